// SPDX-License-Identifier: MIT
// Queries on compact terrains.
#include "decoder/terrain_forms.hpp"
#include "decoder/walk.hpp"
#include "shared/digest.hpp"

namespace microtin {
namespace {

// Hints: vertices looked at along the whole path, and the distance along it where that ends.
constexpr uint32_t kSamples = 22;
constexpr uint32_t kFinest = 2;

// Steps of a walk after which it looks for a start that is nearer: this costs half as many.
constexpr uint32_t kFirstSteps = 24;

// In a triangle that is no ghost: that with a number, or one near it.
RingCursor start_at(const Ring& r, uint32_t number) {
  if (number >= triangle_count(r)) number = 0;
  RingCursor cursor = cursor_at(r, number);
  if (!cursor.may_stop()) cursor.to_right();
  if (cursor.is_ghost()) cursor.cross();
  return cursor;
}

// The position of a vertex, past repeats; and back.
uint32_t position_of(const microtin_compact* c, uint32_t v) {
  const Index* const repeat = repeats_in(c);
  uint32_t position = v + 1;
  for (uint32_t i = 0; i < repeats_of(*c) && repeat[i] <= position; ++i) ++position;
  return position;
}

uint32_t vertex_of(const microtin_compact* c, uint32_t position) {
  if (position == 0) return static_cast<uint32_t>(MICROTIN_VERTEX_AT_INFINITY);
  const Index* const repeat = repeats_in(c);
  uint32_t before = repeats_of(*c);
  // A repeat's slit has its last position and the one before for corners.
  while (before != 0 && repeat[before - 1] >= position) {
    --before;
    if (repeat[before] != position) continue;
    position = low_of(ring_of(c).left, position - 1);
  }
  return position - 1 - before;
}

Vertex on_lattice(const microtin_compact* c, Vertex v) {
  return Vertex{static_cast<uint16_t>(v.x + c->west), static_cast<uint16_t>(v.y + c->south), v.z};
}

// The number of the triangle at a position, to the left of the path.
uint32_t number_at(uint32_t position) {
  return 2 * position - kFirstNumber;
}

// The square of half of it: each part is below 2^30.1, as a narrow box may lie 2^16 steps from p.
uint32_t distance(Point at, int32_t x, int32_t y) {
  const int32_t dx = x - (at.x >> 1), dy = y - (at.y >> 1);
  return static_cast<uint32_t>(dx * dx) + static_cast<uint32_t>(dy * dy);
}

// A triangle at a position that is nearer to p than `best`, or at that.
uint32_t number_near(const Ring& r, FinePoint p, uint32_t best) {
  const int32_t x = p.x >> 9, y = p.y >> 9;
  const uint32_t end = r.positions - 1;
  uint32_t stride = end / kSamples + 1, step = stride, i = stride / 2 + 1, last = end;
  uint32_t least = distance(place_of(r, best), x, y);
  for (;;) {
    for (; i < last; i += step) {
      const uint32_t far = distance(place_of(r, i), x, y);
      if (far < least) {
        least = far;
        best = i;
      }
    }
    // Half as far, to both sides of the nearest.
    stride /= 2;
    if (stride < kFinest) return number_at(best);
    i = best > stride ? best - stride : 1;
    last = best + stride < end ? best + stride + 1 : end;
    step = 2 * stride;
  }
}

FinePoint seen_from_box(const microtin_compact* c, int32_t x, int32_t y) {
  const FinePoint corner = fine(Point{c->west, c->south});
  return FinePoint{x - corner.x, y - corner.y};
}

// Differences from the box are below 2^16 steps then, which distance() needs to stay in 32 bits.
int32_t nearest_on_lattice(int32_t place) {
  const int32_t most = int32_t{kLatticeMax} * 256;
  return place < 0 ? 0 : place > most ? most : place;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

size_t microtin_compact_size(const microtin_compact* compact) {
  return sizeof(microtin_compact) + body_bytes(*compact);
}

uint32_t microtin_compact_vertex_count(const microtin_compact* compact) {
  return compact->vertices;
}

void microtin_compact_vertex(const microtin_compact* compact, uint32_t v, uint16_t* x, uint16_t* y,
                             int16_t* z) {
  const Ring r = ring_of(compact);
  const uint32_t i = position_of(compact, v);
  const Point at = place_of(r, i);
  const Vertex vertex = on_lattice(compact, Vertex{at.x, at.y, r.vertex[i].z});
  *x = vertex.x;
  *y = vertex.y;
  *z = vertex.z;
}

uint32_t microtin_compact_triangle_count(const microtin_compact* compact) {
  return triangle_count(ring_of(compact));
}

microtin_triangle_kind microtin_compact_triangle(const microtin_compact* compact, uint32_t t,
                                                 uint32_t v[3]) {
  const Ring r = ring_of(compact);
  const RingCursor cursor = cursor_at(r, t);
  v[0] = vertex_of(compact, cursor.start());
  v[1] = vertex_of(compact, cursor.end());
  v[2] = vertex_of(compact, cursor.apex());
  if (v[0] == v[1] || v[0] == v[2] || v[1] == v[2]) return MICROTIN_TRIANGLE_NO_AREA;
  if (cursor.is_ghost()) return MICROTIN_TRIANGLE_GHOST;
  return cursor.has_terrain() ? MICROTIN_TRIANGLE_REAL : MICROTIN_TRIANGLE_VOID;
}

uint64_t microtin_compact_digest(const microtin_compact* compact) {
  const Ring r = ring_of(compact);
  uint64_t sum = 0;
  for (uint32_t t = 0; t < triangle_count(r); ++t) {
    const RingCursor cursor = cursor_at(r, t);
    if (cursor.is_ghost() || !cursor.may_stop()) continue;
    Vertex corner[3];
    for (uint32_t i = 0; i < 3; ++i) {
      corner[i] = on_lattice(compact, cursor.vertex(cursor.corner(i)));
    }
    sum += triangle_digest(corner, !cursor.has_terrain());
  }
  return sum;
}

void microtin_compact_axes(const microtin_compact* compact, microtin_axis* x, microtin_axis* y,
                           microtin_axis* z) {
  *x = compact->axis[0];
  *y = compact->axis[1];
  *z = compact->axis[2];
}

microtin_query_result microtin_compact_height_at(const microtin_compact* compact, int32_t x,
                                                 int32_t y, uint32_t* hint, int32_t* height,
                                                 uint32_t step_limit) {
  if (!is_on_lattice(x, y)) return MICROTIN_QUERY_OUTSIDE;
  const Ring r = ring_of(compact);
  const FinePoint p = seen_from_box(compact, x, y);
  uint32_t number = *hint, limit = step_limit == 0 ? kFirstSteps : step_limit;
  for (;;) {  // twice at most
    RingCursor cursor = start_at(r, number);
    const bool arrived = walk_in_place(cursor, p, limit);
    *hint = number_of(cursor);
    if (arrived) return cursor.is_ghost() ? MICROTIN_QUERY_OUTSIDE : result_at(cursor, p, height);
    if (step_limit != 0) return MICROTIN_QUERY_STEP_LIMIT;
    // Where nothing is nearer than the hub that it turns around, it had better turn on.
    const uint32_t hub = cursor.end(), near = number_near(r, p, hub);
    number = near == number_at(hub) ? *hint : near;
    step_limit = limit = triangle_count(r);
  }
}

microtin_query_result microtin_compact_safe_heights_at(const microtin_compact* compact, int32_t x,
                                                       int32_t y, uint32_t* hint,
                                                       microtin_safe_heights* heights,
                                                       uint32_t step_limit) {
  int32_t height = 0;
  const microtin_query_result found =
      microtin_compact_height_at(compact, x, y, hint, &height, step_limit);
  return found == MICROTIN_QUERY_OK ? widen(height, compact->below, compact->above, heights)
                                    : found;
}

void microtin_compact_margins(const microtin_compact* compact, uint32_t* below, uint32_t* above) {
  *below = compact->below;
  *above = compact->above;
}

uint32_t microtin_compact_hint(const microtin_compact* compact, int32_t x, int32_t y) {
  const FinePoint p = seen_from_box(compact, nearest_on_lattice(x), nearest_on_lattice(y));
  return number_near(ring_of(compact), p, 1);
}
