// SPDX-License-Identifier: MIT
// Bounds that grow with the distance from a route.
#ifndef MICROTIN_ENCODER_IMPORT_ROUTE_BOUNDS_HPP
#define MICROTIN_ENCODER_IMPORT_ROUTE_BOUNDS_HPP

#include <string>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/import/geojson.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

// Polygons around the lines of a GeoJSON file, each with a bound: from `least` at the lines to
// `edge` at half of `width` metres from them, in eight steps that are within the straight line
// between the two. Throws Error naming the file if it has no line, or if `edge` is less.
std::vector<Feature> route_bounds(const std::string& path, Decimal width, Decimal least,
                                  Decimal edge, Unit unit);

}  // namespace microtin::importing

#endif
