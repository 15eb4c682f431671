// SPDX-License-Identifier: MIT
// Shards: any split of a pack's tiles joins to the bytes of a single run, and nothing else joins.
#include "encoder/pack/shard.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "tests/support/files.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/slow.hpp"
#include "tests/support/temporary_folder.hpp"

namespace microtin::tests {
namespace {

using Bytes = std::vector<uint8_t>;

// A raster whose tiles are encoded one by one, as if by as many machines, of which each plans the
// same.
class Shards {
 public:
  Shards(const Raster& raster, const PackOptions& options)
      : raster_(raster), single_(encode_pack(raster, options)), plan_(plan_pack(raster_, options)) {
    for (uint32_t tile = 0; tile <= all_tiles(plan_.tiled.grid).last; ++tile) {
      encode_tiles(plan_, {tile, tile}, [&](uint32_t number, EncodedTile&& encoded) {
        CHECK(number == tile);
        tiles_.push_back(std::move(encoded));
      });
    }
  }

  Bytes single() const { return write_pack(single_); }
  uint32_t tiles() const { return static_cast<uint32_t>(tiles_.size()); }

  std::string write(TileRange range) {
    std::string path = folder_ / (std::to_string(range.first) + "-" + std::to_string(range.last));
    OutputFile out(path);
    ShardWriter shard(plan_, content_of(plan_, {}), range, out);
    for (uint32_t tile = range.first; tile <= range.last; ++tile) shard.add(tiles_[tile]);
    out.commit();
    return path;
  }

  Bytes merge(const std::vector<std::string>& shards) {
    const std::string path = folder_ / "merged";
    OutputFile out(path);
    StreamSpool streams(path);
    out.write(write_pack_head(merge_shards(shards, streams)));
    streams.copy_to(out);
    out.commit();
    return bytes_of_file(path);
  }

  // What merge says, without the folder.
  std::string refusal(const std::vector<std::string>& shards) {
    try {
      merge(shards);
    } catch (const Error& error) {
      std::string text = error.what();
      const std::string folder = folder_.path() + "/";
      for (size_t at = 0; (at = text.find(folder)) != std::string::npos;) {
        text.erase(at, folder.size());
      }
      return text;
    }
    return "";
  }

  const TemporaryFolder& folder() const { return folder_; }

