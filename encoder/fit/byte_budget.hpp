// SPDX-License-Identifier: MIT
// The smallest error bound that a number of bytes allows.
#ifndef MICROTIN_ENCODER_FIT_BYTE_BUDGET_HPP
#define MICROTIN_ENCODER_FIT_BYTE_BUDGET_HPP

#include <cstdint>
#include <functional>
#include <optional>

#include "encoder/exact/decimal.hpp"
#include "encoder/layers.hpp"

namespace microtin::fit {

// Bounds from `largest` downwards, 2.4 % apart and with three digits: rung 96 is a tenth of it.
// largest > 0.
Decimal bound_at(Decimal largest, uint32_t rung);

// The last of kRungs that fits, given that fewer bytes are needed for lower rungs; nothing if rung
// 0 does not. Large bounds, which are quick to try, come first. `roughly` is asked about 15 times,
// `exactly` as often as the two differ.
using Fits = std::function<bool(uint32_t rung)>;
std::optional<uint32_t> last_rung(const Fits& roughly, const Fits& exactly);
constexpr uint32_t kRungs = 600;  // more than six powers of ten

}  // namespace microtin::fit

#endif
