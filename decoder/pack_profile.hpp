// SPDX-License-Identifier: MIT
// The places of a profile through the tiles of a pack, one after another.
//
// The segment is cut where it crosses the lines between tiles. A part between two cuts lies in one
// tile, or along the border of two. At a cut the terrain of any tile there has the height.
#ifndef MICROTIN_DECODER_PACK_PROFILE_HPP
#define MICROTIN_DECODER_PACK_PROFILE_HPP

#include "decoder/pack_query.hpp"

namespace microtin {

enum class ProfilePhase : uint8_t {
  kBegin,
  kEntering,  // before the first tile
  kTiles,     // in a tile
  kEnd
};

// What a microtin_segment_state holds for a profile through a pack.
struct ProfileState {
  uint32_t tile;
  uint32_t stage[2], triangle[2];  // of the walks in the tile, and in the one beyond a border
  uint8_t phase;
  uint8_t before;     // the worst microtin_query_result since the last place
  uint8_t has_entry;  // the place where the segment enters the tile is behind
};
static_assert(sizeof(ProfileState) <= sizeof(microtin_segment_state), "it holds this");

// The next crossing of a tile, and where the walk stands behind it.
struct TileCrossing {
  Crossing crossing;
  bool is_in_part;  // before the segment leaves the tile
  WalkStage stage;
  uint32_t triangle;
};

template <class Form>
class PackProfile {
 public:
  PackProfile(const microtin_pack& p, const microtin_segment& segment, ProfileState* state,
              microtin_crossing* crossing)
      : p_(p), segment_(segment), state_(*state), crossing_(crossing) {}

  void next() {
    if (state_.phase == static_cast<uint8_t>(ProfilePhase::kBegin)) return begin();
    TouchedTiles tiles(p_.header.grid, segment_);
    if (state_.phase < static_cast<uint8_t>(ProfilePhase::kEnd) && tiles.go_to(state_.tile)) {
      while (!tiles.at_end()) {
        if (next_of_tile(tiles)) return;
      }
    }
    end();
  }

 private:
  void set_phase(ProfilePhase phase) { state_.phase = static_cast<uint8_t>(phase); }

  void note(microtin_query_result before) {
    state_.before =
        static_cast<uint8_t>(worse(static_cast<microtin_query_result>(state_.before), before));
  }

  void report(int32_t along, microtin_query_result result, int32_t height) {
    *crossing_ = microtin_crossing{along, result == MICROTIN_QUERY_OK ? height : INT32_MIN,
                                   static_cast<uint32_t>(result), state_.before};
    state_.before = MICROTIN_QUERY_OK;
  }

  microtin_query_result height_at(int64_t x, int64_t y, int32_t* height) const {
    uint32_t hint = 0;
    return height_in_pack<Form>(p_, x, y, &hint, height);
  }

  void begin() {
    int32_t height = 0;
    const microtin_query_result result = height_at(segment_.x, segment_.y, &height);
    report(0, result, height);
    TouchedTiles tiles(p_.header.grid, segment_);
    state_.has_entry = is_inside(p_, segment_.x, segment_.y);
    set_phase(state_.has_entry != 0 ? ProfilePhase::kTiles : ProfilePhase::kEntering);
    if (state_.has_entry == 0) note(MICROTIN_QUERY_OUTSIDE);
    if (is_place(segment_)) return set_phase(ProfilePhase::kEnd);
    const uint32_t first = tiles.at_end() ? 0 : tiles.number();
    enter_next(tiles);
    if (tiles.at_end()) state_.tile = first;  // it is touched at a corner at most
  }

  void end() {
    set_phase(ProfilePhase::kEnd);
    if (!is_inside(p_, segment_.x_end, segment_.y_end)) note(MICROTIN_QUERY_OUTSIDE);
    int32_t height = 0;
    const microtin_query_result result = height_at(segment_.x_end, segment_.y_end, &height);
    const uint8_t before = state_.before;
    report(static_cast<int32_t>(MICROTIN_ALONG_END), result, height);
    state_.before = before;  // for another call
  }

  // To the tile that holds more than a point of the segment, from this one on. Of two along a
  // border, the one behind it is the other's business.
  void enter_next(TouchedTiles& tiles) {
    for (; !tiles.at_end(); tiles.next()) {
      const TileBox box = tiles.box();
      if (!TileSegment(box, segment_).has_length() || is_beyond_border(box)) continue;
      state_.tile = tiles.number();
      state_.stage[0] = state_.stage[1] = 0;
      return;
    }
  }

  bool is_beyond_border(const TileBox& box) const {
    if (!runs_along_side(box, segment_)) return false;
    const LocalPoint at = local(box, segment_.x, segment_.y);
    return segment_.x == segment_.x_end ? at.x == 0 && box.x != 0 : at.y == 0 && box.y != 0;
  }

  // The tile beyond the border along which the segment runs; this tile if there is none.
  uint32_t tile_beyond(uint32_t tile, const TileBox& box) const {
    const TileGrid& grid = p_.header.grid;
    if (!runs_along_side(box, segment_)) return tile;
    if (segment_.x != segment_.x_end) {
      return segment_.y != 0 && box.y_end != grid.y_max ? tile + tile_columns(grid) : tile;
    }
    return segment_.x != 0 && box.x_end != grid.x_max ? tile + 1 : tile;
  }

