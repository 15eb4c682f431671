// Coding of the next point's place in the free region of the triangle it conflicts with.
//
// The box around the region is cut into 4 x 4 cells, the point's cell is coded, and the cell
// becomes the box, three times; what remains is uniform. A cell weighs its number of lattice
// points, times the share of it that is free, times the chance that no other point came first: the
// walk inserts the point whose circle through the chord is the smallest, and with density points
// per unit area a circle that sweeps an area s over the chord is the first with probability
// exp(-density * s).
#ifndef MICROTIN_SHARED_PLACE_CODING_HPP
#define MICROTIN_SHARED_PLACE_CODING_HPP

#include "shared/free_region.hpp"
#include "shared/probability.hpp"

namespace microtin {

constexpr int kCells = 4;        // per axis
constexpr int kLevels = 3;       // of cells
constexpr int kSweepLevels = 2;  // of them weigh the chance of being first
constexpr uint32_t kSplitEntries = 17;
constexpr int32_t kEvenSplit = 8;  // the entry for even odds
constexpr int kSweepEntries = 9;

// For each level and each of its four binary decisions: the odds learned for the estimated ones.
struct PlaceModel {
  Curve<kSplitEntries> split[kLevels][4];
};

inline void reset(PlaceModel& model) {
  for (int level = 0; level < kLevels; ++level) {
    for (int decision = 0; decision < 4; ++decision) {
      reset(model.split[level][decision], -kEvenSplit * kLog2One, kLog2One);
    }
  }
}

// What weighs the cells of a box; the powers are relative to the box's first corner.
struct PlaceOdds {
  Power inside;        // t's circle: negative where the point can be
  Power outside[3];    // certified neighbours' circles: positive where it can be
  bool cuts[3];        // which of them still cut the box
  bool sweeps;         // whether the chance of being first differs noticeably over the region
  Power swept_from;    // where the sweep starts: the circle behind the chord
  int32_t steepening;  // steepness of `inside` over that of swept_from, 8 fractional bits
  // 4096 * chance of being first, at equal steps of the share of the way from swept_from to
  // `inside`
  uint16_t chance[kSweepEntries];
};

// A circle of the pencil through v and a, by the cotangent k of its inscribed angle on t's side,
// with 8 fractional bits.
typedef int64_t Cotangent;
constexpr Cotangent kCotangentCap = 32767;

inline Cotangent cotangent(int64_t q, int64_t h) {
  // |q| < 2^33; h is negative for an apex behind the chord.
  const int64_t k = h < 0 ? quotient(-q * 256, -h) : quotient(q * 256, h);
  return k > kCotangentCap ? kCotangentCap : k < -kCotangentCap ? -kCotangentCap : k;
}

// Fills in the chances of being first; `density` is the logarithm of points per unit area.
inline void estimate_sweep(PlaceOdds& odds, const FreeRegion& region, Log2 density) {
  const Point v = region.corner[0], c = region.corner[1], a = region.corner[2];
  const int64_t length2 = squared_length(v, a);
  const Cotangent to = cotangent(dot_at(c, v, a), orient2d(v, c, a));
  const Side& behind = region.side[kChord];
  Cotangent from;
  if (behind.ghost) {
    // Nothing behind the chord: start at a circle so large that its segment is next to nothing.
    from = (to < 0 ? to : 0) - 8 * 256;
    // Its power is that of t's circle plus (to - from) h(p), h(p) = twice the area of (a, v, p).
    const int64_t hx = static_cast<int32_t>(a.y) - v.y, hy = static_cast<int32_t>(v.x) - a.x;
    odds.swept_from = circle_with_gradient(cap_slope(odds.inside.x + (to - from) * hx),
                                           cap_slope(odds.inside.y + (to - from) * hy));
  } else {
    from = cotangent(dot_at(behind.apex, v, a), orient2d(a, v, behind.apex));
    odds.swept_from = odds.outside[kChord];
  }
  const int64_t steepening = quotient(odds.inside.steepness * 256, odds.swept_from.steepness);
  odds.steepening = steepening < 65535 ? static_cast<int32_t>(steepening) : 65535;
  const Area start = segment_area(length2, from, 256);
  for (int i = 0; i < kSweepEntries; ++i) {
    const Area swept =
        segment_area(length2, from + (to - from) * i / (kSweepEntries - 1), 256) - start;
    // chance = exp(-density * swept) = 2^-loss; log2(log2(e)) = 135 / 256.
    uint64_t loss = 0;
    if (swept > 0) loss = exp2_of(log2_of(static_cast<uint64_t>(swept)) + density + 135);
    const Log2 left = loss < 12 * 256 ? 12 * 256 - static_cast<Log2>(loss) : 0;
    odds.chance[i] = static_cast<uint16_t>(exp2_of(left));
  }
  odds.sweeps = odds.chance[kSweepEntries - 1] < odds.chance[0] - odds.chance[0] / 8;
}

inline void estimate_odds(PlaceOdds& odds, const FreeRegion& region, Log2 density) {
  odds.inside = circle_through(region.corner[0], region.corner[1], region.corner[2]);
  for (int i = 0; i < 3; ++i) {
    const Side& side = region.side[i];
    odds.cuts[i] = side.certified && !side.ghost;
    if (!odds.cuts[i]) continue;
    const Point from = region.corner[i], to = region.corner[i == 2 ? 0 : i + 1];
    const Power circle = circle_through(from, side.apex, to);
    odds.outside[i] = moved_origin(circle, static_cast<int32_t>(region.corner[0].x) - from.x,
                                   static_cast<int32_t>(region.corner[0].y) - from.y);
  }
  estimate_sweep(odds, region, density);
}

inline void move_origin(PlaceOdds& odds, int32_t dx, int32_t dy) {
  odds.inside = moved_origin(odds.inside, dx, dy);
  odds.swept_from = moved_origin(odds.swept_from, dx, dy);
  for (int i = 0; i < 3; ++i) {
    if (odds.cuts[i]) odds.outside[i] = moved_origin(odds.outside[i], dx, dy);
  }
}

// Four slices of `count` <= 2^16 lattice lines: where each starts, and where the last one ends.
struct Slices {
  int32_t count;
  int32_t start[kCells + 1];
};

inline Slices slice(int32_t count) {
  Slices slices;
  slices.count = count;
  for (int i = 0; i <= kCells; ++i) slices.start[i] = count * i / kCells;
  return slices;
}

inline int slice_of(const Slices& slices, int32_t offset) {
  int i = 0;
  while (i < kCells - 1 && offset >= slices.start[i + 1]) ++i;
  return i;
}

// How far the slices' middles are outside a circle, in 64ths of the size of a cell: x[i] + y[j],
// each within +-2^29. Close to the circle that is its power divided by the steepness.
struct Distances {
  int32_t x[kCells], y[kCells];
};

constexpr int64_t kDistanceCap = static_cast<int64_t>(1) << 29;

inline void measure_axis(int64_t constant, int64_t slope, const Slices& slices, uint32_t shift,
                         int32_t reciprocal, int32_t* distance) {
  for (int i = 0; i < kCells; ++i) {
    const int32_t twice = slices.start[i] + slices.start[i + 1] - 1;  // twice the middle
    const int64_t power = constant + (static_cast<int64_t>(twice) * 128 + slope) * twice / 2;
    int64_t scaled = power >> shift;
    if (scaled > kDistanceCap) scaled = kDistanceCap;
    if (scaled < -kDistanceCap) scaled = -kDistanceCap;
    distance[i] = static_cast<int32_t>((scaled * reciprocal) >> 23);
  }
}

inline Distances measure(const Power& circle, const Slices& columns, const Slices& rows) {
  // A cell spans 5/8 (mean of |cos| and |sin|) of its width and height less one lattice step each.
  // The ramp is that many steps' change of power: at least a quarter of a unit, at most 2^60.
  const int32_t steps = (columns.count > kCells ? columns.count - kCells : 0) +
                        (rows.count > kCells ? rows.count - kCells : 0);
  const int64_t ramp = circle.steepness * (5 * steps) / 32 + 64;
  const uint32_t bits = highest_bit(static_cast<uint64_t>(ramp));
  const uint32_t shift = bits > 15 ? bits - 15 : 0;
  // 64 / ramp: (power >> shift) * reciprocal / 2^23, the reciprocal at most 2^23. ramp >> shift is
  // below 2^16 and at least 64.
  const int32_t reciprocal =
      static_cast<int32_t>((1ul << 29) / static_cast<uint32_t>(ramp >> shift));
  Distances distances;
  measure_axis(circle.constant, circle.x, columns, shift, reciprocal, distances.x);
  measure_axis(0, circle.y, rows, shift, reciprocal, distances.y);
  return distances;
}

// Share of a cell, in 64ths, on the positive side of a circle, from the distance of its middle.
inline uint32_t share_beyond(int32_t distance) {
  return distance <= -32 ? 0 : distance >= 32 ? 64 : static_cast<uint32_t>(distance + 32);
}

typedef uint32_t CellWeights[kCells][kCells];

// Chance of being first at a place so far outside the circle behind the chord and inside t's.
inline uint32_t chance_at(const PlaceOdds& odds, int32_t gone, int32_t left) {
  const int32_t most = 1 << 14;
  if (gone < 0) gone = 0;
  if (gone > most) gone = most;
  left = left < 0 ? 0 : left > most ? most : left;
  left = (left * odds.steepening >> 8) + 1;  // < 2^30 before the shift
  const uint32_t share =
      static_cast<uint32_t>(gone) * 256u / static_cast<uint32_t>(gone + left);  // < 256
  const uint32_t i = share >> 5, f = share & 31u;
  return (odds.chance[i] * (32u - f) + odds.chance[i + 1] * f) >> 5;
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
  const Distances inside = measure(odds.inside, columns, rows);
  Distances from = inside;
  if (odds.sweeps) from = measure(odds.swept_from, columns, rows);
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
  const Distances outside = measure(circle, columns, rows);
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
bool code_half(Coder& coder, Curve<kSplitEntries>& curve, uint32_t low, uint32_t high,
               bool in_high) {
  if (low == 0) return true;
  if (high == 0) return false;
  const Log2 odds = log2_of(high) - log2_of(low);
  return code_on_curve(coder, curve, odds + kEvenSplit * kLog2One, in_high);
}

// Codes one of four slices by their weights.
template <class Coder>
int code_slice(Coder& coder, Curve<kSplitEntries>* half, const uint32_t* weight, int slice) {
  const bool high =
      code_half(coder, half[0], weight[0] + weight[1], weight[2] + weight[3], slice >= 2);
  const int first = high ? 2 : 0;
  return first + code_half(coder, half[1], weight[first], weight[first + 1], (slice & 1) != 0);
}

// Codes a place in `box`; `odds` are relative to the triangle's corner `v`.
template <class Coder>
Point code_place(Coder& coder, PlaceModel& model, PlaceOdds& odds, Point v, Box box, Point place) {
  move_origin(odds, box.x0 - v.x, box.y0 - v.y);
  for (int level = 0; level < kLevels; ++level) {
    const Slices columns = slice(box.x1 - box.x0 + 1), rows = slice(box.y1 - box.y0 + 1);
    if (columns.count == 1 && rows.count == 1) break;
    if (level == kSweepLevels) odds.sweeps = false;
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
    if (level + 1 < kLevels) move_origin(odds, columns.start[i], rows.start[j]);
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
