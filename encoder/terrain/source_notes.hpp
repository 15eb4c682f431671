// SPDX-License-Identifier: MIT
// What people and files state about a source, for those who use the terrain.
#ifndef MICROTIN_ENCODER_TERRAIN_SOURCE_NOTES_HPP
#define MICROTIN_ENCODER_TERRAIN_SOURCE_NOTES_HPP

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "encoder/exact/decimal.hpp"
#include "encoder/layers.hpp"

namespace microtin::terrain {

// What a number of accuracy is. The numbers are those of the note.
enum class AccuracyKind : uint8_t {
  kUnknown = 0,
  kLe90 = 1,  // 90 % of all heights are within it
  kRmse = 2,  // root-mean-square error
  kLe95 = 3   // 95 % of all heights are within it
};

// The accuracy of a source itself, in units of height.
struct SourceAccuracy {
  AccuracyKind kind;
  Decimal value;  // at least 0
};

// "LE90 4"; a kind that is not known is "unknown".
std::string to_string(const SourceAccuracy& accuracy);
const char* name_of(AccuracyKind kind);

// Reads such a text; nothing for any other.
std::optional<SourceAccuracy> parse_source_accuracy(const std::string& text);

// A year of four digits with decimals, "2020.5"; nothing for any other text.
std::optional<Decimal> parse_epoch(const std::string& text);

// UTF-8 texts. Empty: not stated.
struct SourceNotes {
  std::string source;            // where the terrain comes from
  std::string date;              // of the source: ISO 8601, 2026-11 or 2019-05/2021
  std::string lineage;           // what was done to the source
  std::string attribution;       // to be shown to users
  std::string license;           // an SPDX expression or a URL
  std::string valid;             // when the terrain is valid: ISO 8601, 2024-01/2025 or 2024-01/..
  std::optional<Decimal> epoch;  // of the coordinates, a year
  std::optional<SourceAccuracy> source_accuracy;
};

// Returns each note of `first` that states something, else that of `second`.
SourceNotes preferred(SourceNotes first, const SourceNotes& second);

// Makes `whole` what it and `part` state together (encoder/docs/input.md has the rules). Returns
// what is left out, as sentences for people.
std::vector<std::string> join(const SourceNotes& part, SourceNotes& whole);

// Texts of a file that are longer are not taken.
constexpr size_t kMostStatedBytes = 1000;

// Takes the notes that a file's metadata state: TIFF tags by GDAL's names for them, and the items
// of GDAL's driver for microtin. `item` returns an empty text for an item that the file lacks. Adds
// what is not taken to `warnings`.
SourceNotes notes_of_items(const std::function<std::string(const char* name)>& item,
                           std::vector<std::string>& warnings);

}  // namespace microtin::terrain

#endif
