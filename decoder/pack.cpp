// SPDX-License-Identifier: MIT
// Reading packs: which tiles are wanted, which are there, and bringing the one to the other.
#include "decoder/pack_state.hpp"

namespace microtin {
namespace {

// Bytes of the buffer in front of the entries that are kept.
uint32_t room_of(const microtin_pack& p) {
  return kHasSectors ? kPackBuffer - p.kept * kPackEntryBytes : kPackBuffer;
}

// From where the last bytes ended, unless `next` is set too.
MICROTIN_ONE_COPY void want(microtin_pack& p, PackStage stage, uint32_t size) {
  const uint32_t room = room_of(p);
  p.stage = stage;
  p.read.buffered = 0;
  p.fed = 0;
  p.is_counted = false;
  p.read.wanted = static_cast<uint8_t>(size < room ? size : room);
}

// Gives up what is in hand; begins again with the header if that is not known.
void give_up(microtin_pack& p) {
  if (p.has_header) {
    want(p, PackStage::kIdle, 0);
    return;
  }
  place_on_lattice(p.axis);
  p.next = 0;
  want(p, PackStage::kFixed, kPackFixedBytes);
}

// --- The header. The bytes of each item are in the buffer when it is handled.

void want_notes(microtin_pack& p) {
  if (p.left != 0) {
    want(p, PackStage::kNotes, p.left);
  } else {
    want(p, PackStage::kCheck, kCheckBytes);
  }
}

// What a header breaks, or what of it is unknown, is reported once its check has passed: before
// that, it is damage.
MICROTIN_IN_PLACE inline microtin_status handle_fixed(microtin_pack& p) {
  const microtin_status known = check_pack_identity(p.buffer);
  if (known != MICROTIN_STATUS_OK) return fail_pack(p, known);
  p.start = static_cast<uint8_t>(read_pack_header(p.buffer, &p.header));
  p.sum = crc32(0, p.buffer, kPackFixedBytes);
  p.left = p.header.note_bytes;
  if (p.start == MICROTIN_STATUS_OK && p.header.placement_bytes != 0) {
    want(p, PackStage::kPlacement, p.header.placement_bytes);
  } else {
    p.left += p.header.placement_bytes;  // one that is not read counts as a note
    want_notes(p);
  }
  return MICROTIN_STATUS_NEED_INPUT;
}

// What is in the buffer counts for the check.
MICROTIN_OUT_OF_LINE microtin_status go_on_to_notes(microtin_pack& p) {
  p.sum = crc32(p.sum, p.buffer, p.read.buffered);
  want_notes(p);
  return MICROTIN_STATUS_NEED_INPUT;
}

microtin_status handle_placement(microtin_pack& p) {
  if (!read_pack_placement(p.buffer, p.header, p.axis)) p.start = MICROTIN_STATUS_MALFORMED;
  return go_on_to_notes(p);
}

microtin_status handle_notes(microtin_pack& p) {
  p.left -= p.read.buffered;
  return go_on_to_notes(p);
}

microtin_status handle_check(microtin_pack& p) {
  if (read_u32(p.buffer) != p.sum) return fail_pack(p, MICROTIN_STATUS_CHECKSUM);
  if (p.start != MICROTIN_STATUS_OK) return fail_pack(p, static_cast<microtin_status>(p.start));
  want(p, PackStage::kIdle, 0);
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
  MICROTIN_PACK_ENTER();
  p.has_header = true;
  MICROTIN_PACK_LEAVE();
  return MICROTIN_STATUS_NEED_INPUT;
}

// --- A tile.

// The place to be filled next, a slot or what is known of a bad tile: an empty one, or that which
// has not been wanted for the longest time. Those of the segment in hand are kept, and those of
// requests that are as important: null if all are.
template <class Place>
Place* place_to_fill(Place* places, uint32_t count, microtin_pack& p) {
  Place* oldest = nullptr;
  uint32_t most = 0;
  bool is_any_pinned = false;
  for (uint32_t i = 0; i < count; ++i) {
    Place& place = places[i];
    if (place.is_empty()) return &place;
    const uint32_t age = place.is_kept(p.priority) ? 0 : p.clock - place.wanted;
    if (age > most && place.is_pinned()) {
      is_any_pinned = true;
    } else if (age > most) {
      most = age;
      oldest = &place;
    }
  }
  if (kPins) p.is_waiting = oldest == nullptr && is_any_pinned;
  return oldest;
}

// For the same reason as set_state.
void set_why(BadTile& bad, microtin_status why) {
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
  MICROTIN_PACK_ENTER();
  bad.why = static_cast<uint8_t>(why);
  MICROTIN_PACK_LEAVE();
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
}

void forget_bad_tiles(microtin_pack& p) {
  for (BadTile& bad : p.bad) set_why(bad, MICROTIN_STATUS_OK);
  p.has_passed = false;
  p.kept = 0;
}

}  // namespace

MICROTIN_ONE_COPY microtin_status fail_pack(microtin_pack& p, microtin_status status) {
  give_up(p);
  return status;
}

MICROTIN_ONE_COPY bool choose_slot(microtin_pack& p) {
  p.slot = p.only_checks ? nullptr : place_to_fill(p.slots, p.slot_count, p);
  return p.slot != nullptr;
}

namespace {

void remember_bad(microtin_pack& p, uint32_t tile, microtin_status why) {
  BadTile* const bad = place_to_fill(p.bad, MICROTIN_PACK_MAX_BAD_TILES, p);
  if (bad != nullptr) {
    set_why(*bad, MICROTIN_STATUS_OK);
    bad->tile = tile;
    bad->wanted = p.clock;
    set_why(*bad, why);
  } else {
    p.passed = tile;
    p.has_passed = true;
  }
}

}  // namespace

microtin_status refuse_tile(microtin_pack& p, microtin_status why) {
  remember_bad(p, p.tile, why);
  return fail_pack(p, MICROTIN_STATUS_OK);
}

microtin_status finish_tile(microtin_pack& p, bool has_terrain) {
  PackSlot& slot = *p.slot;
  slot.tile = p.tile;
  slot.wanted = p.clock;
  slot.loaded = static_cast<uint16_t>(p.clock >> 4);
  slot.has_terrain = has_terrain;
  set_state(slot, SlotState::kReady);
  return fail_pack(p, MICROTIN_STATUS_OK);
}

MICROTIN_ONE_COPY microtin_status read_entry(microtin_pack& p, uint32_t tile, const uint8_t* bytes,
                                             PackEntry* entry) {
  if (pack_entry_check(p.header.identity, tile, bytes) !=
      read_u32(bytes + kPackEntryBytes - kCheckBytes)) {
    p.kept = 0;  // it may be read better
    return MICROTIN_STATUS_CHECKSUM;
  }
  return read_pack_entry(bytes, p.header, entry) ? MICROTIN_STATUS_OK : MICROTIN_STATUS_MALFORMED;
}

MICROTIN_ONE_COPY microtin_status lack_slot(microtin_pack& p) {
  p.is_sound = true;
  return fail_pack(p, MICROTIN_STATUS_OK);
}

namespace {

// The entry of a tile that was read with another one; null: none was.
const uint8_t* kept_entry(const microtin_pack& p, uint32_t tile) {
  const uint32_t place = tile - p.kept_from;
  return kHasSectors && place < p.kept ? p.buffer + room_of(p) + place * kPackEntryBytes : nullptr;
}

// Wants the entry of the tile in hand, or takes it from those that are kept. From a card the next
// ones come with it: another read, after the stream, would want their sector once more.
MICROTIN_IN_PLACE inline void want_entry(microtin_pack& p, uint32_t tile) {
  p.tile = tile;
  p.tile_priority = p.only_checks ? kNoRequest : p.priority;
  p.is_sound = false;
  const uint8_t* const kept = kept_entry(p, tile);
  if (kept != nullptr) {
    __builtin_memcpy(p.buffer, kept, kPackEntryBytes);
    want(p, PackStage::kEntry, kPackEntryBytes);
    p.read.buffered = p.read.wanted;
    return;
  }
  const TileGrid& grid = p.header.grid;
  const uint32_t left = tile_columns(grid) * tile_rows(grid) - tile;
  const uint32_t most = kHasSectors && p.sector != 0 ? kEntriesOfRead : 1;
  p.kept = 0;
  p.next = pack_entry_start(p.header, tile);
  want(p, PackStage::kEntry, kPackEntryBytes * (left < most ? left : most));
}

// Moves the entries behind the first one to the buffer's end.
MICROTIN_IN_PLACE inline void keep_entries(microtin_pack& p) {
  p.kept = static_cast<uint8_t>(p.read.buffered / kPackEntryBytes - 1);
  p.kept_from = p.tile + 1;
  __builtin_memmove(p.buffer + room_of(p), p.buffer + kPackEntryBytes,
                    p.kept * static_cast<size_t>(kPackEntryBytes));
}

microtin_mesh* mesh_to_fill(const microtin_pack& p, const PackSlot& slot) {
  return p.work != nullptr ? p.work : static_cast<microtin_mesh*>(slot.space);
}

// Takes the entry that is in the buffer, as read_entry.
MICROTIN_IN_PLACE inline microtin_status take_entry(microtin_pack& p) {
  if (kHasSectors && p.read.buffered > kPackEntryBytes) keep_entries(p);
  return read_entry(p, p.tile, p.buffer, &p.entry);
}

// Where there is no slot, the stream is compared with its hash: only a good tile wants one.
microtin_status handle_entry(microtin_pack& p) {
  const microtin_status taken = take_entry(p);
  if (taken != MICROTIN_STATUS_OK) return refuse_tile(p, taken);
  const bool has_slot = choose_slot(p);
  // What is to be made compact needs its slot not before then.
  const bool is_emptied = has_slot && (p.work == nullptr || p.entry.size == 0) && empty_slot(p);
  if (is_waiting(p)) {
    p.read.wanted = p.read.buffered = kPackEntryBytes;  // the others are kept
    return MICROTIN_STATUS_STEP_LIMIT;
  }
  if (has_slot) {
    if (is_emptied && p.entry.size == 0) return finish_tile(p, false);
    microtin_decoder_init(p.decoder_space, p.decoder_bytes, mesh_to_fill(p, *p.slot), &p.decoder);
  } else if (p.entry.size == 0) {
    return lack_slot(p);
  }
  p.left = p.entry.size;
  p.sum = kStreamHash;
  p.next = p.entry.offset;
  want(p, PackStage::kStream, p.left);
  return MICROTIN_STATUS_NEED_INPUT;
}

// What the first bytes of a stream say of the tile.
microtin_status start_of_tile(const microtin_pack& p) {
  Contract contract;
  const microtin_status status = read_tile_header(p.buffer, p.read.buffered, p.header,
                                                  tile_box(p.header.grid, p.tile), &contract);
  if (status != MICROTIN_STATUS_OK) return status;
  return contract.vertices > mesh_to_fill(p, *p.slots)->capacity ? MICROTIN_STATUS_TOO_BIG
                                                                 : MICROTIN_STATUS_OK;
}

// Counts what came of the stream. STEP_LIMIT: it is to be decoded. A stream of a later version is
// only compared with its hash: damage might have made it look like one.
microtin_status handle_stream(microtin_pack& p) {
  if (!p.is_counted) {
    if (p.left == p.entry.size) p.start = static_cast<uint8_t>(start_of_tile(p));
    if (p.start == MICROTIN_STATUS_UNSUPPORTED_VERSION) p.slot = nullptr;
    p.is_counted = true;
    p.sum = stream_hash(p.sum, p.buffer, p.read.buffered);
    p.left -= p.read.buffered;
  }
  return p.slot != nullptr ? MICROTIN_STATUS_STEP_LIMIT
                           : take_decoder_status(p, MICROTIN_STATUS_OK);
}

// Handles what is in the buffer, if it is complete. OK: a tile is ready, or refused, or lacks a
// slot; STOPPED: the tile is decoded, and a pack with compact slots must make it compact.
MICROTIN_ONE_COPY MICROTIN_OUT_OF_LINE microtin_status handle(microtin_pack& p) {
  if (p.read.buffered < p.read.wanted) return MICROTIN_STATUS_NEED_INPUT;
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
      return handle_stream(p);
    case PackStage::kIdle:
      return MICROTIN_STATUS_OK;
    case PackStage::kStore:
      break;
  }
  return MICROTIN_STATUS_STOPPED;
}

// What a segment wants of a pack.
struct Wishes {
  bool is_any;   // a tile is neither there nor known to be bad, nor was it tried
  bool in_hand;  // the tile that is being read is among them
  bool has_bad;
  uint32_t first;  // the first if there is any
};

// Notes the slots and bad tiles that the segment meets from here on, up to one good or unknown tile
// more than there are slots, and the first of the unknown ones.
MICROTIN_OUT_OF_LINE void look_along(microtin_pack& p, TouchedTiles& tiles, Wishes* wishes) {
  uint32_t left = p.slot_count + 1u;  // one that does not fit is enough to know
  for (; !tiles.at_end() && left != 0; tiles.next()) {
    const uint32_t tile = tiles.number(), slot = slot_of(p, tile), bad = bad_tile(p, tile);
    if (p.has_passed && tile == p.passed) continue;
    wishes->in_hand = wishes->in_hand || tile == p.tile;
    if (bad != MICROTIN_PACK_MAX_BAD_TILES) {
      p.bad[bad].wanted = p.clock;
      wishes->has_bad = true;  // it needs no slot
      continue;
    }
    --left;
    if (slot != p.slot_count) {
      p.slots[slot].wanted = p.clock;
      continue;
    }
    if (!wishes->is_any) wishes->first = tile;
    wishes->is_any = true;
  }
}

// Notes which slots and bad tiles the segment meets, and goes to `passed`. False if the segment
// does not meet that. However many tiles were passed, none of them is looked at again.
bool go_to_passed(microtin_pack& p, TouchedTiles& tiles, Wishes* wishes) {
  for (uint32_t i = 0; i < p.slot_count; ++i) {
    PackSlot& slot = p.slots[i];
    if (!slot.is_empty() && tiles.go_to(slot.tile)) slot.wanted = p.clock;
  }
  for (BadTile& bad : p.bad) {
    if (!bad.is_empty() && tiles.go_to(bad.tile)) bad.wanted = p.clock;
  }
  wishes->has_bad = tiles.go_to(p.passed);
  return wishes->has_bad;
}

// Notes which slots and bad tiles the segment touches, and finds the first tile to be tried. What
// it needs on the stack is not there while a tile is decoded.
MICROTIN_ONE_COPY MICROTIN_OUT_OF_LINE Wishes wishes_of(microtin_pack& p,
                                                        const microtin_segment& segment) {
  Wishes wishes = {false, false, false, 0};
  begin_call(p);
  for (;;) {  // twice at most
    TouchedTiles tiles(p.header.grid, segment);
    if (p.has_passed) {
      p.has_passed = go_to_passed(p, tiles, &wishes);
      if (!p.has_passed) continue;  // from where the segment begins
    }
    look_along(p, tiles, &wishes);
    return wishes;
  }
}

// Takes up a segment: what was tried for another counts for that alone.
void take_up(microtin_pack& p, const microtin_segment& segment) {
  const uint32_t hash =
      stream_hash(kStreamHash, reinterpret_cast<const uint8_t*>(&segment), sizeof segment);
  if (hash != p.segment_hash) p.is_whole = false;
  p.segment_hash = hash;
}

// Whether storage reads next for the entry that is looked at: in turn with the tile in hand, if
// both want bytes.
bool is_look_next(const microtin_pack& p) {
  return p.look.read.wants() && !(p.look.was_last && p.read.wants());
}

uint64_t next_of(const microtin_pack& p) {
  return is_look_next(p) ? p.look.next : p.next;
}

// Bytes that are wanted next and lie in one sector.
uint32_t wanted_now(const microtin_pack& p) {
  const PackRead& read = is_look_next(p) ? p.look.read : p.read;
  const uint32_t left = static_cast<uint32_t>(read.wanted - read.buffered);
  if (!kHasSectors || p.sector == 0) return left;
  const uint32_t room = p.sector - (static_cast<uint32_t>(next_of(p)) & (p.sector - 1u));
  return left < room ? left : room;
}

uint8_t* place_of(microtin_pack& p) {
  return is_look_next(p) ? p.look.bytes + p.look.read.buffered : p.buffer + p.read.buffered;
}

// Where storage puts the bytes of a read.
uint8_t* landing_of(microtin_pack& p) {
#if MICROTIN_READ_ALIGNMENT > 1
  return p.landing + -reinterpret_cast<uintptr_t>(p.landing) % MICROTIN_READ_ALIGNMENT;
#else
  return place_of(p);
#endif
}

// What follows from what storage reported. NEED_INPUT: go on; OK: a tile was refused.
microtin_status take_storage_result(microtin_pack& p) {
  const Storage reported = p.read.storage;
  p.read.storage = Storage::kWell;
  // Only the first of the entries that one read brings is needed.
  if (reported != Storage::kWell && p.stage == PackStage::kEntry &&
      p.read.buffered >= kPackEntryBytes) {
    p.read.wanted = p.read.buffered;
    return MICROTIN_STATUS_NEED_INPUT;
  }
  if (reported == Storage::kFailed) return MICROTIN_STATUS_IO;
  if (reported == Storage::kEnds) {
    return p.has_header ? refuse_tile(p, MICROTIN_STATUS_TRUNCATED)
                        : fail_pack(p, MICROTIN_STATUS_TRUNCATED);
  }
  return MICROTIN_STATUS_NEED_INPUT;
}

}  // namespace

