// SPDX-License-Identifier: MIT
// Packs of random tiles that the encoder would not write, and damage to them.
#ifndef MICROTIN_TESTS_SUPPORT_FORGED_PACK_HPP
#define MICROTIN_TESTS_SUPPORT_FORGED_PACK_HPP

#include <algorithm>
#include <utility>
#include <vector>

#include "encoder/pack/file.hpp"
#include "encoder/stream/encode.hpp"
#include "tests/support/device.hpp"
#include "tests/support/forged_tiles.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/mesh_copy.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {

inline void put_number(Bytes& bytes, size_t at, uint64_t value, size_t width) {
  for (size_t i = 0; i < width; ++i) bytes[at + i] = static_cast<uint8_t>(value >> 8 * i);
}

// Where the content of a note is in a file, and its bytes.
inline std::pair<size_t, size_t> note_in(const Bytes& file, uint8_t type) {
  const uint8_t* content = nullptr;
  uint32_t size = 0;
  REQUIRE(microtin_find_note(file.data(), file.size(), type, &content, &size) ==
          MICROTIN_STATUS_OK);
  return {static_cast<size_t>(content - file.data()), size};
}

// Makes the checks of a pack's header and index right again.
inline void repair_checks(Bytes& pack) {
  PackHeader header{};
  REQUIRE(read_pack_header(pack.data(), &header) == MICROTIN_STATUS_OK);
  const uint32_t index = pack_index_start(header);
  put_number(pack, index - kCheckBytes, crc32(0, pack.data(), index - kCheckBytes), kCheckBytes);
  for (uint32_t tile = 0; tile < tile_columns(header.grid) * tile_rows(header.grid); ++tile) {
    const size_t entry = static_cast<size_t>(pack_entry_start(header, tile));
    const uint32_t of_entry = pack_entry_check(header.identity, tile, pack.data() + entry);
    put_number(pack, entry + kPackEntryBytes - kCheckBytes, of_entry, kCheckBytes);
  }
}

// Vertices at some of the places of a box, the corners among them if it is whole.
inline Tin random_vertices(Random& random, uint32_t width, uint32_t height, bool is_whole) {
  Tin tin;
  for (uint32_t x = 0; x <= width; ++x) {
    for (uint32_t y = 0; y <= height; ++y) {
      const bool is_corner = (x == 0 || x == width) && (y == 0 || y == height);
      if (!(is_whole && is_corner) && random.below(100) >= 35) continue;
      const int32_t z = static_cast<int32_t>(random.below(65536)) - 32768;
      tin.vertices.push_back({static_cast<uint16_t>(x), static_cast<uint16_t>(y),
                              static_cast<int16_t>(random.below(3) == 0 ? z : z / 4096)});
    }
  }
  return tin;
}

// The terrain with some triangles void.
inline Tin with_some_voids(Tin tin, Random& random, uint32_t voids_of_100) {
  return with_voids_where(std::move(tin), [&] { return random.below(100) < voids_of_100; });
}

// Such vertices that make a triangle, some triangles void.
inline Tin random_tile(Random& random, uint32_t width, uint32_t height, bool is_whole,
                       uint32_t voids_of_100) {
  Tin tin = random_vertices(random, width, height, is_whole);
  while (!has_triangle(tin)) tin = random_vertices(random, width, height, is_whole);
  return with_some_voids(std::move(tin), random, voids_of_100);
}

}  // namespace microtin::tests

#endif
