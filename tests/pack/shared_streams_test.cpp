// SPDX-License-Identifier: MIT
// Tiles with equal streams share one: behind every door that writes packs.
#include <doctest/doctest.h>

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "encoder/files/output.hpp"
#include "encoder/pack/point_pack.hpp"
#include "encoder/pack/shard.hpp"
#include "tests/support/files.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/temporary_folder.hpp"

namespace microtin::tests {
namespace {

using Bytes = std::vector<uint8_t>;

// An ocean at height 0, with an island in a corner.
Raster ocean(uint32_t width, bool has_island) {
  Raster raster = rough_raster(width, width);
  for (uint32_t i = 0; i < width * width; ++i) {
    const bool is_land = has_island && i % width < 20 && i / width < 20;
    if (!is_land) raster.heights[i] = 0;
  }
  return raster;
}

// Tiles with terrain, and their streams, each counted once.
std::pair<size_t, size_t> tiles_and_streams(const PackFile& pack) {
  size_t tiles = 0;
  std::set<std::vector<uint64_t>> streams;
  for (const IndexEntry& entry : pack.entries()) {
    if (entry.size == 0) continue;
    ++tiles;
    streams.insert({entry.offset, entry.size});
  }
  return {tiles, streams.size()};
}

PackOptions flat_options() {
  PackOptions options = pack_options(1, 400);
  options.tile_size = 16;
  return options;
}

}  // namespace

TEST_CASE("packs: an ocean of flat tiles costs the bytes of one") {
  const EncodedPack encoded = encode_pack(ocean(257, false), flat_options());
  REQUIRE(encoded.streams.size() == 256);
  const Bytes bytes = write_pack(encoded);
  const PackFile pack(bytes);
  CHECK(tiles_and_streams(pack) == std::pair(size_t{256}, size_t{1}));
  CHECK(bytes.size() ==
        pack_entry_start(pack.header(), 0) + 256 * kPackEntryBytes + encoded.streams[0].size());
  CHECK_NOTHROW(pack.expect_as_stated());
  CHECK(verify(pack, ocean(257, false), Decimal{1, 0}).within_bound);
}

TEST_CASE("packs: tiles that differ have streams of their own, equal ones share") {
  const Raster raster = ocean(257, true);
  const EncodedPack encoded = encode_pack(raster, flat_options());
  const Bytes bytes = write_pack(encoded);
  const PackFile pack(bytes);
  const std::set<Bytes> different(encoded.streams.begin(), encoded.streams.end());
  CHECK(different.size() > 4);
  CHECK(tiles_and_streams(pack) == std::pair(size_t{256}, different.size()));
  for (uint32_t tile = 0; tile < 256; ++tile) {
    const IndexEntry& entry = pack.entries()[tile];
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(entry.offset);
    CHECK(Bytes(begin, begin + entry.size) == encoded.streams[tile]);
  }
  CHECK(verify(pack, raster, Decimal{1, 0}).within_bound);
}

TEST_CASE("packs: shards join to the pack of a single run, shared streams too") {
  const TemporaryFolder folder;
  const Raster raster = ocean(129, true);
  const RasterInMemory reader(raster);
  const PackPlan plan = plan_pack(reader, flat_options());
  const uint32_t last = all_tiles(plan.tiled.grid).last;
  std::vector<std::string> paths;
  for (const TileRange range : {TileRange{0, last / 2}, TileRange{last / 2 + 1, last}}) {
    paths.push_back(folder / std::to_string(range.first));
    OutputFile out(paths.back());
    ShardWriter shard(plan, content_of(plan, {}), range, out);
    encode_tiles(plan, range, [&](uint32_t, EncodedTile&& tile) { shard.add(tile); });
    out.commit();
  }
  const std::string path = folder / "merged";
  OutputFile out(path);
  StreamSpool streams(path);
  out.write(write_pack_head(merge_shards(paths, streams)));
  streams.copy_to(out);
  out.commit();
  CHECK(bytes_of_file(path) == write_pack(encode_pack(raster, flat_options())));
}

TEST_CASE("packs: flat tiles of points share a stream") {
  PointCloud cloud;
  for (int64_t x = 0; x <= 64; ++x) {
    for (int64_t y = 0; y <= 64; ++y) cloud.points.push_back({x, y, 7});
  }
  PackOptions options = pack_options(1, 16);
  options.simplify.bounded = false;
  options.lattice.max_error.reset();
  options.max_vertices = 400;
  const PointPack made = encode_point_pack(cloud, options, {});
  const PackFile pack(pack::write_pack(made.content, made.streams));
  const auto [tiles, streams] = tiles_and_streams(pack);
  CHECK(tiles == pack.entries().size());
  CHECK(tiles >= 16);
  CHECK(streams <= 9);  // tiles in corners, along sides, and between have their own extents
  CHECK_NOTHROW(pack.expect_as_stated());
}

TEST_CASE("streams: a spool keeps equal ones once, whatever comes between") {
  const TemporaryFolder folder;
  StreamSpool streams(folder / "pack");
  const Bytes a(300, 1), b(300, 2), none;
  CHECK(streams.add(a) == 0);
  CHECK(streams.add(b) == 300);
  CHECK(streams.add(none) == 0);
  CHECK(streams.add(a) == 0);
  CHECK(streams.add(Bytes(299, 1)) == 600);
  CHECK(streams.add(b) == 300);
  OutputFile out(folder / "all");
  streams.copy_to(out);
  out.commit();
  Bytes all = a;
  all.insert(all.end(), b.begin(), b.end());
  all.resize(899, 1);
  CHECK(bytes_of_file(folder / "all") == all);
  streams.clear();
  CHECK(streams.add(b) == 0);
}

}  // namespace microtin::tests
