#include "encoder/prepared_terrain.hpp"

#include "encoder/error_context.hpp"
#include "encoder/import.hpp"
#include "encoder/input_file.hpp"
#include "encoder/voids.hpp"
#include "encoder/water.hpp"

namespace microtin {
namespace {

Raster read_mask(const std::string& path, const Raster& raster) {
  Raster mask = import_asc(path, read_file(path));
  about(path, [&] { check_water_mask(mask, raster); });
  return mask;
}

}  // namespace

PreparedTerrain prepared_terrain(const std::string& path, const Preparation& preparation) {
  PreparedTerrain terrain{import_terrain(path), 0, 0};
  terrain.filled = fill_voids(terrain.source, preparation.fill_voids);
  if (!preparation.water_level) return terrain;
  auto* const raster = std::get_if<Raster>(&terrain.source);
  if (raster == nullptr) throw Error(path + ": --water-level is for rasters; these are points");
  std::optional<Raster> mask;
  if (!preparation.water_mask.empty()) mask = read_mask(preparation.water_mask, *raster);
  terrain.flooded = about(path, [&] {
    return flood_voids(*raster, *preparation.water_level, mask ? &*mask : nullptr);
  });
  return terrain;
}

std::string told(const PreparedTerrain& terrain) {
  std::string text;
  if (terrain.filled != 0) {
    text += ", " + std::to_string(terrain.filled) + " of the posts were void and are filled";
  }
  if (terrain.flooded != 0) {
    text += ", " + std::to_string(terrain.flooded) + " of the posts were void and are water";
  }
  return text;
}

}  // namespace microtin
