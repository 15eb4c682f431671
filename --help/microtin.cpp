// SPDX-License-Identifier: MIT
/* microtin 0.1.0, the decoder in one source, made by decoder/amalgamate.py.

MIT License

Copyright (c) 2026 microtin contributors

Permission is hereby granted, free of charge, to any person obtaining a copy
of this software and associated documentation files (the "Software"), to deal
in the Software without restriction, including without limitation the rights
to use, copy, modify, merge, publish, distribute, sublicense, and/or sell
copies of the Software, and to permit persons to whom the Software is
furnished to do so, subject to the following conditions:

The above copyright notice and this permission notice shall be included in all
copies or substantial portions of the Software.

THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR
IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY,
FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE
AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER
LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM,
OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE
SOFTWARE.
*/
#include "microtin.h"

#if defined(__clang__)
#pragma clang diagnostic ignored "-Wunused-const-variable"
#pragma clang diagnostic ignored "-Wunused-function"
#if defined(__OPTIMIZE_SIZE__)
#pragma clang attribute push(__attribute__((minsize)), apply_to = function)
#endif
#endif

// --- decoder/axis.cpp
// --- decoder/axis.hpp

#include <stdint.h>


namespace microtin {
namespace {

// Steps with 9 fractional bits, rounded down, at which the axis has value / per_unit units: one bit
// more than is asked for, which says how to round. -1 is less than half a 1/256 step outside; below
// that, the place is outside 0 .. `most` steps, per_unit outside 1 .. 2^24, or the axis' offset
// outside +-2^61. Needs (most + 1) * axis.numerator < 2^61. Six 64-bit divisions.
int64_t half_steps(const microtin_axis& axis, uint32_t most, int64_t value, uint32_t per_unit);

// To nearest with 8 fractional bits, halves up.
inline int64_t rounded_steps(int64_t half_steps) {
  return (half_steps + 1) >> 1;
}

}  // namespace
}  // namespace microtin


// --- shared/division.hpp

#include <stdint.h>

// --- shared/fixed_math.hpp

#include <stdint.h>

// --- shared/compiler.hpp

// GCC 12 at -O2, where there are no vector registers, puts two 16-bit numbers into a word and takes
// the high half of the word's square for that of each: seen on
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
// wanted in many places (ONE_COPY). What is smaller than a call of it, or wanted in one place, is
// put there (IN_PLACE): compilers do not see that no other file calls it.
#if !defined(__GNUC__)
#define MICROTIN_IN_PLACE
#define MICROTIN_OUT_OF_LINE
#define MICROTIN_ONE_COPY
#else
#define MICROTIN_IN_PLACE __attribute__((always_inline))
#if !defined(__OPTIMIZE_SIZE__)
#define MICROTIN_OUT_OF_LINE __attribute__((noinline))
#define MICROTIN_ONE_COPY
#elif defined(__clang__)
#define MICROTIN_OUT_OF_LINE
#define MICROTIN_ONE_COPY __attribute__((noinline))
#else
#define MICROTIN_OUT_OF_LINE
#define MICROTIN_ONE_COPY __attribute__((noinline, noclone))
#endif
#endif

// A function that keeps no call but those of ONE_COPY, also where size counts and others share what
// it calls.
#if defined(__GNUC__) && !defined(__clang__)
#define MICROTIN_WITHOUT_CALLS __attribute__((flatten))
#else
#define MICROTIN_WITHOUT_CALLS
#endif

// Where a table of some KB is cheaper than a division.
#if (defined(__x86_64__) || defined(__aarch64__)) && !defined(__OPTIMIZE_SIZE__)
#define MICROTIN_LARGE_TABLES
#endif

// Where a multiplication makes 32 bits at most: wider ones are calls.
#if defined(__ARM_ARCH_6M__) || defined(__AVR__) || (defined(__riscv) && !defined(__riscv_mul))
#define MICROTIN_NARROW_MACHINE
#endif


namespace microtin {
namespace {

// A base-2 logarithm with 8 fractional bits.
typedef int32_t Log2;
constexpr Log2 kLog2One = 256;

// Position of the highest set bit of v > 0.
#if defined(__GNUC__) && !defined(__AVR__)
MICROTIN_IN_PLACE inline uint32_t highest_bit(uint32_t v) {
  return 31u ^ static_cast<uint32_t>(__builtin_clz(v));
}
#else
MICROTIN_ONE_COPY inline uint32_t highest_bit(uint32_t v) {
  uint32_t bit = 0;
  for (uint32_t step = 16; step != 0; step >>= 1) {
    if (v >> step) {
      v >>= step;
      bit += step;
    }
  }
  return bit;
}
#endif

// log2(v) within 1/256, for v > 0.
inline Log2 log2_of(uint32_t v) {
  const uint32_t bit = highest_bit(v);
  // The 16 bits behind the leading one, m of 2^16: log2(1 + m) is m + m (1 - m) (0.424 - 0.162 m).
  const uint32_t m = v << (31u - bit) >> 15 & 0xFFFFu;
  const uint32_t bend = (m * (65536u - m) >> 16) * (27800u - (10600u * m >> 16)) >> 16;
  return static_cast<Log2>(bit * 256u + ((m + bend + 128u) >> 8));
}

// A rough one: straight between powers of two, 0.086 too low at most.
inline Log2 rough_log2(uint32_t v) {
  const uint32_t bit = highest_bit(v);
  return static_cast<Log2>((bit << 8) + (v << (31u - bit) >> 23 & 0xFFu));
}

// The inverse of it, 0 for l < 0; l < 2^13.
inline uint32_t rough_exp2(Log2 l) {
  if (l < 0) return 0;
  const uint32_t bit = static_cast<uint32_t>(l) >> 8;
  return (256u + (static_cast<uint32_t>(l) & 255u)) << 23 >> (31u - bit);
}

inline int32_t kept_within(int32_t v, int32_t least, int32_t most) {
  return v < least ? least : v > most ? most : v;
}

// The root of v but for 1 / 256 of it, for 0 < v < 2^31.
inline uint32_t rough_root(uint32_t v) {
  const uint32_t half = highest_bit(v) >> 1;
  const uint32_t guess = (11u * (v >> half) + ((22u << half) + 32u)) >> 5;
  return (guess + v / guess) >> 1;
}

// The root but for 1 of 2^15.
inline uint32_t fine_root(uint32_t v) {
  const uint32_t guess = rough_root(v) | 1u;
  return (guess + v / guess) >> 1;
}

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

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

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

// A place is (value / per_unit * denominator - offset) / numerator steps.
int64_t half_steps(const microtin_axis& axis, uint32_t most, int64_t value, uint32_t per_unit) {
  const int64_t limit = static_cast<int64_t>(1) << 61, outside = -2;
  if (per_unit == 0 || per_unit > (1ul << 24)) return outside;
  if (axis.offset >= limit || axis.offset <= -limit) return outside;
  const uint64_t denominator = axis.denominator, numerator = axis.numerator;  // < 2^40
  // Split into whole units, the most that are not above, and rest. One Quotient for all divisions
  // saves stack.
  const bool negative = value < 0;
  Quotient part =
      divide(negative ? ~static_cast<uint64_t>(value) : static_cast<uint64_t>(value), per_unit);
  const uint64_t whole = negative ? part.whole + 1 : part.whole;  // the size of it
  const uint64_t rest = negative ? per_unit - 1u - part.rest : part.rest;
  // Inside, whole * denominator <= offset + (most + 1/512) * numerator < 2^62, and it is above
  // -2^61 - 2^41: what is farther from 0 is refused before it can overflow.
  if (whole > divide(static_cast<uint64_t>(1) << 62, denominator).whole) return outside;
  const uint64_t product = whole * denominator;  // <= 2^62
  part = divide(rest * denominator, per_unit);   // < 2^64; < 2^40
  // In numerator-ths of a step, from a step before 0: within 2^62 + 2^61 + 2^41; and a rest of one.
  const uint64_t part_rest = part.rest * 512u;  // / per_unit / 512
  const int64_t ahead = static_cast<int64_t>(part.whole + numerator) - axis.offset +
                        (negative ? -static_cast<int64_t>(product) : static_cast<int64_t>(product));
  if (ahead < 0) return outside;
  part = divide(static_cast<uint64_t>(ahead), numerator);
  if (part.whole > static_cast<uint64_t>(most) + 1) return outside;
  const uint64_t fine = part.rest * 512u + divide(part_rest, per_unit).whole;  // < 2^49
  const int64_t found =
      static_cast<int64_t>(part.whole * 512u + divide(fine, numerator).whole) - 512;
  return found > static_cast<int64_t>(most) * 512 ? outside : found;
}

}  // namespace
}  // namespace microtin
// --- decoder/buckets.cpp
// Buckets: for each part of a terrain's box a triangle near it.
// --- decoder/state.hpp

// --- decoder/range_decoder.hpp

// --- shared/crc32.hpp

#include <stddef.h>
#include <stdint.h>

// --- shared/tables.hpp

#include <stdint.h>


#if defined(__AVR__)
#include <avr/pgmspace.h>
#define MICROTIN_IN_FLASH PROGMEM
#else
#define MICROTIN_IN_FLASH
#endif

namespace microtin {
namespace {

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

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

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

}  // namespace
}  // namespace microtin

// --- shared/format.hpp

#include <stddef.h>
#include <stdint.h>


namespace microtin {
namespace {

constexpr uint8_t kMagic[4] MICROTIN_IN_FLASH = {'m', 't', 'i', 'n'};
constexpr uint8_t kVersion = 5;
constexpr uint32_t kMinDegree = 6, kMaxDegree = 32;
constexpr uint32_t kMaxVertices = 16777216;  // 2^24

// A section of the body ends with the first phase that brings the terrain to this many vertices,
// and with every phase after it.
constexpr uint32_t kSectionVertices = 256;

// Payload bytes that suffice for any step. Most are used by a vertex on a hull edge: a decision,
// its gap (19 decisions and 15 uniform bits) and its height (19 decisions and 15 uniform bits), at
// 9 bits a decision, are 48 bytes (FORMAT.md, "Payload bytes of a step").
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

// How much of the odds of places a stream makes use of (place_coding.hpp): the more, the smaller
// and the slower to decode.
enum class Decoding : uint8_t { kQuick = 1, kBalanced = 2, kDense = 3 };

// What the fixed header promises.
struct Contract {
  uint32_t vertices;
  uint16_t x_max, y_max;
  uint32_t degree;  // most triangles around a vertex when it is inserted
  Decoding decoding;
  bool has_heights;
  bool has_voids;
  bool odd_origin_x = false, odd_origin_y = false;  // of the stream's lattice on its pack's
};

// Lattice places that vertices can lie on, modulo 2^32: 2^32 are 0.
inline uint32_t lattice_places(const Contract& contract) {
  return (static_cast<uint32_t>(contract.x_max) + 1u) *
         (static_cast<uint32_t>(contract.y_max) + 1u);
}

// A stream begins with magic 4 and version 1. What follows of the header is framed as sections are:
// its length, then properties, vertices, x_max, y_max, the placement, notes; the CRC-32 of all
// before.
constexpr uint32_t kIdentityBytes = 5;
constexpr uint32_t kCheckBytes = 4;
constexpr uint32_t kPlacementMostBytes = 66;                                // 3 * (10 + 6 + 6)
constexpr uint32_t kHeaderMostBytes = 2 + 4 + 3 + 3 + kPlacementMostBytes;  // before the notes

// Properties: these flags, 8 * decoding, 32 * degree. All further bits are for later versions.
constexpr uint32_t kHasHeights = 1, kHasVoids = 2, kHasPlacement = 4;
constexpr uint32_t kOddOriginX = 2048, kOddOriginY = 4096;
constexpr uint32_t kPropertyBits = 13;

// Notes are for people and applications; decoding needs none of them. A type byte (microtin.h has
// the types), a length (2 bytes), the content.
constexpr uint32_t kNoteHeadBytes = 3;
constexpr uint32_t kNotesMostBytes = 65535;

inline uint32_t read_u16(const uint8_t* p) {
  return p[0] | static_cast<uint32_t>(p[1]) << 8;
}

inline uint32_t read_u32(const uint8_t* p) {
  return read_u16(p) | read_u16(p + 2) << 16;
}

}  // namespace
}  // namespace microtin

// --- shared/mesh.hpp

#include <stddef.h>

// --- shared/lattice.hpp

#include <stdint.h>


namespace microtin {
namespace {

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

}  // namespace
}  // namespace microtin

// --- shared/predicates.hpp


namespace microtin {
namespace {

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

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

#if MICROTIN_INDEX_BITS == 16
typedef uint16_t Index;
#else
typedef uint32_t Index;
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

MICROTIN_IN_PLACE inline Point point_of(const Mesh& mesh, Index v) {
  return mesh.place[v];
}

MICROTIN_ONE_COPY inline bool is_ghost(const Mesh& mesh, Index triangle) {
  const Index f = first_edge(triangle);
  return is_ghost(mesh.origin[f], mesh.origin[f + 1u], mesh.origin[f + 2u]);
}

// Makes a and b each other's twins.
MICROTIN_IN_PLACE inline void pair(Mesh& mesh, size_t a, size_t b) {
  mesh.twin[a] = static_cast<Index>(b);
  mesh.twin[b] = static_cast<Index>(a);
}

// in_conflict for the rare cases: a ghost, or p on the circle.
MICROTIN_OUT_OF_LINE inline bool in_rare_conflict(const Mesh& mesh, Index a, Index b, Index c,
                                                  Point p) {
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

}  // namespace
}  // namespace microtin

// --- shared/probability.hpp

// --- shared/vectors.hpp


#if defined(__SSE2__) && defined(__x86_64__) && !defined(__OPTIMIZE_SIZE__)
#if defined(__has_include)
#if __has_include(<stdlib.h>)  // gcc's emmintrin.h includes it
#define MICROTIN_PAIRS
#include <emmintrin.h>
#endif
#endif
#elif defined(__ARM_FEATURE_DSP) && defined(__ARM_FEATURE_SIMD32) && !defined(__OPTIMIZE_SIZE__)
#define MICROTIN_PAIRS
#include <arm_acle.h>
#endif


namespace microtin {
namespace {

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

// Where a bit's means go: both never get there.
constexpr int32_t kTowardsOne = static_cast<int32_t>(kProbabilityOne) - kProbabilityMargin;
constexpr int32_t kTowardsZero = kProbabilityMargin;

#if defined(MICROTIN_PAIRS) && defined(__SSE2__)

// Both means at once: ways are within 2^15, and the high half of a product with 2^(16 - n) is a
// way's 2^n-th part, rounded down.
MICROTIN_IN_PLACE inline void learn(AdaptiveBit& bit, bool one) {
  static_assert(sizeof bit == sizeof(int32_t), "both means make a word");
  const int32_t towards = one ? kTowardsOne << 16 | kTowardsOne : kTowardsZero << 16 | kTowardsZero;
  int32_t means;
  __builtin_memcpy(&means, &bit, sizeof means);
  const __m128i was = _mm_cvtsi32_si128(means);
  const __m128i way = _mm_sub_epi16(_mm_cvtsi32_si128(towards), was);
  const __m128i step = _mm_mulhi_epi16(way, _mm_cvtsi32_si128(1 << (16 - 5) | 1 << (32 - 8)));
  means = _mm_cvtsi128_si32(_mm_add_epi16(was, step));
  __builtin_memcpy(&bit, &means, sizeof means);
}

#else

MICROTIN_IN_PLACE inline void learn(AdaptiveBit& bit, bool one) {
  const int32_t towards = one ? kTowardsOne : kTowardsZero;
  bit.fast = static_cast<uint16_t>(bit.fast + ((towards - bit.fast) >> 5));
  bit.slow = static_cast<uint16_t>(bit.slow + ((towards - bit.slow) >> 8));
}

#endif

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

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

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

  MICROTIN_IN_PLACE void normalise() {
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

}  // namespace
}  // namespace microtin

// --- shared/reconstruction.hpp

// --- shared/height_coding.hpp


namespace microtin {
namespace {

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

}  // namespace
}  // namespace microtin

// --- shared/hull_coding.hpp

// --- shared/parity_coding.hpp


namespace microtin {
namespace {

// Lattice lines, both ends included.
struct Lines {
  FastInt first, last;
};

inline FastInt count_of(const Lines& lines) {
  return lines.last - lines.first + 1;
}

constexpr FastInt kFewLines = 32;  // of fewer the counts of two halves differ noticeably

// Whether a line of a stream is odd in the pack, where the stream's first one may be.
inline bool is_odd(FastInt line, bool odd_origin) {
  return ((line & 1) != 0) != odd_origin;
}

// How often lines of either parity were met: at least 1, together at most kTallyMost.
struct Tally {
  uint16_t met[2];  // even, odd
};

constexpr uint32_t kTallyMost = 512;

// Of each axis, x or y: of the first line to be known of a place; of the second, where the first is
// even, and where it is odd.
struct Parities {
  Tally first[2], second[2][2];
};

inline void reset(Parities& parities) {
  uint16_t* met = parities.first[0].met;
  for (uint32_t i = 0; i < sizeof parities / sizeof *met; ++i) *met++ = 1;
}

inline bool prefers_one(const Tally& tally) {
  const uint32_t even = tally.met[0], odd = tally.met[1];
  return even > 2 * odd || odd > 2 * even;
}

// When the tally is full all is halved: what is long ago counts less.
inline void learn(Tally& tally, bool odd) {
  uint16_t* const met = tally.met;
  met[odd] = static_cast<uint16_t>(met[odd] + 1u);
  if (static_cast<uint32_t>(met[0]) + met[1] <= kTallyMost) return;
  met[0] = static_cast<uint16_t>((met[0] + 1u) >> 1);
  met[1] = static_cast<uint16_t>((met[1] + 1u) >> 1);
}

// The probability, with 15 bits, that one of several lines, of which any is as likely as the others
// of its parity, is odd.
inline uint32_t probability_of_odd(const Tally& tally, const Lines& lines) {
  uint32_t even = tally.met[0], odd = tally.met[1];
  const FastInt count = count_of(lines);
  if ((count & 1) != 0 && count < kFewLines) {
    const uint32_t half = static_cast<uint32_t>(count >> 1), first = lines.first & 1;
    even *= half + 1u - first;
    odd *= half + first;  // below 2^13
  }
  const int32_t probability = static_cast<int32_t>((odd << 15) / (even + odd));
  return static_cast<uint32_t>(kept_within(
      probability, kProbabilityMargin, static_cast<int32_t>(kProbabilityOne) - kProbabilityMargin));
}

// Lines that are left to choose from: all, or those of one parity. Number i is line step i + base.
struct Ruling {
  Lines numbers;
  FastInt step, base;  // 1, 0 or 2, -1 .. 1
};

inline FastInt line_at(const Ruling& ruling, FastInt number) {
  return ruling.step * number + ruling.base;
}

// Of a line that is one of them.
inline FastInt number_of(const Ruling& ruling, FastInt line) {
  return (line - ruling.base) >> (ruling.step - 1);
}

// Codes the parity of one of several lines, which count from one that may be odd itself, and leaves
// those of this parity.
template <class Coder>
MICROTIN_OUT_OF_LINE void code_parity(Coder& coder, const Tally& tally, Ruling& ruling,
                                      bool odd_origin, FastInt line) {
  const FastInt origin = odd_origin ? 1 : 0;
  const Lines lines = {ruling.numbers.first + origin, ruling.numbers.last + origin};
  const FastInt odd =
      coder.bit(probability_of_odd(tally, lines), ((line + origin) & 1) != 0) ? 1 : 0;
  ruling.numbers = Lines{(lines.first + 1 - odd) >> 1, (lines.last - odd) >> 1};
  ruling.step = 2;
  ruling.base = odd - origin;
}

// Where no parity is preferred none is coded: that would take longer, and save nothing.
template <class Coder>
Ruling rule(Coder& coder, const Tally& tally, const Lines& lines, bool odd_origin, FastInt line) {
  Ruling ruling = {lines, 1, 0};
  if (lines.first < lines.last && prefers_one(tally)) {
    code_parity(coder, tally, ruling, odd_origin, line);
  }
  return ruling;
}

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

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

// How many steps beyond a the next point on an edge at the border is. Such that lead too far give
// 0. `density` is the logarithm of vertices per unit area.
template <class Coder>
int32_t code_gap(Coder& coder, ExponentModel& gap, MantissaModel& mantissa, Parities& parities,
                 const Contract& contract, const HullEdge& edge, Log2 density, FastInt known) {
  const bool along_x = edge.along.y == 0;
  const bool odd =
      along_x ? is_odd(edge.a.x, contract.odd_origin_x) : is_odd(edge.a.y, contract.odd_origin_y);
  Tally& tally = parities.first[along_x ? 0 : 1];
  const Ruling steps = rule(coder, tally, Lines{1, edge.length - 1}, odd, known);
  uint32_t bits = density < 0 ? static_cast<uint32_t>(-density) / (2 * kLog2One) : 0;  // at most 16
  if (steps.step == 2 && bits != 0) --bits;
  const FastInt first = steps.numbers.first;
  const FastInt number = first + static_cast<FastInt>(code_magnitude(
                                     coder, gap, mantissa, bits,
                                     static_cast<uint32_t>(number_of(steps, known) - first)));
  if (number > steps.numbers.last) return 0;
  const FastInt gone = line_at(steps, number);
  learn(tally, is_odd(gone, odd));
  return static_cast<int32_t>(gone);
}

// A point on the edge, if that is at the border, or anywhere. Gaps that lead too far give a, which
// is not beyond the edge.
template <class Coder>
Point code_hull_place(Coder& coder, ExponentModel& gap, MantissaModel& mantissa, Parities& parities,
                      const Contract& contract, const HullEdge& edge, Log2 density) {
  const Vertex next = coder.next();
  Point place = {next.x, next.y};
  if (edge.length == 0) {
    place.x = code_outer_coordinate(coder, contract.x_max, place.x);
    place.y = code_outer_coordinate(coder, contract.y_max, place.y);
    return place;
  }
  const Offset past = place - edge.a;
  const int32_t length = edge.length;
  const int32_t steps =
      code_gap(coder, gap, mantissa, parities, contract, edge, density, absolute(past.x + past.y));
  return Point{static_cast<uint16_t>(edge.a.x + edge.along.x / length * steps),
               static_cast<uint16_t>(edge.a.y + edge.along.y / length * steps)};
}

}  // namespace
}  // namespace microtin

// --- shared/insertion.hpp

// --- shared/sight.hpp

// --- shared/pairs.hpp


#if defined(MICROTIN_PAIRS)

namespace microtin {
namespace {

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

}  // namespace
}  // namespace microtin

#endif


namespace microtin {
namespace {

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

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

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
MICROTIN_IN_PLACE inline bool grow_cavity(const Mesh& mesh, Index start, Point p, Cavity& cavity,
                                          const Forbids& forbids) {
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

}  // namespace
}  // namespace microtin

// --- shared/place_coding.hpp

// --- shared/place_odds.hpp

// --- shared/corner_distances.hpp

// --- shared/legal_places.hpp

// --- shared/free_region.hpp


namespace microtin {
namespace {

// A place in grains, of which a lattice step has 2^shift: the shift is that which brings a
// triangle's corners just below 2^kCornerBits.
struct Spot {
  int32_t x;
  int32_t y;
};

constexpr int32_t kCornerBits = 11;

inline Spot operator-(Spot a, Spot b) {
  return Spot{a.x - b.x, a.y - b.y};
}

// Of corners: below 2^23. Of a corner and a difference of two: below 2^24.
inline int32_t dot(Spot a, Spot b) {
  return a.x * b.x + a.y * b.y;
}

inline int32_t cross(Spot a, Spot b) {
  return a.x * b.y - a.y * b.x;
}

// v * 2^shift, rounded down; the result fits. |v| < 2^19, -26 <= shift <= 10.
#if UINTPTR_MAX > 0xFFFFFFFFu
inline int32_t shifted(FastInt v, int32_t shift) {
  constexpr int32_t kFiner = 32;  // by so much more, which leaves all below 2^61, and back
  return static_cast<int32_t>(v * (static_cast<FastInt>(1) << (shift + kFiner)) >> kFiner);
}
#else
inline int32_t shifted(FastInt v, int32_t shift) {
  return shift >= 0 ? v * (static_cast<FastInt>(1) << shift) : v >> -shift;
}
#endif

inline Spot shifted(Offset v, int32_t shift) {
  return Spot{shifted(v.x, shift), shifted(v.y, shift)};
}

// Has the highest bit of the longer coordinate.
inline uint32_t extent_of(Offset v) {
  return static_cast<uint32_t>(absolute(v.x)) | static_cast<uint32_t>(absolute(v.y));
}

// The bits of an extent but one, if it is not zero.
inline int32_t size_of(uint32_t extent) {
  return static_cast<int32_t>(highest_bit(extent));
}

// The circles through both ends of a side form a pencil, ordered by the cotangent of the angle
// under which the side is seen from the arc to its left. 12 fractional bits, capped.
typedef int32_t Cotangent;
constexpr uint32_t kCotangentBits = 12;
constexpr int32_t kOwnCap = 64, kBehindCap = 16;  // of a triangle's own circle, of that behind

// A divisor brought below 2^12, so that dividends fit.
struct Divisor {
  int32_t h;
  uint32_t shift;
};

// h > 0.
inline Divisor divisor_of(int32_t h) {
  const uint32_t bits = highest_bit(static_cast<uint32_t>(h));
  const uint32_t shift = bits > 11 ? bits - 11 : 0;
  return Divisor{h >> shift, shift};
}

// q / h, at most `most` <= 64 in magnitude.
MICROTIN_IN_PLACE inline Cotangent cotangent(int32_t q, Divisor by, int32_t most) {
  const int32_t h = by.h;
  q = kept_within(q >> by.shift, -h * most, h * most);
  return q * (static_cast<int32_t>(1) << kCotangentBits) / h;
}

// The side from corner i to corner i + 1 of a triangle, and what is known behind it.
struct Side {
  bool certified;    // the triangle behind is final: its circle is empty
  bool ghost;        // ... and lies outside the hull: nothing at all is behind
  Offset apex;       // ... otherwise, the corner opposite to this side
  Cotangent behind;  // ... and the circle there, over this side
};

// All places are relative to corner v.
struct FreeRegion {
  Point origin;      // v
  Offset corner[2];  // c, a: v, c, a turn counter-clockwise and are not on a line
  int32_t shift;     // -5 .. 10
  Spot c, a;
  int32_t cc, aa, ca;       // dot products
  Divisor by_twice;         // twice the area
  Log2 expected;            // log2 of the points that it should hold
  Side chord;               // from a to v, which the walk came across: certified
  Side next;                // from v to c
  bool opposite_certified;  // from c to a: all that counts of it
};

// Area, over the squared chord, of the segment that is seen under k >= 0 (8 fractional bits, at
// most 2^14): 12 fractional bits, at most 1592. It is about 1/6 (k + 0.734) / (k^2 + 0.734 k +
// 0.315), off by at most 1.25 %.
constexpr uint32_t minor_segment(uint32_t k) {
  return (k + 188u) * 174763u / (k * (k + 188u) + 20643u);
}

// Twice the area of a whole disc over the squared chord, pi / 2 (1 + k^2), with k <= 4 (8
// fractional bits): 8 fractional bits, at most 6834.
constexpr uint32_t whole_disc(uint32_t k) {
  return (65536u + (k < 1024 ? k * k : 1024u * 1024u)) * 201u >> 15;
}

#if defined(MICROTIN_LARGE_TABLES)

// Both, for all cotangents up to the largest cap: 64 KB, of which few are met often.
struct SegmentTable {
  struct Entry {
    uint16_t minor, disc;
  } under[kOwnCap * 256 + 1];

