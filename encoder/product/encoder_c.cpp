// SPDX-License-Identifier: MIT
// The public interface in C: structs become objects, exceptions a status and a message.
#include <algorithm>
#include <cstring>
#include <functional>
#include <iterator>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "microtin/encoder.h"
#include "microtin/encoder.hpp"
#include "microtin/surface.hpp"

#define MICROTIN_TEXT(number) MICROTIN_TEXT_OF(number)
#define MICROTIN_TEXT_OF(number) #number

using namespace microtin::encoder;
using microtin::base::Error;

struct microtin_source {
  SourceTerrain terrain;
};

struct microtin_surface {
  Surface surface;
  Mesh mesh;  // handed out last, as the two below
  std::vector<double> places = {};
  std::vector<uint8_t> known = {};
  std::vector<microtin_phase> phases = {};
  std::vector<Line> lines = {};  // handed out last, with what points into them
  std::vector<const char*> classes = {};
  std::vector<uint64_t> line_vertices = {};
  std::vector<double> coordinates = {};
};

namespace {

thread_local std::string last_message, last_warnings;

microtin_status failed(microtin_status outcome, const char* why) {
  try {
    last_message = why;
  } catch (const std::bad_alloc&) {
    last_message.clear();
  }
  return outcome;
}

// Runs `work`, whose exceptions nobody in C can catch.
template <class Work>
microtin_status guarded(const Work& work) {
  try {
    work();
    return MICROTIN_STATUS_OK;
  } catch (const Cancelled& cancelled) {
    return failed(MICROTIN_STATUS_CANCELLED, cancelled.what());
  } catch (const std::bad_alloc&) {
    return failed(MICROTIN_STATUS_NO_MEMORY, "out of memory");
  } catch (const std::out_of_range& refused) {
    return failed(MICROTIN_STATUS_REJECTED, refused.what());
  } catch (const std::runtime_error& refused) {
    return failed(MICROTIN_STATUS_REJECTED, refused.what());
  } catch (const std::exception& fault) {
    return failed(MICROTIN_STATUS_INTERNAL, fault.what());
  }
}

std::string text_of(const char* text) {
  return text != nullptr ? text : "";
}

template <class Pointer>
void expect(Pointer* pointer) {
  if (pointer == nullptr) throw Error("a pointer is null");
}

std::vector<std::string> texts_of(const char* const* texts, uint64_t count) {
  if (count != 0) expect(texts);
  std::vector<std::string> all;
  for (uint64_t i = 0; i < count; ++i) {
    expect(texts[i]);
    all.emplace_back(texts[i]);
  }
  return all;
}

// Structs begin with their size as the caller's version of the header has it. What the caller does
// not know has its default; what the library does not know must be 0.
constexpr size_t kLargestStruct = 4096;  // of any later version; a larger size was never set

template <class Struct>
void expect_struct(const Struct* given) {
  expect(given);
  if (given->size < sizeof given->size || given->size > kLargestStruct) {
    throw Error("the size of a struct is not set: assign its sizeof");
  }
}

template <class Struct>
Struct read_struct(const Struct* given) {
  expect_struct(given);
  const auto* const bytes = reinterpret_cast<const unsigned char*>(given);
  if (given->size < sizeof given->size)
    throw Error("the size of a struct is not set: assign sizeof");
  if (given->size > sizeof(Struct) && std::any_of(bytes + sizeof(Struct), bytes + given->size,
                                                  [](int byte) { return byte != 0; })) {
    throw Error("a struct has members of a later version: link that version of libmicrotin");
  }
  Struct known{};
  std::memcpy(&known, given, std::min(given->size, sizeof(Struct)));
  return known;
}

template <class Struct>
void write_struct(Struct known, Struct* to) {
  known.size = to->size;
  std::memset(to, 0, known.size);
  std::memcpy(to, &known, std::min(known.size, sizeof(Struct)));
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

void copy_decimal(const std::string& decimal, char (&to)[24]) {
  std::strncpy(to, decimal.c_str(), sizeof to - 1);  // 21 characters at most
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

class BytesInMemory : public ByteSource {
 public:
  BytesInMemory(const uint8_t* bytes, uint64_t size) : bytes_(bytes, bytes + size) {}
  uint64_t size() const override { return bytes_.size(); }
  size_t read(uint64_t offset, void* to, size_t size) const override {
    if (offset >= bytes_.size()) return 0;
    const size_t taken = std::min<uint64_t>(size, bytes_.size() - offset);
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), taken,
                static_cast<uint8_t*>(to));
    return taken;
  }

 private:
  std::vector<uint8_t> bytes_;
};

microtin_status open(microtin_surface** surface, const std::function<Surface()>& read) {
  return guarded([&] {
    expect(surface);
    auto opened = std::make_unique<microtin_surface>(microtin_surface{read(), {}});
    for (const Phase& phase : opened->surface.info().phases) {
      opened->phases.push_back({phase.vertices, phase.bytes, phase.max_error.c_str()});
    }
    *surface = opened.release();
  });
}

microtin_status hand_out(microtin_surface* surface, microtin_triangles* triangles,
                         const std::function<Mesh()>& read) {
  return guarded([&] {
    expect(surface);
    expect_struct(triangles);
    surface->mesh = read();
    const Mesh& mesh = surface->mesh;
    write_struct({0, mesh.vertices.size(), mesh.triangles.size(),
                  mesh.vertices.empty() ? nullptr : mesh.vertices.front().data(),
                  mesh.triangles.empty() ? nullptr : mesh.triangles.front().data()},
                 triangles);
  });
}

microtin_lines hand_out(microtin_surface& surface, std::vector<Line> lines) {
  surface.lines = std::move(lines);
  surface.classes.clear();
  surface.line_vertices.clear();
  surface.coordinates.clear();
  for (const Line& line : surface.lines) {
    surface.classes.push_back(line.line_class.c_str());
    surface.line_vertices.push_back(line.vertices.size());
    for (const auto& vertex : line.vertices) {
      surface.coordinates.insert(surface.coordinates.end(), vertex.begin(), vertex.end());
    }
  }
  return {0, surface.lines.size(), surface.classes.data(), surface.line_vertices.data(),
          surface.coordinates.data()};
}

microtin_profile hand_out(microtin_surface& surface, const Profile& profile) {
  surface.places.clear();
  surface.known.clear();
  for (const ProfilePlace& p : profile.places) {
    surface.places.insert(surface.places.end(),
                          {p.along, p.distance, p.x, p.y, p.height, p.below, p.above});
    surface.known.push_back(p.is_known_before ? 1 : 0);
  }
  return {0,
          profile.places.size(),
          surface.places.data(),
          surface.known.data(),
          profile.length,
          profile.earth_radius,
          profile.geodesic_deviation,
          static_cast<uint32_t>(profile.result)};
}

SightOptions options_of(const microtin_sight_options& given) {
  SightOptions options;
  if (given.earth_factor != 0) options.earth_factor = given.earth_factor;
  options.frequency = given.frequency;
  if (given.zone_share != 0) options.zone_share = given.zone_share;
  options.is_safe = given.is_safe != 0;
  return options;
}

void write_bounds(const HeightBounds& found, microtin_height_bounds* bounds) {
  write_struct({0, found.lowest, found.highest, found.source_lowest, found.source_highest,
                found.is_complete ? 1u : 0u},
               bounds);
}

void write_sight(const LineOfSight& sight, const microtin_sights& to, uint64_t i) {
  const auto write = [i](double* numbers, double value) {
    if (numbers != nullptr) numbers[i] = value;
  };
  if (to.line != nullptr) to.line[i] = static_cast<uint8_t>(sight.line);
  if (to.zone != nullptr) to.zone[i] = static_cast<uint8_t>(sight.zone);
  write(to.least_clearance, sight.least_clearance);
  write(to.least_clearance_at, sight.least_clearance_at);
  write(to.first_obstruction, sight.first_obstruction);
  write(to.first_zone_obstruction, sight.first_zone_obstruction);
  write(to.free_share, sight.free_share);
  write(to.free_share_at, sight.free_share_at);
}

microtin_surface_info info_of(const SurfaceInfo& all) {
  microtin_surface_info info{};
  info.bytes = all.bytes;
  info.vertices = all.vertices;
  info.is_pack = all.is_pack ? 1 : 0;
  info.tile_columns = all.tile_columns;
  info.tile_rows = all.tile_rows;
  info.west = all.box.west;
  info.south = all.box.south;
  info.east = all.box.east;
  info.north = all.box.north;
  info.lowest = all.lowest;
  info.highest = all.highest;
  info.x = all.x;
  info.y = all.y;
  info.z = all.z;
  info.horizontal_unit = static_cast<uint32_t>(all.horizontal_unit);
  info.vertical_unit = static_cast<uint32_t>(all.vertical_unit);
  info.horizontal_epsg = all.horizontal_epsg;
  info.vertical_epsg = all.vertical_epsg;
  info.wkt = all.wkt.c_str();
  info.source_name = all.source_name.c_str();
  info.date = all.date.c_str();
  info.lineage = all.lineage.c_str();
  info.attribution = all.attribution.c_str();
  info.license = all.license.c_str();
  info.valid = all.valid.c_str();
  info.epoch = all.epoch.c_str();
  info.source_accuracy = all.source_accuracy.c_str();
  info.digest = all.digest.c_str();
  info.least_bound = all.least_bound.c_str();
  info.largest_bound = all.largest_bound.c_str();
  info.max_bound_ratio = all.max_bound_ratio.c_str();
  info.bound = all.bound.c_str();
  info.max_error = all.max_error.c_str();
  info.rms_error = all.rms_error.c_str();
  info.mean_error = all.mean_error.c_str();
  info.max_error_at_points = all.max_error_at_points.c_str();
  info.surface = static_cast<uint32_t>(all.surface);
  info.side = static_cast<uint32_t>(all.side);
  info.max_below = all.max_below.c_str();
  info.max_above = all.max_above.c_str();
  info.max_below_everywhere = all.max_below_everywhere.c_str();
  info.max_above_everywhere = all.max_above_everywhere.c_str();
  return info;
}

}  // namespace

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

