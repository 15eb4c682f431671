// SPDX-License-Identifier: MIT
// Breaklines are chains of edges near their lines. This file looks for the edges by itself: of all
// edges those that are near a line, by comparing places on them with places on the line.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/stream/edge_marks.hpp"
#include "encoder/terrain/line_class.hpp"
#include "microtin/surface.hpp"
#include "tests/support/join.hpp"
#include "tests/support/point_sets.hpp"
#include "tests/support/session.hpp"

using namespace microtin::tests;
namespace library = microtin::encoder;

// A namespace of its own: sources of a folder may be compiled as one.
namespace microtin::breaklines_test {
namespace {

constexpr int kColumns = 61, kRows = 47;  // posts; row 0 is the southernmost
constexpr double kWest = 1000, kSouth = 2000, kShift = 0.71;

using Place = std::array<double, 3>;
using Line = std::vector<Place>;

double ground_at(double column, double row) {
  return 300 + 90 * std::sin(column * 0.23) * std::cos(row * 0.31) +
         std::fmod(std::floor(column) * 7 + std::floor(row) * 13, 11);
}

// Posts `cell` apart. Beyond a column and a row they are void.
void write_terrain(const Session& session, double cell, int first_void = kColumns) {
  std::string text = "ncols 61\nnrows 47\nxllcenter 1000\nyllcenter 2000\ncellsize " +
                     std::to_string(cell) + "\nnodata_value -9\n";
  for (int row = kRows - 1; row >= 0; --row) {
    for (int column = 0; column < kColumns; ++column) {
      const bool is_void = column >= first_void && column < first_void + 8 && row > 20 && row < 30;
      text += is_void ? "-9" : std::to_string(std::lround(ground_at(column, row)));
      text += column + 1 < kColumns ? ' ' : '\n';
    }
  }
  session.write("t.asc", text);
}

// In posts; heights below 0 are left out.
std::vector<Line> placed(const std::vector<Line>& lines, double cell) {
  std::vector<Line> all = lines;
  for (Line& line : all) {
    for (Place& p : line) p = {kWest + p[0] * cell, kSouth + p[1] * cell, p[2]};
  }
  return all;
}

void write_lines(const Session& session, const std::vector<Line>& lines) {
  std::string text = "x,y,z\n";
  for (const Line& line : lines) {
    for (const Place& p : line) {
      char words[96];
      std::snprintf(words, sizeof words, p[2] < 0 ? "%.6f,%.6f\n" : "%.6f,%.6f,%.3f\n", p[0], p[1],
                    p[2]);
      text += words;
    }
    text += '\n';
  }
  session.write("lines.csv", text);
}

double distance_to(const Place& p, const Place& a, const Place& b) {
  const double x = b[0] - a[0], y = b[1] - a[1], square = x * x + y * y;
  const double share = square == 0 ? 0 : ((p[0] - a[0]) * x + (p[1] - a[1]) * y) / square;
  const double t = std::min(std::max(share, 0.0), 1.0);
  return std::hypot(p[0] - a[0] - t * x, p[1] - a[1] - t * y);
}

double distance_to(const Place& p, const Line& line) {
  double least = 1e300;
  for (std::size_t i = 0; i + 1 < line.size(); ++i)
    least = std::min(least, distance_to(p, line[i], line[i + 1]));
  return least;
}

Place between(const Place& a, const Place& b, double t) {
  return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}

using Edges = std::vector<std::pair<uint32_t, uint32_t>>;

// The edges of which every place is near the line.
Edges edges_near(const library::Mesh& mesh, const Line& line, double most) {
  std::set<std::pair<uint32_t, uint32_t>> all;
  for (const auto& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) {
      const uint32_t a = t[static_cast<std::size_t>(i)],
                     b = t[static_cast<std::size_t>((i + 1) % 3)];
      all.insert({std::min(a, b), std::max(a, b)});
    }
  }
  Edges near;
  for (const auto& [a, b] : all) {
    bool is_near = true;
    for (int i = 0; i <= 32 && is_near; ++i) {
      is_near = distance_to(between(mesh.vertices[a], mesh.vertices[b], i / 32.0), line) <= most;
    }
    if (is_near) near.push_back({a, b});
  }
  return near;
}

// Whether edges lead from near the beginning of the line to near its end, and all places on the
// line are near one of them, at a height within `room` if the line has heights.
bool follows(const library::Mesh& mesh, const Line& line, double step, double room) {
  const double most = kShift * step;
  const Edges edges = edges_near(mesh, line, most);
  std::set<uint32_t> reached;
  for (const auto& [a, b] : edges) {
    for (const uint32_t v : {a, b}) {
      if (distance_to(mesh.vertices[v], line.front(), line.front()) <= most) reached.insert(v);
    }
  }
  for (std::size_t before = 0; before != reached.size();) {
    before = reached.size();
    for (const auto& [a, b] : edges) {
      if (reached.count(a) + reached.count(b) == 1) reached.insert({a, b});
    }
  }
  const bool ends = std::any_of(reached.begin(), reached.end(), [&](uint32_t v) {
    return distance_to(mesh.vertices[v], line.back(), line.back()) <= most;
  });
  bool is_covered = ends;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    for (int k = 0; k <= 64 && is_covered; ++k) {
      const Place p = between(line[i], line[i + 1], k / 64.0);
      is_covered = std::any_of(edges.begin(), edges.end(), [&](const auto& edge) {
        const Place &a = mesh.vertices[edge.first], &b = mesh.vertices[edge.second];
        if (reached.count(edge.first) == 0 || distance_to(p, a, b) > most + 1e-9) return false;
        if (p[2] < 0) return true;
        const double x = b[0] - a[0], y = b[1] - a[1];
        const double t = ((p[0] - a[0]) * x + (p[1] - a[1]) * y) / (x * x + y * y);
        const double z = between(a, b, std::min(std::max(t, 0.0), 1.0))[2];
        return std::abs(z - p[2]) <= room + 1e-3;
      });
    }
  }
  return is_covered;
}

