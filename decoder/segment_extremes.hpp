// SPDX-License-Identifier: MIT
// The greatest and the least height of a segment's crossings.
#ifndef MICROTIN_DECODER_SEGMENT_EXTREMES_HPP
#define MICROTIN_DECODER_SEGMENT_EXTREMES_HPP

#include "decoder/crossing.hpp"
#include "microtin/segment.h"

namespace microtin {

constexpr int kHighest = 0, kLowest = 1;  // of the values and places of a state

inline void begin_extremes(microtin_segment_state* state) {
  state->value[kHighest] = INT32_MIN;
  state->value[kLowest] = INT32_MAX;
}

inline void set_value(int which, int32_t height, const Along& along,
                      microtin_segment_state* state) {
  state->value[which] = height;
  state->part[which] = along.part;
  state->whole[which] = along.whole;
}

// An edge needs no division if neither end is higher, or lower, than all heights so far. The first
// height is both, also the lowest that there can be: INT32_MIN.
MICROTIN_ONE_COPY inline void add_to_extremes(const Crossing& c, microtin_segment_state* state) {
  if (c.result != MICROTIN_QUERY_OK) return;
  const int32_t highest = state->value[kHighest], lowest = state->value[kLowest];
  if (c.height <= highest && c.other <= highest && c.height >= lowest && c.other >= lowest) return;
  const int32_t height = height_of(c);
  if (height > highest || lowest == INT32_MAX) set_value(kHighest, height, c.along, state);
  if (height < lowest) set_value(kLowest, height, c.along, state);
}

// A type, so that compilers see which function is called.
struct AddToExtremes {
  template <class Form>
  bool begin_terrain(const Form&) const {
    return true;
  }
  template <class Walk>
  void operator()(const Walk&, const Crossing& c, microtin_segment_state* state) const {
    add_to_extremes(c, state);
  }
};

inline int32_t place_of_value(int which, const microtin_segment_state& state) {
  return rounded_down(Along{state.part[which], state.whole[which]});
}

inline void get_extremes(const microtin_segment_state& state, microtin_segment_extremes* extremes) {
  if (state.value[kLowest] == INT32_MAX) return;
  extremes->highest = state.value[kHighest];
  extremes->lowest = state.value[kLowest];
  extremes->highest_along = place_of_value(kHighest, state);
  extremes->lowest_along = place_of_value(kLowest, state);
}

inline void clear(microtin_segment_extremes* extremes) {
  extremes->highest = INT32_MIN;
  extremes->lowest = INT32_MAX;
  extremes->highest_along = extremes->lowest_along = 0;
}

}  // namespace microtin

#endif
