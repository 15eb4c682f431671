// SPDX-License-Identifier: MIT
// What the encoder writes, the decoder rebuilds: the canonical triangulation of the same points.
#include "encoder/stream/encode.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/stream/header.hpp"
#include "tests/support/mesh_copy.hpp"
#include "tests/support/point_sets.hpp"
#include "tests/support/slow.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

using Bytes = std::vector<uint8_t>;

Tin tin_of(const Points& points, Random& random) {
  Tin tin;
  for (const Point p : points) {
    tin.vertices.push_back(Vertex{p.x, p.y, static_cast<int16_t>(random.below(65536) - 32768)});
  }
  return tin;
}

std::vector<Vertex> sorted(std::vector<Vertex> vertices) {
  std::sort(vertices.begin(), vertices.end(), [](const Vertex& a, const Vertex& b) {
    return Point{a.x, a.y} < Point{b.x, b.y};
  });
  return vertices;
}

bool same_vertices(const std::vector<Vertex>& a, const std::vector<Vertex>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Vertex& p, const Vertex& q) {
    return p.x == q.x && p.y == q.y && p.z == q.z;
  });
}

// Empty, or what is wrong with the stream of `tin`.
std::string round_trip_fault(const Tin& tin, const Effort& effort,
                             bool (*is_right)(const Points&, const TriangleSet&)) {
  const DecodedTerrain decoded(encode(tin, Metadata(), effort));
  const MeshCopy copy(decoded.mesh());
  std::vector<Vertex> vertices;
  for (uint32_t v = 0; v < copy.place.size(); ++v) {
    vertices.push_back(Vertex{copy.place[v].x, copy.place[v].y, copy.z[v]});
  }
  if (!same_vertices(sorted(vertices), sorted(tin.vertices))) return "other vertices";
  std::string fault = mesh_fault(copy.mesh, copy.mesh.vertices);
  if (!fault.empty()) return fault;
  return is_right(copy.place, triangles_of(copy.mesh)) ? "" : "not the canonical triangulation";
}

constexpr Effort kEfforts[] = {{6, Coding::kQuick},
                               {8, Coding::kBalanced},
                               {10, Coding::kBalanced},
                               {12, Coding::kDense},
                               {32, Coding::kBalanced}};

// Triangles as the places of their corners.
std::set<std::set<std::array<int64_t, 3>>> triangles_in(const SurfaceModel& model) {
  std::set<std::set<std::array<int64_t, 3>>> all;
  for (const auto& [a, b, c] : model.triangles) {
    all.insert({model.vertices[a], model.vertices[b], model.vertices[c]});
  }
  return all;
}

bool equals_definition(const Points& points, const TriangleSet& set) {
  return reference_delaunay(points) == set;
}

}  // namespace

TEST_CASE("round trip: small sets decode to the triangulation by definition" * kSlow) {
  std::vector<PointSet> sets = tiny_point_sets();
  for (uint64_t seed = 11; seed <= 14; ++seed) {
    for (const uint32_t n : {10u, 15u, 24u}) {
      for (PointSet& set : point_sets(n, seed)) sets.push_back(std::move(set));
    }
  }
  Random random(1);
  for (const PointSet& set : sets) {
    for (const Effort& effort : kEfforts) {
      CAPTURE(set.name);
      CAPTURE(effort.degree);
      CHECK(round_trip_fault(tin_of(set.points, random), effort, equals_definition) == "");
    }
  }
}

TEST_CASE("round trip: sets of some thousands decode to the canonical triangulation" * kSlow) {
  Random random(2);
  for (const uint32_t n : {300u, 2500u}) {
    for (const PointSet& set : point_sets(n, n)) {
      for (const Effort& effort : kEfforts) {
        if (n > 1000 && effort.degree != 10) continue;
        CAPTURE(set.name);
        CAPTURE(effort.degree);
        CHECK(round_trip_fault(tin_of(set.points, random), effort, is_reference_delaunay) == "");
      }
    }
  }
}

TEST_CASE("round trip: every cell of whole lattices") {
  Random random(3);
  for (uint32_t columns = 2; columns <= 12; ++columns) {
    for (const uint32_t rows : {2u, 3u, 7u, 12u}) {
      const Points points = lattice_points(columns, rows, random);
      CHECK(round_trip_fault(tin_of(points, random), {6, Coding::kQuick}, is_reference_delaunay) ==
            "");
      CHECK(round_trip_fault(tin_of(points, random), {8, Coding::kDense}, is_reference_delaunay) ==
            "");
    }
  }
}

