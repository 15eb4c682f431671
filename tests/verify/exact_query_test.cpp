// SPDX-License-Identifier: MIT
// Heights at real places: against the planes of all triangles in exact fractions.
#include "encoder/terrain/exact_query.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "encoder/exact/fraction.hpp"
#include "encoder/verify/verify.hpp"
#include "tests/support/point_sets.hpp"
#include "tests/support/reference_heights.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

using reference::Corners;

using Pair = std::pair<Wide, Wide>;  // a fraction in lowest terms

Pair pair_of(const Fraction& f) {
  return {f.numerator, f.denominator};
}

// Twice the area of (a, b, place), times the place's parts.
Wide area(const Vertex& a, const Vertex& b, const RealPlace& p) {
  return (Wide{b.x} - a.x) * ((p.y - a.y) * p.parts + p.y_part) -
         (Wide{b.y} - a.y) * ((p.x - a.x) * p.parts + p.x_part);
}

// What all closed triangles that hold a place know of it.
struct Known {
  bool is_inside = false;
  std::set<Pair> heights;  // of triangles with terrain, and of a vertex
};

Known known_at(const std::vector<Corners>& triangles, const RealPlace& p) {
  Known known;
  for (const Corners& t : triangles) {
    const Wide a = area(t.v[1], t.v[2], p), b = area(t.v[2], t.v[0], p),
               c = area(t.v[0], t.v[1], p);
    if (a < 0 || b < 0 || c < 0) continue;
    known.is_inside = true;
    const bool is_vertex = (a == 0) + (b == 0) + (c == 0) == 2;
    if (t.is_void && !is_vertex) continue;
    known.heights.insert(pair_of(reduced(a * t.v[0].z + b * t.v[1].z + c * t.v[2].z, a + b + c)));
  }
  return known;
}

void expect(const ExactAnswer& answer, const Known& known) {
  if (known.heights.empty()) {
    CHECK(answer.kind == (known.is_inside ? MICROTIN_QUERY_VOID : MICROTIN_QUERY_OUTSIDE));
    return;
  }
  REQUIRE(known.heights.size() == 1);
  REQUIRE(answer.kind == MICROTIN_QUERY_OK);
  const ExactHeight& h = answer.height;
  const Pair found = pair_of(reduced(h.base * h.under + h.above, h.under));
  CHECK((found == *known.heights.begin()));
}

// Between two vertices, a part of the way, or anywhere.
RealPlace random_place(const Tin& tin, Random& random) {
  constexpr std::array<int64_t, 5> kParts{1, 3, 1000, int64_t{1} << 20, 999999937};
  const int64_t parts = kParts[random.below(5)];
  const auto count = static_cast<uint32_t>(tin.vertices.size());
  const Vertex &p = tin.vertices[random.below(count)], &q = tin.vertices[random.below(count)];
  const auto some = [&] {
    return static_cast<int64_t>(random.below(static_cast<uint32_t>(parts)));
  };
  int64_t x = p.x * parts + (q.x - p.x) * some(), y = p.y * parts;
  if (random.below(2) == 0) {
    const int64_t on_the_way = some();
    x = p.x * parts + (q.x - p.x) * on_the_way;
    y = p.y * parts + (q.y - p.y) * on_the_way;
  }
  return {x / parts, y / parts, x % parts, y % parts, parts};
}

}  // namespace

TEST_CASE("exact heights equal the exact plane, from any start and from either side") {
  Random random(36);
  int heights = 0;
  for (const PointSet& set : point_sets(60, 36)) {
    Tin tin;
    for (const Point p : set.points) {
      tin.vertices.push_back({p.x, p.y, static_cast<int16_t>(random.below(65536) - 32768)});
    }
    const DecodedTerrain whole(encode(tin, Metadata()));
    for (const Corners& t : reference::real_triangles(whole.mesh())) {
      if (random.below(4) != 0) continue;
      tin.voids.push_back(
          Tin::Triangle{{t.v[0].x, t.v[0].y}, {t.v[1].x, t.v[1].y}, {t.v[2].x, t.v[2].y}});
    }
    const DecodedTerrain terrain(encode(tin, Metadata()));
    const std::vector<Corners> triangles = reference::real_triangles(terrain.mesh());
    for (int probe = 0; probe < 300; ++probe) {
      const RealPlace place = random_place(tin, random);
      const Known known = known_at(triangles, place);
      uint32_t hint = random.below(microtin_mesh_triangle_count(terrain.mesh()));
      expect(exact_answer(terrain.mesh(), place, 0, &hint), known);
      heights += known.heights.size() == 1;
    }
  }
  CHECK(heights > 4000);
}

TEST_CASE("exact heights: a hull's edge holds the places on it, and no others") {
  Tin tin;
  tin.vertices = {{0, 0, 0}, {30, 10, 60}, {0, 10, 10}};
  const DecodedTerrain terrain(encode(tin, Metadata()));
  const auto kind = [&](const RealPlace& place) {
    uint32_t hint = 0;
    return exact_answer(terrain.mesh(), place, 0, &hint).kind;
  };
  constexpr Wide kParts = kMostParts - 1;  // a multiple of 3: (1, 1/3) is on the edge to (30, 10)
  CHECK(kind({1, 0, 0, kParts / 3, kParts}) == MICROTIN_QUERY_OK);
  CHECK(kind({1, 0, 0, kParts / 3 + 1, kParts}) == MICROTIN_QUERY_OK);
  CHECK(kind({1, 0, 0, kParts / 3 - 1, kParts}) == MICROTIN_QUERY_OUTSIDE);
  CHECK(kind({1, 0, 1, kParts / 3, kParts}) == MICROTIN_QUERY_OUTSIDE);
  uint32_t hint = 0;
  const ExactAnswer on_edge = exact_answer(terrain.mesh(), {1, 0, 0, kParts / 3, kParts}, 0, &hint);
  CHECK(to_string(rounded_height({0, 1, 1}, on_edge.height, 9)) == "2");
}

