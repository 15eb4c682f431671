#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "encoder/cli_commands.hpp"
#include "encoder/cli_report.hpp"
#include "encoder/error_context.hpp"
#include "encoder/fractal.hpp"
#include "encoder/header.hpp"
#include "encoder/output_file.hpp"
#include "encoder/pack_surface.hpp"
#include "encoder/render.hpp"

namespace microtin {

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

Spot cell_of(const Source& source, const SurfaceModel& model) {
  const auto* raster = std::get_if<Raster>(&source);
  if (raster == nullptr) return cell_of(std::get<PointCloud>(source), model);
  const Placement& lattice = model.placement;
  return {step_of(raster->x) / step_of(lattice.x), step_of(raster->y) / step_of(lattice.y)};
}

Portrait portrait_of(const PackFile& pack) {
  Portrait portrait{model_of(pack), pack.metadata(), 0, pack.bytes(), pack.entries().size()};
  for (const PackEntry& entry : pack.entries()) portrait.vertices += entry.vertices;
  return portrait;
}

// Verifies what is to be drawn.
using Verify = std::function<Verification(const Source&, const PostVisitor&)>;

void draw(const RenderRequest& request, const Portrait& portrait, const Verify& verify) {
  std::vector<uint8_t> picture;
  if (request.source.empty()) {
    picture = about(request.input, [&] { return render_png(portrait, request.width); });
  } else {
    const Source source = prepared_terrain(request.source, request.preparation).source;
    const Comparison comparison{cell_of(source, portrait.model),
                                [&](const PostVisitor& visit) { return verify(source, visit); }};
    picture =
        about(request.input, [&] { return render_png(portrait, request.width, &comparison); });
  }
  OutputFile out(request.output);
  out.write({reinterpret_cast<const char*>(picture.data()), picture.size()});
  out.commit();
}

}  // namespace

void run_render(const RenderRequest& request) {
  refuse_overwriting(request.input, request.output);
  const std::vector<uint8_t> stream = read_stream(request.input);
  if (is_pack(stream)) {
    const auto [pack, portrait] = about(request.input, [&] {
      PackFile file(stream);
      Portrait all = portrait_of(file);
      return std::pair(std::move(file), std::move(all));
    });
    draw(request, portrait, [&pack = pack](const Source& source, const PostVisitor& visit) {
      return verify(pack, source, std::nullopt, visit);
    });
    return;
  }
  const DecodedTerrain terrain = about(request.input, [&] { return DecodedTerrain(stream); });
  const microtin_mesh* const mesh = terrain.mesh();
  draw(
      request,
      {model_of(mesh), read_header(stream).metadata, microtin_vertex_count(mesh), stream.size(), 0},
      [mesh](const Source& source, const PostVisitor& visit) {
        return verify(mesh, source, std::nullopt, visit);
      });
}

}  // namespace microtin
