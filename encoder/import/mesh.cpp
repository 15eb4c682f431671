// SPDX-License-Identifier: MIT
// Vertices of mesh files: PLY, text or binary, and Wavefront OBJ.
#include <algorithm>
#include <array>

#include "encoder/base/error.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/crs.hpp"
#include "encoder/import/import.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {

// PLY, the Stanford polygon format: of its elements the vertices, of these x, y and z.
// Ours: a reader that keeps the decimals of text as they are is not at hand.

namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

constexpr std::array<uint64_t, 8> kTypeBytes = {1, 1, 2, 2, 4, 4, 4, 8};

std::optional<Type> type_named(std::string_view name) {
  constexpr std::array<std::string_view, 16> kNames = {
      "char", "uchar", "short", "ushort", "int",   "uint",   "float",   "double",
      "int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"};
  for (size_t i = 0; i < kNames.size(); ++i) {
    if (kNames[i] == name) return static_cast<Type>(i % 8);
  }
  return std::nullopt;
}

struct Property {
  std::string name;
  Type type;
  std::optional<Type> list_count;  // a list: the type of its length
};

struct Element {
  std::string name;
  uint64_t count;
  std::vector<Property> properties;
};

enum class Encoding { kText, kLittleEndian, kBigEndian };

class HeaderReader {
 public:
  HeaderReader(const std::string& name, std::string_view text)
      : name_(name), rest_(without_mark(text)), line_end_(line_end_of(rest_)) {
    read();
  }

  Encoding encoding() const { return *encoding_; }
  const std::vector<Element>& elements() const { return elements_; }
  const Reference& reference() const { return reference_; }
  std::string_view rest() const { return rest_; }  // behind the header
  size_t lines() const { return line_; }

 private:
  void read() {
    if (!next_line() || fields_.size() != 1 || fields_[0] != "ply") fail("is not a PLY file");
    while (next_line()) {
      if (fields_.empty() || fields_[0] == "obj_info") continue;
      if (fields_[0] == "comment") {
        read_comment();
        continue;
      }
      if (fields_[0] == "end_header") {
        if (!encoding_) fail("the header lacks the format");
        return;
      }
      if (fields_[0] == "format") {
        read_format();
      } else if (fields_[0] == "element") {
        read_element();
      } else if (fields_[0] == "property") {
        read_property();
      } else {
        fail(quoted(fields_[0]) + " is not a keyword of a PLY header");
      }
    }
    fail("the header does not end");
  }

  // A binary body follows the last line at once, so that all lines must end as the first one does;
  // the CR of CR LF is a blank.
  static char line_end_of(std::string_view text) {
    const size_t end = text.find_first_of("\r\n");
    return end != text.npos && text[end] == '\r' && text.substr(end, 2) != "\r\n" ? '\r' : '\n';
  }

  bool next_line() {
    if (rest_.empty()) return false;
    ++line_;
    const size_t end = std::min(rest_.find(line_end_), rest_.size());
    text_ = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    split_at_blanks(text_, fields_);
    return true;
  }

  // "comment crs: ...", as the mesh reader of QGIS has it, or without the colon, as it had.
  void read_comment() {
    if (fields_.size() < 3 || (fields_[1] != "crs:" && fields_[1] != "crs")) return;
    const auto start = static_cast<size_t>(fields_[2].data() - text_.data());
    const std::string_view system =
        text_.substr(start, text_.find_last_not_of(" \t\r") + 1 - start);
    reference_ = reference_of_line(system);
  }

  void read_format() {
    const std::string_view format = fields_.size() == 3 ? fields_[1] : "";
    if (format == "ascii") encoding_ = Encoding::kText;
    if (format == "binary_little_endian") encoding_ = Encoding::kLittleEndian;
    if (format == "binary_big_endian") encoding_ = Encoding::kBigEndian;
    if (!encoding_) fail("the format is not one of PLY's");
  }

  void read_element() {
    const auto count = fields_.size() == 3 ? parse_decimal(fields_[2]) : std::nullopt;
    if (!count || count->decimals != 0 || count->mantissa < 0) fail("an element needs a count");
    elements_.push_back({std::string(fields_[1]), static_cast<uint64_t>(count->mantissa), {}});
  }

