// SPDX-License-Identifier: MIT
// Encodes the changed tiles of a pack again, with the options that the pack states.
#include <algorithm>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/pack/kept_tiles.hpp"
#include "encoder/pack/surface.hpp"
#include "encoder/product/document.hpp"
#include "encoder/product/made_pack.hpp"
#include "encoder/stream/header.hpp"
#include "encoder/terrain/raster_scan.hpp"
#include "encoder/verify/everywhere.hpp"

namespace microtin::product {
namespace {

// Parts of the time, estimated: reading the raster, and comparing all tiles.
constexpr double kScanned = 0.05, kCompared = 0.3;

PackFile open_pack_of_raster(const std::string& path) {
  PackFile pack = open_pack(path).file;
  if (!pack.metadata().grid || !pack.metadata().accuracy) {
    throw Error(path + ": is not a pack that microtin made of a raster; encode the terrain again");
  }
  return pack;
}

// The terrain must have bounds from a map exactly if the pack has, and at the same scale.
void expect_same_map(const Metadata& old, const Raster& frame) {
  if (frame.bounds.unscaled.has_value() == old.bounds.has_value()) return;
  throw Error(old.bounds
                  ? "the pack has bounds of an error map; name it with " + parameter("error_map")
                  : "the pack has one bound for all posts; leave out " + parameter("error_map") +
                        ", or encode the terrain again");
}

// Whether the bound holds between posts, too, as far as a pack shows: over obstacles it does, and
// where no margin is larger.
bool is_kept_everywhere(const PackFile& pack) {
  const Metadata& stated = pack.metadata();
  if (stated.bounds) return stated.surface == SurfaceKind::kObstacles;
  const Margins margins{pack.header().below, pack.header().above};
  const std::optional<Distances> everywhere = stated_everywhere(margins, stated.placement.z);
  const std::optional<Decimal>& bound = stated.accuracy->bound;
  return everywhere && bound && everywhere->below <= *bound && everywhere->above <= *bound;
}

// What the pack states of its tiles. A pack that has breaklines was not made with a bound
// everywhere, and keeps one by chance alone.
LatticeOptions options_of(const PackFile& pack, std::optional<BoundScope> bound_at,
                          bool has_breaklines) {
  const Metadata& stated = pack.metadata();
  LatticeOptions options;
  options.max_error = stated.bounds ? stated.bounds->max_error : stated.accuracy->bound;
  options.never_below = stated.side == BoundSide::kNeverBelow;
  options.water_level = stated.water_level;
  if (bound_at) options.bound_at = *bound_at;
  if (!bound_at && !has_breaklines && is_kept_everywhere(pack)) {
    options.bound_at = BoundScope::kEverywhere;
  }
  return options;
}

// The coding of the first tile that can be read; of none the one that is requested.
Effort effort_of(const PackFile& pack, Effort effort) {
  for (uint32_t tile = 0; tile < pack.tiles(); ++tile) {
    try {
      const std::vector<uint8_t> stream = pack.stream(tile);
      if (stream.empty()) continue;  // without terrain
      effort.coding = static_cast<Coding>(read_header(stream).info.coding);
      break;
    } catch (const Error&) {  // it will be encoded again
    }
  }
  return effort;
}

PackOptions pack_options(const PackFile& old, const EncodeOptions& requested,
                         std::optional<BoundScope> bound_at) {
  refuse_options_of_streams(requested);
  EncodeOptions options = requested;
  options.lattice = options_of(old, bound_at, !requested.lattice.breaklines.empty());
  options.effort = effort_of(old, requested.effort);
  const uint32_t vertices =
      std::max(kFewestTileVertices,
               requested.tile_vertices != 0 ? requested.tile_vertices : old.header().most_vertices);
  return {options.lattice, simplify_options(options, 1, {}), vertices, old.grid().width, vertices};
}

// Throws Error if a device that holds the tiles of the old pack may not hold this one.
void expect_room(const PackFile& old, uint32_t number, const TileSummary& tile) {
  const PackHeader& header = old.header();
  if (header.compact_bytes == 0 || !tile.compact) return;
  const uint64_t bytes = bytes_of(*tile.compact, index_bits(header.most_vertices));
  if (bytes <= header.compact_bytes) return;
  throw Error("tile " + std::to_string(number) + " takes " + std::to_string(bytes) +
              " bytes in compact form, and the pack states at most " +
              std::to_string(header.compact_bytes) + "; allow more with " +
              parameter("tile_vertices") + ", or encode the terrain again");
}

Error too_large(const TileTooLarge& tile, const PackFile& old) {
  return Error("tile " + std::to_string(tile.tile) + " has " + std::to_string(tile.vertices) +
               " vertices, and the pack states at most " +
               std::to_string(old.header().most_vertices) + "; allow more with " +
               parameter("tile_vertices") + ", or encode the terrain again");
}

PackPlan plan_of(const PackFile& old, const RasterReader& raster, const PackOptions& options,
                 const RasterScan& scanned, const std::vector<RealLine>& breaklines) {
  const Lattice lattice = post_lattice_at(raster.frame(), scanned.heights,
                                          old.metadata().placement.z, first_fit(options.lattice));
  const auto lines = tiled_lines(breaklines, lattice.placement, raster.frame());
  return {{raster, lattice, options.lattice, old.grid(), nullptr, lines},
          options,
          old.grid().width,
          scanned.fingerprint,
          kCompared};
}

}  // namespace

std::optional<Decimal> max_error_of_map(const std::string& pack) {
  const std::optional<StatedBounds> bounds = open_pack(pack).file.metadata().bounds;
  return bounds ? std::optional(bounds->unscaled) : std::nullopt;
}

UpdatedPack update_pack(const std::string& old_path, const RasterReader& raster,
                        const EncodeOptions& options, std::optional<BoundScope> bound_at,
                        StreamSpool& streams, const Progress& progress) {
  const PackFile old = open_pack_of_raster(old_path);
  expect_posts_of(raster.frame(), old);
  expect_same_system(old.metadata(), completed(raster.frame().reference));
  expect_same_map(old.metadata(), raster.frame());
  expect_water_level(old_path, old.metadata().water_level, options.lattice.water_level);
  const PackOptions stated = pack_options(old, options, bound_at);
  LatticeOptions lines = stated.lattice;
  lines.breaklines = options.lattice.breaklines;
  expect_breaklines_possible(lines, raster.frame());
  const RasterScan scanned =
      scan(raster, stated.lattice.max_error, false, progress.part(0, kScanned));
  PackPlan plan = plan_of(old, raster, stated, scanned, lines.breaklines);
  const KeptTiles kept(old, plan.tiled, progress.part(kScanned, kCompared));
  plan.tiled.kept = &kept;
  plan.options.simplify.progress = progress;
  Metadata metadata = old.metadata();
  static_cast<SourceNotes&>(metadata) = preferred(raster.frame().reference.notes, metadata);
  UpdatedPack updated{{old.grid(), noted(std::move(metadata), options), {}}, kept.count()};
  try {
    encode_tiles(plan, all_tiles(old.grid()), [&](uint32_t number, EncodedTile&& tile) {
      if (options.tile_vertices == 0 && !kept.keeps(number)) expect_room(old, number, tile.summary);
      tile.summary.offset = streams.add(tile.stream);
      updated.content.tiles.push_back(tile.summary);
    });
  } catch (const TileTooLarge& tile) {
    throw too_large(tile, old);
  }
  return updated;
}

}  // namespace microtin::product
