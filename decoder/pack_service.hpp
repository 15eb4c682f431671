// SPDX-License-Identifier: MIT
// Serving packs: what both kinds of slots share.
#ifndef MICROTIN_DECODER_PACK_SERVICE_HPP
#define MICROTIN_DECODER_PACK_SERVICE_HPP

#include "decoder/pack_state.hpp"

namespace microtin {

// Lays out a pack with `work_bytes` in front of the slots and `slot_bytes` for each slot. The
// status is that of microtin_pack_init.
microtin_status lay_out_pack(void* workspace, size_t size, uint32_t slots, uint32_t capacity,
                             uint64_t work_bytes, uint64_t slot_bytes, microtin_pack** pack);

// Goes on with a segment, up to where its next tile is to be decoded (STEP_LIMIT) or made compact
// (STOPPED).
microtin_status go_on(microtin_pack& p, const microtin_segment& segment);

// Chooses a slot for the tile in hand. False if all are wanted by the segment in hand.
bool choose_slot(microtin_pack& p);

// Ends with the tile in hand, which is good, but for which there is no slot. OK.
microtin_status lack_slot(microtin_pack& p);

// Queries do not look at an empty slot, so the order of these writes matters to those that
// interrupt.
inline void set_state(PackSlot& slot, SlotState state) {
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
  slot.state = state;
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
}

// Ends with the tile in hand: it is in the slot, or to be remembered as bad. OK.
microtin_status finish_tile(microtin_pack& p, bool has_terrain);
microtin_status refuse_tile(microtin_pack& p, microtin_status why);

// Gives up what is in hand, and returns the status.
microtin_status fail_pack(microtin_pack& p, microtin_status status);

// What follows from what the decoder said, but for STEP_LIMIT. OK: the tile is ready, or refused;
// STEP_LIMIT: it is to be made compact next.
microtin_status hear_decoder(microtin_pack& p, microtin_status status);

// Decodes what is in the buffer: in place, so that only the caller's frame lies above the
// decoder's.
MICROTIN_IN_PLACE inline microtin_status decode(microtin_pack& p, uint32_t step_limit) {
  size_t used = 0;
  const microtin_status status = microtin_decoder_feed(
      p.decoder, p.buffer + p.fed, static_cast<size_t>(p.buffered - p.fed), &used, step_limit);
  p.fed = static_cast<uint8_t>(p.fed + used);
  return status == MICROTIN_STATUS_STEP_LIMIT ? status : hear_decoder(p, status);
}

}  // namespace microtin

#endif
