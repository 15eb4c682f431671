// SPDX-License-Identifier: MIT
// A box of lattice points cut into 4 x 4 cells, and how far the cells are outside a circle.
#ifndef MICROTIN_SHARED_CELLS_HPP
#define MICROTIN_SHARED_CELLS_HPP

#include "shared/free_region.hpp"

namespace microtin {

constexpr int kSlices = 4;  // per axis
constexpr int kCells = kSlices * kSlices;

// Something for each cell, columns one after the other. Loops over them are vectorised where no
// other loop is around them.
typedef int16_t Cells[kCells];

// Four slices of `count` <= 2^16 lattice lines: where each starts, and where the last one ends.
struct Slices {
  FastInt count;
  FastInt start[kSlices + 1];
  FastInt extent;           // of a slice, but at most a step too narrow; eighths of half steps
  uint32_t unit;            // middles are in half steps / 2^(unit - 2), below 24576
  int16_t middle[kSlices];  // from the middle of all
  int16_t square[kSlices];  // middle^2 / 2^16
};

inline void slice(Slices& slices, FastInt count) {
  slices.count = count;
  slices.extent = count > kSlices ? (count - 3) * 4 : 4;
  slices.unit = 16 - highest_bit(static_cast<uint32_t>(count));
  slices.start[0] = 0;
  for (int i = 0; i < kSlices; ++i) {
    slices.start[i + 1] = count * (i + 1) >> 2;
    const FastInt twice = slices.start[i] + slices.start[i + 1] - count;
    slices.middle[i] =
        static_cast<int16_t>((twice * (static_cast<FastInt>(1) << slices.unit)) >> 2);
  }
  for (int i = 0; i < kSlices; ++i) {
    slices.square[i] =
        static_cast<int16_t>(static_cast<int32_t>(slices.middle[i]) * slices.middle[i] >> 16);
  }
}

inline int slice_of(const Slices& slices, FastInt offset) {
  int i = 0;
  while (i < kSlices - 1 && offset >= slices.start[i + 1]) ++i;
  return i;
}

// How much a slice's width counts: nothing where all are about the same. At most 16.
inline uint32_t size_of(const Slices& slices, int i) {
  return slices.count > 64 ? 1u : static_cast<uint32_t>(slices.start[i + 1] - slices.start[i]);
}

struct Grid {
  Slices columns, rows;
};

// How powers become distances: 512 / ramp of them. Shifted, multiplied, shifted by 21.
struct Scale {
  uint32_t shift;
  int32_t reciprocal;  // 2^14 .. 2^26
};

// 28 <= ramp < 2^50.
inline Scale scale_by(int64_t ramp) {
  const uint32_t bits = highest_bit(static_cast<uint64_t>(ramp));
  const uint32_t shift = bits > 15 ? bits - 15 : 0;
  return Scale{shift, static_cast<int32_t>((static_cast<uint32_t>(1) << 30) /
                                           static_cast<uint32_t>(scaled(ramp, 1, shift)))};
}

// Distances in 64ths of a cell's extent across the circle, from the change of the power at the
// middle of the grid. Slopes are below 2^25 whole ones, extents below 2^18. Circles are drawn a
// little softly, since points of terrains are often on them.
inline Scale scale_for(const Power& power, const Grid& grid) {
  const int64_t x = absolute(power.x) >> 4, y = absolute(power.y) >> 4;
  const int64_t width = grid.columns.extent, height = grid.rows.extent;
  return scale_by(((x * width + y * height) * 4 + width * width + height * height) / 8 + 24);
}

inline int16_t clamped(int16_t v, int16_t low, int16_t high) {
  const int16_t raised = v < low ? low : v;
  return raised > high ? high : raised;
}

// How far the middles of cells are outside a circle: that of cell (i, j) x[i] + y[j].
struct Distances {
  int16_t x[kSlices], y[kSlices];
};

// The power of slices' middles: a parabola. By the circle's own scale it fits 16 bits, of both axes
// together below 12581; by another one it may wrap around, which spoils an estimate and no more.
inline void measure_axis(int32_t constant, FastInt slope, const Slices& slices, const Scale& scale,
                         int16_t* distance) {
  const int16_t linear =
      static_cast<int16_t>(scaled(slope, scale.reciprocal, scale.shift + slices.unit + 7));
  const int16_t square =
      static_cast<int16_t>(scaled(32768, scale.reciprocal, scale.shift + 2 * slices.unit));
  for (int i = 0; i < kSlices; ++i) {
    distance[i] =
        static_cast<int16_t>(constant + (static_cast<int32_t>(slices.middle[i]) * linear >> 16) +
                             (static_cast<int32_t>(slices.square[i]) * square >> 16));
  }
}

MICROTIN_OUT_OF_LINE inline void measure(const Power& power, const Scale& scale, const Grid& grid,
                                         Distances& distance) {
  int32_t value = kept_within(scaled(power.value, 1, scale.shift), static_cast<int32_t>(1) << 30);
  value = kept_within(scaled(value, scale.reciprocal, 21), 1 << 13);
  measure_axis(value, power.x, grid.columns, scale, distance.x);
  measure_axis(0, power.y, grid.rows, scale, distance.y);
}

// 16-bit arithmetic that wraps around.
inline int16_t sum_of(int16_t a, int16_t b) {
  return static_cast<int16_t>(static_cast<uint16_t>(a) + static_cast<uint16_t>(b));
}

// For each column of cells. One by one, as copies of what is done are quicker and vectorised; in a
// loop where size counts.
template <class Body>
void for_columns(const Body& body) {
#if defined(__OPTIMIZE_SIZE__)
  for (int i = 0; i < kSlices; ++i) body(i);
#else
  static_assert(kSlices == 4, "all columns");
  body(0);
  body(1);
  body(2);
  body(3);
#endif
}

inline void expand_column(int16_t x, const int16_t* y, int16_t* sum) {
  for (int j = 0; j < kSlices; ++j) sum[j] = sum_of(x, y[j]);
}

// Of all cells.
MICROTIN_OUT_OF_LINE inline void expand(const Distances& distance, Cells sum) {
  for_columns(
      [&distance, sum](int i) { expand_column(distance.x[i], distance.y, sum + kSlices * i); });
}

inline int16_t share_of(int16_t weight, int16_t share) {
  return static_cast<int16_t>((static_cast<uint32_t>(static_cast<uint16_t>(weight)) *
                               static_cast<uint16_t>(static_cast<uint32_t>(share) << 8)) >>
                              16);
}

inline void cut_column(int16_t x, const int16_t* y, int16_t* weight) {
  for (int j = 0; j < kSlices; ++j) {
    const int16_t outside = static_cast<int16_t>(sum_of(x, y[j]) + 32);
    weight[j] = share_of(weight[j], static_cast<int16_t>(clamped(outside, 0, 63) << 2));
  }
}

// Takes away what lies inside a circle: all of a cell that is half a cell inside, nothing of one
// that is half a cell outside.
MICROTIN_OUT_OF_LINE inline void cut(const Distances& distance, Cells weight) {
  for_columns(
      [&distance, weight](int i) { cut_column(distance.x[i], distance.y, weight + kSlices * i); });
}

}  // namespace microtin

#endif
