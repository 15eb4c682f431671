// SPDX-License-Identifier: MIT
// The terrain files of autopilots: ArduPilot's .DAT and INAV's .TER, a degree by a degree each.
#ifndef MICROTIN_ENCODER_EXPORT_AUTOPILOT_HPP
#define MICROTIN_ENCODER_EXPORT_AUTOPILOT_HPP

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "encoder/export/queries.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/degrees.hpp"

namespace microtin::exporting {

// Where autopilots look for the posts of their terrain files: by the firmware's arithmetic, rounded
// as there, not by that of the ellipsoid. A block's corner that is five centimetres off is refused
// by ArduPilot.
//
// Sources: ArduPilot's libraries/AP_Terrain (AP_Terrain.h, TerrainUtil.cpp, TerrainIO.cpp,
// tools/create_terrain.py) and AP_Common/Location.cpp; INAV's src/main/terrain (terrain_location.c,
// terrain_utils.c, terrain_io.c) and inav-configurator's pull request 2708.

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

// The blocks of autopilots' terrain files, 2,048 bytes each.

// Heights of all posts of a layout, in millimetres, row by row.
struct AutopilotPosts {
  std::vector<int32_t> heights;
  uint64_t beyond = 0;  // beyond the terrain's edge, with the height there
};

constexpr int32_t kNoHeight = std::numeric_limits<int32_t>::min();

// One block of a file, in the caller's bytes.
class AutopilotBlock {
 public:
  static constexpr size_t kBytes = 2048;

  // A bit for each group of 4 x 4 posts: whether it is there.
  static constexpr uint32_t kGroup = 4, kGroupColumns = kBlockColumns / kGroup;
  static constexpr uint32_t kGroups = kBlockRows / kGroup * kGroupColumns;
  static constexpr uint64_t kAllGroups = (uint64_t{1} << kGroups) - 1;

  AutopilotBlock(const AutopilotLayout& layout, uint32_t row, uint32_t column, uint8_t* bytes)
      : layout_(layout), row_(row), column_(column), bytes_(bytes) {}

  uint64_t groups() const;
  static bool has_post(uint64_t groups, uint32_t row, uint32_t column) {
    return (groups >> (row / kGroup * kGroupColumns + column / kGroup) & 1) != 0;
  }

  // In metres, as the firmware reads it.
  int32_t height(uint32_t row, uint32_t column) const;

  // Leaves zeros if no group is known. Throws Error where INAV's ten bits do not hold the heights.
  void write(const AutopilotPosts& posts);

 private:
  int32_t post(const AutopilotPosts& posts, uint32_t row, uint32_t column) const;
  bool is_known(const AutopilotPosts& posts, uint32_t group) const;
  template <class Visit>
  void for_each(const AutopilotPosts& posts, uint64_t groups, const Visit& visit) const;
  void write_header(uint64_t groups, uint64_t version);
  void write_trailer(uint8_t* at) const;
  void write_heights(const AutopilotPosts& posts, uint64_t groups);
  void write_offsets(const AutopilotPosts& posts, uint64_t groups);
  [[noreturn]] void refuse(int32_t lowest, int32_t highest) const;

  const AutopilotLayout& layout_;
  uint32_t row_, column_;
  uint8_t* bytes_;
};

// Writing the terrain files of autopilots: ArduPilot's .DAT and INAV's .TER, a degree by a degree
// each.

// By the suffix, .DAT or .TER; nothing for others.
std::optional<Autopilot> autopilot_of(const std::string& path);

// Metres between the posts that firmware expects if nothing else is set.
constexpr uint32_t kArduPilotSpacing = 100, kInavSpacing = 30;

struct AutopilotFile {
  std::vector<uint8_t> bytes;
  uint64_t blocks = 0;   // that hold heights
  uint64_t partial = 0;  // of these: groups of 4 x 4 posts without all heights are marked missing
  uint64_t empty = 0;    // all zero, which firmware takes for a block that it does not have
  uint64_t beyond = 0;   // posts beyond the terrain's edge that have the height there

  // What the grid, read as the firmware does, is away from the surface; metres.
  uint64_t places = 0;  // of the lattice that were looked at
  double largest = 0, rms = 0;

  // Places of the lattice with terrain, and those of them that firmware in single precision misses.
  uint64_t queried = 0, missed = 0;
};

// The surface as posts every `spacing` (10 .. 1000) metres. Its places must be in degrees, its
// heights in metres. Throws Error at the poles, where firmware's distances are not those of the
// file, if the surface has no height in the cell, where heights do not fit 16 bits or, in a block
// of INAV's, 10 bits of 2 m above the lowest, and as the surface does.
AutopilotFile autopilot_file(const SampledSurface& surface, Autopilot autopilot, DegreeCell cell,
                             uint32_t spacing);

}  // namespace microtin::exporting

#endif
