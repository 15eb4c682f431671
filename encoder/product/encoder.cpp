// SPDX-License-Identifier: MIT
// The public interface: checks options and terrains, and translates them.
#include "microtin/encoder.hpp"

#include <memory>
#include <optional>
#include <utility>
#include <variant>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/import/bound_map.hpp"
#include "encoder/import/crs.hpp"
#include "encoder/import/import.hpp"
#include "encoder/import/prepared_terrain.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/product/encode_stream.hpp"
#include "encoder/product/made_pack.hpp"
#include "encoder/product/public_options.hpp"
#include "encoder/terrain/clouds.hpp"
#include "encoder/terrain/voids.hpp"

namespace microtin::encoder {

using base::Error;

struct SourceTerrain::Content {
  std::shared_ptr<const terrain::Source> source;            // null: what is in the files
  std::shared_ptr<const terrain::Raster> bounds = nullptr;  // of its posts; null: one for all
  std::vector<std::string> files = {};
  std::shared_ptr<const importing::FileTexts> texts = nullptr;  // null: there are none
};

namespace {

void expect(bool holds, const std::string& rule) {
  if (!holds) throw Error(rule);
}

bool is_number(int64_t value) {
  return value >= -terrain::kLargestNumber && value <= terrain::kLargestNumber;
}

void check_decimals(int decimals) {
  expect(decimals >= 0 && decimals <= 18, "decimals: use 0 to 18");
}

// In lowest terms: headers hold 40 bits of each.
microtin_axis checked(const microtin_axis& axis) {
  expect(axis.numerator != 0 && axis.denominator != 0,
         "an axis has no step; set numerator and denominator above 0");
  return exact::reduced_axis(axis.offset, axis.numerator, axis.denominator);
}

terrain::Reference reference_of(const std::string& wkt, const std::string& z_unit) {
  terrain::Reference reference = importing::reference_of_wkt(wkt);
  importing::state_vertical_unit(exact::unit_named(z_unit), reference);
  return reference;
}

terrain::Reference raster_reference(const RasterData& posts) {
  terrain::Reference reference = reference_of(posts.wkt, posts.z_unit);
  const auto item = [&](const char* name) {
    const auto found = posts.items.find(name);
    return found != posts.items.end() ? found->second : std::string();
  };
  reference.notes = terrain::notes_of_items(item, reference.warnings);
  return reference;
}

terrain::Raster raster_of(RasterData posts) {
  expect(posts.heights.size() == uint64_t{posts.columns} * posts.rows,
         "there are " + std::to_string(posts.heights.size()) +
             " heights; use columns times rows, " +
             std::to_string(uint64_t{posts.columns} * posts.rows));
  check_decimals(posts.decimals);
  for (const int64_t height : posts.heights) {
    expect(height == kNoData || is_number(height), "a height is beyond 10^18; use fewer decimals");
  }
  static_assert(kNoData == terrain::kVoidHeight, "void posts are taken as they are");
  return terrain::Raster{posts.columns,          posts.rows,       std::move(posts.heights),
                         posts.decimals,         checked(posts.x), checked(posts.y),
                         raster_reference(posts)};
}

terrain::Source cloud_of(const PointCloudData& points) {
  check_decimals(points.xy_decimals);
  check_decimals(points.z_decimals);
  terrain::PointCloud cloud;
  cloud.xy_decimals = points.xy_decimals;
  cloud.z_decimals = points.z_decimals;
  cloud.reference = reference_of(points.wkt, points.z_unit);
  cloud.points.reserve(points.points.size());
  for (const auto& [x, y, z] : points.points) {
    expect(is_number(x) && is_number(y) && is_number(z),
           "a coordinate is beyond 10^18; use fewer decimals");
    cloud.points.push_back({x, y, z});
  }
  return cloud;
}

// A raster that somebody else keeps.
class KeptRaster : public terrain::RasterReader {
 public:
  explicit KeptRaster(const terrain::Raster& raster) : raster_(raster) {
    frame_ = terrain::frame_of(raster);
  }

