// SPDX-License-Identifier: MIT
// Surrounds each piece of a line by a rectangle, and each of its ends by a polygon.
#include "encoder/import/corridor.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/decimal.hpp"
#include "encoder/exact/wide.hpp"
#include "encoder/terrain/degrees.hpp"

namespace microtin::importing {
namespace {

constexpr double kMetresOfDegree = 110574;
constexpr double kPieceDegrees = 0.25;  // of latitude: a metre has the same longitude in a piece
constexpr int kCorners = 32;            // around an end; they are 0.5 % farther away than sides

struct Place {
  double x, y;
};

RealPoint point_at(double x, double y) {
  const std::optional<Decimal> decimal_x = exact::shortest_decimal(x),
                               decimal_y = exact::shortest_decimal(y);
  if (!decimal_x || !decimal_y)
    throw Error("a place of the route is out of range; check its coordinates");
  return {*decimal_x, *decimal_y};
}

// How many numbers of x and of y a metre has near a piece.
Place per_metre(Place from, Place to, double metres, Unit unit) {
  if (unit != Unit::kDegree) {
    const double length = exact::metres_per(unit).value_or(1);
    return {1 / length, 1 / length};
  }
  constexpr double kMostLatitude = 89;
  const double degree = 1 / kMetresOfDegree;
  const double latitude = std::max(std::abs(from.y), std::abs(to.y)) + metres * degree;
  if (latitude > kMostLatitude)
    throw Error("the corridor comes within a degree of a pole; end the route farther away");
  return {degree / std::cos(latitude * kPi / 180), degree};
}

// A regular polygon around the circle.
RealRings around(Place at, double metres, Place per) {
  RealLine ring;
  const double radius = metres / std::cos(kPi / kCorners);
  for (int corner = 0; corner <= kCorners; ++corner) {
    const double angle = 2 * kPi * (corner % kCorners) / kCorners;
    ring.push_back(
        point_at(at.x + radius * std::cos(angle) * per.x, at.y + radius * std::sin(angle) * per.y));
  }
  return {ring};
}

RealRings beside(Place from, Place to, double metres, Place per) {
  const double along_x = (to.x - from.x) / per.x, along_y = (to.y - from.y) / per.y;
  const double length = std::hypot(along_x, along_y);
  const double side_x = -along_y / length * metres * per.x,
               side_y = along_x / length * metres * per.y;
  const RealPoint first = point_at(from.x + side_x, from.y + side_y);
  return {{first, point_at(to.x + side_x, to.y + side_y), point_at(to.x - side_x, to.y - side_y),
           point_at(from.x - side_x, from.y - side_y), first}};
}

void add_piece(Place from, Place to, double metres, Unit unit, std::vector<RealRings>& polygons) {
  const Place per = per_metre(from, to, metres, unit);
  polygons.push_back(around(to, metres, per));
  if (from.x != to.x || from.y != to.y) polygons.push_back(beside(from, to, metres, per));
}

}  // namespace

std::vector<RealRings> corridor_of(const RealLine& line, double metres, Unit unit) {
  std::vector<RealRings> polygons;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Place to = {exact::real(line[i].x), exact::real(line[i].y)};
    const Place from = i == 0 ? to : Place{exact::real(line[i - 1].x), exact::real(line[i - 1].y)};
    const double rise = unit == Unit::kDegree ? std::abs(to.y - from.y) : 0;
    if (rise > 180) throw Error("the route leaves the Earth; check its coordinates");
    const int pieces = 1 + static_cast<int>(rise / kPieceDegrees);
    for (int piece = 0; piece < pieces; ++piece) {
      const auto at = [&](int end) {
        const double share = static_cast<double>(end) / pieces;
        return Place{from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share};
      };
      add_piece(at(piece), at(piece + 1), metres, unit, polygons);
    }
  }
  return polygons;
}

std::vector<RealRings> corridors_of(const std::string& path, const std::vector<Feature>& features,
                                    double metres, Unit unit) {
  std::vector<RealRings> polygons;
  for (const Feature& feature : features) {
    for (const RealLine& line : feature.lines) {
      std::vector<RealRings> corridor =
          with_file_context(path, [&] { return corridor_of(line, metres, unit); });
      std::move(corridor.begin(), corridor.end(), std::back_inserter(polygons));
    }
  }
  return polygons;
}

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

std::vector<Feature> route_bounds(const std::string& path, const FeatureFiles& files, Decimal width,
                                  Decimal least, Decimal edge, Unit unit) {
  if (!(least <= edge)) {
    throw Error(parameter("route_edge_error") + ' ' + to_string(edge) + " is less than " +
                parameter("max_error") + ' ' + to_string(least) + "; use a larger one");
  }
  const std::vector<Feature> lines = files.read(path);
  std::vector<Feature> bounds(kSteps);
  for (int step = 0; step < kSteps; ++step) {
    Feature& feature = bounds[static_cast<std::size_t>(step)];
    feature.has_max_error = true;
    feature.max_error = bound_at(least, edge, step);
    const double metres = exact::real(width) / 2 * (step + 1) / kSteps;
    feature.polygons = corridors_of(path, lines, metres, unit);
  }
  if (bounds[0].polygons.empty()) throw Error(path + ": has no line; draw the route as one");
  return bounds;
}

}  // namespace microtin::importing
