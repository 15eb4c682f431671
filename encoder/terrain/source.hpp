// SPDX-License-Identifier: MIT
// A terrain as it was read: exact decimals, not yet on the lattice.
#ifndef MICROTIN_ENCODER_TERRAIN_SOURCE_HPP
#define MICROTIN_ENCODER_TERRAIN_SOURCE_HPP

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/metadata.hpp"

namespace microtin::terrain {

// A raster's height at a post that has none, and at a place of its lattice where no post is; of all
// other numbers the largest magnitude.
constexpr int64_t kVoidHeight = std::numeric_limits<int64_t>::min();
constexpr int64_t kNoPost = kVoidHeight + 1;
constexpr int64_t kLargestNumber = 1000000000000000000;

constexpr bool is_height(int64_t number) {
  return number > kNoPost;
}

// What the file format implies, or what is requested instead.
struct Reference {
  Unit horizontal_unit = Unit::kUnknown;
  Unit vertical_unit = Unit::kUnknown;
  uint32_t horizontal_epsg = 0;
  uint32_t vertical_epsg = 0;
  std::string wkt = {};  // of the horizontal system, where it has no code
  // Names of units that streams do not have, where they are stated: they are converted, or refused.
  std::string horizontal_other = {}, vertical_other = {};
  bool one_unit = false;    // requested: heights have the unit of places, if that is a length
  bool depths = false;      // heights grow downwards
  std::string unread = {};  // why the file that says its system is not read; empty: it is, or none
  std::vector<std::string> warnings = {};  // sentences for people: what was overridden or converted
  SourceNotes notes = {};                  // what the file states about itself
};

// Posts that were void when they were read and have a height nevertheless.
struct Mended {
  uint64_t filled = 0;                              // interpolated
  uint64_t flooded = 0;                             // at the water level
  uint64_t obstacles = 0, obstacles_elsewhere = 0;  // that raise posts, or touch none with a height

  void add(const Mended& others) {
    filled += others.filled;
    flooded += others.flooded;
    obstacles += others.obstacles;
    obstacles_elsewhere += others.obstacles_elsewhere;
  }
};

struct Raster {
  uint32_t width = 0;
  uint32_t height = 0;
  std::vector<int64_t> heights;  // times 10^-decimals; row by row, row 0 southernmost
  int decimals = 0;
  Axis x{0, 1, 1}, y{0, 1, 1};  // from a post's column and row to where its centre lies
  Reference reference;
  std::string selection = {};  // how it was put together of files, for the user; empty: it was not
  Mended mended = {};          // of its posts
  // Neighbouring posts are at most this many columns and rows apart. 1: a post is at every place.
  uint32_t x_spacing = 1, y_spacing = 1;
  OwnBounds bounds = {};
};

// Whether there are places without a post.
inline bool is_sparse(const Raster& raster) {
  return raster.x_spacing > 1 || raster.y_spacing > 1;
}

struct SourcePoint {
  int64_t x, y;  // times 10^-xy_decimals
  int64_t z;     // times 10^-z_decimals
};

// How many points of each class there are, but for those that are withheld.
struct ClassCounts {
  std::array<uint64_t, 256> points{};
  uint64_t withheld = 0;
};

struct PointCloud {
  std::vector<SourcePoint> points;
  int xy_decimals = 0;
  int z_decimals = 0;
  Reference reference;
  std::string selection;            // which points of the file these are, for the user; empty: all
  std::optional<ClassSet> classes;  // that were taken, of files that have them
  ClassCounts counts;               // points of each class in such files, taken or not
  OwnBounds bounds;
};

using Source = std::variant<Raster, PointCloud>;

inline const Reference& reference_of(const Source& source) {
  return std::visit([](const auto& one) -> const Reference& { return one.reference; }, source);
}

// Decimals of its heights.
inline int height_decimals(const Source& source) {
  const auto* raster = std::get_if<Raster>(&source);
  return raster != nullptr ? raster->decimals : std::get<PointCloud>(source).z_decimals;
}

// The number that stands for a height, if there is one: with this many decimals.
inline std::optional<int64_t> number_of(const std::optional<Decimal>& height, int decimals) {
  if (!height || height->decimals > decimals) return std::nullopt;
  const Wide number = mantissa_at(*height, decimals);
  if (magnitude(number) > kLargestNumber) return std::nullopt;
  return static_cast<int64_t>(number);
}

// Gives a number more decimals: `factor` is a power of ten. False if it is too large for them.
inline bool refine(int64_t& number, int64_t factor) {
  if (magnitude(number) > kLargestNumber / factor) return false;
  number *= factor;
  return true;
}

// Refines all heights of a raster that are not void.
inline bool refine(std::vector<int64_t>& heights, int64_t factor) {
  for (int64_t& height : heights) {
    if (is_height(height) && !refine(height, factor)) return false;
  }
  return true;
}

// From the numbers of a source (posts: column, row, height) to real coordinates.
inline Placement placement_of(const Source& source) {
  if (const auto* raster = std::get_if<Raster>(&source)) {
    return {raster->x, raster->y, decimal_axis(raster->decimals)};
  }
  const auto& cloud = std::get<PointCloud>(source);
  const Axis xy = decimal_axis(cloud.xy_decimals);
  return {xy, xy, decimal_axis(cloud.z_decimals)};
}

inline uint64_t void_posts(const Raster& raster) {
  return static_cast<uint64_t>(
      std::count(raster.heights.begin(), raster.heights.end(), kVoidHeight));
}

// Posts with a height.
inline uint64_t posts_with_height(const Raster& raster) {
  return static_cast<uint64_t>(
      std::count_if(raster.heights.begin(), raster.heights.end(), is_height));
}

inline PostGrid posts_of(const Raster& frame) {
  return {frame.width, frame.height, frame.x, frame.y};
}

inline const OwnBounds& bounds_of(const Source& source) {
  return std::visit([](const auto& one) -> const OwnBounds& { return one.bounds; }, source);
}

// Calls visit(x, y, z, number) for every post, void ones too, or point: the numbers that
// placement_of places, and which of the source's heights it is.
template <class Visit>
void for_each_numbered_post(const Source& source, const Visit& visit) {
  size_t number = 0;
  if (const auto* raster = std::get_if<Raster>(&source)) {
    for (uint32_t row = 0; row < raster->height; ++row) {
      for (uint32_t column = 0; column < raster->width; ++column, ++number) {
        const int64_t z = raster->heights[number];
        if (z != kNoPost) visit(int64_t{column}, int64_t{row}, z, number);
      }
    }
  } else {
    for (const SourcePoint& p : std::get<PointCloud>(source).points) visit(p.x, p.y, p.z, number++);
  }
}

// Calls visit(x, y, z) for each of these.
template <class Visit>
void for_each_post(const Source& source, const Visit& visit) {
  for_each_numbered_post(source, [&](int64_t x, int64_t y, int64_t z, size_t) { visit(x, y, z); });
}

}  // namespace microtin::terrain

#endif
