// SPDX-License-Identifier: MIT
// Packs that are damaged, or break a rule: a device tells so, and never answers from them.
#include <doctest/doctest.h>

#include <chrono>
#include <cstring>
#include <optional>
#include <vector>

#include "microtin/compact_pack.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/packs.hpp"

namespace microtin::tests {
namespace {

uint32_t bad_tiles(const PackDevice& device) {
  uint32_t all = 0, number = 0, why = MICROTIN_STATUS_OK;
  for (uint32_t i = 0; i < 2 * MICROTIN_PACK_MAX_BAD_TILES; ++i) {
    all += microtin_pack_bad_tile(device.pack, i, &number, &why) == MICROTIN_STATUS_OK ? 1u : 0u;
  }
  return all;
}

// What a service says in the end; NEED_INPUT if there is none.
microtin_status served(const PackDevice& device, Card& card, const microtin_segment& segment,
                       uint32_t steps = 100) {
  for (int calls = 0; calls < 10000; ++calls) {
    const microtin_status status = device.load(card, segment, steps);
    if (status != MICROTIN_STATUS_NEED_INPUT && status != MICROTIN_STATUS_STEP_LIMIT) return status;
  }
  return MICROTIN_STATUS_NEED_INPUT;
}

// A row of flat tiles of two steps, each as high as its number.
Bytes row_of_tiles(uint32_t tiles) {
  std::vector<ForgedTile> row;
  for (uint32_t i = 0; i < tiles; ++i) {
    const int16_t z = static_cast<int16_t>(i);
    row.push_back(forged_tile({{{0, 0, z}, {2, 0, z}, {0, 2, z}, {2, 2, z}}, {}}));
  }
  return forged_pack({2 * tiles, 2, 2, 2}, row);
}

size_t stream_at(const Bytes& pack, uint32_t tile) {
  return static_cast<size_t>(PackFile(pack).entries()[tile].offset);
}

// Three vertices within 4 x 3 steps, in a stream whose header says that it reaches so far: found by
// trying what payloads say.
Bytes loose_stream(uint16_t x_max, uint16_t y_max) {
  const Bytes header =
      write_header(Contract{3, x_max, y_max, kMinDegree, Coding::kBalanced, false, false}, {});
  for (uint32_t payload = 0; payload < 65536; ++payload) {
    Bytes stream = header;
    for (const uint32_t byte : {2u, payload >> 8, payload & 255u}) {
      stream.push_back(static_cast<uint8_t>(byte));
    }
    append_check(stream, header.size());
    const Device device(3);
    if (device.decode(stream) != MICROTIN_STATUS_OK) continue;
    bool fits = true;
    for (uint32_t v = 0; v < 3; ++v) {
      Point p{};
      int16_t z = 0;
      microtin_mesh_vertex(device.mesh, v, &p.x, &p.y, &z);
      fits = fits && p.x <= 4 && p.y <= 3;
    }
    if (fits) return stream;
  }
  FAIL("there is no such stream");
  return {};
}

}  // namespace

TEST_CASE_TEMPLATE("pack: bad tiles are skipped, reported, and tried again on request", Device,
                   MeshSlots, CompactSlots) {
  const Bytes good = row_of_tiles(6);
  Card card{good};
  card.bytes[stream_at(good, 0) + 20] ^= 1;
  card.bytes[stream_at(good, 3) + 20] ^= 1;
  const Device device(6);
  const microtin_segment all = {0, 300, 12 * 256, 300};
  CHECK(bad_tiles(device) == 0);
  CHECK(device.load(card, all) == MICROTIN_STATUS_BAD_TILES);
  CHECK(bad_tiles(device) == 2);
  CHECK(why_bad(device, 0) == MICROTIN_STATUS_CHECKSUM);
  CHECK(why_bad(device, 3) == MICROTIN_STATUS_CHECKSUM);
  CHECK(why_bad(device, 1) == MICROTIN_STATUS_OK);
  const auto answer = [&](int64_t x, int64_t y) {
    int32_t height = 0;
    return device.height_at(x, y, height);
  };
  CHECK(answer(256, 300) == MICROTIN_QUERY_BAD_TILE);
  CHECK(answer(512, 300) == MICROTIN_QUERY_OK);  // on the border, by the other tile
  CHECK(answer(3 * 256, 300) == MICROTIN_QUERY_OK);
  CHECK(answer(7 * 256, 300) == MICROTIN_QUERY_BAD_TILE);
  CHECK(answer(11 * 256, 300) == MICROTIN_QUERY_OK);
  int32_t highest = 0;
  CHECK(device.highest_on(all, &highest) == MICROTIN_QUERY_BAD_TILE);
  CHECK(highest == 5 * 65536);
  const microtin_segment between = {512, 300, 6 * 256, 300}, along = {6 * 256, 0, 6 * 256, 512};
  CHECK(device.highest_on(between, &highest) == MICROTIN_QUERY_OK);
  CHECK(device.highest_on(along, &highest) == MICROTIN_QUERY_OK);
  const uint32_t reads = card.reads;
  CHECK(device.load(card, all) == MICROTIN_STATUS_BAD_TILES);
  CHECK(card.reads == reads);
  card.bytes = good;
  CHECK(device.load(card, all) == MICROTIN_STATUS_BAD_TILES);  // not yet
  CHECK(card.reads == reads);
  microtin_pack_clear_bad_tiles(device.pack);
  CHECK(answer(256, 300) == MICROTIN_QUERY_NOT_LOADED);
  CHECK(device.load(card, all) == MICROTIN_STATUS_OK);
  CHECK(answer(256, 300) == MICROTIN_QUERY_OK);
  CHECK(bad_tiles(device) == 0);
  card.bytes[stream_at(good, 2) + 20] ^= 1;
  microtin_pack_reset(device.pack);
  CHECK(device.load(card, all) == MICROTIN_STATUS_BAD_TILES);
  CHECK(bad_tiles(device) == 1);
  microtin_pack_reset(device.pack);  // another card
  CHECK(bad_tiles(device) == 0);
  card.bytes = good;
  CHECK(device.load(card, all) == MICROTIN_STATUS_OK);
}

TEST_CASE_TEMPLATE("pack: with a step limit, too, a bad tile is no stop, and is read once", Device,
                   MeshSlots, CompactSlots) {
  const Bytes good = row_of_tiles(6);
  Card card{good};
  card.bytes[stream_at(good, 1) + 20] ^= 1;
  card.most = 11;
  const Device device(6);
  const microtin_segment all = {0, 300, 12 * 256, 300};
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  uint32_t calls = 0;
  for (; calls < 10000; ++calls) {
    const uint32_t reads = card.reads;
    status = device.load(card, all, 1);
    REQUIRE(card.reads <= reads + 1);
    if (status != MICROTIN_STATUS_NEED_INPUT && status != MICROTIN_STATUS_STEP_LIMIT) break;
  }
  CHECK(status == MICROTIN_STATUS_BAD_TILES);
  CHECK(why_bad(device, 1) == MICROTIN_STATUS_CHECKSUM);
}

TEST_CASE_TEMPLATE(
    "pack: more bad tiles than are remembered cost an attempt a service, never a stop", Device,
    MeshSlots, CompactSlots) {
  constexpr uint32_t kTiles = 20, kBad = 14;
  const Bytes good = row_of_tiles(kTiles);
  Card card{good};
  for (uint32_t i = 0; i < kBad; ++i) card.bytes[stream_at(good, i) + 20] ^= 1;
  const Device device(kTiles);
  const microtin_segment all = {0, 300, kTiles * 512, 300};
  CHECK(served(device, card, all) == MICROTIN_STATUS_BAD_TILES);
  for (uint32_t i = 0; i < kTiles; ++i) {
    int32_t height = 0;
    const microtin_query_result expected = i >= kBad ? MICROTIN_QUERY_OK
                                           : i < MICROTIN_PACK_MAX_BAD_TILES
                                               ? MICROTIN_QUERY_BAD_TILE
                                               : MICROTIN_QUERY_NOT_LOADED;
    CHECK(device.height_at(i * 512 + 256, 300, height) == expected);
  }
  uint32_t reads = card.reads;
  CHECK(served(device, card, all) == MICROTIN_STATUS_BAD_TILES);
  CHECK(card.reads ==
        reads + 2 * (kBad - MICROTIN_PACK_MAX_BAD_TILES));  // an entry and a stream each
  // Those that are wanted no more make room for others.
  const microtin_segment behind = {(kBad - 2) * 512 + 256, 300, kTiles * 512, 300};
  CHECK(served(device, card, behind) == MICROTIN_STATUS_BAD_TILES);
  CHECK(why_bad(device, kBad - 1) == MICROTIN_STATUS_CHECKSUM);
  CHECK(why_bad(device, kBad - 2) == MICROTIN_STATUS_CHECKSUM);
  reads = card.reads;
  CHECK(served(device, card, behind) == MICROTIN_STATUS_BAD_TILES);
  CHECK(card.reads == reads);
}

TEST_CASE_TEMPLATE("pack: a segment across many bad tiles takes time that grows as their number",
                   Device, MeshSlots, CompactSlots) {
  constexpr uint32_t kTiles = 60000;
  Card card{forged_pack({kTiles, 2, 1, 2}, std::vector<ForgedTile>(kTiles))};
  PackHeader header{};
  REQUIRE(read_pack_header(card.bytes.data(), &header) == MICROTIN_STATUS_OK);
  card.bytes.resize(pack_index_start(header));  // the index is gone: all tiles are truncated
  const Device device(3);
  const auto began = std::chrono::steady_clock::now();
  CHECK(device.load(card, {0, 100, kTiles * 256, 100}) == MICROTIN_STATUS_BAD_TILES);
  // A fifth of a second with sanitizers; a minute if each attempt looked along the tiles before it.
  CHECK(std::chrono::steady_clock::now() - began < std::chrono::seconds(10));
  CHECK(card.reads > kTiles);
}

TEST_CASE_TEMPLATE("pack: what is beyond the end is truncated, in the header and in tiles", Device,
                   MeshSlots, CompactSlots) {
  const Bytes good = row_of_tiles(3);
  const size_t header = pack_index_start(PackFile(good).header());
  const auto cut = [&](size_t size) {
    return Card{Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size))};
  };
  for (const uint32_t steps : {0u, 3u}) {
    for (size_t size = 0; size < good.size(); ++size) {
      Card card = cut(size);
      const Device device(3);
      const microtin_segment all = {0, 300, 6 * 256, 300};
      microtin_status status = MICROTIN_STATUS_NEED_INPUT;
      for (int calls = 0; calls < 1000; ++calls) {
        status = device.load(card, all, steps);
        if (status != MICROTIN_STATUS_NEED_INPUT && status != MICROTIN_STATUS_STEP_LIMIT) break;
      }
      CHECK(status == (size < header ? MICROTIN_STATUS_TRUNCATED : MICROTIN_STATUS_BAD_TILES));
      if (size >= header) CHECK(why_bad(device, 2) == MICROTIN_STATUS_TRUNCATED);
      if (size >= stream_at(good, 2)) CHECK(why_bad(device, 1) == MICROTIN_STATUS_OK);
    }
  }
}

