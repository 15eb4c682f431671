// Writing decoded terrains in formats that other programs read.
#ifndef MICROTIN_ENCODER_EXPORT_HPP
#define MICROTIN_ENCODER_EXPORT_HPP

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "encoder/exact/metadata.hpp"
#include "encoder/files/output_file.hpp"
#include "microtin/microtin.h"

namespace microtin {

enum class MeshFormat {
  kXyz,  // a line "x y z" for each vertex, no triangles
  kObj,  // Wavefront
  kPly,  // ASCII PLY
  kGlb   // glTF binary
};

// By the suffix of `path`; "-" is kXyz. Throws Error for other suffixes.
MeshFormat mesh_format_of(const std::string& path);

enum class Coordinates { kReal, kLattice };

// A surface in global lattice coordinates. Triangles are counter-clockwise from above, without void
// ones.
struct SurfaceModel {
  Placement placement;
  Unit horizontal_unit = Unit::kUnknown, vertical_unit = Unit::kUnknown;
  std::vector<std::array<int64_t, 3>> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
};

// Vertices keep their numbers.
SurfaceModel model_of(const microtin_mesh* mesh);

void export_model(const SurfaceModel& model, MeshFormat format, Coordinates coordinates,
                  OutputFile& out);

void export_mesh(const microtin_mesh* mesh, MeshFormat format, Coordinates coordinates,
                 OutputFile& out);

}  // namespace microtin

#endif
