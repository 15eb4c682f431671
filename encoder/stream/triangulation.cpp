// SPDX-License-Identifier: MIT
// Inserts by the shared cavity, removes by ears, keeps an edge of each vertex.
#include "encoder/stream/triangulation.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/stream/spatial_order.hpp"

namespace microtin::stream {

Triangulation::Triangulation(const std::vector<Point>& points) {
  std::vector<Index> order;
  *this = Triangulation(points, order);
  renumber(order);
}

Triangulation::Triangulation(const std::vector<Point>& points, std::vector<Index>& order) {
  order = insertion_order(points);
  start_with_triangle(order, [&points](Index a, Index b, Index c) {
    return orient2d(points[a], points[b], points[c]);
  });
  set_sizes(points.size());
  set_cavity_limit(64);
  for (std::size_t i = 0; i < order.size(); ++i) {
    arrays_.places[i] = points[order[i]];
  }
  start_mesh(mesh_);
  Index hint = 0;
  for (Index v = 3; v < order.size(); ++v) hint = connect(v, hint);
  mesh_.vertices = static_cast<Index>(order.size());
  for (Index t = 0; t < mesh_.triangles; ++t) note_edges(t);
}

Triangulation::Triangulation(const Triangulation& other)
    : mesh_(other.mesh_),
      arrays_(other.arrays_),
      edge_of_(other.edge_of_),
      cavity_(other.cavity_),
      cavity_triangles_(other.cavity_triangles_),
      cavity_origin_(other.cavity_origin_),
      cavity_twin_(other.cavity_twin_),
      new_triangles_(other.new_triangles_),
      free_vertices_(other.free_vertices_),
      free_slot_(other.free_slot_),
      logs_(other.logs_),
      log_(other.log_) {
  point_at_arrays();
}

void Triangulation::set_sizes(std::size_t vertices) {
  arrays_.places.resize(vertices);
  arrays_.origin.resize(6 * vertices);
  arrays_.twin.resize(6 * vertices);
  edge_of_.resize(vertices + 1);
  point_at_arrays();
}

void Triangulation::set_cavity_limit(std::size_t limit) {
  cavity_triangles_.resize(limit + 2);
  cavity_origin_.resize(limit + 2);
  cavity_twin_.resize(limit + 2);
  cavity_.limit = static_cast<Index>(limit);
  point_at_arrays();
}

void Triangulation::point_at_arrays() {
  mesh_.place = arrays_.places.data();
  mesh_.origin = arrays_.origin.data();
  mesh_.twin = arrays_.twin.data();
  cavity_.triangles = cavity_triangles_.data();
  cavity_.edge_origin = cavity_origin_.data();
  cavity_.edge_twin = cavity_twin_.data();
}

// Vertex i becomes vertex order[i].
void Triangulation::renumber(const std::vector<Index>& order) {
  std::vector<Point> places(order.size());
  std::vector<Index> edge_of(edge_of_);
  for (std::size_t i = 0; i < order.size(); ++i) {
    places[order[i]] = mesh_.place[i];
    edge_of[std::size_t{order[i]} + 1] = edge_of_[i + 1];
  }
  std::copy(places.begin(), places.end(), mesh_.place);
  edge_of_.swap(edge_of);
  for (Index h = 0; h < first_edge(mesh_.triangles); ++h) {
    if (mesh_.origin[h] != kInfinity) mesh_.origin[h] = order[mesh_.origin[h]];
  }
}

Index Triangulation::degree(Index v) const {
  const Index start = edge_of(v);
  Index h = start, neighbours = 0;
  do {
    ++neighbours;
    h = mesh_.twin[previous_in_triangle(h)];
  } while (h != start);
  return neighbours;
}

Index Triangulation::locate(Point p, Index hint) const {
  Index h = hint;
  const Index f = first_edge(triangle_of(hint));
  for (Index i = 0; i < 3; ++i) {
    if (mesh_.origin[f + i] == kInfinity) h = mesh_.twin[next_in_triangle(f + i)];
  }
  Point from = point_of(mesh_, mesh_.origin[h]);
  Point to = point_of(mesh_, mesh_.origin[next_in_triangle(h)]);
  if (orient2d(from, to, p) < 0) {
    h = mesh_.twin[h];
    std::swap(from, to);
  }
  // p lies on from -> to or to its left. On a Delaunay triangulation no triangle is met twice.
  for (;;) {
    const Index to_apex = next_in_triangle(h), from_apex = previous_in_triangle(h);
    if (mesh_.origin[from_apex] == kInfinity) return h;
    const Point apex = point_of(mesh_, mesh_.origin[from_apex]);
    if (orient2d(to, apex, p) < 0) {
      h = mesh_.twin[to_apex];
      from = apex;
    } else if (orient2d(apex, from, p) < 0) {
      h = mesh_.twin[from_apex];
      to = apex;
    } else {
      return h;
    }
  }
}

void Triangulation::find_cavity(Point p, Index hint) {
  const Index start = locate(p, hint);
  const auto forbids_nothing = [](Index) { return false; };
  while (!grow_cavity(mesh_, start, p, cavity_, forbids_nothing)) {
    set_cavity_limit(2 * std::size_t{cavity_.limit});
  }
}

// Joins vertex v, whose place is known, to the mesh. Returns a half-edge near it.
Index Triangulation::connect(Index v, Index hint) {
  find_cavity(point_of(mesh_, v), hint);
  return fan_cavity(mesh_, cavity_, v);
}

const std::vector<Index>& Triangulation::conflicts(Point p, Index hint) {
  find_cavity(p, hint);
  new_triangles_.assign(cavity_.triangles, cavity_.triangles + cavity_.size);
  return new_triangles_;
}

Index Triangulation::insert(Point p, Index hint) {
  Index v = mesh_.vertices;
  if (free_vertices_.empty()) {
    set_sizes(std::size_t{v} + 1);
  } else {
    v = free_vertices_.back();
    free_vertices_.pop_back();
  }
  find_cavity(p, hint);
  if (logs_) log_insertion(v);
  mesh_.place[v] = p;
  fan_cavity(mesh_, cavity_, v);
  new_triangles_.assign(cavity_.triangles, cavity_.triangles + cavity_.size + 2);
  if (v == mesh_.vertices) {
    ++mesh_.vertices;
  } else {
    for (std::size_t i = new_triangles_.size(); i-- > cavity_.size;) {
      const Index slot = free_slot_;
      free_slot_ = mesh_.twin[slot];
      new_triangles_[i] = triangle_of(slot);
      move_last_triangle(new_triangles_[i]);
    }
  }
  for (const Index triangle : new_triangles_) note_edges(triangle);
  return v;
}

void Triangulation::move_last_triangle(Index slot) {
  const Index from = first_edge(--mesh_.triangles), to = first_edge(slot);
  for (Index i = 0; i < 3; ++i) {
    mesh_.origin[to + i] = mesh_.origin[from + i];
    pair(mesh_, to + i, mesh_.twin[from + i]);
  }
}

void Triangulation::note_edges(Index triangle) {
  const Index f = first_edge(triangle);
  for (Index h = f; h < f + 3; ++h) edge_of_[entry(mesh_.origin[h])] = h;
}

// What an insertion or a removal overwrites: triangles, where they meet others, an edge of each
// vertex around, the number and the slots of what was removed before.

void Triangulation::log_change(Index v, bool is_insertion) {
  log_.changes.push_back(
      {v, free_slot_, mesh_.place[v], is_insertion, log_.triangles.size(), log_.edges.size()});
  log_edge(v);
}

void Triangulation::log_triangle(Index slot) {
  const Index *const origin = mesh_.origin + slot, *const twin = mesh_.twin + slot;
  log_.triangles.push_back({slot, {origin[0], origin[1], origin[2]}, {twin[0], twin[1], twin[2]}});
}

void Triangulation::log_edge(Index v) {
  log_.edges.push_back({v, edge_of(v)});
}

void Triangulation::log_insertion(Index v) {
  log_change(v, true);
  for (Index i = 0; i < cavity_.size; ++i) log_triangle(first_edge(cavity_.triangles[i]));
  for (Index i = 0; i < cavity_.size + 2; ++i) log_edge(cavity_.edge_origin[i]);
  log_triangle(free_slot_);
  log_triangle(mesh_.twin[free_slot_]);
}

void Triangulation::log_removal(Index v, const Hole& hole) {
  log_change(v, false);
  for (const Corner* c = hole.corners; c <= hole.last; ++c) {
    log_triangle(c->slot);
    log_edge(c->vertex);
  }
}

Index Triangulation::undo() {
  const Change change = log_.changes.back();
  for (std::size_t i = change.triangles; i < log_.triangles.size(); ++i) {
    const Triangle& old = log_.triangles[i];
    const bool is_free = old.origin[0] == old.origin[1];
    for (Index k = 0; k < 3; ++k) {
      mesh_.origin[old.slot + k] = old.origin[k];
      mesh_.twin[old.slot + k] = old.twin[k];
      if (!is_free) mesh_.twin[old.twin[k]] = old.slot + k;
    }
  }
  for (std::size_t i = change.edges; i < log_.edges.size(); ++i) {
    edge_of_[entry(log_.edges[i].vertex)] = log_.edges[i].edge;
  }
  log_.triangles.resize(change.triangles);
  log_.edges.resize(change.edges);
  log_.changes.pop_back();
  mesh_.place[change.vertex] = change.place;
  free_slot_ = change.free_slot;
  if (change.is_insertion) {
    free_vertices_.push_back(change.vertex);
  } else {
    free_vertices_.pop_back();
  }
  return change.vertex;
}

void Triangulation::forget_changes() {
  log_.triangles.clear();
  log_.edges.clear();
  log_.changes.clear();
}

bool Triangulation::remove(Index v, Index max_degree) {
  Hole hole;
  if (!open_hole(v, max_degree, hole)) return false;
  if (logs_) log_removal(v, hole);
  fill_hole(hole);
  edge_of_[entry(v)] = kNoEdge;
  free_vertices_.push_back(v);
  return true;
}

// Collects the corners around v. False if there are too many.
bool Triangulation::open_hole(Index v, Index max_corners, Hole& hole) const {
  Corner* corner = hole.corners;
  Corner* const most = corner + max_corners;
  Corner* infinite = nullptr;
  const Index start = edge_of(v);
  Index h = start;
  do {
    if (corner == most) return false;
    corner->slot = first_edge(triangle_of(h));
    const Index side = next_without_branch(h);
    const Index into = previous_without_branch(h);
    corner->outside = mesh_.twin[side];
    corner->vertex = mesh_.origin[side];
    if (corner->vertex == kInfinity) {
      infinite = corner;
    } else {
      const Point at = point_of(mesh_, corner->vertex);
      corner->x = at.x;
      corner->y = at.y;
    }
    h = mesh_.twin[into];
    ++corner;
  } while (h != start);
  if (infinite != nullptr) std::rotate(hole.corners, infinite + 1, corner);
  hole.last = corner - 1;
  return true;
}

// Cuts the hole into Delaunay triangles. Two slots are left over.
void Triangulation::fill_hole(const Hole& hole) {
  const Corner* freed = hole.corners;
  edge_of_[entry(hole.last->vertex)] = freed->slot;
  fill(hole.corners, hole.last, hole.last->outside, freed);
  new_triangles_.clear();
  for (const Corner* c = hole.corners; c != freed; ++c)
    new_triangles_.push_back(triangle_of(c->slot));
  for (; freed <= hole.last; ++freed) {
    mesh_.origin[freed->slot + 1] = mesh_.origin[freed->slot];
    mesh_.twin[freed->slot] = free_slot_;
    free_slot_ = freed->slot;
  }
}

// Fills the part of the hole from `first` to `last` that the half-edge `closing` closes; recursive,
// with at most as many levels as there are corners. The slots come from `freed` on.
void Triangulation::fill(const Corner* first, const Corner* last, Index closing,
                         const Corner*& freed) {
  if (last == first + 3 && last->vertex != kInfinity) {
    fill_quadrangle(first, closing, freed);
    return;
  }
  const Corner* const apex = apex_of(first, last);
  const Index h = (freed++)->slot;
  mesh_.origin[h] = last->vertex;
  mesh_.origin[h + 1] = first->vertex;
  mesh_.origin[h + 2] = apex->vertex;
  pair(mesh_, h, closing);
  close(first, apex, h + 1, freed);
  close(apex, last, h + 2, freed);
}

// Closes the side of a new triangle that a pocket lies beyond, or nothing.
inline void Triangulation::close(const Corner* first, const Corner* last, Index closing,
                                 const Corner*& freed) {
  if (last != first + 1) return fill(first, last, closing, freed);
  pair(mesh_, closing, first->outside);
  edge_of_[entry(first->vertex)] = closing;
}

// The most frequent part of all, without branches: its diagonal starts at corner s = 0 or 1.
// Half-edge h is the side that follows corner s, g the one two corners on.
void Triangulation::fill_quadrangle(const Corner* first, Index closing, const Corner*& freed) {
  const uint32_t s = finite_apex_of(first, first + 3) == first + 1 ? 1 : 0;
  const Index vertex[5] = {first[0].vertex, first[1].vertex, first[2].vertex, first[3].vertex,
                           first[0].vertex};
  const Index outside[4] = {first[0].outside, first[1].outside, first[2].outside, closing};
  const Index h = freed[0].slot, g = freed[1].slot;
  freed += 2;
  mesh_.origin[h] = mesh_.origin[g + 2] = vertex[s];
  mesh_.origin[h + 1] = vertex[s + 1];
  mesh_.origin[h + 2] = mesh_.origin[g] = vertex[s + 2];
  mesh_.origin[g + 1] = vertex[s + 3];
  pair(mesh_, h, outside[s]);
  pair(mesh_, h + 1, outside[s + 1]);
  pair(mesh_, g, outside[s + 2]);
  pair(mesh_, g + 1, outside[(s + 3) & 3]);
  pair(mesh_, h + 2, g + 2);
  edge_of_[entry(vertex[s])] = h;
  edge_of_[entry(vertex[s + 1])] = h + 1;
  edge_of_[entry(vertex[s + 2])] = g;
  edge_of_[entry(vertex[s + 3])] = g + 1;
}

// The corner that forms a Delaunay triangle with the pocket's closing side.
inline const Triangulation::Corner* Triangulation::apex_of(const Corner* first,
                                                           const Corner* last) {
  if (last == first + 2) return first + 1;
  if (last->vertex == kInfinity) return hull_apex_of(first, last);
  return finite_apex_of(first, last);
}

// The one of all corners to the left of last -> first whose circle through these two holds no
// other.
inline const Triangulation::Corner* Triangulation::finite_apex_of(const Corner* first,
                                                                  const Corner* last) {
  const Corner a = *last, b = *first;
  Angle best = {1, 0};  // no apex yet: the circle is the half-plane to the left
  std::ptrdiff_t apex = last - first;
  for (std::ptrdiff_t i = 1; first + i != last; ++i) {
    const Corner& p = first[i];
    const int64_t ax = a.x - p.x, ay = a.y - p.y, bx = b.x - p.x, by = b.y - p.y;
    const Angle angle = {ax * bx + ay * by, ax * by - ay * bx};
    const int64_t inside = incircle(best, angle);
    bool better = (angle.h > 0) & (inside > 0);
    if ((inside == 0) & (angle.h > 0)) {
      better = conflicts_with_triangle(place(a), place(b), place(first[apex]), place(p));
    }
    // Without a branch: nobody can predict which is better.
    const int64_t take = -static_cast<int64_t>(better);
    best.h ^= (best.h ^ angle.h) & take;
    best.q ^= (best.q ^ angle.q) & take;
    apex ^= (apex ^ i) & take;
  }
  return first + apex;
}

// The apex where the closing side comes from infinity: circles are half-planes, and all corners lie
// on one side of `first` along the hull.
const Triangulation::Corner* Triangulation::hull_apex_of(const Corner* first, const Corner* last) {
  const Corner* apex = first + 1;
  for (const Corner* p = apex + 1; p != last; ++p) {
    if (conflicts_with_ghost(place(*first), place(*apex), place(*p))) apex = p;
  }
  return apex;
}

}  // namespace microtin::stream
