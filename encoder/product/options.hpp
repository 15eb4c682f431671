// SPDX-License-Identifier: MIT
// What is asked of an encoding, and what follows from that for its parts.
#ifndef MICROTIN_ENCODER_PRODUCT_OPTIONS_HPP
#define MICROTIN_ENCODER_PRODUCT_OPTIONS_HPP

#include <cstdint>
#include <string>

#include "encoder/exact/metadata.hpp"
#include "encoder/fit/simplify.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/lattice_choice.hpp"

namespace microtin::product {

struct EncodeOptions {
  LatticeOptions lattice;
  uint32_t max_vertices = 0;   // 0: as many as it takes
  uint32_t max_bytes = 0;      // 0: as many as it takes; else the bound is looked for
  uint32_t tile_vertices = 0;  // of a pack: at most so many in a tile; 0: as device_ram allows
  uint32_t tile_steps = 0;     // of a pack of posts; 0: to be chosen
  uint64_t device_ram = 0;     // 0: unlimited
  Search search = Search::kNormal;
  Effort effort;
  uint32_t horizontal_epsg = 0;  // 0: what the terrain's format implies
  uint32_t vertical_epsg = 0;
  std::string source_text, date, lineage;
};

// What the header will say but for the accuracy.
Metadata metadata_of(const EncodeOptions& options, const Reference& reference,
                     const Placement& placement);

// The vertices that a stream may have, 0 for as many as it takes. A device's RAM is a limit only if
// nothing else asks for vertices.
uint32_t vertex_limit(const EncodeOptions& options);

SimplifyOptions simplify_options(const EncodeOptions& options, const Progress& progress);

}  // namespace microtin::product

#endif
