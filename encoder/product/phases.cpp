// SPDX-License-Identifier: MIT
// Decodes streams section by section, and compares what is there with the header.
#include "encoder/product/phases.hpp"

#include "encoder/base/error.hpp"
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::product {
namespace {

// Vertices and bytes; the error if there is a source.
std::vector<PhaseEnd> phases_of(const std::vector<uint8_t>& stream, const Source* source) {
  std::vector<PhaseEnd> phases;
  const auto visit = [&](const microtin_mesh* mesh, uint64_t bytes) {
    phases.push_back({microtin_mesh_vertex_count(mesh), bytes, std::nullopt});
    if (source == nullptr) return;
    const Verification found = verify(mesh, *source, std::nullopt);
    if (found.covered != 0) phases.back().max_error = found.max_error;
  };
  const DecodedTerrain decoded(stream, visit);
  return phases;
}

}  // namespace

std::vector<PhaseEnd> measure_phases(const std::vector<uint8_t>& stream, const Source& source) {
  return phases_of(stream, &source);
}

std::string broken_phases(const std::vector<PhaseEnd>& stated, const std::vector<PhaseEnd>& found) {
  if (stated.size() != found.size()) {
    return "its header states " + std::to_string(stated.size()) + " phases, but there are " +
           std::to_string(found.size());
  }
  for (size_t i = 0; i < stated.size(); ++i) {
    const PhaseEnd &a = stated[i], &b = found[i];
    const std::string phase = "phase " + std::to_string(i + 1) + " in the header";
    if (a.vertices != b.vertices || a.bytes != b.bytes) {
      return phase + " has " + std::to_string(b.vertices) + " vertices after " +
             std::to_string(b.bytes) + " bytes, not " + std::to_string(a.vertices) + " after " +
             std::to_string(a.bytes);
    }
    if (a.max_error && b.max_error && !(*b.max_error <= *a.max_error)) {
      return phase + " is up to " + to_string(*b.max_error) + " off, more than " +
             to_string(*a.max_error);
    }
  }
  return "";
}

void expect_as_stated(const std::vector<uint8_t>& stream, const microtin_mesh* mesh) {
  const Metadata stated = read_header(stream).metadata;
  if (stated.digest && *stated.digest != microtin_mesh_digest(mesh)) {
    throw Error("the digest in its header is not that of its mesh");
  }
  if (stated.phases.empty()) return;
  const std::string broken = broken_phases(stated.phases, phases_of(stream, nullptr));
  if (!broken.empty()) throw Error(broken);
}

}  // namespace microtin::product