  terrain::Raster read(const terrain::PostRectangle& rectangle) const override {
    return terrain::crop(raster_, rectangle);
  }

 private:
  const terrain::Raster& raster_;
};

void expect_default(const char* name, bool is_default, const char* kind) {
  expect(is_default, base::parameter(name) + " is an option of " + kind + "; leave it out");
}

void check_stream_options(const Options& options, bool has_map) {
  expect_default("tile_vertices", options.tile_vertices == 0, "packs");
  expect_default("tile_size", options.tile_size == 0, "packs");
  const bool is_aim = !options.max_error.empty() && !has_map;  // a map's bounds are scaled
  const int aims =
      (is_aim ? 1 : 0) + (options.max_vertices != 0 ? 1 : 0) + (options.max_bytes != 0 ? 1 : 0);
  expect(aims <= 1, base::parameter("max_error") + ", " + base::parameter("max_vertices") +
                        " and " + base::parameter("max_bytes") + " exclude each other; use one");
  expect(!options.never_below || has_map || !options.max_error.empty() || options.max_bytes != 0,
         base::parameter("never_below") + " needs " + base::parameter("max_error") + " or " +
             base::parameter("max_bytes"));
}

void check_pack_options(const Options& options, bool has_map) {
  expect_default("max_vertices", options.max_vertices == 0, "streams");
  expect_default("max_bytes", options.max_bytes == 0, "streams");
  expect(!options.never_below || has_map || !options.max_error.empty(),
         base::parameter("never_below") + " needs " + base::parameter("max_error"));
}

// How files are read.
importing::Preparation preparation_of(const SourceTerrain::Content& content,
                                      const Options& options) {
  importing::Preparation preparation = product::preparation_of(options);
  if (!content.files.empty()) {
    preparation.more_files.assign(content.files.begin() + 1, content.files.end());
  }
  preparation.texts = content.texts;
  return preparation;
}

product::EncodeOptions options_of(const SourceTerrain& terrain, const Options& options) {
  product::EncodeOptions all = product::options_of(options);
  const importing::Preparation preparation = preparation_of(terrain.content(), options);
  product::take_breaklines(options, importing::feature_files_of(preparation), all);
  if (!options.obstacles.empty()) product::imply_obstacles(all);
  return all;
}

// The raster of bounds that the caller gave, unless a file replaces it.
std::optional<importing::BoundMap> own_map(const SourceTerrain::Content& content,
                                           const importing::Preparation& preparation) {
  if (content.bounds == nullptr || !preparation.error_map.empty()) return std::nullopt;
  return importing::BoundMap(base::parameter("error_map"),
                             std::make_unique<KeptRaster>(*content.bounds), preparation.max_error);
}

terrain::Source read_files(const SourceTerrain::Content& content, const Options& options) {
  const importing::Preparation preparation = preparation_of(content, options);
  return importing::prepared_terrain(content.files[0], preparation, own_map(content, preparation));
}

// A terrain in the units that are requested, shaped by files: a copy only where that changes it.
class SettledTerrain {
 public:
  SettledTerrain(const SourceTerrain::Content& content, const Options& options)
      : source_(content.source.get()) {
    if (source_ == nullptr) {
      changed_ = read_files(content, options);
      reference_ = terrain::reference_of(*changed_);
      return;
    }
    const importing::Preparation preparation = preparation_of(content, options);
    const importing::SettledReference settled =
        importing::settle(terrain::reference_of(*source_), *preparation.requested);
    reference_ = settled.reference;
    const bool is_plain = importing::is_plain(settled.conversion);
    const bool has_files = !options.error_map.empty() || !options.area.empty() ||
                           !options.route.empty() || !options.obstacles.empty();
    std::optional<importing::BoundMap> map = own_map(content, preparation);
    if (is_plain && !has_files && !map) {
      importing::expect_systems(preparation, reference_);
      return;
    }
    changed_ = *source_;
    if (!is_plain) importing::convert(*changed_, settled);
    importing::shape(*changed_, preparation, std::move(map));
  }

