// SPDX-License-Identifier: MIT
// Walks along edges from cell to cell, and through triangles from post to post. Heights are whole
// units of 2^-16 z steps: those of vertices exactly, those of posts rounded up to find how far the
// surface is below, down to find how far it is above. So a distance is never too small, and at most
// two units too large.
#include "encoder/terrain/everywhere.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/terrain/exact_query.hpp"

namespace microtin::terrain {
namespace {

constexpr int64_t kUnits = 65536;               // of height in a z step
constexpr int64_t kHighest = int64_t{1} << 40;  // in units: far beyond all lattice heights

// A coordinate in whole parts of the distance of two posts: column c lies at c * step.
struct PostAxis {
  Wide scale, shift, step;
  uint32_t posts;

  PostAxis(const Axis& lattice, const Axis& source, uint32_t count) : posts(count) {
    const LatticeMap map = map_between(lattice, source);
    scale = map.scale;
    shift = map.shift;
    step = map.step;
  }
  Wide at(uint16_t place) const { return scale * place + shift; }
  // So that coordinates stay below 2^27, and the double area of a triangle below 2^55.
  bool is_small() const {
    return step <= Wide{1} << 20 && scale <= 1024 && magnitude(shift) <= Wide{1} << 26;
  }
};

// An end of an edge: where it lies, in parts of the axes, and its height in units.
struct End {
  Wide x, y, z;
};

class Comparison {
 public:
  Comparison(const Placement& lattice, const Raster& raster)
      : raster_(raster),
        x_(lattice.x, raster.x, raster.width),
        y_(lattice.y, raster.y, raster.height),
        from_(
            map_between({0, 1, static_cast<uint64_t>(power_of_ten(raster.decimals))}, lattice.z)) {}

  // Whether numerators along an edge, over parts^2 * cell, stay below 2^83 * kHighest * 8.
  bool is_exact(const End& a, const End& b) const {
    const Wide most = parts(a, b), cell = x_.step * y_.step;
    return x_.is_small() && y_.is_small() && most <= Wide{1} << 41 &&
           most * most <= (Wide{1} << 83) / cell;
  }

  End end_of(const Vertex& v) const { return {x_.at(v.x), y_.at(v.y), Wide{v.z} * kUnits}; }

  // Takes the posts in a counter-clockwise triangle into account.
  void add_posts(const End& a, const End& b, const End& c) {
    const Wide south = std::min({a.y, b.y, c.y}), north = std::max({a.y, b.y, c.y});
    const Wide first = std::max<Wide>(ceil_divide(south, y_.step), 0);
    const Wide last = std::min<Wide>(floor_divide(north, y_.step), y_.posts - Wide{1});
    for (Wide row = first; row <= last; ++row) add_row(a, b, c, row);
  }

  // Takes the edge from `a` to `b` into account.
  void add(const End& a, const End& b) {
    const std::vector<Wide>& stops = stops_along(a, b);
    for (size_t i = 1; i < stops.size(); ++i) add_piece(a, b, stops[i - 1], stops[i]);
  }

  Wide below() const { return below_; }
  Wide above() const { return above_; }
  bool has_far_post() const { return has_far_post_; }

 private:
  static Wide turn(const End& a, const End& b, Wide x, Wide y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
  }

