// SPDX-License-Identifier: MIT
// Texts made of several parts.
#ifndef MICROTIN_TESTS_SUPPORT_JOIN_HPP
#define MICROTIN_TESTS_SUPPORT_JOIN_HPP

#include <initializer_list>
#include <string>
#include <string_view>

namespace microtin::tests {

inline std::string join(std::initializer_list<std::string_view> parts) {
  std::string all;
  for (const std::string_view part : parts) all += part;
  return all;
}

}  // namespace microtin::tests

#endif
