// SPDX-License-Identifier: MIT
// Every option of an encoding, by every door: the command line, C++ and C make the same bytes of
// it, and other bytes than without it. An option without a row here fails.
#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <list>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "microtin/encoder.h"
#include "microtin/encoder.hpp"
#include "tests/support/files.hpp"
#include "tests/support/members.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;
namespace library = microtin::encoder;

namespace {

constexpr const char* kCpp = "encoder/include/microtin/encoder.hpp";
constexpr const char* kC = "encoder/include/microtin/encoder.h";

enum Kind : unsigned {
  kStream = 1,
  kPack = 2,
  kCloud = 4,
  kCloudPack = 8,
  kClouds = kCloud | kCloudPack,
  kPacks = kPack | kCloudPack,
  kAll = 15
};

bool is_pack(Kind kind) {
  return (kind & kPacks) != 0;
}

// All options of both kinds.
struct Setting {
  std::string flags;
  std::function<void(library::Options&)> cpp;
  std::function<void(microtin_options&)> c;
};

Setting operator+(const Setting& a, const Setting& b) {
  return {a.flags + ' ' + b.flags,
          [=](library::Options& wanted) {
            a.cpp(wanted);
            b.cpp(wanted);
          },
          [=](microtin_options& options) {
            a.c(options);
            b.c(options);
          }};
}

template <class Cpp, class CppValue, class C, class CValue>
Setting setting(const std::string& flags, Cpp cpp, CppValue cpp_value, C c, CValue c_value) {
  return {flags, [=](library::Options& wanted) { wanted.*cpp = cpp_value; },
          [=](microtin_options& options) { options.*c = c_value; }};
}

// A text or a number that is the same in C++ and C.
template <class Cpp, class C, class Value>
Setting setting(const std::string& flag, Cpp cpp, C c, Value value) {
  std::ostringstream words;
  words << flag << " '" << value << "'";
  return setting(words.str(), cpp, value, c, value);
}

struct Row {
  std::string name;  // of the member
  unsigned kinds;    // for which it makes a difference
  Setting set;
  Setting beside;  // without it, too
};

using W = library::Options;
using C = microtin_options;

Setting bound(const char* value) {
  return setting("--max-error", &W::max_error, &C::max_error, value);
}

Setting epsg(uint32_t code) {
  return setting("", &W::horizontal_epsg, code, &C::horizontal_epsg, code);
}

Setting surface(const std::string& word, library::SurfaceKind kind, uint32_t number) {
  return setting("--surface " + word, &W::surface, kind, &C::surface, number);
}

std::vector<Row> rows_of_notes() {
  using namespace microtin::encoder;
  const Setting two = bound("2");
  const auto height_code = setting("--epsg 25832:7837", &W::vertical_epsg, uint32_t{7837},
                                   &C::vertical_epsg, uint32_t{7837});
  return {
      {"surface", 0, surface("unknown", library::SurfaceKind::kUnknown, 0), two},
      {"surface", kAll, surface("ground", library::SurfaceKind::kGround, 1), two},
      {"surface", kAll, surface("top", library::SurfaceKind::kTop, 2), two},
      {"surface", kAll, surface("bed", library::SurfaceKind::kBed, 3), two},
      {"surface", kAll, surface("geoid", library::SurfaceKind::kGeoid, 4), two},
      {"surface", kAll, surface("obstacles", library::SurfaceKind::kObstacles, 5), two},
      {"horizontal_epsg", kAll, setting("--epsg", &W::horizontal_epsg, &C::horizontal_epsg, 25832u),
       two},
      {"vertical_epsg", kAll, epsg(25832) + height_code, two},
      {"source_name", kAll, setting("--source-name", &W::source_name, &C::source_name, "a survey"),
       two},
      {"date", kAll, setting("--date", &W::date, &C::date, "2026-11"), two},
      {"lineage", kAll, setting("--lineage", &W::lineage, &C::lineage, "thinned"), two},
      {"attribution", kAll,
       setting("--attribution", &W::attribution, &C::attribution, "\xC2\xA9 a survey"), two},
      {"license", kAll, setting("--license", &W::license, &C::license, "CC-BY-4.0"), two},
      {"valid", kAll, setting("--valid", &W::valid, &C::valid, "2024-01/.."), two},
      {"epoch", kAll, setting("--epoch", &W::epoch, &C::epoch, "2020.5"), two},
      {"source_accuracy", kAll,
       setting("--source-accuracy", &W::source_accuracy, &C::source_accuracy, "LE90 4"), two},
      {"digest", kStream | kCloud, setting("--digest", &W::digest, true, &C::digest, 1u), two},
      {"phases", kStream | kCloud, setting("--phases", &W::phases, true, &C::phases, 1u), two},
  };
}

// The path of a GeoJSON file.
const char* feature(const char* properties, const char* type, const char* coordinates) {
  static const Session session;
  static std::list<std::string> paths;
  const std::string name = std::to_string(paths.size()) + ".geojson";
  std::ostringstream text;
  text << R"({"type": "Feature", "properties": {)" << properties << R"(}, "geometry": {"type": ")"
       << type << R"(", "coordinates": )" << coordinates << "}}";
  session.write(name, text.str());
  return paths.emplace_back(session.folder() + "/" + name).c_str();
}

