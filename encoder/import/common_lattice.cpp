// SPDX-License-Identifier: MIT
// Divides the first raster's cells until every raster's posts have a place.
#include <numeric>
#include <optional>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/import/mosaic.hpp"

namespace microtin::importing {
namespace {

constexpr Wide kRounding = 1000000;  // parts of a cell
constexpr const char* kRemedy = ": bring all onto one grid with gdalwarp -tr -tap";

// "10 x 10"
std::string cells_of(const Raster& frame) {
  const auto step = [](const Axis& axis) {
    return CoordinateText({0, axis.numerator, axis.denominator})(1);
  };
  return step(frame.x) + " x " + step(frame.y);
}

// Converts numbers of one axis to those of another. Steps of axes are above 0, and so is the map's.
LatticeMap map_of(const Axis& from, const Axis& to) {
  const LatticeMap map = map_between(from, to);
  if (map.step <= 0) throw InternalFault("a grid has cells without a size; give them one");
  return map;
}

// The least number of parts of the first raster's cells, a multiple of `parts`, of which the cells
// of another raster are a whole number. Nothing if the cells have too many parts.
std::optional<Wide> parts_for_cells(const LatticeMap& map, Wide parts) {
  const Wide needed = map.step / greatest_common_divisor(map.scale, map.step);
  const Wide both = needed / greatest_common_divisor(needed, parts) * parts;
  if (both > kMostSpacing || map.scale * both / map.step > kMostSpacing) return std::nullopt;
  return both;
}

// The place of another raster's first post, where each cell of the first raster has `parts` parts.
// Nothing if the post lies between two places.
std::optional<int64_t> place_on(const LatticeMap& map, Wide parts) {
  const Wide shift = map.shift * parts, place = round_divide(shift, map.step);
  if (magnitude(shift - place * map.step) > map.step * parts / kRounding) return std::nullopt;
  return static_cast<int64_t>(place);
}

// The least multiple of `parts`, up to four times, that has a place for another raster's posts.
std::optional<Wide> parts_for_posts(const LatticeMap& map, Wide parts) {
  for (const Wide times : {1, 2, 3, 4}) {
    if (place_on(map, parts * times)) return parts * times;
  }
  return std::nullopt;
}

struct SharedAxis {
  Axis axis;
  std::vector<int64_t> first;
  std::vector<uint32_t> spacing;
};

Error too_different(size_t i, const std::vector<Raster>& frames,
                    const std::vector<std::string>& paths) {
  return Error(paths[i] + ": its cells are " + cells_of(frames[i]) + ", those of " + paths[0] +
               " are " + cells_of(frames[0]) + kRemedy);
}

SharedAxis shared_axis(const std::vector<Raster>& frames, const std::vector<std::string>& paths,
                       Axis Raster::*which) {
  const Axis& grid = frames[0].*which;
  Wide parts = 1;
  for (size_t i = 0; i < frames.size(); ++i) {
    const auto more = parts_for_cells(map_of(frames[i].*which, grid), parts);
    if (!more) throw too_different(i, frames, paths);
    parts = *more;
  }
  for (size_t i = 0; i < frames.size(); ++i) {
    const auto more = parts_for_posts(map_of(frames[i].*which, grid), parts);
    if (!more) throw Error(paths[i] + ": its posts lie between those of " + paths[0] + kRemedy);
    parts = *more;
  }
  SharedAxis shared;
  shared.axis = reduced_axis(grid.offset * parts, static_cast<Wide>(grid.numerator),
                             static_cast<Wide>(grid.denominator) * parts);
  for (size_t i = 0; i < frames.size(); ++i) {
    const LatticeMap map = map_of(frames[i].*which, grid);
    const Wide spacing = map.scale * parts / map.step;
    if (spacing > kMostSpacing) throw too_different(i, frames, paths);
    shared.first.push_back(*place_on(map, parts));
    shared.spacing.push_back(static_cast<uint32_t>(spacing));
  }
  return shared;
}

// How far posts of two grids are apart at least, in places of the lattice; 0 where posts or corners
// of cells go together.
int64_t shift_of(int64_t first, int64_t spacing, int64_t other_first, int64_t other_spacing) {
  const int64_t common = std::gcd(spacing, other_spacing), away = first - other_first;
  if ((2 * away - (spacing - other_spacing)) % (2 * common) == 0) return 0;
  const int64_t rest = away % common;
  return rest < 0 ? rest + common : rest;
}

std::string part_of_cell(int64_t places, int64_t spacing) {
  if (places == 0) return "0";
  const int64_t divisor = std::gcd(places, spacing);
  return std::to_string(places / divisor) + "/" + std::to_string(spacing / divisor);
}

}  // namespace

CommonLattice common_lattice(const std::vector<Raster>& frames,
                             const std::vector<std::string>& paths) {
  const SharedAxis x = shared_axis(frames, paths, &Raster::x);
  const SharedAxis y = shared_axis(frames, paths, &Raster::y);
  CommonLattice lattice{x.axis, y.axis, {}};
  for (size_t i = 0; i < frames.size(); ++i) {
    lattice.rasters.push_back({x.first[i], y.first[i], x.spacing[i], y.spacing[i]});
  }
  return lattice;
}

std::string warning_on_shift(const std::vector<PostPlaces>& rasters,
                             const std::vector<std::string>& paths) {
  const PostPlaces& grid = rasters[0];
  std::string text;
  uint64_t others = 0;
  for (size_t i = 1; i < rasters.size(); ++i) {
    const PostPlaces& r = rasters[i];
    const int64_t x = shift_of(r.x, r.x_spacing, grid.x, grid.x_spacing);
    const int64_t y = shift_of(r.y, r.y_spacing, grid.y, grid.y_spacing);
    if (x == 0 && y == 0) continue;
    if (!text.empty()) {
      ++others;
      continue;
    }
    text = paths[i] + ": its posts lie off those of " + paths[0] + ", by " +
           part_of_cell(x, r.x_spacing) + " of a cell in x and " + part_of_cell(y, r.y_spacing) +
           " in y; each is kept where it lies";
  }
  if (text.empty()) return text;
  if (others != 0) text += "; so do those of " + std::to_string(others) + " other files";
  return text + "; if a file is registered wrongly, move it with gdal_translate -a_ullr";
}

}  // namespace microtin::importing
