// SPDX-License-Identifier: MIT
// The autopilots' adapters on a device, over a pack in flash.
#include "tests/firmware/adapters_report.hpp"
#include "tests/firmware/linked_pack.hpp"
#include "toolchains/firmware.h"

namespace {

constexpr uint32_t kSlots = 5, kCapacity = 300;

alignas(MICROTIN_ALIGNMENT) uint8_t workspace[MICROTIN_PACK_BYTES(kSlots, kCapacity)];

}  // namespace

int firmware_main() {
  microtin_pack* pack = nullptr;
  if (microtin_pack_init(workspace, sizeof workspace, kSlots, kCapacity, &pack) !=
      MICROTIN_STATUS_OK) {
    return 3;
  }
  return microtin::AdaptersReport(put_char, pack, read_flash, nullptr).run();
}
