// SPDX-License-Identifier: MIT
// Reads characters, suffixes, dates and numbers.
#include "encoder/base/text.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>

#if !defined(__cpp_lib_to_chars)
#include <locale.h>
#include <stdlib.h>

#include <cmath>
#include <string>
#endif

namespace microtin::base {

size_t character_bytes(std::string_view text) {
  const auto byte = [text](size_t i) -> uint32_t {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
  };
  const uint32_t first = byte(0);
  if (first < 0x80) return 1;
  if (first < 0xC0 || first >= 0xF8) return 0;
  const size_t size = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  uint32_t code = first & (0x7Fu >> size);
  for (size_t i = 1; i < size; ++i) {
    if ((byte(i) & 0xC0u) != 0x80) return 0;
    code = code << 6 | (byte(i) & 0x3Fu);
  }
  const uint32_t least = size == 2 ? 0x80 : size == 3 ? 0x800 : 0x10000;
  const bool surrogate = code >= 0xD800 && code < 0xE000;
  return code >= least && code <= 0x10FFFF && !surrogate ? size : 0;
}

bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character.front());
  if (character.size() == 1) return first < 0x20 || first == 0x7F;
  return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
}

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::string suffix_of(const std::string& path) {
  return lower_case(std::filesystem::u8path(path).extension().string());
}

namespace {

bool is_number(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

int value_of(std::string_view digits) {
  int value = 0;
  for (const char c : digits) value = 10 * value + (c - '0');
  return value;
}

int days_of(int year, int month) {
  if (month != 2) return month == 4 || month == 6 || month == 9 || month == 11 ? 30 : 31;
  return year % 4 == 0 && (year % 100 != 0 || year % 400 == 0) ? 29 : 28;
}

bool is_single_date(std::string_view text) {
  if (text.size() != 4 && text.size() != 7 && text.size() != 10) return false;
  if (!is_number(text.substr(0, 4))) return false;
  if (text.size() == 4) return true;
  const std::string_view month = text.substr(5, 2);
  if (text[4] != '-' || !is_number(month) || value_of(month) < 1 || value_of(month) > 12) {
    return false;
  }
  if (text.size() == 7) return true;
  const std::string_view day = text.substr(8);
  return text[7] == '-' && is_number(day) && value_of(day) >= 1 &&
         value_of(day) <= days_of(value_of(text.substr(0, 4)), value_of(month));
}

}  // namespace

bool is_iso_date(std::string_view text) {
  const size_t slash = text.find('/');
  if (slash == text.npos) return is_single_date(text);
  const std::string_view first = text.substr(0, slash), last = text.substr(slash + 1);
  const size_t common = std::min(first.size(), last.size());
  return is_single_date(first) && is_single_date(last) &&
         first.substr(0, common) <= last.substr(0, common);
}

bool is_iso_validity(std::string_view text) {
  const size_t slash = text.find('/');
  if (slash == text.npos) return is_iso_date(text);
  const std::string_view first = text.substr(0, slash), last = text.substr(slash + 1);
  if (first == "..") return is_single_date(last);
  return last == ".." ? is_single_date(first) : is_iso_date(text);
}

std::string iso_date(int year, int day) {
  if (year < 1000 || year > 9999) return "";
  int month = 1;
  while (month < 12 && day > days_of(year, month)) day -= days_of(year, month++);
  if (day < 1 || day > days_of(year, month)) return std::to_string(year);
  const auto two_digits = [](int number) {
    return std::string(number < 10 ? "-0" : "-") + std::to_string(number);
  };
  return std::to_string(year) + two_digits(month) + two_digits(day);
}

std::string hexadecimal(uint64_t number) {
  std::string digits(16, '0');
  for (size_t i = digits.size(); i-- > 0; number >>= 4) digits[i] = "0123456789abcdef"[number & 15];
  return digits;
}

std::string utf8_of(std::string text) {
  std::string_view rest = text;
  while (!rest.empty() && character_bytes(rest) != 0) rest.remove_prefix(character_bytes(rest));
  if (rest.empty()) return text;
  std::string converted;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x80) converted += static_cast<char>(0xC0 | byte >> 6);
    converted += static_cast<char>(byte >= 0x80 ? 0x80 | (byte & 0x3F) : byte);
  }
  return converted;
}

// Reads floating-point numbers by std::from_chars, which libc++ has for double from version 20 on,
// or by the C library in the C locale.

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
