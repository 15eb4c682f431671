// SPDX-License-Identifier: MIT
// How far a straight path is above a segment's crossings.
#ifndef MICROTIN_DECODER_SEGMENT_CLEARANCE_HPP
#define MICROTIN_DECODER_SEGMENT_CLEARANCE_HPP

#include "decoder/crossing.hpp"
#include "microtin/segment.h"
#include "shared/fixed_math.hpp"
#include "shared/format.hpp"
#include "shared/interpolation.hpp"

namespace microtin {

constexpr int kLeast = 0, kFirst = 1;  // of the values of a state
constexpr int32_t kPathMost = INT32_C(1) << 25;

// A number that is linear along the segment, times what it is divided by.
struct Linear {
  int64_t begin, end;
};

// The height of a triangle's plane, 8 fractional bits, times twice the triangle's area, which is
// below 2^33. A segment that touches the triangle has its ends within 2^25 of its corners: weights
// are below 2^43, and the height is below 2^60.5.
inline int64_t plane_at(const Vertex* v, int64_t area, FinePoint p) {
  const Point a{v[0].x, v[0].y}, b{v[1].x, v[1].y}, c{v[2].x, v[2].y};
  return orient_fine(c, a, p) * (static_cast<int32_t>(v[1].z) - v[0].z) +
         orient_fine(a, b, p) * (static_cast<int32_t>(v[2].z) - v[0].z) + v[0].z * area * 256;
}

// a * part / whole + b * share / whole, rounded down; both parts 0 .. whole < 2^50, a and b below
// 2^28. Long division: the rest stays below 4 * whole.
MICROTIN_ONE_COPY inline int32_t sum_of_shares(uint32_t a, int64_t part, uint32_t b, int64_t share,
                                               int64_t whole) {
  int64_t rest = 0;
  int32_t quotient = 0;
  for (uint32_t bit = UINT32_C(1) << highest_bit(a | b | 1u); bit != 0; bit >>= 1) {
    quotient *= 2;
    rest *= 2;
    if ((a & bit) != 0) rest += part;
    if ((b & bit) != 0) rest += share;
    for (; rest >= whole; ++quotient) rest -= whole;  // three times at most
  }
  return quotient;
}

// What rises is a part of its rise; what falls is all of its fall less a part.
struct Slope {
  int32_t start;
  uint32_t size;
  int64_t part;

  Slope(int32_t rise, int64_t along, int64_t whole)
      : start(rise < 0 ? rise : 0),
        size(static_cast<uint32_t>(rise < 0 ? -rise : rise)),
        part(rise < 0 ? whole - along : along) {}
};

// Finds the least clearance, and the first place where it is less than what is needed. The path is
// lower by a margin of the terrain, which is less than 2^25: its heights are within 2^26.
class AddToClearance {
 public:
  AddToClearance(const microtin_path& path, uint32_t flags)
      : z_(path.z),
        z_end_(path.z_end),
        needed_(path.clearance),
        is_safe_((flags & MICROTIN_FLAG_SAFE) != 0) {}

  // For a walk on a terrain. False if it does not state its margin.
  template <class Form>
  bool begin_terrain(const Form& form) {
    if (!is_safe_) return true;
    if (form.below() == kNotStated) return false;
    z_ -= static_cast<int32_t>(form.below()) * 16;
    z_end_ -= static_cast<int32_t>(form.below()) * 16;
    return true;
  }

  template <class Walk>
  void operator()(const Walk& walk, const Crossing& c, microtin_segment_state* state) const {
    const bool was_low = state->is_low != 0 && c.along.part != 0;
    state->is_low = 0;
    if (c.result != MICROTIN_QUERY_OK || is_high(c, *state)) return;
    const int32_t clearance = clearance_at(walk, c);
    if (clearance < state->value[kLeast]) {
      state->value[kLeast] = clearance;
      state->part[kLeast] = c.along.part;
      state->whole[kLeast] = c.along.whole;
    }
    if (clearance >= needed_) return;
    state->is_low = 1;
    if (was_low) return;
    const int32_t first = first_low(walk, c);
    if (state->value[kFirst] < 0 || first < state->value[kFirst]) state->value[kFirst] = first;
  }

 private:
  // Whether the clearance is surely no less than what is found and needed.
  bool is_high(const Crossing& c, const microtin_segment_state& state) const {
    const int32_t ground = ((c.height > c.other ? c.height : c.other) >> 8) + 1;
    const int32_t least = (z_ < z_end_ ? z_ : z_end_) - ground;
    return least >= state.value[kLeast] && least >= needed_;
  }

  // Rounded down.
  template <class Walk>
  int32_t clearance_at(const Walk& walk, const Crossing& c) const {
    if (c.share < 0) {
      int64_t area = 0;
      const Linear above = above_plane(walk, &area);
      return static_cast<int32_t>(floor_of(c.along.part == 0 ? above.begin : above.end, area));
    }
    const int64_t whole = c.along.whole;
    const Slope path(z_end_ - z_, c.along.part, whole),
        fall(((c.height >> 16) - (c.other >> 16)) * 256, c.share, whole);
    return z_ - (c.height >> 16) * 256 + path.start + fall.start +
           sum_of_shares(path.size, path.part, fall.size, fall.part, whole);
  }

  // The path above the plane of the triangle before the crossing, times twice the triangle's area.
  template <class Walk>
  Linear above_plane(const Walk& walk, int64_t* area) const {
    const auto triangle = walk.triangle();
    const Vertex v[3] = {triangle.vertex(triangle.corner(0)), triangle.vertex(triangle.corner(1)),
                         triangle.vertex(triangle.corner(2))};
    *area = orient2d(Point{v[0].x, v[0].y}, Point{v[1].x, v[1].y}, Point{v[2].x, v[2].y});
    return Linear{z_ * *area - plane_at(v, *area, walk.begin()),
                  z_end_ * *area - plane_at(v, *area, walk.end())};
  }

  // Where the clearance falls below what is needed: in the triangle before the crossing, if that is
  // known. Differences are below 2^62.
  template <class Walk>
  int32_t first_low(const Walk& walk, const Crossing& c) const {
    if (c.before != MICROTIN_QUERY_OK || c.along.part == 0) return rounded_down(c.along);
    int64_t area = 0;
    const Linear above = above_plane(walk, &area);
    const int64_t begin = above.begin - needed_ * area, end = above.end - needed_ * area;
    return rounded_down(Along{begin, begin - end});
  }

  int32_t z_, z_end_, needed_;
  bool is_safe_;
};

inline void begin_clearance(microtin_segment_state* state) {
  state->value[kLeast] = INT32_MAX;
  state->value[kFirst] = -1;
}

inline void clear(microtin_path_clearance* clearance) {
  clearance->least = INT32_MAX;
  clearance->least_along = 0;
  clearance->first_along = -1;
}

inline void get_clearance(const microtin_segment_state& state, microtin_path_clearance* clearance) {
  if (state.value[kLeast] == INT32_MAX) return;
  clearance->least = state.value[kLeast];
  clearance->least_along = rounded_down(Along{state.part[kLeast], state.whole[kLeast]});
  clearance->first_along = state.value[kFirst];
}

inline bool has_legal_heights(const microtin_path& path) {
  const auto is_legal = [](int32_t z) { return z <= kPathMost && z >= -kPathMost; };
  return is_legal(path.z) && is_legal(path.z_end) && is_legal(path.clearance);
}

}  // namespace microtin

#endif
