// SPDX-License-Identifier: MIT
// Courses and blocks on a single terrain, whatever its form (tile_course.hpp).
#ifndef MICROTIN_DECODER_TERRAIN_QUERY_HPP
#define MICROTIN_DECODER_TERRAIN_QUERY_HPP

#include "decoder/places.hpp"
#include "decoder/tile_course.hpp"

namespace microtin {

inline bool is_on_lattice(int64_t x, int64_t y) {
  const int64_t most = static_cast<int64_t>(kLatticeMax) * 256;
  return x >= 0 && x <= most && y >= 0 && y <= most;
}

template <class Form>
microtin_answer height_in_terrain(const Form& form, int64_t x, int64_t y, uint32_t* hint,
                                  int32_t* height) {
  if (!is_on_lattice(x, y)) return MICROTIN_OUTSIDE;
  return form.height_at(LocalPoint{static_cast<int32_t>(x), static_cast<int32_t>(y)}, hint, height);
}

// Hulls are convex: a course leaves them only if it ends outside.
template <class Form>
microtin_answer highest_in_terrain(const Form& form, const microtin_course& course,
                                   int32_t* height) {
  *height = INT32_MIN;
  if (!is_on_lattice(course.x, course.y) || !is_on_lattice(course.x_end, course.y_end)) {
    return MICROTIN_OUTSIDE;
  }
  const microtin_answer answer = ask_ends(
      course,
      [&form](int64_t x, int64_t y, uint32_t* hint, int32_t* end) {
        return height_in_terrain(form, x, y, hint, end);
      },
      height);
  TileCourse all(TileBox{0, 0, kLatticeMax, kLatticeMax}, course);
  return all.look(form, height) ? answer : worse(answer, MICROTIN_IN_VOID);
}

template <class Form>
microtin_answer fill_from_terrain(const Form& form, const microtin_axis& z,
                                  const microtin_block& block, int16_t* heights) {
  if (!has_small_units(z)) return MICROTIN_OUTSIDE;
  return fill(
      block, z,
      [&form](int64_t x, int64_t y, uint32_t* hint, int32_t* height) {
        return height_in_terrain(form, x, y, hint, height);
      },
      heights);
}

}  // namespace microtin

#endif
