// SPDX-License-Identifier: MIT
// Checks dates: a year, a month of it or a day of that.
#include "encoder/base/iso_date.hpp"

#include <algorithm>

namespace microtin::base {
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

}  // namespace

bool is_iso_date(std::string_view text) {
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

}  // namespace microtin::base
