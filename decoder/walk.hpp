// SPDX-License-Identifier: MIT
// Finding the triangle that holds a place, and the height there: the same for each form of a mesh.
//
// A form's cursor stands on a half-edge of a triangle, with that to its left:
//   start(), end(), apex()      the numbers of the half-edge's ends, and of the third corner
//   is_ghost()                  whether the third corner is infinity
//   has_terrain()               whether the triangle is neither ghost nor void
//   is_void()                   whether a triangle that is no ghost is void
//   cross()                     to the triangle beyond, on the half-edge the other way
//   leave_next(), leave_last(), then enter()   ... beyond end() -> apex(), beyond apex() ->
//                               start(), or into what is no triangle of the mesh, where may_stop()
//                               is false
//   cross_around(forward)       in a ghost with infinity for apex: beyond end() -> apex(), else
//                               beyond apex() -> start(), to the ghost next to it
//   turn()                      to the next half-edge of the triangle
//   corner(0), (1), (2)         the same three, counter-clockwise from any
//   place(number), vertex(number)   of a finite vertex
#ifndef MICROTIN_DECODER_WALK_HPP
#define MICROTIN_DECODER_WALK_HPP

#include "decoder/state.hpp"
#include "microtin/microtin.h"
#include "shared/format.hpp"
#include "shared/interpolation.hpp"

namespace microtin {

// A point as seen from p, with 8 fractional bits: each coordinate is within +-2^24.
MICROTIN_IN_PLACE inline Offset seen_from(FinePoint p, Point at) {
  return Offset{static_cast<FastInt>(at.x) * 256 - p.x, static_cast<FastInt>(at.y) * 256 - p.y};
}

// Walks from a triangle, which is no ghost, to the triangle that holds p, through at most
// `step_limit` triangles: crosses any edge that p lies beyond. The cursor is left where the walk
// ended, in a ghost if p is outside the hull; false if the steps did not suffice.
//
// As many steps as there are triangles always suffice, also in several calls. Lift the vertices to
// the paraboloid, with the infinitesimals of conflicts_on_circle: the triangles become facets of a
// strictly convex surface, and each step makes the facet's plane higher above p. So no triangle is
// met twice (Edelsbrunner, "An acyclicity theorem for cell complexes in d dimensions", 1990).
//
// Twice the area that two corners span with p is below 2^50: each factor pair is below 2^24 * 2^24.
//
// Compact terrains take the form in place: where all sources are one, walk has two callers there
// and would be a call, which costs 4 % of a search.
template <class Cursor>
MICROTIN_IN_PLACE inline bool walk_in_place(Cursor& cursor, FinePoint p, uint32_t step_limit) {
  Offset from = seen_from(p, cursor.place(cursor.start()));
  Offset to = seen_from(p, cursor.place(cursor.end()));
  if (cross(from, to) < 0) {
    cursor.cross();
    const Offset other = from;
    from = to;
    to = other;
  }
  for (uint32_t step = 0; step < step_limit || !cursor.may_stop(); ++step) {
    // p does not lie beyond the half-edge.
    if (cursor.is_ghost()) return true;
    const Offset apex = seen_from(p, cursor.apex_place());
    if (cross(to, apex) < 0) {
      cursor.leave_next();
      from = apex;
    } else if (cross(apex, from) < 0) {
      cursor.leave_last();
      to = apex;
    } else {
      return true;
    }
    cursor.enter();
  }
  return false;
}

template <class Cursor>
inline bool walk(Cursor& cursor, FinePoint p, uint32_t step_limit) {
  return walk_in_place(cursor, p, step_limit);
}

// Whether p, in a closed triangle without terrain, is a corner or on an edge with terrain beyond.
template <class Cursor>
MICROTIN_OUT_OF_LINE inline bool touches_terrain(Cursor cursor, FinePoint p) {
  bool touches = false, is_on_edge = false;
  for (uint32_t i = 0; i < 3 && !touches; ++i, cursor.turn()) {
    const Offset from = seen_from(p, cursor.place(cursor.start()));
    if (cross(from, seen_from(p, cursor.place(cursor.end()))) != 0) continue;
    Cursor other = cursor;
    other.cross();
    touches = is_on_edge || other.has_terrain();  // on two edges: a corner
    is_on_edge = true;
  }
  return touches;
}

// The result at p in the closed triangle, which is no ghost. A vertex always knows its own height;
// on an edge, terrain on either side is enough.
template <class Cursor>
inline microtin_query_result result_at(const Cursor& cursor, FinePoint p, int32_t* height) {
  if (!cursor.has_terrain() && !touches_terrain(cursor, p)) return MICROTIN_QUERY_VOID;
  *height = height_in_triangle(cursor.vertex(cursor.corner(0)), cursor.vertex(cursor.corner(1)),
                               cursor.vertex(cursor.corner(2)), p);
  return MICROTIN_QUERY_OK;
}

inline Vertex vertex_of(const Mesh& mesh, uint32_t v) {
  const Point at = mesh.place[v];
  return Vertex{at.x, at.y, mesh.z[v]};
}

// The half-edge mesh's.
class MeshCursor {
 public:
  MeshCursor(const microtin_mesh& m, Index half_edge) : m_(&m), h_(half_edge) {}

