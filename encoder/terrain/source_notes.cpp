// SPDX-License-Identifier: MIT
// Notes about a source: as options spell them, as files state them, and of several files together.
#include "encoder/terrain/source_notes.hpp"

#include <algorithm>
#include <string_view>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"

namespace microtin::terrain {
namespace {

constexpr const char* kKinds[] = {"unknown", "LE90", "RMSE", "LE95"};
constexpr std::string_view kSeparator = "; ", kAnd = " AND ";
constexpr size_t kMostJoinedBytes = 4 * kMostStatedBytes;

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

std::string trimmed(const std::string& text) {
  const auto begin = std::find_if_not(text.begin(), text.end(), is_blank);
  const auto end = std::find_if_not(text.rbegin(), text.rend(), is_blank).base();
  return begin < end ? std::string(begin, end) : std::string();
}

// Whether the text is among those that were joined.
bool contains(const std::string& joined, std::string_view separator, const std::string& text) {
  for (size_t at = 0; at <= joined.size();) {
    const size_t end = std::min(joined.find(separator, at), joined.size());
    if (joined.compare(at, end - at, text) == 0) return true;
    at = end + separator.size();
  }
  return joined == text;
}

// Appends a text that is not there yet. False if there is no room for it.
bool append(const std::string& text, std::string_view separator, std::string& joined) {
  if (text.empty() || contains(joined, separator, text)) return true;
  if (joined.size() + separator.size() + text.size() > kMostJoinedBytes) return false;
  if (!joined.empty()) joined += separator;
  joined += text;
  return true;
}

// An SPDX expression as a part of another one.
std::string operand(const std::string& license) {
  return license.find(' ') == license.npos || license.front() == '(' ? license
                                                                     : "(" + license + ")";
}

bool append_license(const std::string& license, std::string& joined) {
  if (license.empty() || joined.empty() || license == joined) {
    if (joined.empty()) joined = license;
    return true;
  }
  if (joined.find(kAnd) == joined.npos) joined = operand(joined);
  return append(operand(license), kAnd, joined);
}

// The first day of an interval, or its last; a date alone is both.
std::string first_of(const std::string& date) {
  return date.substr(0, date.find('/'));
}

std::string last_of(const std::string& date) {
  const size_t slash = date.find('/');
  return slash == date.npos ? date : date.substr(slash + 1);
}

// A year ends after its months, so that what is missing counts as the last.
bool ends_before(const std::string& a, const std::string& b) {
  return a + '~' < b + '~';
}

std::string united(const std::string& a, const std::string& b) {
  if (a.empty() || b.empty() || a == b) return a.empty() ? b : a;
  const std::string first = std::min(first_of(a), first_of(b));
  const std::string last = std::max(last_of(a), last_of(b), ends_before);
  return first == last ? first : first + '/' + last;
}

// The worst of one kind.
std::optional<SourceAccuracy> united(const std::optional<SourceAccuracy>& a,
                                     const std::optional<SourceAccuracy>& b) {
  if (!a || !b || a->kind != b->kind) return std::nullopt;
  return a->value <= b->value ? b : a;
}

bool is_same_number(const std::optional<Decimal>& a, const std::optional<Decimal>& b) {
  return a.has_value() == b.has_value() && (!a || *a == *b);
}

// TIFF's "2026:11:21 10:20:30" as a date.
std::string date_of_tiff(const std::string& text) {
  std::string date = text.substr(0, 10);
  std::replace(date.begin(), date.end(), ':', '-');
  return is_iso_date(date) ? date : std::string();
}

}  // namespace

const char* name_of(AccuracyKind kind) {
  return kKinds[static_cast<size_t>(kind)];
}

std::string to_string(const SourceAccuracy& accuracy) {
  return std::string(name_of(accuracy.kind)) + ' ' + exact::to_string(accuracy.value);
}

std::optional<SourceAccuracy> parse_source_accuracy(const std::string& text) {
  const size_t blank = text.find(' ');
  const std::string kind = lower_case(text.substr(0, blank));
  for (size_t i = 0; i < std::size(kKinds) && blank != text.npos; ++i) {
    if (kind != lower_case(kKinds[i])) continue;
    const std::optional<Decimal> value = parse_decimal(text.substr(blank + 1));
    if (!value || value->mantissa < 0) return std::nullopt;
    return SourceAccuracy{static_cast<AccuracyKind>(i), *value};
  }
  return std::nullopt;
}

std::optional<Decimal> parse_epoch(const std::string& text) {
  const std::string year = text.substr(0, text.find('.'));
  const bool is_year = year.size() == 4 && text.find_first_not_of("0123456789.") == text.npos;
  return is_year ? parse_decimal(text) : std::nullopt;
}

SourceNotes preferred(SourceNotes first, const SourceNotes& second) {
  for (std::string SourceNotes::*const text :
       {&SourceNotes::source, &SourceNotes::date, &SourceNotes::lineage, &SourceNotes::attribution,
        &SourceNotes::license, &SourceNotes::valid}) {
    if ((first.*text).empty()) first.*text = second.*text;
  }
  if (!first.epoch) first.epoch = second.epoch;
  if (!first.source_accuracy) first.source_accuracy = second.source_accuracy;
  return first;
}

std::vector<std::string> join(const SourceNotes& part, SourceNotes& whole) {
  std::vector<std::string> left_out;
  const auto expect = [&](bool is_kept, const char* name, const char* why) {
    if (!is_kept)
      left_out.push_back(std::string("files state ") + why + ": set " + parameter(name));
  };
  expect(append(part.source, kSeparator, whole.source), "source_name",
         "more names than a header takes, and some are left out");
  expect(append(part.lineage, kSeparator, whole.lineage), "lineage",
         "more lineages than a header takes, and some are left out");
  expect(append(part.attribution, kSeparator, whole.attribution), "attribution",
         "more attributions than a header takes, and some are left out");
  expect(append_license(part.license, whole.license), "license",
         "more licences than a header takes, and some are left out");
  whole.date = united(whole.date, part.date);
  if (part.valid != whole.valid) whole.valid.clear();
  whole.source_accuracy = united(whole.source_accuracy, part.source_accuracy);
  expect(is_same_number(part.epoch, whole.epoch), "epoch",
         "different epochs of their coordinates, and none is noted");
  if (!is_same_number(part.epoch, whole.epoch)) whole.epoch.reset();
  return left_out;
}

SourceNotes notes_of_items(const std::function<std::string(const char* name)>& item,
                           std::vector<std::string>& warnings) {
  const auto text = [&](const char* name) {
    std::string found = utf8_of(trimmed(item(name)));
    if (found.size() <= kMostStatedBytes) return found;
    warnings.push_back(std::string("the file's ") + name + " has " + std::to_string(found.size()) +
                       " bytes, and is not noted");
    return std::string();
  };
  SourceNotes own, tiff;
  own.source = text("SOURCE");
  own.lineage = text("LINEAGE");
  own.attribution = text("ATTRIBUTION");
  own.license = text("LICENSE");
  if (const std::string date = text("DATE"); is_iso_date(date)) own.date = date;
  if (const std::string valid = text("VALID"); is_iso_validity(valid)) own.valid = valid;
  own.epoch = parse_epoch(text("COORDINATE_EPOCH"));
  own.source_accuracy = parse_source_accuracy(text("SOURCE_ACCURACY"));
  tiff.source = text("TIFFTAG_IMAGEDESCRIPTION");
  tiff.attribution = text("TIFFTAG_COPYRIGHT");
  tiff.date = date_of_tiff(text("TIFFTAG_DATETIME"));
  return preferred(own, tiff);
}

}  // namespace microtin::terrain
