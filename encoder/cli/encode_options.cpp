// SPDX-License-Identifier: MIT
// What encode accepts, and what plan and merge accept, for a pack in shards.
#include <CLI/CLI.hpp>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "encoder/cli/commands.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/cli/pages.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/stream/device_memory.hpp"
#include "microtin/encoder.hpp"
#include "microtin/microtin.h"

namespace microtin::cli {
namespace {

bool read_tiles(std::string_view text, TileRange& range) {
  const size_t colon = text.find(':');
  return colon != std::string_view::npos && read_number(text.substr(0, colon), range.first) &&
         read_number(text.substr(colon + 1), range.last) && range.first <= range.last;
}

void add_search(CLI::App& command, encoder::Options& options) {
  begin_group(command, "Time to search, with a bound or a limit");
  const auto add = [&](const char* name, const char* effort, const char* description) {
    return command.add_flag_callback(
        name, [&options, effort] { encoder::set_option(options, "effort", effort); }, description);
  };
  CLI::Option* const fast =
      add("--fast", "fast", "Search for a short time; files are some 18 % larger");
  add("--best", "best", "Search for a long time, about ten times the usual one")->excludes(fast);
}

void add_coding(CLI::App& command, encoder::Options& options) {
  begin_group(command, "Work of the device");
  add_named(command, "--coding", options,
            "Trade file size against decoding time. quick: fastest to decode. dense: "
            "smallest file");
  add_named(command, "--max-degree N", options,
            "Limit the triangles around a vertex when it is added")
      ->default_str("usually 10; 9 with quick; 16 if that saves 0.4 % below 2000 vertices");
}

// Neither a number of vertices nor of bytes of the whole file limits a pack.
void add_tiles(CLI::App& command, EncodeRequest& request, CLI::Option& vertices,
               CLI::Option& bytes) {
  begin_group(command, "Packs and devices");
  CLI::Option* const tile =
      add_named(command, "--tile-vertices N", request.options,
                "Write a pack of tiles with at most N vertices each")
          ->excludes(&vertices)
          ->excludes(&bytes)
          ->default_str(std::to_string(encoder::kUsualTileVertices) + " for .mtp files");
  add_named(command, "--tile-size N", request.options,
            "Make tiles of a raster at most N steps between posts wide and high")
      ->default_str("chosen");
  add_number(command, "--device-ram BYTES", request.device_ram, device_ram(3),
             "Fit mesh and decoder into the RAM of a device. .mtin: with the best vertices that "
             "fit; with --max-error or --max-vertices, fail if the terrain does not fit. .mtp: "
             "with the largest tiles of which the device keeps four, compact, and decodes one. "
             "Indices have 16 bits up to " +
                 std::to_string(MICROTIN_MAX_VERTICES_FOR(16)) + " vertices, else 32",
             device_ram(kMaxVertices))
      ->excludes(&bytes)
      ->excludes(tile)
      ->default_str("no limit");
  add_choice<Adapter>(command, "--for", request.adapter,
                      {{"inav", Adapter::kInav}, {"ardupilot", Adapter::kArduPilot}},
                      "Write a pack for an autopilot's adapter, and print what to set there. With "
                      "--device-ram: tiles of which the adapter keeps " +
                          std::to_string(kAdapterTiles) + ", compact")
      ->default_str("no adapter");
}

// Where the header has notes of the file unless options state others.
constexpr const char* kOfFile = "what the file states";

void add_notes(CLI::App& command, encoder::Options& options) {
  begin_group(command, "Notes in the header");
  add_named(command, "--surface", options,
            "Note what the heights are: bare ground, the top surface with vegetation "
            "and buildings, the bed of a sea or lake, a geoid, or an envelope of obstacles");
  const std::pair<const char*, const char*> notes[] = {
      {"--source-name NAME", "Note where the terrain comes from"},
      {"--date DATE",
       "Note the date of the source: 2026, 2026-11 or 2026-11-21, or two of them with a slash "
       "between"},
      {"--lineage WORDS", "Note how the source was processed before"},
      {"--attribution WORDS", "Note an attribution to be shown to users"},
      {"--license LICENSE", "Note the licence of the source: an SPDX expression or a URL"},
      {"--valid DATES",
       "Note when the terrain is valid: two dates with a slash between, of which one may be .."},
      {"--epoch YEAR", "Note the epoch of the coordinates, a decimal year"},
      {"--source-accuracy ACCURACY",
       "Note how accurate the source itself is: LE90, LE95 or RMSE, and a number in units of "
       "height, such as 'LE90 4'"},
  };
  for (const auto& [definition, description] : notes) {
    add_named(command, definition, options, description)->default_str(kOfFile);
  }
  add_named(command, "--digest", options,
            "Note a digest of a stream's mesh, by which a device checks its memory: 11 bytes");
  add_named(command, "--phases", options,
            "Note the vertices, bytes and largest error after each phase of a stream");
}

void add_bound(CLI::App& command, EncodeRequest& request, CLI::Option*& vertices,
               CLI::Option*& bytes) {
  encoder::Options& options = request.options;
  begin_group(command, "Bound or limit");
  add_named(command, "--max-error METRES", options,
            "Keep every height within this distance, in the terrain's unit")
      ->default_str("every post or point is a vertex");
  vertices = add_named(command, "--max-vertices N", options,
                       "Find the smallest error that N vertices allow")
                 ->default_str("no limit");
  bytes = add_named(command, "--max-bytes BYTES", options,
                    "Find the smallest error that a file of this size allows")
              ->excludes(vertices)
              ->default_str("no limit");
  add_error_map(command, options,
                "elsewhere --max-error holds, and --max-bytes and --max-vertices scale all bounds");
  add_named(command, "--never-below", options,
            "Keep the surface at or above every height, by at most the bound");
  add_named(command, "--bound-at", options,
            "Choose where --max-error holds. points: at posts, and at points where they "
            "lie. lattice: at the lattice positions that stand for points. everywhere: on "
            "the whole surface of a raster, compared with the bilinear one of its posts");
  add_obstacles(command, options);
  add_breaklines(command, options, "Make edges along");
}

void add_encode_options(CLI::App& command, const std::shared_ptr<EncodeRequest>& request) {
  encoder::Options& options = request->options;
  CLI::Option *vertices = nullptr, *bytes = nullptr;
  add_terrain(command, request->source, request->preparation);
  add_bound(command, *request, vertices, bytes);
  begin_group(command, "Lattice");
  add_named(command, "--z-step METRES", options, "Set the step of heights, in the terrain's unit")
      ->default_str("the source's; with --max-error that of the smallest file");
  add_named(command, "--xy-step DISTANCE", options,
            "Set the step of positions: posts for rasters, the terrain's unit for points")
      ->default_str("the source's");
  begin_group(command, "Points");
  add_named(command, "--duplicates", options,
            "Choose the height where points share a lattice position. middle: all "
            "count, and the surface aims at the middle of the lowest and highest");
  add_search(command, options);
  add_coding(command, options);
  add_tiles(command, *request, *vertices, *bytes);
  add_preparation(command, request->preparation, options);
  add_notes(command, options);
}

void check_encode_options(const encoder::Options& options) {
  const bool has_map = !options.error_map.empty();
  const bool has_bound = !options.max_error.empty();
  if (has_bound && !has_map && (options.max_bytes | options.max_vertices) != 0) {
    throw CLI::ExcludesError(options.max_bytes != 0 ? "--max-bytes" : "--max-vertices",
                             "--max-error");
  }
  if (options.never_below && !has_bound && !has_map && options.max_bytes == 0) {
    throw CLI::ValidationError("--never-below", "needs --max-error or --max-bytes");
  }
  if (!options.obstacles.empty() && !has_bound) {
    throw CLI::ValidationError("--obstacles", "needs --max-error");
  }
}

}  // namespace

void add_encode(CLI::App& app, Action& action) {
  auto request = std::make_shared<EncodeRequest>();
  CLI::App& command = *app.add_subcommand("encode", "Turn a terrain into a stream or a pack");
  command.group(kEncode);
  begin_group(command, kOptions);
  add_output(command, request->output,
             "Write this stream (.mtin) or pack (.mtp); - is standard output");
  add_encode_options(command, request);
  begin_group(command, "Shards of a pack");
  const auto read = [request](const std::string& text) {
    return read_tiles(text, request->tiles.emplace());
  };
  add_read(command, "--shard FROM:TO", read, "FROM:TO, such as 0:99",
           "Write a shard of a raster's pack, with these of its tiles; merge joins shards")
      ->default_str("all tiles");
  add_text(command, "--resume FILE", request->resume,
           "Keep the finished tiles of a raster's pack or shard in this file, and go on from it if "
           "it is there; it is removed at the end");
  command.callback([request, &action] {
    check_encode_options(request->options);
    action = [request] { run_encode(*request); };
  });
}

void add_plan(CLI::App& app, Action& action) {
  struct Request : EncodeRequest {
    uint32_t shards = 1;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command =
      *app.add_subcommand("plan", "Print the options of encode for each shard of a pack");
  command.group(kShards);
  begin_group(command, kOptions);
  add_number(command, "--shards N", request->shards, 1u, "Set the number of shards")
      ->default_str(std::to_string(request->shards));
  add_encode_options(command, request);
  command.callback([request, &action] {
    check_encode_options(request->options);
    action = [request] { run_plan(*request, request->shards); };
  });
}

void add_update(CLI::App& app, Action& action) {
  auto request = std::make_shared<UpdateRequest>();
  CLI::App& command = *app.add_subcommand(
      "update", "Encode the tiles of a pack again whose terrain changed; keep the others");
  command.group(kEncode);
  command.add_option("OLD", request->old, "The pack (.mtp) of a raster")
      ->required()
      ->type_name(kFile);
  begin_group(command, kOptions);
  add_output(command, request->output, "Write this pack (.mtp); - is standard output");
  add_terrain(command, request->source, request->preparation);
  add_error_map(command, request->options, "elsewhere the pack's bound holds");
  const auto read_scope = [request](const std::string& text) {
    if (text == "everywhere") request->bound_at = BoundScope::kEverywhere;
    if (text == "points") request->bound_at = BoundScope::kTruePlaces;
    return request->bound_at.has_value();
  };
  add_read(command, "--bound-at points|everywhere", read_scope, "points or everywhere",
           "Keep the pack's bound at posts, or between them, too")
      ->default_str("everywhere if the pack's margins are within the bound, or over obstacles");
  add_obstacles(command, request->options);
  add_breaklines(command, request->options, "Make edges of all tiles along");
  add_named(command, "--tile-vertices N", request->options,
            "Let new tiles have at most N vertices each")
      ->default_str("as many as the pack states");
  add_search(command, request->options);
  add_preparation(command, request->preparation, request->options);
  add_notes(command, request->options);
  command.callback([request, &action] { action = [request] { run_update(*request); }; });
}

void add_merge(CLI::App& app, Action& action) {
  struct Request {
    std::vector<std::string> shards;
    std::string output;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command =
      *app.add_subcommand("merge", "Join the shards of a pack, or packs of one plan, in any order");
  command.group(kShards);
  command
      .add_option("SHARD", request->shards,
                  "All files that encode --shard wrote for the pack, or packs that cut made")
      ->required()
      ->type_name(kFile);
  add_output(command, request->output);
  command.callback(
      [request, &action] { action = [request] { run_merge(request->shards, request->output); }; });
}

}  // namespace microtin::cli
