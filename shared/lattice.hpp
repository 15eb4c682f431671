// SPDX-License-Identifier: MIT
// The integer lattice on which all geometry happens, and the lexicographic order of its points.
#ifndef MICROTIN_SHARED_LATTICE_HPP
#define MICROTIN_SHARED_LATTICE_HPP

#include <stdint.h>

#include "shared/compiler.hpp"

namespace microtin {

constexpr uint16_t kLatticeMax = 65535;  // x and y run from 0 to here; see predicates.hpp for why

// At least 32 bits, as wide as the machine multiplies best. (int_fast32_t is not the same in all
// parts of one program: hosted and freestanding headers may differ.)
#if UINTPTR_MAX > 0xFFFFFFFFu
typedef int64_t FastInt;
#else
typedef int32_t FastInt;
#endif

inline FastInt absolute(FastInt v) {
  return v < 0 ? -v : v;
}

struct MICROTIN_WORD Point {
  uint16_t x;
  uint16_t y;
};

// A terrain vertex: its place and its height in steps.
struct Vertex {
  uint16_t x;
  uint16_t y;
  int16_t z;
};

inline bool operator==(Point a, Point b) {
  return a.x == b.x && a.y == b.y;
}

inline bool operator!=(Point a, Point b) {
  return !(a == b);
}

// Lexicographic: by x, then by y. Orders the symbolic perturbation and names the first point.
inline uint32_t rank_of(Point p) {
  return static_cast<uint32_t>(p.x) << 16 | p.y;
}

inline bool operator<(Point a, Point b) {
  return rank_of(a) < rank_of(b);
}

}  // namespace microtin

#endif
