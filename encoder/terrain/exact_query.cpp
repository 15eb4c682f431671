// SPDX-License-Identifier: MIT
// The decoder's own walk leads to the triangle at the nearest 1/256 of a lattice step; exact tests
// go on from there.
#include "encoder/terrain/exact_query.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>

namespace microtin::terrain {
namespace {

// A triangle as seen from a place.
class Seen {
 public:
  Seen(const microtin_mesh* mesh, uint32_t triangle, const RealPlace& place) : place_(place) {
    uint32_t v[3];
    kind = microtin_mesh_triangle(mesh, triangle, v);
    if (kind == MICROTIN_TRIANGLE_GHOST) return;
    for (uint32_t i = 0; i < 3; ++i) corner_[i] = vertex_of(mesh, v[i]);
    constexpr Wide kFew = Wide{1} << 27;  // so that sides have 64 bits
    for (uint32_t i = 0; i < 3; ++i) {
      const Vertex &a = corner_[i], &b = corner_[(i + 1) % 3];
      side[i] = place.parts < kFew ? side_of<int64_t>(a, b) : side_of<Wide>(a, b);
    }
  }

  bool holds_place() const {
    return kind != MICROTIN_TRIANGLE_GHOST && side[0] >= 0 && side[1] >= 0 && side[2] >= 0;
  }

  const std::array<Vertex, 3>& corners() const { return corner_; }

  microtin_triangle_kind kind;
  // Twice the area that the edge from corner i spans with the place, times its parts: below 0 if
  // the place lies beyond the edge. Within 2^34 * kMostParts; inside at most 2^32 * kMostParts.
  Wide side[3];

  // The height at a place in the closed triangle. On an edge the edge's ends alone count.
  ExactHeight height() const {
    for (uint32_t i = 0; i < 3; ++i) {
      if (side[i] == 0) return height_between(corner_[i], corner_[(i + 1) % 3]);
    }
    const Vertex& a = corner_[0];
    return {a.z, side[2] * (corner_[1].z - a.z) + side[0] * (corner_[2].z - a.z),
            side[0] + side[1] + side[2]};
  }

 private:
  template <class Number>
  Number side_of(const Vertex& a, const Vertex& b) const {
    const int64_t dx = int64_t{b.x} - a.x, dy = int64_t{b.y} - a.y;
    const int64_t whole = dx * (place_.y - a.y) - dy * (place_.x - a.x);
    return whole * static_cast<Number>(place_.parts) + dx * static_cast<Number>(place_.y_part) -
           dy * static_cast<Number>(place_.x_part);
  }

  // By the axis along which the edge is longer, from its lower end on.
  ExactHeight height_between(Vertex a, Vertex b) const {
    const bool along_x = std::abs(b.x - a.x) >= std::abs(b.y - a.y);
    if (along_x ? b.x < a.x : b.y < a.y) std::swap(a, b);
    const Wide on_the_way = along_x ? (place_.x - a.x) * place_.parts + place_.x_part
                                    : (place_.y - a.y) * place_.parts + place_.y_part;
    return {a.z, on_the_way * (b.z - a.z), (along_x ? b.x - a.x : b.y - a.y) * place_.parts};
  }

  const RealPlace& place_;
  std::array<Vertex, 3> corner_{};
};

// From a ghost to the triangle inside, whose neighbours are not all ghosts with it.
uint32_t inside_of(const microtin_mesh* mesh, uint32_t ghost) {
  uint32_t v[3];
  microtin_mesh_triangle(mesh, ghost, v);
  uint32_t edge = 0;
  while (v[edge] == MICROTIN_VERTEX_AT_INFINITY || v[(edge + 1) % 3] == MICROTIN_VERTEX_AT_INFINITY)
    ++edge;
  return microtin_mesh_neighbour(mesh, ghost, edge);
}

// A vertex always has its height; an edge has one if there is terrain on either side.
bool touches_terrain(const microtin_mesh* mesh, uint32_t triangle, const Seen& seen) {
  bool is_on_edge = false;
  for (uint32_t i = 0; i < 3; ++i) {
    if (seen.side[i] != 0) continue;
    uint32_t v[3];
    const uint32_t other = microtin_mesh_neighbour(mesh, triangle, i);
    if (is_on_edge || microtin_mesh_triangle(mesh, other, v) == MICROTIN_TRIANGLE_REAL) return true;
    is_on_edge = true;
  }
  return false;
}

int32_t nearest_256th(int64_t whole, Wide part, Wide parts) {
  const double fine = 256 * (static_cast<double>(part) / static_cast<double>(parts));
  const int64_t place = whole * 256 + std::llround(fine);
  return static_cast<int32_t>(std::clamp<int64_t>(place, 0, int64_t{kLatticeMax} * 256));
}

}  // namespace

// Neighbours are queried one after the other: the triangle of the last often is that of the next.
// Of edges beyond which the place lies any may be crossed: see decoder/walk.hpp.
ExactAnswer exact_answer(const microtin_mesh* mesh, const RealPlace& place, uint32_t step_limit,
                         uint32_t* hint) {
  if (*hint < microtin_mesh_triangle_count(mesh)) {
    const Seen seen(mesh, *hint, place);
    if (seen.kind == MICROTIN_TRIANGLE_REAL && seen.holds_place())
      return {MICROTIN_QUERY_OK, seen.height()};
  }
  int32_t rounded = 0;
  const microtin_query_result near = microtin_mesh_height_at(
      mesh, nearest_256th(place.x, place.x_part, place.parts),
      nearest_256th(place.y, place.y_part, place.parts), hint, &rounded, 0, step_limit);
  if (near != MICROTIN_QUERY_OK && near != MICROTIN_QUERY_OUTSIDE && near != MICROTIN_QUERY_VOID) {
    return {near, {0, 0, 1}};
  }
  uint32_t triangle = *hint;
  for (bool is_first = true;; is_first = false) {
    *hint = triangle;
    const Seen seen(mesh, triangle, place);
    if (seen.kind == MICROTIN_TRIANGLE_GHOST) {
      if (!is_first) return {MICROTIN_QUERY_OUTSIDE, {0, 0, 1}};
      triangle = inside_of(mesh, triangle);
      continue;
    }
    uint32_t beyond = 0;
    while (beyond < 3 && seen.side[beyond] >= 0) ++beyond;
    if (beyond < 3) {
      triangle = microtin_mesh_neighbour(mesh, triangle, beyond);
      continue;
    }
    if (seen.kind == MICROTIN_TRIANGLE_VOID && !touches_terrain(mesh, triangle, seen)) {
      return {MICROTIN_QUERY_VOID, {0, 0, 1}};
    }
    return {MICROTIN_QUERY_OK, seen.height()};
  }
}

std::vector<std::array<Vertex, 3>> triangles_at(const microtin_mesh* mesh, const RealPlace& place,
                                                uint32_t hint) {
  std::vector<std::array<Vertex, 3>> found;
  std::vector<uint32_t> next = {hint};
  std::set<uint32_t> met = {hint};
  while (!next.empty()) {
    const uint32_t triangle = next.back();
    next.pop_back();
    const Seen seen(mesh, triangle, place);
    if (!seen.holds_place()) continue;
    if (seen.kind == MICROTIN_TRIANGLE_REAL) found.push_back(seen.corners());
    for (uint32_t i = 0; i < 3; ++i) {
      if (seen.side[i] != 0) continue;
      const uint32_t other = microtin_mesh_neighbour(mesh, triangle, i);
      if (met.insert(other).second) next.push_back(other);
    }
  }
  return found;
}

}  // namespace microtin::terrain