TEST_CASE_TEMPLATE("pack: damaged, swapped and foreign bytes are reported, and never used", Device,
                   MeshSlots, CompactSlots) {
  const Bytes good = pack_bytes(rough_raster(61, 53));
  const PackFile pack(good);
  const auto status_of = [](const Bytes& bytes) {
    Card card{bytes};
    const Device device(4);
    const microtin_status status = device.load(card, at(30, 26));
    int32_t height = 0;
    const microtin_query_result answer = device.height_at(30 * 256, 26 * 256, height);
    CHECK((status == MICROTIN_STATUS_OK || status == MICROTIN_STATUS_BAD_TILES) ==
          (answer == MICROTIN_QUERY_OK || answer == MICROTIN_QUERY_BAD_TILE));
    if (status == MICROTIN_STATUS_OK) CHECK(answer == MICROTIN_QUERY_OK);
    return status;
  };
  CHECK(status_of(good) == MICROTIN_STATUS_OK);
  CHECK(status_of(Bytes(good.size())) == MICROTIN_STATUS_BAD_MAGIC);
  CHECK(status_of({}) == MICROTIN_STATUS_TRUNCATED);
  const uint32_t index = pack_index_start(pack.header());
  Bytes zeros = good;
  std::fill(zeros.begin() + index, zeros.end(), uint8_t{0});
  CHECK(status_of(zeros) == MICROTIN_STATUS_BAD_TILES);
  // Every byte changed: all that matters for this place is noticed.
  uint32_t noticed = 0;
  for (size_t i = 0; i < good.size(); ++i) {
    Bytes changed = good;
    changed[i] ^= static_cast<uint8_t>(1u << i % 8);
    if (status_of(changed) != MICROTIN_STATUS_OK) ++noticed;
  }
  CHECK(noticed > index + kPackEntryBytes);
  // Entries and streams of two tiles swapped.
  const uint32_t last = static_cast<uint32_t>(pack.entries().size()) - 1;
  const auto is_refused = [&](uint32_t tile, const Bytes& bytes) {
    Card card{bytes};
    const Device device(4);
    const TileBox box = tile_box(pack.grid(), tile);
    return device.load(card, at(box.x + 1, box.y + 1)) == MICROTIN_STATUS_BAD_TILES &&
           why_bad(device, tile) == MICROTIN_STATUS_CHECKSUM;
  };
  Bytes swapped = good;
  std::swap_ranges(swapped.begin() + index, swapped.begin() + index + kPackEntryBytes,
                   swapped.begin() + index + last * kPackEntryBytes);
  CHECK(is_refused(0, swapped));
  CHECK(is_refused(last, swapped));
  const Bytes other = pack_bytes(rough_raster(61, 53), 4);
  Bytes foreign = good;
  std::copy(other.begin() + index,
            other.begin() + std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(other.size()),
                                                     static_cast<std::ptrdiff_t>(good.size())),
            foreign.begin() + index);
  CHECK(is_refused(0, foreign));
}

