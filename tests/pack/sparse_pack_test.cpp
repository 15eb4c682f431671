// SPDX-License-Identifier: MIT
// Packs of several grids that share a lattice: posts are not at every place of it.
#include <doctest/doctest.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "encoder/pack/sparse_line.hpp"
#include "tests/support/border_walk.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

// Whether a post is at a place, and how far posts are apart at most.
struct Grids {
  std::string name;
  std::function<bool(int, int)> has_post;
  uint32_t x_spacing, y_spacing;
};

const std::vector<Grids>& grids() {
  static const std::vector<Grids> all = {
      {"every second column", [](int x, int) { return x % 2 == 0; }, 2, 1},
      {"bands of 3 and 2 columns", [](int x, int y) { return y < 27 ? x % 2 == 0 : x % 3 == 0; }, 3,
       1},
      {"bands whose posts share no column",
       [](int x, int y) { return y < 27 ? x % 4 == 2 : x % 6 == 3; }, 6, 1},
      {"half a step off in x and y",
       [](int x, int y) { return x < 30 ? x % 2 == 0 && y % 2 == 0 : x % 2 == 1 && y % 2 == 1; }, 2,
       2},
      {"a coarse grid in x and y next to a fine one",
       [](int x, int y) { return x < 31 || (x % 5 == 0 && y % 5 == 0); }, 5, 5},
      {"ten columns and one", [](int x, int y) { return y < 27 ? x % 10 == 0 : x % 1 == 0; }, 10,
       1},
  };
  return all;
}

Raster sparse_raster(const Grids& grids, const VoidAt& void_at = no_void) {
  Raster raster = rough_raster(61, 53, void_at);
  raster.x_spacing = grids.x_spacing;
  raster.y_spacing = grids.y_spacing;
  for (size_t post = 0; post < raster.heights.size(); ++post) {
    const int x = static_cast<int>(post % 61), y = static_cast<int>(post / 61);
    if (!grids.has_post(x, y)) raster.heights[post] = kNoPost;
  }
  return raster;
}

void check_sparse_pack(const Raster& raster, const PackOptions& options) {
  const PackFile pack(write_pack(encode_pack(raster, options)));
  CAPTURE(pack.grid().width);
  const BorderCount count = walk_borders(pack, raster);
  CHECK(count.differ == 0);
  if (void_posts(raster) == 0) CHECK(count.one_sided == 0);
  CHECK(count.wrong_posts == 0);
  if (pack.entries().size() > 1) CHECK(count.both > 0);
  const Verification found = verify(pack, raster, options.lattice.max_error);
  CHECK(found.posts == posts_with_height(raster));
  CHECK(found.voids == void_posts(raster));
  CHECK(found.within_bound);
  CHECK(found.uncovered == 0);
  CHECK(found.voids_answered == 0);
}

}  // namespace

TEST_CASE("between posts stands what lies on the line between the next ones") {
  Raster part = raster_of(4, {0, kNoPost, kNoPost, 30, kVoidHeight, kNoPost, kNoPost, 30});
  part.x_spacing = 3;
  const std::vector<Sample> samples = {
      {{0, 0}, 0, -300, 300}, {{3, 0}, 30, -270, 330}, {{3, 1}, 30, -270, 330}};
  const PlaceSamples places(part, samples);
  const std::optional<Sample> near = places.at(1, 0), far = places.at(2, 0);
  REQUIRE(near.has_value());
  REQUIRE(far.has_value());
  CHECK(near->height == 10);
  CHECK(near->lowest == -290);
  CHECK(near->highest == 310);
  CHECK(far->height == 20);
  CHECK(!places.at(1, 1).has_value());
  CHECK(places.all().size() == 5);
  CHECK(line_samples(places, {0, 0, 4, true}, 3).size() == 2);
  CHECK(line_samples(places, {1, 0, 2, false}, 1).size() == 2);
  CHECK(!line_samples(places, {1, 0, 2, false}, 1)[1].has_value());
}

TEST_CASE("packs of several grids: no cracks, every post within its bound, whatever the tiles" *
          kSlow) {
  for (const Grids& each : grids()) {
    CAPTURE(each.name);
    const Raster raster = sparse_raster(each);
    for (const uint32_t size : {7u, 10u, 13u, 20u, 60u}) {
      PackOptions options = pack_options(2, 1000);
      options.tile_size = size;
      check_sparse_pack(raster, options);
    }
    check_sparse_pack(raster, pack_options(4, 60));
  }
}

TEST_CASE("packs of several grids: no place between posts is left out" * kSlow) {
  for (const Grids& each : grids()) {
    CAPTURE(each.name);
    PackOptions options = pack_options(2, 1000);
    options.tile_size = 11;
    const PackFile pack(write_pack(encode_pack(sparse_raster(each), options)));
    const Tiles tiles(pack);
    BorderCount count;
    uint64_t missing = 0;
    for (int64_t y = 5 * 256; y <= 48 * 256; y += 64) {  // rims of grids may be a cell apart
      for (int64_t x = 10 * 256; x <= 50 * 256; x += 64) {
        if (!compare_at(tiles, x, y, count)) ++missing;
      }
    }
    CHECK(missing == 0);
    CHECK(count.differ == 0);
  }
}

TEST_CASE("packs of several grids: voids stay voids" * kSlow) {
  for (const Grids& each : grids()) {
    CAPTURE(each.name);
    for (const VoidKind& kind : void_kinds()) {
      if (kind.name == "30 of 100" || kind.name == "chessboard") continue;  // posts stand alone
      CAPTURE(kind.name);
      const Raster raster = sparse_raster(each, kind.at);
      try {
        PackOptions options = pack_options(2, 1000);
        options.tile_size = 16;
        check_sparse_pack(raster, options);
      } catch (const Error& error) {
        FAIL_CHECK(error.what());
      }
    }
  }
}

TEST_CASE("packs of several grids: without a bound, and never below") {
  for (const Grids& each : grids()) {
    CAPTURE(each.name);
    const Raster raster = sparse_raster(each);
    PackOptions exact{{}, {}, 5000, 17};
    const PackFile pack(write_pack(encode_pack(raster, exact)));
    CHECK(walk_borders(pack, raster).differ == 0);
    const Verification found = verify(pack, raster, Decimal{0, 0});
    CHECK(found.within_bound);
    CHECK(found.uncovered == 0);
    PackOptions above = pack_options(6, 1000);
    above.lattice.never_below = true;
    above.tile_size = 17;
    const PackFile high(write_pack(encode_pack(raster, above)));
    CHECK(verify(high, raster, Decimal{6, 0}).max_below.mantissa == 0);
  }
}

}  // namespace microtin::tests
