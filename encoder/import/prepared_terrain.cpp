// SPDX-License-Identifier: MIT
// Terrains as they are encoded, and as they are compared with the result; and folders of their
// files.
#include "encoder/import/prepared_terrain.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/area.hpp"
#include "encoder/import/breaklines.hpp"
#include "encoder/import/corridor.hpp"
#include "encoder/import/import.hpp"
#include "encoder/import/mosaic.hpp"
#include "encoder/import/obstacles.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/terrain/clouds.hpp"
#include "encoder/terrain/voids.hpp"
#include "shared/lattice.hpp"

namespace microtin::importing {
namespace {

namespace fs = std::filesystem;

using FilesBySuffix = std::map<std::string, std::vector<std::string>>;

// The suffix that counts: a format may have two.
std::string counted(const std::string& suffix) {
  return suffix == ".tiff" ? ".tif" : suffix;
}

FilesBySuffix terrain_files_in(const std::string& folder) {
  FilesBySuffix by_suffix;
  std::error_code error;
  const fs::directory_iterator entries(fs::u8path(folder), error);
  if (error) throw Error(folder + ": cannot be read: " + error.message());
  for (const auto& entry : entries) {
    const std::string path = entry.path().string(), suffix = suffix_of(path);
    // macOS keeps attributes of N50E006.hgt in ._N50E006.hgt.
    if (entry.path().filename().string().front() == '.') continue;
    if (is_terrain_suffix(suffix) && is_regular_file(path)) {
      by_suffix[counted(suffix)].push_back(path);
    }
  }
  return by_suffix;
}

FilesBySuffix::const_iterator most_of(const FilesBySuffix& files) {
  return std::max_element(files.begin(), files.end(), [](const auto& a, const auto& b) {
    return a.second.size() < b.second.size();
  });
}

}  // namespace

std::vector<std::string> files_in(const std::string& path) {
  std::error_code none;
  if (!fs::is_directory(fs::u8path(path), none)) return {path};
  const FilesBySuffix by_suffix = terrain_files_in(path);
  if (by_suffix.empty()) throw Error(path + ": holds no terrain file: " + terrain_kinds());
  std::vector<std::string> files = most_of(by_suffix)->second;
  std::sort(files.begin(), files.end());
  return files;
}

std::string left_out_of(const std::string& path) {
  std::error_code none;
  if (!fs::is_directory(fs::u8path(path), none)) return "";
  const FilesBySuffix by_suffix = terrain_files_in(path);
  if (by_suffix.size() < 2) return "";
  const auto most = most_of(by_suffix);
  std::string others;
  for (auto other = by_suffix.begin(); other != by_suffix.end(); ++other) {
    if (other == most) continue;
    others +=
        (others.empty() ? "" : ", ") + std::to_string(other->second.size()) + " of " + other->first;
  }
  return path + ": its " + most->first + " files are taken; left out are " + others;
}

namespace {

std::unique_ptr<RasterReader> open_mask(const std::string& path, const Raster& frame) {
  OpenSource source = open_terrain(path);
  auto* const mask = std::get_if<std::unique_ptr<RasterReader>>(&source);
  if (mask == nullptr) throw Error(path + ": is not a raster; use an .asc grid of 0 and 1");
  with_file_context(path, [&] {
    expect_same_horizontal_system((*mask)->frame().reference, frame.reference);
    check_water_mask((*mask)->frame(), frame);
  });
  return std::move(*mask);
}

[[noreturn]] void refuse_water(const std::string& path) {
  throw Error(path + ": " + parameter("water_level") + " is for rasters, and these are points");
}

// Where a raster has water if it has no height: a mask's places, or all, but for those in no file.
class WaterPlaces {
 public:
  WaterPlaces(const Raster& frame, const Preparation& preparation)
      : frame_(frame), absent_(preparation.absent), mask_path_(preparation.water_mask) {
    if (!mask_path_.empty()) mask_ = open_mask(mask_path_, frame);
    sea_ = preparation.sea;
    if (!sea_.empty() && frame.reference.horizontal_unit != Unit::kDegree) {
      throw Error(preparation.cells +
                  ": marks cells of degrees as sea, and the terrain is not in " +
                  "degrees; leave these lines out");
    }
  }

  // 1 where there is water, for a part of the raster, `absent` as the raster has it; nothing: all
  // places are.
  std::optional<Raster> read(const PostRectangle& rectangle, const Raster& part,
                             const std::vector<bool>& absent) const {
    std::optional<Raster> places;
    if (mask_) {
      places = mask_->read(rectangle);
      with_file_context(mask_path_, [&] { check_water_mask(*places, part); });
    }
    if (mask_ || absent.empty() || absent_ == Absent::kSea) return places;
    places = crop_frame(frame_, rectangle);
    places->decimals = 0;
    places->heights.assign(part.heights.size(), 1);
    for (size_t i = 0; i < absent.size(); ++i) {
      if (absent[i] && !is_sea(part, i)) places->heights[i] = 0;
    }
    return places;
  }

