// SPDX-License-Identifier: MIT
// Writing the terrain files of autopilots: ArduPilot's .DAT and INAV's .TER, a degree by a degree
// each.
#ifndef MICROTIN_ENCODER_EXPORT_AUTOPILOT_HPP
#define MICROTIN_ENCODER_EXPORT_AUTOPILOT_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/export/autopilot_layout.hpp"
#include "encoder/export/height_sampler.hpp"
#include "encoder/layers.hpp"

namespace microtin::exporting {

// By the suffix, .DAT or .TER; nothing for others.
std::optional<Autopilot> autopilot_of(const std::string& path);

// Metres between the posts that firmware expects if nothing else is set.
constexpr uint32_t kArduPilotSpacing = 100, kInavSpacing = 30;

struct AutopilotFile {
  std::vector<uint8_t> bytes;
  uint64_t blocks = 0;   // that hold heights
  uint64_t partial = 0;  // of these: groups of 4 x 4 posts without all heights are marked missing
  uint64_t empty = 0;    // all zero, which firmware takes for a block that it does not have
  uint64_t beyond = 0;   // posts beyond the terrain's edge that have the height there

  // What the grid, read as the firmware does, is away from the surface; metres.
  uint64_t places = 0;  // of the lattice that were looked at
  double largest = 0, rms = 0;

  // Places of the lattice with terrain, and those of them that firmware in single precision misses.
  uint64_t asked = 0, missed = 0;
};

// The surface as posts every `spacing` (10 .. 1000) metres. Its places must be in degrees, its
// heights in metres. Throws Error at the poles, where firmware's distances are not those of the
// file, if the surface has no height in the cell, where heights do not fit 16 bits or, in a block
// of INAV's, 10 bits of 2 m above the lowest, and as the surface does.
AutopilotFile autopilot_file(const SampledSurface& surface, Autopilot autopilot, DegreeCell cell,
                             uint32_t spacing);

}  // namespace microtin::exporting

#endif