  const terrain::Source& source() const { return changed_ ? *changed_ : *source_; }
  const terrain::Reference& reference() const { return reference_; }

 private:
  const terrain::Source* source_;
  terrain::Reference reference_;
  std::optional<terrain::Source> changed_;
};

// A terrain as packs are made of it: a raster is read in pieces, from files or from memory.
class TiledTerrain {
 public:
  TiledTerrain(const SourceTerrain::Content& content, const Options& options) {
    if (content.source == nullptr) {
      const importing::Preparation preparation = preparation_of(content, options);
      opened_ =
          importing::prepared_source(content.files[0], preparation, own_map(content, preparation));
      source_ = product::pack_source_of(opened_);
      return;
    }
    settled_.emplace(content, options);
    if (const auto* const raster = std::get_if<terrain::Raster>(&settled_->source())) {
      raster_ = std::make_unique<KeptRaster>(*raster);
      source_ = raster_.get();
    } else {
      source_ = &std::get<terrain::PointCloud>(settled_->source());
    }
  }

  const product::PackSource& source() const { return source_; }
  const terrain::Reference& reference() const {
    if (settled_) return settled_->reference();
    const auto* const cloud = std::get_if<const terrain::PointCloud*>(&source_);
    if (cloud != nullptr) return (*cloud)->reference;
    return std::get<const terrain::RasterReader*>(source_)->frame().reference;
  }

