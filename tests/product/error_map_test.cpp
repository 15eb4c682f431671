// SPDX-License-Identifier: MIT
// Bounds that posts and points have of their own, kept by every product: heights are looked up in
// the triangles one by one, and the bounds are this file's own reading of the map.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "microtin/encoder.hpp"
#include "microtin/surface.hpp"
#include "tests/support/files.hpp"
#include "tests/support/join.hpp"
#include "tests/support/session.hpp"

using namespace microtin::tests;
namespace library = microtin::encoder;

namespace {

constexpr int kColumns = 61, kRows = 47;  // posts, 10 apart; row 0 is the southernmost
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

bool is_void(int column, int row) {
  return column > 50 && row > 40;
}

int height_of(int column, int row) {
  return static_cast<int>(std::lround(300 + 90 * std::sin(column * 0.23) * std::cos(row * 0.31) +
                                      (column * 7 + row * 13) % 11));
}

using Bounds = std::function<double(int column, int row)>;  // kNone: none

std::string grid_of(int columns, int rows, double cell, double west, double south,
                    const std::function<double(int, int)>& value) {
  std::string text = "ncols " + std::to_string(columns) + "\nnrows " + std::to_string(rows) +
                     "\nxllcorner " + std::to_string(west) + "\nyllcorner " +
                     std::to_string(south) + "\ncellsize " + std::to_string(cell) +
                     "\nnodata_value -9\n";
  for (int row = rows - 1; row >= 0; --row) {
    for (int column = 0; column < columns; ++column) {
      const double number = value(column, row);
      char word[32];
      std::snprintf(word, sizeof word, "%g", std::isnan(number) ? -9 : number);
      text += word;
      text += column + 1 < columns ? ' ' : '\n';
    }
  }
  return text;
}

// Posts lie at multiples of 10 from 1000, 2000.
std::string grid_of_posts(const std::function<double(int, int)>& value) {
  return grid_of(kColumns, kRows, 10, 995, 1995, value);
}

void write_terrain(const Session& session) {
  session.write("t.asc", grid_of_posts([](int column, int row) {
                  return is_void(column, row) ? kNone : height_of(column, row);
                }));
}

// The surface's height at a place by its triangles; kNone outside.
double height_at(const library::Mesh& mesh, double x, double y) {
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const auto cross = [&](const auto& p, const auto& q) {
      return (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
    };
    const double u = cross(b, c), v = cross(c, a), w = cross(a, b);
    if (u < 0 || v < 0 || w < 0) continue;
    return (u * a[2] + v * b[2] + w * c[2]) / (u + v + w);
  }
  return kNone;
}

struct Kept {
  double largest_ratio = 0, lowest = 0;  // the lowest: of the surface above a post
};

// Every post is covered and within its bound.
Kept expect_kept(const std::string& path, const Bounds& bound) {
  constexpr double kRounding = 1e-6;
  const library::Mesh mesh = library::Surface::from_file(path).mesh();
  Kept kept;
  for (int row = 0; row < kRows; ++row) {
    for (int column = 0; column < kColumns; ++column) {
      const double height = height_at(mesh, 1000 + 10 * column, 2000 + 10 * row);
      CHECK(std::isnan(height) == is_void(column, row));
      if (is_void(column, row)) continue;
      const double above = height - height_of(column, row), allowed = bound(column, row);
      kept.lowest = std::min(kept.lowest, above);
      if (std::isnan(allowed)) continue;
      CHECK_MESSAGE(std::abs(above) <= allowed + kRounding,
                    (path + " at " + std::to_string(column)));
      if (allowed > 0) kept.largest_ratio = std::max(kept.largest_ratio, std::abs(above) / allowed);
    }
  }
  return kept;
}

double west_tight(int column, int row) {
  if (column == 30 && row < 9) return 0;
  return column < 25 ? 2 : column > 55 ? kNone : 15;
}

void expect_runs(const Session& session, const std::string& arguments) {
  const Session::Result result = session.run(arguments);
  CHECK_MESSAGE(result.code == 0, (arguments + ": " + result.err));
}

std::string field(const Session& session, const std::string& file, const std::string& name) {
  const std::string report = session.run("info --json " + file).out;
  const std::size_t at = report.find('"' + name + "\": ");
  return at == report.npos ? ""
                           : report.substr(at + name.size() + 4,
                                           report.find_first_of(",}", at) - at - name.size() - 4);
}

}  // namespace

