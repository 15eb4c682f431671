// SPDX-License-Identifier: MIT
#include "encoder/export/autopilot.hpp"

#include <algorithm>
#include <cmath>

#include "encoder/base/error.hpp"
#include "encoder/base/suffix.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/exact/real_place.hpp"
#include "encoder/export/autopilot_block.hpp"

namespace microtin::exporting {
namespace {

// A lattice's axis and places in 1e-7 degrees.
class GeoAxis {
 public:
  GeoAxis(const Axis& axis, int64_t low, int64_t high)
      : axis_(axis), map_(map_between({0, 1, kDegree}, axis)), low_(low), high_(high) {}

  // The lattice coordinate, kept within the surface. Nothing if it is farther away than that.
  std::optional<RealCoordinate> inside(int64_t degrees, double most_beyond, bool* is_beyond) const {
    const Wide place = map_.numerator(degrees),
               kept = std::clamp(place, low_ * map_.step, high_ * map_.step);
    if (kept == place) return coordinate_of(map_, degrees, axis_);
    *is_beyond = true;
    const double beyond =
        std::abs(static_cast<double>(place - kept) / static_cast<double>(map_.step));
    if (beyond * step_of(axis_) * 1e7 > most_beyond) return std::nullopt;
    return RealCoordinate{static_cast<int64_t>(kept / map_.step), 0, 1};
  }

  double degrees(int64_t lattice) const {
    return (offset_of(axis_) + step_of(axis_) * static_cast<double>(lattice)) * 1e7;
  }

