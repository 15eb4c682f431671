// SPDX-License-Identifier: MIT
// meshoptimizer: triangles in the strip order that it recommends for transmission, vertices in the
// order of their first use, its own codecs for both, then zstd at its best level.
#include <meshoptimizer.h>
#include <zstd.h>

#include <cstring>

#include "encoder/base/error.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/peers/peers.hpp"

namespace microtin::bench {
namespace {

// The size of a vertex must be a multiple of four bytes.
struct Packed {
  uint16_t x, y;
  int16_t z, unused;
};

struct Sizes {
  uint32_t vertices, indices, index_bytes, vertex_bytes, with_heights;
};

size_t bytes_per_vertex(bool has_heights) {
  return has_heights ? sizeof(Packed) : 2 * sizeof(uint16_t);
}

std::vector<uint32_t> optimized_indices(const Surface& surface) {
  std::vector<uint32_t> indices;
  for (const auto& t : surface.triangles) indices.insert(indices.end(), t.begin(), t.end());
  meshopt_optimizeVertexCacheStrip(indices.data(), indices.data(), indices.size(),
                                   surface.vertices.size());
  return indices;
}

// Puts the vertices in the order of their first use.
std::vector<uint8_t> fetched_vertices(const Surface& surface, std::vector<uint32_t>& indices) {
  const size_t size = bytes_per_vertex(surface.has_heights);
  std::vector<uint8_t> vertices;
  for (const Vertex& v : surface.vertices) {
    const Packed packed = {v.x, v.y, v.z, 0};
    const auto* const bytes = reinterpret_cast<const uint8_t*>(&packed);
    vertices.insert(vertices.end(), bytes, bytes + size);
  }
  const size_t count = surface.vertices.size();
  if (meshopt_optimizeVertexFetch(vertices.data(), indices.data(), indices.size(), vertices.data(),
                                  count, size) != count) {
    throw Error("meshoptimizer: a vertex has no triangle");
  }
  return vertices;
}

Bytes compressed(const Bytes& bytes) {
  Bytes out(ZSTD_compressBound(bytes.size()));
  out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), ZSTD_maxCLevel()));
  return out;
}

Bytes decompressed(const Bytes& bytes) {
  Bytes out(ZSTD_getFrameContentSize(bytes.data(), bytes.size()));
  if (ZSTD_decompress(out.data(), out.size(), bytes.data(), bytes.size()) != out.size()) {
    throw Error("zstd: cannot decode");
  }
  return out;
}

Bytes encode(const Surface& surface) {
  std::vector<uint32_t> indices = optimized_indices(surface);
  const std::vector<uint8_t> vertices = fetched_vertices(surface, indices);
  const size_t count = surface.vertices.size(), size = bytes_per_vertex(surface.has_heights);
  Bytes index_bytes(meshopt_encodeIndexBufferBound(indices.size(), count));
  index_bytes.resize(meshopt_encodeIndexBuffer(index_bytes.data(), index_bytes.size(),
                                               indices.data(), indices.size()));
  Bytes vertex_bytes(meshopt_encodeVertexBufferBound(count, size));
  vertex_bytes.resize(meshopt_encodeVertexBuffer(vertex_bytes.data(), vertex_bytes.size(),
                                                 vertices.data(), count, size));
  const Sizes sizes = {static_cast<uint32_t>(count), static_cast<uint32_t>(indices.size()),
                       static_cast<uint32_t>(index_bytes.size()),
                       static_cast<uint32_t>(vertex_bytes.size()), surface.has_heights ? 1u : 0u};
  Bytes bytes(sizeof sizes);
  std::memcpy(bytes.data(), &sizes, sizeof sizes);
  bytes.insert(bytes.end(), index_bytes.begin(), index_bytes.end());
  bytes.insert(bytes.end(), vertex_bytes.begin(), vertex_bytes.end());
  return compressed(bytes);
}

struct Decoded {
  Sizes sizes{};
  std::vector<uint32_t> indices;
  std::vector<uint8_t> vertices;
};

Decoded decode_buffers(const Bytes& compressed_bytes) {
  const Bytes bytes = decompressed(compressed_bytes);
  Decoded decoded;
  std::memcpy(&decoded.sizes, bytes.data(), sizeof decoded.sizes);
  const Sizes& sizes = decoded.sizes;
  const size_t size = bytes_per_vertex(sizes.with_heights != 0);
  decoded.indices.resize(sizes.indices);
  decoded.vertices.resize(sizes.vertices * size);
  const uint8_t* const from = bytes.data() + sizeof sizes;
  if (meshopt_decodeIndexBuffer(decoded.indices.data(), sizes.indices, sizeof(uint32_t), from,
                                sizes.index_bytes) != 0 ||
      meshopt_decodeVertexBuffer(decoded.vertices.data(), sizes.vertices, size,
                                 from + sizes.index_bytes, sizes.vertex_bytes) != 0) {
    throw Error("meshoptimizer: cannot decode");
  }
  return decoded;
}

Surface decode(const Bytes& bytes) {
  const Decoded decoded = decode_buffers(bytes);
  Surface surface;
  surface.has_heights = decoded.sizes.with_heights != 0;
  const size_t size = bytes_per_vertex(surface.has_heights);
  for (size_t i = 0; i < decoded.sizes.vertices; ++i) {
    Packed packed{};
    std::memcpy(&packed, decoded.vertices.data() + i * size, size);
    surface.vertices.push_back({packed.x, packed.y, packed.z});
  }
  for (size_t i = 0; i < decoded.indices.size(); i += 3) {
    surface.triangles.push_back(
        {decoded.indices[i], decoded.indices[i + 1], decoded.indices[i + 2]});
  }
  return surface;
}

}  // namespace

Codec meshoptimizer() {
  return {"meshoptimizer + zstd", true, encode, decode, decode_buffers};
}

}  // namespace microtin::bench
