// SPDX-License-Identifier: MIT
// The public interface in C for sources, streams and packs that are made.
#include <algorithm>
#include <cstring>
#include <functional>
#include <iterator>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "encoder/product/c_calls.hpp"
#include "microtin/encoder.hpp"

#define MICROTIN_TEXT(number) MICROTIN_TEXT_OF(number)
#define MICROTIN_TEXT_OF(number) #number

using namespace microtin::encoder;
using microtin::base::Error;
using microtin::product::copy_decimal;
using microtin::product::expect;
using microtin::product::expect_struct;
using microtin::product::guarded;
using microtin::product::read_struct;
using microtin::product::text_of;
using microtin::product::write_struct;

struct microtin_source {
  SourceTerrain terrain;
};

namespace {

thread_local std::string last_message, last_warnings;

std::vector<std::string> texts_of(const char* const* texts, uint64_t count) {
  if (count != 0) expect(texts);
  std::vector<std::string> all;
  for (uint64_t i = 0; i < count; ++i) {
    expect(texts[i]);
    all.emplace_back(texts[i]);
  }
  return all;
}

RasterData read_raster(const microtin_raster_data& raster) {
  Transform transform{};
  std::copy(std::begin(raster.transform), std::end(raster.transform), transform.begin());
  const double no_data = raster.no_data != nullptr ? *raster.no_data : kNoValue;
  if (raster.heights != nullptr) {
    return raster_from_cells(raster.columns, raster.rows, raster.heights, transform, no_data);
  }
  expect(raster.float_heights);
  return raster_from_cells(raster.columns, raster.rows, raster.float_heights, transform, no_data);
}

// 0 is what is usual, else it is 1 above the number that it has in C++.
template <class Choice>
Choice choice(const char* name, uint32_t given, Choice usual, Choice last) {
  const auto most = static_cast<uint32_t>(last) + 1;
  if (given > most) throw Error(std::string(name) + ": 0 .. " + std::to_string(most));
  return given == 0 ? usual : static_cast<Choice>(given - 1);
}

Options options_of(const microtin_options& given) {
  Options options;
  options.max_error = text_of(given.max_error);
  options.never_below = given.never_below != 0;
  options.z_step = text_of(given.z_step);
  options.xy_step = text_of(given.xy_step);
  options.effort = choice("effort", given.effort, options.effort, SearchEffort::kBest);
  options.max_degree = given.max_degree;
  options.coding = choice("coding", given.coding, options.coding, Coding::kDense);
  options.bound_at = choice("bound_at", given.bound_at, options.bound_at, BoundAt::kEverywhere);
  options.duplicates =
      choice("duplicates", given.duplicates, options.duplicates, Duplicates::kMean);
  options.units = text_of(given.units);
  options.depths = given.depths != 0;
  options.horizontal_epsg = given.horizontal_epsg;
  options.vertical_epsg = given.vertical_epsg;
  if (given.surface > static_cast<uint32_t>(SurfaceKind::kObstacles)) {
    throw Error("surface: " + std::to_string(given.surface) + " is not allowed; use 0 .. 5");
  }
  options.surface = static_cast<SurfaceKind>(given.surface);
  options.source_name = text_of(given.source_name);
  options.date = text_of(given.date);
  options.lineage = text_of(given.lineage);
  options.attribution = text_of(given.attribution);
  options.license = text_of(given.license);
  options.valid = text_of(given.valid);
  options.epoch = text_of(given.epoch);
  options.source_accuracy = text_of(given.source_accuracy);
  options.digest = given.digest != 0;
  options.phases = given.phases != 0;
  options.error_map = text_of(given.error_map);
  options.area = text_of(given.area);
  options.route = text_of(given.route);
  options.route_width = text_of(given.route_width);
  options.route_edge_error = text_of(given.route_edge_error);
  options.breaklines = text_of(given.breaklines);
  options.obstacles = text_of(given.obstacles);
  options.max_vertices = given.max_vertices;
  options.max_bytes = given.max_bytes;
  options.tile_vertices = given.tile_vertices;
  options.tile_size = given.tile_size;
  return options;
}

Callbacks callbacks_of(const microtin_options& options) {
  if (options.progress == nullptr) return {};
  Callbacks callbacks;
  callbacks.progress = [&options](double done) {
    if (options.progress(options.context, done) != 0) throw Cancelled();
  };
  return callbacks;
}

void copy_report(const Report& report, microtin_report* to) {
  last_warnings.clear();
  for (const std::string& warning : report.warnings) last_warnings += warning + '\n';
  if (to == nullptr) return;
  microtin_report all{};
  all.samples = report.samples;
  all.vertices = report.vertices;
  all.bytes = report.bytes;
  all.tiles = report.tiles;
  copy_decimal(report.bound, all.bound);
  copy_decimal(report.max_error, all.max_error);
  copy_decimal(report.rms_error, all.rms_error);
  copy_decimal(report.mean_error, all.mean_error);
  copy_decimal(report.max_below, all.max_below);
  copy_decimal(report.max_above, all.max_above);
  copy_decimal(report.max_below_everywhere, all.max_below_everywhere);
  copy_decimal(report.max_above_everywhere, all.max_above_everywhere);
  copy_decimal(report.max_error_at_points, all.max_error_at_points);
  copy_decimal(report.max_below_at_points, all.max_below_at_points);
  copy_decimal(report.least_bound, all.least_bound);
  copy_decimal(report.largest_bound, all.largest_bound);
  copy_decimal(report.max_bound_ratio, all.max_bound_ratio);
  write_struct(all, to);
}

microtin_status make(microtin_source** terrain, const std::function<SourceTerrain()>& read) {
  return guarded([&] {
    expect(terrain);
    *terrain = new microtin_source{read()};
  });
}

}  // namespace

