// SPDX-License-Identifier: MIT
// Writing the lines that marked edges make as GeoJSON.
#ifndef MICROTIN_ENCODER_EXPORT_LINES_HPP
#define MICROTIN_ENCODER_EXPORT_LINES_HPP

#include <vector>

#include "encoder/export/mesh.hpp"
#include "encoder/files/output.hpp"
#include "encoder/layers.hpp"
#include "encoder/stream/edge_marks.hpp"
#include "microtin/microtin.h"

namespace microtin::exporting {

// A feature for each line, with its class as a property and a height at each position.
void export_lines(const microtin_mesh* mesh, const std::vector<MarkedLine>& lines,
                  const Placement& placement, OutputFile& out);

}  // namespace microtin::exporting

#endif