TEST_CASE_TEMPLATE("pack: of a placement that was damage nothing stays", Device, MeshSlots,
                   CompactSlots) {
  Card card{pack_bytes(rough_raster(61, 53), 0)};
  REQUIRE(card.bytes[6] == 0);
  for (const uint8_t denominator : Bytes{0, 3}) {
    const Bytes placement = {2, 2, denominator, 2, 2, denominator, 2, 2, denominator};
    Card damaged = card;
    damaged.bytes[6] = static_cast<uint8_t>(placement.size());
    std::copy(placement.begin(), placement.end(), damaged.bytes.begin() + kPackFixedBytes);
    const Device device(1);
    CHECK(device.load(damaged, at(1, 1)) == MICROTIN_STATUS_CHECKSUM);
    REQUIRE(device.load(card, at(1, 1)) == MICROTIN_STATUS_OK);
    microtin_pack_info info;
    REQUIRE(microtin_pack_get_info(device.pack, &info) == MICROTIN_STATUS_OK);
    for (const microtin_axis& axis : {info.x, info.y, info.z}) {
      CHECK(axis.offset == 0);
      CHECK(axis.numerator == 1);
      CHECK(axis.denominator == 1);
    }
  }
}

TEST_CASE_TEMPLATE("pack: a tile of another tile's place is refused, whatever its checks", Device,
                   MeshSlots, CompactSlots) {
  // Two tiles that differ by one height, by one that takes as many bytes; right CRCs of their own.
  Raster raster = rough_raster(9, 5);
  for (size_t i = 0; i < raster.heights.size(); ++i) raster.heights[i] = i % 9 % 4 == 2 ? 50 : 0;
  EncodedPack encoded;
  do {
    REQUIRE(++raster.heights[9 * 2 + 6] < 100);
    encoded = encode_pack(raster, {{}, {}, 30, 0});
    REQUIRE(encoded.streams.size() == 2);
  } while (encoded.streams[0].size() != encoded.streams[1].size());
  const Bytes &west = encoded.streams[0], &east = encoded.streams[1];
  REQUIRE(west != east);
  Bytes bytes = write_pack(encoded);
  const auto status_of = [&](uint32_t x) {
    Card card{bytes};
    const Device device(4);
    return device.load(card, at(x, 1));
  };
  CHECK(status_of(1) == MICROTIN_STATUS_OK);
  CHECK(status_of(7) == MICROTIN_STATUS_OK);
  std::swap_ranges(bytes.end() - static_cast<std::ptrdiff_t>(2 * west.size()),
                   bytes.end() - static_cast<std::ptrdiff_t>(west.size()),
                   bytes.end() - static_cast<std::ptrdiff_t>(west.size()));
  CHECK(status_of(1) == MICROTIN_STATUS_BAD_TILES);
  CHECK(status_of(7) == MICROTIN_STATUS_BAD_TILES);
}

