// SPDX-License-Identifier: MIT
// Writing surfaces as ESRI ASCII grids.
#ifndef MICROTIN_ENCODER_EXPORT_GRID_HPP
#define MICROTIN_ENCODER_EXPORT_GRID_HPP

#include "encoder/export/height_sampler.hpp"
#include "encoder/files/output_file.hpp"
#include "encoder/layers.hpp"

namespace microtin::exporting {

// At least as many bytes as export_grid writes.
double most_grid_bytes(const SampledSurface& surface, const PostGrid& posts);

// Heights at posts, which reach beyond the surface where they like. Each is that of the exact
// plane, rounded to three decimals more than the step of heights has, but at most nine. Corner and
// cell size have all their decimals, or 12, which import_asc reads as the fraction they stand for.
// Posts without a height get a NODATA_value below all others. Written post by post: memory is the
// surface's alone. Throws Error if the surface cannot be asked.
void export_grid(const SampledSurface& surface, const PostGrid& posts, OutputFile& out);

}  // namespace microtin::exporting

#endif
