// SPDX-License-Identifier: MIT
// Files on both sides of 180 degrees: one name for each longitude, so that neighbours stay
// neighbours.
#ifndef MICROTIN_ENCODER_IMPORT_LONGITUDES_HPP
#define MICROTIN_ENCODER_IMPORT_LONGITUDES_HPP

#include <string>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::importing {

// Longitudes of a file, in degrees.
struct LongitudeSpan {
  double west, east;
};

// Which files have names of longitudes 360 degrees larger in the whole: where more than half a
// turn lies empty between files, those west of it continue those east of it, beyond 180.
std::vector<bool> turned_east(const std::vector<LongitudeSpan>& spans);

// Part of a sentence for the user; empty if none of the files is turned.
std::string turned_text(const std::vector<bool>& turned, double east);

}  // namespace microtin::importing

#endif
