// SPDX-License-Identifier: MIT
// A number that tells meshes apart, quicker to compute than their digest (shared/digest.hpp). Not
// part of the format, and no match for somebody who wants to deceive it.
#ifndef MICROTIN_ENCODER_STREAM_FINGERPRINT_HPP
#define MICROTIN_ENCODER_STREAM_FINGERPRINT_HPP

#include <cstdint>
#include <vector>

#include "encoder/stream/spatial_order.hpp"
#include "shared/lattice.hpp"

namespace microtin::stream {

// The sum over a mesh's real triangles: neither their order nor which corner comes first counts,
// but their sense of rotation does.
class Fingerprint {
 public:
  // Triangles name these vertices.
  explicit Fingerprint(const std::vector<Vertex>& vertices) {
    keys_.reserve(vertices.size());
    for (const Vertex& v : vertices) {
      keys_.push_back(scramble(static_cast<uint64_t>(v.x) << 32 | static_cast<uint64_t>(v.y) << 16 |
                               static_cast<uint16_t>(v.z)));
    }
  }

  void add(uint32_t a, uint32_t b, uint32_t c, bool is_void) {
    const uint64_t edges =
        edge(keys_[a], keys_[b]) + edge(keys_[b], keys_[c]) + edge(keys_[c], keys_[a]);
    sum_ += scramble(edges + (is_void ? 1 : 0));
  }

  uint64_t sum() const { return sum_; }

 private:
  static uint64_t edge(uint64_t from, uint64_t to) { return from * (to << 32 | to >> 32); }

  std::vector<uint64_t> keys_;  // by vertex
  uint64_t sum_ = 0;
};

}  // namespace microtin::stream

#endif