  Index start() const { return mesh().origin[h_]; }
  Index end() const { return mesh().origin[next_in_triangle(h_)]; }
  Index apex() const { return mesh().origin[previous_in_triangle(h_)]; }
  Index triangle() const { return triangle_of(h_); }
  bool is_ghost() const { return apex() == kInfinity; }
  bool may_stop() const { return true; }
  bool has_terrain() const { return microtin::has_terrain(*m_, triangle()); }
  bool is_void() const { return has_voids(*m_) && microtin::is_void(m_->voids, triangle()); }
  void cross() { enter(); }
  void leave_next() { h_ = next_in_triangle(h_); }
  void leave_last() { h_ = previous_in_triangle(h_); }
  void enter() { h_ = mesh().twin[h_]; }
  void cross_around(bool forward) {
    if (forward) {
      leave_next();
    } else {
      leave_last();
    }
    enter();
  }
  void turn() { h_ = next_in_triangle(h_); }
  MICROTIN_IN_PLACE Point place(uint32_t v) const { return mesh().place[v]; }
  MICROTIN_IN_PLACE Point apex_place() const { return place(apex()); }
  MICROTIN_IN_PLACE Index corner(uint32_t i) const {
    return mesh().origin[first_edge(triangle()) + i];
  }
  Vertex vertex(uint32_t v) const { return vertex_of(mesh(), v); }

 private:
  const Mesh& mesh() const { return m_->mesh; }

  const microtin_mesh* m_;
  Index h_;
};

// Walks as above from *triangle, ghost or not, to another.
bool walk_to(const microtin_mesh& mesh, FinePoint p, uint32_t step_limit, Index* triangle);

// Widens a height, rounded to nearest at 16 fractional bits, halves up, by margins in sixteenths.
// The exact height is between half a unit less and half a unit more, so that it lies in lowest ..
// highest also without margins. All numbers are below 2^23 + 2^24.
MICROTIN_ONE_COPY inline microtin_query_result widen(int32_t height, uint32_t below, uint32_t above,
                                                     microtin_safe_heights* heights) {
  if (below == kNotStated || above == kNotStated) return MICROTIN_QUERY_NO_MARGIN;
  const int32_t whole = height >> 8;  // rounded down
  heights->lowest = whole - ((height & 255) == 0 ? 1 : 0) - static_cast<int32_t>(above) * 16;
  heights->highest = whole + 1 + static_cast<int32_t>(below) * 16;
  return MICROTIN_QUERY_OK;
}

}  // namespace microtin

#endif
