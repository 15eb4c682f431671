// SPDX-License-Identifier: MIT
// What encode accepts, and plan and merge for a pack in shards.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iterator>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/base/iso_date.hpp"
#include "encoder/cli/command_line.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/definitions.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/stream/device_ram.hpp"
#include "microtin/encoder.hpp"
#include "microtin/microtin.h"
#include "shared/format.hpp"

namespace microtin::cli {
namespace {

bool read_tiles(std::string_view text, TileRange& range) {
  const size_t colon = text.find(':');
  return colon != std::string_view::npos && read_number(text.substr(0, colon), range.first) &&
         read_number(text.substr(colon + 1), range.last) && range.first <= range.last;
}

void add_search(CLI::App& command, Search& search) {
  const auto add = [&](const char* name, Search value, const char* description) {
    return command.add_flag_callback(
        name, [&search, value] { search = value; }, description);
  };
  CLI::Option* const fast =
      add("--fast", Search::kFast, "With a bound or limit: search for a short time only");
  add("--best", Search::kBest, "... or for a long time")->excludes(fast);
}

void add_coding(CLI::App& command, Coding& coding) {
  command
      .add_option_function<std::string>(
          "--coding",
          [&coding](const std::string& name) {
            const auto* const end = std::end(kCodings);
            const auto* const found =
                std::find_if(std::begin(kCodings), end,
                             [&name](Coding known) { return name_of(known) == name; });
            if (found == end) {
              throw CLI::ValidationError("--coding", name + " is not quick, balanced or dense");
            }
            coding = *found;
          },
          "How much of it goes into choosing: quick, balanced or dense (the smallest stream)")
      ->default_str(name_of(coding));
}

// Packs are neither of a number of vertices nor of bytes.
void add_tiles(CLI::App& command, EncodeRequest& request, CLI::Option& vertices,
               CLI::Option& bytes) {
  CLI::Option* const tile =
      command
          .add_option(
              "--tile-vertices", request.tile_vertices,
              "Write a pack of tiles with at most this many vertices each. For a .mtp file without "
              "--device-ram the default is " +
                  std::to_string(encoder::kUsualTileVertices))
          ->check(CLI::Range(kFewestTileVertices, kMaxVertices))
          ->excludes(&vertices)
          ->excludes(&bytes);
  command
      .add_option("--tile-size", request.tile_size,
                  "Extent of the pack's tiles at most, in steps between posts; chosen if not given")
      ->check(CLI::Range(1u, uint32_t{kLatticeMax}));
  command
      .add_option(
          "--device-ram", request.device_ram,
          "Bytes that a device has for mesh and decoder, with 16-bit numbers up to " +
              std::to_string(MICROTIN_MAX_VERTICES_FOR(16)) +
              " vertices, with 32-bit numbers beyond. Alone: use the best vertices that fit; with "
              "--max-error or --max-vertices: fail if the terrain does not fit. For a pack (.mtp): "
              "tiles of which such a device keeps four, compact, and decodes one")
      ->excludes(&bytes)
      ->excludes(tile)
      ->check(CLI::Range(device_ram(3), device_ram(kMaxVertices)));
}

// What the header tells people.
void add_notes(CLI::App& command, EncodeRequest& request) {
  command.add_option("--source-name", request.source_name, "Where the terrain comes from");
  command
      .add_option("--date", request.date, "Of the source: 2026, 2026-11 or 2026-11-21 (ISO 8601)")
      ->check([](const std::string& text) {
        return is_iso_date(text) ? std::string() : text + " is not a date such as 2026-11-21";
      });
  command.add_option("--lineage", request.lineage, "What was done to the source before");
}

void add_point_options(CLI::App& command, EncodeRequest& request) {
  add_choice<BoundAt>(command, "--bound-at", request.bound_at,
                      {{"points", BoundAt::kTruePlaces}, {"lattice", BoundAt::kLattice}},
                      "points or lattice",
                      "Where --max-error holds for points: where they truly lie (points, if not "
                      "given), or at their places on the lattice alone");
  add_choice<DuplicateRule>(command, "--duplicates", request.lattice.duplicates,
                            {{"middle", DuplicateRule::kMiddle},
                             {"lowest", DuplicateRule::kLowest},
                             {"highest", DuplicateRule::kHighest},
                             {"mean", DuplicateRule::kMean}},
                            "middle, lowest, highest or mean",
                            "Of points that meet at a place of the lattice: which one stands for "
                            "all; if not given all count, the surface aims at their middle");
}

void add_encode_options(CLI::App& command, const std::shared_ptr<EncodeRequest>& request) {
  add_terrain(command, request->input, request->preparation);
  CLI::Option* const bound =
      add_decimal(command, "--max-error", request->lattice.max_error,
                  "Keep every height within this distance, in the terrain's unit");
  CLI::Option* const vertices =
      command
          .add_option(
              "--max-vertices", request->max_vertices,
              "Use at most this many vertices, and the smallest --max-error that they allow")
          ->check(CLI::Range(3u, kMaxVertices))
          ->excludes(bound);
  CLI::Option* const bytes =
      command
          .add_option("--max-bytes", request->max_bytes,
                      "Keep the smallest --max-error that a file of this size can")
          ->check(CLI::PositiveNumber)
          ->excludes(bound)
          ->excludes(vertices);
  add_tiles(command, *request, *vertices, *bytes);
  command.add_flag("--never-below", request->lattice.never_below,
                   "With a bound: no height is below the source, all are at most so far above");
  add_point_options(command, *request);
  add_search(command, request->search);
  add_decimal(
      command, "--z-step", request->lattice.z_step,
      "Step of heights; with --max-error, if not given, the one that takes the fewest bytes");
  add_decimal(command, "--xy-step", request->lattice.xy_step, "Step of places (rasters: in posts)");
  command
      .add_option(
          "--max-degree", request->effort.degree,
          "Most triangles around a vertex when it is added; if not given 10, quick 9, or, of "
          "less than 2,000 vertices, 16 if that saves a 256th")
      ->check(CLI::Range(kMinDegree, kMaxDegree));
  add_coding(command, request->effort.coding);
  add_preparation(command, request->preparation);
  add_notes(command, *request);
}

void check_encode_options(EncodeRequest& request) {
  if (request.lattice.never_below && !request.lattice.max_error && request.max_bytes == 0) {
    throw CLI::ValidationError("--never-below", "needs --max-error or --max-bytes");
  }
  request.lattice.water_level = request.preparation.water_level;
}

}  // namespace

void add_encode(CLI::App& app, Action& action) {
  auto request = std::make_shared<EncodeRequest>();
  CLI::App& command = *app.add_subcommand("encode", "Turn a terrain into a stream, or a pack");
  add_encode_options(command, request);
  add_output(command, request->output);
  const auto read = [request](const std::string& text) {
    return read_tiles(text, request->tiles.emplace());
  };
  add_read(command, "--shard", read, "FROM:TO, as 0:99",
           "FROM:TO: write a shard of a pack, with these of its tiles; merge joins them");
  command.callback([request, &action] {
    check_encode_options(*request);
    action = [request] { run_encode(*request); };
  });
}

void add_plan(CLI::App& app, Action& action) {
  struct Request : EncodeRequest {
    uint32_t shards = 1;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command = *app.add_subcommand(
      "plan", "Print, for each shard of a pack, options for encode that make it");
  add_encode_options(command, request);
  command.add_option("--shards", request->shards, "Number of shards")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  command.callback([request, &action] {
    check_encode_options(*request);
    action = [request] { run_plan(*request, request->shards); };
  });
}

void add_merge(CLI::App& app, Action& action) {
  struct Request {
    std::vector<std::string> shards;
    std::string output;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command = *app.add_subcommand("merge", "Join the shards of a pack, in any order");
  command.add_option("shards", request->shards, "What encode --shard wrote, all of it")
      ->required()
      ->type_name(kFile);
  add_output(command, request->output);
  command.callback(
      [request, &action] { action = [request] { run_merge(request->shards, request->output); }; });
}

}  // namespace microtin::cli