void expect_run(const Session& session, const std::string& words) {
  const Session::Result result = session.run(words);
  REQUIRE_MESSAGE(result.code == 0, (words + ": " + result.err));
}

library::Mesh mesh_of(const Session& session, const std::string& file) {
  return library::Surface::from_file(session.folder() + "/" + file).mesh();
}

// Encodes and verifies; each line is a chain of edges then.
void expect_edges(const Session& session, const std::vector<Line>& lines, double step,
                  const std::string& options, double room = 0) {
  write_lines(session, lines);
  expect_run(session, "encode t.asc --units metre --breaklines lines.csv -o t.mtin " + options);
  expect_run(session, "verify t.mtin t.asc --units metre --breaklines lines.csv");
  const library::Mesh mesh = mesh_of(session, "t.mtin");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    CHECK_MESSAGE(follows(mesh, lines[i], step, room), ("line " + std::to_string(i) + options));
  }
}

// Lines that meet at small angles at a post, and two that cross them.
std::vector<Line> fan() {
  std::vector<Line> lines;
  lines.reserve(11);
  for (int i = 0; i < 9; ++i) lines.push_back({{5, 5, -1}, {50.0, 12 + 1.3 * i, -1}});
  lines.push_back({{30, 2, -1}, {41, 40, -1}});
  lines.push_back({{12, 40.4, -1}, {55.7, 8.2, -1}, {57, 30, -1}});
  return lines;
}

// Along rows, columns and diagonals of posts, some of them halfway between, and one twice.
std::vector<Line> straight() {
  return {{{3, 10, -1}, {55, 10, -1}},     {{20, 4, -1}, {20, 44, -1}},
          {{2, 2, -1}, {40, 40, -1}},      {{8, 40, -1}, {44, 4, -1}},
          {{3, 20.5, -1}, {50, 20.5, -1}}, {{30.5, 3, -1}, {30.5, 44, -1}},
          {{3, 10, -1}, {55, 10, -1}}};
}

std::vector<Line> bent() {
  Line wave, ring;
  for (int i = 0; i <= 100; ++i) {
    wave.push_back({4 + 0.5 * i, 23 + 12 * std::sin(i * 0.17), -1});
    ring.push_back(
        {30 + 11 * std::cos(i * 0.06283185307), 24 + 9 * std::sin(i * 0.06283185307), -1});
  }
  ring.back() = ring.front();
  return {wave, ring};
}

// Encodes a pack; edges follow each line through its tiles then, and shards give the same bytes.
void expect_edges_of_pack(const Session& session, const std::vector<Line>& lines, int tile_size,
                          const std::string& options, double room = 0) {
  write_lines(session, lines);
  const std::string same = "t.asc --units metre --breaklines lines.csv --max-error " + options;
  const std::string whole = same + " --tile-size " + std::to_string(tile_size);
  expect_run(session, "encode " + whole + " -o t.mtp");
  expect_run(session, "verify t.mtp t.asc --units metre --breaklines lines.csv");
  const library::Mesh mesh = mesh_of(session, "t.mtp");
  for (std::size_t i = 0; i < lines.size(); ++i) {
    CHECK_MESSAGE(follows(mesh, lines[i], 10, room), ("line " + std::to_string(i) + options));
  }
  const std::string plan = session.run("plan --shards 2 " + whole).out;
  std::string files;
  std::size_t begin = 0;
  for (std::size_t end = plan.find('\n'); end != std::string::npos; end = plan.find('\n', begin)) {
    const std::string file = std::to_string(begin) + ".shard";
    expect_run(session,
               join({"encode ", same, " ", plan.substr(begin, end - begin), " -o ", file}));
    files += file + ' ';
    begin = end + 1;
  }
  expect_run(session, join({"merge ", files, "-o m.mtp"}));
  CHECK(session.read("m.mtp") == session.read("t.mtp"));
}

