// SPDX-License-Identifier: MIT
// A small part of the registry: what elevation comes in most often.
#include <array>

#include "encoder/base/error.hpp"
#include "encoder/import/crs.hpp"

namespace microtin::importing {
namespace {

struct Geographic {
  uint32_t code;
  std::string_view name, datum, ellipsoid;
  std::string_view utm;   // begins the names of its zones
  uint32_t north, south;  // code of UTM zone 0, north and south; 0: none
  uint32_t first, last;   // zones that there are
};

constexpr std::array<Geographic, 3> kGeographic = {
    {{4326, "GCS_WGS_1984", "D_WGS_1984", R"("WGS_1984",6378137.0,298.257223563)", "WGS_1984",
      32600, 32700, 1, 60},
     {4258, "GCS_ETRS_1989", "D_ETRS_1989", R"("GRS_1980",6378137.0,298.257222101)", "ETRS_1989",
      25800, 0, 28, 38},
     {4269, "GCS_North_American_1983", "D_North_American_1983",
      R"("GRS_1980",6378137.0,298.257222101)", "NAD_1983", 26900, 0, 1, 23}}};

constexpr uint32_t kWebMercator = 3857;
constexpr std::string_view kWebMercatorName = "WGS_1984_Web_Mercator_Auxiliary_Sphere";

// EGM96, EGM2008, EGM84, mean sea level, NAVD88 (metre, US survey foot, foot), NGVD29 (US survey
// foot), DHHN92, DHHN2016, EVRF2000, EVRF2007, EVRF2019, ODN, NAP, NGF-IGN69, LN02, LHN95, Baltic
// 1977, AHD, NZVD2016, CGVD28, CGVD2013, JGD2011; others in feet; then all depths.
constexpr std::array<VerticalCode, 58> kVertical = {{{5773, Unit::kMetre},
                                                     {3855, Unit::kMetre},
                                                     {5798, Unit::kMetre},
                                                     {5714, Unit::kMetre},
                                                     {5703, Unit::kMetre},
                                                     {6360, Unit::kUsSurveyFoot},
                                                     {8228, Unit::kFoot},
                                                     {5702, Unit::kUsSurveyFoot},
                                                     {5783, Unit::kMetre},
                                                     {7837, Unit::kMetre},
                                                     {5730, Unit::kMetre},
                                                     {5621, Unit::kMetre},
                                                     {9389, Unit::kMetre},
                                                     {5701, Unit::kMetre},
                                                     {5709, Unit::kMetre},
                                                     {5720, Unit::kMetre},
                                                     {5728, Unit::kMetre},
                                                     {5729, Unit::kMetre},
                                                     {5705, Unit::kMetre},
                                                     {5711, Unit::kMetre},
                                                     {7839, Unit::kMetre},
                                                     {5713, Unit::kMetre},
                                                     {6647, Unit::kMetre},
                                                     {6695, Unit::kMetre},
                                                     {6130, Unit::kFoot},
                                                     {6131, Unit::kFoot},
                                                     {6132, Unit::kFoot},
                                                     {8050, Unit::kFoot},
                                                     {8052, Unit::kUsSurveyFoot},
                                                     {5336, Unit::kMetre, true, 5735},
                                                     {5612, Unit::kMetre, true, 5705},
                                                     {5614, Unit::kFoot, true, 0},
                                                     {5706, Unit::kMetre, true, 5611},
                                                     {5715, Unit::kMetre, true, 5714},
                                                     {5734, Unit::kMetre, true, 5797},
                                                     {5739, Unit::kMetre, true, 0},
                                                     {5789, Unit::kMetre, true, 7979},
                                                     {5831, Unit::kMetre, true, 5829},
                                                     {5861, Unit::kMetre, true, 0},
                                                     {5862, Unit::kMetre, true, 0},
                                                     {5863, Unit::kMetre, true, 0},
                                                     {5864, Unit::kMetre, true, 0},
                                                     {5865, Unit::kMetre, true, 0},
                                                     {5866, Unit::kMetre, true, 0},
                                                     {5867, Unit::kMetre, true, 0},
                                                     {5873, Unit::kMetre, true, 0},
                                                     {6357, Unit::kMetre, true, 5703},
                                                     {6358, Unit::kUsSurveyFoot, true, 6360},
                                                     {6359, Unit::kUsSurveyFoot, true, 5702},
                                                     {7976, Unit::kMetre, true, 5738},
                                                     {8051, Unit::kFoot, true, 8050},
                                                     {8053, Unit::kUsSurveyFoot, true, 8052},
                                                     {8358, Unit::kMetre, true, 8357},
                                                     {8378, Unit::kMetre, true, 0},
                                                     {8897, Unit::kFoot, true, 0},
                                                     {9287, Unit::kMetre, true, 0},
                                                     {9288, Unit::kMetre, true, 0},
                                                     {9672, Unit::kMetre, true, 0}}};

struct NamedHeights {
  uint32_t code;
  std::string_view name;
};

constexpr std::array<NamedHeights, 2> kNamedHeights = {
    {{5773, "EGM96_Geoid"}, {3855, "EGM2008_Geoid"}}};

std::string geographic_text(const Geographic& system) {
  return "GEOGCS[\"" + std::string(system.name) + "\",DATUM[\"" + std::string(system.datum) +
         "\",SPHEROID[" + std::string(system.ellipsoid) +
         R"(]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]])";
}

std::string projected_text(const std::string& name, const Geographic& base,
                           const std::string& projection) {
  return "PROJCS[\"" + name + "\"," + geographic_text(base) + ",PROJECTION" + projection +
         R"(,UNIT["Meter",1.0]])";
}

// A zone of Universal Transverse Mercator.
struct Zone {
  const Geographic* base;
  uint32_t number;
  bool is_south;

