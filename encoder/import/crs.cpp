// SPDX-License-Identifier: MIT
// Finds codes and units in well-known text and GeoTIFF keys.
#include "encoder/import/crs.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>

#include "encoder/base/text.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {
namespace {

constexpr size_t kDeepest = 64;  // brackets in brackets; real ones have a dozen

// A node of well-known text as it is being read: KEYWORD["name", 1, CHILD[...], ...].
struct Node {
  std::string keyword;              // lower case
  std::vector<std::string> values;  // of those that are no nodes; texts without quotes
};

bool is_one_of(const std::string& keyword, std::initializer_list<std::string_view> all) {
  for (const std::string_view one : all) {
    if (keyword == one) return true;
  }
  return false;
}

enum class Kind { kNone, kProjected, kGeographic, kVertical };

// Local systems are planes as projected ones are.
Kind kind_of(const std::string& keyword) {
  if (is_one_of(keyword,
                {"projcs", "projcrs", "projectedcrs", "local_cs", "engcrs", "engineeringcrs"})) {
    return Kind::kProjected;
  }
  if (is_one_of(keyword, {"geogcs", "geogcrs", "geographiccrs", "geodcrs", "geodeticcrs"})) {
    return Kind::kGeographic;
  }
  if (is_one_of(keyword, {"vert_cs", "vertcs", "vertcrs", "verticalcrs"})) return Kind::kVertical;
  return Kind::kNone;
}

uint32_t code_of(const std::string& text) {
  uint32_t code = 0;
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, code);
  return error == std::errc() && next == end ? code : 0;
}

// By its length in metres.
StatedUnit length_unit(const Node& node) {
  const std::optional<double> metres = real_number(node.values[1]);
  return metres ? unit_of_length(*metres, node.values[0]) : unit_named(node.values[0]);
}

// By its radians.
StatedUnit angular_unit(const Node& node) {
  constexpr double kDegree = 0.017453292519943295, kAlike = 1e-9;
  const std::optional<double> radians = real_number(node.values[1]);
  if (radians && std::abs(*radians - kDegree) < kAlike) return {Unit::kDegree, {}};
  return {Unit::kUnknown, node.values[0]};
}

class WktReader {
 public:
  // Goes on to where the brackets end, or the text does, or they are too deep.
  Reference read(std::string_view text) {
    std::string word;
    bool in_quotes = false;
    for (const char c : text) {
      const bool is_mark = !in_quotes && std::string_view("[(,])").find(c) != std::string::npos;
      if (c == '"') {
        in_quotes = !in_quotes;
      } else if (!is_mark) {
        const bool is_space = std::isspace(static_cast<unsigned char>(c)) != 0 || c == '\0';
        if (in_quotes || !is_space) word += c;
      } else if (c == '[' || c == '(') {
        if (open_.size() == kDeepest) break;
        open_.push_back({lower_case(word), {}});
        word.clear();
      } else {
        if (!word.empty() && !open_.empty()) open_.back().values.push_back(word);
        word.clear();
        if (c != ',' && !open_.empty()) close();
      }
    }
    return reference_;
  }

 private:
  void close() {
    const Node node = std::move(open_.back());
    open_.pop_back();
    find_direction(node);
    const Kind own = kind_of(node.keyword);
    if (own != Kind::kNone && !node.values.empty()) name_system(own, node.values[0]);
    if (open_.empty() || node.values.size() < 2) return;
    const bool in_system = open_.size() >= 2 && is_one_of(open_.back().keyword, {"cs", "axis"});
    const Kind kind = kind_of((in_system ? open_[open_.size() - 2] : open_.back()).keyword);
    if (kind == Kind::kNone || is_of_another(kind)) return;
    if (is_one_of(node.keyword, {"authority", "id"}) && lower_case(node.values[0]) == "epsg") {
      (kind == Kind::kVertical ? reference_.vertical_epsg : reference_.horizontal_epsg) =
          code_of(node.values[1]);
    } else if (is_one_of(node.keyword, {"unit", "lengthunit", "angleunit"})) {
      add_unit(kind, node);
    }
  }

  // Systems without codes are known by the names that ESRI gives them.
  void name_system(Kind kind, const std::string& name) {
    const bool is_vertical = kind == Kind::kVertical;
    uint32_t& known = is_vertical ? reference_.vertical_epsg : reference_.horizontal_epsg;
    if (is_of_another(kind) || known != 0) return;
    const Unit unit = is_vertical ? reference_.vertical_unit : reference_.horizontal_unit;
    const uint32_t code = is_vertical ? code_of_esri_heights(name) : code_of_esri_name(name);
    if (code != 0 && built_in_system(code)->unit == unit) known = code;
  }

  // By the vertical axis, or by ESRI's parameter.
  void find_direction(const Node& node) {
    if (open_.empty() || node.values.size() < 2 || is_of_another(Kind::kVertical)) return;
    const std::string first = lower_case(node.values[0]), second = lower_case(node.values[1]);
    const bool is_own = kind_of(open_.back().keyword) == Kind::kVertical;
    if (node.keyword == "axis" && second == "down") reference_.depths = true;
    if (!is_own || node.keyword != "parameter" || first != "direction") return;
    const std::optional<double> direction = real_number(second);
    reference_.depths = direction && *direction < 0;
  }

  bool is_in_vertical_axis() const {
    if (open_.back().keyword != "axis" || open_.back().values.size() < 2) return false;
    const std::string direction = lower_case(open_.back().values[1]);
    return direction == "up" || direction == "down";
  }

