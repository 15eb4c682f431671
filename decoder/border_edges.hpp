// SPDX-License-Identifier: MIT
// What the tiles on both sides of a border know of it.
#ifndef MICROTIN_DECODER_BORDER_EDGES_HPP
#define MICROTIN_DECODER_BORDER_EDGES_HPP

#include "decoder/segment_walk.hpp"

namespace microtin {

// The known edges of a terrain's hull along a border line, in the order of their places.
template <class Form>
class BorderEdges {
 public:
  // The line x (if vertical) or y = `line`, a side of the tile. At most two rounds of the hull.
  BorderEdges(const Form& form, bool vertical, int32_t line)
      : cursor_(first_ghost(form)),
        corner_(fine_point(form.corner())),
        vertical_(vertical),
        line_(line),
        rises_(vertical == (line == 0)) {
    bool was_on_line = true;
    for (uint32_t i = 2 * form.triangles(); i != 0; --i, was_on_line = is_on_line(), advance()) {
      if (!was_on_line && is_on_line()) return;
    }
    has_more_ = false;
  }

  // How far the known edges that hold a place reach; that place if none does. Places do not fall
  // from call to call.
  int32_t reach(int32_t from) {
    while (has_more_ && last() <= from) {
      advance();
      has_more_ = is_on_line();
    }
    if (!has_more_ || first() > from) return from;
    typename Form::Cursor inside = cursor_;
    inside.cross();
    return inside.has_terrain() ? last() : from;
  }

 private:
  // There is one: a hull has three edges at least.
  static typename Form::Cursor first_ghost(const Form& form) {
    uint32_t t = 0;
    while (!form.at(t).is_ghost() || !form.at(t).may_stop()) ++t;
    return form.at(t);
  }

  // The x or y of a vertex.
  MICROTIN_ONE_COPY int32_t coordinate(uint32_t vertex, bool y) const {
    const LocalPoint p = fine_point(cursor_.place(vertex));
    return y ? p.y + corner_.y : p.x + corner_.x;
  }
  // Where the edge begins and ends along the line.
  int32_t first() const { return coordinate(rises_ ? cursor_.start() : cursor_.end(), vertical_); }
  int32_t last() const { return coordinate(rises_ ? cursor_.end() : cursor_.start(), vertical_); }
  bool is_on_line() const {
    return coordinate(cursor_.start(), !vertical_) == line_ &&
           coordinate(cursor_.end(), !vertical_) == line_;
  }

  // To the hull edge that follows as places rise. The outside lies to the left of hull edges: along
  // the first vertical side they run up, and so around the tile.
  void advance() { advance_on_hull(cursor_, rises_); }

  typename Form::Cursor cursor_;  // on a hull edge of a ghost
  LocalPoint corner_;
  bool vertical_;
  int32_t line_;
  bool rises_;  // edges run as places rise
  bool has_more_ = true;
};

// Whether one of two terrains knows each place from `known` to `end` of the line that is `line` to
// one, and 0 to the other.
template <class Form>
bool know_border(const Form& one, int32_t line, const Form& other, int32_t other_line,
                 bool vertical, int32_t known, int32_t end) {
  BorderEdges<Form> mine(one, vertical, line), theirs(other, vertical, other_line);
  while (known < end) {  // once for each edge at most
    const int32_t reached = larger(mine.reach(known), theirs.reach(known));
    if (reached == known) return false;
    known = reached;
  }
  return true;
}

}  // namespace microtin

#endif
