#include <charconv>
#include <filesystem>

#include "encoder/error.hpp"
#include "encoder/import.hpp"
#include "encoder/import_text.hpp"

namespace microtin {
namespace {

constexpr uint32_t kWgs84 = 4326;
constexpr uint32_t kEgm96Height = 5773;

// "n43" as 43, "s05" as -5; nothing if the text does not read so.
std::optional<int> degrees(std::string_view text, char positive, char negative, int most) {
  if (text.empty() || (text[0] != positive && text[0] != negative)) return std::nullopt;
  const char* const end = text.data() + text.size();
  int value = 0;
  const auto [next, error] = std::from_chars(text.data() + 1, end, value);
  if (next != end || error != std::errc() || value < 0 || value > most) return std::nullopt;
  return text[0] == positive ? value : -value;
}

struct Corner {
  int latitude;
  int longitude;
};

Corner south_west_corner(const std::string& name) {
  const std::string file = lower_case(std::filesystem::path(name).filename().string());
  const std::string_view place = std::string_view(file).substr(0, file.find_first_of("._"));
  if (place.size() == 7) {
    const auto latitude = degrees(place.substr(0, 3), 'n', 's', 90);
    const auto longitude = degrees(place.substr(3), 'e', 'w', 180);
    if (latitude && longitude) return {*latitude, *longitude};
  }
  throw Error(name + ": the file's name does not say where it lies, as N43E007.hgt does");
}

int64_t height_at(const std::string& bytes, size_t post) {
  const auto high = static_cast<uint8_t>(bytes[2 * post]);
  const auto low = static_cast<uint8_t>(bytes[2 * post + 1]);
  const int value = high * 256 + low;
  const int height = value < 32768 ? value : value - 65536;
  return height == -32768 ? kVoidHeight : height;
}

}  // namespace

Raster import_hgt(const std::string& name, const std::string& bytes) {
  Raster raster;
  for (const uint32_t posts : {1201u, 3601u}) {
    if (bytes.size() == size_t{2} * posts * posts) raster.width = raster.height = posts;
  }
  if (raster.width == 0) {
    throw Error(name + ": has " + std::to_string(bytes.size()) +
                " bytes; an .hgt file has 2884802 (1201 x 1201 posts) or 25934402 (3601 x 3601)");
  }
  raster.heights.reserve(size_t{raster.width} * raster.height);
  for (uint32_t row = raster.height; row-- > 0;) {
    for (uint32_t column = 0; column < raster.width; ++column) {
      raster.heights.push_back(height_at(bytes, size_t{row} * raster.width + column));
    }
  }
  const Corner corner = south_west_corner(name);
  const uint64_t per_degree = raster.width - 1;
  raster.x = {corner.longitude * static_cast<int64_t>(per_degree), 1, per_degree};
  raster.y = {corner.latitude * static_cast<int64_t>(per_degree), 1, per_degree};
  raster.reference = {Unit::kDegree, Unit::kMetre, kWgs84, kEgm96Height};
  return raster;
}

}  // namespace microtin
