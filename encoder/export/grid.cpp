// SPDX-License-Identifier: MIT
// Surfaces as ESRI ASCII grids: which posts they have, where these lie on the lattice, and the
// files.
#include "encoder/export/grid.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/lattice_map.hpp"

namespace microtin::exporting {

// Lays posts along both axes in exact numbers.

namespace {

// Posts along one axis, from the first at `axis` on.
struct Row {
  Axis axis;
  uint32_t count;
};

uint32_t checked_count(Wide count) {
  if (count > std::numeric_limits<int32_t>::max()) {
    throw Error("the grid has 2^31 columns or rows or more; use a larger cell");
  }
  return static_cast<uint32_t>(count);
}

// From `first` on over a span, a step apart. A span's numerator lies below 2^81, its denominator
// and the step's below 2^40, the step's numerator below 2^60.
Row row_over(const Fraction& first, const Fraction& span, const Fraction& step) {
  const Wide steps = span.numerator * step.denominator / (span.denominator * step.numerator);
  return {make_axis(first, step), checked_count(steps + 1)};
}

Row row_over(const Axis& lattice, int64_t low, int64_t high, Decimal cell) {
  const Wide numerator = static_cast<Wide>(lattice.numerator);
  const Wide denominator = static_cast<Wide>(lattice.denominator);
  return row_over(reduced(lattice.offset + numerator * low, denominator),
                  {numerator * (Wide{high} - low), denominator}, meaning_of(cell));
}

Row row_over(Decimal low, Decimal high, Decimal cell) {
  const int decimals = std::max(low.decimals, high.decimals);
  const Wide first = mantissa_at(low, decimals), scale = power_of_ten(decimals);
  return row_over(reduced(first, scale), {mantissa_at(high, decimals) - first, scale},
                  meaning_of(cell));
}

// The first and the last number of an axis from `low` to `high`.
struct Numbers {
  Wide first, last;

  bool empty() const { return first > last; }
};

Numbers numbers_within(const Axis& axis, Decimal low, Decimal high) {
  const auto map_from = [&](Decimal value) {
    return map_between(decimal_axis(value.decimals), axis);
  };
  const LatticeMap from = map_from(low), to = map_from(high);
  return {ceil_divide(from.numerator(low.mantissa), from.step),
          floor_divide(to.numerator(high.mantissa), to.step)};
}

// The posts of an axis from `low` to `high`.
Row row_within(const Axis& axis, Decimal low, Decimal high) {
  const Numbers posts = numbers_within(axis, low, high);
  if (posts.empty()) throw Error("no post of the grid lies in the extent; choose a larger one");
  return {moved_axis(axis, posts.first), checked_count(posts.last - posts.first + 1)};
}

// A grid's x by the name by which columns of its own lie in the extent; by its own if by none.
Axis named_within(const PostGrid& grid, const Extent& extent, bool is_degrees) {
  for (const Axis& name : names_of_x(grid.x, is_degrees)) {
    const Numbers posts = numbers_within(name, extent.west, extent.east);
    if (!posts.empty() && posts.first < grid.columns && posts.last >= 0) return name;
  }
  return grid.x;
}

PostGrid grid_of(const Row& x, const Row& y) {
  return {x.count, y.count, x.axis, y.axis};
}

std::string range_text(const Axis& axis, int64_t low, int64_t high) {
  const CoordinateText text(axis);
  return text(low) + " to " + text(high);
}

}  // namespace

std::optional<Extent> parse_extent(const std::string& text) {
  constexpr Decimal kFurthest{1000000000000, 0};
  std::array<Decimal, 4> sides;
  size_t begin = 0;
  for (size_t i = 0; i < sides.size(); ++i) {
    const size_t end = i + 1 < sides.size() ? text.find(',', begin) : text.size();
    if (end == std::string::npos) return std::nullopt;
    const std::optional<Decimal> side =
        parse_decimal(std::string_view(text).substr(begin, end - begin), kPlaceDecimals);
    if (!side || kFurthest <= *side || *side <= Decimal{-kFurthest.mantissa, 0})
      return std::nullopt;
    sides[i] = *side;
    begin = end + 1;
  }
  const auto [west, south, east, north] = sides;
  if (east <= west || north <= south) return std::nullopt;
  return Extent{west, south, east, north};
}

std::string extent_text(const SampledSurface& surface) {
  return "x " + range_text(surface.placement.x, surface.x_min, surface.x_max) + ", y " +
         range_text(surface.placement.y, surface.y_min, surface.y_max);
}

PostGrid lattice_grid(const SampledSurface& surface) {
  const auto row = [](const Axis& lattice, int64_t low, int64_t high) {
    return Row{moved_axis(lattice, low), checked_count(Wide{high} - low + 1)};
  };
  return grid_of(row(surface.placement.x, surface.x_min, surface.x_max),
                 row(surface.placement.y, surface.y_min, surface.y_max));
}

PostGrid grid_of_cells(const SampledSurface& surface, Decimal cell) {
  return grid_of(row_over(surface.placement.x, surface.x_min, surface.x_max, cell),
                 row_over(surface.placement.y, surface.y_min, surface.y_max, cell));
}

PostGrid grid_of_cells(const Extent& extent, Decimal cell) {
  return grid_of(row_over(extent.west, extent.east, cell),
                 row_over(extent.south, extent.north, cell));
}

PostGrid posts_within(const PostGrid& grid, const Extent& extent, bool is_degrees) {
  return grid_of(row_within(named_within(grid, extent, is_degrees), extent.west, extent.east),
                 row_within(grid.y, extent.south, extent.north));
}

PostPlaces::PostPlaces(const Axis& posts, const std::vector<Axis>& names, int64_t low, int64_t high)
    : low_(low), high_(high) {
  for (const Axis& name : names) names_.push_back({map_between(posts, name), name});
}

std::optional<RealCoordinate> PostPlaces::operator()(int64_t post) const {
  for (const Name& name : names_) {
    const std::optional<RealCoordinate> at = coordinate_of(name.map, post, name.axis);
    if (!at || at->whole < low_) continue;
    if (at->whole < high_ || (at->whole == high_ && at->part == 0)) return at;
  }
  return std::nullopt;
}

PostPlaces places_of_x(const SampledSurface& s, const Axis& posts) {
  return {posts, names_of_x(s.placement.x, s.is_degrees), s.x_min, s.x_max};
}

PostPlaces places_of_y(const SampledSurface& s, const Axis& posts) {
  return {posts, {s.placement.y}, s.y_min, s.y_max};
}

bool meets(const SampledSurface& surface, const PostGrid& posts) {
  const auto overlaps = [](const Axis& posts_axis, uint32_t count, const Axis& lattice, int64_t low,
                           int64_t high) {
    const LatticeMap map = map_between(posts_axis, lattice);
    return map.numerator(0) <= high * map.step && map.numerator(Wide{count} - 1) >= low * map.step;
  };
  const Placement& p = surface.placement;
  const std::vector<Axis> names = names_of_x(p.x, surface.is_degrees);
  return std::any_of(names.begin(), names.end(),
                     [&](const Axis& x) {
                       return overlaps(posts.x, posts.columns, x, surface.x_min, surface.x_max);
                     }) &&
         overlaps(posts.y, posts.rows, p.y, surface.y_min, surface.y_max);
}

// Samples the surface at each cell's centre, from north to south.

namespace {

// Heights as text.
class HeightText {
 public:
  explicit HeightText(const Axis& z)
      : z_(z), decimals_(std::min(decimals_of(z) + 3, kMaxDecimals)) {}

