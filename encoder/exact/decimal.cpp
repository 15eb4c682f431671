// SPDX-License-Identifier: MIT
// Reads, rounds, scales and prints decimals by integers.
// Ours: libraries for decimals keep each number on the heap; there are millions of these.
#include "encoder/exact/decimal.hpp"

#include <algorithm>
#include <charconv>
#include <limits>

#include "encoder/base/text.hpp"

namespace microtin::exact {
namespace {

constexpr int64_t kMostBeforeDigit = 100000000000000000;  // 10^17: one more digit still fits

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool remove_sign(std::string_view& text) {
  if (text.empty() || (text[0] != '-' && text[0] != '+')) return false;
  const bool negative = text[0] == '-';
  text.remove_prefix(1);
  return negative;
}

// Splits "12.5e-3" at the e; nothing if what follows is not an exponent.
std::optional<int64_t> remove_exponent(std::string_view& text) {
  const size_t e = text.find_first_of("eE");
  if (e == std::string_view::npos) return 0;
  std::string_view digits = text.substr(e + 1);
  const bool negative = remove_sign(digits);
  int32_t exponent = 0;
  const char* end = digits.data() + digits.size();
  if (digits.empty() || !is_digit(digits[0])) return std::nullopt;
  const auto [next, error] = std::from_chars(digits.data(), end, exponent);
  if (next != end || error != std::errc()) return std::nullopt;
  text = text.substr(0, e);
  return negative ? -exponent : exponent;
}

// Collects digits from the left; each counts 10^-place.
struct Digits {
  int max_decimals;
  int64_t mantissa = 0;
  int64_t decimals = 0;  // place of the last digit kept
  bool full = false;

  // False if a digit of the integer part does not fit.
  bool add(int digit, int64_t place) {
    if (full || (mantissa == 0 && digit == 0)) return true;
    if (place <= max_decimals && mantissa < kMostBeforeDigit) {
      mantissa = mantissa * 10 + digit;
      decimals = place;
      return true;
    }
    full = true;
    if (place <= 0) return false;
    if (mantissa == 0) decimals = max_decimals;
    if (place == decimals + 1 && digit >= 5) ++mantissa;
    return true;
  }
};

template <class Binary>
std::optional<Decimal> shortest(Binary value, int max_decimals) {
  char text[32];
  const char* const end = std::to_chars(text, text + sizeof text, value).ptr;
  return parse_decimal({text, static_cast<size_t>(end - text)}, max_decimals);
}

}  // namespace

bool operator==(Decimal a, Decimal b) {
  return a <= b && b <= a;
}

bool operator<=(Decimal a, Decimal b) {
  const int decimals = std::max(a.decimals, b.decimals);
  return mantissa_at(a, decimals) <= mantissa_at(b, decimals);
}

int64_t power_of_ten(int exponent) {
  int64_t power = 1;
  for (int i = 0; i < exponent; ++i) power *= 10;
  return power;
}

Decimal make_decimal(Wide mantissa, int decimals) {
  constexpr Wide kMost = std::numeric_limits<int64_t>::max();
  while (decimals > 0 && (mantissa % 10 == 0 || magnitude(mantissa) > kMost)) {
    mantissa /= 10;
    --decimals;
  }
  return {static_cast<int64_t>(std::clamp(mantissa, -kMost, kMost)), decimals};
}

Decimal make_decimal_up(Wide mantissa, int decimals) {
  constexpr Wide kMost = std::numeric_limits<int64_t>::max();
  for (; decimals > 0 && mantissa > kMost; --decimals) mantissa = ceil_divide(mantissa, 10);
  return make_decimal(mantissa, decimals);
}

Decimal make_decimal_nearest(Wide mantissa, int decimals) {
  constexpr Wide kMost = std::numeric_limits<int64_t>::max();
  Wide power = 1;
  for (; decimals > 0 && magnitude(mantissa) / power >= kMost; --decimals) power *= 10;
  return make_decimal(round_divide(mantissa, power), decimals);
}

Decimal half(Decimal value) {
  return make_decimal(Wide{value.mantissa} * 5, value.decimals + 1);
}

Wide mantissa_at(Decimal value, int decimals) {
  return Wide{value.mantissa} * power_of_ten(decimals - value.decimals);
}

std::optional<Decimal> parse_decimal(std::string_view text, int max_decimals) {
  const bool negative = remove_sign(text);
  const std::optional<int64_t> exponent = remove_exponent(text);
  if (!exponent) return std::nullopt;
  const size_t point = std::min(text.find('.'), text.size());
  if (text.empty() || text == ".") return std::nullopt;
  Digits digits{max_decimals};
  int64_t place = -static_cast<int64_t>(point) - *exponent;
  for (size_t i = 0; i < text.size(); ++i) {
    if (i == point) continue;
    if (!is_digit(text[i]) || !digits.add(text[i] - '0', ++place)) return std::nullopt;
  }
  if (digits.mantissa == 0) return Decimal{};
  for (; digits.decimals < 0; ++digits.decimals) {
    if (digits.mantissa >= kMostBeforeDigit) return std::nullopt;
    digits.mantissa *= 10;
  }
  return make_decimal(negative ? -digits.mantissa : digits.mantissa,
                      static_cast<int>(digits.decimals));
}

std::optional<Decimal> shortest_decimal(float value, int max_decimals) {
  return shortest(value, max_decimals);
}

std::optional<Decimal> shortest_decimal(double value, int max_decimals) {
  return shortest(value, max_decimals);
}

std::string to_string(Decimal value) {
  const bool negative = value.mantissa < 0;
  const uint64_t bits = static_cast<uint64_t>(value.mantissa);
  std::string text = std::to_string(negative ? 0 - bits : bits);
  const size_t decimals = static_cast<size_t>(value.decimals);
  if (text.size() <= decimals) text.insert(0, decimals + 1 - text.size(), '0');
  if (decimals != 0) text.insert(text.size() - decimals, ".");
  return negative ? "-" + text : text;
}

double real(Decimal value) {
  return real_number(to_string(value)).value_or(0);
}

}  // namespace microtin::exact
