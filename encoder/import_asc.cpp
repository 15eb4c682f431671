#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "encoder/error_context.hpp"
#include "encoder/fraction.hpp"
#include "encoder/import.hpp"
#include "encoder/import_text.hpp"

namespace microtin {
namespace {

// The words of a text, one after the other.
class Words {
 public:
  Words(const std::string& name, const std::string& text) : name_(name), text_(text) {}

  // Moves to the next word; false at the end.
  bool next() {
    while (position_ < text_.size() && is_space(text_[position_])) {
      if (text_[position_++] == '\n') ++line_;
    }
    const size_t start = position_;
    while (position_ < text_.size() && !is_space(text_[position_])) ++position_;
    word_ = std::string_view(text_).substr(start, position_ - start);
    return !word_.empty();
  }

  std::string_view word() const { return word_; }
  [[noreturn]] void fail(const std::string& what) const { fail_at(name_, line_, what); }

 private:
  static bool is_space(char c) { return is_blank(c) || c == '\n'; }

  const std::string& name_;
  const std::string& text_;
  std::string_view word_;
  size_t position_ = 0;
  size_t line_ = 1;
};

// Heights equal to it are void. Writers put numbers here that no height can have, such as -3.4e38;
// heights that repeat the text count as equal, too.
struct NoData {
  std::string text;
  std::optional<Decimal> value;

  bool matches(std::string_view word, const std::optional<Decimal>& number) const {
    return (number && value && *number == *value) || (!text.empty() && word == text);
  }
};

// What the header says; errors do not name the file.
class Header {
 public:
  NoData no_data;

  // False if the key was there before.
  bool add(const std::string& key, Decimal value) { return numbers_.emplace(key, value).second; }

  uint32_t count(const std::string& key) const {
    const Decimal value = required(key);
    if (value.decimals != 0 || value.mantissa < 1 || value.mantissa > INT32_MAX) {
      throw Error(key + " is not a count: " + to_string(value));
    }
    return static_cast<uint32_t>(value.mantissa);
  }

  // The axis of cell centres; `axis` is x or y.
  Axis centres(char axis) const {
    const std::string lower_left = std::string(1, axis) + "ll";
    const std::string other = std::string("d") + axis;
    const std::string size_key = has(other) && !has("cellsize") ? other : "cellsize";
    const Decimal size = required(size_key);
    if (size.mantissa <= 0) throw Error(size_key + " is not above 0");
    const bool is_centre = has(lower_left + "center");
    const Decimal place = required(lower_left + (is_centre ? "center" : "corner"));
    return axis_of_cells(place, size, is_centre ? 0 : 1);
  }

 private:
  bool has(const std::string& key) const { return numbers_.count(key) != 0; }

  Decimal required(const std::string& key) const {
    if (!has(key)) throw Error("the header does not give " + key);
    return numbers_.at(key);
  }

  std::map<std::string, Decimal> numbers_;
};

bool is_known(std::string_view key) {
  constexpr std::array<std::string_view, 9> kKeys = {
      "ncols", "nrows", "xllcorner", "xllcenter", "yllcorner", "yllcenter", "cellsize", "dx", "dy"};
  return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

bool is_finite_number(std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() && std::isfinite(value);
}

NoData no_data_of(const Words& words) {
  if (!is_finite_number(words.word())) words.fail(quoted(words.word()) + " is not a number");
  return {std::string(words.word()), parse_decimal(words.word())};
}

// Reads keys and values up to the first word that begins no key: the first height.
Header read_header(Words& words) {
  Header header;
  while (words.next()) {
    const char first = words.word()[0];
    if ((first < 'A' || first > 'Z') && (first < 'a' || first > 'z')) return header;
    const std::string key = lower_case(std::string(words.word()));
    if (key != "nodata_value" && !is_known(key)) {
      words.fail(quoted(words.word()) + " is neither a number nor a key of an ASCII grid's header");
    }
    if (!words.next()) words.fail("the value of " + key + " is missing");
    if (key == "nodata_value") {
      header.no_data = no_data_of(words);
      continue;
    }
    const std::optional<Decimal> value = parse_decimal(words.word(), kPlaceDecimals);
    if (!value) words.fail(key + " is not a number in range: " + quoted(words.word()));
    if (!header.add(key, *value)) words.fail(key + " is given twice");
  }
  return header;
}

// The words from the current one on, in the file's order.
DecimalColumn read_heights(Words& words, const NoData& no_data, uint64_t count) {
  DecimalColumn heights;
  const std::string of_all = " of " + std::to_string(count) + " heights";
  for (uint64_t read = 0; read < count; ++read, words.next()) {
    const std::string_view word = words.word();
    if (word.empty()) words.fail("the grid ends after " + std::to_string(read) + of_all);
    const std::optional<Decimal> height = parse_decimal(word);
    if (no_data.matches(word, height)) {
      heights.add_void();
    } else if (!height || !heights.add(*height)) {
      words.fail(quoted(word) + " is not a number in range");
    }
  }
  if (!words.word().empty())
    words.fail("the grid goes on after its " + std::to_string(count) + " heights");
  return heights;
}

}  // namespace

Raster import_asc(const std::string& name, const std::string& text) {
  Words words(name, text);
  const Header header = read_header(words);
  Raster raster = about(name, [&] {
    Raster empty;
    empty.width = header.count("ncols");
    empty.height = header.count("nrows");
    empty.x = header.centres('x');
    empty.y = header.centres('y');
    return empty;
  });
  DecimalColumn heights =
      read_heights(words, header.no_data, uint64_t{raster.width} * raster.height);
  raster.decimals = heights.decimals();
  raster.heights = std::move(heights.mantissas());
  // The file begins in the north.
  for (uint32_t row = 0; row < raster.height / 2; ++row) {
    const auto low = raster.heights.begin() + int64_t{row} * raster.width;
    const auto high = raster.heights.end() - (int64_t{row} + 1) * raster.width;
    std::swap_ranges(low, low + raster.width, high);
  }
  return raster;
}

}  // namespace microtin
