// SPDX-License-Identifier: MIT
// Asks the surface at each cell's centre, from north to south.
#include "encoder/export/grid.hpp"

#include <algorithm>

#include "encoder/base/error.hpp"
#include "encoder/exact/coordinates.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/lattice_map.hpp"

namespace microtin::exporting {
namespace {

// The posts along one axis of the grid.
class Posts {
 public:
  Posts(const Axis& lattice, int64_t low, int64_t high, const std::optional<Decimal>& cell)
      : low_(low), high_(high) {
    const Wide offset = lattice.offset + static_cast<Wide>(lattice.numerator) * low;
    const Wide numerator = static_cast<Wide>(lattice.numerator);
    const Wide denominator = static_cast<Wide>(lattice.denominator);
    if (!cell) {
      axis_ = reduced_axis(offset, numerator, denominator);
      count_ = high - low + 1;
    } else {
      const Fraction step = meaning_of(*cell);
      axis_ = make_axis(reduced(offset, denominator), step);
      count_ = static_cast<int64_t>(numerator * (high - low) * step.denominator /
                                    (denominator * step.numerator)) +
               1;
    }
    map_ = map_between(axis_, lattice);
  }

  const Axis& axis() const { return axis_; }
  int64_t count() const { return count_; }

  // Of a post on the lattice, with 8 fractional bits.
  int64_t place(int64_t post) const {
    const Wide place = round_divide(256 * map_.numerator(post), map_.step);
    return static_cast<int64_t>(std::clamp<Wide>(place, Wide{256} * low_, Wide{256} * high_));
  }

  // The distance between posts.
  std::string step() const { return CoordinateText({0, axis_.numerator, axis_.denominator})(1); }

 private:
  int64_t low_, high_, count_;
  Axis axis_{0, 1, 1};
  LatticeMap map_{};
};

// Answers of the height query as text.
class HeightText {
 public:
  explicit HeightText(const Axis& z)
      : z_(z), decimals_(std::min(decimals_of(z) + 3, kMaxDecimals)) {}

  Decimal value(int32_t height) const {
    const Wide numerator = Wide{z_.offset} * 65536 + static_cast<Wide>(z_.numerator) * height;
    const Wide denominator = static_cast<Wide>(z_.denominator) * 65536;
    return make_decimal(round_divide(numerator * power_of_ten(decimals_), denominator), decimals_);
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

void write_header(const Posts& x, const Posts& y, const std::string& no_data, OutputFile& out) {
  const std::string dx = x.step(), dy = y.step();
  out.write("ncols " + std::to_string(x.count()) + "\nnrows " + std::to_string(y.count()) +
            "\nxllcenter " + CoordinateText(x.axis())(0) + "\nyllcenter " +
            CoordinateText(y.axis())(0) + '\n' +
            (dx == dy ? "cellsize " + dx : "dx " + dx + "\ndy " + dy) + "\nNODATA_value " +
            no_data + '\n');
}

}  // namespace

uint64_t lattice_posts(const SampledSurface& surface) {
  return static_cast<uint64_t>(surface.x_max - surface.x_min + 1) *
         static_cast<uint64_t>(surface.y_max - surface.y_min + 1);
}

void export_grid(const SampledSurface& surface, const std::optional<Decimal>& cell,
                 OutputFile& out) {
  const Posts x(surface.placement.x, surface.x_min, surface.x_max, cell);
  const Posts y(surface.placement.y, surface.y_min, surface.y_max, cell);
  const HeightText text(surface.placement.z);
  const std::string no_data = std::to_string(no_data_below(text.value(surface.lowest * 65536)));
  write_header(x, y, no_data, out);
  for (int64_t row = y.count(); row-- > 0;) {
    std::string line;
    for (int64_t column = 0; column < x.count(); ++column) {
      const std::optional<int32_t> height = surface.height_at(x.place(column), y.place(row));
      if (column != 0) line += ' ';
      line += height ? to_string(text.value(*height)) : no_data;
    }
    out.write(line + '\n');
  }
}

}  // namespace microtin::exporting
