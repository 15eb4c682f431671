// SPDX-License-Identifier: MIT
// Names systems by their codes, or by well-known text.
#include "encoder/export/system.hpp"

#include <optional>

#include "encoder/exact/units.hpp"
#include "encoder/export/json.hpp"
#include "encoder/import/crs.hpp"

namespace microtin::exporting {
namespace {

std::string horizontal_text(const Metadata& metadata) {
  return metadata.horizontal_epsg != 0 ? wkt_of_code(metadata.horizontal_epsg) : metadata.wkt;
}

// As ESRI adds it behind the horizontal system.
std::string vertical_text(const Metadata& metadata) {
  const std::optional<double> metres = metres_per(metadata.vertical_unit);
  if (!metres) return "";
  const std::string name(esri_name_of_heights(metadata.vertical_epsg));
  const std::string unit = metadata.vertical_unit == Unit::kMetre  ? "Meter"
                           : metadata.vertical_unit == Unit::kFoot ? "Foot"
                                                                   : "Foot_US";
  return ",VERTCS[\"" + name + "\",VDATUM[\"" + name +
         "\"],PARAMETER[\"Vertical_Shift\",0.0],PARAMETER[\"Direction\",1.0],UNIT[\"" + unit +
         "\"," + json(*metres) + "]]";
}

}  // namespace

std::string system_line(const Metadata& metadata) {
  if (metadata.horizontal_epsg != 0) return "EPSG:" + std::to_string(metadata.horizontal_epsg);
  std::string line = metadata.wkt;
  for (char& c : line) {
    if (c == '\n' || c == '\r' || c == '\t') c = ' ';
  }
  return line;
}

std::string system_text(const Metadata& metadata) {
  const std::string horizontal = horizontal_text(metadata);
  if (horizontal.empty()) return "";
  const bool is_whole = reference_of_wkt(horizontal).vertical_unit != Unit::kUnknown;
  return horizontal + (is_whole ? "" : vertical_text(metadata)) + '\n';
}

}  // namespace microtin::exporting