TEST_CASE_TEMPLATE("pack: a placement that is not verified is not used", Device, MeshSlots,
                   CompactSlots) {
  Metadata metadata;
  metadata.placement.z = {0, uint64_t{1} << 31, 1};
  Card card{
      forged_pack({4, 4, 4, 4}, {forged_tile({{{0, 0, 1}, {4, 0, 2}, {0, 4, 3}}, {}})}, metadata)};
  const Device device(1);
  int16_t height = 5;
  const microtin_grid_spec block{256, 256, 0, 0, 1, 1, -9};
  for (int calls = 0; calls < 1000; ++calls) {
    microtin_pack_info info;
    if (microtin_pack_get_info(device.pack, &info) == MICROTIN_STATUS_OK) break;
    height = 5;
    REQUIRE(device.sample_grid(block, &height) == MICROTIN_QUERY_NOT_LOADED);
    REQUIRE(height == -9);
    card.most = 1;
    device.load(card, at(1, 1), 1);
  }
  REQUIRE(device.load(card, at(1, 1)) == MICROTIN_STATUS_OK);
  height = 5;
  CHECK(device.sample_grid(block, &height) == MICROTIN_QUERY_OUTSIDE);  // too coarse
  CHECK(height == 5);
}

TEST_CASE_TEMPLATE(
    "pack: headers that break a rule are malformed, damaged headers fail their checksum", Device,
    MeshSlots, CompactSlots) {
  const Bytes good = row_of_tiles(2);
  const auto status_of = [](const Bytes& bytes) {
    Card card{bytes};
    const Device device(2);
    return device.load(card, at(1, 1));
  };
  const auto with = [&](size_t at, uint8_t value) {
    Bytes bytes = good;
    bytes[at] = value;
    const size_t index = pack_index_start(PackFile(good).header());
    put_number(bytes, index - 4, crc32(0, bytes.data(), index - 4), 4);
    return bytes;
  };
  CHECK(status_of(good) == MICROTIN_STATUS_OK);
  CHECK(status_of(with(0, 'M')) == MICROTIN_STATUS_BAD_MAGIC);
  CHECK(status_of(with(4, kPackVersion + 1)) == MICROTIN_STATUS_UNSUPPORTED_VERSION);
  for (uint32_t flags = 1; flags < 256; ++flags) {
    Bytes flagged = with(5, static_cast<uint8_t>(flags));
    CHECK(status_of(flagged) == MICROTIN_STATUS_UNSUPPORTED_VERSION);
    flagged[8 + flags % 8] ^= 4;
    CHECK((status_of(flagged) == MICROTIN_STATUS_UNSUPPORTED_VERSION) == (flags >= 16));
  }
  for (const size_t at : {7u, 18u, 19u}) CHECK(status_of(with(at, 1)) == MICROTIN_STATUS_MALFORMED);
  Bytes placed = good;
  placed.insert(placed.begin() + kPackFixedBytes, 67, uint8_t{0});
  placed[6] = 67;
  const size_t end = pack_index_start(PackFile(good).header()) + 67 - kCheckBytes;
  put_number(placed, end, crc32(0, placed.data(), end), kCheckBytes);
  CHECK(status_of(placed) == MICROTIN_STATUS_MALFORMED);
  for (const size_t at : {10u, 12u, 20u, 24u})
    CHECK(status_of(with(at, 0)) == MICROTIN_STATUS_MALFORMED);
  for (const size_t at : {23u, 27u}) CHECK(status_of(with(at, 128)) == MICROTIN_STATUS_MALFORMED);
  for (const size_t at : {43u, 47u}) CHECK(status_of(with(at, 1)) == MICROTIN_STATUS_MALFORMED);
  CHECK(status_of(with(30, 255)) == MICROTIN_STATUS_OK);
  CHECK(status_of(with(31, 1)) == MICROTIN_STATUS_MALFORMED);  // above 2^24 vertices
  CHECK(status_of(with(36, static_cast<uint8_t>(~good[36]))) == MICROTIN_STATUS_BAD_TILES);
  // Damage is reported as such, unless the rest ends too early for it.
  for (size_t at = 8; at < pack_index_start(PackFile(good).header()); ++at) {
    Bytes damaged = good;
    damaged[at] ^= 4;
    PackHeader header{};
    read_pack_header(damaged.data(), &header);
    const bool is_short = pack_index_start(header) > damaged.size();
    CAPTURE(at);
    CHECK(status_of(damaged) == (is_short ? MICROTIN_STATUS_TRUNCATED : MICROTIN_STATUS_CHECKSUM));
  }
}

