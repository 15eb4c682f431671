// SPDX-License-Identifier: MIT
// The public options, in the terms of the parts that do the work.
#ifndef MICROTIN_ENCODER_PRODUCT_PUBLIC_OPTIONS_HPP
#define MICROTIN_ENCODER_PRODUCT_PUBLIC_OPTIONS_HPP

#include "encoder/import/prepared_terrain.hpp"
#include "encoder/layers.hpp"
#include "encoder/product/options.hpp"
#include "microtin/encoder.hpp"

namespace microtin::product {

// The options of the encoding itself, without the lines of the file `breaklines` and without what
// `obstacles` imply. Throws Error naming an option that does not take its value.
EncodeOptions options_of(const encoder::Options& options);

// Reads the file of breaklines, if there is one. Throws Error naming the file.
void take_breaklines(const encoder::Options& options, EncodeOptions& all);

// The preparation of the terrain with the options that shape it, and with its units and systems.
// The values are those that options_of accepts. Throws Error if they contradict.
Preparation preparation_of(const encoder::Options& options, Preparation preparation = {});

}  // namespace microtin::product

#endif
