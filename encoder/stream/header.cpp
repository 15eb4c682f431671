// SPDX-License-Identifier: MIT
// Header fields and notes as FORMAT.md lays them down.
#include "encoder/stream/header.hpp"

#include "encoder/base/error.hpp"
#include "encoder/base/status_text.hpp"
#include "shared/crc32.hpp"
#include "shared/header.hpp"

namespace microtin::stream {
namespace {

using Bytes = std::vector<uint8_t>;

uint64_t zigzag(int64_t value) {
  return static_cast<uint64_t>(value) << 1 ^ static_cast<uint64_t>(value >> 63);
}

int64_t unzigzag(uint64_t value) {
  return static_cast<int64_t>(value >> 1 ^ (0 - (value & 1)));
}

void append_note(Bytes& notes, uint8_t type, const Bytes& content) {
  notes.push_back(type);
  append_number(notes, static_cast<uint32_t>(content.size()), 2);
  notes.insert(notes.end(), content.begin(), content.end());
}

void append_text(Bytes& notes, uint8_t type, const std::string& text) {
  if (!text.empty()) append_note(notes, type, Bytes(text.begin(), text.end()));
}

void append_axis(Bytes& bytes, const Axis& axis) {
  append_varint(bytes, zigzag(axis.offset));
  append_varint(bytes, axis.numerator);
  append_varint(bytes, axis.denominator);
}

void append_decimal(Bytes& bytes, Decimal value) {
  append_varint(bytes, zigzag(value.mantissa));
  bytes.push_back(static_cast<uint8_t>(value.decimals));
}

bool is_lattice_itself(const Axis& axis) {
  return axis.offset == 0 && axis.numerator == 1 && axis.denominator == 1;
}

Bytes accuracy_content(const Accuracy& accuracy) {
  Bytes content;
  content.push_back(accuracy.bound.has_value() ? 1 : 0);
  if (accuracy.bound) append_decimal(content, *accuracy.bound);
  append_decimal(content, accuracy.max_error);
  append_decimal(content, accuracy.rms_error);
  return content;
}

// Reads the content of one note from front to back.
class NoteReader {
 public:
  NoteReader(const uint8_t* begin, const uint8_t* end) : next_(begin), end_(end) {}

  uint64_t number() {
    uint64_t value = 0;
    if (!read_varint(&next_, end_, &value)) throw Error("malformed note in the header");
    return value;
  }

  uint32_t number32() {
    const uint64_t value = number();
    if (value > UINT32_MAX) throw Error("malformed note in the header");
    return static_cast<uint32_t>(value);
  }

  uint8_t byte() {
    if (next_ == end_) throw Error("malformed note in the header");
    return *next_++;
  }

  Decimal decimal() {
    Decimal value;
    value.mantissa = unzigzag(number());
    value.decimals = byte();
    if (value.decimals > 18) throw Error("malformed note in the header");
    return value;
  }