microtin_status take_decoder_status(microtin_pack& p, microtin_status status) {
  const bool is_decoded = status == MICROTIN_STATUS_OK;
  // What follows the last section counts for the hash.
  if (p.left != 0 && (is_decoded || status == MICROTIN_STATUS_NEED_INPUT)) {
    want(p, PackStage::kStream, p.left);
    return MICROTIN_STATUS_NEED_INPUT;
  }
  if (status == MICROTIN_STATUS_TOO_BIG) return refuse_tile(p, status);
  if (!is_decoded || p.sum != p.entry.stream_hash) return refuse_tile(p, MICROTIN_STATUS_CHECKSUM);
  if (p.start != MICROTIN_STATUS_OK) return refuse_tile(p, static_cast<microtin_status>(p.start));
  if (p.slot == nullptr) return lack_slot(p);
  if (p.work == nullptr) return finish_tile(p, true);
  want(p, PackStage::kStore, 0);
  p.compactor = nullptr;
  return MICROTIN_STATUS_STEP_LIMIT;
}

namespace {

// Whether the tile in hand, which the segment does not want, is given up for it: one that is less
// important, or that cannot be read.
bool gives_way(const microtin_pack& p) {
  return p.priority < p.tile_priority || p.read.storage == Storage::kFailed;
}

}  // namespace