// Lines on and near the borders of tiles of 10 steps: half a step away, across at small angles,
// bending there, through corners and near these.
std::vector<Line> beside_borders() {
  return {{{10, 2, -1}, {10, 44, -1}},
          {{2, 9.5, -1}, {58, 9.5, -1}},
          {{2, 30.5, -1}, {58, 30.5, -1}},
          {{29.7, 1, -1}, {30.4, 45, -1}},
          {{1, 20.3, -1}, {59, 19.6, -1}},
          {{40.2, 3, -1}, {39.9, 22, -1}, {40.1, 41, -1}},
          {{13, 33, -1}, {26, 46, -1}},
          {{42, 12.2, -1}, {58, 28.2, -1}},
          {{50, 2, -1}, {50.4, 10, -1}, {49.8, 15, -1}, {55, 18, -1}},
          {{20.3, 20.2, -1}, {22, 25, -1}},
          {{44, 40.1, -1}, {51.2, 40.2, -1}, {44, 40.4, -1}},
          {{21.4, 2, -1}, {18.8, 28, -1}},
          {{5, 15.3, -1}, {17, 24.9, -1}},
          {{3, 38.2, -1}, {14, 41.6, -1}},
          {{52.4, 32, -1}, {56, 42.9, -1}, {47.9, 43.2, -1}}};
}

// Lines at some height above the ground, with a place for each fortieth of a segment.
std::vector<Line> with_heights(std::vector<Line> lines, double above) {
  for (Line& line : lines) {
    Line dense;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      for (int k = 0; k < 40; ++k) dense.push_back(between(line[i], line[i + 1], k / 40.0));
    }
    dense.push_back(line.back());
    for (Place& p : dense) p[2] = ground_at(p[0], p[1]) + above + std::sin(p[0] + p[1]);
    line = dense;
  }
  return lines;
}

}  // namespace

TEST_CASE("breaklines: fans, crossings, rows, diagonals and curves are edges at every step") {
  for (const auto& [cell, step] : {std::pair{30.0, 1.0}, {1.0, 1.0}, {1.0, 0.25}}) {
    const Session session;
    write_terrain(session, cell);
    const std::string xy = " --xy-step " + std::string(step == 1 ? "1" : "0.25");
    for (const std::vector<Line>& lines : {fan(), straight(), bent()}) {
      expect_edges(session, placed(lines, cell), cell * step, "--max-error 12" + xy);
    }
  }
}

TEST_CASE("breaklines: packs have them across and along the borders of their tiles") {
  const Session session;
  write_terrain(session, 10);
  for (const std::vector<Line>& lines : {fan(), straight(), bent(), beside_borders()}) {
    expect_edges_of_pack(session, placed(lines, 10), 10, "12");
    expect_edges_of_pack(session, placed(lines, 10), 7, "30");
    expect_edges_of_pack(session, placed(lines, 10), 23, "4 --fast");
    expect_edges_of_pack(session, placed(lines, 10), 10, "12 --never-below");
  }
}

TEST_CASE("breaklines: packs keep the heights of lines along borders, too") {
  const Session session;
  write_terrain(session, 10);
  const auto lines = [](double above) { return placed(with_heights(beside_borders(), above), 10); };
  expect_edges_of_pack(session, lines(-5.5), 10, "60", 60);
  expect_edges_of_pack(session, lines(-40), 10, "60", 60);
  expect_edges_of_pack(session, lines(50), 7, "90", 90);
  expect_edges_of_pack(session, lines(-5.5), 9, "90 --never-below", 90);
}

TEST_CASE("breaklines: between its vertices a border keeps the heights of a line, too") {
  const Session session;
  std::string text = "ncols 61\nnrows 47\nxllcenter 1000\nyllcenter 2000\ncellsize 10\n";
  for (int row = kRows - 1; row >= 0; --row) {
    for (int column = 0; column < kColumns; ++column) {
      const bool is_hill = column > 7 && column < 13 && row > 20 && row < 26;
      text += is_hill ? "175 " : "100 ";
    }
  }
  session.write("t.asc", text);
  // The hill's lowest surface within the bound is a little below the line's highest.
  expect_edges_of_pack(session, placed({{{10, 2, 60}, {10, 44, 60}}}, 10), 10, "60", 60);
}

TEST_CASE("breaklines: shards of other lines do not join") {
  const Session session;
  write_terrain(session, 10);
  for (const int shard : {0, 1}) {
    write_lines(session, placed({{{5, 12, -1}, {50, 30.0 + shard, -1}}}, 10));
    expect_run(session, join({"encode t.asc --units metre --max-error 12 --breaklines lines.csv ",
                              "--tile-size 30 --shard ", shard == 0 ? "0:1" : "2:3", " -o ",
                              std::to_string(shard), ".shard"}));
  }
  CHECK(contains(session.failure("merge 0.shard 1.shard -o m.mtp"), "made with other options"));
}

