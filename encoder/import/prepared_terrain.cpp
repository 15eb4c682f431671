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
#include "encoder/files/input.hpp"
#include "encoder/import/import.hpp"
#include "encoder/import/mosaic.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/terrain/clouds.hpp"
#include "encoder/terrain/voids.hpp"
#include "encoder/terrain/water.hpp"
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
  const fs::directory_iterator entries(folder, error);
  if (error) throw Error(folder + ": cannot be read: " + error.message());
  for (const auto& entry : entries) {
    const std::string path = entry.path().string(), suffix = suffix_of(path);
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
  if (!fs::is_directory(path, none)) return {path};
  const FilesBySuffix by_suffix = terrain_files_in(path);
  if (by_suffix.empty()) throw Error(path + ": holds no terrain file: " + terrain_kinds());
  std::vector<std::string> files = most_of(by_suffix)->second;
  std::sort(files.begin(), files.end());
  return files;
}

std::string left_out_of(const std::string& path) {
  std::error_code none;
  if (!fs::is_directory(path, none)) return "";
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
  if (mask == nullptr) throw Error(path + ": is not a raster");
  with_file_context(path, [&] { check_water_mask((*mask)->frame(), frame); });
  return std::move(*mask);
}

[[noreturn]] void refuse_water(const std::string& path) {
  throw Error(path + ": " + parameter("water_level") + " is for rasters, and these are points");
}

// Reads a raster with its water.
class FloodedRaster : public RasterReader {
 public:
  FloodedRaster(const std::string& path, std::unique_ptr<RasterReader> raster, Decimal level,
                std::string mask_path)
      : path_(path), raster_(std::move(raster)), level_(level), mask_path_(std::move(mask_path)) {
    frame_ = raster_->frame();
    flood_voids(frame_, level_, nullptr);
    if (!mask_path_.empty()) mask_ = open_mask(mask_path_, frame_);
  }

  Raster read(const PostRectangle& rectangle) const override {
    Raster part = raster_->read(rectangle);
    std::optional<Raster> mask;
    if (mask_) {
      mask = mask_->read(rectangle);
      with_file_context(mask_path_, [&] { check_water_mask(*mask, part); });
    }
    with_file_context(path_, [&] { flood_voids(part, level_, mask ? &*mask : nullptr); });
    return part;
  }

 private:
  std::string path_;
  std::unique_ptr<RasterReader> raster_, mask_;
  Decimal level_;
  std::string mask_path_;
};

Raster read_mask(const std::string& path, const Raster& raster) {
  Raster all = open_mask(path, raster)->read({0, 0, raster.width, raster.height});
  with_file_context(path, [&] { check_water_mask(all, raster); });
  return all;
}

// The files that make up a terrain.
std::vector<std::string> parts_of(const std::string& path, const Preparation& preparation) {
  std::vector<std::string> parts = files_in(path);
  for (const std::string& more : preparation.more_files) {
    for (std::string& file : files_in(more)) parts.push_back(std::move(file));
  }
  return parts;
}

template <class AnySource>
AnySource settled(const std::string& path, AnySource source, const Preparation& preparation) {
  if (!preparation.asked) return source;
  with_file_context(path, [&] { settle_source(source, *preparation.asked); });
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

// One file is read without a detour.
Source read_parts(const std::vector<std::string>& parts, const Preparation& preparation) {
  if (parts.size() == 1 && !preparation.gridded) {
    Source source =
        import_terrain(parts[0], preparation.classes, preparation.indirect, preparation.band);
    return settled(parts[0], std::move(source), preparation);
  }
  OpenSource source = open_parts(parts, preparation);
  if (auto* const cloud = std::get_if<PointCloud>(&source)) return std::move(*cloud);
  const RasterReader& raster = *std::get<std::unique_ptr<RasterReader>>(source);
  const uint32_t width = raster.frame().width, height = raster.frame().height;
  if (std::max(width, height) > kLatticeMax + 1) {
    throw Error(parts[0] + " and others: " + std::to_string(width) + " x " +
                std::to_string(height) + " posts are too many for a stream: make a pack (.mtp)");
  }
  Raster whole = raster.read({0, 0, width, height});
  whole.selection = raster.frame().selection;
  return whole;
}

}  // namespace

std::vector<std::string> files_of(const std::string& path, const Preparation& preparation) {
  std::vector<std::string> files;
  std::vector<std::string> names = preparation.water_mask.empty()
                                       ? std::vector<std::string>()
                                       : std::vector<std::string>{preparation.water_mask};
  if (!path.empty()) {
    const std::vector<std::string> parts = parts_of(path, preparation);
    names.insert(names.end(), parts.begin(), parts.end());
  }
  for (const std::string& name : names) {
    for (std::string& file : terrain_files(name, preparation.indirect)) {
      files.push_back(std::move(file));
    }
  }
  return files;
}

Source prepared_terrain(const std::string& path, const Preparation& preparation) {
  Source source = read_parts(parts_of(path, preparation), preparation);
  auto* const raster = std::get_if<Raster>(&source);
  if (raster != nullptr) fill_voids(*raster, preparation.fill_voids);
  if (!preparation.water_level) return source;
  if (raster == nullptr) refuse_water(path);
  std::optional<Raster> mask;
  if (!preparation.water_mask.empty()) mask = read_mask(preparation.water_mask, *raster);
  with_file_context(
      path, [&] { flood_voids(*raster, *preparation.water_level, mask ? &*mask : nullptr); });
  return source;
}

OpenSource prepared_source(const std::string& path, const Preparation& preparation) {
  OpenSource source = open_parts(parts_of(path, preparation), preparation);
  auto* const raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
  if (raster == nullptr) {
    if (preparation.water_level) refuse_water(path);
    return source;
  }
  *raster = with_voids_filled(std::move(*raster), preparation.fill_voids);
  if (!preparation.water_level) return source;
  return with_file_context(path, [&]() -> OpenSource {
    return std::make_unique<FloodedRaster>(path, std::move(*raster), *preparation.water_level,
                                           preparation.water_mask);
  });
}

std::string describe_preparation(const Mended& mended, const std::string& selection) {
  std::string text;
  if (mended.filled != 0) {
    text += ", " + std::to_string(mended.filled) + " of the posts were void and are filled";
  }
  if (mended.flooded != 0) {
    text += ", " + std::to_string(mended.flooded) + " of the posts were void and are water";
  }
  if (!selection.empty()) text += ", " + selection;
  return text;
}

}  // namespace microtin::importing
