// SPDX-License-Identifier: MIT
// The half-edge mesh: three half-edges per triangle in a row, ghost triangles around the hull.
//
// Half-edge h runs from origin[h] to the origin of next_in_triangle(h); triangles turn
// counter-clockwise. Ghost triangles join each hull edge to the vertex at infinity, so the mesh is
// a sphere: n vertices give exactly 2n - 2 triangles and every half-edge has a twin.
#ifndef MICROTIN_SHARED_MESH_HPP
#define MICROTIN_SHARED_MESH_HPP

#include <stddef.h>

#include "microtin/config.h"
#include "shared/fixed_math.hpp"
#include "shared/lattice.hpp"
#include "shared/predicates.hpp"
#include "shared/tables.hpp"

namespace microtin {

#if MICROTIN_INDEX_BITS == 16
typedef uint16_t Index;
#else
typedef uint32_t Index;
#endif

// The vertex at infinity. No vertex has this number: the largest half-edge number stays below it.
constexpr Index kInfinity = static_cast<Index>(~static_cast<Index>(0));

// Whether one of three vertices is at infinity: the highest bit tells, since there are six times as
// many half-edges as vertices.
inline bool is_ghost(Index a, Index b, Index c) {
  return ((static_cast<uint32_t>(a) | b | c) >> (MICROTIN_INDEX_BITS - 1)) != 0;
}

// Views of arrays that somebody else owns.
struct Mesh {
  Point* place;     // vertices
  int16_t* z;       // vertices
  Index* origin;    // 3 * triangles
  Index* twin;      // 3 * triangles
  Index vertices;   // n
  Index triangles;  // 2n - 2, ghosts included
};

// floor(h / 3) by one multiplication; exact for every Index value (no divide on the smallest
// cores).
inline Index triangle_of(Index h) {
#if MICROTIN_INDEX_BITS == 16
  return static_cast<Index>((static_cast<uint32_t>(h) * 43691u) >> 17);
#else
  return static_cast<Index>((static_cast<uint64_t>(h) * 2863311531u) >> 33);
#endif
}

inline Index first_edge(Index triangle) {
  return static_cast<Index>(3u * triangle);
}

// Whether h is a multiple of 3: of all numbers these times the inverse of 3 are the smallest.
inline bool is_first_edge(Index h) {
  constexpr uint32_t kThird = 0xFFFFFFFFu / 3, kInverse = 2 * kThird + 1;
  return static_cast<uint32_t>(static_cast<uint64_t>(h) * kInverse) <= kThird;  // modulo 2^32
}

MICROTIN_ONE_COPY inline Index next_in_triangle(Index h) {
  const Index next = static_cast<Index>(h + 1u);
  return is_first_edge(next) ? static_cast<Index>(h - 2u) : next;
}

inline Index previous_in_triangle(Index h) {
  return static_cast<Index>(is_first_edge(h) ? h + 2u : h - 1u);
}

MICROTIN_IN_PLACE inline Point point_of(const Mesh& mesh, Index v) {
  return mesh.place[v];
}

MICROTIN_ONE_COPY inline bool is_ghost(const Mesh& mesh, Index triangle) {
  const Index f = first_edge(triangle);
  return is_ghost(mesh.origin[f], mesh.origin[f + 1u], mesh.origin[f + 2u]);
}

// Makes a and b each other's twins.
MICROTIN_IN_PLACE inline void pair(Mesh& mesh, size_t a, size_t b) {
  mesh.twin[a] = static_cast<Index>(b);
  mesh.twin[b] = static_cast<Index>(a);
}

// in_conflict for the rare cases: a ghost, or p on the circle.
MICROTIN_OUT_OF_LINE inline bool in_rare_conflict(const Mesh& mesh, Index a, Index b, Index c,
                                                  Point p) {
  // Infinity, or the largest, comes last: after two turns at most.
  while (c != kInfinity && (is_ghost(a, b, b) || point_of(mesh, c) < point_of(mesh, a) ||
                            point_of(mesh, c) < point_of(mesh, b))) {
    turn(a, b, c);
  }
  const Angle angle = angle_at(p, point_of(mesh, a), point_of(mesh, b));
  return c == kInfinity ? conflicts_with_ghost(angle)
                        : conflicts_on_circle(angle, point_of(mesh, c), p);
}

#if defined(MICROTIN_NARROW_MACHINE) && !(defined(__AVR__) && defined(__OPTIMIZE_SIZE__))

typedef int32_t Sign;  // a number that has the right one

MICROTIN_OUT_OF_LINE inline Sign sign_of_incircle(Offset a, Offset b, Offset c) {
  const int64_t d = incircle(angle_between(a - c, b - c), angle_between(a, b));
  return d > 0 ? 1 : d < 0 ? -1 : 0;
}

inline Sign sign_of_conflict(const Mesh& mesh, Index a, Index b, Index c, Point p) {
  const Offset to_a = point_of(mesh, a) - p, to_b = point_of(mesh, b) - p;
  const Offset to_c = point_of(mesh, c) - p;
  return are_near(to_a, to_b, to_c) ? near_incircle(to_a, to_b, to_c)
                                    : sign_of_incircle(to_a, to_b, to_c);
}

#else

typedef int64_t Sign;

inline Sign sign_of_conflict(const Mesh& mesh, Index a, Index b, Index c, Point p) {
  const Offset from = point_of(mesh, a) - p, to = point_of(mesh, b) - p;
  const Angle near = angle_between(from, to);
  const Offset far = point_of(mesh, c) - p;
  return incircle(angle_between(from - far, to - far), near);
}

#endif

// Whether p conflicts with the counter-clockwise triangle (a, b, c). A corner of it does not.
inline bool in_conflict(const Mesh& mesh, Index a, Index b, Index c, Point p) {
  const Sign d = is_ghost(a, b, c) ? 0 : sign_of_conflict(mesh, a, b, c, p);
  return d != 0 ? d > 0 : in_rare_conflict(mesh, a, b, c, p);
}

// Origins, each plus 1, and twins of the first half-edges: a counter-clockwise triangle (0, 1, 2),
// then its three ghosts. Origin 0 is infinity, the vertex -1.
constexpr uint8_t kStartOrigins[12] MICROTIN_IN_FLASH = {1, 2, 3, 2, 1, 0, 3, 2, 0, 1, 3, 0};
constexpr uint8_t kStartTwins[12] MICROTIN_IN_FLASH = {3, 6, 9, 0, 11, 7, 1, 5, 10, 2, 8, 4};

// The mesh of one counter-clockwise triangle (0, 1, 2) and its three ghosts.
inline void start_mesh(Mesh& mesh) {
  mesh.vertices = 3;
  mesh.triangles = 4;
  for (uint32_t i = 0; i < sizeof kStartOrigins; ++i) {
    mesh.origin[i] = static_cast<Index>(read_table(kStartOrigins + i) - 1);
    mesh.twin[i] = read_table(kStartTwins + i);
  }
}

}  // namespace microtin

#endif
