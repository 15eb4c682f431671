// SPDX-License-Identifier: MIT
// Finds values that fill voids by their distance from all other heights.
#include "encoder/terrain/fill_value.hpp"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

namespace microtin::terrain {
namespace {

// Rows of nines, and where the ranges of 16 and 32 bits end; those of floating point are no heights
// at all. 999 may be a height, -999 is far below any land.
bool is_usual(Decimal value) {
  constexpr int64_t kUsual[] = {-999,    -9999,       9999,        -99999,    99999,
                                -999999, 999999,      -32768,      -32767,    32767,
                                65535,   -2147483648, -2147483647, 2147483647};
  return value.decimals == 0 &&
         std::find(std::begin(kUsual), std::end(kUsual), value.mantissa) != std::end(kUsual);
}

std::string warning(const Extremes& heights, int decimals, const char* what,
                    const std::function<std::string(const std::string&)>& remedy) {
  const Extremes::Fill fill = heights.fill(decimals);
  if (fill.count == 0) return "";
  const std::string value = to_string(make_decimal(fill.value, decimals));
  return "taken as they are: " + std::to_string(fill.count) + ' ' + what +
         (fill.count == 1 ? "" : "s") + " of height " + value +
         ", far from all others; if they mark voids, " + remedy(value);
}

}  // namespace

void Extremes::End::add(int64_t number, uint64_t times) {
  if (count != 0 && number == first) {
    count += times;
    return;
  }
  if (count == 0 || number < first) {
    has_next = count != 0;
    next = first;
    first = number;
    count = times;
  } else if (!has_next || number < next) {
    has_next = true;
    next = number;
  }
}

void Extremes::add(int64_t number) {
  low_.add(number, 1);
  high_.add(-number, 1);
}

void Extremes::add(const Extremes& others) {
  for (const auto& [mine, theirs] : {std::pair(&low_, &others.low_), {&high_, &others.high_}}) {
    if (theirs->count != 0) mine->add(theirs->first, theirs->count);
    if (theirs->has_next) mine->add(theirs->next, 1);
  }
}

Extremes::Fill Extremes::fill(int decimals) const {
  // Whether an end is far off, seen as the low one: whether the next is farther from it than from
  // the other end.
  const auto is_far = [](const End& end, const End& other) {
    const Wide next = end.next;
    return end.has_next && next - end.first > -Wide{other.first} - next;
  };
  const Fill low{low_.first, low_.count}, high{-high_.first, high_.count};
  if (is_far(low_, high_) && is_usual(make_decimal(low.value, decimals))) return low;
  if (is_far(high_, low_) && is_usual(make_decimal(high.value, decimals))) return high;
  return {};
}

std::string warning_on_fill(const Extremes& posts, int decimals) {
  return warning(posts, decimals, "post", [](const std::string& value) {
    return "the source must say so: NODATA_value " + value +
           " in an .asc, NaN in an array, else \"gdal_translate -a_nodata " + value + "\"";
  });
}

std::string warning_on_fill(const Raster& raster) {
  Extremes heights;
  for (const int64_t height : raster.heights) {
    if (height != kVoidHeight) heights.add(height);
  }
  return warning_on_fill(heights, raster.decimals);
}

std::string warning_on_fill(const PointCloud& cloud) {
  Extremes heights;
  for (const SourcePoint& point : cloud.points) heights.add(point.z);
  return warning(heights, cloud.z_decimals, "point",
                 [](const std::string&) { return "leave them out"; });
}

}  // namespace microtin::terrain
