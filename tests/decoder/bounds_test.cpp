// SPDX-License-Identifier: MIT
// Bounds of the arithmetic by all cases, where there are few enough; tests/lemmas proves others.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "shared/repulsion.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {
namespace {

int64_t magnitude(int64_t v) {
  return v < 0 ? -v : v;
}

// The largest in-circle determinant of four points in a square of that side.
int64_t largest_determinant(uint16_t side) {
  const uint32_t columns = side + 1u, places = columns * columns;
  const auto place = [columns](uint32_t i) {
    return Point{static_cast<uint16_t>(i / columns), static_cast<uint16_t>(i % columns)};
  };
  int64_t largest = 0;
  for (uint32_t a = 0; a < places; ++a) {
    for (uint32_t b = 0; b < places; ++b) {
      for (uint32_t c = 0; c < places; ++c) {
        const Angle at_c = angle_at(place(c), place(a), place(b));
        for (uint32_t p = 0; p < c; ++p) {
          const int64_t d = incircle(at_c, angle_at(place(p), place(a), place(b)));
          largest = std::max(largest, magnitude(d));
        }
      }
    }
  }
  return largest;
}

}  // namespace

TEST_CASE("the in-circle determinant of a square of side S is at most S^4 / 2, and reaches it") {
  for (uint16_t side = 1; side <= 6; ++side) {
    const int64_t square = int64_t{side} * side;
    CAPTURE(side);
    CHECK(2 * largest_determinant(side) <= square * square);
    if (side % 2 == 0) CHECK(2 * largest_determinant(side) == square * square);
  }
}

TEST_CASE("slices of any count of lines have the bounds that distances count on") {
  for (FastInt count = 1; count <= 65536; ++count) {
    Slices slices;
    slice(slices, count);
    REQUIRE(slices.start[kSlices] == count);
    REQUIRE((slices.extent > 0 && slices.extent < 1 << 18));
    REQUIRE(slices.unit <= 16);
    for (int i = 0; i < kSlices; ++i) {
      const FastInt lines = slices.start[i + 1] - slices.start[i];
      REQUIRE(magnitude(lines * kSlices - count) < kSlices);
      REQUIRE(magnitude(slices.middle[i]) <= 24576);
      REQUIRE((slices.square[i] >= 0 && slices.square[i] <= 9216));
    }
  }
}

TEST_CASE("the sixteenths of a box's slices fit 13 bits, their products 29") {
  for (uint32_t size = 0; size < 16; ++size) {
    const int32_t unit = static_cast<int32_t>(1) << (27 - size);
    for (FastInt count = 1; count <= static_cast<FastInt>(2) << size; ++count) {
      Slices slices;
      slice(slices, count);
      int16_t middle[kSlices];
      scale_middles(slices, unit, middle);
      const int64_t scale = (unit << 2) >> slices.unit;
      for (int i = 0; i < kSlices; ++i) {
        REQUIRE(magnitude(slices.middle[i] * scale) < 1 << 29);
        REQUIRE(magnitude(middle[i]) < 1 << 13);
      }
    }
  }
}

TEST_CASE("a root is at least the true one, and hardly larger") {
  const auto check = [](uint64_t v) {
    const double root = sqrt_above(v), exact = std::sqrt(static_cast<double>(v));
    REQUIRE(root >= exact);
    REQUIRE(root <= 2 + exact * (1 + 1.0 / 128));
  };
  for (uint64_t v = 1; v < 1 << 20; ++v) check(v);
  for (uint32_t bit = 20; bit < 58; ++bit) {
    for (uint64_t i = 0; i < 4096; ++i) {
      const uint64_t v = (uint64_t{1} << bit) + (i << (bit - 12));
      check(v);
      check(v - 1);
    }
  }
}

TEST_CASE("logarithms, powers and segments are as close as the format says") {
  const auto close = [](double value, double exact, double error) {
    REQUIRE(std::abs(value - exact) <= error);
  };
  for (uint64_t v = 1; v < 1 << 18; ++v) {
    close(log2_of(v), 256 * std::log2(static_cast<double>(v)), 1);
  }
  for (Log2 l = 1; l < 30 * kLog2One; ++l) {
    const double exact = std::exp2(l / 256.0);
    close(exp2_of(l), exact, 1 + exact / 7000);
  }
  for (Cotangent k = 0; k <= kCotangentCap; ++k) {
    const double c = k / 256.0, exact = 32768 * ((1 + c * c) * std::atan2(1, c) - c);
    close(segment(-k), exact, 1 + 0.0125 * exact);
    REQUIRE(segment(-k) <= 51781);
    REQUIRE(segment(k) < int64_t{1} << 30);
  }
}

}  // namespace microtin::tests
