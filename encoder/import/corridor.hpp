// SPDX-License-Identifier: MIT
// The ground on both sides of a route, and bounds that grow with the distance from it.
#ifndef MICROTIN_ENCODER_IMPORT_CORRIDOR_HPP
#define MICROTIN_ENCODER_IMPORT_CORRIDOR_HPP

#include <string>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/import/features.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/polygons.hpp"

namespace microtin::importing {

// Polygons that together hold all places within `metres` of a line. Coordinates are in `unit`, of
// which one that is not known counts as metres. A degree of latitude counts as 110,574 metres, its
// least on WGS 84, and one of longitude as that times the least cosine nearby, so that no place is
// missed. Some are farther away: by up to 0.5 % in a plane, and 3 % in degrees below 60 degrees of
// latitude for up to 10 km. Throws Error if a line of degrees comes near a pole. O(degrees of
// latitude + vertices) polygons.
std::vector<RealRings> corridor_of(const RealLine& line, double metres, Unit unit);

// The polygons of corridor_of for all lines of features. Throws Error naming the file, `path`.
std::vector<RealRings> corridors_of(const std::string& path, const std::vector<Feature>& features,
                                    double metres, Unit unit);

// Polygons around the lines of a file, each with a bound: from `least` at the lines to
// `edge` at half of `width` metres from them, in eight steps that are within the straight line
// between the two. Throws Error naming the file if it has no line, or if `edge` is less.
std::vector<Feature> route_bounds(const std::string& path, const FeatureFiles& files, Decimal width,
                                  Decimal least, Decimal edge, Unit unit);

}  // namespace microtin::importing

#endif
