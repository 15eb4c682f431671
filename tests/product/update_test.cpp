// SPDX-License-Identifier: MIT
// Packs that are brought up to date: only tiles whose terrain changed are new, and the whole keeps
// what the old pack stated, without cracks.
#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/pack/surface.hpp"
#include "encoder/product/made_pack.hpp"
#include "tests/support/border_walk.hpp"
#include "tests/support/files.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/session.hpp"
#include "tests/support/temporary_folder.hpp"

namespace microtin::tests {
namespace {

using Bytes = std::vector<uint8_t>;
using Change = std::function<int64_t(int x, int y, int64_t z)>;

// Tiles of 20 posts a side, so 4 x 3 of them.
PackOptions tiles_of_20(int64_t bound) {
  PackOptions options = pack_options(bound, 600);
  options.tile_size = 20;
  return options;
}

Raster changed(Raster raster, const Change& change) {
  for (size_t i = 0; i < raster.heights.size(); ++i) {
    const auto column = static_cast<int>(i % raster.width),
               row = static_cast<int>(i / raster.width);
    raster.heights[i] = change(column, row, raster.heights[i]);
  }
  return raster;
}

class OldPack {
 public:
  explicit OldPack(Bytes bytes) : bytes_(std::move(bytes)) {
    OutputFile out(path_);
    out.write(bytes_);
    out.commit();
  }
  OldPack(const Raster& raster, const PackOptions& options)
      : OldPack(write_pack(encode_pack(raster, options))) {}

  const Bytes& bytes() const { return bytes_; }

  struct Updated {
    Bytes bytes;
    uint32_t kept;
  };
  Updated update(const Raster& raster, uint32_t tile_vertices = 0) const {
    EncodeOptions options;
    options.search = Search::kFast;
    options.tile_vertices = tile_vertices;
    const std::string path = folder_ / "new.mtp";
    OutputFile out(path);
    StreamSpool streams(path);
    const UpdatedPack updated =
        update_pack(path_, RasterInMemory(raster), options, {}, streams, {});
    out.write(write_pack_head(updated.content));
    streams.copy_to(out);
    out.commit();
    return {bytes_of_file(path), updated.kept};
  }