TEST_CASE("error map: each post of a raster keeps its own bound, in every product") {
  const Session session;
  write_terrain(session);
  session.write("map.asc", grid_of_posts(west_tight));
  const std::string folder = session.folder() + "/";
  for (const char* product :
       {"a.mtin", "b.mtin --fast", "c.mtin --best", "d.mtp --tile-vertices 40",
        "e.mtp --tile-size 13", "f.mtin --z-step 0.5", "g.mtin --coding quick"}) {
    const std::string file = std::string(product).substr(0, std::string(product).find(' '));
    expect_runs(session,
                "encode t.asc --units metre --error-map map.asc -o " + std::string(product));
    const Kept kept = expect_kept(folder + file, west_tight);
    CHECK(kept.largest_ratio > 0.9);  // the bounds are used
    CHECK(std::stod(field(session, file, "max_ratio")) >= kept.largest_ratio - 1e-6);
    CHECK(std::stod(field(session, file, "max_ratio")) <= 1);
    CHECK(field(session, file, "least") == "0.0");
    CHECK(field(session, file, "largest") == "15.0");
    CHECK(field(session, file, "bound") == "null");  // some posts have none
    expect_runs(session, "verify " + file + " t.asc --units metre --error-map map.asc");
    CHECK(contains(session.failure("verify " + file + " t.asc --units metre"), "--error-map"));
  }
}

TEST_CASE("error map: a coarser raster gives a post the least bound of the cells that it touches") {
  const Session session;
  write_terrain(session);
  const auto cell = [](int column, int row) { return 2.0 + (column * 5 + row * 3) % 9; };
  session.write("map.asc", grid_of(7, 6, 100, 950, 1950, cell));  // posts on borders of cells
  const Bounds bound = [&](int column, int row) {
    double least = 1e9;
    for (int v = 0; v < 6; ++v) {
      for (int u = 0; u < 7; ++u) {
        const bool touches =
            std::abs(10 * column - 100 * u) <= 50 && std::abs(10 * row - 100 * v) <= 50;
        if (touches) least = std::min(least, cell(u, v));
      }
    }
    return least;
  };
  for (const char* file : {"a.mtin", "a.mtp"}) {
    expect_runs(session, std::string("encode t.asc --units metre --error-map map.asc -o ") + file);
    CHECK(expect_kept(session.folder() + "/" + file, bound).largest_ratio > 0.9);
    CHECK(field(session, file, "bound") == "10.0");
  }
}

TEST_CASE("error map: polygons bound the posts in them and on their borders") {
  const Session session;
  write_terrain(session);
  session.write("map.geojson",
                R"({"type": "FeatureCollection", "features": [
  {"type": "Feature", "properties": {"max_error": 1.5}, "geometry": {"type": "Polygon",
    "coordinates": [[[1100, 2100], [1200, 2100], [1200, 2250], [1100, 2250], [1100, 2100]],
                    [[1130, 2130], [1170, 2130], [1170, 2170], [1130, 2170], [1130, 2130]]]}},
  {"type": "Feature", "properties": {"max_error": null}, "geometry": {"type": "MultiPolygon",
    "coordinates": [[[[1400, 2000], [1500, 2000], [1450, 2100], [1400, 2000]]]]}}]})");
  const Bounds bound = [](int column, int row) -> double {
    const int x = 10 * column, y = 10 * row;
    const bool in = x >= 100 && x <= 200 && y >= 100 && y <= 250,
               in_hole = x > 130 && x < 170 && y > 130 && y < 170;
    if (in && !in_hole) return 1.5;
    const bool in_triangle = y >= 0 && y <= 2 * (x - 400) && y <= 2 * (500 - x);
    return in_triangle ? kNone : 12;
  };
  for (const char* file : {"a.mtin", "a.mtp"}) {
    expect_runs(
        session,
        std::string("encode t.asc --units metre --max-error 12 --error-map map.geojson -o ") +
            file);
    CHECK(expect_kept(session.folder() + "/" + file, bound).largest_ratio > 0.9);
    CHECK(field(session, file, "bounded") != "0");
    expect_runs(session,
                std::string("verify ") + file + " t.asc --units metre --error-map map.geojson");
  }
  const auto tight = library::Surface::from_file(session.folder() + "/a.mtin").info();
  CHECK(tight.least_bound == "1.5");
  CHECK(tight.largest_bound == "12");
}

