// SPDX-License-Identifier: MIT
// What the names of files say about their formats.
#ifndef MICROTIN_ENCODER_BASE_SUFFIX_HPP
#define MICROTIN_ENCODER_BASE_SUFFIX_HPP

#include <string>

#include "encoder/layers.hpp"

namespace microtin::base {

// A to Z alone, whatever the locale.
std::string lower_case(std::string text);

// With its dot, in small letters: some systems write .ASC. Empty: the file has none.
std::string suffix_of(const std::string& path);

}  // namespace microtin::base

#endif
