// SPDX-License-Identifier: MIT
// What people and files state about sources: as texts, of several files, and out of metadata.
#include "encoder/terrain/source_notes.hpp"

#include <doctest/doctest.h>

#include <map>

#include "encoder/base/error.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {
namespace {

using Items = std::map<std::string, std::string>;

struct Taken {
  SourceNotes notes;
  std::vector<std::string> warnings;
};

Taken take(const Items& items) {
  Taken taken;
  const auto item = [&](const char* name) {
    const auto found = items.find(name);
    return found != items.end() ? found->second : std::string();
  };
  taken.notes = notes_of_items(item, taken.warnings);
  return taken;
}

// What files of which each states one note state together, in their order.
template <class Value>
Value joined(Value SourceNotes::*note, const std::vector<Value>& values) {
  SourceNotes whole;
  whole.*note = values[0];
  for (const Value& value : values) {
    SourceNotes part;
    part.*note = value;
    join(part, whole);
  }
  return whole.*note;
}

std::string joined_texts(std::string SourceNotes::*note, const std::vector<std::string>& texts) {
  return joined(note, texts);
}

}  // namespace

TEST_CASE("source notes: an accuracy is a kind and a number") {
  for (const char* const text : {"LE90 4", "RMSE 0.25", "LE95 0", "unknown 12"}) {
    const auto accuracy = parse_source_accuracy(text);
    REQUIRE_MESSAGE(accuracy, text);
    CHECK(to_string(*accuracy) == text);
  }
  CHECK(to_string(*parse_source_accuracy("rmse 2.50")) == "RMSE 2.5");
  for (const char* const text : {"", "4", "LE90", "LE90 ", "LE90 -4", "LE90 4 m", "LE90  4",
                                 "LE91 4", " LE90 4", "LE90:4", "LE90 4,5"}) {
    CHECK_MESSAGE(!parse_source_accuracy(text), text);
  }
}

TEST_CASE("source notes: an epoch is a year of four digits with decimals") {
  for (const char* const text : {"2020.5", "1997", "2010.123456789"}) {
    const auto epoch = parse_epoch(text);
    REQUIRE_MESSAGE(epoch, text);
    CHECK(to_string(*epoch) == text);
  }
  for (const char* const text :
       {"", "20.5", "-2020", "2020-05", "20205", "2020,5", "2e3", "2020.5.1"}) {
    CHECK_MESSAGE(!parse_epoch(text), text);
  }
}

TEST_CASE("source notes: what an option states comes before what the file states") {
  SourceNotes option, file;
  option.attribution = "option";
  option.epoch = Decimal{2020, 0};
  file = {"s",
          "2026",
          "l",
          "file",
          "MIT",
          "2024/..",
          Decimal{2010, 0},
          SourceAccuracy{AccuracyKind::kRmse, {1, 0}}};
  const SourceNotes notes = preferred(option, file);
  CHECK(notes.source == "s");
  CHECK(notes.date == "2026");
  CHECK(notes.lineage == "l");
  CHECK(notes.attribution == "option");
  CHECK(notes.license == "MIT");
  CHECK(notes.valid == "2024/..");
  CHECK(to_string(*notes.epoch) == "2020");
  CHECK(to_string(*notes.source_accuracy) == "RMSE 1");
}

TEST_CASE("source notes: several files' texts are joined, each once") {
  using N = SourceNotes;
  CHECK(joined_texts(&N::attribution, {"a", "", "b", "a", "b"}) == "a; b");
  CHECK(joined_texts(&N::source, {"", "ab", "a", "b", "ab"}) == "ab; a; b");
  CHECK(joined_texts(&N::lineage, {"x", "x"}) == "x");
  CHECK(joined_texts(&N::license, {"MIT", "", "CC0-1.0", "MIT"}) == "MIT AND CC0-1.0");
  CHECK(joined_texts(&N::license, {"MIT OR X11", "CC0-1.0", "MIT OR X11"}) ==
        "(MIT OR X11) AND CC0-1.0");
  CHECK(joined_texts(&N::date, {"2020-05", "2019", "", "2021-01/2021-03"}) == "2019/2021-03");
  CHECK(joined_texts(&N::date, {"2019-05", "2019"}) == "2019");
  CHECK(joined_texts(&N::date, {"2020", "2020"}) == "2020");
  CHECK(joined_texts(&N::valid, {"2020/..", "2020/.."}) == "2020/..");
  CHECK(joined_texts(&N::valid, {"2020/..", "2021/.."}).empty());
}

