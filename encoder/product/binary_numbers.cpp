// SPDX-License-Identifier: MIT
// Arrays of binary numbers, as other programs hold them, become exact posts and points.
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/import/raster.hpp"
#include "encoder/import/text.hpp"
#include "microtin/encoder.hpp"

namespace microtin::encoder {
namespace {

using base::Error;

microtin_axis centres(double corner, double size, uint32_t cells) {
  return base::with_file_context(
      "transform", [&] { return importing::axis_of_cells_from(corner, size, cells); });
}

template <class Number>
RasterData binary_posts(uint32_t columns, uint32_t rows, const Number* heights, const Transform& t,
                        double no_data) {
  if (!runs_east(t)) {
    throw Error(
        "transform: columns must run east and rows north or south: WEST, WIDTH, 0, NORTH, 0, "
        "-HEIGHT, GDAL's order");
  }
  const importing::NoData voids(no_data);
  importing::DecimalColumn numbers;
  numbers.reserve(size_t{columns} * rows);
  for (uint32_t i = 0; i < rows; ++i) {
    const uint32_t row = t[5] < 0 ? rows - 1 - i : i;
    for (uint32_t column = 0; column < columns; ++column) {
      const Number value = heights[size_t{row} * columns + column];
      if (voids.marks(value)) {
        numbers.add_void();
        continue;
      }
      const auto decimal = exact::shortest_decimal(value);
      if (!decimal || !numbers.add(*decimal)) {
        throw Error("row " + std::to_string(row) + ", column " + std::to_string(column) + ": " +
                    importing::not_a_height(value));
      }
    }
  }
  RasterData posts;
  posts.columns = columns;
  posts.rows = rows;
  posts.decimals = numbers.decimals();
  posts.heights = std::move(numbers.mantissas());
  posts.x = centres(t[0], t[1], columns);
  posts.y = centres(t[3], t[5], rows);
  return posts;
}

}  // namespace

bool runs_east(const Transform& transform) {
  return importing::runs_east(transform);
}

bool can_hold(uint64_t bytes, uint32_t columns, uint32_t rows) {
  return importing::can_hold(bytes, columns, rows);
}

RasterData raster_from_cells(uint32_t columns, uint32_t rows, const float* heights,
                             const Transform& transform, double no_data) {
  return binary_posts(columns, rows, heights, transform, no_data);
}

RasterData raster_from_cells(uint32_t columns, uint32_t rows, const double* heights,
                             const Transform& transform, double no_data) {
  return binary_posts(columns, rows, heights, transform, no_data);
}

PointCloudData point_cloud_from_xyz(uint64_t count, const double* coordinates) {
  importing::PointColumns columns;
  for (uint64_t i = 0; i < 3 * count; ++i) {
    const auto decimal = exact::shortest_decimal(coordinates[i]);
    if (!decimal || !columns.add(i % 3, *decimal)) {
      throw Error("point " + std::to_string(i / 3) + ": is not a number in range");
    }
  }
  const terrain::PointCloud cloud = columns.take();
  PointCloudData points;
  points.xy_decimals = cloud.xy_decimals;
  points.z_decimals = cloud.z_decimals;
  points.points.reserve(cloud.points.size());
  for (const auto& [x, y, z] : cloud.points) points.points.push_back({x, y, z});
  return points;
}

}  // namespace microtin::encoder
