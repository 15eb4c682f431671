// SPDX-License-Identifier: MIT
// Writes lines as GeoJSON.
#include "encoder/export/lines.hpp"

#include <string>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/export/json.hpp"
#include "encoder/terrain/exact_query.hpp"

namespace microtin::exporting {

void export_lines(const microtin_mesh* mesh, const std::vector<MarkedLine>& lines,
                  const Placement& placement, OutputFile& out) {
  const CoordinateText x_text(placement.x), y_text(placement.y), z_text(placement.z);
  out.write("{\"type\": \"FeatureCollection\", \"features\": [");
  const char* before = "\n";
  for (const MarkedLine& line : lines) {
    out.write(before + std::string("{\"type\": \"Feature\", \"properties\": {\"class\": ") +
              json(name_of(line.kind)) +
              "}, \"geometry\": {\"type\": \"LineString\", \"coordinates\": [");
    std::string places;
    for (const uint32_t v : line.vertices) {
      const Vertex vertex = vertex_of(mesh, v);
      places += (places.empty() ? "[" : ", [") + x_text(vertex.x) + ", " + y_text(vertex.y) + ", " +
                z_text(vertex.z) + ']';
    }
    out.write(places + "]}}");
    before = ",\n";
  }
  out.write("\n]}\n");
}

}  // namespace microtin::exporting
