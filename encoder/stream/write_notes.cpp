// SPDX-License-Identifier: MIT
// Writing the notes of headers, as format-stream.md lays them down.
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/stream/header.hpp"

namespace microtin::stream {
namespace {

using Bytes = std::vector<uint8_t>;

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

}  // namespace microtin::stream
