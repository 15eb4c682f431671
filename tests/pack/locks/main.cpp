// SPDX-License-Identifier: MIT
// locks PACK QUERIES [unlocked]: two threads query while another one loads, in a build with
// MICROTIN_PACK_ENTER, for each kind of pack. Ends with 1 if one of QUERIES heights is wrong, or if
// a pinned slot is written to. With `unlocked` the hooks do nothing, which a sanitizer must find.
// For a proof by numbers run it with 10000000 queries, which takes some minutes.
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

#include "microtin/compact_pack.h"

namespace {

std::mutex lock;
bool has_lock = true;
// Runs once, after the lock was released for the second time: a query has pinned its tile.
thread_local std::function<void()> with_pin;
thread_local int releases = 0;

std::vector<unsigned char> bytes;

int32_t read_pack(void*, uint64_t offset, uint8_t* buffer, size_t size) {
  if (offset >= bytes.size()) return 0;
  const size_t left = bytes.size() - static_cast<size_t>(offset);
  const size_t taken = size < left ? size : left;
  std::memcpy(buffer, bytes.data() + offset, taken);
  return static_cast<int32_t>(taken);
}

void require(bool is_right, const char* what) {
  if (is_right) return;
  std::printf("wrong: %s\n", what);
  std::exit(1);
}

// A pack of either kind.
class Pack {
 public:
  static constexpr uint32_t kCapacity = 300;

  Pack(bool is_compact, uint32_t slots) : is_compact_(is_compact) {
    const uint32_t tile_bytes = MICROTIN_COMPACT_BYTES(kCapacity);
    const size_t size = is_compact ? MICROTIN_COMPACT_PACK_BYTES(slots, kCapacity, tile_bytes)
                                   : MICROTIN_PACK_BYTES(slots, kCapacity);
    space_.resize(size / 8 + 1);
    const microtin_status status =
        is_compact
            ? microtin_compact_pack_init(space_.data(), size, slots, kCapacity, tile_bytes, &pack)
            : microtin_pack_init(space_.data(), size, slots, kCapacity, &pack);
    require(status == MICROTIN_STATUS_OK, "no pack");
  }

  microtin_status load(const microtin_segment& segment, uint32_t steps) const {
    return is_compact_ ? microtin_compact_pack_load_with(pack, &segment, read_pack, nullptr, steps)
                       : microtin_pack_load_with(pack, &segment, read_pack, nullptr, steps);
  }
  void load_all(const microtin_segment& segment) const {
    microtin_status status = MICROTIN_STATUS_NEED_INPUT;
    while (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT) {
      status = load(segment, 1000);
    }
    require(status == MICROTIN_STATUS_OK, "a segment is not loaded");
  }
  microtin_query_result height_at(int64_t x, int64_t y, int32_t* height) const {
    uint32_t hint = 0;
    return is_compact_ ? microtin_compact_pack_height_at(pack, x, y, &hint, height)
                       : microtin_pack_height_at(pack, x, y, &hint, height);
  }
  microtin_query_result extremes(const microtin_segment& segment,
                                 microtin_segment_extremes* found) const {
    return is_compact_ ? microtin_compact_pack_segment_extremes(pack, &segment, found)
                       : microtin_pack_segment_extremes(pack, &segment, found);
  }
  microtin_query_result gradient_at(int64_t x, int64_t y, microtin_gradient* gradient) const {
    uint32_t hint = 0;
    return is_compact_ ? microtin_compact_pack_gradient_at(pack, x, y, &hint, gradient)
                       : microtin_pack_gradient_at(pack, x, y, &hint, gradient);
  }

  microtin_pack* pack = nullptr;

 private:
  bool is_compact_;
  std::vector<uint64_t> space_;
};

// 32-bit numbers of a linear congruence.
class Numbers {
 public:
  explicit Numbers(uint32_t seed) : state_(seed) {}
  int64_t below(int64_t most) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<int64_t>((state_ >> 33) % static_cast<uint64_t>(most));
  }

 private:
  uint64_t state_;
};

struct Question {
  int64_t x, y;
  int32_t height;
  microtin_segment segment;
  microtin_segment_extremes extremes;
  microtin_gradient gradient;
};

// What a pack answers of which all tiles are loaded.
std::vector<Question> questions(uint32_t x_max, uint32_t y_max) {
  Pack whole(false, 64);
  whole.load_all({0, 0, int64_t{x_max} * 256, int64_t{y_max} * 256});
  std::vector<Question> all(500);
  Numbers numbers(7);
  for (Question& q : all) {
    q.x = numbers.below(int64_t{x_max} * 256 - 1024);
    q.y = numbers.below(int64_t{y_max} * 256 - 1024);
    q.segment = {q.x, q.y, q.x + numbers.below(1024), q.y + numbers.below(1024)};
    whole.load_all(q.segment);
    require(whole.height_at(q.x, q.y, &q.height) == MICROTIN_QUERY_OK, "no height");
    require(whole.extremes(q.segment, &q.extremes) == MICROTIN_QUERY_OK, "no extremes");
    require(whole.gradient_at(q.x, q.y, &q.gradient) == MICROTIN_QUERY_OK, "no gradient");
  }
  return all;
}

// What the threads of a race share.
struct Race {
  const std::vector<Question>& all;
  std::atomic<uint32_t> turn{0};  // of the loader: another question each time
  std::atomic<bool> has_failed{false}, is_over{false};

