// SPDX-License-Identifier: MIT
// A terrain as a pack of tiles, each of which is known to keep what was requested.
#ifndef MICROTIN_ENCODER_PRODUCT_ENCODE_PACK_HPP
#define MICROTIN_ENCODER_PRODUCT_ENCODE_PACK_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/files/output.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/encode.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/product/options.hpp"
#include "encoder/terrain/raster_reader.hpp"

namespace microtin::product {

// What a pack holds, and what it keeps.
struct PackReport {
  TileGrid grid;
  Decimal z_step;
  uint64_t vertices = 0, bytes = 0;
  uint32_t most_vertices = 0;  // in a tile
  uint64_t compact_bytes = 0;  // of a tile, at most; 0: not stated
  uint32_t empty_tiles = 0;
  Verification measured;                // of all tiles
  std::optional<Decimal> bound;         // that all posts or points keep
  std::optional<StatedBounds> bounds;   // if they have bounds of their own
  std::optional<Distances> everywhere;  // of a raster, as the header states them
};

PackReport report_of(const PackContent& pack);

// The fewest vertices that a slot of a device has room for, and the memory in bytes that an adapter
// of decoder/adapters takes with kAdapterTiles such compact slots. The pack states compact_bytes.
uint32_t slot_capacity(const PackReport& pack);
uint64_t adapter_ram(const PackReport& pack);

// Chooses, encodes, decodes and compares tile by tile, as encode_stream does for all; the streams
// wait in the spool until the index is known. Throws Error if what is requested cannot be had.
PackContent encode_pack(const RasterReader& raster, const EncodeOptions& requested,
                        StreamSpool& streams, const Progress& progress);

// The result of encoding points as a pack.
struct EncodedPoints {
  std::vector<uint8_t> bytes;
  PackReport report;
  Decimal xy_step, xy_displacement;
  uint64_t points;  // compared: without those for which another stands
  uint64_t merged;
  std::optional<Verification> true_places;  // of points that the lattice moves
};

// Points that the lattice moves are fitted within less than the bound where they truly lie, if it
// is missed there. Throws Error also if that is not enough: without an --xy-step a pack moves none.
EncodedPoints encode_pack(const PointCloud& cloud, const EncodeOptions& requested);

// Writes a shard with some of the tiles that the pack of a raster has. Throws Error also if there
// is no first one.
struct ShardReport {
  TileRange tiles, all;
  uint64_t vertices;
};

ShardReport encode_shard(const RasterReader& raster, const EncodeOptions& requested,
                         TileRange tiles, OutputFile& out, const Progress& progress);

// How this many shards are to be encoded, so that together they are what a single run makes.
struct ShardPlan {
  uint32_t tile_size;
  Decimal z_step;
  TileRange tiles;
};

std::vector<ShardPlan> plan_shards(const RasterReader& raster, const EncodeOptions& options,
                                   uint32_t shards, const Progress& progress);

// As the option --shard has it.
std::string range_text(TileRange range);

}  // namespace microtin::product

#endif
