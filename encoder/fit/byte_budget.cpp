// SPDX-License-Identifier: MIT
// A ladder of bounds, searched roughly from above and then exactly.
#include "encoder/fit/byte_budget.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace microtin::fit {
namespace {

constexpr uint32_t kPerPowerOfTen = 96;
constexpr uint32_t kStride = 48;

double value_of(Decimal d) {
  return static_cast<double>(d.mantissa) / std::pow(10.0, d.decimals);
}

}  // namespace

Decimal bound_at(Decimal largest, uint32_t rung) {
  const double value =
      value_of(largest) * std::pow(10.0, -static_cast<double>(rung) / kPerPowerOfTen);
  char text[32];
  std::snprintf(text, sizeof text, "%.2e", value);
  return parse_decimal(text).value_or(largest);
}

std::optional<uint32_t> last_rung(const Fits& roughly, const Fits& exactly) {
  uint32_t fits = 0, fails = kStride;
  while (fails < kRungs && roughly(fails)) {
    fits = fails;
    fails += kStride;
  }
  while (fails - fits > 1) {
    const uint32_t middle = (fits + fails) / 2;
    (roughly(middle) ? fits : fails) = middle;
  }
  fits = std::min(fits, kRungs - 1);
  if (exactly(fits)) {
    while (fits + 1 < kRungs && exactly(fits + 1)) ++fits;
    return fits;
  }
  while (fits != 0) {
    if (exactly(--fits)) return fits;
  }
  return std::nullopt;
}

}  // namespace microtin::fit