// Options that are files, with places over the raster and the points.
std::vector<Row> rows_of_files() {
  static const char* const square =
      "[[[300, 300], [560, 300], [560, 750], [300, 750], [300, 300]]]";
  static const char* const across = "[[30, 30], [540, 740]]";
  static const char* const bounds = feature(R"("max_error": 0.25)", "Polygon", square);
  static const char* const area = feature("", "Polygon", square);
  static const char* const line = feature("", "LineString", across);
  static const char* const tower = feature(R"("height": 30, "radius": 3)", "Point", "[530, 725]");
  const Setting two = bound("2");
  const Setting route = setting("--route", &W::route, &C::route, line) +
                        setting("--route-width", &W::route_width, &C::route_width, "60");
  return {
      {"error_map", kAll, setting("--error-map", &W::error_map, &C::error_map, bounds), two},
      {"area", kAll, setting("--area", &W::area, &C::area, area), two},
      {"route", kAll, route, two},
      {"route_width", kAll, route, two},
      {"route_edge_error", kAll,
       route + setting("--route-edge-error", &W::route_edge_error, &C::route_edge_error, "7"), two},
      {"breaklines", kStream | kPack | kCloud,
       setting("--breaklines", &W::breaklines, &C::breaklines, line), two},
      {"obstacles", kStream | kPack, setting("--obstacles", &W::obstacles, &C::obstacles, tower),
       bound("9")},
  };
}

