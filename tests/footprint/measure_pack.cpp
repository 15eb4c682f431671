// SPDX-License-Identifier: MIT
// Measures what the linked pack takes to serve and to ask, with slots of meshes and compact ones:
// prints a line "name value" for each number, all in instructions.
#include "microtin/compact_pack.hpp"
#include "tests/firmware/linked_pack.hpp"
#include "tests/firmware/report.hpp"
#include "tests/footprint/statistics.hpp"
#include "toolchains/counter.hpp"
#include "toolchains/firmware.h"

namespace {

constexpr uint32_t kSlots = 9, kCapacity = 64, kPlaces = 1024, kSegments = 64;

class Told {
 public:
  explicit Told(const char* form) : form_(form) {}

  void say(const char* what, uint32_t value) const {
    microtin::print(put_char, form_);
    microtin::print(put_char, what);
    microtin::print(put_char, " ");
    microtin::print(put_char, value);
    microtin::print(put_char, "\n");
  }

 private:
  const char* form_;
};

template <class Work>
uint32_t counted(const Work& work) {
  const uint32_t before = instruction_count();
  work();
  const uint32_t after = instruction_count();
  return after - before - (instruction_count() - after);
}

// Loads all tiles in calls of `step_limit` work units. Reading from flash is counted.
template <class Pack>
Statistics fetch(Pack& pack, microtin_pack_info& info, uint32_t step_limit) {
  Statistics calls;
  serve(pack, {0, 0, 0, 0});
  pack.get_info(&info);
  pack.reset();
  for (uint32_t i = 0; i < kSlots; ++i) {
    const int64_t x = static_cast<int64_t>(i % 3 * info.tile_width) * 256 + 128;
    const int64_t y = static_cast<int64_t>(i / 3 * info.tile_height) * 256 + 128;
    microtin_status status = MICROTIN_STATUS_NEED_INPUT;
    while (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT) {
      calls.add(counted([&] {
        status = pack.load_with({x, y, x, y}, read_flash, nullptr, step_limit);
      }));
    }
  }
  return calls;
}

template <class Pack>
void measure(Pack& pack, const Told& told) {
  microtin_pack_info info;
  const Statistics service = fetch(pack, info, 1);
  told.say("_tile", service.sum() / kSlots);
  told.say("_worst_call", service.most());
  told.say("_worst_call_20", fetch(pack, info, 20).most());
  Statistics heights, segments;
  microtin::ProbeNumbers numbers;
  const int32_t x_most = static_cast<int32_t>(info.x_max) * 256,
                y_most = static_cast<int32_t>(info.y_max) * 256;
  uint32_t hint = 0;
  int32_t height = 0;
  microtin_segment_extremes extremes;
  for (uint32_t i = 0; i < kPlaces; ++i) {
    const int32_t x = numbers.between(0, x_most), y = numbers.between(0, y_most);
    heights.add(counted([&] { pack.height_at(x, y, &hint, &height); }));
  }
  told.say("_height_mean", heights.mean());
  told.say("_height_worst", heights.most());
  for (uint32_t i = 0; i < kSegments; ++i) {
    const int32_t x = numbers.between(0, x_most), y = numbers.between(0, y_most),
                  x_end = numbers.between(0, x_most), y_end = numbers.between(0, y_most);
    segments.add(counted([&] { pack.segment_extremes({x, y, x_end, y_end}, &extremes); }));
  }
  told.say("_highest_mean", segments.mean());
  told.say("_highest_worst", segments.most());
}

}  // namespace

int firmware_main() {
  static microtin::Pack<kSlots, kCapacity> meshes(microtin::defer_init);
  static microtin::CompactPack<kSlots, kCapacity> compact(microtin::defer_init);
  if (meshes.begin() != MICROTIN_STATUS_OK || compact.begin() != MICROTIN_STATUS_OK) return 1;
  measure(meshes, Told("pack"));
  measure(compact, Told("compact_pack"));
  return 0;
}
