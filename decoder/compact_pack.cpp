// SPDX-License-Identifier: MIT
// Packs that make tiles compact: between decoding a tile and telling that it is there.
#include "decoder/pack_state.hpp"
#include "decoder/ring.hpp"

namespace microtin {
namespace {

// A step of decoding takes as many instructions as all of these, or more.
constexpr uint32_t kItemsOfStep = 16;

// Whether a tile takes no more than the header says of any.
bool is_as_stated(const PackHeader& header, const microtin_compact& tile) {
  const uint32_t index_bytes = header.most_vertices <= MICROTIN_MAX_VERTICES_FOR(16) ? 2 : 4;
  return header.compact_bytes == 0 || compact_bytes(tile, index_bytes) <= header.compact_bytes;
}

// Makes the tile in hand compact. OK: it is there, or refused.
microtin_status store(microtin_pack& p, uint32_t step_limit) {
  if (p.compactor == nullptr) {
    const bool has_slot = choose_slot(p);
    if (is_waiting(p)) return MICROTIN_STATUS_STEP_LIMIT;
    if (!has_slot) return lack_slot(p);
    if (!empty_slot(p)) return MICROTIN_STATUS_STEP_LIMIT;
    microtin_compactor_init(p.slot->space, p.slot_bytes, p.work, p.decoder_space, p.decoder_bytes,
                            &p.compactor);
  }
  const uint32_t most = 0xFFFFFFFFu / kItemsOfStep;
  microtin_compact* compact = nullptr;
  const microtin_status status = microtin_compactor_run(
      p.compactor, &compact, (step_limit < most ? step_limit : most) * kItemsOfStep);
  if (status == MICROTIN_STATUS_STEP_LIMIT) return status;
  if (status != MICROTIN_STATUS_OK) return refuse_tile(p, MICROTIN_STATUS_TOO_BIG);
  if (!is_as_stated(p.header, *compact)) return refuse_tile(p, MICROTIN_STATUS_MALFORMED);
  return finish_tile(p, true);
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_compact_pack_init(void* workspace, size_t size, uint32_t slots,
                                           uint32_t capacity, uint32_t tile_bytes,
                                           microtin_pack** pack) {
  const uint64_t work_bytes = MICROTIN_PACK_ROUND(MICROTIN_MESH_BYTES(capacity));
  const uint64_t slot_bytes = MICROTIN_PACK_ROUND(uint64_t{tile_bytes});
  const microtin_status status =
      lay_out_pack(workspace, size, slots, capacity, work_bytes, slot_bytes, pack);
  if (status != MICROTIN_STATUS_OK) return status;
  microtin_pack& p = **pack;
  return microtin_mesh_init(p.decoder_space + p.decoder_bytes, static_cast<size_t>(work_bytes),
                            &p.work);
}

microtin_status microtin_compact_pack_load(microtin_pack* pack, const microtin_segment* segment,
                                           uint32_t step_limit) {
  if (pack == nullptr || segment == nullptr) return MICROTIN_STATUS_ARGUMENT;
  if (pack->work == nullptr) return MICROTIN_STATUS_WRONG_PACK_KIND;
  microtin_status status = MICROTIN_STATUS_OK;
  while (status == MICROTIN_STATUS_OK ||
         (status == MICROTIN_STATUS_STEP_LIMIT && step_limit == 0)) {
    status = go_on(*pack, *segment);
    if (is_waiting(*pack)) return status;
    if (status == MICROTIN_STATUS_STEP_LIMIT) {
      status = decode(*pack, step_limit);
    } else if (status == MICROTIN_STATUS_STOPPED) {
      status = store(*pack, step_limit);
      if (is_waiting(*pack)) return status;
    } else {
      return status;
    }
  }
  return status;
}
