// SPDX-License-Identifier: MIT
// What the two workspaces hold.
#ifndef MICROTIN_DECODER_STATE_HPP
#define MICROTIN_DECODER_STATE_HPP

#include "decoder/range_decoder.hpp"
#include "microtin/microtin.h"
#include "shared/reconstruction.hpp"

struct microtin_mesh {
  microtin::Mesh mesh;
  uint8_t* voids;              // a bit per triangle
  uint32_t capacity;           // vertices
  uint32_t verified_vertices;  // vertices when the last check passed
  microtin_axis axis[3];       // if is_placed
  uint32_t below, above;       // margins; coarser terrains state none
  bool is_placed;              // the header's check has passed
  bool has_voids;              // whether `voids` is decoded; coarser terrains know none
};

namespace microtin {

inline bool has_voids(const microtin_mesh& m) {
  return kBuiltVoids && m.has_voids;
}

MICROTIN_ONE_COPY inline bool has_terrain(const microtin_mesh& m, Index t) {
  return !is_ghost(m.mesh, t) && !(has_voids(m) && is_void(m.voids, t));
}

// Why it must not be asked yet; OK if it may.
inline microtin_query_result refusal_of(const microtin_mesh& m, uint32_t flags) {
  if (m.mesh.triangles == 0) return MICROTIN_QUERY_NOT_LOADED;
  const bool is_usable =
      m.verified_vertices == m.mesh.vertices || (flags & MICROTIN_FLAG_ALLOW_UNVERIFIED) != 0;
  return is_usable ? MICROTIN_QUERY_OK : MICROTIN_QUERY_UNVERIFIED;
}

MICROTIN_ONE_COPY inline void empty_mesh(microtin_mesh& m) {
  m.mesh.vertices = 0;
  m.mesh.triangles = 0;
  m.verified_vertices = 0;
  m.has_voids = false;
  m.is_placed = false;
  m.below = m.above = kNotStated;
}

enum class Item : uint8_t {
  kIdentity,
  kLength,  // of the header, or of a section's payload
  kHeader,  // up to its notes
  kPayloadStart,
  kStep,
  kRest,   // what is left of the header or the payload, not read
  kCheck,  // of the header, or of a section
};

}  // namespace microtin

struct microtin_decoder {
  microtin_mesh* mesh;
  uint32_t capacity;
  microtin_status status;  // NEED_INPUT while all is well
  uint32_t stop_phase;
  microtin::Item item;
  bool in_header;
  microtin_status verdict;  // OK, or what to say once the check ahead has passed
  microtin::RangeDecoder coder;
  microtin::Reconstruction reconstruction;
};

static_assert(sizeof(microtin_mesh) <= MICROTIN_MESH_BYTES(0), "see MICROTIN_MESH_BYTES");
static_assert(sizeof(microtin_decoder) <= MICROTIN_DECODER_BYTES(0), "see MICROTIN_DECODER_BYTES");

#endif
