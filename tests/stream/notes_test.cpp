// SPDX-License-Identifier: MIT
// Every member of the metadata comes back from the header of a stream and of a pack, alone and
// beside all others. A member without a row fails.
#include <doctest/doctest.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/stream/header.hpp"
#include "tests/support/members.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

bool is_same_decimal(const std::optional<Decimal>& a, const std::optional<Decimal>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->mantissa == b->mantissa && a->decimals == b->decimals;
}

bool is_same_accuracy(const std::optional<Accuracy>& a, const std::optional<Accuracy>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return is_same_decimal(a->bound, b->bound) && is_same_decimal(a->max_error, b->max_error) &&
         is_same_decimal(a->rms_error, b->rms_error) &&
         is_same_decimal(a->mean_error, b->mean_error);
}

bool is_same_sums(const std::optional<TileSums>& a, const std::optional<TileSums>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->vertices == b->vertices && a->tiles == b->tiles;
}

bool is_same_placement(const Placement& a, const Placement& b) {
  return is_same(a.x, b.x) && is_same(a.y, b.y) && is_same(a.z, b.z);
}

bool is_same_grid(const std::optional<PostGrid>& a, const std::optional<PostGrid>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->columns == b->columns && a->rows == b->rows && is_same(a->x, b->x) &&
         is_same(a->y, b->y);
}

bool is_same_distances(const std::optional<Distances>& a, const std::optional<Distances>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return is_same_decimal(a->below, b->below) && is_same_decimal(a->above, b->above);
}

bool is_same_bounds(const std::optional<StatedBounds>& a, const std::optional<StatedBounds>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  const BoundSpan &p = a->span, &q = b->span;
  return p.bounded == q.bounded && p.unbounded == q.unbounded &&
         is_same_decimal(p.least, q.least) && is_same_decimal(p.largest, q.largest) &&
         is_same_decimal(p.ratio, q.ratio) && is_same_decimal(a->max_error, b->max_error) &&
         is_same_decimal(a->unscaled, b->unscaled);
}

bool is_same_margins(const Margins& a, const Margins& b) {
  return a.below == b.below && a.above == b.above;
}

bool is_same_source_accuracy(const std::optional<SourceAccuracy>& a,
                             const std::optional<SourceAccuracy>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->kind == b->kind && is_same_decimal(a->value, b->value);
}

bool is_same_phases(const std::vector<PhaseEnd>& a, const std::vector<PhaseEnd>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.vertices == q.vertices && p.bytes == q.bytes &&
           is_same_decimal(p.max_error, q.max_error);
  });
}

bool is_same_places(const std::vector<FilePlace>& a, const std::vector<FilePlace>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.kind == q.kind && p.base == q.base && p.offset == q.offset && p.size == q.size;
  });
}

struct Row {
  std::string member;
  std::function<void(Metadata&)> set;
  std::function<bool(const Metadata&, const Metadata&)> is_same;
};

template <class Value>
Row row(const std::string& member, Value Metadata::*at, const Value& value) {
  return {member, [=](Metadata& m) { m.*at = value; },
          [=](const Metadata& a, const Metadata& b) { return a.*at == b.*at; }};
}

template <class Value, class Same>
Row row(const std::string& member, Value Metadata::*at, const Value& value, const Same& is_same) {
  return {member, [=](Metadata& m) { m.*at = value; },
          [=](const Metadata& a, const Metadata& b) { return is_same(a.*at, b.*at); }};
}

// Notes of several parts.
void add_parts(std::vector<Row>& all) {
  using std::optional;
  for (const uint64_t digest : {uint64_t{0}, UINT64_MAX, uint64_t{0x0123456789ABCDEF}}) {
    all.push_back(row("digest", &Metadata::digest, optional(digest)));
  }
  for (const std::vector<PhaseEnd>& phases :
       {std::vector<PhaseEnd>{{3, 0, std::nullopt}},
        std::vector<PhaseEnd>{{300, 900, Decimal{45, 1}},
                              {UINT32_MAX, UINT64_MAX, Decimal{0, 0}}}}) {
    all.push_back(row("phases", &Metadata::phases, phases, is_same_phases));
  }
  for (const int kind : {0, 1, 2, 3, 4}) {
    for (const int base : {0, 1, 2}) {
      const FilePlace place{static_cast<PlaceKind>(kind), static_cast<PlaceBase>(base), 300, 7};
      const std::vector<FilePlace> places = {place, {PlaceKind::kGeoid, PlaceBase::kEnd, 0, 1}};
      all.push_back(row("places", &Metadata::places, places, is_same_places));
    }
  }
  for (const ClassSet& classes :
       {ClassSet(), ClassSet().set(), ClassSet().set(0), ClassSet().set(255),
        ClassSet().set(2).set(3).set(9), ClassSet().set().reset(7)}) {
    all.push_back(row("classes", &Metadata::classes, optional(classes)));
  }
}

