// SPDX-License-Identifier: MIT
// The command decode: a mesh or a grid from a stream or a pack.
#include <filesystem>

#include "encoder/cli/commands.hpp"
#include "encoder/export/export.hpp"
#include "encoder/export/grid.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/files/output_file.hpp"
#include "encoder/product/document.hpp"

namespace microtin::cli {

namespace {

bool is_grid(const std::string& path) {
  return std::filesystem::path(path).extension() == ".asc";
}

void decode_to_grid(const DecodeRequest& request) {
  constexpr uint64_t kMostPosts = uint64_t{1} << 26;  // of a stream, without a word on cells
  const Document document(request.input);
  SampledSurface surface = document.sampled();
  if (document.stream() != nullptr && !request.cell && lattice_posts(surface) > kMostPosts) {
    throw Error(request.input + ": has " + std::to_string(lattice_posts(surface)) +
                " places on its lattice: give the size of the grid's cells, --cell");
  }
  if (request.lattice) surface.placement = Placement();
  OutputFile out(request.output);
  export_grid(surface, request.cell, out);
  out.commit();
}

}  // namespace

void run_decode(const DecodeRequest& request) {
  refuse_overwriting({request.input}, request.output);
  if (is_grid(request.output)) {
    decode_to_grid(request);
    return;
  }
  if (request.cell) throw Error(request.output + ": only .asc grids have cells");
  const MeshFormat format = mesh_format_of(request.output);
  const SurfaceModel model = Document(request.input).model();
  if (format == MeshFormat::kGlb && model.triangles.empty()) {
    throw Error(request.input + ": holds no triangle");
  }
  OutputFile out(request.output);
  export_model(model, format, request.lattice ? Coordinates::kLattice : Coordinates::kReal, out);
  out.commit();
}

}  // namespace microtin::cli
