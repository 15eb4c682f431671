// SPDX-License-Identifier: MIT
// What weighs the places in the free region of a triangle.
//
// A cell weighs the share of it that is free, times the chance that no other point came first: the
// walk inserts the point whose circle through the chord is the smallest, and with density points
// per unit area a circle that sweeps an area s over the chord is the first with probability
// exp(-density * s).
#ifndef MICROTIN_SHARED_PLACE_ODDS_HPP
#define MICROTIN_SHARED_PLACE_ODDS_HPP

#include "shared/repulsion.hpp"

namespace microtin {

constexpr int kSweepNodes = 4;
constexpr int kSweepSteps = 8 * kSweepNodes;

struct PlaceOdds {
  Box box;              // from corner 0; encloses the free region
  Grid grid;            // of it
  bool matters[3];      // in the grid: the circle behind a side
  Distances behind[3];  // from these circles
  Power swept_from;     // the circle behind the chord
  Distances distance;   // from the circle in hand
  Cells weight;
  bool sweeps;  // whether the chance of being first differs noticeably over the region
  // 511 * chance of being first, at equal steps of the cotangent from the triangle's circle to that
  // behind the chord.
  int16_t chance_at[kSweepSteps + 1];
  Cells left, all;  // of the sweep, at the cells
  Repulsion repulsion;
};

// Eight equal steps from `from` towards `to`, both below 2^12.
MICROTIN_OUT_OF_LINE inline void interpolate(int16_t from, int16_t to, int16_t* step) {
  const int16_t start = static_cast<int16_t>(from * 8);
  const int16_t difference = static_cast<int16_t>(to - from);
  for (int16_t j = 0; j < 8; ++j) {
    const int16_t moved_by = static_cast<int16_t>(difference * j);
    step[j] = static_cast<int16_t>(static_cast<int16_t>(start + moved_by) >> 3);
  }
}

// 511 * chance of being first for a swept area, with 17 fractional bits as segment() has them;
// `rate` <= 2^30 is the density by that unit, with 16 fractional bits, times log2(e).
inline int16_t chance_of(int32_t swept, uint32_t rate) {
  const uint64_t loss = swept > 0 ? static_cast<uint64_t>(swept) * rate >> 25 : 0;
  const Log2 left = loss < 15 * kLog2One ? 15 * kLog2One - static_cast<Log2>(loss) : 0;
  return static_cast<int16_t>(exp2_of(left) * 511 >> 15);
}

// Fills in the chances of being first; `density` is the logarithm of points per unit area.
inline void estimate_sweep(PlaceOdds& odds, const FreeRegion& region, Log2 density) {
  const Cotangent from = region.side[kChord].behind, to = region.side[kChord].own;
  const Offset chord = region.corner[2];
  const int32_t start = segment(from);
  // log2(log2(e)) = 135 / 256.
  const Log2 log_rate = log2_of(static_cast<uint64_t>(dot(chord, chord))) + density + 135;
  const uint32_t rate = exp2_of(log_rate + 16 * kLog2One);
  int16_t last = chance_of(segment(to) - start, rate);
  odds.sweeps = last < 256;
  if (!odds.sweeps) return;
  for (int i = 1; i <= kSweepNodes; ++i) {
    const int16_t next = chance_of(segment(to + (((from - to) * i) >> 2)) - start, rate);
    interpolate(last, next, odds.chance_at + 8 * (i - 1));
    last = next;
  }
  odds.chance_at[kSweepSteps] = last;
}

// `density` is the logarithm of points per unit area.
inline void estimate_odds(PlaceOdds& odds, const FreeRegion& region, Log2 density) {
  for (int i = 0; i < 3; ++i) odds.matters[i] = region.side[i].certified && !region.side[i].ghost;
  estimate_sweep(odds, region, density);
}

// The circle over a side, seen from the middle of the grid.
inline Power circle(const PlaceOdds& odds, const FreeRegion& region, int side, Cotangent k) {
  return circle_over(region.corner[side], region.corner[side + 1], k, middle_of(odds.box));
}

// Multiplies the weights by the chances of being first: the sweep has passed some of the way from
// the circle behind the chord to the triangle's.
MICROTIN_OUT_OF_LINE MICROTIN_IN_PLACE inline void sweep(PlaceOdds& odds, const Scale& own) {
  int16_t* const left = odds.left;
  int16_t* const all = odds.all;
  measure(odds.swept_from, own, odds.grid, odds.distance);
  expand(odds.distance, all);
  for (int k = 0; k < kCells; ++k) {
    left[k] = clamped(static_cast<int16_t>(-left[k]), 0, 16383);
    all[k] = static_cast<int16_t>(clamped(all[k], 1, 16383) + left[k]);
  }
  for (int k = 0; k < kCells; ++k) {
    const uint32_t steps = static_cast<uint32_t>(left[k]) * kSweepSteps;
    const int16_t chance = odds.chance_at[steps / static_cast<uint16_t>(all[k])];
    odds.weight[k] = static_cast<int16_t>(odds.weight[k] * chance);
  }
}

// What the triangle's circle leaves of the cells, times the chances of being first.
MICROTIN_OUT_OF_LINE MICROTIN_IN_PLACE inline void weigh_inside(PlaceOdds& odds,
                                                                const FreeRegion& region) {
  const Power own = circle(odds, region, kChord, region.side[kChord].own);
  const Scale scale = scale_for(own, odds.grid);
  measure(own, scale, odds.grid, odds.distance);
  expand(odds.distance, odds.left);
  const int16_t whole = odds.sweeps ? 1 : 511;
  for (int k = 0; k < kCells; ++k) {
    const int16_t share = clamped(static_cast<int16_t>(32 - odds.left[k]), 0, 64);
    odds.weight[k] = static_cast<int16_t>(share * whole);
  }
  if (odds.sweeps) sweep(odds, scale);
}

MICROTIN_IN_PLACE inline void weigh_cells(PlaceOdds& odds, const FreeRegion& region) {
  odds.swept_from = circle(odds, region, kChord, region.side[kChord].behind);
  weigh_inside(odds, region);
  for (int k = 0; k < 3; ++k) {
    if (!odds.matters[k]) continue;
    const Power power =
        k == kChord ? odds.swept_from : circle(odds, region, k, region.side[k].behind);
    measure(power, scale_for(power, odds.grid), odds.grid, odds.behind[k]);
    cut(odds.behind[k], odds.weight);
  }
  if (repels(odds.repulsion))
    repel(odds.repulsion, region, middle_of(odds.box), odds.grid, odds.weight);
}

// Makes a cell the box.
inline void narrow(PlaceOdds& odds, int i, int j) {
  for (int k = 0; k < 3; ++k) {
    const Distances& outside = odds.behind[k];
    if (odds.matters[k]) odds.matters[k] = sum_of(outside.x[i], outside.y[j]) < 64;
  }
  if (repels(odds.repulsion)) odds.repulsion.nearest = odds.repulsion.near[kSlices * i + j];
  Box& box = odds.box;
  const FastInt* const column = odds.grid.columns.start + i;
  const FastInt* const row = odds.grid.rows.start + j;
  box = Box{box.x0 + column[0], box.y0 + row[0], box.x0 + column[1] - 1, box.y0 + row[1] - 1};
}

}  // namespace microtin

#endif
