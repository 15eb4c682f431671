// SPDX-License-Identifier: MIT
// Queries on a decoded mesh.
#include "decoder/state.hpp"
#include "decoder/walk.hpp"
#include "shared/digest.hpp"
#include "shared/division.hpp"
#include "shared/header.hpp"

namespace microtin {
namespace {

uint32_t public_vertex(Index v) {
  return v == kInfinity ? static_cast<uint32_t>(MICROTIN_INFINITY) : v;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

uint32_t microtin_vertex_count(const microtin_mesh* mesh) {
  return mesh->mesh.vertices;
}

void microtin_vertex(const microtin_mesh* mesh, uint32_t v, uint16_t* x, uint16_t* y, int16_t* z) {
  const Point at = mesh->mesh.place[v];
  *x = at.x;
  *y = at.y;
  *z = mesh->mesh.z[v];
}

uint32_t microtin_triangle_count(const microtin_mesh* mesh) {
  return mesh->mesh.triangles;
}

microtin_triangle_kind microtin_triangle(const microtin_mesh* mesh, uint32_t t, uint32_t v[3]) {
  const Index f = first_edge(static_cast<Index>(t));
  for (uint32_t i = 0; i < 3; ++i) v[i] = public_vertex(mesh->mesh.origin[f + i]);
  if (is_ghost(mesh->mesh, static_cast<Index>(t))) return MICROTIN_GHOST;
  return has_terrain(*mesh, static_cast<Index>(t)) ? MICROTIN_REAL : MICROTIN_VOID;
}

uint32_t microtin_neighbour(const microtin_mesh* mesh, uint32_t t, uint32_t corner) {
  const Index f = first_edge(static_cast<Index>(t));
  return triangle_of(mesh->mesh.twin[static_cast<Index>(f + corner)]);
}

uint64_t microtin_digest(const microtin_mesh* mesh) {
  uint64_t sum = 0;
  for (Index t = 0; t < mesh->mesh.triangles; ++t) {
    if (is_ghost(mesh->mesh, t)) continue;
    const MeshCursor cursor(*mesh, first_edge(t));
    Vertex corner[3];
    for (uint32_t i = 0; i < 3; ++i) corner[i] = cursor.vertex(cursor.corner(i));
    sum += triangle_digest(corner, !has_terrain(*mesh, t));
  }
  return sum;
}

microtin_answer microtin_height_at(const microtin_mesh* mesh, int32_t x, int32_t y, uint32_t flags,
                                   uint32_t* hint, int32_t* height) {
  return microtin_height_at_limited(mesh, x, y, flags, 0, hint, height);
}

microtin_answer microtin_height_at_limited(const microtin_mesh* mesh, int32_t x, int32_t y,
                                           uint32_t flags, uint32_t step_limit, uint32_t* hint,
                                           int32_t* height) {
  const Mesh& m = mesh->mesh;
  if (m.triangles == 0) return MICROTIN_NOT_DECODED;
  if (mesh->verified_vertices != m.vertices && (flags & MICROTIN_ANSWER_UNVERIFIED) == 0) {
    return MICROTIN_NOT_VERIFIED;
  }
  const int32_t most = static_cast<int32_t>(kLatticeMax) * 256;
  if (x < 0 || x > most || y < 0 || y > most) return MICROTIN_OUTSIDE;
  const FinePoint p = {x, y};
  Index t = *hint < m.triangles ? static_cast<Index>(*hint) : static_cast<Index>(0);
  const bool arrived = walk_to(*mesh, p, step_limit == 0 ? m.triangles : step_limit, &t);
  *hint = t;
  if (!arrived) return MICROTIN_NOT_YET;
  if (is_ghost(m, t)) return MICROTIN_OUTSIDE;
  return answer_at(MeshCursor(*mesh, first_edge(t)), p, height);
}

void microtin_placement(const microtin_mesh* mesh, microtin_axis* x, microtin_axis* y,
                        microtin_axis* z) {
  microtin_axis axis[3];
  place_on_lattice(axis);
  const microtin_axis* const known = mesh->is_placed ? mesh->axis : axis;
  *x = known[0];
  *y = known[1];
  *z = known[2];
}

int microtin_to_lattice(const microtin_axis* axis, int64_t value, uint32_t per_unit,
                        int32_t* lattice) {
  if (per_unit == 0 || per_unit > (1ul << 24)) return 0;
  const uint64_t denominator = axis->denominator, numerator = axis->numerator;  // < 2^40
  // lattice = (value / per_unit * denominator - offset) / numerator. Split into whole units, the
  // most that are not above, and rest.
  const bool negative = value < 0;
  const Quotient units =
      divide(negative ? ~static_cast<uint64_t>(value) : static_cast<uint64_t>(value), per_unit);
  const uint64_t whole = negative ? units.whole + 1 : units.whole;  // the size of it
  const uint64_t rest = negative ? per_unit - 1u - units.rest : units.rest;
  // Places outside are refused before anything can overflow: those inside are within 65537
  // numerators of the offset, so whole * denominator < 2^61 + 2^57.
  const int64_t limit = static_cast<int64_t>(1) << 61;
  if (highest_bit(whole | 1u) + highest_bit(denominator) > 62) return 0;
  const uint64_t product = whole * denominator;  // < 2^64
  if (product > 2 * static_cast<uint64_t>(limit)) return 0;
  if (axis->offset >= limit || axis->offset <= -limit) return 0;
  const int64_t ahead =
      (negative ? -static_cast<int64_t>(product) : static_cast<int64_t>(product)) - axis->offset;
  const Quotient part = divide(rest * denominator, per_unit);               // < 2^64; < 2^40
  const int64_t one = static_cast<int64_t>(numerator), most = 65536 * one;  // < 2^56
  if (ahead > most || ahead < -static_cast<int64_t>(denominator) - one) return 0;
  const int64_t steps =
      ahead + static_cast<int64_t>(part.whole);  // numerator-ths of a lattice step
  // Round (steps + part.rest / per_unit) * 256 / numerator to nearest, halves up.
  int64_t base = -1, over = steps + one;  // 0 <= over < numerator, or it is outside
  if (steps >= 0) {
    const Quotient places = divide(static_cast<uint64_t>(steps), numerator);
    base = static_cast<int64_t>(places.whole);
    over = static_cast<int64_t>(places.rest);
  }
  if (over < 0) return 0;
  const uint64_t fine_numerator =
      static_cast<uint64_t>(over) * 512u + divide(part.rest * 512u, per_unit).whole;  // < 2^50
  const int64_t twice = static_cast<int64_t>(divide(fine_numerator, numerator).whole);
  const int64_t result = base * 256 + (twice + 1) / 2;
  if (result < 0 || result > static_cast<int64_t>(kLatticeMax) * 256) return 0;
  *lattice = static_cast<int32_t>(result);
  return 1;
}
