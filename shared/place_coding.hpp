// Coding of the next point's place in the free region of the triangle it conflicts with.
//
// The box around the region is cut into 4 x 4 cells, the point's cell is coded, and the cell
// becomes the box; what remains is uniform. A cell weighs its number of lattice points, times the
// share of it that is free, times the chance that no other point came first: the walk inserts the
// point whose circle through the chord is the smallest, and with density points per unit area a
// circle that sweeps an area s over the chord is the first with probability exp(-density * s).
#ifndef MICROTIN_SHARED_PLACE_CODING_HPP
#define MICROTIN_SHARED_PLACE_CODING_HPP

#include "shared/format.hpp"
#include "shared/free_region.hpp"
#include "shared/probability.hpp"

namespace microtin {

constexpr int kCells = 4;   // per axis
constexpr uint32_t kSplitEntries = 9;
constexpr int kSweepNodes = 4;
constexpr int kSweepEntries = 8 * kSweepNodes + 1;

// For each level and each of its four binary decisions: the odds learned for the estimated ones.
struct PlaceModel {
  Calibration<kSplitEntries> split[kMaxLevels][4];
};

// Something for each cell, columns one after the other.
typedef int16_t Cells[kCells * kCells];

constexpr uint64_t kReachCap = static_cast<uint64_t>(1) << 45;

// Numbers of circles in PlaceOdds. Those of the sides come first.
constexpr int kOwn = 3, kEnds = 4, kCircles = 6;

// What weighs the cells of a box; the powers are seen from its middle.
struct PlaceOdds {
  // Of the triangles behind the sides, t's own, and points: the ends of the chord.
  Power circle[kCircles];
  bool cuts[kCircles];       // which of them matter in the box
  Cells distance[kCircles];  // how far the cells are outside of them
  int64_t reach;             // of repulsion, see repulsion_scale
  bool sweeps;        // whether the chance of being first differs noticeably over the region
  Power swept_from;   // where the sweep starts: the circle behind the chord
  // 511 * chance of being first, at equal steps of the cotangent from t's circle to swept_from
  int16_t chance[kSweepEntries];
  Cells chances;      // at the cells
};
// Eight equal steps from `from` towards `to`, both below 2^12.
MICROTIN_OUT_OF_LINE inline void interpolate(int16_t from, int16_t to, int16_t* step) {
  const int16_t start = static_cast<int16_t>(from * 8), difference = static_cast<int16_t>(to - from);
  for (int16_t j = 0; j < 8; ++j) {
    step[j] = static_cast<int16_t>(static_cast<int16_t>(start + static_cast<int16_t>(difference * j)) >> 3);
  }
}

// Fills in the chances of being first; `density` is the logarithm of points per unit area.
inline void estimate_sweep(PlaceOdds& odds, Offset chord, Cotangent from, int64_t start, Cotangent to,
                           Log2 density) {
  // Bits lost per unit of segment(), 17 fractional bits: log2(log2(e)) = 135 / 256.
  const Log2 scale = log2_of(static_cast<uint64_t>(dot(chord, chord))) + density + 135;
  const uint64_t rate = exp2_of(scale + 16 * kLog2One);  // 16 fractional bits
  const uint64_t capped = rate < (static_cast<uint64_t>(1) << 30) ? rate : static_cast<uint64_t>(1) << 30;
  int16_t last = 0;
  for (int i = 0; i <= kSweepNodes; ++i) {
    int16_t chance = 511;
    if (i != kSweepNodes) {
      const int64_t swept = segment(to + (((from - to) * i) >> 2)) - start;
      const uint64_t loss = swept > 0 ? static_cast<uint64_t>(swept) * capped >> 25 : 0;
      const Log2 left = loss < 15 * 256 ? 15 * 256 - static_cast<Log2>(loss) : 0;
      chance = static_cast<int16_t>(exp2_of(left) * 511 >> 15);
    }
    if (i != 0) interpolate(last, chance, odds.chance + 8 * (i - 1));
    last = chance;
  }
  odds.chance[kSweepEntries - 1] = last;
  odds.sweeps = odds.chance[0] < 448;
  for (int k = 0; k < kCells * kCells; ++k) odds.chances[k] = 511;
}

inline void estimate_odds(PlaceOdds& odds, const FreeRegion& region, Offset middle, Log2 density,
                          bool repels) {
  const Side& chord = region.side[kChord];
  odds.circle[kOwn] = circle_over(region, kChord, chord.own, middle);
  odds.cuts[kOwn] = true;
  for (int i = 0; i < 3; ++i) {
    const Side& side = region.side[i];
    odds.cuts[i] = side.certified && !side.ghost;
    if (odds.cuts[i]) odds.circle[i] = circle_over(region, i, side.behind, middle);
  }
  const uint64_t reach = exp2_of(kLog2One - density);
  odds.reach = static_cast<int64_t>(reach < kReachCap ? reach : kReachCap);
  for (int i = 0; i < 2; ++i) {
    odds.cuts[kEnds + i] = repels;
    odds.circle[kEnds + i] = point_circle(region.corner[2 * i], middle);
  }
  // With nothing behind the chord the sweep starts at a circle so large that its segment is next to
  // nothing.
  const Cotangent from = chord.ghost ? (chord.own < 0 ? chord.own : 0) - 8 * 256 : chord.behind;
  odds.swept_from = chord.ghost ? circle_over(region, kChord, from, middle) : odds.circle[kChord];
  estimate_sweep(odds, region.corner[2], from, chord.ghost ? segment(from) : region.swept_from,
                 chord.own, density);
}

// Four slices of `count` <= 2^16 lattice lines: where each starts, and where the last one ends.
struct Slices {
  int_fast32_t count;
  int_fast32_t start[kCells + 1];
  uint32_t unit;            // middles are in half steps / 2^(unit - 2), below 24576
  int16_t middle[kCells];   // from the middle of all
  int16_t square[kCells];   // middle^2 / 2^16
  int_fast32_t extent;      // of a slice, less one lattice step, in eighths of half steps; at least 1
};

inline Slices slice(int_fast32_t count) {
  Slices slices;
  slices.count = count;
  slices.unit = 16 - highest_bit(static_cast<uint32_t>(count));
  slices.start[0] = 0;
  for (int i = 0; i < kCells; ++i) {
    slices.start[i + 1] = count * (i + 1) >> 2;
    const int_fast32_t twice = slices.start[i] + slices.start[i + 1] - count;
    slices.middle[i] = static_cast<int16_t>((twice * (static_cast<int_fast32_t>(1) << slices.unit)) >> 2);
  }
  for (int i = 0; i < kCells; ++i) {
    slices.square[i] = static_cast<int16_t>(static_cast<int32_t>(slices.middle[i]) * slices.middle[i] >> 16);
  }
  slices.extent = count > kCells ? (count - kCells) * 4 : 1;
  return slices;
}

inline int slice_of(const Slices& slices, int_fast32_t offset) {
  int i = 0;
  while (i < kCells - 1 && offset >= slices.start[i + 1]) ++i;
  return i;
}

// How powers become distances in 64ths of a cell's extent across the circle: shifted, multiplied,
// shifted by 21.
struct Scale {
  uint32_t shift;
  int32_t reciprocal;  // 2^14 .. 2^27
};

inline Scale scale_by(int64_t ramp) {
  const uint32_t bits = highest_bit(static_cast<uint64_t>(ramp));
  const uint32_t shift = bits > 15 ? bits - 15 : 0;
  return Scale{shift, static_cast<int32_t>((1ul << 30) / static_cast<uint32_t>(ramp >> shift))};
}

// From the change of the power across a cell, at the middle of the box: slopes below 2^27, extents
// below 2^18.
inline Scale scale_for(const Power& power, const Slices& columns, const Slices& rows) {
  const int64_t x = power.x < 0 ? -power.x : power.x, y = power.y < 0 ? -power.y : power.y;
  const int64_t width = columns.extent, height = rows.extent;
  const int64_t ramp = ((x * width + y * height) * 5 + width * width + height * height) / 8 + 8;
  return scale_by(ramp);
}

// The power of slices' middles, in 64ths of a cell's extent: a parabola.
inline void measure_axis(int32_t constant, int_fast32_t slope, const Slices& slices, const Scale& scale,
                         int16_t* distance) {
  const int16_t linear = static_cast<int16_t>(static_cast<int64_t>(slope) * scale.reciprocal >> (scale.shift + slices.unit + 3));
  const int16_t square = static_cast<int16_t>((static_cast<int64_t>(scale.reciprocal) << 15) >> (scale.shift + 2 * slices.unit));
  for (int i = 0; i < kCells; ++i) {
    distance[i] = static_cast<int16_t>(constant + (static_cast<int32_t>(slices.middle[i]) * linear >> 16) + (static_cast<int32_t>(slices.square[i]) * square >> 16));
  }
}

inline void add_column(int16_t x, const int16_t* y, int16_t* sum) {
  for (int j = 0; j < kCells; ++j) sum[j] = static_cast<int16_t>(x + y[j]);
}

// How far the cells' middles are outside a circle.
MICROTIN_OUT_OF_LINE inline void measure(const Power& power, const Scale& scale, const Slices& columns,
                    const Slices& rows, Cells outside) {
  const int64_t cap = 1 << 30, far = 1 << 13;
  int64_t value = power.value >> scale.shift;
  value = value > cap ? cap : value < -cap ? -cap : value;
  value = value * scale.reciprocal >> 21;
  value = value > far ? far : value < -far ? -far : value;
  int16_t x[kCells], y[kCells];
  measure_axis(static_cast<int32_t>(value), power.x, columns, scale, x);
  measure_axis(0, power.y, rows, scale, y);
  add_column(x[0], y, outside);
  add_column(x[1], y, outside + kCells);
  add_column(x[2], y, outside + 2 * kCells);
  add_column(x[3], y, outside + 3 * kCells);
}

inline int16_t clamped(int16_t v, int16_t low, int16_t high) {
  const int16_t raised = v < low ? low : v;
  return raised > high ? high : raised;
}

// Takes away what lies inside a circle; a cell `margin` inside is gone.
MICROTIN_OUT_OF_LINE inline void cut(const Cells outside, int16_t margin, Cells weight) {
  for (int k = 0; k < kCells * kCells; ++k) {
    const int16_t share = clamped(static_cast<int16_t>(outside[k] + margin), 0, 63);
    weight[k] = static_cast<int16_t>((static_cast<uint32_t>(static_cast<uint16_t>(weight[k])) *
                                      (static_cast<uint16_t>(share << 10 ))) >> 16);
  }
}

// The chances of being first in the cells.
MICROTIN_OUT_OF_LINE inline void sweep(PlaceOdds& odds, const Slices& columns, const Slices& rows) {
  Cells left, total;
  const Scale scale = scale_for(odds.circle[kOwn], columns, rows);
  measure(odds.swept_from, scale, columns, rows, total);
  for (int k = 0; k < kCells * kCells; ++k) {
    left[k] = clamped(static_cast<int16_t>(-odds.distance[kOwn][k]), 0, 16383);
    total[k] = static_cast<int16_t>(clamped(total[k], 1, 16383) + left[k]);
  }
  for (int k = 0; k < kCells * kCells; ++k) {
    odds.chances[k] = odds.chance[static_cast<uint32_t>(left[k]) * 32u / static_cast<uint32_t>(total[k])];
  }
}

// How much a slice's width counts: nothing where all are about the same. At most 16.
inline uint32_t size_of(const Slices& slices, int i) {
  const int_fast32_t width = slices.start[i + 1] - slices.start[i];
  return slices.count > 64 ? 1u : static_cast<uint32_t>(width);
}

// Vertices of a terrain keep apart: within a quarter of the points' mean spacing of an end of the
// chord, where the power is below reach / 8, places are the rarer the closer they are. Where cells
// are much larger, that is not worth telling (and distances would not fit 16 bits).
inline void repel(PlaceOdds& odds, const Slices& columns, const Slices& rows, Cells weight) {
  const int64_t radius2 = static_cast<int64_t>(columns.count) * columns.count +
                          static_cast<int64_t>(rows.count) * rows.count;  // of the box
  if (odds.reach < radius2 * 3 / 32 + 8) return;
  const Scale scale = scale_by(odds.reach);
  for (int k = kEnds; k < kCircles; ++k) {
    if (!odds.cuts[k] || odds.circle[k].value > odds.reach / 4 + 2 * radius2) continue;
    measure(odds.circle[k], scale, columns, rows, odds.distance[k]);
    cut(odds.distance[k], 0, weight);
  }
}

// Weighs the cells by the share that is free, and by the chance of being first.
inline void weigh_cells(PlaceOdds& odds, const Slices& columns, const Slices& rows, Cells weight) {
  for (int k = 0; k < kEnds; ++k) {
    if (!odds.cuts[k]) continue;
    measure(odds.circle[k], scale_for(odds.circle[k], columns, rows), columns, rows,
            odds.distance[k]);
  }
  if (odds.sweeps) sweep(odds, columns, rows);
  for (int k = 0; k < kCells * kCells; ++k) {
    const int16_t share = clamped(static_cast<int16_t>(32 - odds.distance[kOwn][k]), 0, 64);
    weight[k] = static_cast<int16_t>(share * odds.chances[k]);
  }
  for (int k = 0; k < kOwn; ++k) {
    if (odds.cuts[k]) cut(odds.distance[k], 32, weight);
  }
  repel(odds, columns, rows, weight);
}

// Codes one of four slices by their weights: the half, then the quarter. What holds no lattice
// points weighs nothing and is never chosen.
template <class Coder>
int code_slice(Coder& coder, Calibration<kSplitEntries>* split, const uint32_t* weight,
               int slice) {
  uint32_t low = weight[0] + weight[1], high = weight[2] + weight[3];
  int first = 0;
  for (int half = 2; half != 0; half >>= 1, ++split) {
    bool in_high = low == 0;
    if (low != 0 && high != 0) {
      const uint32_t bits = highest_bit(low + high);
      const uint32_t shift = bits > 16 ? bits - 16 : 0;
      const uint32_t odds = ((high >> shift) << 15) / (((low + high) >> shift) + 1);
      in_high = code_calibrated(coder, *split, odds, (slice & half) != 0);
    }
    if (in_high) first += half;
    low = weight[first];
    high = weight[first + 1];
  }
  return first;
}

// Makes a cell the box.
inline void narrow(PlaceOdds& odds, Box& box, const Slices& columns, const Slices& rows, int i,
                   int j) {
  box.x1 = box.x0 + columns.start[i + 1] - 1;
  box.y1 = box.y0 + rows.start[j + 1] - 1;
  box.x0 += columns.start[i];
  box.y0 += rows.start[j];
  const int_fast32_t dx = columns.start[i] + columns.start[i + 1] - columns.count;
  const int_fast32_t dy = rows.start[j] + rows.start[j + 1] - rows.count;
  for (int k = 0; k < kCircles; ++k) {
    if (!odds.cuts[k]) continue;
    odds.cuts[k] = k >= kOwn || odds.distance[k][kCells * i + j] < 64;
    odds.circle[k] = moved(odds.circle[k], dx, dy);
  }
  odds.swept_from = moved(odds.swept_from, dx, dy);
}

// Codes the cell of `box` that holds the place, which becomes the box.
template <class Coder>
MICROTIN_OUT_OF_LINE void code_cell(Coder& coder, Calibration<kSplitEntries>* split,
                                    PlaceOdds& odds, Box& box, Point place) {
  const Slices columns = slice(box.x1 - box.x0 + 1), rows = slice(box.y1 - box.y0 + 1);
  if (columns.count == 1 && rows.count == 1) return;
  Cells weight;
  weigh_cells(odds, columns, rows, weight);
  uint32_t row_size[kCells], column_weight[kCells], cell_weight[kCells];
  for (int j = 0; j < kCells; ++j) row_size[j] = size_of(rows, j);
  for (int i = 0; i < kCells; ++i) {
    column_weight[i] = 0;
    for (int j = 0; j < kCells; ++j) {
      column_weight[i] += (static_cast<uint32_t>(weight[kCells * i + j]) + 1u) * row_size[j];
    }
    column_weight[i] *= size_of(columns, i);
  }
  const int i = code_slice(coder, &split[0], column_weight, slice_of(columns, place.x - box.x0));
  for (int j = 0; j < kCells; ++j) {
    cell_weight[j] = (static_cast<uint32_t>(weight[kCells * i + j]) + 1u) * row_size[j];
  }
  const int j = code_slice(coder, &split[2], cell_weight, slice_of(rows, place.y - box.y0));
  narrow(odds, box, columns, rows, i, j);
}

// Codes a place in `box`, which encloses the free region.
template <class Coder>
Point code_place(Coder& coder, PlaceModel& model, PlaceOdds& odds, const FreeRegion& region,
                 Log2 density, uint32_t levels, bool repels, Box box, Point place) {
  const Point v = region.origin;
  estimate_odds(odds, region, Offset{box.x0 + box.x1 - 2 * v.x, box.y0 + box.y1 - 2 * v.y},
                density, repels);
  for (uint32_t level = 0; level < levels; ++level) {
    code_cell(coder, model.split[level], odds, box, place);
  }
  const uint32_t x = coder.uniform(static_cast<uint32_t>(box.x1 - box.x0 + 1),
                                   static_cast<uint32_t>(place.x - box.x0));
  const uint32_t y = coder.uniform(static_cast<uint32_t>(box.y1 - box.y0 + 1),
                                   static_cast<uint32_t>(place.y - box.y0));
  return Point{static_cast<uint16_t>(static_cast<uint32_t>(box.x0) + x),
               static_cast<uint16_t>(static_cast<uint32_t>(box.y0) + y)};
}

}  // namespace microtin

#endif
