// SPDX-License-Identifier: MIT
// Which tiles stay and which give way where places compete for the slots of a pack.
#include "microtin/requests.h"

#include <doctest/doctest.h>

#include <vector>

#include "tests/support/forged_pack.hpp"
#include "tests/support/pack_device.hpp"

namespace microtin::tests {
namespace {

constexpr uint32_t kTiles = 8, kSide = 16;

// 8 x 8 equal tiles of 16 x 16 steps.
Bytes square_pack(uint32_t damaged = 0) {
  Random random(7);
  const ForgedTile tile = forged_tile(random_tile(random, kSide, kSide, true, 0));
  Bytes pack = forged_pack({kTiles * kSide, kTiles * kSide, kSide, kSide},
                           std::vector<ForgedTile>(kTiles * kTiles, tile));
  for (uint32_t i = 0; i < damaged; ++i) {
    const size_t size = tile.stream.size();
    pack[pack.size() - (kTiles * kTiles - i) * size + size / 2] ^= 1;
  }
  return pack;
}

// The middle of a tile.
microtin_segment middle(uint32_t column, uint32_t row) {
  return at(column * kSide + kSide / 2, row * kSide + kSide / 2);
}

template <class Slots>
struct Served {
  explicit Served(uint32_t slots, Bytes bytes = square_pack())
      : card{std::move(bytes)}, device(slots, 400) {
    microtin_requests_init(&requests, device.pack);
  }

  microtin_status serve(uint32_t steps = 1000) {
    return std::is_same<Slots, CompactSlots>::value
               ? microtin_requests_load_compact(&requests, Card::read, &card, steps)
               : microtin_requests_load(&requests, Card::read, &card, steps);
  }
  // Until nothing can be loaded.
  microtin_status settle() {
    microtin_status status = serve();
    for (int i = 0;
         i < 5000 && (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT);
         ++i) {
      status = serve();
    }
    return status;
  }
  microtin_status add(const microtin_segment& segment, uint32_t priority) {
    return microtin_requests_add(&requests, &segment, priority);
  }
  bool knows(const microtin_segment& place) {
    int32_t height = 0;
    return device.height_at(place.x, place.y, height) == MICROTIN_QUERY_OK;
  }

