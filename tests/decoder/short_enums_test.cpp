// SPDX-License-Identifier: MIT
// Public structs and results are the same to callers whose enumerations have one byte.
#include "tests/decoder/short_enums.h"

#include <doctest/doctest.h>

#include "tests/support/forged_pack.hpp"
#include "tests/support/pack_device.hpp"

namespace microtin::tests {

TEST_CASE("short enums: structs have the same sizes, and what is written is what is read") {
  REQUIRE(short_enums_status_size() == 1);
  static_assert(sizeof(microtin_status) == 4, "the library's are not short");
  const size_t sizes[] = MICROTIN_PUBLIC_STRUCTS;
  uint32_t i = 0;
  for (const size_t size : sizes) CHECK(short_enums_size(i++) == size);
  Card card{forged_pack(
      {4, 4, 4, 4}, {forged_tile({{{0, 0, 1}, {4, 0, 2}, {0, 4, 3}, {4, 4, 4}, {2, 2, 5}}, {}})})};
  const MeshSlots device(1, 3);
  CHECK(device.load(card, at(1, 1)) == MICROTIN_STATUS_BAD_TILES);
  CHECK(short_enums_why(device.pack, 0) == MICROTIN_STATUS_TOO_BIG);
}

}  // namespace microtin::tests
