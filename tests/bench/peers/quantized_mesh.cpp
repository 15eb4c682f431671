// SPDX-License-Identifier: MIT
// quantized-mesh 1.0 as terrain servers send it: 16-bit differences, indices below a high-water
// mark, the vertices of the four borders, gzip. The format's coordinates have 15 bits; here the
// differences are taken modulo 2^16, so that all codecs carry the same integers.
#include <zlib.h>

#include <algorithm>
#include <numeric>

#include "encoder/base/error.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/peers/peers.hpp"

namespace microtin::bench {
namespace {

constexpr size_t kHeaderBytes = 88;  // centre, heights, bounding sphere, horizon: floating point
constexpr size_t kMostShortIndices = 65536;
constexpr int kGzip = 15 + 16;  // zlib's window bits, and its code for gzip

void append(Bytes& bytes, uint32_t value, size_t size) {
  for (size_t i = 0; i < size; ++i) bytes.push_back(static_cast<uint8_t>(value >> (8 * i)));
}

uint32_t take(const uint8_t*& from, size_t size) {
  uint32_t value = 0;
  for (size_t i = 0; i < size; ++i) value |= static_cast<uint32_t>(*from++) << (8 * i);
  return value;
}

// The bits of x and y, taken in turn.
uint32_t interleaved(uint32_t x, uint32_t y) {
  uint32_t bits = 0;
  for (uint32_t i = 0; i < 16; ++i) bits |= ((x >> i & 1u) << 1 | (y >> i & 1u)) << (2 * i);
  return bits;
}

// Triangles along a space-filling curve; vertices in the order of their first use.
Surface in_sending_order(const Surface& surface) {
  std::vector<size_t> order(surface.triangles.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::vector<uint32_t> keys;
  for (const auto& t : surface.triangles) {
    uint32_t x = 0, y = 0;
    for (const uint32_t v : t) {
      x += surface.vertices[v].x;
      y += surface.vertices[v].y;
    }
    keys.push_back(interleaved(x / 3, y / 3));
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return keys[a] < keys[b]; });
  constexpr uint32_t kNone = ~0u;
  std::vector<uint32_t> number(surface.vertices.size(), kNone);
  Surface sent;
  sent.has_heights = surface.has_heights;
  for (const size_t i : order) {
    std::array<uint32_t, 3> triangle{};
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = surface.triangles[i][k];
      if (number[v] == kNone) {
        number[v] = static_cast<uint32_t>(sent.vertices.size());
        sent.vertices.push_back(surface.vertices[v]);
      }
      triangle[k] = number[v];
    }
    sent.triangles.push_back(triangle);
  }
  return sent;
}

uint16_t component(const Vertex& v, int axis) {
  return axis == 0 ? v.x : axis == 1 ? v.y : static_cast<uint16_t>(v.z);
}

void append_components(Bytes& bytes, const std::vector<Vertex>& vertices, int axis) {
  uint16_t previous = 0;
  for (const Vertex& v : vertices) {
    const auto difference = static_cast<int16_t>(component(v, axis) - previous);
    const auto bits = static_cast<uint32_t>(difference);
    append(bytes, bits << 1 ^ (0 - (bits >> 31)), 2);
    previous = component(v, axis);
  }
}

void append_border(Bytes& bytes, const std::vector<Vertex>& vertices, int axis, uint16_t value,
                   size_t index_size) {
  std::vector<uint32_t> border;
  for (size_t i = 0; i < vertices.size(); ++i) {
    if (component(vertices[i], axis) == value) border.push_back(static_cast<uint32_t>(i));
  }
  append(bytes, static_cast<uint32_t>(border.size()), 4);
  for (const uint32_t v : border) append(bytes, v, index_size);
}

Bytes written(const Surface& surface) {
  const std::vector<Vertex>& vertices = surface.vertices;
  const size_t index_size = vertices.size() > kMostShortIndices ? 4 : 2;
  Bytes bytes(kHeaderBytes);
  append(bytes, static_cast<uint32_t>(vertices.size()), 4);
  for (int axis = 0; axis < 3; ++axis) append_components(bytes, vertices, axis);
  while (bytes.size() % index_size != 0) bytes.push_back(0);
  append(bytes, static_cast<uint32_t>(surface.triangles.size()), 4);
  uint32_t highest = 0;
  for (const auto& t : surface.triangles) {
    for (const uint32_t v : t) {
      append(bytes, highest - v, index_size);
      if (v == highest) ++highest;
    }
  }
  for (int axis = 0; axis < 2; ++axis) {
    const auto [low, high] = std::minmax_element(vertices.begin(), vertices.end(),
                                                 [axis](const Vertex& a, const Vertex& b) {
                                                   return component(a, axis) < component(b, axis);
                                                 });
    append_border(bytes, vertices, axis, component(*low, axis), index_size);
    append_border(bytes, vertices, axis, component(*high, axis), index_size);
  }
  return bytes;
}

Surface read(const Bytes& bytes) {
  const uint8_t* from = bytes.data() + kHeaderBytes;
  Surface surface;
  surface.vertices.resize(take(from, 4));
  for (int axis = 0; axis < 3; ++axis) {
    uint16_t value = 0;
    for (Vertex& v : surface.vertices) {
      const uint32_t zigzag = take(from, 2);
      value = static_cast<uint16_t>(value + (zigzag >> 1 ^ (0 - (zigzag & 1u))));
      if (axis == 0) v.x = value;
      if (axis == 1) v.y = value;
      if (axis == 2) v.z = static_cast<int16_t>(value);
      surface.has_heights = surface.has_heights || v.z != 0;
    }
  }
  const size_t index_size = surface.vertices.size() > kMostShortIndices ? 4 : 2;
  while (static_cast<size_t>(from - bytes.data()) % index_size != 0) ++from;
  surface.triangles.resize(take(from, 4));
  uint32_t highest = 0;
  for (auto& t : surface.triangles) {
    for (uint32_t& v : t) {
      v = highest - take(from, index_size);
      if (v == highest) ++highest;
    }
  }
  return surface;  // the borders only serve to draw skirts
}

Bytes zipped(const Bytes& bytes) {
  z_stream stream{};
  if (deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, kGzip, 9, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw Error("zlib: cannot start");
  }
  Bytes out(deflateBound(&stream, bytes.size()));
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  const int status = deflate(&stream, Z_FINISH);
  out.resize(stream.total_out);
  deflateEnd(&stream);
  if (status != Z_STREAM_END) throw Error("zlib: cannot encode");
  return out;
}

// The last four bytes tell the size.
Bytes unzipped(const Bytes& bytes) {
  const uint8_t* tail = bytes.data() + bytes.size() - 4;
  Bytes out(take(tail, 4));
  z_stream stream{};
  stream.next_in = const_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  if (inflateInit2(&stream, kGzip) != Z_OK) throw Error("zlib: cannot start");
  const int status = inflate(&stream, Z_FINISH);
  inflateEnd(&stream);
  if (status != Z_STREAM_END) throw Error("zlib: cannot decode");
  return out;
}

Bytes encode(const Surface& surface) {
  return zipped(written(in_sending_order(surface)));
}

Surface decode(const Bytes& bytes) {
  return read(unzipped(bytes));
}

}  // namespace

Codec quantized_mesh() {
  return {"quantized-mesh + gzip", true, encode, decode, decode};
}

}  // namespace microtin::bench
