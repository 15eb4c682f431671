// SPDX-License-Identifier: MIT
// Narrows the limits of posts until a surface lies between two bilinear ones.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/exact/wide.hpp"
#include "encoder/terrain/own_bounds.hpp"
#include "encoder/verify/everywhere.hpp"

namespace microtin::verifying {
namespace {

constexpr int64_t kOneStep = 65536;                   // of heights
constexpr int64_t kBeyondLattice = int64_t{1} << 41;  // units: more than all heights are apart
constexpr int64_t kRounding = 2;                      // units by which distances may be too large

[[noreturn]] void refuse(const std::string& why, const std::string& remedy) {
  throw Error(parameter("bound_at") + " everywhere " + why + "; " + remedy);
}

int32_t in_steps(Wide units) {
  return static_cast<int32_t>(std::clamp<Wide>(units, std::numeric_limits<int32_t>::min() + 1,
                                               std::numeric_limits<int32_t>::max()));
}

// The bounds of posts, rounded down; those of posts without one are larger than all distances.
std::vector<int64_t> allowed_at_posts(const Raster& raster, const Decimal& max_error,
                                      const LatticeMap& to_steps) {
  const BoundOf bound_of(raster.bounds, max_error, kMaxDecimals);
  const Wide parts = to_steps.step * exact::power_of_ten(kMaxDecimals - raster.decimals);
  std::vector<int64_t> allowed(raster.heights.size(), kBeyondLattice);
  for (std::size_t post = 0; post < allowed.size(); ++post) {
    const Wide bound = bound_of(post);
    if (bound == BoundOf::kNone) continue;
    const auto [whole, rest] = exact::multiply_divide(bound * kOneStep, to_steps.scale, parts);
    allowed[post] = static_cast<int64_t>(std::min<Wide>(whole, kBeyondLattice));
  }
  return allowed;
}

bool is_one_post(const Axis& lattice, const Axis& source) {
  const LatticeMap map = map_between(source, lattice);
  return map.scale == map.step && map.shift == 0;
}

// The bend of the cell to the north-east of a post: the sum of the heights at the ends of the
// diagonal from there, less those at the others. 0 if one of its posts is void. Numbers are below
// 2^61.
int64_t bend_of_cell(const Raster& surface, std::size_t post) {
  const int64_t* const south = &surface.heights[post];
  const int64_t a = south[0], b = south[1], c = south[surface.width], d = south[surface.width + 1];
  if (a == kVoidHeight || b == kVoidHeight || c == kVoidHeight || d == kVoidHeight) return 0;
  return a - b - c + d;
}

// How far one end of a line must be from a bound, so that a line that bulges towards it, by a
// parabola of `bulge` in the middle, stays within. The other end can be `other_end` from it.
int64_t room_for(int64_t bulge, int64_t other_end) {
  if (other_end >= bulge) return bulge;
  const double missing = 2 * std::sqrt(static_cast<double>(bulge)) -
                         std::sqrt(static_cast<double>(std::max<int64_t>(other_end, 0)));
  return static_cast<int64_t>(std::ceil(missing * missing)) + 1;
}

}  // namespace

Bend most_bent(const Raster& raster) {
  Bend most;
  int64_t by = 0;
  for (uint32_t row = 0; row + 1 < raster.height; ++row) {
    for (uint32_t column = 0; column + 1 < raster.width; ++column) {
      const int64_t bend = std::abs(bend_of_cell(raster, std::size_t{row} * raster.width + column));
      if (bend <= by) continue;
      by = bend;
      most = {column, row, make_decimal(bend, raster.decimals)};
    }
  }
  return most;
}

// Between posts a surface is farther off. On mountains and fractals, one fitted within this part of
// the bound takes the fewest bytes once that is mended.
LatticeOptions first_fit(const LatticeOptions& options) {
  constexpr int kHundredths = 85, kDecimals = 2;
  LatticeOptions fitted = options;
  if (!is_bound_everywhere(options)) return fitted;
  Decimal& bound = *fitted.max_error;
  if (bound.decimals + kDecimals > kMaxDecimals) return fitted;
  bound = make_decimal(Wide{bound.mantissa} * kHundredths, bound.decimals + kDecimals);
  return fitted;
}

void expect_equal_distances(const Raster& raster) {
  if (!is_sparse(raster)) return;
  refuse("is for rasters whose posts are at equal distances, and these are not",
         "use " + parameter("bound_at") + " points");
}

// Two triangles with the heights of a bent cell's posts are on one side of it: a bound on both
// sides is larger than a quarter of what it bends, one on one side may have to be twice as large.
void refuse_everywhere(const Raster& raster, const LatticeOptions& options, uint64_t missed) {
  const Bend bend = most_bent(raster);
  const Wide quarter = Wide{bend.by.mantissa} * 25, parts = options.never_below ? 2 : 1;
  const Decimal enough = make_decimal(quarter * parts, bend.by.decimals + 2);
  throw Error(parameter("max_error") + ' ' + to_string(*options.max_error) +
              " cannot be kept everywhere: it is missed around " + std::to_string(missed) +
              " posts. The cell from x " + CoordinateText(raster.x)(bend.column) + ", y " +
              CoordinateText(raster.y)(bend.row) + " bends by " + to_string(bend.by) +
              " between its posts; use " +
              (*options.max_error <= enough
                   ? "more than " + to_string(enough)
                   : "a smaller " + parameter("z_step") + ", a larger bound") +
              ", or " + parameter("bound_at") + " points");
}

EverywhereBound::EverywhereBound(const Raster& raster, const LatticeOptions& options,
                                 const Placement& lattice)
    : raster_(raster),
      lattice_(lattice),
      to_steps_(map_between(decimal_axis(raster.decimals), lattice.z)) {
  expect_equal_distances(raster);
  if (!is_one_post(lattice.x, raster.x) || !is_one_post(lattice.y, raster.y)) {
    refuse("keeps the positions of posts", "leave out " + parameter("xy_step"));
  }
  allowed_ = {allowed_at_posts(raster, *options.max_error, to_steps_), options.never_below};
}

// Ties are broken so that the two triangles of a cell whose posts are vertices share the diagonal
// from its south-eastern post to its north-western one. Along it they are above or below the
// bilinear surface by a parabola of up to a quarter of what the cell bends, so the ends of this
// diagonal must be nearer on that side than the cell allows. Where the post's own bound is less,
// the other end makes up for it. A step of heights lies within the limits, unless two cells
// contradict.
Tightening EverywhereBound::vertex_limits(std::size_t post) const {
  const std::size_t width = raster_.width, column = post % width, row = post / width;
  const auto least = [&](int64_t distance) { return allowed_.never_below ? 0 : -distance; };
  const int64_t own = allowed_.distances[post];
  int64_t above = own, below = least(own);
  const auto keep_to_cell = [&](std::size_t cell, std::size_t other) {
    const Wide bend = bend_of_cell(raster_, cell);
    const auto quarter = static_cast<int64_t>(std::min<Wide>(
        ceil_divide(magnitude(bend) * to_steps_.scale * kOneStep, to_steps_.step * 4),
        kBeyondLattice));
    const int64_t allowed = allowed_in_cell(allowed_, cell, width),
                  other_end = allowed_.distances[other] - kOneStep;
    if (bend > 0) {
      below = std::max(below, least(allowed) + room_for(quarter, other_end - least(allowed)));
    } else {
      above = std::min(above, allowed - room_for(quarter, allowed - least(other_end)));
    }
  };
  if (column != 0 && row + 1 < raster_.height) keep_to_cell(post - 1, post - 1 + width);
  if (column + 1 < width && row != 0) keep_to_cell(post - width, post + 1 - width);
  below = std::min(below, own - kOneStep - 2 * kRounding);
  above = std::max(above, least(own) + kOneStep + 2 * kRounding);
  const Wide height = to_steps_.numerator(raster_.heights[post]) * kOneStep;
  const Wide lowest = ceil_divide(height, to_steps_.step) + below + kRounding,
             highest = floor_divide(height, to_steps_.step) + above - kRounding;
  const Wide middle = (lowest + highest) / 2;
  return {{static_cast<uint16_t>(column), static_cast<uint16_t>(row)},
          in_steps(lowest > highest ? middle : lowest),
          in_steps(lowest > highest ? middle : highest),
          true};
}

void EverywhereBound::narrow(std::size_t post, int32_t here, Excess excess) {
  Tightening limits = vertex_limits(post);
  if (limits_.count(post) == 0) {  // else narrower limits were in vain
    const auto more = [](int64_t by) { return Wide{by} + by / 4 + kRounding; };
    limits = {limits.place, std::numeric_limits<int32_t>::min(),
              std::numeric_limits<int32_t>::max()};
    if (excess.below != 0) limits.lowest = in_steps(here + more(excess.below));
    if (excess.above != 0) limits.highest = in_steps(here - more(excess.above));
  }
  limits_[post] = limits;
}

uint64_t EverywhereBound::see(const microtin_mesh* mesh) {
  const auto excess = measure_excess(mesh, lattice_, raster_, allowed_);
  if (!excess) {
    refuse("cannot be computed for heights of so many digits",
           "use " + parameter("bound_at") + " points");
  }
  uint64_t missed = 0;
  uint32_t hint = 0;
  for (std::size_t post = 0; post < excess->size(); ++post) {
    const Excess one = (*excess)[post];
    if (one.below == 0 && one.above == 0) continue;
    ++missed;
    const auto place = [](std::size_t at) { return static_cast<int32_t>(at * 256); };
    const int32_t x = place(post % raster_.width), y = place(post / raster_.width);
    int32_t here = 0;
    if (microtin_mesh_height_at(mesh, x, y, &hint, &here, 0, 0) == MICROTIN_QUERY_OK) {
      narrow(post, here, one);
    }
  }
  return missed;
}

std::vector<Tightening> EverywhereBound::tightenings() const {
  std::vector<Tightening> all;
  all.reserve(limits_.size());
  for (const auto& entry : limits_) all.push_back(entry.second);
  std::sort(all.begin(), all.end(),
            [](const Tightening& a, const Tightening& b) { return a.place < b.place; });
  return all;
}

}  // namespace microtin::verifying
