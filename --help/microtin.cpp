// microtin 0.1.0, the decoder in two files, made by decoder/amalgamate.py. MIT licence.
#include "microtin.h"

#if defined(__clang__)
#pragma clang diagnostic ignored "-Wunused-const-variable"
#endif

// --- decoder/buckets.cpp
// Buckets: for each part of a terrain's box a triangle near it.
// --- decoder/state.hpp
// What the two workspaces hold.

// --- decoder/range_decoder.hpp
// The reading coder: a binary range decoder over the bytes of one section's payload.

// --- shared/crc32.hpp
// CRC-32 as in zip and Ethernet: polynomial 0x04C11DB7, reflected, all ones before and after.

#include <stddef.h>
#include <stdint.h>

// --- shared/tables.hpp
// The constant tables, and the one way to read them: on AVR they stay in flash.

#include <stdint.h>

// --- shared/compiler.hpp
// What compilers are told. Included before all other code, since it holds for what follows.

// GCC 12 at -O2, where there are no vector registers, puts two 16-bit numbers into a word and takes
// the high half of the word's square for that of each (the middles of slices, cells.hpp): seen on
// RISC-V and on x86 without SSE.
#if defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE__) &&     \
    !defined(__OPTIMIZE_SIZE__) && !defined(__SSE2__) && !defined(__VX__) && \
    !defined(__ARM_NEON) && !defined(__ALTIVEC__) && !defined(__riscv_vector)
#pragma GCC optimize("no-tree-vectorize")
#endif

// Where size counts, GCC keeps more values at hand than there are registers, and moves instructions
// apart: without that Cortex-M4 needs 170 bytes less, Cortex-M0 240.
#if defined(__GNUC__) && !defined(__clang__) && defined(__OPTIMIZE_SIZE__)
#pragma GCC optimize("no-tree-fre", "no-move-loop-invariants")
#pragma GCC optimize("no-caller-saves", "no-schedule-insns2")
#endif

// Where speed counts, rare code, and code that is vectorised only if no loop is around it, is kept
// out of its callers (OUT_OF_LINE). Where size counts, there is one copy of what is small but
// wanted in many places (ONE_COPY), and no call of what is wanted in one (IN_PLACE).
#if !defined(__GNUC__)
#define MICROTIN_OUT_OF_LINE
#define MICROTIN_ONE_COPY
#define MICROTIN_IN_PLACE
#elif defined(__OPTIMIZE_SIZE__)
#define MICROTIN_OUT_OF_LINE
#if defined(__clang__)
#define MICROTIN_ONE_COPY __attribute__((noinline))
#else
#define MICROTIN_ONE_COPY __attribute__((noinline, noclone))
#endif
#define MICROTIN_IN_PLACE __attribute__((always_inline))
#else
#define MICROTIN_OUT_OF_LINE __attribute__((noinline))
#define MICROTIN_ONE_COPY
#define MICROTIN_IN_PLACE
#endif

// Where a multiplication makes 32 bits at most: wider ones are calls.
#if defined(__ARM_ARCH_6M__) || defined(__AVR__) || (defined(__riscv) && !defined(__riscv_mul))
#define MICROTIN_NARROW_MACHINE
#endif


#if defined(__AVR__)
#include <avr/pgmspace.h>
#define MICROTIN_IN_FLASH PROGMEM
#else
#define MICROTIN_IN_FLASH
#endif

namespace microtin {

template <class Number>
Number read_table(const Number* entry) {
#if defined(__AVR__)
  const uint8_t* const bytes = reinterpret_cast<const uint8_t*>(entry);
  Number number = 0;
  for (uint8_t i = sizeof(Number); i-- != 0;) {
    number = static_cast<Number>(static_cast<uint32_t>(number) << 8 | pgm_read_byte(bytes + i));
  }
  return number;
#else
  return *entry;
#endif
}

}  // namespace microtin


namespace microtin {

// Shifts eight bits out of a check: one by one where size counts, otherwise by fours.
#if defined(__OPTIMIZE_SIZE__)

inline uint32_t shift_byte(uint32_t crc) {
  for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ ((crc & 1u) != 0 ? 0xEDB88320u : 0u);
  return crc;
}

#else

// What four bits shifted out add.
constexpr uint32_t kCrcTable[16] MICROTIN_IN_FLASH = {
    0x00000000, 0x1DB71064, 0x3B6E20C8, 0x26D930AC, 0x76DC4190, 0x6B6B51F4, 0x4DB26158, 0x5005713C,
    0xEDB88320, 0xF00F9344, 0xD6D6A3E8, 0xCB61B38C, 0x9B64C2B0, 0x86D3D2D4, 0xA00AE278, 0xBDBDF21C,
};

inline uint32_t shift_byte(uint32_t crc) {
  for (int i = 0; i < 2; ++i) crc = crc >> 4 ^ read_table(kCrcTable + (crc & 15u));
  return crc;
}

#endif

// The check of anything and its own check, low byte first, behind it.
constexpr uint32_t kCheckedCrc = 0x2144DF1C;

// Feed 0 first, then each result: crc32(crc32(0, a), b) is the check of a followed by b.
inline uint32_t crc32(uint32_t crc, const uint8_t* bytes, size_t size) {
  crc = ~crc;
  for (size_t i = 0; i < size; ++i) crc = shift_byte(crc ^ bytes[i]);
  return ~crc;
}

}  // namespace microtin

// --- shared/format.hpp
// The constants of the format and the fixed part of its header. FORMAT.md explains them.

#include <stddef.h>
#include <stdint.h>


namespace microtin {

constexpr uint8_t kMagic[4] MICROTIN_IN_FLASH = {'m', 't', 'i', 'n'};
constexpr uint8_t kVersion = 4;
constexpr uint32_t kMinDegree = 6, kMaxDegree = 32;
constexpr uint32_t kMaxLevels = 3;
constexpr uint32_t kMaxVertices = 16777216;  // 2^24

// A section of the body ends with the first phase that brings the terrain to this many vertices,
// and with every phase after it.
constexpr uint32_t kSectionVertices = 256;

// Payload bytes that suffice for any step. Most are used by a vertex on a hull edge: a decision,
// its gap (18 decisions and 15 uniform bits) and its height (19 decisions and 15 uniform bits), at
// 9 bits a decision, are 47 bytes (FORMAT.md, "Payload bytes of a step").
constexpr uint32_t kStepBytes = 48;

// Bytes of zero that stand virtually behind a section's payload.
constexpr uint32_t kVirtualBytes = 4;

// Vertices of all phases together that a stream may walk around. Every phase of the encoder leaves
// about 3/4 of its vertices at most: 4 n and 7 per phase suffice (FORMAT.md, "Work").
constexpr uint32_t work_budget(uint32_t vertices) {
  return 4 * vertices + 512;
}

// The sum that breaks the budget is beyond it by one phase at most.
static_assert(work_budget(kMaxVertices) + uint64_t{kMaxVertices} <= UINT32_MAX, "work fits");

// What the fixed header promises.
struct Contract {
  uint32_t vertices;
  uint16_t x_max, y_max;
  uint32_t degree;  // most triangles around a vertex when it is inserted
  uint32_t levels;  // of cells (place_coding.hpp)
  bool has_heights;
  bool has_voids;
};

// Lattice places that vertices can lie on: at most 2^32.
inline uint64_t lattice_places(const Contract& contract) {
  return (static_cast<uint64_t>(contract.x_max) + 1) * (static_cast<uint32_t>(contract.y_max) + 1);
}

// A stream begins with magic 4 and version 1. What follows of the header is framed as sections are:
// its length, then properties, vertices, x_max, y_max, the placement, notes; the CRC-32 of all
// before.
constexpr uint32_t kIdentityBytes = 5;
constexpr uint32_t kCheckBytes = 4;
constexpr uint32_t kPlacementMostBytes = 66;                                // 3 * (10 + 6 + 6)
constexpr uint32_t kHeaderMostBytes = 2 + 4 + 3 + 3 + kPlacementMostBytes;  // before the notes

// Properties: these flags, 8 * levels, 32 * degree.
constexpr uint32_t kHasHeights = 1, kHasVoids = 2, kHasPlacement = 4;

// Notes are for people and hosts; decoding needs none of them. A type byte, a length (2 bytes), the
// content.
constexpr uint8_t kNoteUnits = 1, kNoteEpsg = 2, kNoteSource = 3, kNoteAccuracy = 4;
constexpr uint8_t kNoteDate = 5, kNoteLineage = 6, kNoteWater = 7;
constexpr uint32_t kNoteHeadBytes = 3;

inline uint32_t read_u16(const uint8_t* p) {
  return p[0] | static_cast<uint32_t>(p[1]) << 8;
}

inline uint32_t read_u32(const uint8_t* p) {
  return read_u16(p) | read_u16(p + 2) << 16;
}

}  // namespace microtin

// --- shared/mesh.hpp
// The half-edge mesh: three half-edges per triangle in a row, ghost triangles around the hull.
//
// Half-edge h runs from origin[h] to the origin of next_in_triangle(h); triangles turn
// counter-clockwise. Ghost triangles join each hull edge to the vertex at infinity, so the mesh is
// a sphere: n vertices give exactly 2n - 2 triangles and every half-edge has a twin.

#include <stddef.h>

// --- shared/fixed_math.hpp
// Integer logarithm, power and square root for estimates. Identical on every target.

#include <stdint.h>


namespace microtin {

// A base-2 logarithm with 8 fractional bits.
typedef int32_t Log2;
constexpr Log2 kLog2One = 256;

// Position of the highest set bit of v > 0.
MICROTIN_ONE_COPY inline uint32_t highest_bit(uint64_t v) {
#if defined(__GNUC__) && UINTPTR_MAX > 0xFFFFFFFFu
  return 63u ^ static_cast<uint32_t>(__builtin_clzll(v));
#else
  uint32_t bit = 0;
  if (v >> 32) {
    v >>= 32;
    bit = 32;
  }
  uint32_t w = static_cast<uint32_t>(v);
#if defined(__GNUC__) && !defined(__AVR__)
  return bit + (31u ^ static_cast<uint32_t>(__builtin_clz(w)));
#else
  for (uint32_t step = 16; step != 0; step >>= 1) {
    if (w >> step) {
      w >>= step;
      bit += step;
    }
  }
  return bit;
#endif
#endif
}

// log2(v) within 1/256, for v > 0.
inline Log2 log2_of(uint64_t v) {
  const uint32_t bit = highest_bit(v);
  // The 16 bits behind the leading one, m of 2^16: log2(1 + m) is m + m (1 - m) (0.424 - 0.162 m).
  const uint32_t m = static_cast<uint32_t>(v << (63u - bit) >> 47) & 0xFFFFu;
  const uint32_t bend = (m * (65536u - m) >> 16) * (27800u - (10600u * m >> 16)) >> 16;
  return static_cast<Log2>(bit * 256u + ((m + bend + 128u) >> 8));
}

// 2^l within 1/256 of itself, at least 1 and at most 2^30.
inline uint32_t exp2_of(Log2 l) {
  if (l <= 0) return 1;
  const uint32_t bit = static_cast<uint32_t>(l) >> 8, f = static_cast<uint32_t>(l) & 255u;
  if (bit >= 30) return static_cast<uint32_t>(1) << 30;
  // f of 2^8: 2^f is 1 + f - f (1 - f) (0.305 + 0.078 f).
  const uint32_t mantissa = 32768u + 128u * f - (f * (256u - f) * (9980u + 10u * f) >> 16);
  return mantissa << 16 >> (31u - bit);
}

// v * factor / 2^shift, rounded down; the product fits.
MICROTIN_ONE_COPY inline int64_t scaled(int64_t v, int32_t factor, uint32_t shift) {
  return v * factor >> shift;
}

MICROTIN_ONE_COPY inline int32_t kept_within(int64_t v, int32_t most) {
  return v > most ? most : v < -most ? -most : static_cast<int32_t>(v);
}

// A number at least sqrt(v) and at most 2 + sqrt(v) * (1 + 2^-7), for 0 < v < 2^58.
inline uint32_t sqrt_above(uint64_t v) {
  return exp2_of((log2_of(v) + 3) / 2) + 1;
}

}  // namespace microtin

// --- shared/lattice.hpp
// The integer lattice on which all geometry happens, and the lexicographic order of its points.

#include <stdint.h>


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

struct Point {
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

// --- shared/predicates.hpp
// Exact orientation and in-circle tests on the 16-bit lattice, and the conflict rule that makes the
// Delaunay triangulation unique.


namespace microtin {

// Where a point lies as seen from another: each coordinate is within +-65535.
struct Offset {
  FastInt x;
  FastInt y;
};

inline Offset operator-(Point a, Point p) {
  return Offset{static_cast<FastInt>(a.x) - p.x, static_cast<FastInt>(a.y) - p.y};
}

inline Offset operator-(Offset a, Offset b) {
  return Offset{a.x - b.x, a.y - b.y};
}

// Twice the signed area of the origin, a, b: positive if they turn counter-clockwise. The products
// are below 2^32, so the difference is below 2^33; of points of the lattice it is within +-2^32.
inline int64_t cross(Offset a, Offset b) {
  return static_cast<int64_t>(a.x) * b.y - static_cast<int64_t>(a.y) * b.x;
}

inline int64_t dot(Offset a, Offset b) {
  return static_cast<int64_t>(a.x) * b.x + static_cast<int64_t>(a.y) * b.y;  // |result| < 2^33
}

// Twice the signed area of (a, b, c).
inline int64_t orient2d(Point a, Point b, Point c) {
  return cross(b - a, c - a);
}

// The product of two signed numbers modulo 2^64.
inline uint64_t wrapping_product(int64_t a, int64_t b) {
  return static_cast<uint64_t>(a) * static_cast<uint64_t>(b);
}

// The angle under which a point sees the chord from a to b: h is twice the triangle's area, q a dot
// product, q / h the cotangent. |h| <= 2^32, |q| < 2^33.
struct Angle {
  int64_t q;
  int64_t h;
};

inline Angle angle_between(Offset a, Offset b) {
  return Angle{dot(a, b), cross(a, b)};
}

inline Angle angle_at(Point p, Point a, Point b) {
  return angle_between(a - p, b - p);
}

// Positive if p lies inside the circle through the counter-clockwise a, b, c; zero if on it. c and
// p are given by the angles under which they see the chord from a to b.
//
// For four points in a square of side S the determinant is at most S^4 / 2 in magnitude
// (FORMAT.md, "Exactness", has the proof). S = 65535 gives 9.2228e18 < 2^63 = 9.2234e18, so the
// value computed modulo 2^64, read as a signed number, is exact.
static_assert(uint64_t{kLatticeMax} * kLatticeMax * kLatticeMax * kLatticeMax / 2 < INT64_MAX,
              "the largest determinant fits");

inline int64_t incircle(Angle c, Angle p) {
  return static_cast<int64_t>(wrapping_product(c.q, p.h) - wrapping_product(p.q, c.h));
}

inline int64_t incircle(Point a, Point b, Point c, Point p) {
  return incircle(angle_at(c, a, b), angle_at(p, a, b));
}

// The same of points that p sees at -127 .. 128 in both coordinates: all lie in a square of side
// 255, so 32 bits hold the determinant, and read it right modulo 2^32.
constexpr uint32_t kNear = 255;
static_assert(uint64_t{kNear} * kNear * kNear * kNear / 2 <= INT32_MAX, "a near determinant fits");

inline bool are_near(Offset a, Offset b, Offset c) {
  const auto above = [](FastInt v) { return static_cast<uint32_t>(v + 127); };
  const uint32_t bits = above(a.x) | above(a.y) | above(b.x) | above(b.y) | above(c.x) | above(c.y);
  return bits <= kNear;
}

inline int32_t near_dot(Offset a, Offset b) {
  return static_cast<int32_t>(a.x) * static_cast<int32_t>(b.x) +
         static_cast<int32_t>(a.y) * static_cast<int32_t>(b.y);
}

inline int32_t near_cross(Offset a, Offset b) {
  return static_cast<int32_t>(a.x) * static_cast<int32_t>(b.y) -
         static_cast<int32_t>(a.y) * static_cast<int32_t>(b.x);
}

// The product of two signed numbers modulo 2^32.
inline uint32_t wrapping_product32(int32_t a, int32_t b) {
  return static_cast<uint32_t>(a) * static_cast<uint32_t>(b);
}

inline int32_t near_incircle(Offset a, Offset b, Offset c) {
  const Offset to_a = a - c, to_b = b - c;
  return static_cast<int32_t>(wrapping_product32(near_dot(to_a, to_b), near_cross(a, b)) -
                              wrapping_product32(near_dot(a, b), near_cross(to_a, to_b)));
}

template <class Corner>
void turn(Corner& a, Corner& b, Corner& c) {
  const Corner first = a;
  a = b;
  b = c;
  c = first;
}

// Turns the triangle until its largest corner comes last: twice at most, as no two are the same.
template <class Corner, class Less>
void turn_largest_last(Corner& a, Corner& b, Corner& c, const Less& less) {
  while (less(c, a) || less(c, b)) turn(a, b, c);
}

// Whether p conflicts with a counter-clockwise triangle on whose circle it lies, of which c is the
// largest corner and `angle` that under which p sees the other two. Ties are broken by lifting each
// point by an infinitesimal that grows with its lexicographic rank (Devillers and Teillaud,
// "Perturbations for Delaunay and weighted Delaunay 3D triangulations"): there is a conflict if p
// is smaller than c and, in its place, turns counter-clockwise. A corner never does: p conflicts
// with no triangle of its own.
inline bool conflicts_on_circle(Angle angle, Point c, Point p) {
  return p < c && angle.h > 0;
}

// Whether p conflicts with the counter-clockwise finite triangle (a, b, c). A corner does not.
inline bool conflicts_with_triangle(Point a, Point b, Point c, Point p) {
  const int64_t d = incircle(a, b, c, p);
  if (d != 0) return d > 0;
  turn_largest_last(a, b, c, [](Point l, Point r) { return l < r; });
  return conflicts_on_circle(angle_at(p, a, b), c, p);
}

// Whether p, which sees u and w under `angle`, conflicts with the ghost triangle (u, w, infinity),
// whose outside lies to the left of u -> w: strictly outside, or on the line strictly between u and
// w.
inline bool conflicts_with_ghost(Angle angle) {
  return angle.h > 0 || (angle.h == 0 && angle.q < 0);
}

inline bool conflicts_with_ghost(Point u, Point w, Point p) {
  return conflicts_with_ghost(angle_at(p, u, w));
}

}  // namespace microtin


#ifndef MICROTIN_INDEX_BITS
#define MICROTIN_INDEX_BITS 32
#endif

namespace microtin {

#if MICROTIN_INDEX_BITS == 16
typedef uint16_t Index;
#elif MICROTIN_INDEX_BITS == 32
typedef uint32_t Index;
#else
#error "MICROTIN_INDEX_BITS must be 16 or 32"
#endif

// The vertex at infinity. No vertex has this number: the largest half-edge number stays below it.
constexpr Index kInfinity = static_cast<Index>(~static_cast<Index>(0));

// Whether one of three vertices is at infinity: the highest bit tells, since there are six times as
// many half-edges as vertices.
inline bool is_ghost(Index a, Index b, Index c) {
  return ((static_cast<uint32_t>(a) | b | c) >> (MICROTIN_INDEX_BITS - 1)) != 0;
}

// Views of arrays that somebody else owns.
struct Mesh {
  Point* place;     // vertices
  int16_t* z;       // vertices
  Index* origin;    // 3 * triangles
  Index* twin;      // 3 * triangles
  Index vertices;   // n
  Index triangles;  // 2n - 2, ghosts included
};

// floor(h / 3) by one multiplication; exact for every Index value (no divide on the smallest
// cores).
inline Index triangle_of(Index h) {
#if MICROTIN_INDEX_BITS == 16
  return static_cast<Index>((static_cast<uint32_t>(h) * 43691u) >> 17);
#else
  return static_cast<Index>((static_cast<uint64_t>(h) * 2863311531u) >> 33);
#endif
}

inline Index first_edge(Index triangle) {
  return static_cast<Index>(3u * triangle);
}

// Whether h is a multiple of 3: of all numbers these times the inverse of 3 are the smallest.
inline bool is_first_edge(Index h) {
  constexpr uint32_t kThird = 0xFFFFFFFFu / 3, kInverse = 2 * kThird + 1;
  return static_cast<uint32_t>(static_cast<uint64_t>(h) * kInverse) <= kThird;  // modulo 2^32
}

MICROTIN_ONE_COPY inline Index next_in_triangle(Index h) {
  const Index next = static_cast<Index>(h + 1u);
  return is_first_edge(next) ? static_cast<Index>(h - 2u) : next;
}

inline Index previous_in_triangle(Index h) {
  return static_cast<Index>(is_first_edge(h) ? h + 2u : h - 1u);
}

inline Point point_of(const Mesh& mesh, Index v) {
  return mesh.place[v];
}

MICROTIN_ONE_COPY inline bool is_ghost(const Mesh& mesh, Index triangle) {
  const Index f = first_edge(triangle);
  return is_ghost(mesh.origin[f], mesh.origin[f + 1u], mesh.origin[f + 2u]);
}

// Makes a and b each other's twins.
inline void pair(Mesh& mesh, size_t a, size_t b) {
  mesh.twin[a] = static_cast<Index>(b);
  mesh.twin[b] = static_cast<Index>(a);
}

// in_conflict for the rare cases: a ghost, or p on the circle.
MICROTIN_OUT_OF_LINE MICROTIN_IN_PLACE inline bool in_rare_conflict(const Mesh& mesh, Index a,
                                                                    Index b, Index c, Point p) {
  turn_largest_last(a, b, c, [&mesh](Index l, Index r) {  // infinity is larger than all
    return l != kInfinity && (r == kInfinity || point_of(mesh, l) < point_of(mesh, r));
  });
  const Angle angle = angle_at(p, point_of(mesh, a), point_of(mesh, b));
  return c == kInfinity ? conflicts_with_ghost(angle)
                        : conflicts_on_circle(angle, point_of(mesh, c), p);
}

#if defined(MICROTIN_NARROW_MACHINE) && !(defined(__AVR__) && defined(__OPTIMIZE_SIZE__))

typedef int32_t Sign;  // a number that has the right one

MICROTIN_OUT_OF_LINE inline Sign sign_of_incircle(Offset a, Offset b, Offset c) {
  const int64_t d = incircle(angle_between(a - c, b - c), angle_between(a, b));
  return d > 0 ? 1 : d < 0 ? -1 : 0;
}

inline Sign sign_of_conflict(const Mesh& mesh, Index a, Index b, Index c, Point p) {
  const Offset to_a = point_of(mesh, a) - p, to_b = point_of(mesh, b) - p;
  const Offset to_c = point_of(mesh, c) - p;
  return are_near(to_a, to_b, to_c) ? near_incircle(to_a, to_b, to_c)
                                    : sign_of_incircle(to_a, to_b, to_c);
}

#else

typedef int64_t Sign;

inline Sign sign_of_conflict(const Mesh& mesh, Index a, Index b, Index c, Point p) {
  const Offset from = point_of(mesh, a) - p, to = point_of(mesh, b) - p;
  const Angle near = angle_between(from, to);
  const Offset far = point_of(mesh, c) - p;
  return incircle(angle_between(from - far, to - far), near);
}

#endif

// Whether p conflicts with the counter-clockwise triangle (a, b, c). A corner of it does not.
inline bool in_conflict(const Mesh& mesh, Index a, Index b, Index c, Point p) {
  const Sign d = is_ghost(a, b, c) ? 0 : sign_of_conflict(mesh, a, b, c, p);
  return d != 0 ? d > 0 : in_rare_conflict(mesh, a, b, c, p);
}

// The mesh of one counter-clockwise triangle (0, 1, 2) and its three ghosts (j, i, infinity).
inline void start_mesh(Mesh& mesh) {
  mesh.vertices = 3;
  mesh.triangles = 4;
  Index previous = 9;  // the ghost whose edge from infinity is met at vertex i
  for (Index i = 0; i < 3; ++i) {
    const Index ghost = static_cast<Index>(3u + 3u * i);
    mesh.origin[i] = mesh.origin[ghost + 1u] = mesh.origin[previous] = i;
    mesh.origin[ghost + 2u] = kInfinity;
    pair(mesh, i, ghost);
    pair(mesh, ghost + 1u, previous + 2u);
    previous = ghost;
  }
}

}  // namespace microtin

// --- shared/probability.hpp
// Adaptive binary probabilities. A coder supplies bit(probability, value) and uniform(count,
// value): the writing coder writes the value it is given, the reading coder ignores it and returns
// the stream's.


namespace microtin {

// Probabilities given to a coder have 15 bits and stay this far from 0 and 1, so every decision
// costs at least -log2(1 - 64 / 32768) = 0.0028 bits and at most 9: decoding is bounded by the
// payload.
constexpr uint32_t kProbabilityOne = 32768;
constexpr int32_t kProbabilityMargin = 64;

// The probability of a one: the mean of two running means of what was seen, both with 15 bits. They
// never leave the margins, to which each step goes only part of the way.
struct AdaptiveBit {
  uint16_t fast;  // each bit weighs 1/32
  uint16_t slow;  // ... 1/256
};

// With 16 bits.
inline int32_t probability_of(const AdaptiveBit& bit) {
  return static_cast<int32_t>(bit.fast) + bit.slow;
}

// `start` < 256: (start + 1/2) / 256.
inline AdaptiveBit adaptive_bit(uint32_t start) {
  const uint16_t probability = static_cast<uint16_t>(start * 128u + 64u);
  return AdaptiveBit{probability, probability};
}

inline void learn(AdaptiveBit& bit, bool one) {
  const int32_t towards =
      one ? static_cast<int32_t>(kProbabilityOne) - kProbabilityMargin : kProbabilityMargin;
  bit.fast = static_cast<uint16_t>(bit.fast + ((towards - bit.fast) >> 5));
  bit.slow = static_cast<uint16_t>(bit.slow + ((towards - bit.slow) >> 8));
}

template <class Coder>
bool code_bit(Coder& coder, AdaptiveBit& bit, bool value) {
  value = coder.bit(static_cast<uint32_t>(probability_of(bit)) >> 1, value);
  learn(bit, value);
  return value;
}

// Codes with a probability between those of two bits, `share` / 256 of the way to the second; the
// nearer one learns.
template <class Coder>
bool code_between(Coder& coder, AdaptiveBit* bits, uint32_t share, bool value) {
  const int32_t from = probability_of(bits[0]), to = probability_of(bits[1]);
  const int32_t between = from + ((to - from) * static_cast<int32_t>(share) >> 8);
  value = coder.bit(static_cast<uint32_t>(between) >> 1, value);
  learn(bits[share >> 7], value);
  return value;
}

// A probability learned as a function of an estimate on a logarithmic scale: entries at equal
// distances, interpolated between the two nearest, of which the nearer one learns.
template <uint32_t kEntries>
struct Curve {
  AdaptiveBit entry[kEntries];
};

// `position` counts entries with 8 fractional bits; beyond the ends the end entries serve.
template <class Coder, uint32_t kEntries>
bool code_on_curve(Coder& coder, Curve<kEntries>& curve, int32_t position, bool value) {
  const uint32_t last = (kEntries - 1) * 256u - 1u;
  uint32_t at = position < 0 ? 0 : static_cast<uint32_t>(position);
  if (at > last) at = last;
  const uint32_t i = at >> 8;
  return code_between(coder, curve.entry + i, at & 255u, value);
}

// A learned correction of an estimated probability: entries at equal distances from 0 to 1.
struct Calibration {
  AdaptiveBit entry[9];
};

// `estimate` has 15 fractional bits and is below 1.
template <class Coder>
bool code_calibrated(Coder& coder, Calibration& calibration, uint32_t estimate, bool value) {
  return code_between(coder, calibration.entry + (estimate >> 12), estimate >> 4 & 255u, value);
}

}  // namespace microtin


namespace microtin {

// The next bytes of the stream. They are copied here, so that what an item needs is in one piece
// however the stream arrives.
struct ByteWindow {
  uint8_t* next;
  size_t left;    // from `next` on
  uint32_t crc;   // of all that was taken since the last check, up to the last settle()
  uint64_t used;  // bytes of the stream up to the last settle()
  uint8_t bytes[2 * kStepBytes];

