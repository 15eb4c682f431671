// Finding the triangle that holds a place, and the height there: the same for each form of a mesh.
//
// A form F tells of a triangle seen from one of its half-edges:
//   F::Edge               a half-edge
//   after(edge)           the next one of its triangle
//   across(edge)          the one that runs the other way, of the triangle beyond
//   start(edge)           the number of the vertex where it starts
//   is_infinity(number)   whether that is the vertex at infinity
//   place(number), vertex(number)   of a finite vertex
//   has_terrain(edge)     whether its triangle is neither ghost nor void
#ifndef MICROTIN_DECODER_WALK_HPP
#define MICROTIN_DECODER_WALK_HPP

#include "decoder/state.hpp"
#include "shared/interpolation.hpp"

namespace microtin {

// A point as seen from p, with 8 fractional bits: each coordinate is within +-2^24.
inline Offset seen_from(FinePoint p, Point at) {
  return Offset{static_cast<FastInt>(at.x) * 256 - p.x, static_cast<FastInt>(at.y) * 256 - p.y};
}

// Walks from the triangle of *edge, which is none of a ghost, to the triangle that holds p, through
// at most `step_limit` triangles: crosses any edge that p lies beyond. *edge becomes one of where
// the walk ended, opposite to infinity if p is outside the hull; false if the steps did not
// suffice.
//
// As many steps as there are triangles always suffice, also in several calls. Lift the vertices to
// the paraboloid, with the infinitesimals of conflicts_on_circle: the triangles become facets of a
// strictly convex surface, and each step makes the facet's plane higher above p. So no triangle is
// met twice (Edelsbrunner, "An acyclicity theorem for cell complexes in d dimensions", 1990).
//
// Twice the area that two corners span with p is below 2^50: each factor pair is below 2^24 * 2^24.
template <class Form>
inline bool walk(const Form& form, FinePoint p, uint32_t step_limit, typename Form::Edge* edge) {
  typename Form::Edge h = *edge;
  Offset from = seen_from(p, form.place(form.start(h)));
  Offset to = seen_from(p, form.place(form.start(form.after(h))));
  if (cross(from, to) < 0) {
    h = form.across(h);
    const Offset other = from;
    from = to;
    to = other;
  }
  bool arrived = false;
  for (uint32_t step = 0; step < step_limit && !arrived; ++step) {
    // p does not lie beyond h.
    const typename Form::Edge next = form.after(h), last = form.after(next);
    const uint32_t apex = form.start(last);
    if (form.is_infinity(apex)) {
      arrived = true;
      break;
    }
    const Offset at = seen_from(p, form.place(apex));
    if (cross(to, at) < 0) {
      h = form.across(next);
      from = at;
    } else if (cross(at, from) < 0) {
      h = form.across(last);
      to = at;
    } else {
      arrived = true;
    }
  }
  *edge = h;
  return arrived;
}

// The answer at p in the closed triangle of h, which is no ghost. A vertex always knows its own
// height; on an edge, terrain on either side is enough.
template <class Form>
inline microtin_answer answer_in(const Form& form, typename Form::Edge h, FinePoint p,
                                 int32_t* height) {
  const typename Form::Edge next = form.after(h), last = form.after(next);
  const uint32_t corner[3] = {form.start(h), form.start(next), form.start(last)};
  bool known = form.has_terrain(h);
  for (uint32_t i = 0; i < 3 && !known; ++i, h = form.after(h)) {
    const Offset from = seen_from(p, form.place(corner[i]));
    const Offset to = seen_from(p, form.place(corner[i == 2 ? 0 : i + 1]));
    known =
        (from.x == 0 && from.y == 0) || (cross(from, to) == 0 && form.has_terrain(form.across(h)));
  }
  if (!known) return MICROTIN_IN_VOID;
  *height =
      height_in_triangle(form.vertex(corner[0]), form.vertex(corner[1]), form.vertex(corner[2]), p);
  return MICROTIN_HEIGHT;
}

// The half-edge mesh.
class MeshForm {
 public:
  typedef Index Edge;

  MeshForm(const Mesh& mesh, const uint8_t* voids) : mesh_(mesh), voids_(voids) {}

  Edge after(Edge h) const { return next_in_triangle(h); }
  Edge across(Edge h) const { return mesh_.twin[h]; }
  Index start(Edge h) const { return mesh_.origin[h]; }
  bool is_infinity(uint32_t v) const { return v == kInfinity; }
  Point place(uint32_t v) const { return Point{mesh_.x[v], mesh_.y[v]}; }
  Vertex vertex(uint32_t v) const { return Vertex{mesh_.x[v], mesh_.y[v], mesh_.z[v]}; }
  bool has_terrain(Edge h) const {
    const Index t = triangle_of(h);
    return !is_ghost(mesh_, t) && !(voids_ != nullptr && is_void(voids_, t));
  }

 private:
  const Mesh& mesh_;
  const uint8_t* voids_;  // null: none
};

inline MeshForm form_of(const microtin_mesh& m) {
  return MeshForm(m.mesh, m.has_voids ? m.voids : nullptr);
}

// Walks as above from *triangle, ghost or not, to another.
bool walk_to(const Mesh& mesh, FinePoint p, uint32_t step_limit, Index* triangle);

}  // namespace microtin

#endif