  std::string name() const {
    return std::string(base->utm) + "_UTM_Zone_" + std::to_string(number) + (is_south ? 'S' : 'N');
  }

  std::string text() const {
    const int meridian = 6 * static_cast<int>(number) - 183;
    return projected_text(
        name(), *base,
        std::string(R"(["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],)") +
            R"(PARAMETER["False_Northing",)" + (is_south ? "10000000.0" : "0.0") +
            R"(],PARAMETER["Central_Meridian",)" + std::to_string(meridian) +
            R"(.0],PARAMETER["Scale_Factor",0.9996],PARAMETER["Latitude_Of_Origin",0.0])");
  }
};

std::optional<Zone> zone_of(uint32_t code) {
  for (const Geographic& base : kGeographic) {
    for (const bool is_south : {false, true}) {
      const uint32_t zero = is_south ? base.south : base.north;
      if (zero != 0 && code >= zero + base.first && code <= zero + base.last) {
        return Zone{&base, code - zero, is_south};
      }
    }
  }
  return std::nullopt;
}

const Geographic* geographic(uint32_t code) {
  for (const Geographic& system : kGeographic) {
    if (system.code == code) return &system;
  }
  return nullptr;
}

std::string built_in_wkt(uint32_t code) {
  if (const Geographic* const system = geographic(code)) return geographic_text(*system);
  if (const std::optional<Zone> zone = zone_of(code)) return zone->text();
  if (code != kWebMercator) return "";
  return projected_text(
      std::string(kWebMercatorName), kGeographic[0],
      R"(["Mercator_Auxiliary_Sphere"],PARAMETER["False_Easting",0.0],)"
      R"(PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",0.0],)"
      R"(PARAMETER["Standard_Parallel_1",0.0],PARAMETER["Auxiliary_Sphere_Type",0.0])");
}

}  // namespace

std::optional<CodedSystem> built_in_system(uint32_t code) {
  if (geographic(code) != nullptr) return CodedSystem{false, Unit::kDegree};
  if (code == kWebMercator || zone_of(code)) return CodedSystem{false, Unit::kMetre};
  for (const VerticalCode& system : kVertical) {
    if (system.code == code) {
      return CodedSystem{true, system.unit, {}, system.is_depth, system.heights};
    }
  }
  return std::nullopt;
}

const VerticalCode* begin_of_verticals() {
  return kVertical.data();
}

const VerticalCode* end_of_verticals() {
  return kVertical.data() + kVertical.size();
}

std::optional<CodedSystem> system_of_code(uint32_t code) {
  std::optional<CodedSystem> system = built_in_system(code);
#ifdef MICROTIN_WITH_GDAL
  if (!system) return system_by_proj(code);
#endif
  return system;
}

std::optional<CodedSystem> system_of_file_code(uint32_t code) {
  try {
    return code == 0 ? std::nullopt : system_of_code(code);
  } catch (const Error&) {
    return std::nullopt;
  }
}

std::string wkt_of_code(uint32_t code) {
  std::string text = built_in_wkt(code);
#ifdef MICROTIN_WITH_GDAL
  if (text.empty() && code != 0) return wkt_by_proj(code);
#endif
  return text;
}

std::string_view esri_name_of_heights(uint32_t code) {
  for (const NamedHeights& heights : kNamedHeights) {
    if (heights.code == code) return heights.name;
  }
  return "unknown";
}

uint32_t code_of_esri_heights(std::string_view name) {
  for (const NamedHeights& heights : kNamedHeights) {
    if (heights.name == name) return heights.code;
  }
  return 0;
}

uint32_t code_of_esri_name(std::string_view name) {
  if (name == kWebMercatorName) return kWebMercator;
  for (const Geographic& base : kGeographic) {
    if (base.name == name) return base.code;
    for (uint32_t number = base.first; number <= base.last; ++number) {
      if (Zone{&base, number, false}.name() == name) return base.north + number;
      if (base.south != 0 && Zone{&base, number, true}.name() == name) return base.south + number;
    }
  }
  return 0;
}

}  // namespace microtin::importing
