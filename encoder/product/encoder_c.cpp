// SPDX-License-Identifier: MIT
// The public face in C: structs become objects, exceptions outcomes with a message.
#include <algorithm>
#include <cstring>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

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
  Mesh mesh;  // handed out last
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

template <class Struct>
const Struct& checked(const Struct* given) {
  if (given == nullptr || given->size != sizeof(Struct)) throw Error("a struct of another size");
  return *given;
}

template <class Pointer>
void expect(Pointer* pointer) {
  if (pointer == nullptr) throw Error("a pointer is null");
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

void expect_none(uint32_t one, uint32_t other, const char* rule) {
  if (one != 0 || other != 0) throw Error(rule);
}

template <class Options>
Options common_options(const microtin_options& given) {
  Options options;
  options.max_error = text_of(given.max_error);
  options.never_below = given.never_below != 0;
  options.z_step = text_of(given.z_step);
  options.xy_step = text_of(given.xy_step);
  options.effort = choice("effort", given.effort, options.effort, SearchEffort::kBest);
  options.max_degree = given.max_degree;
  options.coding = choice("coding", given.coding, options.coding, Coding::kDense);
  options.bound_at = choice("bound_at", given.bound_at, options.bound_at, BoundAt::kLattice);
  options.duplicates =
      choice("duplicates", given.duplicates, options.duplicates, Duplicates::kMean);
  options.units = text_of(given.units);
  options.depths = given.depths != 0;
  options.horizontal_epsg = given.horizontal_epsg;
  options.vertical_epsg = given.vertical_epsg;
  options.source_name = text_of(given.source_name);
  options.date = text_of(given.date);
  options.lineage = text_of(given.lineage);
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
  *to = {};
  to->samples = report.samples;
  to->vertices = report.vertices;
  to->bytes = report.bytes;
  to->tiles = report.tiles;
  copy_decimal(report.bound, to->bound);
  copy_decimal(report.max_error, to->max_error);
  copy_decimal(report.rms_error, to->rms_error);
  copy_decimal(report.mean_error, to->mean_error);
  copy_decimal(report.max_below, to->max_below);
  copy_decimal(report.max_error_at_points, to->max_error_at_points);
  copy_decimal(report.max_below_at_points, to->max_below_at_points);
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
    *surface = new microtin_surface{read(), {}};
  });
}

microtin_status hand_out(microtin_surface* surface, microtin_triangles* triangles,
                         const std::function<Mesh()>& read) {
  return guarded([&] {
    expect(surface);
    expect(triangles);
    surface->mesh = read();
    const Mesh& mesh = surface->mesh;
    *triangles = {mesh.vertices.size(), mesh.triangles.size(),
                  mesh.vertices.empty() ? nullptr : mesh.vertices.front().data(),
                  mesh.triangles.empty() ? nullptr : mesh.triangles.front().data()};
  });
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
    RasterData posts = read_raster(checked(raster));
    posts.wkt = text_of(raster->wkt);
    return SourceTerrain(std::move(posts));
  });
}

microtin_status microtin_source_from_points(const microtin_point_data* points,
                                            microtin_source** source) {
  return make(source, [&] {
    expect(checked(points).coordinates);
    PointCloudData read = point_cloud_from_xyz(points->count, points->coordinates);
    read.wkt = text_of(points->wkt);
    return SourceTerrain(read);
  });
}

microtin_status microtin_source_from_file(const char* path, microtin_source** source) {
  return make(source, [&] { return SourceTerrain::from_file(text_of(path)); });
}

void microtin_source_free(microtin_source* source) {
  delete source;
}