 private:
  const uint8_t* next_;
  const uint8_t* end_;
};

Unit unit_of(uint8_t code) {
  return code <= static_cast<uint8_t>(Unit::kUsSurveyFoot) ? static_cast<Unit>(code)
                                                           : Unit::kUnknown;
}

void read_note(uint8_t type, const uint8_t* begin, const uint8_t* end, Metadata& m) {
  NoteReader reader(begin, end);
  if (type == kNoteUnits) {
    m.horizontal_unit = unit_of(reader.byte());
    m.vertical_unit = unit_of(reader.byte());
  } else if (type == kNoteEpsg) {
    m.horizontal_epsg = reader.number32();
    m.vertical_epsg = reader.number32();
  } else if (type == kNoteSource) {
    m.source.assign(begin, end);
  } else if (type == kNoteAccuracy) {
    Accuracy accuracy;
    if (reader.byte() != 0) accuracy.bound = reader.decimal();
    accuracy.max_error = reader.decimal();
    accuracy.rms_error = reader.decimal();
    m.accuracy = accuracy;
  } else if (type == kNoteDate) {
    m.date.assign(begin, end);
  } else if (type == kNoteLineage) {
    m.lineage.assign(begin, end);
  } else if (type == kNoteWater) {
    m.water_level = reader.decimal();
  }
}

}  // namespace

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

Bytes write_notes(const Metadata& m) {
  Bytes notes;
  if (m.horizontal_unit != Unit::kUnknown || m.vertical_unit != Unit::kUnknown) {
    append_note(notes, kNoteUnits,
                {static_cast<uint8_t>(m.horizontal_unit), static_cast<uint8_t>(m.vertical_unit)});
  }
  if (m.horizontal_epsg != 0 || m.vertical_epsg != 0) {
    Bytes content;
    append_varint(content, m.horizontal_epsg);
    append_varint(content, m.vertical_epsg);
    append_note(notes, kNoteEpsg, content);
  }
  append_text(notes, kNoteSource, m.source);
  if (m.accuracy) append_note(notes, kNoteAccuracy, accuracy_content(*m.accuracy));
  append_text(notes, kNoteDate, m.date);
  append_text(notes, kNoteLineage, m.lineage);
  if (m.water_level) {
    Bytes content;
    append_decimal(content, *m.water_level);
    append_note(notes, kNoteWater, content);
  }
  if (notes.size() > 65535) throw Error("the texts for the header are longer than 65,535 bytes");
  return notes;
}

Bytes write_header(const Contract& contract, const Metadata& metadata) {
  const Bytes placement = write_placement(metadata.placement);
  const Bytes notes = write_notes(metadata);
  Bytes payload;
  append_varint(payload, (contract.has_heights ? kHasHeights : 0) |
                             (contract.has_voids ? kHasVoids : 0) |
                             (placement.empty() ? 0 : kHasPlacement) | contract.levels << 3 |
                             contract.degree << 5);
  append_varint(payload, contract.vertices);
  append_varint(payload, contract.x_max);
  append_varint(payload, contract.y_max);
  payload.insert(payload.end(), placement.begin(), placement.end());
  payload.insert(payload.end(), notes.begin(), notes.end());
  Bytes header(kMagic, kMagic + sizeof kMagic);
  header.push_back(kVersion);
  append_varint(header, payload.size());
  header.insert(header.end(), payload.begin(), payload.end());
  append_check(header, 0);
  return header;
}

void read_notes(const uint8_t* begin, const uint8_t* end, Metadata& metadata) {
  for (const uint8_t* at = begin; at != end;) {
    if (end - at < std::ptrdiff_t{kNoteHeadBytes}) throw Error("malformed note in the header");
    const uint8_t type = *at;
    const uint8_t* const content = at + kNoteHeadBytes;
    const uint32_t size = read_u16(at + 1);
    if (end - content < std::ptrdiff_t{size}) throw Error("malformed note in the header");
    at = content + size;
    read_note(type, content, at, metadata);
  }
}

Header read_header(const Bytes& stream) {
  Header header;
  microtin_status status = microtin_peek(stream.data(), stream.size(), &header.info);
  if (status == MICROTIN_NEED_INPUT) status = MICROTIN_TRUNCATED;
  if (status != MICROTIN_DONE) throw Error(describe(status));
  const uint8_t* const end = stream.data() + header.info.header_bytes - kCheckBytes;
  const uint8_t* next = stream.data() + kIdentityBytes;
  uint64_t length = 0;
  microtin_axis axis[3];
  read_varint(&next, end, &length);
  read_header(&next, end, &header.contract, axis);
  header.metadata.placement = {axis[0], axis[1], axis[2]};
  read_notes(next, end, header.metadata);
  return header;
}

Bytes with_metadata(const Bytes& stream, const Metadata& metadata) {
  const Header old = read_header(stream);
  Bytes changed = write_header(old.contract, metadata);
  changed.insert(changed.end(), stream.begin() + old.info.header_bytes, stream.end());
  read_header(changed);  // throws if a decoder would refuse it; the rest was not touched
  return changed;
}

}  // namespace microtin::stream