TEST_CASE("breaklines: a pack is brought up to date with them") {
  const Session session;
  write_terrain(session, 10);
  write_lines(session, placed(beside_borders(), 10));
  const std::string options = "t.asc --units metre --breaklines lines.csv -o ";
  expect_run(session, join({"encode --max-error 12 --tile-size 10 ", options, "t.mtp"}));
  const std::string kept = session.run(join({"update t.mtp ", options, "u.mtp"})).out;
  CHECK_MESSAGE(contains(kept, "kept: 30 of 30 tiles"), kept);
  CHECK(session.read("u.mtp") == session.read("t.mtp"));
  expect_run(session, "encode t.asc --units metre --max-error 12 --tile-size 10 -o p.mtp");
  const std::string added =
      session.run(join({"update p.mtp --tile-vertices 400 ", options, "u.mtp"})).out;
  CHECK_MESSAGE(!contains(added, "kept: 30"), added);
  expect_run(session, "verify u.mtp t.asc --units metre --breaklines lines.csv");
  const library::Mesh mesh = mesh_of(session, "u.mtp");
  for (const Line& line : placed(beside_borders(), 10)) CHECK(follows(mesh, line, 10, 0));
}

TEST_CASE("breaklines: a pack that keeps its bound everywhere by chance is updated with them") {
  const Session session;
  std::string text = "ncols 61\nnrows 47\nxllcenter 1000\nyllcenter 2000\ncellsize 10\n";
  for (int post = 0; post < kColumns * kRows; ++post) text += post % 2 == 0 ? "50 " : "51 ";
  session.write("t.asc", text);
  write_lines(session, placed(bent(), 10));
  const std::string options = "t.asc --units metre --breaklines lines.csv -o ";
  expect_run(session, join({"encode --max-error 9 --tile-size 10 ", options, "t.mtp"}));
  const auto info = library::Surface::from_file(session.folder() + "/t.mtp").info();
  REQUIRE(std::stod(info.max_below_everywhere) <= 9);
  REQUIRE(std::stod(info.max_above_everywhere) <= 9);
  expect_run(session, join({"update t.mtp ", options, "u.mtp"}));
  CHECK(session.read("u.mtp") == session.read("t.mtp"));
  CHECK(contains(session.failure(join({"update t.mtp --bound-at everywhere ", options, "u.mtp"})),
                 "do not go together"));
}

TEST_CASE("breaklines: every way to search keeps them") {
  const Session session;
  write_terrain(session, 10);
  session.write("map.geojson", R"({"type": "Feature", "properties": {"max_error": 2},
"geometry": {"type": "Polygon",
"coordinates": [[[1100, 2100], [1300, 2100], [1300, 2300], [1100, 2100]]]}})");
  const std::vector<Line> lines = placed(fan(), 10);
  for (const char* options :
       {"--max-error 12 --fast", "--max-error 12 --best", "--max-error 12 --never-below",
        "--max-bytes 900", "--max-vertices 700", "--max-error 12 --water-level 300",
        "--max-error 12 --error-map map.geojson",
        "--max-bytes 1500 --error-map map.geojson --max-error 12", "--max-error 12 --coding dense",
        "--max-error 12 --z-step 5", "--max-error 0.5"}) {
    CAPTURE(options);
    write_lines(session, lines);
    const std::string made = options;
    expect_run(session, "encode t.asc --units metre --breaklines lines.csv -o t.mtin " + made);
    std::string same;
    if (contains(made, "--error-map")) same = " --error-map map.geojson";
    if (contains(made, "--water-level")) same = " --water-level 300";
    if (contains(made, "--never-below")) same = " --never-below";
    expect_run(session, "verify t.mtin t.asc --units metre --breaklines lines.csv" + same);
    const library::Mesh mesh = mesh_of(session, "t.mtin");
    for (const Line& line : lines) CHECK(follows(mesh, line, 10, 0));
  }
  CHECK(session.read("t.mtin").size() > 0);
}

TEST_CASE("breaklines: heights of lines are within the bound along all of them") {
  const Session session;
  write_terrain(session, 10);
  const auto above = [](double column, double row, double more) {
    return Place{column, row, std::floor(ground_at(column, row)) + more};
  };
  Line ridge;  // from post to post, some metres above and below
  for (int i = 0; i < 40; ++i) {
    const int half = i / 2;
    ridge.push_back(above(8 + i, 10 + half, i % 2 == 0 ? 4 : -3));
  }
  const std::vector<Line> lines = placed({ridge, {above(5, 40, 0), above(6, 41, 2)}}, 10);
  expect_edges(session, lines, 10, "--max-error 9", 9);
  expect_edges(session, lines, 10, "--max-error 9 --fast", 9);
  expect_edges(session, lines, 10, "--max-error 15 --never-below", 15);
  expect_edges(session, lines, 10, "--max-error 9 --best", 9);
  const std::string report =
      session.run("verify t.mtin t.asc --units metre --breaklines lines.csv").out;
  CHECK(contains(report, "\"max_error\": "));
  CHECK(!contains(report, "\"max_error\": 0.0}"));
}

