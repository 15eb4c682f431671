// SPDX-License-Identifier: MIT
// Every limit of a number that is given: the last that is taken and the first that is not, on the
// command line, in C++ and in C.
#include <doctest/doctest.h>

#include <cstdint>
#include <functional>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "microtin/encoder.h"
#include "microtin/encoder.hpp"
#include "tests/support/join.hpp"
#include "tests/support/members.hpp"
#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;
namespace library = microtin::encoder;

namespace {

struct CommandLimit {
  std::string command, option;
  std::vector<std::string> taken, refused;
};

// 3 vertices with 16-bit numbers, 2^24 with 32-bit ones.
std::string ram(uint64_t vertices, unsigned bits) {
  return std::to_string(MICROTIN_MESH_BYTES_FOR(vertices, bits) +
                        MICROTIN_DECODER_BYTES_FOR(vertices, bits));
}

std::string less(const std::string& number) {
  return std::to_string(std::stoull(number) - 1);
}

std::string more(const std::string& number) {
  return std::to_string(std::stoull(number) + 1);
}

std::vector<CommandLimit> command_limits() {
  const std::string least = ram(3, 16), most = ram(1 << 24, 32);
  return {
      {"", "--max-vertices", {"3", "16777216"}, {"2", "16777217", "-1", "3.5"}},
      {"", "--max-bytes", {"1", "4294967295"}, {"0", "4294967296", "-1"}},
      {"", "--tile-vertices", {"16", "16777216"}, {"15", "16777217"}},
      {"", "--tile-size", {"1", "65535"}, {"0", "65536"}},
      {"", "--device-ram", {least, most}, {less(least), more(most)}},
      {"", "--max-degree", {"6", "32"}, {"5", "33"}},
      {"", "--fill-voids", {"0", "4294967295"}, {"4294967296", "-1"}},
      {"",
       "--epsg",
       {"1", "4294967295", "1:1", "1:4294967295"},
       {"0", "4294967296", "1:0", "1:4294967296"}},
      {"", "--classes", {"0", "255", "0,255"}, {"256", "-1"}},
      {"", "--max-error", {"0", "0.000000001"}, {"-0.000000001"}},
      {"", "--z-step", {"0.000000001"}, {"-1"}},
      {"", "--xy-step", {"0.000000001"}, {"-1"}},
      {"", "--water-level", {"-9", "9"}, {"x"}},
      {"", "--route-width", {"0 --route none.geojson"}, {"-1 --route none.geojson"}},
      {"", "--route-edge-error", {"0", "0.000000001"}, {"-1"}},
      {"encode", "--shard", {"0:0", "0:4294967295"}, {"1:0", "0:4294967296"}},
      {"plan", "--shards", {"1", "4294967295"}, {"0", "4294967296"}},
      {"fractal", "--size", {"2", "8193"}, {"1", "8194"}},
      {"fractal", "--seed", {"0", "18446744073709551615"}, {"18446744073709551616", "-1"}},
      {"render", "--width", {"200", "8192"}, {"199", "8193"}},
      {"render", "--first-bytes", {"1", "4294967295"}, {"0", "4294967296"}},
      {"render", "--fill-voids", {"0", "4294967295"}, {"4294967296"}},
      {"render", "--contours", {"0.000000001", "auto"}, {"0", "-1"}},
      {"verify", "--fill-voids", {"0", "4294967295"}, {"4294967296"}},
      {"decode", "--cell", {"0.000000001"}, {"0", "-1"}},
  };
}

// The command with files that are not there: it fails by these, unless before by its options.
std::string words_of(const std::string& command) {
  if (command == "encode") return "encode none.asc -o none/o.mtin ";
  if (command == "plan") return "plan none.asc --max-error 1 --tile-vertices 60 ";
  if (command == "verify") return "verify none.mtin none.asc ";
  if (command == "fractal") return "fractal -o none/o.asc ";
  return command + " none.mtin -o none/o.png ";
}

bool is_taken(const Session& session, const CommandLimit& row, const std::string& value) {
  const std::string command = row.command.empty() ? "encode" : row.command;
  const int code = session.run(words_of(command) + row.option + "=" + value).code;
  CHECK((code == 1 || code == 2));
  return code == 1;
}

// --- The library ---------------------------------------------------------------------------------

library::SourceTerrain terrain_of(uint32_t columns, uint32_t rows, int64_t height = 0,
                                  int decimals = 0) {
  library::RasterData posts;
  posts.columns = columns;
  posts.rows = rows;
  posts.heights.assign(size_t{columns} * rows, height);
  posts.decimals = decimals;
  return library::SourceTerrain(std::move(posts));
}

std::string error_of(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

struct Limit {
  std::string message;  // of what is beyond it
  uint32_t library::Options::*cpp;
  uint32_t microtin_options::*c;
  std::vector<uint32_t> taken, refused;
};

const std::vector<Limit> kLimits = {
    {"max_degree: use 6 to 32, or 0 for the default",
     &library::Options::max_degree,
     &microtin_options::max_degree,
     {0, 6, 32},
     {5, 33, UINT32_MAX}},
    {"max_vertices: use 3 to 16777216, or 0 for the default",
     &library::Options::max_vertices,
     &microtin_options::max_vertices,
     {0, 3, 1u << 24},
     {1, 2, (1u << 24) + 1}},
    {"effort: 0 .. 3", nullptr, &microtin_options::effort, {0, 3}, {4}},
    {"coding: 0 .. 3", nullptr, &microtin_options::coding, {0, 3}, {4}},
    {"bound_at: 0 .. 3", nullptr, &microtin_options::bound_at, {0, 3}, {4}},
    {"duplicates: 0 .. 4", nullptr, &microtin_options::duplicates, {0, 4}, {5}},
};

std::string error_in_c(const microtin_options& options) {
  static const double corners[] = {0, 0, 0, 9, 0, 0, 0, 9, 0, 9, 9, 0};
  const microtin_point_data square{sizeof(microtin_point_data), 4, corners, ""};
  microtin_source* terrain = nullptr;
  REQUIRE(microtin_source_from_points(&square, &terrain) == MICROTIN_STATUS_OK);
  uint8_t* bytes = nullptr;
  uint64_t size = 0;
  const bool done =
      microtin_encode_stream(terrain, &options, &bytes, &size, nullptr) == MICROTIN_STATUS_OK;
  microtin_bytes_free(bytes);
  microtin_source_free(terrain);
  return done ? "" : microtin_last_error();
}

}  // namespace

TEST_CASE("limits: the last number is taken, the next is not") {
  const Session session;
  for (const CommandLimit& row : command_limits()) {
    CAPTURE(row.option);
    for (const std::string& value : row.taken) CHECK_MESSAGE(is_taken(session, row, value), value);
    for (const std::string& value : row.refused)
      CHECK_MESSAGE(!is_taken(session, row, value), value);
  }
}

TEST_CASE("limits: no option that takes a number is without a row") {
  const Session session;
  for (const std::string command : {"encode", "plan", "decode", "render", "fractal", "verify"}) {
    const std::string help = session.run(command + " --help").out;
    const std::regex line("\n  (--[a-z-]+) (?:N|BYTES|METRES|DISTANCE|auto\\|METRES)\\s");
    for (std::sregex_iterator at(help.begin(), help.end(), line), end; at != end; ++at) {
      const std::string option = (*at)[1];
      bool found = option == "--band";  // in a program with GDAL alone
      for (const CommandLimit& row : command_limits()) {
        found |= row.option == option && (row.command == command || row.command.empty());
      }
      CHECK_MESSAGE(found, join({command, " ", option}));
    }
  }
}

TEST_CASE("limits: of numbers in C++ and C") {
  for (const Limit& limit : kLimits) {
    CAPTURE(limit.message);
    const auto expect = [&](uint32_t value, bool is_taken) {
      CAPTURE(value);
      microtin_options options{};
      options.size = sizeof options;
      options.*limit.c = value;
      CHECK((error_in_c(options) == limit.message) == !is_taken);
      if (limit.cpp == nullptr) return;
      library::Options same;
      same.*limit.cpp = value;
      CHECK((error_of([&] { encode_stream(terrain_of(3, 3), same); }) == limit.message) ==
            !is_taken);
    };
    for (const uint32_t value : limit.taken) expect(value, true);
    for (const uint32_t value : limit.refused) expect(value, false);
  }
}

TEST_CASE("limits: vertices of tiles in C++ and C") {
  const Session session;
  const std::string path = session.folder() + "/o.mtp",
                    message = "tile_vertices: use 16 to 16777216";
  for (const auto& row :
       {std::pair(0u, true), std::pair(1u, false), std::pair(15u, false), std::pair(16u, true),
        std::pair(1u << 24, true), std::pair((1u << 24) + 1, false)}) {
    const uint32_t value = row.first;
    const bool is_taken = row.second;
    CAPTURE(value);
    library::Options options;
    options.max_error = "1";
    options.tile_vertices = value;
    const auto encode = [&] { encode_pack(terrain_of(9, 9), options, path); };
    CHECK((error_of(encode).find(message) == 0) == !is_taken);
  }
}

namespace {

std::string flat_grid(uint32_t columns, uint32_t rows) {
  std::string text = "ncols " + std::to_string(columns) + "\nnrows " + std::to_string(rows) +
                     "\nxllcenter 0\nyllcenter 0\ncellsize 1\n";
  for (uint64_t post = 0; post < uint64_t{columns} * rows; ++post) text += "1 ";
  return text;
}

}  // namespace

TEST_CASE("limits: 2^20 tiles of a pack of a raster, at every door" * kSlow) {
  const std::string message = "the pack has 1049600 tiles of 1 steps, more than 1048576; ";
  const Session session;
  const std::string options = " --units metre --max-error 1 --fast --tile-size 1";
  session.write("more.asc", flat_grid(1026, 1025));
  CHECK(contains(session.failure("encode more.asc -o o.mtp" + options), message));
  CHECK(contains(session.failure("encode more.asc --shard 0:0 -o o.shard" + options), message));
  CHECK(contains(session.failure("plan more.asc --shards 2" + options), message));
  session.write("most.asc", flat_grid(1025, 1025));
  CHECK(contains(session.run("plan most.asc --shards 2" + options).out, "524288:1048575"));
  library::Options pack;
  pack.max_error = "1";
  pack.tile_size = 1;
  CHECK(contains(
      error_of([&] { encode_pack(terrain_of(1026, 1025), pack, session.folder() + "/o.mtp"); }),
      message));
}

TEST_CASE("limits: of posts, their heights and their decimals") {
  constexpr int64_t kMost = 1000000000000000000;
  library::Options options;
  options.max_error = "1";
  options.effort = library::SearchEffort::kFast;
  const auto error_with = [&](uint32_t columns, uint32_t rows) {
    return error_of([&] { encode_stream(terrain_of(columns, rows), options); });
  };
  CHECK(error_with(2, 2).empty());
  CHECK(!error_with(1, 2).empty());
  CHECK(!error_with(2, 1).empty());
  CHECK(error_with(65536, 2).empty());
  CHECK(!error_with(65537, 2).empty());
  CHECK(error_with(2, 65536).empty());
  CHECK(!error_with(2, 65537).empty());
  for (const int64_t sign : {-1, 1}) {
    CHECK(error_of([&] { terrain_of(2, 2, sign * kMost); }).empty());
    CHECK(error_of([&] { terrain_of(2, 2, sign * (kMost + 1)); }) ==
          "a height is beyond 10^18; use fewer decimals");
    for (const size_t axis : {0u, 1u, 2u}) {
      library::PointCloudData points;
      points.points = {{0, 0, 0}};
      points.points[0][axis] = sign * kMost;
      CHECK(error_of([&] { (void)library::SourceTerrain{points}; }).empty());
      points.points[0][axis] += sign;
      CHECK(error_of([&] { (void)library::SourceTerrain{points}; }) ==
            "a coordinate is beyond 10^18; use fewer decimals");
    }
  }
  for (const auto& [decimals, message] :
       {std::pair(-1, "decimals: use 0 to 18"), std::pair(0, ""), std::pair(18, ""),
        std::pair(19, "decimals: use 0 to 18")}) {
    const int given = decimals;
    CHECK(error_of([&] { terrain_of(2, 2, 0, given); }) == message);
    library::PointCloudData points;
    points.xy_decimals = given;
    CHECK(error_of([&] { (void)library::SourceTerrain{points}; }) == message);
    points.xy_decimals = 0;
    points.z_decimals = given;
    CHECK(error_of([&] { (void)library::SourceTerrain{points}; }) == message);
  }
}
