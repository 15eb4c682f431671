// Writing decoded terrains in formats that other programs read.
#ifndef MICROTIN_ENCODER_EXPORT_HPP
#define MICROTIN_ENCODER_EXPORT_HPP

#include <string>

#include "encoder/output_file.hpp"
#include "microtin/microtin.h"

namespace microtin {

enum class MeshFormat {
  kXyz,  // a line "x y z" for each vertex, no triangles
  kObj,  // Wavefront
  kPly   // ASCII PLY
};

// By the suffix of `path`; "-" is kXyz. Throws Error for other suffixes.
MeshFormat mesh_format_of(const std::string& path);

enum class Coordinates { kReal, kLattice };

// Vertices keep their numbers. Triangles are counter-clockwise from above, without void ones.
void export_mesh(const microtin_mesh* mesh, MeshFormat format, Coordinates coordinates,
                 OutputFile& out);

}  // namespace microtin

#endif
