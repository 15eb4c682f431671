// SPDX-License-Identifier: MIT
// Walks along segments on small terrains, degenerate and full of voids, and on packs of them: what
// each form returns is what exact arithmetic on all triangles says, and all forms return the same.
// The fuzzer chooses each vertex, void and path.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <vector>

#include "fuzz/support/pack_slots.hpp"
#include "fuzz/support/segment_checks.hpp"
#include "microtin/microtin.hpp"
#include "tests/support/forged_tiles.hpp"

namespace {

using namespace microtin;
using namespace microtin::tests;

constexpr uint32_t kCapacity = 64;  // with less, a terrain may not fit in place
constexpr size_t kMostVertices = 14;

// Tiles of the same few places, whose distance is that of `scale` lattice steps.
struct Layout {
  uint32_t columns, rows, width, height, scale;

  TileGrid grid() const {
    return {columns * width * scale, rows * height * scale, static_cast<uint16_t>(width * scale),
            static_cast<uint16_t>(height * scale)};
  }
};

Layout layout_from(FuzzedDataProvider& data) {
  constexpr uint32_t kScales[] = {1, 2, 3, 997, 8191};
  const uint8_t shape = data.ConsumeIntegral<uint8_t>();
  return {1u + shape % 2, 1u + shape / 2 % 2, data.ConsumeIntegralInRange<uint32_t>(1, 7),
          data.ConsumeIntegralInRange<uint32_t>(1, 7), kScales[data.ConsumeIntegralInRange(0, 4)]};
}

int16_t height_from(FuzzedDataProvider& data) {
  const int8_t z = data.ConsumeIntegral<int8_t>();
  return static_cast<int16_t>(z % 4 != 0 ? z / 4 : z == 124 ? 32767 : z * 256);
}

// A lattice of `width` by `height` places: corners at times, and some of the others.
Tin tin_from(FuzzedDataProvider& data, const Layout& layout) {
  Tin tin;
  const auto add = [&](uint32_t x, uint32_t y) {
    const Vertex v = {static_cast<uint16_t>(x * layout.scale),
                      static_cast<uint16_t>(y * layout.scale), height_from(data)};
    const bool is_there =
        std::any_of(tin.vertices.begin(), tin.vertices.end(),
                    [&](const Vertex& other) { return other.x == v.x && other.y == v.y; });
    if (!is_there) tin.vertices.push_back(v);
  };
  const uint32_t kind = data.ConsumeIntegral<uint8_t>();
  for (uint32_t corner = 0; corner < 4; ++corner) {
    if ((kind >> corner & 1u) == 0) continue;
    add((corner & 1u) * layout.width, (corner >> 1) * layout.height);
  }
  for (size_t i = data.ConsumeIntegralInRange<size_t>(0, kMostVertices - 4); i > 0; --i) {
    const uint32_t place = data.ConsumeIntegral<uint8_t>();
    add(place % (layout.width + 1), place / 16 % (layout.height + 1));
  }
  return tin;
}

// A tile; without a triangle it has no terrain.
ForgedTile tile_from(FuzzedDataProvider& data, const Layout& layout) {
  Tin tin = tin_from(data, layout);
  if (!has_triangle(tin)) return {};
  uint32_t voids = data.ConsumeIntegral<uint8_t>();
  if (voids % 2 != 0) {
    voids |= data.ConsumeIntegral<uint32_t>() << 8;
    tin = with_voids_where(std::move(tin), [&] {
      voids = voids >> 1 | voids << 31;
      return (voids & 1u) != 0;
    });
  }
  return {encode(tin, Metadata(), {16, Coding::kQuick}),
          static_cast<uint32_t>(tin.vertices.size())};
}

// A place of the lattice, between two of them, or anywhere.
int64_t coordinate(FuzzedDataProvider& data, uint32_t places, uint32_t scale) {
  const uint8_t kind = data.ConsumeIntegral<uint8_t>();
  const int64_t most = int64_t{places} * scale * 256, unit = int64_t{scale} * 256;
  if (kind < 160) return kind % (places + 1) * unit;
  if (kind < 224) return kind % (2 * places + 1) * unit / 2;
  return data.ConsumeIntegralInRange<int64_t>(0, most);
}

microtin_path path_from(FuzzedDataProvider& data, const Layout& layout) {
  const uint32_t columns = layout.columns * layout.width, rows = layout.rows * layout.height;
  const auto height = [&] {
    const int32_t z = height_from(data);
    return z * 256 + (z % 2 == 0 ? 0 : data.ConsumeIntegralInRange<int32_t>(-300, 300));
  };
  microtin_path path;
  path.segment.x = coordinate(data, columns, layout.scale);
  path.segment.y = coordinate(data, rows, layout.scale);
  const uint8_t kind = data.ConsumeIntegral<uint8_t>();
  path.segment.x_end = kind % 4 == 1 ? path.segment.x : coordinate(data, columns, layout.scale);
  path.segment.y_end = kind % 4 == 2 ? path.segment.y : coordinate(data, rows, layout.scale);
  path.z = height();
  path.z_end = kind % 8 < 4 ? path.z : height();
  path.clearance = kind % 16 < 8 ? 0 : height();
  return path;
}

// A terrain as a mesh, and as a compact terrain.
struct Forms {
  Terrain<kCapacity> mesh, made;
  CompactTerrain<kCapacity> compact;

