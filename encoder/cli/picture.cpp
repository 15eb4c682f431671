// SPDX-License-Identifier: MIT
// The commands render and fractal: pictures, and terrains to try the program with.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/cli/pages.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/input.hpp"
#include "encoder/files/output.hpp"
#include "encoder/picture/render.hpp"
#include "encoder/product/document.hpp"
#include "encoder/product/public_options.hpp"
#include "encoder/terrain/fractal.hpp"

namespace microtin::cli {
namespace {

void run_fractal(const std::string& output, uint32_t size, uint64_t seed) {
  OutputFile out(output);
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // else a text for which memory is short ends early, unsaid
  write_fractal_asc(text, size, seed);
  out.write(text.str());
  out.commit();
}

// The distance from the source is drawn, too, if there is one; it is read as the stream was
// encoded.
struct RenderRequest : TerrainRequest {
  std::string input;
  std::string output;
  uint32_t width = 1024;
  bool mesh = true;    // draw the triangles
  bool world = false;  // write a world file next to the picture
  PaletteKind palette = PaletteKind::kLand;
  bool contours = false;
  std::optional<Decimal> interval;  // of contours; a round one if not given
  std::string title;
  bool coordinates = false, north_arrow = false;
  uint32_t first_bytes = 0;  // of a stream: draw what a decoder has after these; 0: all
  bool force = false;        // read a pack of more vertices than a stream can have
};

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

// CLI11 adds the stream that follows a list of sources to the list; this takes it out again.
void take_stream_from_sources(RenderRequest& request) {
  if (!request.input.empty() || request.source.empty()) return;
  std::vector<std::string> files = request.preparation.more_files;
  files.insert(files.begin(), request.source);
  const auto stream = std::find_if(files.begin(), files.end(), [](const std::string& file) {
    return suffix_of(file) == ".mtin" || suffix_of(file) == ".mtp";
  });
  if (stream == files.end()) return;
  request.input = *stream;
  files.erase(stream);
  if (files.empty()) throw CLI::ArgumentMismatch("--source: names a stream, and no terrain");
  request.source = files.front();
  request.preparation.more_files.assign(files.begin() + 1, files.end());
}

}  // namespace

void add_render(CLI::App& app, Action& action) {
  auto request = std::make_shared<RenderRequest>();
  CLI::App& command =
      *app.add_subcommand("render", "Draw a stream or a pack as .png, .svg or .html");
  command.group(kLookAt);
  add_stream(command, request->input)->required(false);  // as far as CLI11 can see
  add_output(command, request->output,
             "Write this picture, .png or .svg, or page for a browser, .html");
  begin_group(command, "Appearance");
  add_number(command, "--width N", request->width, kNarrowest, "Set the pixels in a row", kWidest)
      ->default_str(std::to_string(request->width));
  command.add_flag_callback(
      "--no-mesh", [request] { request->mesh = false; }, "Do not draw the triangles");
  add_choice<PaletteKind>(command, "--palette", request->palette,
                          {{"land", PaletteKind::kLand}, {"sea", PaletteKind::kSea}},
                          "Choose the colours of heights. land: one ramp from the lowest height. "
                          "sea: blue below 0, land colours above");
  add_read(
      command, "--contours auto|METRES",
      [request](const std::string& text) {
        request->contours = true;
        request->interval = parse_decimal(text);
        return text == "auto" || (request->interval && request->interval->mantissa > 0);
      },
      "auto or a decimal number above 0",
      "Draw contour lines at this distance of heights, in the terrain's unit, or at a round one")
      ->default_str("no contour lines");
  command.add_flag("--coordinates", request->coordinates,
                   "Draw ticks with numbers on the frame, at round coordinates");
  add_number(command, "--first-bytes BYTES", request->first_bytes, 1u,
             "Draw what a device has after the first bytes of a stream")
      ->default_str("the whole stream");
  add_text(command, "--title WORDS", request->title,
           "Print this title above the map, in Latin letters, digits and common signs");
  command.add_flag("--north-arrow", request->north_arrow, "Draw a north arrow, which points up");
  begin_group(command, kOptions);
  add_terrain(command, request->source, request->preparation, "--source",
              "Draw a map of the errors against this terrain: files, or a folder of them")
      ->default_str("no such map");
  add_cells(command, request->source, request->preparation, false);
  command.add_flag("--world-file", request->world,
                   "Write also a .pgw file with the position of the map");
  command.add_flag("--force", request->force, "Draw a pack of more than 2^24 vertices");
  add_preparation(command, request->preparation, request->options);
  command.callback([request, &action] {
    take_stream_from_sources(*request);
    if (request->input.empty()) throw CLI::RequiredError("STREAM");
    action = [request] { run_render(*request); };
  });
}

void add_fractal(CLI::App& app, Action& action) {
  struct Request {
    std::string output;
    uint32_t size = 513;
    uint64_t seed = 1;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command =
      *app.add_subcommand("fractal", "Make a terrain to try the program with (.asc)");
  command.group(kOthers);
  add_output(command, request->output);
  add_number(command, "--size N", request->size, kSmallestFractal, "Set the posts in a row",
             kLargestFractal)
      ->default_str(std::to_string(request->size));
  add_number(command, "--seed N", request->seed, uint64_t{0},
             "Set the random seed; each seed makes a different terrain")
      ->default_str(std::to_string(request->seed));
  command.callback([request, &action] {
    action = [request] { run_fractal(request->output, request->size, request->seed); };
  });
}

}  // namespace microtin::cli
