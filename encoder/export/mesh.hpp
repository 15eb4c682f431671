// SPDX-License-Identifier: MIT
// Writing decoded terrains as meshes, and their lines as GeoJSON.
#ifndef MICROTIN_ENCODER_EXPORT_MESH_HPP
#define MICROTIN_ENCODER_EXPORT_MESH_HPP

#include <string>
#include <vector>

#include "encoder/export/queries.hpp"
#include "encoder/files/output.hpp"
#include "encoder/layers.hpp"
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/stream/edge_marks.hpp"
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

// At least as many bytes as a mesh of this many vertices on the surface takes.
uint64_t most_mesh_bytes(const SampledSurface& surface, uint64_t vertices, MeshFormat format,
                         Coordinates coordinates);

void export_model(const SurfaceModel& model, MeshFormat format, Coordinates coordinates,
                  OutputFile& out);

// glTF 2.0: one mesh with normals and a colour by height for each vertex. Metres, x to the east, y
// up, z to the south, from the middle of the terrain, whose real coordinates are the asset's
// extra "origin". Units that are not known count as metres, as do degrees of height; horizontal
// degrees become metres with the lengths that they have at the middle. The model must have a
// triangle. Throws Error if it takes more than 4 GB.
void export_glb(const SurfaceModel& model, Coordinates coordinates, OutputFile& out);

// Bytes of vertices and triangles, without the description before them, below 4 KB.
uint64_t glb_bytes(uint64_t vertices, uint64_t triangles);

// A feature for each line, with its class as a property and a height at each position.
void export_lines(const microtin_mesh* mesh, const std::vector<MarkedLine>& lines,
                  const Placement& placement, OutputFile& out);

}  // namespace microtin::exporting

#endif
