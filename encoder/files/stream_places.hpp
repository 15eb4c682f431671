// SPDX-License-Identifier: MIT
// Where streams lie that are written one after the other, equal ones once.
#ifndef MICROTIN_ENCODER_FILES_STREAM_PLACES_HPP
#define MICROTIN_ENCODER_FILES_STREAM_PLACES_HPP

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::files {

class StreamPlaces {
 public:
  // Whether the bytes at an offset are those of the stream.
  using IsAt = std::function<bool(uint64_t offset)>;

  // The offset of an equal stream, or bytes(): then the stream is new, and is to be written there.
  uint64_t place(const std::vector<uint8_t>& stream, const IsAt& is_at);

  // All streams that are to be written take as many bytes.
  uint64_t bytes() const { return bytes_; }

 private:
  struct Place {
    uint64_t offset, size;
  };
  std::unordered_multimap<size_t, Place> places_;  // by a hash
  uint64_t bytes_ = 0;
};

// Streams in memory.
class JoinedStreams {
 public:
  // Returns where the stream is. An empty one is nowhere: 0.
  uint64_t add(const std::vector<uint8_t>& stream);

  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  StreamPlaces places_;
  std::vector<uint8_t> bytes_;
};

}  // namespace microtin::files

#endif
