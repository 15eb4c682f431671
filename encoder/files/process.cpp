// SPDX-License-Identifier: MIT
// A list of temporary files that a signal handler removes.
#include "encoder/files/process.hpp"

#include <atomic>
#include <cstring>
#include <mutex>

namespace microtin::files {
namespace {

constexpr std::size_t kSlots = 8, kLongest = 4096;

// A handler may read nothing else: fixed memory, each flag set last and cleared first.
struct Slot {
  std::atomic<bool> used;
  char path[kLongest];
};
static_assert(std::atomic<bool>::is_always_lock_free, "a handler must not wait");

Slot slots[kSlots];
std::mutex mutex;  // of who takes slots and gives them back

}  // namespace

void for_each_leftover(void (*remove)(const char* path)) {
  for (const Slot& slot : slots) {
    if (slot.used) remove(slot.path);
  }
}

Leftover::Leftover(const std::string& path) : slot_(0) {
  const std::lock_guard<std::mutex> lock(mutex);
  while (slot_ < kSlots && slots[slot_].used) ++slot_;
  if (slot_ == kSlots || path.size() >= kLongest) {
    slot_ = kSlots;
    return;
  }
  std::memcpy(slots[slot_].path, path.c_str(), path.size() + 1);
  slots[slot_].used = true;
}

Leftover::~Leftover() {
  const std::lock_guard<std::mutex> lock(mutex);
  if (slot_ != kSlots) slots[slot_].used = false;
}

}  // namespace microtin::files