TEST_CASE("error map: the surface is never below a post, and above it by its bound at most") {
  const Session session;
  write_terrain(session);
  const auto cell = [](int column, int) { return column < 30 ? 3.0 : 20.0; };
  session.write("map.asc", grid_of_posts(cell));
  for (const char* file : {"a.mtin", "a.mtp"}) {
    expect_runs(
        session,
        std::string("encode t.asc --units metre --never-below --error-map map.asc -o ") + file);
    CHECK(expect_kept(session.folder() + "/" + file, cell).lowest >= -1e-6);
    CHECK(field(session, file, "side") == "\"never_below\"");
  }
  session.write("holes.asc", grid_of_posts(west_tight));
  CHECK(contains(session.failure("encode t.asc --never-below --error-map holes.asc -o b.mtin"),
                 "without a bound"));
}

TEST_CASE("error map: a limit scales all bounds alike, and the file states the factor") {
  const Session session;
  write_terrain(session);
  const auto cell = [](int column, int) { return column < 30 ? 2.0 : 20.0; };
  session.write("map.asc", grid_of_posts(cell));
  for (const char* limit : {"--max-bytes 700", "--max-vertices 300"}) {
    expect_runs(
        session,
        std::string("encode t.asc --units metre --fast --error-map map.asc -o a.mtin ") + limit);
    const double scale = std::stod(field(session, "a.mtin", "scale"));
    CHECK(scale != 1);
    const Bounds scaled = [&](int column, int row) { return scale * cell(column, row); };
    CHECK(expect_kept(session.folder() + "/a.mtin", scaled).largest_ratio > 0.8);
    expect_runs(session, "verify a.mtin t.asc --units metre --error-map map.asc");
  }
  CHECK(session.read("a.mtin").size() > 100);
}

TEST_CASE("error map: two bounds take at most 3 % more than the two regions alone") {
  const Session session;
  session.run("fractal --size 257 --seed 4 -o t.asc");
  const std::string text = session.read("t.asc");
  std::vector<std::vector<std::string>> rows;
  std::string head = "xllcenter 0\nyllcenter 0\ncellsize 30\n";
  std::size_t at = 0;
  for (int line = 0; at < text.size(); ++line) {
    const std::size_t end = text.find('\n', at);
    if (line >= 5) {
      rows.emplace_back();
      for (std::size_t from = at; from < end;) {
        const std::size_t to = std::min(text.find(' ', from), end);
        rows.back().push_back(text.substr(from, to - from));
        from = to + 1;
      }
    }
    at = end + 1;
  }
  const auto part = [&](std::size_t from, std::size_t to) {
    std::string grid = "ncols " + std::to_string(to - from) + "\nnrows 257\n" + head;
    for (const auto& row : rows) {
      for (std::size_t i = from; i < to; ++i) grid += row[i] + (i + 1 < to ? " " : "\n");
    }
    return grid;
  };
  session.write("west.asc", part(0, 129));
  session.write("east.asc", part(129, 257));
  session.write("map.asc",
                "ncols 2\nnrows 2\nxllcorner -15\nyllcorner -15\ncellsize 3870\n2 20\n2 20\n");
  for (const char* words :
       {"west.asc --max-error 2 -o west.mtin", "east.asc --max-error 20 -o east.mtin",
        "t.asc --error-map map.asc -o both.mtin"}) {
    expect_runs(session, std::string("encode --units metre ") + words);
  }
  const double alone =
      static_cast<double>(session.read("west.mtin").size() + session.read("east.mtin").size());
  CHECK(static_cast<double>(session.read("both.mtin").size()) <= 1.03 * alone);
}

