// SPDX-License-Identifier: MIT
// Reads floating-point numbers by std::from_chars, which libc++ has for double from version 20 on,
// or by the C library in the C locale.
#include "encoder/base/real_number.hpp"

#include <charconv>

#if !defined(__cpp_lib_to_chars)
#include <locale.h>
#include <stdlib.h>

#include <cmath>
#include <string>
#endif

namespace microtin::base {

#if defined(__cpp_lib_to_chars)

std::optional<double> real_number(std::string_view text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || next != end) return std::nullopt;
  return value;
}

#else

std::optional<double> real_number(std::string_view text) {
  // Signs, blanks, and hexadecimal digits that std::from_chars does not read.
  if (text.empty() || text[0] == '+' || static_cast<unsigned char>(text[0]) <= ' ')
    return std::nullopt;
  if (text.find_first_of("xX") != text.npos) return std::nullopt;
  static const locale_t plain = newlocale(LC_ALL_MASK, "C", nullptr);
  const std::string copy(text);
  char* end = nullptr;
  const double value = strtod_l(copy.c_str(), &end, plain);
  if (end != copy.c_str() + copy.size()) return std::nullopt;
  const bool names_infinity = text.find_first_of("iI") != text.npos;
  if (std::isinf(value) && !names_infinity) return std::nullopt;
  // 0 that is not spelt so: no digit but 0 stands before an exponent.
  const bool spells_zero =
      text.substr(0, text.find_first_of("eE")).find_first_of("123456789") == text.npos;
  if (value == 0 && !spells_zero) return std::nullopt;
  return value;
}

#endif

}  // namespace microtin::base
