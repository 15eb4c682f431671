// SPDX-License-Identifier: MIT
// Which request is loaded next, and which tiles give way to it.
#include "microtin/requests.h"

#include "decoder/pack_state.hpp"

namespace microtin {
namespace {

constexpr uint32_t kHere = MICROTIN_PRIORITY_HERE, kAhead = MICROTIN_PRIORITY_AHEAD,
                   kOther = MICROTIN_PRIORITY_OTHER, kSoon = MICROTIN_PRIORITY_SOON;
constexpr uint8_t kNone = kNoRequest;
// Counts of the pack's clock, about four for each service, after which a tile is not in use any
// more.
constexpr uint32_t kUseLasts = 4 * MICROTIN_REQUEST_LIFE;
// Counts of PackSlot::loaded during which a tile does not give way to one that is needed soon, so
// that such tiles do not displace each other again and again.
constexpr uint16_t kStays = 4 * MICROTIN_REQUEST_TURN / 16;
constexpr uint32_t kMostMissing = 32;  // of a working set
static_assert(kAhead + 1 == kOther && kOther < MICROTIN_MAX_REQUESTS, "others come last");

// What is written before it is seen by what it interrupts, or by what interrupts it, before what is
// written behind it.
void fence() {
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
}

// Copies a segment that questions may replace at any moment.
microtin_segment segment_of(const microtin_request& request, uint8_t* version) {
  microtin_segment segment;
  do {  // ends when no question interrupts the copy
    *version = request.version;
    fence();
    segment = request.segment;
    fence();
  } while (*version != request.version);
  return segment;
}

microtin_segment segment_of(const microtin_request& request) {
  uint8_t version;
  return segment_of(request, &version);
}

void put(microtin_request& request, const microtin_segment& segment) {
  const microtin_segment& old = request.segment;
  const bool is_same = old.x == segment.x && old.y == segment.y && old.x_end == segment.x_end &&
                       old.y_end == segment.y_end;
  request.age = 0;
  if (request.is_set && is_same) return;
  request.segment = segment;
  fence();
  request.version = static_cast<uint8_t>(request.version + 1);
  fence();
  request.is_set = 1;
}

// The tile where a segment begins; any number outside the pack.
uint32_t first_tile(const TileGrid& grid, const microtin_segment& segment) {
  const auto slice = [](int64_t place, uint32_t size, uint32_t most) {
    const uint32_t step = place < 0 ? 0 : static_cast<uint32_t>(place >> 8);
    return (step < most ? step : most - 1) / size;
  };
  return slice(segment.y, grid.height, grid.y_max) * tile_columns(grid) +
         slice(segment.x, grid.width, grid.x_max);
}

// The request for that tile behind the first two, or an empty one, or one of lower priority, which
// is then empty; MICROTIN_MAX_REQUESTS if there is none.
uint32_t place_for(microtin_requests& r, uint32_t tile, uint32_t priority) {
  uint32_t found = MICROTIN_MAX_REQUESTS;
  for (uint32_t i = kOther; i < MICROTIN_MAX_REQUESTS; ++i) {
    const microtin_request& request = r.request[i];
    if (request.is_set && first_tile(r.pack->header.grid, request.segment) == tile) return i;
    const bool is_free = !request.is_set;
    if (is_free || (found == MICROTIN_MAX_REQUESTS && request.priority > priority)) found = i;
  }
  if (found != MICROTIN_MAX_REQUESTS) r.request[found].is_set = 0;
  return found;
}

// Whether a request that found no room before gets the first one: by lot, so that the order in
// which places are requested favours none of them.
bool wins(microtin_requests& r) {
  r.lot = static_cast<uint16_t>(r.lot * 25173u + 13849u);
  return r.lot < 0x4000;
}

// Slots in which a request may put its tiles.
uint32_t open_slots(const microtin_pack& p, uint32_t priority) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < p.slot_count; ++i) {
    if (p.slots[i].is_empty() || p.slots[i].priority > priority) ++count;
  }
  return count;
}

// Keeps the tiles of a segment, of the way ahead as many as have room besides those of higher
// priority. True if one of these is missing.
bool keep(microtin_pack& p, const microtin_segment& segment, uint32_t priority) {
  uint32_t left = priority == kAhead ? open_slots(p, kHere) : p.slot_count;
  bool is_missing = false;
  for (TouchedTiles tiles(p.header.grid, segment); !tiles.at_end() && left != 0; tiles.next()) {
    const uint32_t slot = slot_of(p, tiles.number());
    if (slot == p.slot_count) {
      if (bad_tile(p, tiles.number()) != MICROTIN_PACK_MAX_BAD_TILES) continue;
      is_missing = true;
    } else {
      uint8_t& kept = p.slots[slot].priority;
      if (kept < priority) continue;
      kept = static_cast<uint8_t>(priority);
    }
    --left;
  }
  return is_missing;
}