TEST_CASE("breaklines: parts outside and over voids are left out") {
  const Session session;
  write_terrain(session, 10, 40);
  write_lines(session, placed({{{-30, 25, -1}, {90, 25.2, -1}},
                               {{-9, -9, -1}, {-9, 60, -1}},
                               {{-9, -9, -1}, {1e12, -1e12, -1}, {1e12, 1e12, -1}}},
                              10));
  expect_run(session, "encode t.asc --units metre --max-error 9 --breaklines lines.csv -o t.mtin");
  expect_run(session, "verify t.mtin t.asc --units metre --breaklines lines.csv");
  const library::Mesh mesh = mesh_of(session, "t.mtin");
  CHECK(follows(mesh, placed({{{0, 25.05, -1}, {39, 25.115, -1}}}, 10)[0], 10, 0));
  CHECK(follows(mesh, placed({{{48, 25.13, -1}, {60, 25.15, -1}}}, 10)[0], 10, 0));
  CHECK(contains(session
                     .run("encode t.asc --units metre --max-error 9 --breaklines lines.csv "
                          "-o o.mtin")
                     .out,
                 "breaklines: 1 lines"));
}

TEST_CASE("breaklines: lines that cross share one vertex there") {
  const Session session;
  std::string text = "ncols 61\nnrows 47\nxllcenter 1000\nyllcenter 2000\ncellsize 10\n";
  for (int i = 0; i < kColumns * kRows; ++i) text += std::to_string(100 + i % kColumns) + ' ';
  session.write("t.asc", text);
  write_lines(session, placed({{{10, 10, -1}, {50, 40, -1}}, {{12, 43, -1}, {42, 13, -1}}}, 10));
  const std::string report =
      session.run("encode t.asc --units metre --max-error 1 --breaklines lines.csv -o t.mtin").out;
  CHECK_MESSAGE(contains(report, "breaklines: 2 lines are 4 edges between 5 vertices"), report);
}

TEST_CASE("breaklines: points have them too, at positions without a point") {
  const Session session;
  std::string points;
  for (int i = 0; i < 1500; ++i) {
    const int x = i * 7919 % 997, y = i * 104729 % 991;
    points += std::to_string(x) + ' ' + std::to_string(y) + ' ' +
              std::to_string(std::lround(50 + 20 * std::sin(x * 0.02) + y % 7)) + '\n';
  }
  session.write("p.xyz", points);
  const std::vector<Line> lines = {{{150, 140, -1}, {801.3, 822.2, -1}},
                                   {{180.5, 900, -1}, {500, 480.25, -1}, {900, 130, -1}}};
  write_lines(session, lines);
  struct Row {
    const char* options;
    double step;
  };
  for (const Row& row :
       {Row{"--max-error 4", 1}, Row{"--max-error 4 --xy-step 0.25", 0.25},
        Row{"--max-error 6 --xy-step 5 --duplicates mean --bound-at lattice", 5}}) {
    CAPTURE(row.options);
    expect_run(session,
               std::string("encode p.xyz --breaklines lines.csv -o p.mtin ") + row.options);
    expect_run(session, "verify p.mtin p.xyz --breaklines lines.csv");
    const library::Mesh mesh = mesh_of(session, "p.mtin");
    for (const Line& line : lines) CHECK(follows(mesh, line, row.step, 0));
  }
}

TEST_CASE("breaklines: verify finds lines that are no edges, and heights beyond the bound") {
  const Session session;
  write_terrain(session, 10);
  const std::vector<Line> lines = placed({{{3, 10.5, -1}, {55, 31, -1}}}, 10);
  write_lines(session, lines);
  expect_run(session, "encode t.asc --units metre --max-error 9 -o t.mtin");
  CHECK(!follows(mesh_of(session, "t.mtin"), lines[0], 10, 0));
  const Session::Result missing =
      session.run("verify t.mtin t.asc --units metre --breaklines lines.csv");
  CHECK(missing.code == 1);
  CHECK(contains(missing.err, "line 1 has no edges"));
  expect_run(session, "encode t.asc --units metre --max-error 9 --breaklines lines.csv -o t.mtin");
  const std::vector<Line> high = placed({{{3, 10.5, 500}, {55, 31, 500}}}, 10);
  write_lines(session, high);
  CHECK(session.run("verify t.mtin t.asc --units metre --breaklines lines.csv").code == 1);
}

