// SPDX-License-Identifier: MIT
// What JavaScript calls beside the decoder's own functions: much at a time, and what only the
// memory knows. Pointers are addresses in the module's memory.
#include "decoder/pack_state.hpp"

using namespace microtin;

// What the sources read by place.
static_assert(offsetof(microtin_pack_info, lowest) == 20 &&
                  offsetof(microtin_pack_info, below) == 24 &&
                  offsetof(microtin_pack_info, x) == 32 &&
                  offsetof(microtin_stream_info, below) == 16 &&
                  offsetof(microtin_stream_info, x) == 24 &&
                  offsetof(microtin_stream_info, mesh_bytes) == 96,
              "see src/pack.js and src/terrain.js");

extern "C" {

// --- Streams.

// Feeds until one more section has passed its check, or `steps` are done. As microtin_decoder_feed
// else.
uint32_t feed_section(microtin_decoder* decoder, const uint8_t* bytes, uint32_t size,
                      uint32_t steps, size_t* used) {
  const uint32_t verified = decoder->mesh->verified_vertices;
  uint32_t taken = 0;
  microtin_status status = MICROTIN_STATUS_STEP_LIMIT;
  for (uint32_t i = 0; i < steps && status == MICROTIN_STATUS_STEP_LIMIT; ++i) {
    status = microtin_decoder_feed(decoder, bytes + taken, size - taken, used, 1);
    taken += static_cast<uint32_t>(*used);
    if (decoder->mesh->verified_vertices != verified) break;
  }
  *used = taken;
  return status;
}

// Vertices of the sections that have passed their checks.
uint32_t verified_vertices(const microtin_mesh* mesh) {
  return mesh->verified_vertices;
}

// Writes x, y and z of each vertex.
void vertices(const microtin_mesh* mesh, int32_t* to) {
  for (uint32_t v = 0; v < microtin_mesh_vertex_count(mesh); ++v, to += 3) {
    uint16_t x, y;
    int16_t z;
    microtin_mesh_vertex(mesh, v, &x, &y, &z);
    to[0] = x;
    to[1] = y;
    to[2] = z;
  }
}

// Writes the vertices of each triangle of a kind; returns how many there are.
uint32_t triangles(const microtin_mesh* mesh, uint32_t kind, uint32_t* to) {
  uint32_t count = 0;
  for (uint32_t t = 0; t < microtin_mesh_triangle_count(mesh); ++t) {
    if (static_cast<uint32_t>(microtin_mesh_triangle(mesh, t, to + 3 * count)) == kind) ++count;
  }
  return count;
}

// --- Packs.

// More than memory can be where they are too many.
double pack_bytes(uint32_t slots, uint32_t capacity) {
  return static_cast<double>(MICROTIN_PACK_BYTES(uint64_t{slots}, uint64_t{capacity}));
}

// Like microtin_pack_load without a step limit, but returns STEP_LIMIT as soon as the tile in
// hand has more than `verified` vertices and all of them have passed their checks. A tile of
// another segment is given up. JavaScript has kept its bytes, so they are not downloaded again.
uint32_t prepare_section(microtin_pack* pack, const microtin_segment* segment, uint32_t verified) {
  pack->tile_priority = kNoRequest;
  microtin_status status = MICROTIN_STATUS_OK;
  while (status == MICROTIN_STATUS_OK) {
    status = go_on(*pack, *segment);
    if (status != MICROTIN_STATUS_STEP_LIMIT) return status;
    const auto& mesh = *static_cast<const microtin_mesh*>(pack->slot->space);
    while (status == MICROTIN_STATUS_STEP_LIMIT) {
      const uint32_t vertices = mesh.mesh.vertices;
      if (pack->start == MICROTIN_STATUS_OK && vertices > verified &&
          vertices == mesh.verified_vertices) {
        return status;
      }
      status = decode(*pack, 1);
    }
  }
  return status;
}

// The mesh of a tile that is there, or that is just being read; null if it is neither, or has no
// terrain.
const microtin_mesh* tile_mesh(const microtin_pack* pack, uint32_t tile) {
  const uint32_t ready = slot_of(*pack, tile);
  const PackSlot* slot = pack->slots + ready;
  if (ready == pack->slot_count) {
    if (pack->stage != PackStage::kStream || pack->tile != tile) return nullptr;
    slot = pack->slot;
    if (slot == nullptr) return nullptr;
  } else if (!slot->has_terrain) {
    return nullptr;
  }
  return static_cast<const microtin_mesh*>(slot->space);
}

// Where the index has the entry of a tile.
double entry_start(const microtin_pack* pack, uint32_t tile) {
  return static_cast<double>(pack_entry_start(pack->header, tile));
}

// Returns the bytes of a tile's stream, which begins at *offset, by its entry of the index. 0 if
// the tile has no terrain, or -1 if the entry breaks a rule or its check.
int32_t read_entry(microtin_pack* pack, uint32_t tile, const uint8_t* bytes, double* offset) {
  PackEntry entry{};
  if (read_entry(*pack, tile, bytes, &entry) != MICROTIN_STATUS_OK) return -1;
  *offset = static_cast<double>(entry.offset);
  return static_cast<int32_t>(entry.size);
}

// The vertices of a tile by the first bytes of its stream; 0 if these are not understood.
uint32_t announced_vertices(const microtin_pack* pack, uint32_t tile, const uint8_t* bytes,
                            uint32_t size) {
  Contract contract;
  const microtin_status status =
      read_tile_header(bytes, size, pack->header, tile_box(pack->header.grid, tile), &contract);
  return status == MICROTIN_STATUS_OK ? contract.vertices : 0;
}

// Where the stream that is being read ends; 0 if none is.
double stream_end(const microtin_pack* pack) {
  if (pack->stage != PackStage::kStream) return 0;
  return static_cast<double>(pack->entry.offset + pack->entry.size);
}
}
