// SPDX-License-Identifier: MIT
// Walks along edges from cell to cell, and through triangles from post to post. Heights are whole
// units of 2^-16 z steps: those of vertices exactly, those of posts rounded up to find how far the
// surface is below, down to find how far it is above. So a distance is never too small, and at most
// two units too large.
#include "encoder/verify/everywhere.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>
#include <vector>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/terrain/exact_query.hpp"

namespace microtin::verifying {
namespace {

constexpr int64_t kUnits = 65536;  // of height in a z step
constexpr Wide kSixteenth = kUnits / 16;
constexpr int64_t kHighest = int64_t{1} << 40;  // in units: far beyond all lattice heights

// A coordinate in whole parts of the distance of two posts: column c lies at c * step.
struct PostAxis {
  int64_t scale = 0, shift = 0, step = 1;
  uint32_t posts;
  bool is_small;  // coordinates stay below 2^27, and the double area of a triangle below 2^57

  PostAxis(const Axis& lattice, const Axis& source, uint32_t count) : posts(count) {
    const LatticeMap map = map_between(lattice, source);
    is_small =
        map.step <= Wide{1} << 20 && map.scale <= 1024 && magnitude(map.shift) <= Wide{1} << 26;
    if (!is_small) return;
    scale = static_cast<int64_t>(map.scale);
    shift = static_cast<int64_t>(map.shift);
    step = static_cast<int64_t>(map.step);
  }
  int64_t at(uint16_t place) const { return scale * place + shift; }
  bool has_post_at(int64_t place) const {
    return place >= 0 && place <= (posts - int64_t{1}) * step && place % step == 0;
  }
};

// An end of an edge: where it lies, in parts of the axes, and its height in units.
struct End {
  int64_t x, y, z;
  bool is_post;
};

// A raster's heights in units, as a double and exactly.
class PostHeights {
 public:
  PostHeights(const Raster& raster, const Axis& z)
      : raster_(raster),
        to_units_(map_between(decimal_axis(raster.decimals), z)),
        scale_(static_cast<double>(to_units_.scale) * kUnits / static_cast<double>(to_units_.step)),
        shift_(static_cast<double>(to_units_.shift) * kUnits /
               static_cast<double>(to_units_.step)) {
    double largest = 0;
    for (const int64_t number : raster.heights) {
      if (number != kVoidHeight) largest = std::max(largest, std::abs(static_cast<double>(number)));
    }
    slack_ = 4 + std::ldexp(scale_ * largest + std::abs(shift_), -48);
  }

  int64_t number_at(int64_t column, int64_t row) const {
    return raster_.heights[static_cast<size_t>(row) * raster_.width + static_cast<size_t>(column)];
  }

  double near(int64_t number) const { return scale_ * static_cast<double>(number) + shift_; }
  // More than doubles and the rounding of exact heights make up together.
  double slack() const { return slack_; }

  // Rounded to both sides; nothing beyond kHighest.
  struct Rounded {
    Wide low, high;
  };
  std::optional<Rounded> exact(int64_t number) const {
    const Wide numerator = to_units_.numerator(number) * kUnits;
    const Rounded post{floor_divide(numerator, to_units_.step),
                       ceil_divide(numerator, to_units_.step)};
    if (post.low >= -kHighest && post.high <= kHighest) return post;
    return std::nullopt;
  }

 private:
  const Raster& raster_;
  LatticeMap to_units_;
  double scale_, shift_, slack_ = 0;
};

// Keeps the largest distances.
class Largest {
 public:
  bool may_exceed(int64_t /*column*/, int64_t /*row*/, double below, double above,
                  double slack) const {
    return below + slack > static_cast<double>(gap_.below) ||
           above + slack > static_cast<double>(gap_.above);
  }
  void add_post(int64_t /*column*/, int64_t /*row*/, Wide below, Wide above) { keep(below, above); }
  void add_cell(int64_t /*column*/, int64_t /*row*/, Wide below, Wide above) { keep(below, above); }
  Gap gap() const { return gap_; }

 private:
  void keep(Wide below, Wide above) {
    gap_.below = std::max(gap_.below, below);
    gap_.above = std::max(gap_.above, above);
  }

