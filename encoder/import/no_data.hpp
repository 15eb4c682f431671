// SPDX-License-Identifier: MIT
// By what a raster marks its voids: every reader and every door asks here.
#ifndef MICROTIN_ENCODER_IMPORT_NO_DATA_HPP
#define MICROTIN_ENCODER_IMPORT_NO_DATA_HPP

#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::importing {

// A number in a text, of any size: infinite if it is beyond 64-bit floating point.
std::optional<double> number_of_any_size(std::string_view word);

// Cells that are not a number are void, and those that have the no-data value in the cells' own
// type: -9999.99 is -9999.990234375 as a float. Values that no height can have have many spellings,
// -3.4e38 and -3.40282e+38; they need to agree to a thousandth.
class NoData {
 public:
  NoData() = default;  // there is no such value, as for NaN
  explicit NoData(double value) : value_(value) {}
  explicit NoData(std::string_view word);  // a number of any size, or NaN

  bool marks(float cell) const;
  bool marks(double cell) const;

  // A text does not tell its type: cells may have been floats, each written to the digits at hand.
  bool marks(std::string_view word) const;

 private:
  double value_ = std::numeric_limits<double>::quiet_NaN();
  std::string text_;  // empty: the value was none
};

}  // namespace microtin::importing

#endif
