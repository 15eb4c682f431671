// SPDX-License-Identifier: MIT
// A corridor holds every place near its line, and few others.
#include "encoder/import/corridor.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "encoder/base/error.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {
namespace {

// Thousandths of a metre, or millionths of a degree, are the numbers of the axes below.
struct Line {
  std::vector<int64_t> x, y;

  RealLine real(int decimals) const {
    RealLine line;
    for (size_t i = 0; i < x.size(); ++i) {
      line.push_back({make_decimal(x[i], decimals), make_decimal(y[i], decimals)});
    }
    return line;
  }
};

Line random_line(Random& random, int64_t x, int64_t y, uint32_t extent) {
  Line line;
  const uint32_t vertices = 1 + random.below(4);
  for (uint32_t i = 0; i < vertices; ++i) {
    line.x.push_back(x + random.below(extent));
    line.y.push_back(y + random.below(extent));
  }
  return line;
}

// Places that a corridor must hold, and that it must not.
struct Counts {
  int near = 0, far = 0;

  template <class IsHeld>
  void check(double away, double held, double left_out, const IsHeld& is_held) {
    if (away <= held) CHECK(is_held());
    if (away > left_out) CHECK(!is_held());
    near += away <= held ? 1 : 0;
    far += away > left_out ? 1 : 0;
  }
};

bool holds(const std::vector<RealRings>& polygons, const Axis& axis, int64_t x, int64_t y) {
  return std::any_of(polygons.begin(), polygons.end(), [&](const RealRings& polygon) {
    return Rings(polygon, axis, axis).contains(x, y);
  });
}

// The distance of a place from the segment between two others.
double distance(double ax, double ay, double bx, double by, double x, double y) {
  const double dx = bx - ax, dy = by - ay, square = dx * dx + dy * dy;
  const double along =
      square == 0 ? 0 : std::clamp(((x - ax) * dx + (y - ay) * dy) / square, 0.0, 1.0);
  return std::hypot(x - ax - along * dx, y - ay - along * dy);
}

// The least distance, where x and y are multiplied by these.
double distance(const Line& line, double x, double y, double x_scale, double y_scale) {
  double least = 1e300;
  for (size_t i = 0; i < line.x.size(); ++i) {
    const size_t from = i == 0 ? 0 : i - 1;
    const auto a = [&](const std::vector<int64_t>& axis, double at, double scale, size_t k) {
      return (static_cast<double>(axis[k]) - at) * scale;
    };
    least = std::min(least, distance(a(line.x, x, x_scale, from), a(line.y, y, y_scale, from),
                                     a(line.x, x, x_scale, i), a(line.y, y, y_scale, i), 0, 0));
  }
  return least;
}

// On the ellipsoid of WGS 84, near a latitude in degrees: metres of a millionth of a degree.
double metres_of_longitude(double latitude) {
  const double s = std::sin(latitude * 3.14159265358979 / 180);
  return 6378137 / std::sqrt(1 - 0.00669438 * s * s) * std::cos(latitude * 3.14159265358979 / 180) *
         3.14159265358979 / 180e6;
}

double metres_of_latitude(double latitude) {
  const double s = std::sin(latitude * 3.14159265358979 / 180);
  return 6378137 * (1 - 0.00669438) / std::pow(1 - 0.00669438 * s * s, 1.5) * 3.14159265358979 /
         180e6;
}

}  // namespace

TEST_CASE("corridor: in a plane it holds what is near, and nothing half a percent farther") {
  Random random(3);
  const Axis axis = decimal_axis(3);
  Counts counts;
  for (int round = 0; round < 60; ++round) {
    const Line line = random_line(random, -500000, 4000000, 1000000);
    const auto polygons = corridor_of(line.real(3), 80, Unit::kMetre);
    for (int i = 0; i < 60; ++i) {
      const int64_t x = int64_t{random.below(1200000)} - 600000,
                    y = int64_t{random.below(1200000)} + 3900000;
      const double away =
          distance(line, static_cast<double>(x), static_cast<double>(y), 0.001, 0.001);
      counts.check(away, 80, 80.45, [&] { return holds(polygons, axis, x, y); });
    }
  }
  CHECK(counts.near > 300);
  CHECK(counts.far > 300);
}

TEST_CASE("corridor: in degrees no near place is missing, and none is 3 percent farther") {
  Random random(4);
  const Axis axis = decimal_axis(6);
  Counts counts;
  for (int round = 0; round < 60; ++round) {
    const int64_t south = int64_t{random.below(118)} * 1000000 - 59000000;
    const Line line = random_line(random, 7000000, south, 900000);
    const auto polygons = corridor_of(line.real(6), 9000, Unit::kDegree);
    for (int i = 0; i < 60; ++i) {
      const int64_t x = 6900000 + int64_t{random.below(1100000)},
                    y = south - 100000 + int64_t{random.below(1100000)};
      // A straight line of degrees is bent on the ground: the scale at the place decides nearby.
      const double latitude = static_cast<double>(y) / 1e6;
      const double away = distance(line, static_cast<double>(x), static_cast<double>(y),
                                   metres_of_longitude(latitude), metres_of_latitude(latitude));
      counts.check(away, 9000, 9270, [&] { return holds(polygons, axis, x, y); });
    }
  }
  CHECK(counts.near > 300);
  CHECK(counts.far > 300);
}

TEST_CASE("corridor: feet are not metres, and poles are refused") {
  const RealLine line = {{Decimal{0, 0}, Decimal{0, 0}}, {Decimal{100, 0}, Decimal{0, 0}}};
  const Axis axis = decimal_axis(0);
  CHECK(holds(corridor_of(line, 10, Unit::kFoot), axis, 50, 32));
  CHECK(!holds(corridor_of(line, 10, Unit::kFoot), axis, 50, 34));
  CHECK(holds(corridor_of(line, 10, Unit::kUnknown), axis, 50, 10));
  CHECK(!holds(corridor_of(line, 10, Unit::kUnknown), axis, 50, 11));
  const RealLine north = {{Decimal{0, 0}, Decimal{895, 1}}};
  CHECK_THROWS_WITH_AS(corridor_of(north, 10, Unit::kDegree),
                       "the corridor comes within a degree of a pole; end the route farther away",
                       Error);
}

}  // namespace microtin::tests
