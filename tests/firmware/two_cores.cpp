// SPDX-License-Identifier: MIT
// One core loads tiles of the linked pack, and another one queries them at the same time, in a
// build with hooks for a lock. Prints how many heights were wrong. With MICROTIN_UNLOCKED the hooks
// do nothing.
#include "microtin/compact_pack.hpp"
#include "tests/firmware/linked_pack.hpp"
#include "tests/firmware/report.hpp"
#include "toolchains/firmware.h"
#include "toolchains/second_core.hpp"

namespace {

constexpr uint32_t kTiles = 9, kSlots = 2, kCapacity = 64, kQuestions = 512;

#ifdef MICROTIN_UNLOCKED
constexpr bool kHasLock = false;
#else
constexpr bool kHasLock = true;
#endif

struct Question {
  int32_t x, y, height;
};
Question questions[kQuestions];

uint32_t compared;  // heights of all races

// Written by one core, and read by the other one.
uint32_t turn;            // of the loading core: another question each time
uint32_t answers, wrong;  // of a race; of all
bool is_over, is_idle;
void (*job)();
uint8_t lock;

template <class Value>
Value read_shared(const Value& value) {
  return __atomic_load_n(&value, __ATOMIC_ACQUIRE);
}

template <class Value>
void write_shared(Value& value, Value to) {
  __atomic_store_n(&value, to, __ATOMIC_RELEASE);
}

// The question of a turn, in no order.
const Question& question(uint32_t of_turn) {
  return questions[(of_turn * 2654435761u >> 16) % kQuestions];
}

// What a pack answers of which all tiles are loaded.
bool answer_all() {
  static microtin::Pack<kTiles, kCapacity> whole(microtin::defer_init);
  if (whole.begin() != MICROTIN_STATUS_OK) return false;
  serve(whole, {0, 0, 0, 0});
  microtin_pack_info info;
  whole.get_info(&info);
  microtin::ProbeNumbers numbers;
  for (Question& q : questions) {
    q.x = numbers.between(0, static_cast<int32_t>(info.x_max) * 256);
    q.y = numbers.between(0, static_cast<int32_t>(info.y_max) * 256);
    serve(whole, {q.x, q.y, q.x, q.y});
    uint32_t hint = 0;
    if (whole.height_at(q.x, q.y, &hint, &q.height) != MICROTIN_QUERY_OK) return false;
  }
  return true;
}

microtin::Pack<kSlots, kCapacity> meshes(microtin::defer_init);
microtin::CompactPack<kSlots, kCapacity> compact(microtin::defer_init);

// The second core's: queries places of the latest turns, whose tiles are there, come, or go.
template <class Pack>
void query(const Pack& pack) {
  uint32_t back = 0;
  while (!read_shared(is_over)) {
    back = (back + 1) % 3;
    const Question& q = question(read_shared(turn) - back);
    uint32_t hint = 0;
    int32_t height = 0;
    if (pack.height_at(q.x, q.y, &hint, &height) != MICROTIN_QUERY_OK) continue;
    write_shared(answers, answers + 1);
    if (height != q.height) write_shared(wrong, wrong + 1);
  }
}

void run_jobs() {
  for (;;) {
    void (*const next)() = read_shared(job);
    if (next == nullptr) continue;
    next();
    write_shared<void (*)()>(job, nullptr);
    write_shared(is_idle, true);
  }
}

// Loads until the other core has its answers, or a wrong one.
template <class Pack>
void race(Pack& pack, void (*querying)(), uint32_t queries) {
  write_shared(answers, uint32_t{0});
  write_shared(is_over, false);
  write_shared(is_idle, false);
  write_shared(job, querying);
  uint32_t now = 0;
  while (read_shared(answers) < queries && read_shared(wrong) == 0) {
    write_shared(turn, ++now);
    const Question& q = question(now);
    serve(pack, {q.x, q.y, q.x, q.y});
  }
  write_shared(is_over, true);
  while (!read_shared(is_idle)) {
  }
  compared += answers;
}

void print_count(uint32_t count, const char* what) {
  microtin::print(put_char, count);
  microtin::print(put_char, what);
}

}  // namespace

extern "C" void locks_enter() {
  while (kHasLock && __atomic_exchange_n(&lock, 1, __ATOMIC_ACQUIRE) != 0) {
  }
}

extern "C" void locks_leave() {
  if (kHasLock) __atomic_store_n(&lock, 0, __ATOMIC_RELEASE);
}

int firmware_main() {
  if (!answer_all()) return 1;
  if (meshes.begin() != MICROTIN_STATUS_OK || compact.begin() != MICROTIN_STATUS_OK) return 1;
  start_second_core(run_jobs);
  race(
      meshes, [] { query(meshes); }, MICROTIN_QUERIES);
  race(
      compact, [] { query(compact); }, MICROTIN_QUERIES);
  print_count(compared, " heights, wrong: ");
  print_count(wrong, "\n");
  return wrong == 0 ? 0 : 1;
}
