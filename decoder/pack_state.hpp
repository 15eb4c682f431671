// SPDX-License-Identifier: MIT
// What the workspace of a pack holds, and how packs are served.
#ifndef MICROTIN_DECODER_PACK_STATE_HPP
#define MICROTIN_DECODER_PACK_STATE_HPP

#include "decoder/state.hpp"
#include "decoder/touched_tiles.hpp"
#include "microtin/compact_pack.h"
#include "shared/pack_format.hpp"

namespace microtin {

constexpr uint32_t kPackBuffer = 128;   // holds every item of the header but the notes
constexpr uint32_t kEntriesOfRead = 4;  // of the index, if reads are aligned
static_assert(kEntriesOfRead * kPackEntryBytes <= kPackBuffer, "they are read at once");
#ifdef MICROTIN_NO_SECTORS
constexpr uint32_t kMostSector = 0;
#else
constexpr uint32_t kMostSector = 32768;
#endif
constexpr bool kHasSectors = kMostSector != 0;
// A tile's stream begins with magic, version, a length, and a header without placement and notes.
constexpr uint32_t kTileHeaderMostBytes =
    kIdentityBytes + 1 + kHeaderMostBytes - kPlacementMostBytes;
static_assert(kPackBuffer - (kEntriesOfRead - 1) * kPackEntryBytes >=
                  (kPackEntryBytes > kTileHeaderMostBytes ? kPackEntryBytes : kTileHeaderMostBytes),
              "an entry, or all that read_tile_header looks at, has room in front of those kept");

// What is read next.
enum class PackStage : uint8_t {
  kFixed,
  kPlacement,
  kNotes,
  kCheck,
  kIdle,
  kEntry,
  kStream,
  kStore  // nothing: a tile is decoded, and to be made compact
};

enum class SlotState : uint8_t { kEmpty, kReady };

// Whether queries of other threads pin the tiles that they use, under a lock of the user's.
#ifdef MICROTIN_PACK_ENTER
constexpr bool kPins = true;
#else
constexpr bool kPins = false;
#define MICROTIN_PACK_ENTER()
#define MICROTIN_PACK_LEAVE()
#endif

// A tile that is there, or room for one.
struct PackSlot {
  void* space;  // begins with a microtin_mesh, or a microtin_compact
  uint32_t tile;
  uint32_t wanted;           // when it was wanted last
  uint16_t loaded;           // when it was loaded, in 16 calls
  volatile SlotState state;  // queries may look only if it is ready
  bool has_terrain;
  volatile bool is_used;  // by a query, since a call noted its use
  uint8_t priority;       // of the requests that it serves; kNoRequest: of none
  uint8_t pins;           // queries that use it; changes under the lock

  bool is_pinned() const { return kPins && __atomic_load_n(&pins, __ATOMIC_RELAXED) != 0; }
  bool is_empty() const { return state == SlotState::kEmpty; }
  bool is_kept(uint8_t than) const { return priority <= than; }
};
constexpr uint8_t kNoRequest = 255;

// A tile that was refused, or room for one.
struct BadTile {
  uint32_t tile;
  uint32_t wanted;       // when it was wanted last
  volatile uint8_t why;  // a status; queries may look only if it is not OK

  bool is_empty() const { return why == MICROTIN_STATUS_OK; }
  bool is_kept(uint8_t) const { return false; }
  bool is_pinned() const { return false; }
};

// What storage reported of the bytes wanted.
enum class Storage : uint8_t { kWell, kEnds, kFailed };

// Bytes that are read one after another.
struct PackRead {
  uint8_t wanted, buffered;  // counts of those wanted next, and of those that came
  Storage storage;

  bool wants() const { return storage == Storage::kWell && buffered < wanted; }
};

// The entry of the index of which bounds are found. The tile in hand does not need it.
struct EntryLook {
  uint64_t next;  // where in the file its next byte is
  PackRead read;
  bool was_last;  // the last read was for it
  uint8_t bytes[kPackEntryBytes];
};

}  // namespace microtin

