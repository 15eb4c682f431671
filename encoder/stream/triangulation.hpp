// SPDX-License-Identifier: MIT
// The canonical Delaunay triangulation of a set of points: built at once, then changed point by
// point. Always exact, and a function of the points alone.
#ifndef MICROTIN_ENCODER_STREAM_TRIANGULATION_HPP
#define MICROTIN_ENCODER_STREAM_TRIANGULATION_HPP

#include <algorithm>
#include <cstddef>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/survey.hpp"
#include "shared/format.hpp"
#include "shared/insertion.hpp"
#include "shared/mesh.hpp"

namespace microtin::stream {

// What `address` points to will be used soon. Changes nothing but the time.
inline void prefetch(const void* address) {
#if defined(__GNUC__)
  __builtin_prefetch(address);
#else
  static_cast<void>(address);
#endif
}

// next_in_triangle and previous_in_triangle where nobody can predict which of the three half-edges
// h is.
inline Index next_without_branch(Index h) {
  return h + 1 - 3 * static_cast<Index>(is_first_edge(h + 1));
}

inline Index previous_without_branch(Index h) {
  return h - 1 + 3 * static_cast<Index>(is_first_edge(h));
}

class Triangulation {
 public:
  // Vertex i is points[i]. Throws Error if two points share a place or all form no triangle.
  explicit Triangulation(const std::vector<Point>& points);

  // Triangulates such that vertex i is points[order[i]], and neighbours have numbers close to one
  // another: quicker to build and to use. Sets `order`.
  Triangulation(const std::vector<Point>& points, std::vector<Index>& order);

  Triangulation(const Triangulation& other);
  Triangulation(Triangulation&&) = default;
  Triangulation& operator=(Triangulation&&) = default;

  // Has no heights: z is null. After removals, up to mesh().vertices vertices and mesh().triangles
  // triangles are a mixture of live and removed ones.
  const Mesh& mesh() const { return mesh_; }

  bool has_vertex(Index v) const { return edge_of(v) != kNoEdge; }

  // The arrays behind the mesh: memory for another one of as many vertices.
  struct Arrays {
    std::vector<Point> places;
    std::vector<Index> origin, twin;
  };
  Arrays take_arrays() && { return std::move(arrays_); }

  // Some half-edge from v, which may be kInfinity; kNoEdge if v was removed.
  static constexpr Index kNoEdge = kInfinity;
  Index edge_of(Index v) const { return edge_of_[entry(v)]; }

  // The neighbours of v, which may be kInfinity and counts as a neighbour too.
  Index degree(Index v) const;

  // A half-edge of a triangle whose closure holds p or, if p lies outside the hull, of a ghost in
  // conflict with it. Walks there from the half-edge `hint`.
  Index locate(Point p, Index hint) const;

  // Adds p, different from all vertices, and returns its number: that of a removed vertex if there
  // is one, else mesh().vertices.
  Index insert(Point p, Index hint);

  // The triangles in conflict with p, which an insertion would replace.
  const std::vector<Index>& conflicts(Point p, Index hint);

  // After `conflicts`: the vertices around those triangles, counter-clockwise, infinity among them.
  // An insertion joins p to all of them.
  Index rim_size() const { return cavity_.size + 2; }
  Index rim(Index i) const { return cavity_.edge_origin[i]; }

  // The triangles that the last insert or remove made. Those of an insert turn counter-clockwise
  // around the new vertex, which is the last corner of each, and take the slots of those that it
  // replaced, then two more.
  const std::vector<Index>& new_triangles() const { return new_triangles_; }

  // Removes v if it has at most max_degree <= kMaxRemovable neighbours, infinity counted, and says
  // whether it did. Those that stay must not all lie on one line. Only the triangles around v
  // change; the other vertices and half-edges keep their numbers. O(degree^2).
  bool remove(Index v, Index max_degree);
  static constexpr Index kMaxRemovable = kMaxDegree;

  // From now on the last changes can be undone, up to those that were forgotten. Insertions must
  // not take a new number then.
  void log_changes() { logs_ = true; }

  // Takes the last insertion or removal back, with all numbers, also those of triangles, and
  // returns the number of its vertex.
  Index undo();
  void forget_changes();