microtin_status go_on(microtin_pack& p, const microtin_segment& segment) {
  if (!is_legal(segment)) return MICROTIN_STATUS_ARGUMENT;
  if (kPins) p.is_waiting = false;
  if (!p.has_header) {
    const microtin_status taken = take_storage_result(p);
    if (taken != MICROTIN_STATUS_NEED_INPUT) return taken;
    const microtin_status status = handle(p);
    if (!p.has_header) return status;
  }
  // Each time ends with a tile of which the entry was kept: the one after these wants input.
  microtin_status status = MICROTIN_STATUS_OK;
  while (status == MICROTIN_STATUS_OK) {
    const Wishes wishes = wishes_of(p, segment);
    if (!wishes.is_any || p.stage == PackStage::kIdle) take_up(p, segment);
    if (!wishes.is_any) {
      const bool is_all = !p.has_passed || p.is_whole;
      p.has_passed = false;
      if (is_all) return wishes.has_bad ? MICROTIN_STATUS_BAD_TILES : MICROTIN_STATUS_OK;
      continue;  // with those in front of the tile passed
    }
    if (p.stage != PackStage::kIdle && !wishes.in_hand && gives_way(p)) {
      give_up(p);
      p.read.storage = Storage::kWell;  // the tile that failed is given up
    }
    status = take_storage_result(p);
    if (status == MICROTIN_STATUS_OK) continue;
    if (status == MICROTIN_STATUS_IO) return status;
    if (p.stage == PackStage::kIdle) {
      if (p.is_sound && wishes.first == p.tile && !choose_slot(p)) {
        return is_waiting(p) ? MICROTIN_STATUS_STEP_LIMIT : MICROTIN_STATUS_WORKSPACE_TOO_SMALL;
      }
      if (!p.has_passed) p.is_whole = true;
      want_entry(p, wishes.first);
    }
    status = handle(p);
  }
  return status;
}