microtin_status microtin_surface_from_file(const char* path, microtin_surface** surface) {
  return open(surface, [&] { return Surface::from_file(text_of(path)); });
}

microtin_status microtin_surface_from_bytes(const uint8_t* bytes, uint64_t byte_count,
                                            const char* name, microtin_surface** surface) {
  return open(surface, [&] {
    expect(bytes);
    return Surface::from_bytes(std::make_unique<BytesInMemory>(bytes, byte_count), text_of(name));
  });
}

void microtin_surface_free(microtin_surface* surface) {
  delete surface;
}

microtin_status microtin_surface_get_info(const microtin_surface* surface,
                                          microtin_surface_info* info) {
  return guarded([&] {
    expect(surface);
    expect_struct(info);
    microtin_surface_info all = info_of(surface->surface.info());
    all.phases = surface->phases.data();
    all.phase_count = surface->phases.size();
    write_struct(all, info);
  });
}

microtin_status microtin_surface_mesh(microtin_surface* surface, microtin_triangles* triangles) {
  return hand_out(surface, triangles, [&] { return surface->surface.mesh(); });
}

microtin_status microtin_surface_lines(microtin_surface* surface, microtin_lines* lines) {
  return guarded([&] {
    expect(surface);
    expect_struct(lines);
    write_struct(hand_out(*surface, surface->surface.lines()), lines);
  });
}

