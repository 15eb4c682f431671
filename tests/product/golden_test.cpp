// SPDX-License-Identifier: MIT
// Golden files through the public faces in C++ and C: the heights that devices report, and why
// files are refused.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "microtin/encoder.h"
#include "microtin/surface.hpp"
#include "tests/support/paths.hpp"

namespace microtin::tests {
namespace {

using encoder::coordinate;
using encoder::Surface;
using encoder::SurfaceInfo;

struct Free {
  void operator()(microtin_surface* surface) const { microtin_surface_free(surface); }
};
using SurfaceInC = std::unique_ptr<microtin_surface, Free>;

// Null if the file is refused; microtin_last_error() has the reason.
SurfaceInC opened_in_c(const std::string& path) {
  microtin_surface* surface = nullptr;
  const microtin_status status = microtin_surface_from_file(path.c_str(), &surface);
  CHECK((status == MICROTIN_STATUS_OK) == (surface != nullptr));
  return SurfaceInC(surface);
}

// Positions in substeps and heights in z steps with 16 fractional bits; NaN: none.
struct Probes {
  std::vector<int64_t> x, y;
  std::vector<double> z;
};

double real(const microtin_axis& axis, int64_t substeps) {
  const double steps = static_cast<double>(substeps) / 256;
  return (static_cast<double>(axis.offset) + static_cast<double>(axis.numerator) * steps) /
         static_cast<double>(axis.denominator);
}

void check_heights(const Surface& surface, microtin_surface* in_c, const Probes& probes) {
  const SurfaceInfo& info = surface.info();
  std::vector<double> x, y, heights(probes.x.size()), heights_in_c(probes.x.size());
  for (size_t i = 0; i < probes.x.size(); ++i) {
    x.push_back(real(info.x, probes.x[i]));
    y.push_back(real(info.y, probes.y[i]));
  }
  surface.heights(x.size(), x.data(), y.data(), heights.data());
  CHECK(microtin_surface_heights(in_c, x.size(), x.data(), y.data(), heights_in_c.data()) ==
        MICROTIN_STATUS_OK);
  const double step =
      static_cast<double>(info.z.numerator) / static_cast<double>(info.z.denominator);
  for (size_t i = 0; i < x.size(); ++i) {
    CAPTURE(probes.x[i]);
    CAPTURE(probes.y[i]);
    const double expected = coordinate(info.z, 0) + probes.z[i] / 65536 * step;
    CHECK(std::isnan(heights[i]) == std::isnan(expected));
    if (!std::isnan(expected)) CHECK(std::fabs(heights[i] - expected) <= step / 65536);
    CHECK(
        (heights[i] == heights_in_c[i] || (std::isnan(heights[i]) && std::isnan(heights_in_c[i]))));
  }
}

// A report: the number of vertices, and the heights at 64 positions.
Probes read_report(const std::string& path, uint64_t& vertices) {
  std::ifstream report(path);
  Probes probes;
  std::string name, digest;
  int status = -1;
  report >> name >> status >> name >> vertices >> name >> digest;
  REQUIRE(status == 0);
  for (std::string x, y, z; report >> x >> y >> z;) {
    if (z == "none:") report >> name;
    probes.x.push_back(std::stoll(x));
    probes.y.push_back(std::stoll(y));
    probes.z.push_back(z == "none:" ? std::nan("") : std::stod(z));
  }
  REQUIRE(probes.x.size() == 64);
  return probes;
}

std::string reason_of(const std::string& path) {
  try {
    const Surface surface = Surface::from_file(path);
    return "";
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

void check_refused(const std::string& path, const std::string& reason) {
  CAPTURE(path);
  CHECK(reason_of(path).find(reason) != std::string::npos);
  CHECK(opened_in_c(path) == nullptr);
  CHECK(microtin_last_error() == reason_of(path));
}

// Reasons by the first words of refused streams, and by the words of the second decoder. A host has
// room for each terrain, and finds that those which are too big for others have too few bytes.
const std::map<std::string, std::string>& reasons() {
  static const std::map<std::string, std::string> all = {
      {"bad", base::describe(MICROTIN_STATUS_BAD_MAGIC)},
      {"foreign", base::describe(MICROTIN_STATUS_BAD_MAGIC)},
      {"unsupported", base::describe(MICROTIN_STATUS_UNSUPPORTED_VERSION)},
      {"checksum", base::describe(MICROTIN_STATUS_CHECKSUM)},
      {"damaged", base::describe(MICROTIN_STATUS_CHECKSUM)},
      {"malformed", base::describe(MICROTIN_STATUS_MALFORMED)},
      {"too", "its header has more vertices than its bytes can hold"},
      {"truncated", base::describe(MICROTIN_STATUS_TRUNCATED)}};
  return all;
}

// The tile of a pack has terrain, or none, or is bad, in C++ and in C.
void check_tile(const Surface& surface, microtin_surface* in_c, uint32_t tile,
                const std::string& recorded) {
  CAPTURE(tile);
  const uint32_t columns = surface.info().tile_columns;
  const uint32_t column = tile % columns, row = tile / columns;
  microtin_triangles triangles{};
  triangles.size = sizeof triangles;
  const microtin_status status = microtin_surface_tile(in_c, column, row, &triangles);
  const bool is_bad = recorded == "unsupported" || recorded == "damaged";
  CHECK((status != MICROTIN_STATUS_OK) == is_bad);
  if (is_bad) {
    CHECK_THROWS_AS(surface.tile(column, row), std::runtime_error);
    return;
  }
  const encoder::Mesh mesh = surface.tile(column, row);
  CHECK(mesh.vertices.empty() == (recorded == "no terrain"));
  CHECK(mesh.vertices.size() == triangles.vertices);
  CHECK(mesh.triangles.size() == triangles.triangles);
}

void check_pack(const std::filesystem::path& path, std::istream& digests) {
  const Surface surface = Surface::from_file(path.string());
  const SurfaceInC in_c = opened_in_c(path.string());
  REQUIRE(in_c);
  uint32_t tile = 0;
  for (std::string line, recorded; std::getline(digests, line) && std::getline(digests, recorded);
       ++tile) {
    CHECK(line == "tile " + std::to_string(tile));
    check_tile(surface, in_c.get(), tile, recorded);
  }
  CHECK(tile == surface.info().tile_columns * surface.info().tile_rows);
}

}  // namespace

TEST_CASE("golden files: streams have the recorded heights in C++ and in C") {
  uint32_t streams = 0;
  for (const auto& entry : std::filesystem::directory_iterator(golden_folder())) {
    if (entry.path().extension() != ".mtin") continue;
    CAPTURE(entry.path().string());
    uint64_t vertices = 0;
    const Probes probes = read_report(
        std::filesystem::path(entry.path()).replace_extension("report").string(), vertices);
    const Surface surface = Surface::from_file(entry.path().string());
    const SurfaceInC in_c = opened_in_c(entry.path().string());
    REQUIRE(in_c);
    CHECK(surface.info().vertices == vertices);
    check_heights(surface, in_c.get(), probes);
    ++streams;
  }
  CHECK(streams == 18);
}

TEST_CASE("golden files: refused streams are refused for the recorded reason in C++ and in C") {
  uint32_t streams = 0;
  for (const auto& entry : std::filesystem::directory_iterator(golden_folder() / "refused")) {
    const std::string name = entry.path().stem().string();
    check_refused(entry.path().string(), reasons().at(name.substr(0, name.find('_'))));
    ++streams;
  }
  CHECK(streams == 52);
}

TEST_CASE("golden files: tiles of packs are as recorded in C++ and in C") {
  uint32_t packs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(golden_folder())) {
    if (entry.path().extension() != ".mtp") continue;
    CAPTURE(entry.path().string());
    ++packs;
    std::ifstream digests(std::filesystem::path(entry.path()).replace_extension("digests"));
    std::string first;
    std::getline(digests, first);
    if (const auto refusal = reasons().find(first); refusal != reasons().end()) {
      check_refused(entry.path().string(), refusal->second);
      continue;
    }
    digests.seekg(0);
    check_pack(entry.path(), digests);
  }
  CHECK(packs == 16);
}

}  // namespace microtin::tests
