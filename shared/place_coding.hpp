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
  // 4096 * chance of being first, at equal steps of the cotangent from swept_from to `inside`
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
    const Log2 left = loss < 12 * 256 ? 12 * 256 - static_cast<Log2>(loss) : 0;
    odds.chance[i] = static_cast<uint16_t>(exp2_of(left));
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

// Four slices of `count` <= 2^16 lattice lines: where each starts, where the last one ends, and the
// middles in half steps from the middle of all.
struct Slices {
  int32_t count;
  int32_t start[kCells + 1];
  int32_t middle[kCells];
};

inline Slices slice(int32_t count) {
  Slices slices;
  slices.count = count;
  for (int i = 0; i <= kCells; ++i) slices.start[i] = count * i / kCells;
  for (int i = 0; i < kCells; ++i) slices.middle[i] = slices.start[i] + slices.start[i + 1] - count;
  return slices;
}

inline int slice_of(const Slices& slices, int32_t offset) {
  int i = 0;
  while (i < kCells - 1 && offset >= slices.start[i + 1]) ++i;
  return i;
}

// How far the slices' middles are outside a circle, in 64ths of a cell's extent across it:
// x[i] + y[j].
struct Distances {
  int32_t x[kCells], y[kCells];
};

// How powers become distances: shifted, multiplied, shifted again by kScaleShift.
struct Scale {
  uint32_t shift;
  int32_t reciprocal;
};
constexpr uint32_t kScaleShift = 23;

inline int32_t magnitude(int32_t v) {
  return v < 0 ? -v : v;
}

// The change of the power across a cell, at the middle of the box.
inline Scale scale_for(const Power& power, const Slices& columns, const Slices& rows) {
  // Twice the extent of a cell in half steps, less one lattice step.
  const int32_t width = columns.count > kCells ? columns.count - kCells : 0;
  const int32_t height = rows.count > kCells ? rows.count - kCells : 0;
  const int64_t x = static_cast<int64_t>(magnitude(power.x)) * width;  // < 2^44
  const int64_t y = static_cast<int64_t>(magnitude(power.y)) * height;
  const int64_t curve = (static_cast<int64_t>(width) * width + static_cast<int64_t>(height) * height) / 4;
  const int64_t ramp = ((x+y)*5/8 + curve*2) / 2 + 1;
  const uint32_t bits = highest_bit(static_cast<uint64_t>(ramp));
  const uint32_t shift = bits > 15 ? bits - 15 : 0;
  return Scale{shift, static_cast<int32_t>((1ul << 29) / static_cast<uint32_t>(ramp >> shift))};
}

constexpr int64_t kDistanceCap = static_cast<int64_t>(1) << 29;

inline int32_t scaled(int64_t power, const Scale& scale) {
  int64_t v = power >> scale.shift;
  if (v > kDistanceCap) v = kDistanceCap;
  if (v < -kDistanceCap) v = -kDistanceCap;
  return static_cast<int32_t>(v * scale.reciprocal >> kScaleShift);
}

inline Distances measure(const Power& power, const Scale& scale, const Slices& columns,
                         const Slices& rows) {
  Distances distances;
  for (int i = 0; i < kCells; ++i) {
    const int32_t m = columns.middle[i];
    distances.x[i] = scaled(power.value + static_cast<int64_t>(m) * (power.x + m), scale);
  }
  for (int i = 0; i < kCells; ++i) {
    const int32_t m = rows.middle[i];
    distances.y[i] = scaled(static_cast<int64_t>(m) * (power.y + m), scale);
  }
  return distances;
}

// Share of a cell, in 64ths, on the positive side of a circle, from the distance of its middle.
inline uint32_t share_beyond(int32_t distance) {
  return distance <= -32 ? 0 : distance >= 32 ? 64 : static_cast<uint32_t>(distance + 32);
}

typedef uint32_t CellWeights[kCells][kCells];

// Chance of being first at a place so far outside the circle behind the chord and inside t's.
inline uint32_t chance_at(const PlaceOdds& odds, int32_t gone, int32_t left) {
  const int32_t most = 1 << 20;
  gone = gone < 0 ? 0 : gone > most ? most : gone;
  left = left < 0 ? 0 : left > most ? most : left;
  const uint32_t share =
      static_cast<uint32_t>(gone) * 256u / static_cast<uint32_t>(gone + left + 1);  // < 256
  const uint32_t i = share >> 6, f = share & 63u;
  return (odds.chance[i] * (64u - f) + odds.chance[i + 1] * f) >> 6;
}

