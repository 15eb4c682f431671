// SPDX-License-Identifier: MIT
// Notes as format-stream.md lays them down.
#include "encoder/stream/notes.hpp"

#include <bitset>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/stream/header.hpp"
#include "shared/header.hpp"

namespace microtin::stream {
namespace {

using Bytes = std::vector<uint8_t>;

// --- Writing -------------------------------------------------------------------------------------

void append_note(Bytes& notes, microtin_note_type type, const Bytes& content) {
  if (content.size() > UINT16_MAX) throw Error("a text for the header is longer than 65,535 bytes");
  notes.push_back(static_cast<uint8_t>(type));
  append_number(notes, static_cast<uint32_t>(content.size()), 2);
  notes.insert(notes.end(), content.begin(), content.end());
}

void append_text(Bytes& notes, microtin_note_type type, const std::string& text) {
  if (!text.empty()) append_note(notes, type, Bytes(text.begin(), text.end()));
}

void append_decimal(Bytes& bytes, Decimal value) {
  append_varint(bytes, zigzag(value.mantissa));
  bytes.push_back(static_cast<uint8_t>(value.decimals));
}

void append_accuracy(Bytes& notes, microtin_note_type type,
                     const std::optional<Accuracy>& accuracy) {
  if (!accuracy) return;
  Bytes content;
  content.push_back(accuracy->bound.has_value() ? 1 : 0);
  if (accuracy->bound) append_decimal(content, *accuracy->bound);
  append_decimal(content, accuracy->max_error);
  append_decimal(content, accuracy->rms_error);
  append_decimal(content, accuracy->mean_error);
  append_note(notes, type, content);
}

void append_units(Bytes& notes, const Metadata& m) {
  if (m.horizontal_unit == Unit::kUnknown && m.vertical_unit == Unit::kUnknown) return;
  append_note(notes, MICROTIN_NOTE_UNITS,
              {static_cast<uint8_t>(m.horizontal_unit), static_cast<uint8_t>(m.vertical_unit)});
}

void append_systems(Bytes& notes, const Metadata& m) {
  if (m.horizontal_epsg == 0 && m.vertical_epsg == 0) return;
  Bytes content;
  append_varint(content, m.horizontal_epsg);
  append_varint(content, m.vertical_epsg);
  append_note(notes, MICROTIN_NOTE_SYSTEMS, content);
}

// Posts that are places of the lattice need no axes.
void append_grid(Bytes& notes, const Metadata& m) {
  if (!m.grid) return;
  Bytes content;
  append_varint(content, m.grid->columns);
  append_varint(content, m.grid->rows);
  if (!is_same(m.grid->x, m.placement.x) || !is_same(m.grid->y, m.placement.y)) {
    append_axis(content, m.grid->x);
    append_axis(content, m.grid->y);
  }
  append_note(notes, MICROTIN_NOTE_GRID, content);
}

// The first and the last class of each run.
void append_classes(Bytes& notes, const std::optional<ClassSet>& classes) {
  if (!classes) return;
  Bytes content;
  const auto is_taken = [&](size_t c) { return c < classes->size() && (*classes)[c]; };
  for (size_t c = 0; c < classes->size(); ++c) {
    if (!is_taken(c)) continue;
    if (c == 0 || !is_taken(c - 1)) content.push_back(static_cast<uint8_t>(c));
    if (!is_taken(c + 1)) content.push_back(static_cast<uint8_t>(c));
  }
  append_note(notes, MICROTIN_NOTE_CLASSES, content);
}

// --- Reading -------------------------------------------------------------------------------------

[[noreturn]] void refuse() {
  throw Error("malformed note in the header");
}

// Reads the content of one note from front to back.
class NoteReader {
 public:
  NoteReader(const uint8_t* begin, const uint8_t* end) : next_(begin), end_(end) {}

  bool at_end() const { return next_ == end_; }
  std::string text() const { return {next_, end_}; }

  uint64_t number() {
    uint64_t value = 0;
    if (!read_varint(&next_, end_, &value)) refuse();
    return value;
  }

  uint32_t number32() {
    const uint64_t value = number();
    if (value > UINT32_MAX) refuse();
    return static_cast<uint32_t>(value);
  }

  uint8_t byte() {
    if (at_end()) refuse();
    return *next_++;
  }

  Decimal decimal() {
    Decimal value;
    value.mantissa = unzigzag(number());
    value.decimals = byte();
    if (value.decimals > 18) refuse();
    return value;
  }

  Axis axis() {
    Axis axis;
    if (!read_axis(&next_, end_, &axis)) refuse();
    return axis;
  }

 private:
  static int64_t unzigzag(uint64_t value) {
    return static_cast<int64_t>(value >> 1 ^ (0 - (value & 1)));
  }

