// SPDX-License-Identifier: MIT
// Terrain files of autopilots, read by other code, written from the firmware's side: from a place
// to its block, in single precision.
#include "encoder/export/autopilot.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "tests/support/autopilot_reader.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/point_sets.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

using Bytes = std::vector<uint8_t>;

// Waves on a slope over a cell and a bit, in metres; degrees from its corner.
double wave(double x, double y) {
  return 900 + 300 * std::sin(x * 40) * std::cos(y * 35) + 200 * (x + y);
}

// A surface by its heights at places with 8 fractional bits, which have 16.
using FineHeights = std::function<std::optional<int32_t>(int64_t x, int64_t y)>;

std::function<ExactAnswer(const RealPlace&)> answering(const FineHeights& height_at) {
  return [height_at](const RealPlace& p) -> ExactAnswer {
    const auto height =
        height_at(p.x * 256 + static_cast<int64_t>(round_divide(256 * p.x_part, p.parts)),
                  p.y * 256 + static_cast<int64_t>(round_divide(256 * p.y_part, p.parts)));
    if (!height) return {MICROTIN_QUERY_OUTSIDE, {0, 0, 1}};
    return {MICROTIN_QUERY_OK, height_of_answer(*height)};
  };
}

SampledSurface surface_of(DegreeCell cell, double scale = 1) {
  SampledSurface surface;
  surface.placement.x = {int64_t{cell.longitude} * 1200 - 12, 1, 1200};
  surface.placement.y = {int64_t{cell.latitude} * 1200 - 12, 1, 1200};
  surface.placement.z = {0, 1, 10};
  surface.x_max = surface.y_max = 1248;
  surface.height_at = answering([scale](int64_t x, int64_t y) {
    const double u = static_cast<double>(x - 12 * 256) / (1200 * 256),
                 v = static_cast<double>(y - 12 * 256) / (1200 * 256);
    return static_cast<int32_t>(std::lround(wave(u, v) * scale * 10 * 65536));
  });
  return surface;
}

// The bytes of a block, one field after the other.
Bytes expected_block(const uint8_t* block, bool inav, uint32_t spacing, DegreeCell cell, uint32_t x,
                     uint32_t y, const std::vector<int32_t>& heights) {
  Bytes bytes(7, 0xFF);
  bytes.push_back(0);
  const auto add = [&bytes](int64_t value, int count) {
    for (; count > 0; --count, value >>= 8) bytes.push_back(static_cast<uint8_t>(value & 255));
  };
  bytes.insert(bytes.end(), block + 8, block + 18);  // the corner and the check: see accepts
  add(inav ? 50 : 1, 2);
  add(spacing, 2);
  if (inav) {
    const int32_t base = *std::min_element(heights.begin(), heights.end());
    for (size_t i = 0; i < heights.size(); i += 4) {  // four posts in five bytes
      int64_t bits = 0;
      for (size_t j = 0; j < 4; ++j) {
        bits |= static_cast<int64_t>((heights[i + j] - base) / 2) << 10 * j;
      }
      add(bits, 5);
    }
    add(base, 2);
  } else {
    for (const int32_t height : heights) add(height, 2);
  }
  add(x, 2);
  add(y, 2);
  add(cell.longitude, 2);
  add(cell.latitude, 1);
  if (!inav) add(1, 1);
  bytes.resize(2048);
  return bytes;
}

// Cells at all latitudes above 70 degrees and at every tenth below. Under sanitizers, which are
// slow, six.
std::vector<int> souths() {
  std::vector<int> chosen;
  for (int south = -89; south < 89; ++south) {
    const bool is_chosen =
        kIsSanitized ? std::abs(south) % 34 == 17 : south < -70 || south >= 70 || south % 10 == 0;
    if (is_chosen) chosen.push_back(south);
  }
  return chosen;
}

}  // namespace