  void read_property() {
    if (elements_.empty()) fail("a property comes before any element");
    const bool list = fields_.size() == 5 && fields_[1] == "list";
    if (!list && fields_.size() != 3) fail("a property needs a type and a name");
    const auto count = list ? type_named(fields_[2]) : std::nullopt;
    const auto type = type_named(fields_[list ? 3 : 1]);
    const bool whole = !count || (*count != Type::kFloat && *count != Type::kDouble);
    if (!type || (list && !count) || !whole) fail("the property's type is not one of PLY's");
    elements_.back().properties.push_back({std::string(fields_.back()), *type, count});
  }

  [[noreturn]] void fail(const std::string& what) const { fail_at(name_, line_, what); }

  const std::string& name_;
  std::string_view rest_, text_;  // text_: the line
  char line_end_;
  size_t line_ = 0;
  std::vector<std::string_view> fields_;
  Reference reference_;
  std::optional<Encoding> encoding_;
  std::vector<Element> elements_;
};

// Which property has a name; their number if none has.
size_t property_named(const Element& element, char name) {
  size_t at = 0;
  const auto is_it = [&](const Property& property) {
    return !property.list_count && property.name == std::string(1, name);
  };
  while (at < element.properties.size() && !is_it(element.properties[at])) ++at;
  return at;
}

// Where x, y and z, or X, Y and Z, stand among the properties of vertices.
std::array<size_t, 3> find_axes(const std::string& name, const Element& vertices) {
  std::array<size_t, 3> found{};
  for (size_t axis = 0; axis < 3; ++axis) {
    const size_t small = property_named(vertices, "xyz"[axis]);
    const bool is_small = small < vertices.properties.size();
    found[axis] = is_small ? small : property_named(vertices, "XYZ"[axis]);
    if (found[axis] == vertices.properties.size()) {
      throw Error(name + ": its vertices have no property " + "xyz"[axis]);
    }
  }
  return found;
}

// One element a line.
class TextBody {
 public:
  TextBody(const std::string& name, const HeaderReader& header)
      : name_(name), rest_(header.rest()), line_(header.lines()) {}

  void skip(const Element& element) {
    for (uint64_t i = 0; i < element.count; ++i) next_line();
  }

  PointColumns read(const Element& vertices) {
    const std::array<size_t, 3> axes = find_axes(name_, vertices);
    PointColumns points;
    for (uint64_t i = 0; i < vertices.count; ++i) {
      next_line();
      find_values(vertices);
      for (size_t axis = 0; axis < 3; ++axis) {
        const std::string_view word = fields_[values_[axes[axis]]];
        const std::optional<Decimal> value = parse_decimal(word);
        if (!value || !points.add(axis, *value)) {
          fail_at(name_, line_, not_a_number(word));
        }
      }
    }
    return points;
  }

 private:
  void next_line() {
    do {
      if (rest_.empty()) fail_at(name_, line_, "the file ends before its elements do");
      ++line_;
      split_at_blanks(take_line(rest_), fields_);
    } while (fields_.empty());
  }

  // Which field each property begins with.
  void find_values(const Element& element) {
    values_.clear();
    size_t at = 0;
    for (const Property& property : element.properties) {
      values_.push_back(at);
      if (at < fields_.size() && property.list_count) {
        const auto length = parse_decimal(fields_[at]);
        const bool counts = length && length->decimals == 0 && length->mantissa >= 0;
        at += counts ? std::min(static_cast<size_t>(length->mantissa), fields_.size())
                     : fields_.size();
      }
      ++at;
    }
    if (at != fields_.size()) fail_at(name_, line_, "the line does not hold the element's values");
  }

  const std::string& name_;
  std::string_view rest_;
  size_t line_;
  std::vector<std::string_view> fields_;
  std::vector<size_t> values_;
};

class BinaryBody {
 public:
  BinaryBody(const std::string& name, const HeaderReader& header)
      : name_(name),
        bytes_(name, header.rest(),
               header.encoding() == Encoding::kBigEndian ? ByteOrder::kBigEndian
                                                         : ByteOrder::kLittleEndian) {}

