// The reconstruction, once for both sides: a breadth-first walk that rebuilds the Delaunay
// triangulation point by point (Sohler, "Fast Reconstruction of Delaunay Triangulations", CCCG
// 1999).
//
// It is a template over the coder. With a reading coder it decodes; with a writing coder, which
// knows the next point, it encodes. A coder supplies, beside bit() and uniform() (probability.hpp):
//   next()        the vertex to be inserted next
//   last_phase(), batch()   how many vertices the phase adds
//   conflicts(mesh, h)      whether that vertex is in conflict with the triangle of half-edge h
//   is_void(mesh, t)        whether triangle t is void
// A reading coder may return anything from these: what the stream says replaces it.
#ifndef MICROTIN_SHARED_RECONSTRUCTION_HPP
#define MICROTIN_SHARED_RECONSTRUCTION_HPP

#include "shared/format.hpp"
#include "shared/height_coding.hpp"
#include "shared/hull_coding.hpp"
#include "shared/insertion.hpp"
#include "shared/place_coding.hpp"

namespace microtin {

constexpr uint32_t kHitEntries = 29;

// Everything that is learned while coding.
struct Models {
  Curve<kHitEntries> hit[4];  // by which of the two sides beside the chord are certified
  PlaceModel place;
  HeightModel height;
  HullModel hull;
  AdaptiveBit is_void[5];
};

inline void reset(Models& models) {
  for (int i = 0; i < 4; ++i) reset(models.hit[i], -12 * 160, 160);
  reset(models.place);
  reset(models.height);
  reset(models.hull);
  for (int i = 0; i < 5; ++i) reset(models.is_void[i], static_cast<uint32_t>(3000 + 6500 * i));
}

enum class Stage : uint8_t { kSeed, kPhase, kWalk, kVoids, kComplete };

enum class Progress : uint8_t {
  kStep,        // one step done, more to do in this section
  kPhaseEnd,    // the same, and it completed a phase
  kSectionEnd,  // ... and the section
  kMalformed
};

struct Reconstruction {
  Mesh* mesh;
  uint8_t* voids;      // a bit per triangle
  Index* queue;        // half-edges parent -> vertex, one per vertex
  uint8_t* marks;      // two bits per vertex: queued, done
  Residual* residual;  // per vertex, see height_coding.hpp
  Contract contract;

  Stage stage;
  bool infinity_done;
  Index vertex;      // being walked around
  Index chord;       // half-edge into `vertex`, of the triangle to be looked at next
  Index turn_start;  // the neighbour where the turn around `vertex` began
  Index anchor;      // the half-edge from vertex 0 to infinity
  Index queue_head;
  Index queue_tail;
  Index phase_end;  // vertices when the phase is complete
  uint32_t phase;   // phases complete
  uint32_t work;    // vertices walked around so far, all phases together
  uint32_t batch;
  int64_t mean_area;  // running mean of twice the area of final triangles, 8 fractional bits
  Index void_cursor;

  Cavity cavity;
  Index cavity_triangles[kMaxDegree - 2];
  Index cavity_origin[kMaxDegree];
  Index cavity_twin[kMaxDegree];
  Index cavity_pending[kMaxDegree];
  // Of the triangle in hand: here to spare the stack.
  FreeRegion region;
  PlaceOdds odds;

