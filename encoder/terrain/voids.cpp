// SPDX-License-Identifier: MIT
// Voids of a raster: how they are filled, and heights that mark voids without a declaration.
#include "encoder/terrain/voids.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/terrain/degrees.hpp"

namespace microtin::terrain {
namespace {

// Calls visit(index) for the posts next to post `index`, void ones too, in its row and column.
template <class Visit>
void for_each_neighbour(const Raster& raster, size_t index, const Visit& visit) {
  const size_t column = index % raster.width, row = index / raster.width;
  const auto look = [&](size_t places, uint32_t spacing, size_t stride, bool is_down) {
    for (size_t away = 1; away <= std::min<size_t>(places, spacing); ++away) {
      const size_t post = is_down ? index - away * stride : index + away * stride;
      if (raster.heights[post] != kNoPost) return visit(post);
    }
  };
  look(column, raster.x_spacing, 1, true);
  look(raster.width - 1 - column, raster.x_spacing, 1, false);
  look(row, raster.y_spacing, raster.width, true);
  look(raster.height - 1 - row, raster.y_spacing, raster.width, false);
}

// The void posts connected to `start`; marks them as seen.
std::vector<size_t> void_region(const Raster& raster, size_t start, std::vector<bool>& seen) {
  std::vector<size_t> region{start};
  seen[start] = true;
  for (size_t i = 0; i < region.size(); ++i) {
    for_each_neighbour(raster, region[i], [&](size_t post) {
      if (raster.heights[post] != kVoidHeight || seen[post]) return;
      seen[post] = true;
      region.push_back(post);
    });
  }
  return region;
}

// A void post whose height is sought, relative to some height near by.
struct Unknown {
  double height = 0;
  double rim_sum = 0;           // of the known neighbours
  int neighbours = 0;           // known or not
  std::vector<size_t> unknown;  // neighbours, by their number in the region
};

std::vector<Unknown> equations(const Raster& raster, const std::vector<size_t>& region,
                               int64_t base) {
  std::vector<Unknown> unknowns(region.size());
  for (size_t i = 0; i < region.size(); ++i) {
    Unknown& u = unknowns[i];
    for_each_neighbour(raster, region[i], [&](size_t post) {
      ++u.neighbours;
      if (raster.heights[post] != kVoidHeight) {
        u.rim_sum += static_cast<double>(raster.heights[post] - base);
      } else {
        const auto found = std::lower_bound(region.begin(), region.end(), post);
        u.unknown.push_back(static_cast<size_t>(found - region.begin()));
      }
    });
  }
  return unknowns;
}

// Successive over-relaxation. The factor is the best one for a square whose side has `extent`
// posts.
void solve(std::vector<Unknown>& unknowns, size_t extent) {
  constexpr double kNearEnough = 1.0 / 64;
  const double factor = 2 / (1 + std::sin(kPi / static_cast<double>(extent + 1)));
  for (size_t sweep = 0; sweep < 100 + 20 * extent; ++sweep) {
    double largest_change = 0;
    for (Unknown& u : unknowns) {
      double sum = u.rim_sum;
      for (const size_t i : u.unknown) sum += unknowns[i].height;
      const double change = factor * (sum / u.neighbours - u.height);
      u.height += change;
      largest_change = std::max(largest_change, std::abs(change));
    }
    if (largest_change < kNearEnough) return;
  }
}

// Some known height next to the region, or kVoidHeight if there is none.
int64_t rim_height(const Raster& raster, const std::vector<size_t>& region) {
  int64_t height = kVoidHeight;
  for (const size_t index : region) {
    for_each_neighbour(raster, index,
                       [&](size_t post) { height = std::max(height, raster.heights[post]); });
  }
  return height;
}

}  // namespace

void fill_voids(Raster& raster, uint32_t largest) {
  std::vector<bool> seen(raster.heights.size());
  for (size_t start = 0; start < raster.heights.size(); ++start) {
    if (raster.heights[start] != kVoidHeight || seen[start]) continue;
    std::vector<size_t> region = void_region(raster, start, seen);
    const int64_t base = region.size() <= largest ? rim_height(raster, region) : kVoidHeight;
    if (base == kVoidHeight) continue;
    std::sort(region.begin(), region.end());
    std::vector<Unknown> unknowns = equations(raster, region, base);
    const size_t rows = (region.back() - region.front()) / raster.width + 1;
    solve(unknowns, std::max(rows, region.size() / rows));
    for (size_t i = 0; i < region.size(); ++i) {
      raster.heights[region[i]] = base + std::llround(unknowns[i].height);
    }
    raster.mended.filled += region.size();
  }
}

bool reaches_side(const Raster& raster, const PostRectangle& inner, Sides sides, uint32_t largest) {
  std::vector<bool> seen(raster.heights.size());
  const auto is_there = [&](size_t index) {
    const size_t column = index % raster.width, row = index / raster.width;
    return (sides.west && column < raster.x_spacing) || (sides.south && row < raster.y_spacing) ||
           (sides.east && column + raster.x_spacing >= raster.width) ||
           (sides.north && row + raster.y_spacing >= raster.height);
  };
  for (uint32_t y = inner.y; y < inner.y + inner.height; ++y) {
    for (uint32_t x = inner.x; x < inner.x + inner.width; ++x) {
      const size_t start = size_t{y} * raster.width + x;
      if (raster.heights[start] != kVoidHeight || seen[start]) continue;
      const std::vector<size_t> region = void_region(raster, start, seen);
      if (region.size() <= largest && std::any_of(region.begin(), region.end(), is_there))
        return true;
    }
  }
  return false;
}

namespace {

// Rows of nines, and where the ranges of 16 and 32 bits end; those of floating point are no heights
// at all. 999 may be a height, -999 is far below any land.
bool is_usual(Decimal value) {
  constexpr int64_t kUsual[] = {-999,    -9999,       9999,        -99999,    99999,
                                -999999, 999999,      -32768,      -32767,    32767,
                                65535,   -2147483648, -2147483647, 2147483647};
  return value.decimals == 0 &&
         std::find(std::begin(kUsual), std::end(kUsual), value.mantissa) != std::end(kUsual);
}

std::string warning(const Extremes& heights, int decimals, const char* what,
                    const std::function<std::string(const std::string&)>& remedy) {
  const Extremes::Fill fill = heights.fill(decimals);
  if (fill.count == 0) return "";
  const std::string value = to_string(make_decimal(fill.value, decimals));
  return "taken as they are: " + std::to_string(fill.count) + ' ' + what +
         (fill.count == 1 ? "" : "s") + " of height " + value +
         ", far from all others; if they mark voids, " + remedy(value);
}

}  // namespace

void Extremes::End::add(int64_t number, uint64_t times) {
  if (count != 0 && number == first) {
    count += times;
    return;
  }
  if (count == 0 || number < first) {
    has_next = count != 0;
    next = first;
    first = number;
    count = times;
  } else if (!has_next || number < next) {
    has_next = true;
    next = number;
  }
}

void Extremes::add(int64_t number) {
  low_.add(number, 1);
  high_.add(-number, 1);
}

void Extremes::add(const Extremes& others) {
  for (const auto& [mine, theirs] : {std::pair(&low_, &others.low_), {&high_, &others.high_}}) {
    if (theirs->count != 0) mine->add(theirs->first, theirs->count);
    if (theirs->has_next) mine->add(theirs->next, 1);
  }
}

Extremes::Fill Extremes::fill(int decimals) const {
  // Whether an end is far off, seen as the low one: whether the next is farther from it than from
  // the other end.
  const auto is_far = [](const End& end, const End& other) {
    const Wide next = end.next;
    return end.has_next && next - end.first > -Wide{other.first} - next;
  };
  const Fill low{low_.first, low_.count}, high{-high_.first, high_.count};
  if (is_far(low_, high_) && is_usual(make_decimal(low.value, decimals))) return low;
  if (is_far(high_, low_) && is_usual(make_decimal(high.value, decimals))) return high;
  return {};
}

std::string warning_on_fill(const Extremes& posts, int decimals) {
  return warning(posts, decimals, "post", [](const std::string& value) {
    return "declare it: NODATA_value " + value +
           " in an .asc, NaN in an array, else \"gdal_translate -a_nodata " + value + "\"";
  });
}

std::string warning_on_fill(const Raster& raster) {
  Extremes heights;
  for (const int64_t height : raster.heights) {
    if (is_height(height)) heights.add(height);
  }
  return warning_on_fill(heights, raster.decimals);
}

std::string warning_on_fill(const PointCloud& cloud) {
  Extremes heights;
  for (const SourcePoint& point : cloud.points) heights.add(point.z);
  return warning(heights, cloud.z_decimals, "point",
                 [](const std::string&) { return "leave them out"; });
}

namespace {

// Writes all heights with at least this many decimals.
void refine(Raster& raster, int decimals) {
  if (decimals <= raster.decimals) return;
  if (!terrain::refine(raster.heights, power_of_ten(decimals - raster.decimals))) {
    throw Error("the water level has too many decimals for these heights; round it");
  }
  raster.decimals = decimals;
}

}  // namespace

void flood_voids(Raster& raster, Decimal level, const Raster* mask) {
  refine(raster, level.decimals);
  const std::optional<int64_t> height = number_of(level, raster.decimals);
  if (!height)
    throw Error("the water level is out of range; use a height near those of the terrain");
  for (size_t i = 0; i < raster.heights.size(); ++i) {
    if (raster.heights[i] != kVoidHeight) continue;
    if (mask != nullptr && mask->heights[i] != power_of_ten(mask->decimals)) continue;
    raster.heights[i] = *height;
    ++raster.mended.flooded;
  }
}

void check_water_mask(const Raster& mask, const Raster& raster) {
  if (mask.width != raster.width || mask.height != raster.height || !is_same(mask.x, raster.x) ||
      !is_same(mask.y, raster.y)) {
    throw Error(
        "its grid differs from the terrain's; it must have the same columns, rows and cells");
  }
  const int64_t one = power_of_ten(mask.decimals);
  const bool is_mask = std::all_of(mask.heights.begin(), mask.heights.end(), [&](int64_t value) {
    return value == 0 || value == one || value == kVoidHeight;
  });
  if (!is_mask) throw Error("a water mask contains only 0 and 1");
}

}  // namespace microtin::terrain
