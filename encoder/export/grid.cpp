// SPDX-License-Identifier: MIT
// Asks the surface at each cell's centre, from north to south.
#include "encoder/export/grid.hpp"

#include <algorithm>

#include "encoder/base/error.hpp"
#include "encoder/exact/coordinates.hpp"
#include "encoder/export/post_grid.hpp"

namespace microtin::exporting {
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
