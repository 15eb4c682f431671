// SPDX-License-Identifier: MIT
// The clearance of a path above a pack: tiles are loaded one after another, where what the index
// states of their heights does not decide.
#ifndef MICROTIN_DECODER_PATH_SEARCH_HPP
#define MICROTIN_DECODER_PATH_SEARCH_HPP

#include "decoder/pack_query.hpp"

namespace microtin {

// What of a path lies in a tile that it touches.
class PathInTile {
 public:
  PathInTile(const microtin_path& path, const TileSegment& part)
      : path_(path), enters_(part.enters()), leaves_(part.leaves()) {}

  // The lowest height there, rounded down.
  int64_t lowest() const {
    if (is_place(path_.segment)) return smaller(path_.z, path_.z_end);
    return smaller(height_at(enters_), height_at(leaves_));
  }

  // Where it begins, as places are returned.
  int32_t begin() const { return rounded_down(Along{enters_.part, enters_.whole}); }

 private:
  // The rise is within 2^26, a part within 2^24.
  int64_t height_at(const Fraction& f) const {
    const int64_t rise = static_cast<int64_t>(path_.z_end) - path_.z;
    return path_.z + floor_of(rise * f.part, f.whole);
  }

  const microtin_path& path_;
  Fraction enters_, leaves_;
};

class PathSearch {
 public:
  PathSearch(microtin_pack& p, const microtin_path& path, uint32_t flags,
             microtin_path_search* search)
      : p_(p), path_(path), flags_(flags), search_(*search) {}

  // Goes on up to the next tile that must be loaded: STOPPED, and *tile is its number. OK or
  // BAD_TILES at the end; STEP_LIMIT behind a tile with terrain, if calls are limited.
  template <class Form>
  microtin_status go_on(bool is_limited, uint32_t* tile) {
    if (!p_.has_header) {
      const microtin_status status = bring_header();
      if (!p_.has_header) return status;
    }
    TouchedTiles tiles(p_.header.grid, path_.segment);
    if (search_.tiles == 0) {
      begin_clearance(&search_.state);
    } else if (tiles.go_to(search_.next)) {
      tiles.next();
    }
    for (; !tiles.at_end(); tiles.next()) {
      const TileSegment part(tiles.box(), path_.segment);
      *tile = tiles.number();
      const bool is_known = is_there(*tile);
      if (!is_known) {
        const microtin_status status = look_at_entry(*tile, part);
        if (status != MICROTIN_STATUS_OK) return status;
      }
      if (is_there(*tile) && !walk_loaded<Form>(*tile, part)) return MICROTIN_STATUS_OK;
      pass(*tile);
      if (is_known && is_limited) return MICROTIN_STATUS_STEP_LIMIT;
    }
    return end();
  }

  // Goes on behind a tile that turned out to be bad.
  void pass_bad(uint32_t tile) {
    search_.has_bad = 1;
    pass(tile);
  }

 private:
  void pass(uint32_t tile) {
    search_.needs_tile = 0;
    search_.next = tile;
    ++search_.tiles;
  }

  // Whether a tile is in a slot, or known to be bad.
  bool is_there(uint32_t tile) const {
    return slot_of(p_, tile) != p_.slot_count || bad_tile(p_, tile) != MICROTIN_PACK_MAX_BAD_TILES;
  }

  // Any entry brings the header first.
  microtin_status bring_header() {
    microtin_pack_bounds bounds = {};
    const microtin_segment here = {0, 0, 0, 0};
    return microtin_pack_bounds_on_segment(&p_, &here, &bounds);
  }

  // OK: the tile is bad, or cannot change what is found; STOPPED: it must be loaded.
  MICROTIN_OUT_OF_LINE microtin_status look_at_entry(uint32_t tile, const TileSegment& part) {
    if (search_.needs_tile != 0) return MICROTIN_STATUS_STOPPED;
    microtin_pack_bounds bounds = {};
    const microtin_segment middle = middle_of(p_.header.grid, tile);
    const microtin_status status = microtin_pack_bounds_on_segment(&p_, &middle, &bounds);
    if (status == MICROTIN_STATUS_BAD_TILES) {
      search_.has_bad = 1;
      return MICROTIN_STATUS_OK;
    }
    if (status != MICROTIN_STATUS_OK) return status;
    if (bounds.check.without_terrain != 0 || is_high(bounds.highest, part)) return status;
    search_.needs_tile = 1;
    return MICROTIN_STATUS_STOPPED;
  }

