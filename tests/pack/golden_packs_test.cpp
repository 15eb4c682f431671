// SPDX-License-Identifier: MIT
// Small golden packs: what tiles may have, and packs that are refused as a whole.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "encoder/stream/encode.hpp"
#include "tests/support/files.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/report_of_tiles.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

constexpr TileGrid kGrid = {21, 18, 7, 7};
constexpr uint32_t kColumns = 3;
constexpr BoundSpan kSpan = {6, 1, {5, 1}, {30, 0}, {98, 2}};

// The height at a corner of tiles. The southernmost row is level.
int16_t corner_height(uint32_t column, uint32_t row) {
  return row <= 1 ? int16_t{5} : static_cast<int16_t>(5 + 3 * column - 170 * row);
}

// The corners of a tile and some vertices inside. Tiles 3 and 4 have voids.
Tin tile_content(uint32_t tile) {
  const uint32_t column = tile % kColumns, row = tile / kColumns;
  const auto height = static_cast<uint16_t>(std::min(7u, kGrid.y_max - 7 * row));
  Tin tin{{{0, 0, corner_height(column, row)},
           {7, 0, corner_height(column + 1, row)},
           {0, height, corner_height(column, row + 1)},
           {7, height, corner_height(column + 1, row + 1)},
           {3, 2, static_cast<int16_t>(6 - 90 * row)}},
          {}};
  if (row == 1) tin.vertices.push_back({5, 4, static_cast<int16_t>(tile)});
  return tile == 3 || tile == 4 ? with_voids(tin) : tin;
}

// Each coding, voids, margins, own bounds, odd origins.
Bytes tile_stream(uint32_t tile) {
  constexpr Effort kEfforts[] = {
      {10, Coding::kBalanced}, {6, Coding::kQuick}, {32, Coding::kDense}};
  const uint32_t column = tile % kColumns, row = tile / kColumns;
  Metadata metadata;
  metadata.everywhere = {1 + row, 17};
  Bytes stream = encode_and_decode(tile_content(tile), metadata, kEfforts[row == 0 ? 0 : tile % 3],
                                   {column % 2 == 1, row % 2 == 1})
                     .stream;
  Bytes chunk;
  append_varint(chunk, 18);
  const Bytes span = write_span(kSpan);
  append_varint(chunk, span.size());
  chunk.insert(chunk.end(), span.begin(), span.end());
  append_check(chunk, 0);
  stream.insert(stream.end(), chunk.begin(), chunk.end());
  return stream;
}

TileSummary summary_of(const Bytes& stream, uint64_t offset, uint32_t vertices) {
  TileSummary tile;
  tile.bytes = static_cast<uint32_t>(stream.size());
  tile.offset = offset;
  tile.stream_hash = stream_hash(kStreamHash, stream.data(), stream.size());
  tile.vertices = vertices;
  add_heights(stream, tile);
  return tile;
}

// Nine tiles: the first and the third are equal, and share a stream; the last has no terrain.
Bytes mixed() {
  PackContent content{kGrid, {}, {}};
  content.metadata.surface = SurfaceKind::kObstacles;
  content.metadata.side = BoundSide::kNeverBelow;
  content.metadata.bounds = StatedBounds{kSpan, {30, 0}, {20, 0}};
  Bytes joined;
  uint64_t vertices = 0;
  for (uint32_t tile = 0; tile < 8; ++tile) {
    const Bytes stream = tile_stream(tile);
    const auto count = static_cast<uint32_t>(tile_content(tile).vertices.size());
    const bool is_shared = tile == 2;
    content.tiles.push_back(summary_of(stream, is_shared ? 0 : joined.size(), count));
    if (!is_shared) joined.insert(joined.end(), stream.begin(), stream.end());
    vertices += count;
  }
  content.tiles.emplace_back();
  content.metadata.sums = TileSums{vertices, 8};
  return pack::write_pack(content, joined);
}

Bytes with_byte(Bytes pack, size_t at, uint8_t value) {
  pack[at] = value;
  return pack;
}

// A pack with tiles of width 0, behind right checks.
Bytes without_width(Bytes pack) {
  PackHeader header{};
  REQUIRE(read_pack_header(pack.data(), &header) == MICROTIN_STATUS_OK);
  put_number(pack, 10, 0, 2);
  const size_t check = pack_index_start(header) - kCheckBytes;
  put_number(pack, check, crc32(0, pack.data(), check), kCheckBytes);
  return pack;
}

std::vector<std::pair<std::string, Bytes>> small_packs() {
  const Bytes pair = bytes_of_file(golden("pair.mtp"));
  return {{"mixed", mixed()},
          {"pair", pair},
          {"pack_foreign", with_byte(pair, 0, 'M')},
          {"pack_version", with_byte(pair, 4, kPackVersion + 1)},
          {"pack_damaged", with_byte(pair, 20, 5)},
          {"pack_truncated", Bytes(pair.begin(), pair.begin() + 60)},
          {"pack_malformed", without_width(pair)}};
}

}  // namespace

TEST_CASE("golden packs: small ones are read, or refused, as is recorded") {
  for (const auto& [name, bytes] : small_packs()) check_golden_pack(name, bytes);
}

TEST_CASE("golden packs: the mixed one keeps what it states, and states what it is to have") {
  const PackFile pack(mixed());
  CHECK_NOTHROW(pack.expect_as_stated());
  CHECK(is_stated(pack.metadata().everywhere));
  CHECK(pack.metadata().bounds);
  CHECK(pack.metadata().sums->tiles == 8);
  CHECK(!pack.tile(8));
  CHECK(tile_stream(0) == tile_stream(2));
  CHECK(tile_stream(0) != tile_stream(1));
}

}  // namespace microtin::tests
