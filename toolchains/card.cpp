// SPDX-License-Identifier: MIT
// A memory card that the emulator keeps in a file.
#include "toolchains/board.h"
#include "toolchains/semihost.hpp"

namespace {

constexpr uint32_t kOpen = 0x01, kRead = 0x06, kSeek = 0x0A;
constexpr uint32_t kBinaryRead = 1;  // fopen's "rb"
constexpr uint32_t kFailed = 0xFFFFFFFF;
constexpr uint32_t kSectorBytes = 512;

uint32_t card = kFailed;

uint32_t number_of(const void* place) {
  return static_cast<uint32_t>(reinterpret_cast<uintptr_t>(place));
}

}  // namespace

int open_card() {
  static const char name[] = "card.img";
  const uint32_t block[3] = {number_of(name), kBinaryRead, sizeof name - 1};
  card = semihost(kOpen, block);
  return card != kFailed;
}

int32_t read_sector(uint32_t sector, uint8_t* bytes) {
  const uint32_t place[2] = {card, sector * kSectorBytes};
  if (semihost(kSeek, place) != 0) return -1;
  const uint32_t block[3] = {card, number_of(bytes), kSectorBytes};
  const uint32_t missing = semihost(kRead, block);
  return missing > kSectorBytes ? -1 : static_cast<int32_t>(kSectorBytes - missing);
}