TEST_CASE_TEMPLATE("pack: tiles that break a rule are refused, here and on the host", Device,
                   MeshSlots, CompactSlots) {
  const Tin fits{{{0, 0, 1}, {4, 0, 2}, {0, 3, 3}, {4, 3, 4}}, {}};
  const ForgedTile good = forged_tile(fits);
  const TileGrid grid = {8, 3, 4, 3};
  const auto check = [&](const Bytes& bytes, microtin_status expected) {
    Card card{bytes};
    const Device device(2);
    CHECK(device.load(card, at(6, 1)) ==
          (expected == MICROTIN_STATUS_OK ? MICROTIN_STATUS_OK : MICROTIN_STATUS_BAD_TILES));
    CHECK(why_bad(device, 1) == expected);
    const auto read = [&] { PackFile(bytes).tile(1); };
    if (expected == MICROTIN_STATUS_OK) {
      CHECK_NOTHROW(read());
    } else {
      CHECK_THROWS_AS(read(), Error);
    }
  };
  const auto refuse = [&](const ForgedTile& tile) {
    check(forged_pack(grid, {good, tile}), MICROTIN_STATUS_MALFORMED);
  };
  check(forged_pack(grid, {good, good}), MICROTIN_STATUS_OK);
  refuse(forged_tile({{{0, 0, 1}, {5, 0, 2}, {0, 3, 3}}, {}}));  // too far to the east
  refuse(forged_tile({{{0, 0, 1}, {4, 0, 2}, {0, 4, 3}}, {}}));  // and to the north
  Bytes few = forged_pack(grid, {good, good});  // more than the header says of any tile
  put_number(few, 28, good.vertices - 1, 4);
  repair_checks(few);
  check(few, MICROTIN_STATUS_MALFORMED);
  Metadata placed, noted;
  placed.placement.x = {1, 1, 1};
  noted.source = "here";
  refuse({encode(fits, placed), good.vertices});
  refuse({encode(fits, noted), good.vertices});
  // The header claims more than the vertices need.
  check(forged_pack(grid, {good, {loose_stream(4, 3), 3}}), MICROTIN_STATUS_OK);
  refuse({loose_stream(5, 3), 3});
  refuse({loose_stream(4, 4), 3});
  // No stream that can be decoded: nothing tells that it is the right one.
  const Contract two = {2, 4, 3, kMinDegree, Coding::kBalanced, false, false};
  check(forged_pack(grid, {good, {write_header(two, {}), good.vertices}}),
        MICROTIN_STATUS_CHECKSUM);
}