// What is small and used most comes first, where short instructions reach it.
struct microtin_pack {
  microtin::PackStage stage;
  volatile bool has_header;
  uint8_t slot_count;
  // The tile `passed` was bad, and there was no room to remember it. Those behind it on a segment
  // are tried before those in front of it, so that bad tiles never keep others from being tried.
  bool has_passed;
  bool is_whole;  // all of the segment in hand up to `passed` has been tried
  bool is_sound;  // the stream of `tile` is the right one, but there was no slot for it
  bool is_counted;
  bool only_checks;  // no tile gets a slot
  uint8_t start;     // a status: what the first bytes of a stream say of the tile, or of the header
  microtin::PackRead read;
  uint8_t fed;      // bytes of the buffer that were decoded
  uint8_t kept;     // entries of the index at the buffer's end
  uint16_t sector;  // no read crosses a multiple of it; a power of two, or 0: they may

  // The tile being read.
  uint32_t tile;
  uint32_t left;       // bytes of notes or stream, those in the buffer too until they are counted
  uint64_t next;       // where in the file
  uint32_t sum;        // of what came so far: the CRC-32 of the header, the hash of a stream
  uint32_t kept_from;  // the first one's tile
  uint32_t clock;
  uint32_t passed;
  uint32_t segment_hash;  // of the segment in hand
  uint8_t priority;       // of the request in hand: slots that serve one as important are kept
  bool is_waiting;        // every slot that might give way is pinned
  uint8_t tile_priority;  // of the request for `tile`; kNoRequest: it is only checked
  microtin::PackEntry entry;
  microtin_decoder* decoder;
  microtin_compactor* compactor;  // of the tile decoded; null: not begun

  microtin_mesh* work;  // where tiles are decoded that will be compact; null: in their slots
  microtin::PackSlot* slots;
  microtin::PackSlot* slot;  // being filled; null: the stream is only compared with its hash
  uint8_t* decoder_space;
  size_t decoder_bytes;
  size_t slot_bytes;
  microtin::PackHeader header;
  microtin_axis axis[3];
  microtin::BadTile bad[MICROTIN_PACK_MAX_BAD_TILES];
  microtin::EntryLook look;
  uint8_t buffer[microtin::kPackBuffer];
#if MICROTIN_READ_ALIGNMENT > 1
  uint8_t landing[microtin::kPackBuffer + MICROTIN_READ_ALIGNMENT - 1];  // where reads store bytes
#endif
};

static_assert(sizeof(microtin_pack) + 7 + MICROTIN_PACK_ROUND(MICROTIN_DECODER_BYTES(0)) <=
                  MICROTIN_PACK_BYTES(0, 0),
              "see MICROTIN_PACK_BYTES");
static_assert(sizeof(microtin::PackSlot) <= 24, "see MICROTIN_PACK_BYTES");
static_assert(sizeof(microtin_pack) % alignof(microtin::PackSlot) == 0, "slots follow it");

