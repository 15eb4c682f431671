// SPDX-License-Identifier: MIT
// Streams that the encoder would not write: the test says which vertices are sent in which phase,
// and what is written where a rule is to be broken.
#ifndef MICROTIN_TESTS_SUPPORT_FORGED_STREAM_HPP
#define MICROTIN_TESTS_SUPPORT_FORGED_STREAM_HPP

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "decoder/state.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/stream/range_encoder.hpp"
#include "tests/support/device.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/point_sets.hpp"
#include "tests/support/reference_delaunay.hpp"

namespace microtin::tests {

// The vertices, the seed first, and how many each phase adds, in any order within the phase.
struct Plan {
  std::vector<Vertex> vertices;
  std::vector<uint32_t> batches;
};

// One vertex a phase.
inline Plan single_steps(std::vector<Vertex> vertices) {
  const std::vector<uint32_t> batches(vertices.size() - 3, 1);
  return Plan{std::move(vertices), batches};
}

// The angle around the middle of circle_points, from the leftmost on.
inline double turn_of(Point p) {
  return std::atan2(32767.0 - p.y, 32767.0 - p.x) + (p.y > 32767 ? 6.3 : 0.0);
}

constexpr uint16_t kWheelSide = 130;

// `spokes` vertices on a circle, at most 36, and last their centre, which gets all as neighbours.
inline Plan wheel(uint32_t spokes) {
  Random random(1);
  Points rim = circle_points(65 * 65, random);
  std::sort(rim.begin(), rim.end(), [](Point a, Point b) { return turn_of(a) < turn_of(b); });
  std::vector<Vertex> vertices;
  for (uint32_t i = 0; i < spokes; ++i) {
    const Point p = rim[i * rim.size() / spokes];
    vertices.push_back(
        Vertex{static_cast<uint16_t>(p.x - 32702), static_cast<uint16_t>(p.y - 32702), 0});
  }
  std::swap(vertices[1], vertices[spokes / 3]);
  std::swap(vertices[2], vertices[2 * spokes / 3]);
  vertices.push_back({65, 65, 0});
  return single_steps(std::move(vertices));
}

// Writes a plan: a coder of shared/reconstruction.hpp. What a derived class hides is written
// otherwise.
class PlanCoder {
 public:
  explicit PlanCoder(Plan plan) : plan_(std::move(plan)) {}

  // Call before each step.
  void at(const Reconstruction& r) { r_ = &r; }

  bool bit(uint32_t probability, bool value) {
    REQUIRE(probability >= kProbabilityMargin);
    REQUIRE(probability <= kProbabilityOne - kProbabilityMargin);
    return payload_.bit(probability, value);
  }
  uint32_t uniform(uint32_t count, uint32_t value) { return payload_.uniform(count, value); }
  uint32_t uniform_or_escape(uint32_t count, uint32_t value) {
    return payload_.uniform_or_escape(count, value);
  }

  // The next of the seed; in a phase what is left of it and conflicts with the triangle in hand: of
  // several the one that makes a final triangle with the chord.
  Vertex next() {
    std::vector<Vertex>& all = plan_.vertices;
    const size_t placed = r_->mesh->vertices;
    hit_ = false;
    for (size_t i = placed; r_->stage == Stage::kWalk && i < r_->phase_end; ++i) {
      const Point p{all[i].x, all[i].y}, best{all[placed].x, all[placed].y};
      if (!is_in_conflict(p) || (hit_ && !is_in_conflict_with_chord_and(best, p))) continue;
      std::swap(all[i], all[placed]);
      hit_ = true;
    }
    return all[placed];
  }
  bool conflicts(const Mesh&, Index) {
    next();
    return hit_;
  }

  bool last_phase() const { return r_->phase + 1 == plan_.batches.size(); }
  uint32_t batch() const { return plan_.batches[r_->phase]; }
  bool is_void(const Mesh&, Index) const { return false; }

  Bytes take_payload() {
    Bytes bytes = payload_.finish();
    payload_ = RangeEncoder();
    return bytes;
  }

 protected:
  const Reconstruction& at() const { return *r_; }

