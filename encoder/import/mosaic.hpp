// SPDX-License-Identifier: MIT
// One terrain from several files.
#ifndef MICROTIN_ENCODER_IMPORT_MOSAIC_HPP
#define MICROTIN_ENCODER_IMPORT_MOSAIC_HPP

#include <memory>
#include <string>
#include <vector>

#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/raster_reader.hpp"

namespace microtin::importing {

// The files of a terrain: for a folder those in it, by name, of the suffix that most of its terrain
// files have. Throws Error if a folder holds none.
std::vector<std::string> files_in(const std::string& path);

// What people should know of a folder that holds terrain files of other suffixes, too; else empty.
std::string left_out_of(const std::string& path);

struct NamedSource {
  std::string path;
  OpenSource source;
};

// One raster, or one cloud, of at least one. Rasters are read when the whole is asked; their posts
// must lie on one grid, in the same units and systems; where several have a height the first one's
// counts, and where none has it is void. `selection` of the whole says how many files overlap and
// by how much they differ at most, and where; so of points at places that files share. Points all
// count. Throws Error naming the file that
// does not go with the first.
OpenSource join(std::vector<NamedSource> parts);

}  // namespace microtin::importing

#endif