  Decimal value(const ExactHeight& height) const { return rounded_height(z_, height, decimals_); }

  // Characters that a height has at most, up to one of the lattice's on its side of zero.
  size_t longest(int32_t step) const {
    const Wide whole = mantissa_at(value({step, 0, 1}), decimals_) / power_of_ten(decimals_);
    const std::string digits = std::to_string(static_cast<int64_t>(magnitude(whole)));
    return std::string("-.").size() + digits.size() + static_cast<size_t>(decimals_);
  }

 private:
  Axis z_;
  int decimals_;
};

// -9999, or as many more nines as it takes to be below every height.
int64_t no_data_below(Decimal lowest) {
  int64_t value = -9999;
  while (value > -power_of_ten(17) && lowest <= Decimal{value, 0}) value = 10 * value - 9;
  return value;
}

// What is written, but for the heights.
class GridText {
 public:
  explicit GridText(const SampledSurface& surface)
      : heights_(surface.placement.z),
        no_data_(std::to_string(no_data_below(heights_.value({surface.lowest, 0, 1})))) {}

  std::string header(const PostGrid& posts) const {
    const std::string dx = step_text(posts.x), dy = step_text(posts.y);
    return "ncols " + std::to_string(posts.columns) + "\nnrows " + std::to_string(posts.rows) +
           "\nxllcenter " + CoordinateText(posts.x)(0) + "\nyllcenter " +
           CoordinateText(posts.y)(0) + '\n' +
           (dx == dy ? "cellsize " + dx : "dx " + dx + "\ndy " + dy) + "\nNODATA_value " +
           no_data_ + '\n';
  }

  std::string height(const ExactAnswer& answer) const {
    return answer.kind == MICROTIN_QUERY_OK ? to_string(heights_.value(answer.height)) : no_data_;
  }

  const std::string& no_data() const { return no_data_; }

 private:
  static std::string step_text(const Axis& axis) {
    return CoordinateText({0, axis.numerator, axis.denominator})(1);
  }

  HeightText heights_;
  std::string no_data_;
};

}  // namespace

double most_grid_bytes(const SampledSurface& surface, const PostGrid& posts) {
  const HeightText heights(surface.placement.z);
  const size_t longest =
      std::max({GridText(surface).no_data().size(), heights.longest(surface.lowest),
                heights.longest(surface.highest)});
  return static_cast<double>(posts.columns) * static_cast<double>(posts.rows) *
         static_cast<double>(longest + 1);
}

void export_grid(const SampledSurface& surface, const PostGrid& posts, OutputFile& out) {
  const PostPlaces x = places_of_x(surface, posts.x), y = places_of_y(surface, posts.y);
  const GridText text(surface);
  out.write(text.header(posts));
  for (int64_t row = posts.rows; row-- > 0;) {
    const std::optional<RealCoordinate> py = y(row);
    for (int64_t column = 0; column < posts.columns; ++column) {
      const std::optional<RealCoordinate> px = x(column);
      out.write((column != 0 ? " " : "") +
                (px && py ? text.height(surface.height_at(place_of(*px, *py))) : text.no_data()));
    }
    out.write("\n");
  }
}

}  // namespace microtin::exporting
