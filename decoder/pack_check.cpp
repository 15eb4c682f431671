// SPDX-License-Identifier: MIT
// Whether tiles are there and whole, and between which heights they lie. Nothing is decoded and no
// slot changes: as where there are more tiles than slots, streams are compared with their hashes.
#include "decoder/pack_query.hpp"

namespace microtin {
namespace {

// OK or BAD_TILES if the tile is checked, else a status to be returned.
microtin_status check_tile(microtin_pack& p, const microtin_segment& middle) {
  // What is being loaded is begun again when it is wanted again.
  if (p.stage > PackStage::kEntry && p.slot != nullptr) fail_pack(p, MICROTIN_STATUS_OK);
  p.tile_priority = kNoRequest;
  p.only_checks = true;
  const microtin_status status = go_on(p, middle);
  p.only_checks = false;
  return status == MICROTIN_STATUS_WORKSPACE_TOO_SMALL ? MICROTIN_STATUS_OK : status;
}

bool has_terrain(const microtin_pack& p, uint32_t tile) {
  const uint32_t slot = slot_of(p, tile);
  return slot != p.slot_count ? p.slots[slot].has_terrain : p.entry.size != 0;
}

microtin_status count_bad(uint32_t tile, microtin_pack_check* check) {
  if (check->bad++ == 0) check->first_bad = tile;
  return MICROTIN_STATUS_OK;
}

// Looks at a tile's stream, and counts the tile. OK if that is done.
MICROTIN_OUT_OF_LINE microtin_status look_at(microtin_pack& p, uint32_t tile,
                                             microtin_pack_check* check) {
  const microtin_status status = check_tile(p, middle_of(p.header.grid, tile));
  if (status == MICROTIN_STATUS_BAD_TILES) return count_bad(tile, check);
  if (status == MICROTIN_STATUS_OK && !has_terrain(p, tile)) ++check->without_terrain;
  return status;
}

// Looks at a tile's entry alone, and counts the tile. It may be in a slot, or its stream be bad.
MICROTIN_OUT_OF_LINE microtin_status look_at(microtin_pack& p, uint32_t tile,
                                             microtin_pack_bounds* bounds) {
  microtin_pack_check& check = bounds->check;
  PackEntry entry;
  const microtin_status status = bring_entry(p, tile, &entry);
  if (status == MICROTIN_STATUS_BAD_TILES) return count_bad(tile, &check);
  if (status != MICROTIN_STATUS_OK) return status;
  if (entry.size == 0) {
    ++check.without_terrain;
    return status;
  }
  const int16_t lowest = entry_lowest(p.look.bytes), highest = entry_highest(p.look.bytes);
  const bool is_first = check.tiles == check.without_terrain + check.bad;
  if (is_first || lowest < bounds->lowest) bounds->lowest = lowest;
  if (is_first || highest > bounds->highest) bounds->highest = highest;
  return status;
}

microtin_pack_check* counts_of(microtin_pack_check* check) {
  return check;
}

microtin_pack_check* counts_of(microtin_pack_bounds* bounds) {
  return &bounds->check;
}

// Brings the header. OK if it is there.
microtin_status begin(microtin_pack& p, const microtin_segment& area, microtin_pack_check* check) {
  if (!is_legal(area)) return MICROTIN_STATUS_ARGUMENT;
  if (!p.has_header) {
    const microtin_status status = check_tile(p, microtin_segment{0, 0, 0, 0});
    if (!p.has_header) return status;
  }
  check->is_inside = is_inside(p, area.x, area.y) && is_inside(p, area.x_end, area.y_end);
  return MICROTIN_STATUS_OK;
}

microtin_status end(const microtin_pack_check& check) {
  return check.bad != 0 ? MICROTIN_STATUS_BAD_TILES : MICROTIN_STATUS_OK;
}

// Tiles in a direction that an interval meets in more than a point, or its only point; none if it
// lies outside.
struct Slice {
  uint32_t first, count;
};

Slice slice_of(int64_t a, int64_t b, uint32_t size, uint32_t most) {
  const int64_t limit = static_cast<int64_t>(most) * 256;
  const int64_t low = a < b ? a : b, high = a < b ? b : a;
  if (high < 0 || low > limit) return Slice{0, 0};
  const uint32_t final = (most - 1) / size;
  const auto slice_at = [&](int64_t place) {
    const uint32_t slice = static_cast<uint32_t>((place < 0 ? 0 : place) >> 8) / size;
    return slice < final ? slice : final;
  };
  const uint32_t first = slice_at(low), last = slice_at((high < limit ? high : limit) - 1);
  return Slice{first, last < first ? 1 : last - first + 1};
}

// Looks at the tiles that a segment touches; a state is a check, or bounds.
template <class State>
microtin_status look_along(microtin_pack* pack, const microtin_segment* segment, State* state) {
  if (pack == nullptr || segment == nullptr || state == nullptr) return MICROTIN_STATUS_ARGUMENT;
  microtin_pack_check* const check = counts_of(state);
  microtin_status status = begin(*pack, *segment, check);
  if (status != MICROTIN_STATUS_OK) return status;
  TouchedTiles tiles(pack->header.grid, *segment);
  if (check->tiles != 0) {
    if (!tiles.go_to(check->next)) return end(*check);
    tiles.next();
  }
  for (; !tiles.at_end(); tiles.next()) {
    status = look_at(*pack, tiles.number(), state);
    if (status != MICROTIN_STATUS_OK) return status;
    ++check->tiles;
    check->next = tiles.number();
  }
  return end(*check);
}

// Looks at the tiles of a box.
template <class State>
microtin_status look_in(microtin_pack* pack, const microtin_segment* diagonal, State* state) {
  if (pack == nullptr || diagonal == nullptr || state == nullptr) return MICROTIN_STATUS_ARGUMENT;
  microtin_pack_check* const check = counts_of(state);
  microtin_status status = begin(*pack, *diagonal, check);
  if (status != MICROTIN_STATUS_OK) return status;
  const TileGrid& grid = pack->header.grid;
  const Slice columns = slice_of(diagonal->x, diagonal->x_end, grid.width, grid.x_max),
              rows = slice_of(diagonal->y, diagonal->y_end, grid.height, grid.y_max);
  // Tiles have 32-bit numbers, so their count fits.
  for (; check->tiles < columns.count * rows.count; ++check->tiles) {
    const uint32_t row = rows.first + check->tiles / columns.count,
                   column = columns.first + check->tiles % columns.count;
    status = look_at(*pack, row * tile_columns(grid) + column, state);
    if (status != MICROTIN_STATUS_OK) return status;
  }
  return end(*check);
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_pack_check_segment(microtin_pack* pack, const microtin_segment* segment,
                                            microtin_pack_check* check) {
  return look_along(pack, segment, check);
}

microtin_status microtin_pack_check_box(microtin_pack* pack, const microtin_segment* diagonal,
                                        microtin_pack_check* check) {
  return look_in(pack, diagonal, check);
}

microtin_status microtin_pack_bounds_on_segment(microtin_pack* pack,
                                                const microtin_segment* segment,
                                                microtin_pack_bounds* bounds) {
  return look_along(pack, segment, bounds);
}

microtin_status microtin_pack_bounds_in_box(microtin_pack* pack, const microtin_segment* diagonal,
                                            microtin_pack_bounds* bounds) {
  return look_in(pack, diagonal, bounds);
}