TEST_CASE(
    "error map: shards join to the pack, a resumed run makes it, and an update keeps its tiles") {
  const Session session;
  write_terrain(session);
  session.write("map.asc", grid_of_posts(west_tight));
  session.write("other.asc", grid_of_posts([](int column, int row) {
                  return column < 12 && row < 12 ? 1 : west_tight(column, row);
                }));
  const std::string options = "t.asc --units metre --error-map map.asc --tile-size 12 --z-step 1 ";
  expect_runs(session, "encode " + options + "-o all.mtp");
  expect_runs(session, "encode " + options + "--shard 0:7 -o a.mtsh");
  expect_runs(session, "encode " + options + "--shard 8:99 -o b.mtsh");
  expect_runs(session, "merge a.mtsh b.mtsh -o joined.mtp");
  CHECK(session.read("joined.mtp") == session.read("all.mtp"));
  expect_runs(session,
              "encode t.asc --units metre --error-map other.asc --tile-size 12 --z-step 1 --shard "
              "8:99 -o c.mtsh");
  CHECK(contains(session.failure("merge a.mtsh c.mtsh -o d.mtp"), "another terrain"));
  expect_runs(session, "encode " + options + "--resume log -o resumed.mtp");
  CHECK(session.read("resumed.mtp") == session.read("all.mtp"));
  expect_runs(session, "update all.mtp t.asc --units metre --error-map map.asc -o same.mtp");
  CHECK(session.read("same.mtp") == session.read("all.mtp"));
  const std::string kept = session
                               .run(
                                   "update all.mtp t.asc --units metre --error-map other.asc "
                                   "--tile-vertices 300 -o new.mtp")
                               .out;
  CHECK(contains(kept, "kept: "));
  CHECK(!contains(kept, "kept: 24 of 24"));
  expect_kept(session.folder() + "/new.mtp", [](int column, int row) {
    return column < 12 && row < 12 ? 1 : west_tight(column, row);
  });
  CHECK(contains(session.failure("update all.mtp t.asc --units metre -o x.mtp"), "--error-map"));
}

TEST_CASE("error map: points keep their own bounds where they truly lie") {
  const Session session;
  std::string points;
  struct Point {
    double x, y, z, bound;
  };
  std::vector<Point> all;
  uint32_t random = 1;
  const auto next = [&] { return (random = random * 1664525u + 1013904223u) >> 8; };
  for (int i = 0; i < 900; ++i) {
    const double x = next() % 100000 / 100.0, y = next() % 100000 / 100.0;
    const double z = std::round((50 + 20 * std::sin(x / 70) * std::cos(y / 90)) * 100) / 100;
    all.push_back({x, y, z, x <= 400 ? 1.0 : 6.0});
    char line[96];
    std::snprintf(line, sizeof line, "%.2f %.2f %.2f\n", x, y, z);
    points += line;
  }
  session.write("p.xyz", points);
  session.write("map.geojson", R"({"type": "Feature", "properties": {"max_error": 1}, "geometry":
    {"type": "Polygon", "coordinates": [[[-1, -1], [400, -1], [400, 1001], [-1, 1001], [-1, -1]]]}})");
  for (const char* words : {"a.mtin", "b.mtin --xy-step 2", "c.mtp --tile-vertices 60"}) {
    expect_runs(
        session,
        std::string("encode p.xyz --units metre --max-error 6 --error-map map.geojson -o ") +
            words);
    const std::string name = std::string(words).substr(0, std::string(words).find(' '));
    const library::Mesh mesh = library::Surface::from_file(session.folder() + "/" + name).mesh();
    for (const Point& p : all) {
      const double height = height_at(mesh, p.x, p.y);
      if (std::isnan(height)) continue;  // outside the hull, by less than a step
      CHECK(std::abs(height - p.z) <= p.bound + 1e-3);
    }
    expect_runs(session, "verify " + name + " p.xyz --units metre --error-map map.geojson");
  }
  CHECK(
      contains(session.failure(
                   "encode p.xyz --max-error 6 --error-map map.geojson --max-bytes 900 -o d.mtin"),
               "--bound-at"));
}

