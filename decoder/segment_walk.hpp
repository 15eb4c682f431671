// SPDX-License-Identifier: MIT
// The walk along a segment, from triangle to triangle: its crossings in their order, each once.
//
// A vertex on the segment's line counts as one to the right, as if the line lay to the left of
// itself by less than any number. So a triangle that the line enters has corners on both sides, one
// edge where the line enters, from a left corner to a right one, and one where the line leaves. A
// triangle alone, by its number, is where the walk stands.
//
// A form of a terrain has the following, so that one walk serves all forms:
//   Cursor       as walk.hpp says
//   triangles(), at(t), number(cursor)   the numbers of triangles; in a ghost the cursor's apex is
//                infinity
//   corner()     the place from which its places are seen
//   height_at(place, step_limit, hint, height)
#ifndef MICROTIN_DECODER_SEGMENT_WALK_HPP
#define MICROTIN_DECODER_SEGMENT_WALK_HPP

#include "decoder/crossing.hpp"
#include "decoder/walk.hpp"

namespace microtin {

// In a ghost, to the hull edge that follows with the outside to the left, or to the one before.
template <class Cursor>
void advance_on_hull(Cursor& cursor, bool forward) {
  cursor.cross_around(forward);
  if (!forward) cursor.turn();
  cursor.turn();
}

// Where a walk stands: in a triangle.
enum class WalkStage : uint8_t {
  kSearch,    // for the triangle that holds the begin
  kTurn,      // in one that holds it, and may lie to the right of the line
  kApproach,  // in a ghost that the begin sees
  kInside,    // in one that the line enters
  kTouch,     // in a ghost whose edge begins on the line, with all terrain to the right
  kBeyond,    // beyond the terrain
  kEnding,    // in the one that holds the end, within a step
  kEnded
};

// The stage that a state holds; a state may hold any number.
inline WalkStage stage_of(uint32_t stage) {
  return stage < static_cast<uint32_t>(WalkStage::kEnding) ? static_cast<WalkStage>(stage)
                                                           : WalkStage::kEnded;
}

template <class Form>
class SegmentWalk {
 public:
  typedef typename Form::Cursor Cursor;

  // From a place of the terrain's lattice, where a search for the begin starts, along a segment in
  // the same coordinates. Any stage and number are allowed.
  SegmentWalk(const Form& form, LocalPoint start, LocalPoint begin, LocalPoint end, WalkStage stage,
              uint32_t number)
      : form_(form),
        corner_(fine_point(form.corner())),
        start_(start),
        begin_(LocalPoint{begin.x - corner_.x, begin.y - corner_.y}),
        end_(LocalPoint{end.x - corner_.x, end.y - corner_.y}),
        starts_at_begin_(start.x == begin.x && start.y == begin.y),
        stage_(stage),
        number_(number < form.triangles() ? number : 0),
        cursor_(form.at(number_)),
        left_(),
        right_() {
    if (!may_stand()) stage_ = WalkStage::kSearch;  // a state of another walk
  }

  bool at_end() const { return stage_ == WalkStage::kEnded; }
  WalkStage stage() const { return stage_; }
  uint32_t number() const { return stage_ == WalkStage::kSearch ? number_ : form_.number(cursor_); }

  // The triangle that holds what the segment has before the last crossing, if it is known; at the
  // begin and at the end the one that holds them.
  Cursor triangle() const {
    Cursor before = cursor_;
    if (stage_ == WalkStage::kTouch) advance_on_hull(before, false);
    const bool is_crossed =
        stage_ == WalkStage::kTouch || stage_ == WalkStage::kInside || stage_ == WalkStage::kBeyond;
    if (is_crossed) before.cross();
    return before;
  }
  // Seen from the corner of the terrain's box.
  FinePoint begin() const { return FinePoint{begin_.x, begin_.y}; }
  FinePoint end() const { return FinePoint{end_.x, end_.y}; }

  // A walk step, of a search all of them if it is not limited. True if it led to a crossing.
  MICROTIN_ONE_COPY bool step(bool is_limited, Crossing* c) {
    if (stage_ == WalkStage::kSearch) return search(is_limited, c);
    const bool is_found = stage_ == WalkStage::kInside     ? pass(c)
                          : stage_ == WalkStage::kTurn     ? turn(c)
                          : stage_ == WalkStage::kApproach ? approach(c)
                          : stage_ == WalkStage::kTouch    ? touch(c)
                                                           : finish(MICROTIN_QUERY_OUTSIDE, c);
    if (stage_ == WalkStage::kEnding) set_end_height(c);
    return is_found;
  }

 private:
  struct Corner {
    LocalPoint at;
    int32_t z;
    int64_t side;  // of the line: positive to the left
  };

  MICROTIN_ONE_COPY MICROTIN_WITHOUT_CALLS Corner corner_of(uint32_t number) const {
    const Vertex v = cursor_.vertex(number);
    Corner corner;
    corner.at = fine_point(Point{v.x, v.y});
    corner.side = orient(begin_, end_, corner.at);
    corner.z = v.z;
    return corner;
  }

