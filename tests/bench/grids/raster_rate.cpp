// SPDX-License-Identifier: MIT
#include "tests/bench/grids/raster_rate.hpp"

#include <algorithm>
#include <cstdlib>

#include "encoder/base/error.hpp"
#include "encoder/stream/encode.hpp"
#include "tests/bench/grids/grid.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/table.hpp"

namespace microtin::bench {
namespace {

// What a terrain takes with LERC at a largest error in the raster's units; 0 if LERC is not there.
size_t lerc_bytes([[maybe_unused]] const Raster& raster, [[maybe_unused]] double bound) {
#ifdef MICROTIN_BENCH_LERC
  ShortRaster source{raster.width, raster.height, {}, {}};
  for (const int64_t z : raster.heights) {
    source.heights.push_back(static_cast<int16_t>(z == kVoidHeight ? 0 : z));
    source.valid.push_back(z == kVoidHeight ? 0 : 1);
  }
  const Bytes bytes = encode_with_lerc(source, bound);
  const ShortRaster decoded = decode_with_lerc(bytes, raster.width, raster.height);
  for (size_t i = 0; i < source.heights.size(); ++i) {
    if (source.valid[i] != decoded.valid[i] ||
        (source.valid[i] != 0 && std::abs(source.heights[i] - decoded.heights[i]) > bound)) {
      throw Error("LERC does not keep its bound");
    }
  }
  return bytes.size();
#else
  return 0;
#endif
}

void print_bound(const Terrain& terrain, int times) {
  LatticeOptions options = terrain.options;
  for (std::optional<Decimal>* metres : {&options.max_error, &options.z_step}) {
    *metres = make_decimal(Wide{(*metres)->mantissa} * times, (*metres)->decimals);
  }
  const Model model = simplified(terrain.raster, options);
  const size_t ours = encode(model.tin, model.metadata).size();
  const size_t posts = terrain.raster.heights.size();
  const double bound = std::stod(to_string(*options.max_error));
  const size_t lerc = lerc_bytes(terrain.raster, bound / terrain.z_metres);
  print_row({terrain.name, to_string(*options.max_error), number(posts), number(2 * posts),
             lerc == 0 ? "-" : number(lerc), number(model.tin.vertices.size()), number(ours),
             lerc == 0 ? "-" : number(static_cast<double>(ours) / static_cast<double>(lerc), 3)});
}

}  // namespace

void print_raster_rate() {
  const std::vector<Terrain> all = terrains();
  print_head("Rasters at equal largest error: a grid delivers posts, microtin a mesh",
             {"terrain", "largest error, m", "posts", "int16 grid (exact), bytes", "LERC, bytes",
              "vertices", "microtin, bytes", "microtin / LERC"});
  for (const Terrain& terrain : all) {
    for (const int times : {1, 3}) print_bound(terrain, times);
  }
}

}  // namespace microtin::bench
