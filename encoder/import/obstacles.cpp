// SPDX-License-Identifier: MIT
// Finds the cells that an obstacle touches, and raises their posts. A cell whose posts are all at
// the obstacle's top or above is there in full, however the obstacle lies in it.
#include "encoder/import/obstacles.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <map>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/wide.hpp"
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
struct Footprint {
  std::vector<std::size_t> cells;
  bool is_level;
};

// A point's parts are level; what is high above the ground along a line or in a polygon follows the
// ground.
std::vector<Footprint> parts_of(const Feature& obstacle, const Raster& raster) {
  const double radius = obstacle.radius ? exact::real(*obstacle.radius) : 0;
  const auto around = [&](const RealLine& line, TouchedCells& cells) {
    for (const RealRings& part : corridor_of(line, radius, raster.reference.horizontal_unit)) {
      cells.add(part);
    }
  };
  std::vector<Footprint> parts;
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
  if (magnitude(number) > kMost)
    throw Error("the top of an obstacle is out of range; check its unit");
  return static_cast<int64_t>(number);
}

// Posts that obstacles raise, by number, each with its height.
using RaisedPosts = std::vector<std::pair<std::size_t, int64_t>>;

// Finds the posts that obstacles raise, and how high. Reads only the ground that obstacles touch.
class Raising {
 public:
  explicit Raising(const RasterReader& ground) : ground_(ground), frame_(ground.frame()) {}

  // Whether a post of the obstacle's cells has a height.
  bool add(const Feature& obstacle) {
    bool is_there = false;
    for (const Footprint& part : parts_of(obstacle, frame_)) {
      is_there =
          (part.is_level ? raise_alike(obstacle, part.cells) : raise_each(obstacle, part.cells)) ||
          is_there;
    }
    return is_there;
  }

  RaisedPosts take() { return {heights_.begin(), heights_.end()}; }

 private:
  // Reads the ground of cells in rectangles of few rows, and calls visit(posts) for each cell, with
  // those of its posts that have heights.
  template <class Visit>
  void visit_cells(const std::vector<std::size_t>& cells, const Visit& visit) const {
    constexpr std::size_t kRows = 64;
    const std::size_t width = frame_.width;
    for (std::size_t i = 0, end; i < cells.size(); i = end) {
      const std::size_t row = cells[i] / width;
      std::size_t west = width, east = 0;
      for (end = i; end < cells.size() && cells[end] / width < row + kRows; ++end) {
        west = std::min(west, cells[end] % width);
        east = std::max(east, cells[end] % width + 1);
      }
      const std::size_t rows = cells[end - 1] / width - row + 2;
      const Raster part =
          ground_.read({static_cast<uint32_t>(west), static_cast<uint32_t>(row),
                        static_cast<uint32_t>(east - west + 1), static_cast<uint32_t>(rows)});
      for (std::size_t k = i; k < end; ++k) visit(posts_of(cells[k], part, west, row));
    }
  }

  // The posts of a cell that have heights, with these.
  RaisedPosts posts_of(std::size_t cell, const Raster& part, std::size_t west,
                       std::size_t south) const {
    const std::size_t width = frame_.width;
    RaisedPosts posts;
    for (const std::size_t post : {cell, cell + 1, cell + width, cell + width + 1}) {
      const int64_t height =
          part.heights[(post / width - south) * part.width + (post % width - west)];
      if (terrain::is_height(height)) posts.emplace_back(post, height);
    }
    return posts;
  }

  static std::optional<int64_t> highest_of(const RaisedPosts& posts) {
    std::optional<int64_t> highest;
    for (const auto& [post, height] : posts) highest = std::max(highest.value_or(height), height);
    return highest;
  }

  int64_t top_of(const Feature& obstacle, int64_t highest) const {
    return obstacle.top ? number_of(*obstacle.top, frame_.decimals)
                        : highest + number_of(*obstacle.height, frame_.decimals);
  }

  bool raise_each(const Feature& obstacle, const std::vector<std::size_t>& cells) {
    bool is_there = false;
    visit_cells(cells, [&](const RaisedPosts& posts) {
      const std::optional<int64_t> highest = highest_of(posts);
      if (!highest) return;
      is_there = true;
      raise(posts, top_of(obstacle, *highest));
    });
    return is_there;
  }

  bool raise_alike(const Feature& obstacle, const std::vector<std::size_t>& cells) {
    std::optional<int64_t> highest;
    visit_cells(cells, [&](const RaisedPosts& posts) {
      if (const auto here = highest_of(posts)) highest = std::max(highest.value_or(*here), *here);
    });
    if (!highest) return false;
    const int64_t top = top_of(obstacle, *highest);
    visit_cells(cells, [&](const RaisedPosts& posts) { raise(posts, top); });
    return true;
  }

  void raise(const RaisedPosts& posts, int64_t top) {
    for (const auto& [post, ground] : posts) {
      if (ground >= top) continue;
      int64_t& height = heights_.emplace(post, top).first->second;
      height = std::max(height, top);
    }
  }

  const RasterReader& ground_;
  const Raster& frame_;
  std::map<std::size_t, int64_t> heights_;
};

// The surface may fall to the bound in this many posts around raised ones, so that few vertices
// make its slope. It may be at their height at all posts of the cells that they are in: of a cell
// with three raised posts, two triangles can leave out the middle.
constexpr int64_t kSlopePosts = 3;
constexpr int64_t slope_at(int64_t away) {
  return std::min(kSlopePosts - away, kSlopePosts - 1);  // of kSlopePosts - 1
}