namespace {

// Lines apart from each other, of three classes.
std::vector<Line> apart() {
  return {{{4, 5, -1}, {30, 12.4, -1}, {52, 6, -1}},
          {{5, 40, -1}, {22, 24, -1}},
          {{30, 40, -1}, {56, 22, -1}, {50, 14, -1}}};
}
constexpr LineClass kApart[] = {LineClass::kRidge, LineClass::kWater, LineClass::kOther};

void write_apart(const Session& session) {
  const std::vector<Line> lines = placed(apart(), 10);
  std::string text = "x,y,line,class\n";
  for (std::size_t i = 0; i < lines.size(); ++i) {
    for (const Place& p : lines[i]) {
      text += std::to_string(p[0]) + ',' + std::to_string(p[1]) + ',' + std::to_string(i) + ',' +
              std::string(name_of(kApart[i])) + '\n';
    }
  }
  session.write("lines.csv", text);
}

std::vector<MarkedLine> lines_of(const std::string& stream) {
  return stream::DecodedTerrain({stream.begin(), stream.end()}).lines();
}

// Other marks behind the same stream.
void write_marked(const Session& session, const std::string& from,
                  const std::vector<MarkedLine>& lines, const std::string& to) {
  const std::string old = session.read(from);
  std::vector<uint8_t> stream(old.begin(), old.end());
  const stream::DecodedTerrain decoded(stream);
  stream.resize(stream.size() - decoded.mark_bytes());
  stream::append_edge_marks(decoded.mesh(), lines, stream);
  session.write(to, {stream.begin(), stream.end()});
}

// Whether the edges of each class are near lines of this class, and lead along them.
bool marks_lines(const library::Mesh& mesh, const std::vector<MarkedLine>& marks) {
  const bool is_class = std::all_of(marks.begin(), marks.end(), [](const MarkedLine& mark) {
    return std::count(std::begin(kApart), std::end(kApart), mark.kind) != 0;
  });
  if (!is_class) return false;
  const std::vector<Line> lines = placed(apart(), 10);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    library::Mesh part;
    part.vertices = mesh.vertices;
    std::size_t edges = 0;
    for (const MarkedLine& mark : marks) {
      if (mark.kind != kApart[i]) continue;
      for (std::size_t k = 1; k < mark.vertices.size(); ++k, ++edges) {
        part.triangles.push_back({mark.vertices[k - 1], mark.vertices[k], mark.vertices[k]});
      }
    }
    std::size_t near = 0;
    for (const auto& [a, b] : edges_near(part, lines[i], kShift * 10)) near += a != b ? 1 : 0;
    if (near != edges || !follows(part, lines[i], 10, 0)) return false;
  }
  return true;
}

// One edge less, another class, or an edge more.
std::vector<MarkedLine> changed(std::vector<MarkedLine> lines, const library::Mesh& mesh,
                                Random& random) {
  MarkedLine& line = lines[random.below(static_cast<uint32_t>(lines.size()))];
  const uint32_t at = random.below(static_cast<uint32_t>(line.vertices.size() - 1));
  const std::vector<uint32_t> edge = {line.vertices[at], line.vertices[at + 1]};
  const auto kind = static_cast<LineClass>(1 + random.below(4));
  const uint32_t what = random.below(3);
  if (what == 0) {
    const auto middle = line.vertices.begin() + at + 1;
    const MarkedLine rest{line.kind, {middle, line.vertices.end()}};
    line.vertices.erase(middle, line.vertices.end());
    lines.push_back(rest);
  } else if (what == 1) {
    lines.insert(lines.begin(), {kind, edge});
  } else {
    const auto& t = mesh.triangles[random.below(static_cast<uint32_t>(mesh.triangles.size()))];
    lines.push_back({kind, {t[0], t[1]}});
  }
  return lines;
}

}  // namespace

TEST_CASE("breaklines: verify compares the marks with the lines") {
  const Session session;
  write_terrain(session, 10);
  write_apart(session);
  expect_run(session, "encode t.asc --units metre --max-error 9 --breaklines lines.csv -o t.mtin");
  const library::Mesh mesh = mesh_of(session, "t.mtin");
  const std::string bytes = session.read("t.mtin");
  const std::vector<MarkedLine> lines = lines_of(bytes);
  CHECK(marks_lines(mesh, lines));
  write_marked(session, "t.mtin", lines, "same.mtin");
  CHECK(session.read("same.mtin") == bytes);
  Random random(4);
  std::size_t refused = 0;
  for (int i = 0; i < 40; ++i) {
    const std::vector<MarkedLine> other = changed(lines, mesh, random);
    write_marked(session, "t.mtin", other, "other.mtin");
    const std::string verify = "verify other.mtin t.asc --units metre --breaklines lines.csv";
    const Session::Result result = session.run(verify);
    const bool is_right = marks_lines(mesh, lines_of(session.read("other.mtin")));
    CHECK_MESSAGE((result.code == 0) == is_right, result.err);
    if (is_right) continue;
    ++refused;
    CHECK(contains(result.err, "; encode it again with --breaklines lines.csv, or name "));
  }
  CHECK(refused > 15);
}

