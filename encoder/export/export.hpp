// SPDX-License-Identifier: MIT
// Writing decoded terrains in formats that other programs read.
#ifndef MICROTIN_ENCODER_EXPORT_EXPORT_HPP
#define MICROTIN_ENCODER_EXPORT_EXPORT_HPP

#include <string>

#include "encoder/export/height_sampler.hpp"
#include "encoder/files/output_file.hpp"
#include "encoder/layers.hpp"
#include "encoder/stream/surface_model.hpp"
#include "microtin/microtin.h"

namespace microtin::exporting {

enum class MeshFormat {
  kXyz,  // a line "x y z" for each vertex, no triangles
  kObj,  // Wavefront
  kPly,  // ASCII PLY
  kGlb   // glTF binary
};

// By the suffix of `path`; "-" is kXyz. Throws Error for other suffixes.
MeshFormat mesh_format_of(const std::string& path);

enum class Coordinates { kReal, kLattice };

// At least as many bytes as a mesh of so many vertices on the surface takes.
uint64_t most_mesh_bytes(const SampledSurface& surface, uint64_t vertices, MeshFormat format,
                         Coordinates coordinates);

void export_model(const SurfaceModel& model, MeshFormat format, Coordinates coordinates,
                  OutputFile& out);

}  // namespace microtin::exporting

#endif