TEST_CASE("the first bytes of a stream make its first vertices, in their own triangulation") {
  Random random(5);
  for (const PointSet& set : point_sets(120, 5)) {
    CAPTURE(set.name);
    const Tin tin = tin_of(set.points, random);
    const Bytes stream = encode(tin, Metadata());
    const SurfaceModel whole = model_of(DecodedTerrain(stream).mesh());
    CHECK(triangles_in(model_after(stream, stream.size())) == triangles_in(whole));
    size_t vertices = 0;
    for (size_t bytes = 1; bytes < stream.size(); bytes += stream.size() / 5) {
      const SurfaceModel part = model_after(stream, bytes);
      REQUIRE(part.vertices.size() <= whole.vertices.size());
      CHECK(std::equal(part.vertices.begin(), part.vertices.end(), whole.vertices.begin()));
      CHECK(part.vertices.size() >= vertices);
      vertices = part.vertices.size();
      if (part.triangles.empty()) continue;  // the first ones may lie on one line
      Tin first;
      for (const auto& [x, y, z] : part.vertices) {
        first.vertices.push_back(
            {static_cast<uint16_t>(x), static_cast<uint16_t>(y), static_cast<int16_t>(z)});
      }
      const SurfaceModel alone = model_of(DecodedTerrain(encode(first, Metadata())).mesh());
      CHECK(triangles_in(part) == triangles_in(alone));
    }
    CHECK(vertices > 3);
  }
}

TEST_CASE("the same points in any order give the same bytes") {
  Random random(4);
  for (const PointSet& set : point_sets(200, 4)) {
    Tin tin = tin_of(set.points, random);
    const std::vector<uint8_t> bytes = encode(tin, Metadata());
    std::reverse(tin.vertices.begin(), tin.vertices.end());
    CHECK(encode(tin, Metadata()) == bytes);
    std::rotate(tin.vertices.begin(), tin.vertices.begin() + 3, tin.vertices.end());
    CHECK(encode(tin, Metadata()) == bytes);
  }
}

TEST_CASE("small terrains take the order that saves bytes, others the usual one") {
  const auto bytes = [](const Tin& tin, Effort effort) {
    return encode(tin, Metadata(), effort).size();
  };
  bool wide = false;
  for (const Coding coding : kCodings) {
    const uint32_t usual = coding == Coding::kQuick ? 9 : 10;
    for (uint32_t seed = 0; seed < 40; ++seed) {
      const Tin small = rolling_tin(50, seed);
      const size_t by_usual = bytes(small, {usual, coding}), by_wide = bytes(small, {16, coding});
      const bool saves = by_usual - by_usual / 256 > by_wide;
      CHECK(bytes(small, {0, coding}) == (saves ? by_wide : by_usual));
      wide = wide || saves;
    }
    const Tin larger = rolling_tin(2000, 1);
    CHECK(encode(larger, Metadata(), {0, coding}) == encode(larger, Metadata(), {usual, coding}));
  }
  CHECK(wide);
}

TEST_CASE("void triangles come back, and no others") {
  Random random(5);
  for (const PointSet& set : point_sets(150, 5)) {
    Tin tin = tin_of(set.points, random);
    const DecodedTerrain without(encode(tin, Metadata()));
    const MeshCopy copy(without.mesh());
    std::set<std::array<Point, 3>> expected;
    for (const std::array<Point, 3>& t : triangles_of(copy.mesh).triangles) {
      if (random.below(3) != 0) continue;
      expected.insert(t);
      tin.voids.push_back(Tin::Triangle{t[0], t[1], t[2]});
    }
    if (tin.voids.empty()) continue;
    const DecodedTerrain decoded(encode(tin, Metadata()));
    std::set<std::array<Point, 3>> found;
    for (uint32_t t = 0; t < microtin_mesh_triangle_count(decoded.mesh()); ++t) {
      uint32_t v[3];
      if (microtin_mesh_triangle(decoded.mesh(), t, v) != MICROTIN_TRIANGLE_VOID) continue;
      std::array<Point, 3> corners;
      for (size_t i = 0; i < 3; ++i) {
        int16_t z = 0;
        microtin_mesh_vertex(decoded.mesh(), v[i], &corners[i].x, &corners[i].y, &z);
      }
      std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
      found.insert(corners);
    }
    CHECK(found == expected);
  }
}

