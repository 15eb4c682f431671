// SPDX-License-Identifier: MIT
// Surfaces as glTF binaries, for viewers.
#ifndef MICROTIN_ENCODER_EXPORT_GLB_HPP
#define MICROTIN_ENCODER_EXPORT_GLB_HPP

#include "encoder/export/export.hpp"
#include "encoder/layers.hpp"

namespace microtin::exporting {

// glTF 2.0: one mesh with normals and a colour by height for each vertex. Metres, x to the east, y
// up, z to the south, from the middle of the terrain, whose real coordinates are the asset's
// extra "origin". Units that are not known count as metres, as do degrees of height; horizontal
// degrees become metres with the lengths that they have at the middle. The model must have a
// triangle. Throws Error if it takes more than 4 GB.
void export_glb(const SurfaceModel& model, Coordinates coordinates, OutputFile& out);

// Bytes of vertices and triangles, without the description before them, below 4 KB.
uint64_t glb_bytes(uint64_t vertices, uint64_t triangles);

}  // namespace microtin::exporting

#endif
