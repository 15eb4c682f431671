// SPDX-License-Identifier: MIT
// Looks for damage in a file, and for differences between two packs.

#include "encoder/base/error.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/files/input.hpp"
#include "encoder/product/document.hpp"
#include "encoder/product/phases.hpp"

namespace microtin::product {
namespace {

bool have_same_tiles(const PackFile& a, const PackFile& b) {
  const TileGrid &g = a.grid(), &h = b.grid();
  const Placement &p = a.metadata().placement, &q = b.metadata().placement;
  return g.x_max == h.x_max && g.y_max == h.y_max && g.width == h.width && g.height == h.height &&
         is_same(p.x, q.x) && is_same(p.y, q.y) && is_same(p.z, q.z);
}

}  // namespace

Checked check_file(const std::string& path) {
  if (is_regular_file(path) && is_pack(*open_file(path))) {
    const OpenPack pack = open_pack(path);
    Checked found{pack.file.tiles(), pack.file.faults()};
    if (found.faults.empty()) with_file_context(path, [&] { pack.file.expect_sums(); });
    return found;
  }
  const DecodedStream stream = read_stream(path);
  with_file_context(path, [&] { expect_as_stated(stream.bytes, stream.terrain.mesh()); });
  return {};
}

Difference compare_packs(const std::string& first, const std::string& second) {
  const OpenPack a = open_pack(first), b = open_pack(second);
  if (!have_same_tiles(a.file, b.file)) {
    throw Error(first + ", " + second +
                ": have other tiles or another lattice; compare packs of one plan");
  }
  const auto stream_in = [](const std::string& path, const OpenPack& pack, uint32_t tile) {
    return with_file_context(path, [&] { return pack.file.stream(tile); });
  };
  Difference found;
  found.tiles = a.file.tiles();
  found.is_header_same = a.header == b.header;
  for (uint32_t tile = 0; tile < found.tiles; ++tile) {
    if (stream_in(first, a, tile) != stream_in(second, b, tile)) found.differ.push_back(tile);
  }
  return found;
}

}  // namespace microtin::product
