// SPDX-License-Identifier: MIT
// What was taken of a laser scan, and what was left out.
#ifndef MICROTIN_ENCODER_IMPORT_CLASS_COUNTS_HPP
#define MICROTIN_ENCODER_IMPORT_CLASS_COUNTS_HPP

#include <string>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::importing {

void add(ClassCounts& sum, const ClassCounts& more);

// "taken: class 2 (812); left out: class 1 (240), withheld (13)".
std::string taken_text(const ClassCounts& counts, const ClassSet& taken);

}  // namespace microtin::importing

#endif
