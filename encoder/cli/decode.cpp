// The command decode: a mesh or a grid from a stream or a pack.
#include <filesystem>

#include "encoder/base/error_context.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/export/export.hpp"
#include "encoder/export/grid.hpp"
#include "encoder/export/height_sampler.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/files/output_file.hpp"
#include "encoder/pack/surface.hpp"
#include "encoder/stream/header.hpp"

namespace microtin::cli {

namespace {

bool is_grid(const std::string& path) {
  return std::filesystem::path(path).extension() == ".asc";
}

void set_units(SurfaceModel& model, const Metadata& metadata) {
  model.horizontal_unit = metadata.horizontal_unit;
  model.vertical_unit = metadata.vertical_unit;
}

SurfaceModel read_surface(const std::string& input) {
  const std::optional<PackFile> pack = open_pack(input);
  if (pack) {
    SurfaceModel model = with_file_context(input, [&] { return model_of(*pack); });
    set_units(model, pack->metadata());
    return model;
  }
  const std::vector<uint8_t> stream = read_stream(input);
  return with_file_context(input, [&] {
    SurfaceModel model = model_of(DecodedTerrain(stream).mesh());
    set_units(model, read_header(stream).metadata);
    return model;
  });
}

void write_grid(const DecodeRequest& request, SampledSurface surface) {
  if (request.lattice) surface.placement = Placement();
  const auto height_at = std::move(surface.height_at);
  surface.height_at = [&](int64_t x, int64_t y) {
    return with_file_context(request.input, [&] { return height_at(x, y); });
  };
  OutputFile out(request.output);
  export_grid(surface, request.cell, out);
  out.commit();
}

void decode_to_grid(const DecodeRequest& request) {
  constexpr uint64_t kMostPosts = uint64_t{1} << 26;  // without a word on cells
  const std::optional<PackFile> pack = open_pack(request.input);
  if (pack) {
    write_grid(request, sampled(*pack));
    return;
  }
  const std::vector<uint8_t> stream = read_stream(request.input);
  const DecodedTerrain terrain =
      with_file_context(request.input, [&] { return DecodedTerrain(stream); });
  const SampledSurface surface = sampled(terrain.mesh());
  if (!request.cell && lattice_posts(surface) > kMostPosts) {
    throw Error(request.input + ": has " + std::to_string(lattice_posts(surface)) +
                " places on its lattice: give the size of the grid's cells, --cell");
  }
  write_grid(request, surface);
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
  const SurfaceModel model = read_surface(request.input);
  if (format == MeshFormat::kGlb && model.triangles.empty()) {
    throw Error(request.input + ": holds no triangle");
  }
  OutputFile out(request.output);
  export_model(model, format, request.lattice ? Coordinates::kLattice : Coordinates::kReal, out);
  out.commit();
}

}  // namespace microtin::cli
