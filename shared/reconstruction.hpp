// SPDX-License-Identifier: MIT
// The reconstruction, once for both sides: a breadth-first walk that rebuilds the Delaunay
// triangulation point by point (Sohler, "Fast Reconstruction of Delaunay Triangulations", CCCG
// 1999).
//
// It is a template over the coder. With a reading coder it decodes; with a writing coder, which
// knows the next point, it encodes. A coder supplies, in addition to bit() and uniform()
// (probability.hpp):
//   next()        the vertex to be inserted next
//   last_phase(), batch()   how many vertices the phase adds
//   conflicts(mesh, h)      whether that vertex is in conflict with the triangle of half-edge h
//   is_void(mesh, t)        whether triangle t is void
// A reading coder may return anything from these: what the stream says replaces it.
#ifndef MICROTIN_SHARED_RECONSTRUCTION_HPP
#define MICROTIN_SHARED_RECONSTRUCTION_HPP

#include "shared/format.hpp"
#include "shared/height_coding.hpp"
#include "shared/insertion.hpp"
#include "shared/marks.hpp"
#include "shared/models.hpp"
#include "shared/place_coding.hpp"

namespace microtin {

enum class Stage : uint8_t { kSeed, kPhase, kWalk, kVoids, kComplete };

enum class StepOutcome : uint8_t {
  kStep,        // one step done, more to do in this section
  kPhaseEnd,    // the same, and it completed a phase
  kSectionEnd,  // one step done, and it completed a phase and the section
  kMalformed
};

// Small numbers come first, where short instructions reach them.
struct Reconstruction {
  Contract contract;

  Stage stage;
  uint8_t from;      // marks of the vertex that the chord comes from
  Index vertex;      // being walked around
  Index chord;       // half-edge into `vertex`, of the triangle to be looked at next
  Index turn_start;  // the neighbour where the turn around `vertex` began
  Index anchor;      // the half-edge from vertex 0 to infinity
  Index queue_head;
  Index queue_tail;
  Index phase_end;  // vertices when the phase is complete
  Index void_cursor;

  Mesh* mesh;
  uint8_t* voids;      // a bit per triangle
  Index* queue;        // half-edges parent -> vertex, one per vertex
  uint8_t* marks;      // mark_bytes() of them: queued, done
  Residual* residual;  // per vertex, see height_coding.hpp
  Cavity cavity;

  uint32_t phase;   // phases complete
  uint32_t work;    // vertices walked around so far, all phases together
  Log2 share;       // for note_final_triangle
  int32_t density;  // log2 of this batch's points per unit area, 16 fractional bits

  PlaceHabits habits;
  // Data of the triangle in hand: here to spare the stack.
  FreeRegion region;
  Place place;

  Index cavity_triangles[kMaxDegree];
  Index cavity_origin[kMaxDegree];
  Index cavity_twin[kMaxDegree];