microtin_status microtin_surface_tile(microtin_surface* surface, uint32_t column, uint32_t row,
                                      microtin_triangles* triangles) {
  return hand_out(surface, triangles, [&] { return surface->surface.tile(column, row); });
}

microtin_status microtin_surface_tile_margins(const microtin_surface* surface, uint32_t column,
                                              uint32_t row, microtin_tile_margins* margins) {
  return guarded([&] {
    expect(surface);
    expect_struct(margins);
    const TileMargins found = surface->surface.tile_margins(column, row);
    microtin_tile_margins all{};
    copy_decimal(found.max_below_everywhere, all.max_below_everywhere);
    copy_decimal(found.max_above_everywhere, all.max_above_everywhere);
    write_struct(all, margins);
  });
}

microtin_status microtin_surface_heights(microtin_surface* surface, uint64_t count, const double* x,
                                         const double* y, double* heights) {
  return guarded([&] {
    expect(surface);
    if (count == 0) return;
    expect(x);
    expect(y);
    expect(heights);
    surface->surface.heights(count, x, y, heights);
  });
}

microtin_status microtin_surface_gradients(microtin_surface* surface, uint64_t count,
                                           const double* x, const double* y, double* east,
                                           double* north) {
  return guarded([&] {
    expect(surface);
    if (count == 0) return;
    for (const double* const numbers : {x, y}) expect(numbers);
    for (double* const numbers : {east, north}) expect(numbers);
    surface->surface.gradients(count, x, y, east, north);
  });
}