  Gap gap_{0, 0};
};

// Keeps by how much distances are larger than allowed, at the posts where they are or next to
// which.
class ExcessAtPosts {
 public:
  ExcessAtPosts(const Raster& raster, const Allowed& allowed)
      : width_(raster.width), allowed_(allowed), excess_(raster.heights.size()) {}

  // Whether a post, or the cell to the north-east of it, may be missed. What is allowed at the post
  // is at most what is allowed in the cell.
  bool may_exceed(int64_t column, int64_t row, double below, double above, double slack) const {
    const auto allowed = static_cast<double>(allowed_.distances[post_at(column, row)]);
    return below + slack > (allowed_.never_below ? 0 : allowed) || above + slack > allowed;
  }
  void add_post(int64_t column, int64_t row, Wide below, Wide above) {
    const std::size_t post = post_at(column, row);
    keep(post, excess_of(allowed_.distances[post], below, above));
  }
  void add_cell(int64_t column, int64_t row, Wide below, Wide above) {
    const std::size_t post = post_at(column, row);
    const Excess excess = excess_of(allowed_in_cell(allowed_, post, width_), below, above);
    for (const std::size_t corner : {post, post + 1, post + width_, post + width_ + 1}) {
      keep(corner, excess);
    }
  }
  std::vector<Excess> take() { return std::move(excess_); }

 private:
  std::size_t post_at(int64_t column, int64_t row) const {
    return static_cast<std::size_t>(row) * width_ + static_cast<std::size_t>(column);
  }
  Excess excess_of(int64_t allowed, Wide below, Wide above) const {
    const auto beyond = [](Wide distance, int64_t most) {
      return static_cast<int64_t>(std::clamp<Wide>(distance - most, 0, kHighest));
    };
    return {beyond(below, allowed_.never_below ? 0 : allowed), beyond(above, allowed)};
  }
  void keep(std::size_t post, Excess excess) {
    excess_[post] = {std::max(excess_[post].below, excess.below),
                     std::max(excess_[post].above, excess.above)};
  }

  std::size_t width_;
  const Allowed& allowed_;
  std::vector<Excess> excess_;
};

// Doubles find what the record may want; only that is computed exactly.
template <class Record>
class Comparison {
 public:
  Comparison(const Placement& lattice, const Raster& raster, Record& record)
      : x_(lattice.x, raster.x, raster.width),
        y_(lattice.y, raster.y, raster.height),
        posts_(raster, lattice.z),
        most_parts_(most_parts(x_, y_)),
        record_(record) {}

  // Whether numerators along an edge, over parts^2 * cell, stay below 2^83 * kHighest * 8.
  bool is_exact(const End& a, const End& b) const { return parts(a, b) <= most_parts_; }

  End end_of(const Vertex& v) const {
    const int64_t x = x_.at(v.x), y = y_.at(v.y);
    return {x, y, v.z * kUnits, x_.has_post_at(x) && y_.has_post_at(y)};
  }

  // Takes the post at a vertex into account, if there is one.
  void add_vertex(const End& v) {
    if (!v.is_post) return;
    const int64_t column = v.x / x_.step, row = v.y / y_.step;
    const int64_t number = posts_.number_at(column, row);
    if (number == kVoidHeight) return;
    const double below = posts_.near(number) - static_cast<double>(v.z);
    if (!record_.may_exceed(column, row, below, -below, posts_.slack())) return;
    if (const auto post = exact(number)) {
      record_.add_post(column, row, post->high - v.z, v.z - post->low);
    }
  }

  // Takes the posts in a counter-clockwise triangle into account, but for those at its corners.
  void add_posts(const End& a, const End& b, const End& c) {
    const auto [west, east] = std::minmax({a.x, b.x, c.x});
    const auto [south, north] = std::minmax({a.y, b.y, c.y});
    const bool is_in_cell = east - west <= x_.step && north - south <= y_.step;
    if (is_in_cell && a.is_post && b.is_post && c.is_post) return;
    const Wide first = std::max<Wide>(ceil_divide(south, y_.step), 0);
    const Wide last = std::min<Wide>(floor_divide(north, y_.step), y_.posts - Wide{1});
    for (Wide row = first; row <= last; ++row) add_row(a, b, c, static_cast<int64_t>(row));
  }