  // Whether a walk may come to stand in the triangle at this stage: the steps from there have an
  // end. Turns the cursor to the edge where the line enters.
  bool may_stand() {
    if (stage_ == WalkStage::kSearch || stage_ >= WalkStage::kBeyond) return true;
    const bool in_ghost = stage_ == WalkStage::kApproach || stage_ == WalkStage::kTouch;
    if (!cursor_.may_stop() || cursor_.is_ghost() != in_ghost) return false;
    if (stage_ == WalkStage::kInside) return enter();
    if (stage_ == WalkStage::kTouch) return side(cursor_.start()) == 0;
    bool is_beside = begin_side() >= 0;
    for (int i = 1; i < 3 && !in_ghost; ++i) {
      cursor_.turn();
      if (begin_side() < 0) is_beside = false;
    }
    return is_beside;
  }

  // Positive if the begin lies to the left of the half-edge.
  int64_t begin_side() const {
    return orient(fine_point(cursor_.place(cursor_.start())),
                  fine_point(cursor_.place(cursor_.end())), begin_);
  }

  // The begin lies in the terrain's box, or else is outside.
  bool search(bool is_limited, Crossing* c) {
    int32_t height = 0;
    microtin_query_result result = form_.height_at(start_, is_limited ? 1u : 0u, &number_, &height);
    if (result == MICROTIN_QUERY_STEP_LIMIT) return false;
    cursor_ = form_.at(number_);
    if (!starts_at_begin_) {
      if (cursor_.is_ghost()) cursor_.cross();
      walk(cursor_, FinePoint{begin_.x, begin_.y}, form_.triangles());
      result = MICROTIN_QUERY_OUTSIDE;
    }
    stage_ = cursor_.is_ghost() ? WalkStage::kApproach : WalkStage::kTurn;
    *c = Crossing{Along{0, 1}, -1, height, height, static_cast<uint8_t>(result), MICROTIN_QUERY_OK};
    return true;
  }

  // Around a corner where the segment begins, until the line enters the triangle.
  MICROTIN_ONE_COPY bool turn(Crossing* c) {
    if (begin_.x == end_.x && begin_.y == end_.y) return finish_inside(MICROTIN_QUERY_OK, c);
    if (enter()) {
      stage_ = WalkStage::kInside;
      return false;
    }
    for (int i = 0; i < 3 && !is_pivot(); ++i) cursor_.turn();
    cursor_.cross();
    if (!cursor_.is_ghost()) return false;
    if (side(cursor_.start()) != 0) advance_on_hull(cursor_, true);
    stage_ = side(cursor_.end()) > 0 ? WalkStage::kApproach : WalkStage::kTouch;
    return false;
  }

  // Turns to the edge where the line enters. False if no corner is on the left, or on the right.
  MICROTIN_OUT_OF_LINE bool enter() {
    for (int i = 0; i < 3; ++i, cursor_.turn()) {
      left_ = corner_of(cursor_.start());
      right_ = corner_of(cursor_.end());
      if (left_.side > 0 && right_.side <= 0) return true;
    }
    return false;
  }

  // Whether the half-edge begins where the segment does, or lies on its line.
  bool is_pivot() const {
    return side(cursor_.start()) == 0 && (side(cursor_.end()) == 0 || side(cursor_.apex()) != 0);
  }

  int64_t side(uint32_t number) const { return corner_of(number).side; }

  // Along hull edges that the begin sees, to that where the line enters.
  MICROTIN_ONE_COPY bool approach(Crossing* c) {
    const bool forward = side(cursor_.end()) <= 0, is_right = side(cursor_.start()) <= 0;
    if (is_right && !forward) return enter_hull(c);
    if (!is_right && forward) return finish(MICROTIN_QUERY_OUTSIDE, c);  // behind the begin
    advance_on_hull(cursor_, forward);
    if (begin_side() > 0) return false;
    if (forward) return touch_corner(c);
    return finish(MICROTIN_QUERY_OUTSIDE, c);
  }

  // The hull edge begins at the last vertex that the begin sees, perhaps on the segment.
  MICROTIN_OUT_OF_LINE bool touch_corner(Crossing* c) {
    const Corner corner = corner_of(cursor_.start());
    const Along along = along_line(corner.at);
    const bool touches = corner.side == 0 && along.part > 0 && along.part <= along.whole;
    if (!touches) return finish(MICROTIN_QUERY_OUTSIDE, c);
    set_vertex(corner, along, MICROTIN_QUERY_OUTSIDE, c);
    stage_ = along.part < along.whole ? WalkStage::kTouch : WalkStage::kEnded;
    return true;
  }

