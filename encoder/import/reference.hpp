// SPDX-License-Identifier: MIT
// In which units and systems a terrain lies: what its file, codes and people state, settled, and
// its numbers converted.
#ifndef MICROTIN_ENCODER_IMPORT_REFERENCE_HPP
#define MICROTIN_ENCODER_IMPORT_REFERENCE_HPP

#include <string>
#include <string_view>

#include "encoder/exact/units.hpp"
#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::importing {

// What the numbers of a file are multiplied by, so that they are in units that streams have. Depths
// have a factor below 0.
struct Conversion {
  DecimalFactor xy, z;
};

struct SettledReference {
  Reference reference;  // after the conversion
  Conversion conversion;
};

// What is requested, where it says something, comes before what the file says; warnings say what
// gave way, and what is converted. Codes that are requested bring their units. `requested.depths`
// turns heights that grow downwards into heights. Throws Error if what is requested contradicts
// itself, and if the file's system is not read, its heights are depths, or a unit cannot be
// converted exactly, and nothing that is requested decides.
SettledReference settle(const Reference& file, const Reference& requested);

// Heights of unknown unit have that of x and y if that is a length. Remarks tell what is guessed or
// not known. Throws Error if x and y are degrees and nobody knows the unit of heights.
Reference completed(Reference reference);

// Throws Error if x and y of a file that goes with a terrain are known to be in another unit or
// system than the terrain's: its positions would be other places.
void expect_same_horizontal_system(const Reference& file, const Reference& terrain);

// "metre", of heights, too; or "degree:foot", horizontal before vertical; ":fathom" is the vertical
// unit alone. False if it is none of these, or degrees are vertical.
bool read_units(const std::string& text, Reference& requested);

// Takes a unit as a file states it. Nothing changes if none is stated.
void state_horizontal_unit(const StatedUnit& unit, Reference& reference);
void state_vertical_unit(const StatedUnit& unit, Reference& reference);

// Adds what another file of the same terrain says: the warnings that are not there yet, and notes.
void add_statements(const Reference& from, Reference& to);

// Terrains whose numbers are brought into units that streams have, and point upwards.

// Whether numbers stay as they are.
bool is_plain(const Conversion& conversion);

// Multiplies all numbers and takes the reference. Throws Error if one gets too large, or needs too
// many decimals.
void convert(Source& source, const SettledReference& settled);

// Settles what a file says and what is requested, and converts the file's numbers: of a raster that
// is read in pieces when a piece is read. Throws Error as settle and convert do.
void settle_source(Source& source, const Reference& requested);
void settle_source(OpenSource& source, const Reference& requested);

}  // namespace microtin::importing

#endif
