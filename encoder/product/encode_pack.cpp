// SPDX-License-Identifier: MIT
// Encodes packs: of rasters tile by tile, of points at once, and of rasters in shards.
#include "encoder/product/encode_pack.hpp"

#include <algorithm>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/export/queries.hpp"
#include "encoder/pack/encode.hpp"
#include "encoder/pack/point_pack.hpp"
#include "encoder/pack/shard.hpp"
#include "encoder/product/true_bound.hpp"
#include "encoder/terrain/clouds.hpp"
#include "encoder/verify/everywhere.hpp"
#include "encoder/verify/verify.hpp"
#include "microtin/encoder.hpp"

namespace microtin::product {
namespace {

uint32_t tile_vertices(const EncodeOptions& options, bool is_narrow) {
  if (options.tile_vertices != 0) return options.tile_vertices;
  if (options.device_ram == 0) return encoder::kUsualTileVertices;
  const bool has_adapter = options.adapter != Adapter::kNone;
  const uint32_t kept = has_adapter ? kAdapterTiles : kKeptTiles;
  const uint64_t taken = has_adapter ? kAdapterBytes : 0;
  const uint64_t left = options.device_ram - std::min(options.device_ram, taken);
  const uint32_t vertices = vertices_for_ram(left, is_narrow, kept);
  if (vertices < kFewestTileVertices) {
    const uint64_t tile = promised_compact_bytes(kFewestTileVertices, false, 16);
    throw Error(parameter("device_ram") + ' ' + std::to_string(options.device_ram) +
                " is too small for a pack, which takes at least " +
                std::to_string(taken + pack_ram(kFewestTileVertices, tile, kept)) + " bytes");
  }
  return vertices;
}

PackOptions pack_options(const EncodeOptions& options, const Progress& progress) {
  refuse_options_of_streams(options);
  EncodeOptions tile = options;
  tile.device_ram = 0;  // it limits tiles, by their number of vertices
  return {options.lattice, simplify_options(tile, 1, progress), tile_vertices(options, true),
          options.tile_size, tile_vertices(options, false)};
}

PackOptions raster_options(const EncodeOptions& options, const Progress& progress) {
  if (options.lattice.xy_step) {
    throw Error(parameter("xy_step") +
                " is not for packs of rasters, which keep the positions of posts; leave it out");
  }
  return pack_options(options, progress);
}

PackOptions point_options(const EncodeOptions& options) {
  refuse_everywhere_of_points(options);
  if (!options.lattice.breaklines.empty()) {
    throw Error(parameter("breaklines") +
                " is for packs of rasters, and these are points; make a stream (.mtin)");
  }
  if (options.tile_size != 0) {
    throw Error(parameter("tile_size") + " is for rasters, and these are points; leave it out");
  }
  if (!options.resume.empty()) {
    throw Error(parameter("resume") + " is for rasters, and these are points; leave it out");
  }
  return pack_options(options, {});
}

// The step of heights: a decimal, as the lattice was chosen.
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
    throw Error(parameter("shard") + ' ' + range_text(range) + " is beyond the last tile, " +
                std::to_string(all.last));
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
  Margins everywhere{0, 0};
  uint64_t streams = 0;
  for (const TileSummary& tile : pack.tiles) {
    if (tile.bytes != 0) {  // a margin that is not stated is above all others
      everywhere = {std::max(everywhere.below, tile.below), std::max(everywhere.above, tile.above)};
    }
    report.vertices += tile.vertices;
    streams = std::max(streams, tile.offset + tile.bytes);
    report.most_vertices = std::max(report.most_vertices, tile.vertices);
    if (tile.bytes == 0) ++report.empty_tiles;
  }
  report.bytes = write_pack_head(pack).size() + streams;
  report.compact_bytes = most_compact_bytes(pack.tiles, report.most_vertices);
  report.measured = measured(pack);
  report.everywhere = stated_everywhere(everywhere, pack.metadata.placement.z);
  if (pack.metadata.accuracy) {
    report.bound = bound_of_all(pack.metadata.accuracy->bound, report.measured.bounds);
  }
  report.bounds = pack.metadata.bounds;
  if (report.bounds && report.measured.bounds) report.bounds->span = *report.measured.bounds;
  return report;
}

uint32_t slot_capacity(const PackReport& pack) {
  return std::max<uint32_t>(pack.most_vertices, 3);
}

uint64_t adapter_ram(const PackReport& pack) {
  return pack_ram(slot_capacity(pack), pack.compact_bytes, kAdapterTiles) + kAdapterBytes;
}

PackContent encode_pack(const RasterReader& raster, const EncodeOptions& requested,
                        StreamSpool& streams, const Progress& progress) {
  const EncodeOptions options = mapped(requested, raster.frame().bounds);
  PackContent pack;
  const Metadata notes = metadata_of(options, raster.frame());
  std::optional<TileLog> log;
  const auto keep = [&](uint32_t, EncodedTile&& tile) {
    tile.summary.offset = streams.add(tile.stream);
    pack.tiles.push_back(tile.summary);
  };
  bool has_begun = false;
  const auto begin = [&](const PackPlan& plan) -> uint32_t {
    pack = content_of(plan, notes);
    streams.clear();
    if (options.resume.empty()) return 0;
    if (has_begun) log->remove();  // its tiles were too large
    has_begun = true;
    log.emplace(options.resume, plan, pack, all_tiles(plan.tiled.grid), keep);
    return log->next();
  };
  const std::optional<uint32_t> size =
      options.resume.empty() ? std::nullopt : logged_tile_size(options.resume);
  pack::encode_pack(raster, raster_options(options, progress), size.value_or(0), begin,
                    [&](uint32_t number, EncodedTile&& tile) {
                      if (log) log->add(tile);
                      keep(number, std::move(tile));
                    });
  return pack;
}

namespace {

// The largest of 1, 2, 5 times a power of ten that is not larger.
Decimal round_step(double step) {
  Decimal rounded = make_decimal(1, kMaxDecimals);
  for (int64_t power = 1; power <= power_of_ten(kMaxDecimals); power *= 10) {
    for (const int64_t digit : {1, 2, 5}) {
      const Wide number = Wide{power} * digit;
      if (static_cast<double>(number) <= step * 1e9) rounded = make_decimal(number, kMaxDecimals);
    }
  }
  return rounded;
}

// A step that does better: the points' own, if tiles can be so small, or one by how far the bound
// is missed, which shrinks with the step until half of the bound makes up for it.
std::string finer_step(const PointCloud& cloud, Decimal step, Decimal bound, Decimal error) {
  const Decimal finest = pack::finest_step(cloud, pack::kMostTiles);
  if (finest <= make_decimal(1, cloud.xy_decimals)) return "leave it out";
  const double missed = std::max(real(error) - real(bound), real(bound) / 2);
  const Decimal likely = round_step(real(step) * real(bound) / 2.5 / missed);
  if (likely <= finest) return "use " + to_string(finest) + ", the finest for so wide a cloud";
  return "use " + to_string(likely);
}

// An attempt, with the errors where points truly lie, if it moves them.
struct PackAttempt {
  PointPack made;
  std::optional<Verification> true_places;
  bool is_kept = true;  // the bound, there
};

PackAttempt attempt(const PointCloud& cloud, const EncodeOptions& options,
                    const std::optional<Decimal>& room) {
  EncodeOptions fitted = options;
  fitted.lattice.max_error = room;
  PackAttempt result{encode_point_pack(cloud, point_options(fitted), metadata_of(options, cloud)),
                     std::nullopt};
  Metadata& metadata = result.made.content.metadata;
  const std::optional<Decimal> none, &bound = options.lattice.max_error;
  metadata.accuracy->bound = bound;
  metadata.bounds = stated_bounds(cloud.bounds, bound);
  if (!moves_points(metadata.placement, cloud)) return result;
  const bool is_bound = options.lattice.bound_at == BoundScope::kTruePlaces;
  const PackFile pack(pack::write_pack(result.made.content, result.made.streams));
  const Verification found =
      verify_at_true_places(sampled(pack).height_at, metadata.placement, cloud, bound);
  const bool too_low = options.lattice.never_below && found.max_below.mantissa != 0;
  result.is_kept = !is_bound || (found.within_bound && !too_low);
  metadata.true_places = Accuracy{is_bound ? bound_of_all(bound, found.bounds) : none,
                                  found.max_error, found.rms_error, found.mean_error};
  result.true_places = found;
  return result;
}

// Where the first attempt does not keep the bound at points' true places, another within less may.
PackAttempt attempt_twice(const PointCloud& cloud, const EncodeOptions& options) {
  const std::optional<Decimal>& bound = options.lattice.max_error;
  PackAttempt first = attempt(cloud, options, bound);
  if (first.is_kept) return first;
  try {
    const Decimal room = narrower(*bound, first.true_places->max_error);
    if (PackAttempt second = attempt(cloud, options, room); second.is_kept) return second;
  } catch (const Error&) {  // the terrain does not go within that
  }
  const Decimal step = first.made.xy_step, error = first.true_places->max_error;
  throw Error("the error at the points is up to " + to_string(error) + ", above " +
              parameter("max_error") + ' ' + to_string(*bound) + ": " + parameter("xy_step") + ' ' +
              to_string(step) + " is too coarse; " + finer_step(cloud, step, *bound, error) +
              ", or use " + parameter("bound_at") + " lattice");
}

}  // namespace

EncodedPoints encode_pack(const PointCloud& cloud, const EncodeOptions& requested) {
  const EncodeOptions options = mapped(requested, cloud.bounds);
  const Placement lattice = choose_pack_lattice(cloud, options.lattice).placement;
  const std::optional<PointCloud> thin = thinned(cloud, lattice, options.lattice.duplicates);
  const PointCloud& kept = thin ? *thin : cloud;
  auto [made, true_places, is_kept] = attempt_twice(kept, options);
  const uint64_t dropped = cloud.points.size() - kept.points.size();
  if (dropped != 0) made.content.metadata.duplicates = options.lattice.duplicates;
  std::vector<uint8_t> bytes = pack::write_pack(made.content, made.streams);
  const Verification found =
      on_our_own([&] { return verify(PackFile(bytes), kept, options.lattice.max_error); });
  if (!found.within_bound || found.uncovered != 0) {
    throw InternalFault("the pack does not meet the options");
  }
  return {std::move(bytes),   report_of(made.content), made.xy_step, made.xy_displacement,
          kept.points.size(), made.merged + dropped,   true_places};
}

ShardReport encode_shard(const RasterReader& raster, const EncodeOptions& requested,
                         TileRange tiles, OutputFile& out, const Progress& progress) {
  const EncodeOptions options = mapped(requested, raster.frame().bounds);
  const Metadata notes = metadata_of(options, raster.frame());
  const PackPlan plan = plan_pack(raster, raster_options(options, progress));
  ShardReport report{existing(tiles, plan.tiled.grid), all_tiles(plan.tiled.grid), 0};
  const PackContent pack = content_of(plan, notes);
  ShardWriter shard(plan, pack, report.tiles, out);
  const auto keep = [&](uint32_t, EncodedTile&& tile) {
    shard.add(tile);
    report.vertices += tile.summary.vertices;
  };
  std::optional<TileLog> log;
  if (!options.resume.empty()) log.emplace(options.resume, plan, pack, report.tiles, keep);
  const TileRange rest{log ? log->next() : report.tiles.first, report.tiles.last};
  if (rest.first > rest.last) return report;
  encode_tiles(plan, rest, [&](uint32_t number, EncodedTile&& tile) {
    if (log) log->add(tile);
    keep(number, std::move(tile));
  });
  return report;
}

std::vector<ShardPlan> plan_shards(const RasterReader& raster, const EncodeOptions& options,
                                   uint32_t shards, const Progress& progress) {
  const PackPlan plan =
      plan_pack(raster, raster_options(mapped(options, raster.frame().bounds), progress));
  const Decimal step = z_step(content_of(plan, {}));
  const uint64_t tiles = tile_count(plan.tiled.grid), parts = std::min<uint64_t>(shards, tiles);
  std::vector<ShardPlan> plans;
  for (uint64_t i = 0; i < parts; ++i) {
    plans.push_back({plan.tile_size,
                     step,
                     {static_cast<uint32_t>(tiles * i / parts),
                      static_cast<uint32_t>(tiles * (i + 1) / parts - 1)}});
  }
  return plans;
}

}  // namespace microtin::product