// A slot that serves no request has the priority kNone.
void find_use(microtin_requests& r) {
  microtin_pack& p = *r.pack;
  begin_call(p);
  for (uint32_t i = 0; i < p.slot_count; ++i) {
    PackSlot& slot = p.slots[i];
    const bool is_in_use =
        !slot.is_empty() && i != r.giving_way && p.clock - slot.wanted < kUseLasts;
    const bool stays = static_cast<uint16_t>((p.clock >> 4) - slot.loaded) < kStays;
    slot.priority = is_in_use ? static_cast<uint8_t>(kOther)
                    : stays   ? static_cast<uint8_t>(kSoon)
                              : kNone;
  }
}

void end_loading(microtin_requests& r) {
  r.loading = kNone;
  r.giving_way = kNone;
}

void grow_older(microtin_requests& r) {
  if (r.since_turn != MICROTIN_REQUEST_TURN) ++r.since_turn;
  for (uint32_t i = 0; i < MICROTIN_MAX_REQUESTS; ++i) {
    microtin_request& request = r.request[i];
    if (request.rest != 0) --request.rest;
    if (!request.is_set || i < kOther) continue;
    if (request.waits != 0xFFFF) ++request.waits;
    const uint8_t age = static_cast<uint8_t>(request.age + 1);
    request.age = age;
    if (age > MICROTIN_REQUEST_LIFE) request.is_set = 0;
  }
}

// Whether the place or segment ahead is to be loaded now.
bool wants(microtin_requests& r, uint32_t priority, microtin_segment* segment) {
  microtin_request& request = r.request[priority];
  if (!request.is_set) return false;
  uint8_t version;
  *segment = segment_of(request, &version);
  const bool is_wanted =
      keep(*r.pack, *segment, priority) && request.rest == 0 && open_slots(*r.pack, priority) != 0;
  if (!is_wanted) request.served = version;
  return is_wanted;
}

// Whether of two requests behind the first two the former is loaded first: the more important one,
// then that in hand, then that which has waited longer.
bool comes_before(const microtin_requests& r, uint8_t one, uint8_t other) {
  const microtin_request &a = r.request[one], &b = r.request[other];
  if (a.priority != b.priority) return a.priority < b.priority;
  if (other == r.loading) return false;
  return one == r.loading || a.waits > b.waits;
}

// The other request to be loaded; none: kNone.
uint8_t choose_other(microtin_requests& r, microtin_segment* segment) {
  for (;;) {  // each time forgets a request
    uint8_t chosen = kNone;
    for (uint8_t i = kOther; i < MICROTIN_MAX_REQUESTS; ++i) {
      if (r.request[i].is_set && (chosen == kNone || comes_before(r, i, chosen))) chosen = i;
    }
    if (chosen == kNone) return kNone;
    microtin_request& request = r.request[chosen];
    *segment = segment_of(request);
    const uint32_t priority = request.priority;
    const bool is_missing = keep(*r.pack, *segment, priority);
    if (is_missing && (priority == kOther || open_slots(*r.pack, kSoon) != 0)) return chosen;
    request.is_set = 0;
    if (chosen == r.loading) end_loading(r);
  }
}

// A tile that is loaded before it is queried is not in use yet.
void note_soon(microtin_pack& p, const microtin_segment& segment) {
  const uint32_t slot = slot_of(p, first_tile(p.header.grid, segment));
  if (slot != p.slot_count) p.slots[slot].wanted -= kUseLasts;
}

// Lets the tile of another place that was loaded first give way, if it is time.
bool take_turn(microtin_requests& r) {
  microtin_pack& p = *r.pack;
  if (r.since_turn < MICROTIN_REQUEST_TURN) return false;
  uint16_t most = 0;
  for (uint32_t i = 0; i < p.slot_count; ++i) {
    const uint16_t age = static_cast<uint16_t>((p.clock >> 4) - p.slots[i].loaded);
    if (p.slots[i].priority != kOther || (r.giving_way != kNone && age <= most)) continue;
    most = age;
    r.giving_way = static_cast<uint8_t>(i);
  }
  if (r.giving_way == kNone) return false;
  p.slots[r.giving_way].priority = kNone;
  r.since_turn = 0;
  return true;
}

// Takes a request in hand.
void take_in_hand(microtin_requests& r, uint32_t number, uint32_t priority) {
  if (number != r.loading) end_loading(r);
  r.loading = static_cast<uint8_t>(number);
  r.pack->priority = static_cast<uint8_t>(priority);
}

