// SPDX-License-Identifier: MIT
// Drives the shared reconstruction with a writing coder, then decodes and compares.
#include "encoder/stream/encode.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/stream/fingerprint.hpp"
#include "encoder/stream/order.hpp"
#include "encoder/stream/range_encoder.hpp"
#include "encoder/stream/triangulation.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "shared/reconstruction.hpp"

namespace microtin::stream {
namespace {

// Fewer phases may save a smaller terrain more bytes than wide free regions cost. Decoding takes a
// few hundredths more, so it must save a part that counts.
constexpr std::size_t kFewVertices = 2000;
constexpr uint32_t kWideDegree = 16;
constexpr std::size_t kPartSaved = 256;

// Knows what is to be sent, and writes it: the coder of shared/reconstruction.hpp.
class WritingCoder {
 public:
  WritingCoder(const std::vector<Vertex>& vertices, const Order& order, VoidTriangles voids)
      : voids_(std::move(voids)) {
    sequence_.reserve(vertices.size());
    for (const Index v : order.seed) sequence_.push_back(vertices[v]);
    for (const std::vector<Index>& batch : order.batches) {
      for (const Index v : batch) sequence_.push_back(vertices[v]);
      batches_.push_back(static_cast<uint32_t>(batch.size()));
    }
  }

  // Call before each step: the first `placed` vertices of the sequence are in the mesh.
  void at(uint32_t placed, uint32_t phase) {
    placed_ = placed;
    phase_ = phase;
  }

  bool bit(uint32_t probability, bool value) { return payload_.bit(probability, value); }
  uint32_t uniform(uint32_t count, uint32_t value) { return payload_.uniform(count, value); }
  uint32_t uniform_or_escape(uint32_t count, uint32_t value) {
    return payload_.uniform_or_escape(count, value);
  }

  Vertex next() const { return sequence_[placed_]; }
  bool last_phase() const { return phase_ + 1 == batches_.size(); }
  uint32_t batch() const { return batches_[phase_]; }
  bool conflicts(const Mesh& mesh, Index h) const {
    const Index f = first_edge(triangle_of(h));
    return in_conflict(mesh, mesh.origin[f], mesh.origin[f + 1], mesh.origin[f + 2],
                       Point{sequence_[placed_].x, sequence_[placed_].y});
  }
  bool is_void(const Mesh& mesh, Index triangle) const { return voids_.has(mesh, triangle); }

  std::vector<uint8_t> take_payload() {
    std::vector<uint8_t> bytes = payload_.finish();
    payload_ = RangeEncoder();
    return bytes;
  }

 private:
  std::vector<Vertex> sequence_;
  std::vector<uint32_t> batches_;
  VoidTriangles voids_;
  uint32_t placed_ = 0;
  uint32_t phase_ = 0;
  RangeEncoder payload_;
};

// The arrays behind a Reconstruction on the host.
class Workspace {
 public:
  Workspace(uint32_t n, Triangulation::Arrays arrays)
      : arrays_(std::move(arrays)),
        z_(n),
        queue_(n),
        marks_(mark_bytes(n)),
        voids_(n / 4 + 1),
        residual_(n) {
    mesh_ =
        Mesh{arrays_.places.data(), z_.data(), arrays_.origin.data(), arrays_.twin.data(), 0, 0};
    state_.mesh = &mesh_;
    state_.queue = queue_.data();
    state_.marks = marks_.data();
    state_.residual = residual_.data();
    state_.voids = voids_.data();
  }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  Reconstruction& state() { return state_; }

