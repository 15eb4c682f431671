// SPDX-License-Identifier: MIT
// The best terrain for a limit of bytes or vertices.
#ifndef MICROTIN_ENCODER_PRODUCT_BUDGET_HPP
#define MICROTIN_ENCODER_PRODUCT_BUDGET_HPP

#include "encoder/layers.hpp"
#include "encoder/product/encode_stream.hpp"

namespace microtin::product {

// As encode_stream, for options with a limit of bytes or of vertices and without a bound. About
// four encodings' time, at most five; of small terrains twenty. If the lattice moves points so far
// that errors grow by a twentieth where they truly lie, a few bounds more are tried there, each in
// several encodings. Throws Error if no bound is large enough.
EncodedStream encode_within_budget(const Source& source, const EncodeOptions& options,
                                   const Progress& progress);

}  // namespace microtin::product

#endif
