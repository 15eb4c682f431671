// SPDX-License-Identifier: MIT
#include "encoder/import/named_source.hpp"

#include <tuple>

#include "encoder/base/error.hpp"
#include "encoder/base/suffix.hpp"
#include "encoder/exact/units.hpp"

namespace microtin::importing {
namespace {

bool is_alike(const Reference& a, const Reference& b) {
  return a.horizontal_unit == b.horizontal_unit && a.vertical_unit == b.vertical_unit &&
         a.horizontal_epsg == b.horizontal_epsg && a.vertical_epsg == b.vertical_epsg &&
         a.wkt == b.wkt;
}

std::string text_of(const Reference& reference) {
  std::string text = "x and y " + std::string(name_of(reference.horizontal_unit)) + ", heights " +
                     std::string(name_of(reference.vertical_unit));
  if (reference.horizontal_epsg != 0) text += ", EPSG:" + std::to_string(reference.horizontal_epsg);
  if (reference.vertical_epsg != 0) text += ":" + std::to_string(reference.vertical_epsg);
  return text;
}

// What to do about two files that are not alike.
std::string remedy(const NamedSource& first, const NamedSource& part, const Reference& a,
                   const Reference& b) {
  for (const auto& [file, reference] : {std::tie(first, a), std::tie(part, b)}) {
    if (reference.horizontal_unit != Unit::kUnknown || !reference.wkt.empty()) continue;
    if (suffix_of(file.path) == ".asc") {
      return "put the .prj that is missing beside " + file.path + ", or give an EPSG code for all";
    }
  }
  const bool is_unknown = a.vertical_unit == Unit::kUnknown || b.vertical_unit == Unit::kUnknown;
  const std::string others = is_unknown ? ", or give units for all" : "";
  return (std::holds_alternative<PointCloud>(part.source) ? "bring all points into one system first"
                                                          : "bring it there with gdalwarp") +
         others;
}

}  // namespace

void expect_alike(const NamedSource& first, const NamedSource& part, const Reference& a,
                  const Reference& b) {
  if (is_alike(a, b)) return;
  throw Error(part.path + ": its units or its coordinate system (" + text_of(b) +
              ") are not those of " + first.path + " (" + text_of(a) +
              "): " + remedy(first, part, a, b));
}

}  // namespace microtin::importing
