// SPDX-License-Identifier: MIT
// The command line: what it accepts, and how it fails.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/base/iso_date.hpp"
#include "encoder/base/utf8.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/completion.hpp"
#include "encoder/cli/definitions.hpp"
#include "encoder/cli/manual.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/cli/version.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/files/leftovers.hpp"
#include "encoder/files/standard_files.hpp"
#include "encoder/picture/render.hpp"
#include "encoder/product/reference.hpp"
#include "encoder/stream/device_ram.hpp"
#include "microtin/microtin.h"
#include "shared/format.hpp"

namespace microtin::cli {
namespace {

constexpr int kFailed = 1, kUsage = 2, kInternal = 3, kReportLost = 4;

constexpr const char* kHidden = "";  // the group of commands that --help does not show

constexpr const char* kExitCodes =
    "Exit codes: 0 done; 1 failed, no output; 2 wrong usage; 3 a fault of microtin itself, no "
    "output; 4 done, but nobody reads the report";

constexpr const char* kTerrainFiles =
    "Rasters: .hgt, .zip with one .hgt, .asc. Points: .xyz, .csv, .txt, .las, .ply, .obj; - reads "
    "points. Several files, or a folder of them, are one terrain"
#ifdef MICROTIN_WITH_GDAL
    ". Others by GDAL"
#endif
    ;

// Other names of standard output are "-" for all that follows, unless a suffix asks for a format.
std::string plain_output(const std::string& path) {
  const bool is_plain = std::filesystem::path(path).extension().empty();
  return is_plain && descriptor_named(path) == STDOUT_FILENO ? "-" : path;
}

void add_output(CLI::App& command, std::string& path,
                const std::string& description = "File to write; - is standard output") {
  command.add_option("-o,--output", path, description)
      ->required()
      ->type_name(kFile)
      ->transform(plain_output);
}

void add_stream(CLI::App& command, std::string& path,
                const std::string& description = "A stream (.mtin) or a pack (.mtp)") {
  command.add_option("stream", path, description)->required()->type_name(kFile);
}

// One or several files, or folders of them, that make up one terrain.
void add_terrain(CLI::App& command, std::string& path, Preparation& preparation) {
  command
      .add_option_function<std::vector<std::string>>(
          "terrain",
          [&path, &preparation](const std::vector<std::string>& files) {
            path = files[0];
            preparation.more_files.assign(files.begin() + 1, files.end());
          },
          kTerrainFiles)
      ->required()
      ->type_name(kFile);
}

void add_json(CLI::App& command, bool& json) {
  command.add_flag("--json", json, "Print JSON");
}

// An option whose text is read by `read`, which says whether it is what is `wanted`. Numbers and
// lists are not left to CLI11: it takes 010 for 8 and the next argument for an item, and does not
// say what it wanted.
CLI::Option* add_read(CLI::App& command, const std::string& name,
                      std::function<bool(const std::string&)> read, const std::string& wanted,
                      const std::string& description) {
  return command.add_option_function<std::string>(
      name,
      [name, read = std::move(read), wanted](const std::string& text) {
        if (!read(text)) throw CLI::ValidationError(name, text + " is not " + wanted);
      },
      description);
}

CLI::Option* add_height(CLI::App& command, const std::string& name, std::optional<Decimal>& value,
                        const std::string& description) {
  const auto read = [&value](const std::string& text) {
    value = parse_decimal(text);
    return value.has_value();
  };
  return add_read(command, name, read, "a decimal number", description);
}

CLI::Option* add_decimal(CLI::App& command, const std::string& name, std::optional<Decimal>& value,
                         const std::string& description) {
  const auto read = [&value](const std::string& text) {
    value = parse_decimal(text);
    return value && value->mantissa >= 0;
  };
  return add_read(command, name, read, "a decimal number from 0 on", description);
}

bool read_number(std::string_view text, uint32_t& number) {
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && next == end;
}

bool read_code(std::string_view text, uint32_t& code) {
  return read_number(text, code) && code != 0;
}

bool read_epsg(std::string_view text, uint32_t& horizontal, uint32_t& vertical) {
  const size_t colon = text.find(':');
  return read_code(text.substr(0, colon), horizontal) &&
         (colon == std::string_view::npos || read_code(text.substr(colon + 1), vertical));
}

bool read_tiles(std::string_view text, TileRange& range) {
  const size_t colon = text.find(':');
  return colon != std::string_view::npos && read_number(text.substr(0, colon), range.first) &&
         read_number(text.substr(colon + 1), range.last) && range.first <= range.last;
}

bool read_classes(std::string_view text, ClassSet& classes) {
  if (text == "all") {
    classes.set();
    return true;
  }
  uint32_t code = 0;
  for (size_t start = 0, end = 0; end != std::string_view::npos; start = end + 1) {
    end = text.find(',', start);
    if (!read_number(text.substr(start, end - start), code) || code >= classes.size()) return false;
    classes.set(code);
  }
  return true;
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

void add_decoding(CLI::App& command, Decoding& decoding) {
  command
      .add_option_function<std::string>(
          "--decoding",
          [&decoding](const std::string& name) {
            const auto* const end = std::end(kDecodings);
            const auto* const found =
                std::find_if(std::begin(kDecodings), end,
                             [&name](Decoding known) { return name_of(known) == name; });
            if (found == end) {
              throw CLI::ValidationError("--decoding", name + " is not quick, balanced or dense");
            }
            decoding = *found;
          },
          "How much of it goes into choosing: quick, balanced or dense (the smallest stream)")
      ->default_str(name_of(decoding));
}

// Packs are neither of a number of vertices nor of bytes.
void add_tiles(CLI::App& command, EncodeRequest& request, CLI::Option& vertices,
               CLI::Option& bytes) {
  CLI::Option* const tile =
      command
          .add_option("--tile-vertices", request.tile_vertices,
                      "Write a pack of tiles with at most so many vertices each")
          ->check(CLI::Range(kFewestTileVertices, kMaxVertices))
          ->excludes(&vertices)
          ->excludes(&bytes);
  command
      .add_option("--tile-steps", request.tile_steps,
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

void add_indirect([[maybe_unused]] CLI::App& command, [[maybe_unused]] Preparation& preparation) {
#ifdef MICROTIN_WITH_GDAL
  command.add_flag_callback(
      "--allow-vrt", [&preparation] { preparation.indirect = Indirect::kAllowed; },
      "Read .vrt files, which name other files to be read, and names that begin with /vsi");
#endif
}

// For encoding, and alike for every comparison with the source.
void add_preparation(CLI::App& command, Preparation& preparation) {
  const auto read = [&preparation](const std::string& text) {
    return read_classes(text, preparation.classes.emplace());
  };
  add_read(
      command, "--classes", read, "a list such as 2,9, nor all",
      "Points to take from a .las file: their classes, 2,9 for instance, or all. If not given: "
      "the ground (2) or, if there is none, all but noise (7, 18)");
  add_indirect(command, preparation);
#ifdef MICROTIN_WITH_GDAL
  command
      .add_option("--band", preparation.band,
                  "Band of heights, from 1 on, in a file that has several (read by GDAL)")
      ->check(CLI::PositiveNumber);
#endif
  command.add_option("--fill-voids", preparation.fill_voids,
                     "Interpolate voids of up to so many posts");
  CLI::Option* const level = add_height(
      command, "--water-level", preparation.water_level,
      "Voids that are left are water at this height, as are posts at this height (rasters)");
  command
      .add_option("--water-mask", preparation.water_mask,
                  "An .asc grid of the terrain's posts: 1 where voids are water, else 0")
      ->type_name(kFile)
      ->needs(level);
}

// What the header tells people.
void add_notes(CLI::App& command, EncodeRequest& request) {
  const auto read = [&request](const std::string& text) {
    return read_epsg(text, request.reference.horizontal_epsg, request.reference.vertical_epsg);
  };
  add_read(
      command, "--epsg", read, "a code, nor two with a colon between",
      "Codes of the coordinates: horizontal, or horizontal:vertical; known ones set the units");
  add_read(
      command, "--units",
      [&request](const std::string& text) { return read_units(text, request.reference); },
      "a unit, nor two with a colon between",
      "Units of x and y and of heights: metre, foot, us-foot or degree; degree:metre, or :foot for "
      "heights alone. If not given: as the file or its codes say; heights as x and y");
  command.add_option("--source-text", request.source_text, "Where the terrain comes from");
  command
      .add_option("--date", request.date, "Of the source: 2026, 2026-11 or 2026-11-21 (ISO 8601)")
      ->check([](const std::string& text) {
        return is_iso_date(text) ? std::string() : text + " is not a date such as 2026-11-21";
      });
  command.add_option("--lineage", request.lineage, "What was done to the source before");
}

// One of some names for values.
template <class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Value& value,
                        std::map<std::string, Value> choices, const std::string& wanted,
                        const std::string& description) {
  const auto read = [&value, choices = std::move(choices)](const std::string& text) {
    const auto found = choices.find(text);
    if (found != choices.end()) value = found->second;
    return found != choices.end();
  };
  return add_read(command, name, read, wanted, description);
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

using Action = std::function<void()>;

void add_encode_options(CLI::App& command, const std::shared_ptr<EncodeRequest>& request) {
  add_terrain(command, request->input, request->preparation);
  CLI::Option* const bound =
      add_decimal(command, "--max-error", request->lattice.max_error,
                  "Keep every height within this distance, in the terrain's unit");
  CLI::Option* const vertices =
      command
          .add_option("--max-vertices", request->max_vertices,
                      "Keep the smallest --max-error that so many vertices can")
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
      .add_option("--degree", request->effort.degree,
                  "Most triangles around a vertex when it is added")
      ->check(CLI::Range(kMinDegree, kMaxDegree))
      ->capture_default_str();
  add_decoding(command, request->effort.decoding);
  add_preparation(command, request->preparation);
  add_notes(command, *request);
}

void check_encode_options(EncodeRequest& request) {
  if (request.lattice.never_below && !request.lattice.max_error && request.max_bytes == 0) {
    throw CLI::ValidationError("--never-below", "needs --max-error or --max-bytes");
  }
  request.lattice.water_level = request.preparation.water_level;
}

void add_encode(CLI::App& app, Action& action) {
  auto request = std::make_shared<EncodeRequest>();
  CLI::App& command = *app.add_subcommand("encode", "Turn a terrain into a stream, or a pack");
  add_encode_options(command, request);
  add_output(command, request->output);
  const auto read = [request](const std::string& text) {
    return read_tiles(text, request->tiles.emplace());
  };
  add_read(command, "--tiles", read, "FROM:TO, as 0:99",
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
  command.add_option("shards", request->shards, "What encode --tiles wrote, all of it")
      ->required()
      ->type_name(kFile);
  add_output(command, request->output);
  command.callback(
      [request, &action] { action = [request] { run_merge(request->shards, request->output); }; });
}

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
  command.add_flag("--force", request->force, "Write a file that can take more than 1 GB");
  command.add_flag("--lattice", request->lattice, "Write the lattice's integers")->excludes(like);
  command.callback([request, &action] {
    request->like_preparation.band = 1;  // all bands have the same posts
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
  command.footer(
      "A word stands where there is no height: outside, void or damaged. For a place on the "
      "command "
      "line their exit codes are 5, 6 and 7; 7 also if the file is damaged.");
  command.callback([request, x, &action, &code] {
    if (x->count() != 0) {
      request->place = parse_place(request->x + ' ' + request->y);
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
      ->check(CLI::Range(2u, 16384u))
      ->capture_default_str();
  command.add_option("--seed", request->seed, "Another terrain for each")->capture_default_str();
  command.callback([request, &action] {
    action = [request] { run_fractal(request->output, request->size, request->seed); };
  });
}

void add_render(CLI::App& app, Action& action) {
  auto request = std::make_shared<RenderRequest>();
  CLI::App& command =
      *app.add_subcommand("render", "Draw a terrain (.png, .svg), or a page that shows it (.html)");
  add_stream(command, request->input);
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
  command.add_flag("--world-file", request->world,
                   "Write beside the picture, as .pgw, where its map lies");
  command.add_option("--source", request->source, "Draw a map of the errors against this terrain")
      ->type_name(kFile);
  add_preparation(command, request->preparation);
  command.callback([request, &action] { action = [request] { run_render(*request); }; });
}

// Prints what the command line accepts, for man or a shell.
void add_document(CLI::App& parent, const std::string& name, const CLI::App& app, Action& action,
                  std::string (*writer)(const CommandText& program)) {
  parent.add_subcommand(name)->group(kHidden)->callback(
      [&app, &action, writer] { action = [&app, writer] { print(writer(describe(app))); }; });
}

// For those who package the program; they tell what is defined by the time they run.
void add_documents(CLI::App& app, Action& action) {
  add_document(app, "manual", app, action, manual);
  CLI::App& completion = *app.add_subcommand("completion")->group(kHidden)->require_subcommand(1);
  add_document(completion, "bash", app, action, bash_completion);
  add_document(completion, "zsh", app, action, zsh_completion);
}

// Prints one line, whatever the text, without asking for memory: there may be none.
int fail(const char* text, int code) {
  std::fputs(code == kInternal ? "microtin: internal fault, please report it: " : "microtin: ",
             stderr);
  for (std::string_view rest = text; !rest.empty();) {
    const size_t size = character_bytes(rest);
    const std::string_view character = rest.substr(0, std::max<size_t>(size, 1));
    const bool shown = size != 0 && !is_control(character);
    for (const char byte : character) {
      std::fprintf(stderr, shown ? "%c" : "\\x%02x", static_cast<unsigned char>(byte));
    }
    rest.remove_prefix(character.size());
  }
  std::fputc('\n', stderr);
  return code;
}

int run(int argc, char** argv) {
  CLI::App app("Terrain TINs for microcontrollers");
  Action action;
  int code = 0;
  app.set_version_flag("--version", versions(), "Print the versions of library and formats");
  app.require_subcommand(1);
  app.footer(kExitCodes);
  add_encode(app, action);
  add_plan(app, action);
  add_merge(app, action);
  add_decode(app, action);
  add_embed(app, action);
  add_height_command(app, action, code);
  add_info(app, action);
  add_verify(app, action);
  add_fractal(app, action);
  add_render(app, action);
  add_documents(app, action);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) return fail(error.what(), kUsage);
    std::ostringstream help;  // was asked for
    app.exit(error, help);
    print(help.str());
    return 0;
  }
  action();
  return code;
}

}  // namespace
}  // namespace microtin::cli

int main(int argc, char** argv) {
  namespace cli = microtin::cli;
  if (!cli::hold_closed_standard_files()) return cli::kFailed;
  for (const int ignored : {SIGXFSZ, SIGPIPE}) std::signal(ignored, SIG_IGN);  // errors like others
  cli::remove_leftovers_on_signals();
  try {
    return cli::run(argc, argv);
  } catch (const std::bad_alloc&) {
    return cli::fail("not enough memory", cli::kFailed);
  } catch (const cli::ReportLost& lost) {
    return cli::fail(lost.what(), cli::kReportLost);
  } catch (const std::logic_error& fault) {  // our own, and those that the library finds
    return cli::fail(fault.what(), cli::kInternal);
  } catch (const std::exception& error) {
    return cli::fail(error.what(), cli::kFailed);
  }
}
