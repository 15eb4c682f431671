// SPDX-License-Identifier: MIT
// Vertices of a terrain keep apart: places close to a corner of the triangle are the rarer the
// closer they are. How close counts is learned.
#ifndef MICROTIN_SHARED_REPULSION_HPP
#define MICROTIN_SHARED_REPULSION_HPP

#include "shared/cells.hpp"

namespace microtin {

// How close vertices come: over the points per unit area, the inverse of a squared distance, such
// that one in 192 * 256 / crowding places is closer than that to a corner. 8 fractional bits.
typedef uint32_t Crowding;
constexpr Crowding kCrowdingStart = 2048, kCrowdingLeast = 512, kCrowdingMost = 65536;

constexpr int16_t kReach = 256;  // the squared distance from which on nothing is repelled

// Coordinates are in sixteenths of the distance that counts, from the middle of the grid. They are
// below 2^12 within the first box, since the unit shrinks with it.
struct Repulsion {
  int32_t unit;     // that many 2^-16 are half a lattice step: at most 2^27
  int16_t nearest;  // squared distance of the box's middle from the nearest corner, at most 512
  Cells near;       // the same of the cells
};

// Half steps within the first box, below 2^(size + 1), in sixteenths.
inline int16_t scaled(int32_t unit, FastInt half_steps) {
  return static_cast<int16_t>(static_cast<int32_t>(half_steps) * unit >> 16);
}

// For a first box of which the longer side has 2^size .. 2^(size + 1) - 1 steps.
inline void start_repulsion(Repulsion& repulsion, uint32_t size, Log2 density, Crowding crowding) {
  // Sixteenths of half steps: 19 = 16 + 4 - 1. Within 2^(27 - size) all fits 32 bits.
  const uint32_t unit = exp2_of((log2_of(crowding) - 8 * kLog2One + density) / 2 + 19 * kLog2One);
  const uint32_t most = static_cast<uint32_t>(1) << (27 - size);
  repulsion.unit = static_cast<int32_t>(unit < most ? unit : most);
  repulsion.nearest = 0;
}

inline bool repels(const Repulsion& repulsion) {
  return repulsion.nearest < 2 * kReach;
}

// Weakens what is within reach.
MICROTIN_OUT_OF_LINE inline void weaken(const Cells near, Cells weight) {
  for (int k = 0; k < kCells; ++k) weight[k] = share_of(weight[k], clamped(near[k], 0, 255));
}

// The slices' middles; below 2^13.
inline void scale_middles(const Slices& slices, int32_t unit, int16_t* middle) {
  const int32_t scale = (unit << 2) >> slices.unit;
  for (int i = 0; i < kSlices; ++i) {
    middle[i] = static_cast<int16_t>(slices.middle[i] * scale >> 16);
  }
}

// Whether a corner is too far from all middles to matter: squared, 23 is above 2 * kReach.
inline bool is_far(const int16_t* middle, int16_t corner) {
  return corner < middle[0] - 23 || corner > middle[kSlices - 1] + 23;
}

MICROTIN_OUT_OF_LINE inline void square_distances(const int16_t* middle, int16_t corner,
                                                  int16_t* square) {
  for (int i = 0; i < kSlices; ++i) {
    const int16_t d = clamped(static_cast<int16_t>(middle[i] - corner), -127, 127);
    square[i] = static_cast<int16_t>(d * d);
  }
}

inline void keep_smaller_in_column(int16_t x, const int16_t* y, int16_t* near) {
  for (int j = 0; j < kSlices; ++j) {
    const int16_t sum = static_cast<int16_t>(x + y[j]);
    near[j] = sum < near[j] ? sum : near[j];
  }
}

MICROTIN_OUT_OF_LINE inline void keep_smaller(const Distances& squares, Cells near) {
  for (int i = 0; i < kSlices; ++i) {
    keep_smaller_in_column(squares.x[i], squares.y, near + kSlices * i);
  }
}

// Takes away weight close to the triangle's corners; `middle` of the grid, half steps from corner
// 0.
MICROTIN_IN_PLACE inline void repel(Repulsion& repulsion, const FreeRegion& region, Offset middle,
                                    const Grid& grid, Cells weight) {
  int16_t column[kSlices], row[kSlices];
  scale_middles(grid.columns, repulsion.unit, column);
  scale_middles(grid.rows, repulsion.unit, row);
  for (int k = 0; k < kCells; ++k) repulsion.near[k] = 2 * kReach;
  bool in_reach = false;
  for (int k = 0; k < 3; ++k) {
    const Offset corner = region.corner[k];
    const int16_t x = scaled(repulsion.unit, 2 * corner.x - middle.x);
    const int16_t y = scaled(repulsion.unit, 2 * corner.y - middle.y);
    if (is_far(column, x) || is_far(row, y)) continue;
    Distances squares;
    square_distances(column, x, squares.x);
    square_distances(row, y, squares.y);
    keep_smaller(squares, repulsion.near);
    in_reach = true;
  }
  if (in_reach) weaken(repulsion.near, weight);
}

inline void learn(Crowding& crowding, const Repulsion& repulsion) {
  if (repulsion.nearest < kReach) crowding += crowding >> 4;
  crowding -= 12;
  if (crowding < kCrowdingLeast) crowding = kCrowdingLeast;
  if (crowding > kCrowdingMost) crowding = kCrowdingMost;
}

}  // namespace microtin

#endif
