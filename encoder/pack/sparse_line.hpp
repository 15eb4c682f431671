// SPDX-License-Identifier: MIT
// Borders through rasters whose posts are not at every place: which places count, and what stands
// for posts at corners and where a border passes between posts.
#ifndef MICROTIN_ENCODER_PACK_SPARSE_LINE_HPP
#define MICROTIN_ENCODER_PACK_SPARSE_LINE_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"
#include "encoder/terrain/survey.hpp"

namespace microtin::pack {

// How far the next post in a row or column is looked for: two grids next to each other may be so
// far apart without a void between them.
constexpr uint32_t farthest_post(uint32_t spacing) {
  return spacing == 1 ? 0 : 2 * spacing - 1;
}

// The samples of a part of a raster, and what lies between them. Places count from the part's
// first.
class PlaceSamples {
 public:
  PlaceSamples(const Raster& part, const std::vector<Sample>& samples);

  // What is at a place of a row or column.
  struct Found {
    bool is_known = false;         // a post, also a void one, or between two
    std::optional<Sample> sample;  // none: known to be void
  };
  Found post(uint32_t x, uint32_t y) const;       // there itself
  Found in_row(uint32_t x, uint32_t y) const;     // there, or between the next posts of the row
  Found in_column(uint32_t x, uint32_t y) const;  // likewise

  // There, or between the next posts around; nothing next to voids, and outside.
  std::optional<Sample> at(uint32_t x, uint32_t y) const;

  // Samples of all places that have one.
  std::vector<Sample> all() const;

 private:
  uint32_t width_, height_, reach_x_, reach_y_;
  const std::vector<Sample>& samples_;
  std::vector<uint32_t> numbers_;  // of samples, by place
};

// A border from a place of the part on, along x or y.
struct SparseLine {
  uint32_t x, y, places;
  bool is_row;
};

// The places of a border that count, in order, with its ends: posts; interpolated ones where it
// passes between posts; nothing where it ends. Places of
// samples count from the border's first.
std::vector<std::optional<Sample>> line_samples(const PlaceSamples& part, const SparseLine& line,
                                                uint32_t spacing);

}  // namespace microtin::pack

#endif
