// SPDX-License-Identifier: MIT
// One cloud from several.
#ifndef MICROTIN_ENCODER_IMPORT_JOINED_CLOUDS_HPP
#define MICROTIN_ENCODER_IMPORT_JOINED_CLOUDS_HPP

#include <vector>

#include "encoder/import/named_source.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

// All points of clouds, at least one, with the decimals that all need. `selection` says by how much
// they differ at most, and where, at places that files share. Throws Error naming the file that
// does not go with the first.
PointCloud join_clouds(std::vector<NamedSource> parts);

}  // namespace microtin::importing

#endif
