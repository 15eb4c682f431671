// SPDX-License-Identifier: MIT
// Several files and folders as one terrain, and packs in shards: the command line, C++ and C make
// the same bytes.
#include "tests/support/files.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "microtin/encoder.h"
#include "microtin/encoder.hpp"
#include "microtin/surface.hpp"
#include "tests/support/members.hpp"
#include "tests/support/session.hpp"

namespace library = microtin::encoder;

namespace microtin::tests {
namespace {

using Bytes = std::vector<uint8_t>;

// Writes cells whose posts overlap by one column, a coarse cell next to them, and two files of
// points.
class Files {
 public:
  Files() {
    std::filesystem::create_directory(session.folder() + "/cells");
    session.write("cells/w.asc", cell(0, 26, 1, 21));
    session.write("cells/e.asc", cell(25, 26, 1, 21));
    session.write("north.asc", cell(0, 26, 2, 11, 22));
    session.write("cells/note.txt", "no points\n");
    session.write("a.xyz", points(0));
    session.write("b.xyz", points(300));
  }

  std::string path(const std::string& name) const { return session.folder() + "/" + name; }

  std::vector<std::string> paths(const std::vector<std::string>& names) const {
    std::vector<std::string> all;
    all.reserve(names.size());
    for (const std::string& name : names) all.push_back(path(name));
    return all;
  }

  Session session;

 private:
  static std::string cell(int x, int columns, int step, int rows, int y = 0) {
    std::string text = "ncols " + std::to_string(columns) + "\nnrows " + std::to_string(rows) +
                       "\nxllcenter " + std::to_string(x) + "\nyllcenter " + std::to_string(y) +
                       "\ncellsize " + std::to_string(step) + "\nnodata_value -9\n";
    for (int row = rows - 1; row >= 0; --row) {
      for (int column = 0; column < columns; ++column) {
        const double east = x + step * column, north = y + step * row;
        const double z = 90 + 40 * std::sin(east * 0.21) * std::cos(north * 0.17) + 3 * column % 4;
        text += row == 3 && column == 9 ? "-9 " : std::to_string(std::lround(z)) + ' ';
      }
      text += '\n';
    }
    return text;
  }

  static std::string points(int first) {
    std::string text;
    for (int i = first; i < first + 300; ++i) {
      const int x = i * 7919 % 613, y = i * 7907 % 509;
      text += std::to_string(x) + ' ' + std::to_string(y) + ' ' +
              std::to_string(std::lround(20 * std::sin(x * 0.02) + y * 0.1)) + '\n';
    }
    return text;
  }
};

library::Options options() {
  library::Options options;
  options.max_error = "2";
  options.units = "metre";
  return options;
}

microtin_options options_in_c() {
  microtin_options options{};
  options.size = sizeof options;
  options.max_error = "2";
  options.units = "metre";
  return options;
}

struct SourceInC {
  explicit SourceInC(const std::vector<std::string>& paths) {
    std::vector<const char*> names;
    names.reserve(paths.size());
    for (const std::string& path : paths) names.push_back(path.c_str());
    REQUIRE_MESSAGE(
        microtin_source_from_files(names.data(), names.size(), &source) == MICROTIN_STATUS_OK,
        microtin_last_error());
  }
  ~SourceInC() { microtin_source_free(source); }
  SourceInC(const SourceInC&) = delete;
  SourceInC& operator=(const SourceInC&) = delete;

  microtin_source* source = nullptr;
};

Bytes stream_in_c(const microtin_source* source) {
  const microtin_options options = options_in_c();
  uint8_t* bytes = nullptr;
  uint64_t size = 0;
  REQUIRE_MESSAGE(
      microtin_encode_stream(source, &options, &bytes, &size, nullptr) == MICROTIN_STATUS_OK,
      microtin_last_error());
  Bytes made(bytes, bytes + size);
  microtin_bytes_free(bytes);
  return made;
}

void check_doors(const Files& files, const std::vector<std::string>& names) {
  std::string command = "encode --units metre --max-error 2";
  for (const std::string& name : names) command += " " + name;
  CAPTURE(command);
  REQUIRE(files.session.run(command + " -o t.mtin").code == 0);
  REQUIRE(files.session.run(command + " -o t.mtp").code == 0);
  const Bytes stream = bytes_of_file(files.path("t.mtin")),
              pack = bytes_of_file(files.path("t.mtp"));

  const auto terrain = library::SourceTerrain::from_files(files.paths(names));
  CHECK((library::encode_stream(terrain, options()).bytes == stream));
  const library::Report report = library::encode_pack(terrain, options(), files.path("cpp.mtp"));
  CHECK((bytes_of_file(files.path("cpp.mtp")) == pack));
  CHECK(report.samples > 0);
  CHECK(report.samples == library::encode_stream(terrain, options()).report.samples);

  const SourceInC in_c(files.paths(names));
  CHECK((stream_in_c(in_c.source) == stream));
  const microtin_options given = options_in_c();
  CHECK(microtin_encode_pack(in_c.source, &given, files.path("c.mtp").c_str(), nullptr) ==
        MICROTIN_STATUS_OK);
  CHECK((bytes_of_file(files.path("c.mtp")) == pack));
}

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return library::message_of(error, [](const std::string& name) { return name; });
  }
  return "nothing is refused";
}

}  // namespace

