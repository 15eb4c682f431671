// SPDX-License-Identifier: MIT
// Lays out posts as the firmware will look for them: by its arithmetic, rounded as there, not by
// that of the ellipsoid. A block's corner that is five centimetres off is refused by ArduPilot.
//
// Sources: ArduPilot's libraries/AP_Terrain (AP_Terrain.h, TerrainUtil.cpp, TerrainIO.cpp,
// tools/create_terrain.py) and AP_Common/Location.cpp; INAV's src/main/terrain (terrain_location.c,
// terrain_utils.c, terrain_io.c) and inav-configurator's pull request 2708.
#include "encoder/export/autopilot.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <string_view>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/lattice_map.hpp"

namespace microtin::exporting {
namespace {

// Posts of a block, north and east; those from one block to the next: the others repeat its
// neighbours. A bit tells of a group of 4 x 4 whether it is there.
constexpr uint32_t kRows = 28, kColumns = 32, kOwnRows = 24, kOwnColumns = 28, kGroup = 4;
constexpr uint32_t kGroupColumns = kColumns / kGroup, kGroups = kRows / kGroup * kGroupColumns;
constexpr size_t kBlockBytes = 2048, kHeights = 22;
constexpr int64_t kDegree = 10000000;  // places are in 1e-7 degrees

constexpr double kMetres = 0.011131884502145034F, kPerMetre = 89.83204953368922F;

bool are_digits(std::string_view text) {
  return text.find_first_not_of("0123456789") == std::string_view::npos;
}

// How much shorter a degree of longitude is, in single precision as there.
double longitude_scale(double latitude) {
  constexpr double kRadian = 0.017453292519943295;
  const auto angle = static_cast<float>(latitude * 1e-7 * kRadian);
  return std::max(static_cast<double>(static_cast<float>(std::cos(static_cast<double>(angle)))),
                  0.01);
}

struct GeoPlace {
  int64_t latitude, longitude;
};

// Where the posts of a cell are. Rows and columns count from its south-west corner.
class Layout {
 public:
  Layout(Autopilot autopilot, DegreeCell cell, uint32_t spacing)
      : autopilot_(autopilot),
        cell_(cell),
        origin_{cell.latitude * kDegree, cell.longitude * kDegree},
        spacing_(spacing),
        block_columns_(block_columns()) {
    while (north_of(block_rows_ * kOwnRows) < kDegree) ++block_rows_;
  }

  Autopilot autopilot() const { return autopilot_; }
  DegreeCell cell() const { return cell_; }
  uint32_t spacing() const { return spacing_; }
  uint32_t block_rows_count() const { return block_rows_; }
  uint32_t block_columns_count() const { return block_columns_; }
  uint32_t rows() const { return (block_rows_ - 1) * kOwnRows + kRows; }
  uint32_t columns() const { return (block_columns_ - 1) * kOwnColumns + kColumns; }
  GeoPlace origin() const { return origin_; }

  // Where the firmware looks for a post's height: by the longitude's scale halfway to the post or,
  // in INAV, at the post itself.
  GeoPlace post(uint32_t row, uint32_t column) const {
    const int64_t north = north_of(row);
    const double along = autopilot_ == Autopilot::kInav ? 1 : 0.5;
    return place(north, column, longitude_scale(latitude(static_cast<double>(north) * along)));
  }

  // What a block's header says. Both have the scale halfway.
  GeoPlace corner(uint32_t block_row, uint32_t block_column) const {
    const int64_t north = north_of(block_row * kOwnRows);
    return place(north, block_column * kOwnColumns,
                 longitude_scale(latitude(static_cast<double>(north) * 0.5)));
  }

  // Rows and columns from the corner to a place, as the firmware counts.
  void locate(double latitude_there, double longitude, double* row, double* column) const {
    const double north = latitude_there - static_cast<double>(origin_.latitude);
    const double along = autopilot_ == Autopilot::kInav ? 1 : 0.5;
    *row = north * kMetres / spacing_;
    *column = (longitude - static_cast<double>(origin_.longitude)) * kMetres *
              longitude_scale(latitude(north * along)) / spacing_;
  }

