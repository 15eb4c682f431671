// Packs on the command line: encode, plan, merge, and their part of info and verify.
#include "encoder/cli/pack.hpp"

#include <algorithm>
#include <memory>
#include <sstream>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/error_context.hpp"
#include "encoder/cli/progress.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/files/output_file.hpp"
#include "encoder/files/stream_spool.hpp"
#include "encoder/import/import.hpp"
#include "encoder/pack/point_pack.hpp"
#include "encoder/pack/shard.hpp"
#include "encoder/pack/surface.hpp"
#include "encoder/pack/tile_plan.hpp"
#include "encoder/terrain/water.hpp"

namespace microtin::cli {
namespace {

uint32_t tile_vertices(const EncodeRequest& request) {
  if (request.tile_vertices != 0) return request.tile_vertices;
  if (request.device_ram == 0) throw Error("a pack needs --tile-vertices or --device-ram");
  const uint32_t vertices = vertices_for_ram(request.device_ram);
  if (vertices < kFewestTileVertices) {
    throw Error("--device-ram " + std::to_string(request.device_ram) + " is too few for a pack");
  }
  return vertices;
}

PackOptions pack_options(const EncodeRequest& request, const Progress& progress) {
  if (request.max_vertices != 0 || request.max_bytes != 0) {
    throw Error("packs are made with --max-error or of all posts");
  }
  EncodeRequest tile = request;
  tile.device_ram = 0;  // it limits tiles, by their number of vertices
  return {request.lattice, simplify_options(tile, progress), tile_vertices(request),
          request.tile_steps};
}

PackOptions raster_options(const EncodeRequest& request, const Progress& progress) {
  if (request.lattice.xy_step) throw Error("packs keep the places of posts: no --xy-step");
  return pack_options(request, progress);
}

PackOptions point_options(const EncodeRequest& request) {
  if (request.tile_steps != 0) throw Error("--tile-steps is for rasters; these are points");
  return pack_options(request, {});
}

std::unique_ptr<RasterReader> open_raster(const EncodeRequest& request) {
  OpenSource source = prepared_source(request.input, request.preparation);
  auto* const raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
  if (raster == nullptr) {
    throw Error(request.input + ": shards are of packs of rasters; these are points");
  }
  return std::move(*raster);
}

PackContent content_of(const PackPlan& plan, const EncodeRequest& request) {
  const Reference& reference = plan.tiled.raster.frame().reference;
  return content_of(plan, metadata_of(request, reference, {}));
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

std::string report(const PackContent& pack) {
  const Verification all = measured(pack);
  uint64_t vertices = 0, bytes = write_pack_head(pack).size();
  uint32_t most = 0, without = 0;
  for (const TileSummary& tile : pack.tiles) {
    vertices += tile.vertices;
    bytes += tile.bytes;
    most = std::max(most, tile.vertices);
    if (tile.bytes == 0) ++without;
  }
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // else a text for which memory is short ends early, unsaid
  text << "step of z: " << to_string(z_step(pack)) << "\npack: " << tile_columns(pack.grid) << " x "
       << tile_rows(pack.grid) << " tiles of " << pack.grid.width << " x " << pack.grid.height
       << " steps";
  if (without != 0) text << ", " << without << " without terrain";
  text << ", " << vertices << " vertices, at most " << most << " in a tile, " << bytes
       << " bytes\nerror: at most " << to_string(all.max_error) << ", rms "
       << to_string(all.rms_error);
  const std::optional<Accuracy>& accuracy = pack.metadata.accuracy;
  if (accuracy && accuracy->bound) {
    text << " (asked for: at most " << to_string(*accuracy->bound) << ")";
  }
  text << "\nbelow the source: at most " << to_string(all.max_below) << '\n';
  return text.str();
}

PackContent encode_whole(const RasterReader& raster, const EncodeRequest& request,
                         StreamSpool& streams) {
  ProgressBar bar;
  PackContent pack;
  const auto begin = [&](const PackPlan& plan) {
    pack = content_of(plan, request);
    streams.clear();
  };
  encode_pack(raster, raster_options(request, bar.progress()), begin,
              [&](uint32_t, EncodedTile&& tile) {
                pack.tiles.push_back(tile.summary);
                streams.add(tile.stream);
              });
  return pack;
}

// The report; writes the pack.
std::string encode_raster(const RasterReader& raster, const EncodeRequest& request,
                          OutputFile& out) {
  StreamSpool streams(request.output);
  const PackContent pack =
      with_file_context(request.input, [&] { return encode_whole(raster, request, streams); });
  out.write(write_pack_head(pack));
  streams.copy_to(out);
  return report(pack);
}

// The same for points.
std::string encode_points(const PointCloud& cloud, const EncodeRequest& request, OutputFile& out) {
  const auto [pack, bytes] = with_file_context(request.input, [&] {
    PointPack made =
        encode_point_pack(cloud, point_options(request), metadata_of(request, cloud.reference, {}));
    std::vector<uint8_t> all = write_pack(made.content, made.streams);
    return std::pair(std::move(made), std::move(all));
  });
  const Verification found =
      on_our_own([&] { return verify(PackFile(bytes), cloud, request.lattice.max_error); });
  if (!found.within_bound || found.uncovered != 0) {
    throw InternalFault("the pack does not keep what was asked for");
  }
  out.write(bytes);
  std::string text = "source: " + std::to_string(cloud.points.size()) + " points";
  if (!cloud.selection.empty()) text += ", " + cloud.selection;
  text += "\nstep of x and y: " + to_string(pack.xy_step) + moved(pack.xy_displacement) + "\n";
  return text + merged(pack.merged) + report(pack.content);
}

std::string text_of(TileRange range) {
  return std::to_string(range.first) + ":" + std::to_string(range.last);
}

// The last tile of a shard may lie beyond the last of all.
TileRange existing(TileRange range, const TileGrid& grid) {
  const TileRange all = all_tiles(grid);
  if (range.first > all.last) {
    throw Error("--tiles " + text_of(range) + ": the last tile is " + std::to_string(all.last));
  }
  return {range.first, std::min(range.last, all.last)};
}

void run_encode_shard(const EncodeRequest& request) {
  OutputFile out(request.output);
  const std::unique_ptr<RasterReader> raster = open_raster(request);
  const std::string text = with_file_context(request.input, [&] {
    ProgressBar bar;
    const PackPlan plan = plan_pack(*raster, raster_options(request, bar.progress()));
    const TileRange range = existing(*request.tiles, plan.tiled.grid);
    ShardWriter shard(plan, content_of(plan, request), range, out);
    uint64_t vertices = 0;
    encode_tiles(plan, range, [&](uint32_t, EncodedTile&& tile) {
      shard.add(tile);
      vertices += tile.summary.vertices;
    });
    return "tiles: " + text_of(range) + " of " + text_of(all_tiles(plan.tiled.grid)) + ", " +
           std::to_string(vertices) + " vertices\n";
  });
  deliver(out, request.output, text);
}

std::string in_units(uint32_t error, const Axis& z) {
  return json(error / 256.0 * static_cast<double>(z.numerator) /
              static_cast<double>(z.denominator));
}

JsonObject tile_report(const PackFile& pack, uint32_t number) {
  const TileBox box = tile_box(pack.grid(), number);
  const PackEntry& entry = pack.entries()[number];
  const Axis& z = pack.metadata().placement.z;
  return {{"tile", json(number)},
          {"x", json(box.x)},
          {"y", json(box.y)},
          {"bytes", json(entry.size)},
          {"vertices", json(entry.vertices)},
          {"lowest", json(entry.lowest)},
          {"highest", json(entry.highest)},
          {"max_error", in_units(entry.max_error, z)},
          {"rms_error", in_units(entry.root_mean_square, z)}};
}

// A line for each tile, under a line of names; columns end on the right.
std::string table(const std::vector<JsonObject>& tiles) {
  std::vector<std::vector<std::string>> lines(1);
  for (const auto& entry : tiles[0]) lines[0].push_back(entry.first);
  std::vector<std::size_t> widths(lines[0].size());
  for (const JsonObject& tile : tiles) {
    lines.emplace_back();
    for (const auto& entry : tile) lines.back().push_back(entry.second);
  }
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < widths.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
  }
  std::string text;
  for (const auto& line : lines) {
    for (std::size_t i = 0; i < widths.size(); ++i) {
      text += std::string(widths[i] - line[i].size() + (i == 0 ? 0 : 2), ' ') + line[i];
    }
    text += '\n';
  }
  return text;
}

std::string array(const std::vector<JsonObject>& tiles) {
  std::string text;
  for (const JsonObject& tile : tiles) text += (text.empty() ? "[" : ", ") + json(tile);
  return text + "]";
}

}  // namespace

void run_encode_pack(const EncodeRequest& request) {
  if (request.tiles) {
    run_encode_shard(request);
    return;
  }
  OutputFile out(request.output);
  const OpenSource source = prepared_source(request.input, request.preparation);
  const auto* const cloud = std::get_if<PointCloud>(&source);
  const std::string text =
      cloud != nullptr
          ? encode_points(*cloud, request, out)
          : encode_raster(*std::get<std::unique_ptr<RasterReader>>(source), request, out);
  deliver(out, request.output, text);
}

void run_plan(const EncodeRequest& request, uint32_t shards) {
  refuse_overwriting(inputs_of(request), "-");
  const std::unique_ptr<RasterReader> raster = open_raster(request);
  const std::string text = with_file_context(request.input, [&] {
    ProgressBar bar;
    const PackPlan plan = plan_pack(*raster, raster_options(request, bar.progress()));
    const uint64_t tiles = tile_count(plan.tiled.grid), parts = std::min<uint64_t>(shards, tiles);
    std::string lines;
    for (uint64_t i = 0; i < parts; ++i) {
      const TileRange range{static_cast<uint32_t>(tiles * i / parts),
                            static_cast<uint32_t>(tiles * (i + 1) / parts - 1)};
      lines += "--tile-steps " + std::to_string(plan.tile_steps) + " --z-step " +
               to_string(z_step(content_of(plan, request))) + " --tiles " + text_of(range) + '\n';
    }
    return lines;
  });
  print(text);
}

void run_merge(const std::vector<std::string>& shards, const std::string& output) {
  refuse_overwriting(shards, output);
  OutputFile out(output);
  const PackContent pack = merge_shards(shards, out);
  deliver(out, output, report(pack));
}

void run_info_pack(const PackFile& pack, bool as_json) {
  std::vector<JsonObject> tiles;
  uint64_t vertices = 0;
  for (uint32_t number = 0; number < pack.entries().size(); ++number) {
    tiles.push_back(tile_report(pack, number));
    vertices += pack.entries()[number].vertices;
  }
  const TileGrid& grid = pack.grid();
  JsonObject report = {{"pack_version", json(kPackVersion)},
                       {"columns", json(tile_columns(grid))},
                       {"rows", json(tile_rows(grid))},
                       {"tile_width", json(grid.width)},
                       {"tile_height", json(grid.height)},
                       {"x_max", json(grid.x_max)},
                       {"y_max", json(grid.y_max)},
                       {"vertices", json(vertices)},
                       {"most_vertices", json(pack.header().most_vertices)},
                       {"lowest", json(pack.header().lowest)},
                       {"highest", json(pack.header().highest)},
                       {"bytes", json(pack.bytes())}};
  add_placement(report, pack.metadata());
  add_notes(report, pack.metadata());
  add_accuracy(report, pack.metadata().accuracy);
  if (as_json) report.emplace_back("tiles", array(tiles));
  print(text_of(report, as_json) + (as_json ? "" : table(tiles)));
}

void run_verify_pack(const VerifyRequest& request, const PackFile& pack) {
  const OpenSource source = prepared_source(request.source, request.preparation);
  const Promise promise = with_file_context(
      request.input, [&] { return promise_of(pack.metadata(), request.preparation); });
  const auto* const raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
  WaterGauge gauge(raster != nullptr ? (*raster)->frame().decimals : 0, promise.water_level);
  const Verification found = with_file_context(request.input, [&] {
    if (const auto* cloud = std::get_if<PointCloud>(&source))
      return verify(pack, *cloud, promise.bound);
    ProgressBar bar;
    return verify(pack, **raster, promise.bound, bar.progress(),
                  promise.water_level ? gauge.visitor() : PostVisitor());
  });
  report_and_judge(request, promise, found, gauge.moved());
}

}  // namespace microtin::cli
