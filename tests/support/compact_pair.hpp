// SPDX-License-Identifier: MIT
// A mesh and the compact terrain made of another one of the same stream, side by side.
#ifndef MICROTIN_TESTS_SUPPORT_COMPACT_PAIR_HPP
#define MICROTIN_TESTS_SUPPORT_COMPACT_PAIR_HPP

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include "microtin/compact.h"
#include "tests/support/layers.hpp"
#include "tests/support/limited_segment.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {

using VertexTuple = std::tuple<uint16_t, uint16_t, int16_t>;
using CornerTuples = std::pair<std::array<VertexTuple, 3>, int>;

// What a form of a mesh tells by numbers, in an order that does not depend on them.
struct Told {
  std::vector<VertexTuple> vertices;
  std::vector<CornerTuples> triangles;  // from the least corner on, infinity first; and the kind

  bool operator==(const Told& other) const {
    return vertices == other.vertices && triangles == other.triangles;
  }
};

template <class VertexCall, class TriangleCall>
Told told_by(uint32_t vertices, uint32_t triangles, VertexCall vertex, TriangleCall triangle) {
  Told told;
  for (uint32_t v = 0; v < vertices; ++v) {
    VertexTuple t;
    vertex(v, &std::get<0>(t), &std::get<1>(t), &std::get<2>(t));
    told.vertices.push_back(t);
  }
  for (uint32_t i = 0; i < triangles; ++i) {
    uint32_t v[3];
    const int kind = triangle(i, v);
    if (kind == MICROTIN_TRIANGLE_NO_AREA) continue;
    std::array<VertexTuple, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
      // Nothing is above infinity: a ghost's other two corners keep it apart from all else.
      corners[k] =
          v[k] == MICROTIN_VERTEX_AT_INFINITY ? VertexTuple{0, 0, 0} : told.vertices.at(v[k]);
    }
    const auto first = kind == MICROTIN_TRIANGLE_GHOST
                           ? std::find(v, v + 3, MICROTIN_VERTEX_AT_INFINITY) - v
                           : std::min_element(corners.begin(), corners.end()) - corners.begin();
    std::rotate(corners.begin(), corners.begin() + first, corners.end());
    told.triangles.emplace_back(corners, kind);
  }
  std::sort(told.vertices.begin(), told.vertices.end());
  std::sort(told.triangles.begin(), told.triangles.end());
  return told;
}

inline Told told_by(const microtin_mesh* m) {
  return told_by(
      microtin_mesh_vertex_count(m), microtin_mesh_triangle_count(m),
      [m](uint32_t v, uint16_t* x, uint16_t* y, int16_t* z) {
        microtin_mesh_vertex(m, v, x, y, z);
      },
      [m](uint32_t t, uint32_t* v) { return microtin_mesh_triangle(m, t, v); });
}

inline Told told_by(const microtin_compact* c) {
  return told_by(
      microtin_compact_vertex_count(c), microtin_compact_triangle_count(c),
      [c](uint32_t v, uint16_t* x, uint16_t* y, int16_t* z) {
        microtin_compact_vertex(c, v, x, y, z);
      },
      [c](uint32_t t, uint32_t* v) { return microtin_compact_triangle(c, t, v); });
}

inline bool is_same_axis(const microtin_axis& a, const microtin_axis& b) {
  return a.offset == b.offset && a.numerator == b.numerator && a.denominator == b.denominator;
}

inline bool have_same_placement(const microtin_mesh* mesh, const microtin_compact* compact) {
  microtin_axis a[3], b[3];
  microtin_mesh_axes(mesh, &a[0], &a[1], &a[2]);
  microtin_compact_axes(compact, &b[0], &b[1], &b[2]);
  return is_same_axis(a[0], b[0]) && is_same_axis(a[1], b[1]) && is_same_axis(a[2], b[2]);
}

struct FinePlace {
  int32_t x, y;
};

// At a vertex, between two vertices, a step next to the border of the box, or anywhere.
inline FinePlace place_near(const microtin_mesh* mesh, Random& random) {
  const auto vertex = [&] {
    uint16_t x = 0, y = 0;
    int16_t z = 0;
    microtin_mesh_vertex(mesh, random.below(microtin_mesh_vertex_count(mesh)), &x, &y, &z);
    return FinePlace{x * 256, y * 256};
  };
  const FinePlace p = vertex(), q = vertex();
  const int32_t part = static_cast<int32_t>(random.below(257));
  switch (random.below(6)) {
    case 0:
      return p;
    case 1: {  // on an edge
      uint32_t v[3];
      microtin_mesh_triangle(mesh, random.below(microtin_mesh_triangle_count(mesh)), v);
      if (v[0] == MICROTIN_VERTEX_AT_INFINITY || v[1] == MICROTIN_VERTEX_AT_INFINITY) return q;
      uint16_t x[2], y[2];
      int16_t z = 0;
      for (int i = 0; i < 2; ++i) microtin_mesh_vertex(mesh, v[i], &x[i], &y[i], &z);
      return {x[0] * (256 - part) + x[1] * part, y[0] * (256 - part) + y[1] * part};
    }
    case 2:
      return {p.x + part - 128, p.y + static_cast<int32_t>(random.below(3)) - 1};
    case 3:
      return {static_cast<int32_t>(random.below(65537 * 256)) - 256,
              static_cast<int32_t>(random.below(65537 * 256)) - 256};
    default:
      return {p.x + (q.x - p.x) / 256 * part, q.y + (p.y - q.y) / 256 * part};
  }
}

