// SPDX-License-Identifier: MIT
#include "encoder/terrain/degree_cell.hpp"

#include <cctype>
#include <charconv>
#include <filesystem>
#include <string_view>

namespace microtin::terrain {
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
  const std::string file = std::filesystem::path(path).filename().string();
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
