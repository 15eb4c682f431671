// SPDX-License-Identifier: MIT
// A mesh and a decoder in workspaces like a device's: full of garbage, and with guards around them.
#ifndef MICROTIN_TESTS_SUPPORT_DEVICE_HPP
#define MICROTIN_TESTS_SUPPORT_DEVICE_HPP

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "microtin/microtin.h"
#include "tests/support/layers.hpp"

namespace microtin::tests {

using Bytes = std::vector<uint8_t>;

// Memory of exactly `size` bytes between two guards.
class Workspace {
 public:
  explicit Workspace(size_t size)
      : size_(size), storage_(kGuardBytes + (size + 7) / 8 * 8 + kGuardBytes, kGarbage) {}

  void* begin() { return storage_.data() + kGuardBytes; }
  size_t size() const { return size_; }

  bool guards_are_whole() const {
    const auto begin = storage_.begin(), end = storage_.end();
    const auto is_garbage = [](uint8_t byte) { return byte == kGarbage; };
    return std::all_of(begin, begin + kGuardBytes, is_garbage) &&
           std::all_of(begin + kGuardBytes + static_cast<std::ptrdiff_t>(size_), end, is_garbage);
  }

 private:
  static constexpr uint8_t kGarbage = 0xA5;
  static constexpr std::ptrdiff_t kGuardBytes = 64;

  size_t size_;
  Bytes storage_;  // from the heap: aligned for everything
};

struct Device {
  explicit Device(uint32_t capacity) : Device(capacity, capacity) {}
  Device(uint32_t mesh_capacity, uint32_t decoder_capacity)
      : mesh_space(MICROTIN_MESH_BYTES(mesh_capacity)),
        decoder_space(MICROTIN_DECODER_BYTES(decoder_capacity)) {
    REQUIRE(microtin_mesh_init(mesh_space.begin(), mesh_space.size(), &mesh) == MICROTIN_STATUS_OK);
    REQUIRE(microtin_decoder_init(decoder_space.begin(), decoder_space.size(), mesh, &decoder) ==
            MICROTIN_STATUS_OK);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  bool guards_are_whole() const {
    return mesh_space.guards_are_whole() && decoder_space.guards_are_whole();
  }

  microtin_status feed(const uint8_t* bytes, size_t size, size_t* used, uint32_t steps = 0) const {
    return microtin_decoder_feed(decoder, bytes, size, used, steps);
  }
  microtin_status feed_all(const Bytes& bytes) const {
    size_t used = 0;
    return feed(bytes.data(), bytes.size(), &used);
  }
  // What the decoder says of a stream that consists of these bytes.
  microtin_status decode(const Bytes& bytes) const {
    feed_all(bytes);
    return microtin_decoder_finish(decoder);
  }

  uint32_t vertices() const { return microtin_mesh_vertex_count(mesh); }

  Workspace mesh_space, decoder_space;
  microtin_mesh* mesh = nullptr;
  microtin_decoder* decoder = nullptr;
};

}  // namespace microtin::tests

#endif
