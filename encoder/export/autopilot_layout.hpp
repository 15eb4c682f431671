// SPDX-License-Identifier: MIT
// Where autopilots look for the posts of their terrain files: by the firmware's arithmetic, rounded
// as there, not by that of the ellipsoid. A block's corner that is five centimetres off is refused
// by ArduPilot.
//
// Sources: ArduPilot's libraries/AP_Terrain (AP_Terrain.h, TerrainUtil.cpp, TerrainIO.cpp,
// tools/create_terrain.py) and AP_Common/Location.cpp; INAV's src/main/terrain (terrain_location.c,
// terrain_utils.c, terrain_io.c) and inav-configurator's pull request 2708.
#ifndef MICROTIN_ENCODER_EXPORT_AUTOPILOT_LAYOUT_HPP
#define MICROTIN_ENCODER_EXPORT_AUTOPILOT_LAYOUT_HPP

#include <cstdint>

#include "encoder/layers.hpp"
#include "encoder/terrain/degree_cell.hpp"

namespace microtin::exporting {

enum class Autopilot { kArduPilot, kInav };

// Posts of a block, north and east; those from one block to the next: the others repeat its
// neighbours.
constexpr uint32_t kBlockRows = 28, kBlockColumns = 32, kOwnRows = 24, kOwnColumns = 28;

// Places are in 1e-7 degrees.
struct GeoPlace {
  int64_t latitude, longitude;
};

constexpr int64_t kDegree = 10000000;

// Degrees' 1e-7 along a meridian, as both firmwares have it.
constexpr double kPerMetre = 89.83204953368922F;

// How much shorter a degree of longitude is, in single precision as there.
double longitude_scale(double latitude);

// Rows and columns of posts count from the cell's south-west corner, `spacing` metres apart.
class AutopilotLayout {
 public:
  AutopilotLayout(Autopilot autopilot, DegreeCell cell, uint32_t spacing);

  Autopilot autopilot() const { return autopilot_; }
  DegreeCell cell() const { return cell_; }
  uint32_t spacing() const { return spacing_; }
  uint32_t block_rows() const { return block_rows_; }
  uint32_t block_columns() const { return block_columns_; }
  uint32_t rows() const { return (block_rows_ - 1) * kOwnRows + kBlockRows; }
  uint32_t columns() const { return (block_columns_ - 1) * kOwnColumns + kBlockColumns; }
  GeoPlace origin() const { return origin_; }

  // Where the firmware looks for the heights of a row of posts.
  struct Row {
    int64_t latitude;
    double scale;  // of longitude: halfway to the row or, in INAV, at the row itself
  };
  Row row(uint32_t row) const;
  int64_t longitude(const Row& row, uint32_t column) const;

  // What a block's header says. Both have the scale halfway.
  GeoPlace corner(uint32_t block_row, uint32_t block_column) const;

  // Rows and columns from the corner to a place, as the firmware counts.
  void locate(double latitude, double longitude, double* row, double* column) const;

  // Whether firmware that computes in single precision finds a block for a place in the cell, and
  // takes its corner for right: near the poles its roundings move places into other columns and
  // corners out of tolerance.
  bool is_found_in_single_precision(GeoPlace place) const;

 private:
  // A corner's distance from the cell's, as such firmware expects it.
  GeoPlace single_corner(uint32_t block_row, uint32_t block_column) const;
  double latitude_at(double north) const { return static_cast<double>(origin_.latitude) + north; }
  double scale_on_the_way(double north) const;
  int64_t north_of(uint32_t row) const;
  uint32_t columns_of_blocks() const;

  Autopilot autopilot_;
  DegreeCell cell_;
  GeoPlace origin_;
  uint32_t spacing_;
  uint32_t block_columns_, block_rows_ = 0;
};

}  // namespace microtin::exporting

#endif
