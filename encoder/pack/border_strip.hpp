// SPDX-License-Identifier: MIT
// Makes borders with which both tiles can keep a bound between their posts, too.
#ifndef MICROTIN_ENCODER_PACK_BORDER_STRIP_HPP
#define MICROTIN_ENCODER_PACK_BORDER_STRIP_HPP

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/pack/borders.hpp"
#include "encoder/verify/everywhere.hpp"

namespace microtin::pack {

// What both tiles come to at worst along their border: all posts next to it are vertices there, at
// the heights that vertex_height chooses. Edges between neighbouring posts are in every Delaunay
// triangulation of posts, so they part a strip of one step on each side from the rest of the tiles.
// A border with which this strip keeps the bound is one with which tiles can.
class BorderStrip {
 public:
  // The options of `tiled` have a bound everywhere. Both must outlive this.
  BorderStrip(const TiledRaster& tiled, const TilePosts& posts, const TileBox& line);
  BorderStrip(const BorderStrip&) = delete;
  BorderStrip& operator=(const BorderStrip&) = delete;

  // Makes the first and the last post vertices whose limits leave room for what cells bend: other
  // borders end there, and must find the same. The posts next to them get such limits, too: in the
  // cell at a corner, vertices of both borders may make the triangles that neither strip has.
  void pin_ends(std::vector<LinePost>& on_line);

  // Makes vertices of the posts next to the places that a chain misses. False: it misses none.
  bool pin_missed(const std::vector<ChainVertex>& chain, std::vector<LinePost>& on_line);

 private:
  std::size_t post_at(uint32_t along) const;
  void limit(uint32_t along, LinePost& post) const;
  void pin(uint32_t along, std::vector<LinePost>& on_line);
  Survey strip_survey(const std::vector<ChainVertex>& chain, int side) const;

  TileBox box_, line_;
  bool is_row_;
  Raster raster_;  // the posts of the line and two on each side
  Placement lattice_;
  EverywhereBound bound_;
  Survey survey_;             // of them as vertices, in the order of places
  std::vector<bool> pinned_;  // posts of the line
};

// Fixes a post next to a border at the height that a BorderStrip assumes.
void pin_height(Sample& sample);

}  // namespace microtin::pack

#endif