  constexpr SegmentTable() : under() {
    uint32_t k = 0;
    for (Entry& entry : under) {
      entry.minor = static_cast<uint16_t>(minor_segment(k));
      entry.disc = static_cast<uint16_t>(whole_disc(k));
      ++k;
    }
  }
};

constexpr SegmentTable kSegments{};

inline uint32_t minor_segment_under(uint32_t k) {
  return kSegments.under[k].minor;
}

inline uint32_t whole_disc_under(uint32_t k) {
  return kSegments.under[k].disc;
}

#else

inline uint32_t minor_segment_under(uint32_t k) {
  return minor_segment(k);
}

inline uint32_t whole_disc_under(uint32_t k) {
  return whole_disc(k);
}

#endif

// Twice the area of the segment to the left of a chord of squared length `square` < 2^25: below
// 2^30. Up to a half disc (k <= 0) it is minor; beyond it is what the disc has left.
inline int32_t segment(uint32_t square, Cotangent fine) {
  const int32_t k = fine >> (kCotangentBits - 8);
  const uint32_t size = static_cast<uint32_t>(k < 0 ? -k : k);
  const int32_t minor = static_cast<int32_t>((square >> 4) * minor_segment_under(size) >> 7);
  if (k <= 0) return minor;
  return static_cast<int32_t>((square >> 8) * whole_disc_under(size)) - minor;
}

// The circle over the side from v to `end`, seen from the apex of the triangle behind it; `turn` is
// 1 if that turns counter-clockwise from `end`, else -1. An apex farther than corners may be counts
// in coarser grains.
inline Cotangent cotangent_behind(const FreeRegion& region, Offset apex, Spot end, int32_t turn) {
  const int32_t beyond = size_of(extent_of(apex)) + region.shift - (kCornerBits - 1);
  const int32_t coarser = beyond > 0 ? beyond : 0;  // at most 16
  const Spot to_apex = shifted(apex, region.shift - coarser);
  end = Spot{end.x >> coarser, end.y >> coarser};
  const int32_t height = turn * cross(end, to_apex) >> coarser;
  return cotangent(dot(to_apex, end - to_apex), divisor_of(height > 1 ? height : 1), kBehindCap);
}

// Brings the corners to grains. Returns twice the area, > 0.
inline int32_t measure(FreeRegion& region) {
  const uint32_t extent = extent_of(region.corner[0]) | extent_of(region.corner[1]);
  region.shift = kCornerBits - 1 - size_of(extent);
  region.c = shifted(region.corner[0], region.shift);
  region.a = shifted(region.corner[1], region.shift);
  region.cc = dot(region.c, region.c);
  region.aa = dot(region.a, region.a);
  region.ca = dot(region.c, region.a);
  const int32_t twice = cross(region.c, region.a), kept = twice > 1 ? twice : 1;
  region.by_twice = divisor_of(kept);
  return kept;
}

// Twice what an open side lets the circle add; the opposite corner sees it under q / twice.
inline int32_t segment_beyond(const FreeRegion& region, int32_t square, int32_t q) {
  return segment(static_cast<uint32_t>(square), cotangent(q, region.by_twice, kBehindCap));
}

// Twice what the circle behind a side from v to `end` takes away. Finds the circle.
inline int32_t segment_behind(const FreeRegion& region, Side& side, Spot end, int32_t square,
                              int32_t turn) {
  if (side.ghost) return 0;
  side.behind = cotangent_behind(region, side.apex, end, turn);
  return segment(static_cast<uint32_t>(square), side.behind);
}

// log2 of the free region's area in lattice units: the triangle and what its circle reaches beyond
// open sides, less what circles behind certified sides reach into it, but never less than a part
// of the triangle. Two segments below 2^30 and a triangle below 2^23 fit.
MICROTIN_OUT_OF_LINE inline Log2 free_area(FreeRegion& region) {
  const int32_t triangle = measure(region);
  const int32_t cc = region.cc, aa = region.aa, ca = region.ca;
  int32_t twice = triangle;
  twice += region.next.certified ? -segment_behind(region, region.next, region.c, cc, -1)
                                 : segment_beyond(region, cc, ca - aa);
  if (!region.opposite_certified) twice += segment_beyond(region, cc + aa - 2 * ca, -ca);
  twice -= segment_behind(region, region.chord, region.a, aa, 1);
  const int32_t least = (triangle >> 4) + 1;
  return rough_log2(static_cast<uint32_t>(twice > least ? twice : least)) -
         (2 * region.shift + 1) * kLog2One;
}

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

// A circle through v, in grains: at x it reaches from y - r to y + r with r^2 = x (x2 - x) + yy.
struct Circle {
  int32_t x2;  // twice the centre's x
  int32_t y;   // the centre's y
  int32_t yy;  // its square
};

// A part of a column, in grains.
struct Span {
  int32_t low, high;
};

struct LegalPlaces {
  int32_t turns;             // quarters, counter-clockwise
  int32_t shift;             // of grains: -10 .. 10
  Lines columns, rows;       // of the lattice
  Span height;               // the lattice's rows in grains
  Spot c, a;                 // corners, below 2^11
  Circle own;                // its centre is below 2^13, its radius below 2^13.5
  Circle behind[2];          // the chord, side 0
  bool cuts[2];              // whether that circle is known and near
  bool odd_column, odd_row;  // whether v's are odd
};

template <class Place>
Place turned(Place p, int32_t turns) {
  if ((turns & 1) != 0) p = Place{-p.y, p.x};
  return (turns & 2) != 0 ? Place{-p.x, -p.y} : p;
}

inline int32_t turns_for(Offset a) {
  if (absolute(a.x) >= absolute(a.y)) return a.x < 0 ? 0 : 2;
  return a.y > 0 ? 1 : 3;
}

inline Lines in_order(FastInt a, FastInt b) {
  return a < b ? Lines{a, b} : Lines{b, a};
}

// Twice the centre of the circle through v and `end`, seen from the right of v -> end under k:
// below 2^18, products below 2^29.
inline Spot twice_centre(Spot end, Cotangent k) {
  return Spot{end.x + (k * end.y >> kCotangentBits), end.y - (k * end.x >> kCotangentBits)};
}

// The circle of that centre, which is below 2^15 after the shift: so is its square below 2^30.
inline Circle circle_about(Spot twice, uint32_t shift) {
  const int32_t y = twice.y >> (1 + shift);
  return Circle{twice.x >> shift, y, y * y};
}

// How much coarser grains must be for a centre below 2^13; at most 4.
inline uint32_t coarsening_for(Spot twice) {
  const uint32_t bits = highest_bit(static_cast<uint32_t>(absolute(twice.x >> 1)) |
                                    static_cast<uint32_t>(absolute(twice.y >> 1)) | 1u);
  return bits > 12 ? bits - 12 : 0;
}

inline Spot coarser(Spot p, uint32_t shift) {
  return Spot{p.x >> shift, p.y >> shift};
}

// Whether there is a circle behind a side, and near enough to be told from a line.
inline bool cuts(const Side& side) {
  return side.certified && !side.ghost && side.behind > -kBehindCap * (1 << kCotangentBits);
}

inline void find_lattice(LegalPlaces& places, const Contract& contract, Point origin) {
  const Offset first = turned(Point{0, 0} - origin, places.turns);
  const Offset last = turned(Point{contract.x_max, contract.y_max} - origin, places.turns);
  places.columns = in_order(first.x, last.x);
  places.rows = in_order(first.y, last.y);
  const bool odd_x = is_odd(origin.x, contract.odd_origin_x);
  const bool odd_y = is_odd(origin.y, contract.odd_origin_y);
  const bool upright = (places.turns & 1) == 0;
  places.odd_column = upright ? odd_x : odd_y;
  places.odd_row = upright ? odd_y : odd_x;
  places.height =
      Span{shifted(places.rows.first, places.shift), shifted(places.rows.last, places.shift)};
}

// `own` and `behind` are the cotangents over the chord.
inline void find_places(LegalPlaces& places, const FreeRegion& region, const Contract& contract,
                        Cotangent own, Cotangent behind) {
  places.turns = turns_for(region.corner[1]);
  const Spot c = turned(region.c, places.turns), a = turned(region.a, places.turns);
  const Spot centre = twice_centre(a, own);
  const uint32_t shift = coarsening_for(centre);
  places.shift = region.shift - static_cast<int32_t>(shift);
  places.own = circle_about(centre, shift);
  const Side &chord = region.chord, &next = region.next;
  places.cuts[0] = cuts(chord);
  places.cuts[1] = cuts(next);
  if (places.cuts[0]) places.behind[0] = circle_about(twice_centre(a, behind), shift);
  if (places.cuts[1]) places.behind[1] = circle_about(twice_centre(c, -next.behind), shift);
  places.c = coarser(c, shift);
  places.a = coarser(a, shift);
  find_lattice(places, contract, region.origin);
}

// Lines from `low` to `high`, in grains. Where a step has less than one, lines count as far as
// their grain does.
inline Lines lines_within(int32_t low, int32_t high, int32_t shift) {
  if (shift >= 0) {
    return Lines{(low + (static_cast<int32_t>(1) << shift) - 1) >> shift, high >> shift};
  }
  const FastInt steps = static_cast<FastInt>(1) << -shift;
  return Lines{low * steps, (high + 1) * steps - 1};
}

// Twice a coordinate to grains.
inline int32_t grains(FastInt twice, int32_t shift) {
  return shifted(twice, shift - 1);
}

// Whether e is on the right of p -> q. Of corners and the own circle: below 2^27.
inline bool is_beyond(Spot p, Spot q, Spot e) {
  return cross(q - p, e - p) < 0;
}

// Whether a place on the own circle is legal as far as sides tell.
inline bool is_open(const LegalPlaces& places, const FreeRegion& region, Spot e) {
  const Spot v = {0, 0};
  return !is_beyond(places.a, v, e) && !(region.next.certified && is_beyond(v, places.c, e)) &&
         !(region.opposite_certified && is_beyond(places.c, places.a, e));
}

struct Columns {
  Lines lines;
  bool open_west, open_east;  // whether they end where the circle does; else at a corner
};

// The columns with legal places. That of v is one of them.
inline Columns legal_columns(const LegalPlaces& places, const FreeRegion& region) {
  const Spot centre = {places.own.x2 >> 1, places.own.y};
  const uint32_t square = static_cast<uint32_t>(centre.x * centre.x + places.own.yy);
  const int32_t radius = (square == 0 ? 0 : static_cast<int32_t>(fine_root(square))) + 1;
  int32_t west = places.c.x < places.a.x ? places.c.x : places.a.x;
  int32_t east = places.c.x > 0 ? places.c.x : 0;
  Columns columns;
  const Spot west_end = {centre.x - radius, centre.y}, east_end = {centre.x + radius, centre.y};
  columns.open_west = is_open(places, region, west_end);
  columns.open_east = is_open(places, region, east_end);
  if (columns.open_west && west_end.x < west) west = west_end.x;
  if (columns.open_east && east_end.x > east) east = east_end.x;
  columns.lines = lines_within(west, east, places.shift);
  const Lines& lattice = places.columns;
  if (columns.lines.first < lattice.first) columns.lines.first = lattice.first;
  if (columns.lines.last > lattice.last) columns.lines.last = lattice.last;
  return columns;
}

// Roots for many columns, and for one.
struct RoughRoot {
  int32_t operator()(int32_t v) const {
    return static_cast<int32_t>(rough_root(static_cast<uint32_t>(v)));
  }
};
struct FineRoot {
  int32_t operator()(int32_t v) const {
    return static_cast<int32_t>(fine_root(static_cast<uint32_t>(v)));
  }
};

// Takes away what lies within a circle, at one end.
MICROTIN_IN_PLACE inline void cut(Span& span, int32_t from, int32_t to) {
  if (from <= span.low) {
    if (to > span.low) span.low = to;
  } else if (to >= span.high && from < span.high) {
    span.high = from;
  }
}

// The square of half of what a circle covers at x, below 2^30; negative beside it.
inline int32_t square_at(const Circle& circle, int32_t x) {
  return x * (circle.x2 - x) + circle.yy;
}

// What the own circle covers at x, whose radius is taken to be `wider`.
template <class Root>
Span own_span(const Circle& own, int32_t x, int32_t wider, const Root& root) {
  const int32_t square = square_at(own, x);
  const int32_t radius = (square > 0 ? root(square) : 0) + wider;
  return Span{own.y - radius, own.y + radius};
}

// The legal part of it. Circles behind are taken to be narrower.
template <class Root>
Span legal_span(const LegalPlaces& places, int32_t x, Span span, int32_t narrower,
                const Root& root) {
  for (int i = 0; i < 2; ++i) {
    const Circle& circle = places.behind[i];
    if (!places.cuts[i]) continue;
    const int32_t square = square_at(circle, x);
    if (square <= 0) continue;
    const int32_t radius = root(square) - narrower;
    cut(span, circle.y - radius, circle.y + radius);
  }
  if (span.low < places.height.low) span.low = places.height.low;
  if (span.high > places.height.high) span.high = places.height.high;
  return span;
}

// The rows of a span: at least one of the lattice.
inline Lines legal_rows(const LegalPlaces& places, Span span) {
  Lines rows = lines_within(span.low, span.high, places.shift);
  if (rows.first < places.rows.first) rows.first = places.rows.first;
  if (rows.first > places.rows.last) rows.first = places.rows.last;
  if (rows.last > places.rows.last) rows.last = places.rows.last;
  if (rows.last < rows.first) rows.last = rows.first;
  return rows;
}

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

// The squared distance, in grains, from which on nothing counts, at most 2^28; 255 / it.
struct Reach {
  int32_t square;
  uint32_t shift, factor;
};

// `square` is its logarithm, 2 .. 28.
inline Reach reach_of(Log2 square) {
  const uint32_t bits = static_cast<uint32_t>(square) >> 8;
  Reach reach;
  reach.square = static_cast<int32_t>(rough_exp2(square));
  reach.shift = bits > 14 ? bits - 14 : 0;
  reach.factor = 255u * 65536u / static_cast<uint32_t>(reach.square >> reach.shift);
  return reach;
}

inline int32_t squared_distance(Spot p, int32_t x, int32_t y) {
  return (p.x - x) * (p.x - x) + (p.y - y) * (p.y - y);  // < 2^30.5
}

// 255 times a squared distance, at most the reach, over that: 0..255.
inline int32_t part_of(const Reach& reach, int32_t square) {
  return static_cast<int32_t>((static_cast<uint32_t>(square) >> reach.shift) * reach.factor >> 16);
}

// 0..255, from the corners v, c and a. |x| < 2^14.5, |y| < 2^15.2.
inline int32_t distance_at(const Reach& reach, const LegalPlaces& places, int32_t x, int32_t y) {
  const int32_t from_v = x * x + y * y;
  const int32_t from_c = squared_distance(places.c, x, y);
  const int32_t from_a = squared_distance(places.a, x, y);
  int32_t least = from_v < reach.square ? from_v : reach.square;
  if (from_c < least) least = from_c;
  if (from_a < least) least = from_a;
  return part_of(reach, least);
}

#if defined(MICROTIN_PAIRS)

// Of two places of a column.
struct Distances {
  int32_t low, high;
};

// With 16 bits for coordinates and differences, which saturate: whatever does not fit is, saturated
// or not, more than 2^15 - 2^11 away, beyond any reach. x fits, so sums of squares stay below
// 25217^2 + 2^30 < 2^31.
#if defined(__SSE2__)

inline __m128i smaller(__m128i a, __m128i b) {
  const __m128i is_less = _mm_cmplt_epi32(a, b);
  return _mm_or_si128(_mm_and_si128(is_less, a), _mm_andnot_si128(is_less, b));
}

inline Distances distances_at(const Reach& reach, const LegalPlaces& places, int32_t x, int32_t low,
                              int32_t high) {
  const __m128i y = _mm_unpacklo_epi32(_mm_cvtsi32_si128(low), _mm_cvtsi32_si128(high));
  const __m128i xx = _mm_shufflelo_epi16(_mm_cvtsi32_si128(x), 0);
  const __m128i both = _mm_unpacklo_epi16(xx, _mm_packs_epi32(y, y));
  const __m128i from = _mm_shuffle_epi32(both, 0x50);  // low, low, high, high
  const __m128i c = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(&places.c));
  const __m128i a = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(&places.a));
  const __m128i corners = _mm_unpacklo_epi64(c, a);
  const __m128i to = _mm_subs_epi16(_mm_packs_epi32(corners, corners), from);
  const __m128i least = smaller(_mm_madd_epi16(to, to), _mm_madd_epi16(from, from));
  const __m128i squares = smaller(smaller(least, _mm_shuffle_epi32(least, 0xB1)),
                                  _mm_shuffle_epi32(_mm_cvtsi32_si128(reach.square), 0));
  const __m128i shifted = _mm_srl_epi32(squares, _mm_cvtsi32_si128(static_cast<int>(reach.shift)));
  const __m128i factor =
      _mm_shuffle_epi32(_mm_cvtsi32_si128(static_cast<int32_t>(reach.factor)), 0);
  const __m128i parts = _mm_srli_epi64(_mm_mul_epu32(shifted, factor), 16);
  return Distances{_mm_cvtsi128_si32(parts), _mm_cvtsi128_si32(_mm_unpackhi_epi64(parts, parts))};
}

#else

inline int16x2_t pair_of(int32_t x, int32_t y) {
  return static_cast<int16x2_t>((static_cast<uint32_t>(x) & 0xFFFFu) |
                                static_cast<uint32_t>(kept_within(y, -32768, 32767)) << 16);
}

inline int32_t squared(int16x2_t way) {
  return __smuad(way, way);
}

inline int32_t distance_of(const Reach& reach, int16x2_t c, int16x2_t a, int16x2_t from) {
  const int32_t from_v = squared(from);
  const int32_t from_c = squared(__qsub16(c, from));
  const int32_t from_a = squared(__qsub16(a, from));
  int32_t least = from_v < reach.square ? from_v : reach.square;
  if (from_c < least) least = from_c;
  if (from_a < least) least = from_a;
  return part_of(reach, least);
}

inline Distances distances_at(const Reach& reach, const LegalPlaces& places, int32_t x, int32_t low,
                              int32_t high) {
  const int16x2_t c = pair_of(places.c.x, places.c.y), a = pair_of(places.a.x, places.a.y);
  return Distances{distance_of(reach, c, a, pair_of(x, low)),
                   distance_of(reach, c, a, pair_of(x, high))};
}

#endif

#endif

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

// How close vertices come: over the points per unit area, the inverse of a squared distance, such
// that one in 192 * 256 / crowding places is closer than that to a corner. 8 fractional bits.
typedef uint32_t Crowding;
constexpr Crowding kCrowdingStart = 2048, kCrowdingLeast = 512, kCrowdingMost = 65536;

struct PlaceOdds {
  bool repels;
  // 511 * chance of being first, f of the way from the triangle's circle to that behind the chord:
  // last + f (linear + f bend).
  int32_t last, linear, bend;
  // The power of a place with respect to the circle behind less that to the triangle's: across.x x
  // + across.y y, both below 2^16.
  Spot across;
  Reach reach;  // of repulsion
};

// 511 * chance of being first after twice the swept area; `rate` is the logarithm of the density by
// that unit, times log2(e), with 8 fractional bits more. |rate| < 2^15.
inline int32_t chance_after(int32_t twice, Log2 rate) {
  if (twice <= 0) return 511;
  const Log2 loss = rough_log2(static_cast<uint32_t>(twice)) + rate;
  if (loss >= 12 * kLog2One) return 0;
  return static_cast<int32_t>(rough_exp2(9 * kLog2One - 1 - static_cast<Log2>(rough_exp2(loss))));
}

// `density` is the logarithm of points per unit area, `own` and `behind` the cotangents over the
// chord.
inline void estimate_sweep(PlaceOdds& odds, const LegalPlaces& places, const FreeRegion& region,
                           Log2 density, Cotangent own, Cotangent behind) {
  // log2(log2(e)) = 135 / 256.
  const Log2 rate = density - (2 * region.shift + 1) * kLog2One + 135 + 8 * kLog2One;
  const uint32_t square = static_cast<uint32_t>(region.aa);
  const int32_t start = segment(square, behind);
  const int32_t last = chance_after(segment(square, own) - start, rate);
  const int32_t middle = chance_after(segment(square, (own + behind) >> 1) - start, rate);
  odds.last = last;
  odds.linear = 4 * middle - 3 * last - 511;
  odds.bend = 2 * (last + 511 - 2 * middle);
  const Spot a = turned(region.a, places.turns);
  const uint32_t shift = static_cast<uint32_t>(region.shift - places.shift) + kCotangentBits;
  odds.across = Spot{(own - behind) * a.y >> shift, (behind - own) * a.x >> shift};  // < 2^30
}

inline void estimate_repulsion(PlaceOdds& odds, const LegalPlaces& places, Log2 density,
                               Crowding crowding) {
  // log2 of what is 255 / 2^16 of the inverse of the squared distance that counts.
  const Log2 inverse = rough_log2(crowding) - 8 * kLog2One + density - 2 * places.shift * kLog2One;
  odds.reach = reach_of(kept_within(-inverse, 2 * kLog2One, 28 * kLog2One));
}

// 0..511. `own` is what the triangle's circle covers of the column, and holds y: |x|, |y| < 2^14.4.
inline int32_t chance_at(const PlaceOdds& odds, Span own, int32_t x, int32_t y) {
  const int32_t all = odds.across.x * x + odds.across.y * y;  // < 2^31
  if (all <= 0) return 511;
  const int32_t above = own.high - y, below = y - own.low;
  const int32_t left = above * below;  // < 2^28
  if (left <= 0) return odds.last;
  const uint32_t f = static_cast<uint32_t>(left) / ((static_cast<uint32_t>(all) >> 8) + 1);
  if (f >= 256) return 511;
  const int32_t way = static_cast<int32_t>(f);
  const int32_t chance = odds.last + (way * (odds.linear + (way * odds.bend >> 8)) >> 8);
  return chance > 0 ? chance : 0;
}

// Of two places, or of all in two halves.
struct Halves {
  uint32_t low, high;  // weights, 1..2^15
};

#if defined(MICROTIN_PAIRS)

// Of two places of a column: 4..521 each.
inline Halves weights_at(const PlaceOdds& odds, const LegalPlaces& places, Span own, int32_t x,
                         int32_t low, int32_t high) {
  int32_t first = chance_at(odds, own, x, low), second = chance_at(odds, own, x, high);
  if (odds.repels) {
    const Distances distance = distances_at(odds.reach, places, x, low, high);
    first = first * (distance.low + 4) >> 8;
    second = second * (distance.high + 4) >> 8;
  }
  return Halves{static_cast<uint32_t>(first) + 4u, static_cast<uint32_t>(second) + 4u};
}

#else

inline uint32_t weight_at(const PlaceOdds& odds, const LegalPlaces& places, Span own, int32_t x,
                          int32_t y) {
  int32_t weight = chance_at(odds, own, x, y);
  if (odds.repels) weight = weight * (distance_at(odds.reach, places, x, y) + 4) >> 8;
  return static_cast<uint32_t>(weight) + 4u;
}

inline Halves weights_at(const PlaceOdds& odds, const LegalPlaces& places, Span own, int32_t x,
                         int32_t low, int32_t high) {
  return Halves{weight_at(odds, places, own, x, low), weight_at(odds, places, own, x, high)};
}

#endif

// Of a column: its legal length times the mean weight. 4..2^14.6.
inline uint32_t column_weight(const PlaceOdds& odds, const LegalPlaces& places, int32_t x) {
  const Span own = own_span(places.own, x, 0, RoughRoot());
  const Span legal = legal_span(places, x, own, 0, RoughRoot());
  const int32_t length = legal.high - legal.low;
  if (length <= 0) return 4;
  const int32_t quarter = length >> 2;
  const Halves weight = weights_at(odds, places, own, x, legal.low + quarter, legal.high - quarter);
  return (static_cast<uint32_t>(length) * (weight.low + weight.high) >> 10) + 4u;
}

// `place` in grains: where the point was.
inline void learn(Crowding& crowding, const PlaceOdds& odds, const LegalPlaces& places,
                  Spot place) {
  if (distance_at(odds.reach, places, place.x, place.y) < 254) crowding += crowding >> 4;
  crowding -= 12;
  if (crowding < kCrowdingLeast) crowding = kCrowdingLeast;
  if (crowding > kCrowdingMost) crowding = kCrowdingMost;
}

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

constexpr uint32_t kLevels = 4;  // most halvings
constexpr uint32_t kColumnContexts = 16, kRowContexts = 12;

// The two halvings of quick decoding: the first, the second in the lower and in the upper half.
struct Quarters {
  AdaptiveBit bit[3];
};

struct PlaceModel {
  Calibration column[kLevels], row[kLevels];  // odds learned for the estimated ones
  Quarters quick_column[kColumnContexts], quick_row[kRowContexts];
  AdaptiveBit escape;
};

// How often lines are halved, and how often by weights taken at the middles of both halves; after
// that the last two tell what is left.
struct Depth {
  uint32_t weighed, halvings;
};

inline Depth depth_of(Decoding decoding) {
  if (decoding == Decoding::kQuick) return Depth{0, 0};
  return Depth{decoding == Decoding::kDense ? 4u : 3u, kLevels};
}

// Keeps the upper or the lower half.
inline void halve(Lines& lines, bool upper) {
  const FastInt half = count_of(lines) >> 1;
  if (upper) {
    lines.first += half;
  } else {
    lines.last = lines.first + half - 1;
  }
}

inline bool is_in_upper_half(const Lines& lines, FastInt line) {
  return line - lines.first >= count_of(lines) >> 1;
}

// Codes a line in one of four quarters, if there are so many lines; keeps the quarter.
template <class Coder>
void code_quarter(Coder& coder, Quarters& quarters, Lines& lines, FastInt line) {
  if (count_of(lines) < 4) return;
  const bool upper = code_bit(coder, quarters.bit[0], is_in_upper_half(lines, line));
  halve(lines, upper);
  halve(lines, code_bit(coder, quarters.bit[upper ? 2 : 1], is_in_upper_half(lines, line)));
}

template <class Coder>
bool code_half(Coder& coder, Calibration& calibration, Lines& lines, Halves weight, FastInt line) {
  const FastInt count = count_of(lines), half = count >> 1;
  if (count < kFewLines) {
    weight.low *= static_cast<uint32_t>(half);
    weight.high *= static_cast<uint32_t>(count - half);
  }
  const uint32_t share = (weight.high << 11) / (weight.low + weight.high + 1) << 4;  // < 2^31
  const bool upper = code_calibrated(coder, calibration, share, is_in_upper_half(lines, line));
  halve(lines, upper);
  return upper;
}

// The halves of a half, on the line through the weights of both, but at least a quarter of its own.
inline Halves halves_of(Halves weight, bool upper) {
  const int32_t low = static_cast<int32_t>(weight.low), high = static_cast<int32_t>(weight.high);
  const int32_t tilt = (high - low) >> 2, mean = upper ? high : low, least = (mean >> 2) + 1;
  const int32_t first = mean - tilt, second = mean + tilt;
  return Halves{static_cast<uint32_t>(first > least ? first : least),
                static_cast<uint32_t>(second > least ? second : least)};
}

// Keeps of `lines` a part that holds `line`. `weigh` is asked at twice two numbers.
template <class Coder, class Weigh>
void code_halves(Coder& coder, Calibration* level, Lines& lines, FastInt line, Depth depth,
                 const Weigh& weigh) {
  Halves weight;  // number by number: on AVR a constant to copy from would be in RAM
  weight.low = 1;
  weight.high = 1;
  bool upper = false;
  for (uint32_t i = 0; i < depth.halvings && lines.first < lines.last; ++i) {
    if (i < depth.weighed) {
      const FastInt count = count_of(lines), middle = 2 * lines.first + (count >> 1) - 1;
      weight = weigh(middle, middle + count);
    } else {
      weight = halves_of(weight, upper);
    }
    upper = code_half(coder, level[i], lines, weight, line);
  }
}

// Codes one of `lines`, all equally likely.
template <class Coder>
FastInt code_line(Coder& coder, const Lines& lines, FastInt line) {
  return lines.first +
         static_cast<FastInt>(coder.uniform(static_cast<uint32_t>(count_of(lines)),
                                            static_cast<uint32_t>(line - lines.first)));
}

// The chance of a hit here, roughly: the logarithm of the points that the free region should hold.
inline uint32_t expected_points(const FreeRegion& region) {
  return static_cast<uint32_t>(kept_within((region.expected + kLog2One) >> 8, 0, 3));
}

struct Place {
  LegalPlaces legal;
  PlaceOdds odds;
};

// What is learned of places beside adaptive bits.
struct PlaceHabits {
  Crowding crowding;
  Parities parities;
};

inline void reset(PlaceHabits& habits) {
  habits.crowding = kCrowdingStart;
  reset(habits.parities);
}

// Twice a number, plus the base, counts grains times 2^-this.
inline int32_t twice_shift(const Ruling& ruling, int32_t shift) {
  return shift - (ruling.step == 1 ? 1 : 0);
}

// Codes x, or the nearest column with legal places.
template <class Coder>
MICROTIN_IN_PLACE inline FastInt code_column(Coder& coder, PlaceModel& model, const Tally& tally,
                                             const FreeRegion& region, const Place& place,
                                             Depth depth, FastInt x) {
  const LegalPlaces& legal = place.legal;
  const Columns columns = legal_columns(legal, region);
  if (x < columns.lines.first) x = columns.lines.first;
  if (x > columns.lines.last) x = columns.lines.last;
  Ruling ruling = rule(coder, tally, columns.lines, legal.odd_column, x);
  const FastInt number = number_of(ruling, x);
  if (depth.weighed == 0) {
    const uint32_t context = (columns.open_east ? 0u : 1u) + (columns.open_west ? 0u : 2u) +
                             (region.next.certified ? 4u : 0u) +
                             (expected_points(region) > 1 ? 8u : 0u);
    code_quarter(coder, model.quick_column[context], ruling.numbers, number);
  } else {
    const FastInt base = ruling.base;
    const int32_t shift = twice_shift(ruling, legal.shift);
    code_halves(
        coder, model.column, ruling.numbers, number, depth, [=, &place](FastInt low, FastInt high) {
          return Halves{column_weight(place.odds, place.legal, shifted(low + base, shift)),
                        column_weight(place.odds, place.legal, shifted(high + base, shift))};
        });
  }
  return line_at(ruling, code_line(coder, ruling.numbers, number));
}

template <class Coder>
MICROTIN_IN_PLACE inline FastInt code_row(Coder& coder, PlaceModel& model, const Tally& tally,
                                          const FreeRegion& region, const Place& place, Depth depth,
                                          Offset at, Lines rows, Span own) {
  const LegalPlaces& legal = place.legal;
  const int32_t x = grains(2 * at.x, legal.shift);
  Ruling ruling = rule(coder, tally, rows, legal.odd_row, at.y);
  const FastInt number = number_of(ruling, at.y);
  if (depth.weighed == 0) {
    const uint32_t zone = x < legal.a.x ? 4u : x > 0 ? 8u : 0u;
    code_quarter(coder, model.quick_row[zone + expected_points(region)], ruling.numbers, number);
  } else {
    const FastInt base = ruling.base;
    const int32_t shift = twice_shift(ruling, legal.shift);
    code_halves(coder, model.row, ruling.numbers, number, depth,
                [=, &place](FastInt low, FastInt high) {
                  return weights_at(place.odds, place.legal, own, x, shifted(low + base, shift),
                                    shifted(high + base, shift));
                });
  }
  return line_at(ruling, code_line(coder, ruling.numbers, number));
}

// Codes `at`, as seen from v and turned.
template <class Coder>
MICROTIN_IN_PLACE inline Offset code_turned_place(Coder& coder, PlaceModel& model,
                                                  const FreeRegion& region, const Place& place,
                                                  Decoding decoding, Offset at,
                                                  PlaceHabits& habits) {
  const Depth depth = depth_of(decoding);
  const LegalPlaces& legal = place.legal;
#if defined(__clang_analyzer__)
  if (legal.shift < -10 || legal.shift > 10) return at;  // never: it does not follow so far
#endif
  Tally& first = habits.parities.first[legal.turns & 1];
  const FastInt x = code_column(coder, model, first, region, place, depth, at.x);
  const int32_t column = grains(2 * x, legal.shift);
  const Span own = own_span(legal.own, column, 1, FineRoot());
  const Lines rows = legal_rows(legal, legal_span(legal, column, own, 1, FineRoot()));
  Tally& second = habits.parities.second[legal.turns & 1][is_odd(x, legal.odd_column) ? 1 : 0];
  const bool missed = x != at.x || at.y < rows.first || at.y > rows.last;
  if (code_bit(coder, model.escape, missed)) {
    at.x = code_line(coder, legal.columns, at.x);
    at.y = code_line(coder, legal.rows, at.y);
    return at;
  }
  at = Offset{x, code_row(coder, model, second, region, place, depth, Offset{x, at.y}, rows, own)};
  learn(first, is_odd(at.x, legal.odd_column));
  learn(second, is_odd(at.y, legal.odd_row));
  if (place.odds.repels) {
    learn(habits.crowding, place.odds, legal, Spot{column, grains(2 * at.y, legal.shift)});
  }
  return at;
}

// Codes the next vertex's place, as seen from v. `density` is the logarithm of points per unit
// area.
template <class Coder>
Offset code_place(Coder& coder, PlaceModel& model, const FreeRegion& region,
                  const Contract& contract, Log2 density, Place& place, PlaceHabits& habits) {
  const Cotangent own = cotangent(region.cc - region.ca, region.by_twice, kOwnCap);
  const Side& chord = region.chord;
  Cotangent behind = chord.ghost ? -4 * (1 << kCotangentBits) : chord.behind;
  if (behind > own) behind = own;
  find_places(place.legal, region, contract, own, behind);
  place.odds.repels = contract.has_heights && contract.decoding != Decoding::kQuick;
  if (contract.decoding != Decoding::kQuick) {
    estimate_sweep(place.odds, place.legal, region, density, own, behind);
    if (place.odds.repels) estimate_repulsion(place.odds, place.legal, density, habits.crowding);
  }
  const Vertex next = coder.next();
  const Offset known = turned(Point{next.x, next.y} - region.origin, place.legal.turns);
  const Offset at =
      code_turned_place(coder, model, region, place, contract.decoding, known, habits);
  return turned(at, -place.legal.turns & 3);
}

}  // namespace
}  // namespace microtin

// --- shared/start_probabilities.hpp


namespace microtin {
namespace {

constexpr uint32_t kStarts = 400;

// clang-format off
constexpr uint8_t kStartTable[kStarts] MICROTIN_IN_FLASH = {
    4, 18, 9, 12, 36, 88, 159, 220, 248, 254, 255, 255, 255, 255, 241, 5,
    18, 25, 33, 63, 116, 183, 230, 249, 254, 254, 255, 255, 252, 246, 3, 8,
    8, 13, 39, 84, 163, 222, 244, 253, 255, 255, 253, 232, 112, 0, 0, 0,
    2, 6, 44, 34, 9, 6, 18, 248, 252, 254, 255, 255, 1, 0, 6, 4,
    3, 16, 46, 102, 193, 243, 253, 255, 255, 254, 255, 4, 1, 2, 1, 4,
    28, 81, 153, 229, 252, 255, 255, 255, 255, 247, 9, 5, 2, 19, 3, 33,
    68, 74, 105, 160, 209, 238, 248, 252, 254, 20, 46, 78, 90, 118, 153, 182,
    209, 241, 8, 23, 48, 76, 102, 156, 205, 230, 244, 5, 19, 41, 79, 122,
    160, 191, 221, 244, 15, 49, 64, 86, 123, 162, 187, 201, 221, 11, 34, 47,
    88, 117, 137, 163, 212, 248, 8, 25, 51, 84, 120, 154, 195, 217, 254, 24,
    48, 62, 88, 118, 157, 193, 221, 254, 59, 83, 80, 93, 117, 151, 183, 223,
    249, 124, 206, 60, 75, 148, 63, 175, 238, 96, 150, 197, 78, 122, 228, 39,
    89, 176, 40, 170, 226, 89, 120, 209, 53, 118, 227, 55, 106, 176, 93, 142,
    233, 68, 104, 124, 97, 84, 225, 36, 162, 220, 78, 148, 177, 102, 206, 181,
    135, 143, 193, 103, 104, 199, 72, 66, 168, 60, 14, 85, 36, 111, 159, 103,
    109, 186, 84, 91, 182, 76, 37, 140, 51, 128, 168, 104, 113, 193, 75, 80,
    177, 67, 22, 119, 35, 0, 187, 160, 132, 189, 176, 57, 69, 187, 160, 132,
    197, 186, 58, 63, 187, 160, 159, 127, 71, 69, 56, 187, 160, 177, 129, 70,
    54, 41, 187, 173, 129, 69, 47, 25, 38, 187, 169, 137, 110, 72, 35, 31,
    170, 135, 108, 77, 86, 61, 29, 173, 143, 131, 174, 162, 97, 40, 150, 135,
    122, 148, 129, 65, 37, 166, 127, 131, 196, 191, 147, 75, 140, 135, 113, 200,
    204, 146, 55, 108, 92, 56, 101, 140, 96, 116, 109, 109, 98, 80, 66, 72,
    79, 63, 58, 42, 157, 173, 209, 158, 153, 194, 149, 155, 176, 140, 127, 151,
    138, 139, 138, 135, 110, 108, 127, 129, 104, 126, 96, 80, 109, 98, 63, 107,
    68, 41, 232, 201, 166, 175, 135, 73, 38, 0, 0, 1, 6, 157, 247, 252,
};
// clang-format on

inline uint32_t table_start(uint32_t i) {
  return read_table(kStartTable + i);
}

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

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

enum class StepOutcome : uint8_t {
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

