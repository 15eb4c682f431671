// SPDX-License-Identifier: MIT
// Reading the notes of headers, which may be damaged.
#include <bitset>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/stream/header.hpp"
#include "shared/header.hpp"

namespace microtin::stream {
namespace {

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

// The enumerator of a number; the first, which is unknown, if it is beyond the last.
template <class Enum>
Enum known(uint8_t number, Enum last) {
  return static_cast<Enum>(number <= static_cast<uint8_t>(last) ? number : 0);
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

// A number that is not known here states nothing.
void read_surface(NoteReader& reader, Metadata& m) {
  const uint8_t kind = reader.byte(), side = reader.byte();
  m.surface = known(kind, SurfaceKind::kObstacles);
  m.side = known(side, BoundSide::kNeverAbove);
  if (reader.at_end()) return;
  const Distances found{reader.decimal(), reader.decimal()};
  if (found.below.mantissa < 0 || found.above.mantissa < 0) refuse();
  m.at_samples = found;
}

BoundSpan read_span(NoteReader& reader) {
  BoundSpan span{reader.number(), reader.number(), reader.decimal(), reader.decimal(),
                 reader.decimal()};
  for (const Decimal& number : {span.least, span.largest, span.ratio}) {
    if (number.mantissa < 0) refuse();
  }
  return span;
}

StatedBounds read_bounds(NoteReader& reader) {
  const BoundSpan span = read_span(reader);
  const Decimal max_error = reader.decimal();
  StatedBounds bounds{span, max_error, reader.decimal()};
  if (bounds.max_error.mantissa < 0 || bounds.unscaled.mantissa < 0) refuse();
  return bounds;
}

std::vector<PhaseEnd> read_phases(NoteReader& reader) {
  std::vector<PhaseEnd> phases;
  for (uint64_t left = reader.number(); left != 0; --left) {
    PhaseEnd end{reader.number32(), reader.number(), std::nullopt};
    if (reader.byte() != 0) end.max_error = reader.decimal();
    if (end.max_error && end.max_error->mantissa < 0) refuse();
    phases.push_back(end);
  }
  return phases;
}

uint64_t read_digest(NoteReader& reader) {
  uint64_t digest = 0;
  for (int i = 0; i < 8; ++i) digest |= uint64_t{reader.byte()} << 8 * i;
  return digest;
}

std::vector<FilePlace> read_places(NoteReader& reader) {
  std::vector<FilePlace> places;
  for (uint64_t left = reader.number(); left != 0; --left) {
    const PlaceKind kind = known(reader.byte(), PlaceKind::kErrors);
    const PlaceBase base = known(reader.byte(), PlaceBase::kEnd);
    const uint64_t offset = reader.number();
    places.push_back({kind, base, offset, reader.number()});
  }
  return places;
}

// A kind that is not known here keeps its number without a name.
SourceAccuracy read_source_accuracy(NoteReader& reader) {
  const AccuracyKind kind = known(reader.byte(), AccuracyKind::kLe95);
  const SourceAccuracy accuracy{kind, reader.decimal()};
  if (accuracy.value.mantissa < 0) refuse();
  return accuracy;
}

TileSums read_sums(NoteReader& reader) {
  const uint64_t vertices = reader.number();
  return {vertices, reader.number()};
}

void read_source_note(uint8_t type, NoteReader reader, SourceNotes& m) {
  switch (type) {
    case MICROTIN_NOTE_ORIGIN:
      m.source = reader.text();
      break;
    case MICROTIN_NOTE_DATE:
      m.date = reader.text();
      break;
    case MICROTIN_NOTE_LINEAGE:
      m.lineage = reader.text();
      break;
    case MICROTIN_NOTE_ATTRIBUTION:
      m.attribution = reader.text();
      break;
    case MICROTIN_NOTE_LICENSE:
      m.license = reader.text();
      break;
    case MICROTIN_NOTE_EPOCH:
      m.epoch = reader.decimal();
      break;
    case MICROTIN_NOTE_VALIDITY:
      m.valid = reader.text();
      break;
    case MICROTIN_NOTE_SOURCE_ACCURACY:
      m.source_accuracy = read_source_accuracy(reader);
      break;
    default:
      break;
  }
}

void read_note(uint8_t type, NoteReader reader, Metadata& m) {
  switch (type) {
    case MICROTIN_NOTE_UNITS:
      m.horizontal_unit = known(reader.byte(), Unit::kUsSurveyFoot);
      m.vertical_unit = known(reader.byte(), Unit::kUsSurveyFoot);
      break;
    case MICROTIN_NOTE_SYSTEMS:
      m.horizontal_epsg = reader.number32();
      m.vertical_epsg = reader.number32();
      break;
    case MICROTIN_NOTE_ACCURACY:
      m.accuracy = read_accuracy(reader);
      break;
    case MICROTIN_NOTE_SURFACE:
      read_surface(reader, m);
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
      m.duplicates = known(reader.byte(), DuplicateRule::kMedian);
      break;
    case MICROTIN_NOTE_TRUE_PLACES:
      m.true_places = read_accuracy(reader);
      break;
    case MICROTIN_NOTE_SUMS:
      m.sums = read_sums(reader);
      break;
    case MICROTIN_NOTE_PHASES:
      m.phases = read_phases(reader);
      break;
    case MICROTIN_NOTE_DIGEST:
      m.digest = read_digest(reader);
      break;
    case MICROTIN_NOTE_PLACES:
      m.places = read_places(reader);
      break;
    case MICROTIN_NOTE_BOUNDS:
      m.bounds = read_bounds(reader);
      break;
    default:
      read_source_note(type, reader, m);
      break;
  }
}

}  // namespace

BoundSpan read_span(const uint8_t* begin, const uint8_t* end) {
  NoteReader reader(begin, end);
  return read_span(reader);
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
