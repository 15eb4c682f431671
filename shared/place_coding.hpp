// SPDX-License-Identifier: MIT
// Coding of the next point's place in the free region of the triangle it conflicts with.
//
// The box around the region is cut into 4 x 4 cells, the point's cell is coded, and the cell
// becomes the box, once or more; what remains is uniform.
#ifndef MICROTIN_SHARED_PLACE_CODING_HPP
#define MICROTIN_SHARED_PLACE_CODING_HPP

#include "shared/format.hpp"
#include "shared/place_odds.hpp"
#include "shared/probability.hpp"

namespace microtin {

// For each of the four binary decisions of a level: the odds learned for the estimated ones.
struct PlaceModel {
  Calibration split[4];
};

// Codes one of four slices by their weights, below 2^26: the half, then the quarter. What holds no
// lattice points weighs nothing and is never chosen; such slices come first.
template <class Coder>
int code_slice(Coder& coder, Calibration* split, const uint32_t* weight, int slice) {
  int first = 0;
  for (int half = 2; half != 0; half >>= 1, ++split) {
    uint32_t low = weight[first], high = weight[first + half];
    if (half == 2) {
      low += weight[1];
      high += weight[3];
    }
    bool in_high = low == 0;
    if (low != 0) {
      const uint32_t bits = highest_bit(low + high);
      const uint32_t shift = bits > 16 ? bits - 16 : 0;
      const uint32_t share = ((high >> shift) << 15) / (((low + high) >> shift) + 1);
      in_high = code_calibrated(coder, *split, share, (slice & half) != 0);
    }
    if (in_high) first += half;
  }
  return first;
}

// The next vertex's place, seen from corner 0: known to a writing coder.
template <class Coder>
Offset next_place(Coder& coder, const FreeRegion& region) {
  const Vertex next = coder.next();
  return Point{next.x, next.y} - region.origin;
}

// A cell's weight is an estimate: any of its places may be the one.
inline uint32_t possible(int16_t weight) {
  return static_cast<uint32_t>(weight) + 32u;
}

// Codes the cell that holds the place, which becomes the box.
template <class Coder>
MICROTIN_OUT_OF_LINE void code_cell(Coder& coder, Calibration* split, const FreeRegion& region,
                                    PlaceOdds& odds) {
  const Offset place = next_place(coder, region);
  const Box& box = odds.box;
  Slices& columns = odds.grid.columns;
  Slices& rows = odds.grid.rows;
  slice(columns, box.x1 - box.x0 + 1);
  slice(rows, box.y1 - box.y0 + 1);
  if (columns.count == 1 && rows.count == 1) return;
  weigh_cells(odds, region);
  uint32_t row_size[kSlices], weight[kSlices];
  for (int j = 0; j < kSlices; ++j) row_size[j] = size_of(rows, j);
  const int16_t* cell = odds.weight;
  for (int i = 0; i < kSlices; ++i) {
    uint32_t sum = 0;
    for (int j = 0; j < kSlices; ++j) sum += possible(*cell++) * row_size[j];
    weight[i] = sum * size_of(columns, i);
  }
  const int i = code_slice(coder, split, weight, slice_of(columns, place.x - box.x0));
  cell = odds.weight + kSlices * i;
  for (int j = 0; j < kSlices; ++j) {
    weight[j] = possible(cell[j]) * row_size[j];
  }
  const int j = code_slice(coder, split + 2, weight, slice_of(rows, place.y - box.y0));
  narrow(odds, i, j);
}

// Codes a coordinate from `low` to `high`, all equally likely.
template <class Coder>
FastInt code_within(Coder& coder, FastInt low, FastInt high, FastInt value) {
  return low + static_cast<FastInt>(coder.uniform(static_cast<uint32_t>(high - low + 1),
                                                  static_cast<uint32_t>(value - low)));
}

// Codes a place in the box, as seen from corner 0.
template <class Coder>
Offset code_place(Coder& coder, PlaceModel& model, const FreeRegion& region, PlaceOdds& odds,
                  uint32_t levels) {
  for (uint32_t level = 0; level < levels; ++level) {
    code_cell(coder, model.split, region, odds);
  }
  const Offset place = next_place(coder, region);
  const Box& box = odds.box;
  return Offset{code_within(coder, box.x0, box.x1, place.x),
                code_within(coder, box.y0, box.y1, place.y)};
}

}  // namespace microtin

#endif