  // The columns of a row from which all three edges are to the left or on the place.
  void add_row(const End& a, const End& b, const End& c, Wide row) {
    const Wide y = row * y_.step;
    Wide first = 0, last = x_.posts - Wide{1};
    for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &c), std::pair(&c, &a)}) {
      // turn = at_0 - slope * step * column >= 0
      const Wide at_0 = turn(*from, *to, 0, y), slope = (to->y - from->y) * x_.step;
      if (slope > 0) last = std::min(last, floor_divide(at_0, slope));
      if (slope < 0) first = std::max(first, ceil_divide(-at_0, -slope));
      if (slope == 0 && at_0 < 0) return;
    }
    for (Wide column = first; column <= last; ++column) {
      add_post(a, b, c, static_cast<uint32_t>(column), static_cast<uint32_t>(row));
    }
  }

  void add_post(const End& a, const End& b, const End& c, uint32_t column, uint32_t row) {
    const std::optional<Rounded> post = post_at(column, row);
    if (!post) return;
    const Wide x = column * x_.step, y = row * y_.step, area = turn(a, b, c.x, c.y);
    const Wide above_a = turn(a, b, x, y) * (c.z - a.z) + turn(c, a, x, y) * (b.z - a.z);
    below_ = std::max(below_, ceil_divide((post->high - a.z) * area - above_a, area));
    above_ = std::max(above_, ceil_divide(above_a - (post->low - a.z) * area, area));
  }

  // A post's height in units, rounded to both sides, if it has one.
  struct Rounded {
    Wide low, high;
  };
  std::optional<Rounded> post_at(uint32_t column, uint32_t row) {
    const int64_t number = raster_.heights[size_t{row} * raster_.width + column];
    if (number == kVoidHeight) return std::nullopt;
    const Wide numerator = from_.numerator(number) * kUnits;
    const Rounded post{floor_divide(numerator, from_.step), ceil_divide(numerator, from_.step)};
    if (post.low >= -kHighest && post.high <= kHighest) return post;
    has_far_post_ = true;
    return std::nullopt;
  }

  // Places along an edge are counted in this many parts of it, so that all lines meet it at whole
  // numbers.
  static Wide parts(const End& a, const End& b) {
    return std::max(magnitude(b.x - a.x), Wide{1}) * std::max(magnitude(b.y - a.y), Wide{1});
  }

  // Both ends, and where the edge crosses the lines of columns and rows.
  const std::vector<Wide>& stops_along(const End& a, const End& b) {
    const Wide all = parts(a, b);
    stops_ = {0, all};
    const auto add_lines = [&](Wide from, Wide to, Wide step) {
      const Wide low = std::min(from, to), high = std::max(from, to);
      for (Wide line = ceil_divide(low, step); line * step <= high && low != high; ++line) {
        stops_.push_back((line * step - from) * (all / (to - from)));
      }
    };
    add_lines(a.x, b.x, x_.step);
    add_lines(a.y, b.y, y_.step);
    std::sort(stops_.begin(), stops_.end());
    stops_.erase(std::unique(stops_.begin(), stops_.end()), stops_.end());
    return stops_;
  }

  // The first cell of a column or row that the middle of a piece lies in, of two if on a line.
  struct Cells {
    Wide first;
    bool also_before;
  };
  static Cells cells_at(Wide twice, Wide step) {
    const Wide cell = floor_divide(twice, 2 * step);
    return {cell, cell * 2 * step == twice};
  }

  void add_piece(const End& a, const End& b, Wide from, Wide to) {
    const Wide all = parts(a, b);
    // Twice the middle of the piece, times the parts; steps are multiplied alike.
    const Cells columns = cells_at(2 * a.x * all + (from + to) * (b.x - a.x), x_.step * all);
    const Cells rows = cells_at(2 * a.y * all + (from + to) * (b.y - a.y), y_.step * all);
    for (int before = 0; before < 4; ++before) {
      if (((before & 1) != 0 && !columns.also_before) || ((before & 2) != 0 && !rows.also_before)) {
        continue;
      }
      const Wide column = columns.first - (before & 1), row = rows.first - (before >> 1);
      if (compare(a, b, from, to, column, row)) return;
    }
  }

  // Whether the cell has four posts with heights. On a line between two cells both are the same.
  bool compare(const End& a, const End& b, Wide from, Wide to, Wide column, Wide row) {
    if (column < 0 || row < 0 || column + 1 >= x_.posts || row + 1 >= y_.posts) return false;
    std::array<Wide, 4> low{}, high{};
    for (uint32_t corner = 0; corner < 4; ++corner) {
      const std::optional<Rounded> post = post_at(static_cast<uint32_t>(column) + corner % 2,
                                                  static_cast<uint32_t>(row) + corner / 2);
      if (!post) return false;
      low[corner] = post->low;
      high[corner] = post->high;
    }
    below_ = std::max(below_, most(a, b, from, to, column, row, high, 1));
    above_ = std::max(above_, most(a, b, from, to, column, row, low, -1));
    return true;
  }

  // The most that the bilinear surface is above the edge (sign 1), or below it (-1), on a piece of
  // the edge that lies in a cell, rounded up. Along it the difference is a parabola: from f at its
  // beginning to g at its end, with the bulge K t (1 - t).
  Wide most(const End& a, const End& b, Wide from, Wide to, Wide column, Wide row,
            const std::array<Wide, 4>& posts, int sign) const {
    const Wide all = parts(a, b), cell = x_.step * y_.step,
               twist = posts[0] - posts[1] - posts[2] + posts[3];
    const auto difference = [&](Wide n) {
      const Wide x = a.x * all + n * (b.x - a.x) - column * x_.step * all;  // 0 .. step * all
      const Wide y = a.y * all + n * (b.y - a.y) - row * y_.step * all;
      // Numerators over all^2 * cell.
      const Wide bilinear = x * (posts[1] - posts[0]) * (y_.step * all) +
                            y * (posts[2] - posts[0]) * (x_.step * all) + x * y * twist;
      const Wide linear = (a.z - posts[0]) * all + n * (b.z - a.z);
      return ceil_divide(sign * (bilinear - linear * (all * cell)), all * all * cell);
    };
    const Wide f = difference(from), g = difference(to), length = to - from;
    const Wide slopes = ((b.x - a.x) < 0) == ((b.y - a.y) < 0) ? 1 : -1;
    const bool is_slanted = a.x != b.x && a.y != b.y;
    // The second derivative of the difference, over the piece, is twice -K.
    const Wide bulge = is_slanted ? -sign * slopes * twist * length * length : 0;
    const Wide k = ceil_divide(bulge, all * cell);
    if (k <= magnitude(g - f)) return std::max(f, g);
    return ceil_divide((f + g) * 2 * k + k * k + (g - f) * (g - f), 4 * k);
  }

  const Raster& raster_;
  PostAxis x_, y_;
  LatticeMap from_;  // from numbers of heights to z steps
  std::vector<Wide> stops_;
  Wide below_ = 0, above_ = 0;
  bool has_far_post_ = false;  // beyond kHighest: no distance is known
};

