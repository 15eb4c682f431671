// SPDX-License-Identifier: MIT
// Makes them by the shipped library.
#include "encoder/stream/compact_form.hpp"

#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "microtin/compact.h"

namespace microtin::stream {
namespace {

constexpr size_t kBytesOfVertex = 38;  // 32-bit numbers, and each vertex twice: COMPACT.md

void expect(bool fulfilled) {
  if (!fulfilled) throw InternalFault("a terrain's compact form is another terrain");
}

}  // namespace

CompactForm compact_form(DecodedTerrain&& terrain) {
  DecodedTerrain source = std::move(terrain);
  const uint32_t vertices = microtin_vertex_count(source.mesh());
  const uint64_t digest = microtin_digest(source.mesh());
  const size_t words = (MICROTIN_COMPACT_HEADER_BYTES + kBytesOfVertex * vertices) / 8 + 1;
  std::vector<uint64_t> space(words), scratch(words + MICROTIN_COMPACTOR_BYTES(0) / 8);
  microtin_compactor* compactor = nullptr;
  microtin_compact* compact = nullptr;
  expect(microtin_compact_begin(space.data(), space.size() * 8, source.mesh(), scratch.data(),
                                scratch.size() * 8, &compactor) == MICROTIN_DONE);
  expect(microtin_compact_proceed(compactor, 0, &compact) == MICROTIN_DONE);
  expect(microtin_compact_digest(compact) == digest);
  // All of a path's positions but two are middles, of a triangle to each side.
  CompactForm form{vertices, 0, true};
  form.repeats = microtin_compact_triangle_count(compact) / 2 + 1 - vertices;
  form.is_narrow = microtin_compact_size(compact) == bytes_of(form, MICROTIN_INDEX_BITS);
  expect(microtin_compact_size(compact) == bytes_of(form, MICROTIN_INDEX_BITS));
  return form;
}

uint32_t index_bits(uint32_t vertices) {
  return vertices <= MICROTIN_MAX_VERTICES_FOR(16) ? 16 : 32;
}

uint64_t bytes_of(const CompactForm& form, uint32_t bits) {
  return MICROTIN_COMPACT_BYTES_WITH(uint64_t{form.vertices}, uint64_t{form.repeats},
                                     form.is_narrow ? 0u : 2u, bits);
}

uint64_t promised_compact_bytes(uint32_t vertices, bool is_narrow, uint32_t bits) {
  return MICROTIN_COMPACT_BYTES_FOR(uint64_t{vertices}, is_narrow ? 0u : 2u, bits);
}

}  // namespace microtin::stream
