// SPDX-License-Identifier: MIT
// Sums errors of heights up exactly.
#ifndef MICROTIN_ENCODER_TERRAIN_ERROR_METER_HPP
#define MICROTIN_ENCODER_TERRAIN_ERROR_METER_HPP

#include <optional>

#include "encoder/exact/exact_height.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/verify.hpp"

namespace microtin::terrain {

// Squares of up to 2^33 numbers from 0 to 2^92, or of up to 2^52 from 0 to 2^36, added up exactly
// in parts of 46 bits: each part stays below 2^125.
class SquareSum {
 public:
  void add(Wide number, Wide times);
  bool operator<=(const SquareSum& other) const;

  // The root of the mean of the `count` squares, of numbers up to `largest`, rounded up.
  Wide root_of_mean(Wide count, Wide largest) const;

 private:
  Wide high_ = 0, middle_ = 0, low_ = 0;  // high * 2^92 + middle * 2^47 + low
};

// Differences between heights of the source and answers of the terrain, in billionths of a unit.
class ErrorMeter {
 public:
  ErrorMeter(const Axis& source, const Axis& lattice);

  // `number` is the source's; `answer` is a lattice height with 16 fractional bits. With 60 and 31
  // bits in these, 40 in the axes and 30 in the source's denominator, sums stay below 2^117, and an
  // error below 2^62 units, which are 2^92 billionths.
  // Returns how far the answer is above, in units.
  double add(int64_t number, int32_t answer);

  // Adds the error of an exact height.
  double add(int64_t number, const ExactHeight& height);

  // Writes the errors, and whether they keep the bound.
  void tell(const std::optional<Decimal>& bound, Verification& found) const;

 private:
  void count(Wide billionths, bool is_below);
  Decimal mean() const;
  Decimal root_mean_square() const;  // rounded up

  Wide to_common_, offset_, step_, from_common_, common_;
  Wide largest_ = 0, deepest_ = 0;
  SquareSum squares_;
  Wide sum_ = 0;
  int64_t count_ = 0;
};

}  // namespace microtin::terrain

#endif