// What the bounds of a raised raster have in common.
terrain::OwnBounds raised_frame(const Raster& frame, const Decimal& max_error) {
  terrain::OwnBounds bounds = terrain::frame_of(frame.bounds);
  if (!bounds.unscaled) bounds = {{}, max_error.decimals, max_error};
  bounds.decimals = std::max(bounds.decimals, frame.decimals);
  return bounds;
}

// Wider bounds around raised posts: from their height to the bound along both axes.
class Slopes {
 public:
  Slopes(const Raster& raster, const Decimal& max_error)
      : raster_(raster), bounds_(raised_frame(raster, max_error)), above_(raster.heights.size()) {
    const bool has_own = !raster.bounds.empty();
    const int decimals = has_own ? raster.bounds.decimals : max_error.decimals;
    own_ = exact::power_of_ten(bounds_.decimals - decimals);
    of_heights_ = exact::power_of_ten(bounds_.decimals - raster.decimals);
    bounds_.numbers = raster.bounds.numbers;
    if (!has_own) bounds_.numbers.assign(raster.heights.size(), max_error.mantissa);
  }

  // Takes a raised post into account. It may lie outside the raster.
  void add(int64_t column, int64_t row, int64_t height) {
    const auto width = static_cast<int64_t>(raster_.width);
    for (int64_t dy = 1 - kSlopePosts; dy < kSlopePosts; ++dy) {
      for (int64_t dx = 1 - kSlopePosts; dx < kSlopePosts; ++dx) {
        const int64_t x = column + dx, y = row + dy;
        if (x < 0 || y < 0 || x >= width || y >= raster_.height) continue;
        const auto post = static_cast<std::size_t>(y * width + x);
        if (!terrain::is_height(raster_.heights[post])) continue;
        const Wide rise = Wide{height} - raster_.heights[post];
        const Wide part = ceil_divide(rise * (slope_at(std::abs(dx)) * slope_at(std::abs(dy))),
                                      slope_at(0) * slope_at(0));
        above_[post] = std::max(above_[post], static_cast<int64_t>(std::max<Wide>(part, 0)));
      }
    }
  }

  terrain::OwnBounds take() {
    for (std::size_t post = 0; post < above_.size(); ++post) {
      int64_t& number = bounds_.numbers[post];
      if (number == terrain::kUnbounded) continue;
      const Wide bound = number * own_ + above_[post] * of_heights_;
      if (bound > int64_t{1} << 62)
        throw Error("bounds and heights have too many digits; round them");
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

class RaisedRaster : public RasterReader {
 public:
  RaisedRaster(std::unique_ptr<RasterReader> ground, const std::vector<Feature>& obstacles,
               const std::string& path, const Decimal& max_error)
      : ground_(std::move(ground)), path_(path), max_error_(max_error) {
    frame_ = ground_->frame();
    with_file_context(path_, [&] {
      Raising raising(*ground_);
      for (const Feature& obstacle : obstacles) {
        ++(raising.add(obstacle) ? frame_.mended.obstacles : frame_.mended.obstacles_elsewhere);
      }
      raised_ = raising.take();
    });
    frame_.bounds = raised_frame(frame_, max_error_);
  }

  Raster read(const terrain::PostRectangle& r) const override {
    Raster part = ground_->read(r);
    visit_raised(r, 0, [&](std::size_t column, std::size_t row, int64_t height) {
      part.heights[(row - r.y) * r.width + (column - r.x)] = height;
    });
    part.bounds = with_file_context(path_, [&] {
      Slopes slopes(part, max_error_);
      visit_raised(r, kSlopePosts - 1, [&](std::size_t column, std::size_t row, int64_t height) {
        slopes.add(static_cast<int64_t>(column) - r.x, static_cast<int64_t>(row) - r.y, height);
      });
      return slopes.take();
    });
    return part;
  }

  std::vector<bool> absent_in(const terrain::PostRectangle& r) const override {
    return ground_->absent_in(r);
  }

 private:
  // The raised posts in a rectangle and those within `reach` of it.
  template <class Visit>
  void visit_raised(const terrain::PostRectangle& r, uint32_t reach, const Visit& visit) const {
    const std::size_t width = frame_.width, west = r.x - std::min(r.x, reach),
                      east = std::min<std::size_t>(std::size_t{r.x} + r.width + reach, width),
                      north =
                          std::min<std::size_t>(std::size_t{r.y} + r.height + reach, frame_.height);
    for (std::size_t row = r.y - std::min(r.y, reach); row < north; ++row) {
      auto post = std::lower_bound(raised_.begin(), raised_.end(),
                                   std::pair(row * width + west, INT64_MIN));
      for (; post != raised_.end() && post->first < row * width + east; ++post) {
        visit(post->first % width, row, post->second);
      }
    }
  }

  std::unique_ptr<RasterReader> ground_;
  std::string path_;
  Decimal max_error_;
  RaisedPosts raised_;
};

}  // namespace

Obstacles::Obstacles(const std::string& path, const FeatureFiles& files)
    : path_(path), features_(files.read(path)) {
  for (const Feature& obstacle : features_) {
    if (obstacle.top.has_value() == obstacle.height.has_value()) {
      throw Error(path +
                  ": an obstacle needs either a top, above the zero of heights, or a height"
                  " above the ground");
    }
  }
}

std::unique_ptr<RasterReader> Obstacles::raised(std::unique_ptr<RasterReader> ground,
                                                const std::optional<Decimal>& max_error) const {
  if (terrain::is_sparse(ground->frame())) {
    throw Error(path_ + ": obstacles are for rasters with a post at every place");
  }
  if (!max_error) throw Error(path_ + ": obstacles need " + parameter("max_error"));
  return std::make_unique<RaisedRaster>(std::move(ground), features_, path_, *max_error);
}

}  // namespace microtin::importing
