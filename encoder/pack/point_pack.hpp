// SPDX-License-Identifier: MIT
// A cloud of points as a pack of tiles.
#ifndef MICROTIN_ENCODER_PACK_POINT_PACK_HPP
#define MICROTIN_ENCODER_PACK_POINT_PACK_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/pack/encode.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/terrain/source.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::pack {

struct PointPack {
  PackContent content;
  std::vector<uint8_t> streams;
  Decimal xy_step, xy_displacement;  // as in Laid
  uint64_t merged = 0;
};

// The finest step among 1, 2, 5, 10 ... of the last decimal of the points' places at which `tiles`
// tiles, as large as they can be, cover them. O(points).
Decimal finest_step(const PointCloud& cloud, uint64_t tiles);

// Cuts the hull of the cloud into tiles and encodes each, on all processors; the result depends
// neither on their number nor on the order of the points. Every place of the hull, so every point,
// is covered by a tile, and every point within the bound; without one, every place that points have
// is a vertex. Borders have no cracks. Throws Error if that cannot be done, as lay_out does, if all
// points lie on one line, or if more than kMostTiles tiles are needed. The metadata needs neither
// placement nor accuracy; the options must not set tile_size.
PointPack encode_point_pack(const PointCloud& cloud, const PackOptions& options,
                            Metadata metadata = {});

// As for a mesh. A point on a border counts once, and is covered if one of its tiles covers it;
// it is visited for each tile that holds it, always in the same order.
Verification verify(const PackFile& pack, const PointCloud& cloud,
                    const std::optional<Decimal>& bound, const PostVisitor& visit = {});

}  // namespace microtin::pack

#endif
