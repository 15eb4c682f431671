// SPDX-License-Identifier: MIT
#include "encoder/export/autopilot_layout.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace microtin::exporting {
namespace {

constexpr double kMetres = 0.011131884502145034F;  // in 1e-7 degrees of a meridian

// As longitude_scale, all in single precision.
float single_scale(int64_t latitude) {
  constexpr float kRadian = 1.0e-7F * 0.01745329252F;
  return std::max(std::cos(static_cast<float>(latitude) * kRadian), 0.01F);
}

}  // namespace

double longitude_scale(double latitude) {
  constexpr double kRadian = 0.017453292519943295;
  const auto angle = static_cast<float>(latitude * 1e-7 * kRadian);
  return std::max(static_cast<double>(static_cast<float>(std::cos(static_cast<double>(angle)))),
                  0.01);
}

AutopilotLayout::AutopilotLayout(Autopilot autopilot, DegreeCell cell, uint32_t spacing)
    : autopilot_(autopilot),
      cell_(cell),
      origin_{cell.latitude * kDegree, cell.longitude * kDegree},
      spacing_(spacing),
      block_columns_(columns_of_blocks()) {
  while (north_of(block_rows_ * kOwnRows) < kDegree) ++block_rows_;
}

AutopilotLayout::Row AutopilotLayout::row(uint32_t row) const {
  const int64_t north = north_of(row);
  return {origin_.latitude + north, scale_on_the_way(static_cast<double>(north))};
}

int64_t AutopilotLayout::longitude(const Row& row, uint32_t column) const {
  return origin_.longitude +
         static_cast<int64_t>(static_cast<double>(column) * spacing_ * kPerMetre / row.scale);
}

GeoPlace AutopilotLayout::corner(uint32_t block_row, uint32_t block_column) const {
  const int64_t north = north_of(block_row * kOwnRows);
  const Row row{origin_.latitude + north,
                longitude_scale(latitude_at(static_cast<double>(north) * 0.5))};
  return {row.latitude, longitude(row, block_column * kOwnColumns)};
}

void AutopilotLayout::locate(double latitude, double longitude, double* row, double* column) const {
  const double north = latitude - static_cast<double>(origin_.latitude);
  *row = north * kMetres / spacing_;
  *column = (longitude - static_cast<double>(origin_.longitude)) * kMetres *
            scale_on_the_way(north) / spacing_;
}

GeoPlace AutopilotLayout::single_corner(uint32_t block_row, uint32_t block_column) const {
  const auto inverse = static_cast<float>(kPerMetre);
  const auto north =
      static_cast<int64_t>(static_cast<float>(block_row * kOwnRows * spacing_) * inverse);
  const auto east = static_cast<int64_t>(static_cast<float>(block_column * kOwnColumns * spacing_) *
                                         inverse / single_scale(origin_.latitude + north / 2));
  return {north, east};
}

bool AutopilotLayout::is_found_in_single_precision(GeoPlace place) const {
  constexpr int64_t kTolerance = 5;  // ArduPilot's; INAV's is larger
  const auto metres = static_cast<float>(kMetres), step = static_cast<float>(spacing_);
  const int64_t up = place.latitude - origin_.latitude;
  const int64_t middle =
      autopilot_ == Autopilot::kInav ? place.latitude : origin_.latitude + up / 2;
  const float north = static_cast<float>(up) * metres;
  const float east =
      static_cast<float>(place.longitude - origin_.longitude) * metres * single_scale(middle);
  const uint32_t row = static_cast<uint32_t>(north / step) / kOwnRows;
  const uint32_t column = static_cast<uint32_t>(east / step) / kOwnColumns;
  if (row >= block_rows_ || column >= block_columns_) return false;
  const GeoPlace written = corner(row, column), expected = single_corner(row, column);
  return std::abs(written.latitude - origin_.latitude - expected.latitude) <= kTolerance &&
         std::abs(written.longitude - origin_.longitude - expected.longitude) <= kTolerance;
}

double AutopilotLayout::scale_on_the_way(double north) const {
  return longitude_scale(latitude_at(north * (autopilot_ == Autopilot::kInav ? 1 : 0.5)));
}

int64_t AutopilotLayout::north_of(uint32_t row) const {
  return static_cast<int64_t>(static_cast<double>(row) * spacing_ * kPerMetre);
}

// Blocks in a row of the file: those that a degree takes at the cell's south, and two more.
uint32_t AutopilotLayout::columns_of_blocks() const {
  const double scale = longitude_scale(static_cast<double>(origin_.latitude));
  const double more = 2.0 * spacing_ * kBlockColumns;
  const double east =
      autopilot_ == Autopilot::kInav ? more / (111319.5 * scale) * 1e7 : more * kPerMetre / scale;
  const double metres = (kDegree + std::trunc(east)) * kMetres * scale;
  return static_cast<uint32_t>(metres / (spacing_ * kOwnColumns));
}

}  // namespace microtin::exporting
