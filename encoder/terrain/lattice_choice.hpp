// SPDX-License-Identifier: MIT
// Choosing the lattice for a source: steps and offsets.
#ifndef MICROTIN_ENCODER_TERRAIN_LATTICE_CHOICE_HPP
#define MICROTIN_ENCODER_TERRAIN_LATTICE_CHOICE_HPP

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/line_class.hpp"
#include "encoder/terrain/polygons.hpp"
#include "encoder/terrain/source.hpp"
#include "shared/lattice.hpp"

namespace microtin::terrain {

// Narrower limits at a place than the bound sets, or limits at one without points: lattice steps
// with 16 fractional bits.
struct Tightening {
  Point place;
  int32_t lowest, highest;
  bool is_vertex = false;  // the place must be one
};

// Where a bound holds: at posts, and at points where they truly lie; at the positions on the
// lattice alone, if that moves points; or between the posts of a raster, too, compared with their
// bilinear surface.
enum class BoundScope : uint8_t { kTruePlaces, kLattice, kEverywhere };

struct LatticeOptions {
  std::optional<Decimal> xy_step;    // in the source's unit; posts for rasters
  std::optional<Decimal> z_step;     // in the source's unit
  std::optional<Decimal> max_error;  // bound of the surface's distance from every height
  bool never_below = false;          // with a bound: the surface must not be below a height
  // No more decimals than the heights'. It is on the lattice, and with a bound the surface is at
  // this height exactly at posts of this height, and at no others.
  std::optional<Decimal> water_level = {};
  DuplicateRule duplicates = DuplicateRule::kMiddle;  // of points
  std::vector<Tightening> tightenings = {};           // by place
  std::vector<RealLine> breaklines = {};              // which become edges; with a bound
  std::vector<LineClass> line_classes = {};           // of each of them
  BoundScope bound_at = BoundScope::kTruePlaces;
};

// The maps take the source's numbers, refined to multiples of 10^-decimals, to the lattice.
struct Lattice {
  LatticeMap x, y, z;
  int xy_decimals, z_decimals;  // z_decimals are enough for max_error, too
  Placement placement;
};

// The numbers of a source along one axis.
struct NumberRange {
  int64_t low = std::numeric_limits<int64_t>::max();
  int64_t high = std::numeric_limits<int64_t>::min();
  int64_t spacing = 0;  // the greatest that divides all differences

  bool empty() const { return low > high; }
  void add(int64_t number);
  void add(const NumberRange& others);
};

// Without an option, a step is the source's own decimal step, or one post, if 16 bits hold the
// range then; else the finest of 2, 5, 10, 20, ... of these steps for which they do. The lattice
// holds the multiples of the step or, if all numbers lie off these by the same rest, those numbers;
// its integers are the multiples themselves (offset below one step) where they fit. Throws Error if
// an explicit step does not fit.
Lattice choose_lattice(const Source& source, const LatticeOptions& options);

// Chooses the lattice of a pack: places count from the lowest x and y, and 31 bits hold them.
// O(points), but for a copy of them.
Lattice choose_pack_lattice(const PointCloud& cloud, const LatticeOptions& options);

// Chooses the lattice for heights of that range; places are a raster's columns and rows, however
// many.
Lattice choose_post_lattice(const Raster& frame, const NumberRange& heights,
                            const LatticeOptions& options);

// The lattice whose heights are those of `z`, for a raster. Throws Error if it does not hold
// heights of that range, or if z is no lattice of decimal heights.
Lattice post_lattice_at(const Raster& frame, const NumberRange& heights, const Axis& z,
                        const LatticeOptions& options);

}  // namespace microtin::terrain

#endif
