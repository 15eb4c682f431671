// SPDX-License-Identifier: MIT
// The terrain files of autopilots: ArduPilot's .DAT and INAV's .TER, a degree by a degree each.
#include "encoder/export/autopilot.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/exact/wide.hpp"

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

namespace {

// Where what is in a block.
constexpr size_t kCheck = 16, kHeights = 22, kBase = 1142, kInavTrailer = 1144;
constexpr size_t kArduPilotTrailer = 1814, kTrailerBytes = 7;
constexpr uint64_t kArduPilotVersion = 1, kInavVersion = 50;

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

}  // namespace

uint64_t AutopilotBlock::groups() const {
  return take(bytes_, 8);
}

int32_t AutopilotBlock::height(uint32_t row, uint32_t column) const {
  const uint32_t post = row * kBlockColumns + column;
  if (layout_.autopilot() == Autopilot::kArduPilot) {
    return static_cast<int16_t>(take(bytes_ + kHeights + 2 * size_t{post}, 2));
  }
  const uint32_t bit = 10 * post;
  const auto offset = static_cast<int32_t>(take(bytes_ + kHeights + bit / 8, 2) >> bit % 8 & 1023);
  return static_cast<int16_t>(take(bytes_ + kBase, 2)) + 2 * offset;
}

void AutopilotBlock::write(const AutopilotPosts& posts) {
  uint64_t groups = 0;
  for (uint32_t group = 0; group < kGroups; ++group) {
    if (is_known(posts, group)) groups |= uint64_t{1} << group;
  }
  if (groups == 0) return;
  const bool is_inav = layout_.autopilot() == Autopilot::kInav;
  write_header(groups, is_inav ? kInavVersion : kArduPilotVersion);
  if (is_inav) {
    write_offsets(posts, groups);
  } else {
    write_heights(posts, groups);
  }
  const size_t end = is_inav ? kInavTrailer : kArduPilotTrailer;
  write_trailer(bytes_ + end);
  // A byte of ArduPilot's block that the check does not cover: below 1 it warns of old data, and
  // does not arm.
  if (!is_inav) bytes_[kArduPilotTrailer + kTrailerBytes] = 1;
  put(bytes_ + kCheck, crc16(bytes_, end + kTrailerBytes), 2);
}

int32_t AutopilotBlock::post(const AutopilotPosts& posts, uint32_t row, uint32_t column) const {
  const size_t first = size_t{row_} * kOwnRows + row;
  return posts.heights[first * layout_.columns() + column_ * kOwnColumns + column];
}

bool AutopilotBlock::is_known(const AutopilotPosts& posts, uint32_t group) const {
  const uint32_t row = group / kGroupColumns * kGroup, column = group % kGroupColumns * kGroup;
  for (uint32_t i = 0; i < kGroup * kGroup; ++i) {
    if (post(posts, row + i / kGroup, column + i % kGroup) == kNoHeight) return false;
  }
  return true;
}

// Calls visit(post's number in the block, millimetres) for each that is there.
template <class Visit>
void AutopilotBlock::for_each(const AutopilotPosts& posts, uint64_t groups,
                              const Visit& visit) const {
  for (uint32_t row = 0; row < kBlockRows; ++row) {
    for (uint32_t column = 0; column < kBlockColumns; ++column) {
      if (has_post(groups, row, column))
        visit(row * kBlockColumns + column, post(posts, row, column));
    }
  }
}

void AutopilotBlock::write_header(uint64_t groups, uint64_t version) {
  const GeoPlace corner = layout_.corner(row_, column_);
  put(bytes_, groups, 8);
  put(bytes_ + 8, static_cast<uint64_t>(corner.latitude), 4);
  put(bytes_ + 12, static_cast<uint64_t>(corner.longitude), 4);
  put(bytes_ + 18, version, 2);
  put(bytes_ + 20, layout_.spacing(), 2);
}

void AutopilotBlock::write_trailer(uint8_t* at) const {
  put(at, row_, 2);
  put(at + 2, column_, 2);
  put(at + 4, static_cast<uint64_t>(layout_.cell().longitude), 2);
  put(at + 6, static_cast<uint64_t>(layout_.cell().latitude), 1);
}

void AutopilotBlock::write_heights(const AutopilotPosts& posts, uint64_t groups) {
  for_each(posts, groups, [&](uint32_t post, int32_t height) {
    put(bytes_ + kHeights + 2 * size_t{post},
        static_cast<uint64_t>(round_divide(Wide{height}, Wide{1000})), 2);
  });
}

void AutopilotBlock::write_offsets(const AutopilotPosts& posts, uint64_t groups) {
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
    put(at, take(at, 2) | static_cast<uint64_t>(std::max<int64_t>(steps(height), 0)) << bit % 8, 2);
  });
  put(bytes_ + kBase, static_cast<uint64_t>(base), 2);
}

void AutopilotBlock::refuse(int32_t lowest, int32_t highest) const {
  const GeoPlace corner = layout_.corner(row_, column_);
  throw Error("from " + std::to_string(lowest / 1000) + " m to " + std::to_string(highest / 1000) +
              " m in the block at " + std::to_string(static_cast<double>(corner.latitude) * 1e-7) +
              ", " + std::to_string(static_cast<double>(corner.longitude) * 1e-7) +
              ": ten bits of 2 m hold 2046 m; write a .DAT file instead");
}

namespace {

// A lattice's axis and places in 1e-7 degrees.
class GeoAxis {
 public:
  GeoAxis(const Axis& axis, int64_t low, int64_t high)
      : axis_(axis), map_(map_between({0, 1, kDegree}, axis)), low_(low), high_(high) {}

  // The lattice coordinate, kept within the surface and rounded as devices round it. Nothing if it
  // is farther away than that.
  std::optional<RealCoordinate> inside(int64_t degrees, double most_beyond, bool* is_beyond) const {
    const Wide place = map_.numerator(degrees),
               kept = std::clamp(place, low_ * map_.step, high_ * map_.step);
    if (kept == place) return on_device(place);
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
  // A position with 8 fractional bits, halves up.
  RealCoordinate on_device(Wide place) const {
    const Wide fine = round_divide(256 * place, map_.step), whole = floor_divide(fine, Wide{256});
    return {static_cast<int64_t>(whole), fine - 256 * whole, 256};
  }

  Axis axis_;
  LatticeMap map_;
  Wide low_, high_;
};

// The height that a device returns at the post, rounded once more.
int32_t millimetres(const ExactHeight& height, const Axis& z) {
  const Wide rounded = rounded_mantissa(z, height_of_answer(fixed_height(height)), 3);
  if (rounded < -32768000 || rounded > 32767000) {
    throw Error("a height of " + std::to_string(static_cast<int64_t>(rounded / 1000)) +
                " m does not fit 16 bits; cut such heights out of the terrain");
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
      ++file.queried;
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
  if (file.blocks == 0)
    throw Error("the terrain has no height in the cell; name the file after a cell that has some");
  measure(named, layout, file);
  return file;
}

}  // namespace microtin::exporting
