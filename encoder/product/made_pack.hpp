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

#include "encoder/base/progress.hpp"
#include "encoder/export/grid.hpp"
#include "encoder/files/output.hpp"
#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"
#include "encoder/product/encode_pack.hpp"
#include "encoder/terrain/raster_scan.hpp"

namespace microtin::product {

// A terrain as packs are made of it: a raster that is read in pieces, or points.
using PackSource = std::variant<const RasterReader*, const PointCloud*>;

// The source must outlive the result.
PackSource source_of(const OpenSource& source);

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

}  // namespace microtin::product

#endif
