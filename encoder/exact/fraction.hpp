// SPDX-License-Identifier: MIT
// Fractions behind rounded decimals, and axes made of them.
#ifndef MICROTIN_ENCODER_EXACT_FRACTION_HPP
#define MICROTIN_ENCODER_EXACT_FRACTION_HPP

#include <cstdint>
#include <optional>

#include "encoder/exact/decimal.hpp"
#include "encoder/layers.hpp"
#include "microtin/microtin.h"

namespace microtin::exact {

using Axis = microtin_axis;  // real = (offset + numerator * lattice) / denominator

// From numbers times 10^-decimals, 0 .. 18, to real ones.
inline Axis decimal_axis(int decimals) {
  return {0, 1, static_cast<uint64_t>(power_of_ten(decimals))};
}

inline double step_of(const Axis& axis) {
  return static_cast<double>(axis.numerator) / static_cast<double>(axis.denominator);
}

inline double offset_of(const Axis& axis) {
  return static_cast<double>(axis.offset) / static_cast<double>(axis.denominator);
}

constexpr int64_t kAxisLimit = int64_t{1} << 40;  // numerators and denominators of axes lie below

// Numerator and denominator without a common divisor, denominator > 0.
struct Fraction {
  Wide numerator;
  Wide denominator;
};

Fraction reduced(Wide numerator, Wide denominator);

// The fraction with the smallest denominator that rounds to the decimals written, at most 12.
Fraction simplest_fraction(Decimal written);

// What a number stands for: 0.000833333333 means 1/1200. That is the simplest fraction if it is so
// simple that this is no accident; else the decimal itself.
Fraction meaning_of(Decimal written);

// The fraction that a decimal stands for, if that changes the number by no more than a tolerance.
Fraction meaning_within(Decimal written, Fraction tolerance);

// The reciprocal of a whole number, if a cell size stands for one: as many digits are written that
// even 2^16 cells lie within a hundredth of a cell of where the decimal puts them.
std::optional<Fraction> reciprocal_meant(Decimal written);

// The axis first + step * k. The step is exact; where the denominators of both do not go together
// in 40 bits, the first is rounded to the finest that does. Throws Error if the step does not fit.
Axis make_axis(Fraction first, Fraction step);

constexpr int kPlaceDecimals = 12;  // of corners and cell sizes: as many as an axis can hold

// From a raster's columns or rows to where they lie: the first is half_cells halves of `size` > 0
// from `place`, both with at most kPlaceDecimals. 0.000833333333 means 1/1200; then the place's
// decimals are rounded, too, within 1/100 cell. |half_cells| < 2^33. Throws Error as make_axis.
Axis axis_of_cells(Decimal place, Decimal size, int64_t half_cells);

// (offset + numerator * k) / denominator in lowest terms. Throws Error if it does not fit an axis.
Axis reduced_axis(Wide offset, Wide numerator, Wide denominator);

// An axis of the same places, counted from number `first` on; its coordinate lies below 2^62.
// Throws Error as reduced_axis.
Axis moved_axis(const Axis& axis, Wide first);

}  // namespace microtin::exact

#endif
