// SPDX-License-Identifier: MIT
// Continued fractions find what a rounded decimal stands for.
// Ours: what libraries have of fractions does not look for the simplest one near a rounded number.
#include "encoder/exact/fraction.hpp"

#include <algorithm>
#include <limits>

#include "encoder/base/error.hpp"

namespace microtin::exact {
namespace {

// The fraction with the smallest denominator in the closed interval between two positive ones; for
// one denominator the smallest (Stern-Brocot descent by continued fractions).
Fraction simplest_between(Fraction low, Fraction high) {
  const Wide whole = low.numerator / low.denominator;
  if (whole * low.denominator == low.numerator) return {whole, 1};
  if (whole < high.numerator / high.denominator) return {whole + 1, 1};
  const Fraction inverse =
      simplest_between({high.denominator, high.numerator - whole * high.denominator},
                       {low.denominator, low.numerator - whole * low.denominator});
  return {whole * inverse.numerator + inverse.denominator, inverse.numerator};
}

[[noreturn]] void refuse_axis() {
  throw Error("the coordinates, the heights or their steps are out of the format's range");
}

}  // namespace

Fraction reduced(Wide numerator, Wide denominator) {
  const Wide divisor = std::max<Wide>(greatest_common_divisor(numerator, denominator), 1);
  return {numerator / divisor, denominator / divisor};
}

Fraction simplest_fraction(Decimal written) {
  const Wide scale = power_of_ten(written.decimals);
  const Wide size = magnitude(written.mantissa);
  if (size == 0) return {0, 1};
  const Fraction simple = simplest_between({2 * size - 1, 2 * scale}, {2 * size + 1, 2 * scale});
  return {written.mantissa < 0 ? -simple.numerator : simple.numerator, simple.denominator};
}

Fraction meaning_of(Decimal written) {
  const Wide scale = power_of_ten(written.decimals);
  const Fraction simple = simplest_fraction(written);
  // About 0.3 q^2 / scale of random decimals have a fraction of a denominator up to q.
  const bool striking = 100 * simple.denominator * simple.denominator <= scale;
  return striking ? simple : reduced(written.mantissa, scale);
}

Fraction meaning_within(Decimal written, Fraction tolerance) {
  const Wide scale = power_of_ten(written.decimals);
  const Fraction simple = meaning_of(written);
  const Wide change = magnitude(simple.numerator * scale - written.mantissa * simple.denominator);
  const bool small =
      change * tolerance.denominator <= simple.denominator * scale * tolerance.numerator;
  return small ? simple : reduced(written.mantissa, scale);
}

std::optional<Fraction> reciprocal_meant(Decimal written) {
  const Wide scale = power_of_ten(written.decimals);
  const Fraction simple = meaning_of(written);
  // |written - 1/q| * 2^16 <= written / 100, times q * scale.
  const Wide drift = magnitude(written.mantissa * simple.denominator - scale);
  if (simple.numerator != 1 || drift == 0) return std::nullopt;
  if (drift * 6553600 > written.mantissa * simple.denominator) return std::nullopt;
  return simple;
}

// The first has a denominator below 2^81 (12 decimals times a step's 2^40 times 2), so products
// with the 40 bits of an axis fit.
Axis make_axis(Fraction first, Fraction step) {
  const Wide largest = std::max(step.numerator, step.denominator);
  if (step.numerator <= 0 || largest >= kAxisLimit) refuse_axis();
  const Wide whole = floor_divide(first.numerator, first.denominator);
  const Wide rest = first.numerator - whole * first.denominator;
  const Wide exact =
      first.denominator / greatest_common_divisor(first.denominator, step.denominator);
  const Wide finest = std::min((kAxisLimit - 1) / largest,
                               (Wide{1} << 62) / (magnitude(whole) + 1) / step.denominator);
  const Wide multiple = std::min(exact, finest);
  if (multiple == 0) refuse_axis();
  const Wide denominator = step.denominator * multiple;
  return reduced_axis(whole * denominator + round_divide(rest * denominator, first.denominator),
                      step.numerator * multiple, denominator);
}

Axis axis_of_cells(Decimal place, Decimal size, int64_t half_cells) {
  const std::optional<Fraction> reciprocal = reciprocal_meant(size);
  const Fraction start = reciprocal ? meaning_within(place, {1, 100 * reciprocal->denominator})
                                    : reduced(place.mantissa, power_of_ten(place.decimals));
  Fraction step = reciprocal ? *reciprocal : reduced(size.mantissa, power_of_ten(size.decimals));
  if (std::max(step.numerator, step.denominator) >= kAxisLimit) step = simplest_fraction(size);
  if (step.numerator >= kAxisLimit) refuse_axis();  // before its products leave 128 bits
  const Fraction first = reduced(
      2 * start.numerator * step.denominator + half_cells * step.numerator * start.denominator,
      2 * start.denominator * step.denominator);
  return make_axis(first, step);
}

Axis reduced_axis(Wide offset, Wide numerator, Wide denominator) {
  const Wide divisor =
      greatest_common_divisor(offset, greatest_common_divisor(numerator, denominator));
  offset /= divisor;
  numerator /= divisor;
  denominator /= divisor;
  if (magnitude(offset) > std::numeric_limits<int64_t>::max() || numerator >= kAxisLimit ||
      denominator >= kAxisLimit) {
    refuse_axis();
  }
  return {static_cast<int64_t>(offset), static_cast<uint64_t>(numerator),
          static_cast<uint64_t>(denominator)};
}

Axis moved_axis(const Axis& axis, Wide first) {
  const Wide numerator = static_cast<Wide>(axis.numerator);
  return reduced_axis(axis.offset + numerator * first, numerator,
                      static_cast<Wide>(axis.denominator));
}

}  // namespace microtin::exact
