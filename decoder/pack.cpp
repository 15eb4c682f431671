// Reading packs: which tiles are wanted, which are there, and bringing the one to the other.
#include "decoder/pack_state.hpp"

namespace microtin {
namespace {

void want(microtin_pack& p, PackStage stage, uint64_t offset, uint32_t size) {
  p.stage = stage;
  p.next = offset;
  p.buffered = 0;
  p.fed = 0;
  p.is_counted = false;
  p.wanted = static_cast<uint8_t>(size < kPackBuffer ? size : kPackBuffer);
}

// Queries do not look at an empty slot, so the order of these writes matters to those that
// interrupt.
void set_state(PackSlot& slot, SlotState state) {
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
  slot.state = state;
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
}

// Gives up what is in hand; begins again with the header if that is not known.
void give_up(microtin_pack& p) {
  if (p.has_header) {
    want(p, PackStage::kIdle, 0, 0);
    return;
  }
  place_on_lattice(p.axis);
  want(p, PackStage::kFixed, 0, kPackFixedBytes);
}

microtin_status fail(microtin_pack& p, microtin_status status) {
  give_up(p);
  return status;
}

// --- The header. The bytes of each item are in the buffer when it is handled.

void want_notes(microtin_pack& p, uint64_t offset) {
  if (p.left != 0) {
    want(p, PackStage::kNotes, offset, p.left);
  } else {
    want(p, PackStage::kCheck, offset, kCheckBytes);
  }
}

microtin_status handle_fixed(microtin_pack& p) {
  const microtin_status known = check_pack_identity(p.buffer);
  if (known != MICROTIN_DONE) return fail(p, known);
  if (!read_pack_header(p.buffer, &p.header)) return fail(p, MICROTIN_MALFORMED);
  p.crc = crc32(0, p.buffer, kPackFixedBytes);
  p.left = p.header.note_bytes;
  if (p.header.placement_bytes == 0) {
    want_notes(p, kPackFixedBytes);
  } else {
    want(p, PackStage::kPlacement, kPackFixedBytes, p.header.placement_bytes);
  }
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_placement(microtin_pack& p) {
  if (!read_pack_placement(p.buffer, p.header, p.axis)) return fail(p, MICROTIN_MALFORMED);
  p.crc = crc32(p.crc, p.buffer, p.buffered);
  want_notes(p, kPackFixedBytes + p.header.placement_bytes);
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_notes(microtin_pack& p) {
  p.crc = crc32(p.crc, p.buffer, p.buffered);
  p.left -= p.buffered;
  want_notes(p, p.next);
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_check(microtin_pack& p) {
  if (read_u32(p.buffer) != p.crc) return fail(p, MICROTIN_CHECKSUM);
  want(p, PackStage::kIdle, 0, 0);
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
  p.has_header = true;
  return MICROTIN_NEED_INPUT;
}

// --- A tile.

// The slot that has not been wanted for the longest time; those of the course in hand are kept.
PackSlot* slot_to_fill(microtin_pack& p) {
  PackSlot* oldest = nullptr;
  for (uint32_t i = 0; i < p.slot_count; ++i) {
    PackSlot& slot = p.slots[i];
    if (slot.state == SlotState::kEmpty) return &slot;
    const uint32_t age = p.clock - slot.wanted;
    if (age != 0 && (oldest == nullptr || age > p.clock - oldest->wanted)) oldest = &slot;
  }
  return oldest;
}

microtin_status finish_tile(microtin_pack& p) {
  PackSlot& slot = p.slots[p.slot];
  slot.tile = p.tile;
  slot.wanted = p.clock;
  set_state(slot, SlotState::kReady);
  want(p, PackStage::kIdle, 0, 0);
  return MICROTIN_DONE;
}

microtin_status handle_entry(microtin_pack& p) {
  if (pack_entry_check(p.crc, p.tile, p.buffer) !=
      read_u32(p.buffer + kPackEntryBytes - kCheckBytes)) {
    return fail(p, MICROTIN_CHECKSUM);
  }
  if (!read_pack_entry(p.buffer, p.header, &p.entry)) return fail(p, MICROTIN_MALFORMED);
  if (p.entry.vertices > p.capacity) return fail(p, MICROTIN_TOO_BIG);
  PackSlot* const slot = slot_to_fill(p);
  if (slot == nullptr) return fail(p, MICROTIN_WORKSPACE_TOO_SMALL);
  p.slot = static_cast<uint8_t>(slot - p.slots);
  set_state(*slot, SlotState::kEmpty);
  microtin_decoder_init(p.decoder_space, p.decoder_bytes, slot->mesh, &p.decoder);
  if (p.entry.size == 0) return finish_tile(p);  // the mesh is empty now
  p.left = p.entry.size;
  p.stream_hash = kStreamHash;
  want(p, PackStage::kStream, p.entry.offset, p.left);
  return MICROTIN_NEED_INPUT;
}

// Whether what was decoded is the tile that the index tells of.
bool is_tile(const microtin_pack& p) {
  const TileBox box = tile_box(p.header.grid, p.tile);
  const Contract& contract = p.decoder->reconstruction.contract;
  return p.left == 0 && p.fed == p.buffered && p.stream_hash == p.entry.stream_hash &&
         contract.vertices == p.entry.vertices && contract.x_max <= box.x_end - box.x &&
         contract.y_max <= box.y_end - box.y;
}

microtin_status handle_stream(microtin_pack& p, uint32_t step_limit) {
  if (!p.is_counted) {
    p.is_counted = true;
    p.stream_hash = stream_hash(p.stream_hash, p.buffer, p.buffered);
    p.left -= p.buffered;
  }
  size_t used = 0;
  const microtin_status status = microtin_feed(
      p.decoder, p.buffer + p.fed, static_cast<size_t>(p.buffered - p.fed), step_limit, &used);
  p.fed = static_cast<uint8_t>(p.fed + used);
  if (status == MICROTIN_STEP_LIMIT) return status;
  if (status == MICROTIN_NEED_INPUT && p.left != 0) {
    want(p, PackStage::kStream, p.next, p.left);
    return status;
  }
  if (status == MICROTIN_DONE && is_tile(p)) return finish_tile(p);
  return fail(p, MICROTIN_CHECKSUM);
}

// Handles what is in the buffer, if it is complete. DONE: a tile is ready.
microtin_status handle(microtin_pack& p, uint32_t step_limit) {
  if (p.buffered < p.wanted) return MICROTIN_NEED_INPUT;
  switch (p.stage) {
    case PackStage::kFixed:
      return handle_fixed(p);
    case PackStage::kPlacement:
      return handle_placement(p);
    case PackStage::kNotes:
      return handle_notes(p);
    case PackStage::kCheck:
      return handle_check(p);
    case PackStage::kEntry:
      return handle_entry(p);
    case PackStage::kStream:
      return handle_stream(p, step_limit);
    case PackStage::kIdle:
      break;
  }
  return MICROTIN_DONE;
}

// What a course wants of a pack: notes which slots it touches, and finds the first tile that is not
// there.
struct Wishes {
  bool complete;
  bool in_hand;  // the tile that is being read is among them
  uint32_t first_absent;
};

Wishes wishes_of(microtin_pack& p, const microtin_course& course) {
  Wishes wishes = {true, false, 0};
  ++p.clock;
  uint32_t left = p.slot_count + 1u;  // one that does not fit is enough to know
  for (TouchedTiles tiles(p.header.grid, course); !tiles.at_end() && left != 0; tiles.next()) {
    --left;
    const uint32_t tile = tiles.number(), slot = slot_of(p, tile);
    wishes.in_hand = wishes.in_hand || tile == p.tile;
    if (slot != p.slot_count) {
      p.slots[slot].wanted = p.clock;
    } else if (wishes.complete) {
      wishes.complete = false;
      wishes.first_absent = tile;
    }
  }
  return wishes;
}

microtin_status prepare_tile(microtin_pack& p, const microtin_course& course, uint32_t step_limit) {
  microtin_status status = MICROTIN_DONE;
  // Once a tile is finished, the next one wants input first.
  for (int finished = 0; status == MICROTIN_DONE && finished < 2; ++finished) {
    const Wishes wishes = wishes_of(p, course);
    if (p.stage != PackStage::kIdle && !wishes.in_hand) give_up(p);
    if (p.stage == PackStage::kIdle) {
      if (wishes.complete) return MICROTIN_DONE;
      p.tile = wishes.first_absent;
      want(p, PackStage::kEntry, pack_entry_start(p.header, p.tile), kPackEntryBytes);
    }
    status = handle(p, step_limit);
  }
  return status;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_pack_init(void* workspace, size_t size, uint32_t slots, uint32_t capacity,
                                   microtin_pack** pack) {
  if (workspace == nullptr || pack == nullptr || slots == 0 || slots > 255 || capacity < 3 ||
      capacity > MICROTIN_MAX_VERTICES) {
    return MICROTIN_ARGUMENT;
  }
  *pack = nullptr;
  if (reinterpret_cast<uintptr_t>(workspace) % MICROTIN_ALIGNMENT != 0) return MICROTIN_MISALIGNED;
  const uint64_t own_bytes = MICROTIN_PACK_ROUND(sizeof(microtin_pack) + slots * sizeof(PackSlot));
  const uint64_t decoder_bytes = MICROTIN_PACK_ROUND(MICROTIN_DECODER_BYTES(capacity));
  const uint64_t mesh_bytes = MICROTIN_PACK_ROUND(MICROTIN_MESH_BYTES(capacity));
  // Below 2^8 * 2^31.
  if (own_bytes + decoder_bytes + slots * mesh_bytes > size) return MICROTIN_WORKSPACE_TOO_SMALL;
  microtin_pack& p = *static_cast<microtin_pack*>(workspace);
  p.slots = reinterpret_cast<PackSlot*>(&p + 1);
  p.slot_count = static_cast<uint8_t>(slots);
  p.capacity = capacity;
  p.decoder_space = static_cast<uint8_t*>(workspace) + own_bytes;
  p.decoder_bytes = static_cast<size_t>(decoder_bytes);
  uint8_t* mesh_space = p.decoder_space + decoder_bytes;
  for (uint32_t i = 0; i < slots; ++i, mesh_space += mesh_bytes) {
    microtin_mesh_init(mesh_space, static_cast<size_t>(mesh_bytes), &p.slots[i].mesh);
  }
  p.clock = 0;
  microtin_pack_reset(&p);
  *pack = &p;
  return MICROTIN_DONE;
}

void microtin_pack_reset(microtin_pack* pack) {
  microtin_pack& p = *pack;
  p.has_header = false;
  p.stage = PackStage::kFixed;
  p.tile = 0;
  for (uint32_t i = 0; i < p.slot_count; ++i) set_state(p.slots[i], SlotState::kEmpty);
  give_up(p);
}

microtin_status microtin_pack_prepare(microtin_pack* pack, const microtin_course* course,
                                      uint32_t step_limit) {
  if (pack == nullptr || course == nullptr || !is_legal(*course)) return MICROTIN_ARGUMENT;
  if (!pack->has_header) {
    const microtin_status status = handle(*pack, step_limit);
    if (!pack->has_header) return status;
  }
  return prepare_tile(*pack, *course, step_limit);
}

void microtin_pack_wanted(microtin_pack* pack, uint64_t* offset, uint8_t** buffer, size_t* size) {
  *offset = pack->next;
  *buffer = pack->buffer + pack->buffered;
  *size = static_cast<size_t>(pack->wanted - pack->buffered);
}

void microtin_pack_given(microtin_pack* pack, size_t size) {
  const size_t most = static_cast<size_t>(pack->wanted - pack->buffered);
  const uint8_t taken = static_cast<uint8_t>(size < most ? size : most);
  pack->buffered = static_cast<uint8_t>(pack->buffered + taken);
  pack->next += taken;
}
