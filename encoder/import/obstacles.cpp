// SPDX-License-Identifier: MIT
// Finds the cells that an obstacle touches, and raises their posts. A cell whose posts are all at
// the obstacle's top or above is there in full, however the obstacle lies in it.
#include "encoder/import/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/wide.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/corridor.hpp"
#include "encoder/terrain/own_bounds.hpp"
#include "encoder/terrain/polygons.hpp"

namespace microtin::importing {
namespace {

// Cells of a raster, by the number of their south-western post.
class TouchedCells {
 public:
  explicit TouchedCells(const Raster& raster) : raster_(raster) {}

  void add(const RealRings& polygon) {
    const terrain::Rings rings(polygon, raster_.x, raster_.y);
    rings.visit_inside(raster_.width, raster_.height, [&](uint32_t column, uint32_t row) {
      add_cells(int64_t{column} - 1, int64_t{row} - 1, column, row);
    });
    for (const RealLine& ring : polygon) {
      for (std::size_t i = 0; i < ring.size(); ++i) {
        add_edge(ring[i], ring[(i + 1) % ring.size()]);
      }
    }
  }

  // In the order of cells, each once.
  std::vector<std::size_t> take() {
    std::sort(cells_.begin(), cells_.end());
    cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
    return std::move(cells_);
  }

 private:
  static constexpr double kSlack = 0.01;  // of a cell: more than doubles and polygons round by

  static double number_at(Decimal coordinate, const Axis& axis) {
    return (exact::real(coordinate) - exact::offset_of(axis)) / exact::step_of(axis);
  }

  void add_cells(int64_t west, int64_t south, int64_t east, int64_t north) {
    const int64_t last_column = int64_t{raster_.width} - 2, last_row = int64_t{raster_.height} - 2;
    for (int64_t row = std::max<int64_t>(south, 0); row <= std::min(north, last_row); ++row) {
      for (int64_t column = std::max<int64_t>(west, 0); column <= std::min(east, last_column);
           ++column) {
        cells_.push_back(static_cast<std::size_t>(row) * raster_.width +
                         static_cast<std::size_t>(column));
      }
    }
  }

  static int64_t cell_of(double number) {
    constexpr double kFar = 1e9;  // beyond all rasters
    return static_cast<int64_t>(std::floor(std::clamp(number, -kFar, kFar)));
  }

  // The cells of each column that the edge passes.
  void add_edge(const RealPoint& from, const RealPoint& to) {
    double x = number_at(from.x, raster_.x), y = number_at(from.y, raster_.y);
    double end_x = number_at(to.x, raster_.x), end_y = number_at(to.y, raster_.y);
    if (end_x < x) {
      std::swap(x, end_x);
      std::swap(y, end_y);
    }
    const int64_t first = std::max<int64_t>(cell_of(x - kSlack), 0),
                  last = std::min<int64_t>(cell_of(end_x + kSlack), int64_t{raster_.width} - 2);
    const double slope = end_x == x ? 0 : (end_y - y) / (end_x - x);
    for (int64_t column = first; column <= last; ++column) {
      const auto y_at = [&](double at) {
        return end_x == x ? y : y + (std::clamp(at, x, end_x) - x) * slope;
      };
      double low = y_at(static_cast<double>(column) - kSlack),
             high = y_at(static_cast<double>(column) + 1 + kSlack);
      if (end_x == x) high = end_y;
      if (low > high) std::swap(low, high);
      add_cells(column, cell_of(low - kSlack), column, cell_of(high + kSlack));
    }
  }

  const Raster& raster_;
  std::vector<std::size_t> cells_;
};

// Cells that an obstacle touches, and whether its top is the same above all of them.
struct Part {
  std::vector<std::size_t> cells;
  bool is_level;
};

// A point's parts are level; what is high above the ground along a line or in a polygon follows the
// ground.
std::vector<Part> parts_of(const Feature& obstacle, const Raster& raster) {
  const double radius = obstacle.radius ? exact::real(*obstacle.radius) : 0;
  const auto around = [&](const RealLine& line, TouchedCells& cells) {
    for (const RealRings& part : corridor_of(line, radius, raster.reference.horizontal_unit)) {
      cells.add(part);
    }
  };
  std::vector<Part> parts;
  for (const RealPoint& point : obstacle.points) {
    TouchedCells cells(raster);
    around({point}, cells);
    parts.push_back({cells.take(), true});
  }
  TouchedCells cells(raster);
  for (const RealRings& polygon : obstacle.polygons) {
    cells.add(polygon);
    for (const RealLine& ring : polygon) around(ring, cells);
  }
  for (const RealLine& line : obstacle.lines) around(line, cells);
  parts.push_back({cells.take(), obstacle.top.has_value()});
  return parts;
}

// In numbers of heights, rounded up.
int64_t number_of(Decimal height, int decimals) {
  const Wide number = ceil_divide(Wide{height.mantissa} * exact::power_of_ten(decimals),
                                  exact::power_of_ten(height.decimals));
  constexpr int64_t kMost = int64_t{1} << 59;
  if (magnitude(number) > kMost) throw Error("the top of an obstacle is out of range");
  return static_cast<int64_t>(number);
}

// Raises the posts of cells, and remembers which.
class Raising {
 public:
  explicit Raising(Raster& raster) : raster_(raster), ground_(raster.heights) {}