microtin_status bring_entry(microtin_pack& p, uint32_t tile, PackEntry* entry) {
  EntryLook& look = p.look;
  const uint64_t start = pack_entry_start(p.header, tile);
  const uint8_t* const kept = kept_entry(p, tile);
  if (kept != nullptr) {
    __builtin_memcpy(look.bytes, kept, kPackEntryBytes);
    look.read = PackRead{0, kPackEntryBytes, Storage::kWell};
  } else if (look.next != start + look.read.buffered) {
    look.next = start;
    look.read = PackRead{};
  }
  const Storage reported = look.read.storage;
  look.read.storage = Storage::kWell;
  if (reported == Storage::kFailed) return MICROTIN_STATUS_IO;
  look.read.wanted = kPackEntryBytes;
  if (reported == Storage::kWell && look.read.wants()) return MICROTIN_STATUS_NEED_INPUT;
  look.read = PackRead{};
  const microtin_status status = reported == Storage::kEnds
                                     ? MICROTIN_STATUS_TRUNCATED
                                     : read_entry(p, tile, look.bytes, entry);
  if (status == MICROTIN_STATUS_OK) return status;
  // A tile whose entry was read before is remembered.
  if (bad_tile(p, tile) == MICROTIN_PACK_MAX_BAD_TILES) remember_bad(p, tile, status);
  return MICROTIN_STATUS_BAD_TILES;
}

