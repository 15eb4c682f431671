// SPDX-License-Identifier: MIT
// Bounds of the arithmetic by all cases, where there are few enough; tests/lemmas proves others.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "shared/free_region.hpp"
#include "shared/probability.hpp"
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

TEST_CASE("roots are as close as the format says") {
  const auto check = [](uint32_t v) {
    const double exact = std::sqrt(static_cast<double>(v));
    REQUIRE(rough_root(v) >= std::floor(exact));
    REQUIRE(rough_root(v) <= 1 + exact + exact / 2048);
  };
  for (uint32_t v = 1; v < 1 << 20; ++v) check(v);
  for (uint32_t bit = 20; bit < 31; ++bit) {
    for (uint32_t i = 0; i < 4096; ++i) check((1u << bit) + (i << (bit - 12)));
  }
}

TEST_CASE("logarithms, powers and segments are as close as the format says") {
  const auto close = [](double value, double exact, double error) {
    REQUIRE(std::abs(value - exact) <= error);
  };
  const auto check = [&close](uint32_t v) {
    const double exact = 256 * std::log2(static_cast<double>(v));
    close(log2_of(v), exact, 1);
    close(rough_log2(v) + 11.5, exact, 11.6);
    REQUIRE(highest_bit(v) == static_cast<uint32_t>(std::ilogb(static_cast<double>(v))));
    if (v < 1 << 18) REQUIRE(rough_exp2(rough_log2(v)) <= v);
  };
  for (uint32_t v = 1; v < 1 << 18; ++v) check(v);
  for (uint32_t i = 0; i < 1 << 18; ++i) check(0xFFFFFFFFu - i * 16381u);
  for (Log2 l = 0; l < 1 << 13; ++l) {
    const double exact = std::exp2(l / 256.0);
    close(rough_exp2(l), 1.03 * exact, 1 + 0.032 * exact);
  }
  for (int32_t k = 0; k <= kOwnCap * 256; ++k) {
    const double c = k / 256.0, exact = (1 + c * c) * std::atan2(1, c) - c;
    const uint32_t square = k <= kBeyondCap * 256 ? (1u << 25) - 1 : (1u << 23) - 1;
    const Cotangent fine = k << (kCotangentBits - 8);
    close(cap(square, -fine) / static_cast<double>(square), exact / 2,
          2.0 / 4096 + 0.00625 * exact);
    REQUIRE(cap(square, fine) < int32_t{1} << 30);
    REQUIRE(cap(square, fine) > 0);
  }
}

// Where tables or wider words serve, they tell what the short formulas tell.
TEST_CASE("every way to compute a segment or its grains gives the same result") {
  for (uint32_t k = 0; k <= kOwnCap * 256u; ++k) {
    REQUIRE(minor_cap_under(k) == minor_cap(k));
    REQUIRE(whole_disc_under(k) == whole_disc(k));
  }
  for (int32_t shift = -26; shift <= 10; ++shift) {
    for (FastInt v = 1; v < 1 << 18; v += 1 + v / 64) {
      for (const FastInt signed_v : {v - 1, -v, (v - 1) | 1}) {
        const double exact = std::ldexp(static_cast<double>(signed_v), shift);
        if (std::abs(exact) < 1 << 24) REQUIRE(shifted(signed_v, shift) == std::floor(exact));
      }
    }
  }
}

// The corners are below 2^11 grains, so are apexes; heights may come out as 1.
TEST_CASE("cotangents stay below their cap, at every quotient of the largest numbers") {
  for (const int32_t most : {kBehindCap, kOwnCap}) {
    const Cotangent cap = most * (1 << kCotangentBits);
    for (uint32_t i = 0; i < 25; ++i) {
      for (const int32_t h : {1 << i, (2 << i) - 1}) {
        for (const int32_t q : {0, 1, h, 33554431}) {
          REQUIRE(magnitude(cotangent(q, divisor_of(h), most)) <= cap);
          REQUIRE(magnitude(cotangent(-q, divisor_of(h), most)) <= cap);
        }
      }
    }
  }
}

// By the means' definition, on numbers that divide exactly.
TEST_CASE("both means of a bit learn as the format says, whatever instructions do it") {
  const auto moved = [](int mean, int towards, int part) {
    return mean + static_cast<int>(std::floor(static_cast<double>(towards - mean) / part));
  };
  size_t wrong = 0;
  for (int mean = 64; mean <= 32704; ++mean) {
    for (const bool one : {false, true}) {
      const int towards = one ? 32704 : 64, other = 32768 - mean;
      AdaptiveBit bit{static_cast<uint16_t>(mean), static_cast<uint16_t>(other)};
      learn(bit, one);
      wrong += bit.fast != moved(mean, towards, 32) || bit.slow != moved(other, towards, 256);
      wrong += bit.fast < 64 || bit.fast > 32704 || bit.slow < 64 || bit.slow > 32704;
    }
  }
  CHECK(wrong == 0);
}

}  // namespace microtin::tests
