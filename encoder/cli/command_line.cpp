// SPDX-License-Identifier: MIT
// What the commands accept; for those that encode see encode_options.cpp.
#include "encoder/cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "encoder/base/suffix.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/completion.hpp"
#include "encoder/cli/definitions.hpp"
#include "encoder/cli/manual.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/picture/render.hpp"
#include "encoder/terrain/fractal.hpp"

namespace microtin::cli {
namespace {

constexpr const char* kHidden = "";  // the group of commands that --help does not show

// Prints what the command line accepts, for man or a shell.
void add_document(CLI::App& parent, const std::string& name, const CLI::App& app, Action& action,
                  std::string (*writer)(const CommandText& program)) {
  parent.add_subcommand(name)->group(kHidden)->callback(
      [&app, &action, writer] { action = [&app, writer] { print(writer(describe(app))); }; });
}

// A list of sources takes the stream that follows it, which is none of them.
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
  if (files.empty()) throw CLI::ArgumentMismatch("--source: names no terrain");
  request.source = files.front();
  request.preparation.more_files.assign(files.begin() + 1, files.end());
}

}  // namespace

void add_decode(CLI::App& app, Action& action) {
  auto request = std::make_shared<DecodeRequest>();
  CLI::App& command = *app.add_subcommand("decode", "Turn a stream into a mesh or a grid");
  add_stream(command, request->input);
  add_output(command, request->output,
             "File to write: .xyz, .obj, .ply, .glb (meshes), .asc (a grid); N43E007.DAT, "
             "N43E007.TER (that cell for ArduPilot, INAV); - is .xyz on standard output");
  CLI::Option* const cell = add_decimal(
      command, "--cell", request->cell,
      "Distance of an .asc grid's posts, in the terrain's unit; if not given, the source's posts, "
      "or of points the lattice's places. Metres between the posts of a .DAT");
  const auto read = [request](const std::string& text) {
    request->extent = parse_extent(text);
    return request->extent.has_value();
  };
  add_read(command, "--extent", read, "WEST,SOUTH,EAST,NORTH, as 7.5,43,8,43.5",
           "Write the posts in this rectangle of the terrain's coordinates: WEST,SOUTH,EAST,NORTH; "
           "with --cell from its south-west corner on");
  CLI::Option* const like =
      command.add_option("--like", request->like, "Write the posts of this raster")
          ->type_name(kFile)
          ->excludes(cell);
  add_indirect(command, request->like_preparation);
  command.add_flag(
      "--force", request->force,
      "Write a file that can take more than 1 GB, or a mesh of more than 2^24 vertices");
  command.add_flag("--lattice", request->lattice, "Write the lattice's integers")->excludes(like);
  command.callback([request, &action] {
    request->like_preparation.band = 1;  // all bands have the same posts
    request->like_preparation.asked.reset();
    if (request->cell && request->cell->mantissa == 0) {
      throw CLI::ValidationError("--cell", "must be above 0");
    }
    action = [request] { run_decode(*request); };
  });
}