TEST_CASE("error map: what a map lacks, and files that are none, are refused") {
  const Session session;
  write_terrain(session);
  session.write("part.asc", grid_of(3, 3, 10, 995, 1995, [](int, int) { return 2; }));
  CHECK(contains(session.failure("encode t.asc --error-map part.asc -o a.mtin"), "does not cover"));
  session.write("below.asc", grid_of_posts([](int, int) { return -3; }));
  CHECK(contains(session.failure("encode t.asc --error-map below.asc -o a.mtin"), "below 0"));
  session.write("points.xyz", "1 2 3\n4 5 6\n7 8 8\n");
  CHECK(contains(session.failure("encode t.asc --error-map points.xyz -o a.mtin"), "raster"));
  session.write("bare.geojson",
                R"({"type": "Polygon", "coordinates": [[[0,0],[1,0],[1,1],[0,0]]]})");
  CHECK(contains(session.failure("encode t.asc --max-error 2 --error-map bare.geojson -o a.mtin"),
                 "max_error"));
  session.failure("encode t.asc --max-error 2 --error-map nowhere.geojson -o a.mtin");
  session.write("map.asc", grid_of_posts([](int, int) { return 2; }));
  expect_runs(session, "encode t.asc --units metre --max-error 2 -o plain.mtp");
  CHECK(
      contains(session.failure("update plain.mtp t.asc --units metre --error-map map.asc -o b.mtp"),
               "one bound"));
  CHECK(contains(session.failure("verify plain.mtp t.asc --units metre --error-map map.asc"),
                 "--error-map"));
}

TEST_CASE("error map: in C++ a raster of bounds makes the bytes that a file of it makes") {
  const Session session;
  write_terrain(session);
  session.write("map.asc", grid_of_posts(west_tight));
  expect_runs(session, "encode t.asc --error-map map.asc -o a.mtin");
  std::vector<double> bounds;
  for (int row = kRows - 1; row >= 0; --row) {
    for (int column = 0; column < kColumns; ++column) bounds.push_back(west_tight(column, row));
  }
  auto terrain = library::SourceTerrain::from_file(session.folder() + "/t.asc");
  const auto without = encode_stream(terrain, {}).bytes;
  terrain.set_error_map(library::raster_from_cells(kColumns, kRows, bounds.data(),
                                                   {995, 10, 0, 1995 + 10 * kRows, 0, -10}));
  const library::Stream made = encode_stream(terrain, {});
  CHECK(made.bytes == bytes_of_file(session.folder() + "/a.mtin"));
  CHECK(made.bytes != without);
  CHECK(made.report.least_bound == "0");
  CHECK(made.report.largest_bound == "15");
  CHECK(made.report.bound == "");
  CHECK(made.report.max_bound_ratio != "");
}

TEST_CASE("features: a file of another system, or of places that there are not, is refused") {
  const Session session;
  write_terrain(session);
  const auto write = [&](const std::string& crs, const std::string& ring) {
    session.write("f.geojson", R"({"type": "FeatureCollection", )" + crs +
                                   R"("features": [{"type": "Feature", "properties": {"top": 9,
        "max_error": 2}, "geometry": {"type": "Polygon", "coordinates": [[)" +
                                   ring + "]]}}]}");
  };
  const auto expect_refused = [&](const std::string& units, const std::string& reason) {
    for (const char* option : {"--area", "--error-map", "--obstacles", "--breaklines"}) {
      for (const char* output : {"a.mtin", "a.mtp"}) {
        const std::string command = "encode t.asc --max-error 30 " + units + ' ' + option;
        const std::string message = session.failure(command + " f.geojson -o " + output);
        CHECK_MESSAGE(contains(message, "f.geojson: " + reason), message);
      }
    }
  };
  const std::string square = "[1000,2000],[1100,2000],[1100,2100],[1000,2000]";
  const auto crs = [](const std::string& name) {
    return R"("crs": {"type": "name", "properties": {"name": ")" + name + "\"}}, ";
  };
  write(crs("urn:ogc:def:crs:EPSG::25833"), square);
  expect_refused("--epsg 25832 --units :metre",
                 "its coordinate system (urn:ogc:def:crs:EPSG::25833) is not the terrain's");
  write(crs("urn:ogc:def:crs:OGC:1.3:CRS84"), square);
  expect_refused("--units metre", "its coordinate system (urn:ogc:def:crs:OGC:1.3:CRS84)");
  for (const char* name : {"urn:ogc:def:crs:EPSG::25832", "NOBODY:1"}) {
    write(crs(name), square);
    expect_runs(
        session,
        "encode t.asc --max-error 30 --area f.geojson --epsg 25832 --units :metre -o a.mtin");
  }
  session.write("t.asc", grid_of(5, 5, 1, 6, 44, [](int x, int y) { return 10 * x + y; }));
  write("", "[6,44],[9,44],[9,444],[6,44]");
  expect_refused("--units degree:metre", "latitude 444 is beyond 90 degrees");
  write("", "[44,6],[44,9],[47000,9],[44,6]");
  expect_refused("--epsg 4326:5773", "longitude 47000 is beyond 360 degrees");
}

