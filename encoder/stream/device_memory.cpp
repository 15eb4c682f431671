// SPDX-License-Identifier: MIT
// Takes it from the decoder's macros, and from the shipped library for compact forms.
#include "encoder/stream/device_memory.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "microtin/compact.h"
#include "microtin/microtin.h"
#include "shared/format.hpp"

namespace microtin::stream {

uint64_t device_ram(uint32_t vertices) {
  const unsigned long n = vertices;
  return n <= MICROTIN_MAX_VERTICES_FOR(16)
             ? MICROTIN_MESH_BYTES_FOR(n, 16) + MICROTIN_DECODER_BYTES_FOR(n, 16)
             : MICROTIN_MESH_BYTES_FOR(n, 32) + MICROTIN_DECODER_BYTES_FOR(n, 32);
}

uint32_t most_vertices(uint64_t bytes) {
  uint32_t fits = 2, too_many = kMaxVertices + 1;
  while (too_many - fits > 1) {
    const uint32_t middle = fits + (too_many - fits) / 2;
    (device_ram(middle) <= bytes ? fits : too_many) = middle;
  }
  return fits == 2 ? 0 : fits;
}

namespace {

constexpr int32_t kNarrow = 256;  // steps

void expect(bool fulfilled) {
  if (!fulfilled) throw InternalFault("a terrain's compact form is another terrain");
}

// Whether the vertices' box is less than 256 steps wide and high.
bool is_narrow(const microtin_mesh* mesh) {
  const uint32_t vertices = microtin_mesh_vertex_count(mesh);
  Vertex least = vertex_of(mesh, 0), most = least;
  for (uint32_t v = 1; v < vertices; ++v) {
    const Vertex p = vertex_of(mesh, v);
    least = {std::min(least.x, p.x), std::min(least.y, p.y), 0};
    most = {std::max(most.x, p.x), std::max(most.y, p.y), 0};
  }
  return most.x - least.x < kNarrow && most.y - least.y < kNarrow;
}

// Memory in which a compact terrain is made.
struct Making {
  std::vector<uint64_t> space, scratch;
  microtin_compactor* compactor = nullptr;
  microtin_compact* compact = nullptr;

  Making(size_t bytes, size_t scratch_bytes)
      : space(bytes / 8 + 1), scratch(scratch_bytes / 8 + 1) {}

  microtin_status run(microtin_mesh* mesh) {
    expect(microtin_compactor_init(space.data(), space.size() * 8, mesh, scratch.data(),
                                   scratch.size() * 8, &compactor) == MICROTIN_STATUS_OK);
    return microtin_compactor_run(compactor, &compact, 0);
  }
};

}  // namespace

CompactForm measured_form(microtin_mesh* mesh) {
  const uint32_t vertices = microtin_mesh_vertex_count(mesh);
  Making making(0, MICROTIN_COMPACTOR_BYTES(uint64_t{vertices}));
  expect(making.run(mesh) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  size_t bytes = 0, scratch = 0;
  microtin_compactor_required_bytes(making.compactor, &bytes, &scratch);
  CompactForm form{vertices, 0, is_narrow(mesh)};
  const uint64_t least = bytes_of(form, MICROTIN_INDEX_BITS);
  form.repeats = 1;
  form.repeats =
      static_cast<uint32_t>((bytes - least) / (bytes_of(form, MICROTIN_INDEX_BITS) - least));
  expect(bytes_of(form, MICROTIN_INDEX_BITS) == bytes);
  return form;
}

CompactForm compact_form(DecodedTerrain&& terrain) {
  DecodedTerrain source = std::move(terrain);
  const CompactForm form = measured_form(source.mesh());
  const uint64_t digest = microtin_mesh_digest(source.mesh()),
                 bytes = bytes_of(form, MICROTIN_INDEX_BITS);
  Making making(bytes, MICROTIN_COMPACTOR_BYTES(uint64_t{form.vertices} + form.repeats));
  expect(making.run(source.mesh()) == MICROTIN_STATUS_OK);
  expect(microtin_compact_digest(making.compact) == digest);
  expect(microtin_compact_size(making.compact) == bytes);
  return form;
}

uint32_t index_bits(uint32_t vertices) {
  return vertices <= MICROTIN_MAX_VERTICES_FOR(16) ? 16 : 32;
}

uint64_t bytes_of(const CompactForm& form, uint32_t bits) {
  return MICROTIN_COMPACT_BYTES_WITH(uint64_t{form.vertices}, uint64_t{form.repeats},
                                     form.is_narrow ? 0u : 2u, bits);
}

bool keeps_promise(const CompactForm& form, uint32_t most) {
  const uint32_t bits = index_bits(most);
  return bytes_of(form, bits) <= promised_compact_bytes(most, form.is_narrow, bits);
}

void expect_promised(const CompactForm& form) {
  if (keeps_promise(form, form.vertices)) return;
  const uint32_t bits = index_bits(form.vertices);
  throw Error("a device could not keep the terrain in compact form: it takes " +
              std::to_string(bytes_of(form, bits)) + " bytes, microtin/compact.h promises " +
              std::to_string(promised_compact_bytes(form.vertices, form.is_narrow, bits)) +
              " for " + std::to_string(form.vertices) + " vertices; change " +
              parameter("max_error") + " or " + parameter("max_degree") +
              ", or make a pack (.mtp)");
}

uint64_t promised_compact_bytes(uint32_t vertices, bool is_narrow, uint32_t bits) {
  return MICROTIN_COMPACT_BYTES_FOR(uint64_t{vertices}, is_narrow ? 0u : 2u, bits);
}

}  // namespace microtin::stream
