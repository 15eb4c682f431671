// SPDX-License-Identifier: MIT
// Packs that are complete and wait to be written: encoded, updated, cut or merged.
#ifndef MICROTIN_ENCODER_PRODUCT_MADE_PACK_HPP
#define MICROTIN_ENCODER_PRODUCT_MADE_PACK_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "encoder/base/work.hpp"
#include "encoder/export/grid.hpp"
#include "encoder/files/output.hpp"
#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/product/encode_pack.hpp"
#include "encoder/product/options.hpp"
#include "encoder/terrain/raster_reader.hpp"
#include "encoder/terrain/raster_scan.hpp"

namespace microtin::product {

// A terrain as packs are made of it: a raster that is read in pieces, or points.
using PackSource = std::variant<const RasterReader*, const PointCloud*>;

// The source must outlive the result.
PackSource pack_source_of(const OpenSource& source);

// The raster of a source. Throws Error if it is points, which have no shards.
const RasterReader& raster_with_shards(const PackSource& source);

// What a source holds, and what may be wrong with it: warnings, or empty texts.
struct SourceFacts {
  std::optional<RasterScan> scanned;  // of a raster
  std::string fill, grid;
};

// Reads a raster once.
SourceFacts facts_of(const PackSource& source);

// The streams of a pack of a raster wait in a file next to the output.
class MadePack {
 public:
  explicit MadePack(EncodedPoints points);
  MadePack(const PackContent& content, std::unique_ptr<StreamSpool> streams);

  const PackReport& report() const { return report_; }

  // Nothing for a pack of a raster.
  const std::optional<EncodedPoints>& points() const { return points_; }

  void write(OutputFile& out);

 private:
  PackReport report_;
  std::optional<EncodedPoints> points_;
  std::vector<uint8_t> head_;
  std::unique_ptr<StreamSpool> streams_;
};

// `output` is the path of the pack to be written. Each function throws Error as the one that it
// calls: encode_pack, update_pack, cut_pack, join_packs or merge_shards.
MadePack made_pack(const PackSource& source, const EncodeOptions& options,
                   const std::string& output, const Progress& progress);

struct UpdatedTiles {
  MadePack pack;
  uint32_t kept, tiles;
};

UpdatedTiles updated_pack(const std::string& old, const RasterReader& raster,
                          const EncodeOptions& options, std::optional<BoundScope> bound_at,
                          const std::string& output, const Progress& progress);

MadePack part_of_pack(const std::string& pack, const Extent& extent, const std::string& output);

// Joins shards, or packs, by what the first file is.
MadePack merged_pack(const std::vector<std::string>& parts, const std::string& output);

// The tiles of a pack that have a place in the extent, as a pack of their own; where tiles have an
// odd width or height, one more column or row in the west or south may be needed. Streams stay as
// they are; errors are those that the whole pack states. Decodes each tile. Throws Error naming the
// pack, also if it has no tile there.
PackContent cut_pack(const std::string& path, const Extent& extent, StreamSpool& streams);

// Packs that were cut from one, or from packs of one plan, as one pack. Tiles in several of them
// must be the same; tiles in none have no terrain. Throws Error naming the pack that does not go
// with the first, also if borders differ.
PackContent join_packs(const std::vector<std::string>& paths, StreamSpool& streams);

// A pack that is brought up to date with a terrain that changed.
struct UpdatedPack {
  PackContent content;
  uint32_t kept;  // tiles of which the bytes are the old ones
};

// The max_error for which the map of a pack's bounds holds as it is; nothing if its posts have no
// bounds of their own. Throws Error naming the pack.
std::optional<Decimal> max_error_of_map(const std::string& pack);

// Keeps the tiles that do for the changed raster all that the old pack states, and encodes the
// others by the bound, side, water level, lattice and coding of the old pack. Borders between new
// tiles and kept ones stay. Reads the raster twice.
//
// `bound_at`: whether the bound is kept between posts, too. If it is nothing, it is kept there if
// the old pack shows that it is: over obstacles, and if its margins are within the bound.
//
// The options set the notes, the search and `tile_vertices` alone. A new tile has at most
// `tile_vertices` vertices. If that is 0, a new tile has no more vertices, and no more bytes in
// compact form, than the old pack states for any tile: devices that hold the old tiles hold it.
//
// Throws Error naming the old pack if its header is wrong, if its index is cut off, or if its tiles
// are not a raster's. Throws Error if the raster has other posts, units or systems, if its heights
// are beyond the lattice, if a new tile is too large, or if an option is for streams.
UpdatedPack update_pack(const std::string& old, const RasterReader& raster,
                        const EncodeOptions& options, std::optional<BoundScope> bound_at,
                        StreamSpool& streams, const Progress& progress);

}  // namespace microtin::product

#endif
