// SPDX-License-Identifier: MIT
// Terrains whose numbers are brought into units that streams have, and point upwards.
#ifndef MICROTIN_ENCODER_IMPORT_CONVERSION_HPP
#define MICROTIN_ENCODER_IMPORT_CONVERSION_HPP

#include "encoder/import/import.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

// Whether numbers stay as they are.
bool is_plain(const Conversion& conversion);

// Multiplies all numbers and takes the reference. Throws Error if one gets too large, or needs too
// many decimals.
void convert(Source& source, const SettledReference& settled);

// Settles what a file says and what is asked for, and converts the file's numbers: of a raster that
// is read in pieces when a piece is read. Throws Error as settle and convert do.
void settle_source(Source& source, const Reference& asked);
void settle_source(OpenSource& source, const Reference& asked);

}  // namespace microtin::importing

#endif
