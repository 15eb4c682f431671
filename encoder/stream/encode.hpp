// SPDX-License-Identifier: MIT
// From chosen vertices to the bytes of a stream.
#ifndef MICROTIN_ENCODER_STREAM_ENCODE_HPP
#define MICROTIN_ENCODER_STREAM_ENCODE_HPP

#include <cstdint>
#include <vector>

#include "encoder/exact/metadata.hpp"
#include "encoder/layers.hpp"
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/terrain/survey.hpp"

namespace microtin::stream {

// What smaller streams may cost. Both are at their best for most terrain.
struct Effort {
  uint32_t degree = 10;  // most triangles around a vertex when it is inserted: 6 .. 32
  uint32_t levels = 2;   // of cells that places are coded in: 1 .. 3
};

// The stream of `tin`; the same for any order of its vertices. It is decoded again with the shipped
// decoder and compared before it is returned. Throws Error if the vertices have no triangle, share
// a place, or are more than 2^24. O(n log n).
std::vector<uint8_t> encode(const Tin& tin, const Metadata& metadata, const Effort& effort = {});

// The same, together with what the decoder made of it.
struct Encoding {
  std::vector<uint8_t> stream;
  DecodedTerrain decoded;
};

Encoding encode_and_decode(const Tin& tin, const Metadata& metadata, const Effort& effort);

}  // namespace microtin::stream

#endif