namespace microtin {

// The slot where a tile is; slot_count if it is not there.
MICROTIN_ONE_COPY inline uint32_t slot_of(const microtin_pack& p, uint32_t tile) {
  for (uint32_t i = 0; i < p.slot_count; ++i) {
    if (p.slots[i].state == SlotState::kReady && p.slots[i].tile == tile) return i;
  }
  return p.slot_count;
}

// Where it is remembered that a tile is bad; MICROTIN_PACK_MAX_BAD_TILES if it is not.
MICROTIN_ONE_COPY inline uint32_t bad_tile(const microtin_pack& p, uint32_t tile) {
  uint32_t i = 0;
  while (i < MICROTIN_PACK_MAX_BAD_TILES && (p.bad[i].is_empty() || p.bad[i].tile != tile)) ++i;
  return i;
}

// Lays out a pack with `work_bytes` in front of the slots and `slot_bytes` for each slot. The
// status is that of microtin_pack_init.
microtin_status lay_out_pack(void* workspace, size_t size, uint32_t slots, uint32_t capacity,
                             uint64_t work_bytes, uint64_t slot_bytes, microtin_pack** pack);

// Whether a call ends because slots are pinned.
MICROTIN_IN_PLACE inline bool is_waiting(const microtin_pack& p) {
  return kPins && p.is_waiting;
}

// Goes on with a segment, up to where its next tile is to be decoded (STEP_LIMIT, unless it waits
// for a slot) or made compact (STOPPED). A tile that another segment began to load comes first, so
// that those who load in turn all get their tiles.
microtin_status go_on(microtin_pack& p, const microtin_segment& segment);

// Whether a query used a slot since this was called last.
MICROTIN_IN_PLACE inline bool take_use(PackSlot& slot) {
  if (kPins) return __atomic_exchange_n(&slot.is_used, false, __ATOMIC_RELAXED);
  if (!slot.is_used) return false;
  slot.is_used = false;
  return true;
}

MICROTIN_IN_PLACE inline void note_use(PackSlot& slot) {
  if (kPins) {
    __atomic_store_n(&slot.is_used, true, __ATOMIC_RELAXED);
  } else {
    slot.is_used = true;
  }
}

// Reads a tile's entry. CHECKSUM or MALFORMED: the tile is bad.
microtin_status read_entry(microtin_pack& p, uint32_t tile, const uint8_t* bytes, PackEntry* entry);

// Brings a tile's entry to `entry` and to p.look.bytes; what is in hand stays. OK, or NEED_INPUT,
// IO, BAD_TILES.
microtin_status bring_entry(microtin_pack& p, uint32_t tile, PackEntry* entry);

// Begins a call: tiles that queries used were wanted after those of the call before.
inline void begin_call(microtin_pack& p) {
  ++p.clock;
  for (uint32_t i = 0; i < p.slot_count; ++i) {
    PackSlot& slot = p.slots[i];
    if (!take_use(slot)) continue;
    slot.wanted = p.clock;
  }
  ++p.clock;
}

// Chooses a slot for the tile in hand. False if all are wanted by the segment in hand.
bool choose_slot(microtin_pack& p);

// Ends with the tile in hand, which is good, but for which there is no slot. OK.
microtin_status lack_slot(microtin_pack& p);

// Queries do not look at an empty slot, so the order of these writes matters to those that
// interrupt.
inline void set_state(PackSlot& slot, SlotState state) {
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
  MICROTIN_PACK_ENTER();
  slot.state = state;
  MICROTIN_PACK_LEAVE();
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
}

// Empties the slot that was chosen. False if a query has pinned it since.
MICROTIN_IN_PLACE inline bool empty_slot(microtin_pack& p) {
  if (!kPins) {
    set_state(*p.slot, SlotState::kEmpty);
    return true;
  }
  MICROTIN_PACK_ENTER();
  p.is_waiting = p.slot->is_pinned();
  if (!p.is_waiting) p.slot->state = SlotState::kEmpty;
  MICROTIN_PACK_LEAVE();
  return !p.is_waiting;
}

// Ends with the tile in hand: it is in the slot, or to be remembered as bad. OK.
microtin_status finish_tile(microtin_pack& p, bool has_terrain);
microtin_status refuse_tile(microtin_pack& p, microtin_status why);

// Gives up what is in hand, and returns the status.
microtin_status fail_pack(microtin_pack& p, microtin_status status);

// What follows from what the decoder returned, but for STEP_LIMIT. OK: the tile is ready, or
// refused; STEP_LIMIT: it is to be made compact next.
microtin_status take_decoder_status(microtin_pack& p, microtin_status status);

// Decodes what is in the buffer: in place, so that only the caller's frame lies above the
// decoder's.
MICROTIN_IN_PLACE inline microtin_status decode(microtin_pack& p, uint32_t step_limit) {
  size_t used = 0;
  const microtin_status status = microtin_decoder_feed(
      p.decoder, p.buffer + p.fed, static_cast<size_t>(p.read.buffered - p.fed), &used, step_limit);
  p.fed = static_cast<uint8_t>(p.fed + used);
  return status == MICROTIN_STATUS_STEP_LIMIT ? status : take_decoder_status(p, status);
}

}  // namespace microtin

#endif
