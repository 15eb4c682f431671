// SPDX-License-Identifier: MIT
// Bounds of heights in areas and along lines, from the tiles that these may touch.
#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/export/queries.hpp"

namespace microtin::exporting {
namespace {

constexpr double kNear = 1.0 / 256;  // lattice steps

// A range of lattice coordinates.
struct Range {
  double low, high;

  static Range between(double a, double b) { return {std::min(a, b), std::max(a, b)}; }
};

// Columns, or rows, of tiles: from the first up to and without the last.
struct Slices {
  int64_t first, last;
};

Slices slices_near(const Range& range, uint32_t side, uint32_t count) {
  const auto slice = [&](double coordinate) {
    return static_cast<int64_t>(std::clamp(coordinate / side, -1.0, static_cast<double>(count)));
  };
  if (range.high + kNear < 0) return {0, 0};
  return {std::max<int64_t>(0, slice(range.low - kNear)),
          std::min<int64_t>(count, slice(range.high + kNear) + 1)};
}

Position on_lattice(const SampledSurface& surface, Position p) {
  const Placement& at = surface.placement;
  return {(p.x - offset_of(at.x)) / step_of(at.x), (p.y - offset_of(at.y)) / step_of(at.y)};
}

// Both ends on the lattice; in degrees by those names that are nearest to the surface's middle, and
// from one end to the other as far as given.
std::pair<Position, Position> area_on_lattice(const SampledSurface& surface, Position from,
                                              Position to) {
  for (const double coordinate : {from.x, from.y, to.x, to.y}) {
    if (!std::isfinite(coordinate)) throw Error("a coordinate of the area is not a number");
  }
  if (surface.is_degrees) {
    const Axis& axis = surface.placement.x;
    const double middle =
        offset_of(axis) + step_of(axis) * static_cast<double>(surface.x_min + surface.x_max) / 2;
    const double turn = 360 * std::round(((from.x + to.x) / 2 - middle) / 360);
    from.x -= turn;
    to.x -= turn;
  }
  return {on_lattice(surface, from), on_lattice(surface, to)};
}

bool is_inside(const SampledSurface& surface, const Position& p) {
  return p.x >= static_cast<double>(surface.x_min) && p.x <= static_cast<double>(surface.x_max) &&
         p.y >= static_cast<double>(surface.y_min) && p.y <= static_cast<double>(surface.y_max);
}

class Gathering {
 public:
  Gathering(const SampledSurface& surface, const TileHeightsOf& heights_of, bool is_inside)
      : grid_(surface.tiles), heights_of_(heights_of) {
    found_.is_complete = is_inside;
  }

  Slices rows(const Range& y) const { return slices_near(y, grid_.height, tile_rows(grid_)); }

  void add_row(int64_t row, const Range& x) {
    const Slices columns = slices_near(x, grid_.width, tile_columns(grid_));
    for (int64_t column = columns.first; column < columns.last; ++column) {
      add(heights_of_(static_cast<uint32_t>(row) * tile_columns(grid_) +
                      static_cast<uint32_t>(column)));
    }
  }

  const TileGrid& grid() const { return grid_; }
  const AreaHeights& found() const { return found_; }

 private:
  void add(const TileHeights& tile) {
    if (!tile.has_terrain) {
      found_.is_complete = false;
      return;
    }
    found_.lowest = found_.has_terrain ? std::min(found_.lowest, tile.lowest) : tile.lowest;
    found_.highest = found_.has_terrain ? std::max(found_.highest, tile.highest) : tile.highest;
    found_.has_terrain = true;
  }

  const TileGrid& grid_;
  const TileHeightsOf& heights_of_;
  AreaHeights found_;
};

}  // namespace

AreaHeights heights_in_box(const SampledSurface& surface, const TileHeightsOf& heights_of,
                           Position corner, Position opposite) {
  const auto [a, b] = area_on_lattice(surface, corner, opposite);
  Gathering gathering(surface, heights_of, is_inside(surface, a) && is_inside(surface, b));
  const Slices rows = gathering.rows(Range::between(a.y, b.y));
  for (int64_t row = rows.first; row < rows.last; ++row) {
    gathering.add_row(row, Range::between(a.x, b.x));
  }
  return gathering.found();
}

AreaHeights heights_on_line(const SampledSurface& surface, const TileHeightsOf& heights_of,
                            Position from, Position to) {
  const auto [a, b] = area_on_lattice(surface, from, to);
  Gathering gathering(surface, heights_of, is_inside(surface, a) && is_inside(surface, b));
  const Range all = Range::between(a.y, b.y);
  const Slices rows = gathering.rows(all);
  for (int64_t row = rows.first; row < rows.last; ++row) {
    // What of the line lies in the row, and a bit more.
    const double height = gathering.grid().height;
    const Range y = {std::max(all.low, static_cast<double>(row) * height - kNear),
                     std::min(all.high, static_cast<double>(row + 1) * height + kNear)};
    const auto x_at = [begin = a, end = b](double at) {
      if (end.y == begin.y) return begin.x;
      const double part = std::clamp((at - begin.y) / (end.y - begin.y), 0.0, 1.0);
      return begin.x + (end.x - begin.x) * part;
    };
    gathering.add_row(
        row, a.y == b.y ? Range::between(a.x, b.x) : Range::between(x_at(y.low), x_at(y.high)));
  }
  return gathering.found();
}

}  // namespace microtin::exporting
