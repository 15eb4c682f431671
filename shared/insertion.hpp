// SPDX-License-Identifier: MIT
// Insertion of one point into a Delaunay mesh: what the point sees, the cavity of conflicting
// triangles, which grows, and the fan from the new vertex.
#ifndef MICROTIN_SHARED_INSERTION_HPP
#define MICROTIN_SHARED_INSERTION_HPP

#include "shared/mesh.hpp"
#include "shared/pairs.hpp"

namespace microtin {

#if defined(MICROTIN_PAIRS)

MICROTIN_OUT_OF_LINE inline bool in_any_conflict(const Mesh& mesh, Index a, Index b, Index c,
                                                 Point p) {
  return in_conflict(mesh, a, b, c, p);
}

struct Seen {
  Index vertex;
  Pair place;  // in the window around the point
};

class Sight {
 public:
  Sight(const Mesh& mesh, Point p)
      : mesh_(mesh),
        p_(p),
        window_(window_around(pair_of(p))),
        place_(difference(pair_of(p), window_)),
        all_(place_) {}

  // Infinity is taken for the point itself: then its tests come out even, which is a rare case.
  Seen see(Index v) {
    const Pair place = v == kInfinity ? place_ : difference(pair_of(point_of(mesh_, v)), window_);
    all_ = either(all_, place);
    return Seen{v, place};
  }

  // Whether the point conflicts with the counter-clockwise triangle (a, b, c).
  bool conflicts(const Seen& a, const Seen& b, const Seen& c) const {
    const int64_t d = is_outside(all_) ? 0 : incircle(a.place, b.place, c.place, place_);
    return d != 0 ? d > 0 : in_any_conflict(mesh_, a.vertex, b.vertex, c.vertex, p_);
  }

 private:
  const Mesh& mesh_;
  const Point p_;
  const Pair window_;
  const Pair place_;
  Pair all_;  // of all places seen: a bit that is in one
};

#else

struct Seen {
  Index vertex;
};

class Sight {
 public:
  Sight(const Mesh& mesh, Point p) : mesh_(mesh), p_(p) {}

  Seen see(Index v) { return Seen{v}; }

  // Whether the point conflicts with the counter-clockwise triangle (a, b, c).
  bool conflicts(const Seen& a, const Seen& b, const Seen& c) const {
    return in_conflict(mesh_, a.vertex, b.vertex, c.vertex, p_);
  }

 private:
  const Mesh& mesh_;
  const Point p_;
};

#endif

// Scratch for one insertion; its arrays belong to the caller. A cavity of m triangles is a polygon
// of m + 2 edges.
struct Cavity {
  Index* triangles;    // limit + 2 entries: the slots to be reused
  Index* edge_origin;  // limit + 2 entries: boundary, counter-clockwise
  Index* edge_twin;    // limit + 2 entries: the half-edges across it
  Index limit;         // most triangles that fit
  Index size;          // triangles found
};

// Collects the triangles in conflict with p: that of `start` and those connected to it. Where
// that across `start` is none of them, its edge comes first on the boundary. `forbids(v)` is asked
// for the far corner v of each triangle before it joins. False if it says yes, or if the cavity
// outgrows its limit; empty if the triangle of `start` and that across are not in conflict.
//
// The boundary is walked once. What is behind lies at the front of edge_twin, what is ahead of the
// edge in hand at its end: both sides of `start` are met like all others. The cavity's dual graph
// is a tree (its union is star-shaped from p and no vertex lies inside), so no triangle is met
// twice; each turn of the loop uses up one boundary edge of at most limit + 2.
template <class Forbids>
MICROTIN_IN_PLACE inline bool grow_cavity(const Mesh& mesh, Index start, Point p, Cavity& cavity,
                                          const Forbids& forbids) {
  Index* const end = cavity.edge_twin + cavity.limit + 2;
  Index* ahead = end;
  *--ahead = start;
  Index across = mesh.twin[start];  // from b to a
  Sight sight(mesh, p);
  Seen a = sight.see(mesh.origin[start]), b = sight.see(mesh.origin[across]);
  uint32_t edges = 0;
  cavity.size = 0;
  for (;;) {
    const Index previous = previous_in_triangle(across);
    const Seen c = sight.see(mesh.origin[previous]);
    if (sight.conflicts(b, a, c)) {
      if (cavity.size == cavity.limit || forbids(c.vertex)) return false;
      cavity.triangles[cavity.size++] = triangle_of(across);
      *--ahead = mesh.twin[previous];
      across = mesh.twin[next_in_triangle(across)];
      b = c;
      continue;
    }
    cavity.edge_origin[edges] = a.vertex;
    cavity.edge_twin[edges++] = across;
    if (ahead == end) return true;
    across = *ahead++;
    a = b;
    b = sight.see(mesh.origin[across]);
  }
}

// Replaces the cavity by a fan around the new vertex v: one triangle (edge origin, next origin, v)
// per boundary edge, in boundary order; the cavity's own slots first, then mesh.triangles and the
// one after it. Returns the first half-edge of the first fan triangle. The caller counts the
// vertex.
inline Index fan_cavity(Mesh& mesh, const Cavity& cavity, Index v) {
  Index* const fresh = cavity.triangles + cavity.size;
  fresh[0] = mesh.triangles++;
  fresh[1] = mesh.triangles++;
  size_t before = first_edge(fresh[1]);
  const uint32_t edges = cavity.size + 2u;
  for (uint32_t i = 0; i < edges; ++i) {
    const size_t h = first_edge(cavity.triangles[i]);
    mesh.origin[h] = mesh.origin[before + 1] = cavity.edge_origin[i];
    mesh.origin[h + 2] = v;
    pair(mesh, h, cavity.edge_twin[i]);
    pair(mesh, before + 1, h + 2);
    before = h;
  }
  return first_edge(cavity.triangles[0]);
}

}  // namespace microtin

#endif