  Card card;
  Slots device;
  microtin_requests requests;
};

}  // namespace

TEST_CASE("requests: a query refreshes the tile that it uses, without requests too") {
  Card card{square_pack()};
  const MeshSlots device(2, 400);
  int32_t height = 0;
  const auto knows = [&](const microtin_segment& place) {
    return device.height_at(place.x, place.y, height) == MICROTIN_QUERY_OK;
  };
  REQUIRE(device.load(card, middle(0, 0)) == MICROTIN_STATUS_OK);
  REQUIRE(device.load(card, middle(1, 0)) == MICROTIN_STATUS_OK);
  REQUIRE(knows(middle(0, 0)));
  REQUIRE(device.load(card, middle(2, 0)) == MICROTIN_STATUS_OK);
  CHECK(knows(middle(0, 0)));
  CHECK(!knows(middle(1, 0)));
}

TEST_CASE_TEMPLATE("requests: the own place comes first, the way ahead next", Slots, MeshSlots,
                   CompactSlots) {
  Served<Slots> here(4);
  REQUIRE(here.settle() == MICROTIN_STATUS_OK);  // the header
  here.add(middle(7, 7), MICROTIN_PRIORITY_OTHER);
  for (int i = 0; i < 5; ++i) here.serve(1);  // it is in hand
  here.add(middle(1, 1), MICROTIN_PRIORITY_AHEAD);
  here.add(middle(0, 0), MICROTIN_PRIORITY_HERE);
  std::vector<int> order;
  for (int i = 0; i < 5000 && order.size() < 3; ++i) {
    here.serve(20);
    for (const int place : {0, 1, 7}) {
      const bool is_listed = std::count(order.begin(), order.end(), place) != 0;
      const auto tile = static_cast<uint32_t>(place);
      if (!is_listed && here.knows(middle(tile, tile))) order.push_back(place);
    }
  }
  CHECK(order == std::vector<int>{0, 1, 7});
  CHECK(here.settle() == MICROTIN_STATUS_OK);
  CHECK(microtin_requests_pending(&here.requests) == 0);
}

TEST_CASE_TEMPLATE("requests: they and a path search take turns in pieces, and both end", Slots,
                   MeshSlots, CompactSlots) {
  Served<Slots> here(3);
  const Slots whole(kTiles * kTiles, 400);
  for (uint32_t i = 0; i < kTiles * kTiles; ++i) {
    whole.load(here.card, middle(i % kTiles, i / kTiles));
  }
  const int64_t end = int64_t{kTiles} * kSide * 256;
  // It falls: no tile is ruled out.
  const microtin_path path = {{0, 0, end, end}, 1 << 23, -(1 << 23), 0};
  microtin_path_clearance expected;
  REQUIRE(whole.path_clearance(path, &expected, 0) == MICROTIN_QUERY_OK);

  microtin_path_search search{};
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  uint32_t moves = 0, found = 0;
  for (uint32_t turn = 0; turn < 100000 && status != MICROTIN_STATUS_OK; ++turn) {
    if (turn % 100 == 0) {
      const microtin_segment place = middle(moves * 3 % kTiles, moves * 5 % kTiles);
      here.add(place, MICROTIN_PRIORITY_HERE);
      ++moves;
    }
    if (here.serve(5) == MICROTIN_STATUS_OK) ++found;
    microtin_pack_read_once(here.device.pack, Card::read, &here.card);
    status = here.device.search_path(path, 0, &search, 5);
    REQUIRE((status == MICROTIN_STATUS_OK || status == MICROTIN_STATUS_NEED_INPUT ||
             status == MICROTIN_STATUS_STEP_LIMIT));
  }
  REQUIRE(status == MICROTIN_STATUS_OK);
  CHECK(search.tiles >= kTiles);
  CHECK(search.decoded > kTiles);
  CHECK(search.clearance.least == expected.least);
  CHECK(search.clearance.least_along == expected.least_along);
  CHECK(moves > 3);
  CHECK(found > moves);
  CHECK(here.settle() == MICROTIN_STATUS_OK);
  CHECK(here.knows(middle((moves - 1) * 3 % kTiles, (moves - 1) * 5 % kTiles)));
}

TEST_CASE_TEMPLATE("requests: a search goes on though the tile in hand cannot be read", Slots,
                   MeshSlots, CompactSlots) {
  Served<Slots> here(3);
  REQUIRE(here.settle() == MICROTIN_STATUS_OK);
  const microtin_path path = {{kSide * 128, kSide * 128, kSide * 128 + 1, kSide * 128}, 0, 0, 0};
  for (const uint32_t more : {0u, 1u}) {  // its entry, and its stream
    here.add(middle(7, 7 - more), MICROTIN_PRIORITY_HERE);
    here.card.failing = ~0u;
    while (here.serve(1) != MICROTIN_STATUS_NEED_INPUT) continue;
    for (uint32_t i = 0; i < more; ++i) here.serve(1);
    here.card.failing = here.card.reads;
    microtin_path_search search{};
    CHECK(here.device.search_path_with(path, 0, &search, here.card) == MICROTIN_STATUS_OK);
    CHECK(search.decoded == 1);
    CHECK(here.card.reads > here.card.failing);
  }
}

TEST_CASE_TEMPLATE("requests: no tile gives way to a request that is less important", Slots,
                   MeshSlots, CompactSlots) {
  Served<Slots> here(4);
  const microtin_segment corner = at(4 * kSide, 4 * kSide), ahead = middle(6, 6),
                         other = middle(0, 7);
  here.add(corner, MICROTIN_PRIORITY_HERE);
  here.settle();
  here.add(ahead, MICROTIN_PRIORITY_AHEAD);
  here.add(other, MICROTIN_PRIORITY_OTHER);
  const uint32_t reads = here.card.reads;
  for (int i = 0; i < 3000; ++i) {
    here.add(other, MICROTIN_PRIORITY_OTHER);
    const microtin_status status = here.serve();
    CHECK((status == MICROTIN_STATUS_WORKSPACE_TOO_SMALL || status == MICROTIN_STATUS_OK));
    for (const uint32_t x : {3u, 4u}) CHECK((here.knows(middle(x, 3)) && here.knows(middle(x, 4))));
  }
  CHECK(here.card.reads == reads);
  CHECK(microtin_requests_working_set(&here.requests) == 6);
  // A step on, and there is room.
  here.add(middle(4, 4), MICROTIN_PRIORITY_HERE);
  for (int i = 0; i < 3000 && !(here.knows(ahead) && here.knows(other)); ++i) {
    here.add(other, MICROTIN_PRIORITY_OTHER);
    here.serve();
  }
  CHECK(here.knows(ahead));
  CHECK(here.knows(other));
  CHECK(here.knows(middle(4, 4)));
}

TEST_CASE("requests: a way ahead that is too long for the slots keeps what is near") {
  Served<MeshSlots> here(3);
  const microtin_segment near = middle(0, 0);
  microtin_segment ahead = near;
  ahead.x_end = middle(7, 0).x;
  here.add(near, MICROTIN_PRIORITY_HERE);
  here.add(ahead, MICROTIN_PRIORITY_AHEAD);
  here.settle();
  const uint32_t reads = here.card.reads;
  for (int i = 0; i < 50; ++i) here.serve();
  CHECK(here.card.reads == reads);
  for (const uint32_t x : {0u, 1u, 2u}) CHECK(here.knows(middle(x, 0)));
  // The other way round, what was near is far.
  const microtin_segment back = {ahead.x_end, ahead.y_end, ahead.x, ahead.y};
  here.add(middle(7, 0), MICROTIN_PRIORITY_HERE);
  here.add(back, MICROTIN_PRIORITY_AHEAD);
  here.settle();
  for (const uint32_t x : {5u, 6u, 7u}) CHECK(here.knows(middle(x, 0)));
}

TEST_CASE("requests: none of many places starves, and the own place stays") {
  for (const uint32_t places : {3u, 6u, 9u, 14u}) {
    Served<MeshSlots> here(2);
    here.add(middle(0, 0), MICROTIN_PRIORITY_HERE);
    here.settle();
    std::vector<uint32_t> answers(places);
    const uint32_t services = places * 12 * MICROTIN_REQUEST_TURN;
    for (uint32_t i = 0; i < services; ++i) {
      for (uint32_t place = 0; i % 5 == 0 && place < places; ++place) {
        const microtin_segment there = middle(place % 7 + 1, place / 7 + 1);
        if (here.knows(there)) {
          ++answers[place];
        } else {
          here.add(there, MICROTIN_PRIORITY_OTHER);
        }
      }
      here.card.reads = 0;
      here.serve();
      if (i % 100 == 0) CHECK(here.knows(middle(0, 0)));
    }
    for (const uint32_t count : answers) CHECK(count > services / 5 / places / 8);
  }
}

TEST_CASE_TEMPLATE("requests: a place that is needed soon takes a slot that serves nothing", Slots,
                   MeshSlots, CompactSlots) {
  Served<Slots> here(3);
  here.add(middle(0, 0), MICROTIN_PRIORITY_HERE);
  here.settle();
  const auto query_two = [&] {  // so that they are in use
    for (const uint32_t x : {0u, 1u}) {
      if (!here.knows(middle(x, 0))) here.add(middle(x, 0), MICROTIN_PRIORITY_OTHER);
    }
  };
  query_two();
  here.settle();
  here.add(middle(5, 0), MICROTIN_PRIORITY_SOON);
  CHECK(microtin_requests_working_set(&here.requests) == 2);
  CHECK(here.settle() == MICROTIN_STATUS_OK);
  CHECK(here.knows(middle(5, 0)));
  // No other one displaces it at once, nor the tiles that are in use.
  const uint32_t reads = here.card.reads;
  for (int i = 0; i < MICROTIN_REQUEST_TURN / 4; ++i) {
    query_two();
    here.add(middle(6, 0), MICROTIN_PRIORITY_SOON);
    CHECK(here.serve() == MICROTIN_STATUS_OK);
  }
  CHECK(here.card.reads == reads);
  CHECK(microtin_requests_pending(&here.requests) == 0);
}

TEST_CASE("requests: a tile that is needed soon gives way at once to one that is missing") {
  Served<MeshSlots> here(2);
  here.add(middle(0, 0), MICROTIN_PRIORITY_HERE);
  here.settle();
  here.add(middle(5, 0), MICROTIN_PRIORITY_SOON);
  here.settle();
  const uint32_t reads_of_tile = here.card.reads / 2;
  here.add(middle(2, 0), MICROTIN_PRIORITY_OTHER);
  for (int i = 0; i < 40 && !here.knows(middle(2, 0)); ++i) here.serve();
  CHECK(here.knows(middle(2, 0)));
  CHECK(!here.knows(middle(5, 0)));
  CHECK(here.card.reads <= 4 * reads_of_tile);
}

TEST_CASE("requests: what is missing comes before what is needed soon, also if that is in hand") {
  Served<MeshSlots> here(4);
  here.settle();
  here.add(middle(5, 0), MICROTIN_PRIORITY_SOON);
  for (int i = 0; i < 3; ++i) here.serve(1);
  here.add(middle(2, 0), MICROTIN_PRIORITY_OTHER);
  while (!here.knows(middle(2, 0))) {
    REQUIRE(microtin_requests_pending(&here.requests) == 1);
    here.serve(20);
  }
  CHECK(!here.knows(middle(5, 0)));
  CHECK(microtin_requests_pending(&here.requests) == 0);
  here.settle();
  CHECK(here.knows(middle(5, 0)));
  // Places that are needed soon leave their room to others, and take none from these.
  for (uint32_t x = 0; x < 6; ++x) here.add(middle(x, 4), MICROTIN_PRIORITY_SOON);
  CHECK(here.add(middle(6, 4), MICROTIN_PRIORITY_SOON) == MICROTIN_STATUS_TOO_BIG);
  for (uint32_t x = 0; x < 6; ++x) {
    CHECK(here.add(middle(x, 5), MICROTIN_PRIORITY_OTHER) == MICROTIN_STATUS_OK);
    CHECK(here.add(middle(x, 5), MICROTIN_PRIORITY_SOON) == MICROTIN_STATUS_OK);
  }
  CHECK(here.add(middle(6, 4), MICROTIN_PRIORITY_SOON) == MICROTIN_STATUS_TOO_BIG);
  CHECK(microtin_requests_working_set(&here.requests) >= 6);
}

TEST_CASE("requests: turns bound what is read") {
  Served<MeshSlots> here(2);
  here.add(middle(0, 0), MICROTIN_PRIORITY_HERE);
  here.settle();
  const uint32_t before = here.card.reads;
  here.add(middle(1, 0), MICROTIN_PRIORITY_OTHER);
  here.settle();
  const uint32_t reads_of_tile = here.card.reads - before;
  constexpr uint32_t kTurns = 20;
  for (uint32_t i = 0; i < kTurns * MICROTIN_REQUEST_TURN; ++i) {
    for (const uint32_t x : {1u, 2u, 3u}) {
      if (!here.knows(middle(x, 0))) here.add(middle(x, 0), MICROTIN_PRIORITY_OTHER);
    }
    here.serve();
  }
  CHECK(here.card.reads - before <= (kTurns + 2) * reads_of_tile);
}

TEST_CASE("requests: a place that nobody requests again is forgotten") {
  Served<MeshSlots> here(2);
  here.settle();
  for (const uint32_t x : {1u, 2u}) {
    here.add(middle(x, 0), MICROTIN_PRIORITY_OTHER);
    here.settle();
  }
  here.knows(middle(1, 0));
  here.knows(middle(2, 0));
  here.add(middle(3, 0), MICROTIN_PRIORITY_OTHER);
  CHECK(microtin_requests_pending(&here.requests) == 1);
  for (int i = 0; i <= MICROTIN_REQUEST_LIFE; ++i) here.serve();
  CHECK(microtin_requests_pending(&here.requests) == 0);
}

TEST_CASE("requests: damaged tiles end their requests and are not read again at once") {
  for (const bool is_ahead : {false, true}) {
    Served<MeshSlots> here(4, square_pack(3 * kTiles));
    here.add(middle(0, 4), MICROTIN_PRIORITY_HERE);
    microtin_segment segment = middle(0, 0);
    segment.x_end = middle(7, 2).x;
    segment.y_end = middle(7, 2).y;
    here.settle();
    here.add(segment, is_ahead ? MICROTIN_PRIORITY_AHEAD : MICROTIN_PRIORITY_OTHER);
    here.settle();
    CHECK(microtin_requests_pending(&here.requests) == 0);
    const uint32_t reads = here.card.reads;
    for (int i = 0; i < 100; ++i) here.serve();
    CHECK(here.card.reads == reads);
    CHECK(here.knows(middle(0, 4)));
  }
}

TEST_CASE("requests: a card that fails, arguments, and the wrong kind of pack") {
  Served<MeshSlots> here(4);
  CHECK(microtin_requests_pending(&here.requests) == 1);
  CHECK(here.add(middle(1, 1), MICROTIN_PRIORITY_OTHER) == MICROTIN_STATUS_NEED_INPUT);
  CHECK(here.add(middle(1, 1), 4) == MICROTIN_STATUS_ARGUMENT);
  CHECK(here.add({0, 0, int64_t{1} << 24, 0}, 0) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_requests_add(&here.requests, nullptr, 0) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_requests_working_set(&here.requests) == 0);
  CHECK(here.add(middle(1, 1), MICROTIN_PRIORITY_HERE) == MICROTIN_STATUS_OK);
  here.serve();
  here.card.is_pulled = true;
  CHECK(here.serve() == MICROTIN_STATUS_IO);
  here.card.is_pulled = false;
  CHECK(here.settle() == MICROTIN_STATUS_OK);
  CHECK(here.knows(middle(1, 1)));
  for (uint32_t x = 0; x < 6; ++x) {
    CHECK(here.add(middle(x, 5), MICROTIN_PRIORITY_OTHER) == MICROTIN_STATUS_OK);
    CHECK(here.add(at(x * kSide + 3, 5 * kSide + 3), MICROTIN_PRIORITY_OTHER) ==
          MICROTIN_STATUS_OK);
  }
  CHECK(microtin_requests_pending(&here.requests) == 6);
  CHECK(here.add(middle(7, 5), MICROTIN_PRIORITY_OTHER) == MICROTIN_STATUS_TOO_BIG);

  Served<CompactSlots> other(4);
  CHECK(microtin_requests_load(&other.requests, Card::read, &other.card, 1) ==
        MICROTIN_STATUS_WRONG_PACK_KIND);
}

TEST_CASE_TEMPLATE("requests: reads that are not ready are no failures, and lose no tile", Slots,
                   MeshSlots, CompactSlots) {
  struct Slow {
    Card card{square_pack()};
    uint32_t calls = 0;

    static int32_t read(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
      Slow& slow = *static_cast<Slow*>(context);
      if (++slow.calls % 3 != 0) return MICROTIN_READ_NOT_READY;
      return Card::read(&slow.card, offset, buffer, size);
    }
  } slow;
  for (const uint32_t steps : {0u, 1u, 1000u}) {
    const Slots device(4, 400);
    const microtin_segment there = middle(3, 3);
    microtin_status status = MICROTIN_STATUS_NEED_INPUT;
    uint32_t calls = 0;
    while (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT) {
      status = device.load_with(there, Slow::read, &slow, steps);
      REQUIRE(++calls < 5000);
    }
    CHECK(status == MICROTIN_STATUS_OK);
    CHECK(calls > 3);  // a call ends at a read that is not ready
    int32_t height = 0;
    CHECK(device.height_at(there.x, there.y, height) == MICROTIN_QUERY_OK);
    microtin_pack_check check{};
    do {
      status = microtin_pack_check_with(device.pack, &there, 1, &check, Slow::read, &slow);
    } while (status == MICROTIN_STATUS_NEED_INPUT);
    CHECK(status == MICROTIN_STATUS_OK);
    CHECK(check.bad == 0);
  }
}

TEST_CASE("requests: a question interrupts the service at every step") {
  // Each read is an interrupt: the own place moves on while its tile is read.
  struct Moving {
    Served<MeshSlots> served{4};
    uint32_t steps = 0;

    static int32_t read(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
      Moving& moving = *static_cast<Moving*>(context);
      const uint32_t x = ++moving.steps / 40 % kTiles;
      moving.served.add(middle(x, 0), MICROTIN_PRIORITY_HERE);
      moving.served.knows(middle(x, 0));
      return Card::read(&moving.served.card, offset, buffer, size);
    }
  } moving;
  for (int i = 0; i < 2000; ++i)
    microtin_requests_load(&moving.served.requests, Moving::read, &moving, 50);
  moving.served.settle();
  CHECK(moving.served.knows(middle(moving.steps / 40 % kTiles, 0)));
}

}  // namespace microtin::tests
