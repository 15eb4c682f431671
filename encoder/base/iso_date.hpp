// SPDX-License-Identifier: MIT
// Dates as ISO 8601 writes them.
#ifndef MICROTIN_ENCODER_BASE_ISO_DATE_HPP
#define MICROTIN_ENCODER_BASE_ISO_DATE_HPP

#include <string_view>

#include "encoder/layers.hpp"

namespace microtin::base {

// Whether the text is a year (2026), a month (2026-11) or a day (2026-11-21) that there is.
bool is_iso_date(std::string_view text);

}  // namespace microtin::base

#endif
