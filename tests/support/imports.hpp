// SPDX-License-Identifier: MIT
// What tests of importers share.
#ifndef MICROTIN_TESTS_SUPPORT_IMPORTS_HPP
#define MICROTIN_TESTS_SUPPORT_IMPORTS_HPP

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/terrain/source.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/paths.hpp"

namespace microtin::tests {

// The message that an import ends with.
template <class Import>
std::string import_error(const Import& import) {
  try {
    import();
  } catch (const Error& error) {
    return error.what();
  }
  return "none";
}

// The points as "x,y,z x,y,z ..." in the cloud's integers.
inline std::string text_of(const PointCloud& cloud) {
  std::string all;
  for (const SourcePoint& p : cloud.points) {
    all += (all.empty() ? "" : " ") + std::to_string(p.x) + "," + std::to_string(p.y) + "," +
           std::to_string(p.z);
  }
  return all;
}

// The path of a file that is no part of the project; empty if it is not here.
inline std::string data_file(const std::string& name) {
  const std::filesystem::path path = data_folder() / "formats" / name;
  if (std::filesystem::exists(path)) return path.string();
  MESSAGE("skipped: " << name << " is not here");
  return "";
}

}  // namespace microtin::tests

#endif