 private:
  Axis axis_;
  LatticeMap map_;
  Wide low_, high_;
};

int32_t millimetres(const ExactHeight& height, const Axis& z) {
  const Wide rounded = rounded_mantissa(z, height, 3);
  if (rounded < -32768000 || rounded > 32767000) {
    throw Error("a height of " + std::to_string(static_cast<int64_t>(rounded / 1000)) +
                " m does not fit 16 bits");
  }
  return static_cast<int32_t>(rounded);
}

AutopilotPosts posts_of(const SampledSurface& surface, const AutopilotLayout& layout) {
  const GeoAxis x(surface.placement.x, surface.x_min, surface.x_max),
      y(surface.placement.y, surface.y_min, surface.y_max);
  // A place in the cell's last group is between posts of which some lie beyond its edge.
  const double reach = AutopilotBlock::kGroup * layout.spacing() * kPerMetre;
  AutopilotPosts posts;
  posts.heights.assign(size_t{layout.rows()} * layout.columns(), kNoHeight);
  for (uint32_t row = layout.rows(); row-- > 0;) {
    const AutopilotLayout::Row line = layout.row(row);
    bool is_row_beyond = false;
    const auto lattice_y = y.inside(line.latitude, reach, &is_row_beyond);
    if (!lattice_y) continue;
    const double reach_east = reach / longitude_scale(static_cast<double>(line.latitude));
    for (uint32_t column = 0; column < layout.columns(); ++column) {
      bool is_beyond = is_row_beyond;
      const auto lattice_x = x.inside(layout.longitude(line, column), reach_east, &is_beyond);
      if (!lattice_x) continue;
      const ExactAnswer answer = surface.height_at(place_of(*lattice_x, *lattice_y));
      if (answer.kind != MICROTIN_QUERY_OK) continue;
      posts.heights[size_t{row} * layout.columns() + column] =
          millimetres(answer.height, surface.placement.z);
      posts.beyond += is_beyond ? 1u : 0u;
    }
  }
  return posts;
}

// The surface by the longitudes of a cell: they may be a turn from its own.
SampledSurface named_as(DegreeCell cell, SampledSurface surface) {
  for (const Axis& name : names_of_x(surface.placement.x, surface.is_degrees)) {
    const GeoAxis x(name, surface.x_min, surface.x_max);
    if (x.degrees(surface.x_min) >= static_cast<double>((cell.longitude + 1) * kDegree) ||
        x.degrees(surface.x_max) <= static_cast<double>(cell.longitude * kDegree)) {
      continue;
    }
    surface.placement.x = name;
    break;
  }
  return surface;
}

// The height at a place in metres, as the firmware finds it; nothing if a post of four is missing.
std::optional<double> grid_height(const AutopilotLayout& layout, std::vector<uint8_t>& bytes,
                                  double latitude, double longitude) {
  double north = 0, east = 0;
  layout.locate(latitude, longitude, &north, &east);
  if (north < 0 || east < 0) return std::nullopt;
  const auto row = static_cast<uint32_t>(north), column = static_cast<uint32_t>(east);
  const uint32_t block_row = row / kOwnRows, block_column = column / kOwnColumns;
  if (block_row >= layout.block_rows() || block_column >= layout.block_columns()) {
    return std::nullopt;
  }
  const size_t number = size_t{block_row} * layout.block_columns() + block_column;
  const AutopilotBlock block(layout, block_row, block_column,
                             bytes.data() + number * AutopilotBlock::kBytes);
  const uint64_t groups = block.groups();
  const uint32_t r = row % kOwnRows, c = column % kOwnColumns;
  double corner[4];
  for (uint32_t i = 0; i < 4; ++i) {
    if (!AutopilotBlock::has_post(groups, r + i / 2, c + i % 2)) return std::nullopt;
    corner[i] = block.height(r + i / 2, c + i % 2);
  }
  const double v = north - row, u = east - column;
  return (corner[0] * (1 - u) + corner[1] * u) * (1 - v) +
         (corner[2] * (1 - u) + corner[3] * u) * v;
}

// Compares at the lattice's places in the cell, or at evenly chosen ones of very many.
void measure(const SampledSurface& surface, const AutopilotLayout& layout, AutopilotFile& file) {
  constexpr double kMostPlaces = 1 << 22;
  const GeoAxis x(surface.placement.x, surface.x_min, surface.x_max),
      y(surface.placement.y, surface.y_min, surface.y_max);
  const double area = static_cast<double>(surface.x_max - surface.x_min + 1) *
                      static_cast<double>(surface.y_max - surface.y_min + 1);
  const auto step = static_cast<int64_t>(std::ceil(std::max(1.0, std::sqrt(area / kMostPlaces))));
  const Axis& z = surface.placement.z;
  double squares = 0;
  for (int64_t row = surface.y_max; row >= surface.y_min; row -= step) {
    const double latitude = y.degrees(row);
    const auto origin = layout.origin();
    if (latitude < static_cast<double>(origin.latitude) ||
        latitude >= static_cast<double>(origin.latitude + kDegree)) {
      continue;
    }
    for (int64_t column = surface.x_min; column <= surface.x_max; column += step) {
      const double longitude = x.degrees(column);
      if (longitude >= static_cast<double>(origin.longitude + kDegree)) break;
      if (longitude < static_cast<double>(origin.longitude)) continue;
      const ExactAnswer answer = surface.height_at(place_on_lattice(column, row));
      if (answer.kind != MICROTIN_QUERY_OK) continue;
      ++file.asked;
      const GeoPlace place{std::llround(latitude), std::llround(longitude)};
      file.missed += layout.is_found_in_single_precision(place) ? 0u : 1u;
      const auto found = grid_height(layout, file.bytes, latitude, longitude);
      if (!found) continue;
      const double error = *found - real_height(z, answer.height);
      ++file.places;
      squares += error * error;
      file.largest = std::max(file.largest, std::abs(error));
    }
  }
  if (file.places != 0) file.rms = std::sqrt(squares / static_cast<double>(file.places));
}

}  // namespace

std::optional<Autopilot> autopilot_of(const std::string& path) {
  const std::string suffix = suffix_of(path);
  if (suffix == ".dat") return Autopilot::kArduPilot;
  if (suffix == ".ter") return Autopilot::kInav;
  return std::nullopt;
}

AutopilotFile autopilot_file(const SampledSurface& surface, Autopilot autopilot, DegreeCell cell,
                             uint32_t spacing) {
  const SampledSurface named = named_as(cell, surface);
  // From here on firmware takes the shortest degree of longitude that it knows for all of them.
  if (cell.latitude == -90 || cell.latitude == 89) {
    throw Error("firmware's distances end at 89.43 degrees: cells at the poles are not written");
  }
  const AutopilotLayout layout(autopilot, cell, spacing);
  const AutopilotPosts posts = posts_of(named, layout);
  AutopilotFile file;
  file.beyond = posts.beyond;
  file.bytes.resize(size_t{layout.block_rows()} * layout.block_columns() * AutopilotBlock::kBytes);
  uint8_t* at = file.bytes.data();
  for (uint32_t row = 0; row < layout.block_rows(); ++row) {
    for (uint32_t column = 0; column < layout.block_columns();
         ++column, at += AutopilotBlock::kBytes) {
      AutopilotBlock block(layout, row, column, at);
      block.write(posts);
      file.empty += block.groups() == 0 ? 1u : 0u;
      file.blocks += block.groups() != 0 ? 1u : 0u;
      file.partial += block.groups() != 0 && block.groups() != AutopilotBlock::kAllGroups ? 1u : 0u;
    }
  }
  if (file.blocks == 0) throw Error("the terrain has no height in the cell");
  measure(named, layout, file);
  return file;
}

}  // namespace microtin::exporting