 private:
  double latitude(double north) const { return static_cast<double>(origin_.latitude) + north; }

  int64_t north_of(uint32_t row) const {
    return static_cast<int64_t>(static_cast<double>(row) * spacing_ * kPerMetre);
  }

  GeoPlace place(int64_t north, uint32_t column, double scale) const {
    const auto east =
        static_cast<int64_t>(static_cast<double>(column) * spacing_ * kPerMetre / scale);
    return {origin_.latitude + north, origin_.longitude + east};
  }

  // Blocks in a row of the file: those that a degree takes at the cell's south, and two more.
  uint32_t block_columns() const {
    const double scale = longitude_scale(static_cast<double>(origin_.latitude));
    const double more = 2.0 * spacing_ * kColumns;
    const double east =
        autopilot_ == Autopilot::kInav ? more / (111319.5 * scale) * 1e7 : more * kPerMetre / scale;
    const double metres = (kDegree + std::trunc(east)) * kMetres * scale;
    return static_cast<uint32_t>(metres / (spacing_ * kOwnColumns));
  }

  Autopilot autopilot_;
  DegreeCell cell_;
  GeoPlace origin_;
  uint32_t spacing_;
  uint32_t block_columns_, block_rows_ = 0;
};

// A lattice's axis and places in 1e-7 degrees.
class GeoAxis {
 public:
  GeoAxis(const Axis& axis, int64_t low, int64_t high)
      : axis_(axis), low_(low * 256), high_(high * 256) {}

  // With 8 fractional bits, kept within the surface. Nothing if it is farther away than that.
  std::optional<int64_t> inside(int64_t degrees, double most_beyond, bool* is_beyond) const {
    const Wide numerator =
        Wide{degrees} * static_cast<Wide>(axis_.denominator) - Wide{axis_.offset} * kDegree;
    const Wide denominator = static_cast<Wide>(axis_.numerator) * kDegree;
    const Wide place = round_divide(256 * numerator, denominator);
    const Wide kept = std::clamp<Wide>(place, low_, high_);
    if (kept == place) return static_cast<int64_t>(kept);
    *is_beyond = true;
    const double beyond = std::abs(static_cast<double>(place - kept)) / 256 * step_of(axis_);
    if (beyond * 1e7 > most_beyond) return std::nullopt;
    return static_cast<int64_t>(kept);
  }

  double degrees(int64_t lattice) const {
    return (offset_of(axis_) + step_of(axis_) * static_cast<double>(lattice)) * 1e7;
  }