  uint8_t take() {
    --left;
    return *next++;
  }

  void skip(uint32_t count) {
    next += count;
    left -= static_cast<size_t>(count);
  }

  // Bytes of the stream so far.
  uint64_t taken() const { return used + static_cast<size_t>(next - bytes); }

  // Counts and checks what was taken, and moves what is left to the front.
  MICROTIN_OUT_OF_LINE void settle() {
    crc = crc32(crc, bytes, static_cast<size_t>(next - bytes));
    used = taken();
    for (size_t i = 0; i < left; ++i) bytes[i] = next[i];
    next = bytes;
  }

  // Adds from `size` bytes what there is room for: so many.
  size_t fill(const uint8_t* from, size_t size) {
    settle();
    size_t added = 0;
    while (added < size && left < sizeof bytes) bytes[left++] = from[added++];
    return added;
  }
};

constexpr uint32_t kRangeLeast = static_cast<uint32_t>(1) << 24;

static_assert((kRangeLeast >> 15) * kProbabilityMargin >= kProbabilityOne,
              "no part of a bit is narrow");
static_assert(kRangeLeast >> 16 >= 1 << 8, "after any number two bytes are enough");

// Interval coding after Schindler and LZMA: `code` is the stream's value relative to the interval's
// low end, always below `range`; `range` stays at or above 2^24 between calls.
struct RangeDecoder {
  uint32_t range;
  uint32_t code;
  uint32_t payload_left;  // bytes not read yet before the check: of notes, or a section's payload
  uint32_t virtual_left;  // zero bytes that may still be read behind it
  bool overrun;           // more was asked for than there is, or no encoder can have written this
  ByteWindow window;      // holds at least min(payload_left, kStepBytes) bytes when a step starts

  uint32_t next_byte() {
    if (payload_left != 0) {
      --payload_left;
      return window.take();
    }
    if (virtual_left == 0) {
      overrun = true;
    } else {
      --virtual_left;
    }
    return 0;
  }

  // At a section's payload, of which payload_left tells the bytes.
  void begin() {
    virtual_left = kVirtualBytes;
    overrun = false;
    range = 0xFFFFFFFFu;
    code = 0;
    for (int i = 0; i < 4; ++i) code = code << 8 | next_byte();
    if (code == range) overrun = true;  // no encoder's interval ends there
  }

  void normalise() {
    if (range < kRangeLeast) refill();
  }

  MICROTIN_OUT_OF_LINE void refill() {
    do {  // at most twice: range >= 2^8 here
      range <<= 8;
      code = code << 8 | next_byte();
    } while (range < kRangeLeast);
  }

  // A bit that is one with `probability` / 2^15. Both parts of the interval are at least
  // 2^9 * kProbabilityMargin wide.
  bool bit(uint32_t probability, bool) {
    const uint32_t bound = (range >> 15) * probability;
    const bool one = code < bound;
    if (one) {
      range = bound;
    } else {
      code -= bound;
      range -= bound;
    }
    normalise();
    return one;
  }

  // A number below `count`, all equally likely; 1 <= count <= 2^16.
  uint32_t uniform(uint32_t count, uint32_t) {
    if (count == 1) return 0;
    range /= count;
    uint32_t value = code / range;
    if (value >= count) {  // in the part of the interval lost to rounding: no encoder goes there
      overrun = true;
      value = 0;
      code = 0;
    }
    code -= value * range;
    normalise();
    return value;
  }

  Vertex next() const { return Vertex{0, 0, 0}; }
  bool last_phase() const { return false; }
  uint32_t batch() const { return 0; }
  bool conflicts(const Mesh&, Index) const { return false; }
  bool is_void(const Mesh&, Index) const { return false; }
};

}  // namespace microtin

// --- shared/reconstruction.hpp
// The reconstruction, once for both sides: a breadth-first walk that rebuilds the Delaunay
// triangulation point by point (Sohler, "Fast Reconstruction of Delaunay Triangulations", CCCG
// 1999).
//
// It is a template over the coder. With a reading coder it decodes; with a writing coder, which
// knows the next point, it encodes. A coder supplies, beside bit() and uniform() (probability.hpp):
//   next()        the vertex to be inserted next
//   last_phase(), batch()   how many vertices the phase adds
//   conflicts(mesh, h)      whether that vertex is in conflict with the triangle of half-edge h
//   is_void(mesh, t)        whether triangle t is void
// A reading coder may return anything from these: what the stream says replaces it.

// --- shared/height_coding.hpp
// Coding of a new vertex's height as the difference from what its neighbours predict.


namespace microtin {

// Magnitudes: the number of bits, then the bit behind the leading one, then uniform bits.
constexpr uint32_t kMagnitudeBits = 17;  // a difference of heights is below 2^17
constexpr uint32_t kExponents = 7;       // numbers of bits told apart: three around the typical one
constexpr uint32_t kMantissas = 10;      // numbers of bits told apart; larger ones share the last

struct ExponentModel {
  AdaptiveBit longer[kExponents];  // than typical - 3 .. typical + 3 bits
};

struct MantissaModel {
  AdaptiveBit second[kMantissas];
};

// Codes whether a magnitude has more than `bits` bits.
template <class Coder>
bool code_longer(Coder& coder, ExponentModel& model, uint32_t typical, uint32_t bits, bool longer) {
  uint32_t i = bits + kExponents / 2;
  i = i < typical ? 0 : i - typical;
  return code_bit(coder, model.longer[i < kExponents ? i : kExponents - 1], longer);
}

// Codes a number of bits up to kMagnitudeBits: upwards or downwards from the typical one, which is
// smaller.
template <class Coder>
uint32_t code_exponent(Coder& coder, ExponentModel& model, uint32_t typical, uint32_t value) {
  uint32_t bits = typical;
  const bool upwards = code_longer(coder, model, typical, bits, bits < value);
  do {
    bits = upwards ? bits + 1 : bits - 1;  // below 0 is above all
  } while (bits < kMagnitudeBits &&
           code_longer(coder, model, typical, bits, bits < value) == upwards);
  return upwards ? bits : bits + 1;
}

// Codes a magnitude below 2^kMagnitudeBits.
template <class Coder>
uint32_t code_magnitude(Coder& coder, ExponentModel& exponent, MantissaModel& mantissa,
                        uint32_t typical_bits, uint32_t value) {
  const uint32_t bits =
      code_exponent(coder, exponent, typical_bits, value == 0 ? 0 : highest_bit(value) + 1);
  if (bits <= 1) return bits;
  AdaptiveBit& second = mantissa.second[bits < kMantissas ? bits : kMantissas - 1];
  const uint32_t leading = 2u + code_bit(coder, second, (value >> (bits - 2) & 1u) != 0);
  const uint32_t rest = static_cast<uint32_t>(1) << (bits - 2);
  return leading * rest + coder.uniform(rest, value & (rest - 1u));
}

constexpr uint32_t kScales = 12;      // contexts: how large a difference is to be expected
constexpr uint32_t kTendencies = 10;  // contexts: of which sign, from below the prediction to above
constexpr uint32_t kSignSizes = 3;    // differences of 1, 2, 3 or more

struct HeightModel {
  ExponentModel exponent[kScales];
  MantissaModel mantissa;
  AdaptiveBit negative[kTendencies][kSignSizes];
};

// What is kept of a vertex's difference from its prediction.
typedef int8_t Residual;

inline Residual residual_of(int32_t difference) {
  return static_cast<Residual>(difference < -127 ? -127 : difference > 127 ? 127 : difference);
}

// The ring of a new vertex has at most 32 neighbours; each weighs 1 / distance^2, rounded to a
// power of two: 2^5 if it is as far as the first, at most 2^9, nothing below 1.
struct RingSums {
  uint32_t weights;    // 2^5 .. 31 * 2^9 + 2^5
  int32_t heights;     // weighted, less that of the first: within +-2^30
  uint32_t spread;     // of their magnitudes
  int32_t residuals;   // weighted: within +-2^21
  uint32_t roughness;  // of their magnitudes
};

inline uint32_t magnitude_of(int32_t v) {
  return static_cast<uint32_t>(v < 0 ? -v : v);
}

// The position of the highest bit of half the squared distance, which is below 2^32; 0 for 1.
inline uint32_t distance_bits(Point a, Point b) {
  const uint32_t dx = static_cast<uint32_t>(a.x) - b.x, dy = static_cast<uint32_t>(a.y) - b.y;
  return highest_bit(((dx * dx >> 1) + (dy * dy >> 1)) | 1u);  // squares are right modulo 2^32
}

inline RingSums sum_ring(const Mesh& mesh, const Residual* residual, const Index* ring,
                         uint32_t size, Point place, uint32_t first) {
  RingSums sums = {0, 0, 0, 0, 0};
  const int32_t base = mesh.z[ring[0]];
  for (uint32_t i = 0; i < size; ++i) {
    const Index v = ring[i];
    if (v == kInfinity) continue;
    const uint32_t bits = distance_bits(point_of(mesh, v), place) + 4u;
    const uint32_t farther = bits < first ? 0 : bits - first;
    if (farther > 9) continue;
    const int32_t weight = 512 >> farther;
    const int32_t height = weight * (mesh.z[v] - base);
    const int32_t difference = weight * residual[v];
    sums.weights += static_cast<uint32_t>(weight);
    sums.heights += height;
    sums.spread += magnitude_of(height);
    sums.residuals += difference;
    sums.roughness += magnitude_of(difference);
  }
  return sums;
}

struct HeightPrediction {
  int32_t height;
  uint32_t scale;     // < kScales: of the difference to be expected
  uint32_t tendency;  // < kTendencies: towards which sign
};

// The larger the differences around here, the spread of the ring and the distance, the larger the
// difference to be expected.
inline uint32_t expected_scale(uint32_t weights, uint32_t roughness, uint32_t spread,
                               uint32_t distance) {
  // Of no smaller numbers are logarithms smaller by more than 1/128: the sum is positive.
  const Log2 sum = log2_of(4 * roughness + weights) + 2 * log2_of(4 * spread + weights) -
                   3 * log2_of(weights) + 32 * static_cast<Log2>(distance) + 320;
  const uint32_t scale = static_cast<uint32_t>(sum) / 768u;
  return scale < kScales ? scale : kScales - 1;
}

// 0 .. 4: neighbours above their own predictions make it likely that the new vertex is, too.
inline uint32_t expected_sign(int32_t residuals, int32_t roughness) {
  const int32_t sum = 5 * residuals;
  return static_cast<uint32_t>((sum >= -3 * roughness) + (sum >= -roughness) + (sum > roughness) +
                               (sum > 3 * roughness));
}

// Predicts from the ring's vertex numbers, of which the first is finite and some may be kInfinity.
inline HeightPrediction predict_height(const Mesh& mesh, const Residual* residual,
                                       const Index* ring, uint32_t size, Point place) {
  const uint32_t first = distance_bits(point_of(mesh, ring[0]), place);
  const RingSums sums = sum_ring(mesh, residual, ring, size, place, first);
  // Rounded to nearest, halves up. 2^16 is added to stay positive: all is below 2^32.
  const uint32_t divisor = 2u * sums.weights;  // not 0
  const uint32_t dividend =
      static_cast<uint32_t>(2 * sums.heights) + sums.weights + (divisor << 16);
  const uint32_t mean = dividend / divisor;
  const bool rounded_down = dividend - mean * divisor > sums.weights;
  HeightPrediction prediction;
  prediction.height = mesh.z[ring[0]] + static_cast<int32_t>(mean) - 65536;
  prediction.scale = expected_scale(sums.weights, sums.roughness, sums.spread,
                                    14u + first - highest_bit(sums.weights));
  prediction.tendency =
      2u * expected_sign(sums.residuals, static_cast<int32_t>(sums.roughness)) + rounded_down;
  return prediction;
}

// Codes a height given its prediction. False if the stream's height does not fit 16 bits.
template <class Coder>
bool code_height(Coder& coder, HeightModel& model, const HeightPrediction& prediction, int16_t* z) {
  const int32_t difference = static_cast<int32_t>(*z) - prediction.height;
  const uint32_t magnitude =
      code_magnitude(coder, model.exponent[prediction.scale], model.mantissa, prediction.scale / 2,
                     static_cast<uint32_t>(difference < 0 ? -difference : difference));
  int32_t height = prediction.height;
  if (magnitude != 0) {
    AdaptiveBit* const negative = model.negative[prediction.tendency];
    const uint32_t size = (magnitude < kSignSizes ? magnitude : kSignSizes) - 1u;
    const int32_t step = static_cast<int32_t>(magnitude);
    height += code_bit(coder, negative[size], difference < 0) ? -step : step;
  }
  if (height < -32768 || height > 32767) return false;
  *z = static_cast<int16_t>(height);
  return true;
}

}  // namespace microtin

// --- shared/hull_coding.hpp
// Coding of new vertices outside the hull or on its boundary.


namespace microtin {

// The hull edge from a to c; the outside is to its right.
struct HullEdge {
  Point a;
  Offset along;    // from a to c
  int32_t length;  // in lattice steps if the edge is part of the lattice's border, else 0
};

inline bool at_border(uint16_t a, uint16_t c, uint16_t most) {
  return a == c && (a == 0 || a == most);
}

inline HullEdge hull_edge(const Contract& contract, Point a, Point c) {
  HullEdge edge = {a, c - a, 0};
  if (at_border(a.x, c.x, contract.x_max) || at_border(a.y, c.y, contract.y_max)) {
    edge.length = static_cast<int32_t>(absolute(edge.along.x + edge.along.y));
  }
  return edge;
}

// A coordinate that is likely to be the smallest or the largest.
template <class Coder>
uint16_t code_outer_coordinate(Coder& coder, uint32_t largest, uint32_t value) {
  if (coder.bit(kProbabilityOne / 4 * 3, value == 0 || value == largest)) {
    const bool high = coder.bit(kProbabilityOne / 2, value == largest);
    return static_cast<uint16_t>(high ? largest : 0);
  }
  return static_cast<uint16_t>(coder.uniform(largest + 1u, value));
}

// A point on the edge, if that is at the border, or anywhere. `density` is the logarithm of
// vertices per unit area. Gaps that lead too far give a, which is not beyond the edge.
template <class Coder>
Point code_hull_place(Coder& coder, ExponentModel& gap, MantissaModel& mantissa,
                      const Contract& contract, const HullEdge& edge, Log2 density) {
  const Vertex next = coder.next();
  Point place = {next.x, next.y};
  if (edge.length == 0) {
    place.x = code_outer_coordinate(coder, contract.x_max, place.x);
    place.y = code_outer_coordinate(coder, contract.y_max, place.y);
    return place;
  }
  const Offset past = place - edge.a;
  const uint32_t spacing =  // at most 16
      density < 0 ? static_cast<uint32_t>(-density) / (2 * kLog2One) : 0;
  const int32_t steps = 1 + static_cast<int32_t>(code_magnitude(
                                coder, gap, mantissa, spacing,
                                static_cast<uint32_t>(absolute(past.x + past.y)) - 1u));
  const int32_t length = edge.length, held = steps < length ? steps : 0;
  return Point{static_cast<uint16_t>(edge.a.x + edge.along.x / length * held),
               static_cast<uint16_t>(edge.a.y + edge.along.y / length * held)};
}

}  // namespace microtin

// --- shared/insertion.hpp
// Insertion of one point into a Delaunay mesh: grow the cavity of conflicting triangles, then fan
// it from the new vertex.

// --- shared/sight.hpp
// What one point sees of the mesh: tests of it against triangles that share corners, in a row.

// --- shared/pairs.hpp
// Both coordinates of a point in one word, where the machine multiplies two pairs of 16-bit numbers
// at once (MICROTIN_PAIRS): in-circle tests of points near one another.


#if defined(__SSE2__) && defined(__x86_64__) && !defined(__OPTIMIZE_SIZE__)
#define MICROTIN_PAIRS
#include <emmintrin.h>
#elif defined(__ARM_FEATURE_DSP) && defined(__ARM_FEATURE_SIMD32) && !defined(__OPTIMIZE_SIZE__)
#define MICROTIN_PAIRS
#include <arm_acle.h>
#endif

#if defined(MICROTIN_PAIRS)

namespace microtin {

// A window is a square of 2^15 x 2^15 places. Of a point in it, both coordinates less those of its
// least corner are below 2^15; of any other point one of them, modulo 2^16, is not, as the corner
// is within 2^15 of both ends of the lattice.
constexpr uint32_t kWindow = 0x8000;
constexpr uint32_t kOutside = 0x80008000u;  // the bits that tell
static_assert(kLatticeMax - kWindow < kWindow, "offsets below -2^15 are none of a window's corner");

inline uint32_t packed(uint32_t x, uint32_t y) {
  return x | y << 16;
}

// Differences of points in a window are within +-(2^15 - 1), so dot and cross products are below
// 2^31, the products of two of these below 2^62, and their difference is below 2^63.
static_assert(2 * int64_t{kWindow - 1} * (kWindow - 1) <= INT32_MAX, "a dot product fits");

#if defined(__SSE2__)

// In the lowest 32-bit lane, x in its lower half; what the others hold does not matter.
typedef __m128i Pair;

inline Pair pair_of(uint32_t bits) {
  return _mm_cvtsi32_si128(static_cast<int32_t>(bits));
}

inline Pair pair_of(Point p) {
  return pair_of(packed(p.x, p.y));
}

inline Pair difference(Pair a, Pair b) {
  return _mm_sub_epi16(a, b);
}

inline Pair either(Pair a, Pair b) {
  return _mm_or_si128(a, b);
}

inline bool is_outside(Pair a) {
  return (static_cast<uint32_t>(_mm_cvtsi128_si32(a)) & kOutside) != 0;
}

// As incircle(Point, Point, Point, Point), of points in one window.
inline int64_t incircle(Pair a, Pair b, Pair c, Pair p) {
  // What c sees in the first lane, what p sees in the second.
  const __m128i eye = _mm_unpacklo_epi32(c, p);
  const __m128i to_a = _mm_sub_epi16(_mm_shuffle_epi32(a, 0), eye);
  const __m128i to_b = _mm_sub_epi16(_mm_shuffle_epi32(b, 0), eye);
  const __m128i turned =  // (y, -x)
      _mm_mullo_epi16(_mm_shufflelo_epi16(to_b, 0xB1), _mm_set1_epi32(-65535));
  const int64_t q = _mm_cvtsi128_si64(_mm_madd_epi16(to_a, to_b));
  const int64_t h = _mm_cvtsi128_si64(_mm_madd_epi16(to_a, turned));
  return static_cast<int32_t>(q) * (h >> 32) - (q >> 32) * static_cast<int32_t>(h);
}

// Differences below 0 become 0.
inline Pair excess(Pair a, Pair b) {
  return _mm_subs_epu16(a, b);
}

#else

typedef uint32_t Pair;  // x in the lower half

inline Pair pair_of(uint32_t bits) {
  return bits;
}

inline Pair pair_of(Point p) {
  return packed(p.x, p.y);
}

inline Pair difference(Pair a, Pair b) {
  return static_cast<Pair>(__ssub16(static_cast<int16x2_t>(a), static_cast<int16x2_t>(b)));
}

inline Pair either(Pair a, Pair b) {
  return a | b;
}

inline bool is_outside(Pair a) {
  return (a & kOutside) != 0;
}

// As incircle(Point, Point, Point, Point), of points in one window.
inline int64_t incircle(Pair a, Pair b, Pair c, Pair p) {
  const int16x2_t from_c = static_cast<int16x2_t>(c), from_p = static_cast<int16x2_t>(p);
  const int16x2_t ca = __ssub16(static_cast<int16x2_t>(a), from_c);
  const int16x2_t cb = __ssub16(static_cast<int16x2_t>(b), from_c);
  const int16x2_t pa = __ssub16(static_cast<int16x2_t>(a), from_p);
  const int16x2_t pb = __ssub16(static_cast<int16x2_t>(b), from_p);
  return static_cast<int64_t>(__smuad(ca, cb)) * __smusdx(pa, pb) -
         static_cast<int64_t>(__smuad(pa, pb)) * __smusdx(ca, cb);
}

inline Pair excess(Pair a, Pair b) {
  return static_cast<Pair>(__uqsub16(static_cast<uint16x2_t>(a), static_cast<uint16x2_t>(b)));
}

#endif

// The least corner of a window around p, kept within 0 .. 2^15.
inline Pair window_around(Pair p) {
  const Pair begin = excess(p, pair_of(0x40004000u));
  return difference(begin, excess(begin, pair_of(0x80008000u)));
}

}  // namespace microtin

#endif


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