 private:
  bool is_in_conflict(Point p) const {
    const Mesh& mesh = *r_->mesh;
    const Index f = first_edge(triangle_of(r_->chord));
    return in_conflict(mesh, mesh.origin[f], mesh.origin[f + 1], mesh.origin[f + 2], p);
  }

  bool is_in_conflict_with_chord_and(Point apex, Point p) const {
    const Point a = point_of(*r_->mesh, r_->mesh->origin[r_->chord]);
    if (r_->vertex == kInfinity) return reference::spoils_hull_edge(apex, a, p);
    return reference::in_perturbed_circle(a, point_of(*r_->mesh, r_->vertex), apex, p);
  }

  Plan plan_;
  const Reconstruction* r_ = nullptr;
  bool hit_ = false;
  RangeEncoder payload_;
};

inline void append_section(Bytes& stream, const Bytes& payload) {
  const size_t from = stream.size();
  append_varint(stream, payload.size());
  stream.insert(stream.end(), payload.begin(), payload.end());
  append_check(stream, from);
}

// A header without placement and notes.
inline Bytes header_of(const Contract& contract) {
  return write_header(contract, Metadata());
}

// The stream that `coder` writes, up to the end or the first step that is malformed.
template <class Coder>
Bytes forge(const Contract& contract, Coder&& coder) {
  Bytes stream = header_of(contract);
  const Device device(contract.vertices);
  Reconstruction& r = device.decoder->reconstruction;
  r.contract = contract;
  start(r);
  StepOutcome outcome = StepOutcome::kStep;
  while (r.stage != Stage::kComplete && outcome != StepOutcome::kMalformed) {
    coder.at(r);
    outcome = step(r, coder);
    if (outcome == StepOutcome::kStep || outcome == StepOutcome::kPhaseEnd) continue;
    append_section(stream, coder.take_payload());
  }
  return stream;
}

// Fills the lower border of the lattice, always with the next place: after a few vertices every
// symbol is nearly certain.
class BorderCoder : public PlanCoder {
 public:
  using PlanCoder::PlanCoder;

  Vertex next() {
    if (at().stage != Stage::kWalk) return PlanCoder::next();
    const Mesh& mesh = *at().mesh;
    const Point a = point_of(mesh, mesh.origin[at().chord]);
    const Point c = point_of(mesh, mesh.origin[previous_in_triangle(at().chord)]);
    conflicts_ = at().vertex == kInfinity && a.y == 0 && c.y == 0 && c.x > a.x + 1;
    return {static_cast<uint16_t>(a.x + 1), 0, 0};
  }
  bool conflicts(const Mesh&, Index) {
    next();
    return conflicts_;
  }

 private:
  bool conflicts_ = false;
};

inline std::vector<Vertex> border_seed(uint16_t largest_x) {
  return {{0, 0, 0}, {largest_x, 0, 0}, {0, 1, 0}};
}

inline Contract border_contract(uint16_t largest_x) {
  return Contract{largest_x + 2u, largest_x, 1, kMaxDegree, Coding::kQuick, false, true};
}

// Up to 4 sections in few bytes: a lattice whose last vertices come one a phase.
inline Bytes sectioned_stream(uint32_t sections) {
  constexpr uint16_t kLargest = 16;
  Random random(2);
  Plan plan{{{0, 0, 0}, {kLargest, 0, 0}, {0, kLargest, 0}}, {}};
  for (const Point p : lattice_points(kLargest + 1, kLargest + 1, random)) {
    const bool in_seed = (p.x == 0 || p.y == 0) && (p.x + p.y) % kLargest == 0;
    if (!in_seed) plan.vertices.push_back(Vertex{p.x, p.y, 0});
  }
  for (uint32_t n = 3; n < kSectionVertices; n += plan.batches.back()) {
    plan.batches.push_back(std::min(3 * n, kSectionVertices - n));
  }
  plan.batches.insert(plan.batches.end(), sections - 1, 1);
  plan.vertices.resize(kSectionVertices + sections - 1);
  const uint32_t n = static_cast<uint32_t>(plan.vertices.size());
  return forge(Contract{n, kLargest, kLargest, kMaxDegree, Coding::kQuick, false, false},
               PlanCoder(std::move(plan)));
}

}  // namespace microtin::tests

#endif
