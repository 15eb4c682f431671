// SPDX-License-Identifier: MIT
// Characters of text that others wrote.
#ifndef MICROTIN_ENCODER_BASE_UTF8_HPP
#define MICROTIN_ENCODER_BASE_UTF8_HPP

#include <cstddef>
#include <string_view>

#include "encoder/layers.hpp"

namespace microtin::base {

// The bytes of the character that the text begins with; 0 if that is none of UTF-8.
size_t character_bytes(std::string_view text);

// Whether a character commands a terminal instead of being shown: U+0000 to U+001F and U+007F to
// U+009F.
bool is_control(std::string_view character);

}  // namespace microtin::base

#endif
