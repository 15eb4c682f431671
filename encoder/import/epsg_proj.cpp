// SPDX-License-Identifier: MIT
// The whole registry, as PROJ has it; part of builds with MICROTIN_WITH_GDAL only.
#include <cpl_conv.h>
#include <cpl_error.h>
#include <ogr_srs_api.h>

#include <cmath>
#include <memory>

#include "encoder/base/error.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/import/crs.hpp"

namespace microtin::importing {
namespace {

struct Destroy {
  void operator()(void* system) const { OSRDestroySpatialReference(system); }
};

using OwnedSystem = std::unique_ptr<void, Destroy>;

// Null if there is no such code.
OwnedSystem system_for(uint32_t code) {
  CPLPushErrorHandler(CPLQuietErrorHandler);
  OwnedSystem system(OSRNewSpatialReference(nullptr));
  const bool found = OSRImportFromEPSG(system.get(), static_cast<int>(code)) == OGRERR_NONE;
  CPLPopErrorHandler();
  if (!found) system.reset();
  return system;
}

StatedUnit unit_of(OGRSpatialReferenceH system, bool is_vertical) {
  char* name = nullptr;  // of the system, which frees it
  if (!is_vertical && OSRIsGeographic(system) != 0) {
    constexpr double kDegree = 0.017453292519943295, kAlike = 1e-12;
    const double radians = OSRGetAngularUnits(system, &name);
    if (std::abs(radians - kDegree) < kAlike) return {Unit::kDegree, {}};
    return {Unit::kUnknown, name};
  }
  const double metres = OSRGetTargetLinearUnits(system, is_vertical ? "VERT_CS" : "PROJCS", &name);
  return unit_of_length(metres, name);
}

bool grows_downwards(OGRSpatialReferenceH system) {
  OGRAxisOrientation orientation = OAO_Other;
  OSRGetAxis(system, nullptr, 0, &orientation);
  return orientation == OAO_Down;
}

}  // namespace

std::optional<CodedSystem> system_by_proj(uint32_t code) {
  const OwnedSystem system = system_for(code);
  if (!system)
    throw Error("EPSG has no coordinate reference system " + std::to_string(code) +
                "; look for the code at epsg.org");
  const bool is_vertical = OSRIsVertical(system.get()) != 0 && OSRIsCompound(system.get()) == 0;
  const bool is_horizontal =
      OSRIsGeographic(system.get()) != 0 || OSRIsProjected(system.get()) != 0;
  if (!is_vertical && (!is_horizontal || OSRIsCompound(system.get()) != 0)) {
    throw Error("EPSG " + std::to_string(code) +
                " is neither a horizontal nor a vertical system: give both, HORIZONTAL:VERTICAL");
  }
  const StatedUnit unit = unit_of(system.get(), is_vertical);
  return CodedSystem{is_vertical, unit.unit, unit.other,
                     is_vertical && grows_downwards(system.get())};
}

std::string wkt_by_proj(uint32_t code) {
  const OwnedSystem system = system_for(code);
  if (!system) return "";
  const char* const options[] = {"FORMAT=WKT1_ESRI", nullptr};
  char* text = nullptr;
  const bool done = OSRExportToWktEx(system.get(), &text, options) == OGRERR_NONE;
  std::string result = done && text != nullptr ? text : "";
  CPLFree(text);
  return result;
}

}  // namespace microtin::importing
