// SPDX-License-Identifier: MIT
// The blocks of autopilots' terrain files, 2,048 bytes each. Sources as of autopilot_layout.hpp.
#ifndef MICROTIN_ENCODER_EXPORT_AUTOPILOT_BLOCK_HPP
#define MICROTIN_ENCODER_EXPORT_AUTOPILOT_BLOCK_HPP

#include <cstdint>
#include <limits>
#include <vector>

#include "encoder/export/autopilot_layout.hpp"

namespace microtin::exporting {

// Heights of all posts of a layout, in millimetres, row by row.
struct AutopilotPosts {
  std::vector<int32_t> heights;
  uint64_t beyond = 0;  // beyond the terrain's edge, with the height there
};

constexpr int32_t kNoHeight = std::numeric_limits<int32_t>::min();

// One block of a file, in the caller's bytes.
class AutopilotBlock {
 public:
  static constexpr size_t kBytes = 2048;

  // A bit for each group of 4 x 4 posts: whether it is there.
  static constexpr uint32_t kGroup = 4, kGroupColumns = kBlockColumns / kGroup;
  static constexpr uint32_t kGroups = kBlockRows / kGroup * kGroupColumns;
  static constexpr uint64_t kAllGroups = (uint64_t{1} << kGroups) - 1;

  AutopilotBlock(const AutopilotLayout& layout, uint32_t row, uint32_t column, uint8_t* bytes)
      : layout_(layout), row_(row), column_(column), bytes_(bytes) {}

  uint64_t groups() const;
  static bool has_post(uint64_t groups, uint32_t row, uint32_t column) {
    return (groups >> (row / kGroup * kGroupColumns + column / kGroup) & 1) != 0;
  }

  // In metres, as the firmware reads it.
  int32_t height(uint32_t row, uint32_t column) const;

  // Leaves zeros if no group is known. Throws Error where INAV's ten bits do not hold the heights.
  void write(const AutopilotPosts& posts);

 private:
  int32_t post(const AutopilotPosts& posts, uint32_t row, uint32_t column) const;
  bool is_known(const AutopilotPosts& posts, uint32_t group) const;
  template <class Visit>
  void for_each(const AutopilotPosts& posts, uint64_t groups, const Visit& visit) const;
  void write_header(uint64_t groups, uint64_t version);
  void write_trailer(uint8_t* at) const;
  void write_heights(const AutopilotPosts& posts, uint64_t groups);
  void write_offsets(const AutopilotPosts& posts, uint64_t groups);
  [[noreturn]] void refuse(int32_t lowest, int32_t highest) const;

  const AutopilotLayout& layout_;
  uint32_t row_, column_;
  uint8_t* bytes_;
};

}  // namespace microtin::exporting

#endif