std::vector<Row> rows() {
  using namespace microtin::encoder;
  const Setting two = bound("2"),
                nothing = {"", [](library::Options&) {}, [](microtin_options&) {}};
  const Setting fast = setting("--fast", &W::effort, SearchEffort::kFast, &C::effort, 1u);
  const Setting coarse = two + setting("--xy-step", &W::xy_step, &C::xy_step, "0.25");
  const auto duplicates = [](const char* flags, Duplicates rule, uint32_t number) {
    return setting(flags, &W::duplicates, rule, &C::duplicates, number);
  };
  const auto coding = [](const char* flags, Coding profile, uint32_t number) {
    return setting(flags, &W::coding, profile, &C::coding, number);
  };
  const auto bound_at = [](const char* flags, BoundAt places, uint32_t number) {
    return setting(flags, &W::bound_at, places, &C::bound_at, number);
  };
  std::vector<Row> all = {
      {"max_error", kAll, bound("1.5"), nothing},
      {"z_step", kAll, setting("--z-step", &W::z_step, &C::z_step, "0.7"), two},
      {"xy_step", kStream | kClouds, setting("--xy-step", &W::xy_step, &C::xy_step, "0.5"),
       bound("40")},
      {"never_below", kAll, setting("--never-below", &W::never_below, true, &C::never_below, 1u),
       two},
      {"effort", kAll, fast, two},
      {"effort", 0, setting("", &W::effort, SearchEffort::kNormal, &C::effort, 2u), two},
      {"effort", kAll, setting("--best", &W::effort, SearchEffort::kBest, &C::effort, 3u),
       bound("1.2")},
      {"max_degree", kAll, setting("--max-degree", &W::max_degree, &C::max_degree, 6u), two},
      {"coding", kAll, coding("--coding quick", Coding::kQuick, 1), two},
      {"coding", 0, coding("--coding balanced", Coding::kBalanced, 2), two},
      {"coding", kAll, coding("--coding dense", Coding::kDense, 3), two},
      {"bound_at", 0, bound_at("--bound-at points", BoundAt::kPoints, 1), coarse},
      {"bound_at", kClouds, bound_at("--bound-at lattice", BoundAt::kLattice, 2), coarse},
      {"bound_at", kStream | kPack, bound_at("--bound-at everywhere", BoundAt::kEverywhere, 3),
       bound("9")},
      {"duplicates", 0, duplicates("--duplicates middle", Duplicates::kMiddle, 1), two},
      {"duplicates", kClouds, duplicates("--duplicates lowest", Duplicates::kLowest, 2), two},
      {"duplicates", kClouds, duplicates("--duplicates highest", Duplicates::kHighest, 3), two},
      {"duplicates", kClouds, duplicates("--duplicates mean", Duplicates::kMean, 4), two},
      {"units", kAll, setting("--units", &W::units, &C::units, "foot:us-foot"), two},
      {"depths", kAll, setting("--depths", &W::depths, true, &C::depths, 1u), two},
      {"max_vertices", kStream | kCloud,
       setting("--max-vertices", &W::max_vertices, &C::max_vertices, 70u), fast},
      {"max_bytes", kStream | kCloud, setting("--max-bytes", &W::max_bytes, &C::max_bytes, 300u),
       fast},
      {"tile_vertices", kPacks,
       setting("--tile-vertices", &W::tile_vertices, &C::tile_vertices, 20u), two},
      {"tile_size", kPack, setting("--tile-size", &W::tile_size, &C::tile_size, 9u), two},
  };
  for (const std::vector<Row>& more : {rows_of_files(), rows_of_notes()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

// Bytes, or nothing where a door refuses.
using Encoded = std::optional<std::vector<uint8_t>>;

// A raster and points of two decimals that 16 bits do not hold, some of which share a place.
class Doors {
 public:
  Doors() {
    session_.write("grid.asc", grid());
    session_.write("cloud.xyz", cloud());
  }

  Encoded by_command(Kind kind, const std::vector<Setting>& settings) const {
    std::string words = "encode " + source(kind) + " -o " + product(kind);
    for (const Setting& setting : settings) words += " " + setting.flags;
    if (is_pack(kind) && !contains(words, "--tile-vertices")) words += " --tile-vertices 60";
    std::filesystem::remove(path(product(kind)));
    const Session::Result result = session_.run(words);
    CHECK_MESSAGE(result.code <= 2, words);
    if (result.code != 0) return std::nullopt;
    return bytes_of_file(path(product(kind)));
  }

  Encoded by_cpp(Kind kind, const std::vector<Setting>& settings) const {
    library::Options options;
    if (is_pack(kind)) options.tile_vertices = 60;
    for (const Setting& setting : settings) setting.cpp(options);
    try {
      const auto terrain = library::SourceTerrain::from_file(path(source(kind)));
      if (!is_pack(kind)) return library::encode_stream(terrain, options).bytes;
      library::encode_pack(terrain, options, path(product(kind)));
      return bytes_of_file(path(product(kind)));
    } catch (const std::runtime_error&) {
      return std::nullopt;
    }
  }

  Encoded by_c(Kind kind, const std::vector<Setting>& settings) const {
    microtin_options options{};
    options.size = sizeof options;
    if (is_pack(kind)) options.tile_vertices = 60;
    for (const Setting& setting : settings) setting.c(options);
    microtin_source* terrain = nullptr;
    REQUIRE(microtin_source_from_file(path(source(kind)).c_str(), &terrain) == MICROTIN_STATUS_OK);
    uint8_t* bytes = nullptr;
    uint64_t size = 0;
    const std::string file = path(product(kind));
    const microtin_status outcome =
        is_pack(kind) ? microtin_encode_pack(terrain, &options, file.c_str(), nullptr)
                      : microtin_encode_stream(terrain, &options, &bytes, &size, nullptr);
    microtin_source_free(terrain);
    CHECK((outcome == MICROTIN_STATUS_OK || outcome == MICROTIN_STATUS_REJECTED));
    Encoded made;
    if (outcome == MICROTIN_STATUS_OK) {
      made = is_pack(kind) ? bytes_of_file(file) : std::vector<uint8_t>(bytes, bytes + size);
    }
    microtin_bytes_free(bytes);
    return made;
  }

 private:
  static std::string grid() {
    std::string text =
        "ncols 40\nnrows 30\nxllcenter 500\nyllcenter 700\ncellsize 2\nnodata_value -9\n";
    for (int row = 0; row < 30; ++row) {
      for (int column = 0; column < 40; ++column) {
        const double z = 60 + 25 * std::sin(column * 0.31) * std::cos(row * 0.23) + row % 3;
        text += row < 4 && column > 34 ? "-9" : one_decimal(z);
        text += column < 39 ? ' ' : '\n';
      }
    }
    return text;
  }

  static std::string one_decimal(double number) {
    char words[32];
    std::snprintf(words, sizeof words, "%.1f", number);
    return words;
  }

  static std::string cloud() {
    std::string text;
    for (int i = 0; i < 400; ++i) {
      const int column = i % 20, row = i / 20;
      const double x = 50 * column + i * 7919 % 997 / 50.0, y = 49 * row + i * 7907 % 991 / 50.0;
      const auto line = [&](double z) {
        char words[64];
        std::snprintf(words, sizeof words, "%.2f %.2f %.1f\n", x, y, z);
        text += words;
      };
      const double z = 30 * std::sin(column * 0.4) + 3 * row;
      line(z);
      if (i % 80 == 33) line(z + 1.5);
      if (i % 80 == 33) line(z + 0.5);
    }
    return text;
  }

  static std::string source(Kind kind) { return (kind & kClouds) != 0 ? "cloud.xyz" : "grid.asc"; }
  static std::string product(Kind kind) { return is_pack(kind) ? "made.mtp" : "made.mtin"; }
  std::string path(const std::string& name) const { return session_.folder() + "/" + name; }

  Session session_;
};

// The command line, C++ and C.
void walk(Kind kind) {
  const Doors doors;
  std::map<std::string, Encoded> made;
  int number = 0;
  for (const Row& row : rows()) {
    if (kIsSanitized && ++number % 8 != 0) continue;  // compilers make no difference
    CAPTURE(row.name);
    CAPTURE(row.set.flags);
    const std::vector<Setting> both = {row.beside, row.set};
    const bool makes_difference = (row.kinds & kind) != 0;
    const Encoded command = doors.by_command(kind, both);
    CHECK((command == doors.by_c(kind, both)));
    CHECK((command == doors.by_cpp(kind, both)));
    if (made.count(row.beside.flags) == 0) {
      made[row.beside.flags] = doors.by_command(kind, {row.beside});
    }
    const Encoded& without = made[row.beside.flags];
    if (makes_difference) {
      CHECK((command && without && command != without));
    } else {
      CHECK((!command || command == without));
    }
  }
}

}  // namespace

TEST_CASE("doors: each option of a stream of posts does the same by each, and something" * kSlow) {
  walk(kStream);
}

TEST_CASE("doors: each option of a pack of posts does the same by each, and something" * kSlow) {
  walk(kPack);
}

TEST_CASE("doors: each option of a stream of points does the same by each, and something" * kSlow) {
  walk(kCloud);
}

TEST_CASE("doors: each option of a pack of points does the same by each, and something" * kSlow) {
  walk(kCloudPack);
}

TEST_CASE("doors: no option is without a row") {
  Names known;
  for (const Row& row : rows()) known.insert(row.name);
  CHECK(text_of(members_of(kCpp, "Options")) == text_of(known));
  CHECK(text_of(members_of(kC, "microtin_options")) ==
        text_of(united(known, {"size", "progress", "context"})));
}
