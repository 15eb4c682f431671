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

// Numbers of circles. Those behind the sides come first, then the triangle's own.
constexpr int kOwn = 3, kCircles = 4;

constexpr int kSweepNodes = 4;
constexpr int kSweepSteps = 8 * kSweepNodes;

// Powers are seen from the middle of the grid.
struct PlaceOdds {
  Grid grid;
  Power circle[kCircles];  // that behind the chord is where the sweep starts
  bool matters[kOwn];      // in the grid
  Distances distance[kCircles];
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
// `rate` < 2^31 is the density by that unit, with 16 fractional bits, times log2(e).
inline int16_t chance_of(int64_t swept, uint64_t rate) {
  const uint64_t loss = swept > 0 ? static_cast<uint64_t>(swept) * rate >> 25 : 0;
  const Log2 left = loss < 15 * kLog2One ? 15 * kLog2One - static_cast<Log2>(loss) : 0;
  return static_cast<int16_t>(exp2_of(left) * 511 >> 15);
}

// Fills in the chances of being first, from the circles of the cotangents `from` to `to`;
// `density` is the logarithm of points per unit area.
inline void estimate_sweep(PlaceOdds& odds, int64_t length2, Cotangent from, int64_t start,
                           Cotangent to, Log2 density) {
  // log2(log2(e)) = 135 / 256.
  const Log2 log_rate = log2_of(static_cast<uint64_t>(length2)) + density + 135;
  const uint64_t most = static_cast<uint64_t>(1) << 30;
  uint64_t rate = exp2_of(log_rate + 16 * kLog2One);
  if (rate > most) rate = most;
  int16_t last = chance_of(segment(to) - start, rate);
  odds.sweeps = last < 256;
  if (!odds.sweeps) return;
  for (int i = 1; i <= kSweepNodes; ++i) {
    int16_t next = 511;
    if (i != kSweepNodes) next = chance_of(segment(to + (((from - to) * i) >> 2)) - start, rate);
    interpolate(last, next, odds.chance_at + 8 * (i - 1));
    last = next;
  }
  odds.chance_at[kSweepSteps] = last;
}

// `middle` of the box, half steps from corner 0; `density` is the logarithm of points per unit
// area.
inline void estimate_odds(PlaceOdds& odds, const FreeRegion& region, Offset middle, Log2 density) {
  const Side& chord = region.side[kChord];
  const Offset* const corner = region.corner;
  for (int i = 0; i < 2; ++i) {
    const Side& side = region.side[i];
    odds.matters[i] = side.certified && !side.ghost;
    if (odds.matters[i])
      odds.circle[i] = circle_over(corner[i], corner[i + 1], side.behind, middle);
  }
  odds.circle[kOwn] = circle_over(corner[2], corner[0], chord.own, middle);
  // With nothing behind the chord the sweep starts at a circle so large that its segment is next to
  // nothing.
  Cotangent from = chord.behind;
  if (chord.ghost) from = (chord.own < 0 ? chord.own : 0) - 8 * 256;
  odds.matters[kChord] = !chord.ghost;
  odds.circle[kChord] = circle_over(corner[2], corner[0], from, middle);
  estimate_sweep(odds, dot(corner[2], corner[2]), from,
                 chord.ghost ? segment(from) : region.swept_from, chord.own, density);
}

// Multiplies the weights by the chances of being first: the sweep has passed some of the way from
// the circle behind the chord to the triangle's.
MICROTIN_OUT_OF_LINE inline void sweep(PlaceOdds& odds, const Scale& own) {
  int16_t* const left = odds.left;
  int16_t* const all = odds.all;
  measure(odds.circle[kChord], own, odds.grid, odds.distance[kChord]);
  expand(odds.distance[kChord], all);
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
MICROTIN_OUT_OF_LINE inline void weigh_inside(PlaceOdds& odds) {
  const Scale own = scale_for(odds.circle[kOwn], odds.grid);
  measure(odds.circle[kOwn], own, odds.grid, odds.distance[kOwn]);
  expand(odds.distance[kOwn], odds.left);
  const int16_t whole = odds.sweeps ? 1 : 511;
  for (int k = 0; k < kCells; ++k) {
    const int16_t share = clamped(static_cast<int16_t>(32 - odds.left[k]), 0, 64);
    odds.weight[k] = static_cast<int16_t>(share * whole);
  }
  if (odds.sweeps) sweep(odds, own);
}

inline void weigh_cells(PlaceOdds& odds) {
  weigh_inside(odds);
  for (int k = 0; k < kOwn; ++k) {
    if (!odds.matters[k]) continue;
    measure(odds.circle[k], scale_for(odds.circle[k], odds.grid), odds.grid, odds.distance[k]);
    cut(odds.distance[k], odds.weight);
  }
  if (repels(odds.repulsion)) repel(odds.repulsion, odds.grid, odds.weight);
}

// Makes a cell the box that the odds are about.
inline void narrow(PlaceOdds& odds, int i, int j) {
  const Offset to = middle_of(odds.grid, i, j);
  for (int k = 0; k < kCircles; ++k) {
    const Distances& outside = odds.distance[k];
    if (k < kOwn) odds.matters[k] = odds.matters[k] && sum_of(outside.x[i], outside.y[j]) < 64;
    if (k >= kChord || odds.matters[k]) odds.circle[k] = moved(odds.circle[k], to);
  }
  if (repels(odds.repulsion)) narrow(odds.repulsion, to);
}

}  // namespace microtin

#endif
