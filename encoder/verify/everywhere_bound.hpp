// SPDX-License-Identifier: MIT
// What a surface must do better so that it keeps a bound everywhere, not at posts alone.
#ifndef MICROTIN_ENCODER_VERIFY_EVERYWHERE_BOUND_HPP
#define MICROTIN_ENCODER_VERIFY_EVERYWHERE_BOUND_HPP

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/layers.hpp"
#include "encoder/terrain/lattice_choice.hpp"
#include "encoder/terrain/source.hpp"
#include "encoder/verify/everywhere.hpp"
#include "microtin/microtin.h"

namespace microtin::verifying {

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

  // Those that all surfaces seen ask for, in the order of places.
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