TEST_CASE("files: several files and folders are one terrain by the command line, C++ and C") {
  const Files files;
  check_doors(files, {"cells/e.asc"});
  check_doors(files, {"cells"});
  check_doors(files, {"north.asc", "cells"});
  check_doors(files, {"a.xyz", "b.xyz"});
}

TEST_CASE("files: one file is what from_file reads") {
  const Files files;
  const std::string path = files.path("north.asc");
  const auto one = library::SourceTerrain::from_file(path);
  const auto same = library::SourceTerrain::from_files({path});
  CHECK((library::encode_stream(one, options()).bytes ==
         library::encode_stream(same, options()).bytes));
  library::encode_pack(one, options(), files.path("one.mtp"));
  library::encode_pack(same, options(), files.path("same.mtp"));
  CHECK((bytes_of_file(files.path("one.mtp")) == bytes_of_file(files.path("same.mtp"))));
}

TEST_CASE("files: bounds of posts and the options that are files hold for all of them") {
  const Files files;
  auto terrain = library::SourceTerrain::from_files({files.path("cells")});
  library::RasterData bounds;
  bounds.columns = 51;
  bounds.rows = 21;
  bounds.heights.assign(51 * 21, 1);
  bounds.wkt = "";
  bounds.x = bounds.y = {0, 1, 1};
  terrain.set_error_map(bounds);
  library::Options wanted = options();
  wanted.max_error = "9";
  CHECK(library::encode_stream(terrain, wanted).report.max_error <= "1");
  CHECK(library::encode_pack(terrain, wanted, files.path("t.mtp")).max_error <= "1");
  files.session.write(
      "area.geojson",
      R"({"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]]]})");
  wanted.area = files.path("area.geojson");
  CHECK(library::encode_stream(terrain, wanted).report.samples == 99);
  CHECK(library::encode_pack(terrain, wanted, files.path("t.mtp")).samples == 99);
}

TEST_CASE("files: texts of GeoJSON stand for files that options name") {
  const Files files;
  const std::string polygon =
      R"({"type": "Polygon", "coordinates": [[[0, 0], [9, 0], [9, 9], [0, 9], [0, 0]]]})";
  const std::string line = R"({"type": "LineString", "coordinates": [[0, 0], [20, 15]]})";
  auto terrain = library::SourceTerrain::from_files({files.path("cells")});
  const library::SourceTerrain before = terrain;
  terrain.set_features("area.gpkg", polygon);
  terrain.set_features("lines.shp", line);
  terrain.set_features("lines.shp", line);  // again
  library::Options wanted = options();
  wanted.max_error = "9";
  wanted.area = "area.gpkg";
  CHECK(library::encode_stream(terrain, wanted).report.samples == 99);
  CHECK(library::encode_pack(terrain, wanted, files.path("t.mtp")).samples == 99);
  CHECK(contains(refusal([&] { library::encode_stream(before, wanted); }), "area.gpkg: "));
  terrain.set_features("area.gpkg", "{}");
  CHECK(contains(refusal([&] { library::encode_stream(terrain, wanted); }), "area.gpkg:1: is not"));
  wanted.area.clear();
  const auto plain = library::encode_stream(terrain, wanted).bytes;
  wanted.breaklines = "lines.shp";
  const auto lined = library::encode_stream(terrain, wanted).bytes;
  CHECK((lined != plain));
  files.session.write("lines.geojson", line);
  wanted.breaklines = files.path("lines.geojson");
  CHECK((library::encode_stream(before, wanted).bytes == lined));
}

TEST_CASE("files: what is no terrain is refused, and errors name the file") {
  const Files files;
  std::filesystem::create_directory(files.path("empty"));
  CHECK(contains(refusal([] { library::SourceTerrain::from_files({}); }), "no file"));
  CHECK(contains(refusal([&] { library::SourceTerrain::from_files({files.path("empty")}); }),
                 "empty: holds no terrain file"));
  const auto absent =
      library::SourceTerrain::from_files({files.path("north.asc"), files.path("nosuch.asc")});
  for (const auto& encode : std::vector<std::function<void()>>{
           [&] { library::encode_stream(absent, options()); },
           [&] { library::encode_pack(absent, options(), files.path("t.mtp")); },
           [&] { library::plan_shards(absent, options(), 2); }}) {
    CHECK(contains(refusal(encode), "nosuch.asc: cannot be read"));
  }
  CHECK(!std::filesystem::exists(files.path("t.mtp")));
  microtin_source* source = nullptr;
  const char* const null = nullptr;
  CHECK(microtin_source_from_files(&null, 1, &source) == MICROTIN_STATUS_REJECTED);
  CHECK(microtin_source_from_files(nullptr, 1, &source) == MICROTIN_STATUS_REJECTED);
  CHECK(microtin_source_from_files(nullptr, 0, &source) == MICROTIN_STATUS_REJECTED);
}

