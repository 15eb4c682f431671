// SPDX-License-Identifier: MIT
// A pack as one surface.
#ifndef MICROTIN_ENCODER_PACK_SURFACE_HPP
#define MICROTIN_ENCODER_PACK_SURFACE_HPP

#include <optional>
#include <vector>

#include "encoder/base/work.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/verify/breaklines.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::pack {

// Vertices in the order of tiles, those on borders once. Throws Error as PackFile::tile does, or if
// tiles give a vertex on their border different heights.
SurfaceModel model_of(const PackFile& pack);

// Throws Error unless the posts of a raster, or of its frame, are the places of the pack.
void expect_posts_of(const Raster& frame, const PackFile& pack);

// Looks for the edges tile by tile. Throws Error as verify does.
FoundBreaklines find_breaklines(const PackFile& pack, const RasterReader& raster,
                                const std::vector<RealLine>& lines,
                                const std::optional<LineRoom>& room);

// As for a mesh; every post counts once, and a post on a border is covered if one of its tiles
// covers it. On all processors; holds a row of tiles at a time. Posts on borders are visited for
// each tile that covers them, always in the same order. Throws Error also if the raster's posts are
// not the places of the pack.
Verification verify(const PackFile& pack, const RasterReader& raster,
                    const std::optional<Decimal>& bound, const Progress& progress = {},
                    const PostVisitor& visit = {});

}  // namespace microtin::pack

#endif