// Counts the tiles that a segment misses and that are not in the list, and adds them.
uint32_t add_missing(const microtin_pack& p, const microtin_segment& segment, uint32_t* list,
                     uint32_t count) {
  for (TouchedTiles tiles(p.header.grid, segment); !tiles.at_end(); tiles.next()) {
    const uint32_t tile = tiles.number();
    uint32_t i = 0;
    while (i < count && list[i] != tile) ++i;
    if (i < count || slot_of(p, tile) != p.slot_count ||
        bad_tile(p, tile) != MICROTIN_PACK_MAX_BAD_TILES) {
      continue;
    }
    if (count == kMostMissing) return count;
    list[count++] = tile;
  }
  return count;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

void microtin_requests_init(microtin_requests* requests, microtin_pack* pack) {
  *requests = microtin_requests{};
  requests->pack = pack;
  end_loading(*requests);
}

microtin_status microtin_requests_add(microtin_requests* requests, const microtin_segment* segment,
                                      uint32_t priority) {
  if (requests == nullptr || segment == nullptr || !is_legal(*segment)) {
    return MICROTIN_STATUS_ARGUMENT;
  }
  microtin_requests& r = *requests;
  if (priority < kOther) {
    put(r.request[priority], *segment);
    return MICROTIN_STATUS_OK;
  }
  if (priority > kSoon) return MICROTIN_STATUS_ARGUMENT;
  if (!r.pack->has_header) return MICROTIN_STATUS_NEED_INPUT;
  const uint32_t place = place_for(r, first_tile(r.pack->header.grid, *segment), priority);
  const bool has_room = place != MICROTIN_MAX_REQUESTS;
  const bool is_new = has_room && !r.request[place].is_set;
  if (priority == kOther && (!has_room || (is_new && r.was_full && !wins(r)))) {
    r.was_full = 1;
    return MICROTIN_STATUS_TOO_BIG;
  }
  if (!has_room) return MICROTIN_STATUS_TOO_BIG;
  microtin_request& request = r.request[place];
  if (is_new) {
    request.waits = 0;
    if (priority == kOther) r.was_full = 0;
  } else if (request.priority < priority) {
    return MICROTIN_STATUS_OK;
  }
  request.priority = static_cast<uint8_t>(priority);
  put(request, *segment);
  return MICROTIN_STATUS_OK;
}

uint32_t microtin_requests_pending(const microtin_requests* requests) {
  uint32_t count = requests->pack->has_header ? 0 : 1;
  for (uint32_t i = 0; i < MICROTIN_MAX_REQUESTS; ++i) {
    const microtin_request& request = requests->request[i];
    const bool is_served =
        i < kOther && request.version == request.served && requests->loading != i;
    const bool is_soon = i >= kOther && request.priority == kSoon;
    if (request.is_set && !is_served && !is_soon) ++count;
  }
  return count;
}

uint32_t microtin_requests_working_set(const microtin_requests* requests) {
  const microtin_pack& p = *requests->pack;
  if (!p.has_header) return 0;
  uint32_t list[kMostMissing], missing = 0, used = 0;
  for (const microtin_request& request : requests->request) {
    if (!request.is_set || request.priority == kSoon) continue;  // the first two have 0
    missing = add_missing(p, segment_of(request), list, missing);
  }
  for (uint32_t i = 0; i < p.slot_count; ++i) {
    if (!p.slots[i].is_empty() && p.slots[i].priority <= kOther) ++used;
  }
  return used + missing;
}

microtin_status microtin_requests_next(microtin_requests* requests, microtin_segment* segment) {
  microtin_requests& r = *requests;
  grow_older(r);
  if (!r.pack->has_header) {
    *segment = microtin_segment{0, 0, 0, 0};
    take_in_hand(r, kNone, kSoon);  // a tile that is begun behind the header gives way
    return MICROTIN_STATUS_NEED_INPUT;
  }
  find_use(r);
  microtin_segment ahead;
  const bool wants_here = wants(r, kHere, segment), wants_ahead = wants(r, kAhead, &ahead);
  if (wants_here || wants_ahead) {
    if (!wants_here) *segment = ahead;
    const uint32_t first = wants_here ? kHere : kAhead;
    take_in_hand(r, first, first);
    return MICROTIN_STATUS_NEED_INPUT;
  }
  if (r.loading < kOther) end_loading(r);
  const uint8_t other = choose_other(r, segment);
  if (other == kNone) return MICROTIN_STATUS_OK;
  take_in_hand(r, other, r.request[other].priority);
  return open_slots(*r.pack, kOther) != 0 || take_turn(r) ? MICROTIN_STATUS_NEED_INPUT
                                                          : MICROTIN_STATUS_WORKSPACE_TOO_SMALL;
}

microtin_status microtin_requests_note(microtin_requests* requests, microtin_status status) {
  microtin_requests& r = *requests;
  if (status != MICROTIN_STATUS_OK && status != MICROTIN_STATUS_BAD_TILES &&
      status != MICROTIN_STATUS_WORKSPACE_TOO_SMALL) {
    return status;
  }
  if (r.loading < MICROTIN_MAX_REQUESTS) {
    microtin_request& request = r.request[r.loading];
    const uint32_t priority = r.loading < kOther ? r.loading : request.priority;
    // Bad tiles that the pack has forgotten are not tried again at once.
    if (keep(*r.pack, segment_of(request), priority)) request.rest = MICROTIN_REQUEST_LIFE;
    if (priority >= kOther) request.is_set = 0;
    if (priority == kSoon) note_soon(*r.pack, segment_of(request));
  }
  end_loading(r);
  return MICROTIN_STATUS_STEP_LIMIT;
}
