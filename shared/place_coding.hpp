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

constexpr int kCells = 4;   // per axis
constexpr int kLevels = 3;  // of cells
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
  Power inside;      // t's circle: negative where the point can be
  Power outside[3];  // certified neighbours' circles: positive where it can be
  bool active[3];    // which of them still cut the box
  bool sweeps;       // whether the chance of being first differs noticeably over the region
  Power swept_from;  // where the sweep starts: the circle behind the chord
  // 4096 * chance of being first, at equal steps of the share of the way from swept_from to
  // `inside`
  uint16_t chance[kSweepEntries];
};

// A circle of the pencil through v and a, by the cotangent k of its inscribed angle on t's side,
// with 8 fractional bits.
typedef int64_t Cotangent;
constexpr Cotangent kCotangentCap = 32767;

inline Cotangent cotangent(int64_t q, int64_t h) {
  const int64_t k = q * 256 / h;  // |q| < 2^33
  return k > kCotangentCap ? kCotangentCap : k < -kCotangentCap ? -kCotangentCap : k;
}

// Area, on t's side of the chord, of the pencil's circle k.
inline Area swept_area(int64_t length2, Cotangent k) {
  return k <= 0 ? segment_area(length2, -k, 256)
                : disc_area(length2, k, 256) - segment_area(length2, k, 256);
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
    odds.swept_from = odds.inside;
    odds.swept_from.x += (to - from) * hx;
    odds.swept_from.y += (to - from) * hy;
  } else {
    from = cotangent(dot_at(behind.apex, v, a), orient2d(a, v, behind.apex));
    odds.swept_from = odds.outside[kChord];
  }
  const Area start = swept_area(length2, from);
  for (int i = 0; i < kSweepEntries; ++i) {
    const Area swept = swept_area(length2, from + (to - from) * i / (kSweepEntries - 1)) - start;
    // chance = exp(-density * swept) = 2^-loss; log2(log2(e)) = 135 / 256.
    uint64_t loss = 0;
    if (swept > 0) loss = exp2_of(log2_of(static_cast<uint64_t>(swept)) + density + 135);
    const Log2 left = loss < 12 * 256 ? 12 * 256 - static_cast<Log2>(loss) : 0;
    odds.chance[i] = static_cast<uint16_t>(exp2_of(left));
  }
  odds.sweeps = odds.chance[kSweepEntries - 1] < odds.chance[0] - odds.chance[0] / 8;
}

inline PlaceOdds place_odds(const FreeRegion& region, Log2 density) {
  PlaceOdds odds;
  odds.inside = circle_through(region.corner[0], region.corner[1], region.corner[2]);
  for (int i = 0; i < 3; ++i) {
    const Side& side = region.side[i];
    odds.active[i] = side.certified && !side.ghost;
    if (!odds.active[i]) continue;
    const Point from = region.corner[i], to = region.corner[i == 2 ? 0 : i + 1];
    const Power circle = circle_through(from, side.apex, to);
    odds.outside[i] = moved_origin(circle, static_cast<int32_t>(region.corner[0].x) - from.x,
                                   static_cast<int32_t>(region.corner[0].y) - from.y);
  }
  estimate_sweep(odds, region, density);
  return odds;
}

inline void move_origin(PlaceOdds& odds, int32_t dx, int32_t dy) {
  odds.inside = moved_origin(odds.inside, dx, dy);
  odds.swept_from = moved_origin(odds.swept_from, dx, dy);
  for (int i = 0; i < 3; ++i) {
    if (odds.active[i]) odds.outside[i] = moved_origin(odds.outside[i], dx, dy);
  }
}

// First lattice offset of the i-th of four slices of `count` lattice lines.
inline int32_t slice_start(int32_t count, int i) {
  return count * i / kCells;  // count <= 2^16, i <= 4
}

// A power at the slices' middles along both axes, and how much it varies over a slice: value(i, j)
// = along_x[i] + along_y[j]. Scaled down by a common shift to 20 bits.
struct SlicedPower {
  int32_t x[kCells], y[kCells];
  int32_t x_span[kCells], y_span[kCells];
};

struct WidePower {
  int64_t x[kCells], y[kCells];
  int64_t x_span[kCells], y_span[kCells];
};

inline int64_t magnitude(int64_t v) {
  return v < 0 ? -v : v;
}

inline void slice_axis(int64_t constant, int64_t slope, int32_t count, int64_t* value,
                       int64_t* span) {
  for (int i = 0; i < kCells; ++i) {
    const int32_t start = slice_start(count, i), end = slice_start(count, i + 1);
    const int32_t twice = start + end - 1;  // twice the middle
    value[i] = constant + (static_cast<int64_t>(twice) * 128 + slope) * twice / 2;
    span[i] =
        magnitude(static_cast<int64_t>(twice) * 256 + slope) * (end > start ? end - start - 1 : 0);
  }
}

inline WidePower slice(const Power& power, int32_t columns, int32_t rows) {
  WidePower wide;
  slice_axis(power.constant, power.x, columns, wide.x, wide.x_span);
  slice_axis(0, power.y, rows, wide.y, wide.y_span);
  return wide;
}