TEST_CASE("error map: a raster of another system is refused, and so is a mask of water") {
  const Session session;
  write_terrain(session);
  session.write("map.asc", grid_of_posts([](int, int) { return 1; }));
  const auto write_system = [&](const char* unit) {
    session.write("map.prj", std::string("GEOGCS[\"a\",UNIT[\"") + unit + "]]");
  };
  write_system("degree\",0.0174532925199433");
  for (const char* option : {"--error-map map.asc", "--water-level 0 --water-mask map.asc"}) {
    for (const char* output : {"a.mtin", "a.mtp"}) {
      const std::string made = std::string(option) + " --max-error 9 -o " + output;
      CHECK(contains(session.failure("encode t.asc --units metre " + made),
                     "map.asc: its x and y are in the unit degree, and those of the terrain in "
                     "metre; bring it into the terrain's system"));
    }
  }
  session.write("map.prj", "LOCAL_CS[\"a\",UNIT[\"m\",1]]");
  expect_runs(session, "encode t.asc --units metre --error-map map.asc --max-error 9 -o a.mtin");
}

TEST_CASE("options: the empty name of a file is refused, and not taken for none") {
  const Session session;
  write_terrain(session);
  for (const char* option : {"--area", "--error-map", "--obstacles", "--breaklines", "--route",
                             "--resume", "--cells", "--water-level 1 --water-mask", "-o"}) {
    const auto result = session.run(std::string("encode t.asc --units metre --max-error 3 ") +
                                    "--route-width 5 -o a.mtp " + option + " \"\"");
    CHECK_MESSAGE(result.code == 2, option);
  }
}

TEST_CASE("area: posts in polygons and on their borders stay, and all others are void") {
  const Session session;
  write_terrain(session);
  session.write("area.geojson",
                R"({"type": "Polygon", "coordinates":
  [[[1100, 2050], [1400, 2050], [1400, 2350], [1100, 2350], [1100, 2050]]]})");
  for (const char* words : {"a.mtin", "a.mtp --tile-size 20"}) {
    const std::string file = std::string(words).substr(0, std::string(words).find(' '));
    expect_runs(
        session,
        std::string("encode t.asc --units metre --max-error 3 --area area.geojson -o ") + words);
    const library::Mesh mesh = library::Surface::from_file(session.folder() + "/" + file).mesh();
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        const double height = height_at(mesh, 1000 + 10 * column, 2000 + 10 * row);
        const bool is_inside = column >= 10 && column <= 40 && row >= 5 && row <= 35;
        CHECK(std::isnan(height) == !is_inside);
        if (is_inside) CHECK(std::abs(height - height_of(column, row)) <= 3 + 1e-6);
      }
    }
    expect_runs(session, "verify " + file + " t.asc --units metre --area area.geojson");
    CHECK(session.run("verify " + file + " t.asc --units metre").code != 0);
  }
  session.write("line.geojson", R"({"type": "LineString", "coordinates": [[0, 0], [1, 1]]})");
  CHECK(contains(session.failure("encode t.asc --area line.geojson -o b.mtin"), "no polygon"));
  std::string points;
  for (int i = 0; i < 400; ++i) {
    points += std::to_string(1000 + i % 20 * 30) + ' ' + std::to_string(2000 + i / 20 * 25) + ' ' +
              std::to_string(i * i % 17) + '\n';
  }
  session.write("p.xyz", points);
  expect_runs(session, "encode p.xyz --units metre --area area.geojson -o p.mtin");
  CHECK(library::Surface::from_file(session.folder() + "/p.mtin").info().vertices == 10 * 13);
}

