// SPDX-License-Identifier: MIT
// Breaklines over the tiles of a pack: the vertices that borders need for them, and the parts that
// lie in a tile.
#ifndef MICROTIN_ENCODER_PACK_TILED_LINES_HPP
#define MICROTIN_ENCODER_PACK_TILED_LINES_HPP

#include <cstdint>
#include <memory>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/breaklines.hpp"
#include "encoder/terrain/lattice_choice.hpp"
#include "shared/pack_format.hpp"

namespace microtin::pack {

// What lines need of a border, by place from its first corner.
struct BorderPins {
  std::vector<Pin> vertices;  // which both tiles need
  std::vector<Pin> heights;   // of posts between these, where a line with heights runs along them
};

// The parts of lines in a tile, by place in it.
struct LinesInTile {
  std::vector<LinePath> paths;
  std::vector<LineStop> stops;  // at vertices of borders
};

// Where a line crosses a border, and where it runs within half a step of one, the vertices of
// its chain are on that border. They depend on the line and the border alone, so that both tiles
// have the same ones.
class TiledLines {
 public:
  // Throws Error as path_of does, and if no line is near the box of all tiles.
  TiledLines(const std::vector<RealLine>& lines, const Placement& pack, const TileBox& all);

  // The border runs from corner to corner of tiles. O(places of lines nearby).
  BorderPins pins_on(const TileGrid& grid, const TileBox& border) const;

  LinesInTile in_tile(const TileGrid& grid, const TileBox& box) const;

  uint64_t fingerprint() const;

 private:
  // The least and the largest coordinates.
  struct Extent {
    double left, bottom, right, top;
    bool meets(const TileBox& box) const;
  };
  struct Line {
    LatticeLine line;  // in the coordinates of the pack
    Extent extent;
  };
  static Extent extent_of(const LatticeLine& line);

  std::vector<Line> lines_;
};

// Nothing without lines. The frame is that of the pack's raster.
std::shared_ptr<const TiledLines> tiled_lines(const std::vector<RealLine>& lines,
                                              const Placement& pack, const Raster& frame);

// Throws Error if packs of such a raster cannot have breaklines with the options.
void expect_breaklines_possible(const LatticeOptions& options, const Raster& frame);

// The parts of lines in a tile that count: those over its posts.
std::vector<LatticeLine> parts_of(const LinesInTile& lines, const Raster& posts);

}  // namespace microtin::pack

#endif
