// SPDX-License-Identifier: MIT
// Terrain files of autopilots, read by other code, written from the firmware's side: from a place
// to its block, in single precision.
#include "encoder/export/autopilot.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {
namespace {

using Bytes = std::vector<uint8_t>;

// Waves on a slope over a cell and a bit, in metres; degrees from its corner.
double wave(double x, double y) {
  return 900 + 300 * std::sin(x * 40) * std::cos(y * 35) + 200 * (x + y);
}

SampledSurface surface_of(DegreeCell cell, double scale = 1) {
  SampledSurface surface;
  surface.placement.x = {int64_t{cell.longitude} * 1200 - 12, 1, 1200};
  surface.placement.y = {int64_t{cell.latitude} * 1200 - 12, 1, 1200};
  surface.placement.z = {0, 1, 10};
  surface.x_max = surface.y_max = 1248;
  surface.height_at = [scale](int64_t x, int64_t y) -> std::optional<int32_t> {
    const double u = static_cast<double>(x - 12 * 256) / (1200 * 256),
                 v = static_cast<double>(y - 12 * 256) / (1200 * 256);
    return static_cast<int32_t>(std::lround(wave(u, v) * scale * 10 * 65536));
  };
  return surface;
}

// What firmware does with a file, its arithmetic in single precision.
class Firmware {
 public:
  Firmware(const Bytes& file, Autopilot autopilot, DegreeCell cell, uint32_t spacing)
      : file_(file), inav_(autopilot == Autopilot::kInav), cell_(cell), spacing_(spacing) {
    const int32_t south = cell.latitude * 10000000;
    const float far = 2.0F * static_cast<float>(spacing) * 32;
    const float scale = cosine(south);
    const int32_t more = inav_ ? static_cast<int32_t>(far / (111319.5F * scale) * 1e7F)
                               : static_cast<int32_t>(far * 89.83204953368922F / scale);
    const float east = static_cast<float>(10000000 + more) * 0.011131884502145034F * scale;
    stride_ = static_cast<uint32_t>(east / static_cast<float>(spacing * 28));
  }

  struct Place {
    uint32_t block_x, block_y, x, y;  // x is north here, as in the firmware
    float part_x, part_y;
  };

  Place place(int32_t latitude, int32_t longitude) const {
    const int32_t south = cell_.latitude * 10000000, west = cell_.longitude * 10000000;
    const float north = static_cast<float>(latitude - south) * 0.011131884502145034F;
    const int32_t middle = inav_ ? latitude : south + (latitude - south) / 2;
    const float east =
        static_cast<float>(longitude - west) * 0.011131884502145034F * cosine(middle);
    const float step = static_cast<float>(spacing_);
    const auto x = static_cast<uint32_t>(north / step), y = static_cast<uint32_t>(east / step);
    return {x / 24,
            y / 28,
            x % 24,
            y % 28,
            (north - static_cast<float>(x) * step) / step,
            (east - static_cast<float>(y) * step) / step};
  }

  const uint8_t* block(const Place& p) const {
    return file_.data() + size_t{2048} * (size_t{stride_} * p.block_x + p.block_y);
  }

  // As it checks what it has read.
  bool accepts(const Place& p) const {
    const uint8_t* const b = block(p);
    const size_t end = inav_ ? 1151 : 1821, trailer = end - 7;
    Bytes checked(b, b + end);
    checked[16] = checked[17] = 0;
    if (!inav_ && b[1821] < 1) return false;
    return remainder_of(checked) == word(b + 16) && word(b + 18) == (inav_ ? 50 : 1) &&
           word(b + 20) == spacing_ && word(b + trailer) == p.block_x &&
           word(b + trailer + 2) == p.block_y &&
           static_cast<int16_t>(word(b + trailer + 4)) == cell_.longitude &&
           static_cast<int8_t>(b[trailer + 6]) == cell_.latitude && corner_is_right(b, p);
  }

  bool has(const Place& p, uint32_t x, uint32_t y) const {
    const uint32_t bit = x / 4 * 8 + y / 4;
    return (block(p)[bit / 8] >> bit % 8 & 1) != 0;
  }

  std::optional<float> height(const Place& p) const {
    float corner[2][2];
    for (uint32_t i = 0; i < 2; ++i) {
      for (uint32_t j = 0; j < 2; ++j) {
        if (!has(p, p.x + i, p.y + j)) return std::nullopt;
        corner[i][j] = static_cast<float>(post(p, p.x + i, p.y + j));
      }
    }
    const float south = corner[0][0] + (corner[0][1] - corner[0][0]) * p.part_y,
                north = corner[1][0] + (corner[1][1] - corner[1][0]) * p.part_y;
    return south + (north - south) * p.part_x;
  }

  // Ten bits one by one.
  int32_t post(const Place& p, uint32_t x, uint32_t y) const {
    const uint8_t* const b = block(p);
    const uint32_t number = x * 32 + y;
    if (!inav_) return static_cast<int16_t>(word(b + 22 + 2 * number));
    int32_t offset = 0;
    for (uint32_t i = 0; i < 10; ++i) {
      const uint32_t bit = 10 * number + i;
      offset += (b[22 + bit / 8] >> bit % 8 & 1) << i;
    }
    return static_cast<int16_t>(word(b + 1142)) + 2 * offset;
  }