microtin_status lay_out_pack(void* workspace, size_t size, uint32_t slots, uint32_t capacity,
                             uint64_t work_bytes, uint64_t slot_bytes, microtin_pack** pack) {
  if (workspace == nullptr || pack == nullptr) return MICROTIN_STATUS_ARGUMENT;
  *pack = nullptr;
  if (slots == 0 || slots > 255 || capacity < 3 || capacity > MICROTIN_MAX_VERTICES) {
    return MICROTIN_STATUS_ARGUMENT;
  }
  if (reinterpret_cast<uintptr_t>(workspace) % MICROTIN_ALIGNMENT != 0)
    return MICROTIN_STATUS_MISALIGNED;
  const uint64_t own_bytes = MICROTIN_PACK_ROUND(sizeof(microtin_pack) + slots * sizeof(PackSlot));
  const uint64_t decoder_bytes = MICROTIN_PACK_ROUND(MICROTIN_DECODER_BYTES(capacity));
  const uint64_t before_slots = own_bytes + decoder_bytes + work_bytes;
  // Below 2^8 * 2^33.
  if (before_slots + slots * slot_bytes > size) return MICROTIN_STATUS_WORKSPACE_TOO_SMALL;
  microtin_pack& p = *static_cast<microtin_pack*>(workspace);
  uint8_t* const bytes = static_cast<uint8_t*>(workspace);
  p.slots = reinterpret_cast<PackSlot*>(&p + 1);
  p.slot_count = static_cast<uint8_t>(slots);
  p.decoder_space = bytes + own_bytes;
  p.decoder_bytes = static_cast<size_t>(decoder_bytes);
  p.slot_bytes = static_cast<size_t>(slot_bytes);
  for (uint32_t i = 0; i < slots; ++i) {
    if (kPins) p.slots[i].pins = 0;
    p.slots[i].space = bytes + static_cast<size_t>(before_slots) + i * p.slot_bytes;
  }
  p.clock = 0;
  p.segment_hash = 0;
  p.sector = 0;
  microtin_pack_reset(&p);
  *pack = &p;
  return MICROTIN_STATUS_OK;
}

}  // namespace microtin