  // Takes the edge from `a` to `b` into account, but for posts at its ends.
  void add(const End& a, const End& b) {
    const bool is_slanted = a.x != b.x && a.y != b.y;
    if (a.is_post && b.is_post && !is_slanted) return;  // linear from post to post
    const bool is_diagonal = std::abs(b.x - a.x) == x_.step && std::abs(b.y - a.y) == y_.step;
    if (a.is_post && b.is_post && is_diagonal) {
      compare(a, b, 0, parts(a, b), std::min(a.x, b.x) / x_.step, std::min(a.y, b.y) / y_.step);
      return;
    }
    const std::vector<int64_t>& stops = stops_along(a, b);
    for (size_t i = 1; i < stops.size(); ++i) add_piece(a, b, stops[i - 1], stops[i]);
  }

  bool has_far_post() const { return has_far_post_; }

 private:
  // The square of an edge's parts, times those of a cell, is at most 2^83. 0: the axes are too
  // large.
  static int64_t most_parts(const PostAxis& x, const PostAxis& y) {
    if (!x.is_small || !y.is_small) return 0;
    const Wide most = (Wide{1} << 83) / (Wide{x.step} * y.step);
    int64_t parts = 0;
    for (int bit = 40; bit >= 0; --bit) {
      const int64_t more = parts | int64_t{1} << bit;
      if (Wide{more} * more <= most) parts = more;
    }
    return parts;
  }

  static int64_t turn(const End& a, const End& b, int64_t x, int64_t y) {
    return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
  }

  std::optional<PostHeights::Rounded> exact(int64_t number) {
    const auto post = posts_.exact(number);
    has_far_post_ = has_far_post_ || !post;
    return post;
  }

  // The columns of a row from which all three edges are to the left or on the place.
  void add_row(const End& a, const End& b, const End& c, int64_t row) {
    const int64_t y = row * y_.step;
    Wide first = 0, last = x_.posts - Wide{1};
    for (const auto& [from, to] : {std::pair(&a, &b), std::pair(&b, &c), std::pair(&c, &a)}) {
      // turn = at_0 - slope * step * column >= 0
      const Wide at_0 = turn(*from, *to, 0, y), slope = Wide{to->y - from->y} * x_.step;
      if (slope > 0) last = std::min(last, floor_divide(at_0, slope));
      if (slope < 0) first = std::max(first, ceil_divide(-at_0, -slope));
      if (slope == 0 && at_0 < 0) return;
    }
    for (Wide column = first; column <= last; ++column) {
      add_post(a, b, c, static_cast<int64_t>(column), row);
    }
  }

  void add_post(const End& a, const End& b, const End& c, int64_t column, int64_t row) {
    const int64_t number = posts_.number_at(column, row);
    if (number == kVoidHeight) return;
    const int64_t x = column * x_.step, y = row * y_.step, area = turn(a, b, c.x, c.y);
    const int64_t of_c = turn(a, b, x, y), of_b = turn(c, a, x, y);
    if (of_b + of_c == 0 || of_b == area || of_c == area) return;  // at a corner
    const double below = posts_.near(number) - static_cast<double>(a.z) -
                         (static_cast<double>(of_c) * static_cast<double>(c.z - a.z) +
                          static_cast<double>(of_b) * static_cast<double>(b.z - a.z)) /
                             static_cast<double>(area);
    if (!record_.may_exceed(column, row, below, -below, posts_.slack())) return;
    const auto post = exact(number);
    if (!post) return;
    const Wide above_a = Wide{of_c} * (c.z - a.z) + Wide{of_b} * (b.z - a.z);
    record_.add_post(column, row, ceil_divide((post->high - a.z) * area - above_a, area),
                     ceil_divide(above_a - (post->low - a.z) * area, area));
  }

  // Places along an edge are counted in this many parts of it, so that all lines meet it at whole
  // numbers.
  static int64_t parts(const End& a, const End& b) {
    return std::max(std::abs(b.x - a.x), int64_t{1}) * std::max(std::abs(b.y - a.y), int64_t{1});
  }

