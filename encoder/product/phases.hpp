// SPDX-License-Identifier: MIT
// What a stream's header states about its mesh and its phases, measured.
#ifndef MICROTIN_ENCODER_PRODUCT_PHASES_HPP
#define MICROTIN_ENCODER_PRODUCT_PHASES_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::product {

// Decodes a stream and compares it with its source at the end of each section. Takes the time of
// decoding, and of a comparison for each section.
std::vector<PhaseEnd> measure_phases(const std::vector<uint8_t>& stream, const Source& source);

// Returns what is wrong with the phases that a header states, or an empty text. Vertices and bytes
// must be equal, errors at least as large.
std::string broken_phases(const std::vector<PhaseEnd>& stated, const std::vector<PhaseEnd>& found);

// Throws Error unless the digest and the phases' vertices and bytes are as the header states them,
// if it does. `mesh` is what the stream decodes to.
void expect_as_stated(const std::vector<uint8_t>& stream, const microtin_mesh* mesh);

}  // namespace microtin::product

#endif
