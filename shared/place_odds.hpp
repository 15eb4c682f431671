// What weighs the places in the free region of a triangle.
//
// A cell weighs the share of it that is free, times the chance that no other point came first: the
// walk inserts the point whose circle through the chord is the smallest, and with density points
// per unit area a circle that sweeps an area s over the chord is the first with probability
// exp(-density * s). On terrains, places close to the ends of the chord weigh less.
#ifndef MICROTIN_SHARED_PLACE_ODDS_HPP
#define MICROTIN_SHARED_PLACE_ODDS_HPP

#include "shared/cells.hpp"

namespace microtin {

// Numbers of circles. Those behind the sides come first.
constexpr int kOwn = 3, kEnds = 4, kCircles = 6;

constexpr int kSweepNodes = 4;
constexpr int kSweepSteps = 8 * kSweepNodes;

// Powers are seen from the middle of the grid.
struct PlaceOdds {
  Grid grid;
  // Of the triangles behind the sides, t's own, and points: the ends of the chord.
  Power circle[kCircles];
  bool matters[kCircles];  // in the grid
  Cells distance[kEnds];   // how far the cells are outside
  Cells weight;
  int64_t reach;     // of repulsion: two points' area, in quarter units
  bool sweeps;       // whether the chance of being first differs noticeably over the region
  Power swept_from;  // where the sweep starts: the circle behind the chord
  // 511 * chance of being first, at equal steps of the cotangent from t's circle to swept_from, and
  // at the cells.
  int16_t chance_at[kSweepSteps + 1];
  Cells chance;
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
  odds.sweeps = last < 448;
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
inline void estimate_odds(PlaceOdds& odds, const FreeRegion& region, Offset middle, Log2 density,
                          bool repels) {
  const Side& chord = region.side[kChord];
  for (int i = 0; i < 3; ++i) {
    const Side& side = region.side[i];
    odds.matters[i] = side.certified && !side.ghost;
    if (odds.matters[i]) odds.circle[i] = circle_over(region, i, side.behind, middle);
  }
  odds.matters[kOwn] = true;
  odds.circle[kOwn] = circle_over(region, kChord, chord.own, middle);
  const uint64_t two_points = exp2_of(kLog2One - density), most = static_cast<uint64_t>(1) << 45;
  odds.reach = static_cast<int64_t>(two_points < most ? two_points : most);
  for (int i = 0; i < 2; ++i) {
    odds.matters[kEnds + i] = repels;
    odds.circle[kEnds + i] = point_circle(region.corner[2 * i], middle);
  }
  // With nothing behind the chord the sweep starts at a circle so large that its segment is next to
  // nothing.
  Cotangent from = chord.behind;
  if (chord.ghost) {
    from = (chord.own < 0 ? chord.own : 0) - 8 * 256;
    odds.swept_from = circle_over(region, kChord, from, middle);
  } else {
    odds.swept_from = odds.circle[kChord];
  }
  estimate_sweep(odds, dot(region.corner[2], region.corner[2]), from,
                 chord.ghost ? segment(from) : region.swept_from, chord.own, density);
}

// Looks up the chances of being first at the cells.
MICROTIN_OUT_OF_LINE inline void sweep(PlaceOdds& odds) {
  int16_t* const left = odds.chance;
  int16_t* const all = odds.weight;
  measure(odds.swept_from, scale_for(odds.circle[kOwn], odds.grid), odds.grid, all);
  for (int k = 0; k < kCells; ++k) {
    left[k] = clamped(static_cast<int16_t>(-odds.distance[kOwn][k]), 0, 16383);
    all[k] = static_cast<int16_t>(clamped(all[k], 1, 16383) + left[k]);
  }
  for (int k = 0; k < kCells; ++k) {
    const uint32_t steps = static_cast<uint32_t>(left[k]) * kSweepSteps;
    odds.chance[k] = odds.chance_at[steps / static_cast<uint16_t>(all[k])];
  }
}

MICROTIN_OUT_OF_LINE inline void weigh_inside(PlaceOdds& odds) {
  if (odds.sweeps) {
    sweep(odds);
  } else {
    for (int k = 0; k < kCells; ++k) odds.chance[k] = 511;
  }
  for (int k = 0; k < kCells; ++k) {
    const int16_t share = clamped(static_cast<int16_t>(32 - odds.distance[kOwn][k]), 0, 64);
    odds.weight[k] = static_cast<int16_t>(share * odds.chance[k]);
  }
}

// Vertices of a terrain keep apart: within a quarter of the points' mean spacing of an end of the
// chord, where the power is below reach / 8, places are the rarer the closer they are. Where cells
// are much larger, that is not worth telling (and distances would not fit 16 bits).
inline void repel(PlaceOdds& odds) {
  const int64_t width = odds.grid.columns.count, height = odds.grid.rows.count;
  const int64_t diagonal2 = width * width + height * height;
  if (odds.reach < diagonal2 * 3 / 32 + 8) return;
  const Scale scale = scale_by(odds.reach);
  for (int k = kEnds; k < kCircles; ++k) {
    if (!odds.matters[k] || odds.circle[k].value > odds.reach / 4 + diagonal2) continue;
    measure(odds.circle[k], scale, odds.grid, odds.chance);  // the chances are used up
    cut(odds.chance, 0, odds.weight);
  }
}

inline void weigh_cells(PlaceOdds& odds) {
  for (int k = 0; k < kEnds; ++k) {
    if (!odds.matters[k]) continue;
    measure(odds.circle[k], scale_for(odds.circle[k], odds.grid), odds.grid, odds.distance[k]);
  }
  weigh_inside(odds);
  for (int k = 0; k < kOwn; ++k) {
    if (odds.matters[k]) cut(odds.distance[k], 32, odds.weight);
  }
  repel(odds);
}

// Makes a cell the box that the odds are about.
inline void narrow(PlaceOdds& odds, int i, int j) {
  const Offset to = middle_of(odds.grid, i, j);
  for (int k = 0; k < kCircles; ++k) {
    if (!odds.matters[k]) continue;
    if (k < kOwn) odds.matters[k] = odds.distance[k][kSlices * i + j] < 64;
    odds.circle[k] = moved(odds.circle[k], to);
  }
  odds.swept_from = moved(odds.swept_from, to);
}

}  // namespace microtin

#endif