TEST_CASE("source notes: numbers of several files that differ are not stated, or the worst is") {
  using Epoch = std::optional<Decimal>;
  using Accuracy = std::optional<SourceAccuracy>;
  const auto epoch = [](const std::vector<Epoch>& values) {
    return joined<Epoch>(&SourceNotes::epoch, values).has_value();
  };
  CHECK(epoch({Decimal{2020, 0}, Decimal{2020, 0}}));
  CHECK(!epoch({Decimal{2020, 0}, Decimal{2021, 0}}));
  CHECK(!epoch({Decimal{2020, 0}, std::nullopt}));
  const Accuracy le4 = parse_source_accuracy("LE90 4"), le9 = parse_source_accuracy("LE90 9"),
                 rmse = parse_source_accuracy("RMSE 2");
  const auto accuracy = [](const std::vector<Accuracy>& values) {
    return joined<Accuracy>(&SourceNotes::source_accuracy, values);
  };
  CHECK(to_string(*accuracy({le4, le9, le4})) == "LE90 9");
  CHECK(!accuracy({le4, rmse}));
  CHECK(!accuracy({le4, std::nullopt}));
}

TEST_CASE("source notes: what is left out of several files' notes is said") {
  SourceNotes whole, part;
  whole.epoch = Decimal{2020, 0};
  CHECK(join(part, whole) ==
        std::vector<std::string>{"files state different epochs of their coordinates, and none is "
                                 "noted: set " +
                                 parameter("epoch")});
  for (int i = 0; i < 3; ++i) {
    part.attribution = std::string(1000, static_cast<char>('a' + i));
    CHECK(join(part, whole).empty());
  }
  part.attribution = std::string(1000, 'd');
  CHECK(join(part, whole).size() == 1);
  CHECK(whole.attribution.size() == 3 * 1000 + 2 * 2);
  part.attribution = std::string(1000, 'b');
  CHECK(join(part, whole).empty());
}

TEST_CASE("source notes: tags of TIFF become notes, unless items of microtin's say otherwise") {
  const Items tags = {{"TIFFTAG_COPYRIGHT", " \xA9 2020 the survey\n"},
                      {"TIFFTAG_IMAGEDESCRIPTION", "DGM1"},
                      {"TIFFTAG_DATETIME", "2021:05:03 10:20:30"}};
  const SourceNotes of_tags = take(tags).notes;
  CHECK(of_tags.attribution == "\xC2\xA9 2020 the survey");  // Latin 1, without blanks
  CHECK(of_tags.source == "DGM1");
  CHECK(of_tags.date == "2021-05-03");
  Items items = {{"SOURCE", "s"},
                 {"DATE", "2019/2020"},
                 {"LINEAGE", "l"},
                 {"ATTRIBUTION", "a"},
                 {"LICENSE", "CC0-1.0"},
                 {"VALID", "../2025"},
                 {"SOURCE_ACCURACY", "LE90 4"},
                 {"COORDINATE_EPOCH", "2020.5"}};
  items.insert(tags.begin(), tags.end());
  const SourceNotes notes = take(items).notes;
  CHECK(notes.source == "s");
  CHECK(notes.date == "2019/2020");
  CHECK(notes.lineage == "l");
  CHECK(notes.attribution == "a");
  CHECK(notes.license == "CC0-1.0");
  CHECK(notes.valid == "../2025");
  CHECK(to_string(*notes.epoch) == "2020.5");
  CHECK(to_string(*notes.source_accuracy) == "LE90 4");
}

TEST_CASE("source notes: what is not as a note must be is not taken, long texts are reported") {
  const Taken odd = take({{"DATE", "yesterday"},
                          {"VALID", "always"},
                          {"COORDINATE_EPOCH", "now"},
                          {"SOURCE_ACCURACY", "good"},
                          {"TIFFTAG_DATETIME", "0000:00:00 00:00:00"}});
  CHECK(odd.notes.date.empty());
  CHECK(odd.notes.valid.empty());
  CHECK(!odd.notes.epoch);
  CHECK(!odd.notes.source_accuracy);
  CHECK(odd.warnings.empty());
  const Taken full = take({{"TIFFTAG_COPYRIGHT", std::string(kMostStatedBytes, 'c')}});
  CHECK(full.notes.attribution.size() == kMostStatedBytes);
  const Taken longer = take({{"TIFFTAG_COPYRIGHT", std::string(kMostStatedBytes + 1, 'c')}});
  CHECK(longer.notes.attribution.empty());
  CHECK(longer.warnings ==
        std::vector<std::string>{"the file's TIFFTAG_COPYRIGHT has 1001 bytes, and is not noted"});
}

}  // namespace microtin::tests