  void skip(const Element& element) {
    if (element.properties.empty()) return;
    for (uint64_t i = 0; i < element.count; ++i) find_values(element);
  }

  PointColumns read(const Element& vertices) {
    const std::array<size_t, 3> axes = find_axes(name_, vertices);
    PointColumns points;
    for (uint64_t i = 0; i < vertices.count; ++i) {
      find_values(vertices);
      for (size_t axis = 0; axis < 3; ++axis) {
        const std::optional<Decimal> value =
            value_at(values_[axes[axis]], vertices.properties[axes[axis]].type);
        if (!value || !points.add(axis, *value)) {
          bytes_.fail("vertex " + std::to_string(i) + ": " + "xyz"[axis] +
                      " is not a number in range");
        }
      }
    }
    return points;
  }

 private:
  // Where each property begins; goes on to the next element.
  void find_values(const Element& element) {
    values_.clear();
    for (const Property& property : element.properties) {
      values_.push_back(at_);
      uint64_t count = 1;
      if (property.list_count) {
        const std::optional<Decimal> length = value_at(at_, *property.list_count);
        if (length->mantissa < 0) bytes_.fail("a list has a negative length");
        count = static_cast<uint64_t>(length->mantissa);
        at_ += kTypeBytes[static_cast<size_t>(*property.list_count)];
      }
      const uint64_t size = count * kTypeBytes[static_cast<size_t>(property.type)];
      bytes_.bytes(at_, size);
      at_ += size;
    }
  }

  std::optional<Decimal> value_at(uint64_t at, Type type) const {
    switch (type) {
      case Type::kInt8:
        return Decimal{bytes_.number<int8_t>(at), 0};
      case Type::kUint8:
        return Decimal{bytes_.number<uint8_t>(at), 0};
      case Type::kInt16:
        return Decimal{bytes_.number<int16_t>(at), 0};
      case Type::kUint16:
        return Decimal{bytes_.number<uint16_t>(at), 0};
      case Type::kInt32:
        return Decimal{bytes_.number<int32_t>(at), 0};
      case Type::kUint32:
        return Decimal{bytes_.number<uint32_t>(at), 0};
      case Type::kFloat:
        return shortest_decimal(bytes_.number<float>(at));
      case Type::kDouble:
        return shortest_decimal(bytes_.number<double>(at));
    }
    return std::nullopt;
  }

  const std::string& name_;
  ByteReader bytes_;
  uint64_t at_ = 0;
  std::vector<uint64_t> values_;
};

template <class Body>
PointCloud read_vertices(const std::string& name, const HeaderReader& header) {
  Body body(name, header);
  for (const Element& element : header.elements()) {
    if (element.name != "vertex") {
      body.skip(element);
      continue;
    }
    PointColumns points = body.read(element);
    if (points.empty()) continue;
    PointCloud cloud = points.take();
    cloud.reference = header.reference();
    return cloud;
  }
  throw Error(name + ": holds no vertex");
}

}  // namespace

PointCloud import_ply(const std::string& name, const std::string& bytes) {
  const HeaderReader header(name, bytes);
  return header.encoding() == Encoding::kText ? read_vertices<TextBody>(name, header)
                                              : read_vertices<BinaryBody>(name, header);
}

PointCloud import_obj(const std::string& name, const std::string& text) {
  PointColumns points;
  std::vector<std::string_view> fields;
  std::string_view rest = without_mark(text);
  for (size_t line = 1; !rest.empty(); ++line) {
    split_at_blanks(take_line(rest), fields);
    if (fields.empty() || fields[0] != "v") continue;
    if (fields.size() < 4) fail_at(name, line, "a vertex needs three numbers");
    for (size_t i = 1; i < fields.size(); ++i) {
      const std::optional<Decimal> value = parse_decimal(fields[i]);
      if (!value || (i <= 3 && !points.add(i - 1, *value))) {
        fail_at(name, line, not_a_number(fields[i]));
      }
    }
  }
  if (points.empty()) throw Error(name + ": holds no vertex");
  return points.take();
}

}  // namespace microtin::importing
