// SPDX-License-Identifier: MIT
// Makes corridors within corridors.
#include "encoder/import/route_bounds.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/wide.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/corridor.hpp"

namespace microtin::importing {
namespace {

constexpr int kSteps = 8;

// Rounded down, with two decimals more than both have.
Decimal bound_at(Decimal least, Decimal edge, int step) {
  const int decimals = std::min(std::max(least.decimals, edge.decimals) + 2, exact::kMaxDecimals);
  const auto number = [&](Decimal value) {
    return Wide{value.mantissa} * exact::power_of_ten(decimals - value.decimals);
  };
  const Wide more = (number(edge) - number(least)) * step / (kSteps - 1);
  return exact::make_decimal(number(least) + more, decimals);
}

}  // namespace

std::vector<Feature> route_bounds(const std::string& path, Decimal width, Decimal least,
                                  Decimal edge, Unit unit) {
  if (!(least <= edge)) {
    throw Error(parameter("route_edge_error") + ' ' + to_string(edge) + " is less than " +
                parameter("max_error") + ' ' + to_string(least) + "; use a larger one");
  }
  const std::vector<Feature> lines = import_geojson(path, read_file(path));
  std::vector<Feature> bounds(kSteps);
  for (int step = 0; step < kSteps; ++step) {
    Feature& feature = bounds[static_cast<std::size_t>(step)];
    feature.has_max_error = true;
    feature.max_error = bound_at(least, edge, step);
    const double metres = exact::real(width) / 2 * (step + 1) / kSteps;
    for (const Feature& one : lines) {
      for (const RealLine& line : one.lines) {
        std::vector<RealRings> corridor =
            with_file_context(path, [&] { return corridor_of(line, metres, unit); });
        std::move(corridor.begin(), corridor.end(), std::back_inserter(feature.polygons));
      }
    }
  }
  if (bounds[0].polygons.empty()) throw Error(path + ": has no line");
  return bounds;
}

}  // namespace microtin::importing