using namespace microtin;

microtin_status microtin_pack_init(void* workspace, size_t size, uint32_t slots, uint32_t capacity,
                                   microtin_pack** pack) {
  const uint64_t slot_bytes = MICROTIN_PACK_ROUND(MICROTIN_MESH_BYTES(capacity));
  const microtin_status status =
      lay_out_pack(workspace, size, slots, capacity, 0, slot_bytes, pack);
  if (status != MICROTIN_STATUS_OK) return status;
  (*pack)->work = nullptr;
  for (uint32_t i = 0; i < slots; ++i) {
    microtin_mesh* mesh = nullptr;
    microtin_mesh_init((*pack)->slots[i].space, (*pack)->slot_bytes, &mesh);
  }
  return MICROTIN_STATUS_OK;
}

void microtin_pack_reset(microtin_pack* pack) {
  microtin_pack& p = *pack;
  p.has_header = false;
  p.read.storage = Storage::kWell;
  p.look = EntryLook{};
  p.tile = 0;
  p.is_sound = false;
  p.only_checks = false;
  p.priority = 0;
  p.slot = nullptr;
  forget_bad_tiles(p);
  for (uint32_t i = 0; i < p.slot_count; ++i) {
    set_state(p.slots[i], SlotState::kEmpty);
    p.slots[i].is_used = false;
    p.slots[i].priority = kNoRequest;
  }
  give_up(p);
}

