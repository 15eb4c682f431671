// SPDX-License-Identifier: MIT
// The public interface in C for streams and packs that are read.
#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "encoder/product/c_calls.hpp"
#include "microtin/profile.hpp"
#include "microtin/surface.hpp"

using namespace microtin::encoder;
using microtin::product::copy_decimal;
using microtin::product::expect;
using microtin::product::expect_struct;
using microtin::product::guarded;
using microtin::product::read_struct;
using microtin::product::text_of;
using microtin::product::write_struct;

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