TEST_CASE_TEMPLATE("pack: a chunk with marks behind a tile is skipped, here and on the host",
                   Device, MeshSlots, CompactSlots) {
  const ForgedTile plain = forged_tile({{{0, 0, 1}, {4, 0, 2}, {0, 3, 3}, {4, 3, 4}}, {}});
  ForgedTile marked = plain, malformed = plain;
  const DecodedTerrain decoded(plain.stream);
  uint32_t v[3];  // of a triangle that is real: two of its corners have an edge
  uint32_t t = 0;
  while (microtin_mesh_triangle(decoded.mesh(), t, v) != MICROTIN_TRIANGLE_REAL) ++t;
  append_edge_marks(decoded.mesh(), {{LineClass::kRidge, {v[0], v[1]}}}, marked.stream);
  REQUIRE(DecodedTerrain(marked.stream).marked_edges() == 1);
  malformed.stream.insert(malformed.stream.end(), {19, 1, 5});  // a chunk of one byte
  append_check(malformed.stream, plain.stream.size());
  CHECK_THROWS_WITH(DecodedTerrain(malformed.stream),
                    "the marks of edges behind the stream are malformed");
  for (const ForgedTile& tile : {plain, marked, malformed}) {
    const Bytes bytes = forged_pack({8, 3, 4, 3}, {plain, tile});
    Card card{bytes};
    const Device device(2);
    CHECK(device.load(card, at(6, 1)) == MICROTIN_STATUS_OK);
    const std::optional<DecodedTerrain> found = PackFile(bytes).tile(1);
    REQUIRE(found);
    CHECK(found->marked_edges() == 0);
    CHECK(found->mark_bytes() == 0);
    uint32_t hint = 0;
    int32_t height = 0, on_host = 1;
    CHECK(device.height_at(6 * 256, 256, height) == MICROTIN_QUERY_OK);
    CHECK(microtin_mesh_height_at(found->mesh(), 2 * 256, 256, &hint, &on_host, 0, 0) ==
          MICROTIN_QUERY_OK);
    CHECK(height == on_host);
  }
}

