// The commands render and fractal: pictures, and terrains to try the program with.
#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "encoder/base/error_context.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/files/output_file.hpp"
#include "encoder/pack/point_pack.hpp"
#include "encoder/pack/surface.hpp"
#include "encoder/picture/render.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/terrain/fractal.hpp"

namespace microtin::cli {

void run_fractal(const std::string& output, uint32_t size, uint64_t seed) {
  OutputFile out(output);
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // else a text for which memory is short ends early, unsaid
  write_fractal_asc(text, size, seed);
  out.write(text.str());
  out.commit();
}

namespace {

// As many steps as would lie between points on a square grid.
Spot cell_of(const PointCloud& cloud, const SurfaceModel& model) {
  const auto [low, high] = std::minmax_element(model.vertices.begin(), model.vertices.end());
  const auto by_y = [](const auto& a, const auto& b) { return a[1] < b[1]; };
  const auto [south, north] =
      std::minmax_element(model.vertices.begin(), model.vertices.end(), by_y);
  const auto area =
      static_cast<double>((*high)[0] - (*low)[0]) * static_cast<double>((*north)[1] - (*south)[1]);
  const double side = std::sqrt(area / static_cast<double>(cloud.points.size()));
  return {side, side};
}

Spot cell_of(const Raster& raster, const SurfaceModel& model) {
  const Placement& lattice = model.placement;
  return {step_of(raster.x) / step_of(lattice.x), step_of(raster.y) / step_of(lattice.y)};
}

Portrait portrait_of(const PackFile& pack) {
  Portrait portrait{model_of(pack), pack.metadata(), 0, pack.bytes(), pack.entries().size()};
  for (const PackEntry& entry : pack.entries()) portrait.vertices += entry.vertices;
  return portrait;
}

void draw(const RenderRequest& request, const Portrait& portrait, const Comparison* comparison) {
  const std::vector<uint8_t> picture = with_file_context(
      request.input, [&] { return render_png(portrait, request.width, comparison); });
  OutputFile out(request.output);
  out.write(picture);
  out.commit();
}

void draw_pack(const RenderRequest& request, const PackFile& pack) {
  const Portrait portrait = with_file_context(request.input, [&] { return portrait_of(pack); });
  if (request.source.empty()) {
    draw(request, portrait, nullptr);
    return;
  }
  const OpenSource source = prepared_source(request.source, request.preparation);
  if (const auto* cloud = std::get_if<PointCloud>(&source)) {
    const Comparison comparison{cell_of(*cloud, portrait.model), [&](const PostVisitor& visit) {
                                  return verify(pack, *cloud, std::nullopt, visit);
                                }};
    draw(request, portrait, &comparison);
    return;
  }
  const auto& raster = std::get<std::unique_ptr<RasterReader>>(source);
  const Comparison comparison{
      cell_of(raster->frame(), portrait.model),
      [&](const PostVisitor& visit) { return verify(pack, *raster, std::nullopt, {}, visit); }};
  draw(request, portrait, &comparison);
}

void draw_stream(const RenderRequest& request, const std::vector<uint8_t>& stream) {
  const DecodedTerrain terrain =
      with_file_context(request.input, [&] { return DecodedTerrain(stream); });
  const microtin_mesh* const mesh = terrain.mesh();
  const Portrait portrait{model_of(mesh), read_header(stream).metadata, microtin_vertex_count(mesh),
                          stream.size(), 0};
  if (request.source.empty()) {
    draw(request, portrait, nullptr);
    return;
  }
  const Source source = prepared_terrain(request.source, request.preparation).source;
  const Comparison comparison{
      std::visit([&](const auto& read) { return cell_of(read, portrait.model); }, source),
      [&](const PostVisitor& visit) { return verify(mesh, source, std::nullopt, visit); }};
  draw(request, portrait, &comparison);
}

}  // namespace

void run_render(const RenderRequest& request) {
  std::vector<std::string> inputs = files_of(request.source, request.preparation);
  inputs.push_back(request.input);
  refuse_overwriting(inputs, request.output);
  const std::optional<PackFile> pack = open_pack(request.input);
  if (pack) {
    draw_pack(request, *pack);
  } else {
    draw_stream(request, read_stream(request.input));
  }
}

}  // namespace microtin::cli
