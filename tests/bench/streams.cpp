// SPDX-License-Identifier: MIT
#include "encoder/files/output_file.hpp"
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

std::string name_of(const Dataset& dataset) {
  const auto& bound = dataset.options.max_error;
  return std::string(dataset.name) + (bound ? "_" + to_string(*bound) : "");
}

}  // namespace

void write_streams(const std::string& folder) {
  const auto path = [&](const std::string& name) { return folder + "/" + name + ".mtin"; };
  write(path("1_uniform_10k"), {uniform_tin(10000, 0), {}});
  write(path("2_uniform_80k"), {uniform_tin(80000, 0), {}});
  for (const Effort& effort : {Effort{8, 2}, Effort{10, 1}, Effort{10, 3}}) {
    write(path("2_uniform_80k_D" + std::to_string(effort.degree) + "_levels" +
               std::to_string(effort.levels)),
          {uniform_tin(80000, 0), {}}, effort);
  }
  write(path("3_uniform_1M"), {uniform_tin(1000000, 0), {}});
  const std::vector<Dataset> grids = rasters();
  for (const Dataset& dataset : grids) {
    write(path(name_of(dataset)), simplified(read_raster(dataset), dataset.options));
  }
  for (const Dataset& dataset : clouds()) {
    write(path(name_of(dataset)), simplified(read_cloud(dataset), dataset.options));
  }
  constexpr uint32_t kTileVertices = 2000;
  if (!grids.empty()) {
    const Dataset& first = grids.front();
    const Model tile = simplified(read_raster(first), first.options, kTileVertices);
    for (const uint32_t levels : {1u, 2u, 3u}) {
      write(path("tile_levels" + std::to_string(levels)), tile, {Effort().degree, levels});
    }
  }
}

}  // namespace microtin::bench