 private:
  bool is_sea(const Raster& part, size_t post) const {
    const size_t column = post % part.width, row = post / part.width;
    const double x = offset_of(part.x) + step_of(part.x) * static_cast<double>(column);
    const double y = offset_of(part.y) + step_of(part.y) * static_cast<double>(row);
    constexpr double kSlack = 1e-9, kTurn = 360;
    return std::any_of(sea_.begin(), sea_.end(), [&](const DegreeCell& cell) {
      const double west = x - cell.longitude, south = y - cell.latitude;
      const auto is_within = [](double at) { return at >= -kSlack && at <= 1 + kSlack; };
      return is_within(south) && (is_within(west) || is_within(west - kTurn));
    });
  }

  const Raster& frame_;
  Absent absent_;
  std::vector<DegreeCell> sea_;
  std::string mask_path_;
  std::unique_ptr<RasterReader> mask_;
};

// Reads a raster with its water.
class FloodedRaster : public RasterReader {
 public:
  FloodedRaster(const std::string& path, std::unique_ptr<RasterReader> raster,
                const Preparation& preparation)
      : path_(path), raster_(std::move(raster)), level_(*preparation.water_level) {
    frame_ = raster_->frame();
    flood_voids(frame_, level_, nullptr);
    places_ = std::make_unique<WaterPlaces>(frame_, preparation);
  }

  Raster read(const PostRectangle& rectangle) const override {
    Raster part = raster_->read(rectangle);
    const auto water = places_->read(rectangle, part, raster_->absent_in(rectangle));
    with_file_context(path_, [&] { flood_voids(part, level_, water ? &*water : nullptr); });
    return part;
  }

