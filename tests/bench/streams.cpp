// SPDX-License-Identifier: MIT
// The streams that are measured, written as files.
#include "encoder/files/output.hpp"
#include "encoder/stream/encode.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/speed.hpp"
#include "tests/bench/surface.hpp"

namespace microtin::bench {
namespace {

void write(const std::string& path, const Model& model, const Effort& effort = {}) {
  const Bytes stream = encode(model.tin, model.metadata, effort);
  OutputFile file(path);
  file.write({reinterpret_cast<const char*>(stream.data()), stream.size()});
  file.commit();
}

std::string file_name_of(const Dataset& dataset) {
  const auto& bound = dataset.options.max_error;
  return std::string(dataset.name) + (bound ? "_" + to_string(*bound) : "");
}

std::string path_of(const std::string& folder, const std::string& name) {
  return folder + "/" + name + ".mtin";
}

void write_uniform(const std::string& folder, const Effort& effort) {
  const std::string name =
      "2_uniform_80k_D" + std::to_string(usual_degree(effort)) + "_" + name_of(effort.coding);
  write(path_of(folder, name), {uniform_tin(80000, 0), {}}, effort);
}

}  // namespace

void write_curve_streams(const std::string& folder) {
  write(path_of(folder, "2_uniform_80k"), {uniform_tin(80000, 0), {}});
  write_uniform(folder, {0, Coding::kQuick});
  write_uniform(folder, {0, Coding::kDense});
  constexpr uint32_t kTileVertices = 2000;
  const std::vector<Dataset> grids = rasters();
  if (grids.empty()) return;
  const Dataset& first = grids.front();
  const Model tile = simplified(read_raster(first), first.options, kTileVertices);
  for (const Coding coding : kCodings) {
    write(path_of(folder, "tile_" + name_of(coding)), tile, {0, coding});
  }
}

void write_streams(const std::string& folder) {
  const auto path = [&](const std::string& name) { return path_of(folder, name); };
  write_curve_streams(folder);
  write(path("1_uniform_10k"), {uniform_tin(10000, 0), {}});
  write_uniform(folder, {8, Coding::kBalanced});
  write(path("3_uniform_1M"), {uniform_tin(1000000, 0), {}});
  for (const Dataset& dataset : rasters()) {
    write(path(file_name_of(dataset)), simplified(read_raster(dataset), dataset.options));
  }
  for (const Dataset& dataset : clouds()) {
    write(path(file_name_of(dataset)), simplified(read_cloud(dataset), dataset.options));
  }
}

}  // namespace microtin::bench
