#include "encoder/export.hpp"

#include <array>
#include <filesystem>

#include "encoder/coordinates.hpp"
#include "encoder/error.hpp"

namespace microtin {
namespace {

using Corners = std::array<uint32_t, 3>;

template <class Visit>
void for_each_real_triangle(const microtin_mesh* mesh, const Visit& visit) {
  for (uint32_t t = 0; t < microtin_triangle_count(mesh); ++t) {
    Corners corners{};
    if (microtin_triangle(mesh, t, corners.data()) == MICROTIN_REAL) visit(corners);
  }
}

void write_vertices(const microtin_mesh* mesh, Coordinates coordinates, const std::string& prefix,
                    OutputFile& out) {
  Placement placement;
  if (coordinates == Coordinates::kReal) {
    microtin_placement(mesh, &placement.x, &placement.y, &placement.z);
  }
  const CoordinateText x_text(placement.x), y_text(placement.y), z_text(placement.z);
  for (uint32_t v = 0; v < microtin_vertex_count(mesh); ++v) {
    uint16_t x = 0, y = 0;
    int16_t z = 0;
    microtin_vertex(mesh, v, &x, &y, &z);
    out.write(prefix + x_text(x) + ' ' + y_text(y) + ' ' + z_text(z) + '\n');
  }
}

// One line for each triangle; the first vertex has number `first`.
void write_triangles(const microtin_mesh* mesh, const std::string& prefix, uint32_t first,
                     OutputFile& out) {
  for_each_real_triangle(mesh, [&](const Corners& corners) {
    std::string line = prefix;
    for (const uint32_t corner : corners) line += ' ' + std::to_string(corner + first);
    out.write(line + '\n');
  });
}

void write_ply_header(const microtin_mesh* mesh, OutputFile& out) {
  uint32_t triangles = 0;
  for_each_real_triangle(mesh, [&](const Corners&) { ++triangles; });
  out.write("ply\nformat ascii 1.0\nelement vertex " + std::to_string(microtin_vertex_count(mesh)) +
            "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
            std::to_string(triangles) + "\nproperty list uchar int vertex_indices\nend_header\n");
}

}  // namespace

MeshFormat mesh_format_of(const std::string& path) {
  const std::string suffix = std::filesystem::path(path).extension().string();
  if (path == "-" || suffix == ".xyz") return MeshFormat::kXyz;
  if (suffix == ".obj") return MeshFormat::kObj;
  if (suffix == ".ply") return MeshFormat::kPly;
  throw Error(path + ": not a kind of mesh file known here (.xyz, .obj, .ply)");
}

void export_mesh(const microtin_mesh* mesh, MeshFormat format, Coordinates coordinates,
                 OutputFile& out) {
  switch (format) {
    case MeshFormat::kXyz:
      write_vertices(mesh, coordinates, "", out);
      break;
    case MeshFormat::kObj:
      write_vertices(mesh, coordinates, "v ", out);
      write_triangles(mesh, "f", 1, out);
      break;
    case MeshFormat::kPly:
      write_ply_header(mesh, out);
      write_vertices(mesh, coordinates, "", out);
      write_triangles(mesh, "3", 0, out);
      break;
  }
}

}  // namespace microtin
