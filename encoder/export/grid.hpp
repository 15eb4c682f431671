// SPDX-License-Identifier: MIT
// Surfaces as ESRI ASCII grids: which posts they have, where these lie on the lattice, and the
// files.
#ifndef MICROTIN_ENCODER_EXPORT_GRID_HPP
#define MICROTIN_ENCODER_EXPORT_GRID_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/export/queries.hpp"
#include "encoder/files/output.hpp"
#include "encoder/layers.hpp"

namespace microtin::exporting {

// A rectangle in a surface's coordinates: west < east, south < north, with at most 12 decimals and
// magnitudes below 10^12.
struct Extent {
  Decimal west, south, east, north;
};

// Four such decimals, "WEST,SOUTH,EAST,NORTH"; nothing for any other text.
std::optional<Extent> parse_extent(const std::string& text);

// The surface's box, for people: "x 2 to 5, y -1 to 8".
std::string extent_text(const SampledSurface& surface);

// The lattice's places in the surface's box.
PostGrid lattice_grid(const SampledSurface& surface);

// Posts `cell` > 0 apart, from the south-west corner of the surface's box, or of an extent, on.
// Throws Error if they are more than 2^31 in a row or column, or if an axis cannot say where.
PostGrid grid_of_cells(const SampledSurface& surface, Decimal cell);
PostGrid grid_of_cells(const Extent& extent, Decimal cell);

// Those of a grid's posts, continued to all sides, that lie in the extent, which may be named a
// turn from the grid's own in degrees. Throws Error as above, and if there are none.
PostGrid posts_within(const PostGrid& grid, const Extent& extent, bool is_degrees);

// From posts of one axis to their places on the lattice.
class PostPlaces {
 public:
  // Places lie between `low` and `high` by any of the lattice's axes. No step is 0.
  PostPlaces(const Axis& posts, const std::vector<Axis>& names, int64_t low, int64_t high);

  // Exact (see coordinate_of); nothing if it is not between these.
  std::optional<RealCoordinate> operator()(int64_t post) const;

 private:
  struct Name {
    LatticeMap map;
    Axis axis;
  };
  std::vector<Name> names_;
  int64_t low_, high_;
};

// Places of a grid's columns and rows on a surface.
PostPlaces places_of_x(const SampledSurface& surface, const Axis& posts);
PostPlaces places_of_y(const SampledSurface& surface, const Axis& posts);

// If the box of the posts meets that of the surface.
bool meets(const SampledSurface& surface, const PostGrid& posts);

// At least as many bytes as export_grid writes.
double most_grid_bytes(const SampledSurface& surface, const PostGrid& posts);

// Heights at posts, which reach beyond the surface where they like. Each is that of the exact
// plane, rounded to three decimals more than the step of heights has, but at most nine. Corner and
// cell size have all their decimals, or 12, which import_asc reads as the fraction they stand for.
// Posts without a height get a NODATA_value below all others. Written post by post: memory is the
// surface's alone. Throws Error if the surface cannot be sampled.
void export_grid(const SampledSurface& surface, const PostGrid& posts, OutputFile& out);

}  // namespace microtin::exporting

#endif