microtin_status microtin_surface_bounds_in_box(const microtin_surface* surface, double west,
                                               double south, double east, double north,
                                               microtin_height_bounds* bounds) {
  return guarded([&] {
    expect(surface);
    expect_struct(bounds);
    write_bounds(surface->surface.bounds_in_box({west, south, east, north}), bounds);
  });
}

microtin_status microtin_surface_bounds_on_line(const microtin_surface* surface, double x, double y,
                                                double x_end, double y_end,
                                                microtin_height_bounds* bounds) {
  return guarded([&] {
    expect(surface);
    expect_struct(bounds);
    write_bounds(surface->surface.bounds_on_line({x, y}, {x_end, y_end}), bounds);
  });
}

microtin_status microtin_surface_profile(microtin_surface* surface, double x, double y,
                                         double x_end, double y_end, microtin_profile* profile) {
  return guarded([&] {
    expect(surface);
    expect_struct(profile);
    write_struct(hand_out(*surface, surface->surface.profile({x, y}, {x_end, y_end})), profile);
  });
}

microtin_status microtin_surface_lines_of_sight(microtin_surface* surface, uint64_t count,
                                                const double* ends,
                                                const microtin_sight_options* options,
                                                const microtin_sights* sights) {
  return guarded([&] {
    expect(surface);
    const microtin_sights to = read_struct(sights);
    const auto given = options != nullptr ? read_struct(options) : microtin_sight_options{};
    if (count != 0) expect(ends);
    for (uint64_t i = 0; i < count; ++i, ends += 6) {
      const Profile profile = surface->surface.profile({ends[0], ends[1]}, {ends[3], ends[4]});
      write_sight(line_of_sight(profile, {ends[2], given.from_datum != 0},
                                {ends[5], given.to_datum != 0}, options_of(given)),
                  to, i);
    }
  });
}

microtin_status microtin_surface_grid(const microtin_surface* surface, const char* cell,
                                      microtin_grid* grid) {
  return guarded([&] {
    expect(surface);
    expect_struct(grid);
    const Grid found = surface->surface.grid(text_of(cell));
    write_struct({0, found.columns, found.rows, found.x, found.y}, grid);
  });
}

microtin_status microtin_surface_sample_grid(microtin_surface* surface, const microtin_grid* grid,
                                             double* heights) {
  return guarded([&] {
    expect(surface);
    expect(heights);
    const microtin_grid given = read_struct(grid);
    surface->surface.heights({given.columns, given.rows, given.x, given.y},
                             {0, 0, given.columns, given.rows}, heights);
  });
}
