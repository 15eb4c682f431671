// SPDX-License-Identifier: MIT
// Places in degrees: which there are on Earth, and the cells of a degree by a degree.
#include "encoder/terrain/degrees.hpp"

#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <string_view>

#include "encoder/base/error.hpp"
#include "encoder/exact/lattice_map.hpp"

namespace microtin::terrain {
namespace {

constexpr std::array<int64_t, 2> kMost = {360, 90};
constexpr const char* kRemedy =
    ": x is the longitude and y the latitude; exchange them, or give the coordinate system that "
    "they are in";

std::string beyond(size_t axis, const std::string& value) {
  return std::string(axis == 0 ? "longitude " : "latitude ") + value + " is beyond " +
         std::to_string(kMost[axis]) + " degrees";
}

// Whether a raster's column or row lies farther out than there may be one.
bool is_beyond(size_t axis, const Axis& posts, int64_t number) {
  constexpr double kRounding = 0.01;  // parts of a cell
  const double margin = step_of(posts) * (axis == 0 ? 1 + kRounding : kRounding);
  const double place = offset_of(posts) + step_of(posts) * static_cast<double>(number);
  return std::abs(place) > static_cast<double>(kMost[axis]) + margin;
}

}  // namespace

std::string beyond_degrees(size_t axis, Decimal value) {
  const Decimal size{value.mantissa < 0 ? -value.mantissa : value.mantissa, value.decimals};
  if (axis > 1 || size <= Decimal{kMost[axis], 0}) return "";
  return beyond(axis, to_string(value));
}

void expect_on_earth(const PointCloud& cloud) {
  const auto decimal = [&](int64_t number) { return make_decimal(number, cloud.xy_decimals); };
  const int64_t unit = power_of_ten(cloud.xy_decimals);
  for (size_t i = 0; i < cloud.points.size(); ++i) {
    const SourcePoint& p = cloud.points[i];
    for (const size_t axis : {size_t{0}, size_t{1}}) {
      const int64_t number = axis == 0 ? p.x : p.y;
      if (magnitude(number) <= Wide{kMost[axis]} * unit) continue;
      throw Error("point " + std::to_string(i + 1) + ", at x " + to_string(decimal(p.x)) + ", y " +
                  to_string(decimal(p.y)) + ": " + beyond_degrees(axis, decimal(number)) + kRemedy);
    }
  }
}

void expect_on_earth(const Raster& frame) {
  for (const size_t axis : {size_t{0}, size_t{1}}) {
    const Axis& posts = axis == 0 ? frame.x : frame.y;
    const int64_t count = axis == 0 ? frame.width : frame.height;
    for (const int64_t number : {int64_t{0}, count - 1}) {
      if (!is_beyond(axis, posts, number)) continue;
      std::string text = axis == 0 ? "column " : "row ";
      text += std::to_string(number + 1);
      text += axis == 0 ? " from the west: " : " from the south: ";
      throw Error(text + beyond(axis, CoordinateText(posts)(number)) + kRemedy);
    }
  }
}

namespace {

// "n43" or "N43" as 43, "s05" as -5; nothing if the text does not read so.
std::optional<int> degrees(std::string_view text, char positive, char negative) {
  const int letter = std::tolower(static_cast<unsigned char>(text[0]));
  if (letter != positive && letter != negative) return std::nullopt;
  const char* const end = text.data() + text.size();
  int value = 0;
  const auto [next, error] = std::from_chars(text.data() + 1, end, value);
  if (next != end || error != std::errc() || value < 0) return std::nullopt;
  return letter == positive ? value : -value;
}

}  // namespace

std::optional<DegreeCell> cell_of(const std::string& path) {
  const std::string file = std::filesystem::u8path(path).filename().string();
  const std::string_view name = std::string_view(file).substr(0, file.find_first_of("._"));
  if (name.size() != 7) return std::nullopt;
  const auto latitude = degrees(name.substr(0, 3), 'n', 's');
  const auto longitude = degrees(name.substr(3), 'e', 'w');
  if (!latitude || !longitude) return std::nullopt;
  if (*latitude < -90 || *latitude >= 90 || *longitude < -180 || *longitude >= 180) {
    return std::nullopt;
  }
  return DegreeCell{*latitude, *longitude};
}

}  // namespace microtin::terrain