  const uint8_t* next_;
  const uint8_t* end_;
};

Unit unit_of(uint8_t code) {
  return code <= static_cast<uint8_t>(Unit::kUsSurveyFoot) ? static_cast<Unit>(code)
                                                           : Unit::kUnknown;
}

Accuracy read_accuracy(NoteReader& reader) {
  Accuracy accuracy;
  if (reader.byte() != 0) accuracy.bound = reader.decimal();
  accuracy.max_error = reader.decimal();
  accuracy.rms_error = reader.decimal();
  accuracy.mean_error = reader.decimal();
  return accuracy;
}

PostGrid read_grid(NoteReader& reader, const Placement& placement) {
  PostGrid grid{reader.number32(), reader.number32(), placement.x, placement.y};
  if (grid.columns == 0 || grid.rows == 0) refuse();
  if (reader.at_end()) return grid;
  grid.x = reader.axis();
  grid.y = reader.axis();
  return grid;
}

ClassSet read_classes(NoteReader& reader) {
  ClassSet classes;
  while (!reader.at_end()) {
    const uint8_t first = reader.byte(), last = reader.byte();
    if (first > last) refuse();
    for (size_t c = first; c <= last; ++c) classes.set(c);
  }
  return classes;
}

DuplicateRule read_duplicates(NoteReader& reader) {
  const uint8_t rule = reader.byte();
  return rule <= static_cast<uint8_t>(DuplicateRule::kMedian) ? static_cast<DuplicateRule>(rule)
                                                              : DuplicateRule::kUnknown;
}

void read_note(uint8_t type, NoteReader reader, Metadata& m) {
  switch (type) {
    case MICROTIN_NOTE_UNITS:
      m.horizontal_unit = unit_of(reader.byte());
      m.vertical_unit = unit_of(reader.byte());
      break;
    case MICROTIN_NOTE_SYSTEMS:
      m.horizontal_epsg = reader.number32();
      m.vertical_epsg = reader.number32();
      break;
    case MICROTIN_NOTE_ORIGIN:
      m.source = reader.text();
      break;
    case MICROTIN_NOTE_ACCURACY:
      m.accuracy = read_accuracy(reader);
      break;
    case MICROTIN_NOTE_DATE:
      m.date = reader.text();
      break;
    case MICROTIN_NOTE_LINEAGE:
      m.lineage = reader.text();
      break;
    case MICROTIN_NOTE_WATER:
      m.water_level = reader.decimal();
      break;
    case MICROTIN_NOTE_GRID:
      m.grid = read_grid(reader, m.placement);
      break;
    case MICROTIN_NOTE_WKT:
      m.wkt = reader.text();
      break;
    case MICROTIN_NOTE_CLASSES:
      m.classes = read_classes(reader);
      break;
    case MICROTIN_NOTE_DUPLICATES:
      m.duplicates = read_duplicates(reader);
      break;
    case MICROTIN_NOTE_TRUE_PLACES:
      m.true_places = read_accuracy(reader);
      break;
    default:
      break;
  }
}

}  // namespace

Bytes write_notes(const Metadata& m) {
  Bytes notes;
  append_units(notes, m);
  append_systems(notes, m);
  append_text(notes, MICROTIN_NOTE_WKT, m.wkt);
  append_text(notes, MICROTIN_NOTE_ORIGIN, m.source);
  append_accuracy(notes, MICROTIN_NOTE_ACCURACY, m.accuracy);
  append_accuracy(notes, MICROTIN_NOTE_TRUE_PLACES, m.true_places);
  append_text(notes, MICROTIN_NOTE_DATE, m.date);
  append_text(notes, MICROTIN_NOTE_LINEAGE, m.lineage);
  if (m.water_level) {
    Bytes content;
    append_decimal(content, *m.water_level);
    append_note(notes, MICROTIN_NOTE_WATER, content);
  }
  append_grid(notes, m);
  append_classes(notes, m.classes);
  if (m.duplicates != DuplicateRule::kUnknown) {
    append_note(notes, MICROTIN_NOTE_DUPLICATES, {static_cast<uint8_t>(m.duplicates)});
  }
  if (notes.size() > kNotesMostBytes) {
    throw Error("the texts for the header are longer than 65,535 bytes");
  }
  return notes;
}

void read_notes(const uint8_t* begin, const uint8_t* end, Metadata& metadata) {
  std::bitset<256> known;
  for (const uint8_t* at = begin; at != end;) {
    if (end - at < std::ptrdiff_t{kNoteHeadBytes}) refuse();
    const uint8_t type = *at;
    const uint8_t* const content = at + kNoteHeadBytes;
    const uint32_t size = read_u16(at + 1);
    if (end - content < std::ptrdiff_t{size}) refuse();
    at = content + size;
    if (!known[type]) read_note(type, NoteReader(content, at), metadata);
    known.set(type);
  }
}

}  // namespace microtin::stream
