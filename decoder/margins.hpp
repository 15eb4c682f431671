// SPDX-License-Identifier: MIT
// Heights between which the source lies.
#ifndef MICROTIN_DECODER_MARGINS_HPP
#define MICROTIN_DECODER_MARGINS_HPP

#include "microtin/microtin.h"
#include "shared/format.hpp"

namespace microtin {

// Widens a height, rounded to nearest at 16 fractional bits, halves up, by margins in sixteenths.
// The exact height is between half a unit less and half a unit more, so that it lies in lowest ..
// highest also without margins. All numbers are below 2^23 + 2^24.
MICROTIN_ONE_COPY inline microtin_query_result widen(int32_t height, uint32_t below, uint32_t above,
                                                     microtin_safe_heights* heights) {
  if (below == kNotStated || above == kNotStated) return MICROTIN_QUERY_NO_MARGIN;
  const int32_t whole = height >> 8;  // rounded down
  heights->lowest = whole - ((height & 255) == 0 ? 1 : 0) - static_cast<int32_t>(above) * 16;
  heights->highest = whole + 1 + static_cast<int32_t>(below) * 16;
  return MICROTIN_QUERY_OK;
}

}  // namespace microtin

#endif