 private:
  importing::OpenSource opened_;
  std::optional<SettledTerrain> settled_;
  std::unique_ptr<terrain::RasterReader> raster_;  // in memory
  product::PackSource source_;
};

// Ends the work by an exception when the caller cancels it.
base::Progress progress_of(const Callbacks& callbacks) {
  return base::Progress([&callbacks](double done) {
    if (callbacks.cancelled && callbacks.cancelled()) throw Cancelled();
    if (callbacks.progress) callbacks.progress(done);
  });
}

void add_bounds(Report& report, const std::optional<terrain::StatedBounds>& bounds) {
  if (!bounds) return;
  report.least_bound = to_string(bounds->span.least);
  report.largest_bound = to_string(bounds->span.largest);
  report.max_bound_ratio = to_string(bounds->span.ratio);
}

void add_everywhere(Report& report, const std::optional<terrain::Distances>& stated) {
  if (!stated) return;
  report.max_below_everywhere = to_string(stated->below);
  report.max_above_everywhere = to_string(stated->above);
}

void add_true_places(Report& report, const std::optional<verifying::Verification>& measured) {
  if (!measured) return;
  report.max_error_at_points = to_string(measured->max_error);
  report.max_below_at_points = to_string(measured->max_below);
}

// The bound that all samples keep; empty if some have none.
std::string bound_text(const product::EncodedStream& encoded) {
  const auto bound = terrain::bound_of_all(encoded.bound, encoded.verification.bounds);
  return bound ? to_string(*bound) : std::string();
}

Report report_of(const product::EncodedStream& encoded) {
  const verifying::Verification& measured = encoded.verification;
  Report report{measured.posts,
                encoded.vertices,
                encoded.stream.size(),
                0,
                bound_text(encoded),
                to_string(measured.max_error),
                to_string(measured.rms_error),
                to_string(measured.mean_error),
                to_string(measured.max_below),
                to_string(measured.max_above),
                {},
                {},
                {},
                {},
                {},
                {},
                {},
                {}};
  add_everywhere(report, encoded.everywhere);
  add_bounds(report, encoded.bounds);
  add_true_places(report, encoded.true_places);
  return report;
}

Report report_of(const product::PackReport& pack, uint64_t samples) {
  Report report{samples,
                pack.vertices,
                pack.bytes,
                static_cast<uint32_t>(pack::tile_count(pack.grid)),
                pack.bound ? to_string(*pack.bound) : std::string(),
                to_string(pack.measured.max_error),
                to_string(pack.measured.rms_error),
                to_string(pack.measured.mean_error),
                to_string(pack.measured.max_below),
                to_string(pack.measured.max_above),
                {},
                {},
                {},
                {},
                {},
                {},
                {},
                {}};
  add_everywhere(report, pack.everywhere);
  add_bounds(report, pack.bounds);
  return report;
}

bool has_map(const SourceTerrain& terrain, const Options& options) {
  return !options.error_map.empty() || terrain.content().bounds != nullptr;
}

// Warnings about units and systems, and of a text that is not empty.
std::vector<std::string> warnings_on(const terrain::Reference& reference, const std::string& fill) {
  std::vector<std::string> warnings = importing::completed(reference).warnings;
  if (!fill.empty()) warnings.push_back(fill);
  return warnings;
}

std::vector<std::string> warnings_on(const terrain::Reference& reference,
                                     const terrain::PointCloud& cloud) {
  std::vector<std::string> warnings = warnings_on(reference, terrain::warning_on_fill(cloud));
  const std::string grid = terrain::warning_on_grid(cloud);
  if (!grid.empty()) warnings.push_back(grid);
  return warnings;
}

void warn_of_obstacles(uint64_t elsewhere, std::vector<std::string>& warnings) {
  if (elsewhere == 0) return;
  warnings.push_back(base::parameter("obstacles") +
                     ": touching no post with a height: " + std::to_string(elsewhere));
}

std::vector<std::string> warnings_on(const SettledTerrain& terrain) {
  const auto* const raster = std::get_if<terrain::Raster>(&terrain.source());
  if (raster == nullptr) {
    return warnings_on(terrain.reference(), std::get<terrain::PointCloud>(terrain.source()));
  }
  std::vector<std::string> warnings =
      warnings_on(terrain.reference(), terrain::warning_on_fill(*raster));
  warn_of_obstacles(raster->mended.obstacles_elsewhere, warnings);
  return warnings;
}

// Warnings on the terrain of a pack.
void add_warnings(Report& report, const TiledTerrain& terrain, const product::SourceFacts& found) {
  report.warnings = warnings_on(terrain.reference(), found.fill);
  if (!found.grid.empty()) report.warnings.push_back(found.grid);
  if (found.scanned) warn_of_obstacles(found.scanned->mended.obstacles_elsewhere, report.warnings);
}

// The options of a pack, or of a shard, of a terrain.
product::EncodeOptions pack_options_of(const SourceTerrain& terrain, const Options& options) {
  check_pack_options(options, has_map(terrain, options));
  return options_of(terrain, options);
}

}  // namespace

std::string message_of(const std::exception& error,
                       const std::function<std::string(const std::string&)>& spell) {
  const auto* const own = dynamic_cast<const Error*>(&error);
  return own != nullptr ? base::spelled(own->text(), spell) : error.what();
}

SourceTerrain::SourceTerrain(std::shared_ptr<const Content> content)
    : content_(std::move(content)) {}

SourceTerrain::SourceTerrain(RasterData raster)
    : SourceTerrain(std::make_shared<Content>(
          Content{std::make_shared<terrain::Source>(raster_of(std::move(raster)))})) {}

SourceTerrain::SourceTerrain(const PointCloudData& points)
    : SourceTerrain(
          std::make_shared<Content>(Content{std::make_shared<terrain::Source>(cloud_of(points))})) {
}

SourceTerrain SourceTerrain::from_file(const std::string& path) {
  return SourceTerrain(std::make_shared<Content>(
      Content{std::make_shared<terrain::Source>(importing::import_terrain(path))}));
}

SourceTerrain SourceTerrain::from_files(const std::vector<std::string>& paths) {
  expect(!paths.empty(), "no file of the terrain is named; name one");
  for (const std::string& path : paths) importing::files_in(path);
  return SourceTerrain(std::make_shared<Content>(Content{nullptr, nullptr, paths}));
}

void SourceTerrain::set_error_map(RasterData bounds) {
  auto map = std::make_shared<terrain::Raster>(raster_of(std::move(bounds)));
  Content changed = *content_;
  changed.bounds = std::move(map);
  content_ = std::make_shared<Content>(std::move(changed));
}

void SourceTerrain::set_features(const std::string& path, std::string geojson) {
  Content changed = *content_;
  auto texts =
      changed.texts != nullptr ? importing::FileTexts(*changed.texts) : importing::FileTexts();
  texts[path] = std::move(geojson);
  changed.texts = std::make_shared<importing::FileTexts>(std::move(texts));
  content_ = std::make_shared<Content>(std::move(changed));
}

Stream encode_stream(const SourceTerrain& terrain, const Options& options,
                     const Callbacks& callbacks) {
  check_stream_options(options, has_map(terrain, options));
  product::EncodeOptions all = options_of(terrain, options);
  const SettledTerrain settled(terrain.content(), options);
  all.reference = settled.reference();
  product::EncodedStream encoded =
      product::encode_stream(settled.source(), all, progress_of(callbacks));
  Report report = report_of(encoded);
  report.warnings = warnings_on(settled);
  return {std::move(encoded.stream), std::move(report)};
}

Report encode_pack(const SourceTerrain& terrain, const Options& options, const std::string& path,
                   const Callbacks& callbacks) {
  product::EncodeOptions all = pack_options_of(terrain, options);
  const TiledTerrain tiled(terrain.content(), options);
  all.reference = tiled.reference();
  files::OutputFile out(path);
  product::MadePack pack = product::made_pack(tiled.source(), all, path, progress_of(callbacks));
  pack.write(out);
  const product::SourceFacts facts = product::facts_of(tiled.source());
  Report report = report_of(pack.report(), facts.scanned ? facts.scanned->posts : 0);
  if (pack.points()) {
    report.samples = pack.points()->points;
    add_true_places(report, pack.points()->true_places);
  }
  add_warnings(report, tiled, facts);
  out.commit();
  return report;
}

std::vector<Shard> plan_shards(const SourceTerrain& terrain, const Options& options, uint32_t count,
                               const Callbacks& callbacks) {
  expect(count != 0, "a pack has at least one shard");
  product::EncodeOptions all = pack_options_of(terrain, options);
  const TiledTerrain tiled(terrain.content(), options);
  all.reference = tiled.reference();
  std::vector<Shard> shards;
  for (const product::ShardPlan& plan : product::plan_shards(
           product::raster_with_shards(tiled.source()), all, count, progress_of(callbacks))) {
    shards.push_back({plan.tile_size, to_string(plan.z_step), plan.tiles.first, plan.tiles.last});
  }
  return shards;
}

Report encode_shard(const SourceTerrain& terrain, const Options& options, const Shard& shard,
                    const std::string& path, const Callbacks& callbacks) {
  Options planned = options;
  planned.tile_size = shard.tile_size;
  planned.z_step = shard.z_step;
  product::EncodeOptions all = pack_options_of(terrain, planned);
  expect(shard.first_tile <= shard.last_tile,
         "a shard ends before its first tile; use a shard that plan_shards returned");
  const TiledTerrain tiled(terrain.content(), planned);
  all.reference = tiled.reference();
  files::OutputFile out(path);
  const product::ShardReport made =
      product::encode_shard(product::raster_with_shards(tiled.source()), all,
                            {shard.first_tile, shard.last_tile}, out, progress_of(callbacks));
  out.commit();
  Report report;
  report.vertices = made.vertices;
  report.tiles = made.tiles.last - made.tiles.first + 1;
  report.warnings = warnings_on(tiled.reference(), "");
  return report;
}

Report merge_packs(const std::vector<std::string>& parts, const std::string& path) {
  expect(!parts.empty(), "no shard or pack is named; name all parts");
  files::OutputFile out(path);
  product::MadePack pack = product::merged_pack(parts, path);
  pack.write(out);
  Report report = report_of(pack.report(), 0);
  out.commit();
  return report;
}

}  // namespace microtin::encoder
