// SPDX-License-Identifier: MIT
// Polygons and lines over a source: which of its posts or points they contain.
#ifndef MICROTIN_ENCODER_TERRAIN_POLYGONS_HPP
#define MICROTIN_ENCODER_TERRAIN_POLYGONS_HPP

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/layers.hpp"
#include "shared/lattice.hpp"

namespace microtin::terrain {

// In real coordinates.
struct RealPoint {
  Decimal x, y;                   // at most 12 decimals
  std::optional<Decimal> z = {};  // of lines that have heights
};

using RealLine = std::vector<RealPoint>;

// Rings that bound an area: a place is inside if a line from it crosses them an odd number of
// times.
using RealRings = std::vector<RealLine>;

// Rings in the numbers of a source, such as columns and rows: rounded to 1/1024 of a number.
class Rings {
 public:
  // Throws Error if a coordinate is 2^52 numbers away or farther.
  Rings(const RealRings& rings, const Axis& x, const Axis& y);

  // The numbers of a row that are inside or on the border, as pairs of a first and a last one;
  // these may overlap. O(edges).
  std::vector<std::pair<int64_t, int64_t>> spans(int64_t row) const;

  bool contains(int64_t x, int64_t y) const;

  // Calls visit(column, row) for each place of a raster that is inside or on the border, for some
  // more than once. O(places inside + rows * edges).
  template <class Visit>
  void visit_inside(uint32_t width, uint32_t height, const Visit& visit) const {
    for (uint32_t row = 0; row < height; ++row) {
      for (const auto& [first, last] : spans(row)) {
        const int64_t end = std::min<int64_t>(last, int64_t{width} - 1);
        for (int64_t x = std::max<int64_t>(first, 0); x <= end; ++x) {
          visit(static_cast<uint32_t>(x), row);
        }
      }
    }
  }

 private:
  struct Place {
    int64_t x, y;  // times 1024
  };
  struct Edge {
    Place low, high;  // by y
  };

  std::vector<Edge> edges_;
};

// The numbers of the corners, counter-clockwise, without places on edges (Andrew's monotone chain).
// Places are distinct and in lexicographic order. Of places on one line the corners are its ends;
// of one place there is none. O(places).
std::vector<uint32_t> hull_corners(const std::vector<Point>& places);

}  // namespace microtin::terrain

#endif