inline uint32_t bits_of(const WidePower& wide) {
  uint64_t all = 1;
  for (int i = 0; i < kCells; ++i) {
    all |= static_cast<uint64_t>(magnitude(wide.x[i]) | magnitude(wide.y[i]) | wide.x_span[i] |
                                 wide.y_span[i]);
  }
  return highest_bit(all) + 1;
}

inline SlicedPower scale(const WidePower& wide, uint32_t shift) {
  SlicedPower sliced;
  for (int i = 0; i < kCells; ++i) {
    sliced.x[i] = static_cast<int32_t>(wide.x[i] >> shift);
    sliced.y[i] = static_cast<int32_t>(wide.y[i] >> shift);
    sliced.x_span[i] = static_cast<int32_t>(wide.x_span[i] >> shift);
    sliced.y_span[i] = static_cast<int32_t>(wide.y_span[i] >> shift);
  }
  return sliced;
}

// Share of a cell, in 64ths, where a quantity is positive: `value` in its middle, varying by `span`
// over it. A quarter of a unit below zero still counts: points on the circle can be in conflict.
inline uint32_t coverage(int32_t value, int32_t span) {
  if (span == 0) return value >= -64 ? 64 : 0;
  if (2 * value >= span) return 64;
  if (2 * value <= -span) return 0;
  return static_cast<uint32_t>(32 + 64 * value / span);
}

typedef uint32_t CellWeights[kCells][kCells];

// Chance of being first at a place, from the powers there, each below 2^21.
inline uint32_t chance_at(const PlaceOdds& odds, int32_t from, int32_t inside) {
  const int32_t gone = from > 0 ? from : 0;
  const int32_t left = inside < 0 ? -inside : 0;
  if (gone + left == 0) return odds.chance[kSweepEntries - 1];
  const uint32_t share = static_cast<uint32_t>(gone) * 256u / static_cast<uint32_t>(gone + left);
  const uint32_t i = share >> 5, f = share & 31u;
  if (f == 0) return odds.chance[i];
  return (odds.chance[i] * (32u - f) + odds.chance[i + 1] * f) >> 5;
}

inline void weigh_cells(PlaceOdds& odds, int32_t columns, int32_t rows, CellWeights weight) {
  WidePower wide[5];
  uint32_t bits = 0;
  for (int k = 0; k < 5; ++k) {
    if (k == 4 ? !odds.sweeps : k < 3 && !odds.active[k]) continue;
    wide[k] = slice(k < 3    ? odds.outside[k]
                    : k == 3 ? odds.inside
                             : odds.swept_from,
                    columns, rows);
    const uint32_t b = bits_of(wide[k]);
    if (b > bits) bits = b;
  }
  const uint32_t shift = bits > 20 ? bits - 20 : 0;
  const SlicedPower inside = scale(wide[3], shift);
  const SlicedPower from = odds.sweeps ? scale(wide[4], shift) : inside;
  for (int i = 0; i < kCells; ++i) {
    const uint32_t width =
        static_cast<uint32_t>(slice_start(columns, i + 1) - slice_start(columns, i));
    for (int j = 0; j < kCells; ++j) {
      const uint32_t height =
          static_cast<uint32_t>(slice_start(rows, j + 1) - slice_start(rows, j));
      const int32_t power = inside.x[i] + inside.y[j];
      uint32_t w = coverage(-power, inside.x_span[i] + inside.y_span[j]);
      if (odds.sweeps) {
        w *= chance_at(odds, from.x[i] + from.y[j], power);
      } else {
        w *= 4096;
      }
      w = w * (columns > 64 ? 1 : width) * (rows > 64 ? 1 : height);
      weight[i][j] = width == 0 || height == 0 ? 0 : w + 1;
    }
  }
  for (int k = 0; k < 3; ++k) {
    if (!odds.active[k]) continue;
    const SlicedPower outside = scale(wide[k], shift);
    bool cuts = false;
    for (int i = 0; i < kCells; ++i) {
      for (int j = 0; j < kCells; ++j) {
        const uint32_t share =
            coverage(outside.x[i] + outside.y[j], outside.x_span[i] + outside.y_span[j]);
        if (share == 64) continue;
        cuts = true;
        if (weight[i][j] != 0) weight[i][j] = (weight[i][j] >> 6) * share + 1;
      }
    }
    odds.active[k] = cuts;
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

inline int slice_of(int32_t count, int32_t offset) {
  int i = 0;
  while (i < kCells - 1 && offset >= slice_start(count, i + 1)) ++i;
  return i;
}

// Codes a place in `box`; `odds` are relative to the triangle's corner `v`.
template <class Coder>
Point code_place(Coder& coder, PlaceModel& model, PlaceOdds& odds, Point v, Box box, Point place) {
  move_origin(odds, box.x0 - v.x, box.y0 - v.y);
  for (int level = 0; level < kLevels; ++level) {
    const int32_t columns = box.x1 - box.x0 + 1, rows = box.y1 - box.y0 + 1;
    if (columns == 1 && rows == 1) break;
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
    const int32_t dx = slice_start(columns, i), dy = slice_start(rows, j);
    box.x1 = box.x0 + slice_start(columns, i + 1) - 1;
    box.y1 = box.y0 + slice_start(rows, j + 1) - 1;
    box.x0 += dx;
    box.y0 += dy;
    move_origin(odds, dx, dy);
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
