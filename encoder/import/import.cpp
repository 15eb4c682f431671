// Chooses the reader of a file by its suffix.
#include "encoder/import/import.hpp"

#include <filesystem>
#include <map>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/files/input_file.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {

namespace {

Source import_other(const std::string& path) {
#ifdef MICROTIN_WITH_GDAL
  return import_gdal(path);
#else
  throw Error(path +
              ": not a kind of terrain file known here (.hgt, .zip, .asc, .xyz, .csv, .txt, .las, "
              ".ply, .obj); for others use \"gdal_translate -of AAIGrid IN OUT.asc\", or build "
              "with -DMICROTIN_WITH_GDAL=ON");
#endif
}

}  // namespace

Source import_terrain(const std::string& path, const std::optional<ClassSet>& classes) {
  using Import = Source (*)(const std::string&, const std::string&);
  const Import points = [](const auto& name, const auto& text) -> Source {
    return import_points(name, text);
  };
  const std::map<std::string, Import> importers = {
      {".xyz", points},
      {".csv", points},
      {".txt", points},
      {".hgt",
       [](const auto& name, const auto& bytes) -> Source { return import_hgt(name, bytes); }},
      {".zip",
       [](const auto& name, const auto& bytes) -> Source { return import_zip(name, bytes); }},
      {".asc", [](const auto& name, const auto& text) -> Source { return import_asc(name, text); }},
      {".ply",
       [](const auto& name, const auto& bytes) -> Source { return import_ply(name, bytes); }},
      {".obj",
       [](const auto& name, const auto& text) -> Source { return import_obj(name, text); }}};
  const std::string suffix = lower_case(std::filesystem::path(path).extension().string());
  if (suffix == ".las" || suffix == ".laz") return import_las(path, read_file(path), classes);
  if (classes) throw Error(path + ": only .las files have classes");
  if (path == "-") return import_points("standard input", read_file(path));
  const auto found = importers.find(suffix);
  if (found == importers.end()) return import_other(path);
  return found->second(path, read_file(path));
}

OpenSource open_terrain(const std::string& path, const std::optional<ClassSet>& classes) {
  const std::string suffix = lower_case(std::filesystem::path(path).extension().string());
  if (!classes && suffix == ".hgt") return open_hgt(path, open_file(path));
  if (!classes && suffix == ".asc") return open_asc(path, open_file(path));
  Source source = import_terrain(path, classes);
  if (auto* const cloud = std::get_if<PointCloud>(&source)) return std::move(*cloud);
  return std::make_unique<RasterInMemory>(std::move(std::get<Raster>(source)));
}

}  // namespace microtin::importing
