// SPDX-License-Identifier: MIT
// Coordinate systems as the files say them that are written.
#ifndef MICROTIN_ENCODER_EXPORT_SYSTEM_HPP
#define MICROTIN_ENCODER_EXPORT_SYSTEM_HPP

#include <string>

#include "encoder/layers.hpp"
#include "encoder/terrain/metadata.hpp"

namespace microtin::exporting {

// In one line, as other programs take it: EPSG:32633, or well-known text. Empty: not known.
std::string system_line(const Metadata& metadata);

// Well-known text for a .prj file, with the unit of heights. Empty: not known, or a code whose text
// is not known here.
std::string system_text(const Metadata& metadata);

}  // namespace microtin::exporting

#endif
