// SPDX-License-Identifier: MIT
// Queries on the tiles of a pack that are there, whatever their form (segment_walk.hpp). They only
// read, and note the slots that they use, so they may interrupt anything.
#ifndef MICROTIN_DECODER_PACK_QUERY_HPP
#define MICROTIN_DECODER_PACK_QUERY_HPP

#include "decoder/border_edges.hpp"
#include "decoder/gradient.hpp"
#include "decoder/pack_state.hpp"
#include "decoder/places.hpp"
#include "decoder/segment_clearance.hpp"
#include "decoder/segment_extremes.hpp"
#include "decoder/tile_segment.hpp"
#include "decoder/walk.hpp"

namespace microtin {

inline bool is_inside(const microtin_pack& p, int64_t x, int64_t y) {
  const TileGrid& grid = p.header.grid;
  return x >= 0 && x <= static_cast<int64_t>(grid.x_max) * 256 && y >= 0 &&
         y <= static_cast<int64_t>(grid.y_max) * 256;
}

// The result of a query for a tile that is not there.
inline microtin_query_result answer_without(const microtin_pack& p, uint32_t tile) {
  return bad_tile(p, tile) == MICROTIN_PACK_MAX_BAD_TILES ? MICROTIN_QUERY_NOT_LOADED
                                                          : MICROTIN_QUERY_BAD_TILE;
}

// Pins a slot, or unpins it, under the lock.
MICROTIN_IN_PLACE inline void change_pins(PackSlot& slot, int change) {
  if (kPins)
    __atomic_store_n(&slot.pins, static_cast<uint8_t>(slot.pins + change), __ATOMIC_RELAXED);
}

// Whether the header is there; what it says does not change after that.
MICROTIN_IN_PLACE inline bool has_header(const microtin_pack& p) {
  MICROTIN_PACK_ENTER();
  const bool is_there = p.has_header;
  MICROTIN_PACK_LEAVE();
  return is_there;
}

// The terrain of a tile, pinned; null if it has none, or is not there, and then *absent becomes
// worse.
MICROTIN_ONE_COPY inline const void* terrain_of(const microtin_pack& p, uint32_t tile,
                                                microtin_query_result* absent) {
  const void* terrain = nullptr;
  MICROTIN_PACK_ENTER();
  const uint32_t slot = slot_of(p, tile);
  if (slot != p.slot_count) {
    note_use(p.slots[slot]);
    if (p.slots[slot].has_terrain) {
      terrain = p.slots[slot].space;
      change_pins(p.slots[slot], 1);
    }
  } else {
    *absent = worse(*absent, answer_without(p, tile));
  }
  MICROTIN_PACK_LEAVE();
  return terrain;
}

// Ends the use of a terrain of terrain_of.
MICROTIN_IN_PLACE inline void unpin(const microtin_pack& p, const void* terrain) {
  if (!kPins || terrain == nullptr) return;
  MICROTIN_PACK_ENTER();
  uint32_t i = 0;
  while (p.slots[i].space != terrain) ++i;
  change_pins(p.slots[i], -1);
  MICROTIN_PACK_LEAVE();
}

// Unpins a terrain at the end of its scope.
class Pinned {
 public:
  MICROTIN_IN_PLACE inline Pinned(const microtin_pack& p, const void* terrain)
      : p_(p), terrain_(terrain) {}
  MICROTIN_IN_PLACE inline ~Pinned() { unpin(p_, terrain_); }
  Pinned(const Pinned&) = delete;
  Pinned& operator=(const Pinned&) = delete;