  bool enter_hull(Crossing* c) {
    cursor_.cross();
    left_ = corner_of(cursor_.start());
    right_ = corner_of(cursor_.end());
    const int64_t to = orient(right_.at, left_.at, end_);
    if (to > 0) return finish(MICROTIN_QUERY_OUTSIDE, c);
    if (to == 0) return finish_inside(MICROTIN_QUERY_OUTSIDE, c);
    stage_ = WalkStage::kInside;
    return set_crossing(right_, left_, to, false, MICROTIN_QUERY_OUTSIDE, c);
  }

  // Through a triangle with corners on both sides, and over the edge where the line leaves it.
  MICROTIN_IN_PLACE bool pass(Crossing* c) {
    const Corner apex = corner_of(cursor_.apex());
    const bool is_fan = apex.side > 0 && right_.side == 0, had_terrain = !cursor_.is_void();
    const microtin_query_result before = known(had_terrain || runs_along_known(apex));
    (apex.side > 0 ? left_ : right_) = apex;
    const int64_t to = orient(right_.at, left_.at, end_);
    if (to >= 0) return finish_inside(before, c);
    if (apex.side <= 0) cursor_.turn();
    cursor_.turn();
    cursor_.cross();
    if (cursor_.is_ghost()) stage_ = WalkStage::kBeyond;
    // All triangles of a fan around a vertex on the line meet it there.
    return !is_fan && set_crossing(right_, left_, to, had_terrain, before, c);
  }

  static microtin_query_result known(bool is_known) {
    return is_known ? MICROTIN_QUERY_OK : MICROTIN_QUERY_VOID;
  }

  // Whether the line runs along an edge of the triangle that has terrain beyond.
  bool runs_along_known(const Corner& apex) const {
    if (right_.side != 0 || apex.side != 0) return false;
    Cursor other = cursor_;
    other.turn();
    other.cross();
    return other.has_terrain();
  }

  // Where the segment crosses an edge that its end lies `to` beyond; negative. The begin is no
  // crossing, nor is a place on an edge between voids, of which the cursor stands on one side.
  bool set_crossing(const Corner& right, const Corner& left, int64_t to, bool had_terrain,
                    microtin_query_result before, Crossing* c) const {
    const int64_t whole = left.side - right.side, part = whole + to;
    if (part <= 0) return false;
    if (right.side == 0) return set_vertex(right, Along{part, whole}, before, c);
    *c = Crossing{Along{part, whole}, -right.side,       right.z * 65536,
                  left.z * 65536,     MICROTIN_QUERY_OK, static_cast<uint8_t>(before)};
    return had_terrain || cursor_.has_terrain();
  }

  bool set_vertex(const Corner& at, const Along& along, microtin_query_result before,
                  Crossing* c) const {
    const int32_t height = at.z * 65536;
    *c = Crossing{along, 0, height, height, MICROTIN_QUERY_OK, static_cast<uint8_t>(before)};
    return true;
  }

  // A place on the line: the parts are below 2^51, as the segment is shorter than 2^24.5.
  Along along_line(LocalPoint p) const {
    const int64_t x = end_.x - begin_.x, y = end_.y - begin_.y;
    return Along{x * (p.x - begin_.x) + y * (p.y - begin_.y), x * x + y * y};
  }

  // Along a hull edge on the line, if it is one. The terrain beyond it is all that knows it.
  MICROTIN_ONE_COPY bool touch(Crossing* c) {
    const Corner b = corner_of(cursor_.end());
    if (b.side != 0) return finish(MICROTIN_QUERY_OUTSIDE, c);
    const Along along = along_line(b.at);
    Cursor inside = cursor_;
    inside.cross();
    if (along.part >= along.whole) {
      cursor_ = inside;
      return finish_inside(known(inside.has_terrain()), c);
    }
    advance_on_hull(cursor_, true);
    return along.part > 0 && set_vertex(b, along, known(inside.has_terrain()), c);
  }

  // The end lies in this triangle. What finds its height is not called from here, to save stack.
  bool finish_inside(microtin_query_result before, Crossing* c) {
    finish(before, c);
    stage_ = WalkStage::kEnding;
    return true;
  }

  void set_end_height(Crossing* c) {
    stage_ = WalkStage::kEnded;
    c->result = static_cast<uint8_t>(result_at(cursor_, end(), &c->height));
    c->other = c->height;
  }

  // The end lies outside.
  bool finish(microtin_query_result before, Crossing* c) {
    stage_ = WalkStage::kEnded;
    *c = Crossing{Along{1, 1}, -1, 0, 0, MICROTIN_QUERY_OUTSIDE, static_cast<uint8_t>(before)};
    return true;
  }

  const Form& form_;
  LocalPoint corner_, start_;
  LocalPoint begin_, end_;  // seen from the corner
  bool starts_at_begin_;
  WalkStage stage_;
  uint32_t number_;  // in a search
  Cursor cursor_;
  Corner left_, right_;  // inside: of the edge where the line enters
};

}  // namespace microtin

#endif
