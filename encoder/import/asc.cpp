// SPDX-License-Identifier: MIT
// ESRI ASCII grids, read whole or in rectangles.
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/import/import.hpp"
#include "encoder/import/raster.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {
namespace {

// The words of a text, one after the other.
class Words {
 public:
  // From a word's beginning on. Lines are counted from there.
  Words(const std::string& name, const ByteSource& text, uint64_t offset = 0, size_t piece = 65536)
      : name_(name), text_(text), offset_(offset), piece_(piece) {}

  // Moves to the next word; false at the end.
  bool next() {
    start_ = end_;
    while (has(start_) && is_space(buffer_[start_])) {
      if (ends_line(start_)) ++line_;
      ++start_;
    }
    end_ = start_;
    while (has(end_) && !is_space(buffer_[end_])) ++end_;
    return start_ != end_;
  }

  std::string_view word() const { return std::string_view(buffer_).substr(start_, end_ - start_); }
  uint64_t offset() const { return offset_ + start_; }  // of the word in the text
  [[noreturn]] void fail(const std::string& what) const { fail_at(name_, line_, what); }

 private:
  // LF, or CR without one.
  bool ends_line(size_t place) {
    if (buffer_[place] != '\r') return buffer_[place] == '\n';
    size_t next = place + 1;
    return has(next) && buffer_[next] != '\n';
  }

  static bool is_space(char c) { return is_blank(c) || c == '\n'; }

  // Whether there is a byte at that place of the buffer, which is filled if need be.
  bool has(size_t& place) {
    if (place < buffer_.size()) return true;
    buffer_.erase(0, start_);
    offset_ += start_;
    place -= start_;
    start_ = 0;
    const size_t size = buffer_.size();
    buffer_.resize(size + piece_ + size / 2);
    buffer_.resize(size + text_.read(offset_ + size, &buffer_[size], buffer_.size() - size));
    return place < buffer_.size();
  }

  const std::string& name_;
  const ByteSource& text_;
  std::string buffer_;  // from offset_ on
  uint64_t offset_;
  size_t piece_;
  size_t start_ = 0, end_ = 0;  // the word
  size_t line_ = 1;
};

// Behind the byte order mark, if there is one.
uint64_t begin_of(const ByteSource& text) {
  std::array<char, 3> bytes{};
  const std::string_view begin(bytes.data(), text.read(0, bytes.data(), bytes.size()));
  return begin.size() - without_mark(begin).size();
}

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
    if (has(other) && has("cellsize") && !(required(other) == required("cellsize"))) {
      throw Error("cellsize and " + other + " are both given; keep one");
    }
    const std::string size_key = has(other) && !has("cellsize") ? other : "cellsize";
    const Decimal size = required(size_key);
    if (size.mantissa <= 0) throw Error(size_key + " is not above 0");
    const bool is_centre = has(lower_left + "center");
    if (is_centre && has(lower_left + "corner")) {
      throw Error(lower_left + "corner and " + lower_left + "center are both given; keep one");
    }
    const Decimal place = required(lower_left + (is_centre ? "center" : "corner"));
    return axis_of_cells(place, size, is_centre ? 0 : 1);
  }

 private:
  bool has(const std::string& key) const { return numbers_.count(key) != 0; }

  Decimal required(const std::string& key) const {
    if (!has(key)) throw Error("the header lacks " + key);
    return numbers_.at(key);
  }

  std::map<std::string, Decimal> numbers_;
};

constexpr std::string_view kNoDataKey = "nodata_value";

