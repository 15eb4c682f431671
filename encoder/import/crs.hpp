// SPDX-License-Identifier: MIT
// Coordinate reference systems: as files state them, and what codes of the EPSG registry say.
#ifndef MICROTIN_ENCODER_IMPORT_CRS_HPP
#define MICROTIN_ENCODER_IMPORT_CRS_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
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

// What a code of the EPSG registry says.
struct CodedSystem {
  bool is_vertical;
  Unit unit;               // of its coordinates
  std::string other = {};  // name of a unit that streams do not have; the unit is kUnknown then
  bool is_depth = false;   // a vertical one that grows downwards
  uint32_t heights = 0;    // the code that differs in the heights alone; 0: there is none
};

struct VerticalCode {
  uint32_t code;
  Unit unit;
  bool is_depth = false;
  uint32_t heights = 0;  // as of CodedSystem
};

// The vertical systems that are known without PROJ, as begin and end.
const VerticalCode* begin_of_verticals();
const VerticalCode* end_of_verticals();

// Known here: WGS 84 (4326), ETRS89 (4258), NAD83 (4269), UTM on these, web Mercator (3857), the
// heights in use, all heights in feet and all depths. Others come from PROJ in builds with GDAL.
// Nothing if the code is not known; throws Error if PROJ knows that there is none, or one of
// another kind.
std::optional<CodedSystem> system_of_code(uint32_t code);

// The system of a code that a file states: nothing, too, if there is none.
std::optional<CodedSystem> system_of_file_code(uint32_t code);

// The system of a code, without PROJ.
std::optional<CodedSystem> built_in_system(uint32_t code);

// Well-known text, as ESRI writes it, of a horizontal system that is known as above; empty if it is
// not.
std::string wkt_of_code(uint32_t code);

// The code of the built-in system that ESRI calls so: WGS_1984_UTM_Zone_33N. 0: none.
uint32_t code_of_esri_name(std::string_view name);

// How ESRI calls heights of that code, "unknown" if that is not known here; and the other way
// round.
std::string_view esri_name_of_heights(uint32_t code);
uint32_t code_of_esri_heights(std::string_view name);

#ifdef MICROTIN_WITH_GDAL
std::optional<CodedSystem> system_by_proj(uint32_t code);
std::string wkt_by_proj(uint32_t code);
#endif

}  // namespace microtin::importing

#endif
