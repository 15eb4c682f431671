// SPDX-License-Identifier: MIT
// xz: points along a Hilbert curve, the differences from one to the next in planes of bytes.
#include <lzma.h>

#include <algorithm>

#include "encoder/base/error.hpp"
#include "encoder/stream/spatial_order.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/peers/peers.hpp"

namespace microtin::bench {
namespace {

// Small numbers for small differences of either sign.
uint16_t fold(uint16_t difference) {
  return static_cast<uint16_t>(difference << 1 ^ (difference >> 15 != 0 ? 0xFFFF : 0));
}

uint16_t unfold(uint16_t folded) {
  return static_cast<uint16_t>(folded >> 1 ^ ((folded & 1) != 0 ? 0xFFFF : 0));
}

std::array<uint16_t, 3> components(const Vertex& v) {
  return {v.x, v.y, static_cast<uint16_t>(v.z)};
}

Bytes planes_of(std::vector<Vertex> vertices) {
  std::sort(vertices.begin(), vertices.end(), [](const Vertex& a, const Vertex& b) {
    return stream::hilbert_position<16>(a.x, a.y) < stream::hilbert_position<16>(b.x, b.y);
  });
  const size_t n = vertices.size();
  Bytes planes(6 * n);
  std::array<uint16_t, 3> last{};
  for (size_t i = 0; i < n; ++i) {
    const auto current = components(vertices[i]);
    for (size_t c = 0; c < 3; ++c) {
      const uint16_t folded = fold(static_cast<uint16_t>(current[c] - last[c]));
      planes[2 * c * n + i] = static_cast<uint8_t>(folded);
      planes[(2 * c + 1) * n + i] = static_cast<uint8_t>(folded >> 8);
    }
    last = current;
  }
  return planes;
}

Surface surface_of(const Bytes& planes) {
  const size_t n = planes.size() / 6;
  Surface surface;
  std::array<uint16_t, 3> at{};
  for (size_t i = 0; i < n; ++i) {
    for (size_t c = 0; c < 3; ++c) {
      const int folded = planes[2 * c * n + i] | planes[(2 * c + 1) * n + i] << 8;
      at[c] = static_cast<uint16_t>(at[c] + unfold(static_cast<uint16_t>(folded)));
    }
    surface.vertices.push_back({at[0], at[1], static_cast<int16_t>(at[2])});
  }
  return surface;
}

Bytes encode(const Surface& surface) {
  const Bytes planes = planes_of(surface.vertices);
  Bytes bytes(lzma_stream_buffer_bound(planes.size()));
  size_t size = 0;
  if (lzma_easy_buffer_encode(9 | LZMA_PRESET_EXTREME, LZMA_CHECK_CRC32, nullptr, planes.data(),
                              planes.size(), bytes.data(), &size, bytes.size()) != LZMA_OK) {
    throw Error("xz: cannot encode");
  }
  bytes.resize(size);
  return bytes;
}

// How much will come out is not known: tries until it fits.
Bytes decompressed(const Bytes& bytes) {
  for (size_t most = 4 * bytes.size();; most *= 2) {
    Bytes planes(most);
    uint64_t memory_limit = UINT64_MAX;
    size_t from = 0, size = 0;
    const lzma_ret status = lzma_stream_buffer_decode(
        &memory_limit, 0, nullptr, bytes.data(), &from, bytes.size(), planes.data(), &size, most);
    planes.resize(size);
    if (status == LZMA_OK) return planes;
    if (status != LZMA_BUF_ERROR) throw Error("xz: cannot decode");
  }
}

Surface decode(const Bytes& bytes) {
  return surface_of(decompressed(bytes));
}

}  // namespace

Codec xz_points() {
  return {"xz points", false, encode, decode, decode};
}

}  // namespace microtin::bench
