// SPDX-License-Identifier: MIT
// Narrows the limits of posts until a surface lies between two bilinear ones.
#include "encoder/verify/everywhere_bound.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <optional>
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

[[noreturn]] void refuse_everywhere(const std::string& why, const std::string& remedy) {
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

EverywhereBound::EverywhereBound(const Raster& raster, const LatticeOptions& options,
                                 const Placement& lattice)
    : raster_(raster),
      lattice_(lattice),
      to_steps_(map_between(decimal_axis(raster.decimals), lattice.z)) {
  if (is_sparse(raster)) {
    refuse_everywhere("is for rasters whose posts are at equal distances, and these are not",
                      "use " + parameter("bound_at") + " points");
  }
  if (!is_one_post(lattice.x, raster.x) || !is_one_post(lattice.y, raster.y)) {
    refuse_everywhere("keeps the positions of posts", "leave out " + parameter("xy_step"));
  }
  allowed_ = {allowed_at_posts(raster, *options.max_error, to_steps_), options.never_below};
}

// Along one diagonal of a bent cell two triangles are above the bilinear surface, along the other
// below it, by up to a quarter of the bend. An end of the diagonal whose triangles are on a side
// must be nearer on that side than the cell allows, by as much. The limits may be empty.
Tightening EverywhereBound::sure_limits(std::size_t post) const {
  const std::size_t width = raster_.width, column = post % width, row = post / width;
  int64_t below = allowed_.never_below ? 0 : allowed_.distances[post],
          above = allowed_.distances[post];
  for (const std::size_t x : {column, column + 1}) {
    for (const std::size_t y : {row, row + 1}) {
      if (x == 0 || y == 0 || x == width || y == raster_.height) continue;
      const std::size_t cell = (y - 1) * width + x - 1;
      const Wide bend = bend_of_cell(raster_, cell);
      const auto quarter = static_cast<int64_t>(std::min<Wide>(
          ceil_divide(magnitude(bend) * to_steps_.scale * kOneStep, to_steps_.step * 4),
          kBeyondLattice));
      const bool ascends = (x == column) == (y == row);  // the diagonal that ends here
      const int64_t allowed = allowed_in_cell(allowed_, cell, width);
      if (ascends == (bend > 0)) {
        above = std::min(above, allowed - quarter);
      } else {
        below = std::min(below, (allowed_.never_below ? 0 : allowed) - quarter);
      }
    }
  }
  const Wide height = to_steps_.numerator(raster_.heights[post]) * kOneStep;
  return {{static_cast<uint16_t>(column), static_cast<uint16_t>(row)},
          in_steps(ceil_divide(height, to_steps_.step) - below + kRounding),
          in_steps(floor_divide(height, to_steps_.step) + above - kRounding),
          true};
}

void EverywhereBound::narrow(std::size_t post, int32_t here, Excess excess) {
  Tightening limits = sure_limits(post);
  if (limits_.count(post) != 0) {  // narrower limits were in vain
    if (limits.lowest > limits.highest) {
      limits.lowest = limits.highest =
          static_cast<int32_t>((int64_t{limits.lowest} + limits.highest) / 2);
    }
  } else {
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
    refuse_everywhere("cannot be computed for heights of so many digits",
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
