// SPDX-License-Identifier: MIT
// Reading the terrain files of autopilots as their firmware does.
#ifndef MICROTIN_TESTS_SUPPORT_AUTOPILOT_READER_HPP
#define MICROTIN_TESTS_SUPPORT_AUTOPILOT_READER_HPP

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

#include "encoder/export/autopilot.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {

// What firmware does with a file, its arithmetic in single precision.
class Firmware {
 public:
  Firmware(const std::vector<uint8_t>& file, Autopilot autopilot, DegreeCell cell, uint32_t spacing)
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
    std::vector<uint8_t> checked(b, b + end);
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

  // CRC-16/XMODEM by long division, a byte at a time with sixteen zeros behind.
  static uint32_t remainder_of(const std::vector<uint8_t>& bytes) {
    static const std::array<uint32_t, 256> remainders = remainders_of_bytes();
    uint32_t rest = 0;
    for (const uint8_t byte : bytes) rest = (rest << 8 & 0xFF00) ^ remainders[rest >> 8 ^ byte];
    return rest;
  }

  static std::array<uint32_t, 256> remainders_of_bytes() {
    std::array<uint32_t, 256> remainders{};
    for (uint32_t byte = 0; byte < 256; ++byte) {
      uint32_t rest = byte << 16;
      for (uint32_t bit = 8; bit-- > 0;) {
        if ((rest >> bit & 0x10000) != 0) rest ^= 0x11021u << bit;
      }
      remainders[byte] = rest;
    }
    return remainders;
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

  const std::vector<uint8_t>& file_;
  bool inav_;
  DegreeCell cell_;
  uint32_t spacing_, stride_ = 0;
};

}  // namespace microtin::tests

#endif