  // v will be used soon and `later` after that: spares them waiting for memory.
  void expect(Index v, Index later) const {
    prefetch(&edge_of_[entry(later)]);
    prefetch(mesh_.origin + edge_of(v));
    prefetch(mesh_.twin + edge_of(v));
  }

 private:
  // A corner of the hole that a removed vertex leaves.
  struct Corner {
    int64_t x, y;  // unless it is kInfinity
    Index vertex;
    Index outside;  // the half-edge beyond the side to the next corner
    Index slot;     // first half-edge of the triangle that was at that side
  };

  struct Hole {
    Corner corners[kMaxRemovable];  // counter-clockwise; kInfinity, if there, comes last
    const Corner* last;
  };

  // What an insertion or a removal overwrites, to be put back.
  struct Triangle {
    Index slot, origin[3], twin[3];
  };
  struct Edge {
    Index vertex, edge;
  };
  struct Change {
    Index vertex, free_slot;
    Point place;
    bool is_insertion;
    std::size_t triangles, edges;  // logged before it
  };
  struct Log {
    std::vector<Triangle> triangles;
    std::vector<Edge> edges;
    std::vector<Change> changes;
  };

  static Point place(const Corner& c) {
    return {static_cast<uint16_t>(c.x), static_cast<uint16_t>(c.y)};
  }
  static Index entry(Index v) { return static_cast<Index>(v + 1u); }
  void set_sizes(std::size_t vertices);
  void set_cavity_limit(std::size_t limit);
  void point_at_arrays();
  void renumber(const std::vector<Index>& order);
  void find_cavity(Point p, Index hint);
  Index connect(Index v, Index hint);
  void move_last_triangle(Index slot);
  void note_edges(Index triangle);
  void log_change(Index v, bool is_insertion);
  void log_triangle(Index slot);
  void log_edge(Index v);
  void log_insertion(Index v);
  void log_removal(Index v, const Hole& hole);
  bool open_hole(Index v, Index max_corners, Hole& hole) const;
  void fill_hole(const Hole& hole);
  void fill(const Corner* first, const Corner* last, Index closing, const Corner*& freed);
  void close(const Corner* first, const Corner* last, Index closing, const Corner*& freed);
  void fill_quadrangle(const Corner* first, Index closing, const Corner*& freed);
  static const Corner* apex_of(const Corner* first, const Corner* last);
  static const Corner* finite_apex_of(const Corner* first, const Corner* last);
  static const Corner* hull_apex_of(const Corner* first, const Corner* last);

  Mesh mesh_ = {};
  Arrays arrays_;
  std::vector<Index> edge_of_;  // entry v + 1; kInfinity + 1 wraps round to entry 0

  Cavity cavity_ = {};
  std::vector<Index> cavity_triangles_, cavity_origin_, cavity_twin_;
  std::vector<Index> new_triangles_;
  std::vector<Index> free_vertices_;
  Index free_slot_ = kNoEdge;  // the last that a removal left over; its twin is the one before
  bool logs_ = false;
  Log log_;
};

// A triangle as a TIN lists it.
inline Tin::Triangle listed_triangle(const Mesh& mesh, Index triangle) {
  const Index f = first_edge(triangle);
  Point p[3];
  for (Index i = 0; i < 3; ++i) p[i] = point_of(mesh, mesh.origin[f + i]);
  std::rotate(p, std::min_element(p, p + 3), p + 3);
  return {p[0], p[1], p[2]};
}

class VoidTriangles {
 public:
  explicit VoidTriangles(const std::vector<Tin::Triangle>& voids) {
    for (const Tin::Triangle& t : voids) voids_.emplace(t.a, t.b, t.c);
  }

  bool empty() const { return voids_.empty(); }
  bool has(const Mesh& mesh, Index triangle) const {
    if (empty()) return false;
    const Tin::Triangle t = listed_triangle(mesh, triangle);
    return voids_.count({t.a, t.b, t.c}) != 0;
  }

 private:
  std::set<std::tuple<Point, Point, Point>> voids_;
};

}  // namespace microtin::stream

#endif
