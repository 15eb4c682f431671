// SPDX-License-Identifier: MIT
// What the commands accept; encode_options.cpp has those that encode.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "encoder/base/text.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/cli/pages.hpp"
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

// A command that prints what a file is like.
void add_look(CLI::App& app, Action& action, const std::string& name,
              const std::string& description, void (*run)(const std::string&, bool)) {
  struct Request {
    std::string input;
    bool json = false;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command = *app.add_subcommand(name, description);
  command.group(kLookAt);
  add_stream(command, request->input);
  add_json(command, request->json);
  command.callback(
      [request, &action, run] { action = [request, run] { run(request->input, request->json); }; });
}

}  // namespace

void add_decode(CLI::App& app, Action& action) {
  auto request = std::make_shared<DecodeRequest>();
  CLI::App& command =
      *app.add_subcommand("decode", "Turn a stream or a pack into a mesh, a grid or lines");
  command.group(kConvert);
  add_stream(command, request->input);
  add_output(
      command, request->output,
      "Write this file. Meshes: .xyz, .obj, .ply, .glb. A grid: .asc. Marked lines: .geojson. "
      "A cell for autopilots: N43E007.DAT, N43E007.TER. - is .xyz on standard output");
  begin_group(command, "Posts of a grid");
  CLI::Option* const cell =
      add_decimal(command, "--cell DISTANCE", request->cell,
                  "Set the distance of posts, in the terrain's unit; in metres for .DAT files")
          ->default_str("the source's posts; for points the lattice's positions");
  add_extent(
      command, request->extent,
      "Write the posts in this rectangle of the terrain's coordinates; with --cell they begin "
      "at its south-west corner")
      ->default_str("the whole terrain");
  CLI::Option* const like =
      add_text(command, "--like FILE", request->like, "Write the posts of this raster")
          ->excludes(cell);
  add_indirect(command, request->like_preparation);
  begin_group(command, kOptions);
  command
      .add_flag("--lattice", request->lattice, "Write lattice coordinates, which are whole numbers")
      ->excludes(like);
  command.add_flag(
      "--force", request->force,
      "Write a file that can have more than 1 GB, or a mesh of more than 2^24 vertices");
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
  CLI::App& command =
      *app.add_subcommand("embed", "Turn a stream or a pack into a C header for firmware");
  command.group(kConvert);
  add_stream(command, request->input);
  add_output(command, request->output);
  command.footer(
      "X.h defines the array X_stream and X_VERTICES, the capacity of a mesh for it. For a pack it "
      "defines X_pack and X_MOST_VERTICES, the capacity of a slot.");
  command.callback(
      [request, &action] { action = [request] { run_embed(request->input, request->output); }; });
}

void add_height_command(CLI::App& app, Action& action, int& code) {
  struct Request : HeightRequest {
    std::string x, y;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command = *app.add_subcommand("height", "Print the height at one or many positions");
  command.group(kLookAt);
  add_stream(command, request->input);
  CLI::Option* const x = command.add_option(
      "X", request->x,
      "Position to the east, in the terrain's unit. Without a position the command reads lines "
      "\"X Y\" from standard input");
  CLI::Option* const y =
      command.add_option("Y", request->y, "Position to the north, in the terrain's unit");
  x->needs(y);
  command.add_flag("--lattice", request->lattice,
                   "Read positions and print heights in lattice steps");
  command.add_flag("--device", request->device,
                   "Compute as a device does, at the nearest 1/256 of a lattice step");
  command.footer(
      "Where there is no height, the command prints a word: outside, void or damaged. For a "
      "position on the command line the exit codes are then 5, 6 and 7; 7 also if the file is "
      "damaged.");
  command.callback([request, x, &action, &code] {
    if (x->count() != 0) {
      request->place = parse_place(request->x + ' ' + request->y, request->device);
      if (!request->place) {
        throw CLI::ValidationError("X Y", '\'' + request->x + ' ' + request->y +
                                              "' is not allowed; use two decimal numbers");
      }
    }
    action = [request, &code] { code = run_height(*request); };
  });
}

void add_info(CLI::App& app, Action& action) {
  add_look(app, action, "info", "Print what a stream or a pack contains", run_info);
}

void add_check(CLI::App& app, Action& action) {
  add_look(app, action, "check",
           "Decode all of a stream or a pack, and list the tiles that cannot be used", run_check);
}

void add_diff(CLI::App& app, Action& action) {
  struct Request {
    std::string first, second;
    bool json = false;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command =
      *app.add_subcommand("diff", "List the tiles in which two packs of the same tiles differ");
  command.group(kLookAt);
  command.add_option("FIRST", request->first, "A pack (.mtp)")->required()->type_name(kFile);
  command.add_option("SECOND", request->second, "A pack of the same tiles")
      ->required()
      ->type_name(kFile);
  add_json(command, request->json);
  command.callback([request, &action] {
    action = [request] { run_diff(request->first, request->second, request->json); };
  });
}

void add_verify(CLI::App& app, Action& action) {
  auto request = std::make_shared<VerifyRequest>();
  CLI::App& command =
      *app.add_subcommand("verify", "Compare a stream or a pack with its source terrain");
  command.group(kLookAt);
  add_stream(command, request->input);
  add_terrain(command, request->source, request->preparation);
  add_preparation(command, request->preparation, request->options);
  begin_group(command, kOptions);
  command.add_flag("--never-below", request->never_below,
                   "Fail also if the surface is below the source anywhere");
  add_error_map(command, request->options, "the file states the bound elsewhere");
  add_breaklines(command, request->options, "Fail also if edges do not follow");
  add_obstacles(command, request->options);
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

void add_help(CLI::App& app, Action& action) {
  CLI::App& help = *app.add_subcommand("help", "Print the page of a command");
  help.group(kOthers)->require_subcommand(0, 1);
  help.callback([&app, &help, &action] {
    if (help.get_subcommands().empty()) action = [&app] { print(help_page(app)); };
  });
  for (const CLI::App* const command : app.get_subcommands({})) {
    help.add_subcommand(command->get_name(), command->get_description())
        ->group(command->get_group())
        ->callback([command, &action] { action = [command] { print(help_page(*command)); }; });
  }
}

void add_documents(CLI::App& app, Action& action) {
  add_document(app, "manual", app, action, manual);
  add_document(app, "reference", app, action, reference);
  CLI::App& completion = *app.add_subcommand("completion")->group(kHidden)->require_subcommand(1);
  add_document(completion, "bash", app, action, bash_completion);
  add_document(completion, "zsh", app, action, zsh_completion);
}

}  // namespace microtin::cli
