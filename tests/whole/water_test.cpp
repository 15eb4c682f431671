// SPDX-License-Identifier: MIT
// Water is where it is declared, exactly, and nowhere else.
#include <doctest/doctest.h>

#include <cstdlib>

#include "encoder/fit/simplify.hpp"
#include "encoder/pack/surface.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/voids.hpp"
#include "tests/support/packs.hpp"

namespace microtin::tests {
namespace {

// Hills around a bay, an island, and beaches just above and below its level of 5.
Raster coast() {
  Raster raster = rough_raster(61, 53, [](int x, int y) {
    const bool on_island = std::abs(x - 43) < 3 && std::abs(y - 10) < 2;
    return x > 30 && y < 25 && !on_island;
  });
  for (int64_t& height : raster.heights) {
    if (height > 0 && height < 10) height = 4 + height % 3;
  }
  flood_voids(raster, {5, 0}, nullptr);
  return raster;
}

struct Seen {
  uint64_t water = 0, water_moved = 0, land_at_level = 0;
};

// What a surface does at posts with the level's height, and at others.
class Looking {
 public:
  explicit Looking(int64_t level) : level_(level) {}

  PostVisitor visitor() {
    return [this](int64_t, int64_t, int64_t z, double above) {
      seen.water += z == level_;
      seen.water_moved += z == level_ && above != 0;
      seen.land_at_level +=
          z != level_ && static_cast<double>(z) + above == static_cast<double>(level_);
    };
  }

  Seen seen;

 private:
  int64_t level_;
};

Seen look(const microtin_mesh* mesh, const Raster& raster, int64_t level) {
  Looking looking(level);
  verify(mesh, raster, std::nullopt, looking.visitor());
  return looking.seen;
}

Seen look(const PackFile& pack, const Raster& raster, int64_t level) {
  Looking looking(level);
  verify(pack, RasterInMemory(raster), std::nullopt, {}, looking.visitor());
  return looking.seen;
}

template <class Surface>
void check_water(const Surface& surface, const Raster& raster) {
  const Seen seen = look(surface, raster, 5);
  CHECK(seen.water > 700);
  CHECK(seen.water_moved == 0);
  CHECK(seen.land_at_level == 0);
  const Verification found = verify(surface, raster, Decimal{7, 0});
  CHECK(found.within_bound);
  CHECK(found.uncovered == 0);
}

LatticeOptions options_of(std::optional<Decimal> z_step, bool never_below) {
  return {std::nullopt, z_step, Decimal{7, 0}, never_below, Decimal{5, 0}};
}

}  // namespace

TEST_CASE("water: with a bound the surface is at the level at its posts, at no others") {
  const Raster raster = coast();
  for (const bool never_below : {false, true}) {
    for (const auto z_step : {std::optional<Decimal>(), std::optional<Decimal>(Decimal{1, 0})}) {
      CAPTURE(never_below);
      SimplifyOptions options;
      options.bounded = true;
      const Approximation found = approximate(raster, options_of(z_step, never_below), options);
      Metadata metadata;
      metadata.placement = found.laid.placement;
      const DecodedTerrain decoded(encode(found.tin, metadata));
      CHECK(microtin_mesh_vertex_count(decoded.mesh()) < 61 * 53 / 2);
      check_water(decoded.mesh(), raster);
    }
  }
}

TEST_CASE("water: the same in packs, across their borders") {
  const Raster raster = coast();
  PackOptions options = pack_options(7, 200);
  options.lattice.water_level = Decimal{5, 0};
  const PackFile pack(write_pack(encode_pack(raster, options)));
  CHECK(pack.entries().size() > 1);
  check_water(pack, raster);
}

TEST_CASE("water: without it, the bound lets the same posts move") {
  const Raster raster = coast();
  PackOptions options = pack_options(7, 200);
  const PackFile pack(write_pack(encode_pack(raster, options)));
  const Seen seen = look(pack, raster, 5);
  CHECK(seen.water_moved > 0);
}

}  // namespace microtin::tests
