// SPDX-License-Identifier: MIT
// Header fields and notes as format-stream.md lays them down.
#include "encoder/stream/header.hpp"

#include <bitset>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "shared/crc32.hpp"
#include "shared/header.hpp"

namespace microtin::stream {
namespace {

using Bytes = std::vector<uint8_t>;

// --- Writing -------------------------------------------------------------------------------------

void append_note(Bytes& notes, microtin_note_type type, const Bytes& content) {
  if (content.size() > UINT16_MAX)
    throw Error("a text for the header is longer than 65,535 bytes; shorten it");
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

void append_surface(Bytes& notes, const Metadata& m) {
  if (m.surface == SurfaceKind::kUnknown && m.side == BoundSide::kNotStated && !m.at_samples) {
    return;
  }
  Bytes content = {static_cast<uint8_t>(m.surface), static_cast<uint8_t>(m.side)};
  if (m.at_samples) {
    append_decimal(content, m.at_samples->below);
    append_decimal(content, m.at_samples->above);
  }
  append_note(notes, MICROTIN_NOTE_SURFACE, content);
}

void append_epoch(Bytes& notes, const std::optional<Decimal>& epoch) {
  if (!epoch) return;
  Bytes content;
  append_decimal(content, *epoch);
  append_note(notes, MICROTIN_NOTE_EPOCH, content);
}

void append_source_accuracy(Bytes& notes, const std::optional<SourceAccuracy>& accuracy) {
  if (!accuracy) return;
  Bytes content = {static_cast<uint8_t>(accuracy->kind)};
  append_decimal(content, accuracy->value);
  append_note(notes, MICROTIN_NOTE_SOURCE_ACCURACY, content);
}

void append_source_notes(Bytes& notes, const SourceNotes& m) {
  append_text(notes, MICROTIN_NOTE_DATE, m.date);
  append_text(notes, MICROTIN_NOTE_LINEAGE, m.lineage);
  append_text(notes, MICROTIN_NOTE_ATTRIBUTION, m.attribution);
  append_text(notes, MICROTIN_NOTE_LICENSE, m.license);
  append_epoch(notes, m.epoch);
  append_text(notes, MICROTIN_NOTE_VALIDITY, m.valid);
  append_source_accuracy(notes, m.source_accuracy);
}

void append_bounds(Bytes& notes, const std::optional<StatedBounds>& bounds) {
  if (!bounds) return;
  Bytes content = write_span(bounds->span);
  append_decimal(content, bounds->max_error);
  append_decimal(content, bounds->unscaled);
  append_note(notes, MICROTIN_NOTE_BOUNDS, content);
}

void append_phases(Bytes& notes, const std::vector<PhaseEnd>& phases) {
  if (phases.empty()) return;
  Bytes content;
  append_varint(content, phases.size());
  for (const PhaseEnd& end : phases) {
    append_varint(content, end.vertices);
    append_varint(content, end.bytes);
    content.push_back(end.max_error ? 1 : 0);
    if (end.max_error) append_decimal(content, *end.max_error);
  }
  append_note(notes, MICROTIN_NOTE_PHASES, content);
}

void append_digest(Bytes& notes, const std::optional<uint64_t>& digest) {
  if (!digest) return;
  Bytes content;
  append_number(content, *digest, 8);
  append_note(notes, MICROTIN_NOTE_DIGEST, content);
}

void append_places(Bytes& notes, const std::vector<FilePlace>& places) {
  if (places.empty()) return;
  Bytes content;
  append_varint(content, places.size());
  for (const FilePlace& place : places) {
    content.push_back(static_cast<uint8_t>(place.kind));
    content.push_back(static_cast<uint8_t>(place.base));
    append_varint(content, place.offset);
    append_varint(content, place.size);
  }
  append_note(notes, MICROTIN_NOTE_PLACES, content);
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

void append_sums(Bytes& notes, const std::optional<TileSums>& sums) {
  if (!sums) return;
  Bytes content;
  append_varint(content, sums->vertices);
  append_varint(content, sums->tiles);
  append_note(notes, MICROTIN_NOTE_SUMS, content);
}

void expect_room(const Bytes& notes) {
  if (notes.size() <= kNotesMostBytes) return;
  throw Error("the texts for the header are longer than 65,535 bytes; shorten them");
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

Bytes write_span(const BoundSpan& span) {
  Bytes content;
  append_varint(content, span.bounded);
  append_varint(content, span.unbounded);
  append_decimal(content, span.least);
  append_decimal(content, span.largest);
  append_decimal(content, span.ratio);
  return content;
}

BoundSpan read_span(const uint8_t* begin, const uint8_t* end) {
  NoteReader reader(begin, end);
  return read_span(reader);
}

Bytes write_notes(const Metadata& m) {
  Bytes notes;
  append_units(notes, m);
  append_systems(notes, m);
  append_text(notes, MICROTIN_NOTE_WKT, m.wkt);
  append_text(notes, MICROTIN_NOTE_ORIGIN, m.source);
  append_accuracy(notes, MICROTIN_NOTE_ACCURACY, m.accuracy);
  append_accuracy(notes, MICROTIN_NOTE_TRUE_PLACES, m.true_places);
  append_surface(notes, m);
  append_bounds(notes, m.bounds);
  append_source_notes(notes, m);
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
  append_sums(notes, m.sums);
  append_phases(notes, m.phases);
  append_digest(notes, m.digest);
  append_places(notes, m.places);
  expect_room(notes);
  return notes;
}

void append_padding(Bytes& notes, size_t before, size_t alignment) {
  size_t size = (alignment - (before + notes.size()) % alignment) % alignment;
  if (size == 0) return;
  while (size < kNoteHeadBytes) size += alignment;
  append_note(notes, MICROTIN_NOTE_PADDING, Bytes(size - kNoteHeadBytes));
  expect_room(notes);
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

namespace {

using Bytes = std::vector<uint8_t>;

bool is_lattice_itself(const Axis& axis) {
  return axis.offset == 0 && axis.numerator == 1 && axis.denominator == 1;
}

}  // namespace

uint64_t zigzag(int64_t value) {
  return static_cast<uint64_t>(value) << 1 ^ static_cast<uint64_t>(value >> 63);
}

void append_axis(Bytes& bytes, const Axis& axis) {
  append_varint(bytes, zigzag(axis.offset));
  append_varint(bytes, axis.numerator);
  append_varint(bytes, axis.denominator);
}

void append_varint(Bytes& bytes, uint64_t value) {
  int groups = 1;
  while (groups < 10 && value >> 7 * groups != 0) ++groups;
  while (--groups > 0) bytes.push_back(static_cast<uint8_t>(value >> 7 * groups | 128));
  bytes.push_back(static_cast<uint8_t>(value & 127));
}

void append_number(Bytes& bytes, uint64_t value, int width) {
  for (int i = 0; i < width; ++i) bytes.push_back(static_cast<uint8_t>(value >> 8 * i));
}

void append_check(Bytes& bytes, size_t from) {
  append_number(bytes, crc32(0, bytes.data() + from, bytes.size() - from), 4);
}

Bytes write_placement(const Placement& p) {
  Bytes content;
  if (is_lattice_itself(p.x) && is_lattice_itself(p.y) && is_lattice_itself(p.z)) return content;
  append_axis(content, p.x);
  append_axis(content, p.y);
  append_axis(content, p.z);
  return content;
}

Bytes write_header(const Contract& contract, const Metadata& metadata) {
  const Bytes placement = write_placement(metadata.placement);
  const Bytes notes = write_notes(metadata);
  Bytes payload;
  const bool has_margins = contract.below != kNotStated || contract.above != kNotStated;
  append_varint(payload,
                (contract.has_heights ? kHasHeights : 0) | (contract.has_voids ? kHasVoids : 0) |
                    (placement.empty() ? 0 : kHasPlacement) |
                    (contract.odd_origin_x ? kOddOriginX : 0) |
                    (contract.odd_origin_y ? kOddOriginY : 0) | (has_margins ? kHasMargins : 0) |
                    static_cast<uint32_t>(contract.coding) << 3 | contract.degree << 5);
  append_varint(payload, contract.vertices);
  append_varint(payload, contract.x_max);
  append_varint(payload, contract.y_max);
  if (has_margins) {
    append_varint(payload, contract.below + 1u);  // not stated: 0
    append_varint(payload, contract.above + 1u);
  }
  payload.insert(payload.end(), placement.begin(), placement.end());
  payload.insert(payload.end(), notes.begin(), notes.end());
  Bytes header(kMagic, kMagic + sizeof kMagic);
  header.push_back(kVersion);
  append_varint(header, payload.size());
  header.insert(header.end(), payload.begin(), payload.end());
  append_check(header, 0);
  return header;
}

Header read_header(const Bytes& stream) {
  Header header;
  microtin_status status = microtin_read_stream_info(stream.data(), stream.size(), &header.info);
  if (status == MICROTIN_STATUS_NEED_INPUT) status = MICROTIN_STATUS_TRUNCATED;
  if (status != MICROTIN_STATUS_OK) throw Error(describe(status));
  const uint8_t* const end = stream.data() + header.info.header_bytes - kCheckBytes;
  const uint8_t* next = stream.data() + kIdentityBytes;
  uint64_t length = 0;
  microtin_axis axis[3];
  read_varint(&next, end, &length);
  read_header(&next, end, &header.contract, axis);
  header.metadata.placement = {axis[0], axis[1], axis[2]};
  header.metadata.everywhere = {header.contract.below, header.contract.above};
  read_notes(next, end, header.metadata);
  return header;
}

Bytes with_metadata(const Bytes& stream, const Metadata& metadata) {
  const Header old = read_header(stream);
  Contract contract = old.contract;
  contract.below = metadata.everywhere.below;
  contract.above = metadata.everywhere.above;
  Bytes changed = write_header(contract, metadata);
  changed.insert(changed.end(), stream.begin() + old.info.header_bytes, stream.end());
  read_header(changed);  // throws if a decoder would refuse it; the rest was not touched
  return changed;
}

}  // namespace microtin::stream