 private:
  const microtin_pack& p_;
  const void* terrain_;
};

// Whether a segment lies on a side of the box, more than a point of which it touches.
inline bool runs_along_side(const TileBox& box, const microtin_segment& c) {
  const LocalPoint a = local(box, c.x, c.y), b = local(box, c.x_end, c.y_end);
  const auto is_side = [](int32_t place, uint32_t steps) {
    return place == 0 || place == static_cast<int32_t>(steps) * 256;
  };
  return (a.x == b.x && is_side(a.x, box.x_end - box.x)) ||
         (a.y == b.y && is_side(a.y, box.y_end - box.y));
}

// OK if every place of a segment along a side of a tile is known to it or to the tile beyond, or
// if the side is another tile's business: the first one's of two at a border.
template <class Form>
microtin_query_result answer_along_side(const microtin_pack& p, uint32_t tile,
                                        const microtin_segment& segment) {
  const TileGrid& grid = p.header.grid;
  const TileBox box = tile_box(grid, tile);
  const LocalPoint a = local(box, segment.x, segment.y),
                   b = local(box, segment.x_end, segment.y_end);
  const bool vertical = a.x == b.x;
  const uint32_t first = vertical ? box.x : box.y, last = vertical ? box.x_end : box.y_end,
                 most = vertical ? grid.x_max : grid.y_max;
  int32_t line = vertical ? a.x : a.y, other_line = 0;  // of its tile: the first side, or the last
  const bool is_last = line != 0;
  if (!is_last && first != 0) return MICROTIN_QUERY_OK;
  microtin_query_result worst = MICROTIN_QUERY_VOID;
  const void *one = terrain_of(p, tile, &worst), *other = nullptr;
  if (is_last && last != most) {
    other = terrain_of(p, tile + (vertical ? 1u : tile_columns(grid)), &worst);
  }
  const Pinned pinned_one(p, one), pinned_other(p, other);
  if (one == nullptr && other == nullptr) return worst;
  const int32_t begin = vertical ? a.y : a.x, end = vertical ? b.y : b.x;
  const int32_t length =
      static_cast<int32_t>(vertical ? box.y_end - box.y : box.x_end - box.x) * 256;
  // What is not there is not known, as if the one that is there were on both sides.
  if (other == nullptr) {
    other = one;
    other_line = line;
  }
  if (one == nullptr) {
    one = other;
    line = 0;
  }
  const bool is_known =
      know_border(Form(one), line, Form(other), other_line, vertical,
                  larger<int32_t>(smaller(begin, end), 0), smaller(larger(begin, end), length));
  return is_known ? MICROTIN_QUERY_OK : worst;
}

// Hands the crossings of a segment in a tile to add(walk, crossing, state). False if the tile holds
// a part of the segment, longer than a point, of which the terrain has no heights.
template <class Form, class Add>
bool walk_tile(const Form& form, const TileSegment& part, const Add& add,
               microtin_segment_state* state) {
  const LocalPoint entry = part.entry();
  SegmentWalk<Form> walk(form, entry, part.begin(), part.end(), WalkStage::kSearch,
                         form.hint(entry));
  bool is_known = true;
  Along last;
  last.part = 0;
  last.whole = 1;
  while (!walk.at_end()) {
    Crossing c;
    if (!walk.step(false, &c)) continue;
    if (c.before != MICROTIN_QUERY_OK && part.holds_between(last, c.along)) is_known = false;
    last = c.along;
    add(walk, c, state);
  }
  return is_known;
}

// What a tile says of a segment that touches it.
template <class Form, class Add>
microtin_query_result answer_of_tile(const microtin_pack& p, const TouchedTiles& tiles,
                                     const microtin_segment& segment, const Add& add,
                                     microtin_segment_state* state) {
  microtin_query_result absent = MICROTIN_QUERY_OK;
  const void* const terrain = terrain_of(p, tiles.number(), &absent);
  const Pinned pinned(p, terrain);
  if (absent == MICROTIN_QUERY_NOT_LOADED) return absent;
  const TileBox box = tiles.box();
  const TileSegment part(box, segment);
  bool is_known = false;
  if (terrain != nullptr) {
    const Form form(terrain);
    Add tile_add = add;
    if (!tile_add.begin_terrain(form)) return MICROTIN_QUERY_NO_MARGIN;
    is_known = walk_tile(form, part, tile_add, state);
  }
  if (!part.has_length() || is_known) return MICROTIN_QUERY_OK;
  if (runs_along_side(box, segment)) return answer_along_side<Form>(p, tiles.number(), segment);
  return worse(absent, MICROTIN_QUERY_VOID);
}

// *terrain is what has the height, pinned, if it is known.
template <class Form>
microtin_query_result height_in_pack(const microtin_pack& p, int64_t x, int64_t y, uint32_t* hint,
                                     int32_t* height, const void** terrain) {
  if ((p.work != nullptr) != Form::kIsCompact) return MICROTIN_QUERY_WRONG_PACK_KIND;
  if (!has_header(p)) return MICROTIN_QUERY_NOT_LOADED;
  if (!is_inside(p, x, y)) return MICROTIN_QUERY_OUTSIDE;
  microtin_query_result result = MICROTIN_QUERY_VOID;
  const microtin_segment here = {x, y, x, y};
  for (TouchedTiles tiles(p.header.grid, here); !tiles.at_end(); tiles.next()) {
    *terrain = terrain_of(p, tiles.number(), &result);
    if (*terrain == nullptr) continue;
    const LocalPoint at = local(tiles.box(), x, y);
    if (Form(*terrain).height_at(at, 0, hint, height) == MICROTIN_QUERY_OK)
      return MICROTIN_QUERY_OK;
    unpin(p, *terrain);
  }
  return result;
}

template <class Form>
microtin_query_result height_in_pack(const microtin_pack& p, int64_t x, int64_t y, uint32_t* hint,
                                     int32_t* height) {
  const void* terrain = nullptr;
  const microtin_query_result found = height_in_pack<Form>(p, x, y, hint, height, &terrain);
  if (found == MICROTIN_QUERY_OK) unpin(p, terrain);
  return found;
}

template <class Form>
microtin_query_result safe_heights_in_pack(const microtin_pack& p, int64_t x, int64_t y,
                                           uint32_t* hint, microtin_safe_heights* heights) {
  int32_t height = 0;
  const void* terrain = nullptr;
  const microtin_query_result found = height_in_pack<Form>(p, x, y, hint, &height, &terrain);
  if (found != MICROTIN_QUERY_OK) return found;
  const Pinned pinned(p, terrain);
  const typename Form::Terrain& tile = *static_cast<const typename Form::Terrain*>(terrain);
  return widen(height, tile.below, tile.above, heights);
}

inline bool is_place(const microtin_segment& segment) {
  return segment.x == segment.x_end && segment.y == segment.y_end;
}

// A segment that is a single place begins and ends there, in each tile that has its height: tiles
// may have other margins.
template <class Form, class Add>
microtin_query_result walk_place(const microtin_pack& p, const microtin_segment& segment,
                                 const Add& add, microtin_segment_state* state) {
  microtin_query_result result = MICROTIN_QUERY_VOID;
  bool is_known = false;
  for (TouchedTiles tiles(p.header.grid, segment); !tiles.at_end(); tiles.next()) {
    const void* const terrain = terrain_of(p, tiles.number(), &result);
    if (terrain == nullptr) continue;
    const Pinned pinned(p, terrain);
    const Form form(terrain);
    const LocalPoint at = local(tiles.box(), segment.x, segment.y);
    SegmentWalk<Form> walk(form, at, at, at, WalkStage::kSearch, form.hint(at));
    Crossing c;
    walk.step(false, &c);
    if (c.result != MICROTIN_QUERY_OK) continue;
    Add tile_add = add;
    if (!tile_add.begin_terrain(form)) return MICROTIN_QUERY_NO_MARGIN;
    tile_add(walk, c, state);
    walk.step(false, &c);
    tile_add(walk, c, state);
    is_known = true;
  }
  return is_known ? MICROTIN_QUERY_OK : result;
}

// Hands the crossings of a segment, tile by tile, to add(walk, crossing, state).
template <class Form, class Add>
microtin_query_result walk_pack(const microtin_pack& p, const microtin_segment& segment,
                                const Add& add, microtin_segment_state* state) {
  if (!is_legal(segment)) return MICROTIN_QUERY_OUTSIDE;
  if ((p.work != nullptr) != Form::kIsCompact) return MICROTIN_QUERY_WRONG_PACK_KIND;
  if (!has_header(p)) return MICROTIN_QUERY_NOT_LOADED;
  microtin_query_result result =
      is_inside(p, segment.x, segment.y) && is_inside(p, segment.x_end, segment.y_end)
          ? MICROTIN_QUERY_OK
          : MICROTIN_QUERY_OUTSIDE;
  if (is_place(segment)) {
    return result == MICROTIN_QUERY_OK ? walk_place<Form>(p, segment, add, state) : result;
  }
  for (TouchedTiles tiles(p.header.grid, segment); !tiles.at_end(); tiles.next()) {
    const microtin_query_result here = answer_of_tile<Form>(p, tiles, segment, add, state);
    if (here == MICROTIN_QUERY_NO_MARGIN) return here;
    result = worse(result, here);
  }
  return result;
}

template <class Form>
microtin_query_result extremes_in_pack(const microtin_pack& p, const microtin_segment& segment,
                                       microtin_segment_extremes* extremes) {
  clear(extremes);
  microtin_segment_state state = {};
  begin_extremes(&state);
  const microtin_query_result result = walk_pack<Form>(p, segment, AddToExtremes(), &state);
  get_extremes(state, extremes);
  return result;
}

template <class Form>
microtin_query_result clearance_in_pack(const microtin_pack& p, const microtin_path& path,
                                        microtin_path_clearance* clearance, uint32_t flags) {
  clear(clearance);
  if (!has_legal_heights(path)) return MICROTIN_QUERY_OUTSIDE;
  microtin_segment_state state = {};
  begin_clearance(&state);
  const microtin_query_result result =
      walk_pack<Form>(p, path.segment, AddToClearance(path, flags), &state);
  if (result == MICROTIN_QUERY_NO_MARGIN) return result;
  get_clearance(state, clearance);
  return result;
}

// A function of a position, as places.hpp has it.
template <class Form>
class HeightInPack {
 public:
  explicit HeightInPack(const microtin_pack& p) : p_(p) {}

