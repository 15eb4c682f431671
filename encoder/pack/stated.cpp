// SPDX-License-Identifier: MIT
// Compares all tiles of a pack with what its header and its index state.
#include <algorithm>
#include <cstddef>
#include <mutex>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/base/work.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/terrain/exact_query.hpp"

namespace microtin::pack {
namespace {

// The numbers of a few tiles, and how many there are.
std::string list_of(const std::vector<uint32_t>& tiles) {
  constexpr std::size_t kMost = 5;
  std::string text = tiles.size() == 1 ? "tile " : std::to_string(tiles.size()) + " tiles (";
  for (std::size_t i = 0; i < std::min(tiles.size(), kMost); ++i) {
    text += (i == 0 ? "" : ", ") + std::to_string(tiles[i]);
  }
  return text + (tiles.size() == 1 ? "" : tiles.size() > kMost ? ", ...)" : ")");
}

// Throws Error naming the unsupported tiles apart from the others that are bad.
void expect_none(const std::vector<TileFault>& faults) {
  std::vector<uint32_t> unsupported, bad;
  std::string first;
  for (const TileFault& fault : faults) {
    (fault.is_unsupported ? unsupported : bad).push_back(fault.tile);
    if (!fault.is_unsupported && first.empty()) first = fault.text;
  }
  std::string text;
  if (!unsupported.empty()) {
    text = "unsupported: " + list_of(unsupported) + ": " +
           describe(MICROTIN_STATUS_UNSUPPORTED_VERSION);
  }
  if (!bad.empty()) text += (text.empty() ? "" : "; ") + ("bad: " + list_of(bad)) + ": " + first;
  if (!text.empty()) throw Error(text);
}

std::string range(int64_t lowest, int64_t highest) {
  return std::to_string(lowest) + " .. " + std::to_string(highest);
}

void expect_within(int16_t lowest, int16_t highest, int16_t least, int16_t most,
                   const std::string& whose) {
  if (lowest >= least && highest <= most) return;
  throw Error("has heights " + range(lowest, highest) + " in z steps, beyond " + whose + " " +
              range(least, most));
}

// A margin that is not stated is above all others.
void expect_margin(uint32_t of_tile, uint32_t of_pack, const std::string& name) {
  if (of_pack == kNotStated || of_tile <= of_pack) return;
  throw Error("does not keep the header's margin " + name + " the source");
}

}  // namespace

bool PackFile::is_unsupported(uint32_t number) const {
  try {
    return start_of(number, stream(number)) == MICROTIN_STATUS_UNSUPPORTED_VERSION;
  } catch (const Error&) {
    return false;
  }
}

void PackFile::expect_bounds(uint32_t number, DecodedTerrain& tile) const {
  const microtin_mesh* const mesh = tile.mesh();
  int16_t lowest = INT16_MAX, highest = INT16_MIN;
  for (uint32_t v = 0; v < microtin_mesh_vertex_count(mesh); ++v) {
    const int16_t z = vertex_of(mesh, v).z;
    lowest = std::min(lowest, z);
    highest = std::max(highest, z);
  }
  const IndexEntry stated = entry_of(number);
  expect_within(lowest, highest, stated.lowest, stated.highest, "those of its entry,");
  expect_within(lowest, highest, header_.lowest, header_.highest, "those of the header,");
  uint32_t below = 0, above = 0;
  microtin_mesh_margins(mesh, &below, &above);
  expect_margin(below, header_.below, "below");
  expect_margin(above, header_.above, "above");
  if (header_.compact_bytes == 0) return;
  const uint64_t bytes = bytes_of(measured_form(tile.mesh()), index_bits(header_.most_vertices));
  if (bytes <= header_.compact_bytes) return;
  throw Error("takes " + std::to_string(bytes) +
              " bytes in compact form; the header says that a tile takes at most " +
              std::to_string(header_.compact_bytes));
}

std::vector<TileFault> PackFile::faults() const {
  std::vector<TileFault> found;
  std::mutex locked;
  for_each_parallel(tiles(), [&](std::size_t i) {
    const auto number = static_cast<uint32_t>(i);
    try {
      std::optional<DecodedTerrain> decoded = tile(number);
      if (!decoded) return;
      with_file_context("tile " + std::to_string(number), [&] { expect_bounds(number, *decoded); });
    } catch (const Error& error) {
      const TileFault fault = {number, is_unsupported(number), error.text()};
      const std::lock_guard<std::mutex> lock(locked);
      found.push_back(fault);
    }
  });
  std::sort(found.begin(), found.end(),
            [](const TileFault& a, const TileFault& b) { return a.tile < b.tile; });
  return found;
}

void PackFile::expect_as_stated() const {
  expect_none(faults());
  expect_sums();
}

void PackFile::expect_sums() const {
  if (!metadata_.sums) return;
  const uint64_t vertices = counted_vertices();
  uint64_t with_terrain = 0;
  for (uint32_t number = 0; number < tiles(); ++number) {
    if (entry_of(number).size != 0) ++with_terrain;
  }
  const auto expect = [](uint64_t stated, uint64_t found, const std::string& of_what) {
    if (stated == found) return;
    throw Error("the header states " + std::to_string(stated) + ' ' + of_what + "; there are " +
                std::to_string(found));
  };
  expect(metadata_.sums->vertices, vertices, "vertices in all tiles");
  expect(metadata_.sums->tiles, with_terrain, "tiles with terrain");
}

}  // namespace microtin::pack