 private:
  Axis axis_;
  int64_t low_, high_;
};

constexpr int32_t kNoHeight = std::numeric_limits<int32_t>::min();

int32_t millimetres(int32_t height, const Axis& z) {
  const Wide numerator = Wide{z.offset} * 65536 + static_cast<Wide>(z.numerator) * height;
  const Wide rounded = round_divide(numerator * 1000, static_cast<Wide>(z.denominator) * 65536);
  if (rounded < -32768000 || rounded > 32767000) {
    throw Error("a height of " + std::to_string(static_cast<int64_t>(rounded / 1000)) +
                " m does not fit 16 bits");
  }
  return static_cast<int32_t>(rounded);
}

// Heights of all posts, in millimetres, row by row.
struct Posts {
  std::vector<int32_t> heights;
  uint64_t beyond = 0, known = 0;
};

Posts posts_of(const SampledSurface& surface, const Layout& layout) {
  const GeoAxis x(surface.placement.x, surface.x_min, surface.x_max),
      y(surface.placement.y, surface.y_min, surface.y_max);
  // A place in the cell's last group is between posts of which some lie beyond its edge.
  const double reach = kGroup * layout.spacing() * kPerMetre;
  Posts posts;
  posts.heights.assign(size_t{layout.rows()} * layout.columns(), kNoHeight);
  for (uint32_t row = layout.rows(); row-- > 0;) {
    for (uint32_t column = 0; column < layout.columns(); ++column) {
      const GeoPlace at = layout.post(row, column);
      const double scale = longitude_scale(static_cast<double>(at.latitude));
      bool is_beyond = false;
      const auto lattice_y = y.inside(at.latitude, reach, &is_beyond);
      const auto lattice_x = x.inside(at.longitude, reach / scale, &is_beyond);
      if (!lattice_x || !lattice_y) continue;
      const auto height = surface.height_at(*lattice_x, *lattice_y);
      if (!height) continue;
      posts.heights[size_t{row} * layout.columns() + column] =
          millimetres(*height, surface.placement.z);
      ++posts.known;
      posts.beyond += is_beyond ? 1u : 0u;
    }
  }
  return posts;
}

void put(uint8_t* at, uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) at[i] = static_cast<uint8_t>(value >> 8 * i);
}

uint64_t take(const uint8_t* at, int bytes) {
  uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value |= uint64_t{at[i]} << 8 * i;
  return value;
}

// CRC-16/XMODEM: polynomial 1021, from 0, no reflection.
uint16_t crc16(const uint8_t* bytes, size_t size) {
  uint32_t crc = 0;
  for (size_t i = 0; i < size; ++i) {
    crc ^= static_cast<uint32_t>(bytes[i]) << 8;
    for (int bit = 0; bit < 8; ++bit) crc = crc << 1 ^ ((crc & 0x8000) != 0 ? 0x11021 : 0);
  }
  return static_cast<uint16_t>(crc);
}

// One block of a file.
class Block {
 public:
  Block(const Layout& layout, uint32_t row, uint32_t column, uint8_t* bytes)
      : layout_(layout), row_(row), column_(column), bytes_(bytes) {}

  uint64_t groups() const { return take(bytes_, 8); }
  static bool has_post(uint64_t groups, uint32_t row, uint32_t column) {
    return (groups >> (row / kGroup * kGroupColumns + column / kGroup) & 1) != 0;
  }

  // In metres, as the firmware reads it.
  int32_t height(uint32_t row, uint32_t column) const {
    const uint32_t post = row * kColumns + column;
    if (layout_.autopilot() == Autopilot::kArduPilot) {
      return static_cast<int16_t>(take(bytes_ + kHeights + 2 * size_t{post}, 2));
    }
    const uint32_t bit = 10 * post;
    const auto offset =
        static_cast<int32_t>(take(bytes_ + kHeights + bit / 8, 2) >> bit % 8 & 1023);
    return static_cast<int16_t>(take(bytes_ + kBase, 2)) + 2 * offset;
  }

  // Leaves zeros if no group is known.
  void write(const Posts& posts) {
    uint64_t groups = 0;
    for (uint32_t group = 0; group < kGroups; ++group) {
      if (is_known(posts, group)) groups |= uint64_t{1} << group;
    }
    if (groups == 0) return;
    const bool is_inav = layout_.autopilot() == Autopilot::kInav;
    write_header(groups, is_inav ? kInavVersion : 1);
    if (is_inav) {
      write_offsets(posts, groups);
    } else {
      write_heights(posts, groups);
    }
    const size_t end = is_inav ? kInavTrailer : kArduPilotTrailer;
    write_trailer(bytes_ + end);
    // Of ArduPilot's block, what the check does not cover: below 1 it warns of old data, and does
    // not arm.
    if (!is_inav) bytes_[kArduPilotTrailer + kTrailerBytes] = 1;
    put(bytes_ + kCheck, crc16(bytes_, end + kTrailerBytes), 2);
  }

 private:
  static constexpr size_t kCheck = 16, kBase = 1142, kInavTrailer = 1144;
  static constexpr size_t kArduPilotTrailer = 1814, kTrailerBytes = 7;
  static constexpr uint64_t kInavVersion = 50;

  int32_t post(const Posts& posts, uint32_t row, uint32_t column) const {
    const size_t first = size_t{row_} * kOwnRows + row;
    return posts.heights[first * layout_.columns() + column_ * kOwnColumns + column];
  }