 private:
  RasterInMemory raster_;
  EncodedPack single_;
  PackPlan plan_;
  std::vector<EncodedTile> tiles_;
  TemporaryFolder folder_;
};

}  // namespace

TEST_CASE("shards: tiles encoded one by one, in any split, are those of a single run" * kSlow) {
  for (const VoidKind& kind : void_kinds()) {
    if (kind.name == "30 of 100") continue;  // many tiles
    CAPTURE(kind.name);
    PackOptions options = pack_options(4, 250);
    options.tile_size = 25;
    Shards shards(rough_raster(61, 53, kind.at), options);
    const Bytes single = shards.single();
    const uint32_t last = shards.tiles() - 1;
    REQUIRE(last > 3);
    CHECK(shards.merge({shards.write({0, last})}) == single);
    for (uint32_t cut = 0; cut < last; ++cut) {
      CHECK(shards.merge({shards.write({cut + 1, last}), shards.write({0, cut})}) == single);
    }
    std::vector<std::string> each;
    for (uint32_t tile = 0; tile <= last; ++tile) each.push_back(shards.write({tile, tile}));
    CHECK(shards.merge(each) == single);
  }
}

TEST_CASE("shards: missing, duplicate, foreign and damaged shards are refused") {
  const Raster raster = rough_raster(61, 53);
  PackOptions several = pack_options(6, 60);
  several.tile_size = 25;
  Shards shards(raster, several);
  const uint32_t last = shards.tiles() - 1;
  const std::string all = std::to_string(last), first = shards.write({0, 2}),
                    rest = shards.write({3, last});
  REQUIRE(shards.refusal({rest, first}).empty());
  CHECK(shards.refusal({first}) ==
        "tiles 3 to " + all + " are in no shard; name their shards, too");
  CHECK(shards.refusal({rest}) == "tiles 0 to 2 are in no shard; name their shards, too");
  CHECK(shards.refusal({first, shards.write({4, last})}) ==
        "tile 3 is in no shard; name its shard, too");
  CHECK(shards.refusal({first, rest, first}) == "0-2: tile 0 is also in 0-2");
  CHECK(shards.refusal({first, shards.write({2, last})}) == "2-" + all + ": tile 2 is also in 0-2");

  for (const auto& [other, options] :
       {std::pair(rough_raster(61, 53, [](int x, int y) { return x == 60 && y == 52; }),
                  pack_options(6, 60)),
        std::pair(raster, pack_options(5, 60)), std::pair(raster, pack_options(6, 61))}) {
    PackOptions tiled = options;
    tiled.tile_size = several.tile_size;
    Shards foreign(other, tiled);
    const std::string text = shards.refusal({first, foreign.write({3, 3})});
    CHECK(text.find("is of another terrain, or made with other options, than 0-2") !=
          std::string::npos);
  }

  const Bytes good = bytes_of_file(rest);
  const std::string bad = shards.folder() / "bad";
  for (size_t i = 0; i < good.size(); i += 7) {
    CAPTURE(i);
    Bytes damaged = good;
    damaged[i] ^= static_cast<uint8_t>(1u << i % 8);
    write_file(bad, damaged);
    CHECK(!shards.refusal({first, bad}).empty());
    write_file(bad, {good.begin(), good.begin() + static_cast<std::ptrdiff_t>(i)});
    CHECK(!shards.refusal({first, bad}).empty());
  }
  write_file(bad, {'n', 'o'});
  CHECK(shards.refusal({bad}) ==
        "bad: not a shard that this version of microtin made; encode it again");
}

namespace {

constexpr size_t kStart = 9, kCheck = 4;

size_t head_bytes(const Bytes& shard) {
  return read_u32(shard.data() + 5);
}

// A shard of which a part, in front of its check, has other bytes, and the right check.
Bytes with_part(Bytes shard, size_t part, size_t size, size_t offset, const Bytes& bytes) {
  std::copy(bytes.begin(), bytes.end(), shard.begin() + static_cast<std::ptrdiff_t>(part + offset));
  const uint32_t check = crc32(0, shard.data() + part, size);
  for (size_t i = 0; i < kCheck; ++i) {
    shard[part + size + i] = static_cast<uint8_t>(check >> 8 * i);
  }
  return shard;
}

Bytes with_head(const Bytes& shard, size_t offset, const Bytes& bytes) {
  return with_part(shard, kStart, head_bytes(shard), offset, bytes);
}

// Writes bytes into the summary of the first tile.
Bytes with_summary(const Bytes& shard, size_t offset, const Bytes& bytes) {
  constexpr size_t kRange = 8, kSummary = 150;
  const size_t summary = kStart + head_bytes(shard) + kCheck + kRange + kCheck;
  return with_part(shard, summary, kSummary, offset, bytes);
}

}  // namespace

TEST_CASE("shards: no tile claims what no tile can have") {
  PackOptions options = pack_options(6, 250);
  options.tile_size = 25;
  Shards shards(rough_raster(61, 53), options);
  const Bytes good = bytes_of_file(shards.write({0, shards.tiles() - 1}));
  const std::string forged = shards.folder() / "forged";
  write_file(forged, with_summary(good, 0, {}));
  REQUIRE(shards.refusal({forged}).empty());
  const Bytes all(8, 0xFF), most = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0x7F},
                            least = {0, 0, 0, 0, 0, 0, 0, 0x80};
  constexpr size_t kVertices = 8, kBelow = 16, kAbove = 20, kPosts = 24, kCovered = 32, kVoids = 40,
                   kMaxError = 56, kMaxBelow = 65, kMaxAbove = 74, kRms = 83, kMean = 92,
                   kRepeats = 101;
  for (const auto& row :
       {std::pair(kVertices, Bytes{0, 0, 0, 2}), std::pair(kBelow, Bytes{1, 0, 16, 0}),
        std::pair(kAbove, Bytes{254, 255, 255, 255}), std::pair(kPosts, all),
        std::pair(kPosts, most), std::pair(kCovered, most), std::pair(kVoids, all),
        std::pair(kVoids, most), std::pair(kMaxError, least), std::pair(kMaxError + 8, Bytes{10}),
        std::pair(kMaxBelow, most), std::pair(kMaxAbove, most), std::pair(kRms, most),
        std::pair(kMean, most), std::pair(kMean, least),
        std::pair(kMean, Bytes{1, 0, 0, 0, 0, 0, 0, 0x80}),
        std::pair(kRepeats, Bytes{0, 0, 0, 2})}) {
    const size_t offset = row.first;
    const Bytes& bytes = row.second;
    CAPTURE(offset);
    write_file(forged, with_summary(good, offset, bytes));
    CHECK(shards.refusal({forged}).find("malformed") != std::string::npos);
  }
}

