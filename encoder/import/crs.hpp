// SPDX-License-Identifier: MIT
// Coordinate reference systems as files state them.
#ifndef MICROTIN_ENCODER_IMPORT_CRS_HPP
#define MICROTIN_ENCODER_IMPORT_CRS_HPP

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::importing {

constexpr size_t kLongestWkt = 16384;  // that is kept; real ones have some hundred bytes

// Whether it looks like well-known text: a word, then a bracket.
bool is_wkt(std::string_view text);

// Codes and units that a well-known text (either version, or ESRI's) gives its horizontal and its
// vertical system; what is not there, or not understood, stays unknown. The text itself, up to a
// NUL, is kept if the horizontal system has no code and the text is not longer than kLongestWkt.
Reference reference_of_wkt(std::string_view text);

// The reference of such a text or a code, EPSG:32633 or, with heights, EPSG:32633+5773.
Reference reference_of_line(std::string_view text);

// The reference of a GeoTIFF key directory, its 16-bit numbers, and of the doubles that it refers
// to.
Reference reference_of_geo_keys(const std::vector<uint16_t>& directory,
                                const std::vector<double>& doubles = {});

// A well-known text without the vertical system that it has in addition to the horizontal one.
std::string horizontal_part(const std::string& text);

}  // namespace microtin::importing

#endif