  void add_unit(Kind kind, const Node& node) {
    const bool is_of_third_axis = kind == Kind::kGeographic && node.keyword == "lengthunit";
    if (kind == Kind::kVertical || is_of_third_axis || is_in_vertical_axis()) {
      state_vertical_unit(length_unit(node), reference_);
    } else {
      state_horizontal_unit(kind == Kind::kProjected ? length_unit(node) : angular_unit(node),
                            reference_);
    }
  }

  // A projected system contains the geographic one that it is based on; one with a transformation
  // contains its target.
  bool is_of_another(Kind kind) const {
    for (const Node& node : open_) {
      if (is_one_of(node.keyword, {"targetcrs", "abridgedtransformation"})) return true;
    }
    return kind == Kind::kGeographic && is_within_projected();
  }

  bool is_within_projected() const {
    for (const Node& node : open_) {
      if (kind_of(node.keyword) == Kind::kProjected) return true;
    }
    return false;
  }

  std::vector<Node> open_;
  Reference reference_;
};

// Units that are not stated follow from codes that are known.
void complete_units(Reference& reference) {
  const auto complete = [](uint32_t code, bool is_vertical, const StatedUnit& unit) {
    if (unit.is_stated()) return unit;
    const std::optional<CodedSystem> system = system_of_file_code(code);
    if (!system || system->is_vertical != is_vertical) return unit;
    return StatedUnit{system->unit, system->other};
  };
  state_horizontal_unit(complete(reference.horizontal_epsg, false,
                                 {reference.horizontal_unit, reference.horizontal_other}),
                        reference);
  state_vertical_unit(
      complete(reference.vertical_epsg, true, {reference.vertical_unit, reference.vertical_other}),
      reference);
}

}  // namespace

bool is_wkt(std::string_view text) {
  const size_t start = text.find_first_not_of(" \t\r\n");
  const size_t open = text.find_first_of("[(");
  if (start == text.npos || open == text.npos || open <= start) return false;
  for (const char c : text.substr(start, open - start)) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && !is_blank(c)) return false;
  }
  return true;
}

Reference reference_of_wkt(std::string_view text) {
  text = text.substr(0, text.find('\0'));
  Reference reference = WktReader().read(text);
  complete_units(reference);
  if (reference.horizontal_epsg == 0 && text.size() <= kLongestWkt) reference.wkt = text;
  return reference;
}

Reference reference_of_line(std::string_view text) {
  constexpr std::string_view kCode = "EPSG:";
  if (text.substr(0, kCode.size()) != kCode) return reference_of_wkt(text);
  Reference reference;
  const std::string_view codes = text.substr(kCode.size());
  const size_t plus = codes.find('+');
  reference.horizontal_epsg = code_of(std::string(codes.substr(0, plus)));
  if (plus != codes.npos) reference.vertical_epsg = code_of(std::string(codes.substr(plus + 1)));
  complete_units(reference);
  return reference;
}

Reference reference_of_geo_keys(const std::vector<uint16_t>& directory,
                                const std::vector<double>& doubles) {
  constexpr uint16_t kModel = 1024, kGeographic = 2048, kAngularUnit = 2054, kProjected = 3072,
                     kLinearUnit = 3076, kLinearSize = 3077, kVertical = 4096, kVerticalUnit = 4099,
                     kUserDefined = 32767, kDoubles = 34736;
  Reference reference;
  bool is_geographic = false;
  uint32_t geographic = 0, projected = 0;
  StatedUnit angular{Unit::kDegree, {}}, linear;
  // A head of four numbers, then for each key: what, where, how many, value.
  for (size_t at = 4; at + 4 <= directory.size(); at += 4) {
    const uint16_t key = directory[at], value = directory[at + 3];
    const bool is_here = directory[at + 1] == 0 && value != kUserDefined;
    const uint16_t code = is_here ? value : uint16_t{0};
    if (key == kModel) is_geographic = code == 2;
    if (key == kGeographic) geographic = code;
    if (key == kProjected) projected = code;
    if (key == kVertical) reference.vertical_epsg = code;
    if (key == kAngularUnit) angular = unit_of_code(code);
    if (key == kLinearUnit && is_here) linear = unit_of_code(code);
    if (key == kLinearSize && directory[at + 1] == kDoubles && value < doubles.size()) {
      linear = unit_of_length(doubles[value], "user-defined");
    }
    if (key == kVerticalUnit) {
      state_vertical_unit(is_here ? unit_of_code(code) : StatedUnit{Unit::kUnknown, "user-defined"},
                          reference);
    }
  }
  reference.horizontal_epsg = is_geographic ? geographic : projected;
  state_horizontal_unit(is_geographic ? angular : linear, reference);
  complete_units(reference);
  return reference;
}

std::string horizontal_part(const std::string& text) {
  size_t depth = 0, begin = 0;
  bool in_quotes = false;
  const size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  const size_t open = std::min(text.find_first_of("[(", first), text.size());
  const std::string root = lower_case(text.substr(first, open - first));
  const bool is_compound = is_one_of(root, {"compd_cs", "compoundcrs"});
  const size_t own = is_compound ? 1 : 0;  // how deep the horizontal system lies
  for (size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    if (c == '"') in_quotes = !in_quotes;
    if (in_quotes) continue;
    if (c == '[' || c == '(') ++depth;
    if (is_compound && c == ',' && depth == own && begin == 0) begin = at + 1;
    if ((c == ']' || c == ')') && depth != 0 && --depth == own) {
      begin = std::min(text.find_first_not_of(" \t\r\n", begin), at);
      return text.substr(begin, at + 1 - begin);
    }
  }
  return text;
}

}  // namespace microtin::importing
