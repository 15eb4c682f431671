// SPDX-License-Identifier: MIT
// From real coordinates to the lattice, for any axis: what exact arithmetic says, or a refusal.
#include <fuzzer/FuzzedDataProvider.h>

#include <cstdint>

#include "fuzz/support/expect.hpp"
#include "tests/support/reference_heights.hpp"

using namespace microtin::tests;
using reference::Wide;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr uint64_t kMost = (uint64_t{1} << 40) - 1;
  constexpr int64_t kLimit = int64_t{1} << 61;
  FuzzedDataProvider given(data, size);
  microtin_axis axis;
  axis.offset = given.ConsumeIntegral<int64_t>();
  axis.numerator = given.ConsumeIntegralInRange<uint64_t>(1, kMost);
  axis.denominator = given.ConsumeIntegralInRange<uint64_t>(1, kMost);
  const uint32_t per_unit = given.ConsumeIntegralInRange<uint32_t>(0, (1u << 24) + 1);
  const Wide numerator = static_cast<Wide>(axis.numerator);
  const Wide denominator = static_cast<Wide>(axis.denominator);
  Wide value = given.ConsumeIntegral<int64_t>();
  if (given.ConsumeBool()) {  // near a lattice place
    const Wide k = given.ConsumeIntegralInRange<int32_t>(-2, 65537);
    value = (axis.offset + k * numerator) * per_unit / denominator +
            given.ConsumeIntegralInRange<int32_t>(-2, 2);
  }
  if (value < INT64_MIN || value > INT64_MAX) return 0;
  bool known =
      per_unit >= 1 && per_unit <= 1u << 24 && axis.offset > -kLimit && axis.offset < kLimit;
  Wide expected = 0;
  if (known) {
    const Wide steps = value * denominator - Wide{axis.offset} * per_unit;
    expected = reference::rounded(steps * 256, numerator * per_unit);
    known = expected >= 0 && expected <= 65535 * 256;
  }
  int32_t lattice = 0;
  EXPECT((microtin_axis_to_lattice(&axis, static_cast<int64_t>(value), per_unit, &lattice) ==
          MICROTIN_STATUS_OK) == known);
  EXPECT(lattice == expected || !known);
  return 0;
}
