// SPDX-License-Identifier: MIT
// A pack: many tiles of one terrain in a file. format-pack.md explains it.
#ifndef MICROTIN_SHARED_PACK_FORMAT_HPP
#define MICROTIN_SHARED_PACK_FORMAT_HPP

#include "shared/crc32.hpp"
#include "shared/format.hpp"
#include "shared/header.hpp"

namespace microtin {

constexpr uint8_t kPackMagic[4] = {'m', 't', 'p', 'k'};
constexpr uint8_t kPackVersion = 5;
constexpr uint32_t kPackIdentityBytes = 6;
constexpr uint32_t kPackFixedBytes = 48;
constexpr uint32_t kPackEntryBytes = 20;
constexpr uint8_t kPackHeaderFlags = 15;  // of later versions; they leave check and notes in place
constexpr uint32_t kPackAlignment = 4;    // of the index in the encoder's packs
constexpr uint32_t kPackExtentMost = 0x7FFFFFFF;

// The parts of a terrain: rectangles of one size, those in the last column and row cut off at the
// largest x and y. Coordinates are global; neighbours share their border.
struct TileGrid {
  uint32_t x_max, y_max;   // 1 .. 2^31 - 1
  uint16_t width, height;  // 1 .. 65535
};

inline uint32_t tile_columns(const TileGrid& grid) {
  return (grid.x_max - 1) / grid.width + 1;
}

inline uint32_t tile_rows(const TileGrid& grid) {
  return (grid.y_max - 1) / grid.height + 1;
}

// The closed rectangle of a tile.
struct TileBox {
  uint32_t x, y;          // the first corner
  uint32_t x_end, y_end;  // the last one
};

inline TileBox tile_box(const TileGrid& grid, uint32_t tile) {
  const uint32_t columns = tile_columns(grid);
  TileBox box;
  box.x = tile % columns * grid.width;  // < x_max, so the sums below stay under 2^32
  box.y = tile / columns * grid.height;
  box.x_end = box.x + grid.width < grid.x_max ? box.x + grid.width : grid.x_max;
  box.y_end = box.y + grid.height < grid.y_max ? box.y + grid.height : grid.y_max;
  return box;
}

// What a pack's header says, up to its notes. Heights, counts and margins are bounds.
struct PackHeader {
  TileGrid grid;
  uint32_t most_vertices;   // of a tile
  uint32_t compact_bytes;   // that any tile takes in compact form at most; 0: not stated
  int16_t lowest, highest;  // vertices of all tiles
  uint32_t identity;        // with which the checks of entries begin
  uint32_t below, above;    // margins of all tiles, or kNotStated
  uint16_t note_bytes;
  uint8_t placement_bytes;  // at most 66
};

inline uint32_t pack_index_start(const PackHeader& header) {
  return kPackFixedBytes + header.placement_bytes + static_cast<uint32_t>(header.note_bytes) +
         kCheckBytes;
}

// Where the entry of a tile is: below 2^37.
inline uint64_t pack_entry_start(const PackHeader& header, uint32_t tile) {
  return pack_index_start(header) + static_cast<uint64_t>(tile) * kPackEntryBytes;
}

inline int16_t read_i16(const uint8_t* p) {
  const uint32_t value = read_u16(p);
  return static_cast<int16_t>(value < 0x8000 ? static_cast<int32_t>(value)
                                             : static_cast<int32_t>(value) - 0x10000);
}

// Checks the first kPackIdentityBytes. UNSUPPORTED_VERSION: all that follows may mean something
// else.
inline microtin_status check_pack_identity(const uint8_t* bytes) {
  constexpr uint32_t kNumber = number_of(kPackMagic);
  if (read_u32(bytes) != kNumber) return MICROTIN_STATUS_BAD_MAGIC;
  return bytes[4] == kPackVersion && (bytes[5] | kPackHeaderFlags) == kPackHeaderFlags
             ? MICROTIN_STATUS_OK
             : MICROTIN_STATUS_UNSUPPORTED_VERSION;
}

// Reads the fixed part of a known identity. Not OK, once the header's check has passed: MALFORMED,
// or UNSUPPORTED_VERSION if a flag is set. Only placement, notes and check are then where the
// header says.
inline microtin_status read_pack_header(const uint8_t* bytes, PackHeader* header) {
  TileGrid& grid = header->grid;
  header->placement_bytes = bytes[6];
  header->note_bytes = static_cast<uint16_t>(read_u16(bytes + 8));
  grid.width = static_cast<uint16_t>(read_u16(bytes + 10));
  grid.height = static_cast<uint16_t>(read_u16(bytes + 12));
  header->lowest = read_i16(bytes + 14);
  header->highest = read_i16(bytes + 16);
  grid.x_max = read_u32(bytes + 20);
  grid.y_max = read_u32(bytes + 24);
  header->most_vertices = read_u32(bytes + 28);
  header->compact_bytes = read_u32(bytes + 32);
  header->identity = read_u32(bytes + 36);
  header->below = read_u32(bytes + 40) - 1;  // a margin that is not stated: 0
  header->above = read_u32(bytes + 44) - 1;
  if (bytes[5] != 0) return MICROTIN_STATUS_UNSUPPORTED_VERSION;
  const bool reserved = (bytes[7] | bytes[18] | bytes[19]) != 0;
  const bool legal = header->below + 1 <= kMarginMost + 1 && header->above + 1 <= kMarginMost + 1 &&
                     !reserved && header->placement_bytes <= kPlacementMostBytes &&
                     grid.width != 0 && grid.height != 0 && grid.x_max != 0 &&
                     grid.x_max <= kPackExtentMost && grid.y_max != 0 &&
                     grid.y_max <= kPackExtentMost && header->most_vertices <= kMaxVertices &&
                     static_cast<uint64_t>(tile_columns(grid)) * tile_rows(grid) <= 0xFFFFFFFF;
  return legal ? MICROTIN_STATUS_OK : MICROTIN_STATUS_MALFORMED;
}

// The placement behind the fixed part, which must fill its bytes.
inline bool read_pack_placement(const uint8_t* placement, const PackHeader& header,
                                microtin_axis* axis) {
  const uint8_t* next = placement;
  const uint8_t* const end = next + header.placement_bytes;
  return read_placement(&next, end, axis) && next == end;
}

// Where the index ends, from which offsets count: below 2^37.
MICROTIN_IN_PLACE inline uint64_t pack_index_end(const PackHeader& header) {
  return pack_entry_start(header, tile_columns(header.grid) * tile_rows(header.grid));
}

// What the index says of a tile.
struct PackEntry {
  uint64_t offset;       // of its stream in the file, below 2^41
  uint32_t size;         // bytes of the stream, below 2^24; 0: there is no terrain
  uint32_t stream_hash;  // FNV-1a of the stream
};

// The bounds of a tile's heights, in an entry whose check has passed.
inline int16_t entry_lowest(const uint8_t* entry) {
  return read_i16(entry + 12);
}

inline int16_t entry_highest(const uint8_t* entry) {
  return read_i16(entry + 14);
}

// False if it breaks a rule.
MICROTIN_IN_PLACE inline bool read_pack_entry(const uint8_t* bytes, const PackHeader& header,
                                              PackEntry* entry) {
  entry->size = read_u16(bytes + 5) | static_cast<uint32_t>(bytes[7]) << 16;
  entry->stream_hash = read_u32(bytes + 8);
  entry->offset =
      pack_index_end(header) + (read_u32(bytes) | static_cast<uint64_t>(bytes[4]) << 32);
  if (entry->size != 0) return true;
  uint32_t rest = 0;
  for (uint32_t i = 0; i < kPackEntryBytes - kCheckBytes; ++i) rest |= bytes[i];
  return rest == 0;
}

// Reads the header of a tile's stream, of which the first bytes are given. MALFORMED unless the
// stream begins as that of a tile: it has neither placement nor notes, no more vertices than the
// pack's header says of any, and reaches no farther than the tile. UNSUPPORTED_VERSION: the stream
// is of another version, or has a property that is unknown here.
inline microtin_status read_tile_header(const uint8_t* bytes, size_t size, const PackHeader& header,
                                        const TileBox& box, Contract* contract) {
  if (size < kIdentityBytes) return MICROTIN_STATUS_MALFORMED;
  const microtin_status known = check_identity(bytes);
  if (known == MICROTIN_STATUS_UNSUPPORTED_VERSION) return known;
  const uint8_t *next = bytes + kIdentityBytes, *const given = bytes + size;
  uint32_t length = 0;
  bool legal = known == MICROTIN_STATUS_OK, more = legal;
  while (more && next != given) more = take_length(&length, *next++, &legal);
  const size_t left = static_cast<size_t>(given - next);
  const uint8_t *const end = next + (length < left ? length : left), *at = next;
  uint64_t properties = 0;
  microtin_axis axis[3];
  const microtin_status status = read_header(&next, end, contract, axis);
  if (status != MICROTIN_STATUS_OK) return status;
  legal = legal && length <= left && next == end && read_varint(&at, end, &properties) &&
          (properties & kHasPlacement) == 0 && contract->vertices <= header.most_vertices &&
          contract->x_max <= box.x_end - box.x && contract->y_max <= box.y_end - box.y;
  return legal ? MICROTIN_STATUS_OK : MICROTIN_STATUS_MALFORMED;
}

// FNV-1a: tells which stream it is. A CRC-32 could not: over bytes that hold their own CRC-32, as
// those of streams do, it depends on their number alone. Feed kStreamHash first, then each result.
constexpr uint32_t kStreamHash = 0x811C9DC5;

MICROTIN_ONE_COPY inline uint32_t stream_hash(uint32_t hash, const uint8_t* bytes, size_t size) {
  for (size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x01000193u;
  return hash;
}

// The check of an entry starts from the pack's identity and the tile's number, so that an entry of
// another tile or pack does not pass.
MICROTIN_IN_PLACE inline uint32_t pack_entry_check(uint32_t identity, uint32_t tile,
                                                   const uint8_t* bytes) {
  uint8_t place[4];
  for (uint32_t i = 0; i < 4; ++i) place[i] = static_cast<uint8_t>(tile >> 8 * i);
  return crc32(crc32(identity, place, 4), bytes, kPackEntryBytes - kCheckBytes);
}

}  // namespace microtin

#endif