  Models models;
};

inline void start(Reconstruction& r, const Contract& contract) {
  r.contract = contract;
  r.stage = Stage::kSeed;
  r.phase = 0;
  r.work = 0;
  r.void_cursor = 0;
  r.cavity.triangles = r.cavity_triangles;
  r.cavity.edge_origin = r.cavity_origin;
  r.cavity.edge_twin = r.cavity_twin;
  r.cavity.pending = r.cavity_pending;
  r.cavity.limit = static_cast<Index>(contract.degree - 2);
  r.mesh->vertices = 0;
  r.mesh->triangles = 0;
  reset(r.models);
}

// --- Marks -------------------------------------------------------------------------------------

constexpr uint8_t kQueued = 1, kDone = 2;

inline bool marked(const Reconstruction& r, Index v, uint8_t mark) {
  if (v == kInfinity) return mark == kQueued || r.infinity_done;
  return (r.marks[v >> 2] >> (2u * (v & 3u)) & mark) != 0;
}

inline void mark(Reconstruction& r, Index v, uint8_t mark) {
  if (v == kInfinity) {
    r.infinity_done = r.infinity_done || mark == kDone;
  } else {
    r.marks[v >> 2] = static_cast<uint8_t>(r.marks[v >> 2] | mark << (2u * (v & 3u)));
  }
}

// --- The triangle in hand ------------------------------------------------------------------------

inline Side side_behind(const Reconstruction& r, Index h) {
  const Index behind = r.mesh->twin[h];
  const Index apex = r.mesh->origin[previous_in_triangle(behind)];
  Side side;
  side.ghost = apex == kInfinity;
  side.certified = marked(r, apex, kDone);
  side.apex = side.ghost ? Point{0, 0} : point_of(*r.mesh, apex);
  return side;
}

// Describes the free region of the real triangle (v, c, a) whose half-edge a -> v is the chord.
inline void look_around(Reconstruction& r) {
  const Mesh& mesh = *r.mesh;
  const Index to_c = next_in_triangle(r.chord), to_a = next_in_triangle(to_c);
  FreeRegion& region = r.region;
  region.corner[0] = point_of(mesh, mesh.origin[to_c]);
  region.corner[1] = point_of(mesh, mesh.origin[to_a]);
  region.corner[2] = point_of(mesh, mesh.origin[r.chord]);
  region.side[0] = side_behind(r, to_c);
  region.side[1] = side_behind(r, to_a);
  region.side[kChord] = side_behind(r, r.chord);
  region.side[kChord].certified = true;  // it was passed in this turn, or has a done vertex
}

// log2 of the expected number of this batch's points per unit area, from the mean area of the final
// triangles met lately: n final vertices have a mean of 1/n of the area each, two triangles' worth.
inline Log2 point_density(const Reconstruction& r) {
  return log2_of(r.batch) - log2_of(r.phase_end) -
         (log2_of(static_cast<uint64_t>(r.mean_area)) - 8 * kLog2One);
}

inline void note_final_triangle(Reconstruction& r, Index h) {
  const Mesh& mesh = *r.mesh;
  const Index f = first_edge(triangle_of(h));
  const Index a = mesh.origin[f], b = mesh.origin[f + 1u], c = mesh.origin[f + 2u];
  if (a == kInfinity || b == kInfinity || c == kInfinity) return;
  const int64_t area = orient2d(point_of(mesh, a), point_of(mesh, b), point_of(mesh, c)) * 256;
  r.mean_area += (area - r.mean_area) / 32;
  if (r.mean_area < 1) r.mean_area = 1;
}

// --- Insertion -----------------------------------------------------------------------------------

// Inserts a vertex at `place`, decoded relative to the triangle of the chord, with the height that
// the stream says or, for a writing coder, z. The chord becomes the half-edge from the new vertex.
// False if that is not legal.
template <class Coder>
bool insert(Reconstruction& r, Coder& coder, Point place, int16_t z) {
  Mesh& mesh = *r.mesh;
  const Index chord = r.chord;
  const Index f = first_edge(triangle_of(chord));
  for (Index i = 0; i < 3; ++i) {
    const Index corner = mesh.origin[f + i];
    if (corner != kInfinity && point_of(mesh, corner) == place) return false;
  }
  if (!(point_of(mesh, 0) < place)) return false;
  if (!in_conflict(mesh, chord, place)) return false;
  const Index behind = mesh.twin[chord];
  const bool at_infinity = r.vertex == kInfinity;
  // Final triangles must stay: those with a done vertex, and those passed in this turn, which can
  // only be reached across the chord or, around infinity, across the edge where the turn began.
  const auto is_final = [&r, &mesh, behind, at_infinity](Index h) {
    if (h == behind) return true;
    const Index f2 = first_edge(triangle_of(h));
    if (marked(r, mesh.origin[f2], kDone) || marked(r, mesh.origin[f2 + 1u], kDone) ||
        marked(r, mesh.origin[f2 + 2u], kDone)) {
      return true;
    }
    if (!at_infinity) return false;
    const Index from = mesh.origin[h], to = mesh.origin[next_in_triangle(h)];
    return (from == kInfinity && to == 0) || (from == 0 && to == kInfinity);
  };
  if (!grow_cavity(mesh, chord, place, r.cavity, is_final)) return false;
  const Index v = mesh.vertices;
  if (r.contract.has_heights) {
    // The chord's ends are in the ring; its start is finite, since triangles at infinity are looked
    // at around infinity only.
    const int32_t start = mesh.z[mesh.origin[chord]];
    const int32_t base = at_infinity ? start : (start + mesh.z[r.vertex]) / 2;
    const HeightPrediction prediction = predict_height(
        mesh, r.residual, r.cavity_origin, static_cast<uint32_t>(r.cavity.size) + 2u, place, base);
    if (!code_height(coder, r.models.height, prediction, &z)) return false;
    r.residual[v] = residual_of(z - prediction.height);
  } else {
    z = 0;
  }
  mesh.x[v] = place.x;
  mesh.y[v] = place.y;
  mesh.z[v] = z;
  const Index first = fan_cavity(mesh, r.cavity, v);
  if (chord == r.anchor) r.anchor = first;
  ++mesh.vertices;
  note_final_triangle(r, first);
  r.chord = mesh.twin[first + 1u];
  return true;
}

// --- Coding of one decision ----------------------------------------------------------------------

// Says hit or miss at the hull edge beside the chord to infinity, and where a hit is.
template <class Coder>
bool decide_at_hull(Reconstruction& r, Coder& coder, Point* place) {
  const Mesh& mesh = *r.mesh;
  const Index to_c = next_in_triangle(r.chord);
  const HullEdge edge = hull_edge(r.contract, point_of(mesh, mesh.origin[r.chord]),
                                  point_of(mesh, mesh.origin[next_in_triangle(to_c)]));
  if (edge.at_border && edge.parts == 1) return false;  // there is no place beyond it
  const uint32_t spacing = expected_spacing(r.contract, r.batch);
  if (!code_hull_hit(coder, r.models.hull, edge, spacing, coder.conflicts(mesh, r.chord))) {
    return false;
  }
  *place = code_hull_place(coder, r.models.hull, r.models.height.mantissa, r.contract, edge,
                           spacing, *place);
  return true;
}

// Says hit or miss at an uncertified triangle and inserts the vertex of a hit. False if malformed.
template <class Coder>
bool decide(Reconstruction& r, Coder& coder, bool* hit) {
  Mesh& mesh = *r.mesh;
  const Vertex next = coder.next();
  Point place = {next.x, next.y};
  if (r.vertex == kInfinity) {
    *hit = decide_at_hull(r, coder, &place);
    if (!*hit) return true;
  } else {
    look_around(r);
    const FreeRegion& region = r.region;
    const Log2 density = point_density(r);
    const int which = (region.side[0].certified ? 1 : 0) + (region.side[1].certified ? 2 : 0);
    const int32_t position = 2 * (free_area(region) + density) + 12 * 256;
    *hit = code_on_curve(coder, r.models.hit[which], position, coder.conflicts(mesh, r.chord));
    if (!*hit) return true;
    estimate_odds(r.odds, region, density);
    const Box bounds = {0, 0, r.contract.x_max, r.contract.y_max};
    const Box box = enclosing_box(region, r.odds.inside, bounds);
    place = code_place(coder, r.models.place, r.odds, region.corner[0], box, place);
  }
  return insert(r, coder, place, next.z);
}

// --- Steps ---------------------------------------------------------------------------------------

// What follows when all vertices of a phase, or of the seed, are in place.
inline Progress after_vertices(Reconstruction& r) {
  if (r.mesh->vertices != r.contract.vertices) {
    r.stage = Stage::kPhase;
    const bool together = r.mesh->vertices < kSectionVertices;
    return together ? Progress::kPhaseEnd : Progress::kSectionEnd;
  }
  r.stage = r.contract.has_voids ? Stage::kVoids : Stage::kComplete;
  return r.contract.has_voids ? Progress::kPhaseEnd : Progress::kSectionEnd;
}

// A coordinate of a seed vertex, likely to be the smallest or the largest.
template <class Coder>
uint16_t code_seed_coordinate(Coder& coder, uint32_t largest, uint32_t value) {
  if (coder.bit(kProbabilityOne / 4 * 3, value == 0 || value == largest)) {
    const bool high = coder.bit(kProbabilityOne / 2, value == largest);
    return static_cast<uint16_t>(high ? largest : 0);
  }
  return static_cast<uint16_t>(coder.uniform(largest + 1u, value));
}

// One of the three vertices that are never removed. The first is the lexicographically smallest of
// all.
template <class Coder>
Progress step_seed(Reconstruction& r, Coder& coder) {
  Mesh& mesh = *r.mesh;
  const Index i = mesh.vertices;
  const Vertex known = coder.next();
  mesh.x[i] = code_seed_coordinate(coder, r.contract.x_max, known.x);
  mesh.y[i] = code_seed_coordinate(coder, r.contract.y_max, known.y);
  mesh.z[i] = 0;
  r.residual[i] = 4;
  if (r.contract.has_heights) {
    const HeightPrediction previous = {i == 0 ? 0 : mesh.z[i - 1u], kScales - 1, kTendencies / 2};
    mesh.z[i] = known.z;
    if (!code_height(coder, r.models.height, previous, &mesh.z[i])) return Progress::kMalformed;
  }
  if (i < 2) {
    ++mesh.vertices;
    return Progress::kStep;
  }
  const Point p0 = point_of(mesh, 0), p1 = point_of(mesh, 1), p2 = point_of(mesh, 2);
  if (!(p0 < p1) || !(p0 < p2) || orient2d(p0, p1, p2) <= 0) return Progress::kMalformed;
  start_mesh(mesh);
  r.anchor = 4;
  return after_vertices(r);
}

// Starts a phase: how many vertices it adds, and the walk from infinity.
template <class Coder>
Progress step_phase(Reconstruction& r, Coder& coder) {
  const uint32_t placed = r.mesh->vertices;
  const uint32_t left = r.contract.vertices - placed;
  uint32_t batch = left;
  if (coder.bit(kProbabilityOne / 2, !coder.last_phase())) {
    // All but the low 12 bits, then these: 1 .. left - 1.
    const uint32_t high = coder.uniform((left >> 12) + 1u, (coder.batch() >> 12));
    const uint32_t lows = high == left >> 12 ? (left & 4095u) + 1u : 4096u;
    batch = high << 12 | coder.uniform(lows, coder.batch() & 4095u);
    if (batch == 0 || batch >= left) return Progress::kMalformed;
  }
  r.batch = batch;
  r.phase_end = static_cast<Index>(placed + batch);
  r.work += placed + batch;
  if (r.work > work_budget(r.contract.vertices)) return Progress::kMalformed;
  const uint32_t mark_bytes = (placed + batch + 3u) / 4u;
  for (uint32_t i = 0; i < mark_bytes; ++i) r.marks[i] = 0;
  r.infinity_done = false;
  r.vertex = kInfinity;
  r.turn_start = 0;
  mark(r, 0, kQueued);
  r.queue_head = 0;
  r.queue_tail = 1;  // entry 0 is vertex 0's, known when the turn around infinity ends
  r.chord = r.anchor;
  // Before anything is known: the lattice's bounds, shared by all. (2^16 * 2^16) * 2^8 = 2^40.
  r.mean_area = static_cast<int64_t>(static_cast<uint64_t>(columns(r.contract)) * rows(r.contract) *
                                     256u / r.phase_end) +
                1;
  r.stage = Stage::kWalk;
  return Progress::kStep;
}

// Leaves the triangle of the chord behind and turns to the next around `vertex`; `chord` is already
// its half-edge into `vertex`. False if the walk is over.
inline bool advance(Reconstruction& r) {
  const Index neighbour = r.mesh->origin[r.chord];
  if (neighbour != r.turn_start) {
    if (!marked(r, neighbour, kQueued)) {
      mark(r, neighbour, kQueued);
      r.queue[r.queue_tail++] = r.mesh->twin[r.chord];
    }
    return true;
  }
  if (r.vertex == kInfinity) r.queue[0] = r.mesh->twin[r.chord];
  mark(r, r.vertex, kDone);
  if (r.queue_head == r.queue_tail) return false;
  r.chord = r.queue[r.queue_head++];
  r.turn_start = r.mesh->origin[r.chord];
  r.vertex = r.mesh->origin[next_in_triangle(r.chord)];
  return true;
}

// Looks at one triangle.
template <class Coder>
Progress step_walk(Reconstruction& r, Coder& coder) {
  const Mesh& mesh = *r.mesh;
  const Index to_c = next_in_triangle(r.chord);
  const Index apex = mesh.origin[next_in_triangle(to_c)];
  bool hit = false;
  if (!marked(r, apex, kDone) && !marked(r, mesh.origin[r.chord], kDone)) {
    if (!decide(r, coder, &hit)) return Progress::kMalformed;
  }
  if (!hit) {
    note_final_triangle(r, r.chord);
    r.chord = mesh.twin[to_c];
  }
  if (mesh.vertices == r.phase_end) {
    ++r.phase;
    return after_vertices(r);
  }
  return advance(r) ? Progress::kStep : Progress::kMalformed;
}

inline bool is_void(const uint8_t* voids, Index triangle) {
  return (static_cast<uint32_t>(voids[triangle >> 3]) >> (triangle & 7u) & 1u) != 0;
}

// Codes the void flag of one real triangle, given those of its neighbours that are known.
template <class Coder>
Progress step_void(Reconstruction& r, Coder& coder) {
  const Mesh& mesh = *r.mesh;
  const Index t = r.void_cursor++;
  const Index f = first_edge(t);
  bool ghost = false;
  uint32_t context = 2;
  for (Index i = 0; i < 3; ++i) {
    ghost = ghost || mesh.origin[f + i] == kInfinity;
    const Index neighbour = triangle_of(mesh.twin[f + i]);
    if (neighbour >= t) continue;
    const Index g = first_edge(neighbour);
    if (mesh.origin[g] == kInfinity || mesh.origin[g + 1u] == kInfinity ||
        mesh.origin[g + 2u] == kInfinity) {
      continue;
    }
    const bool other = is_void(r.voids, neighbour);
    if (other && context < 4) ++context;
    if (!other && context > 0) --context;
  }
  bool flag = false;
  if (!ghost) flag = code_bit(coder, r.models.is_void[context], coder.is_void(mesh, t));
  const uint32_t bit = 1u << (t & 7u), others = r.voids[t >> 3] & ~bit;
  r.voids[t >> 3] = static_cast<uint8_t>(flag ? others | bit : others);
  if (r.void_cursor < mesh.triangles) return Progress::kStep;
  r.stage = Stage::kComplete;
  return Progress::kSectionEnd;
}

// One step: bounded work, at most kStepBytes of the payload, nothing half done.
template <class Coder>
Progress step(Reconstruction& r, Coder& coder) {
  switch (r.stage) {
    case Stage::kSeed:
      return step_seed(r, coder);
    case Stage::kPhase:
      return step_phase(r, coder);
    case Stage::kWalk:
      return step_walk(r, coder);
    case Stage::kVoids:
      return step_void(r, coder);
    case Stage::kComplete:
      break;
  }
  return Progress::kMalformed;
}

}  // namespace microtin

#endif