TEST_CASE("breaklines: verify names the mark or the line that is wrong") {
  const Session session;
  write_terrain(session, 10);
  write_apart(session);
  const std::string options = "t.asc --units metre --max-error 9 --breaklines lines.csv -o t.mtin";
  expect_run(session, "encode " + options);
  const auto refusal = [&](const std::vector<MarkedLine>& lines) {
    write_marked(session, "t.mtin", lines, "other.mtin");
    return session.failure("verify other.mtin t.asc --units metre --breaklines lines.csv");
  };
  CHECK(
      contains(refusal({}), "other.mtin: breaklines: line 1 has no edges marked as ridge from x "));
  const std::string bytes = session.read("t.mtin");
  std::vector<MarkedLine> lines = lines_of(bytes);
  for (MarkedLine& line : lines) line.kind = LineClass::kWall;
  CHECK(contains(refusal(lines), " is marked as wall, and follows no line of this class; encode"));
}

TEST_CASE("breaklines: an edge of several lines has the class of the first one") {
  const Session session;
  write_terrain(session, 10);
  const auto verify = [&](const std::string& first, const std::string& second) {
    session.write("lines.csv", "x,y,class\n1030,2100," + first + "\n1500,2100," + first +
                                   "\n\n1030,2100," + second + "\n1500,2100," + second + '\n');
    return session.run("verify t.mtin t.asc --units metre --breaklines lines.csv");
  };
  verify("dam", "road");
  expect_run(session, "encode t.asc --units metre --max-error 9 --breaklines lines.csv -o t.mtin");
  CHECK(verify("dam", "road").code == 0);
  CHECK(contains(verify("road", "dam").err, "line 1 has no edges marked as road"));
}

TEST_CASE("breaklines: GeoJSON and text say the same lines") {
  const Session session;
  write_terrain(session, 10);
  session.write("a.geojson", R"({"type": "FeatureCollection", "features": [
{"type": "Feature", "geometry":
  {"type": "LineString", "coordinates": [[1050, 2050], [1500, 2300]]}},
{"type": "Feature", "geometry": {"type": "MultiLineString", "coordinates":
  [[[1050, 2300, 230], [1060, 2300, 232.5]]]}},
{"type": "Feature", "geometry": {"type": "Polygon", "coordinates":
  [[[1400, 2100], [1500, 2100], [1450, 2200], [1400, 2100]]]}}]})");
  session.write("b.csv",
                "# positions\nLine;X;Y;Z\nr;1050;2050;\nr;1500;2300;\ns;1050;2300;230\n"
                "s;1060;2300;232.5\nt;1400;2100;\nt;1500;2100;\nt;1450;2200;\nt;1400;2100;\n");
  session.write("c.txt",
                "1050 2050\n1500 2300\n\n\n1050 2300 230\n1060 2300 232.5\n\n1400 2100\n"
                "1500 2100\n1450 2200\n1400 2100\n");
  std::string first;
  for (const char* file : {"a.geojson", "b.csv", "c.txt"}) {
    expect_run(session, std::string("encode t.asc --units metre --max-error 40 -o t.mtin "
                                    "--breaklines ") +
                            file);
    if (first.empty()) first = session.read("t.mtin");
    CHECK(session.read("t.mtin") == first);
  }
}

TEST_CASE("breaklines: a header that states other units or depths is refused, by each command") {
  const Session session;
  write_terrain(session, 10);
  session.write("good.csv", "X [m],Y [m],Z [m],line\n1050,2050,\n1500,2300,\n");
  for (const char* output : {"o.mtin", "o.mtp"}) {
    expect_run(session, join({"encode t.asc --units metre --max-error 40 --breaklines good.csv -o ",
                              output}));
  }
  const auto expect_refused = [&](const std::string& header, const std::string& reason) {
    session.write("l.csv", header + "\n1050,2050,230\n1500,2300,230\n");
    for (const char* command :
         {"encode t.asc --max-error 40 -o a.mtin", "encode t.asc --max-error 40 -o a.mtp",
          "update o.mtp t.asc -o b.mtp", "verify o.mtin t.asc", "plan t.asc --max-error 40"}) {
      const std::string message =
          session.failure(std::string(command) + " --units metre --breaklines l.csv");
      CHECK_MESSAGE(contains(message, "l.csv: " + reason), command);
    }
  };
  expect_refused("x,y,z_ft", "heights are in the unit foot, and those of the terrain in metre");
  expect_refused("x,y,Z [cm]", "heights are in the unit centimetre");
  expect_refused("x [km],y [km],z", "x and y are in the unit kilometre");
  expect_refused("lon,lat,z", "x and y are in the unit degree");
  expect_refused("x,y,depth", "the lines have depths");
}

