// SPDX-License-Identifier: MIT
// The lattice that the posts of several rasters share, though their cells may differ.
#ifndef MICROTIN_ENCODER_IMPORT_COMMON_LATTICE_HPP
#define MICROTIN_ENCODER_IMPORT_COMMON_LATTICE_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::importing {

// Where a raster's posts are on a lattice: the first one, and every how many places others are.
struct PostPlaces {
  int64_t x, y;
  uint32_t x_spacing, y_spacing;  // 1 .. kMostSpacing
};

constexpr uint32_t kMostSpacing = 128;

struct CommonLattice {
  Axis x, y;                        // the coarsest with a place for each post
  std::vector<PostPlaces> rasters;  // in the order given
};

// The rasters' frames and the files' names, at least one of each. Cells may differ by a factor of
// whole numbers. Writers round corners by up to one millionth of a cell; posts lie off those of the
// first raster by whole cells, or by halves, thirds or quarters of the places that cells share.
// Throws Error naming the file that does not go with the first.
CommonLattice common_lattice(const std::vector<Raster>& frames,
                             const std::vector<std::string>& paths);

// A sentence for people if posts lie off those of the first raster, by parts of a cell, although
// neither all posts nor all corners of cells go together; else empty.
std::string warning_on_shift(const std::vector<PostPlaces>& rasters,
                             const std::vector<std::string>& paths);

}  // namespace microtin::importing

#endif