  bool is_known(const Posts& posts, uint32_t group) const {
    const uint32_t row = group / kGroupColumns * kGroup, column = group % kGroupColumns * kGroup;
    for (uint32_t i = 0; i < kGroup * kGroup; ++i) {
      if (post(posts, row + i / kGroup, column + i % kGroup) == kNoHeight) return false;
    }
    return true;
  }

  // Calls visit(post's number in the block, millimetres) for each that is there.
  template <class Visit>
  void for_each(const Posts& posts, uint64_t groups, const Visit& visit) const {
    for (uint32_t row = 0; row < kRows; ++row) {
      for (uint32_t column = 0; column < kColumns; ++column) {
        if (has_post(groups, row, column)) visit(row * kColumns + column, post(posts, row, column));
      }
    }
  }

  void write_header(uint64_t groups, uint64_t version) {
    const GeoPlace corner = layout_.corner(row_, column_);
    put(bytes_, groups, 8);
    put(bytes_ + 8, static_cast<uint64_t>(corner.latitude), 4);
    put(bytes_ + 12, static_cast<uint64_t>(corner.longitude), 4);
    put(bytes_ + 18, version, 2);
    put(bytes_ + 20, layout_.spacing(), 2);
  }

  void write_trailer(uint8_t* at) const {
    put(at, row_, 2);
    put(at + 2, column_, 2);
    put(at + 4, static_cast<uint64_t>(layout_.cell().longitude), 2);
    put(at + 6, static_cast<uint64_t>(layout_.cell().latitude), 1);
  }

  void write_heights(const Posts& posts, uint64_t groups) {
    for_each(posts, groups, [&](uint32_t post, int32_t height) {
      put(bytes_ + kHeights + 2 * size_t{post},
          static_cast<uint64_t>(round_divide(Wide{height}, Wide{1000})), 2);
    });
  }

  void write_offsets(const Posts& posts, uint64_t groups) {
    int32_t lowest = std::numeric_limits<int32_t>::max(), highest = kNoHeight;
    for_each(posts, groups, [&](uint32_t, int32_t height) {
      lowest = std::min(lowest, height);
      highest = std::max(highest, height);
    });
    const auto base = static_cast<int32_t>(round_divide(Wide{lowest}, Wide{1000}));
    const auto steps = [base](int32_t height) {
      return static_cast<int64_t>(round_divide(Wide{height} - Wide{base} * 1000, Wide{2000}));
    };
    if (steps(highest) > 1023) refuse(lowest, highest);
    for_each(posts, groups, [&](uint32_t post, int32_t height) {
      const size_t bit = 10 * size_t{post};
      uint8_t* const at = bytes_ + kHeights + bit / 8;
      put(at, take(at, 2) | static_cast<uint64_t>(std::max<int64_t>(steps(height), 0)) << bit % 8,
          2);
    });
    put(bytes_ + kBase, static_cast<uint64_t>(base), 2);
  }

  [[noreturn]] void refuse(int32_t lowest, int32_t highest) const {
    const GeoPlace corner = layout_.corner(row_, column_);
    throw Error("from " + std::to_string(lowest / 1000) + " m to " +
                std::to_string(highest / 1000) + " m in the block at " +
                std::to_string(static_cast<double>(corner.latitude) * 1e-7) + ", " +
                std::to_string(static_cast<double>(corner.longitude) * 1e-7) +
                ": ten bits of 2 m hold 2046 m");
  }

