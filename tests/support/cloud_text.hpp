// SPDX-License-Identifier: MIT
// Points as text, for tests of what needs no importer.
#ifndef MICROTIN_TESTS_SUPPORT_CLOUD_TEXT_HPP
#define MICROTIN_TESTS_SUPPORT_CLOUD_TEXT_HPP

#include <algorithm>
#include <array>
#include <sstream>
#include <string>
#include <vector>

#include "encoder/terrain/source.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {

// Points, one a line: x, y and, if there is a third word, z.
inline PointCloud cloud_of(const std::string& text) {
  std::istringstream lines(text);
  std::vector<std::array<Decimal, 3>> points;
  PointCloud cloud;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::array<Decimal, 3> point{};
    std::string word;
    for (Decimal& coordinate : point) {
      if (words >> word) coordinate = parse_decimal(word).value();
    }
    cloud.xy_decimals = std::max({cloud.xy_decimals, point[0].decimals, point[1].decimals});
    cloud.z_decimals = std::max(cloud.z_decimals, point[2].decimals);
    points.push_back(point);
  }
  const auto number = [](Decimal value, int decimals) {
    return static_cast<int64_t>(mantissa_at(value, decimals));
  };
  for (const auto& [x, y, z] : points) {
    cloud.points.push_back(
        {number(x, cloud.xy_decimals), number(y, cloud.xy_decimals), number(z, cloud.z_decimals)});
  }
  return cloud;
}

}  // namespace microtin::tests

#endif
