// SPDX-License-Identifier: MIT
// Segments and blocks on a single terrain, whatever its form (tile_segment.hpp).
#ifndef MICROTIN_DECODER_TERRAIN_QUERY_HPP
#define MICROTIN_DECODER_TERRAIN_QUERY_HPP

#include "decoder/places.hpp"
#include "decoder/tile_segment.hpp"

namespace microtin {

inline LocalPoint local_place(int64_t x, int64_t y) {
  return LocalPoint{static_cast<int32_t>(x), static_cast<int32_t>(y)};
}

template <class Form>
microtin_query_result height_in_terrain(const Form& form, int64_t x, int64_t y, uint32_t* hint,
                                        int32_t* height) {
  if (!is_on_lattice(x, y)) return MICROTIN_QUERY_OUTSIDE;
  return form.height_at(local_place(x, y), 0, hint, height);
}

// The ends of a segment come before the triangles.
constexpr uint32_t kSegmentEnds = 2;

inline void note_answer(microtin_segment_state* done, microtin_query_result answer) {
  done->worst = worse(answer, static_cast<microtin_query_result>(done->worst));
}

// A step, or without a limit all, of the walk to the end that comes next.
template <class Form>
void walk_to_end(const Form& form, const microtin_segment& segment, uint32_t step_limit,
                 microtin_segment_state* done) {
  const bool is_first = done->next == 0;
  const LocalPoint end =
      is_first ? local_place(segment.x, segment.y) : local_place(segment.x_end, segment.y_end);
  int32_t height = INT32_MIN;
  const microtin_query_result answer =
      form.height_at(end, step_limit == 0 ? 0u : 1u, &done->hint, &height);
  if (answer == MICROTIN_QUERY_STEP_LIMIT) return;
  done->highest = is_first ? height : larger(height, done->highest);
  note_answer(done, answer);
  ++done->next;
}

// Hulls are convex: a segment leaves them only if it ends outside.
template <class Form>
microtin_query_result highest_in_terrain(const Form& form, const microtin_segment& segment,
                                         microtin_segment_state* state, int32_t* height,
                                         uint32_t step_limit) {
  microtin_segment_state own = {};  // without a limit a call needs no state
  microtin_segment_state* const done = state != nullptr ? state : &own;
  *height = INT32_MIN;
  if (!is_on_lattice(segment.x, segment.y) || !is_on_lattice(segment.x_end, segment.y_end)) {
    return MICROTIN_QUERY_OUTSIDE;
  }
  TileSegment all(TileBox{0, 0, kLatticeMax, kLatticeMax}, segment);
  all.move(form.corner());
  for (uint32_t step = 0; done->next < kSegmentEnds + form.triangles(); ++step) {
    if (step_limit != 0 && step == step_limit) return MICROTIN_QUERY_STEP_LIMIT;
    if (done->next < kSegmentEnds) {
      walk_to_end(form, segment, step_limit, done);
    } else if (!all.look(form, done->next++ - kSegmentEnds, &done->highest)) {
      note_answer(done, MICROTIN_QUERY_VOID);
    }
  }
  *height = done->highest;
  return static_cast<microtin_query_result>(done->worst);
}

template <class Form>
microtin_query_result fill_from_terrain(const Form& form, const microtin_axis& z,
                                        const microtin_grid_spec& grid, int16_t* heights) {
  if (!has_small_units(z)) return MICROTIN_QUERY_OUTSIDE;
  return fill(
      grid, z,
      [&form](int64_t x, int64_t y, uint32_t* hint, int32_t* height) {
        return height_in_terrain(form, x, y, hint, height);
      },
      heights);
}

}  // namespace microtin

#endif
