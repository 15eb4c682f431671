// SPDX-License-Identifier: MIT
// Takes lines to the lattice, and leaves out what does not lie over the terrain.
#include "encoder/terrain/breaklines.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/terrain/polygons.hpp"
#include "shared/lattice.hpp"
#include "shared/predicates.hpp"

namespace microtin::terrain {
namespace {

constexpr double kSampling = 0.25;  // steps between the places of a line that are looked at

double coordinate_on(Decimal value, const Axis& axis) {
  const std::optional<RealCoordinate> at = exact::coordinate_of(value, axis);
  if (!at) throw Error("the coordinate " + to_string(value) + " is too far from the terrain");
  return static_cast<double>(at->whole) +
         static_cast<double>(at->part) / static_cast<double>(at->parts);
}

std::vector<Point> hull_of(const std::vector<Point>& places) {
  std::vector<Point> hull;
  for (const uint32_t corner : hull_corners(places)) hull.push_back(places[corner]);
  return hull;
}

void make_distinct(std::vector<Point>& places) {
  std::sort(places.begin(), places.end());
  places.erase(std::unique(places.begin(), places.end()), places.end());
}

class LineGroundTest {
 public:
  explicit LineGroundTest(const LineGround& ground) : ground_(ground) {}

  bool holds(LinePlace place) const {
    constexpr double kMost = kLatticeMax;
    const double x = nearest_step(place.x), y = nearest_step(place.y);
    if (x < 0 || y < 0 || x > kMost || y > kMost) return false;
    return is_in_hull(nearest_position(place)) && !is_near_void(place);
  }

 private:
  bool is_in_hull(Point p) const {
    const std::vector<Point>& hull = ground_.hull;
    for (std::size_t i = 0; i < hull.size(); ++i) {
      if (orient2d(hull[i], hull[(i + 1) % hull.size()], p) < 0) return false;
    }
    return hull.size() > 2;
  }

  bool is_near_void(LinePlace place) const {
    const std::vector<Point>& voids = ground_.voids;
    if (voids.empty()) return false;
    const double left = std::max(place.x - ground_.x_spacing, -1.0),
                 right = std::min(place.x + ground_.x_spacing, double{kLatticeMax} + 1);
    for (int x = static_cast<int>(std::floor(left)) + 1; x < right; ++x) {
      const double low = std::max(std::floor(place.y - ground_.y_spacing) + 1, 0.0);
      const Point from{static_cast<uint16_t>(x), static_cast<uint16_t>(low)};
      const auto at = std::lower_bound(voids.begin(), voids.end(), from);
      if (at != voids.end() && at->x == from.x && at->y < place.y + ground_.y_spacing) return true;
    }
    return false;
  }

  const LineGround& ground_;
};

LinePlace place_between(LinePlace a, LinePlace b, double share) {
  return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share, a.z + (b.z - a.z) * share};
}

// Collects the places of a line that the ground holds as lines of their own.
class LineCutter {
 public:
  LineCutter(const LineGround& ground, bool has_heights, uint32_t number,
             std::vector<LatticeLine>& lines)
      : test_(ground), has_heights_(has_heights), number_(number), lines_(lines) {}

  void cut(const std::vector<LinePlace>& places) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (i != 0) look_between(places[i - 1], places[i]);
      look_at(places[i], true);
    }
    end();
  }

 private:
  // Looks at the part of a segment that lies over the lattice, however long the segment is.
  void look_between(LinePlace a, LinePlace b) {
    double from = 0, to = 1;
    narrow(a.x, b.x, from, to);
    narrow(a.y, b.y, from, to);
    if (from >= to) return;
    const auto samples = static_cast<int64_t>(distance(a, b) * (to - from) / kSampling);
    for (int64_t i = 1; i <= samples; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(samples + 1);
      look_at(place_between(a, b, from + (to - from) * share), false);
    }
  }

  // Narrows shares of the way from a to b to those within a step of the lattice's coordinates.
  static void narrow(double a, double b, double& from, double& to) {
    constexpr double kLeast = -1, kMost = double{kLatticeMax} + 1;
    if (a == b) {
      if (a < kLeast || a > kMost) to = from;
      return;
    }
    const double low = (kLeast - a) / (b - a), high = (kMost - a) / (b - a);
    from = std::max(from, std::min(low, high));
    to = std::min(to, std::max(low, high));
  }

  // The last place that is held ends a line, vertex or not.
  void look_at(LinePlace place, bool is_vertex) {
    if (!test_.holds(place)) {
      end();
      return;
    }
    if (is_vertex || part_.empty()) {
      add(place);
      last_.reset();
    } else {
      last_ = place;
    }
  }

  void end() {
    if (last_) add(*last_);
    if (part_.size() > 1) lines_.emplace_back(std::move(part_), has_heights_, number_);
    part_.clear();
    last_.reset();
  }

  void add(LinePlace place) {
    const bool is_new = part_.empty() || part_.back().x != place.x || part_.back().y != place.y;
    if (is_new) part_.push_back(place);
  }

  LineGroundTest test_;
  bool has_heights_;
  uint32_t number_;
  std::vector<LatticeLine>& lines_;
  std::vector<LinePlace> part_;
  std::optional<LinePlace> last_;  // held, and no vertex
};

void expect_one_height(LinePlace a, LinePlace b, const Placement& lattice) {
  if (a.z == b.z) return;
  throw Error("a line of the " + parameter("breaklines") + " has two heights at " +
              place_text(a, lattice) + "; give it one");
}

}  // namespace

