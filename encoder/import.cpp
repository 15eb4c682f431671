#include "encoder/import.hpp"

#include <filesystem>

#include "encoder/error.hpp"
#include "encoder/import_text.hpp"
#include "encoder/input_file.hpp"

namespace microtin {

Source import_terrain(const std::string& path) {
  if (path == "-") return import_points("standard input", read_file(path));
  const std::string suffix = lower_case(std::filesystem::path(path).extension().string());
  const bool points = suffix == ".xyz" || suffix == ".csv" || suffix == ".txt";
  if (!points && suffix != ".hgt" && suffix != ".asc") {
    throw Error(path + ": not a kind of terrain file known here (.hgt, .asc, .xyz, .csv, .txt)");
  }
  const std::string content = read_file(path);
  if (points) return import_points(path, content);
  if (suffix == ".hgt") return import_hgt(path, content);
  return import_asc(path, content);
}

}  // namespace microtin