  Seen see(Index v) {
    const Pair place =
        v == kInfinity ? pair_of(kOutside) : difference(pair_of(point_of(mesh_, v)), window_);
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


namespace microtin {

// Scratch for one insertion; its arrays belong to the caller. A cavity of m triangles is a polygon
// of m + 2 edges.
struct Cavity {
  Index* triangles;    // limit + 2 entries: the slots to be reused
  Index* edge_origin;  // limit + 2 entries: boundary, counter-clockwise
  Index* edge_twin;    // limit + 2 entries: the half-edges across it
  Index limit;         // most triangles that fit
  Index size;          // triangles found
};

// Collects the triangles in conflict with p: that of `start` and those connected to it. Where
// that across `start` is none of them, its edge comes first on the boundary. `forbids(v)` is asked
// for the far corner v of each triangle before it joins. False if it says yes, or if the cavity
// outgrows its limit; empty if the triangle of `start` and that across are not in conflict.
//
// The boundary is walked once. What is behind lies at the front of edge_twin, what is ahead of the
// edge in hand at its end: both sides of `start` are met like all others. The cavity's dual graph
// is a tree (its union is star-shaped from p and no vertex lies inside), so no triangle is met
// twice; each turn of the loop uses up one boundary edge of at most limit + 2.
template <class Forbids>
bool grow_cavity(const Mesh& mesh, Index start, Point p, Cavity& cavity, const Forbids& forbids) {
  Index* const end = cavity.edge_twin + cavity.limit + 2;
  Index* ahead = end;
  *--ahead = start;
  Index across = mesh.twin[start];  // from b to a
  Sight sight(mesh, p);
  Seen a = sight.see(mesh.origin[start]), b = sight.see(mesh.origin[across]);
  uint32_t edges = 0;
  cavity.size = 0;
  for (;;) {
    const Index previous = previous_in_triangle(across);
    const Seen c = sight.see(mesh.origin[previous]);
    if (sight.conflicts(b, a, c)) {
      if (cavity.size == cavity.limit || forbids(c.vertex)) return false;
      cavity.triangles[cavity.size++] = triangle_of(across);
      *--ahead = mesh.twin[previous];
      across = mesh.twin[next_in_triangle(across)];
      b = c;
      continue;
    }
    cavity.edge_origin[edges] = a.vertex;
    cavity.edge_twin[edges++] = across;
    if (ahead == end) return true;
    across = *ahead++;
    a = b;
    b = sight.see(mesh.origin[across]);
  }
}

// Replaces the cavity by a fan around the new vertex v: one triangle (edge origin, next origin, v)
// per boundary edge, in boundary order; the cavity's own slots first, then mesh.triangles and the
// one after it. Returns the first half-edge of the first fan triangle. The caller counts the
// vertex.
inline Index fan_cavity(Mesh& mesh, const Cavity& cavity, Index v) {
  Index* const fresh = cavity.triangles + cavity.size;
  fresh[0] = mesh.triangles++;
  fresh[1] = mesh.triangles++;
  size_t before = first_edge(fresh[1]);
  const uint32_t edges = cavity.size + 2u;
  for (uint32_t i = 0; i < edges; ++i) {
    const size_t h = first_edge(cavity.triangles[i]);
    mesh.origin[h] = mesh.origin[before + 1] = cavity.edge_origin[i];
    mesh.origin[h + 2] = v;
    pair(mesh, h, cavity.edge_twin[i]);
    pair(mesh, before + 1, h + 2);
    before = h;
  }
  return first_edge(cavity.triangles[0]);
}

}  // namespace microtin

// --- shared/place_coding.hpp
// Coding of the next point's place in the free region of the triangle it conflicts with.
//
// The box around the region is cut into 4 x 4 cells, the point's cell is coded, and the cell
// becomes the box, once or more; what remains is uniform.

// --- shared/place_odds.hpp
// What weighs the places in the free region of a triangle.
//
// A cell weighs the share of it that is free, times the chance that no other point came first: the
// walk inserts the point whose circle through the chord is the smallest, and with density points
// per unit area a circle that sweeps an area s over the chord is the first with probability
// exp(-density * s).

// --- shared/repulsion.hpp
// Vertices of a terrain keep apart: places close to a corner of the triangle are the rarer the
// closer they are. How close counts is learned.

// --- shared/cells.hpp
// A box of lattice points cut into 4 x 4 cells, and how far the cells are outside a circle.

// --- shared/free_region.hpp
// Where the next point can lie, given that it is in conflict with an uncertified triangle: inside
// the triangle's circle, outside the circles of the certified triangles behind its sides.
// Everything here is an estimate that selects contexts and odds, except enclosing_box, which must
// hold every legal point.


namespace microtin {

// The circles through both ends of a side form a pencil, ordered by the cotangent of the angle
// under which the side is seen from the arc to its left. 8 fractional bits, capped.
typedef int32_t Cotangent;
constexpr Cotangent kCotangentCap = 89 * 256;

static_assert(int64_t{kCotangentCap} * 65536 < INT32_MAX, "a quotient's dividend fits");
static_assert(65536 + int64_t{kCotangentCap} * kCotangentCap < INT32_MAX, "a squared one fits");

// q / h, off by less than 2 / 256; |q| < 2^34, 0 < h < 2^34.
inline Cotangent cotangent(int64_t q, int64_t h) {
  // h is brought below 2^16, but not below 2^15: then |q| * 256 <= 89 * 2^16 * 2^8 < 2^31.
  const uint32_t bits = highest_bit(static_cast<uint64_t>(h));
  const uint32_t shift = bits > 15 ? bits - 15 : 0;
  const int32_t divisor = static_cast<int32_t>(scaled(h, 1, shift));
  return kept_within(scaled(q, 1, shift), 89 * divisor) * 256 / divisor;
}

// The side from corner i to corner i + 1 of a triangle, and what is known behind it.
struct Side {
  bool certified;  // the triangle behind is final: its circle is empty
  bool ghost;      // ... and lies outside the hull: nothing at all is behind
  Offset apex;     // ... otherwise, the corner opposite to this side
  // The circles of the triangle itself and of the one behind; of a ghost's, one so large that its
  // segment is next to nothing.
  Cotangent own, behind;
};

constexpr int kChord = 2;  // the side the walk came from, from corner 2 (a) to corner 0 (v)

// All places are relative to corner 0.
struct FreeRegion {
  Point origin;
  Offset corner[4];  // v, c, a, counter-clockwise, never on a line; v
  Side side[3];
};

// Of the angle under which `from` sees the side from a to b, which is to its right.
inline Cotangent cotangent_at(const Offset& from, const Offset& a, const Offset& b) {
  const Offset to_a = a - from, to_b = b - from;
  return cotangent(dot(to_a, to_b), cross(to_a, to_b));
}

// Areas carry 8 fractional bits; the largest disc has 2^58.
typedef int64_t Area;

// Area of the disc on whose circle a chord of squared length `length2` < 2^33 is seen under k.
inline Area disc_area(int64_t length2, Cotangent k) {
  // pi / 4 = 201 / 256; 1 + k^2 <= 2^22 with 8 fractional bits.
  return scaled(length2, (65536 + k * k) >> 8, 8) * 201;
}

// Area, over length2, of the segment to the left of the chord: 17 fractional bits, below 2^30. Up
// to a half disc (k <= 0) it is about 2/3 / (k + 0.315 / (k + 0.734)), off by at most 1.25 %;
// beyond it is what the disc has left.
inline int32_t segment(Cotangent k) {
  const uint32_t size = static_cast<uint32_t>(k < 0 ? -k : k);
  const int32_t smaller = static_cast<int32_t>(89478480u / (16u * size + 330400u / (size + 188u)));
  if (k <= 0) return smaller;
  return static_cast<int32_t>(static_cast<int64_t>(65536 + k * k) * 3217 >> 11) - smaller;
}

// log2 of the free region's area in lattice units. Fills in the sides' cotangents.
inline Log2 free_area(FreeRegion& region) {
  Area lost = 0;
  for (int i = 0; i < 3; ++i) {
    Side& side = region.side[i];
    if (!side.certified) continue;
    const Offset& from = region.corner[i];
    const Offset& to = region.corner[i + 1];
    side.own = cotangent_at(region.corner[i == 0 ? 2 : i - 1], from, to);
    int32_t segments = segment(-side.own);
    if (side.ghost) {
      side.behind = (side.own < 0 ? side.own : 0) - 8 * 256;
    } else {
      side.behind = -cotangent_at(side.apex, to, from);
      segments += segment(side.behind);
    }
    lost += scaled(dot(to - from, to - from), segments, 9);
  }
  const Offset chord = region.corner[kChord];
  const Area disc = disc_area(dot(chord, chord), region.side[kChord].own);
  const Area left = disc - lost, least = (disc >> 8) + 1;
  return log2_of(static_cast<uint64_t>(left > least ? left : least)) - 8 * kLog2One;
}

// A circle by the power of places with respect to it, negative inside, in half lattice steps: at
// an offset (i, j) from some place it is value + i (x / 16 + i) + j (y / 16 + j).
struct Power {
  int64_t value;
  FastInt x;
  FastInt y;
};

// The circle through both ends of a chord, seen from `middle` (half steps from corner 0).
// Offsets are below 2^18: products 2^37, times a cotangent 2^52 >> 8; slopes below 2^29.
inline Power circle_over(Offset from, Offset to, Cotangent k, Offset middle) {
  const Offset a = {middle.x - 2 * from.x, middle.y - 2 * from.y};
  const Offset b = {middle.x - 2 * to.x, middle.y - 2 * to.y};
  const Offset chord = {a.x - b.x, a.y - b.y};
  Power power;
  power.value = dot(a, b) - scaled(cross(chord, a), k, 8);
  power.x = 16 * (a.x + b.x) + static_cast<FastInt>(static_cast<int64_t>(k) * chord.y >> 4);
  power.y = 16 * (a.y + b.y) - static_cast<FastInt>(static_cast<int64_t>(k) * chord.x >> 4);
  return power;
}

// A box of lattice points, both ends included.
struct Box {
  FastInt x0, y0, x1, y1;
};

// Half steps.
inline Offset middle_of(const Box& box) {
  return Offset{box.x0 + box.x1, box.y0 + box.y1};
}

// log2 of its longer side, rounded down.
inline uint32_t size_of(const Box& box) {
  return highest_bit(static_cast<uint32_t>((box.x1 - box.x0) | (box.y1 - box.y0) | 1));
}

inline void extend(Box& box, FastInt x, FastInt y) {
  if (x < box.x0) box.x0 = x;
  if (x > box.x1) box.x1 = x;
  if (y < box.y0) box.y0 = y;
  if (y > box.y1) box.y1 = y;
}

// Cuts the box off where it is beyond another.
inline void cut(Box& box, const Box& bounds) {
  if (box.x0 < bounds.x0) box.x0 = bounds.x0;
  if (box.y0 < bounds.y0) box.y0 = bounds.y0;
  if (box.x1 > bounds.x1) box.x1 = bounds.x1;
  if (box.y1 > bounds.y1) box.y1 = bounds.y1;
}

// Extends a box to those of a circle's extremes that are less than `slack` on the near side of an
// open side, or beyond it; all in sixteenths of a step. Products are below 2^18 * 2^28, twice.
inline void extend_beyond(Box& box, Offset from, Offset side, Offset centre, FastInt radius,
                          FastInt slack) {
  const int64_t near = cross(side, centre - Offset{16 * from.x, 16 * from.y}) -
                       static_cast<int64_t>(slack) * (absolute(side.x) + absolute(side.y));
  for (int i = 0; i < 2; ++i) {  // west and south, east and north; rounded inwards
    const FastInt reach = i == 0 ? -radius : radius, round = i == 0 ? 15 : 0;
    const Offset rounded = {centre.x + round, centre.y + round};
    if (near < static_cast<int64_t>(side.y) * reach) {
      extend(box, (rounded.x + reach) >> 4, rounded.y >> 4);
    }
    if (near + static_cast<int64_t>(side.x) * reach < 0) {
      extend(box, rounded.x >> 4, (rounded.y + reach) >> 4);
    }
  }
}

// Cuts off a box what the free region cannot hold: it holds the triangle itself and, beyond open
// sides, the circle's extremes. Circles whose cotangent over the chord is capped are not followed.
inline void enclose(const FreeRegion& region, Box& bounds) {
  const Cotangent k = region.side[kChord].own;
  if (absolute(k) == kCotangentCap) return;
  // Sixteenths of a step from v. The cotangent is off by less than 1/128, which moves the centre,
  // and changes the radius, by less than 1/256 of the chord. All below 2^28.
  const Offset c = region.corner[1], a = region.corner[2];
  const Offset centre = {a.x * 8 + static_cast<FastInt>(static_cast<int64_t>(k) * a.y >> 5),
                         a.y * 8 - static_cast<FastInt>(static_cast<int64_t>(k) * a.x >> 5)};
  const FastInt margin = (absolute(a.x) + absolute(a.y)) / 8 + 2;
  const int64_t square = scaled(dot(a, a), 65536 + k * k, 10);
  const FastInt radius = static_cast<FastInt>(sqrt_above(static_cast<uint64_t>(square))) + margin;
  // The computed extremes are beyond the true ones by less than this.
  const FastInt slack = 2 * margin + 5 + (radius >> 7);
  Box box = {a.x, a.y, a.x, a.y};
  extend(box, 0, 0);
  extend(box, c.x, c.y);
  for (int i = 0; i < 2; ++i) {
    const Offset from = region.corner[i], side = region.corner[i + 1] - from;
    if (!region.side[i].certified) extend_beyond(box, from, side, centre, radius, slack);
  }
  cut(bounds, box);
}

}  // namespace microtin


namespace microtin {

constexpr int kSlices = 4;  // per axis
constexpr int kCells = kSlices * kSlices;

// Something for each cell, columns one after the other. Loops over them are vectorised where no
// other loop is around them.
typedef int16_t Cells[kCells];

// Four slices of `count` <= 2^16 lattice lines: where each starts, and where the last one ends.
struct Slices {
  FastInt count;
  FastInt start[kSlices + 1];
  FastInt extent;           // of a slice, but at most a step too narrow; eighths of half steps
  uint32_t unit;            // middles are in half steps / 2^(unit - 2), below 24576
  int16_t middle[kSlices];  // from the middle of all
  int16_t square[kSlices];  // middle^2 / 2^16
};

inline void slice(Slices& slices, FastInt count) {
  slices.count = count;
  slices.extent = count > kSlices ? (count - 3) * 4 : 4;
  slices.unit = 16 - highest_bit(static_cast<uint32_t>(count));
  slices.start[0] = 0;
  for (int i = 0; i < kSlices; ++i) {
    slices.start[i + 1] = count * (i + 1) >> 2;
    const FastInt twice = slices.start[i] + slices.start[i + 1] - count;
    slices.middle[i] =
        static_cast<int16_t>((twice * (static_cast<FastInt>(1) << slices.unit)) >> 2);
  }
  for (int i = 0; i < kSlices; ++i) {
    slices.square[i] =
        static_cast<int16_t>(static_cast<int32_t>(slices.middle[i]) * slices.middle[i] >> 16);
  }
}

inline int slice_of(const Slices& slices, FastInt offset) {
  int i = 0;
  while (i < kSlices - 1 && offset >= slices.start[i + 1]) ++i;
  return i;
}

// How much a slice's width counts: nothing where all are about the same. At most 16.
inline uint32_t size_of(const Slices& slices, int i) {
  return slices.count > 64 ? 1u : static_cast<uint32_t>(slices.start[i + 1] - slices.start[i]);
}

struct Grid {
  Slices columns, rows;
};

// How powers become distances: 512 / ramp of them. Shifted, multiplied, shifted by 21.
struct Scale {
  uint32_t shift;
  int32_t reciprocal;  // 2^14 .. 2^26
};

// 28 <= ramp < 2^50.
inline Scale scale_by(int64_t ramp) {
  const uint32_t bits = highest_bit(static_cast<uint64_t>(ramp));
  const uint32_t shift = bits > 15 ? bits - 15 : 0;
  return Scale{shift, static_cast<int32_t>((static_cast<uint32_t>(1) << 30) /
                                           static_cast<uint32_t>(scaled(ramp, 1, shift)))};
}

// Distances in 64ths of a cell's extent across the circle, from the change of the power at the
// middle of the grid. Slopes are below 2^25 whole ones, extents below 2^18. Circles are drawn a
// little softly, since points of terrains are often on them.
inline Scale scale_for(const Power& power, const Grid& grid) {
  const int64_t x = absolute(power.x) >> 4, y = absolute(power.y) >> 4;
  const int64_t width = grid.columns.extent, height = grid.rows.extent;
  return scale_by(((x * width + y * height) * 4 + width * width + height * height) / 8 + 24);
}

inline int16_t clamped(int16_t v, int16_t low, int16_t high) {
  const int16_t raised = v < low ? low : v;
  return raised > high ? high : raised;
}

// How far the middles of cells are outside a circle: that of cell (i, j) x[i] + y[j].
struct Distances {
  int16_t x[kSlices], y[kSlices];
};

// The power of slices' middles: a parabola. By the circle's own scale it fits 16 bits, of both axes
// together below 12581; by another one it may wrap around, which spoils an estimate and no more.
inline void measure_axis(int32_t constant, FastInt slope, const Slices& slices, const Scale& scale,
                         int16_t* distance) {
  const int16_t linear =
      static_cast<int16_t>(scaled(slope, scale.reciprocal, scale.shift + slices.unit + 7));
  const int16_t square =
      static_cast<int16_t>(scaled(32768, scale.reciprocal, scale.shift + 2 * slices.unit));
  for (int i = 0; i < kSlices; ++i) {
    distance[i] =
        static_cast<int16_t>(constant + (static_cast<int32_t>(slices.middle[i]) * linear >> 16) +
                             (static_cast<int32_t>(slices.square[i]) * square >> 16));
  }
}

MICROTIN_OUT_OF_LINE inline void measure(const Power& power, const Scale& scale, const Grid& grid,
                                         Distances& distance) {
  int32_t value = kept_within(scaled(power.value, 1, scale.shift), static_cast<int32_t>(1) << 30);
  value = kept_within(scaled(value, scale.reciprocal, 21), 1 << 13);
  measure_axis(value, power.x, grid.columns, scale, distance.x);
  measure_axis(0, power.y, grid.rows, scale, distance.y);
}

// 16-bit arithmetic that wraps around.
inline int16_t sum_of(int16_t a, int16_t b) {
  return static_cast<int16_t>(static_cast<uint16_t>(a) + static_cast<uint16_t>(b));
}

// For each column of cells. One by one, as copies of what is done are quicker and vectorised; in a
// loop where size counts.
template <class Body>
void for_columns(const Body& body) {
#if defined(__OPTIMIZE_SIZE__)
  for (int i = 0; i < kSlices; ++i) body(i);
#else
  static_assert(kSlices == 4, "all columns");
  body(0);
  body(1);
  body(2);
  body(3);
#endif
}

inline void expand_column(int16_t x, const int16_t* y, int16_t* sum) {
  for (int j = 0; j < kSlices; ++j) sum[j] = sum_of(x, y[j]);
}

// Of all cells.
MICROTIN_OUT_OF_LINE inline void expand(const Distances& distance, Cells sum) {
  for_columns(
      [&distance, sum](int i) { expand_column(distance.x[i], distance.y, sum + kSlices * i); });
}

inline int16_t share_of(int16_t weight, int16_t share) {
  return static_cast<int16_t>((static_cast<uint32_t>(static_cast<uint16_t>(weight)) *
                               static_cast<uint16_t>(static_cast<uint32_t>(share) << 8)) >>
                              16);
}

inline void cut_column(int16_t x, const int16_t* y, int16_t* weight) {
  for (int j = 0; j < kSlices; ++j) {
    const int16_t outside = static_cast<int16_t>(sum_of(x, y[j]) + 32);
    weight[j] = share_of(weight[j], static_cast<int16_t>(clamped(outside, 0, 63) << 2));
  }
}

// Takes away what lies inside a circle: all of a cell that is half a cell inside, nothing of one
// that is half a cell outside.
MICROTIN_OUT_OF_LINE inline void cut(const Distances& distance, Cells weight) {
  for_columns(
      [&distance, weight](int i) { cut_column(distance.x[i], distance.y, weight + kSlices * i); });
}

}  // namespace microtin


namespace microtin {

// How close vertices come: over the points per unit area, the inverse of a squared distance, such
// that one in 192 * 256 / crowding places is closer than that to a corner. 8 fractional bits.
typedef uint32_t Crowding;
constexpr Crowding kCrowdingStart = 2048, kCrowdingLeast = 512, kCrowdingMost = 65536;

constexpr int16_t kReach = 256;  // the squared distance from which on nothing is repelled

// Coordinates are in sixteenths of the distance that counts, from the middle of the grid. They are
// below 2^12 within the first box, since the unit shrinks with it.
struct Repulsion {
  int32_t unit;     // that many 2^-16 are half a lattice step: at most 2^27
  int16_t nearest;  // squared distance of the box's middle from the nearest corner, at most 512
  Cells near;       // the same of the cells
};

// Half steps within the first box, below 2^(size + 1), in sixteenths.
inline int16_t scaled(int32_t unit, FastInt half_steps) {
  return static_cast<int16_t>(static_cast<int32_t>(half_steps) * unit >> 16);
}

// For a first box of which the longer side has 2^size .. 2^(size + 1) - 1 steps.
inline void start_repulsion(Repulsion& repulsion, uint32_t size, Log2 density, Crowding crowding) {
  // Sixteenths of half steps: 19 = 16 + 4 - 1. Within 2^(27 - size) all fits 32 bits.
  const uint32_t unit = exp2_of((log2_of(crowding) - 8 * kLog2One + density) / 2 + 19 * kLog2One);
  const uint32_t most = static_cast<uint32_t>(1) << (27 - size);
  repulsion.unit = static_cast<int32_t>(unit < most ? unit : most);
  repulsion.nearest = 0;
}

inline bool repels(const Repulsion& repulsion) {
  return repulsion.nearest < 2 * kReach;
}

// Weakens what is within reach.
MICROTIN_OUT_OF_LINE inline void weaken(const Cells near, Cells weight) {
  for (int k = 0; k < kCells; ++k) weight[k] = share_of(weight[k], clamped(near[k], 0, 255));
}

// The slices' middles; below 2^13.
inline void scale_middles(const Slices& slices, int32_t unit, int16_t* middle) {
  const int32_t scale = (unit << 2) >> slices.unit;
  for (int i = 0; i < kSlices; ++i) {
    middle[i] = static_cast<int16_t>(slices.middle[i] * scale >> 16);
  }
}

// Whether a corner is too far from all middles to matter: squared, 23 is above 2 * kReach.
inline bool is_far(const int16_t* middle, int16_t corner) {
  return corner < middle[0] - 23 || corner > middle[kSlices - 1] + 23;
}

MICROTIN_OUT_OF_LINE inline void square_distances(const int16_t* middle, int16_t corner,
                                                  int16_t* square) {
  for (int i = 0; i < kSlices; ++i) {
    const int16_t d = clamped(static_cast<int16_t>(middle[i] - corner), -127, 127);
    square[i] = static_cast<int16_t>(d * d);
  }
}

inline void keep_smaller_in_column(int16_t x, const int16_t* y, int16_t* near) {
  for (int j = 0; j < kSlices; ++j) {
    const int16_t sum = static_cast<int16_t>(x + y[j]);
    near[j] = sum < near[j] ? sum : near[j];
  }
}

MICROTIN_OUT_OF_LINE inline void keep_smaller(const Distances& squares, Cells near) {
  for (int i = 0; i < kSlices; ++i) {
    keep_smaller_in_column(squares.x[i], squares.y, near + kSlices * i);
  }
}

// Takes away weight close to the triangle's corners; `middle` of the grid, half steps from corner
// 0.
MICROTIN_IN_PLACE inline void repel(Repulsion& repulsion, const FreeRegion& region, Offset middle,
                                    const Grid& grid, Cells weight) {
  int16_t column[kSlices], row[kSlices];
  scale_middles(grid.columns, repulsion.unit, column);
  scale_middles(grid.rows, repulsion.unit, row);
  for (int k = 0; k < kCells; ++k) repulsion.near[k] = 2 * kReach;
  bool in_reach = false;
  for (int k = 0; k < 3; ++k) {
    const Offset corner = region.corner[k];
    const int16_t x = scaled(repulsion.unit, 2 * corner.x - middle.x);
    const int16_t y = scaled(repulsion.unit, 2 * corner.y - middle.y);
    if (is_far(column, x) || is_far(row, y)) continue;
    Distances squares;
    square_distances(column, x, squares.x);
    square_distances(row, y, squares.y);
    keep_smaller(squares, repulsion.near);
    in_reach = true;
  }
  if (in_reach) weaken(repulsion.near, weight);
}

inline void learn(Crowding& crowding, const Repulsion& repulsion) {
  if (repulsion.nearest < kReach) crowding += crowding >> 4;
  crowding -= 12;
  if (crowding < kCrowdingLeast) crowding = kCrowdingLeast;
  if (crowding > kCrowdingMost) crowding = kCrowdingMost;
}

}  // namespace microtin


namespace microtin {

constexpr int kSweepNodes = 4;
constexpr int kSweepSteps = 8 * kSweepNodes;

struct PlaceOdds {
  Box box;              // from corner 0; encloses the free region
  Grid grid;            // of it
  bool matters[3];      // in the grid: the circle behind a side
  Distances behind[3];  // from these circles
  Power swept_from;     // the circle behind the chord
  Distances distance;   // from the circle in hand
  Cells weight;
  bool sweeps;  // whether the chance of being first differs noticeably over the region
  // 511 * chance of being first, at equal steps of the cotangent from the triangle's circle to that
  // behind the chord.
  int16_t chance_at[kSweepSteps + 1];
  Cells left, all;  // of the sweep, at the cells
  Repulsion repulsion;
};

// Eight equal steps from `from` towards `to`, both below 2^12.
MICROTIN_OUT_OF_LINE inline void interpolate(int16_t from, int16_t to, int16_t* step) {
  const int16_t start = static_cast<int16_t>(from * 8);
  const int16_t difference = static_cast<int16_t>(to - from);
  for (int16_t j = 0; j < 8; ++j) {
    const int16_t moved_by = static_cast<int16_t>(difference * j);
    step[j] = static_cast<int16_t>(static_cast<int16_t>(start + moved_by) >> 3);
  }
}

// 511 * chance of being first for a swept area, with 17 fractional bits as segment() has them;
// `rate` <= 2^30 is the density by that unit, with 16 fractional bits, times log2(e).
inline int16_t chance_of(int32_t swept, uint32_t rate) {
  const uint64_t loss = swept > 0 ? static_cast<uint64_t>(swept) * rate >> 25 : 0;
  const Log2 left = loss < 15 * kLog2One ? 15 * kLog2One - static_cast<Log2>(loss) : 0;
  return static_cast<int16_t>(exp2_of(left) * 511 >> 15);
}

// Fills in the chances of being first; `density` is the logarithm of points per unit area.
inline void estimate_sweep(PlaceOdds& odds, const FreeRegion& region, Log2 density) {
  const Cotangent from = region.side[kChord].behind, to = region.side[kChord].own;
  const Offset chord = region.corner[2];
  const int32_t start = segment(from);
  // log2(log2(e)) = 135 / 256.
  const Log2 log_rate = log2_of(static_cast<uint64_t>(dot(chord, chord))) + density + 135;
  const uint32_t rate = exp2_of(log_rate + 16 * kLog2One);
  int16_t last = chance_of(segment(to) - start, rate);
  odds.sweeps = last < 256;
  if (!odds.sweeps) return;
  for (int i = 1; i <= kSweepNodes; ++i) {
    const int16_t next = chance_of(segment(to + (((from - to) * i) >> 2)) - start, rate);
    interpolate(last, next, odds.chance_at + 8 * (i - 1));
    last = next;
  }
  odds.chance_at[kSweepSteps] = last;
}

// `density` is the logarithm of points per unit area.
inline void estimate_odds(PlaceOdds& odds, const FreeRegion& region, Log2 density) {
  for (int i = 0; i < 3; ++i) odds.matters[i] = region.side[i].certified && !region.side[i].ghost;
  estimate_sweep(odds, region, density);
}

// The circle over a side, seen from the middle of the grid.
inline Power circle(const PlaceOdds& odds, const FreeRegion& region, int side, Cotangent k) {
  return circle_over(region.corner[side], region.corner[side + 1], k, middle_of(odds.box));
}

// Multiplies the weights by the chances of being first: the sweep has passed some of the way from
// the circle behind the chord to the triangle's.
MICROTIN_OUT_OF_LINE MICROTIN_IN_PLACE inline void sweep(PlaceOdds& odds, const Scale& own) {
  int16_t* const left = odds.left;
  int16_t* const all = odds.all;
  measure(odds.swept_from, own, odds.grid, odds.distance);
  expand(odds.distance, all);
  for (int k = 0; k < kCells; ++k) {
    left[k] = clamped(static_cast<int16_t>(-left[k]), 0, 16383);
    all[k] = static_cast<int16_t>(clamped(all[k], 1, 16383) + left[k]);
  }
  for (int k = 0; k < kCells; ++k) {
    const uint32_t steps = static_cast<uint32_t>(left[k]) * kSweepSteps;
    const int16_t chance = odds.chance_at[steps / static_cast<uint16_t>(all[k])];
    odds.weight[k] = static_cast<int16_t>(odds.weight[k] * chance);
  }
}

// What the triangle's circle leaves of the cells, times the chances of being first.
MICROTIN_OUT_OF_LINE MICROTIN_IN_PLACE inline void weigh_inside(PlaceOdds& odds,
                                                                const FreeRegion& region) {
  const Power own = circle(odds, region, kChord, region.side[kChord].own);
  const Scale scale = scale_for(own, odds.grid);
  measure(own, scale, odds.grid, odds.distance);
  expand(odds.distance, odds.left);
  const int16_t whole = odds.sweeps ? 1 : 511;
  for (int k = 0; k < kCells; ++k) {
    const int16_t share = clamped(static_cast<int16_t>(32 - odds.left[k]), 0, 64);
    odds.weight[k] = static_cast<int16_t>(share * whole);
  }
  if (odds.sweeps) sweep(odds, scale);
}

MICROTIN_IN_PLACE inline void weigh_cells(PlaceOdds& odds, const FreeRegion& region) {
  odds.swept_from = circle(odds, region, kChord, region.side[kChord].behind);
  weigh_inside(odds, region);
  for (int k = 0; k < 3; ++k) {
    if (!odds.matters[k]) continue;
    const Power power =
        k == kChord ? odds.swept_from : circle(odds, region, k, region.side[k].behind);
    measure(power, scale_for(power, odds.grid), odds.grid, odds.behind[k]);
    cut(odds.behind[k], odds.weight);
  }
  if (repels(odds.repulsion))
    repel(odds.repulsion, region, middle_of(odds.box), odds.grid, odds.weight);
}

// Makes a cell the box.
inline void narrow(PlaceOdds& odds, int i, int j) {
  for (int k = 0; k < 3; ++k) {
    const Distances& outside = odds.behind[k];
    if (odds.matters[k]) odds.matters[k] = sum_of(outside.x[i], outside.y[j]) < 64;
  }
  if (repels(odds.repulsion)) odds.repulsion.nearest = odds.repulsion.near[kSlices * i + j];
  Box& box = odds.box;
  const FastInt* const column = odds.grid.columns.start + i;
  const FastInt* const row = odds.grid.rows.start + j;
  box = Box{box.x0 + column[0], box.y0 + row[0], box.x0 + column[1] - 1, box.y0 + row[1] - 1};
}

}  // namespace microtin


namespace microtin {

// For each of the four binary decisions of a level: the odds learned for the estimated ones.
struct PlaceModel {
  Calibration split[4];
};

// Codes one of four slices by their weights, below 2^26: the half, then the quarter. What holds no
// lattice points weighs nothing and is never chosen; such slices come first.
template <class Coder>
int code_slice(Coder& coder, Calibration* split, const uint32_t* weight, int slice) {
  int first = 0;
  for (int half = 2; half != 0; half >>= 1, ++split) {
    uint32_t low = weight[first], high = weight[first + half];
    if (half == 2) {
      low += weight[1];
      high += weight[3];
    }
    bool in_high = low == 0;
    if (low != 0) {
      const uint32_t bits = highest_bit(low + high);
      const uint32_t shift = bits > 16 ? bits - 16 : 0;
      const uint32_t share = ((high >> shift) << 15) / (((low + high) >> shift) + 1);
      in_high = code_calibrated(coder, *split, share, (slice & half) != 0);
    }
    if (in_high) first += half;
  }
  return first;
}

// The next vertex's place, seen from corner 0: known to a writing coder.
template <class Coder>
Offset next_place(Coder& coder, const FreeRegion& region) {
  const Vertex next = coder.next();
  return Point{next.x, next.y} - region.origin;
}

// A cell's weight is an estimate: any of its places may be the one.
inline uint32_t possible(int16_t weight) {
  return static_cast<uint32_t>(weight) + 32u;
}

// Codes the cell that holds the place, which becomes the box.
template <class Coder>
MICROTIN_OUT_OF_LINE void code_cell(Coder& coder, Calibration* split, const FreeRegion& region,
                                    PlaceOdds& odds) {
  const Offset place = next_place(coder, region);
  const Box& box = odds.box;
  Slices& columns = odds.grid.columns;
  Slices& rows = odds.grid.rows;
  slice(columns, box.x1 - box.x0 + 1);
  slice(rows, box.y1 - box.y0 + 1);
  if (columns.count == 1 && rows.count == 1) return;
  weigh_cells(odds, region);
  uint32_t row_size[kSlices], weight[kSlices];
  for (int j = 0; j < kSlices; ++j) row_size[j] = size_of(rows, j);
  const int16_t* cell = odds.weight;
  for (int i = 0; i < kSlices; ++i) {
    uint32_t sum = 0;
    for (int j = 0; j < kSlices; ++j) sum += possible(*cell++) * row_size[j];
    weight[i] = sum * size_of(columns, i);
  }
  const int i = code_slice(coder, split, weight, slice_of(columns, place.x - box.x0));
  cell = odds.weight + kSlices * i;
  for (int j = 0; j < kSlices; ++j) {
    weight[j] = possible(cell[j]) * row_size[j];
  }
  const int j = code_slice(coder, split + 2, weight, slice_of(rows, place.y - box.y0));
  narrow(odds, i, j);
}

// Codes a coordinate from `low` to `high`, all equally likely.
template <class Coder>
FastInt code_within(Coder& coder, FastInt low, FastInt high, FastInt value) {
  return low + static_cast<FastInt>(coder.uniform(static_cast<uint32_t>(high - low + 1),
                                                  static_cast<uint32_t>(value - low)));
}

// Codes a place in the box, as seen from corner 0.
template <class Coder>
Offset code_place(Coder& coder, PlaceModel& model, const FreeRegion& region, PlaceOdds& odds,
                  uint32_t levels) {
  for (uint32_t level = 0; level < levels; ++level) {
    code_cell(coder, model.split, region, odds);
  }
  const Offset place = next_place(coder, region);
  const Box& box = odds.box;
  return Offset{code_within(coder, box.x0, box.x1, place.x),
                code_within(coder, box.y0, box.y1, place.y)};
}

}  // namespace microtin

// --- shared/start_probabilities.hpp
// Where the adaptive bits start, in the order of Models: the probability of a one is
// (entry + 1/2) / 256. Written by `tests/bench/run train`.


namespace microtin {

constexpr uint32_t kStarts = 279;

// clang-format off
constexpr uint8_t kStartTable[kStarts] MICROTIN_IN_FLASH = {
    11, 7, 9, 16, 38, 90, 160, 220, 247, 254, 255, 255, 255, 255, 242, 15,
    21, 17, 32, 66, 118, 183, 229, 248, 252, 251, 248, 232, 206, 145, 14, 18,
    16, 26, 55, 110, 187, 230, 248, 254, 255, 255, 254, 254, 205, 0, 2, 4,
    37, 89, 69, 44, 14, 42, 42, 248, 252, 254, 255, 255, 4, 5, 2, 4,
    4, 18, 46, 103, 192, 243, 253, 255, 255, 254, 255, 2, 25, 25, 3, 9,
    29, 82, 155, 228, 252, 255, 255, 255, 255, 248, 25, 14, 6, 20, 4, 33,
    68, 74, 105, 160, 209, 238, 248, 252, 254, 7, 28, 57, 92, 128, 166, 199,
    227, 248, 12, 35, 61, 90, 124, 163, 199, 228, 247, 7, 32, 61, 95, 131,
    166, 197, 225, 249, 22, 45, 65, 91, 120, 162, 197, 224, 244, 187, 160, 132,
    189, 176, 57, 69, 187, 160, 132, 197, 186, 58, 63, 187, 160, 159, 127, 71,
    69, 56, 187, 160, 177, 129, 70, 54, 41, 187, 173, 129, 69, 47, 25, 38,
    187, 169, 137, 110, 72, 35, 31, 170, 135, 108, 77, 86, 61, 29, 173, 143,
    131, 174, 162, 97, 40, 150, 135, 122, 148, 129, 65, 37, 166, 127, 131, 196,
    191, 147, 75, 140, 135, 113, 200, 204, 146, 55, 108, 92, 56, 101, 140, 96,
    116, 109, 109, 98, 80, 66, 72, 79, 63, 58, 42, 157, 173, 209, 158, 153,
    194, 149, 155, 176, 140, 127, 151, 138, 139, 138, 135, 110, 108, 127, 129, 104,
    126, 96, 80, 109, 98, 63, 107, 68, 41, 231, 201, 166, 175, 135, 73, 38,
    0, 0, 1, 6, 157, 247, 246,
};
// clang-format on

inline uint32_t table_start(uint32_t i) {
  return read_table(kStartTable + i);
}

}  // namespace microtin


namespace microtin {

constexpr uint32_t kHitEntries = 15;
constexpr int kHitContexts = 7;

// Everything that is learned while coding.
struct Models {
  Curve<kHitEntries> hit[kHitContexts];
  PlaceModel place;
  HeightModel height;
  ExponentModel gap;
  AdaptiveBit is_void[7];
};

static_assert(sizeof(Models) == kStarts * sizeof(AdaptiveBit), "nothing but adaptive bits");

inline void reset(Models& models) {
  uint16_t* to = reinterpret_cast<uint16_t*>(&models);
  for (uint32_t i = 0; i < kStarts; ++i) {
    const AdaptiveBit bit = adaptive_bit(table_start(i));
    *to++ = bit.fast;
    *to++ = bit.slow;
  }
}

enum class Stage : uint8_t { kSeed, kPhase, kWalk, kVoids, kComplete };

enum class Progress : uint8_t {
  kStep,        // one step done, more to do in this section
  kPhaseEnd,    // the same, and it completed a phase
  kSectionEnd,  // ... and the section
  kMalformed
};

struct Reconstruction {
  Mesh* mesh;
  uint8_t* voids;      // a bit per triangle
  Index* queue;        // half-edges parent -> vertex, one per vertex
  uint8_t* marks;      // two bits per vertex: queued, done
  Residual* residual;  // per vertex, see height_coding.hpp
  Contract contract;

  Stage stage;
  Index vertex;      // being walked around
  Index chord;       // half-edge into `vertex`, of the triangle to be looked at next
  uint8_t from;      // marks of the vertex that the chord comes from
  Index turn_start;  // the neighbour where the turn around `vertex` began
  Index anchor;      // the half-edge from vertex 0 to infinity
  Index queue_head;
  Index queue_tail;
  Index phase_end;  // vertices when the phase is complete
  uint32_t phase;   // phases complete
  uint32_t work;    // vertices walked around so far, all phases together
  Log2 share;       // for note_final_triangle
  int32_t density;  // log2 of this batch's points per unit area, 16 fractional bits
  Index void_cursor;

  Crowding crowding;
  // Of the triangle in hand: here to spare the stack.
  FreeRegion region;
  PlaceOdds odds;

  Cavity cavity;
  Index cavity_triangles[kMaxDegree];
  Index cavity_origin[kMaxDegree];
  Index cavity_twin[kMaxDegree];

  Models models;
};

// All but the contract, which is known.
inline void start(Reconstruction& r) {
  r.stage = Stage::kSeed;
  r.phase = 0;
  r.work = 0;
  r.void_cursor = 0;
  r.cavity.triangles = r.cavity_triangles;
  r.cavity.edge_origin = r.cavity_origin;
  r.cavity.edge_twin = r.cavity_twin;
  r.cavity.limit = static_cast<Index>(r.contract.degree - 2);
  r.mesh->vertices = 0;
  r.mesh->triangles = 0;
  reset(r.models);
  r.crowding = kCrowdingStart;
}

// --- Marks -------------------------------------------------------------------------------------

constexpr uint8_t kQueued = 1, kDone = 2;

// In the two lowest bits; those above are other vertices'.
inline uint32_t marks_of(const Reconstruction& r, Index v) {
  if (v == kInfinity) return kQueued | kDone;  // nobody asks before its turn is over
  return static_cast<uint32_t>(r.marks[v >> 2]) >> (2u * (v & 3u));
}

inline bool marked(const Reconstruction& r, Index v, uint8_t mark) {
  return (marks_of(r, v) & mark) != 0;
}

inline void mark(Reconstruction& r, Index v, uint8_t mark) {
  if (v == kInfinity) return;
  r.marks[v >> 2] = static_cast<uint8_t>(r.marks[v >> 2] | mark << (2u * (v & 3u)));
}

// --- The triangle in hand ------------------------------------------------------------------------

inline void look_behind(const Reconstruction& r, Index h, Side& side) {
  const Index apex = r.mesh->origin[previous_in_triangle(r.mesh->twin[h])];
  side.ghost = apex == kInfinity;
  side.certified = marked(r, apex, kDone);
  if (!side.ghost) side.apex = point_of(*r.mesh, apex) - r.region.origin;
}

// Describes the free region of the real triangle (v, c, a) whose half-edge a -> v is the chord.
inline void look_around(Reconstruction& r) {
  FreeRegion& region = r.region;
  const Mesh& mesh = *r.mesh;
  const Index edge[3] = {next_in_triangle(r.chord), previous_in_triangle(r.chord), r.chord};
  region.origin = point_of(mesh, r.vertex);
  region.corner[0] = region.corner[3] = Offset{0, 0};
  region.corner[1] = point_of(mesh, mesh.origin[edge[1]]) - region.origin;
  region.corner[2] = point_of(mesh, mesh.origin[r.chord]) - region.origin;
  for (int i = 0; i < 3; ++i) look_behind(r, edge[i], region.side[i]);
  region.side[kChord].certified = true;  // it was passed in this turn, or has a done vertex
}

// log2 of the mean area of a Delaunay triangle of random points less the mean log2 of it.
constexpr Log2 kMeanOfLogs = 220;

// Takes a final triangle into the running mean of what such suggest about the density: of n final
// vertices each has two triangles to itself, and of these vertices `share` are the batch's.
// Logarithms are below 2^14: the difference stays below 2^23.
inline void note_final_triangle(Reconstruction& r, int64_t twice_area) {
  const Log2 density = r.share - log2_of(static_cast<uint64_t>(twice_area));
  r.density += (density * 256 - r.density) / 16;
}

// --- Insertion -----------------------------------------------------------------------------------

// Inserts a vertex at `place`, decoded relative to the triangle of the chord, with the height that
// the stream says. The chord becomes the half-edge from the new vertex. False if that is not legal.
template <class Coder>
bool insert(Reconstruction& r, Coder& coder, Point place) {
  Mesh& mesh = *r.mesh;
  const Index chord = r.chord;
  if (!(point_of(mesh, 0) < place)) return false;
  // Final triangles must stay. Those with a done vertex are met through that vertex, since the
  // chord's has none. Those passed in this turn can only be reached across the chord: around
  // infinity the first of them is at vertex 0, which is the smallest and so stays on the hull.
  const auto is_done = [&r](Index corner) { return marked(r, corner, kDone); };
  if (!grow_cavity(mesh, chord, place, r.cavity, is_done)) return false;
  if (r.cavity.size == 0 || r.cavity_twin[0] != mesh.twin[chord]) return false;
  const Index v = mesh.vertices;
  int16_t z = 0;
  if (r.contract.has_heights) {
    // The ring begins with the chord's start, which is finite, since triangles at infinity are
    // looked at around infinity only.
    const HeightPrediction prediction = predict_height(
        mesh, r.residual, r.cavity_origin, static_cast<uint32_t>(r.cavity.size) + 2u, place);
    z = coder.next().z;
    if (!code_height(coder, r.models.height, prediction, &z)) return false;
    r.residual[v] = residual_of(z - prediction.height);
  }
  mesh.place[v] = place;
  mesh.z[v] = z;
  const Index first = fan_cavity(mesh, r.cavity, v);
  if (chord == r.anchor) r.anchor = first;
  ++mesh.vertices;
  r.chord = mesh.twin[first + 1u];
  return true;
}

// --- Coding of one decision ----------------------------------------------------------------------

struct HitEstimate {
  int context;
  int32_t position;  // on the context's curve
};

// The hull edge beside the chord to infinity.
inline HullEdge hull_edge(const Reconstruction& r) {
  const Mesh& mesh = *r.mesh;
  return hull_edge(r.contract, point_of(mesh, mesh.origin[r.chord]),
                   point_of(mesh, mesh.origin[previous_in_triangle(r.chord)]));
}

// The longer the edge, against the spacing of the vertices, the likelier is a hit.
inline HitEstimate estimate_hull_hit(const HullEdge& edge, Log2 density) {
  const FastInt length = absolute(edge.along.x) | absolute(edge.along.y);
  return HitEstimate{6, 2 * log2_of(static_cast<uint64_t>(length)) + density + 6 * 256};
}

// The degree of the vertex where h starts, infinity counted, but at most `most`.
inline uint32_t degree_up_to(const Mesh& mesh, Index h, uint32_t most) {
  const Index first = h;
  uint32_t degree = 0;
  do {
    ++degree;
    h = mesh.twin[previous_in_triangle(h)];
  } while (h != first && degree < most);
  return degree;
}

// A miss makes c known to the walk if it is not yet. The encoder removes every vertex whose degree
// is at most D when the walk comes to know it, so such a c must still get neighbours: a hit.
inline HitEstimate estimate_hit(Reconstruction& r, Log2 density) {
  const Mesh& mesh = *r.mesh;
  const Index from_c = previous_in_triangle(r.chord);
  HitEstimate estimate;
  estimate.position = free_area(r.region) + density + 6 * 256;
  estimate.context = (r.region.side[0].certified ? 1 : 0) + (r.region.side[1].certified ? 2 : 0);
  if (marked(r, mesh.origin[from_c], kQueued)) return estimate;
  const uint32_t degree = degree_up_to(mesh, from_c, r.contract.degree + 2u);
  estimate.context = degree < r.contract.degree + 2u ? 4 : 5;
  if (degree <= r.contract.degree) estimate.position = static_cast<int32_t>(kHitEntries) * 256;
  return estimate;
}

template <class Coder>
MICROTIN_IN_PLACE inline bool code_hit(Reconstruction& r, Coder& coder,
                                       const HitEstimate& estimate) {
  return code_on_curve(coder, r.models.hit[estimate.context], estimate.position,
                       coder.conflicts(*r.mesh, r.chord));
}

// Where a hit is. It takes the place of c.
template <class Coder>
MICROTIN_IN_PLACE inline Point locate(Reconstruction& r, Coder& coder, Log2 density) {
  FreeRegion& region = r.region;
  PlaceOdds& odds = r.odds;
  const Offset first = Point{0, 0} - region.origin;
  odds.box = Box{first.x, first.y, first.x + r.contract.x_max, first.y + r.contract.y_max};
  enclose(region, odds.box);
  estimate_odds(odds, region, density);
  if (r.contract.has_heights) {
    start_repulsion(odds.repulsion, size_of(odds.box), density, r.crowding);
  } else {
    odds.repulsion.nearest = 2 * kReach;
  }
  const Offset found = code_place(coder, r.models.place, region, odds, r.contract.levels);
  learn(r.crowding, odds.repulsion);
  region.corner[1] = found;
  return Point{static_cast<uint16_t>(region.origin.x + found.x),
               static_cast<uint16_t>(region.origin.y + found.y)};
}

enum class Decision : uint8_t { kMiss, kHit, kMalformed };

// Says hit or miss at an uncertified triangle, and inserts the vertex of a hit.
template <class Coder>
Decision decide_at_hull(Reconstruction& r, Coder& coder, Log2 density) {
  const HullEdge edge = hull_edge(r);
  if (edge.length == 1) return Decision::kMiss;  // there is no place beyond it
  if (!code_hit(r, coder, estimate_hull_hit(edge, density))) return Decision::kMiss;
  const Point place =
      code_hull_place(coder, r.models.gap, r.models.height.mantissa, r.contract, edge, density);
  return insert(r, coder, place) ? Decision::kHit : Decision::kMalformed;
}

template <class Coder>
Decision decide(Reconstruction& r, Coder& coder) {
  const Log2 density = r.density / 256;
  if (r.vertex == kInfinity) return decide_at_hull(r, coder, density);
  look_around(r);
  const bool hit = code_hit(r, coder, estimate_hit(r, density));
  if (hit && !insert(r, coder, locate(r, coder, density))) return Decision::kMalformed;
  // The triangle of the chord and c, or the new vertex, is final.
  note_final_triangle(r, cross(r.region.corner[1], r.region.corner[2]));
  return hit ? Decision::kHit : Decision::kMiss;
}

// --- Steps ---------------------------------------------------------------------------------------

// What follows when all vertices of a phase, or of the seed, are in place.
inline Progress after_vertices(Reconstruction& r) {
  if (r.mesh->vertices != r.contract.vertices) {
    r.stage = Stage::kPhase;
    const bool together = r.mesh->vertices < kSectionVertices;
    return together ? Progress::kPhaseEnd : Progress::kSectionEnd;
  }
  r.stage = r.contract.has_voids ? Stage::kVoids : Stage::kComplete;
  return r.contract.has_voids ? Progress::kPhaseEnd : Progress::kSectionEnd;
}

// One of the three vertices that are never removed. The first is the lexicographically smallest of
// all.
template <class Coder>
Progress step_seed(Reconstruction& r, Coder& coder) {
  Mesh& mesh = *r.mesh;
  const Index i = mesh.vertices;
  const Vertex known = coder.next();
  mesh.place[i].x = code_outer_coordinate(coder, r.contract.x_max, known.x);
  mesh.place[i].y = code_outer_coordinate(coder, r.contract.y_max, known.y);
  mesh.z[i] = 0;
  r.residual[i] = 4;
  if (r.contract.has_heights) {
    const HeightPrediction previous = {i == 0 ? 0 : mesh.z[i - 1u], kScales - 1, kTendencies / 2};
    mesh.z[i] = known.z;
    if (!code_height(coder, r.models.height, previous, &mesh.z[i])) return Progress::kMalformed;
  }
  if (i < 2) {
    ++mesh.vertices;
    return Progress::kStep;
  }
  const Point p0 = point_of(mesh, 0), p1 = point_of(mesh, 1), p2 = point_of(mesh, 2);
  if (!(p0 < p1) || !(p0 < p2) || orient2d(p0, p1, p2) <= 0) return Progress::kMalformed;
  start_mesh(mesh);
  r.anchor = 4;
  return after_vertices(r);
}

// Starts a phase: how many vertices it adds, and the walk from infinity.
template <class Coder>
Progress step_phase(Reconstruction& r, Coder& coder) {
  const uint32_t placed = r.mesh->vertices;
  const uint32_t left = r.contract.vertices - placed;
  uint32_t batch = left;
  if (coder.bit(kProbabilityOne / 2, !coder.last_phase())) {
    // All but the low 16 bits, then these: 1 .. left - 1.
    const uint32_t high = coder.uniform((left >> 16) + 1u, coder.batch() >> 16);
    batch = high << 16 | coder.uniform(left < 65536 ? left : 65536, coder.batch() & 65535u);
    if (batch == 0 || batch >= left) return Progress::kMalformed;
  }
  r.phase_end = static_cast<Index>(placed + batch);
  r.work += placed + batch;
  if (r.work > work_budget(placed + batch)) return Progress::kMalformed;
  const uint32_t mark_bytes = (placed + batch + 3u) / 4u;
  for (uint32_t i = 0; i < mark_bytes; ++i) r.marks[i] = 0;
  r.vertex = kInfinity;
  r.turn_start = 0;
  mark(r, 0, kQueued);
  r.queue_head = 0;
  r.queue_tail = 1;  // entry 0 is vertex 0's, known when the turn around infinity ends
  r.chord = r.anchor;
  r.from = kQueued;
  const Log2 log_batch = log2_of(batch);
  r.share = log_batch - log2_of(placed + batch) - kMeanOfLogs;
  // Before anything is known: the lattice's bounds, shared by all.
  r.density = (log_batch - log2_of(lattice_places(r.contract))) * 256;
  r.stage = Stage::kWalk;
  return Progress::kStep;
}

// Turns to the next triangle around `vertex`; `chord` is already its half-edge into `vertex`, which
// comes from `neighbour`. False if the walk is over.
inline bool advance(Reconstruction& r, Index neighbour, uint32_t marks) {
  if (neighbour != r.turn_start) {
    r.from = static_cast<uint8_t>(marks);
    if ((marks & kQueued) == 0) {
      r.queue[r.queue_tail++] = r.mesh->twin[r.chord];
      mark(r, neighbour, kQueued);
    }
    return true;
  }
  if (r.vertex == kInfinity) r.queue[0] = r.mesh->twin[r.chord];
  mark(r, r.vertex, kDone);
  if (r.queue_head == r.queue_tail) return false;
  r.chord = r.queue[r.queue_head++];
  r.from = kDone;  // the parent's turn is over
  r.turn_start = r.mesh->origin[r.chord];
  r.vertex = r.mesh->origin[r.mesh->twin[r.chord]];
  return true;
}

// The far corner of the triangle of the chord.
struct Corner {
  Index into;    // half-edge from it into `vertex`, of the next triangle
  Index number;  // of the corner
  uint32_t marks;
};

inline Corner far_corner(const Reconstruction& r) {
  const Index into = r.mesh->twin[next_in_triangle(r.chord)];
  const Index number = r.mesh->origin[into];
  return Corner{into, number, marks_of(r, number)};
}

// Leaves the triangle of the chord, which is final. False if the walk is over.
inline bool pass(Reconstruction& r, const Corner& corner) {
  r.chord = corner.into;
  return advance(r, corner.number, corner.marks);
}

// Says hit or miss at the triangle of the chord, which is not certified, and leaves it.
template <class Coder>
Progress step_decision(Reconstruction& r, Coder& coder, const Corner& corner) {
  const Decision decision = decide(r, coder);
  if (decision == Decision::kMalformed) return Progress::kMalformed;
  if (decision == Decision::kMiss) return pass(r, corner) ? Progress::kStep : Progress::kMalformed;
  if (r.mesh->vertices == r.phase_end) {
    ++r.phase;
    return after_vertices(r);
  }
  const Index placed = r.mesh->origin[r.chord];
  return advance(r, placed, 0) ? Progress::kStep : Progress::kMalformed;
}

constexpr uint32_t kStepTriangles = 8;  // most that one step passes

// Passes certified triangles, but only a few, and looks at one that is not.
template <class Coder>
Progress step_walk(Reconstruction& r, Coder& coder) {
  for (uint32_t i = 0;; ++i) {
    const Corner corner = far_corner(r);
    if (((r.from | corner.marks) & kDone) == 0) return step_decision(r, coder, corner);
    if (i == kStepTriangles) return Progress::kStep;
    if (!pass(r, corner)) return Progress::kMalformed;
  }
}

inline bool is_void(const uint8_t* voids, Index triangle) {
  return (static_cast<uint32_t>(voids[triangle >> 3]) >> (triangle & 7u) & 1u) != 0;
}

// Codes the void flag of one real triangle, given those of its neighbours that are known.
template <class Coder>
Progress step_void(Reconstruction& r, Coder& coder) {
  const Mesh& mesh = *r.mesh;
  const Index t = r.void_cursor++;
  const Index f = first_edge(t);
  uint32_t context = 3;
  for (uint32_t i = 0; i < 3; ++i) {
    const Index neighbour = triangle_of(mesh.twin[f + i]);
    if (neighbour < t && !is_ghost(mesh, neighbour)) {
      context = is_void(r.voids, neighbour) ? context + 1 : context - 1;
    }
  }
  const bool flag =
      !is_ghost(mesh, t) && code_bit(coder, r.models.is_void[context], coder.is_void(mesh, t));
  const uint32_t bit = 1u << (t & 7u), others = r.voids[t >> 3] & ~bit;
  r.voids[t >> 3] = static_cast<uint8_t>(flag ? others | bit : others);
  if (r.void_cursor < mesh.triangles) return Progress::kStep;
  r.stage = Stage::kComplete;
  return Progress::kSectionEnd;
}

// One step: bounded work, at most kStepBytes of the payload, nothing half done.
template <class Coder>
Progress step(Reconstruction& r, Coder& coder) {
  switch (r.stage) {
    case Stage::kSeed:
      return step_seed(r, coder);
    case Stage::kPhase:
      return step_phase(r, coder);
    case Stage::kWalk:
      return step_walk(r, coder);
    case Stage::kVoids:
      return step_void(r, coder);
    case Stage::kComplete:
      break;
  }
  return Progress::kMalformed;
}

}  // namespace microtin


struct microtin_mesh {
  microtin::Mesh mesh;
  uint8_t* voids;              // a bit per triangle
  uint32_t capacity;           // vertices
  uint32_t verified_vertices;  // vertices when the last check passed
  microtin_axis axis[3];
  bool has_voids;  // whether `voids` is decoded; coarser terrains know none
};

namespace microtin {

enum class Item : uint8_t {
  kIdentity,
  kLength,  // of the header, or of a section's payload
  kHeader,  // up to its notes
  kPayloadStart,
  kStep,
  kRest,   // what is left of the header or the payload, not read
  kCheck,  // of the header, or of a section
};

}  // namespace microtin

struct microtin_decoder {
  microtin_mesh* mesh;
  uint32_t capacity;
  microtin_status status;  // NEED_INPUT while all is well
  uint32_t stop_phase;
  microtin::Item item;
  bool in_header;
  microtin_status verdict;  // DONE, or what to say once the check ahead has passed
  microtin::RangeDecoder coder;
  microtin::Reconstruction reconstruction;
};

static_assert(sizeof(microtin_mesh) <= MICROTIN_MESH_BYTES(0), "see MICROTIN_MESH_BYTES");
static_assert(sizeof(microtin_decoder) <= MICROTIN_DECODER_BYTES(0), "see MICROTIN_DECODER_BYTES");

// --- decoder/walk.hpp
// Finding the triangle that holds a place.

// --- shared/interpolation.hpp
// The height of a triangle's plane at a place inside it: one rounding, the same everywhere.

// --- shared/division.hpp
// 64-bit division. Where the machine has none it is done bit by bit: the compilers' helpers, but
// for those of AVR, are several times the code.

#include <stdint.h>


namespace microtin {

struct Quotient {
  uint64_t whole;
  uint64_t rest;
};

#if UINTPTR_MAX > 0xFFFFFFFFu || defined(__wasm__) || defined(__AVR__)

// d > 0.
inline Quotient divide(uint64_t n, uint64_t d) {
  return Quotient{n / d, n % d};
}

// floor(n * 2^17 / d), below 2^35; 0 < d <= 2^40.
inline uint64_t divide_finely(uint64_t n, uint64_t d) {
  return (n / d << 17) + (n % d << 17) / d;
}

#else

MICROTIN_OUT_OF_LINE inline Quotient divide(uint64_t n, uint64_t d) {
  uint64_t bit = 1, whole = 0;
  for (; d <= n >> 1; d <<= 1) bit <<= 1;
  for (; bit != 0; bit >>= 1, d >>= 1) {
    if (n < d) continue;
    n -= d;
    whole |= bit;
  }
  return Quotient{whole, n};
}

inline uint64_t divide_finely(uint64_t n, uint64_t d) {
  uint64_t whole = 0;
  d <<= 17;
  for (int i = 0; i < 35; ++i) {
    whole <<= 1;
    if (n >= d) {
      n -= d;
      ++whole;
    }
    n <<= 1;  // < 2 * d <= 2^58
  }
  return whole;
}

#endif

}  // namespace microtin


namespace microtin {

// A place with 8 fractional bits per coordinate: 0 .. 65535 * 256.
struct FinePoint {
  int32_t x;
  int32_t y;
};

inline FinePoint fine(Point p) {
  return FinePoint{static_cast<int32_t>(p.x) * 256, static_cast<int32_t>(p.y) * 256};
}

// 256 times twice the signed area of (a, b, p): positive if p lies to the left of a -> b.
// Each factor pair is below 2^16 * 2^24, so |result| < 2^41.
inline int64_t orient_fine(Point a, Point b, FinePoint p) {
  const int32_t abx = static_cast<int32_t>(b.x) - a.x;
  const int32_t aby = static_cast<int32_t>(b.y) - a.y;
  const FinePoint o = fine(a);
  return static_cast<int64_t>(abx) * (p.y - o.y) - static_cast<int64_t>(aby) * (p.x - o.x);
}

// Height, with 16 fractional bits and rounded to nearest (halves up), of the plane through the
// counter-clockwise a, b, c at p in the closed triangle. On an edge only the edge's ends count, so
// both sides agree.
//
// The barycentric weights are >= 0 and add up to w = 256 * twice the area <= 2^40. Relative to a.z
// the sum is at most 2^16 * w <= 2^56 in magnitude, so that with 2^16 * w added it is from 0 to
// 2^57. One more bit than is kept is divided out, to round.
inline int32_t height_in_triangle(Vertex a, Vertex b, Vertex c, FinePoint p) {
  const Point pa{a.x, a.y}, pb{b.x, b.y}, pc{c.x, c.y};
  const int64_t w = orient2d(pa, pb, pc) * 256;
  const int64_t weight_b = orient_fine(pc, pa, p);
  const int64_t weight_c = orient_fine(pa, pb, p);
  const int64_t sum =
      weight_b * (static_cast<int32_t>(b.z) - a.z) + weight_c * (static_cast<int32_t>(c.z) - a.z);
  const uint64_t raised = static_cast<uint64_t>(sum + w * 65536);
  const uint64_t rounded = (divide_finely(raised, static_cast<uint64_t>(w)) + 1) >> 1;
  return static_cast<int32_t>(static_cast<int64_t>(rounded) +
                              (static_cast<int64_t>(a.z) - 65536) * 65536);
}

}  // namespace microtin


namespace microtin {

// Positive if p lies to the left of a half-edge, negative if to the right; `next` is the half-edge
// after it, and both start at finite vertices.
inline int64_t side_of(const Mesh& mesh, Index half_edge, Index next, FinePoint p) {
  return orient_fine(point_of(mesh, mesh.origin[half_edge]), point_of(mesh, mesh.origin[next]), p);
}

// Walks from *triangle to the triangle that holds p, through at most `step_limit` triangles:
// crosses any edge that p lies beyond. *triangle becomes where the walk ended, a ghost if p is
// outside the hull; false if the steps did not suffice.
//
// mesh.triangles steps always suffice, also in several calls. Lift the vertices to the paraboloid,
// with the infinitesimals of conflicts_on_circle: the triangles become facets of a strictly convex
// surface, and each step makes the facet's plane higher above p. So no triangle is met twice
// (Edelsbrunner, "An acyclicity theorem for cell complexes in d dimensions", 1990).
bool walk_to(const Mesh& mesh, FinePoint p, uint32_t step_limit, Index* triangle);

}  // namespace microtin


// The box is divided into side x side buckets of equal size, row by row from the south-west.
struct microtin_buckets {
  uint16_t west, south, width, height;  // of the vertices' box, in lattice steps
  uint32_t x_scale, y_scale;            // buckets per lattice step, 16 fractional bits
  uint32_t side;
};

static_assert(sizeof(microtin_buckets) <= MICROTIN_BUCKETS_BYTES(0), "see MICROTIN_BUCKETS_BYTES");

namespace microtin {
namespace {

constexpr uint32_t kMostSide = 1024;

Index* triangles_of(microtin_buckets* buckets) {
  return reinterpret_cast<Index*>(buckets + 1);
}

uint32_t side_of(size_t size) {
  uint32_t side = 0;
  while (side < kMostSide && MICROTIN_BUCKETS_BYTES(side + 1) <= size) ++side;
  return side;
}

// Lattice steps that an extent covers, both ends counted.
uint32_t steps_of(uint16_t extent) {
  return static_cast<uint32_t>(extent) + 1u;
}

void measure(microtin_buckets& buckets, const Mesh& mesh) {
  uint16_t west = kLatticeMax, south = kLatticeMax, east = 0, north = 0;
  for (Index v = 0; v < mesh.vertices; ++v) {
    const Point p = point_of(mesh, v);
    if (p.x < west) west = p.x;
    if (p.x > east) east = p.x;
    if (p.y < south) south = p.y;
    if (p.y > north) north = p.y;
  }
  buckets.west = west;
  buckets.south = south;
  buckets.width = static_cast<uint16_t>(east - west);
  buckets.height = static_cast<uint16_t>(north - south);
  buckets.x_scale = (buckets.side << 16) / steps_of(buckets.width);
  buckets.y_scale = (buckets.side << 16) / steps_of(buckets.height);
}

// The middle of bucket i along an axis, with 8 fractional bits, in whole steps.
int32_t middle(uint32_t i, uint32_t side, uint16_t start, uint16_t extent) {
  const uint32_t steps = (2 * i + 1) * steps_of(extent) / (2 * side);  // the product is below 2^27
  return static_cast<int32_t>((start + steps) * 256);
}

// To and fro, so that each walk starts beside where it ends.
void fill(microtin_buckets* buckets, const Mesh& mesh) {
  const uint32_t side = buckets->side;
  Index t = 0;
  for (uint32_t row = 0; row < side; ++row) {
    const int32_t y = middle(row, side, buckets->south, buckets->height);
    for (uint32_t i = 0; i < side; ++i) {
      const uint32_t column = row % 2 == 0 ? i : side - 1 - i;
      const int32_t x = middle(column, side, buckets->west, buckets->width);
      if (mesh.triangles != 0) walk_to(mesh, FinePoint{x, y}, mesh.triangles, &t);
      triangles_of(buckets)[row * side + column] = t;
    }
  }
}

// The number along an axis of the bucket that holds a coordinate, or of the one nearest to it.
uint32_t bucket_of(int32_t fine, uint16_t start, uint16_t extent, uint32_t scale) {
  const int32_t steps = (fine < 0 ? 0 : fine >> 8) - start;
  if (steps < 0) return 0;
  return ((steps < extent ? static_cast<uint32_t>(steps) : extent) * scale) >> 16;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_buckets_init(void* workspace, size_t size, const microtin_mesh* mesh,
                                      microtin_buckets** buckets) {
  if (workspace == nullptr || mesh == nullptr || buckets == nullptr) return MICROTIN_ARGUMENT;
  *buckets = nullptr;
  if (reinterpret_cast<uintptr_t>(workspace) % MICROTIN_ALIGNMENT != 0) return MICROTIN_MISALIGNED;
  const uint32_t side = side_of(size);
  if (side == 0) return MICROTIN_WORKSPACE_TOO_SMALL;
  microtin_buckets& b = *static_cast<microtin_buckets*>(workspace);
  b.side = side;
  measure(b, mesh->mesh);
  fill(&b, mesh->mesh);
  *buckets = &b;
  return MICROTIN_DONE;
}

uint32_t microtin_buckets_hint(const microtin_buckets* buckets, int32_t x, int32_t y) {
  const microtin_buckets& b = *buckets;
  const uint32_t column = bucket_of(x, b.west, b.width, b.x_scale);
  const uint32_t row = bucket_of(y, b.south, b.height, b.y_scale);
  return reinterpret_cast<const Index*>(buckets + 1)[row * b.side + column];
}
// --- decoder/decoder.cpp
// The push decoder: header, sections, steps.
// --- shared/header.hpp
// Reading the header, and the numbers of variable length in it.


namespace microtin {

// Whether the first bytes are those of a stream that this code can read.
inline microtin_status check_identity(const uint8_t* identity) {
  for (uint32_t i = 0; i < sizeof kMagic; ++i) {
    if (identity[i] != read_table(kMagic + i)) return MICROTIN_BAD_MAGIC;
  }
  return identity[4] == kVersion ? MICROTIN_DONE : MICROTIN_UNSUPPORTED_VERSION;
}

// Takes a byte into a length, 0 before the first: seven bits a byte, high ones first, the top bit
// set if more follow. True if more do. A length of more than 31 bits, or not in its shortest form,
// ends where that shows, counts as 0 and is not legal.
inline bool take_length(uint32_t* length, uint8_t byte, bool* legal) {
  *legal = *length >> 24 == 0 && (*length != 0 || byte != 128);
  *length = *legal ? *length << 7 | (byte & 127u) : 0;
  return *legal && byte >= 128;
}

// A number in groups of seven bits, as lengths are. False if it is longer than `bytes`, not in its
// shortest form, or above 64 bits.
inline bool read_varint(const uint8_t** bytes, const uint8_t* end, uint64_t* value) {
  *value = 0;
  while (*bytes != end) {
    const uint8_t byte = *(*bytes)++;
    if (*value >> 57 != 0 || (*value == 0 && byte == 128)) return false;
    *value = *value << 7 | (byte & 127u);
    if (byte < 128) return true;
  }
  return false;
}

// A numerator or denominator: 1 .. 2^40 - 1.
inline bool read_step(const uint8_t** bytes, const uint8_t* end, uint64_t* value) {
  return read_varint(bytes, end, value) && *value != 0 && *value >> 40 == 0;
}

// Number by number: on AVR a constant to copy from would be in RAM.
inline void place_on_lattice(microtin_axis* axis) {
  for (int i = 0; i < 3; ++i) {
    axis[i].offset = 0;
    axis[i].numerator = 1;
    axis[i].denominator = 1;
  }
}

// A placement: for x, y and z the offset (zigzag), numerator and denominator. What is not legal
// leaves `axis` on the lattice itself.
inline bool read_placement(const uint8_t** bytes, const uint8_t* end, microtin_axis* axis) {
  for (int i = 0; i < 3; ++i) {
    uint64_t offset = 0;
    if (!read_varint(bytes, end, &offset) || !read_step(bytes, end, &axis[i].numerator) ||
        !read_step(bytes, end, &axis[i].denominator)) {
      place_on_lattice(axis);
      return false;
    }
    const int64_t half = static_cast<int64_t>(offset >> 1);
    axis[i].offset = (offset & 1u) != 0 ? -half - 1 : half;
  }
  return true;
}

// Reads a header's payload up to its notes. False if it breaks a rule of the format. Then, and
// without a placement, `axis` is on the lattice itself.
inline bool read_header(const uint8_t** bytes, const uint8_t* end, Contract* contract,
                        microtin_axis* axis) {
  uint64_t number[4];  // properties, vertices, x_max, y_max
  bool legal = true;
  for (int i = 0; i < 4; ++i) legal = legal && read_varint(bytes, end, number + i);
  place_on_lattice(axis);
  if (!legal) return false;
  const uint32_t properties = static_cast<uint32_t>(number[0]);
  contract->has_heights = (properties & kHasHeights) != 0;
  contract->has_voids = (properties & kHasVoids) != 0;
  contract->levels = properties >> 3 & 3u;
  contract->degree = properties >> 5;
  contract->vertices = static_cast<uint32_t>(number[1]);
  contract->x_max = static_cast<uint16_t>(number[2]);
  contract->y_max = static_cast<uint16_t>(number[3]);
  if ((properties & kHasPlacement) != 0) legal = read_placement(bytes, end, axis);
  return legal && number[0] >> 11 == 0 && contract->degree >= kMinDegree &&
         contract->degree <= kMaxDegree && contract->levels >= 1 && number[1] >= 3 &&
         number[1] <= kMaxVertices && number[2] <= kLatticeMax && number[3] <= kLatticeMax;
}

}  // namespace microtin


namespace microtin {
namespace {

template <class Size>
Size smaller(Size a, Size b) {
  return a < b ? a : b;
}

static_assert(kHeaderMostBytes <= sizeof(ByteWindow::bytes), "a header fits up to its notes");

// Bytes that must be at hand before the next item can be handled as a whole.
uint32_t bytes_needed(const microtin_decoder& d) {
  uint32_t most = 1;
  switch (d.item) {
    case Item::kIdentity:
      return kIdentityBytes;
    case Item::kLength:
      return 1;
    case Item::kCheck:
      return kCheckBytes;
    case Item::kHeader:
      most = kHeaderMostBytes;
      break;
    case Item::kPayloadStart:
      most = 4;
      break;
    case Item::kStep:
      most = kStepBytes;
      break;
    case Item::kRest:
      break;
  }
  return smaller(d.coder.payload_left, most);
}

// Whatever is wrong is told once the check ahead has passed: before, it is damage.
MICROTIN_OUT_OF_LINE void note_malformed(microtin_decoder& d) {
  d.verdict = MICROTIN_MALFORMED;
}

// The length of the header, or of a section, comes next.
void expect_length(microtin_decoder& d) {
  d.coder.payload_left = 0;
  d.item = Item::kLength;
}

microtin_status handle_identity(microtin_decoder& d) {
  const uint8_t* const identity = d.coder.window.next;
  d.coder.window.skip(kIdentityBytes);
  const microtin_status known = check_identity(identity);
  if (known != MICROTIN_DONE) return known;
  expect_length(d);
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_length(microtin_decoder& d) {
  bool legal = true;
  const bool more = take_length(&d.coder.payload_left, d.coder.window.take(), &legal);
  if (!legal) note_malformed(d);
  if (!more) d.item = d.in_header ? Item::kHeader : Item::kPayloadStart;
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_header(microtin_decoder& d) {
  ByteWindow& window = d.coder.window;
  const uint8_t* end = window.next;
  if (!read_header(&end, end + smaller(d.coder.payload_left, kHeaderMostBytes),
                   &d.reconstruction.contract, d.mesh->axis)) {
    note_malformed(d);
  }
  const uint32_t size = static_cast<uint32_t>(end - window.next);
  window.skip(size);
  d.coder.payload_left -= size;
  d.item = Item::kRest;
  return MICROTIN_NEED_INPUT;
}

microtin_status end_payload(microtin_decoder& d, bool legal) {
  if (!legal || d.coder.payload_left != 0) note_malformed(d);
  d.item = Item::kRest;
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_payload_start(microtin_decoder& d) {
  d.coder.begin();
  d.item = Item::kStep;
  const bool legal = d.verdict == MICROTIN_DONE && !d.coder.overrun;
  return legal ? MICROTIN_NEED_INPUT : end_payload(d, false);
}

// Whether the phase after which decoding is to stop is complete.
bool is_far_enough(const microtin_decoder& d) {
  return d.stop_phase != 0 && d.reconstruction.phase >= d.stop_phase;
}

// As many steps as surely find their bytes at hand.
microtin_status handle_steps(microtin_decoder& d, uint32_t* steps_left) {
  while (*steps_left != 0) {
    --*steps_left;
    const Progress progress = step(d.reconstruction, d.coder);
    if (progress == Progress::kMalformed || d.coder.overrun) return end_payload(d, false);
    if (progress == Progress::kSectionEnd) return end_payload(d, true);
    if (progress == Progress::kPhaseEnd && d.reconstruction.stage == Stage::kPhase &&
        is_far_enough(d)) {
      return MICROTIN_STOPPED;
    }
    if (d.coder.window.left < kStepBytes) return MICROTIN_NEED_INPUT;
  }
  return MICROTIN_STEP_LIMIT;
}

// Takes what is at hand of the bytes that are not read.
microtin_status handle_rest(microtin_decoder& d) {
  const uint32_t taken = smaller(static_cast<uint32_t>(d.coder.window.left), d.coder.payload_left);
  d.coder.window.skip(taken);
  d.coder.payload_left -= taken;
  if (d.coder.payload_left == 0) d.item = Item::kCheck;
  return MICROTIN_NEED_INPUT;
}

microtin_status end_header(microtin_decoder& d) {
  const uint32_t vertices = d.reconstruction.contract.vertices;
  if (vertices > d.capacity || vertices > d.mesh->capacity) return MICROTIN_TOO_BIG;
  start(d.reconstruction);
  d.in_header = false;
  return MICROTIN_NEED_INPUT;
}

microtin_status end_section(microtin_decoder& d) {
  d.mesh->verified_vertices = d.mesh->mesh.vertices;
  if (d.reconstruction.stage == Stage::kComplete) {
    d.mesh->has_voids = d.reconstruction.contract.has_voids;
    return MICROTIN_DONE;
  }
  return is_far_enough(d) ? MICROTIN_STOPPED : MICROTIN_NEED_INPUT;
}

// Of all since the last check.
microtin_status handle_check(microtin_decoder& d) {
  ByteWindow& window = d.coder.window;
  window.skip(kCheckBytes);
  window.settle();
  const bool passes = window.crc == kCheckedCrc;
  window.crc = 0;
  if (!passes) return MICROTIN_CHECKSUM;
  if (d.verdict != MICROTIN_DONE) return d.verdict;
  expect_length(d);
  return d.in_header ? end_header(d) : end_section(d);
}

// NEED_INPUT means: go on.
MICROTIN_ONE_COPY microtin_status handle_item(microtin_decoder& d, uint32_t* steps_left) {
  switch (d.item) {
    case Item::kIdentity:
      return handle_identity(d);
    case Item::kLength:
      return handle_length(d);
    case Item::kHeader:
      return handle_header(d);
    case Item::kPayloadStart:
      return handle_payload_start(d);
    case Item::kStep:
      return handle_steps(d, steps_left);
    case Item::kRest:
      return handle_rest(d);
    case Item::kCheck:
      break;
  }
  return handle_check(d);
}

microtin_status feed(microtin_decoder& d, const uint8_t* bytes, size_t size, uint32_t step_limit,
                     size_t* used) {
  ByteWindow& window = d.coder.window;
  uint32_t steps_left = step_limit == 0 ? 0xFFFFFFFFu : step_limit;
  microtin_status status = MICROTIN_NEED_INPUT;
  while (status == MICROTIN_NEED_INPUT) {
    while (window.left < bytes_needed(d)) {
      if (*used == size) return MICROTIN_NEED_INPUT;
      *used += window.fill(bytes + *used, size - *used);
    }
    status = handle_item(d, &steps_left);
  }
  // What is left came in this call, as no item asks for more than the stream has, but for what an
  // earlier call brought.
  const size_t returned = smaller<size_t>(window.left, *used);
  window.left -= returned;
  *used -= returned;
  return status;
}

// How many vertices a workspace holds, of which `fixed` bytes and `per_four` bytes for four,
// rounded up, are needed.
MICROTIN_ONE_COPY microtin_status capacity_of(const void* workspace, size_t size, uint32_t fixed,
                                              uint32_t per_four, uint32_t* capacity) {
  if (reinterpret_cast<uintptr_t>(workspace) % MICROTIN_ALIGNMENT != 0) return MICROTIN_MISALIGNED;
  const uint32_t most = MICROTIN_MAX_VERTICES, enough = fixed + per_four * ((most + 3) / 4);
  const uint32_t bytes = size < enough ? static_cast<uint32_t>(size) : enough;
  *capacity = bytes < fixed ? 0 : smaller((bytes - fixed) * 4 / per_four, most);
  return *capacity < 3 ? MICROTIN_WORKSPACE_TOO_SMALL : MICROTIN_DONE;
}

// A size, or the largest where size_t is too narrow for it.
size_t saturated(unsigned long size) {
  const size_t most = ~static_cast<size_t>(0);
  return size < most ? static_cast<size_t>(size) : most;
}

constexpr uint32_t kMeshFixed = MICROTIN_MESH_BYTES(0);
constexpr uint32_t kMeshPerFour = MICROTIN_MESH_BYTES(4) - kMeshFixed;
constexpr uint32_t kDecoderFixed = MICROTIN_DECODER_BYTES(0);
constexpr uint32_t kDecoderPerFour = MICROTIN_DECODER_BYTES(4) - kDecoderFixed;

static_assert(uint64_t{kMeshPerFour} * (MICROTIN_MAX_VERTICES + 3) <= UINT32_MAX &&
                  kDecoderPerFour <= kMeshPerFour,
              "products of capacity_of fit");

MICROTIN_ONE_COPY void empty_mesh(microtin_mesh& m) {
  m.mesh.vertices = 0;
  m.mesh.triangles = 0;
  m.verified_vertices = 0;
  m.has_voids = false;
  place_on_lattice(m.axis);
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_mesh_init(void* workspace, size_t size, microtin_mesh** mesh) {
  if (workspace == nullptr || mesh == nullptr) return MICROTIN_ARGUMENT;
  *mesh = nullptr;
  uint32_t capacity = 0;
  const microtin_status status = capacity_of(workspace, size, kMeshFixed, kMeshPerFour, &capacity);
  if (status != MICROTIN_DONE) return status;
  microtin_mesh& m = *static_cast<microtin_mesh*>(workspace);
  // Widest numbers first, so that everything is aligned.
  const size_t half_edges = 6 * static_cast<size_t>(capacity);
  m.mesh.origin = reinterpret_cast<Index*>(&m + 1);
  m.mesh.twin = m.mesh.origin + half_edges;
  m.mesh.place = reinterpret_cast<Point*>(m.mesh.twin + half_edges);
  m.mesh.z = reinterpret_cast<int16_t*>(m.mesh.place + capacity);
  m.voids = reinterpret_cast<uint8_t*>(m.mesh.z + capacity);
  m.capacity = capacity;
  empty_mesh(m);
  *mesh = &m;
  return MICROTIN_DONE;
}

microtin_status microtin_decoder_init(void* workspace, size_t size, microtin_mesh* mesh,
                                      microtin_decoder** decoder) {
  if (workspace == nullptr || mesh == nullptr || decoder == nullptr) return MICROTIN_ARGUMENT;
  *decoder = nullptr;
  uint32_t capacity = 0;
  const microtin_status status =
      capacity_of(workspace, size, kDecoderFixed, kDecoderPerFour, &capacity);
  if (status != MICROTIN_DONE) return status;
  microtin_decoder& d = *static_cast<microtin_decoder*>(workspace);
  d.mesh = mesh;
  d.capacity = capacity;
  d.status = MICROTIN_NEED_INPUT;
  d.stop_phase = 0;
  d.verdict = MICROTIN_DONE;
  d.item = Item::kIdentity;
  d.in_header = true;
  d.coder.window.next = d.coder.window.bytes;
  d.coder.window.left = 0;
  d.coder.window.crc = 0;
  d.coder.window.used = 0;
  Reconstruction& r = d.reconstruction;
  r.mesh = &mesh->mesh;
  r.voids = mesh->voids;
  r.queue = reinterpret_cast<Index*>(&d + 1);
  r.marks = reinterpret_cast<uint8_t*>(r.queue + capacity);
  r.residual = reinterpret_cast<Residual*>(r.marks + (capacity + 3) / 4);
  r.phase = 0;
  empty_mesh(*mesh);
  *decoder = &d;
  return MICROTIN_DONE;
}

void microtin_stop_after_phase(microtin_decoder* decoder, uint32_t phase) {
  decoder->stop_phase = phase;
}

microtin_status microtin_feed(microtin_decoder* decoder, const uint8_t* bytes, size_t size,
                              uint32_t step_limit, size_t* used) {
  if (decoder == nullptr || used == nullptr || (bytes == nullptr && size != 0)) {
    return MICROTIN_ARGUMENT;
  }
  *used = 0;
  if (decoder->status != MICROTIN_NEED_INPUT) return decoder->status;
  const microtin_status status = feed(*decoder, bytes, size, step_limit, used);
  if (status != MICROTIN_STEP_LIMIT) decoder->status = status;
  return status;
}

microtin_status microtin_finish(microtin_decoder* decoder) {
  if (decoder == nullptr) return MICROTIN_ARGUMENT;
  if (decoder->status == MICROTIN_NEED_INPUT) decoder->status = MICROTIN_TRUNCATED;
  return decoder->status;
}

uint32_t microtin_phase(const microtin_decoder* decoder) {
  return decoder->reconstruction.phase;
}

uint64_t microtin_bytes_used(const microtin_decoder* decoder) {
  return decoder->coder.window.taken();
}

microtin_status microtin_peek(const uint8_t* bytes, size_t size, microtin_info* info) {
  if (info == nullptr || (bytes == nullptr && size != 0)) return MICROTIN_ARGUMENT;
  info->header_bytes = 0;
  if (size < kIdentityBytes) return MICROTIN_NEED_INPUT;
  const microtin_status known = check_identity(bytes);
  if (known != MICROTIN_DONE) return known;
  const uint8_t* next = bytes + kIdentityBytes;
  uint32_t length = 0;
  bool legal = true, more = true;
  while (more && next != bytes + size) more = take_length(&length, *next++, &legal);
  if (more) return MICROTIN_NEED_INPUT;
  const uint32_t checked = static_cast<uint32_t>(next - bytes) + length;  // length < 2^31
  info->header_bytes = checked + kCheckBytes;
  if (size < info->header_bytes) return MICROTIN_NEED_INPUT;
  if (crc32(0, bytes, static_cast<size_t>(info->header_bytes)) != kCheckedCrc) {
    return MICROTIN_CHECKSUM;
  }
  Contract contract;
  microtin_axis axis[3];
  if (!legal || !read_header(&next, bytes + checked, &contract, axis)) return MICROTIN_MALFORMED;
  info->vertices = contract.vertices;
  info->version = kVersion;
  info->degree = static_cast<uint8_t>(contract.degree);
  info->levels = static_cast<uint8_t>(contract.levels);
  info->has_heights = contract.has_heights;
  info->has_voids = contract.has_voids;
  info->x = axis[0];
  info->y = axis[1];
  info->z = axis[2];
  info->mesh_bytes = saturated(MICROTIN_MESH_BYTES(contract.vertices));
  info->decoder_bytes = saturated(MICROTIN_DECODER_BYTES(contract.vertices));
  return MICROTIN_DONE;
}
// --- decoder/pack.cpp
// Reading packs: which tiles are wanted, which are there, and bringing the one to the other.
// --- decoder/pack_state.hpp
// What the workspace of a pack holds.

// --- decoder/touched_tiles.hpp
// The tiles that a course may touch, from where it begins.

// --- shared/pack_format.hpp
// A pack: many tiles of one terrain in a file. PACK.md explains it.


namespace microtin {

constexpr uint8_t kPackMagic[4] MICROTIN_IN_FLASH = {'m', 't', 'p', 'k'};
constexpr uint8_t kPackVersion = 2;
constexpr uint32_t kPackFixedBytes = 32;
constexpr uint32_t kPackEntryBytes = 28;
constexpr uint32_t kPackExtentMost = 0x7FFFFFFF;

// The parts of a terrain: rectangles of one size, those in the last column and row cut off at the
// largest x and y. Coordinates are global; neighbours share their border.
struct TileGrid {
  uint32_t x_max, y_max;   // 1 .. 2^31 - 1
  uint16_t width, height;  // 1 .. 65535
};

inline uint32_t tile_columns(const TileGrid& grid) {
  return (grid.x_max - 1) / grid.width + 1;
}

inline uint32_t tile_rows(const TileGrid& grid) {
  return (grid.y_max - 1) / grid.height + 1;
}

// The closed rectangle of a tile.
struct TileBox {
  uint32_t x, y;          // the first corner
  uint32_t x_end, y_end;  // the last one
};

inline TileBox tile_box(const TileGrid& grid, uint32_t tile) {
  const uint32_t columns = tile_columns(grid);
  TileBox box;
  box.x = tile % columns * grid.width;  // < x_max, so the sums below stay under 2^32
  box.y = tile / columns * grid.height;
  box.x_end = box.x + grid.width < grid.x_max ? box.x + grid.width : grid.x_max;
  box.y_end = box.y + grid.height < grid.y_max ? box.y + grid.height : grid.y_max;
  return box;
}

// What a pack's header says, up to its notes.
struct PackHeader {
  TileGrid grid;
  uint32_t most_vertices;    // of a tile
  int16_t lowest, highest;   // vertices of all tiles
  uint32_t placement_bytes;  // at most 66
  uint32_t note_bytes;       // at most 65535
};

inline uint32_t pack_index_start(const PackHeader& header) {
  return kPackFixedBytes + header.placement_bytes + header.note_bytes + kCheckBytes;
}

// Where the entry of a tile is: below 2^37.
inline uint64_t pack_entry_start(const PackHeader& header, uint32_t tile) {
  return pack_index_start(header) + static_cast<uint64_t>(tile) * kPackEntryBytes;
}

inline int16_t read_i16(const uint8_t* p) {
  const uint32_t value = read_u16(p);
  return static_cast<int16_t>(value < 0x8000 ? static_cast<int32_t>(value)
                                             : static_cast<int32_t>(value) - 0x10000);
}

inline microtin_status check_pack_identity(const uint8_t* bytes) {
  for (uint32_t i = 0; i < sizeof kPackMagic; ++i) {
    if (bytes[i] != read_table(kPackMagic + i)) return MICROTIN_BAD_MAGIC;
  }
  return bytes[4] == kPackVersion ? MICROTIN_DONE : MICROTIN_UNSUPPORTED_VERSION;
}

// Reads the fixed part of a known identity. False if it breaks a rule.
inline bool read_pack_header(const uint8_t* bytes, PackHeader* header) {
  TileGrid& grid = header->grid;
  header->placement_bytes = bytes[6];
  header->note_bytes = read_u16(bytes + 8);
  grid.width = static_cast<uint16_t>(read_u16(bytes + 10));
  grid.height = static_cast<uint16_t>(read_u16(bytes + 12));
  header->lowest = read_i16(bytes + 14);
  header->highest = read_i16(bytes + 16);
  grid.x_max = read_u32(bytes + 20);
  grid.y_max = read_u32(bytes + 24);
  header->most_vertices = read_u32(bytes + 28);
  const bool reserved = (bytes[5] | bytes[7] | bytes[18] | bytes[19]) != 0;
  return !reserved && header->placement_bytes <= kPlacementMostBytes && grid.width != 0 &&
         grid.height != 0 && grid.x_max != 0 && grid.x_max <= kPackExtentMost && grid.y_max != 0 &&
         grid.y_max <= kPackExtentMost && header->most_vertices <= kMaxVertices &&
         static_cast<uint64_t>(tile_columns(grid)) * tile_rows(grid) <= 0xFFFFFFFF;
}

// The placement behind the fixed part, which must fill its bytes.
inline bool read_pack_placement(const uint8_t* placement, const PackHeader& header,
                                microtin_axis* axis) {
  const uint8_t* next = placement;
  const uint8_t* const end = next + header.placement_bytes;
  return read_placement(&next, end, axis) && next == end;
}

// What the index says of a tile.
struct PackEntry {
  uint64_t offset;  // of its stream in the file, below 2^40
  uint32_t size;    // bytes of the stream, below 2^24; 0: there is no terrain
  uint32_t vertices;
  int16_t lowest, highest;    // vertices
  uint32_t max_error;         // in 1/256 of a z step, rounded up; 65535: that much or more
  uint32_t root_mean_square;  // alike
  uint32_t stream_hash;       // FNV-1a of the stream
};

// False if it breaks a rule.
inline bool read_pack_entry(const uint8_t* bytes, const PackHeader& header, PackEntry* entry) {
  entry->offset = read_u32(bytes) | static_cast<uint64_t>(bytes[4]) << 32;
  entry->size = read_u16(bytes + 5) | static_cast<uint32_t>(bytes[7]) << 16;
  entry->vertices = read_u16(bytes + 8) | static_cast<uint32_t>(bytes[10]) << 16;
  entry->lowest = read_i16(bytes + 12);
  entry->highest = read_i16(bytes + 14);
  entry->max_error = read_u16(bytes + 16);
  entry->root_mean_square = read_u16(bytes + 18);
  entry->stream_hash = read_u32(bytes + 20);
  uint32_t used = bytes[11];
  if (entry->size != 0) return used == 0 && entry->vertices <= header.most_vertices;
  for (uint32_t i = 0; i < kPackEntryBytes - kCheckBytes; ++i) used |= bytes[i];
  return used == 0;
}

// FNV-1a: tells which stream it is. A CRC-32 could not: over bytes that hold their own CRC-32, as
// those of streams do, it depends on their number alone. Feed kStreamHash first, then each result.
constexpr uint32_t kStreamHash = 0x811C9DC5;

inline uint32_t stream_hash(uint32_t hash, const uint8_t* bytes, size_t size) {
  for (size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x01000193u;
  return hash;
}

// The check of an entry starts from the header's check and the tile's number, so that an entry of
// another tile or pack does not pass.
inline uint32_t pack_entry_check(uint32_t header_check, uint32_t tile, const uint8_t* bytes) {
  uint8_t place[4];
  for (uint32_t i = 0; i < 4; ++i) place[i] = static_cast<uint8_t>(tile >> 8 * i);
  return crc32(crc32(header_check, place, 4), bytes, kPackEntryBytes - kCheckBytes);
}

}  // namespace microtin


namespace microtin {

constexpr int64_t kCourseMost = static_cast<int64_t>(1) << 40;
constexpr int64_t kCourseLongest = static_cast<int64_t>(1) << 24;

inline bool is_legal(const microtin_course& c) {
  const int64_t ends[4] = {c.x, c.y, c.x_end, c.y_end};
  for (int i = 0; i < 4; ++i) {
    if (ends[i] > kCourseMost || ends[i] < -kCourseMost) return false;
  }
  const int64_t dx = c.x_end - c.x, dy = c.y_end - c.y;
  return dx < kCourseLongest && dx > -kCourseLongest && dy < kCourseLongest && dy > -kCourseLongest;
}

// The tiles whose closed boxes a legal course meets, row by row from where it begins. Looks at no
// more than twice as many boxes as its bounding box has columns and rows, together.
class TouchedTiles {
 public:
  TouchedTiles(const TileGrid& grid, const microtin_course& course)
      : grid_(grid),
        course_(course),
        columns_(slices(course.x, course.x_end, grid.width, grid.x_max)),
        rows_(slices(course.y, course.y_end, grid.height, grid.y_max)),
        rises_right_((course.x_end < course.x) == (course.y_end < course.y)),
        column_(columns_.from),
        row_(rows_.from),
        first_(columns_.from),
        is_met_(false),
        at_end_(columns_.none || rows_.none) {
    seek();
  }

  bool at_end() const { return at_end_; }
  uint32_t number() const { return row_ * tile_columns(grid_) + column_; }
  TileBox box() const { return tile_box(grid_, number()); }

  void next() {
    if (!is_met_) first_ = column_;
    is_met_ = true;
    step();
    seek();
  }

 private:
  enum class Side { kLeft, kOn, kRight };

  // Where a box is, seen along the course. Its corners are within 2^25 of the beginning, the end
  // within 2^24: products stay below 2^50.
  Side side() const {
    const TileBox b = box();
    const int64_t left = static_cast<int64_t>(b.x) * 256 - course_.x,
                  right = static_cast<int64_t>(b.x_end) * 256 - course_.x,
                  below = static_cast<int64_t>(b.y) * 256 - course_.y,
                  above = static_cast<int64_t>(b.y_end) * 256 - course_.y;
    const int64_t dx = course_.x_end - course_.x, dy = course_.y_end - course_.y;
    const int64_t corner[4] = {dx * below - dy * left, dx * below - dy * right,
                               dx * above - dy * left, dx * above - dy * right};
    bool some_left = false, some_right = false;
    for (int i = 0; i < 4; ++i) {
      some_left = some_left || corner[i] >= 0;
      some_right = some_right || corner[i] <= 0;
    }
    return !some_left ? Side::kRight : some_right ? Side::kOn : Side::kLeft;
  }

  // To a box that the course meets. A row's are neighbours: those before them are on one side of
  // the course, those behind on the other.
  void seek() {
    const Side behind = rises_right_ ? Side::kRight : Side::kLeft;
    while (!at_end_) {
      const Side here = side();
      if (here == Side::kOn) return;
      if (here == behind) {
        next_row();
      } else {
        step();
      }
    }
  }

  // Where a whole row lies before the course, all that follow do, too.
  void step() {
    if (column_ != columns_.to) {
      column_ = columns_.after(column_);
    } else if (is_met_) {
      next_row();
    } else {
      at_end_ = true;
    }
  }

  // A course never turns back: no box of the next row lies before the first of this one.
  void next_row() {
    column_ = first_;
    is_met_ = false;
    at_end_ = row_ == rows_.to;
    if (!at_end_) row_ = rows_.after(row_);
  }

  // Columns or rows, in the direction of the course.
  struct Slices {
    uint32_t from, to;
    bool none;

    uint32_t after(uint32_t i) const { return from < to ? i + 1 : i - 1; }
  };

  static Slices slices(int64_t begin, int64_t end, uint32_t size, uint32_t most) {
    const int64_t limit = static_cast<int64_t>(most) * 256;
    int64_t low = begin < end ? begin : end, high = begin < end ? end : begin;
    if (high < 0 || low > limit) return Slices{0, 0, true};
    if (low < 0) low = 0;
    if (high > limit) high = limit;
    uint32_t first = static_cast<uint32_t>(low >> 8) / size;
    if (first != 0 && static_cast<int64_t>(first) * size * 256 == low) --first;
    const uint32_t reached = static_cast<uint32_t>(high >> 8) / size, final = (most - 1) / size;
    const uint32_t last = reached < final ? reached : final;
    return begin <= end ? Slices{first, last, false} : Slices{last, first, false};
  }

  const TileGrid& grid_;
  const microtin_course& course_;
  Slices columns_, rows_;
  bool rises_right_;  // or falls left: along a row the boxes to the left of the course come first
  uint32_t column_, row_;
  uint32_t first_;  // column of the first box met in this row, or in the last one that has any
  bool is_met_;     // a box of this row is among them
  bool at_end_;
};

}  // namespace microtin


namespace microtin {

constexpr uint32_t kPackBuffer = 128;  // holds every item of the header but the notes

// What is read next.
enum class PackStage : uint8_t { kFixed, kPlacement, kNotes, kCheck, kIdle, kEntry, kStream };

enum class SlotState : uint8_t { kEmpty, kReady };

// A tile that is there, or room for one.
struct PackSlot {
  microtin_mesh* mesh;  // empty: the tile has no terrain
  uint32_t tile;
  uint32_t wanted;           // when it was wanted last
  volatile SlotState state;  // queries may look only if it is ready
};

}  // namespace microtin

struct microtin_pack {
  uint8_t* decoder_space;
  size_t decoder_bytes;
  microtin::PackSlot* slots;
  uint32_t capacity;  // vertices of a slot
  uint8_t slot_count;
  volatile bool has_header;
  microtin::PackStage stage;
  uint8_t slot;  // being filled
  microtin::PackHeader header;
  microtin_axis axis[3];
  uint32_t crc;  // of the header so far, or its check
  uint32_t clock;
  // The tile being read.
  uint32_t tile;
  microtin::PackEntry entry;
  microtin_decoder* decoder;
  uint32_t stream_hash;
  uint32_t left;  // bytes of notes or stream, those in the buffer too until they are counted
  // The next bytes wanted, and those that came.
  uint64_t next;
  uint8_t wanted, buffered, fed;
  bool is_counted;
  uint8_t buffer[microtin::kPackBuffer];
};

static_assert(sizeof(microtin_pack) + 7 + MICROTIN_PACK_ROUND(MICROTIN_DECODER_BYTES(0)) <=
                  MICROTIN_PACK_BYTES(0, 0),
              "see MICROTIN_PACK_BYTES");
static_assert(sizeof(microtin::PackSlot) <= 24, "see MICROTIN_PACK_BYTES");
static_assert(sizeof(microtin_pack) % alignof(microtin::PackSlot) == 0, "slots follow it");

namespace microtin {

// The slot where a tile is; slot_count if it is not there.
inline uint32_t slot_of(const microtin_pack& p, uint32_t tile) {
  for (uint32_t i = 0; i < p.slot_count; ++i) {
    if (p.slots[i].state == SlotState::kReady && p.slots[i].tile == tile) return i;
  }
  return p.slot_count;
}

}  // namespace microtin


namespace microtin {
namespace {

void want(microtin_pack& p, PackStage stage, uint64_t offset, uint32_t size) {
  p.stage = stage;
  p.next = offset;
  p.buffered = 0;
  p.fed = 0;
  p.is_counted = false;
  p.wanted = static_cast<uint8_t>(size < kPackBuffer ? size : kPackBuffer);
}

// Queries do not look at an empty slot, so the order of these writes matters to those that
// interrupt.
void set_state(PackSlot& slot, SlotState state) {
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
  slot.state = state;
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
}

// Gives up what is in hand; begins again with the header if that is not known.
void give_up(microtin_pack& p) {
  if (p.has_header) {
    want(p, PackStage::kIdle, 0, 0);
    return;
  }
  place_on_lattice(p.axis);
  want(p, PackStage::kFixed, 0, kPackFixedBytes);
}

microtin_status fail(microtin_pack& p, microtin_status status) {
  give_up(p);
  return status;
}

// --- The header. The bytes of each item are in the buffer when it is handled.

void want_notes(microtin_pack& p, uint64_t offset) {
  if (p.left != 0) {
    want(p, PackStage::kNotes, offset, p.left);
  } else {
    want(p, PackStage::kCheck, offset, kCheckBytes);
  }
}

microtin_status handle_fixed(microtin_pack& p) {
  const microtin_status known = check_pack_identity(p.buffer);
  if (known != MICROTIN_DONE) return fail(p, known);
  if (!read_pack_header(p.buffer, &p.header)) return fail(p, MICROTIN_MALFORMED);
  p.crc = crc32(0, p.buffer, kPackFixedBytes);
  p.left = p.header.note_bytes;
  if (p.header.placement_bytes == 0) {
    want_notes(p, kPackFixedBytes);
  } else {
    want(p, PackStage::kPlacement, kPackFixedBytes, p.header.placement_bytes);
  }
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_placement(microtin_pack& p) {
  if (!read_pack_placement(p.buffer, p.header, p.axis)) return fail(p, MICROTIN_MALFORMED);
  p.crc = crc32(p.crc, p.buffer, p.buffered);
  want_notes(p, kPackFixedBytes + p.header.placement_bytes);
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_notes(microtin_pack& p) {
  p.crc = crc32(p.crc, p.buffer, p.buffered);
  p.left -= p.buffered;
  want_notes(p, p.next);
  return MICROTIN_NEED_INPUT;
}

microtin_status handle_check(microtin_pack& p) {
  if (read_u32(p.buffer) != p.crc) return fail(p, MICROTIN_CHECKSUM);
  want(p, PackStage::kIdle, 0, 0);
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
  p.has_header = true;
  return MICROTIN_NEED_INPUT;
}

// --- A tile.

// The slot that has not been wanted for the longest time; those of the course in hand are kept.
PackSlot* slot_to_fill(microtin_pack& p) {
  PackSlot* oldest = nullptr;
  for (uint32_t i = 0; i < p.slot_count; ++i) {
    PackSlot& slot = p.slots[i];
    if (slot.state == SlotState::kEmpty) return &slot;
    const uint32_t age = p.clock - slot.wanted;
    if (age != 0 && (oldest == nullptr || age > p.clock - oldest->wanted)) oldest = &slot;
  }
  return oldest;
}

microtin_status finish_tile(microtin_pack& p) {
  PackSlot& slot = p.slots[p.slot];
  slot.tile = p.tile;
  slot.wanted = p.clock;
  set_state(slot, SlotState::kReady);
  want(p, PackStage::kIdle, 0, 0);
  return MICROTIN_DONE;
}

microtin_status handle_entry(microtin_pack& p) {
  if (pack_entry_check(p.crc, p.tile, p.buffer) !=
      read_u32(p.buffer + kPackEntryBytes - kCheckBytes)) {
    return fail(p, MICROTIN_CHECKSUM);
  }
  if (!read_pack_entry(p.buffer, p.header, &p.entry)) return fail(p, MICROTIN_MALFORMED);
  if (p.entry.vertices > p.capacity) return fail(p, MICROTIN_TOO_BIG);
  PackSlot* const slot = slot_to_fill(p);
  if (slot == nullptr) return fail(p, MICROTIN_WORKSPACE_TOO_SMALL);
  p.slot = static_cast<uint8_t>(slot - p.slots);
  set_state(*slot, SlotState::kEmpty);
  microtin_decoder_init(p.decoder_space, p.decoder_bytes, slot->mesh, &p.decoder);
  if (p.entry.size == 0) return finish_tile(p);  // the mesh is empty now
  p.left = p.entry.size;
  p.stream_hash = kStreamHash;
  want(p, PackStage::kStream, p.entry.offset, p.left);
  return MICROTIN_NEED_INPUT;
}

// Whether what was decoded is the tile that the index tells of.
bool is_tile(const microtin_pack& p) {
  const TileBox box = tile_box(p.header.grid, p.tile);
  const Contract& contract = p.decoder->reconstruction.contract;
  return p.left == 0 && p.fed == p.buffered && p.stream_hash == p.entry.stream_hash &&
         contract.vertices == p.entry.vertices && contract.x_max <= box.x_end - box.x &&
         contract.y_max <= box.y_end - box.y;
}

microtin_status handle_stream(microtin_pack& p, uint32_t step_limit) {
  if (!p.is_counted) {
    p.is_counted = true;
    p.stream_hash = stream_hash(p.stream_hash, p.buffer, p.buffered);
    p.left -= p.buffered;
  }
  size_t used = 0;
  const microtin_status status = microtin_feed(
      p.decoder, p.buffer + p.fed, static_cast<size_t>(p.buffered - p.fed), step_limit, &used);
  p.fed = static_cast<uint8_t>(p.fed + used);
  if (status == MICROTIN_STEP_LIMIT) return status;
  if (status == MICROTIN_NEED_INPUT && p.left != 0) {
    want(p, PackStage::kStream, p.next, p.left);
    return status;
  }
  if (status == MICROTIN_DONE && is_tile(p)) return finish_tile(p);
  return fail(p, MICROTIN_CHECKSUM);
}

// Handles what is in the buffer, if it is complete. DONE: a tile is ready.
microtin_status handle(microtin_pack& p, uint32_t step_limit) {
  if (p.buffered < p.wanted) return MICROTIN_NEED_INPUT;
  switch (p.stage) {
    case PackStage::kFixed:
      return handle_fixed(p);
    case PackStage::kPlacement:
      return handle_placement(p);
    case PackStage::kNotes:
      return handle_notes(p);
    case PackStage::kCheck:
      return handle_check(p);
    case PackStage::kEntry:
      return handle_entry(p);
    case PackStage::kStream:
      return handle_stream(p, step_limit);
    case PackStage::kIdle:
      break;
  }
  return MICROTIN_DONE;
}

// What a course wants of a pack: notes which slots it touches, and finds the first tile that is not
// there.
struct Wishes {
  bool complete;
  bool in_hand;  // the tile that is being read is among them
  uint32_t first_absent;
};

Wishes wishes_of(microtin_pack& p, const microtin_course& course) {
  Wishes wishes = {true, false, 0};
  ++p.clock;
  uint32_t left = p.slot_count + 1u;  // one that does not fit is enough to know
  for (TouchedTiles tiles(p.header.grid, course); !tiles.at_end() && left != 0; tiles.next()) {
    --left;
    const uint32_t tile = tiles.number(), slot = slot_of(p, tile);
    wishes.in_hand = wishes.in_hand || tile == p.tile;
    if (slot != p.slot_count) {
      p.slots[slot].wanted = p.clock;
    } else if (wishes.complete) {
      wishes.complete = false;
      wishes.first_absent = tile;
    }
  }
  return wishes;
}

microtin_status prepare_tile(microtin_pack& p, const microtin_course& course, uint32_t step_limit) {
  microtin_status status = MICROTIN_DONE;
  // Once a tile is finished, the next one wants input first.
  for (int finished = 0; status == MICROTIN_DONE && finished < 2; ++finished) {
    const Wishes wishes = wishes_of(p, course);
    if (p.stage != PackStage::kIdle && !wishes.in_hand) give_up(p);
    if (p.stage == PackStage::kIdle) {
      if (wishes.complete) return MICROTIN_DONE;
      p.tile = wishes.first_absent;
      want(p, PackStage::kEntry, pack_entry_start(p.header, p.tile), kPackEntryBytes);
    }
    status = handle(p, step_limit);
  }
  return status;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_pack_init(void* workspace, size_t size, uint32_t slots, uint32_t capacity,
                                   microtin_pack** pack) {
  if (workspace == nullptr || pack == nullptr || slots == 0 || slots > 255 || capacity < 3 ||
      capacity > MICROTIN_MAX_VERTICES) {
    return MICROTIN_ARGUMENT;
  }
  *pack = nullptr;
  if (reinterpret_cast<uintptr_t>(workspace) % MICROTIN_ALIGNMENT != 0) return MICROTIN_MISALIGNED;
  const uint64_t own_bytes = MICROTIN_PACK_ROUND(sizeof(microtin_pack) + slots * sizeof(PackSlot));
  const uint64_t decoder_bytes = MICROTIN_PACK_ROUND(MICROTIN_DECODER_BYTES(capacity));
  const uint64_t mesh_bytes = MICROTIN_PACK_ROUND(MICROTIN_MESH_BYTES(capacity));
  // Below 2^8 * 2^31.
  if (own_bytes + decoder_bytes + slots * mesh_bytes > size) return MICROTIN_WORKSPACE_TOO_SMALL;
  microtin_pack& p = *static_cast<microtin_pack*>(workspace);
  p.slots = reinterpret_cast<PackSlot*>(&p + 1);
  p.slot_count = static_cast<uint8_t>(slots);
  p.capacity = capacity;
  p.decoder_space = static_cast<uint8_t*>(workspace) + own_bytes;
  p.decoder_bytes = static_cast<size_t>(decoder_bytes);
  uint8_t* mesh_space = p.decoder_space + decoder_bytes;
  for (uint32_t i = 0; i < slots; ++i, mesh_space += mesh_bytes) {
    microtin_mesh_init(mesh_space, static_cast<size_t>(mesh_bytes), &p.slots[i].mesh);
  }
  p.clock = 0;
  microtin_pack_reset(&p);
  *pack = &p;
  return MICROTIN_DONE;
}

void microtin_pack_reset(microtin_pack* pack) {
  microtin_pack& p = *pack;
  p.has_header = false;
  p.stage = PackStage::kFixed;
  p.tile = 0;
  for (uint32_t i = 0; i < p.slot_count; ++i) set_state(p.slots[i], SlotState::kEmpty);
  give_up(p);
}

microtin_status microtin_pack_prepare(microtin_pack* pack, const microtin_course* course,
                                      uint32_t step_limit) {
  if (pack == nullptr || course == nullptr || !is_legal(*course)) return MICROTIN_ARGUMENT;
  if (!pack->has_header) {
    const microtin_status status = handle(*pack, step_limit);
    if (!pack->has_header) return status;
  }
  return prepare_tile(*pack, *course, step_limit);
}

void microtin_pack_wanted(microtin_pack* pack, uint64_t* offset, uint8_t** buffer, size_t* size) {
  *offset = pack->next;
  *buffer = pack->buffer + pack->buffered;
  *size = static_cast<size_t>(pack->wanted - pack->buffered);
}

void microtin_pack_given(microtin_pack* pack, size_t size) {
  const size_t most = static_cast<size_t>(pack->wanted - pack->buffered);
  const uint8_t taken = static_cast<uint8_t>(size < most ? size : most);
  pack->buffered = static_cast<uint8_t>(pack->buffered + taken);
  pack->next += taken;
}
// --- decoder/pack_query.cpp
// Queries on the tiles of a pack that are there. They only read, so they may interrupt anything.

namespace microtin {
namespace {

microtin_course place(int64_t x, int64_t y) {
  return microtin_course{x, y, x, y};
}

bool is_inside(const microtin_pack& p, int64_t x, int64_t y) {
  const TileGrid& grid = p.header.grid;
  return x >= 0 && x <= static_cast<int64_t>(grid.x_max) * 256 && y >= 0 &&
         y <= static_cast<int64_t>(grid.y_max) * 256;
}

// In steps with 8 fractional bits, from the first corner of a tile that the course touches: within
// 2^25.
struct LocalPoint {
  int32_t x, y;
};

LocalPoint local(const TileBox& box, int64_t x, int64_t y) {
  return LocalPoint{static_cast<int32_t>(x - static_cast<int64_t>(box.x) * 256),
                    static_cast<int32_t>(y - static_cast<int64_t>(box.y) * 256)};
}

// Twice the signed area of (a, b, p): positive if p lies to the left of a -> b. Ends of courses are
// less than 2^24 apart, corners of triangles too, and none is farther than 2^26 from another: below
// 2^51.
int64_t orient(LocalPoint a, LocalPoint b, LocalPoint p) {
  return static_cast<int64_t>(b.x - a.x) * (p.y - a.y) -
         static_cast<int64_t>(b.y - a.y) * (p.x - a.x);
}

int64_t magnitude(int64_t v) {
  return v < 0 ? -v : v;
}

// rise * part / whole with 16 fractional bits, rounded to nearest, halves up; 0 <= part <= whole <
// 2^52, |rise| < 2^16. Long division, a bit of |rise| and then a fractional bit at a time: the rest
// stays below 3 * whole.
int32_t share(int32_t rise, int64_t part, int64_t whole) {
  const uint32_t size = static_cast<uint32_t>(rise < 0 ? -rise : rise);
  int64_t quotient = 0, rest = 0;  // quotient < 2^34
  for (int bit = 15; bit >= -17; --bit) {
    quotient *= 2;
    rest *= 2;
    if (bit >= 0 && (size >> bit & 1u) != 0) rest += part;
    for (int i = 0; i < 2 && rest >= whole; ++i) {
      rest -= whole;
      ++quotient;
    }
  }
  // One fractional bit more than is kept, and whether there is a rest.
  if (rise >= 0) return static_cast<int32_t>((quotient + 1) >> 1);
  return static_cast<int32_t>(-((quotient + (rest != 0 ? 1 : 0)) >> 1));
}

// A course in a tile.
class TileCourse {
 public:
  TileCourse(const microtin_mesh* mesh, const TileBox& box, const microtin_course& course)
      : mesh_(mesh),
        width_(static_cast<int32_t>(box.x_end - box.x) * 256),
        height_(static_cast<int32_t>(box.y_end - box.y) * 256),
        begin_(local(box, course.x, course.y)),
        end_(local(box, course.x_end, course.y_end)),
        x_(reach(begin_.x, end_.x)),
        y_(reach(begin_.y, end_.y)) {}

  // Looks at all triangles; at most microtin_triangle_count of them.
  void look(int32_t* highest, bool* is_known) const {
    const uint32_t triangles = microtin_triangle_count(mesh_);
    if (triangles == 0) *is_known = false;
    for (uint32_t t = 0; t < triangles; ++t) {
      if (is_aside(static_cast<Index>(t))) continue;
      uint32_t v[3];
      const microtin_triangle_kind kind = microtin_triangle(mesh_, t, v);
      if (kind == MICROTIN_GHOST) {
        if (leaves_at(v)) *is_known = false;
        continue;
      }
      const Corner corner[3] = {corner_at(v[0]), corner_at(v[1]), corner_at(v[2])};
      if (kind == MICROTIN_VOID) {
        if (passes_inside(corner)) *is_known = false;
        continue;
      }
      for (int i = 0; i < 3; ++i) look_at_edge(corner[i], corner[i == 2 ? 0 : i + 1], highest);
    }
  }

 private:
  struct Corner {
    LocalPoint at;
    int16_t z;
    int64_t side;  // of the course: positive to the left
  };

  // Whole steps that the course reaches along an axis.
  struct Reach {
    int32_t low, high;
  };

  static Reach reach(int32_t begin, int32_t end) {
    return begin < end ? Reach{begin >> 8, (end + 255) >> 8} : Reach{end >> 8, (begin + 255) >> 8};
  }

  // Whether a triangle, not a ghost, lies beside the bounding box of the course: most do.
  bool is_aside(Index t) const {
    const Mesh& mesh = mesh_->mesh;
    const Index* const v = mesh.origin + first_edge(t);
    if (is_ghost(v[0], v[1], v[2])) return false;
    const Point a = point_of(mesh, v[0]), b = point_of(mesh, v[1]), c = point_of(mesh, v[2]);
    return are_aside(a.x, b.x, c.x, x_) || are_aside(a.y, b.y, c.y, y_);
  }
  static bool are_aside(int32_t a, int32_t b, int32_t c, const Reach& reach) {
    return (a < reach.low && b < reach.low && c < reach.low) ||
           (a > reach.high && b > reach.high && c > reach.high);
  }

  Corner corner_at(uint32_t v) const {
    uint16_t x = 0, y = 0;
    int16_t z = 0;
    microtin_vertex(mesh_, v, &x, &y, &z);
    const LocalPoint at = {static_cast<int32_t>(x) * 256, static_cast<int32_t>(y) * 256};
    return Corner{at, z, orient(begin_, end_, at)};
  }

  // Whether the course has a point on the closed edge, given its ends' sides.
  bool meets(const Corner& a, const Corner& b) const {
    if ((a.side > 0 && b.side > 0) || (a.side < 0 && b.side < 0)) return false;
    const int64_t from = orient(a.at, b.at, begin_), to = orient(a.at, b.at, end_);
    return (from <= 0 && to >= 0) || (from >= 0 && to <= 0);
  }

  // Where the course crosses the edge; where it runs along it, ends of the edge on the course. (The
  // course's own ends are looked at elsewhere.)
  void look_at_edge(const Corner& a, const Corner& b, int32_t* highest) const {
    if (!meets(a, b)) return;
    const int64_t part = magnitude(a.side), whole = part + magnitude(b.side);
    if (whole == 0) {
      if (spans(a.at)) raise(a.z * 65536, highest);
      if (spans(b.at)) raise(b.z * 65536, highest);
      return;
    }
    raise(a.z * 65536 + share(b.z - a.z, part, whole), highest);
  }

  static void raise(int32_t height, int32_t* highest) {
    if (height > *highest) *highest = height;
  }

  // Whether a point on the course's line lies between its ends.
  bool spans(LocalPoint p) const {
    return between(begin_.x, p.x, end_.x) && between(begin_.y, p.y, end_.y);
  }
  static bool between(int32_t a, int32_t p, int32_t b) {
    return (a <= p && p <= b) || (b <= p && p <= a);
  }

  // Whether the course has a point inside the open triangle: no side of it, and not the course's
  // own line, parts them (separating axes of a triangle and a segment).
  bool passes_inside(const Corner* corner) const {
    bool some_left = false, some_right = false;
    for (int i = 0; i < 3; ++i) {
      const Corner &a = corner[i], &b = corner[i == 2 ? 0 : i + 1];
      if (orient(a.at, b.at, begin_) <= 0 && orient(a.at, b.at, end_) <= 0) return false;
      some_left = some_left || a.side > 0;
      some_right = some_right || a.side < 0;
    }
    return some_left && some_right;
  }

  // Whether the course leaves the terrain across the ghost's hull edge, which runs with the outside
  // to its left, and is not the border to the next tile.
  bool leaves_at(const uint32_t* v) const {
    const int k = v[0] == MICROTIN_INFINITY ? 0 : v[1] == MICROTIN_INFINITY ? 1 : 2;
    const Corner a = corner_at(v[(k + 1) % 3]), b = corner_at(v[(k + 2) % 3]);
    const bool on_border = (a.at.x == b.at.x && (a.at.x == 0 || a.at.x == width_)) ||
                           (a.at.y == b.at.y && (a.at.y == 0 || a.at.y == height_));
    if (on_border || !meets(a, b)) return false;
    return orient(a.at, b.at, begin_) > 0 || orient(a.at, b.at, end_) > 0;
  }

  const microtin_mesh* mesh_;
  int32_t width_, height_;
  LocalPoint begin_, end_;
  Reach x_, y_;
};

// The worse of two answers: NOT_DECODED, OUTSIDE, IN_VOID, HEIGHT.
microtin_answer worse(microtin_answer a, microtin_answer b) {
  if (a == MICROTIN_NOT_DECODED || b == MICROTIN_NOT_DECODED) return MICROTIN_NOT_DECODED;
  if (a == MICROTIN_OUTSIDE || b == MICROTIN_OUTSIDE) return MICROTIN_OUTSIDE;
  return a == MICROTIN_HEIGHT ? b : a;
}

// A height in whole units, halves up, kept within int16_t. |z| < 2^31, the numerator < 2^31, the
// offset within 2^45, the denominator < 2^40: sums below 2^62 + 2^61 + 2^55.
int16_t in_units(int32_t z, const microtin_axis& axis) {
  const int64_t unit = static_cast<int64_t>(axis.denominator) * 65536;
  const int64_t sum = static_cast<int64_t>(axis.numerator) * z + axis.offset * 65536 + unit / 2;
  int64_t height = sum / unit;
  if (sum % unit < 0) --height;
  if (height > INT16_MAX) return INT16_MAX;
  return static_cast<int16_t>(height < INT16_MIN ? INT16_MIN : height);
}

}  // namespace
}  // namespace microtin

using namespace microtin;

int microtin_pack_header(const microtin_pack* pack, microtin_pack_info* info) {
  if (!pack->has_header) return 0;
  const PackHeader& header = pack->header;
  info->x_max = header.grid.x_max;
  info->y_max = header.grid.y_max;
  info->tile_width = header.grid.width;
  info->tile_height = header.grid.height;
  info->most_vertices = header.most_vertices;
  info->lowest = header.lowest;
  info->highest = header.highest;
  info->x = pack->axis[0];
  info->y = pack->axis[1];
  info->z = pack->axis[2];
  return 1;
}

int microtin_pack_to_lattice(const microtin_axis* axis, uint32_t most, int64_t value,
                             uint32_t per_unit, int64_t* lattice) {
  const int64_t limit = static_cast<int64_t>(1) << 61;
  if (per_unit == 0 || per_unit > (1ul << 24) || axis->numerator >> 30 != 0 ||
      most > kPackExtentMost || axis->offset >= limit || axis->offset <= -limit) {
    return 0;
  }
  const int64_t denominator = static_cast<int64_t>(axis->denominator);  // < 2^40
  int64_t whole = value / per_unit, rest = value % per_unit;
  if (rest < 0) {
    rest += per_unit;
    --whole;
  }
  if (whole > 2 * limit / denominator || whole < -2 * limit / denominator) return 0;
  const uint64_t scaled = static_cast<uint64_t>(rest) * axis->denominator;  // < 2^64
  // In parts of a step, numerator of them: below 2^62 + 2^61 + 2^40; and a rest / per_unit of one.
  const int64_t parts =
      whole * denominator - axis->offset + static_cast<int64_t>(scaled / per_unit);
  if (parts < 0) return 0;
  const uint64_t step = static_cast<uint64_t>(parts) / axis->numerator,
                 over = static_cast<uint64_t>(parts) % axis->numerator;
  if (step > most) return 0;
  const uint64_t fraction = over * per_unit + scaled % per_unit;  // < 2^54 of 2^54
  const uint64_t twice = fraction * 512 / (axis->numerator * per_unit);
  const int64_t result = static_cast<int64_t>(step * 256 + (twice + 1) / 2);
  if (result > static_cast<int64_t>(most) * 256) return 0;
  *lattice = result;
  return 1;
}

microtin_answer microtin_pack_height_at(const microtin_pack* pack, int64_t x, int64_t y,
                                        uint32_t* hint, int32_t* height) {
  if (!pack->has_header) return MICROTIN_NOT_DECODED;
  if (!is_inside(*pack, x, y)) return MICROTIN_OUTSIDE;
  microtin_answer answer = MICROTIN_IN_VOID;
  const microtin_course here = place(x, y);
  for (TouchedTiles tiles(pack->header.grid, here); !tiles.at_end(); tiles.next()) {
    const uint32_t slot = slot_of(*pack, tiles.number());
    if (slot == pack->slot_count) {
      answer = MICROTIN_NOT_DECODED;
      continue;
    }
    const LocalPoint p = local(tiles.box(), x, y);
    if (microtin_height_at(pack->slots[slot].mesh, p.x, p.y, 0, hint, height) == MICROTIN_HEIGHT) {
      return MICROTIN_HEIGHT;
    }
  }
  return answer;
}

microtin_answer microtin_pack_highest(const microtin_pack* pack, const microtin_course* course,
                                      int32_t* height) {
  *height = INT32_MIN;
  if (!is_legal(*course)) return MICROTIN_OUTSIDE;
  uint32_t hint = 0;
  int32_t begin = INT32_MIN, end = INT32_MIN;
  const microtin_answer answer =
      worse(microtin_pack_height_at(pack, course->x, course->y, &hint, &begin),
            microtin_pack_height_at(pack, course->x_end, course->y_end, &hint, &end));
  if (answer == MICROTIN_NOT_DECODED) return answer;
  bool is_known = true;
  int32_t highest = begin > end ? begin : end;
  for (TouchedTiles tiles(pack->header.grid, *course); !tiles.at_end(); tiles.next()) {
    const uint32_t slot = slot_of(*pack, tiles.number());
    if (slot == pack->slot_count) return MICROTIN_NOT_DECODED;
    TileCourse(pack->slots[slot].mesh, tiles.box(), *course).look(&highest, &is_known);
  }
  *height = highest;
  return is_known ? answer : worse(answer, MICROTIN_IN_VOID);
}

microtin_answer microtin_pack_fill(const microtin_pack* pack, const microtin_block* block,
                                   int16_t* heights) {
  const microtin_axis& axis = pack->axis[2];
  const int64_t furthest = static_cast<int64_t>(1) << 45;
  const microtin_course corner = place(block->x, block->y);
  if (!is_legal(corner) || axis.numerator >> 31 != 0 || axis.offset > furthest ||
      axis.offset < -furthest) {
    return MICROTIN_OUTSIDE;
  }
  microtin_answer answer = MICROTIN_HEIGHT;
  uint32_t hint = 0;
  for (uint32_t row = 0; row < block->rows; ++row) {
    const int64_t y = block->y + static_cast<int64_t>(block->dy) * row;
    for (uint32_t column = 0; column < block->columns; ++column) {
      const int64_t x = block->x + static_cast<int64_t>(block->dx) * column;
      int32_t z = 0;
      const microtin_answer here = microtin_pack_height_at(pack, x, y, &hint, &z);
      *heights++ = here == MICROTIN_HEIGHT ? in_units(z, axis) : block->missing;
      answer = worse(answer, here);
    }
  }
  return answer;
}
// --- decoder/query.cpp
// Queries on a decoded mesh.
// --- shared/digest.hpp
// The canonical digest of a mesh: a sum over its triangles, so that their order does not matter.


namespace microtin {

// FNV-1a, 64 bits, of x, y, z of the corners, counter-clockwise from the lexicographically
// smallest, low bytes first, then a void flag of two bytes.
inline uint64_t triangle_digest(const Vertex corner[3], bool is_void) {
  uint32_t first = 0;
  for (uint32_t i = 1; i < 3; ++i) {
    const Point p = {corner[i].x, corner[i].y}, least = {corner[first].x, corner[first].y};
    if (p < least) first = i;
  }
  uint16_t words[10];
  for (uint32_t i = 0; i < 3; ++i) {
    const Vertex& v = corner[(first + i) % 3];
    words[3 * i] = v.x;
    words[3 * i + 1] = v.y;
    words[3 * i + 2] = static_cast<uint16_t>(v.z);
  }
  words[9] = is_void;
  uint64_t hash = 0xCBF29CE484222325u;
  for (uint32_t i = 0; i < 20; ++i) {
    const uint32_t byte = static_cast<uint32_t>(words[i / 2]) >> (i % 2 * 8) & 255u;
    hash = (hash ^ byte) * 0x100000001B3u;
  }
  return hash;
}

}  // namespace microtin


namespace microtin {
namespace {

bool has_terrain(const microtin_mesh& m, Index t) {
  return !is_ghost(m.mesh, t) && !(m.has_voids && is_void(m.voids, t));
}

// The corner of a real triangle where a half-edge starts.
Vertex corner_at(const Mesh& mesh, uint32_t half_edge) {
  const Index v = mesh.origin[half_edge];
  const Point at = point_of(mesh, v);
  return Vertex{at.x, at.y, mesh.z[v]};
}

// The answer at p in the closed real triangle t. A vertex always knows its own height; on an edge,
// terrain on either side is enough.
microtin_answer answer_in(const microtin_mesh& m, Index t, FinePoint p, int32_t* height) {
  const Mesh& mesh = m.mesh;
  bool known = has_terrain(m, t);
  const Index f = first_edge(t);
  for (uint32_t i = 0; i < 3 && !known; ++i) {
    const Index h = static_cast<Index>(f + i);
    const FinePoint at = fine(point_of(mesh, mesh.origin[h]));
    known = (at.x == p.x && at.y == p.y) || (side_of(mesh, h, next_in_triangle(h), p) == 0 &&
                                             has_terrain(m, triangle_of(mesh.twin[h])));
  }
  if (!known) return MICROTIN_IN_VOID;
  *height =
      height_in_triangle(corner_at(mesh, f), corner_at(mesh, f + 1u), corner_at(mesh, f + 2u), p);
  return MICROTIN_HEIGHT;
}

uint32_t public_vertex(Index v) {
  return v == kInfinity ? static_cast<uint32_t>(MICROTIN_INFINITY) : v;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

uint32_t microtin_vertex_count(const microtin_mesh* mesh) {
  return mesh->mesh.vertices;
}

void microtin_vertex(const microtin_mesh* mesh, uint32_t v, uint16_t* x, uint16_t* y, int16_t* z) {
  const Point at = mesh->mesh.place[v];
  *x = at.x;
  *y = at.y;
  *z = mesh->mesh.z[v];
}

uint32_t microtin_triangle_count(const microtin_mesh* mesh) {
  return mesh->mesh.triangles;
}

microtin_triangle_kind microtin_triangle(const microtin_mesh* mesh, uint32_t t, uint32_t v[3]) {
  const Index f = first_edge(static_cast<Index>(t));
  for (uint32_t i = 0; i < 3; ++i) v[i] = public_vertex(mesh->mesh.origin[f + i]);
  if (is_ghost(mesh->mesh, static_cast<Index>(t))) return MICROTIN_GHOST;
  return has_terrain(*mesh, static_cast<Index>(t)) ? MICROTIN_REAL : MICROTIN_VOID;
}

uint32_t microtin_neighbour(const microtin_mesh* mesh, uint32_t t, uint32_t corner) {
  const Index f = first_edge(static_cast<Index>(t));
  return triangle_of(mesh->mesh.twin[static_cast<Index>(f + corner)]);
}

uint64_t microtin_digest(const microtin_mesh* mesh) {
  uint64_t sum = 0;
  for (Index t = 0; t < mesh->mesh.triangles; ++t) {
    if (is_ghost(mesh->mesh, t)) continue;
    const Index f = first_edge(t);
    const Vertex corner[3] = {corner_at(mesh->mesh, f), corner_at(mesh->mesh, f + 1u),
                              corner_at(mesh->mesh, f + 2u)};
    sum += triangle_digest(corner, !has_terrain(*mesh, t));
  }
  return sum;
}

microtin_answer microtin_height_at(const microtin_mesh* mesh, int32_t x, int32_t y, uint32_t flags,
                                   uint32_t* hint, int32_t* height) {
  return microtin_height_at_limited(mesh, x, y, flags, 0, hint, height);
}

microtin_answer microtin_height_at_limited(const microtin_mesh* mesh, int32_t x, int32_t y,
                                           uint32_t flags, uint32_t step_limit, uint32_t* hint,
                                           int32_t* height) {
  const Mesh& m = mesh->mesh;
  if (m.triangles == 0) return MICROTIN_NOT_DECODED;
  if (mesh->verified_vertices != m.vertices && (flags & MICROTIN_ANSWER_UNVERIFIED) == 0) {
    return MICROTIN_NOT_VERIFIED;
  }
  const int32_t most = static_cast<int32_t>(kLatticeMax) * 256;
  if (x < 0 || x > most || y < 0 || y > most) return MICROTIN_OUTSIDE;
  const FinePoint p = {x, y};
  Index t = *hint < m.triangles ? static_cast<Index>(*hint) : static_cast<Index>(0);
  const bool arrived = walk_to(m, p, step_limit == 0 ? m.triangles : step_limit, &t);
  *hint = t;
  if (!arrived) return MICROTIN_NOT_YET;
  if (is_ghost(m, t)) return MICROTIN_OUTSIDE;
  return answer_in(*mesh, t, p, height);
}

void microtin_placement(const microtin_mesh* mesh, microtin_axis* x, microtin_axis* y,
                        microtin_axis* z) {
  *x = mesh->axis[0];
  *y = mesh->axis[1];
  *z = mesh->axis[2];
}

int microtin_to_lattice(const microtin_axis* axis, int64_t value, uint32_t per_unit,
                        int32_t* lattice) {
  if (per_unit == 0 || per_unit > (1ul << 24)) return 0;
  const uint64_t denominator = axis->denominator, numerator = axis->numerator;  // < 2^40
  // lattice = (value / per_unit * denominator - offset) / numerator. Split into whole units, the
  // most that are not above, and rest.
  const bool negative = value < 0;
  const Quotient units =
      divide(negative ? ~static_cast<uint64_t>(value) : static_cast<uint64_t>(value), per_unit);
  const uint64_t whole = negative ? units.whole + 1 : units.whole;  // the size of it
  const uint64_t rest = negative ? per_unit - 1u - units.rest : units.rest;
  // Places outside are refused before anything can overflow: those inside are within 65537
  // numerators of the offset, so whole * denominator < 2^61 + 2^57.
  const int64_t limit = static_cast<int64_t>(1) << 61;
  if (highest_bit(whole | 1u) + highest_bit(denominator) > 62) return 0;
  const uint64_t product = whole * denominator;  // < 2^64
  if (product > 2 * static_cast<uint64_t>(limit)) return 0;
  if (axis->offset >= limit || axis->offset <= -limit) return 0;
  const int64_t ahead =
      (negative ? -static_cast<int64_t>(product) : static_cast<int64_t>(product)) - axis->offset;
  const Quotient part = divide(rest * denominator, per_unit);               // < 2^64; < 2^40
  const int64_t one = static_cast<int64_t>(numerator), most = 65536 * one;  // < 2^56
  if (ahead > most || ahead < -static_cast<int64_t>(denominator) - one) return 0;
  const int64_t steps =
      ahead + static_cast<int64_t>(part.whole);  // numerator-ths of a lattice step
  // Round (steps + part.rest / per_unit) * 256 / numerator to nearest, halves up.
  int64_t base = -1, over = steps + one;  // 0 <= over < numerator, or it is outside
  if (steps >= 0) {
    const Quotient places = divide(static_cast<uint64_t>(steps), numerator);
    base = static_cast<int64_t>(places.whole);
    over = static_cast<int64_t>(places.rest);
  }
  if (over < 0) return 0;
  const uint64_t fine_numerator =
      static_cast<uint64_t>(over) * 512u + divide(part.rest * 512u, per_unit).whole;  // < 2^50
  const int64_t twice = static_cast<int64_t>(divide(fine_numerator, numerator).whole);
  const int64_t result = base * 256 + (twice + 1) / 2;
  if (result < 0 || result > static_cast<int64_t>(kLatticeMax) * 256) return 0;
  *lattice = static_cast<int32_t>(result);
  return 1;
}
// --- decoder/walk.cpp

namespace microtin {
namespace {

// A half-edge of the triangle or, from a ghost, of the real one beside it.
Index real_edge(const Mesh& mesh, Index triangle) {
  Index h = first_edge(triangle);
  if (!is_ghost(mesh, triangle)) return h;
  while (mesh.origin[h] == kInfinity || mesh.origin[next_in_triangle(h)] == kInfinity) ++h;
  return mesh.twin[h];
}

}  // namespace

bool walk_to(const Mesh& mesh, FinePoint p, uint32_t step_limit, Index* triangle) {
  Index h = real_edge(mesh, *triangle);
  if (side_of(mesh, h, next_in_triangle(h), p) < 0) h = mesh.twin[h];
  bool arrived = false;
  for (uint32_t step = 0; step < step_limit && !arrived; ++step) {
    // p does not lie beyond h.
    const Index next = next_in_triangle(h), last = next_in_triangle(next);
    const bool real = mesh.origin[last] != kInfinity;
    if (real && side_of(mesh, next, last, p) < 0) {
      h = mesh.twin[next];
    } else if (real && side_of(mesh, last, h, p) < 0) {
      h = mesh.twin[last];
    } else {
      arrived = true;
    }
  }
  *triangle = triangle_of(h);
  return arrived;
}

}  // namespace microtin
