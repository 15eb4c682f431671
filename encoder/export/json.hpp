// SPDX-License-Identifier: MIT
// Values as JSON. Not by a library: numbers keep the digits that std::to_chars gives them
// ("1e+05"), and the bytes of .glb files are the same whatever version of a library is there.
#ifndef MICROTIN_ENCODER_EXPORT_JSON_HPP
#define MICROTIN_ENCODER_EXPORT_JSON_HPP

#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::exporting {

template <class Integer, std::enable_if_t<std::is_integral_v<Integer>, int> = 0>
std::string json(Integer value) {
  return std::to_string(value);
}

// The shortest number that is read as the same; finite.
std::string json(double value);

// In quotes, without any control character. What is not UTF-8 becomes U+FFFD.
std::string json(std::string_view text);

// Names and their values' JSON, in order.
using JsonObject = std::vector<std::pair<std::string, std::string>>;

std::string json(const JsonObject& object);

}  // namespace microtin::exporting

#endif
