// SPDX-License-Identifier: MIT
// A card that never waits, with every event in every state of the adapter's state machine.
#include <doctest/doctest.h>

#include <cstring>
#include <string>
#include <vector>

#include "decoder/adapters/inav.h"
#include "encoder/files/input.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/paths.hpp"

namespace microtin::tests {
namespace {

enum class Event { kNone, kPulled, kBusy, kFails, kStuck, kShort };

Bytes card_bytes() {
  const std::string text = read_file(golden("degree.mtp"));
  return {text.begin(), text.end()};
}

// A card of which every function takes some steps. Its DMA writes into the buffer at the end, which
// nobody may touch until then.
class SlowCard {
 public:
  static constexpr int kDelay = 3;

  microtin_card_driver driver() const { return {presence, open, seek, read, close}; }
  void begin(Event event, int steps) {
    event_ = event;
    steps_ = steps;
  }
  // A step of the main loop has passed.
  void pass() {
    if (steps_ > 0 && --steps_ == 0) event_ = Event::kNone;
  }
  bool is_open() const { return is_open_; }
  uint32_t opened = 0, failed = 0;

 private:
  static SlowCard& of(void* context) { return *static_cast<SlowCard*>(context); }

  static microtin_card_presence presence(void* context) {
    const SlowCard& card = of(context);
    if (card.event_ == Event::kPulled) return MICROTIN_CARD_ABSENT;
    return card.event_ == Event::kBusy ? MICROTIN_CARD_BUSY : MICROTIN_CARD_READY;
  }
  // Whether an operation has come to its end.
  bool is_done() {
    REQUIRE((event_ != Event::kPulled && event_ != Event::kBusy));
    if (event_ == Event::kStuck || ++waited_ < kDelay) return false;
    waited_ = 0;
    return true;
  }
  microtin_card_progress progress() {
    if (event_ == Event::kFails) {
      ++failed;
      is_broken_ = true;
      return MICROTIN_CARD_FAILED;
    }
    return is_done() ? MICROTIN_CARD_DONE : MICROTIN_CARD_NOT_YET;
  }
  static microtin_card_progress open(void* context) {
    SlowCard& card = of(context);
    REQUIRE(!card.is_open_);
    const microtin_card_progress found = card.progress();
    if (found == MICROTIN_CARD_DONE) {
      card.is_open_ = true;
      card.is_broken_ = false;
      card.at_ = 0;
      ++card.opened;
    }
    return found;
  }
  static microtin_card_progress seek(void* context, uint64_t offset) {
    SlowCard& card = of(context);
    REQUIRE(card.is_open_);
    REQUIRE(!card.is_broken_);  // errors are sticky
    const microtin_card_progress found = card.progress();
    if (found == MICROTIN_CARD_DONE) card.at_ = offset;
    return found;
  }
  static int32_t read(void* context, uint8_t* buffer, size_t size) {
    SlowCard& card = of(context);
    REQUIRE(card.is_open_);
    REQUIRE(!card.is_broken_);
    if (card.buffer_ == nullptr) {
      card.buffer_ = buffer;
      card.size_ = size;
      card.before_.assign(buffer, buffer + size);
    }
    REQUIRE(card.buffer_ == buffer);
    REQUIRE(card.size_ == size);
    REQUIRE(std::memcmp(buffer, card.before_.data(), size) == 0);
    const microtin_card_progress found = card.progress();
    if (found == MICROTIN_CARD_FAILED) return -1;
    if (found == MICROTIN_CARD_NOT_YET) return MICROTIN_READ_NOT_READY;
    card.buffer_ = nullptr;
    const size_t left = card.bytes_.size() - std::min(card.bytes_.size(), card.at_);
    size_t taken = std::min(size, left);
    if (card.event_ == Event::kShort) taken = std::min<size_t>(taken, 5);
    std::memcpy(buffer, card.bytes_.data() + card.at_, taken);
    card.at_ += taken;
    return static_cast<int32_t>(taken);
  }
  static void close(void* context) {
    SlowCard& card = of(context);
    card.is_open_ = false;
    card.buffer_ = nullptr;
    card.waited_ = 0;
  }

