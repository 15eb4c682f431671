// SPDX-License-Identifier: MIT
// Rasters that claim more posts than their files can hold.
#ifndef MICROTIN_ENCODER_IMPORT_CLAIMED_POSTS_HPP
#define MICROTIN_ENCODER_IMPORT_CLAIMED_POSTS_HPP

#include <algorithm>
#include <cstdint>

#include "encoder/layers.hpp"

namespace microtin::importing {

// Whether files with `held` bytes, or `held` posts, can hold a raster of `columns` x `rows`, below
// 2^32 each. A header's count alone takes no memory: the function accepts up to 2^24 posts, and
// 1024 for each byte, which is what deflate reaches.
inline bool can_hold(uint64_t held, uint64_t columns, uint64_t rows) {
  constexpr uint64_t kBelieved = uint64_t{1} << 24, kPostsPerByte = 1024;
  return columns * rows <= std::max(kBelieved, held * kPostsPerByte);
}

}  // namespace microtin::importing

#endif