TEST_CASE("route: what lies near its lines stays, with the area's polygons") {
  const Session session;
  write_terrain(session);
  session.write("route.geojson",
                R"({"type": "LineString", "coordinates": [[1100, 2100], [1500, 2100]]})");
  session.write("area.geojson", R"({"type": "Polygon", "coordinates":
  [[[1200, 2300], [1300, 2300], [1300, 2400], [1200, 2400], [1200, 2300]]]})");
  const std::string words =
      " --units metre --route route.geojson --route-width 60 --area area.geojson";
  for (const std::string file : {"a.mtin", "a.mtp"}) {
    const std::string tiles = file == "a.mtp" ? " --tile-size 20" : "";
    expect_runs(session, join({"encode t.asc --max-error 3 -o ", file, words, tiles}));
    const library::Mesh mesh = library::Surface::from_file(session.folder() + "/" + file).mesh();
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        const bool is_level = row >= 7 && row <= 13;
        const bool is_near = is_level && column >= 10 && column <= 50;
        if (is_level && !is_near) continue;  // round ends
        const bool is_in_area = column >= 20 && column <= 30 && row >= 30 && row <= 40;
        const double height = height_at(mesh, 1000 + 10 * column, 2000 + 10 * row);
        CHECK(std::isnan(height) == !(is_near || is_in_area));
      }
    }
  }
  expect_runs(session, "verify a.mtin t.asc" + words);
  CHECK(session.run("verify a.mtin t.asc --units metre").code != 0);
  CHECK(contains(session.failure("encode t.asc --route area.geojson --route-width 60 -o b.mtin"),
                 "area.geojson: has no line"));
  CHECK(session.run("encode t.asc --route route.geojson -o b.mtin").code == 2);
}

TEST_CASE("route: the bound grows from its lines to the edges, and fewer vertices are needed") {
  const Session session;
  write_terrain(session);
  session.write("route.geojson",
                R"({"type": "LineString", "coordinates": [[1000, 2100], [1600, 2100]]})");
  const std::string route = " --units metre --route route.geojson --route-width 160";
  for (const std::string file : {"a.mtin", "a.mtp"}) {
    const std::string tiles = file == "a.mtp" ? " --tile-size 20" : "";
    const std::string encode = join({"encode t.asc --max-error 1 -o ", file, tiles, route});
    expect_runs(session, encode);
    const uint64_t vertices =
        library::Surface::from_file(session.folder() + "/" + file).info().vertices;
    expect_runs(session, encode + " --route-edge-error 9");
    const library::Surface surface = library::Surface::from_file(session.folder() + "/" + file);
    CHECK(surface.info().vertices < vertices);
    const library::Mesh mesh = surface.mesh();
    double largest = 0;
    for (int row = 2; row <= 18; ++row) {
      const double part = std::abs(row - 10) / 8.0;
      for (int column = 0; column <= 50; ++column) {
        const double z = height_at(mesh, 1000 + 10 * column, 2000 + 10 * row);
        if (std::isnan(z)) continue;
        const double error = std::abs(z - height_of(column, row));
        CHECK(error <= 1 + 8 * part + 1e-6);
        largest = std::max(largest, error);
      }
    }
    CHECK(largest > 2);
    expect_runs(session, join({"verify ", file, " t.asc", route, " --route-edge-error 9"}));
    CHECK(session.run(join({"verify ", file, " t.asc", route})).code != 0);
  }
  const std::string base = "encode t.asc -o b.mtin" + route;
  CHECK(contains(session.failure(base + " --max-error 5 --route-edge-error 4"), "is less than"));
  CHECK(contains(session.failure(base + " --route-edge-error 4"), "needs"));
}

TEST_CASE("error map: a bound of a point or a line is refused, not left out") {
  const Session session;
  write_terrain(session);
  session.write("map.geojson", R"({"type": "Feature", "properties": {"max_error": 1}, "geometry":
  {"type": "Point", "coordinates": [1100, 2100]}})");
  CHECK(contains(session.failure("encode t.asc --units metre --max-error 5 --error-map "
                                 "map.geojson -o a.mtin"),
                 "map.geojson: a property max_error is for polygons"));
}
