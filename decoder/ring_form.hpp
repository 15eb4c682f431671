// SPDX-License-Identifier: MIT
// A compact terrain, as segments want to see terrains: tile_segment.hpp.
#ifndef MICROTIN_DECODER_RING_FORM_HPP
#define MICROTIN_DECODER_RING_FORM_HPP

#include "decoder/ring_cursor.hpp"
#include "decoder/tile_segment.hpp"

namespace microtin {

class RingForm {
 public:
  typedef RingCursor Cursor;
  static constexpr bool kIsCompact = true;

  explicit RingForm(const void* space)
      : c_(static_cast<const microtin_compact*>(space)), ring_(ring_of(c_)) {}

  uint32_t triangles() const { return triangle_count(ring_); }
  Point corner() const { return Point{c_->west, c_->south}; }
  RingCursor at(uint32_t t) const { return cursor_at(ring_, t); }
  bool places(uint32_t t, Point* places) const {
    const uint32_t middle = middle_of(t);
    const RingSpan span = span_of(ring_.left + (t & 1u), middle);
    if (span.low == 0) return false;
    places[0] = place_of(ring_, span.low);
    places[1] = place_of(ring_, middle);
    places[2] = place_of(ring_, span.high);
    return true;
  }
  microtin_query_result height_at(LocalPoint p, uint32_t step_limit, uint32_t* hint,
                                  int32_t* height) const {
    return microtin_compact_height_at(c_, p.x, p.y, hint, height, step_limit);
  }

 private:
  const microtin_compact* c_;
  Ring ring_;
};

}  // namespace microtin

#endif