// How much a slice's width counts: nothing where all are about the same. At most 16.
inline uint32_t size_of(const Slices& slices, int i) {
  const int32_t width = slices.start[i + 1] - slices.start[i];
  return slices.count > 64 ? 1u : static_cast<uint32_t>(width);
}

// Weighs the cells by size, by the share inside t's circle, and by the chance of being first. A
// cell without lattice points weighs nothing, any other at least 1.
inline void weigh_inside(const PlaceOdds& odds, const Slices& columns, const Slices& rows,
                         CellWeights weight) {
  const Scale scale = scale_for(odds.inside, columns, rows);
  const Distances inside = measure(odds.inside, scale, columns, rows);
  Distances from = inside;
  if (odds.sweeps) from = measure(odds.swept_from, scale, columns, rows);
  uint32_t height[kCells];
  for (int j = 0; j < kCells; ++j) height[j] = size_of(rows, j);
  for (int i = 0; i < kCells; ++i) {
    const uint32_t width = size_of(columns, i);
    for (int j = 0; j < kCells; ++j) {
      const uint32_t size = width * height[j];
      const int32_t left = -inside.x[i] - inside.y[j];
      const uint32_t share = share_beyond(left);
      uint32_t chance = 4096;
      if (odds.sweeps && share != 0) chance = chance_at(odds, from.x[i] + from.y[j], left);
      weight[i][j] = size == 0 ? 0 : share * chance * size + 1;
    }
  }
}

// Takes away what lies in one certified circle. False if that was nothing.
inline bool cut_outside(const Power& circle, const Slices& columns, const Slices& rows,
                        CellWeights weight) {
  const Distances outside = measure(circle, scale_for(circle, columns, rows), columns, rows);
  bool cuts = false;
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const uint32_t share = share_beyond(outside.x[i] + outside.y[j]);
      if (share == 64) continue;
      cuts = true;
      if (weight[i][j] != 0) weight[i][j] = (weight[i][j] >> 6) * share + 1;
    }
  }
  return cuts;
}

inline void weigh_cells(PlaceOdds& odds, const Slices& columns, const Slices& rows,
                        CellWeights weight) {
  weigh_inside(odds, columns, rows, weight);
  for (int k = 0; k < 3; ++k) {
    if (odds.cuts[k]) odds.cuts[k] = cut_outside(odds.outside[k], columns, rows, weight);
  }
}

// Codes one of two halves by their weights; a half without lattice points is never chosen.
template <class Coder>
bool code_half(Coder& coder, Calibration<kSplitEntries>& calibration, uint32_t low, uint32_t high,
               bool in_high) {
  if (low == 0) return true;
  if (high == 0) return false;
  while ((low | high) >> 16) { low >>= 1; high >>= 1; }
  return code_calibrated(coder, calibration, (high << 15) / (high + low), in_high);
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
    uint32_t column_weight[kCells];
    for (int i = 0; i < kCells; ++i) {
      column_weight[i] = weight[i][0] + weight[i][1] + weight[i][2] + weight[i][3];
    }
    const int i = code_slice(coder, &model.split[level][0], column_weight,
                             slice_of(columns, place.x - box.x0));
    const int j =
        code_slice(coder, &model.split[level][2], weight[i], slice_of(rows, place.y - box.y0));
    box.x1 = box.x0 + columns.start[i + 1] - 1;
    box.y1 = box.y0 + rows.start[j + 1] - 1;
    box.x0 += columns.start[i];
    box.y0 += rows.start[j];
    if (level + 1 == kLevels) break;
    odds.inside = moved(odds.inside, columns.middle[i], rows.middle[j]);
    odds.swept_from = moved(odds.swept_from, columns.middle[i], rows.middle[j]);
    for (int k = 0; k < 3; ++k) {
      if (odds.cuts[k]) odds.outside[k] = moved(odds.outside[k], columns.middle[i], rows.middle[j]);
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