bool is_known(std::string_view key) {
  constexpr std::array<std::string_view, 9> kKeys = {
      "ncols", "nrows", "xllcorner", "xllcenter", "yllcorner", "yllcenter", "cellsize", "dx", "dy"};
  return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

NoData no_data_of(const Words& words) {
  const std::string_view word = words.word();
  if (!NoData().marks(word) && !number_of_any_size(word)) {
    words.fail(quoted(word) + " is not a number" + remedy_for_commas(word));
  }
  return NoData(word);
}

// Reads keys and values up to the first word that begins no key: the first height.
Header read_header(Words& words) {
  Header header;
  bool has_no_data = false;
  while (words.next()) {
    const char first = words.word()[0];
    if (NoData().marks(words.word())) return header;
    if ((first < 'A' || first > 'Z') && (first < 'a' || first > 'z')) return header;
    const std::string key = lower_case(std::string(words.word()));
    if (key != kNoDataKey && !is_known(key)) {
      words.fail(quoted(words.word()) + " is neither a number nor a key of an ASCII grid's header");
    }
    if (!words.next()) words.fail("the value of " + key + " is missing");
    if (key == kNoDataKey) {
      if (has_no_data) words.fail(key + " is given twice");
      header.no_data = no_data_of(words);
      has_no_data = true;
      continue;
    }
    const std::optional<Decimal> value = parse_decimal(words.word(), kPlaceDecimals);
    if (!value) {
      words.fail(key + " is not a number in range: " + quoted(words.word()) +
                 remedy_for_commas(words.word()));
    }
    if (!header.add(key, *value)) words.fail(key + " is given twice");
  }
  return header;
}

// The height that the current word says; nothing if it is void. Throws Error if it is neither.
std::optional<Decimal> read_height(const Words& words, const NoData& no_data) {
  if (no_data.marks(words.word())) return std::nullopt;
  const std::optional<Decimal> height = parse_decimal(words.word());
  if (!height) {
    words.fail(quoted(words.word()) + " is not a number in range" +
               (number_of_any_size(words.word())
                    ? "; if it marks voids, the header's NODATA_value must be the same"
                    : remedy_for_commas(words.word())));
  }
  return height;
}

// Calls visit(height, number) for all heights, from the current word on, in the file's order.
// Visit returns false if the height is out of range.
template <class Visit>
void for_each_height(Words& words, const NoData& no_data, uint64_t count, const Visit& visit) {
  const std::string of_all = " of " + std::to_string(count) + " heights";
  for (uint64_t read = 0; read < count; ++read, words.next()) {
    const std::string_view word = words.word();
    if (word.empty()) words.fail("the grid ends after " + std::to_string(read) + of_all);
    if (!visit(read_height(words, no_data), read)) {
      words.fail(quoted(word) + " is not a number in range");
    }
  }
  if (!words.word().empty())
    words.fail("the grid has more numbers than its " + std::to_string(count) + " heights");
}

// Without heights.
Raster frame_of(const std::string& name, const Header& header) {
  return with_file_context(name, [&] {
    Raster frame;
    frame.width = header.count("ncols");
    frame.height = header.count("nrows");
    frame.x = header.centres('x');
    frame.y = header.centres('y');
    return frame;
  });
}

class AscReader : public RasterReader {
 public:
  AscReader(const std::string& name, std::unique_ptr<ByteSource> text, Reference reference)
      : name_(name), text_(std::move(text)) {
    Words words(name_, *text_, begin_of(*text_));
    const Header header = read_header(words);
    no_data_ = header.no_data;
    frame_ = frame_of(name_, header);
    frame_.reference = std::move(reference);
    DecimalRange range;
    const uint64_t count = uint64_t{frame_.width} * frame_.height;
    for_each_height(words, no_data_, count,
                    [&](const std::optional<Decimal>& height, uint64_t number) {
                      if (number % kStride == 0) marks_.push_back(words.offset());
                      return !height || range.add(*height);
                    });
    frame_.decimals = range.decimals();
  }

  Raster read(const PostRectangle& r) const override {
    Raster part = crop_frame(frame_, r);
    part.heights.resize(size_t{r.width} * r.height);
    for (uint32_t y = 0; y < r.height; ++y) {
      const uint64_t from_north = frame_.height - 1 - (r.y + y);
      read_row(from_north * frame_.width + r.x, r.width, &part.heights[size_t{y} * r.width]);
    }
    return part;
  }

 private:
  void read_row(uint64_t first, uint32_t width, int64_t* heights) const {
    constexpr size_t kBytesPerHeight = 8;  // or more, or less
    Words words(name_, *text_, marks_[first / kStride],
                (first % kStride + width) * kBytesPerHeight);
    for (uint64_t skipped = 0; skipped < first % kStride; ++skipped) words.next();
    for (uint32_t x = 0; x < width; ++x) {
      words.next();
      heights[x] = mantissa_of(words.word());
    }
  }

  // What was read once cannot be wrong, unless it is changed meanwhile.
  int64_t mantissa_of(std::string_view word) const {
    if (no_data_.marks(word)) return kVoidHeight;
    const std::optional<Decimal> height = parse_decimal(word);
    DecimalRange range;
    if (!height || height->decimals > frame_.decimals || !range.add(*height)) {
      throw Error(name_ + ": changed while it was read; start again when it is complete");
    }
    return static_cast<int64_t>(mantissa_at(*height, frame_.decimals));
  }

  static constexpr uint64_t kStride = 512;

  std::string name_;
  std::unique_ptr<ByteSource> text_;
  NoData no_data_;
  std::vector<uint64_t> marks_;  // where every kStride-th height is in the text
};

}  // namespace

bool is_grid(std::string_view text) {
  text = without_mark(text);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\v\f\r\n"), text.size()));
  const std::string key =
      lower_case(std::string(text.substr(0, text.find_first_of(" \t\v\f\r\n"))));
  return key == kNoDataKey || is_known(key);
}

std::unique_ptr<RasterReader> open_asc(const std::string& name, std::unique_ptr<ByteSource> text,
                                       Reference reference) {
  return std::make_unique<AscReader>(name, std::move(text), std::move(reference));
}

Raster import_asc(const std::string& name, const std::string& text) {
  const std::unique_ptr<ByteSource> bytes = bytes_in_memory({text.begin(), text.end()});
  Words words(name, *bytes, begin_of(*bytes));
  const Header header = read_header(words);
  Raster raster = frame_of(name, header);
  DecimalColumn heights;
  for_each_height(words, header.no_data, uint64_t{raster.width} * raster.height,
                  [&](const std::optional<Decimal>& height, uint64_t) {
                    if (height) return heights.add(*height);
                    heights.add_void();
                    return true;
                  });
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

}  // namespace microtin::importing
