// SPDX-License-Identifier: MIT
// Bytes of terrains, compared with other programs.
#include "encoder/stream/encode.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/peers/peers.hpp"
#include "tests/bench/rate.hpp"
#include "tests/bench/table.hpp"

namespace microtin::bench {
namespace {

std::string label(const Dataset& dataset) {
  const auto text = [](const std::optional<Decimal>& value) {
    return value ? to_string(*value) : "-";
  };
  return std::string(dataset.name) + " " + text(dataset.options.max_error) + " / " +
         text(dataset.options.z_step);
}

class TerrainRate {
 public:
  TerrainRate() {
    Row head{"terrain, error / z step",
             "vertices",
             "xy floor",
             "microtin, bytes",
             "bits/vertex",
             "quick, bytes",
             "dense, bytes"};
    for (const Codec& peer : peers_) {
      head.push_back(peer.name + ", bytes");
      head.push_back("ratio");
    }
    print_head("Terrain: x, y, z and triangles, whole file; ratio: microtin / peer", head);
  }

  void add(const Dataset& dataset, const Source& source) {
    const Model model = simplified(source, dataset.options);
    const Bytes stream = encode(model.tin, model.metadata);
    const Surface surface = surface_of(stream);
    const auto size = static_cast<double>(stream.size());
    const size_t vertices = surface.vertices.size();
    Row row{label(dataset), number(vertices), number(floor_bits(surface), 2), number(stream.size()),
            number(8 * size / static_cast<double>(vertices), 2)};
    for (const Coding coding : {Coding::kQuick, Coding::kDense}) {
      const Effort effort{0, coding};
      const size_t bytes = encode(model.tin, model.metadata, effort).size();
      decoding_means_[coding == Coding::kDense].add(static_cast<double>(bytes) / size);
      row.push_back(number(bytes));
    }
    for (size_t i = 0; i < peers_.size(); ++i) {
      const size_t peer_size = checked_encode(peers_[i], surface).size();
      const double ratio = size / static_cast<double>(peer_size);
      means_[i].add(ratio);
      row.push_back(number(peer_size));
      row.push_back(number(ratio, 3));
    }
    print_row(row);
  }

  void print_means() const {
    Row row{"geometric mean", "", "", "", ""};
    for (const GeometricMean& mean : decoding_means_) {
      row.push_back("x " + number(mean.value(), 3));
    }
    for (const GeometricMean& mean : means_) {
      row.push_back("");
      row.push_back(number(mean.value(), 3));
    }
    print_row(row);
  }

 private:
  const std::vector<Codec> peers_ = dense_codecs();
  GeometricMean decoding_means_[2];
  std::vector<GeometricMean> means_ = std::vector<GeometricMean>(peers_.size());
};

}  // namespace

void print_terrain_rate() {
  const std::vector<Dataset> grids = rasters(), surveys = clouds();
  if (grids.empty()) return;
  TerrainRate table;
  for (const Dataset& dataset : grids) table.add(dataset, read_raster(dataset));
  for (const Dataset& dataset : surveys) table.add(dataset, read_cloud(dataset));
  table.print_means();
}

}  // namespace microtin::bench
