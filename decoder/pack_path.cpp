// SPDX-License-Identifier: MIT
// The clearance of paths above packs whose tiles are meshes: linked only where it is used, also by
// linkers that keep all of a file.
#include "decoder/path_search.hpp"
#include "decoder/terrain_forms.hpp"

using namespace microtin;

microtin_status microtin_pack_search_path(microtin_pack* pack, const microtin_path* path,
                                          uint32_t flags, microtin_path_search* search,
                                          uint32_t step_limit) {
  return search_path<MeshForm, microtin_pack_load>(pack, path, flags, search, step_limit);
}