TEST_CASE("shards: no pack has more tiles than can be made") {
  PackOptions options = pack_options(6, 250);
  options.tile_size = 25;
  Shards shards(rough_raster(51, 26), options);  // two tiles
  const Bytes good = bytes_of_file(shards.write({0, shards.tiles() - 1}));
  const std::string forged = shards.folder() / "forged";
  constexpr size_t kLargestX = 20;
  write_file(forged, with_head(good, kLargestX, {0, 0, 0x90, 1}));  // 2^20 columns
  CHECK(shards.refusal({forged}) == "tiles 2 to 1048575 are in no shard; name their shards, too");
  write_file(forged, with_head(good, kLargestX, {1, 0, 0x90, 1}));
  CHECK(shards.refusal({forged}) == "forged: malformed: a rule of the format is broken");
}

TEST_CASE("packs: tiles become smaller until none has too many vertices") {
  PackOptions options = pack_options(2, 34);
  options.simplify.search = Search::kGreedy;
  std::vector<uint32_t> tried;
  uint32_t most = 0, tiles = 0;
  const auto begin = [&](const PackPlan& plan) {
    tried.push_back(plan.tile_size);
    most = tiles = 0;
    return 0;
  };
  // The largest tile is none of the roughest, which planning counts.
  encode_pack(RasterInMemory(rough_raster(121, 113)), options, 0, begin,
              [&](uint32_t tile, EncodedTile&& encoded) {
                CHECK(tile == tiles++);
                most = std::max(most, encoded.summary.vertices);
              });
  CHECK(tried.size() > 1);
  CHECK(tried.size() < 5);
  CHECK(std::adjacent_find(tried.begin(), tried.end(), std::less_equal<>()) == tried.end());
  CHECK(most <= 34);
  CHECK(most > 17);
}

TEST_CASE("packs: planned tiles have most of the vertices allowed, and are planned once") {
  for (const Search search : {Search::kFast, Search::kNormal}) {
    for (const uint32_t allowed : {100u, 150u}) {
      PackOptions options = pack_options(2, allowed);
      options.simplify.search = search;
      uint32_t plans = 0, most = 0;
      encode_pack(
          RasterInMemory(rough_raster(241, 225)), options, 0,
          [&](const PackPlan&) { return plans++, 0u; },
          [&](uint32_t, EncodedTile&& encoded) {
            most = std::max(most, encoded.summary.vertices);
          });
      CHECK(plans == 1);
      CHECK(most > allowed * 3 / 4);
    }
  }
}

TEST_CASE("packs: a shard whose tile is too large prints the size of tiles to try") {
  const RasterInMemory raster(rough_raster(61, 53));
  PackOptions options = pack_options(2, 40);
  options.tile_size = 60;
  const PackPlan plan = plan_pack(raster, options);
  try {
    encode_tiles(plan, {0, 0}, [](uint32_t, EncodedTile&&) {});
    FAIL("is not refused");
  } catch (const TileTooLarge& error) {
    CHECK(error.fewer_steps < 60);
    CHECK(std::string(error.what())
              .find("vertices, more than a tile may have; use tile_size " +
                    std::to_string(error.fewer_steps)) != std::string::npos);
  }
}

}  // namespace microtin::tests
