// SPDX-License-Identifier: MIT
// The commands of the microtin program: what each accepts, and what it does once its options are
// read.
#ifndef MICROTIN_ENCODER_CLI_COMMANDS_HPP
#define MICROTIN_ENCODER_CLI_COMMANDS_HPP

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/export/grid.hpp"
#include "encoder/import/prepared_terrain.hpp"
#include "encoder/layers.hpp"
#include "encoder/picture/palette.hpp"
#include "encoder/product/encode_pack.hpp"
#include "encoder/product/options.hpp"
#include "microtin/encoder.hpp"
#include "microtin/microtin.h"

namespace CLI {
class App;
}

namespace microtin::cli {

// Each function defines a command. Parsing sets `action` to the command that is named.
using Action = std::function<void()>;

void add_encode(CLI::App& app, Action& action);
void add_update(CLI::App& app, Action& action);
void add_plan(CLI::App& app, Action& action);
void add_merge(CLI::App& app, Action& action);
void add_cut(CLI::App& app, Action& action);
void add_decode(CLI::App& app, Action& action);
void add_embed(CLI::App& app, Action& action);
void add_height_command(CLI::App& app, Action& action, int& code);  // its exit code
void add_profile(CLI::App& app, Action& action, int& code);         // its exit code
void add_info(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_diff(CLI::App& app, Action& action);
void add_verify(CLI::App& app, Action& action);
void add_fractal(CLI::App& app, Action& action);
void add_render(CLI::App& app, Action& action);

// The command help, with the pages of the commands that are defined before it.
void add_help(CLI::App& app, Action& action);

// Documents for packages of the program, about the commands that are defined when they are printed.
void add_documents(CLI::App& app, Action& action);

// What the commands do. All throw Error.

// A terrain, and the options of the library that say how it is read.
struct TerrainRequest {
  std::string source;
  Preparation preparation;  // what only the command line sets of it
  encoder::Options options;
};

struct EncodeRequest : TerrainRequest {
  std::string output;
  std::optional<TileRange> tiles;  // a shard of a pack, with these
  uint64_t device_ram = 0;         // as in EncodeOptions, and so are the next two
  Adapter adapter = Adapter::kNone;
  std::string resume;
};

void run_encode(const EncodeRequest& request);

// Prints, for each shard, a line with the options that encode it as a single run would.
void run_plan(const EncodeRequest& request, uint32_t shards);

struct UpdateRequest : EncodeRequest {
  std::string old;                     // the pack
  std::optional<BoundScope> bound_at;  // where its bound is kept; nothing: where it is now
};

// Writes a pack in which only the tiles are new that the old one does not have for the terrain.
void run_update(const UpdateRequest& request);

void run_merge(const std::vector<std::string>& shards, const std::string& output);

struct DecodeRequest {
  std::string input;
  std::string output;
  bool lattice = false;          // integers instead of real coordinates
  bool force = false;            // write more than 1 GB, read more than a stream's vertices
  std::optional<Decimal> cell;   // of a grid
  std::optional<Extent> extent;  // where the grid's posts lie
  std::string like;              // the raster whose posts the grid has; empty: none
  Preparation like_preparation;  // how that is read
};

void run_decode(const DecodeRequest& request);

void run_embed(const std::string& input, const std::string& output);

// A place in the terrain's units, or in steps of its lattice.
struct Place {
  Decimal x, y;
};

// Two numbers with blanks, a comma or a semicolon between; nothing for any other text. Decimals
// are kept as the host's queries take them, or a device's.
std::optional<Place> parse_place(std::string_view text, bool for_device);

struct HeightRequest {
  std::string input;
  std::optional<Place> place;  // else those on standard input, one a line
  bool lattice = false;
  bool device = false;  // answers as a device does
};

// Where a place has no height, and where the file is damaged: exit codes.
constexpr int kOutside = 5, kInVoid = 6, kDamaged = 7;

// "outside", "void" or "damaged", and these codes; 0 where there are heights.
const char* word_for(microtin_query_result answer);
int code_for(microtin_query_result answer);

// The code that `work` returns; if a file is damaged, prints the error and returns kDamaged.
int code_unless_damaged(const std::function<int()>& work);

// Prints heights, or words where there are none. Returns the exit code.
int run_height(const HeightRequest& request);

struct ProfileRequest {
  std::string input;
  std::string output;  // empty: none
  Place from, to;
  std::optional<Decimal> from_height, to_height;      // above the ground
  std::optional<Decimal> from_altitude, to_altitude;  // above the datum
  std::optional<Decimal> frequency;                   // in MHz
  uint32_t zone_share = 60;                           // percent
  double earth_factor = 4.0 / 3;
  uint32_t samples = 0;  // 0: all places of the profile
  uint32_t width = 1024;
  bool safe = false;
  bool json = false;
};

// Prints what a line crosses, and whether its ends see each other. Returns the exit code.
int run_profile(const ProfileRequest& request);

void run_info(const std::string& input, bool json);

// Throws Error, after the report, if a tile cannot be used.
void run_check(const std::string& input, bool as_json);

// Throws Error, after the report, if a tile differs.
void run_diff(const std::string& first, const std::string& second, bool as_json);

// The terrain is read as the stream was encoded; breaklines must be edges.
struct VerifyRequest : TerrainRequest {
  std::string input;
  bool never_below = false;
  bool json = false;
};

// Throws Error, after the report, if the stream fails its promises.
void run_verify(const VerifyRequest& request);

void run_fractal(const std::string& output, uint32_t size, uint64_t seed);

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

void run_render(const RenderRequest& request);

}  // namespace microtin::cli

#endif
