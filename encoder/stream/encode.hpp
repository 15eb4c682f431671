// SPDX-License-Identifier: MIT
// From chosen vertices to the bytes of a stream.
#ifndef MICROTIN_ENCODER_STREAM_ENCODE_HPP
#define MICROTIN_ENCODER_STREAM_ENCODE_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/terrain/metadata.hpp"
#include "encoder/terrain/survey.hpp"
#include "shared/format.hpp"

namespace microtin::stream {

constexpr Coding kCodings[] = {Coding::kQuick, Coding::kBalanced, Coding::kDense};

// quick, balanced or dense.
std::string name_of(Coding coding);

// What smaller streams may cost.
struct Effort {
  // Most triangles around a vertex when it is inserted: 6 .. 32. 0: usual_degree, or, of terrains
  // of less than 2,000 vertices, 16 if that saves a 256th of the bytes.
  uint32_t degree = 0;
  Coding coding = Coding::kBalanced;
};

// The given degree, or the one that takes the fewest bytes of most terrain.
inline uint32_t usual_degree(const Effort& effort) {
  if (effort.degree != 0) return effort.degree;
  return effort.coding == Coding::kQuick ? 9 : 10;
}

// Where the lattice of a tile's stream begins on that of its pack, as far as coding wants to know.
struct Origin {
  bool odd_x = false, odd_y = false;
};

// The stream of `tin`; the same for any order of its vertices. It is decoded again with the shipped
// decoder and compared before it is returned. Throws Error if the vertices have no triangle, share
// a place, or are more than 2^24. O(n log n).
std::vector<uint8_t> encode(const Tin& tin, const Metadata& metadata, const Effort& effort = {});

// A stream, together with what the decoder made of it.
struct Encoding {
  std::vector<uint8_t> stream;
  DecodedTerrain decoded;
};

Encoding encode_and_decode(const Tin& tin, const Metadata& metadata, const Effort& effort,
                           Origin origin = {});

}  // namespace microtin::stream

#endif
