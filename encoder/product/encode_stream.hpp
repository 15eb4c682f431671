// SPDX-License-Identifier: MIT
// A terrain as one stream that is known to keep what was requested.
#ifndef MICROTIN_ENCODER_PRODUCT_ENCODE_STREAM_HPP
#define MICROTIN_ENCODER_PRODUCT_ENCODE_STREAM_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/fit/breaklines.hpp"
#include "encoder/fit/simplify.hpp"
#include "encoder/layers.hpp"
#include "encoder/product/options.hpp"
#include "encoder/terrain/lay_out.hpp"
#include "encoder/verify/breaklines.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::product {

struct Breaklines {
  FoundBreaklines found;  // by the decoder's triangles
  BreaklineCost cost;
};

struct EncodedStream {
  Laid laid;
  std::optional<Decimal> bound;        // requested, or found: the scale of posts' own bounds
  std::optional<StatedBounds> bounds;  // if posts have bounds of their own
  std::vector<uint8_t> stream;
  uint32_t vertices;
  Verification verification;
  std::optional<Verification> true_places;  // of points that the lattice moves
  std::optional<Distances> everywhere;      // of a raster, as the header states them
  std::optional<Breaklines> breaklines;     // if there are such lines
};

// Chooses, encodes, decodes with the shipped decoder, and compares that with every post or point:
// what is returned keeps the bound, covers all heights, leaves all voids open and keeps water at
// its level, and all breaklines are chains of edges. Points keep max_error where they truly lie,
// too, unless options leave that, and rasters keep it between their posts if options say so: after
// each attempt limits become narrower where it is missed. With a limit of bytes or vertices, that
// is the smallest bound found whose stream keeps the limit, in about the time of four encodings, or
// of more where the lattice moves points so far that bounds must be tried at their true places.
// Throws Error if what is requested cannot be had.
EncodedStream encode_stream(const Source& source, const EncodeOptions& requested,
                            const Progress& progress);

// The largest error where the bound is to hold.
Decimal error_where_bound(const EncodedStream& encoded, BoundScope bound_at);

// Encodes without looking for a bound: only insertion of the worst sample keeps max_vertices.
EncodedStream encode_measured(const Source& source, const EncodeOptions& options,
                              const Progress& progress);

// What becomes of an approximation with these options, whose bound holds on the lattice. It
// becomes as wide as it must where points truly lie, or everywhere, as options say.
EncodedStream measured(const Source& source, const EncodeOptions& options, Approximation&& found);

// As encode_stream, for options with a limit of bytes or of vertices and without a bound. About
// four encodings' time, at most five; of small terrains twenty. If the lattice moves points so far
// that errors grow by a twentieth where they truly lie, a few bounds more are tried there, each in
// several encodings. Throws Error if no bound is large enough.
EncodedStream encode_within_budget(const Source& source, const EncodeOptions& options,
                                   const Progress& progress);

}  // namespace microtin::product

#endif
