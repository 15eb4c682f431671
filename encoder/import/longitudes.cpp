// SPDX-License-Identifier: MIT
#include "encoder/import/longitudes.hpp"

#include <algorithm>
#include <limits>

#include "encoder/exact/decimal.hpp"

namespace microtin::importing {

std::vector<bool> turned_east(const std::vector<LongitudeSpan>& spans) {
  constexpr double kHalfTurn = 180;
  std::vector<LongitudeSpan> sorted = spans;
  std::sort(sorted.begin(), sorted.end(),
            [](const LongitudeSpan& a, const LongitudeSpan& b) { return a.west < b.west; });
  double east = sorted[0].east, last_west = -std::numeric_limits<double>::infinity();
  for (const LongitudeSpan& span : sorted) {
    if (span.west - east > kHalfTurn) last_west = east;
    east = std::max(east, span.east);
  }
  std::vector<bool> turned;
  turned.reserve(spans.size());
  for (const LongitudeSpan& span : spans) turned.push_back(span.east <= last_west);
  return turned;
}

std::string turned_text(const std::vector<bool>& turned, double east) {
  const auto count = std::count(turned.begin(), turned.end(), true);
  if (count == 0) return "";
  return "; " + std::to_string(count) +
         (count == 1
              ? " lies beyond 180 degrees east and continues its neighbours' longitudes, to "
              : " lie beyond 180 degrees east and continue their neighbours' longitudes, to ") +
         to_string(*shortest_decimal(east));
}

}  // namespace microtin::importing