  // Whether a post of the obstacle's cells has a height.
  bool add(const Feature& obstacle) {
    bool is_there = false;
    for (const Part& part : parts_of(obstacle, raster_)) {
      if (part.is_level) {
        is_there = raise(obstacle, part.cells.data(), part.cells.size()) || is_there;
      } else {
        for (const std::size_t& cell : part.cells) {
          is_there = raise(obstacle, &cell, 1) || is_there;
        }
      }
    }
    return is_there;
  }

  const std::vector<std::size_t>& raised() const { return raised_; }

 private:
  template <class Visit>
  void visit_posts(const std::size_t* cells, std::size_t count, const Visit& visit) const {
    const std::size_t width = raster_.width;
    for (std::size_t i = 0; i < count; ++i) {
      for (const std::size_t post :
           {cells[i], cells[i] + 1, cells[i] + width, cells[i] + width + 1}) {
        if (terrain::is_height(ground_[post])) visit(post);
      }
    }
  }

  bool raise(const Feature& obstacle, const std::size_t* cells, std::size_t count) {
    std::optional<int64_t> highest;
    visit_posts(cells, count, [&](std::size_t post) {
      highest = std::max(highest.value_or(ground_[post]), ground_[post]);
    });
    if (!highest) return false;
    const int64_t top = obstacle.top ? number_of(*obstacle.top, raster_.decimals)
                                     : *highest + number_of(*obstacle.height, raster_.decimals);
    visit_posts(cells, count, [&](std::size_t post) {
      if (raster_.heights[post] >= top) return;
      raster_.heights[post] = top;
      raised_.push_back(post);
    });
    return true;
  }

  Raster& raster_;
  const std::vector<int64_t> ground_;
  std::vector<std::size_t> raised_;  // some more than once
};

// The surface may fall to the bound in this many posts around raised ones, so that few vertices
// make its slope.
constexpr int64_t kSlopePosts = 3;

// Wider bounds around raised posts: from their height to the bound along both axes.
class Slopes {
 public:
  Slopes(const Raster& raster, const std::optional<Decimal>& max_error)
      : raster_(raster), bounds_(raster.bounds) {
    if (bounds_.empty()) {
      bounds_ = {{}, max_error->decimals, *max_error};
      bounds_.numbers.assign(raster.heights.size(), max_error->mantissa);
    }
    const int decimals = std::max(bounds_.decimals, raster.decimals);
    own_ = exact::power_of_ten(decimals - bounds_.decimals);
    of_heights_ = exact::power_of_ten(decimals - raster.decimals);
    bounds_.decimals = decimals;
    above_.resize(raster.heights.size());
  }

  void add(std::size_t raised) {
    const auto width = static_cast<int64_t>(raster_.width);
    const int64_t column = static_cast<int64_t>(raised) % width,
                  row = static_cast<int64_t>(raised) / width;
    const auto weight = [](int64_t away) { return kSlopePosts - std::abs(away); };
    for (int64_t dy = 1 - kSlopePosts; dy < kSlopePosts; ++dy) {
      for (int64_t dx = 1 - kSlopePosts; dx < kSlopePosts; ++dx) {
        const int64_t x = column + dx, y = row + dy;
        if (x < 0 || y < 0 || x >= width || y >= raster_.height) continue;
        const auto post = static_cast<std::size_t>(y * width + x);
        if (!terrain::is_height(raster_.heights[post])) continue;
        const Wide rise = Wide{raster_.heights[raised]} - raster_.heights[post];
        const Wide part = ceil_divide(rise * (weight(dx) * weight(dy)), kSlopePosts * kSlopePosts);
        above_[post] = std::max(above_[post], static_cast<int64_t>(std::max<Wide>(part, 0)));
      }
    }
  }

  terrain::OwnBounds take() {
    for (std::size_t post = 0; post < above_.size(); ++post) {
      int64_t& number = bounds_.numbers[post];
      if (number == terrain::kUnbounded) continue;
      const Wide bound = number * own_ + above_[post] * of_heights_;
      if (bound > int64_t{1} << 62) throw Error("bounds and heights have too many digits");
      number = static_cast<int64_t>(bound);
    }
    return std::move(bounds_);
  }

 private:
  const Raster& raster_;
  terrain::OwnBounds bounds_;
  Wide own_, of_heights_;       // from numbers of bounds and heights to those of the result
  std::vector<int64_t> above_;  // how far the surface may be above a post's bound
};

}  // namespace

Obstacles::Obstacles(const std::string& path)
    : path_(path), features_(import_geojson(path, read_file(path))) {
  for (const Feature& obstacle : features_) {
    if (obstacle.top.has_value() == obstacle.height.has_value()) {
      throw Error(path +
                  ": an obstacle needs either a top, above the zero of heights, or a height"
                  " above the ground");
    }
  }
}

void Obstacles::raise(Raster& raster, const std::optional<Decimal>& max_error) const {
  if (terrain::is_sparse(raster)) {
    throw Error(path_ + ": obstacles are for rasters with a post at every place");
  }
  if (!max_error) throw Error(path_ + ": obstacles need " + parameter("max_error"));
  Raising raising(raster);
  for (const Feature& obstacle : features_) {
    const bool is_there = with_file_context(path_, [&] { return raising.add(obstacle); });
    ++(is_there ? raster.mended.obstacles : raster.mended.obstacles_elsewhere);
  }
  Slopes slopes(raster, max_error);
  for (const std::size_t post : raising.raised()) slopes.add(post);
  raster.bounds = with_file_context(path_, [&] { return slopes.take(); });
}

}  // namespace microtin::importing