  // Both ends, and where the edge crosses the lines of columns and rows.
  const std::vector<int64_t>& stops_along(const End& a, const End& b) {
    const int64_t all = parts(a, b);
    stops_ = {0, all};
    const auto add_lines = [&](int64_t from, int64_t to, int64_t step) {
      if (from == to) return;
      const int64_t low = std::min(from, to), high = std::max(from, to);
      for (auto line = static_cast<int64_t>(ceil_divide(low, step)); line * step <= high; ++line) {
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

  void add_piece(const End& a, const End& b, int64_t from, int64_t to) {
    const Wide all = parts(a, b);
    // Twice the middle of the piece, times the parts; steps are multiplied alike.
    const Cells columns = cells_at(2 * a.x * all + (Wide{from} + to) * (b.x - a.x), x_.step * all);
    const Cells rows = cells_at(2 * a.y * all + (Wide{from} + to) * (b.y - a.y), y_.step * all);
    for (int before = 0; before < 4; ++before) {
      if (((before & 1) != 0 && !columns.also_before) || ((before & 2) != 0 && !rows.also_before)) {
        continue;
      }
      const Wide column = columns.first - (before & 1), row = rows.first - (before >> 1);
      if (compare(a, b, from, to, static_cast<int64_t>(column), static_cast<int64_t>(row))) return;
    }
  }

  // Whether the cell has four posts with heights. On a line between two cells both are the same.
  bool compare(const End& a, const End& b, int64_t from, int64_t to, int64_t column, int64_t row) {
    if (column < 0 || row < 0 || column + 1 >= x_.posts || row + 1 >= y_.posts) return false;
    std::array<int64_t, 4> numbers{};
    for (uint32_t corner = 0; corner < 4; ++corner) {
      numbers[corner] = posts_.number_at(column + corner % 2, row + corner / 2);
      if (numbers[corner] == kVoidHeight) return false;
    }
    if (!may_exceed(a, b, from, to, column, row, numbers)) return true;
    std::array<Wide, 4> low{}, high{};
    for (uint32_t corner = 0; corner < 4; ++corner) {
      const auto post = exact(numbers[corner]);
      if (!post) return false;
      low[corner] = post->low;
      high[corner] = post->high;
    }
    record_.add_cell(column, row, most(a, b, from, to, column, row, high, 1),
                     most(a, b, from, to, column, row, low, -1));
    return true;
  }

  // Whether a piece of an edge may be farther from the posts' surface than all before: at its ends,
  // or by the bulge of the parabola between them, which is at most a quarter of K.
  bool may_exceed(const End& a, const End& b, int64_t from, int64_t to, int64_t column, int64_t row,
                  const std::array<int64_t, 4>& numbers) const {
    const int64_t flat_twist = numbers[0] - numbers[1] - numbers[2] + numbers[3];
    if (flat_twist == 0 && a.is_post && b.is_post && to - from == parts(a, b)) return false;
    const double all = static_cast<double>(parts(a, b)), p = posts_.near(numbers[0]);
    const double east = posts_.near(numbers[1]) - p, north = posts_.near(numbers[2]) - p;
    const double twist = posts_.near(numbers[3]) - p - east - north;
    const double columns = static_cast<double>(b.x - a.x) / static_cast<double>(x_.step),
                 rows = static_cast<double>(b.y - a.y) / static_cast<double>(y_.step);
    const double x = static_cast<double>(a.x) / static_cast<double>(x_.step) -
                     static_cast<double>(column),
                 y = static_cast<double>(a.y) / static_cast<double>(y_.step) -
                     static_cast<double>(row);
    const double rise = static_cast<double>(b.z - a.z), base = p - static_cast<double>(a.z);
    const auto difference = [&](int64_t n) {
      const double t = static_cast<double>(n) / all, u = x + t * columns, v = y + t * rows;
      return base + u * east + v * north + u * v * twist - t * rise;
    };
    const double f = difference(from), g = difference(to);
    const double length = static_cast<double>(to - from) / all;
    const double bulge = columns * rows * twist * length * length / 4;
    const double range =
        std::abs(base) + std::abs(rise) + std::abs(east) + std::abs(north) + std::abs(twist);
    return record_.may_exceed(column, row, std::max(f, g) + std::max(-bulge, 0.0),
                              std::max(-f, -g) + std::max(bulge, 0.0),
                              posts_.slack() + std::ldexp(range, -22));
  }

  // The most that the bilinear surface is above the edge (sign 1), or below it (-1), on a piece of
  // the edge that lies in a cell, rounded up. Along it the difference is a parabola: from f at its
  // beginning to g at its end, with the bulge K t (1 - t).
  Wide most(const End& a, const End& b, Wide from, Wide to, Wide column, Wide row,
            const std::array<Wide, 4>& posts, int sign) const {
    const Wide all = parts(a, b), cell = Wide{x_.step} * y_.step,
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

  PostAxis x_, y_;
  PostHeights posts_;
  int64_t most_parts_;  // of an edge
  std::vector<int64_t> stops_;
  Record& record_;
  bool has_far_post_ = false;  // beyond kHighest: no distance is known
};

Decimal decimal_of(Wide units, const Axis& z) {
  const Wide numerator = units * static_cast<Wide>(z.numerator);
  const Wide divisor = kUnits * static_cast<Wide>(z.denominator);
  const WholeAndRest split = multiply_divide(power_of_ten(kMaxDecimals), numerator, divisor);
  return make_decimal_up(split.whole + (split.rest != 0 ? 1 : 0), kMaxDecimals);
}

// Whether all was compared: exact arithmetic holds the numbers.
template <class Record>
bool compare_all(const microtin_mesh* mesh, const Placement& lattice, const Raster& raster,
                 Record& record) {
  if (is_sparse(raster)) return false;
  Comparison<Record> comparison(lattice, raster, record);
  std::vector<bool> is_compared(microtin_mesh_vertex_count(mesh));
  const uint32_t triangles = microtin_mesh_triangle_count(mesh);
  for (uint32_t t = 0; t < triangles; ++t) {
    uint32_t v[3];
    if (microtin_mesh_triangle(mesh, t, v) != MICROTIN_TRIANGLE_REAL) continue;
    const std::array<End, 3> ends = {comparison.end_of(vertex_of(mesh, v[0])),
                                     comparison.end_of(vertex_of(mesh, v[1])),
                                     comparison.end_of(vertex_of(mesh, v[2]))};
    for (uint32_t i = 0; i < 3; ++i) {
      const End &from = ends[i], &to = ends[(i + 1) % 3];
      if (!comparison.is_exact(from, to)) return false;
      if (!is_compared[v[i]]) comparison.add_vertex(from);
      is_compared[v[i]] = true;
      uint32_t unused[3];
      const uint32_t other = microtin_mesh_neighbour(mesh, t, i);
      const bool is_shared = microtin_mesh_triangle(mesh, other, unused) == MICROTIN_TRIANGLE_REAL;
      if (!is_shared || t < other) comparison.add(from, to);  // an edge counts once
    }
    comparison.add_posts(ends[0], ends[1], ends[2]);
  }
  return !comparison.has_far_post();
}

}  // namespace

std::optional<Gap> measure_gap(const microtin_mesh* mesh, const Placement& lattice,
                               const Raster& raster) {
  Largest largest;
  if (!compare_all(mesh, lattice, raster, largest)) return std::nullopt;
  return largest.gap();
}

int64_t allowed_in_cell(const Allowed& allowed, std::size_t post, std::size_t width) {
  const std::vector<int64_t>& all = allowed.distances;
  return std::max({all[post], all[post + 1], all[post + width], all[post + width + 1]});
}

std::optional<std::vector<Excess>> measure_excess(const microtin_mesh* mesh,
                                                  const Placement& lattice, const Raster& raster,
                                                  const Allowed& allowed) {
  ExcessAtPosts excess(raster, allowed);
  if (!compare_all(mesh, lattice, raster, excess)) return std::nullopt;
  return excess.take();
}

std::optional<Distances> measure_everywhere(const microtin_mesh* mesh, const Placement& lattice,
                                            const Raster& raster) {
  const std::optional<Gap> gap = measure_gap(mesh, lattice, raster);
  if (!gap) return std::nullopt;
  return Distances{decimal_of(gap->below, lattice.z), decimal_of(gap->above, lattice.z)};
}

Margins margins_of(const std::optional<Gap>& gap) {
  if (!gap) return {};
  const Wide below = ceil_divide(gap->below, kSixteenth),
             above = ceil_divide(gap->above, kSixteenth);
  if (std::max(below, above) > kMarginMost) return {};
  return {static_cast<uint32_t>(below), static_cast<uint32_t>(above)};
}

std::optional<Distances> stated_everywhere(const Margins& margins, const Axis& z) {
  if (!is_stated(margins)) return std::nullopt;
  return Distances{decimal_of(margins.below * kSixteenth, z),
                   decimal_of(margins.above * kSixteenth, z)};
}

}  // namespace microtin::verifying
