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

constexpr int64_t kOneStep = 65536;                // of heights
constexpr int64_t kMostNumber = int64_t{1} << 60;  // of heights, and of what is added to them
constexpr int64_t kRounding = 2;                   // units by which distances may be too large

[[noreturn]] void refuse_everywhere(const std::string& why, const std::string& remedy) {
  throw Error(parameter("bound_at") + " everywhere " + why + "; " + remedy);
}

int32_t in_steps(Wide units) {
  return static_cast<int32_t>(std::clamp<Wide>(units, std::numeric_limits<int32_t>::min() + 1,
                                               std::numeric_limits<int32_t>::max()));
}

// The raster's heights plus its bounds, or less them, or plus nothing.
Raster moved_by_bounds(const Raster& raster, const std::optional<Decimal>& max_error, int sign) {
  Raster surface = raster;
  surface.decimals = std::max(raster.decimals, max_error->decimals);
  const Wide scale = power_of_ten(surface.decimals - raster.decimals);
  const BoundOf bound_of(raster.bounds, max_error, surface.decimals);
  for (std::size_t i = 0; i < surface.heights.size(); ++i) {
    int64_t& number = surface.heights[i];
    if (number == kVoidHeight) continue;
    const Wide bound = bound_of(i), moved = number * scale + sign * bound;
    if (magnitude(moved) > kMostNumber) {
      refuse_everywhere("cannot be computed for heights and bounds of so many digits",
                        "use " + parameter("bound_at") + " points");
    }
    number = bound == BoundOf::kNone ? kVoidHeight : static_cast<int64_t>(moved);
  }
  return surface;
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
    : lattice_(lattice) {
  if (is_sparse(raster)) {
    refuse_everywhere("is for rasters whose posts are at equal distances, and these are not",
                      "use " + parameter("bound_at") + " points");
  }
  if (!is_one_post(lattice.x, raster.x) || !is_one_post(lattice.y, raster.y)) {
    refuse_everywhere("keeps the positions of posts", "leave out " + parameter("xy_step"));
  }
  lowest_ = moved_by_bounds(raster, options.max_error, options.never_below ? 0 : -1);
  highest_ = moved_by_bounds(raster, options.max_error, 1);
  to_steps_ = map_between(decimal_axis(lowest_.decimals), lattice.z);
}

// Along one diagonal of a bent cell two triangles are above the bilinear surface, along the other
// below it, by up to a quarter of the bend. The most that a cell bends at whose post this is, an
// end of the diagonal whose triangles miss the surface on that side.
int64_t EverywhereBound::bend_at(const Raster& surface, std::size_t post, Side side) const {
  const std::size_t width = surface.width, column = post % width, row = post / width;
  int64_t most = 0;
  for (const std::size_t x : {column, column + 1}) {
    for (const std::size_t y : {row, row + 1}) {
      if (x == 0 || y == 0 || x == width || y == surface.height) continue;
      const int64_t bend = bend_of_cell(surface, (y - 1) * width + x - 1);
      const bool ascends = (x == column) == (y == row);  // the diagonal that ends here
      const bool is_above = bend > 0;                    // triangles along the ascending one
      if ((ascends == is_above) == (side == Side::kAbove)) most = std::max(most, std::abs(bend));
    }
  }
  return most;
}

Tightening EverywhereBound::sure_limits(std::size_t post) const {
  const auto units = [&](const Raster& surface, Side side) {
    const bool is_below = side == Side::kBelow;
    const Wide bend = bend_at(surface, post, side);
    const Wide number = Wide{surface.heights[post]} * 4 + (is_below ? bend : -bend);
    const Wide numerator = (to_steps_.scale * number + to_steps_.shift * 4) * kOneStep;
    return in_steps(is_below ? ceil_divide(numerator, to_steps_.step * 4) + kRounding
                             : floor_divide(numerator, to_steps_.step * 4) - kRounding);
  };
  const auto width = static_cast<std::size_t>(lowest_.width);
  const Point place{static_cast<uint16_t>(post % width), static_cast<uint16_t>(post / width)};
  return {place, units(lowest_, Side::kBelow), units(highest_, Side::kAbove), true};
}

void EverywhereBound::narrow(std::size_t post, int32_t here, int64_t below, int64_t above) {
  const auto [found, is_new] = limits_.try_emplace(post, sure_limits(post));
  Tightening& limits = found->second;
  if (!is_new) {  // in vain: become what is sure
    limits = sure_limits(post);
    if (limits.lowest > limits.highest) {
      limits.lowest = limits.highest =
          static_cast<int32_t>((int64_t{limits.lowest} + limits.highest) / 2);
    }
    return;
  }
  limits = {limits.place, std::numeric_limits<int32_t>::min(), std::numeric_limits<int32_t>::max()};
  const auto more = [](int64_t by) { return Wide{by} + by / 4 + kRounding; };
  if (below != 0) limits.lowest = in_steps(here + more(below));
  if (above != 0) limits.highest = in_steps(here - more(above));
}

uint64_t EverywhereBound::see(const microtin_mesh* mesh) {
  const auto below = beyond(mesh, lattice_, lowest_, Side::kBelow),
             above = beyond(mesh, lattice_, highest_, Side::kAbove);
  if (!below || !above) {
    refuse_everywhere("cannot be computed for heights of so many steps",
                      "use " + parameter("bound_at") + " points");
  }
  uint64_t missed = 0;
  uint32_t hint = 0;
  for (std::size_t post = 0; post < below->size(); ++post) {
    if ((*below)[post] == 0 && (*above)[post] == 0) continue;
    ++missed;
    const std::size_t column = post % lowest_.width, row = post / lowest_.width;
    int32_t here = 0;
    const auto place = [](std::size_t at) { return static_cast<int32_t>(at * 256); };
    if (microtin_mesh_height_at(mesh, place(column), place(row), &hint, &here, 0, 0) ==
        MICROTIN_QUERY_OK) {
      narrow(post, here, (*below)[post], (*above)[post]);
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
