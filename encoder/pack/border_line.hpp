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
};

struct ChainVertex {
  uint32_t post;
  int16_t height;
};

// The fewest vertices, of equally many those nearest to the source, whose chain passes every post
// within its bounds: all posts if there are none. Chains end at voids and at the ends of the line,
// where heights depend on the sample there alone. At most 65536 posts. O(n * the posts that a piece
// of the chain reaches).
std::vector<ChainVertex> simplify_line(const std::vector<LinePost>& posts, ErrorModel model);

}  // namespace microtin::pack

#endif
