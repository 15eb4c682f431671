// SPDX-License-Identifier: MIT
// Places seen from a tile of a pack.
#ifndef MICROTIN_DECODER_LOCAL_POINT_HPP
#define MICROTIN_DECODER_LOCAL_POINT_HPP

#include "shared/compiler.hpp"
#include "shared/lattice.hpp"
#include "shared/pack_format.hpp"

namespace microtin {

// In steps with 8 fractional bits, from the first corner of a tile that the segment touches: within
// 2^25.
struct LocalPoint {
  int32_t x, y;
};

inline LocalPoint local(const TileBox& box, int64_t x, int64_t y) {
  return LocalPoint{static_cast<int32_t>(x - static_cast<int64_t>(box.x) * 256),
                    static_cast<int32_t>(y - static_cast<int64_t>(box.y) * 256)};
}

inline LocalPoint fine_point(Point p) {
  return LocalPoint{p.x * static_cast<int32_t>(256), p.y * static_cast<int32_t>(256)};
}

// Twice the signed area of (a, b, p): positive if p lies to the left of a -> b. Ends of segments
// are less than 2^24 apart, corners of triangles too, and none is farther than 2^26 from another:
// below 2^51.
MICROTIN_ONE_COPY inline int64_t orient(const LocalPoint& a, const LocalPoint& b,
                                        const LocalPoint& p) {
  return static_cast<int64_t>(b.x - a.x) * (p.y - a.y) -
         static_cast<int64_t>(b.y - a.y) * (p.x - a.x);
}

}  // namespace microtin

#endif
