// SPDX-License-Identifier: MIT
// A pack of streams that are given tile by tile.
#ifndef MICROTIN_TESTS_SUPPORT_JOINED_PACK_HPP
#define MICROTIN_TESTS_SUPPORT_JOINED_PACK_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/files/output.hpp"
#include "encoder/pack/file.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {

inline std::vector<uint8_t> write_pack(PackContent content,
                                       const std::vector<std::vector<uint8_t>>& streams) {
  JoinedStreams joined;
  for (size_t i = 0; i < streams.size(); ++i) content.tiles[i].offset = joined.add(streams[i]);
  return pack::write_pack(content, joined.bytes());
}

}  // namespace microtin::tests

#endif
