// SPDX-License-Identifier: MIT
// The commands render and fractal: pictures, and terrains to try the program with.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <sstream>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/input.hpp"
#include "encoder/files/output.hpp"
#include "encoder/picture/render.hpp"
#include "encoder/product/document.hpp"
#include "encoder/product/public_options.hpp"
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

constexpr uint32_t kFlatWidth = 512;  // of the picture for browsers that cannot draw
constexpr const char *kPage = ".html", *kDrawing = ".svg";

std::string world_path(const std::string& picture) {
  return std::filesystem::u8path(picture).replace_extension(".pgw").string();
}

void expect_picture(const RenderRequest& request) {
  const std::string suffix = suffix_of(request.output);
  if (!suffix.empty() && suffix != ".png" && suffix != kDrawing && suffix != kPage) {
    throw Error(request.output +
                ": is not a kind of picture that render writes; name it .png, .svg or .html");
  }
  if (request.world && suffix != ".png") {
    throw Error(request.output + ": only a .png file gets a world file; leave out --world-file");
  }
  if (request.first_bytes != 0 && (suffix == kPage || !request.source.empty())) {
    throw Error(request.output +
                ": --first-bytes is for .png and .svg files without a map of errors; leave it out");
  }
}

// The whole terrain, or what its first bytes make.
Portrait portrait_of(const RenderRequest& request, const Document& document) {
  const uint64_t most = most_vertices(request.input, document.counted_vertices(), request.force);
  uint64_t vertices = document.vertices(), bytes = document.bytes();
  Metadata metadata = document.metadata();
  SurfaceModel model;
  std::vector<MarkedLine> lines;
  if (request.first_bytes != 0) {
    bytes = std::min<uint64_t>(request.first_bytes, bytes);
    model = document.model_after(bytes);
    vertices = model.vertices.size();
    if (bytes < document.bytes()) metadata.accuracy.reset();  // that of the whole terrain
  } else {
    model = document.model(most);
    if (document.stream() != nullptr) lines = document.stream()->terrain.lines();
  }
  return {std::move(model),
          std::move(metadata),
          vertices,
          bytes,
          document.tiles(),
          request.mesh,
          request.palette,
          request.contours,
          request.interval,
          request.title,
          request.coordinates,
          request.north_arrow,
          std::move(lines)};
}

// The bytes of what was read: of a stream those that it was decoded from, as it may come by a pipe.
std::string content_of(const Document& document) {
  if (document.pack() != nullptr) return read_file(document.path());
  const std::vector<uint8_t>& bytes = document.stream()->bytes;
  return {bytes.begin(), bytes.end()};
}

// One file, which shows the terrain in a browser.
void write_page(const RenderRequest& request, const Document& document, const Portrait& portrait) {
  if (!request.source.empty())
    throw Error(request.output +
                ": a page cannot show a map of errors; leave out --source, or write a .png file");
  if (request.contours || !request.title.empty() || request.coordinates || request.north_arrow) {
    throw Error(request.output +
                ": a page cannot show contours, coordinates, a title or a north arrow; write a "
                ".png or .svg file");
  }
  const std::string page = with_file_context(request.input, [&] {
    return render_page(portrait, std::filesystem::u8path(request.input).stem().string(),
                       content_of(document), render_png(portrait, kFlatWidth));
  });
  OutputFile out(request.output);
  out.write(page);
  const std::string of_units = warning_of_units(request.output, portrait.model);
  out.commit();
  std::fputs(of_units.c_str(), stderr);
}

void write_drawing(const RenderRequest& request, const Portrait& portrait) {
  if (!request.source.empty())
    throw Error(
        request.output +
        ": a drawing cannot show a map of errors; leave out --source, or write a .png file");
  const std::string svg =
      with_file_context(request.input, [&] { return render_svg(portrait, request.width); });
  OutputFile out(request.output);
  out.write(svg);
  const std::string of_units = warning_of_units(request.output, portrait.model);
  out.commit();
  std::fputs(of_units.c_str(), stderr);
}

void draw(const RenderRequest& request, const Portrait& portrait, const Comparison* comparison) {
  const std::vector<uint8_t> picture = with_file_context(
      request.input, [&] { return render_png(portrait, request.width, comparison); });
  OutputFile out(request.output);
  out.write(picture);
  std::optional<OutputFile> world;
  if (request.world) {
    world.emplace(world_path(request.output))
        .write(world_file(portrait, request.width, comparison != nullptr));
  }
  const std::string of_units = warning_of_units(request.output, portrait.model);
  out.commit();
  if (world) world->commit();
  std::fputs(of_units.c_str(), stderr);
}

}  // namespace

void run_render(const RenderRequest& request) {
  const Preparation preparation = preparation_of(request.options, request.preparation);
  std::vector<std::string> inputs = files_of(request.source, preparation);
  inputs.push_back(request.input);
  refuse_overwriting(inputs, request.output);
  expect_picture(request);
  const Document document(request.input);
  const Portrait portrait = portrait_of(request, document);
  const std::string suffix = suffix_of(request.output);
  if (suffix == kPage) return write_page(request, document, portrait);
  if (suffix == kDrawing) return write_drawing(request, portrait);
  if (request.source.empty()) {
    draw(request, portrait, nullptr);
    return;
  }
  const Original original(document, request.source, preparation);
  const SurfaceModel& model = portrait.model;
  const Comparison comparison{
      original.raster() != nullptr ? cell_of(*original.raster(), model)
                                   : cell_of(*original.cloud(), model),
      [&](const PostVisitor& visit) { return original.compare(std::nullopt, {}, visit); }};
  draw(request, portrait, &comparison);
}

}  // namespace microtin::cli
