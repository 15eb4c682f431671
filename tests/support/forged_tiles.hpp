// SPDX-License-Identifier: MIT
// Packs of tiles that are given one by one.
#ifndef MICROTIN_TESTS_SUPPORT_FORGED_TILES_HPP
#define MICROTIN_TESTS_SUPPORT_FORGED_TILES_HPP

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/pack/file.hpp"
#include "encoder/stream/encode.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/mesh_copy.hpp"

namespace microtin::tests {

// A tile: a stream, and of how many vertices the header knows. Empty: no terrain.
struct ForgedTile {
  std::vector<uint8_t> stream;
  uint32_t vertices = 0;
};

inline ForgedTile forged_tile(const Tin& tin) {
  return {encode(tin, Metadata()), static_cast<uint32_t>(tin.vertices.size())};
}

// The lowest and the highest height of a stream's vertices; nothing if it cannot be decoded.
inline void add_heights(const std::vector<uint8_t>& stream, TileSummary& summary) {
  try {
    const DecodedTerrain decoded(stream, {}, MarkChunks::kSkip);
    summary.lowest = INT16_MAX;
    summary.highest = INT16_MIN;
    for (uint32_t v = 0; v < microtin_mesh_vertex_count(decoded.mesh()); ++v) {
      const int16_t z = vertex_of(decoded.mesh(), v).z;
      summary.lowest = std::min(summary.lowest, z);
      summary.highest = std::max(summary.highest, z);
    }
    microtin_mesh_margins(decoded.mesh(), &summary.below, &summary.above);
  } catch (const Error&) {
  }
}

// Each stream has its own place, so that damage to one is none to others.
inline std::vector<uint8_t> forged_pack(const TileGrid& grid, const std::vector<ForgedTile>& tiles,
                                        const Metadata& metadata = {}) {
  PackContent content{grid, metadata, {}};
  std::vector<uint8_t> streams;
  for (const ForgedTile& tile : tiles) {
    TileSummary summary;
    summary.bytes = static_cast<uint32_t>(tile.stream.size());
    summary.stream_hash = stream_hash(kStreamHash, tile.stream.data(), tile.stream.size());
    summary.vertices = tile.vertices;
    summary.offset = summary.bytes == 0 ? 0 : streams.size();
    if (summary.bytes != 0) add_heights(tile.stream, summary);
    content.tiles.push_back(summary);
    streams.insert(streams.end(), tile.stream.begin(), tile.stream.end());
  }
  return write_pack(content, streams);
}

inline bool has_triangle(const Tin& tin) {
  const auto at = [&](size_t v) { return Point{tin.vertices[v].x, tin.vertices[v].y}; };
  bool found = false;
  for (size_t i = 2; i < tin.vertices.size(); ++i) {
    found = found || orient2d(at(0), at(1), at(i)) != 0;
  }
  return found;
}

// The terrain with those triangles void for which choose() is true.
template <class Choose>
Tin with_voids_where(Tin tin, const Choose& choose) {
  const DecodedTerrain decoded(encode(tin, Metadata()));
  const MeshCopy copy(decoded.mesh());
  for (const std::array<Point, 3>& t : triangles_of(copy.mesh).triangles) {
    if (choose()) tin.voids.push_back(Tin::Triangle{t[0], t[1], t[2]});
  }
  return tin;
}

}  // namespace microtin::tests

#endif
