// SPDX-License-Identifier: MIT
// Margins: what a stream states, and the heights between which its source lies.
#include <doctest/doctest.h>

#include "microtin/compact.h"
#include "tests/support/device.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/reference_heights.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

Bytes with_margins(const Bytes& stream, uint32_t below, uint32_t above) {
  Header header = read_header(stream);
  header.contract.below = below;
  header.contract.above = above;
  Bytes changed = write_header(header.contract, header.metadata);
  changed.insert(changed.end(), stream.begin() + header.info.header_bytes, stream.end());
  return changed;
}

// Heights up to the ends of their range.
Tin steep_tin(Random& random) {
  Tin tin = rolling_tin(200, random.below(1000));
  for (Vertex& v : tin.vertices) v.z = static_cast<int16_t>(random.below(65536) - 32768);
  return tin;
}

// Nothing is lost by rounding, and at most a 128th of a step is given away.
bool holds(const microtin_safe_heights& heights, int32_t height, uint32_t below, uint32_t above) {
  const int64_t low = int64_t{height} - int64_t{above} * 4096,
                high = int64_t{height} + int64_t{below} * 4096;
  const int64_t lowest = int64_t{heights.lowest} * 256, highest = int64_t{heights.highest} * 256;
  return lowest < low && lowest >= low - 512 && highest > high && highest <= high + 512;
}

struct CompactOf {
  explicit CompactOf(const Device& device)
      : space(MICROTIN_COMPACT_BYTES(device.vertices())),
        scratch(MICROTIN_COMPACTOR_BYTES(device.vertices())) {
    microtin_compactor* compactor = nullptr;
    REQUIRE(microtin_compactor_init(space.begin(), space.size(), device.mesh, scratch.begin(),
                                    scratch.size(), &compactor) == MICROTIN_STATUS_OK);
    REQUIRE(microtin_compactor_run(compactor, &compact, 0) == MICROTIN_STATUS_OK);
  }
  Workspace space, scratch;
  microtin_compact* compact = nullptr;
};

}  // namespace

TEST_CASE("margins: the source lies within the safe heights of meshes and compact terrains") {
  Random random(61);
  for (const uint32_t below : {0u, 1u, 77u, kMarginMost}) {
    for (const uint32_t above : {0u, 5u, kMarginMost}) {
      const Tin tin = steep_tin(random);
      const Bytes stream = with_margins(encode(tin, Metadata()), below, above);
      const Device device(300);
      REQUIRE(device.decode(stream) == MICROTIN_STATUS_OK);
      Device other(300);
      REQUIRE(other.decode(stream) == MICROTIN_STATUS_OK);
      const CompactOf ring(other);
      uint32_t margin[2] = {}, of_ring[2] = {};
      microtin_mesh_margins(device.mesh, margin, margin + 1);
      microtin_compact_margins(ring.compact, of_ring, of_ring + 1);
      CHECK(margin[0] == below);
      CHECK(margin[1] == above);
      CHECK(of_ring[0] == below);
      CHECK(of_ring[1] == above);
      uint32_t hint = 0, ring_hint = 0;
      for (const Vertex& v : tin.vertices) {
        const int32_t x = v.x * 256 + static_cast<int32_t>(random.below(3)) - 1,
                      y = v.y * 256 + static_cast<int32_t>(random.below(3)) - 1;
        int32_t height = 0;
        microtin_safe_heights heights{}, heights_of_ring{};
        const microtin_query_result found =
            microtin_mesh_height_at(device.mesh, x, y, &hint, &height, 0, 0);
        CHECK(microtin_mesh_safe_heights_at(device.mesh, x, y, &hint, &heights, 0, 0) == found);
        CHECK(microtin_compact_safe_heights_at(ring.compact, x, y, &ring_hint, &heights_of_ring,
                                               0) == found);
        if (found != MICROTIN_QUERY_OK) continue;
        CHECK(holds(heights, height, below, above));
        CHECK(heights.lowest == heights_of_ring.lowest);
        CHECK(heights.highest == heights_of_ring.highest);
      }
    }
  }
}

TEST_CASE("margins: a height is safe only if the whole stream states both") {
  const Tin tin = rolling_tin(600, 62);
  const Bytes plain = encode(tin, Metadata());
  const uint32_t unknown = kNotStated;
  for (const Bytes& stream :
       {plain, with_margins(plain, unknown, 3), with_margins(plain, 3, unknown)}) {
    const Device device(600);
    REQUIRE(device.decode(stream) == MICROTIN_STATUS_OK);
    uint32_t hint = 0;
    microtin_safe_heights heights{7, 7};
    const int32_t x = tin.vertices[5].x * 256, y = tin.vertices[5].y * 256;
    CHECK(microtin_mesh_safe_heights_at(device.mesh, x, y, &hint, &heights, 0, 0) ==
          MICROTIN_QUERY_NO_MARGIN);
    CHECK(heights.lowest == 7);
    CHECK(heights.highest == 7);
  }
  // The margins are those of the surface with all its vertices.
  const Device device(600);
  microtin_decoder_stop_after_phase(device.decoder, 1);
  while (device.feed_all(with_margins(plain, 3, 3)) == MICROTIN_STATUS_NEED_INPUT) continue;
  uint32_t below = 0, above = 0;
  microtin_mesh_margins(device.mesh, &below, &above);
  CHECK(below == MICROTIN_MARGIN_NOT_STATED);
  CHECK(above == MICROTIN_MARGIN_NOT_STATED);
}

TEST_CASE("margins: a pack's heights are safe by the margins of their tile") {
  Random random(63);
  const TileGrid grid{60, 30, 30, 30};
  std::vector<ForgedTile> tiles;
  for (const uint32_t below : {4u, 900u}) {
    ForgedTile tile = forged_tile(random_vertices(random, 30, 30, true));
    tile.stream = with_margins(tile.stream, below, 2);
    tiles.push_back(tile);
  }
  Card card{forged_pack(grid, tiles)};
  const MeshSlots meshes(2, 500);
  const CompactSlots rings(2, 500);
  const microtin_segment all = {256, 256, 59 * 256, 29 * 256};
  for (const PackDevice* device :
       {static_cast<const PackDevice*>(&meshes), static_cast<const PackDevice*>(&rings)}) {
    REQUIRE(device->load(card, all) == MICROTIN_STATUS_OK);
    for (const int32_t x : {700, 7000, 9000, 15000}) {
      int32_t height = 0;
      uint32_t hint = 0;
      microtin_safe_heights heights{};
      REQUIRE(device->height_at(x, 4000, height) == MICROTIN_QUERY_OK);
      const microtin_query_result found =
          device == &meshes
              ? microtin_pack_safe_heights_at(device->pack, x, 4000, &hint, &heights)
              : microtin_compact_pack_safe_heights_at(device->pack, x, 4000, &hint, &heights);
      CHECK(found == MICROTIN_QUERY_OK);
      CHECK(holds(heights, height, x < 30 * 256 ? 4 : 900, 2));
    }
  }
}

}  // namespace microtin::tests
