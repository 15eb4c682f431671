// SPDX-License-Identifier: MIT
// A mesh driver for MDAL, the library by which QGIS reads meshes: the C functions that it looks for
// in a plugin, with its names. A mesh has one group of data, the heights of its vertices.
#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <memory>
#include <microtin/surface.hpp>
#include <mutex>
#include <stdexcept>

#define MICROTIN_MDAL extern "C" __attribute__((visibility("default")))

namespace {

using microtin::encoder::Box;
using microtin::encoder::Mesh;
using microtin::encoder::Surface;
using microtin::encoder::SurfaceInfo;

struct Opened {
  Mesh mesh;
  Box box;
  std::string system;
};

// Open meshes by their numbers; QGIS calls from several threads.
class Meshes {
 public:
  int add(Opened opened) {
    const std::lock_guard<std::mutex> lock(mutex_);
    meshes_.emplace(++last_, std::make_shared<const Opened>(std::move(opened)));
    return last_;
  }
  void remove(int id) {
    const std::lock_guard<std::mutex> lock(mutex_);
    meshes_.erase(id);
  }
  // Null if there is none.
  std::shared_ptr<const Opened> find(int id) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = meshes_.find(id);
    return found == meshes_.end() ? nullptr : found->second;
  }

 private:
  mutable std::mutex mutex_;
  std::map<int, std::shared_ptr<const Opened>> meshes_;
  int last_ = 0;
};

Meshes& meshes() {
  static Meshes all;
  return all;
}

// What MDAL gives to QGIS, which knows codes and well-known text.
std::string system_of(const SurfaceInfo& info) {
  if (info.horizontal_epsg != 0) return "EPSG:" + std::to_string(info.horizontal_epsg);
  return info.wkt;
}

Opened open(const char* path) {
  const Surface surface = Surface::from_file(path);
  Mesh mesh = surface.mesh();
  constexpr size_t kMost = std::numeric_limits<int>::max() / 3;
  if (mesh.vertices.size() > kMost || mesh.triangles.size() > kMost) {
    throw std::runtime_error("too many vertices for MDAL");
  }
  return {std::move(mesh), surface.info().box, system_of(surface.info())};
}

// Those of `count` things from `start` on that are there.
struct Range {
  size_t first, count;
};

Range available(size_t all, int start, int count) {
  if (start < 0 || count < 0) return {0, 0};
  const size_t first = std::min(all, static_cast<size_t>(start));
  return {first, std::min(all - first, static_cast<size_t>(count))};
}

}  // namespace

MICROTIN_MDAL const char* MDAL_DRIVER_driverName() {
  return "MICROTIN";
}

MICROTIN_MDAL const char* MDAL_DRIVER_driverLongName() {
  return "microtin terrain: stream or pack";
}

MICROTIN_MDAL const char* MDAL_DRIVER_filters() {
  return "*.mtin *.mtp";
}

MICROTIN_MDAL int MDAL_DRIVER_capabilities() {
  return 1;  // reads meshes
}

MICROTIN_MDAL int MDAL_DRIVER_maxVertexPerFace() {
  return 3;
}

MICROTIN_MDAL bool MDAL_DRIVER_canReadMesh(const char* path) {
  std::ifstream file(path, std::ios::binary);
  uint8_t begin[8] = {};
  file.read(reinterpret_cast<char*>(begin), sizeof begin);
  const uint8_t* note = nullptr;
  uint32_t size = 0;
  if (std::memcmp(begin, "mtsh", 4) == 0) return true;  // a shard, which opening names as such
  return file &&
         microtin_find_note(begin, sizeof begin, 0, &note, &size) != MICROTIN_STATUS_BAD_MAGIC;
}

// The number of the mesh, -1 if it cannot be read. QGIS has no place for the reason.
MICROTIN_MDAL int MDAL_DRIVER_openMesh(const char* path, const char* /*name*/) {
  try {
    return meshes().add(open(path));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "microtin: %s\n", error.what());
    return -1;
  }
}

MICROTIN_MDAL void MDAL_DRIVER_closeMesh(int id) {
  meshes().remove(id);
}

MICROTIN_MDAL int MDAL_DRIVER_M_vertexCount(int id) {
  const auto opened = meshes().find(id);
  return opened ? static_cast<int>(opened->mesh.vertices.size()) : -1;
}

MICROTIN_MDAL int MDAL_DRIVER_M_faceCount(int id) {
  const auto opened = meshes().find(id);
  return opened ? static_cast<int>(opened->mesh.triangles.size()) : -1;
}

