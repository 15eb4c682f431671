// SPDX-License-Identifier: MIT
// Real coordinates on axes at the ends of their ranges, for terrains and for packs: what exact
// arithmetic says, or a refusal.
#include <doctest/doctest.h>

#include <cstdint>
#include <set>

#include "microtin/microtin.h"
#include "microtin/pack.h"
#include "tests/support/reference_heights.hpp"

namespace microtin::tests {
namespace {

using reference::rounded;
using reference::Wide;

constexpr int64_t kFar = int64_t{1} << 61;  // offsets lie within
constexpr uint64_t kMostOfAxis = (uint64_t{1} << 40) - 1;
constexpr uint32_t kMostPerUnit = 1u << 24;
constexpr uint64_t kPackNumerators = uint64_t{1} << 30;  // a pack's axes have smaller ones
constexpr uint32_t kPackMost = 0x7FFFFFFF;

constexpr uint64_t kParts[] = {
    1, 3, 1200, kPackNumerators - 1, kPackNumerators, kMostOfAxis - 1, kMostOfAxis};
constexpr int64_t kOffsets[] = {INT64_MIN, -kFar, 1 - kFar, 2 - kFar, -1,   0,
                                1,         7777,  kFar - 2, kFar - 1, kFar, INT64_MAX};
constexpr uint32_t kPerUnit[] = {
    0, 1, 2, 10000000, kMostPerUnit - 1, kMostPerUnit, kMostPerUnit + 1};

// What both are asked for, and how many of the places are inside.
struct Asked {
  uint32_t most;
  uint32_t inside = 0;
};

bool has_range(const microtin_axis& axis, uint32_t per_unit) {
  return axis.offset > -kFar && axis.offset < kFar && per_unit >= 1 && per_unit <= kMostPerUnit;
}

void check_terrain(const microtin_axis& axis, int64_t value, uint32_t per_unit, Asked& asked) {
  int32_t found = -1;
  const bool known = microtin_axis_to_lattice(&axis, value, per_unit, &found) == MICROTIN_STATUS_OK;
  Wide expected = -1;
  if (has_range(axis, per_unit)) {
    const Wide parts = Wide{value} * Wide(axis.denominator) - Wide{axis.offset} * per_unit;
    expected = rounded(parts * 256, Wide(axis.numerator) * per_unit);
  }
  const bool inside = expected >= 0 && expected <= Wide{asked.most} * 256;
  CHECK(known == inside);
  CHECK(found == (inside ? expected : -1));
  asked.inside += inside;
}

void check_pack(const microtin_axis& axis, int64_t value, uint32_t per_unit, Asked& asked) {
  int64_t found = -1;
  const bool known = microtin_pack_axis_to_lattice(&axis, asked.most, value, per_unit, &found) ==
                     MICROTIN_STATUS_OK;
  Wide parts = -1, expected = -1;
  if (has_range(axis, per_unit) && axis.numerator < kPackNumerators && asked.most <= kPackMost) {
    parts = Wide{value} * Wide(axis.denominator) - Wide{axis.offset} * per_unit;
    expected = rounded(parts * 256, Wide(axis.numerator) * per_unit);
  }
  const bool inside = parts >= 0 && expected <= Wide{asked.most} * 256;
  CHECK(known == inside);
  CHECK(found == (inside ? expected : -1));
  asked.inside += inside;
}

// Near the first and the last place, and at the ends of values.
std::set<int64_t> values_near(const microtin_axis& axis, uint32_t most, uint32_t per_unit) {
  std::set<int64_t> values = {INT64_MIN, INT64_MIN + 1, -1, 0, 1, INT64_MAX - 1, INT64_MAX};
  for (const Wide place : {Wide{-1}, Wide{0}, Wide{1}, Wide{most}, Wide{most} + 1}) {
    const Wide units = (Wide{axis.offset} + Wide(axis.numerator) * place) * per_unit;
    for (int beside = -2; beside <= 2; ++beside) {
      const Wide value = units / Wide(axis.denominator) + beside;
      if (value >= INT64_MIN && value <= INT64_MAX) values.insert(static_cast<int64_t>(value));
    }
  }
  return values;
}

template <typename Check>
void check_extremes(Asked& asked, Check check) {
  for (const uint64_t numerator : kParts) {
    for (const uint64_t denominator : kParts) {
      for (const int64_t offset : kOffsets) {
        const microtin_axis axis = {offset, numerator, denominator};
        for (const uint32_t per_unit : kPerUnit) {
          for (const int64_t value : values_near(axis, asked.most, per_unit)) {
            check(axis, value, per_unit, asked);
          }
        }
      }
    }
  }
}

}  // namespace

TEST_CASE("real coordinates convert exactly at the ends of all ranges") {
  Asked asked{65535};
  check_extremes(asked, check_terrain);
  CHECK(asked.inside > 10000);
}

TEST_CASE("pack: real coordinates convert exactly at the ends of all ranges") {
  for (const uint32_t most : {1u, 65535u, kPackMost}) {
    Asked asked{most};
    check_extremes(asked, check_pack);
    CHECK(asked.inside > 3000);
  }
  Asked beyond{kPackMost + 1};
  check_extremes(beyond, check_pack);
  CHECK(beyond.inside == 0);
}

}  // namespace microtin::tests