LatticeLine::LatticeLine(std::vector<LinePlace> places, bool has_heights, uint32_t number)
    : places_(std::move(places)), has_heights_(has_heights), number_(number) {
  double along = 0;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (i != 0) along += distance(places_[i - 1], places_[i]);
    along_.push_back(along);
  }
}

// The last segment that begins before, or the first.
std::size_t LatticeLine::segment_at(double along) const {
  const auto after = std::lower_bound(along_.begin(), along_.end(), along);
  const auto place = static_cast<std::size_t>(after - along_.begin());
  return std::min(place == 0 ? 0 : place - 1, places_.size() - 2);
}

LinePlace LatticeLine::at(double along) const {
  const std::size_t i = segment_at(along);
  const double share = (along - along_[i]) / (along_[i + 1] - along_[i]);
  return place_between(places_[i], places_[i + 1], std::clamp(share, 0.0, 1.0));
}

double LatticeLine::foot(LinePlace wanted, double from, double to) const {
  double best = from, nearest = distance(at(from), wanted);
  for (std::size_t i = segment_at(from); i + 1 < places_.size() && along_[i] <= to; ++i) {
    const double share = share_of(wanted, places_[i], places_[i + 1]);
    const double along =
        std::clamp(along_[i] + (along_[i + 1] - along_[i]) * share, from, std::max(from, to));
    const double away = distance(at(along), wanted);
    if (away < nearest) {
      nearest = away;
      best = along;
    }
  }
  return best;
}

LatticeLine::Range LatticeLine::between(double from, double to) const {
  const auto first = std::upper_bound(along_.begin(), along_.end(), from);
  const auto last = std::lower_bound(first, along_.end(), to);
  return {static_cast<std::size_t>(first - along_.begin()),
          static_cast<std::size_t>(last - along_.begin())};
}

double distance(LinePlace a, LinePlace b) {
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
}

double share_of(LinePlace p, LinePlace a, LinePlace b) {
  const double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
  if (square == 0) return 0;
  return std::clamp(((p.x - a.x) * x + (p.y - a.y) * y) / square, 0.0, 1.0);
}

Point nearest_position(LinePlace place) {
  const auto on_lattice = [](double at) {
    return static_cast<uint16_t>(std::clamp(nearest_step(at), 0.0, double{kLatticeMax}));
  };
  return {on_lattice(place.x), on_lattice(place.y)};
}

LineGround line_ground_of(const Survey& survey, double x_spacing, double y_spacing) {
  return {hull_of(places_of(survey.samples)), survey.voids, x_spacing, y_spacing};
}

LineGround line_ground_of(const Source& source, const Placement& lattice) {
  const Placement own = placement_of(source);
  const LatticeMap x_map = exact::map_between(own.x, lattice.x),
                   y_map = exact::map_between(own.y, lattice.y);
  std::vector<Point> places, voids;
  for_each_post(source, [&](int64_t x, int64_t y, int64_t z) {
    const Wide column = x_map.nearest(x), row = y_map.nearest(y);
    if (column < 0 || row < 0 || column > kLatticeMax || row > kLatticeMax) return;
    const Point place{static_cast<uint16_t>(column), static_cast<uint16_t>(row)};
    (is_height(z) ? places : voids).push_back(place);
  });
  make_distinct(places);
  make_distinct(voids);
  const auto spacing = [](const LatticeMap& map) {
    return static_cast<double>(map.scale) / static_cast<double>(map.step);
  };
  return {hull_of(places), std::move(voids), spacing(x_map), spacing(y_map)};
}

LinePath path_of(const RealLine& line, uint32_t number, const Placement& lattice) {
  LinePath path{{}, !line.empty() && line.front().z.has_value(), number};
  for (const RealPoint& p : line) {
    const LinePlace place{coordinate_on(p.x, lattice.x), coordinate_on(p.y, lattice.y),
                          path.has_heights && p.z ? coordinate_on(*p.z, lattice.z) : 0};
    const bool is_same =
        !path.places.empty() && path.places.back().x == place.x && path.places.back().y == place.y;
    if (is_same) {
      expect_one_height(path.places.back(), place, lattice);
    } else {
      path.places.push_back(place);
    }
  }
  return path;
}

void add_parts(const LineGround& ground, const LinePath& path, std::vector<LatticeLine>& lines) {
  LineCutter(ground, path.has_heights, path.number, lines).cut(path.places);
}

void refuse_lines_elsewhere() {
  throw Error(parameter("breaklines") +
              ": no line lies on the terrain; compare the order and the system of their " +
              "coordinates with the terrain's, or leave the option out");
}

std::vector<LatticeLine> lines_over(const LineGround& ground, const std::vector<RealLine>& lines,
                                    const Placement& lattice) {
  std::vector<LatticeLine> all;
  for (std::size_t number = 0; number < lines.size(); ++number) {
    add_parts(ground, path_of(lines[number], static_cast<uint32_t>(number), lattice), all);
  }
  if (all.empty() && !lines.empty()) refuse_lines_elsewhere();
  return all;
}

std::string place_text(LinePlace place, const Placement& lattice) {
  const auto text = [](double at, const Axis& axis) {
    const double value = exact::offset_of(axis) + exact::step_of(axis) * at;
    const std::optional<Decimal> decimal = exact::shortest_decimal(value, 6);
    return decimal ? to_string(*decimal) : std::string("far away");
  };
  return "x " + text(place.x, lattice.x) + ", y " + text(place.y, lattice.y);
}

}  // namespace microtin::terrain