Decimal decimal_of(Wide units, const Axis& z) {
  const Wide numerator = units * static_cast<Wide>(z.numerator);
  const Wide divisor = kUnits * static_cast<Wide>(z.denominator);
  const WholeAndRest split = multiply_divide(power_of_ten(kMaxDecimals), numerator, divisor);
  return make_decimal_up(split.whole + (split.rest != 0 ? 1 : 0), kMaxDecimals);
}

}  // namespace

std::optional<Distances> measure_everywhere(const microtin_mesh* mesh, const Placement& lattice,
                                            const Raster& raster) {
  Comparison comparison(lattice, raster);
  const uint32_t triangles = microtin_mesh_triangle_count(mesh);
  for (uint32_t t = 0; t < triangles; ++t) {
    uint32_t v[3];
    if (microtin_mesh_triangle(mesh, t, v) != MICROTIN_TRIANGLE_REAL) continue;
    const std::array<End, 3> ends = {comparison.end_of(vertex_of(mesh, v[0])),
                                     comparison.end_of(vertex_of(mesh, v[1])),
                                     comparison.end_of(vertex_of(mesh, v[2]))};
    for (uint32_t i = 0; i < 3; ++i) {
      const End &from = ends[i], &to = ends[(i + 1) % 3];
      if (!comparison.is_exact(from, to)) return std::nullopt;
      uint32_t unused[3];
      const uint32_t other = microtin_mesh_neighbour(mesh, t, i);
      const bool is_shared = microtin_mesh_triangle(mesh, other, unused) == MICROTIN_TRIANGLE_REAL;
      if (!is_shared || t < other) comparison.add(from, to);  // an edge counts once
    }
    comparison.add_posts(ends[0], ends[1], ends[2]);
  }
  if (comparison.has_far_post()) return std::nullopt;
  return Distances{decimal_of(comparison.below(), lattice.z),
                   decimal_of(comparison.above(), lattice.z)};
}

}  // namespace microtin::terrain