// All of an enumeration.
void add_enumerations(std::vector<Row>& all) {
  using std::optional;
  for (const int unit : {0, 1, 2, 3, 4}) {
    all.push_back(row("horizontal_unit", &Metadata::horizontal_unit, static_cast<Unit>(unit)));
    all.push_back(row("vertical_unit", &Metadata::vertical_unit, static_cast<Unit>(unit)));
  }
  for (const int kind : {0, 1, 2, 3, 4, 5}) {
    all.push_back(row("surface", &Metadata::surface, static_cast<SurfaceKind>(kind)));
  }
  for (const int kind : {0, 1, 2, 3}) {
    const SourceAccuracy accuracy{static_cast<AccuracyKind>(kind), {45, 1}};
    all.push_back(row<optional<SourceAccuracy>>("source_accuracy", &Metadata::source_accuracy,
                                                accuracy, is_same_source_accuracy));
  }
  for (const int side : {0, 1, 2, 3}) {
    all.push_back(row("side", &Metadata::side, static_cast<BoundSide>(side)));
  }
  for (const int rule : {0, 1, 2, 3, 4, 5}) {
    all.push_back(row("duplicates", &Metadata::duplicates, static_cast<DuplicateRule>(rule)));
  }
}

// Values with all bits of a few lengths, and ends of what can be written.
std::vector<Row> rows() {
  using std::optional;
  const Accuracy bounded{Decimal{10, 0}, Decimal{99, 1}, Decimal{345, 2}, Decimal{-12, 18}};
  const Accuracy measured{std::nullopt, Decimal{INT64_MAX, 9}, Decimal{0, 0},
                          Decimal{INT64_MIN, 1}};
  std::vector<Row> all = {
      row("placement", &Metadata::placement, Placement{{-7, 3, 1200}, {33, 1, 7}, {-250, 5, 2}},
          is_same_placement),
      row("horizontal_epsg", &Metadata::horizontal_epsg, 1u),
      row("horizontal_epsg", &Metadata::horizontal_epsg, UINT32_MAX),
      row("vertical_epsg", &Metadata::vertical_epsg, 1u),
      row("vertical_epsg", &Metadata::vertical_epsg, UINT32_MAX),
      row<std::string>("wkt", &Metadata::wkt, "LOCAL_CS[\"w\"]"),
      row<std::string>("source", &Metadata::source, "s"),
      row<std::string>("source", &Metadata::source, std::string(300, 's')),
      row<std::string>("date", &Metadata::date, "2026-11"),
      row<std::string>("lineage", &Metadata::lineage, "l\n\xC3\xA4"),
      row<std::string>("attribution", &Metadata::attribution, "\xC2\xA9 the survey"),
      row<std::string>("license", &Metadata::license, "CC-BY-4.0"),
      row<std::string>("valid", &Metadata::valid, "2024-01/.."),
      row<std::optional<Decimal>>("epoch", &Metadata::epoch, Decimal{20205, 1}, is_same_decimal),
      row("water_level", &Metadata::water_level, optional(Decimal{-445, 1}), is_same_decimal),
      row("accuracy", &Metadata::accuracy, optional(bounded), is_same_accuracy),
      row("accuracy", &Metadata::accuracy, optional(measured), is_same_accuracy),
      row("true_places", &Metadata::true_places, optional(bounded), is_same_accuracy),
      row("true_places", &Metadata::true_places, optional(measured), is_same_accuracy),
      row("at_samples", &Metadata::at_samples, optional(Distances{{INT64_MAX, 9}, {0, 0}}),
          is_same_distances),
      row("at_samples", &Metadata::at_samples, optional(Distances{{0, 0}, {1, 18}}),
          is_same_distances),
      row("everywhere", &Metadata::everywhere, Margins{0, 1048576}, is_same_margins),
      row("everywhere", &Metadata::everywhere, Margins{kNotStated, 0}, is_same_margins),
      row("everywhere", &Metadata::everywhere, Margins{77, 5}, is_same_margins),
      row("bounds", &Metadata::bounds,
          optional(
              StatedBounds{{66, UINT64_MAX, {0, 0}, {INT64_MAX, 18}, {1, 0}}, {30, 0}, {25, 1}}),
          is_same_bounds),
      row("sums", &Metadata::sums, optional(TileSums{0, 0}), is_same_sums),
      row("sums", &Metadata::sums, optional(TileSums{UINT64_MAX, 1048576}), is_same_sums),
      row("grid", &Metadata::grid, optional(PostGrid{1, UINT32_MAX, {1, 2, 3}, {-4, 5, 6}}),
          is_same_grid),
      row("grid", &Metadata::grid, optional(PostGrid{300, 2, {0, 1, 1}, {0, 1, 1}}), is_same_grid),
      row("grid", &Metadata::grid, optional(PostGrid{300, 2, {0, 1, 1}, {0, 1, 2}}), is_same_grid),
      row("grid", &Metadata::grid, optional(PostGrid{300, 2, {0, 1, 2}, {0, 1, 1}}), is_same_grid),
  };
  add_parts(all);
  add_enumerations(all);
  return all;
}