MICROTIN_MDAL int MDAL_DRIVER_M_edgeCount(int /*id*/) {
  return 0;
}

MICROTIN_MDAL void MDAL_DRIVER_M_extent(int id, double* west, double* east, double* south,
                                        double* north) {
  const auto opened = meshes().find(id);
  const Box box = opened ? opened->box : Box();
  *west = box.west;
  *east = box.east;
  *south = box.south;
  *north = box.north;
}

// Valid as long as the mesh is open.
MICROTIN_MDAL const char* MDAL_DRIVER_M_projection(int id) {
  const auto opened = meshes().find(id);
  return opened ? opened->system.c_str() : "";
}

// x, y, z of each.
MICROTIN_MDAL int MDAL_DRIVER_M_vertices(int id, int start, int count, double* to) {
  const auto opened = meshes().find(id);
  if (!opened) return -1;
  const Range range = available(opened->mesh.vertices.size(), start, count);
  for (size_t i = 0; i < range.count; ++i) {
    to = std::copy_n(opened->mesh.vertices[range.first + i].begin(), 3, to);
  }
  return static_cast<int>(range.count);
}

MICROTIN_MDAL int MDAL_DRIVER_M_edges(int /*id*/, int /*start*/, int /*count*/, int* /*starts*/,
                                      int* /*ends*/) {
  return 0;
}

// The corners of each, and behind which of them it ends.
MICROTIN_MDAL int MDAL_DRIVER_M_faces(int id, int start, int count, int* ends, int corner_count,
                                      int* corners) {
  const auto opened = meshes().find(id);
  if (!opened) return -1;
  const Range range =
      available(opened->mesh.triangles.size(), start, std::min(count, corner_count / 3));
  for (size_t i = 0; i < range.count; ++i) {
    const auto& triangle = opened->mesh.triangles[range.first + i];
    corners = std::transform(triangle.begin(), triangle.end(), corners,
                             [](uint32_t corner) { return static_cast<int>(corner); });
    ends[i] = 3 * static_cast<int>(i + 1);
  }
  return static_cast<int>(range.count);
}

// --- The group of heights, and its one dataset ---

MICROTIN_MDAL int MDAL_DRIVER_M_datasetGroupCount(int /*id*/) {
  return 1;
}

MICROTIN_MDAL const char* MDAL_DRIVER_G_groupName(int /*id*/, int /*group*/) {
  return "Height";
}

MICROTIN_MDAL const char* MDAL_DRIVER_G_referenceTime(int /*id*/, int /*group*/) {
  return "";
}

MICROTIN_MDAL int MDAL_DRIVER_G_metadataCount(int /*id*/, int /*group*/) {
  return 0;
}

MICROTIN_MDAL const char* MDAL_DRIVER_G_metadataKey(int /*id*/, int /*group*/, int /*item*/) {
  return "";
}

MICROTIN_MDAL const char* MDAL_DRIVER_G_metadataValue(int /*id*/, int /*group*/, int /*item*/) {
  return "";
}

MICROTIN_MDAL bool MDAL_DRIVER_G_datasetsDescription(int /*id*/, int /*group*/, bool* is_scalar,
                                                     int* location, int* datasets) {
  *is_scalar = true;
  *location = 1;  // vertices
  *datasets = 1;
  return true;
}

MICROTIN_MDAL double MDAL_DRIVER_D_time(int /*id*/, int /*group*/, int /*dataset*/,
                                        bool* is_valid) {
  *is_valid = true;
  return 0;
}

MICROTIN_MDAL int MDAL_DRIVER_D_data(int id, int /*group*/, int /*dataset*/, int start, int count,
                                     double* to) {
  const auto opened = meshes().find(id);
  if (!opened) return -1;
  const Range range = available(opened->mesh.vertices.size(), start, count);
  for (size_t i = 0; i < range.count; ++i) to[i] = opened->mesh.vertices[range.first + i][2];
  return static_cast<int>(range.count);
}

MICROTIN_MDAL void MDAL_DRIVER_D_unload(int /*id*/, int /*group*/, int /*dataset*/) {}

MICROTIN_MDAL bool MDAL_DRIVER_D_hasActiveFlagCapability(int /*id*/, int /*group*/,
                                                         int /*dataset*/) {
  return false;
}

MICROTIN_MDAL int MDAL_DRIVER_D_activeFlags(int /*id*/, int /*group*/, int /*dataset*/,
                                            int /*start*/, int /*count*/, int* /*to*/) {
  return 0;
}