  Bytes bytes_ = card_bytes();
  Event event_ = Event::kNone;
  int steps_ = 0, waited_ = 0;
  bool is_open_ = false, is_broken_ = false;
  size_t at_ = 0, size_ = 0;
  uint8_t* buffer_ = nullptr;
  Bytes before_;
};

struct Flown {
  std::vector<float> heights;
  bool was_there = false;  // the state in which the event came
  uint32_t failures = 0, opened = 0;
  uint16_t removals = 0;
};

// Flies over three places; in the `nth` step in a state an event begins, and lasts some steps.
Flown fly(microtin_card_state state, uint32_t nth, Event event, int lasts) {
  const AdapterSlots device(4, 300);
  SlowCard slow;
  const microtin_card_driver driver = slow.driver();
  microtin_card card;
  microtin_card_init(&card, &driver, &slow);
  microtin_inav inav;
  microtin_inav_init(&inav, device.pack);
  Flown flown;
  for (const int32_t place : {0, 300000, 700000}) {
    float height = 0;
    for (int step = 0; step < 20000; ++step) {
      microtin_inav_set_position(&inav, 433100000 + place, 72150000 + place);
      if (microtin_inav_height(&inav, 433100000 + place, 72150000 + place, &height)) break;
      if (card.state == state && !flown.was_there && --nth == 0) {
        flown.was_there = true;
        slow.begin(event, lasts);
      }
      const microtin_status status = microtin_inav_load_card(&inav, &card, 50);
      if (status == MICROTIN_STATUS_IO) {
        ++flown.failures;
      } else {
        REQUIRE((status == MICROTIN_STATUS_OK || status == MICROTIN_STATUS_NEED_INPUT ||
                 status == MICROTIN_STATUS_STEP_LIMIT));
      }
      slow.pass();
    }
    flown.heights.push_back(height);
  }
  flown.opened = slow.opened;
  flown.removals = card.removals;
  uint32_t tile = 0, why = 0;
  for (uint32_t i = 0; i < MICROTIN_PACK_MAX_BAD_TILES; ++i) {
    CHECK(microtin_pack_bad_tile(device.pack, i, &tile, &why) == MICROTIN_STATUS_NOT_FOUND);
  }
  return flown;
}

}  // namespace

TEST_CASE("adapters: every event in every state of a card leaves all heights known") {
  const Flown calm = fly(MICROTIN_CARD_GONE, 0, Event::kNone, 0);
  REQUIRE(calm.opened == 1);
  CHECK(calm.failures == 0);
  CHECK(calm.heights[0] > 0);
  for (const microtin_card_state state :
       {MICROTIN_CARD_CLOSED, MICROTIN_CARD_OPENING, MICROTIN_CARD_OPEN, MICROTIN_CARD_SEEKING,
        MICROTIN_CARD_READING}) {
    for (const uint32_t nth : {1u, 2u, 6u}) {
      if (nth == 6 && state < MICROTIN_CARD_OPEN) continue;
      if (nth == 2 && state == MICROTIN_CARD_CLOSED) continue;
      for (const Event event :
           {Event::kPulled, Event::kBusy, Event::kFails, Event::kStuck, Event::kShort}) {
        for (const int lasts : {1, 7, 1200}) {
          const Flown flown = fly(state, nth, event, lasts);
          CAPTURE(int{state});
          CAPTURE(nth);
          CAPTURE(static_cast<int>(event));
          CAPTURE(lasts);
          CHECK(flown.was_there);
          CHECK(flown.heights == calm.heights);
          const bool is_patient = event == Event::kBusy || event == Event::kShort ||
                                  (event == Event::kStuck && lasts < MICROTIN_CARD_PATIENCE);
          if (is_patient) CHECK(flown.failures == 0);
          if (event == Event::kPulled) CHECK(flown.removals == 1);
          if (event == Event::kPulled && lasts > 1) CHECK(flown.failures > 0);
          if (event == Event::kStuck && lasts > MICROTIN_CARD_PATIENCE) CHECK(flown.failures > 0);
        }
      }
    }
  }
}

TEST_CASE("adapters: a card that fails rests before it is opened again") {
  const Flown flown = fly(MICROTIN_CARD_READING, 5, Event::kFails, MICROTIN_CARD_REST - 2);
  CHECK(flown.failures == 1);
  CHECK(flown.opened == 2);
}

}  // namespace microtin::tests