TEST_CASE("autopilot: firmware finds every height of a cell within a grid's error" * kSlow) {
  for (const DegreeCell cell : {DegreeCell{43, 7}, {-34, -71}, {0, -1}, {-1, 0}, {61, 179}}) {
    for (const Autopilot autopilot : {Autopilot::kArduPilot, Autopilot::kInav}) {
      const bool inav = autopilot == Autopilot::kInav;
      const uint32_t spacing = inav ? kInavSpacing : kArduPilotSpacing;
      const AutopilotFile file = autopilot_file(surface_of(cell), autopilot, cell, spacing);
      const Firmware firmware(file.bytes, autopilot, cell, spacing);
      REQUIRE(file.bytes.size() % (size_t{2048} * firmware.stride()) == 0);
      CHECK(file.places > 1400000);
      CHECK(file.largest < (inav ? 2.5 : 6));
      CHECK(file.rms < file.largest);
      Random random(9);
      double largest = 0;
      for (int i = 0; i < 20000; ++i) {
        const auto pick = [&] { return static_cast<int32_t>(random.below(10000000)); };
        const int32_t north = pick(), east = pick();
        const auto place =
            firmware.place(cell.latitude * 10000000 + north, cell.longitude * 10000000 + east);
        REQUIRE(firmware.accepts(place));
        const auto height = firmware.height(place);
        REQUIRE(height.has_value());
        largest = std::max(
            largest, std::abs(static_cast<double>(*height) - wave(east * 1e-7, north * 1e-7)));
      }
      CHECK(largest < file.largest + 0.5);
    }
  }
}

TEST_CASE("autopilot: every byte of a block is that of the format" * kSlow) {
  const DegreeCell cell{43, 7};
  for (const Autopilot autopilot : {Autopilot::kArduPilot, Autopilot::kInav}) {
    const bool inav = autopilot == Autopilot::kInav;
    for (const uint32_t spacing : {30u, 100u}) {
      if (inav && spacing != 30) continue;
      // A plane that falls by whole metres, two at a time, from row to row of posts.
      SampledSurface surface = surface_of(cell);
      const double row = spacing * 89.83204953368922e-7 * 1200 * 256;
      surface.height_at = answering([row](int64_t, int64_t y) {
        const auto rows = std::lround(static_cast<double>(y - 12 * 256) / row);
        return static_cast<int32_t>((8000 - 2 * rows) * 10 * 65536 / 16);
      });
      surface.placement.z = {0, 16, 10};
      const AutopilotFile file = autopilot_file(surface, autopilot, cell, spacing);
      const Firmware firmware(file.bytes, autopilot, cell, spacing);
      for (const uint32_t x : {0u, 3u, 11u}) {
        for (const uint32_t y : {0u, 5u, 17u}) {
          const Firmware::Place place{x, y, 0, 0, 0, 0};
          std::vector<int32_t> heights;
          for (uint32_t i = 0; i < 28 * 32; ++i) {
            heights.push_back(static_cast<int32_t>(8000 - 2 * (x * 24 + i / 32)));
          }
          const uint8_t* const block = firmware.block(place);
          CHECK(firmware.accepts(place));
          CHECK(Bytes(block, block + 2048) ==
                expected_block(block, inav, spacing, cell, x, y, heights));
        }
      }
    }
  }
}

TEST_CASE("autopilot: missing heights are marked and reported" * kSlow) {
  const DegreeCell cell{43, 7};
  SampledSurface surface = surface_of(cell);
  const auto whole = surface.height_at;
  surface.height_at = [whole](const RealPlace& place) -> ExactAnswer {
    if (place.x >= 300 && place.x < 500 && place.y >= 600) return {MICROTIN_QUERY_VOID, {0, 0, 1}};
    return whole(place);
  };
  for (const Autopilot autopilot : {Autopilot::kArduPilot, Autopilot::kInav}) {
    const AutopilotFile file = autopilot_file(surface, autopilot, cell, 30);
    CHECK(file.empty > 0);
    CHECK(file.partial > 0);
    const Firmware firmware(file.bytes, autopilot, cell, 30);
    uint64_t empty = 0, partial = 0;
    for (size_t at = 0; at < file.bytes.size(); at += 2048) {
      const bool full =
          std::all_of(&file.bytes[at], &file.bytes[at] + 7, [](uint8_t b) { return b == 255; });
      const bool none =
          std::all_of(&file.bytes[at], &file.bytes[at] + 2048, [](uint8_t b) { return b == 0; });
      empty += none ? 1u : 0u;
      partial += !full && !none ? 1u : 0u;
    }
    CHECK(empty == file.empty);
    CHECK(partial == file.partial);
    // In the hole nothing, two groups away from it everything.
    for (int32_t i = 0; i < 2000; ++i) {
      const int32_t north = 6100000 + i * 1900, hole = 10000000 / 1200 * (488 - 188 * (i & 1)) - 1;
      const auto in = firmware.place(430000000 + north, 70000000 + hole - 10000000 / 1200 * 90);
      const auto out = firmware.place(430000000 + north, 70000000 + 10000000 / 1200 * 510);
      if ((i & 1) == 0) CHECK(!firmware.height(in));
      CHECK(firmware.height(out));
    }
  }
}

