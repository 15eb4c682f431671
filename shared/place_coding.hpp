// Coding of the next point's place in the free region of the triangle it conflicts with.
//
// The box around the region is cut into 4 x 4 cells, the point's cell is coded, and the cell
// becomes the box; what remains is uniform. A cell weighs its number of lattice points, times the
// share of it that is free, times the chance that no other point came first: the walk inserts the
// point whose circle through the chord is the smallest, and with density points per unit area a
// circle that sweeps an area s over the chord is the first with probability exp(-density * s).
#ifndef MICROTIN_SHARED_PLACE_CODING_HPP
#define MICROTIN_SHARED_PLACE_CODING_HPP

#include "shared/free_region.hpp"
#include "shared/probability.hpp"

namespace microtin {

constexpr int kCells = 4;   // per axis
constexpr int kLevels = 2;  // of cells
constexpr uint32_t kSplitEntries = 9;
constexpr int kSweepEntries = 5;

// For each level and each of its four binary decisions: the odds learned for the estimated ones.
struct PlaceModel {
  Calibration<kSplitEntries> split[kLevels][4];
};

inline void reset(PlaceModel& model) {
  for (int level = 0; level < kLevels; ++level) {
    for (int decision = 0; decision < 4; ++decision) reset(model.split[level][decision]);
  }
}

// What weighs the cells of a box; the powers are seen from its middle.
struct PlaceOdds {
  Power inside;      // t's circle: negative where the point can be
  Power outside[3];  // certified neighbours' circles: positive where it can be
  bool cuts[3];      // which of them still cut the box
  bool sweeps;       // whether the chance of being first differs noticeably over the region
  Power swept_from;  // where the sweep starts: the circle behind the chord
  // 1023 * chance of being first, at equal steps of the cotangent from swept_from to `inside`
  uint16_t chance[kSweepEntries];
};

// Fills in the chances of being first; `density` is the logarithm of points per unit area.
inline void estimate_sweep(PlaceOdds& odds, const Offset chord, Cotangent from, Cotangent to,
                           Log2 density) {
  // Bits lost per unit of segment(), 17 fractional bits: log2(log2(e)) = 135 / 256.
  const Log2 scale = log2_of(static_cast<uint64_t>(dot(chord, chord))) + density + 135;
  const uint64_t rate = exp2_of(scale + 16 * kLog2One);  // 16 fractional bits
  const uint64_t capped = rate < (static_cast<uint64_t>(1) << 30) ? rate : static_cast<uint64_t>(1) << 30;
  const int64_t start = segment(from);
  for (int i = 0; i < kSweepEntries; ++i) {
    const int64_t swept = segment(from + (to - from) * i / (kSweepEntries - 1)) - start;
    const uint64_t loss = swept > 0 ? static_cast<uint64_t>(swept) * capped >> 25 : 0;
    const Log2 left = loss < 15 * 256 ? 15 * 256 - static_cast<Log2>(loss) : 0;
    odds.chance[i] = static_cast<uint16_t>(exp2_of(left) * 1023 >> 15);
  }
  odds.sweeps = odds.chance[kSweepEntries - 1] < odds.chance[0] - odds.chance[0] / 8;
}

inline void estimate_odds(PlaceOdds& odds, const FreeRegion& region, Offset middle, Log2 density) {
  const Side& chord = region.side[kChord];
  odds.inside = circle_over(region, kChord, chord.own, middle);
  for (int i = 0; i < 3; ++i) {
    const Side& side = region.side[i];
    odds.cuts[i] = side.certified && !side.ghost;
    if (odds.cuts[i]) odds.outside[i] = circle_over(region, i, side.behind, middle);
  }
  // With nothing behind the chord the sweep starts at a circle so large that its segment is next to
  // nothing.
  const Cotangent from = chord.ghost ? (chord.own < 0 ? chord.own : 0) - 8 * 256 : chord.behind;
  odds.swept_from =
      chord.ghost ? circle_over(region, kChord, from, middle) : odds.outside[kChord];
  estimate_sweep(odds, offset(region.corner[2], region.corner[0]), from, chord.own, density);
}

// Four slices of `count` <= 2^16 lattice lines: where each starts, and where the last one ends.
// Middles and extents are in units of 2^unit half steps, so that middles are below 2^10.
struct Slices {
  int32_t count;
  int32_t start[kCells + 1];
  uint32_t unit;
  int32_t middle[kCells];  // from the middle of all
  int32_t extent;          // of a slice, less one lattice step, 3 fractional bits; at least 1
};

inline Slices slice(int32_t count) {
  Slices slices;
  slices.count = count;
  const uint32_t bits = highest_bit(static_cast<uint32_t>(count));
  slices.unit = bits > 9 ? bits - 9 : 0;
  slices.start[0] = 0;
  for (int i = 0; i < kCells; ++i) {
    slices.start[i + 1] = static_cast<int32_t>(static_cast<uint32_t>(count) * (static_cast<uint32_t>(i) + 1u) >> 2);
    slices.middle[i] = (slices.start[i] + slices.start[i + 1] - count) >> slices.unit;
  }
  slices.extent = count > kCells ? (count - kCells) * 4 >> slices.unit : 1;
  return slices;
}

inline int slice_of(const Slices& slices, int32_t offset) {
  int i = 0;
  while (i < kCells - 1 && offset >= slices.start[i + 1]) ++i;
  return i;
}

// How powers become distances in 64ths of a cell's extent across the circle: shifted, multiplied,
// shifted by 20.
struct Scale {
  uint32_t shift;
  int32_t reciprocal;
};

// From the change of the power across a cell, at the middle of the box: slopes below 2^34, extents
// below 2^13.
inline Scale scale_for(const Power& power, const Slices& columns, const Slices& rows) {
  const int64_t x = static_cast<int64_t>(power.x < 0 ? -power.x : power.x) << columns.unit;
  const int64_t y = static_cast<int64_t>(power.y < 0 ? -power.y : power.y) << rows.unit;
  const int64_t curve_x = static_cast<int64_t>(columns.extent) << columns.unit;
  const int64_t curve_y = static_cast<int64_t>(rows.extent) << rows.unit;
  const int64_t ramp = ((x * columns.extent + y * rows.extent) * 5 +
                        (curve_x * curve_x + curve_y * curve_y)) / 8 + 1;
  const uint32_t bits = highest_bit(static_cast<uint64_t>(ramp));
  const uint32_t shift = bits > 15 ? bits - 15 : 0;
  return Scale{shift, static_cast<int32_t>((1ul << 29) / static_cast<uint32_t>(ramp >> shift))};
}

// Distances of the cells' middles from a circle, positive outside: x[i] + y[j].
struct Distances {
  int32_t x[kCells], y[kCells];
};

inline void measure_axis(int32_t constant, int32_t slope, const Slices& slices, const Scale& scale,
                         int32_t* distance) {
  const uint32_t shift = scale.shift + 4;
  const int32_t linear = static_cast<int32_t>((static_cast<int64_t>(slope) << slices.unit) * scale.reciprocal >> shift);
  const int32_t square = static_cast<int32_t>((static_cast<int64_t>(scale.reciprocal) << 2 * slices.unit) >> shift);
  for (int i = 0; i < kCells; ++i) {
    const int32_t m = slices.middle[i];
    distance[i] = constant + ((m * (linear + m * square)) >> 16);
  }
}

inline Distances measure(const Power& power, const Scale& scale, const Slices& columns,
                         const Slices& rows) {
  const int64_t cap = 1 << 30, far = 1 << 13;
  int64_t value = power.value >> scale.shift;
  value = value > cap ? cap : value < -cap ? -cap : value;
  value = value * scale.reciprocal >> 20;
  value = value > far ? far : value < -far ? -far : value;
  Distances distances;
  measure_axis(static_cast<int32_t>(value), power.x, columns, scale, distances.x);
  measure_axis(0, power.y, rows, scale, distances.y);
  return distances;
}

// Share of a cell, in 64ths, on the positive side of a circle, from the distance of its middle.
inline uint32_t share_beyond(int32_t distance) {
  return static_cast<uint32_t>(distance < -32 ? 0 : distance > 32 ? 64 : distance + 32);
}

typedef uint16_t CellWeights[kCells * kCells];  // columns one after the other

// Chance of being first at a place so far outside the circle behind the chord and inside t's.
inline uint32_t chance_at(const PlaceOdds& odds, int32_t gone, int32_t left) {
  if (gone < 0) gone = 0;
  if (left < 0) left = 0;
  const uint32_t share =
      static_cast<uint32_t>(gone) * 256u / static_cast<uint32_t>(gone + left + 1);  // < 256
  const uint32_t i = share >> 6, f = share & 63u;
  return (odds.chance[i] * (64u - f) + odds.chance[i + 1] * f) >> 6;
}

// Weighs the cells by the share inside t's circle, and by the chance of being first.
inline void weigh_inside(const PlaceOdds& odds, const Slices& columns, const Slices& rows,
                         CellWeights weight) {
  const Scale scale = scale_for(odds.inside, columns, rows);
  const Distances inside = measure(odds.inside, scale, columns, rows);
  if (!odds.sweeps) {
    for (int k = 0; k < kCells * kCells; ++k) {
      weight[k] = static_cast<uint16_t>(share_beyond(-inside.x[k / kCells] - inside.y[k % kCells]) * 1023u);
    }
    return;
  }
  const Distances from = measure(odds.swept_from, scale, columns, rows);
  for (int k = 0; k < kCells * kCells; ++k) {
    const int32_t left = -inside.x[k / kCells] - inside.y[k % kCells];
    const uint32_t share = share_beyond(left);
    weight[k] = 0;
    if (share != 0) weight[k] = static_cast<uint16_t>(share * chance_at(odds, from.x[k / kCells] + from.y[k % kCells], left));
  }
}

// Takes away what lies in one certified circle. False if that was nothing.
inline bool cut_outside(const Power& circle, const Slices& columns, const Slices& rows,
                        CellWeights weight) {
  const Distances outside = measure(circle, scale_for(circle, columns, rows), columns, rows);
  uint32_t all = 64;
  for (int k = 0; k < kCells * kCells; ++k) {
    const uint32_t share = share_beyond(outside.x[k / kCells] + outside.y[k % kCells]);
    all &= share;
    weight[k] = static_cast<uint16_t>((weight[k] * share) >> 6);
  }
  return all == 0;
}

inline void weigh_cells(PlaceOdds& odds, const Slices& columns, const Slices& rows,
                        CellWeights weight) {
  weigh_inside(odds, columns, rows, weight);
  for (int k = 0; k < 3; ++k) {
    if (odds.cuts[k]) odds.cuts[k] = cut_outside(odds.outside[k], columns, rows, weight);
  }
}

// How much a slice's width counts: nothing where all are about the same. At most 16.
inline uint32_t size_of(const Slices& slices, int i) {
  const int32_t width = slices.start[i + 1] - slices.start[i];
  return slices.count > 64 ? 1u : static_cast<uint32_t>(width);
}

// Codes one of two halves by their weights; a half without lattice points is never chosen.
template <class Coder>
bool code_half(Coder& coder, Calibration<kSplitEntries>& calibration, uint32_t low, uint32_t high,
               bool in_high) {
  if (low == 0) return true;
  if (high == 0) return false;
  const uint32_t bits = highest_bit(low + high);
  const uint32_t shift = bits > 16 ? bits - 16 : 0;
  const uint32_t p = ((high >> shift) << 15) / ((low + high) >> shift);
  return code_calibrated(coder, calibration, p > 32767 ? 32767 : p, in_high);
}

// Codes one of four slices by their weights.
template <class Coder>
int code_slice(Coder& coder, Calibration<kSplitEntries>* half, const uint32_t* weight, int slice) {
  const bool high =
      code_half(coder, half[0], weight[0] + weight[1], weight[2] + weight[3], slice >= 2);
  const int first = high ? 2 : 0;
  return first + code_half(coder, half[1], weight[first], weight[first + 1], (slice & 1) != 0);
}

// Codes a place in `box`, which encloses the free region.
template <class Coder>
Point code_place(Coder& coder, PlaceModel& model, PlaceOdds& odds, const FreeRegion& region,
                 Log2 density, Box box, Point place) {
  const Point v = region.corner[0];
  estimate_odds(odds, region, Offset{box.x0 + box.x1 - 2 * v.x, box.y0 + box.y1 - 2 * v.y},
                density);
  for (int level = 0; level < kLevels; ++level) {
    const Slices columns = slice(box.x1 - box.x0 + 1), rows = slice(box.y1 - box.y0 + 1);
    if (columns.count == 1 && rows.count == 1) break;
    CellWeights weight;
    weigh_cells(odds, columns, rows, weight);
    uint32_t row_size[kCells], column_weight[kCells], cell_weight[kCells];
    for (int j = 0; j < kCells; ++j) row_size[j] = size_of(rows, j);
    for (int i = 0; i < kCells; ++i) {
      column_weight[i] = 0;
      for (int j = 0; j < kCells; ++j) column_weight[i] += (weight[kCells * i + j] + 1u) * row_size[j];
      column_weight[i] *= size_of(columns, i);
    }
    const int i = code_slice(coder, &model.split[level][0], column_weight,
                             slice_of(columns, place.x - box.x0));
    for (int j = 0; j < kCells; ++j) cell_weight[j] = (weight[kCells * i + j] + 1u) * row_size[j];
    const int j =
        code_slice(coder, &model.split[level][2], cell_weight, slice_of(rows, place.y - box.y0));
    box.x1 = box.x0 + columns.start[i + 1] - 1;
    box.y1 = box.y0 + rows.start[j + 1] - 1;
    box.x0 += columns.start[i];
    box.y0 += rows.start[j];
    if (level + 1 == kLevels) break;
    const int32_t dx = columns.start[i] + columns.start[i + 1] - columns.count;
    const int32_t dy = rows.start[j] + rows.start[j + 1] - rows.count;
    odds.inside = moved(odds.inside, dx, dy);
    odds.swept_from = moved(odds.swept_from, dx, dy);
    for (int k = 0; k < 3; ++k) {
      if (odds.cuts[k]) odds.outside[k] = moved(odds.outside[k], dx, dy);
    }
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
