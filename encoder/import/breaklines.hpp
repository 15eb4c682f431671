// SPDX-License-Identifier: MIT
// BreaklineFile out of files of features and of text with a position on each line.
#ifndef MICROTIN_ENCODER_IMPORT_BREAKLINES_HPP
#define MICROTIN_ENCODER_IMPORT_BREAKLINES_HPP

#include <string>
#include <vector>

#include "encoder/import/features.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/line_class.hpp"
#include "encoder/terrain/polygons.hpp"

namespace microtin::importing {

struct BreaklineFile {
  std::vector<RealLine> lines;
  std::vector<LineClass> classes;  // of each line
};

// Lines and the rings of polygons of a file, in the terrain's own system; heights are in its unit.
// GeoJSON has .geojson or .json, and maybe a property class, and what GDAL reads a field of that
// name. A text has columns x, y, maybe z, and maybe a name of the line; a header may name them, and
// a column class. An empty line ends a line, and so does another name or class. Throws Error with
// the place of a fault: no line, a line of one position, positions with and without a height in a
// line, a class that there is not.
BreaklineFile read_breaklines(const std::string& path, const FeatureFiles& files);

// Reads which system and units a file of breaklines states, for FeatureFiles::expect_system, unless
// that is known, or the file is a pipe, which can be read once only.
void note_breaklines(const std::string& path, const FeatureFiles& files);

}  // namespace microtin::importing

#endif
