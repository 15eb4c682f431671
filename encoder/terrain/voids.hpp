// SPDX-License-Identifier: MIT
// Voids of a raster: how they are filled, heights that mark voids without a declaration, and water.
#ifndef MICROTIN_ENCODER_TERRAIN_VOIDS_HPP
#define MICROTIN_ENCODER_TERRAIN_VOIDS_HPP

#include <cstdint>
#include <optional>
#include <string>

#include "encoder/layers.hpp"
#include "encoder/terrain/raster_reader.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::terrain {

// Fills the void regions (connected by sides) of up to `largest` posts with heights whose every one
// is the mean of its four neighbours, like a soap film on the region's rim. Counts
// them as filled.
void fill_voids(Raster& raster, uint32_t largest);

struct Sides {
  bool west, south, east, north;
};

// Whether a void region of up to `largest` posts goes from the inner rectangle to one of these
// sides of the raster.
bool reaches_side(const Raster& raster, const PostRectangle& inner, Sides sides, uint32_t largest);

// Heights that look as if somebody had marked voids by them, and not said so.

// The lowest and the highest of some numbers, how many there are of both, and what comes next.
class Extremes {
 public:
  void add(int64_t number);
  void add(const Extremes& others);

  // The lowest or the highest, if it is a number that programs fill voids with, such as -9999, and
  // is farther from the next than all others are from each other. No land has such a place.
  struct Fill {
    int64_t value = 0;
    uint64_t count = 0;  // 0: there is none
  };
  Fill fill(int decimals) const;

 private:
  // The lowest of numbers times a sign, and the lowest of all others.
  struct End {
    int64_t first = 0, next = 0;
    uint64_t count = 0;
    bool has_next = false;

    void add(int64_t number, uint64_t times);
  };

  End low_, high_;  // high_: of the negative numbers
};

// A sentence that says so, with the remedy; empty if there is no such value.
std::string warning_on_fill(const Raster& raster);
std::string warning_on_fill(const PointCloud& cloud);
std::string warning_on_fill(const Extremes& posts, int decimals);

// Gives void posts the height of the water level: all, or those where the mask is 1. Posts with
// heights keep them. Counts those as flooded. Throws Error if the level needs more decimals than
// go with the heights.
void flood_voids(Raster& raster, Decimal level, const Raster* mask);

// Throws Error if the mask has not the posts of the raster, or holds anything but 0, 1 and voids.
void check_water_mask(const Raster& mask, const Raster& raster);

}  // namespace microtin::terrain

#endif