Metadata with_all(const std::vector<Row>& all) {
  Metadata metadata;
  for (const Row& row : all) row.set(metadata);
  return metadata;
}

// How many bytes all texts may have beside the heads of their notes.
void write_text(std::string Metadata::*text, size_t size) {
  Metadata metadata;
  metadata.*text = std::string(size, 'a');
  CHECK(write_notes(metadata).size() == size + kNoteHeadBytes);
}

}  // namespace

TEST_CASE("notes: each is read back from a header, alone and with all others") {
  const std::vector<Row> all = rows();
  const Tin tin = rolling_tin(10, 5);
  for (const Row& row : all) {
    CAPTURE(row.member);
    for (Metadata metadata : {Metadata(), full_metadata(), with_all(all)}) {
      row.set(metadata);
      const Metadata back = read_header(encode(tin, metadata)).metadata;
      for (const Row& other : all) {
        CAPTURE(other.member);
        CHECK(other.is_same(metadata, back));
      }
    }
  }
}

TEST_CASE("notes: no member of the metadata is without a row") {
  Names known;
  for (const Row& row : rows()) known.insert(row.member);
  const Names of_source = members_of("encoder/terrain/source_notes.hpp", "SourceNotes");
  CHECK(text_of(united(members_of("encoder/terrain/metadata.hpp", "Metadata"), of_source)) ==
        text_of(known));
  CHECK(text_of(members_of("encoder/terrain/source_notes.hpp", "SourceAccuracy")) == "kind value ");
  CHECK(text_of(members_of("encoder/terrain/metadata.hpp", "Accuracy")) ==
        "bound max_error mean_error rms_error ");
  CHECK(text_of(members_of("encoder/terrain/metadata.hpp", "Distances")) == "above below ");
  CHECK(text_of(members_of("encoder/terrain/metadata.hpp", "Margins")) == "above below ");
  CHECK(text_of(members_of("encoder/terrain/metadata.hpp", "TileSums")) == "tiles vertices ");
  CHECK(text_of(members_of("encoder/terrain/metadata.hpp", "PostGrid")) == "columns rows x y ");
  CHECK(text_of(members_of("encoder/terrain/metadata.hpp", "PhaseEnd")) ==
        "bytes max_error vertices ");
  CHECK(text_of(members_of("encoder/terrain/metadata.hpp", "FilePlace")) ==
        "base kind offset size ");
  CHECK(text_of(members_of("encoder/exact/lattice_map.hpp", "Placement")) == "x y z ");
}

TEST_CASE("notes: a surface may end behind its side, later numbers state nothing") {
  const auto read = [](const std::vector<uint8_t>& content) {
    std::vector<uint8_t> note = {MICROTIN_NOTE_SURFACE, static_cast<uint8_t>(content.size()), 0};
    note.insert(note.end(), content.begin(), content.end());
    Metadata metadata;
    read_notes(note.data(), note.data() + note.size(), metadata);
    return metadata;
  };
  CHECK(read({4, 2}).surface == SurfaceKind::kGeoid);
  CHECK(read({4, 2}).side == BoundSide::kNeverBelow);
  CHECK(!read({4, 2}).at_samples);
  CHECK(read({6, 4}).surface == SurfaceKind::kUnknown);
  CHECK(read({6, 4}).side == BoundSide::kNotStated);
  const Metadata all = read({1, 1, 10, 1, 14, 0, 99});  // with a byte of a later version
  CHECK(to_string(all.at_samples->below) == "0.5");
  CHECK(to_string(all.at_samples->above) == "7");
  const std::vector<std::vector<uint8_t>> broken = {
      {}, {1}, {1, 1, 10}, {1, 1, 10, 1, 14}, {1, 1, 1, 0, 0, 0}, {1, 1, 0, 0, 1, 0}};
  for (const std::vector<uint8_t>& content : broken) CHECK_THROWS_AS(read(content), Error);
}

