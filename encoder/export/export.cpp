// SPDX-License-Identifier: MIT
// Writes XYZ, OBJ and PLY line by line.
#include "encoder/export/export.hpp"

#include "encoder/base/error.hpp"
#include "encoder/base/suffix.hpp"
#include "encoder/exact/coordinates.hpp"
#include "encoder/export/glb.hpp"

namespace microtin::exporting {
namespace {

void write_vertices(const SurfaceModel& model, Coordinates coordinates, const std::string& prefix,
                    OutputFile& out) {
  const Placement placement = coordinates == Coordinates::kReal ? model.placement : Placement();
  const CoordinateText x_text(placement.x), y_text(placement.y), z_text(placement.z);
  for (const auto& [x, y, z] : model.vertices) {
    out.write(prefix + x_text(x) + ' ' + y_text(y) + ' ' + z_text(z) + '\n');
  }
}

// One line for each triangle; the first vertex has number `first`.
void write_triangles(const SurfaceModel& model, const std::string& prefix, uint32_t first,
                     OutputFile& out) {
  for (const auto& corners : model.triangles) {
    std::string line = prefix;
    for (const uint32_t corner : corners) line += ' ' + std::to_string(corner + first);
    out.write(line + '\n');
  }
}

void write_ply_header(const SurfaceModel& model, Coordinates coordinates, OutputFile& out) {
  const bool is_placed = coordinates == Coordinates::kReal && !model.system.empty();
  out.write("ply\nformat ascii 1.0\n" +
            (is_placed ? "comment crs: " + model.system + '\n' : std::string()) +
            "element vertex " + std::to_string(model.vertices.size()) +
            "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
            std::to_string(model.triangles.size()) +
            "\nproperty list uchar int vertex_indices\nend_header\n");
}

}  // namespace

MeshFormat mesh_format_of(const std::string& path) {
  const std::string suffix = suffix_of(path);
  if (path == "-" || suffix == ".xyz") return MeshFormat::kXyz;
  if (suffix == ".obj") return MeshFormat::kObj;
  if (suffix == ".ply") return MeshFormat::kPly;
  if (suffix == ".glb") return MeshFormat::kGlb;
  throw Error(path +
              ": not a kind of file that is written (.xyz, .obj, .ply, .glb, .asc, .dat, .ter); "
              "gdal_translate and ogr2ogr with the driver MTIN write others");
}

uint64_t most_mesh_bytes(const SampledSurface& surface, uint64_t vertices, MeshFormat format,
                         Coordinates coordinates) {
  constexpr uint64_t kHead = 65536 + 4096;  // a ply's has a text of the header
  const uint64_t triangles = format == MeshFormat::kXyz ? 0 : 2 * vertices;
  if (format == MeshFormat::kGlb) return kHead + glb_bytes(vertices, triangles);
  const Placement placement = coordinates == Coordinates::kReal ? surface.placement : Placement();
  const size_t vertex = std::string("v   \n").size() +
                        CoordinateText(placement.x).longest(surface.x_min, surface.x_max) +
                        CoordinateText(placement.y).longest(surface.y_min, surface.y_max) +
                        CoordinateText(placement.z).longest(surface.lowest, surface.highest);
  const size_t triangle = std::string("f   \n").size() + 3 * std::to_string(vertices).size();
  return kHead + vertices * vertex + triangles * triangle;
}

void export_model(const SurfaceModel& model, MeshFormat format, Coordinates coordinates,
                  OutputFile& out) {
  switch (format) {
    case MeshFormat::kXyz:
      write_vertices(model, coordinates, "", out);
      break;
    case MeshFormat::kObj:
      write_vertices(model, coordinates, "v ", out);
      write_triangles(model, "f", 1, out);
      break;
    case MeshFormat::kPly:
      write_ply_header(model, coordinates, out);
      write_vertices(model, coordinates, "", out);
      write_triangles(model, "3", 0, out);
      break;
    case MeshFormat::kGlb:
      export_glb(model, coordinates, out);
      break;
  }
}

}  // namespace microtin::exporting
