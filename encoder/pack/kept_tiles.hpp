// SPDX-License-Identifier: MIT
// The tiles of a pack that stay as they are when the raster changes.
#ifndef MICROTIN_ENCODER_PACK_KEPT_TILES_HPP
#define MICROTIN_ENCODER_PACK_KEPT_TILES_HPP

#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/base/work.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/borders.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/pack/tile.hpp"

namespace microtin::pack {

// A tile is kept if it does for the posts of the changed raster all that an encoded tile does. It
// covers every post with a height, within the bound and on the bound's side, and no void post.
// Water has its level, and breaklines are edges. The margins that the tile states hold. The posts
// of its borders next to voids are vertices, so that a neighbour can be encoded anew. A tile
// without terrain is kept if no post with a height belongs to that tile alone. A tile of the old
// pack that cannot be read is not kept.
class KeptTiles {
 public:
  // Reads and decodes every tile of the old pack, on all processors. All three must outlive this.
  // The raster has the posts of the pack.
  KeptTiles(const PackFile& old, const TiledRaster& changed, const Progress& progress);

  bool keeps(uint32_t tile) const { return tiles_[tile].is_kept; }
  bool has_terrain(uint32_t tile) const { return keeps(tile) && tiles_[tile].summary.bytes != 0; }
  uint32_t count() const;

  // A tile that is kept, measured by the changed raster.
  EncodedTile tile(uint32_t tile) const;

  // The vertices on the border of a tile that is kept, by place in the tile.
  const SharedVertices& border(uint32_t tile) const { return tiles_[tile].border; }

  // The height of the vertex at a post, if a tile that is kept has one there.
  std::optional<int16_t> height_at(GlobalPost post) const;

 private:
  struct Tile {
    bool is_kept = false;
    TileSummary summary;
    SharedVertices border;
  };
  Tile examined(uint32_t number) const;

  const PackFile& old_;
  const TiledRaster& changed_;
  std::vector<Tile> tiles_;
};

}  // namespace microtin::pack

#endif