TEST_CASE("autopilot: posts just beyond the edge have its height, farther ones none") {
  const DegreeCell cell{43, 7};
  SampledSurface surface = surface_of(cell);
  surface.x_max = surface.y_max = 1212;  // to the cell's own edge
  const AutopilotFile file = autopilot_file(surface, Autopilot::kArduPilot, cell, 100);
  const Firmware firmware(file.bytes, Autopilot::kArduPilot, cell, 100);
  CHECK(file.beyond > 0);
  for (int32_t i = 0; i < 1000; ++i) {
    CHECK(firmware.height(firmware.place(439999999, 70000000 + i * 9999)));
    CHECK(firmware.height(firmware.place(430000000 + i * 9999, 79999999)));
  }
}

TEST_CASE("autopilot: places that firmware in single precision misses are counted" * kSlow) {
  for (const Autopilot autopilot : {Autopilot::kArduPilot, Autopilot::kInav}) {
    const uint32_t spacing = autopilot == Autopilot::kInav ? kInavSpacing : kArduPilotSpacing;
    for (const int south : souths()) {
      const DegreeCell cell{south, -180};
      SampledSurface surface = surface_of(cell);
      surface.placement.x = {-180 * 50, 1, 50};
      surface.placement.y = {south * 50, 1, 50};
      surface.x_max = surface.y_max = 50;
      surface.height_at = [](const RealPlace&) -> ExactAnswer {
        return {MICROTIN_QUERY_OK, height_of_answer(0)};
      };
      const AutopilotFile file = autopilot_file(surface, autopilot, cell, spacing);
      const Firmware firmware(file.bytes, autopilot, cell, spacing);
      uint64_t missed = 0;
      for (int32_t y = 0; y < 50; ++y) {
        for (int32_t x = 0; x < 50; ++x) {
          const auto place =
              firmware.place(south * 10000000 + y * 200000, -1800000000 + x * 200000);
          missed += place.block_y >= firmware.stride() || !firmware.accepts(place) ? 1u : 0u;
        }
      }
      CAPTURE(south);
      CHECK(file.queried == 2500);
      CHECK(file.missed == missed);
      if (south >= -75 && south < 75) CHECK(missed == 0);
      if (south < -82 || south >= 82) CHECK(missed > 0);
    }
    CHECK_THROWS_WITH(
        autopilot_file(surface_of({-90, 0}), autopilot, {-90, 0}, spacing),
        "firmware's distances end at 89.43 degrees: cells at the poles are not written");
    CHECK_THROWS(autopilot_file(surface_of({89, 0}), autopilot, {89, 0}, spacing));
  }
}

TEST_CASE("autopilot: heights that do not fit and other cells are refused" * kSlow) {
  const DegreeCell cell{43, 7};
  const auto refusal = [&](const SampledSurface& surface, DegreeCell there, Autopilot autopilot) {
    try {
      autopilot_file(surface, autopilot, there, 100);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusal(surface_of(cell), {44, 9}, Autopilot::kInav) ==
        "the terrain has no height in the cell; name the file after a cell that has some");
  SampledSurface cliff = surface_of(cell);
  cliff.height_at =
      answering([](int64_t x, int64_t) { return x < 600 * 256 ? 0 : 2050 * 10 * 65536; });
  CHECK(refusal(cliff, cell, Autopilot::kArduPilot).empty());
  CHECK(refusal(cliff, cell, Autopilot::kInav).find("from 0 m to 2050 m in the block at 43.") == 0);
  cliff.height_at =
      answering([](int64_t x, int64_t) { return x < 600 * 256 ? 0 : 2046 * 10 * 65536; });
  CHECK(refusal(cliff, cell, Autopilot::kInav).empty());
  SampledSurface tower = surface_of(cell);
  tower.placement.z = {0, 100, 1};
  tower.height_at = answering([](int64_t, int64_t) { return 400 * 65536; });
  CHECK(refusal(tower, cell, Autopilot::kArduPilot) ==
        "a height of 40000 m does not fit 16 bits; cut such heights out of the terrain");
}

TEST_CASE("autopilot: the suffix selects the autopilot") {
  CHECK(autopilot_of("x.TER") == Autopilot::kInav);
  CHECK(autopilot_of("x.dat") == Autopilot::kArduPilot);
  CHECK(!autopilot_of("x.asc"));
}

}  // namespace microtin::tests
