// SPDX-License-Identifier: MIT
// Questions about many places, whatever knows their heights: a function of x, y, hint and height
// that returns heights as microtin_mesh_height_at does.
#ifndef MICROTIN_DECODER_PLACES_HPP
#define MICROTIN_DECODER_PLACES_HPP

#include "decoder/touched_tiles.hpp"
#include "shared/fixed_math.hpp"

namespace microtin {

// How bad a result is. No switch: compilers make tables of those, which AVR would keep in RAM.
inline int rank(microtin_query_result result) {
  if (result == MICROTIN_QUERY_NOT_LOADED) return 4;
  if (result == MICROTIN_QUERY_BAD_TILE) return 3;
  if (result == MICROTIN_QUERY_OUTSIDE) return 2;
  return result == MICROTIN_QUERY_VOID ? 1 : 0;
}

inline microtin_query_result worse(microtin_query_result a, microtin_query_result b) {
  return rank(a) > rank(b) ? a : b;
}

// Whether heights on an axis fit whole units.
inline bool has_small_units(const microtin_axis& z) {
  return z.numerator >> 31 == 0 && is_within(z.offset, static_cast<int64_t>(1) << 45);
}

// A height in whole units, halves up, kept within int16_t. |z| < 2^31, the numerator < 2^31, the
// offset within 2^45, the denominator < 2^40: sums below 2^62 + 2^61 + 2^55.
MICROTIN_ONE_COPY inline int16_t in_units(int32_t z, const microtin_axis& axis) {
  const int64_t unit = static_cast<int64_t>(axis.denominator) * 65536;
  const int64_t sum = static_cast<int64_t>(static_cast<int32_t>(axis.numerator)) * z +
                      axis.offset * 65536 + unit / 2;
  const int64_t height = floor_of(sum, unit);
  if (height > INT16_MAX) return INT16_MAX;
  return static_cast<int16_t>(height < INT16_MIN ? INT16_MIN : height);
}

// The result for many positions, of which one more has a result.
inline microtin_query_result joined(microtin_query_result all, microtin_query_result here) {
  return here != MICROTIN_QUERY_OK && all != MICROTIN_QUERY_NOT_LOADED ? here : all;
}

// Hands the result and the height at each position of a grid to put(result, height), row by row.
template <class HeightAt, class Put>
microtin_query_result for_grid(const microtin_grid_spec& grid, const HeightAt& height_at,
                               const Put& put) {
  if (!is_within(grid.x, kSegmentMost) || !is_within(grid.y, kSegmentMost))
    return MICROTIN_QUERY_OUTSIDE;
  microtin_query_result result = MICROTIN_QUERY_OK;
  uint32_t hint = 0;
  int64_t y = grid.y;  // below 2^40 + 2^47
  for (uint32_t row = 0; row < grid.rows; ++row, y += grid.dy) {
    int64_t x = grid.x;
    for (uint32_t column = 0; column < grid.columns; ++column, x += grid.dx) {
      int32_t z = 0;
      const microtin_query_result here = height_at(x, y, &hint, &z);
      put(here, z);
      result = joined(result, here);
    }
  }
  return result;
}

// The heights of a grid in whole units of the axis z, as microtin_pack_sample_grid returns them.
template <class HeightAt>
microtin_query_result fill(const microtin_grid_spec& grid, const microtin_axis& axis,
                           const HeightAt& height_at, int16_t* heights) {
  return for_grid(grid, height_at, [&](microtin_query_result here, int32_t z) {
    *heights++ = here == MICROTIN_QUERY_OK ? in_units(z, axis) : grid.missing;
  });
}

template <class HeightAt>
microtin_query_result grid_extremes(const microtin_grid_spec& grid, const HeightAt& height_at,
                                    microtin_grid_extremes* extremes) {
  extremes->highest = INT32_MIN;
  extremes->lowest = INT32_MAX;
  return for_grid(grid, height_at, [extremes](microtin_query_result here, int32_t z) {
    if (here != MICROTIN_QUERY_OK) return;
    if (z > extremes->highest) extremes->highest = z;
    if (z < extremes->lowest) extremes->lowest = z;
  });
}

// The heights at some positions, INT32_MIN where there is none.
template <class HeightAt>
microtin_query_result heights_at(const microtin_position* positions, uint32_t count,
                                 const HeightAt& height_at, uint32_t* hint, int32_t* heights) {
  microtin_query_result result = MICROTIN_QUERY_OK;
  for (uint32_t i = 0; i < count; ++i) {
    const microtin_query_result here = height_at(positions[i].x, positions[i].y, hint, heights + i);
    if (here != MICROTIN_QUERY_OK) heights[i] = INT32_MIN;
    result = joined(result, here);
  }
  return result;
}

}  // namespace microtin

#endif
