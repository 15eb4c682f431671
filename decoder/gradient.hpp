// SPDX-License-Identifier: MIT
// The gradient of the triangle at a position, whatever the terrain's form (segment_walk.hpp).
//
// Several triangles with terrain may hold a position on an edge or a vertex. Of these it is the one
// whose centre lies farthest east, and of those with equal x farthest north: no two have the same
// centre, and it does not depend on the form or on where the search began.
#ifndef MICROTIN_DECODER_GRADIENT_HPP
#define MICROTIN_DECODER_GRADIENT_HPP

#include "decoder/local_point.hpp"
#include "decoder/walk.hpp"
#include "microtin/segment.h"

namespace microtin {

// The best triangle so far.
struct BestTriangle {
  microtin_gradient gradient;
  int64_t x, y;  // three times its centre
  uint32_t number;
  bool is_found;
};

// The corners are counter-clockwise. Products are below 2^32.
inline microtin_gradient gradient_of(const Vertex* v) {
  const int64_t bx = static_cast<int32_t>(v[1].x) - v[0].x,
                by = static_cast<int32_t>(v[1].y) - v[0].y,
                bz = static_cast<int32_t>(v[1].z) - v[0].z,
                cx = static_cast<int32_t>(v[2].x) - v[0].x,
                cy = static_cast<int32_t>(v[2].y) - v[0].y,
                cz = static_cast<int32_t>(v[2].z) - v[0].z;
  return microtin_gradient{bz * cy - cz * by, bx * cz - cx * bz, bx * cy - cx * by};
}

template <class Form>
class TrianglesAt {
 public:
  typedef typename Form::Cursor Cursor;

  // For a position seen from the corner of the terrain's box, which lies at (west, south).
  TrianglesAt(const Form& form, FinePoint p, int64_t west, int64_t south, BestTriangle* best)
      : form_(form), p_(p), west_(west), south_(south), best_(*best) {}

  // Looks at all triangles that hold the position, of which this is one.
  void look_from(Cursor cursor) {
    consider(cursor);
    for (int i = 0; i < 3; ++i, cursor.turn()) {
      if (is_on_edge(cursor)) go_around(cursor);
    }
  }

 private:
  // Whether the position, in the closed triangle, lies on the cursor's edge.
  bool is_on_edge(const Cursor& cursor) const {
    return cross(seen_from(p_, cursor.place(cursor.start())),
                 seen_from(p_, cursor.place(cursor.end()))) == 0;
  }

  // Over edges that hold the position, up to the hull or back to where it began.
  void go_around(Cursor cursor) {
    const uint32_t first = form_.number(cursor);
    for (uint32_t left = form_.triangles(); left != 0; --left) {
      cursor.cross();
      if (cursor.is_ghost() || form_.number(cursor) == first) return;
      consider(cursor);
      cursor.turn();
      if (!is_on_edge(cursor)) cursor.turn();
      if (!is_on_edge(cursor)) return;
    }
  }

  void consider(const Cursor& cursor) {
    if (!cursor.has_terrain()) return;
    const Vertex v[3] = {cursor.vertex(cursor.start()), cursor.vertex(cursor.end()),
                         cursor.vertex(cursor.apex())};
    const int64_t x = west_ + v[0].x + v[1].x + v[2].x, y = south_ + v[0].y + v[1].y + v[2].y;
    if (best_.is_found && (x < best_.x || (x == best_.x && y <= best_.y))) return;
    best_ = BestTriangle{gradient_of(v), x, y, form_.number(cursor), true};
  }

  const Form& form_;
  FinePoint p_;
  int64_t west_, south_;  // three times
  BestTriangle& best_;
};

// Looks at the triangles of a terrain that hold a position; the terrain lies at (x, y) of others.
// The result is that of a height there.
template <class Form>
microtin_query_result look_at_place(const Form& form, LocalPoint at, int64_t x, int64_t y,
                                    uint32_t step_limit, uint32_t* hint, BestTriangle* best) {
  int32_t height = 0;
  const microtin_query_result result = form.height_at(at, step_limit, hint, &height);
  if (result != MICROTIN_QUERY_OK) return result;
  const Point corner = form.corner();
  const LocalPoint from = fine_point(corner);
  const FinePoint p = {at.x - from.x, at.y - from.y};
  TrianglesAt<Form>(form, p, 3 * (x + corner.x), 3 * (y + corner.y), best)
      .look_from(form.at(*hint));
  return result;
}

template <class Form>
microtin_query_result gradient_in_terrain(const Form& form, int32_t x, int32_t y, uint32_t* hint,
                                          microtin_gradient* gradient, uint32_t step_limit) {
  BestTriangle best = {};
  const microtin_query_result result =
      look_at_place(form, LocalPoint{x, y}, 0, 0, step_limit, hint, &best);
  if (result != MICROTIN_QUERY_OK) return result;
  if (!best.is_found) return MICROTIN_QUERY_VOID;  // a vertex among voids has a height alone
  *gradient = best.gradient;
  *hint = best.number;
  return MICROTIN_QUERY_OK;
}

}  // namespace microtin

#endif
