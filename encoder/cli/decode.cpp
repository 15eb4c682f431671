// SPDX-License-Identifier: MIT
// The command decode: a mesh or a grid from a stream or a pack.
#include <filesystem>
#include <optional>

#include "encoder/cli/commands.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/export/export.hpp"
#include "encoder/export/grid.hpp"
#include "encoder/export/system.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/files/output_file.hpp"
#include "encoder/product/document.hpp"

namespace microtin::cli {

namespace {

namespace fs = std::filesystem;

bool is_grid(const std::string& path) {
  return std::filesystem::path(path).extension() == ".asc";
}

// A grid's coordinate system, in a file beside it.
class SystemFile {
 public:
  SystemFile(const std::string& grid, const Metadata& metadata)
      : path_(fs::path(grid).replace_extension(".prj").string()), code_(metadata.horizontal_epsg) {
    const std::string text = system_text(metadata);
    if (!text.empty()) out_.emplace(path_).write(text);
  }

  void commit() {
    if (out_) {
      out_->commit();
    } else if (std::error_code none; fs::exists(path_, none)) {
      warn(path_ + " lies beside the grid, but is not its coordinate system");
    } else if (code_ != 0) {
      const std::string code = "EPSG:" + std::to_string(code_);
      warn("no " + path_ + " is written: the text of " + code +
           " is not known here; \"gdalsrsinfo -o wkt_esri " + code + "\" prints it");
    }
  }

 private:
  std::string path_;
  uint32_t code_;
  std::optional<OutputFile> out_;
};

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
  std::optional<SystemFile> system;
  if (!request.lattice) system.emplace(request.output, document.metadata());
  out.commit();
  if (system) system->commit();
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
  const bool is_real = !request.lattice;
  OutputFile out(request.output);
  export_model(model, format, is_real ? Coordinates::kReal : Coordinates::kLattice, out);
  out.commit();
  if (format == MeshFormat::kGlb && is_real) warn_of_units(request.output, model);
}

}  // namespace microtin::cli