  // The question of a turn, in no order.
  const Question& question(uint32_t of_turn) const {
    return all[(of_turn * 2654435761u >> 16) % all.size()];
  }
};

// Queries until `queries` of them have a height: places of the loader's latest turns, so that their
// tiles are there, come, or go.
void ask(const Pack& pack, Race& race, uint32_t seed, uint64_t queries) {
  Numbers numbers(seed);
  for (uint64_t answers = 0; answers < queries && !race.has_failed;) {
    const Question& q = race.question(race.turn - static_cast<uint32_t>(numbers.below(5)));
    int32_t height = 0;
    if (pack.height_at(q.x, q.y, &height) != MICROTIN_QUERY_OK) {
      std::this_thread::yield();
      continue;
    }
    ++answers;
    if (height != q.height) race.has_failed = true;
    if (answers % 8 != 0) continue;
    microtin_segment_extremes extremes;
    if (pack.extremes(q.segment, &extremes) == MICROTIN_QUERY_OK &&
        (extremes.highest != q.extremes.highest || extremes.lowest != q.extremes.lowest)) {
      race.has_failed = true;
    }
    microtin_gradient gradient;
    if (pack.gradient_at(q.x, q.y, &gradient) == MICROTIN_QUERY_OK &&
        std::memcmp(&gradient, &q.gradient, sizeof gradient) != 0) {
      race.has_failed = true;
    }
  }
}

// Loads the tiles of one question after another. Returns how often it waited for a pinned slot.
uint64_t load_in_turn(const Pack& pack, Race& race) {
  uint64_t waits = 0;
  while (!race.is_over) {
    const Question& q = race.question(++race.turn);
    microtin_status status = MICROTIN_STATUS_NEED_INPUT;
    while (!race.is_over &&
           (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT)) {
      status = pack.load(q.segment, 50);
      if (microtin_pack_is_waiting(pack.pack)) ++waits;
    }
    require(race.is_over || status == MICROTIN_STATUS_OK, "loading ends with an error");
  }
  return waits;
}

void run_race(bool is_compact, const std::vector<Question>& all, uint64_t queries) {
  Pack pack(is_compact, 4);
  Race race{all};
  uint64_t waits = 0;
  std::thread loader([&] { waits = load_in_turn(pack, race); });
  std::thread one([&] { ask(pack, race, 1, queries / 2); });
  ask(pack, race, 2, queries - queries / 2);
  one.join();
  race.is_over = true;
  loader.join();
  require(!race.has_failed, "an answer of a thread");
  std::printf("%s slots: %llu right heights, segments loaded: %u, waits: %llu\n",
              is_compact ? "compact" : "mesh", static_cast<unsigned long long>(queries),
              race.turn.load(), static_cast<unsigned long long>(waits));
}

// A query that is as slow as can be: while it uses the only slot, the loader wants it.
void hold_a_pin(bool is_compact, uint32_t x_max, uint32_t y_max) {
  Pack pack(is_compact, 1);
  const microtin_segment here = {128, 128, 128, 128},
                         there = {x_max * int64_t{256} - 128, y_max * int64_t{256} - 128,
                                  x_max * int64_t{256} - 128, y_max * int64_t{256} - 128};
  int32_t expected = 0, height = 0;
  pack.load_all(here);
  require(pack.height_at(128, 128, &expected) == MICROTIN_QUERY_OK, "no height before");
  releases = 0;
  with_pin = [&] {
    for (int i = 0; i < 300; ++i) {
      const microtin_status status = pack.load(there, i % 2 == 0 ? 10 : 0);
      require(status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT,
              "a status while a slot is pinned");
    }
    require(microtin_pack_is_waiting(pack.pack) == 1, "the loader does not say that it waits");
  };
  require(pack.height_at(128, 128, &height) == MICROTIN_QUERY_OK && height == expected,
          "a height from a pinned slot");
  require(!with_pin, "no pin was held");
  pack.load_all(there);
  require(microtin_pack_is_waiting(pack.pack) == 0, "the loader waits for nothing");
  require(pack.height_at(there.x, there.y, &height) == MICROTIN_QUERY_OK, "no height after");
  require(pack.height_at(128, 128, &height) == MICROTIN_QUERY_NOT_LOADED, "two tiles in a slot");
}

}  // namespace

void locks_enter() {
  if (has_lock) lock.lock();
}

void locks_leave() {
  if (has_lock) lock.unlock();
  if (!with_pin || ++releases != 2) return;
  const std::function<void()> run = std::move(with_pin);
  with_pin = nullptr;
  run();
}

int main(int argc, char** argv) {
  std::FILE* const file = argc > 2 ? std::fopen(argv[1], "rb") : nullptr;
  if (file == nullptr) return 2;
  for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) {
    bytes.push_back(static_cast<unsigned char>(c));
  }
  std::fclose(file);
  has_lock = argc < 4;
  Pack header(false, 1);
  header.load_all({0, 0, 0, 0});
  microtin_pack_info info;
  require(microtin_pack_get_info(header.pack, &info) == MICROTIN_STATUS_OK, "no header");
  const std::vector<Question> all = questions(info.x_max, info.y_max);
  for (const bool is_compact : {false, true}) {
    hold_a_pin(is_compact, info.x_max, info.y_max);
    run_race(is_compact, all, std::strtoull(argv[2], nullptr, 10));
  }
  return 0;
}
