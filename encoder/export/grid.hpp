// SPDX-License-Identifier: MIT
// Writing surfaces as ESRI ASCII grids.
#ifndef MICROTIN_ENCODER_EXPORT_GRID_HPP
#define MICROTIN_ENCODER_EXPORT_GRID_HPP

#include <optional>

#include "encoder/exact/decimal.hpp"
#include "encoder/export/height_sampler.hpp"
#include "encoder/files/output_file.hpp"
#include "encoder/layers.hpp"

namespace microtin::exporting {

// Posts of a grid of the lattice's places.
uint64_t lattice_posts(const SampledSurface& surface);

// Heights from the surface's south-west corner on, in steps of `cell` > 0 in its unit; without, at
// the lattice's places. Each is that of its place, rounded to 1/256 of a lattice step, with three
// decimals more than the step of heights has, but at most nine. Corner and cell size have all their
// decimals, or 12, which import_asc reads as the fraction they stand for. Posts without a height
// get a NODATA_value below all others. Throws Error if the cells do not fit a grid, or the surface
// cannot be asked.
void export_grid(const SampledSurface& surface, const std::optional<Decimal>& cell,
                 OutputFile& out);

}  // namespace microtin::exporting

#endif
