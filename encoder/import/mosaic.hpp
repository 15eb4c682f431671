// SPDX-License-Identifier: MIT
// One terrain from several files.
#ifndef MICROTIN_ENCODER_IMPORT_MOSAIC_HPP
#define MICROTIN_ENCODER_IMPORT_MOSAIC_HPP

#include <vector>

#include "encoder/import/named_source.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

// One raster, or one cloud, of at least one. Rasters are read when the whole is asked; their posts
// must lie on one grid, in the same units and systems; where several have a height the first one's
// counts, and where none has it is void. `selection` of the whole says how many files overlap and
// by how much they differ at most, and where; so of points at places that files share. Points all
// count. Throws Error naming the file that does not go with the first.
OpenSource join(std::vector<NamedSource> parts);

}  // namespace microtin::importing

#endif
