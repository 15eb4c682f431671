// SPDX-License-Identifier: MIT
// One terrain from several files: which files go together, and how their longitudes continue.
#ifndef MICROTIN_ENCODER_IMPORT_MOSAIC_HPP
#define MICROTIN_ENCODER_IMPORT_MOSAIC_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::importing {

struct NamedSource {
  std::string path;
  OpenSource source;
};

// Throws Error naming a part, and what to do, if its units or system `b` are not those of the first
// one, `a`.
void expect_alike(const NamedSource& first, const NamedSource& part, const Reference& a,
                  const Reference& b);

// Files on both sides of 180 degrees: one name for each longitude, so that neighbours stay
// neighbours.

// Longitudes of a file, in degrees.
struct LongitudeSpan {
  double west, east;
};

// Which files have names of longitudes 360 degrees larger in the whole: where more than half a
// turn lies empty between files, those west of it continue those east of it, beyond 180.
std::vector<bool> turned_east(const std::vector<LongitudeSpan>& spans);

// Part of a sentence for the user; empty if none of the files is turned.
std::string turned_text(const std::vector<bool>& turned, double east);

// One terrain from several files.

// One raster, or one cloud, of at least one. Rasters are read when the whole is; their posts
// must lie on one grid, in the same units and systems; where several have a height the first one's
// counts, and where none has it is void. `selection` of the whole says how many files overlap and
// by how much they differ at most, and where; so of points at places that files share. Points all
// count. Throws Error naming the file that does not go with the first.
OpenSource join(std::vector<NamedSource> parts);

// One cloud from several.

// All points of clouds, at least one, with the decimals that all need. `selection` says by how much
// they differ at most, and where, at places that files share. Throws Error naming the file that
// does not go with the first.
PointCloud join_clouds(std::vector<NamedSource> parts);

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
