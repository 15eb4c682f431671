// SPDX-License-Identifier: MIT
#include "encoder/import/folder.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "encoder/base/error.hpp"
#include "encoder/base/suffix.hpp"
#include "encoder/files/byte_source.hpp"
#include "encoder/import/import.hpp"

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

}  // namespace microtin::importing
