// SPDX-License-Identifier: MIT
// From the lattice to real units: what exact arithmetic says, or a refusal. Names and versions.
#include <doctest/doctest.h>

#include <cstdint>
#include <random>
#include <string_view>

#include "microtin/microtin.h"
#include "shared/format.hpp"
#include "shared/pack_format.hpp"
#include "tests/support/reference_heights.hpp"

namespace microtin::tests {
namespace {

using reference::rounded;
using reference::Wide;

constexpr int64_t kFarOffset = int64_t{1} << 61;
constexpr uint64_t kMostRatioPart = (uint64_t{1} << 40) - 1;
constexpr uint32_t kMostRealsPerUnit = 1u << 24;

constexpr uint64_t kRatioParts[] = {1, 2, 3, 1200, kMostRatioPart - 1, kMostRatioPart};
constexpr int64_t kRealOffsets[] = {INT64_MIN, -kFarOffset, 1 - kFarOffset, -7777,    -1, 0,
                                    1,         7777,        kFarOffset - 1, INT64_MAX};
constexpr uint32_t kRealsPerUnit[] = {
    0, 1, 3, 1000, 10000000, kMostRealsPerUnit, kMostRealsPerUnit + 1};

// The largest whole number that is not above n / d.
Wide floor_of(Wide n, Wide d) {
  return n / d - (n % d < 0 ? 1 : 0);
}

struct ExactSteps {
  bool known;
  Wide value;
};

ExactSteps expected(const microtin_axis& axis, int64_t place, Wide fraction, uint32_t per_unit) {
  const bool legal = per_unit >= 1 && per_unit <= kMostRealsPerUnit && axis.offset > -kFarOffset &&
                     axis.offset < kFarOffset;
  const Wide steps = floor_of(place, fraction);
  const Wide far = (steps < 0 ? -steps : steps) * Wide(axis.numerator);
  if (!legal || far > (Wide{1} << 62)) return {false, 0};
  const Wide parts = Wide{axis.offset} * fraction + Wide(axis.numerator) * place;
  const Wide d = Wide(axis.denominator) * fraction;
  const Wide units = floor_of(parts, d), most = Wide{1} << 38;
  if (units >= most || units < -most) return {false, 0};
  return {true, units * per_unit + rounded((parts - units * d) * per_unit, d)};
}

uint32_t check_place(const microtin_axis& axis, int64_t place, uint32_t per_unit) {
  const ExactSteps right = expected(axis, place, 256, per_unit);
  int64_t found = -1;
  const bool known =
      microtin_axis_from_lattice(&axis, place, per_unit, &found) == MICROTIN_STATUS_OK;
  CHECK(known == right.known);
  CHECK(found == (right.known ? right.value : -1));
  return known ? 1 : 0;
}

uint32_t check_height(const microtin_axis& axis, int32_t height, uint32_t per_unit) {
  const ExactSteps right = expected(axis, height, 65536, per_unit);
  const bool fits = right.known && right.value >= INT32_MIN && right.value <= INT32_MAX;
  int32_t found = -1;
  const bool known = microtin_axis_height(&axis, height, per_unit, &found) == MICROTIN_STATUS_OK;
  CHECK(known == fits);
  CHECK(found == (fits ? right.value : -1));
  return known ? 1 : 0;
}

TEST_CASE("real units: places and heights at the ends of all ranges") {
  uint32_t places = 0, heights = 0;
  for (const uint64_t numerator : kRatioParts) {
    for (const uint64_t denominator : kRatioParts) {
      for (const int64_t offset : kRealOffsets) {
        const microtin_axis axis = {offset, numerator, denominator};
        for (const uint32_t per_unit : kRealsPerUnit) {
          for (const int64_t place :
               {INT64_MIN, -(int64_t{1} << 40), int64_t{-1}, int64_t{0}, int64_t{1}, int64_t{12345},
                int64_t{65535} * 256, int64_t{1} << 40, INT64_MAX}) {
            places += check_place(axis, place, per_unit);
          }
          for (const int32_t height : {INT32_MIN, -65537, -1, 0, 1, 99999, INT32_MAX}) {
            heights += check_height(axis, height, per_unit);
          }
        }
      }
    }
  }
  CHECK(places > 1000);
  CHECK(heights > 1000);
}

TEST_CASE("real units: random places and heights") {
  std::mt19937_64 random(11);
  uint32_t known = 0;
  for (int i = 0; i < 20000; ++i) {
    const microtin_axis axis = {static_cast<int64_t>(random()) >> (2 + random() % 60),
                                (1 + random() % kMostRatioPart) >> (random() % 40),
                                (1 + random() % kMostRatioPart) >> (random() % 40)};
    if (axis.numerator == 0 || axis.denominator == 0) continue;
    const uint32_t per_unit = 1 + static_cast<uint32_t>(random() % kMostRealsPerUnit);
    known += check_place(axis, static_cast<int64_t>(random() % (65536 * 256)), per_unit);
    known += check_height(axis, static_cast<int32_t>(random()), per_unit);
  }
  CHECK(known > 5000);
}

TEST_CASE("real units: a place comes back from its coordinate") {
  const microtin_axis degrees = {-117 * 3600, 1, 3600};
  for (int32_t place = 0; place < 65535 * 256; place += 4099) {
    int64_t value = 0;
    REQUIRE(microtin_axis_from_lattice(&degrees, place, 10000000, &value) == MICROTIN_STATUS_OK);
    int32_t back = -1;
    REQUIRE(microtin_axis_to_lattice(&degrees, value, 10000000, &back) == MICROTIN_STATUS_OK);
    CHECK(back == place);
  }
}

TEST_CASE("names of statuses and results, and versions") {
  const auto status = [](int number) {
    return std::string_view(microtin_status_name(static_cast<microtin_status>(number)));
  };
  const auto result = [](int number) {
    return std::string_view(microtin_query_result_name(static_cast<microtin_query_result>(number)));
  };
  CHECK(status(MICROTIN_STATUS_OK) == "OK");
  CHECK(status(MICROTIN_STATUS_NEED_INPUT) == "NEED_INPUT");
  CHECK(status(MICROTIN_STATUS_STEP_LIMIT) == "STEP_LIMIT");
  CHECK(status(MICROTIN_STATUS_STOPPED) == "STOPPED");
  CHECK(status(MICROTIN_STATUS_BAD_MAGIC) == "BAD_MAGIC");
  CHECK(status(MICROTIN_STATUS_UNSUPPORTED_VERSION) == "UNSUPPORTED_VERSION");
  CHECK(status(MICROTIN_STATUS_TOO_BIG) == "TOO_BIG");
  CHECK(status(MICROTIN_STATUS_CHECKSUM) == "CHECKSUM");
  CHECK(status(MICROTIN_STATUS_MALFORMED) == "MALFORMED");
  CHECK(status(MICROTIN_STATUS_TRUNCATED) == "TRUNCATED");
  CHECK(status(MICROTIN_STATUS_MISALIGNED) == "MISALIGNED");
  CHECK(status(MICROTIN_STATUS_WORKSPACE_TOO_SMALL) == "WORKSPACE_TOO_SMALL");
  CHECK(status(MICROTIN_STATUS_ARGUMENT) == "ARGUMENT");
  CHECK(status(MICROTIN_STATUS_IO) == "IO");
  CHECK(status(MICROTIN_STATUS_BAD_TILES) == "BAD_TILES");
  CHECK(status(MICROTIN_STATUS_OUT_OF_RANGE) == "OUT_OF_RANGE");
  CHECK(status(MICROTIN_STATUS_NOT_FOUND) == "NOT_FOUND");
  CHECK(status(MICROTIN_STATUS_WRONG_PACK_KIND) == "WRONG_PACK_KIND");
  CHECK(result(MICROTIN_QUERY_OK) == "OK");
  CHECK(result(MICROTIN_QUERY_OUTSIDE) == "OUTSIDE");
  CHECK(result(MICROTIN_QUERY_VOID) == "VOID");
  CHECK(result(MICROTIN_QUERY_NOT_LOADED) == "NOT_LOADED");
  CHECK(result(MICROTIN_QUERY_UNVERIFIED) == "UNVERIFIED");
  CHECK(result(MICROTIN_QUERY_STEP_LIMIT) == "STEP_LIMIT");
  CHECK(result(MICROTIN_QUERY_BAD_TILE) == "BAD_TILE");
  CHECK(result(MICROTIN_QUERY_WRONG_PACK_KIND) == "WRONG_PACK_KIND");
  CHECK(result(MICROTIN_QUERY_NO_MARGIN) == "NO_MARGIN");
  for (const int none : {-1, 4, 15, 30, int{MICROTIN_STATUS_REJECTED}}) CHECK(status(none) == "?");
  for (const int none : {-1, 9}) CHECK(result(none) == "?");
  CHECK(microtin_version_number() ==
        MICROTIN_VERSION_MAJOR * 65536 + MICROTIN_VERSION_MINOR * 256 + MICROTIN_VERSION_PATCH);
  CHECK(microtin_stream_format_version() == kVersion);
  CHECK(microtin_pack_format_version() == kPackVersion);
}

}  // namespace
}  // namespace microtin::tests