TEST_CASE_TEMPLATE("pack: all fields of a tile without terrain are 0", Device, MeshSlots,
                   CompactSlots) {
  const Bytes good = forged_pack({2, 2, 2, 2}, {ForgedTile()});
  const size_t entry = pack_index_start(PackFile(good).header());
  for (size_t at = 0; at < kPackEntryBytes - kCheckBytes; ++at) {
    if (at >= 5 && at < 8) continue;  // the size
    Card card{good};
    card.bytes[entry + at] = 1;
    repair_checks(card.bytes);
    const Device device(1);
    CHECK(device.load(card, {256, 256, 256, 256}) == MICROTIN_STATUS_BAD_TILES);
    CHECK(why_bad(device, 0) == MICROTIN_STATUS_MALFORMED);
    CHECK_THROWS_WITH_AS(PackFile(card.bytes), doctest::Contains("malformed"), Error);
  }
}

TEST_CASE_TEMPLATE("pack: tiles of a later version are distinguished from damaged ones", Device,
                   MeshSlots, CompactSlots) {
  const ForgedTile good = forged_tile({{{0, 0, 1}, {4, 0, 2}, {0, 3, 3}, {4, 3, 4}}, {}});
  const TileGrid grid = {8, 3, 4, 3};
  const auto check = [&](const Bytes& bytes, microtin_status expected) {
    for (const uint32_t slots : {1u, 2u}) {
      for (const uint32_t steps : {0u, 1u}) {
        Card card{bytes};
        const Device device(slots);
        const microtin_segment both = {256, 256, 7 * 256, 256};
        const microtin_status status = expected != MICROTIN_STATUS_OK ? MICROTIN_STATUS_BAD_TILES
                                       : slots == 1 ? MICROTIN_STATUS_WORKSPACE_TOO_SMALL
                                                    : MICROTIN_STATUS_OK;
        for (int calls = 0; calls < 2; ++calls) CHECK(served(device, card, both, steps) == status);
        CHECK(why_bad(device, 1) == expected);
        int32_t height = 0;
        CHECK(device.height_at(256, 256, height) == MICROTIN_QUERY_OK);
      }
    }
    if (expected == MICROTIN_STATUS_OK) {
      CHECK_NOTHROW(PackFile(bytes).tile(1));
      CHECK_NOTHROW(PackFile(bytes).expect_as_stated());
      return;
    }
    CHECK_THROWS_WITH_AS(PackFile(bytes).tile(1), doctest::Contains(describe(expected)), Error);
    CHECK_THROWS_WITH_AS(
        PackFile(bytes).expect_as_stated(),
        doctest::Contains(expected == MICROTIN_STATUS_UNSUPPORTED_VERSION ? "unsupported: tile 1: "
                                                                          : "bad: tile 1: "),
        Error);
  };
  const auto check_changed = [&](const Bytes& stream, microtin_status expected) {
    const Bytes bytes = forged_pack(grid, {good, {stream, good.vertices}});
    check(bytes, expected);
    Bytes damaged = bytes;
    damaged.back() ^= 1;
    check(damaged, MICROTIN_STATUS_CHECKSUM);
  };
  Bytes later = good.stream;
  later[4] = kVersion + 1;
  check_changed(later, MICROTIN_STATUS_UNSUPPORTED_VERSION);
  later.resize(700, 9);  // of which a device sees a part at a time
  check_changed(later, MICROTIN_STATUS_UNSUPPORTED_VERSION);
  for (uint32_t bit = kPropertyBits; bit < 64; ++bit) {
    Bytes payload;
    append_varint(payload, uint64_t{1} << bit | 10u << 5 | 2u << 3);
    payload.resize(200, 3);
    Bytes stream(good.stream.begin(), good.stream.begin() + kIdentityBytes);
    append_varint(stream, payload.size());
    stream.insert(stream.end(), payload.begin(), payload.end());
    append_check(stream, 0);
    check_changed(stream, MICROTIN_STATUS_UNSUPPORTED_VERSION);
  }
  Bytes with_chunks = good.stream;  // what follows a stream, short and long
  for (const size_t size : {size_t{0}, size_t{90}, size_t{300}}) {
    Bytes chunk;
    append_varint(chunk, 77);
    append_varint(chunk, size);
    chunk.resize(chunk.size() + size, 5);
    append_check(chunk, 0);
    with_chunks.insert(with_chunks.end(), chunk.begin(), chunk.end());
    check_changed(with_chunks, MICROTIN_STATUS_OK);
  }
}

