// SPDX-License-Identifier: MIT
// What one point sees of the mesh: tests of it against triangles that share corners, in a row.
#ifndef MICROTIN_SHARED_SIGHT_HPP
#define MICROTIN_SHARED_SIGHT_HPP

#include "shared/mesh.hpp"
#include "shared/pairs.hpp"

namespace microtin {

#if defined(MICROTIN_PAIRS)

MICROTIN_OUT_OF_LINE inline bool in_any_conflict(const Mesh& mesh, Index a, Index b, Index c,
                                                 Point p) {
  return in_conflict(mesh, a, b, c, p);
}

struct Seen {
  Index vertex;
  Pair place;  // in the window around the point
};

class Sight {
 public:
  Sight(const Mesh& mesh, Point p)
      : mesh_(mesh),
        p_(p),
        window_(window_around(pair_of(p))),
        place_(difference(pair_of(p), window_)),
        all_(place_) {}

  // Infinity is taken for the point itself: then its tests come out even, which is a rare case.
  Seen see(Index v) {
    const Pair place = v == kInfinity ? place_ : difference(pair_of(point_of(mesh_, v)), window_);
    all_ = either(all_, place);
    return Seen{v, place};
  }

  // Whether the point conflicts with the counter-clockwise triangle (a, b, c).
  bool conflicts(const Seen& a, const Seen& b, const Seen& c) const {
    const int64_t d = is_outside(all_) ? 0 : incircle(a.place, b.place, c.place, place_);
    return d != 0 ? d > 0 : in_any_conflict(mesh_, a.vertex, b.vertex, c.vertex, p_);
  }

 private:
  const Mesh& mesh_;
  const Point p_;
  const Pair window_;
  const Pair place_;
  Pair all_;  // of all places seen: a bit that is in one
};

#else

struct Seen {
  Index vertex;
};

class Sight {
 public:
  Sight(const Mesh& mesh, Point p) : mesh_(mesh), p_(p) {}

  Seen see(Index v) { return Seen{v}; }

  // Whether the point conflicts with the counter-clockwise triangle (a, b, c).
  bool conflicts(const Seen& a, const Seen& b, const Seen& c) const {
    return in_conflict(mesh_, a.vertex, b.vertex, c.vertex, p_);
  }

 private:
  const Mesh& mesh_;
  const Point p_;
};

#endif

}  // namespace microtin

#endif
