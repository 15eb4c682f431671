// SPDX-License-Identifier: MIT
// A stream or a pack as C source, to be linked into firmware.
#ifndef MICROTIN_ENCODER_STREAM_EMBED_HPP
#define MICROTIN_ENCODER_STREAM_EMBED_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::stream {

enum class Embedded { kStream, kPack };

// A C and C++ header that defines, for `name` "alps": alps_stream, the bytes, a constant array that
// linkers place in flash; and ALPS_VERTICES, the capacity that its terrain needs. Of a pack:
// alps_pack; and ALPS_MOST_VERTICES, the capacity that a slot needs. Characters that names cannot
// have become underscores.
std::string embed(const std::vector<uint8_t>& bytes, Embedded kind, uint32_t vertices,
                  const std::string& name);

}  // namespace microtin::stream

#endif
