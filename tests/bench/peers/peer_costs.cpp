// SPDX-License-Identifier: MIT
#include "tests/bench/peers/peer_costs.hpp"

#include <memory>

#include "encoder/base/error.hpp"
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/fractal.hpp"
#include "tests/bench/grids/grid.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/measure.hpp"
#include "tests/bench/peak_memory.hpp"
#include "tests/bench/peers/peers.hpp"
#include "tests/bench/table.hpp"

namespace microtin::bench {
namespace {

struct Contender {
  std::string name, delivers;
  size_t bytes;
  Work decode;
};

struct Input {
  std::string name;
  Tin tin;
};

// Heights of the synthetic terrain at uniform places.
Tin uniform_with_heights(uint32_t count) {
  constexpr uint32_t kSize = 1025;
  const std::vector<int16_t> heights = fractal_heights(kSize, 1);
  Tin tin = uniform_tin(count, 0);
  for (Vertex& v : tin.vertices) v.z = heights[(v.y >> 6) * kSize + (v.x >> 6)];
  return tin;
}

std::vector<Input> inputs() {
  constexpr uint32_t kVertices = 80000;
  const Terrain terrain = terrains().front();
  return {{"80,000 uniform points, x and y", uniform_tin(kVertices, 0)},
          {"80,000 uniform points with heights", uniform_with_heights(kVertices)},
          {"terrain " + terrain.name, simplified(terrain.raster, terrain.options).tin}};
}

void add_points(const Codec& codec, const Bytes& bytes, std::vector<Contender>& all) {
  all.push_back({codec.name, "points, own order", bytes.size(),
                 [codec, bytes] { codec.decode_and_drop(bytes); }});
  const std::optional<Triangulator> peer = triangulator();
  if (!peer) return;
  all.push_back({codec.name + " + " + peer->name, "mesh, own order", bytes.size(),
                 [codec, bytes, peer] { peer->count_triangles(codec.decode(bytes).vertices); }});
}

std::vector<Contender> contenders(const Tin& tin) {
  const Bytes stream = encode(tin, {});
  const auto surface = std::make_shared<const Surface>(surface_of(stream));
  std::vector<Contender> all = {
      {"microtin", "mesh, own order", stream.size(), [stream] { DecodedTerrain{stream}; }}};
  std::vector<Codec> codecs = dense_codecs();
  for (Codec& codec : mesh_codecs()) codecs.push_back(std::move(codec));
  for (const Codec& codec : codecs) {
    const Bytes bytes = checked_encode(codec, *surface);
    if (codec.sends_triangles) {
      all.push_back({codec.name, "mesh, own order", bytes.size(),
                     [codec, bytes] { codec.decode_and_drop(bytes); }});
    } else {
      add_points(codec, bytes, all);
    }
  }
  if (const std::optional<Triangulator> peer = triangulator()) {
    const size_t bytes_per_vertex = surface->has_heights ? 6 : 4;
    all.push_back({"16-bit numbers + " + peer->name, "mesh, any order kept",
                   bytes_per_vertex * surface->vertices.size(),
                   [surface, peer] { peer->count_triangles(surface->vertices); }});
  }
  return all;
}

std::vector<Work> works_of(const std::vector<Contender>& all) {
  std::vector<Work> works;
  works.reserve(all.size());
  for (const Contender& contender : all) works.push_back(contender.decode);
  return works;
}

std::string title(const char* what, const Input& input) {
  return std::string(what) + ": " + input.name + ", " + number(input.tin.vertices.size()) +
         " vertices";
}

}  // namespace

void print_peer_costs() {
  for (const Input& input : inputs()) {
    print_head(title("Today's peers", input),
               {"codec", "delivers", "bytes", "bits/vertex", "decoding, ms", "peak memory, KB"});
    const std::vector<Contender> all = contenders(input.tin);
    std::vector<std::optional<double>> memory;
    memory.reserve(all.size());
    for (const Contender& contender : all) memory.push_back(peak_memory(contender.decode));
    const std::vector<double> times = nanoseconds(works_of(all));
    const auto vertices = static_cast<double>(input.tin.vertices.size());
    for (size_t i = 0; i < all.size(); ++i) {
      print_row({all[i].name, all[i].delivers, number(all[i].bytes),
                 number(8 * static_cast<double>(all[i].bytes) / vertices, 2),
                 number(times[i] / 1e6, 1), memory[i] ? number(*memory[i] / 1024, 0) : "-"});
    }
  }
}

void print_peer_instructions(const std::string& file) {
  for (const Input& input : inputs()) {
    print_head(title("Instructions of decoding, per vertex", input), {"codec", "instructions"});
    const std::vector<Contender> all = contenders(input.tin);
    const std::vector<double> counts = instructions(works_of(all), file);
    for (size_t i = 0; i < all.size(); ++i) {
      print_row(
          {all[i].name, number(counts[i] / static_cast<double>(input.tin.vertices.size()), 0)});
    }
  }
}

}  // namespace microtin::bench
