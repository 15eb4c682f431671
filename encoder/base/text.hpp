// SPDX-License-Identifier: MIT
// Text that others wrote, whatever the locale: characters, letters, dates and numbers.
#ifndef MICROTIN_ENCODER_BASE_TEXT_HPP
#define MICROTIN_ENCODER_BASE_TEXT_HPP

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "encoder/layers.hpp"

namespace microtin::base {

// The bytes of the character that the text begins with; 0 if that is none of UTF-8.
size_t character_bytes(std::string_view text);

// Whether a character commands a terminal instead of being shown: U+0000 to U+001F and U+007F to
// U+009F.
bool is_control(std::string_view character);

// A to Z alone, whatever the locale.
std::string lower_case(std::string text);

// With its dot, in small letters: some systems write .ASC. Empty: the file has none.
std::string suffix_of(const std::string& path);

// Whether the text is a year (2026), a month (2026-11) or a day (2026-11-21) that there is, or an
// interval from one to another that is not before it (2019-05/2021).
bool is_iso_date(std::string_view text);

// Whether the text is such a date or interval, or an interval that is open on one side
// (2024-01/.., ../2025).
bool is_iso_validity(std::string_view text);

// The date of a day of a year, counted from 1; the year alone if it has no such day. Empty: the
// year has not four digits.
std::string iso_date(int year, int day);

// Sixteen digits.
std::string hexadecimal(uint64_t number);

// Returns the text if all of it is UTF-8; else its bytes are taken as characters of Latin 1.
std::string utf8_of(std::string text);

// The double nearest to the number that the whole text spells: "-0.25", "1e5", "inf", "nan".
// Returns nothing for other text ("+1", " 1", "0x1", "1,5") and for finite numbers that no double
// is near.
std::optional<double> real_number(std::string_view text);

}  // namespace microtin::base

#endif
