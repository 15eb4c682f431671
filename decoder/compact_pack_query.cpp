// SPDX-License-Identifier: MIT
// Queries on packs whose tiles are compact.
#include "decoder/pack_query.hpp"
#include "decoder/ring_cursor.hpp"

namespace microtin {
namespace {

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
    const uint32_t middle = middle_of(t), low = low_of(ring_, middle, t & 1u);
    if (low == 0) return false;
    places[0] = place_of(ring_, low);
    places[1] = place_of(ring_, middle);
    places[2] = place_of(ring_, high_of(ring_, middle, t & 1u));
    return true;
  }
  microtin_answer height_at(LocalPoint p, uint32_t* hint, int32_t* height) const {
    return microtin_compact_height_at(c_, p.x, p.y, 0, hint, height);
  }

 private:
  const microtin_compact* c_;
  Ring ring_;
};

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_answer microtin_compact_pack_height_at(const microtin_pack* pack, int64_t x, int64_t y,
                                                uint32_t* hint, int32_t* height) {
  return height_in_pack<RingForm>(*pack, x, y, hint, height);
}

microtin_answer microtin_compact_pack_highest(const microtin_pack* pack,
                                              const microtin_course* course, int32_t* height) {
  return highest_in_pack<RingForm>(*pack, *course, height);
}

microtin_answer microtin_compact_pack_fill(const microtin_pack* pack, const microtin_block* block,
                                           int16_t* heights) {
  return fill_from_pack<RingForm>(*pack, *block, heights);
}
