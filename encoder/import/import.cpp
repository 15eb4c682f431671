// SPDX-License-Identifier: MIT
// Chooses the reader of a file by its suffix.
#include "encoder/import/import.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/crs.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {

namespace {

namespace fs = std::filesystem;

bool is_text_of_points(const std::string& suffix) {
  return suffix == ".xyz" || suffix == ".csv" || suffix == ".txt";
}

// Grids are found by their content where a name may be that of points.
bool is_grid_file(const std::string& path) {
  const std::string suffix = suffix_of(path);
  if (!is_text_of_points(suffix) || !is_regular_file(path)) return suffix == ".asc";
  constexpr uint64_t kHeadBytes = 4096;
  const std::unique_ptr<ByteSource> file = open_file(path);
  const std::vector<uint8_t> head = bytes_at(*file, 0, std::min(kHeadBytes, file->size()));
  return is_grid({reinterpret_cast<const char*>(head.data()), head.size()});
}

// A grid's well-known text is in a file next to it. Empty: there is none.
std::string system_file_of(const std::string& path) {
  if (!is_grid_file(path)) return "";
  for (const char* const suffix : {".prj", ".PRJ", ".Prj"}) {
    const fs::path file = fs::u8path(path).replace_extension(suffix);
    std::error_code none;
    if (fs::is_regular_file(file, none)) return file.string();
  }
  return "";
}

// An option may decide in its place, so that what is wrong with it is kept, not thrown.
Reference reference_beside(const std::string& path) {
  const std::string file = system_file_of(path);
  if (file.empty()) return {};
  Reference unread;
  try {
    const std::string text(without_mark(read_file(file)));
    if (is_wkt(text)) return reference_of_wkt(text);
    unread.unread = file +
                    ": is not well-known text of a coordinate system; write it with \"gdalsrsinfo "
                    "-o wkt_esri\", or set an EPSG code or units";
  } catch (const Error& error) {
    unread.unread = error.what();
  }
  return unread;
}

Source import_grid(const std::string& path, const std::string& text) {
  Raster raster = import_asc(path, text);
  raster.reference = reference_beside(path);
  return raster;
}

Source import_points_or_grid(const std::string& path, const std::string& text) {
  if (is_grid(text)) return import_grid(path, text);
  return import_points(path, text);
}

using Import = Source (*)(const std::string&, const std::string&);

// By suffix. Null: none of these.
Import importer_for(const std::string& suffix) {
  const std::map<std::string, Import> importers = {
      {".hgt",
       [](const auto& name, const auto& bytes) -> Source { return import_hgt(name, bytes); }},
      {".zip",
       [](const auto& name, const auto& bytes) -> Source { return import_zip(name, bytes); }},
      {".asc", import_grid},
      {".ply",
       [](const auto& name, const auto& bytes) -> Source { return import_ply(name, bytes); }},
      {".obj",
       [](const auto& name, const auto& text) -> Source { return import_obj(name, text); }}};
  if (is_text_of_points(suffix)) return import_points_or_grid;
  const auto found = importers.find(suffix);
  return found == importers.end() ? nullptr : found->second;
}

bool is_laser_scan(const std::string& suffix) {
  return suffix == ".las" || suffix == ".laz";
}

constexpr const char* kKinds =
    ".hgt, .zip, .asc, .xyz, .csv, .txt, .las, .laz, .ply, .obj"
#ifdef MICROTIN_WITH_GDAL
    ", .tif and others by GDAL";
#else
    "; for others use \"gdal_translate -of AAIGrid IN OUT.asc\", or build with "
    "-DMICROTIN_WITH_GDAL=ON";
#endif

#ifdef MICROTIN_WITH_GDAL
bool is_for_others(const std::string& path) {
  const std::string suffix = suffix_of(path);
  return path != "-" && !is_laser_scan(suffix) && importer_for(suffix) == nullptr;
}

// GDAL has names of its own, and folders. Pipes and devices it refuses in words that help nobody.
Source import_other(const std::string& path, Indirect indirect, uint32_t band) {
  std::error_code none;
  if (fs::exists(fs::u8path(path), none) && !fs::is_directory(fs::u8path(path), none)) {
    open_file(path);  // throws Error if it cannot be read in pieces
  }
  return import_gdal(path, indirect, band);
}
#else
Source import_other(const std::string& path, Indirect, uint32_t) {
  open_file(path);  // throws Error if it is not there
  throw Error(path + ": is not a kind of terrain file that microtin reads: " + kKinds);
}
#endif

// Whether a file is one that GDAL reads and that folders hold sheets in.
bool is_sheet_for_others([[maybe_unused]] const std::string& suffix) {
#ifdef MICROTIN_WITH_GDAL
  for (const char* const known :
       {".tif", ".tiff", ".dem", ".dt0", ".dt1", ".dt2", ".bil", ".flt", ".bt", ".grd"}) {
    if (suffix == known) return true;
  }
#endif
  return false;
}

void expect_source(const std::string& path) {
  const std::string suffix = suffix_of(path);
  if (suffix != ".mtin" && suffix != ".mtp") return;
  throw Error(path + ": is " + (suffix == ".mtp" ? "a pack" : "a stream") +
              ", which \"microtin decode\" turns into a terrain file");
}

}  // namespace

std::string terrain_kinds() {
  return kKinds;
}

bool is_terrain_suffix(const std::string& suffix) {
  return is_laser_scan(suffix) || importer_for(suffix) != nullptr || is_sheet_for_others(suffix);
}

std::vector<std::string> terrain_files(const std::string& path,
                                       [[maybe_unused]] Indirect indirect) {
  expect_source(path);
#ifdef MICROTIN_WITH_GDAL
  if (is_for_others(path)) return gdal_files(path, indirect);
#endif
  std::vector<std::string> files = {path};
  if (const std::string system = system_file_of(path); !system.empty()) files.push_back(system);
  return files;
}

Source import_terrain(const std::string& path, const std::optional<ClassSet>& classes,
                      Indirect indirect, uint32_t band) {
  const std::string suffix = suffix_of(path);
  expect_source(path);
  if (is_laser_scan(suffix)) return import_las(path, read_file(path), classes);
  if (classes) throw Error(path + ": only .las and .laz files have classes");
  if (path == "-") return import_points_or_grid("standard input", read_file(path));
  const Import import = importer_for(suffix);
  if (import == nullptr) return import_other(path, indirect, band);
  return import(path, read_file(path));
}

OpenSource open_terrain(const std::string& path, const std::optional<ClassSet>& classes,
                        Indirect indirect, uint32_t band) {
  const std::string suffix = suffix_of(path);
  if (!classes && suffix == ".hgt") return open_hgt(path, open_file(path));
  if (!classes && is_grid_file(path)) {
    return open_asc(path, open_file(path), reference_beside(path));
  }
  Source source = import_terrain(path, classes, indirect, band);
  if (auto* const cloud = std::get_if<PointCloud>(&source)) return std::move(*cloud);
  return std::make_unique<RasterInMemory>(std::move(std::get<Raster>(source)));
}

}  // namespace microtin::importing
