// SPDX-License-Identifier: MIT
// Between the lattice and real coordinates: places and heights, exactly, and as text.
#include "encoder/exact/lattice_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "encoder/exact/wide.hpp"

namespace microtin::exact {
namespace {

constexpr int kBinaryBits = 62;
constexpr Wide kBinaryParts = Wide{1} << kBinaryBits;

// The lattice coordinate next to it.
int64_t nearest_line(const RealCoordinate& at) {
  return at.whole + (at.part >= at.parts - at.part ? 1 : 0);
}

// part / from as parts of `to`, rounded down; from, to < 2^122.
Wide rescaled(Wide part, Wide from, Wide to) {
  return from == to ? part : multiply_divide(to, part, from).whole;
}

// The smallest common denominator, or kMostParts if that is larger.
Wide common_parts(Wide a, Wide b) {
  if (a == b) return a;
  Wide product = 0;
  const Wide factor = b % a == 0 ? b / a : b / greatest_common_divisor(a, b);
  return __builtin_mul_overflow(a, factor, &product) || product > kMostParts ? kMostParts : product;
}

}  // namespace

RealPlace place_of(const RealCoordinate& x, const RealCoordinate& y) {
  const Wide parts =
      x.parts > kMostParts || y.parts > kMostParts ? kMostParts : common_parts(x.parts, y.parts);
  return {x.whole, y.whole, rescaled(x.part, x.parts, parts), rescaled(y.part, y.parts, parts),
          parts};
}

// `step` is below 2^80.
std::optional<RealCoordinate> coordinate_of(const LatticeMap& map, Wide number, const Axis& axis) {
  constexpr Wide kFar = Wide{1} << 62;
  constexpr double kHalfUnit = 0.5e-12;
  const Wide numerator = map.numerator(number), whole = floor_divide(numerator, map.step);
  if (whole <= -kFar || whole >= kFar) return std::nullopt;
  const RealCoordinate at{static_cast<int64_t>(whole), numerator - whole * map.step, map.step};
  const double above = static_cast<double>(at.part), parts = static_cast<double>(at.parts);
  const double away = std::min(above, static_cast<double>(at.parts - at.part));
  if (away * step_of(axis) <= kHalfUnit * parts) return RealCoordinate{nearest_line(at), 0, 1};
  return at;
}

std::optional<RealCoordinate> coordinate_of(Decimal value, const Axis& axis) {
  const Axis decimals = decimal_axis(value.decimals);
  return coordinate_of(map_between(decimals, axis), value.mantissa, axis);
}

std::vector<Axis> names_of_x(const Axis& x, bool is_degrees) {
  constexpr Wide kTurn = 360, kMost = std::numeric_limits<int64_t>::max();
  std::vector<Axis> names = {x};
  for (const Wide turns : {-kTurn, kTurn}) {
    const Wide offset = x.offset + turns * static_cast<Wide>(x.denominator);
    if (!is_degrees || magnitude(offset) > kMost) continue;
    names.push_back({static_cast<int64_t>(offset), x.numerator, x.denominator});
  }
  return names;
}

BinaryAxis::BinaryAxis(const Axis& axis, int64_t low, int64_t high)
    : axis_(axis), low_(low), high_(high), least_(real(low - 1)), most_(real(high + 1)) {}

// Times the numerator, a coordinate is the sum of value's whole units and of their rest, which are
// taken apart: below 2^103 and, in 2^62 parts, below 2^102.
std::optional<RealCoordinate> BinaryAxis::operator()(double value) const {
  if (!(value >= least_ && value <= most_)) return std::nullopt;
  const double units = std::floor(value);
  const auto rest = static_cast<int64_t>(std::ldexp(value - units, kBinaryBits));
  const Wide numerator = static_cast<Wide>(axis_.numerator);
  const Wide denominator = static_cast<Wide>(axis_.denominator);
  const Wide ahead = static_cast<Wide>(units) * denominator - axis_.offset;
  const Wide steps = floor_divide(ahead, numerator);
  const Wide fine = ((ahead - steps * numerator) << kBinaryBits) + rest * denominator;
  const Wide more = (fine >> kBinaryBits) / numerator;
  const Wide part = (fine - ((more * numerator) << kBinaryBits)) / numerator;
  RealCoordinate at{static_cast<int64_t>(steps + more), part, kBinaryParts};
  const int64_t line = nearest_line(at);
  if (std::fabs(real(line) - value) <= std::ldexp(std::fabs(value), -50)) at = {line, 0, 1};
  if (at.whole < low_ || at.whole > high_ || (at.whole == high_ && at.part != 0)) {
    return std::nullopt;
  }
  return at;
}

namespace {

// Quick for most numbers, which have 64 bits.
double to_double(Wide number) {
  const auto low = static_cast<int64_t>(number);
  return low == number ? static_cast<double>(low) : static_cast<double>(number);
}

}  // namespace

// Times the axis' denominator a height is whole + rest / under, of which rest / under < 1: a
// quotient by an integer is rounded as if there were none of it, but for its half.
Wide rounded_mantissa(const Axis& z, const ExactHeight& height, int decimals) {
  const Wide scale = power_of_ten(decimals), denominator = static_cast<Wide>(z.denominator);
  const Wide numerator = static_cast<Wide>(z.numerator);
  const auto [whole, rest] = multiply_divide(scale * numerator, height.above, height.under);
  const Wide all = scale * (z.offset + numerator * height.base) + whole;
  const Wide half = rest >= height.under - rest ? 1 : 0;  // of twice the rest the whole part
  return floor_divide(2 * all + half + denominator, 2 * denominator);
}

Decimal rounded_height(const Axis& z, const ExactHeight& height, int decimals) {
  return make_decimal(rounded_mantissa(z, height, decimals), decimals);
}

double real_height(const Axis& z, const ExactHeight& height) {
  const double above = to_double(height.above) / to_double(height.under);
  const Wide base = z.offset + static_cast<Wide>(z.numerator) * height.base;
  return (to_double(base) + static_cast<double>(z.numerator) * above) /
         static_cast<double>(z.denominator);
}

int32_t fixed_height(const ExactHeight& height) {
  const auto [whole, rest] = multiply_divide(65536, height.above, height.under);
  const Wide half = rest >= height.under - rest ? 1 : 0;
  return static_cast<int32_t>(Wide{height.base} * 65536 + whole + half);
}

namespace {

uint64_t reduced_denominator(const Axis& axis) {
  const Wide denominator = static_cast<Wide>(axis.denominator);
  const Wide divisor = greatest_common_divisor(
      axis.offset, greatest_common_divisor(static_cast<Wide>(axis.numerator), denominator));
  return static_cast<uint64_t>(denominator / divisor);
}

}  // namespace

int decimals_of(const Axis& axis) {
  constexpr int kMost = 18, kOfEndless = 12;
  uint64_t denominator = reduced_denominator(axis);
  int twos = 0, fives = 0;
  for (; denominator % 2 == 0; denominator /= 2) ++twos;
  for (; denominator % 5 == 0; denominator /= 5) ++fives;
  const int decimals = std::max(twos, fives);
  return denominator == 1 && decimals <= kMost ? decimals : kOfEndless;
}

CoordinateText::CoordinateText(const Axis& axis)
    : axis_(axis), decimals_(decimals_of(axis)), scale_(power_of_ten(decimals_)) {}

std::string CoordinateText::operator()(int64_t number) const {
  const Wide numerator = axis_.offset + static_cast<Wide>(axis_.numerator) * number;
  const Wide denominator = static_cast<Wide>(axis_.denominator);
  const Wide size = magnitude(numerator);
  const Wide whole = size / denominator;
  // The remainder is below 2^40, the scale below 2^60. Rounding never carries: a denominator below
  // 2^40 leaves 1 - 1 / denominator at or below 0.9999999999991.
  const Wide fraction = round_divide(size % denominator * scale_, denominator);
  const bool negative = numerator < 0 && (whole != 0 || fraction != 0);
  const std::string behind_zero = to_string(make_decimal(fraction, decimals_)).substr(1);
  return (negative ? "-" : "") + std::to_string(static_cast<uint64_t>(whole)) + behind_zero;
}

size_t CoordinateText::longest(int64_t low, int64_t high) const {
  const auto whole = [this](int64_t number) {
    const std::string text = (*this)(number);
    return std::min(text.find('.'), text.size());
  };
  const size_t behind_point = decimals_ == 0 ? 0 : 1 + static_cast<size_t>(decimals_);
  return std::max(whole(low), whole(high)) + behind_point;
}

}  // namespace microtin::exact