TEST_CASE("placement and notes come back as they were given") {
  Random random(6);
  const Tin tin = tin_of(point_sets(20, 6)[0].points, random);
  CHECK(read_header(encode(tin, Metadata())).info.header_bytes <= 32);
  Metadata given = full_metadata();
  given.placement.x = {-9'223'372'036'854'775'807 - 1, 1, 1};
  given.placement.y = {9'223'372'036'854'775'807, (1ull << 40) - 1, (1ull << 40) - 1};
  given.placement.z = {-25, 1, 20};
  given.source = "a survey, 2019 \xC3\xA9";
  given.date = "2019-07";
  given.lineage = "noise removed";
  given.water_level = Decimal{-35, 1};
  given.accuracy = Accuracy{Decimal{5, 1}, Decimal{49, 2}, Decimal{123, 3}, Decimal{-7, 4}};
  given.true_places = Accuracy{{}, Decimal{51, 2}, Decimal{124, 3}, Decimal{0, 0}};
  given.wkt = "LOCAL_CS[\"site\"]";
  given.grid = PostGrid{3601, 1201, {-7, 1, 3}, given.placement.y};
  given.classes = ClassSet().set(0).set(2).set(8).set(9).set(254).set(255);
  given.duplicates = DuplicateRule::kMiddle;
  const Metadata read = read_header(encode(tin, given)).metadata;
  const auto same_axis = [](const Axis& a, const Axis& b) {
    return a.offset == b.offset && a.numerator == b.numerator && a.denominator == b.denominator;
  };
  CHECK(same_axis(read.placement.x, given.placement.x));
  CHECK(same_axis(read.placement.y, given.placement.y));
  CHECK(same_axis(read.placement.z, given.placement.z));
  CHECK(read.horizontal_unit == Unit::kDegree);
  CHECK(read.vertical_unit == Unit::kMetre);
  CHECK(read.horizontal_epsg == 4326);
  CHECK(read.vertical_epsg == 5773);
  CHECK(read.source == given.source);
  CHECK(read.date == given.date);
  CHECK(read.lineage == given.lineage);
  REQUIRE(read.water_level.has_value());
  CHECK(to_string(*read.water_level) == "-3.5");
  REQUIRE(read.accuracy.has_value());
  CHECK(to_string(*read.accuracy->bound) == "0.5");
  CHECK(to_string(read.accuracy->max_error) == "0.49");
  CHECK(to_string(read.accuracy->rms_error) == "0.123");
  CHECK(to_string(read.accuracy->mean_error) == "-0.0007");
  REQUIRE(read.true_places.has_value());
  CHECK(!read.true_places->bound.has_value());
  CHECK(to_string(read.true_places->max_error) == "0.51");
  CHECK(read.wkt == given.wkt);
  REQUIRE(read.grid.has_value());
  CHECK(read.grid->columns == 3601);
  CHECK(read.grid->rows == 1201);
  CHECK(same_axis(read.grid->x, given.grid->x));
  CHECK(same_axis(read.grid->y, given.grid->y));
  CHECK(read.classes == given.classes);
  CHECK(read.duplicates == DuplicateRule::kMiddle);
}

TEST_CASE("a grid that is the lattice itself takes no axes in its note") {
  Metadata given;
  given.placement.x = given.placement.y = {-7, 1, 3};
  given.grid = PostGrid{513, 513, given.placement.x, given.placement.y};
  const Bytes notes = write_notes(given);
  CHECK(notes == Bytes{MICROTIN_NOTE_GRID, 4, 0, 0x84, 1, 0x84, 1});
  Metadata read;
  read.placement = given.placement;
  read_notes(notes.data(), notes.data() + notes.size(), read);
  REQUIRE(read.grid.has_value());
  CHECK(read.grid->x.offset == -7);
  CHECK(read.grid->y.denominator == 3);
}

TEST_CASE("of two notes of a type the first counts, and what follows a known content is skipped") {
  const auto read = [](const Bytes& notes) {
    Metadata metadata;
    read_notes(notes.data(), notes.data() + notes.size(), metadata);
    return metadata;
  };
  CHECK(read({3, 1, 0, 'a', 3, 1, 0, 'b'}).source == "a");
  CHECK(read({1, 4, 0, 2, 1, 9, 9}).horizontal_unit == Unit::kDegree);
  CHECK(read({11, 1, 0, 200}).duplicates == DuplicateRule::kUnknown);
  for (const Bytes& broken :
       {Bytes{1}, Bytes{3, 2, 0, 'a'}, Bytes{1, 1, 0, 2}, Bytes{8, 2, 0, 0, 1},
        Bytes{8, 3, 0, 1, 1, 0}, Bytes{10, 2, 0, 3, 2}, Bytes{10, 1, 0, 3}}) {
    CHECK_THROWS_AS(read(broken), Error);
  }
}

TEST_CASE("sets that no stream can hold are refused with a sentence") {
  const auto refusal = [](const std::vector<Vertex>& vertices) -> std::string {
    try {
      encode(Tin{vertices, {}}, Metadata());
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  CHECK(refusal({}).find("triangle") != std::string::npos);
  CHECK(refusal({{1, 1, 0}, {2, 2, 0}}).find("triangle") != std::string::npos);
  CHECK(refusal({{0, 0, 0}, {5, 5, 1}, {9, 9, 2}, {65535, 65535, 3}}).find("triangle") !=
        std::string::npos);
  CHECK(refusal({{0, 0, 0}, {5, 5, 1}, {5, 5, 2}, {9, 0, 3}}).find("share") != std::string::npos);
  CHECK(refusal({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}).empty());
}

}  // namespace microtin::tests