microtin_status microtin::product::failed(microtin_status outcome, const char* why) {
  try {
    last_message = why;
  } catch (const std::bad_alloc&) {
    last_message.clear();
  }
  return outcome;
}

const char* microtin_last_error(void) {
  return last_message.c_str();
}

const char* microtin_last_warnings(void) {
  return last_warnings.c_str();
}

const char* microtin_version_string(void) {
  return MICROTIN_TEXT(MICROTIN_VERSION_MAJOR) "." MICROTIN_TEXT(
      MICROTIN_VERSION_MINOR) "." MICROTIN_TEXT(MICROTIN_VERSION_PATCH);
}

microtin_status microtin_source_from_raster(const microtin_raster_data* raster,
                                            microtin_source** source) {
  return make(source, [&] {
    const microtin_raster_data given = read_struct(raster);
    RasterData cells = read_raster(given);
    cells.wkt = text_of(given.wkt);
    return SourceTerrain(std::move(cells));
  });
}

microtin_status microtin_source_from_points(const microtin_point_data* points,
                                            microtin_source** source) {
  return make(source, [&] {
    const microtin_point_data given = read_struct(points);
    expect(given.coordinates);
    PointCloudData read = point_cloud_from_xyz(given.count, given.coordinates);
    read.wkt = text_of(given.wkt);
    return SourceTerrain(read);
  });
}

microtin_status microtin_source_from_file(const char* path, microtin_source** source) {
  return make(source, [&] { return SourceTerrain::from_file(text_of(path)); });
}

microtin_status microtin_source_from_files(const char* const* paths, uint64_t count,
                                           microtin_source** source) {
  return make(source, [&] { return SourceTerrain::from_files(texts_of(paths, count)); });
}

microtin_status microtin_source_set_error_map(microtin_source* source,
                                              const microtin_raster_data* bounds) {
  return guarded([&] {
    expect(source);
    source->terrain.set_error_map(read_raster(read_struct(bounds)));
  });
}

void microtin_source_free(microtin_source* source) {
  delete source;
}

microtin_status microtin_encode_stream(const microtin_source* source,
                                       const microtin_options* options, uint8_t** bytes,
                                       uint64_t* byte_count, microtin_report* report) {
  return guarded([&] {
    expect(source);
    expect(bytes);
    expect(byte_count);
    if (report != nullptr) expect_struct(report);
    const microtin_options given = read_struct(options);
    const Stream stream = encode_stream(source->terrain, options_of(given), callbacks_of(given));
    copy_report(stream.report, report);  // first: what fails leaves no bytes behind
    *bytes = new uint8_t[stream.bytes.size()];
    std::copy(stream.bytes.begin(), stream.bytes.end(), *bytes);
    *byte_count = stream.bytes.size();
  });
}

// NOLINTNEXTLINE(readability-non-const-parameter): it is freed
void microtin_bytes_free(uint8_t* bytes) {
  delete[] bytes;
}

microtin_status microtin_encode_pack(const microtin_source* source, const microtin_options* options,
                                     const char* path, microtin_report* report) {
  return guarded([&] {
    expect(source);
    expect(path);
    if (report != nullptr) expect_struct(report);
    const microtin_options given = read_struct(options);
    copy_report(encode_pack(source->terrain, options_of(given), path, callbacks_of(given)), report);
  });
}

microtin_status microtin_plan_shards(const microtin_source* source, const microtin_options* options,
                                     uint32_t count, microtin_shard* shards, uint32_t* planned) {
  return guarded([&] {
    expect(source);
    expect_struct(shards);
    expect(planned);
    const microtin_options given = read_struct(options);
    const std::vector<Shard> found =
        plan_shards(source->terrain, options_of(given), count, callbacks_of(given));
    const size_t size = shards->size;
    auto* to = reinterpret_cast<unsigned char*>(shards);
    for (const Shard& shard : found) {
      microtin_shard all{0, shard.tile_size, shard.first_tile, shard.last_tile, {}};
      copy_decimal(shard.z_step, all.z_step);
      std::memcpy(to, &size, sizeof size);
      write_struct(all, reinterpret_cast<microtin_shard*>(to));
      to += size;
    }
    *planned = static_cast<uint32_t>(found.size());
  });
}

microtin_status microtin_encode_shard(const microtin_source* source,
                                      const microtin_options* options, const microtin_shard* shard,
                                      const char* path, microtin_report* report) {
  return guarded([&] {
    expect(source);
    expect(path);
    if (report != nullptr) expect_struct(report);
    const microtin_options given = read_struct(options);
    const microtin_shard part = read_struct(shard);
    const std::string z_step(part.z_step, std::find(part.z_step, std::end(part.z_step), '\0'));
    copy_report(encode_shard(source->terrain, options_of(given),
                             {part.tile_size, z_step, part.first_tile, part.last_tile}, path,
                             callbacks_of(given)),
                report);
  });
}

microtin_status microtin_merge_packs(const char* const* parts, uint64_t count, const char* path,
                                     microtin_report* report) {
  return guarded([&] {
    expect(path);
    if (report != nullptr) expect_struct(report);
    copy_report(merge_packs(texts_of(parts, count), path), report);
  });
}
