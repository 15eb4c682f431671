// SPDX-License-Identifier: MIT
// What the readers of text formats share.
#ifndef MICROTIN_ENCODER_IMPORT_TEXT_HPP
#define MICROTIN_ENCODER_IMPORT_TEXT_HPP

#include <string>
#include <string_view>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::importing {

// Throws Error("name:line: what").
[[noreturn]] void fail_at(const std::string& name, size_t line, const std::string& what);

// A piece of the input for a message: in quotes, printable, short.
std::string quoted(std::string_view piece);

// What is wrong with a word that stands where a number in range is needed, and what to do about it.
std::string not_a_number(std::string_view word);

// The remedy for decimal commas, to follow what is wrong; empty if there is no comma.
std::string remedy_for_commas(std::string_view piece);

// What is wrong with a binary number that is none of a raster's heights, and what to do if it marks
// voids.
std::string not_a_height(double value);

// A field without the quotes around it.
std::string_view without_quotes(std::string_view field);

// Whether what is between commas may be decimals: 5,07 and not 5, 7.
bool has_torn_decimals(std::string_view line, const std::vector<std::string_view>& fields);

inline bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

// The decimals that the most precise of some numbers needs.
class DecimalRange {
 public:
  // False if the numbers do not all go into magnitudes up to 10^18 with the decimals needed.
  bool add(Decimal value);

  int decimals() const { return decimals_; }

 private:
  Wide largest_ = 0;
  int decimals_ = 0;
};

// Numbers brought to these decimals.
class DecimalColumn {
 public:
  // False as DecimalRange::add is.
  bool add(Decimal value);
  void add_void() { mantissas_.push_back(kVoidHeight); }
  void reserve(size_t count);  // throws std::bad_alloc also where there can be no such memory

  int decimals() const { return range_.decimals(); }
  std::vector<int64_t>& mantissas() { return mantissas_; }
  const std::vector<int64_t>& mantissas() const { return mantissas_; }

 private:
  std::vector<int64_t> mantissas_;
  DecimalRange range_;
};

// The coordinates of points as they are read; x and y share their decimals.
class PointColumns {
 public:
  // The next coordinate of `axis` 0, 1 or 2: each point needs all three, in this order. False as
  // for DecimalColumn.
  bool add(size_t axis, Decimal value) { return (axis < 2 ? xy_ : z_).add(value); }

  bool empty() const { return z_.mantissas().empty(); }
  PointCloud take();

 private:
  DecimalColumn xy_;  // x and y in turn
  DecimalColumn z_;
};

// Splits a line at runs of blanks with at most one comma or semicolon in each; an empty field is
// kept, unless it is the last.
void split(std::string_view line, std::vector<std::string_view>& fields);

// Splits a line at each of these separators, but for those between quotes around a whole field;
// fields are without the blanks around them.
void split_at(char separator, std::string_view line, std::vector<std::string_view>& fields);

// Splits a line at runs of blanks alone.
void split_at_blanks(std::string_view line, std::vector<std::string_view>& fields);

// A text without the byte order mark that it may begin with.
std::string_view without_mark(std::string_view text);

// Takes the first line away from a text that is not empty; without its end: LF, CR LF or CR.
std::string_view take_line(std::string_view& text);

}  // namespace microtin::importing

#endif
