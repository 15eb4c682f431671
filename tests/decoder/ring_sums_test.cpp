// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

#include "shared/height_coding.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

struct Neighbours {
  std::vector<Point> places;
  std::vector<int16_t> heights;
  std::vector<Residual> residuals;
  std::vector<Index> ring;
};

// Neighbours with coordinates and heights that are often extreme. Infinity is among them, but not
// first.
Neighbours neighbours_of(Random& random, Point place) {
  const auto below = [&random](uint32_t most) {
    const uint32_t kind = random.below(8);
    return kind < 2 ? kind * (most - 1) : random.below(most);
  };
  Neighbours n;
  const uint32_t size = 3 + random.below(30), near = 1u << (1 + random.below(16));
  for (Index v = 0; v < size; ++v) {
    const auto near_to = [&](uint16_t c) { return static_cast<uint16_t>(c + below(near)); };
    n.places.push_back(Point{near_to(place.x), near_to(place.y)});
    n.heights.push_back(static_cast<int16_t>(static_cast<int32_t>(below(65536)) - 32768));
    n.residuals.push_back(static_cast<Residual>(static_cast<int32_t>(below(255)) - 127));
    n.ring.push_back(v != 0 && random.below(12) == 0 ? kInfinity : v);
  }
  return n;
}

int32_t bits_of(Point a, Point b) {
  const int64_t dx = int64_t{a.x} - b.x, dy = int64_t{a.y} - b.y;
  int32_t bits = 0;
  for (int64_t half = (dx * dx) / 2 + (dy * dy) / 2; half > 1; half /= 2) ++bits;
  return bits;
}

// As format-stream.md defines them, in 64 bits.
bool are_right(const RingSums& sums, const Neighbours& n, Point place) {
  const int32_t first = bits_of(n.places[0], place);
  int64_t weights = 0, heights = 0, spread = 0, residuals = 0, roughness = 0;
  for (const Index v : n.ring) {
    if (v == kInfinity) continue;
    const int32_t farther = std::max(0, bits_of(n.places[v], place) + 4 - first);
    const int64_t weight = farther > 9 ? 0 : 512 >> farther;
    const int64_t height = weight * (int64_t{n.heights[v]} - n.heights[0]);
    const int64_t residual = weight * n.residuals[v];
    weights += weight;
    heights += height;
    spread += std::abs(height);
    residuals += residual;
    roughness += std::abs(residual);
  }
  return sums.first == static_cast<uint32_t>(first) && sums.weights == weights &&
         sums.heights == heights && sums.spread == spread && sums.residuals == residuals &&
         sums.roughness == roughness;
}

}  // namespace

TEST_CASE("sums over a ring are as they are defined") {
  Random random(64);
  size_t wrong = 0;
  for (int i = 0; i < 200000; ++i) {
    const Point place = {static_cast<uint16_t>(random.below(65536)),
                         static_cast<uint16_t>(random.below(65536))};
    Neighbours n = neighbours_of(random, place);
    const Mesh mesh = {n.places.data(), n.heights.data(), nullptr, nullptr, 0, 0};
    const auto size = static_cast<uint32_t>(n.ring.size());
    wrong += !are_right(sum_ring(mesh, n.residuals.data(), n.ring.data(), size, place), n, place);
  }
  CHECK(wrong == 0);
}

}  // namespace microtin::tests