  microtin_query_result operator()(int64_t x, int64_t y, uint32_t* hint, int32_t* height) const {
    return height_in_pack<Form>(p_, x, y, hint, height);
  }

 private:
  const microtin_pack& p_;
};

template <class Form>
microtin_query_result fill_from_pack(const microtin_pack& p, const microtin_grid_spec& grid,
                                     int16_t* heights) {
  if (has_header(p) && !has_small_units(p.axis[2])) return MICROTIN_QUERY_OUTSIDE;
  return fill(grid, p.axis[2], HeightInPack<Form>(p), heights);
}

// The best triangle of all tiles that are there.
template <class Form>
microtin_query_result gradient_in_pack(const microtin_pack& p, int64_t x, int64_t y, uint32_t* hint,
                                       microtin_gradient* gradient) {
  if ((p.work != nullptr) != Form::kIsCompact) return MICROTIN_QUERY_WRONG_PACK_KIND;
  if (!has_header(p)) return MICROTIN_QUERY_NOT_LOADED;
  if (!is_inside(p, x, y)) return MICROTIN_QUERY_OUTSIDE;
  microtin_query_result result = MICROTIN_QUERY_VOID;
  BestTriangle best = {};
  const microtin_segment here = {x, y, x, y};
  for (TouchedTiles tiles(p.header.grid, here); !tiles.at_end(); tiles.next()) {
    const void* const terrain = terrain_of(p, tiles.number(), &result);
    if (terrain == nullptr) continue;
    const Pinned pinned(p, terrain);
    const TileBox box = tiles.box();
    look_at_place(Form(terrain), local(box, x, y), box.x, box.y, 0, hint, &best);
  }
  if (!best.is_found) return result;
  *gradient = best.gradient;
  *hint = best.number;
  return MICROTIN_QUERY_OK;
}

}  // namespace microtin

#endif