TEST_CASE("files: shards by C++ and C are those of the command line, and join to one pack") {
  const Files files;
  const std::string command = "cells --units metre --max-error 2 --tile-vertices 20";
  REQUIRE(files.session.run("encode " + command + " -o one.mtp").code == 0);
  const std::string plan = files.session.run("plan " + command + " --shards 3").out;
  library::Options wanted = options();
  wanted.tile_vertices = 20;
  const auto terrain = library::SourceTerrain::from_files({files.path("cells")});
  const std::vector<library::Shard> shards = library::plan_shards(terrain, wanted, 3);
  REQUIRE(shards.size() == 3);

  microtin_options given = options_in_c();
  given.tile_vertices = 20;
  const SourceInC in_c({files.path("cells")});
  microtin_shard all[4]{};
  all[0].size = sizeof all[0];
  uint32_t planned = 0;
  REQUIRE(microtin_plan_shards(in_c.source, &given, 3, all, &planned) == MICROTIN_STATUS_OK);
  REQUIRE(planned == 3);
  CHECK(text_of(members_of("encoder/include/microtin/encoder.h", "microtin_shard")) ==
        "first_tile last_tile size tile_size z_step ");

  std::string lines;
  std::vector<std::string> parts;
  uint64_t vertices = 0;
  for (size_t i = 0; i < shards.size(); ++i) {
    const library::Shard& shard = shards[i];
    CHECK(all[i].size == sizeof all[i]);
    CHECK(all[i].tile_size == shard.tile_size);
    CHECK(all[i].z_step == shard.z_step);
    CHECK(all[i].first_tile == shard.first_tile);
    CHECK(all[i].last_tile == shard.last_tile);
    const std::string range =
        std::to_string(shard.first_tile) + ":" + std::to_string(shard.last_tile);
    lines += "--tile-size " + std::to_string(shard.tile_size) + " --z-step " + shard.z_step +
             " --shard " + range + "\n";
    parts.push_back(files.path(std::to_string(i) + ".shard"));
    const library::Report made = library::encode_shard(terrain, wanted, shard, parts.back());
    CHECK(made.tiles == shard.last_tile - shard.first_tile + 1);
    vertices += made.vertices;
    microtin_report report{};
    report.size = sizeof report;
    const std::string by_c = files.path("c.shard");
    REQUIRE(microtin_encode_shard(in_c.source, &given, &all[i], by_c.c_str(), &report) ==
            MICROTIN_STATUS_OK);
    CHECK(report.vertices == made.vertices);
    CHECK((bytes_of_file(by_c) == bytes_of_file(parts.back())));
  }
  CHECK(lines == plan);
  std::swap(parts[0], parts[2]);
  const library::Report merged = library::merge_packs(parts, files.path("merged.mtp"));
  CHECK((bytes_of_file(files.path("merged.mtp")) == bytes_of_file(files.path("one.mtp"))));
  CHECK(merged.bytes == bytes_of_file(files.path("one.mtp")).size());
  CHECK(merged.samples == 0);
  CHECK(vertices >= merged.vertices);
  const char* const names[] = {parts[0].c_str(), parts[1].c_str(), parts[2].c_str()};
  const std::string by_c = files.path("c.mtp");
  REQUIRE(microtin_merge_packs(names, 3, by_c.c_str(), nullptr) == MICROTIN_STATUS_OK);
  CHECK((bytes_of_file(by_c) == bytes_of_file(files.path("one.mtp"))));
  CHECK(microtin_merge_packs(names, 2, by_c.c_str(), nullptr) == MICROTIN_STATUS_REJECTED);
  CHECK(microtin_merge_packs(nullptr, 0, by_c.c_str(), nullptr) == MICROTIN_STATUS_REJECTED);
}

TEST_CASE("files: what has no shards is refused") {
  const Files files;
  const auto points = library::SourceTerrain::from_files({files.path("a.xyz")});
  CHECK(contains(refusal([&] { library::plan_shards(points, options(), 2); }), "points"));
  const auto raster = library::SourceTerrain::from_files({files.path("cells")});
  CHECK(contains(refusal([&] { library::plan_shards(raster, options(), 0); }), "at least one"));
  const std::string path = files.path("t.shard");
  CHECK(contains(refusal([&] {
                   library::encode_shard(raster, options(), {20, "1", 5, 4}, path);
                 }),
                 "before its first tile"));
  CHECK(contains(refusal([&] {
                   library::encode_shard(raster, options(), {20, "1", 900, 901}, path);
                 }),
                 "beyond the last tile"));
  CHECK(contains(refusal([&] {
                   library::encode_shard(points, options(), {20, "1", 0, 1}, path);
                 }),
                 "points"));
  CHECK(!std::filesystem::exists(path));
  const SourceInC in_c({files.path("cells")});
  const microtin_options given = options_in_c();
  microtin_shard shard{};
  uint32_t planned = 0;
  CHECK(microtin_plan_shards(in_c.source, &given, 1, &shard, &planned) == MICROTIN_STATUS_REJECTED);
  CHECK(microtin_encode_shard(in_c.source, &given, &shard, path.c_str(), nullptr) ==
        MICROTIN_STATUS_REJECTED);
}

}  // namespace microtin::tests
