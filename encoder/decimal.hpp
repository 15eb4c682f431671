// Exact decimal numbers: what people write in files and on command lines.
#ifndef MICROTIN_ENCODER_DECIMAL_HPP
#define MICROTIN_ENCODER_DECIMAL_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace microtin {

// mantissa * 10^-decimals, decimals in 0..18, no trailing zero among the decimals.
struct Decimal {
  int64_t mantissa = 0;
  int decimals = 0;
};

// Reads "12", "-0.25", "+7.30e-1", ".5", "5."; nothing else may precede or follow. More than
// `max_decimals` decimals are rounded to nearest (ties away from zero). Nothing if the text is not a
// finite number or does not fit.
std::optional<Decimal> parse_decimal(std::string_view text, int max_decimals = 9);

// "-0.25": shortest form that reads back equal.
std::string to_string(Decimal value);

}  // namespace microtin

#endif