// A walk that stops after each few steps, and goes on.
inline microtin_query_result height_in_pieces(const microtin_compact* compact, FinePlace p,
                                              uint32_t piece, uint32_t* hint, int32_t* height) {
  microtin_query_result answer = MICROTIN_QUERY_STEP_LIMIT;
  const uint32_t most = microtin_compact_triangle_count(compact) / piece + 1;
  for (uint32_t i = 0; i <= most && answer == MICROTIN_QUERY_STEP_LIMIT; ++i) {
    answer = microtin_compact_height_at(compact, p.x, p.y, hint, height, piece);
  }
  return answer;
}

// The answers at this many places, from all kinds of hints; empty or what differs.
inline std::string difference_of_heights(const microtin_mesh* mesh, const microtin_compact* compact,
                                         int places, Random& random) {
  uint32_t hint = 0, mesh_hint = 0;
  for (int i = 0; i < places; ++i) {
    const FinePlace p = place_near(mesh, random);
    const uint32_t way = random.below(8);
    if (way == 0) hint = static_cast<uint32_t>(random.next());
    if (way == 1) hint = random.below(microtin_compact_triangle_count(compact));
    if (way == 2) hint = microtin_compact_hint(compact, p.x, p.y);
    int32_t expected = 1, height = 1;
    const microtin_query_result answer =
        microtin_mesh_height_at(mesh, p.x, p.y, &mesh_hint, &expected, 0, 0);
    const microtin_query_result other =
        way == 3 ? height_in_pieces(compact, p, 1 + random.below(3), &hint, &height)
                 : microtin_compact_height_at(compact, p.x, p.y, &hint, &height, 0);
    if (answer != other || expected != height) {
      return "at " + std::to_string(p.x) + " " + std::to_string(p.y) + ": " +
             std::to_string(expected) + " (" + std::to_string(answer) + "), compact " +
             std::to_string(height) + " (" + std::to_string(other) + ")";
    }
    const bool walked = p.x >= 0 && p.x <= 65535 * 256 && p.y >= 0 && p.y <= 65535 * 256;
    if (walked && hint >= microtin_compact_triangle_count(compact)) return "no number as hint";
  }
  return "";
}

// A segment between two such places, along one of the axes at times, or a place.
inline microtin_segment segment_near(const microtin_mesh* mesh, Random& random) {
  const FinePlace a = place_near(mesh, random), b = place_near(mesh, random);
  const uint32_t kind = random.below(8);
  return {a.x, a.y, kind == 0 || kind == 2 ? a.x : b.x, kind == 1 || kind == 2 ? a.y : b.y};
}

inline std::string difference_of_segments(const microtin_mesh* mesh,
                                          const microtin_compact* compact, int segments,
                                          Random& random) {
  for (int i = 0; i < segments; ++i) {
    const microtin_segment c = segment_near(mesh, random);
    const Extremes extremes = extremes_on(mesh, c);
    const uint32_t most = i % 2 == 0 ? 3 : 2 * microtin_mesh_triangle_count(mesh);
    if (!(extremes == extremes_on(compact, c)) ||
        !(extremes == extremes_in_pieces(mesh, c, most, random)) ||
        !(extremes == extremes_in_pieces(compact, c, most, random))) {
      return "on the segment " + std::to_string(c.x) + " " + std::to_string(c.y) + " to " +
             std::to_string(c.x_end) + " " + std::to_string(c.y_end);
    }
    const microtin_grid_spec block = {c.x,
                                      c.y,
                                      static_cast<int32_t>((c.x_end - c.x) / 4),
                                      static_cast<int32_t>((c.y_end - c.y) / 3),
                                      5,
                                      4,
                                      -9999};
    std::array<int16_t, 20> heights{}, others{};
    if (microtin_mesh_sample_grid(mesh, &block, heights.data()) !=
            microtin_compact_sample_grid(compact, &block, others.data()) ||
        heights != others) {
      return "in the block at " + std::to_string(c.x) + " " + std::to_string(c.y);
    }
  }
  return "";
}

inline std::string difference(const microtin_mesh* mesh, const microtin_compact* compact,
                              int places, Random& random) {
  if (microtin_compact_vertex_count(compact) != microtin_mesh_vertex_count(mesh))
    return "vertex count";
  if (microtin_compact_digest(compact) != microtin_mesh_digest(mesh)) return "digest";
  if (!have_same_placement(mesh, compact)) return "placement";
  if (!(told_by(mesh) == told_by(compact))) return "vertices and triangles by number";
  std::string of_heights = difference_of_heights(mesh, compact, places, random);
  if (!of_heights.empty()) return of_heights;
  return difference_of_segments(mesh, compact, places / 20, random);
}

}  // namespace microtin::tests

#endif