  const Layout& layout_;
  uint32_t row_, column_;
  uint8_t* bytes_;
};

// The height at a place in metres, as the firmware finds it; nothing if a post of four is missing.
std::optional<double> grid_height(const Layout& layout, std::vector<uint8_t>& bytes,
                                  double latitude, double longitude) {
  double north = 0, east = 0;
  layout.locate(latitude, longitude, &north, &east);
  if (north < 0 || east < 0) return std::nullopt;
  const auto row = static_cast<uint32_t>(north), column = static_cast<uint32_t>(east);
  const uint32_t block_row = row / kOwnRows, block_column = column / kOwnColumns;
  if (block_row >= layout.block_rows_count() || block_column >= layout.block_columns_count()) {
    return std::nullopt;
  }
  const size_t number = size_t{block_row} * layout.block_columns_count() + block_column;
  const Block block(layout, block_row, block_column, bytes.data() + number * kBlockBytes);
  const uint64_t groups = block.groups();
  const uint32_t r = row % kOwnRows, c = column % kOwnColumns;
  double corner[4];
  for (uint32_t i = 0; i < 4; ++i) {
    if (!Block::has_post(groups, r + i / 2, c + i % 2)) return std::nullopt;
    corner[i] = block.height(r + i / 2, c + i % 2);
  }
  const double v = north - row, u = east - column;
  return (corner[0] * (1 - u) + corner[1] * u) * (1 - v) +
         (corner[2] * (1 - u) + corner[3] * u) * v;
}

// Compares at the lattice's places in the cell, or at evenly chosen ones of very many.
void measure(const SampledSurface& surface, const Layout& layout, AutopilotFile& file) {
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
      const auto found = grid_height(layout, file.bytes, latitude, longitude);
      const auto height = found ? surface.height_at(column * 256, row * 256) : std::nullopt;
      if (!height) continue;
      const double there = offset_of(z) + step_of(z) * *height / 65536, error = *found - there;
      ++file.places;
      squares += error * error;
      file.largest = std::max(file.largest, std::abs(error));
    }
  }
  if (file.places != 0) file.rms = std::sqrt(squares / static_cast<double>(file.places));
}

std::string upper_case(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

}  // namespace

std::optional<Autopilot> autopilot_of(const std::string& path) {
  const std::string suffix = upper_case(std::filesystem::path(path).extension().string());
  if (suffix == ".DAT") return Autopilot::kArduPilot;
  if (suffix == ".TER") return Autopilot::kInav;
  return std::nullopt;
}

DegreeCell cell_of(const std::string& path) {
  const std::string name = upper_case(std::filesystem::path(path).stem().string());
  const bool has_form = name.size() == 7 && (name[0] == 'N' || name[0] == 'S') &&
                        (name[3] == 'E' || name[3] == 'W') && are_digits(name.substr(1, 2)) &&
                        are_digits(name.substr(4));
  if (has_form) {
    const int latitude = std::stoi(name.substr(1, 2)) * (name[0] == 'S' ? -1 : 1);
    const int longitude = std::stoi(name.substr(4)) * (name[3] == 'W' ? -1 : 1);
    if (latitude >= -90 && latitude < 90 && longitude >= -180 && longitude < 180) {
      return {latitude, longitude};
    }
  }
  throw Error(path + ": the name must be that of a cell, such as N43E007");
}

AutopilotFile autopilot_file(const SampledSurface& surface, Autopilot autopilot, DegreeCell cell,
                             uint32_t spacing) {
  const Layout layout(autopilot, cell, spacing);
  const Posts posts = posts_of(surface, layout);
  AutopilotFile file;
  file.beyond = posts.beyond;
  file.bytes.resize(size_t{layout.block_rows_count()} * layout.block_columns_count() * kBlockBytes);
  uint8_t* at = file.bytes.data();
  for (uint32_t row = 0; row < layout.block_rows_count(); ++row) {
    for (uint32_t column = 0; column < layout.block_columns_count(); ++column, at += kBlockBytes) {
      Block block(layout, row, column, at);
      block.write(posts);
      constexpr uint64_t kAll = (uint64_t{1} << kGroups) - 1;
      file.empty += block.groups() == 0 ? 1u : 0u;
      file.blocks += block.groups() != 0 ? 1u : 0u;
      file.partial += block.groups() != 0 && block.groups() != kAll ? 1u : 0u;
    }
  }
  if (file.blocks == 0) throw Error("the terrain has no height in the cell");
  measure(surface, layout, file);
  return file;
}

}  // namespace microtin::exporting