TEST_CASE("notes: an accuracy of the source keeps its number if its kind is of a later version") {
  const auto read = [](const std::vector<uint8_t>& content) {
    std::vector<uint8_t> note = {MICROTIN_NOTE_SOURCE_ACCURACY,
                                 static_cast<uint8_t>(content.size()), 0};
    note.insert(note.end(), content.begin(), content.end());
    Metadata metadata;
    read_notes(note.data(), note.data() + note.size(), metadata);
    return to_string(*metadata.source_accuracy);
  };
  CHECK(read({1, 8, 0}) == "LE90 4");
  CHECK(read({3, 10, 1, 99}) == "LE95 0.5");  // with a byte of a later version
  CHECK(read({4, 8, 0}) == "unknown 4");
  const std::vector<std::vector<uint8_t>> broken = {{}, {1}, {1, 8}, {1, 7, 0}};
  for (const std::vector<uint8_t>& content : broken) CHECK_THROWS_AS(read(content), Error);
}

TEST_CASE("notes: lists of phases and places have as many entries as they state") {
  const auto read = [](uint8_t type, const std::vector<uint8_t>& content) {
    std::vector<uint8_t> note = {type, static_cast<uint8_t>(content.size()), 0};
    note.insert(note.end(), content.begin(), content.end());
    Metadata metadata;
    read_notes(note.data(), note.data() + note.size(), metadata);
    return metadata;
  };
  const auto phases = read(MICROTIN_NOTE_PHASES, {2, 3, 5, 0, 9, 40, 1, 10, 1, 99}).phases;
  REQUIRE(phases.size() == 2);  // behind them is a byte of a later version
  CHECK(phases[0].vertices == 3);
  CHECK(!phases[0].max_error);
  CHECK(phases[1].bytes == 40);
  CHECK(to_string(*phases[1].max_error) == "0.5");
  const auto places = read(MICROTIN_NOTE_PLACES, {1, 5, 3, 100, 20, 99}).places;
  REQUIRE(places.size() == 1);  // of a kind and a base of a later version
  CHECK(places[0].kind == PlaceKind::kUnknown);
  CHECK(places[0].base == PlaceBase::kUnknown);
  CHECK(places[0].offset == 100);
  CHECK(places[0].size == 20);
  const std::vector<std::vector<uint8_t>> broken_phases = {
      {}, {1}, {1, 3, 5}, {1, 3, 5, 1, 1, 0}, {2, 3, 5, 0}};
  for (const auto& content : broken_phases) {
    CHECK_THROWS_AS(read(MICROTIN_NOTE_PHASES, content), Error);
  }
  const std::vector<std::vector<uint8_t>> broken_places = {{}, {1, 1, 1, 9}, {2, 1, 1, 9, 9}};
  for (const auto& content : broken_places) {
    CHECK_THROWS_AS(read(MICROTIN_NOTE_PLACES, content), Error);
  }
  CHECK_THROWS_AS(read(MICROTIN_NOTE_DIGEST, {1, 2, 3, 4, 5, 6, 7}), Error);
}

TEST_CASE("notes: texts take as many bytes as notes have, and no more") {
  using Text = std::string Metadata::*;
  const std::vector<Text> texts = {&Metadata::wkt,     &Metadata::source,      &Metadata::date,
                                   &Metadata::lineage, &Metadata::attribution, &Metadata::license,
                                   &Metadata::valid};
  for (const Text text : texts) {
    write_text(text, kNotesMostBytes - kNoteHeadBytes);
    CHECK_THROWS_AS(write_text(text, kNotesMostBytes - kNoteHeadBytes + 1), Error);
    CHECK_THROWS_AS(write_text(text, UINT16_MAX + 1), Error);
    Metadata two;
    two.*text = std::string(40000, 'a');
    (text == texts[1] ? two.lineage : two.source) =
        std::string(kNotesMostBytes - 2 * kNoteHeadBytes - 40000, 'b');
    CHECK(write_notes(two).size() == kNotesMostBytes);
    (text == texts[1] ? two.lineage : two.source) += 'b';
    CHECK_THROWS_AS(write_notes(two), Error);
  }
}

}  // namespace microtin::tests