TEST_CASE("breaklines: decimal commas are refused, and quotes around fields are none of them") {
  const Session session;
  write_terrain(session, 10);
  const auto outcome = [&](const std::string& lines) {
    session.write("l.csv", lines);
    return session.run("encode t.asc --units metre --max-error 40 -o o.mtin --breaklines l.csv")
        .err;
  };
  CHECK(outcome(R"("x","y","line")"
                "\n"
                R"("1050","2050","a")"
                "\n"
                R"("1500","2300","a")")
            .empty());
  CHECK(outcome("1050,2050,,1.a\n1500,2300,,1.a\n").empty());
  for (const char* const lines :
       {"1050,05,2050,03\n1500,07,2300,02\n", "x,y\n1050,5,2050,3\n1500,7,2300,2\n",
        "1050,5;2050,3\n1500,7;2300,2\n", "1050,5 2050,3\n1500,7 2300,2\n"}) {
    CHECK_MESSAGE(contains(outcome(lines), "l.csv:"), lines);
  }
}

TEST_CASE("breaklines: what cannot be kept is refused") {
  const Session session;
  write_terrain(session, 10);
  const auto refusal = [&](const std::string& lines, const std::string& options) {
    session.write("l.csv", lines);
    return session.failure("encode t.asc --units metre --breaklines l.csv " + options);
  };
  const std::string line = "1050 2050\n1500 2300\n";
  CHECK(contains(refusal(line, "-o o.mtin"), "--breaklines needs a bound"));
  CHECK(contains(refusal(line, "-o o.mtp"), "--breaklines needs a bound"));
  for (const char* output : {"o.mtin", "o.mtp"}) {
    CHECK(contains(refusal(line, join({"--max-error 9 --bound-at everywhere -o ", output})),
                   "do not go together"));
  }
  session.write("p.xyz", "0 0 1\n9 0 2\n0 9 3\n9 9 4\n");
  CHECK(contains(session.failure("encode p.xyz --max-error 1 --breaklines l.csv -o o.mtp"),
                 "make a stream"));
  CHECK(contains(refusal("", "--max-error 9 -o o.mtin"), "l.csv: has no line"));
  CHECK(contains(refusal("1 2\n", "--max-error 9 -o o.mtin"), "a single position"));
  CHECK(contains(refusal("1 2\n3 x\n", "--max-error 9 -o o.mtin"), "l.csv:2: "));
  CHECK(contains(refusal("a,b\n1,2\n", "--max-error 9 -o o.mtin"), "named as x and y"));
  CHECK(contains(refusal("1 2 3\n4 5\n", "--max-error 9 -o o.mtin"), "with and without a height"));
  const std::string wall = "1050 2050 300\n1300 2050 300\n\n1050 2052 390\n1300 2052 390\n";
  const std::string two = refusal(wall, "--max-error 9 -o o.mtin");
  CHECK(contains(two, "x 1050, y 2050"));
  CHECK(contains(two, "line 1 at 300"));
  CHECK(contains(two, "line 2 at 390"));
  CHECK(contains(refusal("1050 2050 900\n1300 2050 900\n", "--max-error 9 -o o.mtin"),
                 "the terrain at "));
}

TEST_CASE("breaklines: lines that all lie elsewhere are refused, by each command") {
  const Session session;
  write_terrain(session, 10);
  session.write("l.csv", "2050 1050\n2300 1500\n\n2050 1060\n2300 1510\n");  // y before x
  const std::string text = "breaklines: no line lies on the terrain; compare the order";
  const std::string options = "t.asc --units metre --max-error 9 ";
  for (const char* output : {"o.mtin", "o.mtp"}) {
    CHECK(contains(session.failure(join({"encode ", options, "--breaklines l.csv -o ", output})),
                   text));
    REQUIRE(session.run(join({"encode ", options, "-o ", output})).code == 0);
    CHECK(contains(
        session.failure(join({"verify ", output, " t.asc --units metre --breaklines l.csv"})),
        text));
  }
  CHECK(contains(session.failure("plan " + options + "--breaklines l.csv"), text));
  CHECK(contains(session.failure("update o.mtp t.asc --units metre --breaklines l.csv -o n.mtp"),
                 text));
}

TEST_CASE("breaklines: a number is no class") {
  const Session session;
  write_terrain(session, 10);
  session.write("l.geojson",
                R"({"type":"Feature","properties":{"class":3},"geometry":{"type":"LineString",)"
                R"("coordinates":[[1050,2050],[1500,2300]]}})");
  CHECK(contains(
      session.failure("encode t.asc --units metre --max-error 9 --breaklines l.geojson -o o.mtin"),
      "l.geojson:1: '3' is not a class of lines; use one of "));
}

}  // namespace microtin::breaklines_test