  // The next place in a tile, or where the segment leaves it. If it has no more, goes to the next
  // tile; then false.
  bool next_of_tile(TouchedTiles& tiles) {
    const TileBox box = tiles.box();
    const TileSegment part(box, segment_);
    if (state_.phase == static_cast<uint8_t>(ProfilePhase::kEntering)) {
      set_phase(ProfilePhase::kTiles);
      state_.has_entry = report_corner(box, part, part.enters());
      if (state_.has_entry != 0) return true;
    }
    bool has_exit = false;
    if (part.has_length()) {
      const uint32_t tile = tiles.number(), other = tile_beyond(tile, box);
      if (next_inside(tile, other, part, &has_exit)) return true;
      if (!has_exit) has_exit = report_corner(box, part, part.leaves());
    }
    tiles.next();
    enter_next(tiles);
    state_.has_entry = has_exit;
    if (tiles.at_end()) set_phase(ProfilePhase::kEnd);
    return has_exit;
  }

  // Returns the height at a corner of tiles, which any of them may have.
  bool report_corner(const TileBox& box, const TileSegment& part, const Fraction& f) {
    LocalPoint at;
    int32_t height = 0;
    if (f.part == 0 || f.part >= f.whole || !part.corner_at(f, &at)) return false;
    const int64_t x = static_cast<int64_t>(box.x) * 256 + at.x,
                  y = static_cast<int64_t>(box.y) * 256 + at.y;
    if (height_at(x, y, &height) != MICROTIN_QUERY_OK) return false;
    report(rounded_down(Along{f.part, f.whole}), MICROTIN_QUERY_OK, height);
    return true;
  }

  // The next place before the segment leaves a tile. Else notes what is known up to there, and
  // returns the place where it leaves, if the tile has a height there and the segment goes on.
  bool next_inside(uint32_t tile, uint32_t other, const TileSegment& part, bool* has_exit) {
    const TileCrossing mine = look(0, tile);
    TileCrossing theirs = mine;
    microtin_query_result before = static_cast<microtin_query_result>(mine.crossing.before);
    int order = -1;
    if (other != tile) {
      theirs = look(1, other);
      before = known_by_either(before, static_cast<microtin_query_result>(theirs.crossing.before));
      if (mine.is_in_part && theirs.is_in_part) {
        order = compare(mine.crossing.along, theirs.crossing.along);
      } else if (theirs.is_in_part) {
        order = 1;
      }
    }
    note(before);
    const Crossing& c = order <= 0 ? mine.crossing : theirs.crossing;
    if (mine.is_in_part || theirs.is_in_part) {
      if (order <= 0) stand(0, mine);
      if (order >= 0) stand(1, theirs);
    } else if (part.is_behind_exit(c.along) || c.along.part >= c.along.whole) {
      return false;
    } else {
      *has_exit = true;
    }
    report(rounded_down(c.along), MICROTIN_QUERY_OK, height_of(c));
    return !*has_exit;
  }

  static microtin_query_result known_by_either(microtin_query_result a, microtin_query_result b) {
    return a == MICROTIN_QUERY_OK || b == MICROTIN_QUERY_OK ? MICROTIN_QUERY_OK : worse(a, b);
  }

  void stand(int walk, const TileCrossing& at) {
    state_.stage[walk] = static_cast<uint32_t>(at.stage);
    state_.triangle[walk] = at.triangle;
  }

  // The next crossing of a tile, from where one of the walks stands. Outside its hull a tile is
  // void.
  MICROTIN_OUT_OF_LINE TileCrossing look(int which, uint32_t tile) {
    microtin_query_result absent = MICROTIN_QUERY_VOID;
    const void* const terrain = terrain_of(p_, tile, &absent);
    TileCrossing found = {
        {{1, 1}, -1, 0, 0, 0, static_cast<uint8_t>(absent)}, false, WalkStage::kSearch, 0};
    if (terrain == nullptr) return found;
    const Pinned pinned(p_, terrain);
    const Form form(terrain);
    const TileSegment part(tile_box(p_.header.grid, tile), segment_);
    const LocalPoint entry = part.entry();
    const bool is_begun = state_.stage[which] != 0;
    SegmentWalk<Form> walk(form, entry, part.begin(), part.end(), stage_of(state_.stage[which]),
                           is_begun ? state_.triangle[which] : form.hint(entry));
    while (!walk.at_end()) {
      Crossing c;
      if (!walk.step(false, &c) || is_behind(c.along, part)) continue;
      found.crossing = c;
      break;
    }
    if (found.crossing.before == MICROTIN_QUERY_OUTSIDE)
      found.crossing.before = MICROTIN_QUERY_VOID;
    found.is_in_part = part.is_before_exit(found.crossing.along);
    found.stage = walk.stage();
    found.triangle = walk.number();
    return found;
  }

  // Whether a place is that where the segment enters, which is behind, or lies before it.
  bool is_behind(const Along& along, const TileSegment& part) const {
    return state_.has_entry != 0 ? !part.is_behind_entry(along) : part.is_before_entry(along);
  }

  const microtin_pack& p_;
  const microtin_segment& segment_;
  ProfileState& state_;
  microtin_crossing* crossing_;
};

template <class Form>
microtin_query_result next_in_pack(const microtin_pack& p, const microtin_segment& segment,
                                   microtin_segment_state* state, microtin_crossing* crossing) {
  if (!is_legal(segment)) return MICROTIN_QUERY_OUTSIDE;
  if ((p.work != nullptr) != Form::kIsCompact) return MICROTIN_QUERY_WRONG_PACK_KIND;
  if (!has_header(p)) return MICROTIN_QUERY_NOT_LOADED;
  ProfileState at;
  __builtin_memcpy(&at, state, sizeof at);
  PackProfile<Form>(p, segment, &at, crossing).next();
  __builtin_memcpy(state, &at, sizeof at);
  return MICROTIN_QUERY_OK;
}

}  // namespace microtin

#endif
