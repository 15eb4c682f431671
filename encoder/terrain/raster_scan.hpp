// SPDX-License-Identifier: MIT
// What is to be known of a whole raster before its tiles are chosen.
#ifndef MICROTIN_ENCODER_TERRAIN_RASTER_SCAN_HPP
#define MICROTIN_ENCODER_TERRAIN_RASTER_SCAN_HPP

#include <cstdint>
#include <optional>

#include "encoder/base/work.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/lattice_choice.hpp"
#include "encoder/terrain/raster_reader.hpp"
#include "encoder/terrain/voids.hpp"

namespace microtin::terrain {

// A fingerprint that depends on a further number.
inline uint64_t mixed(uint64_t fingerprint, uint64_t number) {
  const uint64_t product = (fingerprint ^ number) * 0x9E3779B97F4A7C15u;
  return product ^ product >> 29;
}

struct RasterScan {
  uint64_t posts = 0, voids = 0;  // with a height, and without one
  Mended mended;
  NumberRange heights;
  Extremes extremes;
  uint64_t fingerprint = 0;  // of all heights; no match for somebody who wants to deceive it
  std::optional<Decimal> least_bound;  // above 0, with a bound
  bool has_exact_posts = false;        // posts have bounds of their own, and some are 0
  PostRectangle roughest{};  // the block of up to 257 x 257 posts that will take most vertices
};

// Reads the raster once, on all processors; the result does not depend on their number. The
// roughest block is looked for only if it is wanted: that takes most of the time.
RasterScan scan(const RasterReader& raster, const std::optional<Decimal>& max_error,
                bool wants_roughest, const Progress& progress);

// Estimates, to compare parts of one raster, how many vertices they will take: counts the posts
// that interpolation between those at a distance of 1, 2, 4, ... posts on both sides misses by more
// than the bound, and those next to voids. Linear.
uint64_t roughness(const Raster& part, const std::optional<Decimal>& max_error);

}  // namespace microtin::terrain

#endif
