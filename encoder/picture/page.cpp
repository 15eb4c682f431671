// SPDX-License-Identifier: MIT
// Fills the places of the page.
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "encoder/base/error.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/picture/maps.hpp"
#include "encoder/picture/render.hpp"

namespace microtin::picture {
namespace {

template <class Bytes>
std::string base64(const Bytes& bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t group = 0;
    for (size_t j = 0; j < 3; ++j)
      group = group << 8 | (j < count ? static_cast<uint8_t>(bytes[i + j]) : 0u);
    for (size_t j = 0; j < 4; ++j) {
      text += j <= count ? kDigits[group >> (18 - 6 * j) & 63] : '=';
    }
  }
  return text;
}

std::string without_markup(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<' || c == '>' || c == '&' || c == '"') {
      safe += "&#" + std::to_string(static_cast<int>(c)) + ';';
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string joined(const std::vector<double>& numbers) {
  std::ostringstream text;
  text.precision(17);
  for (size_t i = 0; i < numbers.size(); ++i) text << (i == 0 ? "" : ",") << numbers[i];
  return text.str();
}

// As the page takes them: bytes of red, green and blue, from the lowest height to the highest.
std::string tints(const Palette& palette) {
  constexpr int kTints = 64;
  std::vector<double> bytes;
  for (int i = 0; i < kTints; ++i) {
    const Colour colour = palette.at(i / (kTints - 1.0));
    for (const double part : {colour.r, colour.g, colour.b}) {
      bytes.push_back(std::round(part * 255));
    }
  }
  return joined(bytes);
}

// What the page needs to draw the terrain as the pictures do, in JSON: the lowest and the highest
// height; how long a unit of x, of y and of heights is, relative to each other; by how much light
// finds slopes steeper than they are.
std::string scene_of(const Portrait& portrait) {
  const Metadata& metadata = portrait.metadata;
  const Placement& at = metadata.placement;
  const Ground ground = ground_of(portrait.model, metadata.horizontal_unit);
  const Relief relief(portrait.model, ground, std::nullopt, portrait.palette);
  const auto height = [&](int64_t z) {
    return offset_of(at.z) + step_of(at.z) * static_cast<double>(z);
  };
  const double up = metres_per(metadata.vertical_unit).value_or(1) /
                    metres_per(metadata.horizontal_unit).value_or(1);
  return R"({"heights":[)" + joined({height(relief.lowest()), height(relief.highest())}) +
         R"(],"ground":[)" + joined({ground.x / step_of(at.x), ground.y / step_of(at.y), up}) +
         R"(],"slope":)" + joined({relief.slope_scale() / step_of(at.z)}) + R"(,"tints":[)" +
         tints(relief.palette()) + "]}";
}

}  // namespace

std::string render_page(const Portrait& portrait, const std::string& title, const std::string& file,
                        const std::vector<uint8_t>& flat) {
  const std::string_view page = viewer_page();
  if (page.empty()) {
    throw Error("this program was built without the page that shows terrains: " +
                std::string(viewer_absence()));
  }
  if (file.size() > kLargestPage) {
    throw Error("it has " + std::to_string(file.size()) + " bytes; a page holds at most " +
                std::to_string(kLargestPage));
  }
  const std::map<std::string_view, std::string> contents = {{"@TITLE@", without_markup(title)},
                                                            {"@SCENE@", scene_of(portrait)},
                                                            {"@PICTURE@", base64(flat)},
                                                            {"@TERRAIN@", base64(file)}};
  std::string filled;
  for (size_t i = 0; i < page.size();) {
    const size_t place = page.find('@', i);
    const size_t end = place == std::string_view::npos ? place : page.find('@', place + 1);
    if (end == std::string_view::npos) return filled += page.substr(i);
    const auto content = contents.find(page.substr(place, end + 1 - place));
    const bool is_place = content != contents.end();
    filled += page.substr(i, (is_place ? place : end) - i);
    if (is_place) filled += content->second;
    i = is_place ? end + 1 : end;
  }
  return filled;
}

}  // namespace microtin::picture