microtin_status microtin_encode_stream(const microtin_source* source,
                                       const microtin_options* options, uint8_t** bytes,
                                       uint64_t* size, microtin_report* report) {
  return guarded([&] {
    expect(source);
    expect(bytes);
    expect(size);
    auto all = common_options<StreamOptions>(checked(options));
    expect_none(options->tile_vertices, options->tile_size,
                "tile_vertices and tile_size are for packs");
    all.max_vertices = options->max_vertices;
    all.max_bytes = options->max_bytes;
    const Stream stream = encode_stream(source->terrain, all, callbacks_of(*options));
    copy_report(stream.report, report);  // first: what fails leaves no bytes behind
    *bytes = new uint8_t[stream.bytes.size()];
    std::copy(stream.bytes.begin(), stream.bytes.end(), *bytes);
    *size = stream.bytes.size();
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
    auto all = common_options<PackOptions>(checked(options));
    expect_none(options->max_vertices, options->max_bytes,
                "max_vertices and max_bytes are for streams");
    all.tile_vertices = options->tile_vertices;
    all.tile_size = options->tile_size;
    copy_report(encode_pack(source->terrain, all, path, callbacks_of(*options)), report);
  });
}

microtin_status microtin_surface_from_file(const char* path, microtin_surface** surface) {
  return open(surface, [&] { return Surface::from_file(text_of(path)); });
}

microtin_status microtin_surface_from_bytes(const uint8_t* bytes, uint64_t size, const char* name,
                                            microtin_surface** surface) {
  return open(surface, [&] {
    expect(bytes);
    return Surface::from_bytes(std::make_unique<BytesInMemory>(bytes, size), text_of(name));
  });
}

void microtin_surface_free(microtin_surface* surface) {
  delete surface;
}

void microtin_surface_get_info(const microtin_surface* surface, microtin_surface_info* info) {
  const SurfaceInfo& all = surface->surface.info();
  *info = {};
  info->bytes = all.bytes;
  info->vertices = all.vertices;
  info->is_pack = all.is_pack ? 1 : 0;
  info->tile_columns = all.tile_columns;
  info->tile_rows = all.tile_rows;
  info->west = all.box.west;
  info->south = all.box.south;
  info->east = all.box.east;
  info->north = all.box.north;
  info->lowest = all.lowest;
  info->highest = all.highest;
  info->x = all.x;
  info->y = all.y;
  info->z = all.z;
  info->source = {all.source.columns, all.source.rows, all.source.x, all.source.y};
  info->horizontal_unit = static_cast<uint32_t>(all.horizontal_unit);
  info->vertical_unit = static_cast<uint32_t>(all.vertical_unit);
  info->horizontal_epsg = all.horizontal_epsg;
  info->vertical_epsg = all.vertical_epsg;
  info->wkt = all.wkt.c_str();
  info->origin = all.origin.c_str();
  info->date = all.date.c_str();
  info->lineage = all.lineage.c_str();
  info->bound = all.bound.c_str();
  info->max_error = all.max_error.c_str();
  info->rms_error = all.rms_error.c_str();
  info->mean_error = all.mean_error.c_str();
  info->max_error_at_points = all.max_error_at_points.c_str();
}

microtin_status microtin_surface_mesh(microtin_surface* surface, microtin_triangles* triangles) {
  return hand_out(surface, triangles, [&] { return surface->surface.mesh(); });
}

microtin_status microtin_surface_tile(microtin_surface* surface, uint32_t column, uint32_t row,
                                      microtin_triangles* triangles) {
  return hand_out(surface, triangles, [&] { return surface->surface.tile(column, row); });
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

microtin_status microtin_surface_grid(const microtin_surface* surface, const char* cell,
                                      microtin_grid* grid) {
  return guarded([&] {
    expect(surface);
    expect(grid);
    const Grid found = surface->surface.grid(text_of(cell));
    *grid = {found.columns, found.rows, found.x, found.y};
  });
}

microtin_status microtin_surface_sample_grid(microtin_surface* surface, const microtin_grid* grid,
                                             double* heights) {
  return guarded([&] {
    expect(surface);
    expect(grid);
    expect(heights);
    surface->surface.heights({grid->columns, grid->rows, grid->x, grid->y},
                             {0, 0, grid->columns, grid->rows}, heights);
  });
}