TEST_CASE("exact heights: real numbers are rounded once") {
  const Axis z{-123456789, 7, 1000};
  const ExactHeight third{100, 1, 3};  // -123456089 + 7/3 thousandths
  CHECK(to_string(rounded_height(z, third, 9)) == "-123456.086666667");
  CHECK(to_string(rounded_height(z, third, 3)) == "-123456.087");
  CHECK(std::abs(real_height(z, third) + 123456.08666666667) < 1e-10);
  CHECK(to_string(rounded_height({0, 1, 1}, {0, 1, 2}, 0)) == "1");  // halves go up
  CHECK(to_string(rounded_height({0, 1, 1}, {0, -1, 2}, 0)) == "0");
  CHECK(to_string(rounded_height({0, 1, 100}, {12, 7, 20}, 3)) == "0.124");  // 0.1235
  const Wide wide = (Wide{1} << 108) + 1;  // products leave 128 bits
  CHECK(to_string(rounded_height({0, (1ull << 40) - 1, 1}, {0, wide / 2, wide}, 9)) ==
        "549755813887.5");
  CHECK(fixed_height({1, 1, 3}) == 87381);
  const Wide odd = (Wide{1} << 109) + 1;  // a factor times 2 / 3 of it, and 5 parts more
  const WholeAndRest all = multiply_divide(Wide{3} << 30, 2 * ((odd - 3) / 3), odd);
  CHECK(all.whole == (Wide{2} << 30) - 1);
  CHECK(all.rest == odd - (Wide{6} << 30));
}

TEST_CASE("exact heights: places of numbers, and what rounded numbers stand for") {
  const Axis degrees{3, 1, 3600};  // the lattice begins at 3/3600 degrees
  const auto at = [&](const char* text) {
    return *coordinate_of(*parse_decimal(text, kPlaceDecimals), degrees);
  };
  CHECK(at("0.000833333333").whole == 0);  // 12 decimals of 3/3600
  CHECK(at("0.000833333333").part == 0);
  CHECK(at("0.000833333332").whole == -1);
  CHECK(at("0.001").whole == 0);
  const RealCoordinate mid = at("0.001");  // 3.6 - 3 steps
  CHECK(mid.part * 10 == mid.parts * 6);
  const BinaryAxis binary(degrees, 0, 7200);
  for (const int64_t k : {0, 1, 3600, 7199, 7200}) {
    const double value = static_cast<double>(k + 3) / 3600;
    for (const double near : {value, std::nextafter(value, -1), std::nextafter(value, 9)}) {
      REQUIRE(binary(near));
      CHECK(binary(near)->whole == k);
      CHECK(binary(near)->part == 0);
    }
  }
  CHECK_FALSE(binary(7203.001 / 3600));
  CHECK_FALSE(binary(2.999 / 3600));
  CHECK_FALSE(binary(std::nan("")));
  CHECK_FALSE(binary(1e300));
  const RealCoordinate half = *BinaryAxis({-7, 2, 1}, 0, 100)(1.5);  // 8.5 / 2 steps
  CHECK(half.whole == 4);
  CHECK(half.part * 4 == half.parts);
  const RealPlace both = place_of({1, 1, 6}, {2, 3, 4});
  CHECK(both.parts == 12);
  CHECK(both.x_part == 2);
  CHECK(both.y_part == 9);
  const Wide large = (Wide{1} << 79) + 7;
  CHECK(place_of({1, large / 2, large}, {0, 0, 1}).parts == kMostParts);
}

TEST_CASE("exact heights: errors are measured exactly, and rounded up once") {
  const auto error = [](int64_t number, const ExactHeight& height) {
    ErrorMeter meter({0, 1, 100}, {0, 1, 10});  // hundredths against tenths
    Verification found;
    const double above = meter.add(number, height);
    meter.report(std::nullopt, found);
    CHECK(std::abs(std::abs(above) - real(found.max_error)) < 2e-9);
    CHECK((found.max_below.mantissa != 0) == (above < 0));
    return to_string(found.max_error);
  };
  CHECK(error(25, {2, 1, 2}) == "0");
  CHECK(error(25, {2, 1, 3}) == "0.016666667");  // 0.2333... is below 0.25
  CHECK(error(23, {2, 1, 3}) == "0.003333334");  // the error above 0.23
  CHECK(error(-25, {-3, 1, 3}) == "0.016666667");
  CHECK(error(0, {0, -1, 3}) == "0.033333334");
  CHECK(error(0, {0, 1, 3}) == "0.033333334");
  const Wide wide = Wide{1} << 108;
  CHECK(error(0, {0, 1, wide}) == "0.000000001");
  CHECK(error(0, {0, -1, wide}) == "0.000000001");
  CHECK(error(1000, {0, 100 * wide - 1, wide}) == "0.000000001");
}

}  // namespace microtin::tests