  std::string refusal(const Raster& raster) const {
    try {
      update(raster);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

 private:
  TemporaryFolder folder_;
  std::string path_ = folder_ / "old.mtp";
  Bytes bytes_;
};

void expect_keeps_all(const PackFile& pack, const Raster& raster, int64_t bound) {
  const Verification found = verify(pack, raster, Decimal{bound, 0});
  CHECK(found.within_bound);
  CHECK(found.uncovered == 0);
  CHECK(found.voids_answered == 0);
  CHECK(found.broken == "");
  CHECK_NOTHROW(pack.expect_as_stated());
  const BorderCount borders = walk_borders(pack, raster);
  CHECK(borders.differ == 0);
  CHECK(borders.wrong_posts == 0);
}

// Tiles that may be new where posts change in a rectangle: those that hold one of them.
uint32_t tiles_that_hold(const TileGrid& grid, int x, int y, int x_end, int y_end) {
  uint32_t count = 0;
  for (uint32_t tile = 0; tile < tile_count(grid); ++tile) {
    const TileBox box = tile_box(grid, tile);
    const auto meets = [](int from, int to, uint32_t first, uint32_t last) {
      return from <= static_cast<int>(last) && to >= static_cast<int>(first);
    };
    if (meets(x, x_end, box.x, box.x_end) && meets(y, y_end, box.y, box.y_end)) ++count;
  }
  return count;
}

struct Place {
  const char* name;
  int x, y, x_end, y_end;
};

// Where heights change: rectangles of posts, with their last column and row.
const std::vector<Place> kPlaces = {
    {"inside a tile", 5, 5, 9, 8},         {"beside a border", 17, 5, 19, 9},
    {"on a border", 20, 5, 20, 9},         {"a corner of four tiles", 20, 20, 20, 20},
    {"around a corner", 38, 18, 42, 22},   {"a row", 0, 30, 60, 30},
    {"the last post", 60, 52, 60, 52},     {"a border's whole length", 20, 20, 20, 40},
    {"all beside a border", 19, 0, 19, 52}};

}  // namespace

TEST_CASE("update: an unchanged terrain gives the same bytes") {
  for (const VoidKind& kind : void_kinds()) {
    if (kind.name == "30 of 100") continue;  // many tiles
    CAPTURE(kind.name);
    const Raster raster = rough_raster(61, 53, kind.at);
    PackOptions options = pack_options(3, 250);
    const OldPack old(raster, options);
    const OldPack::Updated updated = old.update(raster);
    CHECK(updated.kept == tile_count(PackFile(old.bytes()).grid()));
    CHECK(updated.bytes == old.bytes());
  }
}

TEST_CASE("update: only tiles that hold a changed post are new, whatever changes") {
  const int64_t bound = 3;
  const std::vector<Change> changes = {
      [](int, int, int64_t z) { return z + 40; }, [](int, int, int64_t z) { return z - 7; },
      [](int, int, int64_t) { return kVoidHeight; },
      [](int x, int y, int64_t z) { return (x + y) % 3 == 0 ? kVoidHeight : z; }};
  for (const VoidKind& kind : {void_kinds()[0], void_kinds()[2], void_kinds()[13]}) {
    const Raster before = rough_raster(61, 53, kind.at);
    const OldPack old(before, tiles_of_20(bound));
    const PackFile first(old.bytes());
    for (const Place& place : kPlaces) {
      for (size_t i = 0; i < changes.size(); ++i) {
        CAPTURE(kind.name);
        CAPTURE(place.name);
        CAPTURE(i);
        const Raster after = changed(before, [&](int x, int y, int64_t z) {
          const bool is_there =
              x >= place.x && x <= place.x_end && y >= place.y && y <= place.y_end;
          return is_there && z != kVoidHeight ? changes[i](x, y, z) : z;
        });
        const OldPack::Updated updated = old.update(after, 600);
        const PackFile second(updated.bytes);
        expect_keeps_all(second, after, bound);
        uint32_t same = 0;
        for (uint32_t tile = 0; tile < second.tiles(); ++tile) {
          if (first.stream(tile) == second.stream(tile)) ++same;
        }
        CHECK(same >= updated.kept);
        // New voids concern also tiles whose border is next to them.
        const int beside = i < 2 ? 0 : 1;
        CHECK(updated.kept >=
              second.tiles() - tiles_that_hold(second.grid(), place.x - beside, place.y - beside,
                                               place.x_end + beside, place.y_end + beside));
        if (i == 0 && after.heights != before.heights) CHECK(updated.kept < second.tiles());
      }
    }
  }
}

TEST_CASE("update: a tile whose margins do not hold any more is new, although its bound holds") {
  const Raster flat = raster_of(61, std::vector<int64_t>(61 * 53, 7));
  const Raster bump =
      changed(flat, [](int x, int y, int64_t z) { return x == 30 && y == 30 ? z + 2 : z; });
  const OldPack old(flat, tiles_of_20(3));
  const OldPack::Updated updated = old.update(bump, 600);
  CHECK(updated.kept == PackFile(old.bytes()).tiles() - 1);
  expect_keeps_all(PackFile(updated.bytes), bump, 3);
}

TEST_CASE("update: voids that are filled, and tiles that had no terrain") {
  const Raster full = rough_raster(61, 53);
  const Raster before = rough_raster(61, 53, [](int x, int y) { return x < 21 && y < 21; });
  const OldPack old(before, tiles_of_20(3));
  const OldPack::Updated updated = old.update(full, 600);
  const PackFile pack(updated.bytes);
  expect_keeps_all(pack, full, 3);
  CHECK(updated.kept < pack.tiles());
  CHECK(updated.kept >= pack.tiles() - 4);
  const OldPack whole(full, tiles_of_20(3));
  expect_keeps_all(PackFile(whole.update(before, 600).bytes), before, 3);
}

TEST_CASE("update: an update of an update, many times, keeps all") {
  Random random(7);
  Raster raster = rough_raster(61, 53);
  Bytes bytes = write_pack(encode_pack(raster, tiles_of_20(3)));
  for (int round = 0; round < 12; ++round) {
    const int x = static_cast<int>(random.below(50)), y = static_cast<int>(random.below(40));
    raster = changed(raster, [&](int px, int py, int64_t z) {
      return px >= x && px < x + 8 && py >= y && py < y + 8 ? z + 9 : z;
    });
    bytes = OldPack(bytes).update(raster, 600).bytes;
    CAPTURE(round);
    expect_keeps_all(PackFile(bytes), raster, 3);
  }
}

TEST_CASE("update: without a bound all posts are vertices, also of new tiles") {
  const Raster before = rough_raster(61, 53);
  PackOptions options = tiles_of_20(3);
  options.lattice.max_error.reset();
  options.simplify.bounded = false;
  const OldPack old(before, options);
  const Raster after =
      changed(before, [](int x, int y, int64_t z) { return x == 5 && y == 5 ? z + 1 : z; });
  const OldPack::Updated updated = old.update(after);
  CHECK(updated.kept == PackFile(old.bytes()).tiles() - 1);
  CHECK(updated.bytes == write_pack(encode_pack(after, options)));
}

TEST_CASE("update: what does not fit the old pack is refused") {
  const Raster raster = rough_raster(61, 53);
  const OldPack old(raster, tiles_of_20(3));
  CHECK(contains(old.refusal(rough_raster(60, 53)), "not a raster with the posts of the pack"));
  const Raster high = changed(raster, [](int x, int, int64_t z) { return x == 3 ? 900000 : z; });
  CHECK(contains(old.refusal(high), "beyond the lattice's range"));
  const Raster noisy = changed(raster, [](int x, int y, int64_t z) {
    return x < 18 && y < 18
               ? z + static_cast<int64_t>(Random(static_cast<uint64_t>(x * 100 + y)).below(90))
               : z;
  });
  CHECK(contains(old.refusal(noisy), "and the pack states at most "));
  CHECK(old.update(noisy, 600).kept >= 8);
}

}  // namespace microtin::tests