  // Whether the path is so high above all of the tile that it changes nothing. Of places with the
  // same clearance the first one counts, and tiles come in the order of the path.
  bool is_high(int32_t highest, const TileSegment& part) const {
    const PathInTile path(path_, part);
    int64_t above = path.lowest() - static_cast<int64_t>(highest) * 256;
    if ((flags_ & MICROTIN_FLAG_SAFE) != 0) {
      if (p_.header.below == kNotStated) return false;
      above -= static_cast<int64_t>(p_.header.below) * 16;
    }
    const int32_t first = search_.state.value[kFirst];
    const bool has_first = above >= path_.clearance || (first >= 0 && first <= path.begin());
    return has_first && (is_first_only() || above >= search_.state.value[kLeast]);
  }

  bool is_first_only() const { return (flags_ & MICROTIN_FLAG_FIRST_ONLY) != 0; }

  // Walks through a tile that is there. False if it does not state its margin.
  template <class Form>
  MICROTIN_OUT_OF_LINE bool walk_loaded(uint32_t tile, const TileSegment& part) {
    microtin_query_result absent = MICROTIN_QUERY_OK;
    const void* const terrain = terrain_of(p_, tile, &absent);
    const Pinned pinned(p_, terrain);
    if (absent != MICROTIN_QUERY_OK) search_.has_bad = 1;
    if (terrain == nullptr) return true;
    const Form form(terrain);
    AddToClearance add(path_, flags_);
    if (!add.begin_terrain(form)) {
      clear(&search_.clearance);
      search_.result = MICROTIN_QUERY_NO_MARGIN;
      return false;
    }
    ++search_.decoded;
    walk_tile(form, part, add, &search_.state);
    return true;
  }

  microtin_status end() {
    clear(&search_.clearance);
    get_clearance(search_.state, &search_.clearance);
    if (is_first_only()) {
      search_.clearance.least = INT32_MAX;
      search_.clearance.least_along = 0;
    }
    const bool is_all_inside = is_inside(p_, path_.segment.x, path_.segment.y) &&
                               is_inside(p_, path_.segment.x_end, path_.segment.y_end);
    search_.result = search_.has_bad != 0 ? MICROTIN_QUERY_BAD_TILE
                     : is_all_inside      ? MICROTIN_QUERY_OK
                                          : MICROTIN_QUERY_OUTSIDE;
    return search_.has_bad != 0 ? MICROTIN_STATUS_BAD_TILES : MICROTIN_STATUS_OK;
  }

  microtin_pack& p_;
  const microtin_path& path_;
  uint32_t flags_;
  microtin_path_search& search_;
};

// A function that loads what a segment touches.
typedef microtin_status (*Load)(microtin_pack*, const microtin_segment*, uint32_t);

// kLoad is microtin_pack_load, or that of compact packs.
template <class Form, Load kLoad>
microtin_status search_path(microtin_pack* pack, const microtin_path* path, uint32_t flags,
                            microtin_path_search* search, uint32_t step_limit) {
  if (pack == nullptr || path == nullptr || search == nullptr || !is_legal(path->segment) ||
      !has_legal_heights(*path)) {
    return MICROTIN_STATUS_ARGUMENT;
  }
  if ((pack->work != nullptr) != Form::kIsCompact) return MICROTIN_STATUS_WRONG_PACK_KIND;
  PathSearch state(*pack, *path, flags, search);
  for (;;) {  // each time loads a tile, or passes a bad one
    uint32_t tile = 0;
    microtin_status status = state.go_on<Form>(step_limit != 0, &tile);
    if (status != MICROTIN_STATUS_STOPPED) return status;
    const microtin_segment middle = middle_of(pack->header.grid, tile);
    status = kLoad(pack, &middle, step_limit);
    if (status == MICROTIN_STATUS_BAD_TILES) {
      state.pass_bad(tile);
    } else if (status != MICROTIN_STATUS_OK) {
      return status;
    }
  }
}

}  // namespace microtin

#endif
