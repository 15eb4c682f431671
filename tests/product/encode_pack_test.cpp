// SPDX-License-Identifier: MIT
// A pack whose tiles are planned again, since one was too large, is the one with tiles of that
// size.

#include <doctest/doctest.h>

#include <algorithm>

#include "encoder/product/made_pack.hpp"
#include "tests/support/files.hpp"
#include "tests/support/packs.hpp"
#include "tests/support/temporary_folder.hpp"

namespace microtin::tests {
namespace {

// Rough in the north alone: tiles of the south are encoded before one that is too large.
RasterInMemory raster_in_memory() {
  Raster raster = rough_raster(121, 113);
  std::fill_n(raster.heights.begin(), 121 * 20, 0);
  return RasterInMemory(raster);
}

// The bytes; the number of tiles' steps is given away.
std::vector<uint8_t> written(const product::EncodeOptions& options, uint32_t& steps) {
  const TemporaryFolder folder;
  const RasterInMemory raster = raster_in_memory();
  product::MadePack pack = product::made_pack(&raster, options, folder / "pack", {});
  OutputFile out(folder / "pack");
  pack.write(out);
  out.commit();
  const TileGrid grid = pack.report().grid;
  steps = std::max(grid.width, grid.height);
  std::vector<uint8_t> bytes = bytes_of_file(folder / "pack");
  const Verification found = verify(PackFile(bytes), raster, options.lattice.max_error);
  CHECK(found.within_bound);
  CHECK(found.uncovered == 0);
  return bytes;
}

}  // namespace

TEST_CASE("product: a pack that is planned again holds what its last plan does") {
  product::EncodeOptions options;
  options.lattice.max_error = Decimal{2, 0};
  options.tile_vertices = 47;  // planning counts the roughest tiles, which have fewer
  options.search = Search::kGreedy;
  const RasterInMemory raster = raster_in_memory();
  PackOptions first = pack_options(2, 47);
  first.simplify.search = Search::kGreedy;
  uint32_t steps = 0, same = 0;
  const std::vector<uint8_t> bytes = written(options, steps);
  CHECK(plan_pack(raster, first).tile_size > steps);  // else nothing is planned again
  options.tile_size = steps;
  CHECK((written(options, same) == bytes));
}

}  // namespace microtin::tests
