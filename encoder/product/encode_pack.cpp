// SPDX-License-Identifier: MIT
// Encodes packs: of rasters tile by tile, of points at once, and of rasters in shards.
#include "encoder/product/encode_pack.hpp"

#include <algorithm>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/error_context.hpp"
#include "encoder/pack/point_pack.hpp"
#include "encoder/pack/shard.hpp"
#include "encoder/pack/tile_plan.hpp"

namespace microtin::product {
namespace {

uint32_t tile_vertices(const EncodeOptions& options, bool is_narrow) {
  if (options.tile_vertices != 0) return options.tile_vertices;
  if (options.device_ram == 0) throw Error("a pack needs --tile-vertices or --device-ram");
  const uint32_t vertices = vertices_for_ram(options.device_ram, is_narrow);
  if (vertices < kFewestTileVertices) {
    throw Error("--device-ram " + std::to_string(options.device_ram) + " is too few for a pack");
  }
  return vertices;
}

PackOptions pack_options(const EncodeOptions& options, const Progress& progress) {
  if (options.max_vertices != 0 || options.max_bytes != 0) {
    throw Error("packs are made with --max-error or of all posts");
  }
  EncodeOptions tile = options;
  tile.device_ram = 0;  // it limits tiles, by their number of vertices
  return {options.lattice, simplify_options(tile, progress), tile_vertices(options, true),
          options.tile_steps, tile_vertices(options, false)};
}

PackOptions raster_options(const EncodeOptions& options, const Progress& progress) {
  if (options.lattice.xy_step) throw Error("packs keep the places of posts: no --xy-step");
  return pack_options(options, progress);
}

PackOptions point_options(const EncodeOptions& options) {
  if (options.tile_steps != 0) throw Error("--tile-steps is for rasters; these are points");
  return pack_options(options, {});
}

// Of heights: a decimal, as the lattice was chosen.
Decimal z_step(const PackContent& pack) {
  const Axis& z = pack.metadata.placement.z;
  int decimals = 0;
  while (decimals < kMaxDecimals &&
         power_of_ten(decimals) % static_cast<int64_t>(z.denominator) != 0) {
    ++decimals;
  }
  const Wide step = Wide{power_of_ten(decimals)} * static_cast<Wide>(z.numerator);
  return make_decimal(step / static_cast<Wide>(z.denominator), decimals);
}

// The last tile of a shard may lie beyond the last of all.
TileRange existing(TileRange range, const TileGrid& grid) {
  const TileRange all = all_tiles(grid);
  if (range.first > all.last) {
    throw Error("--tiles " + range_text(range) + ": the last tile is " + std::to_string(all.last));
  }
  return {range.first, std::min(range.last, all.last)};
}

}  // namespace

std::string range_text(TileRange range) {
  return std::to_string(range.first) + ":" + std::to_string(range.last);
}

PackReport report_of(const PackContent& pack) {
  PackReport report;
  report.grid = pack.grid;
  report.z_step = z_step(pack);
  report.bytes = write_pack_head(pack).size();
  for (const TileSummary& tile : pack.tiles) {
    report.vertices += tile.vertices;
    report.bytes += tile.bytes;
    report.most_vertices = std::max(report.most_vertices, tile.vertices);
    if (tile.bytes == 0) ++report.empty_tiles;
  }
  report.measured = measured(pack);
  if (pack.metadata.accuracy) report.bound = pack.metadata.accuracy->bound;
  return report;
}

PackContent encode_pack(const RasterReader& raster, const EncodeOptions& options,
                        StreamSpool& streams, const Progress& progress) {
  PackContent pack;
  const Metadata notes = metadata_of(options, raster.frame().reference);
  const auto begin = [&](const PackPlan& plan) {
    pack = content_of(plan, notes);
    streams.clear();
  };
  pack::encode_pack(raster, raster_options(options, progress), begin,
                    [&](uint32_t, EncodedTile&& tile) {
                      pack.tiles.push_back(tile.summary);
                      streams.add(tile.stream);
                    });
  return pack;
}

void write_pack(const PackContent& pack, StreamSpool& streams, OutputFile& out) {
  out.write(write_pack_head(pack));
  streams.copy_to(out);
}

EncodedPoints encode_pack(const PointCloud& cloud, const EncodeOptions& options) {
  PointPack made =
      encode_point_pack(cloud, point_options(options), metadata_of(options, cloud.reference));
  std::vector<uint8_t> bytes = pack::write_pack(made.content, made.streams);
  const Verification found =
      on_our_own([&] { return verify(PackFile(bytes), cloud, options.lattice.max_error); });
  if (!found.within_bound || found.uncovered != 0) {
    throw InternalFault("the pack does not keep what was asked for");
  }
  return {std::move(bytes), report_of(made.content), made.xy_step, made.xy_displacement,
          made.merged};
}

ShardReport encode_shard(const RasterReader& raster, const EncodeOptions& options, TileRange tiles,
                         OutputFile& out, const Progress& progress) {
  const Metadata notes = metadata_of(options, raster.frame().reference);
  const PackPlan plan = plan_pack(raster, raster_options(options, progress));
  ShardReport report{existing(tiles, plan.tiled.grid), all_tiles(plan.tiled.grid), 0};
  ShardWriter shard(plan, content_of(plan, notes), report.tiles, out);
  encode_tiles(plan, report.tiles, [&](uint32_t, EncodedTile&& tile) {
    shard.add(tile);
    report.vertices += tile.summary.vertices;
  });
  return report;
}

std::vector<ShardPlan> plan_shards(const RasterReader& raster, const EncodeOptions& options,
                                   uint32_t shards, const Progress& progress) {
  const PackPlan plan = plan_pack(raster, raster_options(options, progress));
  const Decimal step = z_step(content_of(plan, {}));
  const uint64_t tiles = tile_count(plan.tiled.grid), parts = std::min<uint64_t>(shards, tiles);
  std::vector<ShardPlan> plans;
  for (uint64_t i = 0; i < parts; ++i) {
    plans.push_back({plan.tile_steps,
                     step,
                     {static_cast<uint32_t>(tiles * i / parts),
                      static_cast<uint32_t>(tiles * (i + 1) / parts - 1)}});
  }
  return plans;
}

PackReport join_shards(const std::vector<std::string>& paths, OutputFile& out) {
  return report_of(merge_shards(paths, out));
}

}  // namespace microtin::product