  uint32_t stride() const { return stride_; }

 private:
  static float cosine(int32_t latitude) {
    return std::max(std::cos(static_cast<float>(latitude) * (1.0e-7F * 0.01745329252F)), 0.01F);
  }
  static uint32_t word(const uint8_t* at) { return at[0] + 256u * at[1]; }

  // CRC-16/XMODEM by long division, a bit at a time with sixteen zeros behind.
  static uint32_t remainder_of(Bytes bytes) {
    bytes.push_back(0);
    bytes.push_back(0);
    uint32_t rest = 0;
    for (size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      rest = rest << 1 | (static_cast<uint32_t>(bytes[bit / 8]) >> (7 - bit % 8) & 1u);
      if ((rest & 0x10000) != 0) rest ^= 0x11021;
    }
    return rest;
  }

  // Within 5 units, as ArduPilot allows; INAV allows 500.
  bool corner_is_right(const uint8_t* b, const Place& p) const {
    int32_t there[2];
    std::memcpy(there, b + 8, sizeof there);  // on a host whose numbers begin with the lowest byte
    const auto north =
        static_cast<int32_t>(static_cast<float>(p.block_x * 24 * spacing_) * 89.83204953368922F);
    const float scale = cosine(cell_.latitude * 10000000 + north / 2);
    const auto east = static_cast<int32_t>(static_cast<float>(p.block_y * 28 * spacing_) *
                                           89.83204953368922F / scale);
    return std::abs(there[0] - cell_.latitude * 10000000 - north) <= 5 &&
           std::abs(there[1] - cell_.longitude * 10000000 - east) <= 5;
  }

  const Bytes& file_;
  bool inav_;
  DegreeCell cell_;
  uint32_t spacing_, stride_ = 0;
};

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

}  // namespace

TEST_CASE("autopilot: firmware finds every height of a cell within a grid's error") {
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

TEST_CASE("autopilot: every byte of a block is that of the format") {
  const DegreeCell cell{43, 7};
  for (const Autopilot autopilot : {Autopilot::kArduPilot, Autopilot::kInav}) {
    const bool inav = autopilot == Autopilot::kInav;
    for (const uint32_t spacing : {30u, 100u}) {
      if (inav && spacing != 30) continue;
      // A plane that falls by whole metres, two at a time, from row to row of posts.
      SampledSurface surface = surface_of(cell);
      const double row = spacing * 89.83204953368922e-7 * 1200 * 256;
      surface.height_at = [row](int64_t, int64_t y) -> std::optional<int32_t> {
        const auto rows = std::lround(static_cast<double>(y - 12 * 256) / row);
        return static_cast<int32_t>((8000 - 2 * rows) * 10 * 65536 / 16);
      };
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

TEST_CASE("autopilot: what is not known is marked, and told") {
  const DegreeCell cell{43, 7};
  SampledSurface surface = surface_of(cell);
  const auto whole = surface.height_at;
  surface.height_at = [whole](int64_t x, int64_t y) -> std::optional<int32_t> {
    if (x > 300 * 256 && x < 500 * 256 && y > 600 * 256) return std::nullopt;
    return whole(x, y);
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

TEST_CASE("autopilot: heights that do not fit and other cells are refused") {
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
        "the terrain has no height in the cell");
  SampledSurface cliff = surface_of(cell);
  cliff.height_at = [](int64_t x, int64_t) -> std::optional<int32_t> {
    return x < 600 * 256 ? 0 : 2050 * 10 * 65536;
  };
  CHECK(refusal(cliff, cell, Autopilot::kArduPilot).empty());
  CHECK(refusal(cliff, cell, Autopilot::kInav).find("from 0 m to 2050 m in the block at 43.") == 0);
  cliff.height_at = [](int64_t x, int64_t) -> std::optional<int32_t> {
    return x < 600 * 256 ? 0 : 2046 * 10 * 65536;
  };
  CHECK(refusal(cliff, cell, Autopilot::kInav).empty());
  SampledSurface tower = surface_of(cell);
  tower.placement.z = {0, 100, 1};
  tower.height_at = [](int64_t, int64_t) -> std::optional<int32_t> { return 400 * 65536; };
  CHECK(refusal(tower, cell, Autopilot::kArduPilot) == "a height of 40000 m does not fit 16 bits");
}

TEST_CASE("autopilot: names tell the cell") {
  CHECK(cell_of("a/N43E007.TER").latitude == 43);
  CHECK(cell_of("s01w180.dat").longitude == -180);
  CHECK(cell_of("s01w180.dat").latitude == -1);
  for (const char* const name :
       {"N43E07.TER", "area.DAT", "N90E000.TER", "N00E180.TER", "S91E000.DAT"}) {
    CHECK_THROWS_AS(cell_of(name), Error);
  }
  CHECK(autopilot_of("x.TER") == Autopilot::kInav);
  CHECK(autopilot_of("x.dat") == Autopilot::kArduPilot);
  CHECK(!autopilot_of("x.asc"));
}

}  // namespace microtin::tests
