// SPDX-License-Identifier: MIT
#include "encoder/export/autopilot_block.hpp"

#include <algorithm>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/exact/wide.hpp"

namespace microtin::exporting {
namespace {

// Where what is in a block.
constexpr size_t kCheck = 16, kHeights = 22, kBase = 1142, kInavTrailer = 1144;
constexpr size_t kArduPilotTrailer = 1814, kTrailerBytes = 7;
constexpr uint64_t kArduPilotVersion = 1, kInavVersion = 50;

void put(uint8_t* at, uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) at[i] = static_cast<uint8_t>(value >> 8 * i);
}

uint64_t take(const uint8_t* at, int bytes) {
  uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value |= uint64_t{at[i]} << 8 * i;
  return value;
}

// CRC-16/XMODEM: polynomial 1021, from 0, no reflection.
uint16_t crc16(const uint8_t* bytes, size_t size) {
  uint32_t crc = 0;
  for (size_t i = 0; i < size; ++i) {
    crc ^= static_cast<uint32_t>(bytes[i]) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = crc << 1 ^ ((crc & 0x8000) != 0 ? 0x11021 : 0);
  }
  return static_cast<uint16_t>(crc);
}

}  // namespace

uint64_t AutopilotBlock::groups() const {
  return take(bytes_, 8);
}

int32_t AutopilotBlock::height(uint32_t row, uint32_t column) const {
  const uint32_t post = row * kBlockColumns + column;
  if (layout_.autopilot() == Autopilot::kArduPilot) {
    return static_cast<int16_t>(take(bytes_ + kHeights + 2 * size_t{post}, 2));
  }
  const uint32_t bit = 10 * post;
  const auto offset = static_cast<int32_t>(take(bytes_ + kHeights + bit / 8, 2) >> bit % 8 & 1023);
  return static_cast<int16_t>(take(bytes_ + kBase, 2)) + 2 * offset;
}

void AutopilotBlock::write(const AutopilotPosts& posts) {
  uint64_t groups = 0;
  for (uint32_t group = 0; group < kGroups; ++group) {
    if (is_known(posts, group)) groups |= uint64_t{1} << group;
  }
  if (groups == 0) return;
  const bool is_inav = layout_.autopilot() == Autopilot::kInav;
  write_header(groups, is_inav ? kInavVersion : kArduPilotVersion);
  if (is_inav) {
    write_offsets(posts, groups);
  } else {
    write_heights(posts, groups);
  }
  const size_t end = is_inav ? kInavTrailer : kArduPilotTrailer;
  write_trailer(bytes_ + end);
  // A byte of ArduPilot's block that the check does not cover: below 1 it warns of old data, and
  // does not arm.
  if (!is_inav) bytes_[kArduPilotTrailer + kTrailerBytes] = 1;
  put(bytes_ + kCheck, crc16(bytes_, end + kTrailerBytes), 2);
}

int32_t AutopilotBlock::post(const AutopilotPosts& posts, uint32_t row, uint32_t column) const {
  const size_t first = size_t{row_} * kOwnRows + row;
  return posts.heights[first * layout_.columns() + column_ * kOwnColumns + column];
}

bool AutopilotBlock::is_known(const AutopilotPosts& posts, uint32_t group) const {
  const uint32_t row = group / kGroupColumns * kGroup, column = group % kGroupColumns * kGroup;
  for (uint32_t i = 0; i < kGroup * kGroup; ++i) {
    if (post(posts, row + i / kGroup, column + i % kGroup) == kNoHeight) return false;
  }
  return true;
}

// Calls visit(post's number in the block, millimetres) for each that is there.
template <class Visit>
void AutopilotBlock::for_each(const AutopilotPosts& posts, uint64_t groups,
                              const Visit& visit) const {
  for (uint32_t row = 0; row < kBlockRows; ++row) {
    for (uint32_t column = 0; column < kBlockColumns; ++column) {
      if (has_post(groups, row, column))
        visit(row * kBlockColumns + column, post(posts, row, column));
    }
  }
}

void AutopilotBlock::write_header(uint64_t groups, uint64_t version) {
  const GeoPlace corner = layout_.corner(row_, column_);
  put(bytes_, groups, 8);
  put(bytes_ + 8, static_cast<uint64_t>(corner.latitude), 4);
  put(bytes_ + 12, static_cast<uint64_t>(corner.longitude), 4);
  put(bytes_ + 18, version, 2);
  put(bytes_ + 20, layout_.spacing(), 2);
}

void AutopilotBlock::write_trailer(uint8_t* at) const {
  put(at, row_, 2);
  put(at + 2, column_, 2);
  put(at + 4, static_cast<uint64_t>(layout_.cell().longitude), 2);
  put(at + 6, static_cast<uint64_t>(layout_.cell().latitude), 1);
}

void AutopilotBlock::write_heights(const AutopilotPosts& posts, uint64_t groups) {
  for_each(posts, groups, [&](uint32_t post, int32_t height) {
    put(bytes_ + kHeights + 2 * size_t{post},
        static_cast<uint64_t>(round_divide(Wide{height}, Wide{1000})), 2);
  });
}

void AutopilotBlock::write_offsets(const AutopilotPosts& posts, uint64_t groups) {
  int32_t lowest = std::numeric_limits<int32_t>::max(), highest = kNoHeight;
  for_each(posts, groups, [&](uint32_t, int32_t height) {
    lowest = std::min(lowest, height);
    highest = std::max(highest, height);
  });
  const auto base = static_cast<int32_t>(round_divide(Wide{lowest}, Wide{1000}));
  const auto steps = [base](int32_t height) {
    return static_cast<int64_t>(round_divide(Wide{height} - Wide{base} * 1000, Wide{2000}));
  };
  if (steps(highest) > 1023) refuse(lowest, highest);
  for_each(posts, groups, [&](uint32_t post, int32_t height) {
    const size_t bit = 10 * size_t{post};
    uint8_t* const at = bytes_ + kHeights + bit / 8;
    put(at, take(at, 2) | static_cast<uint64_t>(std::max<int64_t>(steps(height), 0)) << bit % 8, 2);
  });
  put(bytes_ + kBase, static_cast<uint64_t>(base), 2);
}

void AutopilotBlock::refuse(int32_t lowest, int32_t highest) const {
  const GeoPlace corner = layout_.corner(row_, column_);
  throw Error("from " + std::to_string(lowest / 1000) + " m to " + std::to_string(highest / 1000) +
              " m in the block at " + std::to_string(static_cast<double>(corner.latitude) * 1e-7) +
              ", " + std::to_string(static_cast<double>(corner.longitude) * 1e-7) +
              ": ten bits of 2 m hold 2046 m");
}

}  // namespace microtin::exporting
