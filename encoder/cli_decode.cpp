#include <filesystem>

#include "encoder/cli_commands.hpp"
#include "encoder/cli_report.hpp"
#include "encoder/error_context.hpp"
#include "encoder/export.hpp"
#include "encoder/export_grid.hpp"
#include "encoder/header.hpp"
#include "encoder/height_sampler.hpp"
#include "encoder/output_file.hpp"
#include "encoder/pack_surface.hpp"

namespace microtin {

namespace {

bool is_grid(const std::string& path) {
  return std::filesystem::path(path).extension() == ".asc";
}

SurfaceModel surface_of(const std::vector<uint8_t>& stream) {
  if (is_pack(stream)) {
    const PackFile pack(stream);
    SurfaceModel model = model_of(pack);
    model.horizontal_unit = pack.metadata().horizontal_unit;
    model.vertical_unit = pack.metadata().vertical_unit;
    return model;
  }
  SurfaceModel model = model_of(DecodedTerrain(stream).mesh());
  const Metadata metadata = read_header(stream).metadata;
  model.horizontal_unit = metadata.horizontal_unit;
  model.vertical_unit = metadata.vertical_unit;
  return model;
}

void write_grid(const DecodeRequest& request, SampledSurface surface) {
  if (request.lattice) surface.placement = Placement();
  const auto height_at = std::move(surface.height_at);
  surface.height_at = [&](int64_t x, int64_t y) {
    return about(request.input, [&] { return height_at(x, y); });
  };
  OutputFile out(request.output);
  export_grid(surface, request.cell, out);
  out.commit();
}

void decode_to_grid(const DecodeRequest& request) {
  constexpr uint64_t kMostPosts = uint64_t{1} << 26;  // without a word on cells
  const std::vector<uint8_t> stream = read_stream(request.input);
  if (is_pack(stream)) {
    const PackFile pack = about(request.input, [&] { return PackFile(stream); });
    write_grid(request, sampled(pack));
    return;
  }
  const DecodedTerrain terrain = about(request.input, [&] { return DecodedTerrain(stream); });
  const SampledSurface surface = sampled(terrain.mesh());
  if (!request.cell && lattice_posts(surface) > kMostPosts) {
    throw Error(request.input + ": has " + std::to_string(lattice_posts(surface)) +
                " places on its lattice: give the size of the grid's cells, --cell");
  }
  write_grid(request, surface);
}

}  // namespace

void run_decode(const DecodeRequest& request) {
  refuse_overwriting(request.input, request.output);
  if (is_grid(request.output)) {
    decode_to_grid(request);
    return;
  }
  if (request.cell) throw Error(request.output + ": only .asc grids have cells");
  const MeshFormat format = mesh_format_of(request.output);
  const std::vector<uint8_t> stream = read_stream(request.input);
  const SurfaceModel model = about(request.input, [&] {
    SurfaceModel all = surface_of(stream);
    if (format == MeshFormat::kGlb && all.triangles.empty()) throw Error("holds no triangle");
    return all;
  });
  OutputFile out(request.output);
  export_model(model, format, request.lattice ? Coordinates::kLattice : Coordinates::kReal, out);
  out.commit();
}

}  // namespace microtin