  explicit Forms(const std::vector<uint8_t>& stream) {
    Decoder<kCapacity> decoder(mesh);
    size_t used = 0;
    EXPECT(decoder.feed(stream.data(), stream.size(), &used) == MICROTIN_STATUS_OK);
    decoder.begin(made);
    EXPECT(decoder.feed(stream.data(), stream.size(), &used) == MICROTIN_STATUS_OK);
    EXPECT(compact.make(made, decoder) == MICROTIN_STATUS_OK);
  }
};

int32_t read_pack(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
  const auto& bytes = *static_cast<const std::vector<uint8_t>*>(context);
  if (offset >= bytes.size()) return 0;
  const size_t taken = std::min(size, bytes.size() - static_cast<size_t>(offset));
  std::memcpy(buffer, bytes.data() + offset, taken);
  return static_cast<int32_t>(taken);
}

// A pack with all of its tiles loaded: four at most, which meet in a corner of each.
struct LoadedPack {
  PackSlots slots;

  LoadedPack(std::vector<uint8_t>& bytes, const Layout& layout, uint32_t tile_bytes)
      : slots(4, kCapacity, tile_bytes) {
    const TileGrid grid = layout.grid();
    const int64_t x = int64_t{grid.width} * 256, y = int64_t{grid.height} * 256;
    EXPECT(slots.load_with({x, y, x, y}, read_pack, &bytes, 0) == MICROTIN_STATUS_OK);
  }
};

bool is_too_long(const microtin_segment& c) {
  constexpr int64_t kLongest = 1 << 24;
  return std::max(std::abs(c.x_end - c.x), std::abs(c.y_end - c.y)) >= kLongest;
}

// Outside a tile's hull a pack has a void.
uint32_t in_pack(uint32_t result) {
  return result == MICROTIN_QUERY_OUTSIDE ? uint32_t{MICROTIN_QUERY_VOID} : result;
}

Walked in_pack(Walked walked) {
  walked.extremes.answer = static_cast<microtin_query_result>(in_pack(walked.extremes.answer));
  walked.result = static_cast<microtin_query_result>(in_pack(walked.result));
  for (microtin_crossing& place : walked.profile) {
    place.result = in_pack(place.result);
    place.before = in_pack(place.before);
  }
  return walked;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  FuzzedDataProvider data(bytes, size);
  const Layout layout = layout_from(data);
  std::vector<ForgedTile> tiles;
  for (uint32_t i = 0; i < layout.columns * layout.rows; ++i) {
    tiles.push_back(tile_from(data, layout));
  }
  std::vector<uint8_t> pack = forged_pack(layout.grid(), tiles);
  const LoadedPack meshes(pack, layout, 0),
      compact(pack, layout, MICROTIN_COMPACT_BYTES(kCapacity));
  reference::Surface surface;
  std::optional<Forms> forms;
  for (uint32_t i = 0; i < tiles.size(); ++i) {
    if (tiles[i].stream.empty()) continue;
    forms.emplace(tiles[i].stream);
    const TileBox box = tile_box(layout.grid(), i);
    surface.add(forms->mesh.mesh(), box.x, box.y);
  }
  for (uint32_t i = 1 + data.ConsumeIntegralInRange<uint32_t>(0, 7); i > 0; --i) {
    const microtin_path path = path_from(data, layout);
    const Walked in_tiles = walk(&meshes.slots, path, 0);
    EXPECT(walk(&compact.slots, path, 0) == in_tiles);
    if (is_too_long(path.segment)) {
      EXPECT(in_tiles.result == MICROTIN_QUERY_OUTSIDE && in_tiles.profile.empty());
      continue;
    }
    check_walk_of_tiles(surface, path, in_tiles);
    if (tiles.size() != 1 || !forms) continue;
    const Walked walked = walk(forms->mesh.mesh(), path, 0);
    check_walk(surface, path, walked);
    const uint32_t limit = data.ConsumeIntegralInRange<uint32_t>(1, 5);
    EXPECT(walk(forms->mesh.mesh(), path, limit) == walked);
    EXPECT(walk(forms->compact.compact(), path, 0) == walked);
    EXPECT(walk(forms->compact.compact(), path, limit) == walked);
    if (!is_place(path.segment)) EXPECT(in_pack(walked) == in_tiles);
  }
  return 0;
}