  PlaceHabits habits;
  // Of the triangle in hand: here to spare the stack.
  FreeRegion region;
  Place place;

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
  reset(r.habits);
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

// The corner opposite to a side whose half-edge beyond is h.
inline Index apex_behind(const Mesh& mesh, Index h) {
  return mesh.origin[previous_in_triangle(h)];
}

inline void look_at(const Reconstruction& r, Index apex, Side& side) {
  side.certified = true;
  side.ghost = apex == kInfinity;
  if (!side.ghost) side.apex = point_of(*r.mesh, apex) - r.region.origin;
}

// Describes the free region of the real triangle (v, c, a) whose half-edge a -> v is the chord.
// What is behind that was passed in this turn, or has a done vertex.
inline void look_around(Reconstruction& r, Index into) {
  FreeRegion& region = r.region;
  const Mesh& mesh = *r.mesh;
  region.origin = point_of(mesh, r.vertex);
  region.corner[0] = point_of(mesh, mesh.origin[into]) - region.origin;
  region.corner[1] = point_of(mesh, mesh.origin[r.chord]) - region.origin;
  const Index next = apex_behind(mesh, into);
  region.next.certified = marked(r, next, kDone);
  if (region.next.certified) look_at(r, next, region.next);
  const Index across = mesh.twin[previous_in_triangle(r.chord)];
  region.opposite_certified = marked(r, apex_behind(mesh, across), kDone);
  look_at(r, apex_behind(mesh, mesh.twin[r.chord]), region.chord);
}

// log2 of the mean area of a Delaunay triangle of random points less the mean log2 of it.
constexpr Log2 kMeanOfLogs = 220;

// Of the origin, a, b, counter-clockwise, if each sees the others on the lattice: below 2^32.
inline uint32_t twice_area(Offset a, Offset b) {
  return wrapping_product32(static_cast<int32_t>(a.x), static_cast<int32_t>(b.y)) -
         wrapping_product32(static_cast<int32_t>(a.y), static_cast<int32_t>(b.x));
}

// Takes a final triangle into the running mean of what such suggest about the density: of n final
// vertices each has two triangles to itself, and of these vertices `share` are the batch's.
// Logarithms are below 2^14: the difference stays below 2^23.
inline void note_final_triangle(Reconstruction& r, Log2 twice_area) {
  const Log2 density = r.share - twice_area;
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
  return HitEstimate{6, 2 * log2_of(static_cast<uint32_t>(length)) + density + 6 * 256};
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
inline HitEstimate estimate_hit(Reconstruction& r, Index into, uint32_t marks, Log2 density) {
  HitEstimate estimate;
  r.region.expected = free_area(r.region) + density;
  estimate.position = r.region.expected + 6 * 256;
  estimate.context = (r.region.next.certified ? 1 : 0) + (r.region.opposite_certified ? 2 : 0);
  if ((marks & kQueued) != 0) return estimate;
  const uint32_t degree = degree_up_to(*r.mesh, into, r.contract.degree + 2u);
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
  const Offset found =
      code_place(coder, r.models.place, region, r.contract, density, r.place, r.habits);
  region.corner[0] = found;
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
  const Point place = code_hull_place(coder, r.models.gap, r.models.height.mantissa,
                                      r.habits.parities, r.contract, edge, density);
  return insert(r, coder, place) ? Decision::kHit : Decision::kMalformed;
}

template <class Coder>
Decision decide(Reconstruction& r, Coder& coder, Index into, uint32_t marks) {
  const Log2 density = r.density / 256;
  if (r.vertex == kInfinity) return decide_at_hull(r, coder, density);
  look_around(r, into);
  const bool hit = code_hit(r, coder, estimate_hit(r, into, marks, density));
  if (hit && !insert(r, coder, locate(r, coder, density))) return Decision::kMalformed;
  // The triangle of the chord and c, or the new vertex, is final.
  note_final_triangle(r, rough_log2(twice_area(r.region.corner[0], r.region.corner[1])));
  return hit ? Decision::kHit : Decision::kMiss;
}

// --- Steps ---------------------------------------------------------------------------------------

// What follows when all vertices of a phase, or of the seed, are in place.
inline StepOutcome after_vertices(Reconstruction& r) {
  if (r.mesh->vertices != r.contract.vertices) {
    r.stage = Stage::kPhase;
    const bool together = r.mesh->vertices < kSectionVertices;
    return together ? StepOutcome::kPhaseEnd : StepOutcome::kSectionEnd;
  }
  r.stage = r.contract.has_voids ? Stage::kVoids : Stage::kComplete;
  return r.contract.has_voids ? StepOutcome::kPhaseEnd : StepOutcome::kSectionEnd;
}

// One of the three vertices that are never removed. The first is the lexicographically smallest of
// all.
template <class Coder>
StepOutcome step_seed(Reconstruction& r, Coder& coder) {
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
    if (!code_height(coder, r.models.height, previous, &mesh.z[i])) return StepOutcome::kMalformed;
  }
  if (i < 2) {
    ++mesh.vertices;
    return StepOutcome::kStep;
  }
  const Point p0 = point_of(mesh, 0), p1 = point_of(mesh, 1), p2 = point_of(mesh, 2);
  if (!(p0 < p1) || !(p0 < p2) || orient2d(p0, p1, p2) <= 0) return StepOutcome::kMalformed;
  start_mesh(mesh);
  r.anchor = 4;
  return after_vertices(r);
}

// Starts a phase: how many vertices it adds, and the walk from infinity.
template <class Coder>
StepOutcome step_phase(Reconstruction& r, Coder& coder) {
  const uint32_t placed = r.mesh->vertices;
  const uint32_t left = r.contract.vertices - placed;
  uint32_t batch = left;
  if (coder.bit(kProbabilityOne / 2, !coder.last_phase())) {
    // All but the low 16 bits, then these: 1 .. left - 1.
    const uint32_t high = coder.uniform((left >> 16) + 1u, coder.batch() >> 16);
    batch = high << 16 | coder.uniform(left < 65536 ? left : 65536, coder.batch() & 65535u);
    if (batch == 0 || batch >= left) return StepOutcome::kMalformed;
  }
  r.phase_end = static_cast<Index>(placed + batch);
  r.work += placed + batch;
  if (r.work > work_budget(placed + batch)) return StepOutcome::kMalformed;
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
  const uint32_t places = lattice_places(r.contract);
  r.density = (log_batch - (places == 0 ? 32 * kLog2One : log2_of(places))) * 256;
  r.stage = Stage::kWalk;
  return StepOutcome::kStep;
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

// Leaves the triangle of the chord, which is final. False if the walk is over.
inline bool pass(Reconstruction& r, const Corner& corner) {
  r.chord = corner.into;
  return advance(r, corner.number, corner.marks);
}

// Says hit or miss at the triangle of the chord, which is not certified, and leaves it.
template <class Coder>
StepOutcome step_decision(Reconstruction& r, Coder& coder, const Corner& corner) {
  const Decision decision = decide(r, coder, corner.into, corner.marks);
  if (decision == Decision::kMalformed) return StepOutcome::kMalformed;
  if (decision == Decision::kMiss)
    return pass(r, corner) ? StepOutcome::kStep : StepOutcome::kMalformed;
  if (r.mesh->vertices == r.phase_end) {
    ++r.phase;
    return after_vertices(r);
  }
  const Index placed = r.mesh->origin[r.chord];
  return advance(r, placed, 0) ? StepOutcome::kStep : StepOutcome::kMalformed;
}

constexpr uint32_t kStepTriangles = 8;  // most that one step passes

// Passes certified triangles, but only a few, and looks at one that is not.
template <class Coder>
StepOutcome step_walk(Reconstruction& r, Coder& coder) {
  for (uint32_t i = 0;; ++i) {
    const Corner corner = far_corner(r);
    if (((r.from | corner.marks) & kDone) == 0) return step_decision(r, coder, corner);
    if (i == kStepTriangles) return StepOutcome::kStep;
    if (!pass(r, corner)) return StepOutcome::kMalformed;
  }
}

inline bool is_void(const uint8_t* voids, Index triangle) {
  return (static_cast<uint32_t>(voids[triangle >> 3]) >> (triangle & 7u) & 1u) != 0;
}

// Codes the void flag of one real triangle, given those of its neighbours that are known.
template <class Coder>
StepOutcome step_void(Reconstruction& r, Coder& coder) {
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
  if (r.void_cursor < mesh.triangles) return StepOutcome::kStep;
  r.stage = Stage::kComplete;
  return StepOutcome::kSectionEnd;
}

// One step: bounded work, at most kStepBytes of the payload, nothing half done.
template <class Coder>
StepOutcome step(Reconstruction& r, Coder& coder) {
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
  return StepOutcome::kMalformed;
}

}  // namespace
}  // namespace microtin


struct microtin_mesh {
  microtin::Mesh mesh;
  uint8_t* voids;              // a bit per triangle
  uint32_t capacity;           // vertices
  uint32_t verified_vertices;  // vertices when the last check passed
  microtin_axis axis[3];       // if is_placed
  bool is_placed;              // the header's check has passed
  bool has_voids;              // whether `voids` is decoded; coarser terrains know none
};

namespace microtin {
namespace {

inline bool has_terrain(const microtin_mesh& m, Index t) {
  return !is_ghost(m.mesh, t) && !(m.has_voids && is_void(m.voids, t));
}

// Why it must not be asked yet; HEIGHT if it may.
inline microtin_answer refusal_of(const microtin_mesh& m, uint32_t flags) {
  if (m.mesh.triangles == 0) return MICROTIN_NOT_DECODED;
  const bool is_usable =
      m.verified_vertices == m.mesh.vertices || (flags & MICROTIN_ANSWER_UNVERIFIED) != 0;
  return is_usable ? MICROTIN_HEIGHT : MICROTIN_NOT_VERIFIED;
}

MICROTIN_ONE_COPY inline void empty_mesh(microtin_mesh& m) {
  m.mesh.vertices = 0;
  m.mesh.triangles = 0;
  m.verified_vertices = 0;
  m.has_voids = false;
  m.is_placed = false;
}

enum class Item : uint8_t {
  kIdentity,
  kLength,  // of the header, or of a section's payload
  kHeader,  // up to its notes
  kPayloadStart,
  kStep,
  kRest,   // what is left of the header or the payload, not read
  kCheck,  // of the header, or of a section
};

}  // namespace
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

// --- shared/interpolation.hpp


namespace microtin {
namespace {

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
MICROTIN_IN_PLACE inline int64_t orient_fine(Point a, Point b, FinePoint p) {
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
MICROTIN_IN_PLACE inline int32_t height_in_triangle(Vertex a, Vertex b, Vertex c, FinePoint p) {
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

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

// A point as seen from p, with 8 fractional bits: each coordinate is within +-2^24.
MICROTIN_IN_PLACE inline Offset seen_from(FinePoint p, Point at) {
  return Offset{static_cast<FastInt>(at.x) * 256 - p.x, static_cast<FastInt>(at.y) * 256 - p.y};
}

// Walks from a triangle, which is no ghost, to the triangle that holds p, through at most
// `step_limit` triangles: crosses any edge that p lies beyond. The cursor is left where the walk
// ended, in a ghost if p is outside the hull; false if the steps did not suffice.
//
// As many steps as there are triangles always suffice, also in several calls. Lift the vertices to
// the paraboloid, with the infinitesimals of conflicts_on_circle: the triangles become facets of a
// strictly convex surface, and each step makes the facet's plane higher above p. So no triangle is
// met twice (Edelsbrunner, "An acyclicity theorem for cell complexes in d dimensions", 1990).
//
// Twice the area that two corners span with p is below 2^50: each factor pair is below 2^24 * 2^24.
template <class Cursor>
inline bool walk(Cursor& cursor, FinePoint p, uint32_t step_limit) {
  Offset from = seen_from(p, cursor.place(cursor.start()));
  Offset to = seen_from(p, cursor.place(cursor.end()));
  if (cross(from, to) < 0) {
    cursor.cross();
    const Offset other = from;
    from = to;
    to = other;
  }
  for (uint32_t step = 0; step < step_limit || !cursor.may_stop(); ++step) {
    // p does not lie beyond the half-edge.
    if (cursor.is_ghost()) return true;
    const Offset apex = seen_from(p, cursor.place(cursor.apex()));
    if (cross(to, apex) < 0) {
      cursor.cross_next();
      from = apex;
    } else if (cross(apex, from) < 0) {
      cursor.cross_last();
      to = apex;
    } else {
      return true;
    }
  }
  return false;
}

// Whether p, in a closed triangle without terrain, is a corner or on an edge with terrain beyond.
template <class Cursor>
MICROTIN_OUT_OF_LINE inline bool touches_terrain(Cursor cursor, FinePoint p) {
  bool touches = false;
  for (uint32_t i = 0; i < 3 && !touches; ++i) {
    const Point from = cursor.place(cursor.start()), to = cursor.place(cursor.end());
    const FinePoint at = fine(from);
    touches = at.x == p.x && at.y == p.y;
    if (!touches && orient_fine(from, to, p) == 0) {
      Cursor other = cursor;
      other.cross();
      touches = other.has_terrain();
    }
    cursor.turn();
  }
  return touches;
}

// The answer at p in the closed triangle, which is no ghost. A vertex always knows its own height;
// on an edge, terrain on either side is enough.
template <class Cursor>
inline microtin_answer answer_at(const Cursor& cursor, FinePoint p, int32_t* height) {
  if (!cursor.has_terrain() && !touches_terrain(cursor, p)) return MICROTIN_IN_VOID;
  *height = height_in_triangle(cursor.vertex(cursor.corner(0)), cursor.vertex(cursor.corner(1)),
                               cursor.vertex(cursor.corner(2)), p);
  return MICROTIN_HEIGHT;
}

// The half-edge mesh's.
class MeshCursor {
 public:
  MeshCursor(const microtin_mesh& m, Index half_edge) : m_(m), h_(half_edge) {}

  Index start() const { return mesh().origin[h_]; }
  Index end() const { return mesh().origin[next_in_triangle(h_)]; }
  Index apex() const { return mesh().origin[previous_in_triangle(h_)]; }
  Index triangle() const { return triangle_of(h_); }
  bool is_ghost() const { return apex() == kInfinity; }
  bool may_stop() const { return true; }
  bool has_terrain() const { return microtin::has_terrain(m_, triangle()); }
  void cross() { h_ = mesh().twin[h_]; }
  void cross_next() { h_ = mesh().twin[next_in_triangle(h_)]; }
  void cross_last() { h_ = mesh().twin[previous_in_triangle(h_)]; }
  void cross_around(bool forward) {
    if (forward) {
      cross_next();
    } else {
      cross_last();
    }
  }
  void turn() { h_ = next_in_triangle(h_); }
  MICROTIN_IN_PLACE Point place(uint32_t v) const { return mesh().place[v]; }
  MICROTIN_IN_PLACE Index corner(uint32_t i) const {
    return mesh().origin[first_edge(triangle()) + i];
  }
  Vertex vertex(uint32_t v) const {
    const Point at = place(v);
    return Vertex{at.x, at.y, mesh().z[v]};
  }

 private:
  const Mesh& mesh() const { return m_.mesh; }

  const microtin_mesh& m_;
  Index h_;
};

// Walks as above from *triangle, ghost or not, to another.
bool walk_to(const microtin_mesh& mesh, FinePoint p, uint32_t step_limit, Index* triangle);

}  // namespace
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
void fill(microtin_buckets* buckets, const microtin_mesh& mesh) {
  const uint32_t side = buckets->side, triangles = mesh.mesh.triangles;
  Index t = 0;
  for (uint32_t row = 0; row < side; ++row) {
    const int32_t y = middle(row, side, buckets->south, buckets->height);
    for (uint32_t i = 0; i < side; ++i) {
      const uint32_t column = row % 2 == 0 ? i : side - 1 - i;
      const int32_t x = middle(column, side, buckets->west, buckets->width);
      if (triangles != 0) walk_to(mesh, FinePoint{x, y}, triangles, &t);
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
  fill(&b, *mesh);
  *buckets = &b;
  return MICROTIN_DONE;
}

uint32_t microtin_buckets_hint(const microtin_buckets* buckets, int32_t x, int32_t y) {
  const microtin_buckets& b = *buckets;
  const uint32_t column = bucket_of(x, b.west, b.width, b.x_scale);
  const uint32_t row = bucket_of(y, b.south, b.height, b.y_scale);
  return reinterpret_cast<const Index*>(buckets + 1)[row * b.side + column];
}
// --- decoder/compact.cpp
// Making compact terrains: a path through the vertices of a mesh, then its laced ring.
// --- decoder/ring.hpp


namespace microtin {
namespace {

// The highest bit of a look: the triangle is void.
constexpr uint32_t kRingFlag = 1ul << (MICROTIN_INDEX_BITS - 1);
constexpr uint32_t kRingNumber = kRingFlag - 1;

// A position, as the middle of a triangle on each side. Its look says, below kRingFlag:
//   0 .. N - 1     one child: a if it is less than b, then c = b + 1; else c, then a = b - 1
//   N .. 2 N - 1   two children, a *full* triangle: N + c
//   2 N on         none, a *leaf*: 2 N + the a of the last full one before, if there is one
// Full ones and leaves take turns along a side. The looks of positions that are no middles are 0.
struct RingNode {
  Index look[2];
  uint16_t place;  // x | y << 8 from the corner of the terrain's box if that is narrow, else x
  int16_t z;
};

// Whether so many positions have room in a look. Behind the a of a full triangle come at least a
// child, b, a child and c, so that 2 N + a is at most 3 N - 5.
constexpr bool has_room_for(uint32_t positions) {
  return positions <= (kRingNumber + 5) / 3;
}

}  // namespace
}  // namespace microtin

// It holds no pointers, so that it can be moved. Behind it lies its body: a node for each position,
// the positions that repeat a vertex, in order, and y of each position if it is not narrow.
struct microtin_compact {
  microtin_axis axis[3];
  uint32_t vertices;
  uint32_t positions;
  uint16_t west, south;  // of the box if it is narrow, else 0
  uint32_t is_narrow;    // the box is less than 256 steps wide and high
};

static_assert(sizeof(microtin_compact) == MICROTIN_COMPACT_HEADER_BYTES, "see compact.h, PACK.md");
static_assert(sizeof(microtin_compact) % alignof(microtin::RingNode) == 0, "nodes follow it");

namespace microtin {
namespace {

struct Ring {
  const RingNode* node;
  const uint16_t* y;  // null: narrow
  const Index* repeat;
  uint32_t positions;
  uint32_t repeats;
};

inline uint32_t repeats_of(const microtin_compact& header) {
  return header.positions - 1 - header.vertices;
}

// Bytes that it takes with numbers of so many bytes. With those at hand less than the mesh, which
// is in memory.
inline size_t compact_bytes(const microtin_compact& header, uint32_t index_bytes) {
  const uint32_t each = 2 * index_bytes + (header.is_narrow != 0 ? 4u : 6u);
  return sizeof(microtin_compact) +
         static_cast<size_t>(header.positions * each + repeats_of(header) * index_bytes);
}

inline size_t body_bytes(const microtin_compact& header) {
  return compact_bytes(header, sizeof(Index)) - sizeof(microtin_compact);
}

inline Ring ring_of(const microtin_compact* c) {
  const uint32_t repeats = repeats_of(*c);
  const RingNode* const node = reinterpret_cast<const RingNode*>(c + 1);
  const Index* const repeat = reinterpret_cast<const Index*>(node + c->positions);
  const uint16_t* const y = reinterpret_cast<const uint16_t*>(repeat + repeats);
  return Ring{node, c->is_narrow != 0 ? nullptr : y, repeat, c->positions, repeats};
}

MICROTIN_IN_PLACE inline uint32_t look(const Ring& r, uint32_t middle, uint32_t side) {
  return r.node[middle].look[side] & kRingNumber;
}

// The a of a full triangle, from the next leaf.
MICROTIN_ONE_COPY inline uint32_t low_of_full(const Ring& r, uint32_t middle, uint32_t side) {
  const uint32_t leaves = 2 * r.positions;
  uint32_t seen = 0;
  while (seen < leaves) seen = look(r, ++middle, side);
  return seen - leaves;
}

inline uint32_t low_of(const Ring& r, uint32_t middle, uint32_t side) {
  const uint32_t seen = look(r, middle, side), n = r.positions;
  if (seen >= n && seen < 2 * n) return low_of_full(r, middle, side);
  return seen < middle ? seen : middle - 1;
}

inline uint32_t high_of(const Ring& r, uint32_t middle, uint32_t side) {
  const uint32_t seen = look(r, middle, side), n = r.positions;
  if (seen >= n && seen < 2 * n) return seen - n;
  return seen > middle && seen < n ? seen : middle + 1;
}

// Relative to the corner of the box if narrow.
MICROTIN_IN_PLACE inline Point place_of(const Ring& r, uint32_t i) {
  const uint16_t place = r.node[i].place;
  if (r.y != nullptr) return Point{place, r.y[i]};
  return Point{static_cast<uint16_t>(place & 255u), static_cast<uint16_t>(place >> 8)};
}

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {
namespace {

// What is done, item by item, in turn. Up to kExpand the mesh is only looked at.
enum class Work : uint8_t {
  kClear,      // bytes of bits
  kBox,        // vertices
  kInfinity,   // half-edges, up to one that starts at infinity
  kExpand,     // triangles, as the path is found
  kNumber,     // corners, along the path
  kNodes,      // positions
  kTriangles,  // triangles of the mesh
  kSlits,      // positions
  kLeft,       // positions: leaves to the left of the path
  kRight,      // ... to the right
  kMove,       // nodes, where the mesh was
  kComplete
};

}  // namespace
}  // namespace
}  // namespace microtin

// What is used most comes first, where short instructions reach it.
struct microtin_compactor {
  microtin::Work work;
  uint8_t status;          // a microtin_status: STEP_LIMIT while all is well
  microtin::Index start;   // a half-edge from infinity
  microtin::Index onward;  // the half-edge where the path goes on, from the other end
  microtin::Point least, most;
  uint32_t cursor;    // the item in hand
  uint32_t position;  // of the corner in hand; the first of its vertex is
  uint32_t first;
  uint32_t low, full_low;  // a of the triangle before, of the last full one
  uint32_t ringed;         // vertices that the expansion reached, infinity included
  uint8_t* triangles;      // a bit each: to the left of the path
  uint8_t* vertices;       // a bit each: on the path
  microtin::Index* order;  // by position: a vertex or, with kRingFlag, the position it repeats
  microtin::RingNode*
      body;  // where it is written: in the target or, if that is the mesh, over its twins
  microtin::Index* repeat;  // there, the next to be listed
  uint16_t* y;              // ... of the first position
  microtin::Mesh mesh;      // the source's
  microtin_mesh* source;
  microtin_compact* target;
  size_t body_bytes;
  size_t body_most, order_most;  // bytes, positions for which there is room
  microtin_compact header;
};

static_assert(sizeof(microtin_compactor) % sizeof(microtin::Index) == 0, "numbers follow it");
static_assert(sizeof(microtin_compactor) + 8 <= MICROTIN_COMPACTOR_HEADER_BYTES, "see compact.h");

namespace microtin {
namespace {
namespace {

typedef microtin_compactor Compactor;

// Shifted in 32 bits, wherever int is shorter or longer.
bool bit_of(const uint8_t* bits, uint32_t i) {
  return (static_cast<uint32_t>(bits[i >> 3]) >> (i & 7u) & 1u) != 0;
}

void set_bit(uint8_t* bits, uint32_t i) {
  bits[i >> 3] = static_cast<uint8_t>(bits[i >> 3] | 1u << (i & 7u));
}

bool is_left(const Compactor& c, Index half_edge) {
  return bit_of(c.triangles, triangle_of(half_edge));
}

size_t bit_bytes(uint32_t vertices) {
  const uint32_t bytes = (vertices + 7) / 8 + (2 * vertices + 7) / 8;
  return (static_cast<size_t>(bytes) + sizeof(Index) - 1) / sizeof(Index) * sizeof(Index);
}

// --- Each handles one item; true if it was the last.

bool clear(Compactor& c) {
  uint8_t* const byte = c.triangles + c.cursor++;
  *byte = 0;
  return byte + 1 == reinterpret_cast<uint8_t*>(c.order);
}

bool extend_box(Compactor& c) {
  const Point p = point_of(c.mesh, static_cast<Index>(c.cursor++));
  if (p.x < c.least.x) c.least.x = p.x;
  if (p.y < c.least.y) c.least.y = p.y;
  if (p.x > c.most.x) c.most.x = p.x;
  if (p.y > c.most.y) c.most.y = p.y;
  return c.cursor == c.header.vertices;
}

bool find_infinity(Compactor& c) {
  if (c.mesh.origin[c.start] == kInfinity) return true;
  ++c.start;
  return false;
}

// RingExpander of Gurung, Luffel, Lindstrom and Rossignac: a tree of triangles, each of which adds
// a vertex to those before. Goes around the tree with that to its left; what it goes around in the
// end is the path. The cursor is the half-edge across which a triangle is entered.
bool expand(Compactor& c) {
  const Mesh& mesh = c.mesh;
  Index h = static_cast<Index>(c.cursor), next = next_in_triangle(h);
  const Index apex = mesh.origin[next_in_triangle(next)];
  if (apex != kInfinity && !bit_of(c.vertices, apex)) {
    set_bit(c.vertices, apex);
    set_bit(c.triangles, triangle_of(h));
    ++c.ringed;
  } else if (!is_left(c, h)) {
    next = next_in_triangle(mesh.twin[h]);  // back, and on from there
  }
  c.cursor = mesh.twin[next];
  return c.cursor == mesh.twin[c.start];
}

void take_position(Compactor& c, Index vertex) {
  c.order[++c.position] = vertex;
  c.first = c.position;
}

// Whether `other`, an end of an edge at the vertex in hand, is where this was seen from.
bool is_seen_from(const Compactor& c, Index other, uint32_t* begin) {
  if (c.first == 0) return false;
  const uint32_t before = c.order[c.first - 1];
  *begin = (before & kRingFlag) != 0 ? before & kRingNumber : c.first - 1;
  return c.order[*begin] == other;
}

// Writes its position into a corner, and turns to the next around the vertex: first those to the
// right of the path, from where it comes, then those to the left, then the next vertex. A vertex
// that the expansion did not reach comes between two positions of the neighbour from where it is
// seen first: all around is to the right then, the edge between the two is a slit. The start, at
// infinity, is to the left, and left without going on.
bool number(Compactor& c) {
  const Mesh& mesh = c.mesh;
  const Index h = static_cast<Index>(c.cursor), previous = previous_in_triangle(h);
  mesh.origin[h] = static_cast<Index>(c.position | kRingFlag);
  const Index across = mesh.twin[previous], other = mesh.origin[previous];
  const bool left = is_left(c, h), leaves = is_left(c, across) != left;
  const bool is_new = (other & kRingFlag) == 0;  // neither numbered nor infinity
  c.cursor = across;
  if (left) {
    if (!leaves || c.onward == kInfinity) return false;
    const Index next = mesh.origin[c.onward];
    if ((next & kRingFlag) != 0) return true;  // infinity again
    take_position(c, next);
    c.cursor = c.onward;
  } else if (leaves) {
    c.onward = previous;
  } else if (is_new && c.position != 0) {
    uint32_t begin = 0;
    if (!bit_of(c.vertices, other)) {
      set_bit(c.vertices, other);
      take_position(c, other);
      c.cursor = previous;
    } else if (is_seen_from(c, other, &begin)) {
      take_position(c, static_cast<Index>(begin | kRingFlag));
      c.first = begin;
      c.cursor = previous;
    }
  }
  return false;
}

bool put_node(Compactor& c) {
  const uint32_t i = c.cursor++;
  const Mesh& mesh = c.mesh;
  Index v = c.order[i];
  if ((v & kRingFlag) != 0) v = c.order[v & kRingNumber];
  if (i == 0) v = 0;  // of infinity, any
  const Point at = point_of(mesh, v);
  RingNode& node = c.body[i];
  node.look[0] = node.look[1] = 0;
  node.z = mesh.z[v];
  if (c.header.is_narrow != 0) {
    node.place = static_cast<uint16_t>((at.x - c.least.x) | (at.y - c.least.y) << 8);
  } else {
    node.place = at.x;
    c.y[i] = at.y;
  }
  return c.cursor == c.header.positions;
}

// The triangle of the positions low < middle < high. What a full one lacks, its leaf gets later.
void put(Compactor& c, uint32_t side, uint32_t low, uint32_t middle, uint32_t high, uint32_t flag) {
  const uint32_t n = c.header.positions;
  const bool has_left = low + 1 != middle, has_right = middle + 1 != high;
  uint32_t value = has_right ? high : low;
  if (has_left == has_right) value = has_left ? n + high : 2 * n;
  c.body[middle].look[side] = static_cast<Index>(value | flag);
}

// A triangle of the mesh, whose corners are positions now.
bool put_triangle(Compactor& c) {
  const Mesh& mesh = c.mesh;
  const Index t = static_cast<Index>(c.cursor++);
  const Index* const corner = mesh.origin + first_edge(t);
  // Counter-clockwise, positions grow to the left of the path and fall to the right.
  const uint32_t side = bit_of(c.triangles, t) ? 0 : 1;
  uint32_t low = corner[2 * side] & kRingNumber, middle = corner[1] & kRingNumber;
  uint32_t high = corner[2 - 2 * side] & kRingNumber;
  while (low > middle || middle > high) {
    const uint32_t turned = low;
    low = middle;
    middle = high;
    high = turned;
  }
  const bool flagged = low != 0 && c.source->has_voids && is_void(c.source->voids, t);
  put(c, side, low, middle, high, flagged ? kRingFlag : 0);
  return t + 1u == mesh.triangles;
}

// Where a vertex occurs again, two triangles without area to the left of the path: one over the
// slit between its two last positions, one from these to what comes before the vertex. `order` of
// its first position becomes its last.
bool put_slit(Compactor& c) {
  const uint32_t i = c.cursor++;
  const uint32_t value = c.order[i];
  if ((value & kRingFlag) == 0) {
    c.order[i] = static_cast<Index>(i);
  } else {
    const uint32_t first = value & kRingNumber, last = c.order[first];
    put(c, 0, last, i - 1, i, 0);
    put(c, 0, first - 1, last, i, 0);
    c.order[first] = static_cast<Index>(i);
    *c.repeat++ = static_cast<Index>(i);
  }
  return c.cursor == c.header.positions;
}

// Along a side: `order` of each middle becomes its a, and each leaf gets that of the full triangle
// before. A full one's left child is what the triangle before has grown to, going up as long as
// that is a right child: one further up is an item, too, so that there are at most two for each.
bool put_leaf(Compactor& c) {
  const uint32_t side = c.work == Work::kLeft ? 0 : 1, middle = c.cursor, n = c.header.positions;
  Index& slot = c.body[middle].look[side];
  const uint32_t seen = slot & kRingNumber;
  if (seen >= 2 * n) {
    slot = static_cast<Index>(slot + c.full_low);
  } else if (seen >= n) {
    const uint32_t above = c.body[c.low].look[side] & kRingNumber;
    if (above == middle || above == n + middle) {
      c.low = c.order[c.low];
      return false;
    }
    c.full_low = c.low;
  }
  if (seen < n || seen >= 2 * n) c.low = seen < middle ? seen : middle - 1;
  c.order[middle] = static_cast<Index>(c.low);
  return ++c.cursor == n - 1;
}

// Eight bytes. The body ends where it begins, or further ahead.
bool move(Compactor& c) {
  uint8_t* const to = reinterpret_cast<uint8_t*>(c.target + 1);
  const uint8_t* const from = reinterpret_cast<const uint8_t*>(c.body);
  for (uint32_t i = 0; i < 8 && c.cursor != c.body_bytes; ++i, ++c.cursor) {
    to[c.cursor] = from[c.cursor];
  }
  return c.cursor == c.body_bytes;
}

// Handles items, as long as there are steps; true if the last was among them.
template <class Item>
MICROTIN_IN_PLACE inline bool each(Compactor& c, uint32_t* left, Item handle) {
  bool last = false;
  for (; *left != 0 && !last; --*left) last = handle(c);
  return last;
}

// Handles items where there are many, else one. A step left.
bool handle(Compactor& c, uint32_t* left) {
  switch (c.work) {
    case Work::kExpand:
      return each(c, left, expand);
    case Work::kNumber:
      return each(c, left, number);
    case Work::kTriangles:
      return each(c, left, put_triangle);
    case Work::kLeft:
    case Work::kRight:
      return each(c, left, put_leaf);
    default:
      break;
  }
  --*left;
  switch (c.work) {
    case Work::kClear:
      return clear(c);
    case Work::kBox:
      return extend_box(c);
    case Work::kInfinity:
      return find_infinity(c);
    case Work::kNodes:
      return put_node(c);
    case Work::kSlits:
      return put_slit(c);
    default:
      break;
  }
  return move(c);
}

// What is needed, and whether it is there.
microtin_status measure(Compactor& c) {
  microtin_compact& header = c.header;
  header.positions = 2 * (header.vertices + 1) - c.ringed;
  header.is_narrow = c.most.x - c.least.x < 256 && c.most.y - c.least.y < 256;
  if (header.is_narrow != 0) {
    header.west = c.least.x;
    header.south = c.least.y;
  }
  c.body_bytes = body_bytes(header);
  c.repeat = reinterpret_cast<Index*>(c.body + header.positions);
  c.y = reinterpret_cast<uint16_t*>(c.repeat + repeats_of(header));
  if (!has_room_for(header.positions)) return MICROTIN_TOO_BIG;
  const bool fits = c.body_bytes <= c.body_most && header.positions <= c.order_most;
  return fits ? MICROTIN_STEP_LIMIT : MICROTIN_WORKSPACE_TOO_SMALL;
}

// The work after that in hand, but for what is not wanted.
Work work_after(const Compactor& c) {
  Work next = static_cast<Work>(static_cast<uint8_t>(c.work) + 1);
  if (next == Work::kSlits && c.header.positions == c.header.vertices + 1) next = Work::kLeft;
  if (next == Work::kMove && c.body == reinterpret_cast<RingNode*>(c.target + 1)) {
    next = Work::kComplete;
  }
  return next;
}

void begin_numbering(Compactor& c) {
  c.order[0] = static_cast<Index>(kRingNumber);  // no vertex
  c.onward = kInfinity;                          // none yet
  c.cursor = c.start;
}

// Without a call of memcpy, which may be slow: no step takes longer than an item.
void copy_header(microtin_compact* to, const microtin_compact& from) {
  for (int i = 0; i < 3; ++i) to->axis[i] = from.axis[i];
  to->vertices = from.vertices;
  to->positions = from.positions;
  to->west = from.west;
  to->south = from.south;
  to->is_narrow = from.is_narrow;
}

// Makes ready for the next work.
microtin_status go_on(Compactor& c) {
  if (c.work == Work::kExpand) {
    const microtin_status status = measure(c);
    if (status != MICROTIN_STEP_LIMIT) return status;
  }
  if (c.work == Work::kRight) empty_mesh(*c.source);  // its end: what is moved may lie over it
  c.work = work_after(c);
  c.cursor = 0;
  if (c.work == Work::kExpand) {
    set_bit(c.vertices, c.mesh.origin[next_in_triangle(c.start)]);
    c.cursor = c.start;
  }
  if (c.work == Work::kNumber) begin_numbering(c);
  if (c.work == Work::kLeft || c.work == Work::kRight) {
    c.cursor = 1;
    c.low = c.full_low = 0;
  }
  if (c.work != Work::kComplete) return MICROTIN_STEP_LIMIT;
  copy_header(c.target, c.header);
  return MICROTIN_DONE;
}

// Where the body is written, and how much room is there: over the twins if the target is the mesh,
// since nothing needs these once corners have numbers.
void find_room(Compactor& c, size_t size) {
  c.body = reinterpret_cast<RingNode*>(c.target + 1);
  c.body_most = size < sizeof(microtin_compact) ? 0 : size - sizeof(microtin_compact);
  if (static_cast<void*>(c.target) != c.source) return;
  c.body = reinterpret_cast<RingNode*>(c.mesh.twin);
  const size_t twins = 6 * static_cast<size_t>(c.source->capacity) * sizeof(Index);
  if (twins < c.body_most) c.body_most = twins;
}

}  // namespace
}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_compact_begin(void* workspace, size_t size, microtin_mesh* mesh,
                                       void* scratch, size_t scratch_size,
                                       microtin_compactor** compactor) {
  if (workspace == nullptr || mesh == nullptr || scratch == nullptr || compactor == nullptr) {
    return MICROTIN_ARGUMENT;
  }
  *compactor = nullptr;
  if ((reinterpret_cast<uintptr_t>(workspace) | reinterpret_cast<uintptr_t>(scratch)) %
          MICROTIN_ALIGNMENT !=
      0) {
    return MICROTIN_MISALIGNED;
  }
  const uint32_t n = mesh->mesh.vertices;
  if (n == 0 || mesh->verified_vertices != n) return MICROTIN_ARGUMENT;
  const size_t order_at = sizeof(Compactor) + bit_bytes(n);
  if (scratch_size < order_at) return MICROTIN_WORKSPACE_TOO_SMALL;
  Compactor& c = *static_cast<Compactor*>(scratch);
  c = Compactor();
  for (int i = 0; i < 3; ++i) c.header.axis[i] = mesh->axis[i];
  c.header.vertices = n;
  c.source = mesh;
  c.mesh = mesh->mesh;
  c.target = static_cast<microtin_compact*>(workspace);
  c.triangles = reinterpret_cast<uint8_t*>(&c + 1);
  c.vertices = c.triangles + (2 * n + 7) / 8;
  c.order = static_cast<Index*>(scratch) + order_at / sizeof(Index);
  c.order_most = (scratch_size - order_at) / sizeof(Index);
  c.ringed = 2;             // infinity, and the vertex where the expansion starts
  c.least.x = kLatticeMax;  // one by one: on AVR a constant to copy from would be in RAM
  c.least.y = kLatticeMax;
  c.status = MICROTIN_STEP_LIMIT;
  find_room(c, size);
  *compactor = &c;
  return MICROTIN_DONE;
}

microtin_status microtin_compact_proceed(microtin_compactor* compactor, uint32_t step_limit,
                                         microtin_compact** compact) {
  if (compactor == nullptr || compact == nullptr) return MICROTIN_ARGUMENT;
  Compactor& c = *compactor;
  *compact = nullptr;
  uint32_t left = step_limit == 0 ? 0xFFFFFFFFu : step_limit;
  while (c.status == MICROTIN_STEP_LIMIT && left != 0) {
    if (handle(c, &left)) c.status = static_cast<uint8_t>(go_on(c));
  }
  if (c.status == MICROTIN_DONE) *compact = c.target;
  return static_cast<microtin_status>(c.status);
}

void microtin_compact_needs(const microtin_compactor* compactor, size_t* bytes,
                            size_t* scratch_bytes) {
  const Compactor& c = *compactor;
  const uint32_t n = c.header.vertices;
  *bytes = sizeof(microtin_compact) + c.body_bytes;
  *scratch_bytes =
      sizeof(Compactor) + bit_bytes(n) + static_cast<size_t>(c.header.positions) * sizeof(Index);
}
// --- decoder/compact_course.cpp
// Courses and blocks on a compact terrain.
// --- decoder/ring_form.hpp

// --- decoder/ring_cursor.hpp


namespace microtin {
namespace {

// The middle of the triangle below the edge (a, c), looked for from both ends: one that lies below
// an edge (a, high), and the most of all below, c - 1, up to what has its least corner at a. A look
// at each in turn, so that all are at most twice as many as there are triangles below the smaller
// child.
MICROTIN_ONE_COPY inline uint32_t far_below(const Ring& r, uint32_t least, uint32_t a, uint32_t c,
                                            uint32_t side) {
  const uint32_t n = r.positions;
  uint32_t most = c - 1, at = most, high = high_of(r, least, side);
  for (; high != c; high = high_of(r, least, side)) {
    least = high;
    const uint32_t seen = look(r, at, side);
    const bool is_leaf = seen >= 2 * n;
    if (!is_leaf && (at != most || seen >= n)) {
      ++at;  // the low of a full triangle: see low_of_full
      continue;
    }
    uint32_t low = most - 1;
    if (at != most) low = seen - 2 * n;
    if (!is_leaf && seen < most) low = seen;
    if (low == a) return most;
    most = at = low;
  }
  return least;
}

// ... if that is full: a + 1 is the least of all below, and what it belongs to comes to lie below
// ever wider edges (a, high). Mostly it is near.
MICROTIN_IN_PLACE inline uint32_t full_below(const Ring& r, uint32_t a, uint32_t c, uint32_t side) {
  uint32_t least = a + 1;
  for (uint32_t looks = 0; looks < 5; ++looks) {
    const uint32_t high = high_of(r, least, side);
    if (high == c) return least;
    least = high;
  }
  return far_below(r, least, a, c, side);
}

// The third corner below the edge (a, c) inside a side: the middle.
inline uint32_t below(const Ring& r, uint32_t a, uint32_t c, uint32_t side) {
  if (a + 2 == c || look(r, a + 1, side) == c) return a + 1;
  if (look(r, c - 1, side) == a) return c - 1;
  return full_below(r, a, c, side);
}

// ... above: a if that has a right child there, else c.
inline uint32_t above(const Ring& r, uint32_t a, uint32_t c, uint32_t side) {
  uint32_t seen = look(r, a, side);
  if (seen == c) return a - 1;
  if (seen == r.positions + c) return low_of_full(r, a, side);
  seen = look(r, c, side);
  return seen < r.positions ? c + 1 : seen - r.positions;
}

// ... on a side of the ring's edge (a, c): c unless that has a left child, else a.
inline uint32_t beside(const Ring& r, uint32_t a, uint32_t c, uint32_t side) {
  const uint32_t n = r.positions;
  uint32_t seen = look(r, c, side);
  if (seen >= 2 * n) return c + 1;
  if (seen > c && seen < n) return seen;
  seen = look(r, a, side);
  return seen < n ? seen : a - 1;
}

// Twice the third corner of the triangle beyond the edge from u to w of one on `side`, plus its
// side. Counter-clockwise, to the left of the path all edges but that opposite to the middle go
// upwards; to the right, downwards.
MICROTIN_ONE_COPY inline uint32_t beyond(const Ring& r, uint32_t u, uint32_t w, uint32_t side) {
  const bool rises = u < w, is_above = rises == (side != 0);
  const uint32_t a = rises ? u : w, c = rises ? w : u;
  if (is_above) return 2 * above(r, a, c, side) + side;
  if (a + 1 != c) return 2 * below(r, a, c, side) + side;
  side ^= 1u;
  return 2 * beside(r, a, c, side) + side;
}

// A half-edge of the ring, from -> to.
class RingCursor {
 public:
  // On a half-edge of the triangle with a middle: its apex is a, so 0 in a ghost.
  RingCursor(const Ring& ring, uint32_t middle, uint32_t side) : ring_(ring) { set(middle, side); }

  uint32_t start() const { return from_; }
  uint32_t end() const { return to_; }
  uint32_t apex() const { return apex_side_ >> 1; }
  uint32_t side() const { return apex_side_ & 1u; }
  bool is_ghost() const { return apex_side_ < 2; }
  bool may_stop() const { return ring_.repeats == 0 || has_area(); }
  bool has_terrain() const { return !is_ghost() && ring_.node[middle()].look[side()] < kRingFlag; }

  // On through triangles without area.
  void cross() {
    swap_ends();
    enter();
    while (!may_stop()) {
      if (is_same(apex(), from_)) {
        cross_next();
      } else {
        cross_last();
      }
    }
  }
  void cross_next() {
    from_ = apex();
    enter();
  }
  void cross_last() {
    to_ = apex();
    enter();
  }
  void cross_around(bool forward) {
    (forward ? from_ : to_) = 0;
    enter_beside_infinity();
    while (!may_stop()) {
      (forward ? to_ : from_) = apex();
      enter_beside_infinity();
    }
  }
  void turn() {
    const uint32_t third = apex();
    apex_side_ = 2 * from_ + side();
    from_ = to_;
    to_ = third;
  }

  // To the triangle of the same middle to the right of the path, where all have area.
  void to_right() { set(middle(), 1); }

  // False for those that fill the gap at a repeat: two corners are the same vertex.
  bool has_area() const {
    return side() != 0 || !(is_same(from_, to_) || is_same(apex(), from_) || is_same(apex(), to_));
  }

  uint32_t middle() const {
    const uint32_t low = from_ < to_ ? from_ : to_, high = from_ < to_ ? to_ : from_;
    return apex() < low ? low : apex() > high ? high : apex();
  }

  Point place(uint32_t i) const { return place_of(ring_, i); }
  Vertex vertex(uint32_t i) const {
    const Point p = place_of(ring_, i);
    return Vertex{p.x, p.y, ring_.node[i].z};
  }
  MICROTIN_IN_PLACE uint32_t corner(uint32_t i) const {
    return i == 0 ? from_ : i == 1 ? to_ : apex();
  }

 private:
  void set(uint32_t middle, uint32_t side) {
    from_ = middle;
    to_ = high_of(ring_, middle, side);
    apex_side_ = 2 * low_of(ring_, middle, side) + side;
    if (side != 0) swap_ends();
  }
  void swap_ends() {
    const uint32_t other = from_;
    from_ = to_;
    to_ = other;
  }
  // Infinity is nothing else, wherever its node is.
  bool is_same(uint32_t i, uint32_t k) const {
    return i != 0 && k != 0 && ring_.node[i].place == ring_.node[k].place &&
           (ring_.y == nullptr || ring_.y[i] == ring_.y[k]);
  }
  // From the triangle beyond the half-edge to this.
  void enter() { apex_side_ = beyond(ring_, to_, from_, side()); }
  // ... if one of its ends is infinity. The path is closed: from the last position it goes to 0.
  void enter_beside_infinity() {
    const uint32_t last = ring_.positions - 1, other = side() ^ 1u;
    if (from_ + to_ != last) {
      enter();
    } else {
      apex_side_ = 2 * below(ring_, 0, last, other) + other;
    }
  }

  const Ring& ring_;
  uint32_t from_, to_;
  uint32_t apex_side_;  // 2 * apex + side
};

// Triangles are numbered by middle and side.
constexpr uint32_t kFirstNumber = 2;

inline uint32_t number_of(const RingCursor& cursor) {
  return 2 * cursor.middle() + cursor.side() - kFirstNumber;
}

inline uint32_t middle_of(uint32_t number) {
  return (number + kFirstNumber) >> 1;
}

inline RingCursor cursor_at(const Ring& r, uint32_t number) {
  return RingCursor(r, middle_of(number), number & 1u);
}

inline uint32_t triangle_count(const Ring& r) {
  return 2 * r.positions - 4;
}

}  // namespace
}  // namespace microtin

// --- decoder/tile_course.hpp

// --- decoder/local_point.hpp

// --- shared/pack_format.hpp

// --- shared/header.hpp


namespace microtin {
namespace {

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

// The offset (zigzag), numerator and denominator.
inline bool read_axis(const uint8_t** bytes, const uint8_t* end, microtin_axis* axis) {
  uint64_t offset = 0;
  if (!read_varint(bytes, end, &offset) || !read_step(bytes, end, &axis->numerator) ||
      !read_step(bytes, end, &axis->denominator)) {
    return false;
  }
  const int64_t half = static_cast<int64_t>(offset >> 1);
  axis->offset = (offset & 1u) != 0 ? -half - 1 : half;
  return true;
}

// A placement: the axes of x, y and z. What is not legal leaves `axis` on the lattice itself.
MICROTIN_ONE_COPY inline bool read_placement(const uint8_t** bytes, const uint8_t* end,
                                             microtin_axis* axis) {
  for (int i = 0; i < 3; ++i) {
    if (read_axis(bytes, end, axis + i)) continue;
    place_on_lattice(axis);
    return false;
  }
  return true;
}

// Reads a header's payload up to its notes. Not DONE: MALFORMED, or UNSUPPORTED_VERSION if it has
// properties unknown here, since these may change what follows. Then, and without a placement,
// `axis` is on the lattice itself.
inline microtin_status read_header(const uint8_t** bytes, const uint8_t* end, Contract* contract,
                                   microtin_axis* axis) {
  uint64_t number[4];  // properties, vertices, x_max, y_max
  place_on_lattice(axis);
  for (int i = 0; i < 4; ++i) {
    if (!read_varint(bytes, end, number + i)) return MICROTIN_MALFORMED;
    if (number[0] >> kPropertyBits != 0) return MICROTIN_UNSUPPORTED_VERSION;
  }
  const uint32_t properties = static_cast<uint32_t>(number[0]);
  contract->has_heights = (properties & kHasHeights) != 0;
  contract->has_voids = (properties & kHasVoids) != 0;
  contract->decoding = static_cast<Decoding>(properties >> 3 & 3u);
  contract->degree = properties >> 5 & 63u;
  contract->odd_origin_x = (properties & kOddOriginX) != 0;
  contract->odd_origin_y = (properties & kOddOriginY) != 0;
  contract->vertices = static_cast<uint32_t>(number[1]);
  contract->x_max = static_cast<uint16_t>(number[2]);
  contract->y_max = static_cast<uint16_t>(number[3]);
  bool legal = (properties & kHasPlacement) == 0 || read_placement(bytes, end, axis);
  legal = legal && contract->degree >= kMinDegree && contract->degree <= kMaxDegree &&
          (properties >> 3 & 3u) != 0 && number[1] >= 3 && number[1] <= kMaxVertices &&
          number[2] <= kLatticeMax && number[3] <= kLatticeMax;
  return legal ? MICROTIN_DONE : MICROTIN_MALFORMED;
}

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

constexpr uint8_t kPackMagic[4] MICROTIN_IN_FLASH = {'m', 't', 'p', 'k'};
constexpr uint8_t kPackVersion = 3;
constexpr uint32_t kPackIdentityBytes = 6;
constexpr uint32_t kPackFixedBytes = 36;
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
  uint32_t compact_bytes;    // that any tile takes in compact form at most; 0: not stated
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

// Of the first kPackIdentityBytes: a flag that is set is one of a later version.
inline microtin_status check_pack_identity(const uint8_t* bytes) {
  for (uint32_t i = 0; i < sizeof kPackMagic; ++i) {
    if (bytes[i] != read_table(kPackMagic + i)) return MICROTIN_BAD_MAGIC;
  }
  return bytes[4] == kPackVersion && bytes[5] == 0 ? MICROTIN_DONE : MICROTIN_UNSUPPORTED_VERSION;
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
  header->compact_bytes = read_u32(bytes + 32);
  const bool reserved = (bytes[7] | bytes[18] | bytes[19]) != 0;
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

// Where the streams may begin: behind the index, below 2^37.
inline uint64_t pack_streams_start(const PackHeader& header) {
  return pack_entry_start(header, tile_columns(header.grid) * tile_rows(header.grid));
}

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
  if (entry->size != 0) {
    return used == 0 && entry->vertices <= header.most_vertices &&
           entry->offset >= pack_streams_start(header);
  }
  for (uint32_t i = 0; i < kPackEntryBytes - kCheckBytes; ++i) used |= bytes[i];
  return used == 0;
}

// Whether a stream, of which the first bytes are given, begins as that of a tile: it has neither
// placement nor notes, and reaches no farther than the tile.
inline bool is_tile_start(const uint8_t* bytes, size_t size, const TileBox& box) {
  if (size < kIdentityBytes) return false;
  const uint8_t *next = bytes + kIdentityBytes, *const given = bytes + size;
  uint32_t length = 0;
  bool legal = true, more = true;
  while (more && next != given) more = take_length(&length, *next++, &legal);
  if (more || length > static_cast<size_t>(given - next)) return false;
  const uint8_t *const end = next + length, *at = next;
  uint64_t properties = 0;
  Contract contract;
  microtin_axis axis[3];
  return read_varint(&at, end, &properties) && (properties & kHasPlacement) == 0 &&
         read_header(&next, end, &contract, axis) == MICROTIN_DONE && next == end &&
         contract.x_max <= box.x_end - box.x && contract.y_max <= box.y_end - box.y;
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

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

// In steps with 8 fractional bits, from the first corner of a tile that the course touches: within
// 2^25.
struct LocalPoint {
  int32_t x, y;
};

inline LocalPoint local(const TileBox& box, int64_t x, int64_t y) {
  return LocalPoint{static_cast<int32_t>(x - static_cast<int64_t>(box.x) * 256),
                    static_cast<int32_t>(y - static_cast<int64_t>(box.y) * 256)};
}

inline LocalPoint fine_point(Point p) {
  return LocalPoint{p.x * static_cast<int32_t>(256), p.y * static_cast<int32_t>(256)};
}

// Twice the signed area of (a, b, p): positive if p lies to the left of a -> b. Ends of courses are
// less than 2^24 apart, corners of triangles too, and none is farther than 2^26 from another: below
// 2^51.
MICROTIN_ONE_COPY inline int64_t orient(const LocalPoint& a, const LocalPoint& b,
                                        const LocalPoint& p) {
  return static_cast<int64_t>(b.x - a.x) * (p.y - a.y) -
         static_cast<int64_t>(b.y - a.y) * (p.x - a.x);
}

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

inline int32_t smaller(int32_t a, int32_t b) {
  return a < b ? a : b;
}

inline int32_t larger(int32_t a, int32_t b) {
  return a < b ? b : a;
}

inline int64_t magnitude(int64_t v) {
  return v < 0 ? -v : v;
}

// rise * part / whole with 16 fractional bits, rounded to nearest, halves up; 0 <= part <= whole <
// 2^52, |rise| < 2^16. Long division, a bit of |rise| and then a fractional bit at a time: the rest
// stays below 3 * whole.
inline int64_t share(int32_t rise, int64_t part, int64_t whole) {
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
  return rise >= 0 ? (quotient + 1) >> 1 : -((quotient + (rest != 0 ? 1 : 0)) >> 1);
}

// A part of the course's length, from where it begins: 0 <= part <= whole <= 2^24.
struct Fraction {
  int32_t part, whole;
};

inline bool is_less(Fraction a, Fraction b) {
  return static_cast<int64_t>(a.part) * b.whole < static_cast<int64_t>(b.part) * a.whole;
}

// Whether what is `from` where the course begins and `to` where it ends, each within +-2^51, and
// linear between, is above 0 at a fraction of it. In two parts, of which the low one is positive:
// below 2^50 and 2^51.
inline bool is_positive_at(Fraction f, int64_t from, int64_t to) {
  const int64_t low = (static_cast<int64_t>(1) << 26) - 1;
  const int64_t rest = (from & low) * (f.whole - f.part) + (to & low) * f.part;
  const int64_t high = (from >> 26) * (f.whole - f.part) + (to >> 26) * f.part + (rest >> 26);
  return high > 0 || (high == 0 && (rest & low) != 0);
}

// A course in a tile that it touches.
//
// Of what is not known, the course has more than a point in an open triangle, on an open edge, or
// outside the hull; points that are not known alone are ends of such parts, or the whole course.
class TileCourse {
 public:
  TileCourse(const TileBox& box, const microtin_course& course)
      : begin_(local(box, course.x, course.y)),
        end_(local(box, course.x_end, course.y_end)),
        x_{0, 0},
        y_{0, 0},
        enters_{0, 1},
        leaves_{begin_.x != end_.x || begin_.y != end_.y, 1} {
    clip(begin_.x, end_.x, static_cast<int32_t>(box.x_end - box.x) * 256);
    clip(begin_.y, end_.y, static_cast<int32_t>(box.y_end - box.y) * 256);
  }

  // Whether the tile holds more of the course than a point.
  bool has_length() const { return is_less(enters_, leaves_); }

  // Looks at all triangles of its terrain. False if a part of the course in the tile is not known.
  template <class Form>
  bool look(const Form& form, int32_t* highest) {
    move(form.corner());
    bool is_known = true;
    for (uint32_t t = 0; t < form.triangles(); ++t) {
      Point place[3];
      const bool is_aside = form.places(t, place) && are_aside(place);
      if (!is_aside && !look_at(form.at(t), highest)) is_known = false;
    }
    return is_known;
  }

 private:
  struct Corner {
    LocalPoint at;
    int32_t z;
    int64_t side;  // of the course: positive to the left
  };

  template <class Cursor>
  Corner corner_of(const Cursor& cursor, uint32_t i) const {
    const Vertex v = cursor.vertex(cursor.corner(i));
    const LocalPoint at = fine_point(Point{v.x, v.y});
    return Corner{at, v.z, orient(begin_, end_, at)};
  }

  // Whole steps that the course reaches along an axis.
  struct Reach {
    int32_t low, high;
  };

  static Reach reach(int32_t begin, int32_t end) {
    return begin < end ? Reach{begin >> 8, (end + 255) >> 8} : Reach{end >> 8, (begin + 255) >> 8};
  }

  // Seen from a place of the tile.
  void move(Point corner) {
    const FinePoint by = fine(corner);
    begin_ = LocalPoint{begin_.x - by.x, begin_.y - by.y};
    end_ = LocalPoint{end_.x - by.x, end_.y - by.y};
    x_ = reach(begin_.x, end_.x);
    y_ = reach(begin_.y, end_.y);
  }

  template <class Cursor>
  bool look_at(const Cursor& cursor, int32_t* highest) const {
    if (!cursor.may_stop()) return true;
    if (cursor.is_ghost())
      return !leaves_at(cursor.place(cursor.start()), cursor.place(cursor.end()));
    Corner corner[3];
    for (uint32_t i = 0; i < 3; ++i) corner[i] = corner_of(cursor, i);
    if (!cursor.has_terrain()) {
      for (const Corner& c : corner) look_at_corner(c, highest);
      return !loses_in(cursor, corner);
    }
    for (int i = 0; i < 3; ++i) look_at_edge(corner[i], corner[i == 2 ? 0 : i + 1], highest);
    return true;
  }

  // Cuts off what lies before or behind the tile along an axis. As the course touches the tile, it
  // enters before its end and leaves behind its beginning.
  void clip(int32_t begin, int32_t end, int32_t size) {
    if (begin == end) return;
    const bool rises = begin < end;
    const int32_t length = rises ? end - begin : begin - end;
    const Fraction enters = {rises ? -begin : begin - size, length},
                   leaves = {rises ? size - begin : begin, length};
    if (is_less(enters_, enters)) enters_ = enters;
    if (is_less(leaves, leaves_)) leaves_ = leaves;
  }

  // Whether a real triangle lies beside the bounding box of the course: most do.
  bool are_aside(const Point* p) const {
    return are_aside(p[0].x, p[1].x, p[2].x, x_) || are_aside(p[0].y, p[1].y, p[2].y, y_);
  }
  static bool are_aside(int32_t a, int32_t b, int32_t c, const Reach& reach) {
    return (a < reach.low && b < reach.low && c < reach.low) ||
           (a > reach.high && b > reach.high && c > reach.high);
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
    const int64_t part = magnitude(a.side), whole = part + magnitude(b.side);
    if (whole == 0) {
      look_at_corner(a, highest);
      look_at_corner(b, highest);
    } else if (meets(a, b)) {
      // The share may not fit in 32 bits; the sum lies between the ends.
      const int64_t height = static_cast<int64_t>(a.z) * 65536 + share(b.z - a.z, part, whole);
      raise(static_cast<int32_t>(height), highest);
    }
  }

  // A vertex on the course.
  void look_at_corner(const Corner& a, int32_t* highest) const {
    if (a.side == 0 && spans(a.at)) raise(a.z * 65536, highest);
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

  // Whether a part of the course lies in a void triangle, or on an edge of it that has no terrain
  // on the other side either.
  template <class Cursor>
  bool loses_in(Cursor cursor, const Corner* corner) const {
    if (passes_inside(corner)) return true;
    for (uint32_t i = 0; i < 3; ++i, cursor.turn()) {
      const Corner &a = corner[i], &b = corner[i == 2 ? 0 : i + 1];
      if (a.side != 0 || b.side != 0 || !runs_along(a.at, b.at)) continue;
      Cursor other = cursor;
      other.cross();
      if (!other.has_terrain()) return true;
    }
    return false;
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

  // Whether the course shares more than a point with an edge on its line.
  bool runs_along(LocalPoint a, LocalPoint b) const {
    return begin_.x != end_.x ? overlap(a.x, b.x, begin_.x, end_.x)
                              : overlap(a.y, b.y, begin_.y, end_.y);
  }
  static bool overlap(int32_t a, int32_t b, int32_t c, int32_t d) {
    return larger(smaller(a, b), smaller(c, d)) < smaller(larger(a, b), larger(c, d));
  }

  // Whether, in the tile, a part of the course lies beyond a hull edge, which runs with the outside
  // to its left.
  bool leaves_at(Point start, Point stop) const {
    const LocalPoint a = fine_point(start), b = fine_point(stop);
    const int64_t from = orient(a, b, begin_), to = orient(a, b, end_);
    if (from <= 0 && to <= 0) return false;
    return is_positive_at(enters_, from, to) || is_positive_at(leaves_, from, to);
  }

  LocalPoint begin_, end_;
  Reach x_, y_;               // as soon as it is looked at
  Fraction enters_, leaves_;  // what of the course lies in the tile
};

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

class RingForm {
 public:
  typedef RingCursor Cursor;
  static constexpr bool kIsCompact = true;

  explicit RingForm(const void* space)
      : c_(static_cast<const microtin_compact*>(space)), ring_(ring_of(c_)) {}

  uint32_t triangles() const { return triangle_count(ring_); }
  Point corner() const { return Point{c_->west, c_->south}; }
  RingCursor at(uint32_t t) const { return cursor_at(ring_, t); }
  bool places(uint32_t t, Point* places) const {
    const uint32_t middle = middle_of(t), low = low_of(ring_, middle, t & 1u);
    if (low == 0) return false;
    places[0] = place_of(ring_, low);
    places[1] = place_of(ring_, middle);
    places[2] = place_of(ring_, high_of(ring_, middle, t & 1u));
    return true;
  }
  microtin_answer height_at(LocalPoint p, uint32_t* hint, int32_t* height) const {
    return microtin_compact_height_at(c_, p.x, p.y, 0, hint, height);
  }

 private:
  const microtin_compact* c_;
  Ring ring_;
};

}  // namespace
}  // namespace microtin

// --- decoder/terrain_query.hpp

// --- decoder/places.hpp

// --- decoder/touched_tiles.hpp


namespace microtin {
namespace {

constexpr int64_t kCourseMost = static_cast<int64_t>(1) << 40;
constexpr int64_t kCourseLongest = static_cast<int64_t>(1) << 24;

MICROTIN_ONE_COPY inline bool is_within(int64_t value, int64_t most) {
  return value <= most && value >= -most;
}

MICROTIN_ONE_COPY inline bool is_legal(const microtin_course& c) {
  return is_within(c.x, kCourseMost) && is_within(c.y, kCourseMost) &&
         is_within(c.x_end, kCourseMost) && is_within(c.y_end, kCourseMost) &&
         is_within(c.x_end - c.x, kCourseLongest - 1) &&
         is_within(c.y_end - c.y, kCourseLongest - 1);
}

// The tiles whose closed boxes a legal course meets, row by row from where it begins. Looks at no
// more than twice as many boxes as its bounding box has columns and rows, together.
class TouchedTiles {
 public:
  MICROTIN_ONE_COPY TouchedTiles(const TileGrid& grid, const microtin_course& course)
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
  // within 2^24.
  Side side() const {
    const TileBox b = box();
    const LocalPoint begin = local(b, course_.x, course_.y),
                     end = local(b, course_.x_end, course_.y_end),
                     size = {static_cast<int32_t>(b.x_end - b.x) * 256,
                             static_cast<int32_t>(b.y_end - b.y) * 256};
    bool some_left = false, some_right = false;
    for (uint32_t i = 0; i < 4; ++i) {
      const int64_t corner =
          orient(begin, end, LocalPoint{(i & 1u) != 0 ? size.x : 0, (i & 2u) != 0 ? size.y : 0});
      some_left = some_left || corner >= 0;
      some_right = some_right || corner <= 0;
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

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

inline microtin_course place(int64_t x, int64_t y) {
  return microtin_course{x, y, x, y};
}

// How bad an answer is. No switch: compilers make tables of those, which AVR would keep in RAM.
inline int rank(microtin_answer answer) {
  if (answer == MICROTIN_NOT_DECODED) return 4;
  if (answer == MICROTIN_IN_BAD_TILE) return 3;
  if (answer == MICROTIN_OUTSIDE) return 2;
  return answer == MICROTIN_IN_VOID ? 1 : 0;
}

inline microtin_answer worse(microtin_answer a, microtin_answer b) {
  return rank(a) > rank(b) ? a : b;
}

// At the ends of a course. *highest becomes the greater height, if there is one.
template <class HeightAt>
microtin_answer ask_ends(const microtin_course& course, const HeightAt& height_at,
                         int32_t* highest) {
  uint32_t hint = 0;
  int32_t begin = INT32_MIN, end = INT32_MIN;
  const microtin_answer answer = worse(height_at(course.x, course.y, &hint, &begin),
                                       height_at(course.x_end, course.y_end, &hint, &end));
  *highest = begin > end ? begin : end;
  return answer;
}

// Whether heights on an axis can be told in whole units.
inline bool has_small_units(const microtin_axis& z) {
  return z.numerator >> 31 == 0 && is_within(z.offset, static_cast<int64_t>(1) << 45);
}

// A height in whole units, halves up, kept within int16_t. |z| < 2^31, the numerator < 2^31, the
// offset within 2^45, the denominator < 2^40: sums below 2^62 + 2^61 + 2^55.
MICROTIN_ONE_COPY inline int16_t in_units(int32_t z, const microtin_axis& axis) {
  const int64_t unit = static_cast<int64_t>(axis.denominator) * 65536;
  const int64_t sum = static_cast<int64_t>(static_cast<int32_t>(axis.numerator)) * z +
                      axis.offset * 65536 + unit / 2;
  // Rounded down, of both signs.
  const uint64_t whole =
      divide(static_cast<uint64_t>(sum < 0 ? ~sum : sum), static_cast<uint64_t>(unit)).whole;
  const int64_t height = sum < 0 ? ~static_cast<int64_t>(whole) : static_cast<int64_t>(whole);
  if (height > INT16_MAX) return INT16_MAX;
  return static_cast<int16_t>(height < INT16_MIN ? INT16_MIN : height);
}

// The heights of a block in whole units of the axis z, as microtin_pack_fill tells them.
template <class HeightAt>
microtin_answer fill(const microtin_block& block, const microtin_axis& axis,
                     const HeightAt& height_at, int16_t* heights) {
  if (!is_within(block.x, kCourseMost) || !is_within(block.y, kCourseMost)) return MICROTIN_OUTSIDE;
  microtin_answer answer = MICROTIN_HEIGHT;
  uint32_t hint = 0;
  int64_t y = block.y;  // below 2^40 + 2^47
  for (uint32_t row = 0; row < block.rows; ++row, y += block.dy) {
    int64_t x = block.x;
    for (uint32_t column = 0; column < block.columns; ++column, x += block.dx) {
      int32_t z = 0;
      const microtin_answer here = height_at(x, y, &hint, &z);
      *heights++ = here == MICROTIN_HEIGHT ? in_units(z, axis) : block.missing;
      if (here != MICROTIN_HEIGHT && answer != MICROTIN_NOT_DECODED) answer = here;
    }
  }
  return answer;
}

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

inline bool is_on_lattice(int64_t x, int64_t y) {
  const int64_t most = static_cast<int64_t>(kLatticeMax) * 256;
  return x >= 0 && x <= most && y >= 0 && y <= most;
}

template <class Form>
microtin_answer height_in_terrain(const Form& form, int64_t x, int64_t y, uint32_t* hint,
                                  int32_t* height) {
  if (!is_on_lattice(x, y)) return MICROTIN_OUTSIDE;
  return form.height_at(LocalPoint{static_cast<int32_t>(x), static_cast<int32_t>(y)}, hint, height);
}

// Hulls are convex: a course leaves them only if it ends outside.
template <class Form>
microtin_answer highest_in_terrain(const Form& form, const microtin_course& course,
                                   int32_t* height) {
  *height = INT32_MIN;
  if (!is_on_lattice(course.x, course.y) || !is_on_lattice(course.x_end, course.y_end)) {
    return MICROTIN_OUTSIDE;
  }
  const microtin_answer answer = ask_ends(
      course,
      [&form](int64_t x, int64_t y, uint32_t* hint, int32_t* end) {
        return height_in_terrain(form, x, y, hint, end);
      },
      height);
  TileCourse all(TileBox{0, 0, kLatticeMax, kLatticeMax}, course);
  return all.look(form, height) ? answer : worse(answer, MICROTIN_IN_VOID);
}

template <class Form>
microtin_answer fill_from_terrain(const Form& form, const microtin_axis& z,
                                  const microtin_block& block, int16_t* heights) {
  if (!has_small_units(z)) return MICROTIN_OUTSIDE;
  return fill(
      block, z,
      [&form](int64_t x, int64_t y, uint32_t* hint, int32_t* height) {
        return height_in_terrain(form, x, y, hint, height);
      },
      heights);
}

}  // namespace
}  // namespace microtin


using namespace microtin;

microtin_answer microtin_compact_highest(const microtin_compact* compact,
                                         const microtin_course* course, int32_t* height) {
  return highest_in_terrain(RingForm(compact), *course, height);
}

microtin_answer microtin_compact_fill(const microtin_compact* compact, const microtin_block* block,
                                      int16_t* heights) {
  return fill_from_terrain(RingForm(compact), compact->axis[2], *block, heights);
}
// --- decoder/compact_pack.cpp
// Packs that make tiles compact: between decoding a tile and telling that it is there.
// --- decoder/pack_state.hpp


namespace microtin {
namespace {

constexpr uint32_t kPackBuffer = 128;  // holds every item of the header but the notes

// What is read next.
enum class PackStage : uint8_t {
  kFixed,
  kPlacement,
  kNotes,
  kCheck,
  kIdle,
  kEntry,
  kStream,
  kStore  // nothing: a tile is decoded, and to be made compact
};

enum class SlotState : uint8_t { kEmpty, kReady };

// A tile that is there, or room for one.
struct PackSlot {
  void* space;  // begins with a microtin_mesh, or a microtin_compact
  uint32_t tile;
  uint32_t wanted;           // when it was wanted last
  volatile SlotState state;  // queries may look only if it is ready
  bool has_terrain;

  bool is_empty() const { return state == SlotState::kEmpty; }
};

// A tile that was refused, or room for one.
struct BadTile {
  uint32_t tile;
  uint32_t wanted;       // when it was wanted last
  volatile uint8_t why;  // a status; queries may look only if it is not DONE

  bool is_empty() const { return why == MICROTIN_DONE; }
};

// What storage said of the bytes wanted.
enum class Storage : uint8_t { kWell, kEnds, kFailed };

}  // namespace
}  // namespace microtin

struct microtin_pack {
  uint8_t* decoder_space;
  size_t decoder_bytes;
  microtin_mesh* work;  // where tiles are decoded that will be compact; null: in their slots
  size_t slot_bytes;
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
  microtin::BadTile bad[MICROTIN_PACK_BAD_TILES];
  // All of a course up to this tile has been tried, and this was bad: there was no room to
  // remember.
  uint32_t passed;
  bool has_passed;
  microtin::Storage storage;
  // The tile being read.
  uint32_t tile;
  microtin::PackEntry entry;
  microtin_decoder* decoder;
  microtin_compactor* compactor;  // of the tile decoded; null: not begun
  uint32_t stream_hash;
  uint32_t left;  // bytes of notes or stream, those in the buffer too until they are counted
  // The next bytes wanted, and those that came.
  uint64_t next;
  uint8_t wanted, buffered, fed;
  uint16_t sector;  // no read crosses a multiple of it; a power of two, or 0: they may
  bool is_counted;
  bool is_legal;  // the stream begins as a tile's does
  uint8_t buffer[microtin::kPackBuffer];
};

static_assert(sizeof(microtin_pack) + 7 + MICROTIN_PACK_ROUND(MICROTIN_DECODER_BYTES(0)) <=
                  MICROTIN_PACK_BYTES(0, 0),
              "see MICROTIN_PACK_BYTES");
static_assert(sizeof(microtin::PackSlot) <= 24, "see MICROTIN_PACK_BYTES");
static_assert(sizeof(microtin_pack) % alignof(microtin::PackSlot) == 0, "slots follow it");

namespace microtin {
namespace {

// The slot where a tile is; slot_count if it is not there.
MICROTIN_ONE_COPY inline uint32_t slot_of(const microtin_pack& p, uint32_t tile) {
  for (uint32_t i = 0; i < p.slot_count; ++i) {
    if (p.slots[i].state == SlotState::kReady && p.slots[i].tile == tile) return i;
  }
  return p.slot_count;
}

// Lays out a pack with so many bytes in front of the slots, and for each. Of the arguments that
// users give, the status tells.
microtin_status lay_out_pack(void* workspace, size_t size, uint32_t slots, uint32_t capacity,
                             uint64_t work_bytes, uint64_t slot_bytes, microtin_pack** pack);

// Empties a slot for the tile in hand. Null if all are wanted by the course in hand.
PackSlot* take_slot(microtin_pack& p);

// Ends with the tile in hand: it is in the slot taken, or to be remembered as bad. DONE.
microtin_status finish_tile(microtin_pack& p, PackSlot& slot, bool has_terrain);
microtin_status refuse_tile(microtin_pack& p, microtin_status why);

// Gives up what is in hand, and returns the status.
microtin_status fail_pack(microtin_pack& p, microtin_status status);

// Where it is remembered that a tile is bad; MICROTIN_PACK_BAD_TILES if it is not.
MICROTIN_ONE_COPY inline uint32_t bad_tile(const microtin_pack& p, uint32_t tile) {
  uint32_t i = 0;
  while (i < MICROTIN_PACK_BAD_TILES && (p.bad[i].is_empty() || p.bad[i].tile != tile)) ++i;
  return i;
}

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {
namespace {

// A step of decoding takes as many instructions as all of these, or more.
constexpr uint32_t kItemsOfStep = 16;

// Whether a tile takes no more than the header says of any.
bool is_as_stated(const PackHeader& header, const microtin_compact& tile) {
  const uint32_t index_bytes = header.most_vertices <= MICROTIN_MAX_VERTICES_FOR(16) ? 2 : 4;
  return header.compact_bytes == 0 || compact_bytes(tile, index_bytes) <= header.compact_bytes;
}

// Makes the tile in hand compact. DONE: it is there, or refused.
microtin_status store(microtin_pack& p, uint32_t step_limit) {
  if (p.compactor == nullptr) {
    PackSlot* const slot = take_slot(p);
    if (slot == nullptr) return fail_pack(p, MICROTIN_WORKSPACE_TOO_SMALL);
    p.slot = static_cast<uint8_t>(slot - p.slots);
    microtin_compact_begin(slot->space, p.slot_bytes, p.work, p.decoder_space, p.decoder_bytes,
                           &p.compactor);
  }
  const uint32_t most = 0xFFFFFFFFu / kItemsOfStep;
  microtin_compact* compact = nullptr;
  const microtin_status status = microtin_compact_proceed(
      p.compactor, (step_limit < most ? step_limit : most) * kItemsOfStep, &compact);
  if (status == MICROTIN_STEP_LIMIT) return status;
  if (status != MICROTIN_DONE) return refuse_tile(p, MICROTIN_TOO_BIG);
  if (!is_as_stated(p.header, *compact)) return refuse_tile(p, MICROTIN_MALFORMED);
  return finish_tile(p, p.slots[p.slot], true);
}

}  // namespace
}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_compact_pack_init(void* workspace, size_t size, uint32_t slots,
                                           uint32_t capacity, uint32_t tile_bytes,
                                           microtin_pack** pack) {
  if (tile_bytes > 0x80000000u) return MICROTIN_ARGUMENT;
  const uint64_t work_bytes = MICROTIN_PACK_ROUND(MICROTIN_MESH_BYTES(capacity));
  const microtin_status status = lay_out_pack(workspace, size, slots, capacity, work_bytes,
                                              MICROTIN_PACK_ROUND(tile_bytes), pack);
  if (status != MICROTIN_DONE) return status;
  microtin_pack& p = **pack;
  return microtin_mesh_init(p.decoder_space + p.decoder_bytes, static_cast<size_t>(work_bytes),
                            &p.work);
}

microtin_status microtin_compact_pack_prepare(microtin_pack* pack, const microtin_course* course,
                                              uint32_t step_limit) {
  if (pack == nullptr || pack->work == nullptr) return MICROTIN_ARGUMENT;
  for (;;) {
    const bool was_decoded = pack->stage == PackStage::kStore;
    const microtin_status status = microtin_pack_prepare(pack, course, step_limit);
    const bool has_steps = was_decoded || step_limit == 0;  // decoding has taken some
    if (status != MICROTIN_STEP_LIMIT || pack->stage != PackStage::kStore || !has_steps) {
      return status;
    }
    const microtin_status stored = store(*pack, step_limit);
    if (stored != MICROTIN_DONE) return stored;
  }
}
// --- decoder/compact_pack_query.cpp
// Queries on packs whose tiles are compact.
// --- decoder/pack_query.hpp

// --- decoder/border_edges.hpp


namespace microtin {
namespace {

// The known edges of a terrain's hull along a border line, in the order of their places.
template <class Form>
class BorderEdges {
 public:
  // The line x (if vertical) or y = `line`, a side of the tile. At most two rounds of the hull.
  BorderEdges(const Form& form, bool vertical, int32_t line)
      : cursor_(first_ghost(form)),
        corner_(fine_point(form.corner())),
        vertical_(vertical),
        line_(line),
        rises_(vertical == (line == 0)) {
    bool was_on_line = true;
    for (uint32_t i = 2 * form.triangles(); i != 0; --i, was_on_line = is_on_line(), advance()) {
      if (!was_on_line && is_on_line()) return;
    }
    has_more_ = false;
  }

  // How far the known edges that hold a place reach; that place if none does. Places do not fall
  // from call to call.
  int32_t reach(int32_t from) {
    while (has_more_ && larger(along(start()), along(end())) <= from) {
      advance();
      has_more_ = is_on_line();
    }
    if (!has_more_ || smaller(along(start()), along(end())) > from) return from;
    typename Form::Cursor inside = cursor_;
    inside.cross();
    return inside.has_terrain() ? larger(along(start()), along(end())) : from;
  }

 private:
  static typename Form::Cursor first_ghost(const Form& form) {
    uint32_t t = 0;
    while (!form.at(t).is_ghost() || !form.at(t).may_stop()) ++t;
    return form.at(t);
  }

  LocalPoint at(uint32_t vertex) const {
    const LocalPoint p = fine_point(cursor_.place(vertex));
    return LocalPoint{p.x + corner_.x, p.y + corner_.y};
  }
  LocalPoint start() const { return at(cursor_.start()); }
  LocalPoint end() const { return at(cursor_.end()); }
  int32_t along(LocalPoint p) const { return vertical_ ? p.y : p.x; }
  int32_t across(LocalPoint p) const { return vertical_ ? p.x : p.y; }
  bool is_on_line() const { return across(start()) == line_ && across(end()) == line_; }

  // To the hull edge that follows as places rise. The outside lies to the left of hull edges: along
  // the first vertical side they run up, and so around the tile.
  void advance() {
    cursor_.cross_around(rises_);
    if (!rises_) cursor_.turn();
    cursor_.turn();
  }

  typename Form::Cursor cursor_;  // on a hull edge of a ghost
  LocalPoint corner_;
  bool vertical_;
  int32_t line_;
  bool rises_;  // edges run as places rise
  bool has_more_ = true;
};

// Whether one of two terrains knows each place from `known` to `end` of the line that is `line` to
// one, and 0 to the other.
template <class Form>
bool know_border(const Form& one, int32_t line, const Form& other, int32_t other_line,
                 bool vertical, int32_t known, int32_t end) {
  BorderEdges<Form> mine(one, vertical, line), theirs(other, vertical, other_line);
  while (known < end) {  // once for each edge at most
    const int32_t reached = larger(mine.reach(known), theirs.reach(known));
    if (reached == known) return false;
    known = reached;
  }
  return true;
}

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {

inline bool is_inside(const microtin_pack& p, int64_t x, int64_t y) {
  const TileGrid& grid = p.header.grid;
  return x >= 0 && x <= static_cast<int64_t>(grid.x_max) * 256 && y >= 0 &&
         y <= static_cast<int64_t>(grid.y_max) * 256;
}

// Of a tile that is not there.
inline microtin_answer answer_without(const microtin_pack& p, uint32_t tile) {
  return bad_tile(p, tile) == MICROTIN_PACK_BAD_TILES ? MICROTIN_NOT_DECODED : MICROTIN_IN_BAD_TILE;
}

// Of a tile that is there; null if it has none, or is not there, and then *absent becomes worse.
MICROTIN_ONE_COPY inline const void* terrain_of(const microtin_pack& p, uint32_t tile,
                                                microtin_answer* absent) {
  const uint32_t slot = slot_of(p, tile);
  if (slot != p.slot_count) return p.slots[slot].has_terrain ? p.slots[slot].space : nullptr;
  *absent = worse(*absent, answer_without(p, tile));
  return nullptr;
}

// Whether a course lies on a side of the box, more than a point of which it touches.
inline bool runs_along_side(const TileBox& box, const microtin_course& c) {
  const auto is = [](int64_t place, uint32_t step) {
    return place == static_cast<int64_t>(step) * 256;
  };
  return (c.x == c.x_end && (is(c.x, box.x) || is(c.x, box.x_end))) ||
         (c.y == c.y_end && (is(c.y, box.y) || is(c.y, box.y_end)));
}

// HEIGHT if every place of a course along a side of a tile is known to it or to the tile beyond, or
// if the side is another tile's business: the first one's of two at a border.
template <class Form>
microtin_answer answer_along_side(const microtin_pack& p, uint32_t tile,
                                  const microtin_course& course) {
  const TileGrid& grid = p.header.grid;
  const TileBox box = tile_box(grid, tile);
  const bool vertical = course.x == course.x_end;
  const uint32_t first = vertical ? box.x : box.y, last = vertical ? box.x_end : box.y_end,
                 most = vertical ? grid.x_max : grid.y_max;
  const bool is_last = (vertical ? course.x : course.y) == static_cast<int64_t>(last) * 256;
  if (!is_last && first != 0) return MICROTIN_HEIGHT;
  microtin_answer worst = MICROTIN_IN_VOID;
  const void *one = terrain_of(p, tile, &worst), *other = nullptr;
  if (is_last && last != most) {
    other = terrain_of(p, tile + (vertical ? 1u : tile_columns(grid)), &worst);
  }
  if (one == nullptr && other == nullptr) return worst;
  const int32_t line = is_last ? static_cast<int32_t>(last - first) * 256 : 0;
  const LocalPoint a = local(box, course.x, course.y), b = local(box, course.x_end, course.y_end);
  const int32_t begin = vertical ? a.y : a.x, end = vertical ? b.y : b.x;
  const int32_t length =
      static_cast<int32_t>(vertical ? box.y_end - box.y : box.x_end - box.x) * 256;
  // What is not there is not known, as if the one that is there were on both sides.
  const bool is_known =
      know_border(Form(one != nullptr ? one : other), one != nullptr ? line : 0,
                  Form(other != nullptr ? other : one), other != nullptr ? 0 : line, vertical,
                  larger(smaller(begin, end), 0), smaller(larger(begin, end), length));
  return is_known ? MICROTIN_HEIGHT : worst;
}

// What a tile says of a course that touches it.
template <class Form>
microtin_answer answer_of_tile(const microtin_pack& p, const TouchedTiles& tiles,
                               const microtin_course& course, int32_t* highest) {
  microtin_answer absent = MICROTIN_HEIGHT;
  const void* const terrain = terrain_of(p, tiles.number(), &absent);
  if (absent == MICROTIN_NOT_DECODED) return absent;
  const TileBox box = tiles.box();
  TileCourse part(box, course);
  const bool is_known = terrain != nullptr && part.look(Form(terrain), highest);
  if (!part.has_length() || is_known) return MICROTIN_HEIGHT;
  if (runs_along_side(box, course)) return answer_along_side<Form>(p, tiles.number(), course);
  return worse(absent, MICROTIN_IN_VOID);
}

template <class Form>
microtin_answer height_in_pack(const microtin_pack& p, int64_t x, int64_t y, uint32_t* hint,
                               int32_t* height) {
  if (!p.has_header || (p.work != nullptr) != Form::kIsCompact) return MICROTIN_NOT_DECODED;
  if (!is_inside(p, x, y)) return MICROTIN_OUTSIDE;
  microtin_answer answer = MICROTIN_IN_VOID;
  const microtin_course here = place(x, y);
  for (TouchedTiles tiles(p.header.grid, here); !tiles.at_end(); tiles.next()) {
    const void* const terrain = terrain_of(p, tiles.number(), &answer);
    if (terrain == nullptr) continue;
    const LocalPoint at = local(tiles.box(), x, y);
    if (Form(terrain).height_at(at, hint, height) == MICROTIN_HEIGHT) return MICROTIN_HEIGHT;
  }
  return answer;
}

template <class Form>
microtin_answer highest_in_pack(const microtin_pack& p, const microtin_course& course,
                                int32_t* height) {
  *height = INT32_MIN;
  if (!is_legal(course)) return MICROTIN_OUTSIDE;
  int32_t highest = INT32_MIN;
  microtin_answer answer = ask_ends(
      course,
      [&p](int64_t x, int64_t y, uint32_t* hint, int32_t* end) {
        return height_in_pack<Form>(p, x, y, hint, end);
      },
      &highest);
  if (answer == MICROTIN_NOT_DECODED) return answer;
  for (TouchedTiles tiles(p.header.grid, course); !tiles.at_end(); tiles.next()) {
    answer = worse(answer, answer_of_tile<Form>(p, tiles, course, &highest));
    if (answer == MICROTIN_NOT_DECODED) return answer;
  }
  *height = highest;
  return answer;
}

template <class Form>
microtin_answer fill_from_pack(const microtin_pack& p, const microtin_block& block,
                               int16_t* heights) {
  if (p.has_header && !has_small_units(p.axis[2])) return MICROTIN_OUTSIDE;
  return fill(
      block, p.axis[2],
      [&p](int64_t x, int64_t y, uint32_t* hint, int32_t* height) {
        return height_in_pack<Form>(p, x, y, hint, height);
      },
      heights);
}

}  // namespace
}  // namespace microtin


using namespace microtin;

microtin_answer microtin_compact_pack_height_at(const microtin_pack* pack, int64_t x, int64_t y,
                                                uint32_t* hint, int32_t* height) {
  return height_in_pack<RingForm>(*pack, x, y, hint, height);
}

microtin_answer microtin_compact_pack_highest(const microtin_pack* pack,
                                              const microtin_course* course, int32_t* height) {
  return highest_in_pack<RingForm>(*pack, *course, height);
}

microtin_answer microtin_compact_pack_fill(const microtin_pack* pack, const microtin_block* block,
                                           int16_t* heights) {
  return fill_from_pack<RingForm>(*pack, *block, heights);
}
// --- decoder/compact_query.cpp
// Queries on compact terrains.
// --- shared/digest.hpp


namespace microtin {
namespace {

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

}  // namespace
}  // namespace microtin


namespace microtin {
namespace {
namespace {

// Hints: vertices looked at along the whole path, and the distance along it where that ends.
constexpr uint32_t kSamples = 22;
constexpr uint32_t kFinest = 2;

// In a triangle that is no ghost: that with a number, or one near it.
RingCursor start_at(const Ring& r, uint32_t number) {
  if (number >= triangle_count(r)) number = 0;
  RingCursor cursor = cursor_at(r, number);
  if (!cursor.may_stop()) cursor.to_right();
  if (cursor.is_ghost()) cursor.cross();
  return cursor;
}

// The position of a vertex, past repeats; and back.
uint32_t position_of(const Ring& r, uint32_t v) {
  uint32_t position = v + 1;
  for (uint32_t i = 0; i < r.repeats && r.repeat[i] <= position; ++i) ++position;
  return position;
}

uint32_t vertex_of(const Ring& r, uint32_t position) {
  if (position == 0) return static_cast<uint32_t>(MICROTIN_INFINITY);
  uint32_t before = r.repeats;
  // A repeat's slit has its last position and the one before for corners.
  while (before != 0 && r.repeat[before - 1] >= position) {
    --before;
    if (r.repeat[before] != position) continue;
    position = low_of(r, position - 1, 0);
  }
  return position - 1 - before;
}

Vertex on_lattice(const microtin_compact* c, Vertex v) {
  return Vertex{static_cast<uint16_t>(v.x + c->west), static_cast<uint16_t>(v.y + c->south), v.z};
}

uint32_t distance(Point at, int32_t x, int32_t y) {
  const int32_t dx = x - at.x, dy = y - at.y;
  return static_cast<uint32_t>((dx < 0 ? -dx : dx) + (dy < 0 ? -dy : dy));
}

}  // namespace
}  // namespace
}  // namespace microtin

using namespace microtin;

size_t microtin_compact_size(const microtin_compact* compact) {
  return sizeof(microtin_compact) + body_bytes(*compact);
}

uint32_t microtin_compact_vertex_count(const microtin_compact* compact) {
  return compact->vertices;
}

void microtin_compact_vertex(const microtin_compact* compact, uint32_t v, uint16_t* x, uint16_t* y,
                             int16_t* z) {
  const Ring r = ring_of(compact);
  const uint32_t i = position_of(r, v);
  const Point at = place_of(r, i);
  const Vertex vertex = on_lattice(compact, Vertex{at.x, at.y, r.node[i].z});
  *x = vertex.x;
  *y = vertex.y;
  *z = vertex.z;
}

uint32_t microtin_compact_triangle_count(const microtin_compact* compact) {
  return triangle_count(ring_of(compact));
}

microtin_triangle_kind microtin_compact_triangle(const microtin_compact* compact, uint32_t t,
                                                 uint32_t v[3]) {
  const Ring r = ring_of(compact);
  const RingCursor cursor = cursor_at(r, t);
  v[0] = vertex_of(r, cursor.start());
  v[1] = vertex_of(r, cursor.end());
  v[2] = vertex_of(r, cursor.apex());
  if (v[0] == v[1] || v[0] == v[2] || v[1] == v[2]) return MICROTIN_NO_AREA;
  if (cursor.is_ghost()) return MICROTIN_GHOST;
  return cursor.has_terrain() ? MICROTIN_REAL : MICROTIN_VOID;
}

uint64_t microtin_compact_digest(const microtin_compact* compact) {
  const Ring r = ring_of(compact);
  uint64_t sum = 0;
  for (uint32_t t = 0; t < triangle_count(r); ++t) {
    const RingCursor cursor = cursor_at(r, t);
    if (cursor.is_ghost() || !cursor.may_stop()) continue;
    Vertex corner[3];
    for (uint32_t i = 0; i < 3; ++i) {
      corner[i] = on_lattice(compact, cursor.vertex(cursor.corner(i)));
    }
    sum += triangle_digest(corner, !cursor.has_terrain());
  }
  return sum;
}

void microtin_compact_placement(const microtin_compact* compact, microtin_axis* x, microtin_axis* y,
                                microtin_axis* z) {
  *x = compact->axis[0];
  *y = compact->axis[1];
  *z = compact->axis[2];
}

microtin_answer microtin_compact_height_at(const microtin_compact* compact, int32_t x, int32_t y,
                                           uint32_t step_limit, uint32_t* hint, int32_t* height) {
  const int32_t most = static_cast<int32_t>(kLatticeMax) * 256;
  if (x < 0 || x > most || y < 0 || y > most) return MICROTIN_OUTSIDE;
  const Ring r = ring_of(compact);
  const FinePoint corner = fine(Point{compact->west, compact->south});
  const FinePoint p = {x - corner.x, y - corner.y};
  RingCursor cursor = start_at(r, *hint);
  const bool arrived = walk(cursor, p, step_limit == 0 ? triangle_count(r) : step_limit);
  *hint = number_of(cursor);
  if (!arrived) return MICROTIN_NOT_YET;
  return cursor.is_ghost() ? MICROTIN_OUTSIDE : answer_at(cursor, p, height);
}

uint32_t microtin_compact_hint(const microtin_compact* compact, int32_t x, int32_t y) {
  const Ring r = ring_of(compact);
  const int32_t px = (x >> 8) - compact->west, py = (y >> 8) - compact->south;
  const uint32_t end = r.positions - 1;
  uint32_t stride = end / kSamples + 1, step = stride, i = stride / 2 + 1, last = end;
  uint32_t best = 1, least = 0xFFFFFFFFu;
  for (;;) {
    do {  // there is one: end is 3 at least
      const uint32_t far = distance(place_of(r, i), px, py);
      if (far < least) {
        least = far;
        best = i;
      }
      i += step;
    } while (i < last);
    // Half as far, to both sides of the nearest.
    stride /= 2;
    if (stride < kFinest) return 2 * best - kFirstNumber;
    i = best > stride ? best - stride : 1;
    last = best + stride < end ? best + stride + 1 : end;
    step = 2 * stride;
  }
}
// --- decoder/course.cpp
// Courses and blocks on a decoded mesh.
// --- decoder/mesh_form.hpp


namespace microtin {
namespace {

class MeshForm {
 public:
  typedef MeshCursor Cursor;
  static constexpr bool kIsCompact = false;

  explicit MeshForm(const void* space) : m_(*static_cast<const microtin_mesh*>(space)) {}

  uint32_t triangles() const { return m_.mesh.triangles; }
  Point corner() const { return Point{0, 0}; }
  MeshCursor at(uint32_t t) const {
    const Index first = first_edge(static_cast<Index>(t));
    const Index* const v = m_.mesh.origin + first;
    const uint32_t i = v[0] == kInfinity ? 1u : v[1] == kInfinity ? 2u : 0u;
    return MeshCursor(m_, static_cast<Index>(first + i));
  }
  bool places(uint32_t t, Point* places) const {
    const Index* const v = m_.mesh.origin + first_edge(static_cast<Index>(t));
    if (is_ghost(v[0], v[1], v[2])) return false;
    for (int i = 0; i < 3; ++i) places[i] = point_of(m_.mesh, v[i]);
    return true;
  }
  microtin_answer height_at(LocalPoint p, uint32_t* hint, int32_t* height) const {
    return microtin_height_at(&m_, p.x, p.y, 0, hint, height);
  }

 private:
  const microtin_mesh& m_;
};

}  // namespace
}  // namespace microtin


using namespace microtin;

microtin_answer microtin_highest(const microtin_mesh* mesh, const microtin_course* course,
                                 int32_t* height) {
  *height = INT32_MIN;
  const microtin_answer refusal = refusal_of(*mesh, 0);
  if (refusal != MICROTIN_HEIGHT) return refusal;
  return highest_in_terrain(MeshForm(mesh), *course, height);
}

microtin_answer microtin_fill(const microtin_mesh* mesh, const microtin_block* block,
                              int16_t* heights) {
  microtin_axis axis[3];
  microtin_placement(mesh, &axis[0], &axis[1], &axis[2]);
  return fill_from_terrain(MeshForm(mesh), axis[2], *block, heights);
}
// --- decoder/decoder.cpp
// The push decoder: header, sections, steps.

namespace microtin {
namespace {
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
  const microtin_status known =
      read_header(&end, end + smaller(d.coder.payload_left, kHeaderMostBytes),
                  &d.reconstruction.contract, d.mesh->axis);
  if (known != MICROTIN_DONE) d.verdict = known;
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
    const StepOutcome outcome = step(d.reconstruction, d.coder);
    if (outcome == StepOutcome::kMalformed || d.coder.overrun) return end_payload(d, false);
    if (outcome == StepOutcome::kSectionEnd) return end_payload(d, true);
    if (outcome == StepOutcome::kPhaseEnd && d.reconstruction.stage == Stage::kPhase &&
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
  d.mesh->is_placed = true;
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

}  // namespace
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
  const microtin_status read = read_header(&next, bytes + checked, &contract, axis);
  if (!legal || read != MICROTIN_DONE) return legal ? read : MICROTIN_MALFORMED;
  info->vertices = contract.vertices;
  info->version = kVersion;
  info->degree = static_cast<uint8_t>(contract.degree);
  info->decoding = static_cast<uint8_t>(contract.decoding);
  info->has_heights = contract.has_heights;
  info->has_voids = contract.has_voids;
  info->x = axis[0];
  info->y = axis[1];
  info->z = axis[2];
  info->mesh_bytes = saturated(MICROTIN_MESH_BYTES(contract.vertices));
  info->decoder_bytes = saturated(MICROTIN_DECODER_BYTES(contract.vertices));
  return MICROTIN_DONE;
}
// --- decoder/names.cpp
// Names for people: of statuses and answers, and the versions.

namespace microtin {
namespace {
namespace {

#if !defined(MICROTIN_NO_NAMES)

constexpr int kFirstError = MICROTIN_BAD_MAGIC;

// The last entry of each is for what has no name.
constexpr char kStatuses[][20] MICROTIN_IN_FLASH = {"DONE", "NEED_INPUT", "STEP_LIMIT", "STOPPED",
                                                    "?"};
constexpr char kErrors[][20] MICROTIN_IN_FLASH = {
    "BAD_MAGIC",  "UNSUPPORTED_VERSION", "TOO_BIG",  "CHECKSUM", "MALFORMED", "TRUNCATED",
    "MISALIGNED", "WORKSPACE_TOO_SMALL", "ARGUMENT", "IO",       "BAD_TILES", "?"};
constexpr char kAnswers[][14] MICROTIN_IN_FLASH = {
    "HEIGHT", "OUTSIDE", "IN_VOID", "NOT_DECODED", "NOT_VERIFIED", "NOT_YET", "IN_BAD_TILE", "?"};

template <size_t Count, size_t Bytes>
const char* entry(const char (&names)[Count][Bytes], int number) {
  const size_t i = static_cast<size_t>(number);
  return names[i < Count ? i : Count - 1];
}

#endif

}  // namespace
}  // namespace
}  // namespace microtin

using namespace microtin;

uint32_t microtin_decoder_version() {
  return static_cast<uint32_t>(MICROTIN_VERSION_MAJOR) << 16 | MICROTIN_VERSION_MINOR << 8 |
         MICROTIN_VERSION_PATCH;
}

uint8_t microtin_stream_version() {
  return kVersion;
}

uint8_t microtin_pack_version() {
  return kPackVersion;
}

#if defined(MICROTIN_NO_NAMES)

const char* microtin_status_name(microtin_status) {
  return "";
}

const char* microtin_answer_name(microtin_answer) {
  return "";
}

#else

const char* microtin_status_name(microtin_status status) {
  const int number = status;
  return number < kFirstError ? entry(kStatuses, number) : entry(kErrors, number - kFirstError);
}

const char* microtin_answer_name(microtin_answer answer) {
  return entry(kAnswers, answer);
}

#endif
// --- decoder/notes.cpp
// Finding a note in a header.

namespace microtin {
namespace {
namespace {

// The notes of a header or, while bytes of it are missing, no `first` and the bytes it takes, 0 if
// unknown.
struct Notes {
  const uint8_t* first;
  uint32_t size;
};

// Of a number that is known to be legal. Returns its last byte.
uint8_t skip_varint(const uint8_t** bytes) {
  while (**bytes >= 128) ++*bytes;
  return *(*bytes)++;
}

microtin_status notes_of_stream(const uint8_t* bytes, size_t size, Notes* notes) {
  microtin_info info;
  const microtin_status status = microtin_peek(bytes, size, &info);
  notes->size = info.header_bytes;
  if (status != MICROTIN_DONE) return status;
  const uint8_t* next = bytes + kIdentityBytes;
  skip_varint(&next);                             // the length
  const uint8_t properties = skip_varint(&next);  // the low ones
  int numbers = (properties & kHasPlacement) != 0 ? 12 : 3;
  for (; numbers != 0; --numbers) skip_varint(&next);
  notes->first = next;
  notes->size = info.header_bytes - kCheckBytes - static_cast<uint32_t>(next - bytes);
  return MICROTIN_DONE;
}

microtin_status notes_of_pack(const uint8_t* bytes, size_t size, Notes* notes) {
  notes->size = 0;
  if (size < kPackIdentityBytes) return MICROTIN_NEED_INPUT;
  const microtin_status known = check_pack_identity(bytes);
  if (known != MICROTIN_DONE) return known;
  notes->size = kPackFixedBytes;
  if (size < kPackFixedBytes) return MICROTIN_NEED_INPUT;
  PackHeader header;
  const bool legal = read_pack_header(bytes, &header);
  notes->size = pack_index_start(header);  // at most 36 + 255 + 65535 + 4
  if (size < notes->size) return MICROTIN_NEED_INPUT;
  if (crc32(0, bytes, static_cast<size_t>(notes->size)) != kCheckedCrc) return MICROTIN_CHECKSUM;
  if (!legal) return MICROTIN_MALFORMED;
  notes->first = bytes + kPackFixedBytes + header.placement_bytes;
  notes->size = header.note_bytes;
  return MICROTIN_DONE;
}

// Makes `notes` the content of the first note of a type, or nothing. Each turn takes three bytes at
// least.
microtin_status find(uint8_t type, Notes* notes) {
  while (notes->size != 0) {
    if (notes->size < kNoteHeadBytes) return MICROTIN_MALFORMED;
    const uint8_t* const head = notes->first;
    const uint32_t size = read_u16(head + 1);
    notes->first += kNoteHeadBytes;
    notes->size -= kNoteHeadBytes;
    if (size > notes->size) return MICROTIN_MALFORMED;
    if (*head == type) {
      notes->size = size;
      return MICROTIN_DONE;
    }
    notes->first += size;
    notes->size -= size;
  }
  notes->first = nullptr;
  return MICROTIN_DONE;
}

}  // namespace
}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_find_note(const uint8_t* bytes, size_t size, uint8_t type,
                                   const uint8_t** content, uint32_t* content_size) {
  if (content == nullptr || content_size == nullptr) return MICROTIN_ARGUMENT;
  *content = nullptr;
  *content_size = 0;
  if (bytes == nullptr) return size == 0 ? MICROTIN_NEED_INPUT : MICROTIN_ARGUMENT;
  Notes notes = {nullptr, 0};
  microtin_status status = notes_of_stream(bytes, size, &notes);
  if (status == MICROTIN_BAD_MAGIC) status = notes_of_pack(bytes, size, &notes);
  if (status == MICROTIN_DONE) status = find(type, &notes);
  if (status == MICROTIN_DONE) *content = notes.first;
  if (status == MICROTIN_DONE || status == MICROTIN_NEED_INPUT) *content_size = notes.size;
  return status;
}
// --- decoder/pack.cpp
// Reading packs: which tiles are wanted, which are there, and bringing the one to the other.

namespace microtin {
namespace {
namespace {

MICROTIN_ONE_COPY void want(microtin_pack& p, PackStage stage, uint64_t offset, uint32_t size) {
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
  if (known != MICROTIN_DONE) return fail_pack(p, known);
  if (!read_pack_header(p.buffer, &p.header)) return fail_pack(p, MICROTIN_MALFORMED);
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
  if (!read_pack_placement(p.buffer, p.header, p.axis)) return fail_pack(p, MICROTIN_MALFORMED);
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
  if (read_u32(p.buffer) != p.crc) return fail_pack(p, MICROTIN_CHECKSUM);
  want(p, PackStage::kIdle, 0, 0);
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
  p.has_header = true;
  return MICROTIN_NEED_INPUT;
}

// --- A tile.

// The place to be filled next, a slot or what is known of a bad tile: an empty one, or that which
// has not been wanted for the longest time. Those of the course in hand are kept: null if all are.
template <class Place>
Place* place_to_fill(Place* places, uint32_t count, uint32_t clock) {
  Place* oldest = nullptr;
  for (uint32_t i = 0; i < count; ++i) {
    Place& place = places[i];
    if (place.is_empty()) return &place;
    const uint32_t age = clock - place.wanted;
    if (age != 0 && (oldest == nullptr || age > clock - oldest->wanted)) oldest = &place;
  }
  return oldest;
}

// For the same reason as set_state.
void set_why(BadTile& bad, microtin_status why) {
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
  bad.why = static_cast<uint8_t>(why);
  __atomic_signal_fence(__ATOMIC_SEQ_CST);
}

void forget_bad_tiles(microtin_pack& p) {
  for (BadTile& bad : p.bad) set_why(bad, MICROTIN_DONE);
  p.has_passed = false;
}

}  // namespace

microtin_status fail_pack(microtin_pack& p, microtin_status status) {
  give_up(p);
  return status;
}

PackSlot* take_slot(microtin_pack& p) {
  PackSlot* const slot = place_to_fill(p.slots, p.slot_count, p.clock);
  if (slot != nullptr) set_state(*slot, SlotState::kEmpty);
  return slot;
}

microtin_status refuse_tile(microtin_pack& p, microtin_status why) {
  BadTile* const bad = place_to_fill(p.bad, MICROTIN_PACK_BAD_TILES, p.clock);
  if (bad != nullptr) {
    set_why(*bad, MICROTIN_DONE);
    bad->tile = p.tile;
    bad->wanted = p.clock;
    set_why(*bad, why);
  } else {
    p.passed = p.tile;
    p.has_passed = true;
  }
  return fail_pack(p, MICROTIN_DONE);
}

microtin_status finish_tile(microtin_pack& p, PackSlot& slot, bool has_terrain) {
  slot.tile = p.tile;
  slot.wanted = p.clock;
  slot.has_terrain = has_terrain;
  set_state(slot, SlotState::kReady);
  return fail_pack(p, MICROTIN_DONE);
}

namespace {

microtin_status handle_entry(microtin_pack& p) {
  if (pack_entry_check(p.crc, p.tile, p.buffer) !=
      read_u32(p.buffer + kPackEntryBytes - kCheckBytes)) {
    return refuse_tile(p, MICROTIN_CHECKSUM);
  }
  if (!read_pack_entry(p.buffer, p.header, &p.entry)) return refuse_tile(p, MICROTIN_MALFORMED);
  if (p.entry.vertices > p.capacity) return refuse_tile(p, MICROTIN_TOO_BIG);
  PackSlot* const slot = place_to_fill(p.slots, p.slot_count, p.clock);
  if (slot == nullptr) return fail_pack(p, MICROTIN_WORKSPACE_TOO_SMALL);
  microtin_mesh* mesh = p.work;
  // What is to be made compact needs its slot not before then.
  if (mesh == nullptr || p.entry.size == 0) {
    set_state(*slot, SlotState::kEmpty);
    if (p.entry.size == 0) return finish_tile(p, *slot, false);
    p.slot = static_cast<uint8_t>(slot - p.slots);
    mesh = static_cast<microtin_mesh*>(slot->space);
  }
  microtin_decoder_init(p.decoder_space, p.decoder_bytes, mesh, &p.decoder);
  p.left = p.entry.size;
  p.stream_hash = kStreamHash;
  want(p, PackStage::kStream, p.entry.offset, p.left);
  return MICROTIN_NEED_INPUT;
}

// Whether all of the stream was taken, and is that of which the index tells.
bool is_stream(const microtin_pack& p) {
  return p.left == 0 && p.fed == p.buffered && p.stream_hash == p.entry.stream_hash;
}

// Whether it keeps the rules for tiles.
bool is_tile(const microtin_pack& p) {
  return p.is_legal && p.decoder->reconstruction.contract.vertices == p.entry.vertices;
}

microtin_status handle_stream(microtin_pack& p, uint32_t step_limit) {
  if (!p.is_counted) {
    if (p.left == p.entry.size) {
      p.is_legal = is_tile_start(p.buffer, p.buffered, tile_box(p.header.grid, p.tile));
    }
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
  if (status != MICROTIN_DONE || !is_stream(p)) return refuse_tile(p, MICROTIN_CHECKSUM);
  if (!is_tile(p)) return refuse_tile(p, MICROTIN_MALFORMED);
  if (p.work == nullptr) return finish_tile(p, p.slots[p.slot], true);
  want(p, PackStage::kStore, 0, 0);
  p.compactor = nullptr;
  return MICROTIN_STEP_LIMIT;
}

// Handles what is in the buffer, if it is complete. DONE: a tile is ready, or refused.
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
    case PackStage::kStore:
      return MICROTIN_STEP_LIMIT;
    case PackStage::kIdle:
      break;
  }
  return MICROTIN_DONE;
}

// What a course wants of a pack.
struct Wishes {
  bool is_any;   // a tile is neither there nor known to be bad, nor was it tried
  bool in_hand;  // the tile that is being read is among them
  bool has_bad;
  bool has_more;   // tiles that were not looked at
  uint32_t first;  // the first if there is any
};

// Notes which slots and bad tiles the course touches, and finds the first tile to be tried. What it
// needs on the stack is not there while a tile is decoded.
MICROTIN_ONE_COPY MICROTIN_OUT_OF_LINE Wishes wishes_of(microtin_pack& p,
                                                        const microtin_course& course) {
  Wishes wishes = {false, false, false, false, 0};
  ++p.clock;
  uint32_t left = p.slot_count + 1u;  // one that does not fit is enough to know
  TouchedTiles tiles(p.header.grid, course);
  for (; !tiles.at_end() && left != 0; tiles.next()) {
    const uint32_t tile = tiles.number(), slot = slot_of(p, tile), bad = bad_tile(p, tile);
    wishes.in_hand = wishes.in_hand || tile == p.tile;
    if (bad != MICROTIN_PACK_BAD_TILES) {
      p.bad[bad].wanted = p.clock;
      wishes.has_bad = true;
      continue;  // it needs no slot
    }
    --left;
    if (slot != p.slot_count) {
      p.slots[slot].wanted = p.clock;
    } else if (!wishes.is_any) {
      wishes.is_any = true;
      wishes.first = tile;
    }
    if (p.has_passed && tile == p.passed) {  // what was missing so far has been tried
      wishes.is_any = false;
      wishes.has_bad = true;
    }
  }
  wishes.has_more = !tiles.at_end();
  return wishes;
}

// What is said of a course of which no tile is to be tried.
microtin_status verdict(microtin_pack& p, const Wishes& wishes) {
  p.has_passed = false;
  if (wishes.has_more) return MICROTIN_WORKSPACE_TOO_SMALL;
  return wishes.has_bad ? MICROTIN_BAD_TILES : MICROTIN_DONE;
}

microtin_status prepare_tile(microtin_pack& p, const microtin_course& course, uint32_t step_limit) {
  microtin_status status = MICROTIN_DONE;
  // Once a tile is finished, the next one wants input first.
  for (int finished = 0; status == MICROTIN_DONE && finished < 2; ++finished) {
    const Wishes wishes = wishes_of(p, course);
    if (p.stage != PackStage::kIdle && !wishes.in_hand) give_up(p);
    if (p.stage == PackStage::kIdle) {
      if (!wishes.is_any) return verdict(p, wishes);
      p.tile = wishes.first;
      want(p, PackStage::kEntry, pack_entry_start(p.header, p.tile), kPackEntryBytes);
    }
    status = handle(p, step_limit);
  }
  return status;
}

// Bytes that are wanted next and lie in one sector.
uint32_t wanted_now(const microtin_pack& p) {
  const uint32_t left = static_cast<uint32_t>(p.wanted - p.buffered);
  if (p.sector == 0) return left;
  const uint32_t room = p.sector - (static_cast<uint32_t>(p.next) & (p.sector - 1u));
  return left < room ? left : room;
}

// What follows from what storage said. NEED_INPUT: go on.
microtin_status hear_storage(microtin_pack& p) {
  const Storage said = p.storage;
  p.storage = Storage::kWell;
  if (said == Storage::kFailed) return MICROTIN_IO;
  if (said == Storage::kEnds) {
    if (!p.has_header) return fail_pack(p, MICROTIN_TRUNCATED);
    refuse_tile(p, MICROTIN_TRUNCATED);
  }
  return MICROTIN_NEED_INPUT;
}

}  // namespace

microtin_status lay_out_pack(void* workspace, size_t size, uint32_t slots, uint32_t capacity,
                             uint64_t work_bytes, uint64_t slot_bytes, microtin_pack** pack) {
  if (workspace == nullptr || pack == nullptr || slots == 0 || slots > 255 || capacity < 3 ||
      capacity > MICROTIN_MAX_VERTICES) {
    return MICROTIN_ARGUMENT;
  }
  *pack = nullptr;
  if (reinterpret_cast<uintptr_t>(workspace) % MICROTIN_ALIGNMENT != 0) return MICROTIN_MISALIGNED;
  const uint64_t own_bytes = MICROTIN_PACK_ROUND(sizeof(microtin_pack) + slots * sizeof(PackSlot));
  const uint64_t decoder_bytes = MICROTIN_PACK_ROUND(MICROTIN_DECODER_BYTES(capacity));
  const uint64_t before_slots = own_bytes + decoder_bytes + work_bytes;
  // Below 2^8 * 2^32.
  if (before_slots + slots * slot_bytes > size) return MICROTIN_WORKSPACE_TOO_SMALL;
  microtin_pack& p = *static_cast<microtin_pack*>(workspace);
  uint8_t* const bytes = static_cast<uint8_t*>(workspace);
  p.slots = reinterpret_cast<PackSlot*>(&p + 1);
  p.slot_count = static_cast<uint8_t>(slots);
  p.capacity = capacity;
  p.decoder_space = bytes + own_bytes;
  p.decoder_bytes = static_cast<size_t>(decoder_bytes);
  p.slot_bytes = static_cast<size_t>(slot_bytes);
  for (uint32_t i = 0; i < slots; ++i) {
    p.slots[i].space = bytes + static_cast<size_t>(before_slots) + i * p.slot_bytes;
  }
  p.clock = 0;
  p.sector = 0;
  microtin_pack_reset(&p);
  *pack = &p;
  return MICROTIN_DONE;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_pack_init(void* workspace, size_t size, uint32_t slots, uint32_t capacity,
                                   microtin_pack** pack) {
  const uint64_t slot_bytes = MICROTIN_PACK_ROUND(MICROTIN_MESH_BYTES(capacity));
  const microtin_status status =
      lay_out_pack(workspace, size, slots, capacity, 0, slot_bytes, pack);
  if (status != MICROTIN_DONE) return status;
  (*pack)->work = nullptr;
  for (uint32_t i = 0; i < slots; ++i) {
    microtin_mesh* mesh = nullptr;
    microtin_mesh_init((*pack)->slots[i].space, (*pack)->slot_bytes, &mesh);
  }
  return MICROTIN_DONE;
}

void microtin_pack_reset(microtin_pack* pack) {
  microtin_pack& p = *pack;
  p.has_header = false;
  p.stage = PackStage::kFixed;
  p.storage = Storage::kWell;
  p.tile = 0;
  forget_bad_tiles(p);
  for (uint32_t i = 0; i < p.slot_count; ++i) set_state(p.slots[i], SlotState::kEmpty);
  give_up(p);
}

microtin_status microtin_pack_align_reads(microtin_pack* pack, uint32_t sector) {
  if (pack == nullptr || sector > 32768 || (sector & (sector - 1)) != 0) return MICROTIN_ARGUMENT;
  pack->sector = static_cast<uint16_t>(sector);
  return MICROTIN_DONE;
}

microtin_status microtin_pack_prepare(microtin_pack* pack, const microtin_course* course,
                                      uint32_t step_limit) {
  if (pack == nullptr || course == nullptr || !is_legal(*course)) return MICROTIN_ARGUMENT;
  const microtin_status heard = hear_storage(*pack);
  if (heard != MICROTIN_NEED_INPUT) return heard;
  if (!pack->has_header) {
    const microtin_status status = handle(*pack, step_limit);
    if (!pack->has_header) return status;
  }
  return prepare_tile(*pack, *course, step_limit);
}

void microtin_pack_wanted(microtin_pack* pack, uint64_t* offset, uint8_t** buffer, size_t* size) {
  *offset = pack->next;
  *buffer = pack->buffer + pack->buffered;
  *size = static_cast<size_t>(wanted_now(*pack));
}

void microtin_pack_given(microtin_pack* pack, int32_t taken) {
  const int32_t most = static_cast<int32_t>(wanted_now(*pack));
  if (most == 0) return;
  if (taken <= 0 || taken > most) {
    pack->storage = taken == 0 ? Storage::kEnds : Storage::kFailed;
    return;
  }
  pack->buffered = static_cast<uint8_t>(pack->buffered + taken);
  pack->next += static_cast<uint32_t>(taken);
}

int microtin_pack_bad_tile(const microtin_pack* pack, uint32_t i, uint32_t* tile,
                           microtin_status* why) {
  if (i >= MICROTIN_PACK_BAD_TILES || pack->bad[i].is_empty()) return 0;
  *tile = pack->bad[i].tile;
  *why = static_cast<microtin_status>(pack->bad[i].why);
  return 1;
}

void microtin_pack_retry(microtin_pack* pack) {
  forget_bad_tiles(*pack);
}
// --- decoder/pack_query.cpp
// Queries on packs whose tiles are meshes, and what headers say.


using namespace microtin;

int microtin_pack_header(const microtin_pack* pack, microtin_pack_info* info) {
  if (!pack->has_header) return 0;
  const PackHeader& header = pack->header;
  info->x_max = header.grid.x_max;
  info->y_max = header.grid.y_max;
  info->tile_width = header.grid.width;
  info->tile_height = header.grid.height;
  info->most_vertices = header.most_vertices;
  info->compact_bytes = header.compact_bytes;
  info->lowest = header.lowest;
  info->highest = header.highest;
  info->x = pack->axis[0];
  info->y = pack->axis[1];
  info->z = pack->axis[2];
  return 1;
}

int microtin_pack_to_lattice(const microtin_axis* axis, uint32_t most, int64_t value,
                             uint32_t per_unit, int64_t* lattice) {
  if (axis->numerator >> 30 != 0 || most > kPackExtentMost) return 0;  // their product: < 2^61
  const int64_t found = half_steps(*axis, most, value, per_unit);
  if (found < 0) return 0;
  *lattice = rounded_steps(found);
  return 1;
}

microtin_answer microtin_pack_height_at(const microtin_pack* pack, int64_t x, int64_t y,
                                        uint32_t* hint, int32_t* height) {
  return height_in_pack<MeshForm>(*pack, x, y, hint, height);
}

microtin_answer microtin_pack_highest(const microtin_pack* pack, const microtin_course* course,
                                      int32_t* height) {
  return highest_in_pack<MeshForm>(*pack, *course, height);
}

microtin_answer microtin_pack_fill(const microtin_pack* pack, const microtin_block* block,
                                   int16_t* heights) {
  return fill_from_pack<MeshForm>(*pack, *block, heights);
}
// --- decoder/query.cpp
// Queries on a decoded mesh.

namespace microtin {
namespace {
namespace {

uint32_t public_vertex(Index v) {
  return v == kInfinity ? static_cast<uint32_t>(MICROTIN_INFINITY) : v;
}

}  // namespace
}  // namespace
}  // namespace microtin

using namespace microtin;

uint32_t microtin_vertex_count(const microtin_mesh* mesh) {
  return mesh->mesh.vertices;
}

void microtin_vertex(const microtin_mesh* mesh, uint32_t v, uint16_t* x, uint16_t* y, int16_t* z) {
  MICROTIN_ASSERT(v < mesh->mesh.vertices);
  const Point at = mesh->mesh.place[v];
  *x = at.x;
  *y = at.y;
  *z = mesh->mesh.z[v];
}

uint32_t microtin_triangle_count(const microtin_mesh* mesh) {
  return mesh->mesh.triangles;
}

microtin_triangle_kind microtin_triangle(const microtin_mesh* mesh, uint32_t t, uint32_t v[3]) {
  MICROTIN_ASSERT(t < mesh->mesh.triangles);
  const Index f = first_edge(static_cast<Index>(t));
  for (uint32_t i = 0; i < 3; ++i) v[i] = public_vertex(mesh->mesh.origin[f + i]);
  if (is_ghost(mesh->mesh, static_cast<Index>(t))) return MICROTIN_GHOST;
  return has_terrain(*mesh, static_cast<Index>(t)) ? MICROTIN_REAL : MICROTIN_VOID;
}

uint32_t microtin_neighbour(const microtin_mesh* mesh, uint32_t t, uint32_t corner) {
  MICROTIN_ASSERT(t < mesh->mesh.triangles && corner < 3);
  const Index f = first_edge(static_cast<Index>(t));
  return triangle_of(mesh->mesh.twin[static_cast<Index>(f + corner)]);
}

uint64_t microtin_digest(const microtin_mesh* mesh) {
  uint64_t sum = 0;
  for (Index t = 0; t < mesh->mesh.triangles; ++t) {
    if (is_ghost(mesh->mesh, t)) continue;
    const MeshCursor cursor(*mesh, first_edge(t));
    Vertex corner[3];
    for (uint32_t i = 0; i < 3; ++i) corner[i] = cursor.vertex(cursor.corner(i));
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
  const microtin_answer refusal = refusal_of(*mesh, flags);
  if (refusal != MICROTIN_HEIGHT) return refusal;
  const int32_t most = static_cast<int32_t>(kLatticeMax) * 256;
  if (x < 0 || x > most || y < 0 || y > most) return MICROTIN_OUTSIDE;
  const FinePoint p = {x, y};
  Index t = *hint < m.triangles ? static_cast<Index>(*hint) : static_cast<Index>(0);
  const bool arrived = walk_to(*mesh, p, step_limit == 0 ? m.triangles : step_limit, &t);
  *hint = t;
  if (!arrived) return MICROTIN_NOT_YET;
  if (is_ghost(m, t)) return MICROTIN_OUTSIDE;
  return answer_at(MeshCursor(*mesh, first_edge(t)), p, height);
}

void microtin_placement(const microtin_mesh* mesh, microtin_axis* x, microtin_axis* y,
                        microtin_axis* z) {
  microtin_axis axis[3];
  place_on_lattice(axis);
  const microtin_axis* const known = mesh->is_placed ? mesh->axis : axis;
  *x = known[0];
  *y = known[1];
  *z = known[2];
}

int microtin_to_lattice(const microtin_axis* axis, int64_t value, uint32_t per_unit,
                        int32_t* lattice) {
  // Numerators are below 2^40.
  const int64_t found = half_steps(*axis, kLatticeMax, value, per_unit);
  if (found < -1) return 0;
  *lattice = static_cast<int32_t>(rounded_steps(found));
  return 1;
}
// --- decoder/real.cpp
// From the lattice to real units.

namespace microtin {
namespace {
namespace {

constexpr int64_t kMostOffset = static_cast<int64_t>(1) << 61;
constexpr int64_t kMostUnits = static_cast<int64_t>(1) << 38;

struct Floor {
  int64_t whole;
  uint64_t rest;
};

Floor floor_of(int64_t n, uint64_t d) {
  const bool negative = n < 0;
  const Quotient part = divide(negative ? ~static_cast<uint64_t>(n) : static_cast<uint64_t>(n), d);
  const int64_t whole = static_cast<int64_t>(part.whole);
  return negative ? Floor{~whole, d - 1 - part.rest} : Floor{whole, part.rest};
}

// rest / d * factor, rounded to nearest, halves up; rest < d < 2^57, factor < 2^25. Bit by bit: the
// product has more than 64.
int64_t scaled(uint64_t rest, uint64_t d, uint32_t factor) {
  uint64_t left = 0;
  int64_t whole = 0;
  for (uint32_t bit = 1ul << 24; bit != 0; bit >>= 1) {
    whole *= 2;
    left *= 2;  // < 2 d
    if ((factor & bit) != 0) left += rest;
    for (; left >= d; left -= d) ++whole;  // twice at most: left < 3 d
  }
  return whole + (left * 2 >= d ? 1 : 0);
}

// (offset + numerator * place) / denominator * per_unit; the place has so many fractional bits, at
// most 16.
bool real_value(const microtin_axis& axis, int64_t place, int bits, uint32_t per_unit,
                int64_t* value) {
  if (per_unit == 0 || per_unit > (1ul << 24)) return false;
  if (axis.offset >= kMostOffset || axis.offset <= -kMostOffset) return false;
  const int64_t steps = place >> bits;  // rounded down
  const uint64_t size = static_cast<uint64_t>(steps < 0 ? -steps : steps);
  if (size > divide(static_cast<uint64_t>(1) << 62, axis.numerator).whole) return false;
  // Within 2^61 + 2^62.
  const int64_t numerator = static_cast<int64_t>(axis.numerator);
  const Floor units = floor_of(axis.offset + numerator * steps, axis.denominator);
  // Below 2^40 * 2^16 each.
  const uint64_t fraction = static_cast<uint64_t>(place) & ((static_cast<uint64_t>(1) << bits) - 1);
  const uint64_t fine = (units.rest << bits) + axis.numerator * fraction,
                 d = axis.denominator << bits;
  const Quotient more = divide(fine, d);
  const int64_t whole = units.whole + static_cast<int64_t>(more.whole);  // < 2^63 + 2^41
  if (whole >= kMostUnits || whole < -kMostUnits) return false;
  *value = whole * static_cast<int64_t>(per_unit) + scaled(more.rest, d, per_unit);
  return true;
}

}  // namespace
}  // namespace
}  // namespace microtin

using namespace microtin;

int microtin_from_lattice(const microtin_axis* axis, int64_t lattice, uint32_t per_unit,
                          int64_t* value) {
  return real_value(*axis, lattice, 8, per_unit, value) ? 1 : 0;
}

int microtin_real_height(const microtin_axis* z, int32_t height, uint32_t per_unit,
                         int32_t* value) {
  int64_t found = 0;
  if (!real_value(*z, height, 16, per_unit, &found)) return 0;
  if (found != static_cast<int32_t>(found)) return 0;
  *value = static_cast<int32_t>(found);
  return 1;
}
// --- decoder/walk.cpp

namespace microtin {
namespace {
namespace {

// A half-edge of the triangle or, from a ghost, of the real one beside it.
Index real_edge(const Mesh& mesh, Index triangle) {
  Index h = first_edge(triangle);
  if (!is_ghost(mesh, triangle)) return h;
  while (mesh.origin[h] == kInfinity || mesh.origin[next_in_triangle(h)] == kInfinity) ++h;
  return mesh.twin[h];
}

}  // namespace

MICROTIN_WITHOUT_CALLS bool walk_to(const microtin_mesh& mesh, FinePoint p, uint32_t step_limit,
                                    Index* triangle) {
  MeshCursor cursor(mesh, real_edge(mesh.mesh, *triangle));
  const bool arrived = walk(cursor, p, step_limit);
  *triangle = cursor.triangle();
  return arrived;
}

}  // namespace
}  // namespace microtin

#if defined(__clang__) && defined(__OPTIMIZE_SIZE__)
#pragma clang attribute pop
#endif
