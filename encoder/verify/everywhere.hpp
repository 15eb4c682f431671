// SPDX-License-Identifier: MIT
// How far a surface of triangles is from the bilinear surface of a raster's posts, and what it must
// do better so that it keeps a bound there. Each has a source of its own.
#ifndef MICROTIN_ENCODER_VERIFY_EVERYWHERE_HPP
#define MICROTIN_ENCODER_VERIFY_EVERYWHERE_HPP

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/lattice_choice.hpp"
#include "encoder/terrain/source.hpp"
#include "encoder/verify/verify.hpp"
#include "microtin/microtin.h"

namespace microtin::verifying {

// The largest distances of a surface below and above another, in units of 2^-16 z steps, rounded
// up.
struct Gap {
  Wide below, above;
};

// Compares at the posts, where they lie, and along the edges of all real triangles. A bilinear less
// a linear function has no extreme inside the part of a triangle that lies in a cell, and along a
// line between posts it is linear. So these are the largest distances everywhere. Cells with a void
// post are left out, and so is what lies outside the grid of posts. Nothing if the numbers of the
// two lattices are too large for exact arithmetic, or if the raster is sparse. Takes O(posts +
// edges x cells that an edge crosses).
std::optional<Gap> measure_gap(const microtin_mesh* mesh, const Placement& lattice,
                               const Raster& raster);

// How far a surface may be from the bilinear one, in Gap's units: at each post, and in a cell as
// far as at the post of its four where that is farthest.
struct Allowed {
  std::vector<int64_t> distances;  // of posts
  bool never_below = false;        // but never below it
};
int64_t allowed_in_cell(const Allowed& allowed, std::size_t post, std::size_t width);

// By how much a surface is farther below or above than allowed, at most, at a post and in the cells
// around it. In Gap's units, rounded up; 0: it is not.
struct Excess {
  int64_t below = 0, above = 0;
};

// Measures it at all posts, as measure_gap does.
std::optional<std::vector<Excess>> measure_excess(const microtin_mesh* mesh,
                                                  const Placement& lattice, const Raster& raster,
                                                  const Allowed& allowed);

// Measures these distances in the unit of heights.
std::optional<Distances> measure_everywhere(const microtin_mesh* mesh, const Placement& lattice,
                                            const Raster& raster);

// As a header states them, rounded up. Not stated where nothing was measured, or too much.
Margins margins_of(const std::optional<Gap>& gap);

// What a header states, in the unit of heights, rounded up at 9 decimals.
std::optional<Distances> stated_everywhere(const Margins& margins, const Axis& z);

// The cell whose posts are farthest from lying in a plane: by heights a, b at the ends of one
// diagonal and c, d at the others it bends by |a + b - c - d|. Two triangles with these heights are
// up to a quarter of that from the bilinear surface.
struct Bend {
  uint32_t column = 0, row = 0;  // of its south-western post
  Decimal by;
};
Bend most_bent(const Raster& raster);

inline bool is_bound_everywhere(const LatticeOptions& options) {
  return options.bound_at == BoundScope::kEverywhere && options.max_error;
}

// The options of a first fit, which looks at posts alone. They have a part of a bound that holds
// everywhere, so that few places between posts are missed. Other options stay as they are.
LatticeOptions first_fit(const LatticeOptions& options);

// Throws Error if the posts of a raster are not at equal distances: between others there is no
// bilinear surface.
void expect_equal_distances(const Raster& raster);

// Throws Error: the bound is missed around `missed` posts. The message has the cell that bends
// most, and what helps.
[[noreturn]] void refuse_everywhere(const Raster& raster, const LatticeOptions& options,
                                    uint64_t missed);

// Narrows the limits of posts around the places that a surface misses, from attempt to attempt:
// first by what is missed and a little more; where that was in vain, the posts become vertices,
// with limits that leave room for what a cell bends between its posts. A cell whose four posts are
// such vertices consists of two triangles and misses nothing, if a whole step lies within the
// limits of each.
class EverywhereBound {
 public:
  // The options have a bound. The raster must outlive this. Throws Error if it is sparse, or if
  // places of the lattice are not those of its posts.
  EverywhereBound(const Raster& raster, const LatticeOptions& options, const Placement& lattice);

  // Measures a surface. How many posts are next to a place that it misses: 0 if it keeps the bound
  // everywhere. Throws Error if that cannot be computed exactly.
  uint64_t see(const microtin_mesh* mesh);

  // Those that all surfaces seen need, in the order of places.
  std::vector<Tightening> tightenings() const;

  // The limits of a post that becomes a vertex: one height if a cell around it bends too much.
  Tightening vertex_limits(std::size_t post) const;

 private:
  void narrow(std::size_t post, int32_t here, Excess excess);

  const Raster& raster_;
  Placement lattice_;
  LatticeMap to_steps_;  // from numbers of heights
  Allowed allowed_;
  std::map<std::size_t, Tightening> limits_;  // of posts that were narrowed
};

}  // namespace microtin::verifying

#endif
