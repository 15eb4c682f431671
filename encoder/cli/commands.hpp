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

#include "encoder/import/prepared_terrain.hpp"
#include "encoder/layers.hpp"
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

// A place in the terrain's units, or in steps of its lattice.
struct Place {
  Decimal x, y;
};

// Two numbers with blanks, a comma or a semicolon between; nothing for any other text. Decimals
// are kept as the host's queries take them, or a device's.
std::optional<Place> parse_place(std::string_view text, bool for_device);

// Where a place has no height, and where the file is damaged: exit codes.
constexpr int kOutside = 5, kInVoid = 6, kDamaged = 7;

// "outside", "void" or "damaged", and these codes; 0 where there are heights.
const char* word_for(microtin_query_result answer);
int code_for(microtin_query_result answer);

// The code that `work` returns; if a file is damaged, prints the error and returns kDamaged.
int code_unless_damaged(const std::function<int()>& work);

}  // namespace microtin::cli

#endif
