// SPDX-License-Identifier: MIT
// Floating-point numbers in text, whatever the locale.
#ifndef MICROTIN_ENCODER_BASE_REAL_NUMBER_HPP
#define MICROTIN_ENCODER_BASE_REAL_NUMBER_HPP

#include <optional>
#include <string_view>

#include "encoder/layers.hpp"

namespace microtin::base {

// The double nearest to the number that the whole text spells: "-0.25", "1e5", "inf", "nan".
// Returns nothing for other text ("+1", " 1", "0x1", "1,5") and for finite numbers that no double
// is near.
std::optional<double> real_number(std::string_view text);

}  // namespace microtin::base

#endif
