// SPDX-License-Identifier: MIT
#include "encoder/import/transform.hpp"

#include <cmath>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"

namespace microtin::importing {
namespace {

Decimal place_of(double value) {
  const std::optional<Decimal> place = shortest_decimal(value, kPlaceDecimals);
  if (!place) throw Error("a number is out of range");
  return *place;
}

}  // namespace

bool runs_east(const std::array<double, 6>& transform) {
  constexpr double kNoSkew = 1e-9;
  const auto& [west, width, skew_by_row, north, skew_by_column, height] = transform;
  return width > 0 && std::abs(skew_by_row) <= kNoSkew * width &&
         std::abs(skew_by_column) <= kNoSkew * std::abs(height);
}

Axis axis_of_cells_from(double corner, double size, uint32_t cells) {
  const Decimal length = place_of(std::abs(size));
  if (length.mantissa == 0) throw Error("cells have no extent");
  return axis_of_cells(place_of(corner), length, size > 0 ? 1 : 1 - 2 * int64_t{cells});
}

}  // namespace microtin::importing