  Models models;
};

// All but the contract, which is known.
inline void start(Reconstruction& r) {
  r.stage = Stage::kSeed;
  r.phase = 0;
  r.work = 0;
  r.void_cursor = 0;
  r.cavity.triangles = r.cavity_triangles;
  r.cavity.edge_origin = r.cavity_origin;
  r.cavity.edge_twin = r.cavity_twin;
  r.cavity.limit = static_cast<Index>(r.contract.degree - 2);
  r.mesh->vertices = 0;
  r.mesh->triangles = 0;
  reset(r.models);
  reset(r.habits);
}

// --- The triangle in hand ------------------------------------------------------------------------

// The far corner of the triangle of the chord.
struct Corner {
  Index into;    // half-edge from it into `vertex`, of the next triangle
  Index number;  // of the corner
  uint32_t marks;
};

inline Corner far_corner(const Reconstruction& r) {
  const Index into = r.mesh->twin[next_in_triangle(r.chord)];
  const Index number = r.mesh->origin[into];
  return Corner{into, number, marks_of(r.marks, number)};
}

// The corner opposite to a side whose half-edge beyond is h.
inline Index apex_behind(const Mesh& mesh, Index h) {
  return mesh.origin[previous_in_triangle(h)];
}

inline void look_at(const Reconstruction& r, Index apex, Side& side) {
  side.certified = true;
  side.ghost = apex == kInfinity;
  if (!side.ghost) side.apex = point_of(*r.mesh, apex);
}

// Describes the free region of the real triangle (v, c, a) whose half-edge a -> v is the chord.
// What is behind that was passed in this turn, or has a done vertex.
MICROTIN_IN_PLACE inline void look_around(Reconstruction& r, Index into) {
  FreeRegion& region = r.region;
  const Mesh& mesh = *r.mesh;
  see_corners(region, point_of(mesh, r.vertex), point_of(mesh, mesh.origin[into]),
              point_of(mesh, mesh.origin[r.chord]));
  const Index next = apex_behind(mesh, into);
  region.next.certified = is_done(r.marks, next);
  if (region.next.certified) look_at(r, next, region.next);
  const Index across = mesh.twin[previous_in_triangle(r.chord)];
  region.opposite_certified = is_done(r.marks, apex_behind(mesh, across));
  look_at(r, apex_behind(mesh, mesh.twin[r.chord]), region.chord);
}

// log2 of the mean area of a Delaunay triangle of random points less the mean log2 of it.
constexpr Log2 kMeanOfLogs = 220;

// Twice the area of the origin, a, b, counter-clockwise, if each sees the others on the lattice:
// below 2^32.
inline uint32_t twice_area(Spot a, Spot b) {
  return wrapping_product32(a.x, b.y) - wrapping_product32(a.y, b.x);
}

// Takes a final triangle into the running mean of what such suggest about the density: of n final
// vertices each has two triangles to itself, and of these vertices `share` are the batch's.
// Logarithms are below 2^14: the difference stays below 2^23.
inline void note_final_triangle(Reconstruction& r, Log2 twice_area) {
  const Log2 density = r.share - twice_area;
  r.density += (density * 256 - r.density) >> 4;
}

// --- Insertion -----------------------------------------------------------------------------------

// Inserts a vertex at `place`, decoded relative to the triangle of the chord, with the height that
// the stream says. The chord becomes the half-edge from the new vertex. False if that is not legal.
template <class Coder>
bool insert(Reconstruction& r, Coder& coder, Point place) {
  Mesh& mesh = *r.mesh;
  const Index chord = r.chord;
  if (!(point_of(mesh, 0) < place)) return false;
  // Final triangles must stay. Those with a done vertex are met through that vertex, since the
  // chord's has none. Those passed in this turn can only be reached across the chord: around
  // infinity the first of them is at vertex 0, which is the smallest and so stays on the hull.
  const auto forbids = [&r](Index corner) { return is_done(r.marks, corner); };
  if (!grow_cavity(mesh, chord, place, r.cavity, forbids)) return false;
  if (r.cavity.size == 0 || r.cavity_twin[0] != mesh.twin[chord]) return false;
  const Index v = mesh.vertices;
  int16_t z = 0;
  if (r.contract.has_heights) {
    // The ring begins with the chord's start, which is finite, since triangles at infinity are
    // looked at around infinity only.
    const HeightPrediction prediction = predict_height(
        mesh, r.residual, r.cavity_origin, static_cast<uint32_t>(r.cavity.size) + 2u, place);
    z = coder.next().z;
    if (!code_height(coder, r.models.height, prediction, &z)) return false;
    r.residual[v] = residual_of(z - prediction.height);
  }
  mesh.place[v] = place;
  mesh.z[v] = z;
  const Index first = fan_cavity(mesh, r.cavity, v);
  if (chord == r.anchor) r.anchor = first;
  ++mesh.vertices;
  r.chord = mesh.twin[first + 1u];
  return true;
}

// --- Coding of one decision ----------------------------------------------------------------------

// The hull edge next to the chord to infinity.
inline HullEdge hull_edge(const Reconstruction& r) {
  const Mesh& mesh = *r.mesh;
  return hull_edge(r.contract, point_of(mesh, mesh.origin[r.chord]),
                   point_of(mesh, mesh.origin[previous_in_triangle(r.chord)]));
}

// Where a hit is. It takes the place of c.
template <class Coder>
MICROTIN_IN_PLACE inline Point locate(Reconstruction& r, Coder& coder, Log2 density) {
  FreeRegion& region = r.region;
  const Offset found =
      code_place(coder, r.models.place, region, r.contract, density, r.place, r.habits);
  region.corner[0] = spot_of(found);
  return Point{static_cast<uint16_t>(region.origin.x + found.x),
               static_cast<uint16_t>(region.origin.y + found.y)};
}

// Says hit or miss at the uncertified triangle of the chord to infinity; the place of a hit.
template <class Coder>
bool find_at_hull(Reconstruction& r, Coder& coder, Point* place) {
  const Log2 density = r.density >> 8;
  const HullEdge edge = hull_edge(r);
  if (edge.length == 1) return false;  // there is no place beyond it
  if (!code_hit(coder, r.models.hit, estimate_hull_hit(edge, density),
                coder.conflicts(*r.mesh, r.chord))) {
    return false;
  }
  *place = code_hull_place(coder, r.models.gap, r.models.height.mantissa, r.habits.parities,
                           r.contract, edge, density);
  return true;
}

// Says hit or miss at an uncertified real triangle; the place of a hit. `marks` are those of the
// corner where `into` starts.
template <class Coder>
bool find_inside(Reconstruction& r, Coder& coder, Index into, uint32_t marks, Point* place) {
  const Log2 density = r.density >> 8;
  look_around(r, into);
  HitEstimate estimate = estimate_hit(r.region, density);
  if ((marks & kQueued) == 0) estimate_newcomer(*r.mesh, into, r.contract.degree, estimate);
  if (!code_hit(coder, r.models.hit, estimate, coder.conflicts(*r.mesh, r.chord))) return false;
  *place = locate(r, coder, density);
  return true;
}

enum class Decision : uint8_t { kMiss, kHit, kMalformed };

// Says hit or miss at an uncertified triangle, and inserts the vertex of a hit.
template <class Coder>
MICROTIN_IN_PLACE inline Decision decide(Reconstruction& r, Coder& coder, const Corner& corner) {
  const bool at_hull = r.vertex == kInfinity;
  Point place = {0, 0};
  const bool hit = at_hull ? find_at_hull(r, coder, &place)
                           : find_inside(r, coder, corner.into, corner.marks, &place);
  if (hit && !insert(r, coder, place)) return Decision::kMalformed;
  if (!at_hull) {
    // The triangle of the chord and c, or the new vertex, is final.
    note_final_triangle(r, rough_log2(twice_area(r.region.corner[0], r.region.corner[1])));
  }
  return hit ? Decision::kHit : Decision::kMiss;
}

// --- Steps ---------------------------------------------------------------------------------------

// What follows when all vertices of a phase, or of the seed, are in place.
inline StepOutcome after_vertices(Reconstruction& r) {
  if (r.mesh->vertices != r.contract.vertices) {
    r.stage = Stage::kPhase;
    const bool together = r.mesh->vertices < kSectionVertices;
    return together ? StepOutcome::kPhaseEnd : StepOutcome::kSectionEnd;
  }
  const bool voids_follow = kBuiltVoids && r.contract.has_voids;
  r.stage = voids_follow ? Stage::kVoids : Stage::kComplete;
  return voids_follow ? StepOutcome::kPhaseEnd : StepOutcome::kSectionEnd;
}

// One of the three vertices that are never removed. The first is the lexicographically smallest of
// all.
template <class Coder>
StepOutcome step_seed(Reconstruction& r, Coder& coder) {
  Mesh& mesh = *r.mesh;
  const Index i = mesh.vertices;
  const Vertex known = coder.next();
  mesh.place[i].x = code_outer_coordinate(coder, r.contract.x_max, known.x);
  mesh.place[i].y = code_outer_coordinate(coder, r.contract.y_max, known.y);
  mesh.z[i] = 0;
  r.residual[i] = 4;
  if (r.contract.has_heights) {
    const HeightPrediction previous = {i == 0 ? 0 : mesh.z[i - 1u], kScales - 1, kTendencies / 2};
    mesh.z[i] = known.z;
    if (!code_height(coder, r.models.height, previous, &mesh.z[i])) return StepOutcome::kMalformed;
  }
  if (i < 2) {
    ++mesh.vertices;
    return StepOutcome::kStep;
  }
  const Point p0 = point_of(mesh, 0), p1 = point_of(mesh, 1), p2 = point_of(mesh, 2);
  if (!(p0 < p1) || !(p0 < p2) || orient2d(p0, p1, p2) <= 0) return StepOutcome::kMalformed;
  start_mesh(mesh);
  r.anchor = 4;
  return after_vertices(r);
}

// Starts a phase: how many vertices it adds, and the walk from infinity.
template <class Coder>
StepOutcome step_phase(Reconstruction& r, Coder& coder) {
  const uint32_t placed = r.mesh->vertices;
  const uint32_t left = r.contract.vertices - placed;
  uint32_t batch = left;
  if (coder.bit(kProbabilityOne / 2, !coder.last_phase())) {
    // All but the low 16 bits, then these: 1 .. left - 1.
    const uint32_t high = coder.uniform((left >> 16) + 1u, coder.batch() >> 16);
    batch = high << 16 | coder.uniform(left < 65536 ? left : 65536, coder.batch() & 65535u);
    if (batch == 0 || batch >= left) return StepOutcome::kMalformed;
  }
  r.phase_end = static_cast<Index>(placed + batch);
  r.work += placed + batch;
  if (r.work > work_budget(placed + batch)) return StepOutcome::kMalformed;
  uint8_t* const marks = r.marks;
  for (uint32_t i = mark_bytes(placed + batch); i != 0; --i) marks[i - 1] = 0;
  r.vertex = kInfinity;
  r.turn_start = 0;
  mark(r.marks, 0, kQueued);
  r.queue_head = 0;
  r.queue_tail = 1;  // entry 0 is vertex 0's, known when the turn around infinity ends
  r.chord = r.anchor;
  r.from = kQueued;
  const Log2 log_batch = log2_of(batch);
  r.share = log_batch - log2_of(placed + batch) - kMeanOfLogs;
  // Before anything is known: the lattice's bounds, shared by all.
  const uint32_t places = lattice_places(r.contract);
  r.density = (log_batch - (places == 0 ? 32 * kLog2One : log2_of(places))) * 256;
  r.stage = Stage::kWalk;
  return StepOutcome::kStep;
}

// Turns to the next triangle around `vertex`; `chord` is already its half-edge into `vertex`, which
// comes from `neighbour`. False if the walk is over.
inline bool advance(Reconstruction& r, Index neighbour, uint32_t marks) {
  if (neighbour != r.turn_start) {
    r.from = static_cast<uint8_t>(marks);
    if ((marks & kQueued) == 0) {
      r.queue[r.queue_tail++] = r.mesh->twin[r.chord];
      mark(r.marks, neighbour, kQueued);
    }
    return true;
  }
  if (r.vertex == kInfinity) r.queue[0] = r.mesh->twin[r.chord];
  mark(r.marks, r.vertex, kDone);
  if (r.queue_head == r.queue_tail) return false;
  r.chord = r.queue[r.queue_head++];
  r.from = kDone;  // the parent's turn is over
  r.turn_start = r.mesh->origin[r.chord];
  r.vertex = r.mesh->origin[r.mesh->twin[r.chord]];
  return true;
}

// Leaves the triangle of the chord, which is final. False if the walk is over.
inline bool pass(Reconstruction& r, const Corner& corner) {
  r.chord = corner.into;
  return advance(r, corner.number, corner.marks);
}

// Says hit or miss at the triangle of the chord, which is not certified, and leaves it.
template <class Coder>
MICROTIN_IN_PLACE inline StepOutcome step_decision(Reconstruction& r, Coder& coder,
                                                   const Corner& corner) {
  const Decision decision = decide(r, coder, corner);
  if (decision == Decision::kMalformed) return StepOutcome::kMalformed;
  if (decision == Decision::kMiss)
    return pass(r, corner) ? StepOutcome::kStep : StepOutcome::kMalformed;
  if (r.mesh->vertices == r.phase_end) {
    ++r.phase;
    return after_vertices(r);
  }
  const Index placed = r.mesh->origin[r.chord];
  return advance(r, placed, 0) ? StepOutcome::kStep : StepOutcome::kMalformed;
}

constexpr uint32_t kStepTriangles = 8;  // most that one step passes

// Passes certified triangles, but only a few, and looks at one that is not.
template <class Coder>
MICROTIN_ROOMY_IN_PLACE StepOutcome step_walk(Reconstruction& r, Coder& coder) {
  for (uint32_t i = 0;; ++i) {
    const Corner corner = far_corner(r);
    if (((r.from | corner.marks) & kDone) == 0) return step_decision(r, coder, corner);
    if (i == kStepTriangles) return StepOutcome::kStep;
    if (!pass(r, corner)) return StepOutcome::kMalformed;
  }
}

inline bool is_void(const uint8_t* voids, Index triangle) {
  return (static_cast<uint32_t>(voids[triangle >> 3]) >> (triangle & 7u) & 1u) != 0;
}

// Codes the void flag of one real triangle, given those of its neighbours that are known.
template <class Coder>
StepOutcome step_void(Reconstruction& r, Coder& coder) {
  const Mesh& mesh = *r.mesh;
  const Index t = r.void_cursor++;
  const Index f = first_edge(t);
  uint32_t context = 3;
  for (uint32_t i = 0; i < 3; ++i) {
    const Index neighbour = triangle_of(mesh.twin[f + i]);
    if (neighbour < t && !is_ghost(mesh, neighbour)) {
      context = is_void(r.voids, neighbour) ? context + 1 : context - 1;
    }
  }
  const bool flag =
      !is_ghost(mesh, t) && code_bit(coder, r.models.is_void[context], coder.is_void(mesh, t));
  const uint32_t bit = 1u << (t & 7u), others = r.voids[t >> 3] & ~bit;
  r.voids[t >> 3] = static_cast<uint8_t>(flag ? others | bit : others);
  if (r.void_cursor < mesh.triangles) return StepOutcome::kStep;
  r.stage = Stage::kComplete;
  return StepOutcome::kSectionEnd;
}

// One step: bounded work, at most kStepBytes of the payload, nothing half done.
template <class Coder>
MICROTIN_ROOMY_IN_PLACE StepOutcome step(Reconstruction& r, Coder& coder) {
  switch (r.stage) {
    case Stage::kSeed:
      return step_seed(r, coder);
    case Stage::kPhase:
      return step_phase(r, coder);
    case Stage::kWalk:
      return step_walk(r, coder);
    case Stage::kVoids:
      if (kBuiltVoids) return step_void(r, coder);
      break;
    case Stage::kComplete:
      break;
  }
  return StepOutcome::kMalformed;
}

}  // namespace microtin

#endif