TEST_CASE_TEMPLATE("pack: streams are shared, lie anywhere, and may overlap", Device, MeshSlots,
                   CompactSlots) {
  const Tin flat{{{0, 0, 1}, {4, 0, 2}, {0, 4, 3}, {4, 4, 4}}, {}};
  const ForgedTile tile = forged_tile(flat);
  const auto size = static_cast<uint32_t>(tile.stream.size());
  PackContent content{{16, 4, 4, 4}, {}, {}};
  TileSummary summary;
  summary.bytes = size;
  summary.stream_hash = stream_hash(kStreamHash, tile.stream.data(), size);
  summary.vertices = 4;
  summary.lowest = 1;
  summary.highest = 4;
  for (const uint64_t offset : {700u, 0u, 700u, 700u}) {
    content.tiles.push_back(summary);
    content.tiles.back().offset = offset;
  }
  Bytes streams(700 + size, 9);  // gaps
  std::copy(tile.stream.begin(), tile.stream.end(), streams.begin());
  std::copy(tile.stream.begin(), tile.stream.end(), streams.begin() + 700);
  const Bytes bytes = pack::write_pack(content, streams);
  Card card{bytes};
  const Device device(4);
  CHECK(device.load(card, {0, 300, 16 * 256, 300}) == MICROTIN_STATUS_OK);
  CHECK_NOTHROW(PackFile(bytes).expect_as_stated());
  // A stream that is a part of another tile's, which ends with it as a chunk's content.
  Bytes outer = tile.stream, head;
  append_varint(head, 77);
  append_varint(head, size);
  const size_t begin = outer.size() + head.size();
  head.insert(head.end(), tile.stream.begin(), tile.stream.end());
  append_check(head, 0);
  outer.insert(outer.end(), head.begin(), head.end());
  for (TileSummary& each : content.tiles) each.offset = begin;
  content.tiles[1].offset = 0;
  content.tiles[1].bytes = static_cast<uint32_t>(outer.size());
  content.tiles[1].stream_hash = stream_hash(kStreamHash, outer.data(), outer.size());
  Card nested{pack::write_pack(content, outer)};
  const Device other(4);
  CHECK(other.load(nested, {0, 300, 16 * 256, 300}) == MICROTIN_STATUS_OK);
  CHECK_NOTHROW(PackFile(nested.bytes).expect_as_stated());
}

}  // namespace microtin::tests