 private:
  std::string path_;
  std::unique_ptr<RasterReader> raster_;
  Decimal level_;
  std::unique_ptr<WaterPlaces> places_;
};

// The files that make up a terrain.
std::vector<std::string> parts_of(const std::string& path, const Preparation& preparation) {
  if (!preparation.sea.empty() && !preparation.water_level) {
    throw Error(preparation.cells + ": marks cells as sea, which need its height; set " +
                parameter("water_level"));
  }
  std::vector<std::string> parts = files_in(path);
  for (const std::string& more : preparation.more_files) {
    for (std::string& file : files_in(more)) parts.push_back(std::move(file));
  }
  return parts;
}

template <class AnySource>
AnySource settled(const std::string& path, AnySource source, const Preparation& preparation) {
  if (!preparation.requested) return source;
  with_file_context(path, [&] { settle_source(source, *preparation.requested); });
  return source;
}

Raster raster_of_points(const std::string& path, const PointCloud& cloud) {
  std::optional<Raster> raster = gridded(cloud);
  if (!raster)
    throw Error(path + ": the points are not the posts of a raster; leave out " +
                parameter("gridded"));
  return std::move(*raster);
}

OpenSource open_parts(const std::vector<std::string>& parts, const Preparation& preparation) {
  std::vector<NamedSource> sources;
  sources.reserve(parts.size());
  for (const std::string& part : parts) {
    OpenSource source =
        open_terrain(part, preparation.classes, preparation.indirect, preparation.band);
    sources.push_back({part, settled(part, std::move(source), preparation)});
  }
  OpenSource all = join(std::move(sources));
  const auto* const cloud = std::get_if<PointCloud>(&all);
  if (!preparation.gridded || cloud == nullptr) return all;
  return std::make_unique<RasterInMemory>(raster_of_points(parts[0], *cloud));
}

Raster whole_of(const std::string& path, const RasterReader& raster) {
  const uint32_t width = raster.frame().width, height = raster.frame().height;
  if (std::max(width, height) > kLatticeMax + 1) {
    throw Error(path + " and others: " + std::to_string(width) + " x " + std::to_string(height) +
                " posts are too many for a stream: make a pack (.mtp)");
  }
  Raster whole = raster.read({0, 0, width, height});
  whole.selection = raster.frame().selection;
  return whole;
}

}  // namespace

FeatureFiles feature_files_of(const Preparation& preparation) {
  return FeatureFiles(preparation.indirect, preparation.texts, preparation.features);
}

namespace {

// Whether the map of bounds is a raster.
bool has_map_of_cells(const Preparation& preparation) {
  return !preparation.error_map.empty() &&
         !feature_files_of(preparation).has_features(preparation.error_map);
}

std::vector<std::string> feature_names_of(const Preparation& preparation) {
  std::vector<std::string> names;
  for (const std::string& name :
       {preparation.area, preparation.route, preparation.obstacles, preparation.breaklines,
        has_map_of_cells(preparation) ? std::string() : preparation.error_map}) {
    if (!name.empty()) names.push_back(name);
  }
  return names;
}

}  // namespace

std::vector<std::string> files_of(const std::string& path, const Preparation& preparation) {
  std::vector<std::string> files;
  std::vector<std::string> names = preparation.water_mask.empty()
                                       ? std::vector<std::string>()
                                       : std::vector<std::string>{preparation.water_mask};
  if (!preparation.cells.empty()) names.push_back(preparation.cells);
  if (has_map_of_cells(preparation)) names.push_back(preparation.error_map);
  if (!path.empty()) {
    const std::vector<std::string> parts = parts_of(path, preparation);
    names.insert(names.end(), parts.begin(), parts.end());
  }
  for (const std::string& name : names) {
    for (std::string& file : terrain_files(name, preparation.indirect)) {
      files.push_back(std::move(file));
    }
  }
  for (const std::string& name : feature_names_of(preparation)) {
    for (std::string& file : feature_files_of(preparation).files_of(name)) {
      files.push_back(std::move(file));
    }
  }
  return files;
}

void expect_systems(const Preparation& preparation, const Reference& terrain) {
  const FeatureFiles files = feature_files_of(preparation);
  if (!preparation.breaklines.empty()) note_breaklines(preparation.breaklines, files);
  for (const std::string& name : feature_names_of(preparation)) {
    const bool is_unread_pipe =
        name == preparation.breaklines && !files.is_for_gdal(name) && !files.is_noted(name);
    if (!is_unread_pipe) files.expect_system(name, terrain);
  }
}

namespace {

OpenSource prepared(const std::string& path, const std::vector<std::string>& parts,
                    const Preparation& preparation) {
  OpenSource source = open_parts(parts, preparation);
  auto* const raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
  if (raster == nullptr) {
    if (preparation.water_level) refuse_water(path);
    return source;
  }
  *raster = with_voids_filled(std::move(*raster), preparation.fill_voids);
  if (!preparation.water_level) return source;
  return with_file_context(path, [&]() -> OpenSource {
    return std::make_unique<FloodedRaster>(path, std::move(*raster), preparation);
  });
}

// One file is read without a detour.
Source prepared_file(const std::string& path, const std::string& file,
                     const Preparation& preparation) {
  Source source = settled(
      file, import_terrain(file, preparation.classes, preparation.indirect, preparation.band),
      preparation);
  auto* const raster = std::get_if<Raster>(&source);
  if (raster != nullptr) fill_voids(*raster, preparation.fill_voids);
  if (!preparation.water_level) return source;
  if (raster == nullptr) refuse_water(path);
  const auto water =
      WaterPlaces(*raster, preparation).read({0, 0, raster->width, raster->height}, *raster, {});
  with_file_context(
      path, [&] { flood_voids(*raster, *preparation.water_level, water ? &*water : nullptr); });
  return source;
}

Source without_bounds(const std::string& path, const Preparation& preparation) {
  const std::vector<std::string> parts = parts_of(path, preparation);
  if (parts.size() == 1 && !preparation.gridded) return prepared_file(path, parts[0], preparation);
  OpenSource source = prepared(path, parts, preparation);
  if (auto* const cloud = std::get_if<PointCloud>(&source)) return std::move(*cloud);
  return whole_of(parts[0], *std::get<std::unique_ptr<RasterReader>>(source));
}

bool has_area(const Preparation& preparation) {
  return !preparation.area.empty() || !preparation.route.empty();
}

Area area_of(const Preparation& preparation, const Reference& reference) {
  const FeatureFiles files = feature_files_of(preparation);
  Area area;
  if (!preparation.area.empty()) area.add_polygons(preparation.area, files);
  if (!preparation.route.empty() && preparation.route_width) {
    area.add_corridors(preparation.route, files, *preparation.route_width,
                       reference.horizontal_unit);
  }
  return area;
}

// The bounds of posts or points, if they have their own; those of `map` in place of the file's.
std::optional<BoundMap> bound_map_of(const Preparation& preparation, const Reference& terrain,
                                     std::optional<BoundMap> map = std::nullopt) {
  const std::optional<Decimal>&least = preparation.max_error, &edge = preparation.route_edge_error;
  const FeatureFiles files = feature_files_of(preparation);
  if (!map && !preparation.error_map.empty()) map.emplace(preparation.error_map, files, least);
  if (map) map->expect_system(terrain);
  if (!edge) return map;
  if (preparation.route.empty() || !preparation.route_width || !least) {
    throw Error(parameter("route_edge_error") + " needs " + parameter("route") + " and " +
                parameter("max_error"));
  }
  std::vector<Feature> bounds = route_bounds(preparation.route, files, *preparation.route_width,
                                             *least, *edge, terrain.horizontal_unit);
  if (map) {
    map->add(std::move(bounds));
  } else {
    map.emplace(preparation.route, std::move(bounds), *least);
  }
  return map;
}

[[noreturn]] void refuse_obstacles_of_points(const Preparation& preparation) {
  throw Error(preparation.obstacles + ": " + parameter("obstacles") +
              " is for rasters, and these are points");
}

void raise_to_obstacles(Source& source, const Preparation& preparation) {
  auto* const raster = std::get_if<Raster>(&source);
  if (raster == nullptr) refuse_obstacles_of_points(preparation);
  const std::string selection = raster->selection;
  Mended mended = raster->mended;
  const auto raised =
      Obstacles(preparation.obstacles, feature_files_of(preparation))
          .raised(std::make_unique<RasterInMemory>(std::move(*raster)), preparation.max_error);
  const Raster& frame = raised->frame();
  *raster = raised->read({0, 0, frame.width, frame.height});
  raster->selection = selection;
  mended.add(frame.mended);
  raster->mended = mended;
}

}  // namespace

void shape(Source& source, const Preparation& preparation, std::optional<BoundMap> map) {
  expect_systems(preparation, terrain::reference_of(source));
  if (has_area(preparation)) {
    const Area area = area_of(preparation, terrain::reference_of(source));
    std::visit([&](auto& one) { area.cut(one); }, source);
  }
  map = bound_map_of(preparation, terrain::reference_of(source), std::move(map));
  if (map) std::visit([&](auto& one) { map->bound(one); }, source);
  if (!preparation.obstacles.empty()) raise_to_obstacles(source, preparation);
}

Source prepared_terrain(const std::string& path, const Preparation& preparation,
                        std::optional<BoundMap> map) {
  Source source = without_bounds(path, preparation);
  shape(source, preparation, std::move(map));
  return source;
}

namespace {

const Reference& reference_of(const OpenSource& source) {
  if (const auto* const cloud = std::get_if<PointCloud>(&source)) return cloud->reference;
  return std::get<std::unique_ptr<RasterReader>>(source)->frame().reference;
}

void cut_to_area(OpenSource& source, const Preparation& preparation) {
  if (auto* const cloud = std::get_if<PointCloud>(&source)) {
    area_of(preparation, cloud->reference).cut(*cloud);
  } else {
    auto& raster = std::get<std::unique_ptr<RasterReader>>(source);
    Area area = area_of(preparation, raster->frame().reference);
    raster = within_area(std::move(raster), std::move(area));
  }
}

void add_bounds(OpenSource& source, const Preparation& preparation, std::optional<BoundMap> map) {
  if (auto* const cloud = std::get_if<PointCloud>(&source)) {
    map = bound_map_of(preparation, cloud->reference, std::move(map));
    if (map) map->bound(*cloud);
    return;
  }
  auto& raster = std::get<std::unique_ptr<RasterReader>>(source);
  map = bound_map_of(preparation, raster->frame().reference, std::move(map));
  if (!map) return;
  raster = with_bounds(std::move(raster), std::make_shared<const BoundMap>(std::move(*map)));
}

void raise_to_obstacles(OpenSource& source, const Preparation& preparation) {
  auto* const raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
  if (raster == nullptr) refuse_obstacles_of_points(preparation);
  *raster = Obstacles(preparation.obstacles, feature_files_of(preparation))
                .raised(std::move(*raster), preparation.max_error);
}

}  // namespace

OpenSource prepared_source(const std::string& path, const Preparation& preparation,
                           std::optional<BoundMap> map) {
  OpenSource source = prepared(path, parts_of(path, preparation), preparation);
  expect_systems(preparation, reference_of(source));
  if (has_area(preparation)) cut_to_area(source, preparation);
  add_bounds(source, preparation, std::move(map));
  if (!preparation.obstacles.empty()) raise_to_obstacles(source, preparation);
  return source;
}

namespace {

std::string counted_obstacles(uint64_t count) {
  return std::to_string(count) + (count == 1 ? " obstacle" : " obstacles");
}

}  // namespace

std::string describe_preparation(const Mended& mended, const std::string& selection) {
  std::string text;
  if (mended.filled != 0) {
    text += ", " + std::to_string(mended.filled) + " of the posts were void and are filled";
  }
  if (mended.flooded != 0) {
    text += ", " + std::to_string(mended.flooded) + " of the posts were void and are water";
  }
  if (mended.obstacles + mended.obstacles_elsewhere != 0) {
    text += ", raised to " + counted_obstacles(mended.obstacles);
  }
  if (mended.obstacles_elsewhere != 0) {
    text += "; " + counted_obstacles(mended.obstacles_elsewhere) +
            (mended.obstacles_elsewhere == 1 ? " lies elsewhere" : " lie elsewhere");
  }
  if (!selection.empty()) text += ", " + selection;
  return text;
}

}  // namespace microtin::importing