void add_embed(CLI::App& app, Action& action) {
  struct Request {
    std::string input, output;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command = *app.add_subcommand(
      "embed", "Turn a stream or a pack into a C header, to be linked into firmware");
  add_stream(command, request->input, "A stream or a pack");
  add_output(command, request->output);
  command.footer(
      "X.h defines the array X_stream and X_VERTICES, the capacity that it needs; of a pack, "
      "X_pack and X_MOST_VERTICES, that of a slot.");
  command.callback(
      [request, &action] { action = [request] { run_embed(request->input, request->output); }; });
}

void add_height_command(CLI::App& app, Action& action, int& code) {
  struct Request : HeightRequest {
    std::string x, y;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command = *app.add_subcommand("height", "Tell the height at places");
  add_stream(command, request->input);
  CLI::Option* const x =
      command.add_option("x", request->x, "A place in the terrain's units: to the east");
  CLI::Option* const y = command.add_option(
      "y", request->y,
      "... and to the north; without a place those on standard input, a line X Y each");
  x->needs(y);
  command.add_flag("--lattice", request->lattice, "Places and heights in steps of the lattice");
  command.add_flag("--device", request->device,
                   "Answer as a device: at the nearest 1/256 of a lattice step");
  command.footer(
      "A word stands where there is no height: outside, void or damaged. For a place on the "
      "command "
      "line their exit codes are 5, 6 and 7; 7 also if the file is damaged.");
  command.callback([request, x, &action, &code] {
    if (x->count() != 0) {
      request->place = parse_place(request->x + ' ' + request->y, request->device);
      if (!request->place) throw CLI::ValidationError("x y", "are not two numbers");
    }
    action = [request, &code] { code = run_height(*request); };
  });
}

void add_info(CLI::App& app, Action& action) {
  struct Request {
    std::string input;
    bool json = false;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command = *app.add_subcommand("info", "Tell what a stream holds");
  add_stream(command, request->input);
  add_json(command, request->json);
  command.callback(
      [request, &action] { action = [request] { run_info(request->input, request->json); }; });
}

void add_verify(CLI::App& app, Action& action) {
  auto request = std::make_shared<VerifyRequest>();
  CLI::App& command = *app.add_subcommand("verify", "Compare a stream with its terrain");
  add_stream(command, request->input);
  add_terrain(command, request->source, request->preparation);
  add_preparation(command, request->preparation);
  command.add_flag("--never-below", request->never_below,
                   "Fail also if the surface is below the source anywhere");
  add_json(command, request->json);
  command.callback([request, &action] { action = [request] { run_verify(*request); }; });
}

void add_fractal(CLI::App& app, Action& action) {
  struct Request {
    std::string output;
    uint32_t size = 513;
    uint64_t seed = 1;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command = *app.add_subcommand("fractal", "Make a terrain (.asc)");
  add_output(command, request->output);
  command.add_option("--size", request->size, "Posts in a row")
      ->check(CLI::Range(kSmallestFractal, kLargestFractal))
      ->capture_default_str();
  const auto read = [request](const std::string& text) { return read_number(text, request->seed); };
  add_read(command, "--seed", read, "a number up to 2^64 - 1", "Another terrain for each")
      ->type_name("UINT")
      ->default_str("1");
  command.callback([request, &action] {
    action = [request] { run_fractal(request->output, request->size, request->seed); };
  });
}

void add_render(CLI::App& app, Action& action) {
  auto request = std::make_shared<RenderRequest>();
  CLI::App& command =
      *app.add_subcommand("render", "Draw a terrain (.png, .svg), or a page that shows it (.html)");
  add_stream(command, request->input)->required(false);  // as far as CLI11 can see
  add_output(command, request->output);
  command.add_option("--width", request->width, "Pixels in a row")
      ->check(CLI::Range(kNarrowest, kWidest))
      ->capture_default_str();
  command.add_flag_callback(
      "--no-mesh", [request] { request->mesh = false; }, "Do not draw the triangles");
  add_choice<PaletteKind>(command, "--palette", request->palette,
                          {{"land", PaletteKind::kLand}, {"sea", PaletteKind::kSea}}, "land or sea",
                          "Colours of heights: land from the lowest on, or land from 0 on and sea, "
                          "blue, below");
  add_read(
      command, "--contours",
      [request](const std::string& text) {
        request->contours = true;
        request->interval = parse_decimal(text);
        return text == "auto" || (request->interval && request->interval->mantissa > 0);
      },
      "auto or a decimal number above 0",
      "Draw lines of equal height: so far apart, in the terrain's unit, or auto");
  command.add_flag("--coordinates", request->coordinates,
                   "Ticks on the frame at round coordinates, with numbers");
  command.add_option("--title", request->title,
                     "Text above the map: Latin letters, digits, common signs");
  command.add_flag("--north-arrow", request->north_arrow, "An arrow to the north, which is up");
  command.add_flag("--force", request->force, "Draw a pack of more than 2^24 vertices");
  command.add_flag("--world-file", request->world,
                   "Write beside the picture, as .pgw, where its map lies");
  add_terrain(
      command, request->source, request->preparation, "--source",
      "Draw a map of the errors against this terrain: a file, several, or a folder of them");
  add_preparation(command, request->preparation);
  command.callback([request, &action] {
    take_stream_from_sources(*request);
    if (request->input.empty()) throw CLI::RequiredError("stream");
    action = [request] { run_render(*request); };
  });
}

void add_documents(CLI::App& app, Action& action) {
  add_document(app, "manual", app, action, manual);
  add_document(app, "reference", app, action, reference);
  CLI::App& completion = *app.add_subcommand("completion")->group(kHidden)->require_subcommand(1);
  add_document(completion, "bash", app, action, bash_completion);
  add_document(completion, "zsh", app, action, zsh_completion);
}

}  // namespace microtin::cli
