// SPDX-License-Identifier: MIT
// Makes packs from sources and from parts, and writes them.
#include "encoder/product/made_pack.hpp"

#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/files/input.hpp"
#include "encoder/pack/shard.hpp"
#include "encoder/terrain/clouds.hpp"
#include "encoder/terrain/voids.hpp"

namespace microtin::product {

PackSource pack_source_of(const OpenSource& source) {
  if (const auto* const cloud = std::get_if<PointCloud>(&source)) return cloud;
  return std::get<std::unique_ptr<RasterReader>>(source).get();
}

const RasterReader& raster_with_shards(const PackSource& source) {
  if (const auto* const raster = std::get_if<const RasterReader*>(&source)) return **raster;
  throw Error("only packs of rasters have shards, and these are points; encode a whole pack");
}

SourceFacts facts_of(const PackSource& source) {
  if (const auto* const cloud = std::get_if<const PointCloud*>(&source)) {
    return {std::nullopt, warning_on_fill(**cloud), warning_on_grid(**cloud)};
  }
  const RasterReader& raster = *std::get<const RasterReader*>(source);
  const RasterScan scanned = scan(raster, {}, false, {});
  return {scanned, warning_on_fill(scanned.extremes, raster.frame().decimals), ""};
}

MadePack::MadePack(EncodedPoints points) : report_(points.report), points_(std::move(points)) {}

MadePack::MadePack(const PackContent& content, std::unique_ptr<StreamSpool> streams)
    : report_(report_of(content)), head_(write_pack_head(content)), streams_(std::move(streams)) {}

void MadePack::write(OutputFile& out) {
  if (points_) {
    out.write(points_->bytes);
  } else {
    out.write(head_);
    streams_->copy_to(out);
  }
}

MadePack made_pack(const PackSource& source, const EncodeOptions& options,
                   const std::string& output, const Progress& progress) {
  if (const auto* const cloud = std::get_if<const PointCloud*>(&source)) {
    return MadePack(encode_pack(**cloud, options));
  }
  auto streams = std::make_unique<StreamSpool>(output);
  const PackContent content =
      encode_pack(*std::get<const RasterReader*>(source), options, *streams, progress);
  return {content, std::move(streams)};
}

UpdatedTiles updated_pack(const std::string& old, const RasterReader& raster,
                          const EncodeOptions& options, std::optional<BoundScope> bound_at,
                          const std::string& output, const Progress& progress) {
  auto streams = std::make_unique<StreamSpool>(output);
  const UpdatedPack made = update_pack(old, raster, options, bound_at, *streams, progress);
  return {MadePack(made.content, std::move(streams)), made.kept,
          static_cast<uint32_t>(made.content.tiles.size())};
}

MadePack part_of_pack(const std::string& pack, const Extent& extent, const std::string& output) {
  auto streams = std::make_unique<StreamSpool>(output);
  const PackContent content = cut_pack(pack, extent, *streams);
  return {content, std::move(streams)};
}

MadePack merged_pack(const std::vector<std::string>& parts, const std::string& output) {
  auto streams = std::make_unique<StreamSpool>(output);
  const PackContent content =
      is_pack(*open_file(parts[0])) ? join_packs(parts, *streams) : merge_shards(parts, *streams);
  return {content, std::move(streams)};
}

}  // namespace microtin::product
