// SPDX-License-Identifier: MIT
// Rasters that claim more posts than their files can hold.
#ifndef MICROTIN_ENCODER_IMPORT_CLAIMED_POSTS_HPP
#define MICROTIN_ENCODER_IMPORT_CLAIMED_POSTS_HPP

#include <algorithm>
#include <cstdint>

#include "encoder/layers.hpp"

namespace microtin::importing {

// Whether files of so many bytes, or of so many posts, can hold so many columns and rows, below
// 2^32 each. Memory is not taken by a header's count alone: up to 2^24 posts are believed, and 1024
// for each byte, which is what deflate comes to.
inline bool can_hold(uint64_t held, uint64_t columns, uint64_t rows) {
  constexpr uint64_t kBelieved = uint64_t{1} << 24, kPostsPerByte = 1024;
  return columns * rows <= std::max(kBelieved, held * kPostsPerByte);
}

}  // namespace microtin::importing

#endif
