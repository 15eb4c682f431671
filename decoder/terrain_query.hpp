// SPDX-License-Identifier: MIT
// Segments and blocks on a single terrain, whatever its form (segment_walk.hpp).
#ifndef MICROTIN_DECODER_TERRAIN_QUERY_HPP
#define MICROTIN_DECODER_TERRAIN_QUERY_HPP

#include "decoder/places.hpp"
#include "decoder/segment_clearance.hpp"
#include "decoder/segment_extremes.hpp"
#include "decoder/segment_walk.hpp"

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

inline bool is_on_lattice(const microtin_segment& segment) {
  return is_on_lattice(segment.x, segment.y) && is_on_lattice(segment.x_end, segment.y_end);
}

// What a crossing says of the whole segment. A terrain alone says OK, OUTSIDE or VOID, which are
// bits: so a crossing costs no comparison.
static_assert(MICROTIN_QUERY_OUTSIDE == 1 && MICROTIN_QUERY_VOID == 2, "they are different bits");
inline void note_answer(const Crossing& c, microtin_segment_state* state) {
  state->result |= static_cast<uint32_t>(c.result | c.before);
}

inline microtin_query_result worst_answer(const microtin_segment_state& state) {
  if ((state.result & MICROTIN_QUERY_OUTSIDE) != 0) return MICROTIN_QUERY_OUTSIDE;
  return static_cast<microtin_query_result>(state.result & MICROTIN_QUERY_VOID);
}

// A walk along a segment on the lattice, from where a state stands.
template <class Form>
SegmentWalk<Form> walk_from(const Form& form, const microtin_segment& segment,
                            const microtin_segment_state& state) {
  const LocalPoint begin = local_place(segment.x, segment.y);
  return SegmentWalk<Form>(form, begin, begin, local_place(segment.x_end, segment.y_end),
                           stage_of(state.stage), state.triangle);
}

template <class Form>
void keep(const SegmentWalk<Form>& walk, microtin_segment_state* state) {
  state->stage = static_cast<uint32_t>(walk.stage());
  state->triangle = walk.number();
}

inline bool is_in_limit(uint32_t step, uint32_t step_limit) {
  return step_limit == 0 || step < step_limit;
}

// Hands the crossings of a segment on the lattice to add(walk, crossing, state), from where the
// state stands, in at most `step_limit` walk steps (0: all). False if there are more.
template <class Form, class Add>
bool walk_terrain(const Form& form, const microtin_segment& segment, uint32_t step_limit,
                  const Add& add, microtin_segment_state* state) {
  SegmentWalk<Form> walk = walk_from(form, segment, *state);
  for (uint32_t step = 0; !walk.at_end() && is_in_limit(step, step_limit); ++step) {
    Crossing c;
    if (!walk.step(step_limit != 0, &c)) continue;
    note_answer(c, state);
    add(walk, c, state);
  }
  keep(walk, state);
  return walk.at_end();
}

// What the last crossing has stays in the state; after the end, the end's.
template <class Form>
microtin_query_result next_in_profile(const Form& form, const microtin_segment& segment,
                                      microtin_segment_state* state, microtin_crossing* crossing,
                                      uint32_t step_limit) {
  if (!is_on_lattice(segment)) return MICROTIN_QUERY_OUTSIDE;
  SegmentWalk<Form> walk = walk_from(form, segment, *state);
  bool is_found = false;
  // With a state of another query, too, the profile has an end.
  int32_t along = static_cast<int32_t>(MICROTIN_ALONG_END);
  for (uint32_t step = 0; !is_found && !walk.at_end() && is_in_limit(step, step_limit); ++step) {
    Crossing c;
    is_found = walk.step(step_limit != 0, &c);
    if (!is_found) continue;
    along = rounded_down(c.along);
    state->value[0] = c.result == MICROTIN_QUERY_OK ? height_of(c) : INT32_MIN;
    state->result = c.result;
    state->is_low = c.before;
  }
  keep(walk, state);
  if (!is_found && !walk.at_end()) return MICROTIN_QUERY_STEP_LIMIT;
  *crossing = microtin_crossing{along, state->value[0], state->result, state->is_low};
  return MICROTIN_QUERY_OK;
}

template <class Form>
MICROTIN_IN_PLACE inline microtin_query_result extremes_in_terrain(
    const Form& form, const microtin_segment& segment, microtin_segment_state* state,
    microtin_segment_extremes* extremes, uint32_t step_limit) {
  microtin_segment_state own = {};  // without a limit a call needs no state
  microtin_segment_state* const done = state != nullptr ? state : &own;
  clear(extremes);
  if (!is_on_lattice(segment)) return MICROTIN_QUERY_OUTSIDE;
  if (done->stage == 0) begin_extremes(done);
  if (!walk_terrain(form, segment, step_limit, AddToExtremes(), done)) {
    return MICROTIN_QUERY_STEP_LIMIT;
  }
  get_extremes(*done, extremes);
  return worst_answer(*done);
}

// Margins are those of the terrain.
template <class Form>
MICROTIN_IN_PLACE inline microtin_query_result clearance_in_terrain(
    const Form& form, const microtin_path& path, microtin_segment_state* state,
    microtin_path_clearance* clearance, uint32_t flags, uint32_t step_limit) {
  microtin_segment_state own = {};
  microtin_segment_state* const done = state != nullptr ? state : &own;
  clear(clearance);
  if (!is_on_lattice(path.segment) || !has_legal_heights(path)) return MICROTIN_QUERY_OUTSIDE;
  AddToClearance add(path, flags);
  if (!add.begin_terrain(form)) return MICROTIN_QUERY_NO_MARGIN;
  if (done->stage == 0) begin_clearance(done);
  if (!walk_terrain(form, path.segment, step_limit, add, done)) return MICROTIN_QUERY_STEP_LIMIT;
  get_clearance(*done, clearance);
  return worst_answer(*done);
}

// A function of a position, as places.hpp has it.
template <class Form>
class HeightInTerrain {
 public:
  explicit HeightInTerrain(const Form& form) : form_(form) {}

  microtin_query_result operator()(int64_t x, int64_t y, uint32_t* hint, int32_t* height) const {
    return height_in_terrain(form_, x, y, hint, height);
  }

 private:
  const Form& form_;
};

template <class Form>
microtin_query_result fill_from_terrain(const Form& form, const microtin_axis& z,
                                        const microtin_grid_spec& grid, int16_t* heights) {
  if (!has_small_units(z)) return MICROTIN_QUERY_OUTSIDE;
  return fill(grid, z, HeightInTerrain<Form>(form), heights);
}

}  // namespace microtin

#endif