 private:
  Triangulation::Arrays arrays_;
  std::vector<int16_t> z_;
  std::vector<Index> queue_;
  std::vector<uint8_t> marks_, voids_;
  std::vector<Residual> residual_;
  Mesh mesh_{};
  Reconstruction state_{};
};

void append_section(std::vector<uint8_t>& stream, const std::vector<uint8_t>& payload) {
  const size_t from = stream.size();
  append_varint(stream, payload.size());
  stream.insert(stream.end(), payload.begin(), payload.end());
  append_check(stream, from);
}

std::vector<uint8_t> write_stream(const Contract& contract, const Metadata& metadata,
                                  WritingCoder& coder, Triangulation::Arrays arrays) {
  std::vector<uint8_t> stream = write_header(contract, metadata);
  Workspace workspace(contract.vertices, std::move(arrays));
  Reconstruction& r = workspace.state();
  r.contract = contract;
  start(r);
  while (r.stage != Stage::kComplete) {
    coder.at(r.mesh->vertices, r.phase);
    const StepOutcome outcome = step(r, coder);
    if (outcome == StepOutcome::kMalformed) throw InternalFault("the order does not rebuild");
    if (outcome == StepOutcome::kSectionEnd) append_section(stream, coder.take_payload());
  }
  return stream;
}

// What the header promises.
Contract contract_of(const Tin& tin, const Metadata& metadata, const Effort& effort,
                     Origin origin) {
  Contract contract{};
  contract.below = metadata.everywhere.below;
  contract.above = metadata.everywhere.above;
  contract.vertices = static_cast<uint32_t>(tin.vertices.size());
  contract.degree = usual_degree(effort);
  contract.coding = effort.coding;
  contract.has_voids = !tin.voids.empty();
  contract.odd_origin_x = origin.odd_x;
  contract.odd_origin_y = origin.odd_y;
  for (const Vertex& v : tin.vertices) {
    contract.x_max = std::max(contract.x_max, v.x);
    contract.y_max = std::max(contract.y_max, v.y);
    contract.has_heights = contract.has_heights || v.z != 0;
  }
  return contract;
}

uint64_t fingerprint_of(const Mesh& mesh, const std::vector<Vertex>& vertices,
                        const VoidTriangles& voids) {
  Fingerprint fingerprint(vertices);
  for (Index t = 0; t < mesh.triangles; ++t) {
    const Index* const v = mesh.origin + first_edge(t);
    if (v[0] == kInfinity || v[1] == kInfinity || v[2] == kInfinity) continue;
    fingerprint.add(v[0], v[1], v[2], voids.has(mesh, t));
  }
  return fingerprint.sum();
}

uint64_t fingerprint_of(const microtin_mesh* mesh) {
  std::vector<Vertex> vertices(microtin_mesh_vertex_count(mesh));
  for (uint32_t i = 0; i < vertices.size(); ++i) vertices[i] = vertex_of(mesh, i);
  Fingerprint fingerprint(vertices);
  const uint32_t triangles = microtin_mesh_triangle_count(mesh);
  for (uint32_t t = 0; t < triangles; ++t) {
    uint32_t v[3];
    const microtin_triangle_kind kind = microtin_mesh_triangle(mesh, t, v);
    if (kind != MICROTIN_TRIANGLE_GHOST)
      fingerprint.add(v[0], v[1], v[2], kind == MICROTIN_TRIANGLE_VOID);
  }
  return fingerprint.sum();
}

// A stream that was not decoded yet, and what its decoder should make of it.
struct Draft {
  std::vector<uint8_t> stream;
  uint64_t fingerprint;
};

Draft draft_of(const Tin& tin, const VoidTriangles& voids, const Metadata& metadata,
               const Contract& contract) {
  std::vector<Index> numbers;
  Triangulation triangulation(places_of(tin), numbers);
  std::vector<Vertex> vertices;
  vertices.reserve(numbers.size());
  for (const Index number : numbers) vertices.push_back(tin.vertices[number]);
  const uint64_t fingerprint = fingerprint_of(triangulation.mesh(), vertices, voids);
  WritingCoder coder(vertices, breadth_first_order(triangulation, contract.degree), voids);
  return {write_stream(contract, metadata, coder, std::move(triangulation).take_arrays()),
          fingerprint};
}

Draft chosen_draft(const Tin& tin, const Metadata& metadata, const Effort& effort, Origin origin) {
  const VoidTriangles voids(tin.voids);
  Contract contract = contract_of(tin, metadata, effort, origin);
  Draft usual = draft_of(tin, voids, metadata, contract);
  if (effort.degree != 0 || tin.vertices.size() >= kFewVertices) return usual;
  contract.degree = kWideDegree;
  Draft wide = draft_of(tin, voids, metadata, contract);
  const std::size_t most = usual.stream.size() - usual.stream.size() / kPartSaved;
  return wide.stream.size() < most ? std::move(wide) : std::move(usual);
}

}  // namespace

std::string name_of(Coding coding) {
  if (coding == Coding::kQuick) return "quick";
  return coding == Coding::kDense ? "dense" : "balanced";
}

Encoding encode_and_decode(const Tin& tin, const Metadata& metadata, const Effort& effort,
                           Origin origin) {
  if (tin.vertices.size() > kMaxVertices) {
    throw Error(
        std::to_string(tin.vertices.size()) +
        " vertices; the format holds 16,777,216; increase the error, or make a pack (.mtp)");
  }
  Draft draft = chosen_draft(tin, metadata, effort, origin);
  DecodedTerrain decoded = on_our_own([&] { return DecodedTerrain(draft.stream); });
  if (microtin_mesh_vertex_count(decoded.mesh()) != tin.vertices.size() ||
      fingerprint_of(decoded.mesh()) != draft.fingerprint) {
    throw InternalFault("the stream does not decode to the terrain it was made from");
  }
  return {std::move(draft.stream), std::move(decoded)};
}

std::vector<uint8_t> encode(const Tin& tin, const Metadata& metadata, const Effort& effort) {
  return encode_and_decode(tin, metadata, effort).stream;
}

}  // namespace microtin::stream
