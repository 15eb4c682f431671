// SPDX-License-Identifier: MIT
// The border between two tiles, from corner to corner: a chain of vertices that both will have.
#ifndef MICROTIN_ENCODER_PACK_BORDER_LINE_HPP
#define MICROTIN_ENCODER_PACK_BORDER_LINE_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/fit/error_model.hpp"
#include "encoder/layers.hpp"

namespace microtin::pack {

// A post of the line, which runs along x or y: of its places, one coordinate ascends. Void posts
// have no sample.
struct LinePost {
  std::optional<Sample> sample;
  bool kept = false;  // must become a vertex
  int32_t aim = 0;    // the height that is best here, within the bounds or not, as a Sample's
};

// Where the surface has as much room above as below.
inline int32_t middle_of(const Sample& sample) {
  return static_cast<int32_t>((int64_t{sample.lowest} + sample.highest) / 2);
}

struct ChainVertex {
  uint32_t post;
  int16_t height;
};

// Few vertices whose chain passes every post within its bounds and near its aim: all posts if there
// are no bounds. Chains end at voids and at the ends of the line, where heights depend on the
// sample and the aim there alone. At most 65536 posts. O(n * the posts that a piece of the chain
// reaches).
// `price` says what a vertex is worth: squares of the bound, in sums of squared distances from
// aims.
std::vector<ChainVertex> simplify_line(const std::vector<LinePost>& posts, ErrorModel model,
                                       uint32_t price);

}  // namespace microtin::pack

#endif
