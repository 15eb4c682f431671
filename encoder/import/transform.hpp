// SPDX-License-Identifier: MIT
// Where the cells of a raster lie that GDAL's six numbers place.
#ifndef MICROTIN_ENCODER_IMPORT_TRANSFORM_HPP
#define MICROTIN_ENCODER_IMPORT_TRANSFORM_HPP

#include <array>
#include <cstdint>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::importing {

// Whether columns run east and rows south or north. The numbers are the outer corner's x, a cell's
// width, its skew by row, the corner's y, the skew by column, a cell's height. Skews of up to 10^-9
// of a cell are what rounding leaves: they move the last of 65,536 rows by 1/15,000 of a cell.
bool runs_east(const std::array<double, 6>& transform);

// Where the centres of cells lie, of which the first begins or, if their size is below 0, the last
// ends at the corner; in the order in which coordinates grow. Numbers stand for the shortest
// decimals that become them. Throws Error.
Axis axis_of_cells_from(double corner, double size, uint32_t cells);

}  // namespace microtin::importing

#endif
