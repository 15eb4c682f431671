// SPDX-License-Identifier: MIT
// The order is the paper's: its own simple code, applied to it, costs what the paper prints.
#include "encoder/stream/order.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>

#include "encoder/stream/encode.hpp"
#include "shared/header.hpp"
#include "tests/support/point_sets.hpp"
#include "tests/support/slow.hpp"

using namespace microtin;
using namespace microtin::tests;

namespace {

// Table 1: two tag bits, a sign, and 6, 9, 12 or 16 bits.
uint64_t table1_bits(int difference) {
  const int magnitude = std::abs(difference);
  return 3u + (magnitude <= 63 ? 6u : magnitude <= 511 ? 9u : magnitude <= 4095 ? 12u : 16u);
}

double table1_bits_per_vertex(const std::vector<Point>& points, const Order& order) {
  uint64_t bits = 0;
  Point before = points[order.seed[2]];
  for (const std::vector<Index>& batch : order.batches) {
    for (const Index v : batch) {
      const Point p = points[v];
      bits += table1_bits(p.x - before.x) + table1_bits(p.y - before.y);
      before = p;
    }
  }
  return static_cast<double>(bits) / static_cast<double>(points.size());
}

// The bytes of a stream up to the end of its first section (format-stream.md, section 4).
size_t first_section_end(const std::vector<uint8_t>& stream) {
  const uint8_t* at = stream.data() + kIdentityBytes;
  for (int framed = 0; framed < 2; ++framed) {  // the header and the section
    uint64_t size = 0;
    REQUIRE(read_varint(&at, stream.data() + stream.size(), &size));
    at += size + kCheckBytes;
  }
  return static_cast<size_t>(at - stream.data());
}

}  // namespace

TEST_CASE("with the paper's code the order costs what the paper's Table 2 prints") {
  const struct {
    uint32_t vertices;
    double bits, tolerance;
  } table2[] = {{5000, 27.49, 0.15}, {80000, 23.42, 0.10}};
  Random random(1);
  for (const auto& row : table2) {
    const std::vector<Point> points = uniform_points(row.vertices, random);
    Triangulation triangulation(points);
    const double bits = table1_bits_per_vertex(points, breadth_first_order(triangulation, 6));
    MESSAGE(row.vertices << " points: " << bits << " bits/vertex, the paper " << row.bits);
    CHECK(bits > row.bits - row.tolerance);
    CHECK(bits < row.bits + row.tolerance);
  }
}

namespace {

// A hub with spokes of points along rays, so that few vertices have nearly all edges.
std::vector<Point> spokes(uint32_t rays, Random& random) {
  std::vector<Point> points = {{32768, 32768}};
  for (uint32_t ray = 0; ray < rays; ++ray) {
    const double angle = 2 * 3.14159265 * ray / rays;
    for (const double radius : {2000.0, 2100.0, 30000.0}) {
      points.push_back(point(static_cast<uint32_t>(32768 + radius * std::cos(angle)),
                             static_cast<uint32_t>(32768 + radius * std::sin(angle))));
    }
  }
  return distinct(points, random);
}

// Equilateral triangles, nearly: every vertex has six neighbours.
std::vector<Point> hexagons(uint32_t side) {
  std::vector<Point> points;
  for (uint32_t row = 0; row < side; ++row) {
    for (uint32_t column = 0; column < side; ++column) {
      points.push_back(point(30 * column + row % 2 * 15, 26 * row));
    }
  }
  return points;
}

// Two rows of vertices that see each other all along, with ends far away.
std::vector<Point> parabola(uint32_t n) {
  std::vector<Point> points;
  for (uint32_t i = 0; i < n; ++i) points.push_back(point(i, i * i / 16));
  return points;
}

std::vector<std::vector<Point>> adversarial_sets(Random& random) {
  return {uniform_points(3000, random),
          clustered_points(2000, random, 5, 300),
          lattice_points(50, 50, random),
          lattice_points(3, 800, random),
          circle_points(1105 * 1105, random),
          spokes(300, random),
          hexagons(50),
          parabola(1000),
          uniform_points(49, random),
          uniform_points(7, random)};
}

}  // namespace

TEST_CASE("every phase leaves at most the share of vertices that is proved") {
  Random random(2);
  for (const std::vector<Point>& points : adversarial_sets(random)) {
    for (const uint32_t degree : {6u, 7u, 8u, 9u, 12u, 32u}) {
      CAPTURE(points.size());
      CAPTURE(degree);
      Triangulation triangulation(points);
      const Order order = breadth_first_order(triangulation, degree);
      int64_t after = static_cast<int64_t>(points.size()), work = after;
      for (auto batch = order.batches.rbegin(); batch != order.batches.rend(); ++batch) {
        const int64_t before = after, removed = static_cast<int64_t>(batch->size());
        after -= removed;
        work += after;
        const int64_t losers = (degree - 1) / 2;  // proofs.md, "Work"
        CHECK(removed * losers >= (degree - 5) * (after - 4) - 3);
        CHECK(3 * (after - 7) <= 2 * (before - 7));
        if (before <= 48) CHECK(removed * losers >= (degree - 5) * (after - 3));
      }
      CHECK(after == 3);
      CHECK(work - after <= work_budget(static_cast<uint32_t>(points.size())));
    }
  }
}

TEST_CASE("80,000 uniform points, x and y alone, stay near the entropy floor") {
  Random random(3);
  Tin tin;
  for (const Point& p : uniform_points(80000, random)) tin.vertices.push_back(Vertex{p.x, p.y, 0});
  const double bits = 8.0 * static_cast<double>(encode(tin, Metadata()).size()) / 80000;
  MESSAGE(bits << " bits/vertex; the floor, log2 C(2^32, n) / n, is 17.155");
  CHECK(bits < 19.5);
}

TEST_CASE("a large terrain is seen first after half a percent of its bytes" * kSlow) {
  constexpr uint32_t kVertices = 270000;
  Random random(4);
  Tin tin;
  for (const Point& p : uniform_points(kVertices, random)) {
    tin.vertices.push_back(Vertex{p.x, p.y, static_cast<int16_t>((p.x + p.y) >> 6)});
  }
  const std::vector<uint8_t> stream = encode(tin, Metadata());
  const size_t first = first_section_end(stream);
  MESSAGE(first << " of " << stream.size() << " bytes");
  CHECK(200 * first <= stream.size());
}