microtin_status microtin_pack_align_reads(microtin_pack* pack, uint32_t sector) {
  if (pack == nullptr || sector > kMostSector || (sector & (sector - 1)) != 0)
    return MICROTIN_STATUS_ARGUMENT;
  pack->sector = static_cast<uint16_t>(sector);
  return MICROTIN_STATUS_OK;
}

microtin_status microtin_pack_load(microtin_pack* pack, const microtin_segment* segment,
                                   uint32_t step_limit) {
  if (pack == nullptr || segment == nullptr) return MICROTIN_STATUS_ARGUMENT;
  if (pack->work != nullptr) return MICROTIN_STATUS_WRONG_PACK_KIND;
  microtin_status status = MICROTIN_STATUS_OK;
  while (status == MICROTIN_STATUS_OK) {
    status = go_on(*pack, *segment);
    if (status != MICROTIN_STATUS_STEP_LIMIT || is_waiting(*pack)) return status;
    status = decode(*pack, step_limit);
  }
  return status;
}

int microtin_pack_is_waiting(const microtin_pack* pack) {
  return is_waiting(*pack) ? 1 : 0;
}

void microtin_pack_next_read(microtin_pack* pack, uint64_t* offset, uint8_t** buffer,
                             size_t* size) {
  *offset = next_of(*pack);
  *buffer = landing_of(*pack);
  *size = static_cast<size_t>(wanted_now(*pack));
}

void microtin_pack_complete_read(microtin_pack* pack, int32_t taken) {
  const int32_t most = static_cast<int32_t>(wanted_now(*pack));
  if (most == 0 || taken == MICROTIN_READ_NOT_READY) return;
  const bool is_look = is_look_next(*pack);
  PackRead& read = is_look ? pack->look.read : pack->read;
  if (taken <= 0 || taken > most) {
    read.storage = taken == 0 ? Storage::kEnds : Storage::kFailed;
  } else {
#if MICROTIN_READ_ALIGNMENT > 1
    __builtin_memcpy(place_of(*pack), landing_of(*pack), static_cast<size_t>(taken));
#endif
    read.buffered = static_cast<uint8_t>(read.buffered + taken);
    (is_look ? pack->look.next : pack->next) += static_cast<uint32_t>(taken);
  }
  pack->look.was_last = is_look;
}

microtin_status microtin_pack_bad_tile(const microtin_pack* pack, uint32_t i, uint32_t* tile,
                                       uint32_t* why) {
  if (i >= MICROTIN_PACK_MAX_BAD_TILES || pack->bad[i].is_empty()) {
    return MICROTIN_STATUS_NOT_FOUND;
  }
  *tile = pack->bad[i].tile;
  *why = pack->bad[i].why;
  return MICROTIN_STATUS_OK;
}

void microtin_pack_clear_bad_tiles(microtin_pack* pack) {
  forget_bad_tiles(*pack);
}
