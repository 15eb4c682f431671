// SPDX-License-Identifier: MIT
// Marks of edges: lines on a mesh, each a path of edges with a class. How marks are kept, and their
// coding, which both sides run.
#ifndef MICROTIN_SHARED_EDGE_MARKS_HPP
#define MICROTIN_SHARED_EDGE_MARKS_HPP

#include "shared/mesh.hpp"
#include "shared/probability.hpp"

namespace microtin {

constexpr uint32_t kMarkChunk = 19;     // the type of a chunk with marks
constexpr uint32_t kLineClasses = 15;   // 1 .. 15; 0 is no mark
constexpr uint32_t kMostLookedAt = 31;  // edges around a vertex that may follow
constexpr uint32_t kScannedInStep = 8;  // half-edges

// Two bits for each half-edge: of an edge the lower half of its class at the half-edge with the
// smaller number, the upper half at the other.
constexpr uint32_t edge_mark_bytes(uint32_t vertices) {
  return vertices + (vertices + 1) / 2;
}

inline uint32_t half_mark(const uint8_t* marks, Index h) {
  return static_cast<uint32_t>(marks[h >> 2]) >> (2 * (h & 3u)) & 3u;
}

// The class of an edge, 0 if it has no mark.
inline uint32_t class_of_edge(const Mesh& mesh, const uint8_t* marks, Index h) {
  const Index twin = mesh.twin[h];
  return half_mark(marks, smaller(h, twin)) | half_mark(marks, larger(h, twin)) << 2;
}

// Marks an edge that has no mark.
inline void mark_edge(const Mesh& mesh, uint8_t* marks, Index h, uint32_t kind) {
  const Index twin = mesh.twin[h];
  const Index low = smaller(h, twin), high = larger(h, twin);
  marks[low >> 2] = static_cast<uint8_t>(marks[low >> 2] | (kind & 3u) << (2 * (low & 3u)));
  marks[high >> 2] = static_cast<uint8_t>(marks[high >> 2] | (kind >> 2) << (2 * (high & 3u)));
}

inline Index end_of(const Mesh& mesh, Index h) {
  return mesh.origin[next_in_triangle(h)];
}

// The edges without a mark that may follow a half-edge in a line: from its end, in the order that
// they have counter-clockwise, those to the right before those to the left.
struct Ways {
  Index edge[kMostLookedAt];
  uint32_t count;
  uint32_t right;  // of them turn to the right
  bool meets;      // another marked edge ends there
};

inline Ways ways_after(const Mesh& mesh, const uint8_t* marks, Index h) {
  Ways ways;
  ways.count = ways.right = 0;
  ways.meets = false;
  const Index back = mesh.twin[h];
  const Point from = point_of(mesh, mesh.origin[h]), at = point_of(mesh, mesh.origin[back]);
  Index e = mesh.twin[previous_in_triangle(back)];
  for (uint32_t i = 0; i < kMostLookedAt && e != back; ++i) {
    const Index to = end_of(mesh, e);
    if (to == kInfinity) {
      // There is no edge.
    } else if (class_of_edge(mesh, marks, e) != 0) {
      ways.meets = true;
    } else {
      ways.edge[ways.count++] = e;
      if (orient2d(from, at, point_of(mesh, to)) < 0) ways.right = ways.count;
    }
    e = mesh.twin[previous_in_triangle(e)];
  }
  return ways;
}

// rough_log2 of a number below 2^34.
inline Log2 rough_log2_of_area(int64_t v) {
  const uint64_t size = static_cast<uint64_t>(v);
  return size >> 32 != 0 ? rough_log2(static_cast<uint32_t>(size >> 2)) + 2 * kLog2One
                         : rough_log2(static_cast<uint32_t>(size));
}

constexpr Log2 kTurnsBack = Log2{1} << 15;

// How far an edge turns away from straight on: the logarithm of the square of the sine, times a
// number that all edges after h share.
inline Log2 bend_of(const Mesh& mesh, Index h, Index e) {
  const Point at = point_of(mesh, mesh.origin[e]);
  const Offset way = at - point_of(mesh, mesh.origin[h]);
  const Offset to = point_of(mesh, end_of(mesh, e)) - at;
  if (dot(way, to) <= 0) return kTurnsBack;
  const int64_t area = cross(way, to);
  return 2 * rough_log2_of_area((area < 0 ? -area : area) | 1) - rough_log2_of_area(dot(to, to));
}

// Which side goes straight on: 0 the right one, 4 the left one.
inline uint32_t straight_side(const Mesh& mesh, Index h, const Ways& ways) {
  const Log2 right = bend_of(mesh, h, ways.edge[ways.right - 1]);
  const Log2 left = bend_of(mesh, h, ways.edge[ways.right]);
  return static_cast<uint32_t>(kept_within((right - left + 1280) >> 9, 0, 4));
}

// Adaptive bits, by number.
constexpr uint32_t kBegins = 0, kSameClass = 1, kEnds = 2, kSide = 4, kFarther = 9;
constexpr uint32_t kMarkBitCount = 12;

constexpr uint8_t kMarkStarts[kMarkBitCount] MICROTIN_IN_FLASH = {1,   220, 64,  200, 60, 84,
                                                                  128, 172, 196, 48,  24, 16};

enum class MarkStage : uint8_t {
  kBetween,  // lines
  kForward,  // from the end of a line's first edge on
  kBackward  // from its begin on
};

// Where the coding of marks stands.
struct EdgeMarking {
  const Mesh* mesh;
  uint8_t* marks;
  uint32_t left;  // edges to be marked
  Index next;     // the half-edge to be looked at for a line
  Index first;    // of the line
  Index last;     // of the line so far, towards its end
  uint8_t kind;   // the line's class
  MarkStage stage;
  AdaptiveBit bits[kMarkBitCount];
};

// The marks must be clear.
inline void begin_marking(EdgeMarking& m, const Mesh& mesh, uint8_t* marks, uint32_t edges) {
  m.mesh = &mesh;
  m.marks = marks;
  m.left = edges;
  m.next = m.first = m.last = 0;
  m.kind = 1;
  m.stage = MarkStage::kBetween;
  for (uint32_t i = 0; i < kMarkBitCount; ++i) {
    m.bits[i] = adaptive_bit(read_table(kMarkStarts + i));
  }
}

inline void add_to_line(EdgeMarking& m, Index h) {
  mark_edge(*m.mesh, m.marks, h, m.kind);
  m.last = h;
  --m.left;
}

// Codes which of the ways goes on; their count if the line ends there.
template <class Coder>
uint32_t code_way(EdgeMarking& m, Coder& coder, const Ways& ways, uint32_t way) {
  const uint32_t end = ways.count;
  if (end == 0) return end;
  if (code_bit(coder, m.bits[kEnds + (ways.meets ? 1u : 0u)], way == end)) return end;
  bool is_left = ways.right == 0;
  if (!is_left && ways.right != end) {
    const uint32_t side = straight_side(*m.mesh, m.last, ways);
    is_left = code_bit(coder, m.bits[kSide + side], way >= ways.right);
  }
  const uint32_t most = is_left ? end - ways.right : ways.right;
  const uint32_t wanted = is_left ? way - ways.right : ways.right - 1 - way;
  uint32_t away = 0;  // from straight on
  while (away + 1 < most &&
         code_bit(coder, m.bits[kFarther + smaller<uint32_t>(away, 2)], wanted > away)) {
    ++away;
  }
  return is_left ? ways.right + away : ways.right - 1 - away;
}

// Looks for the begin of a line. False if there are no more edges.
template <class Coder>
bool find_line(EdgeMarking& m, Coder& coder) {
  const Mesh& mesh = *m.mesh;
  for (uint32_t i = 0; i < kScannedInStep; ++i) {
    const Index h = m.next;
    if (h == 3u * mesh.triangles) return false;
    m.next = static_cast<Index>(h + 1u);
    const bool may_be = h < mesh.twin[h] && mesh.origin[h] != kInfinity &&
                        end_of(mesh, h) != kInfinity && class_of_edge(mesh, m.marks, h) == 0;
    if (!may_be || !code_bit(coder, m.bits[kBegins], coder.begins(h))) continue;
    const uint32_t kind = coder.line_class(h);
    if (!code_bit(coder, m.bits[kSameClass], kind == m.kind)) {
      m.kind = static_cast<uint8_t>(1 + coder.uniform(kLineClasses, kind - 1));
    }
    m.first = h;
    m.stage = MarkStage::kForward;
    add_to_line(m, h);
    break;
  }
  return true;
}

// Marks at most one edge, and looks at kScannedInStep half-edges, or at kMostLookedAt around a
// vertex. False if the edges do not suffice. Must not be called with none left.
//
// A coder writes or reads, and supplies begins(h), whether a line is to begin with a half-edge;
// line_class(h), that of the line; and way(h, ways), which of the ways the line goes on with.
template <class Coder>
bool code_marks(EdgeMarking& m, Coder& coder) {
  if (m.stage == MarkStage::kBetween) return find_line(m, coder);
  const Ways ways = ways_after(*m.mesh, m.marks, m.last);
  const uint32_t way = code_way(m, coder, ways, coder.way(m.last, ways));
  if (way != ways.count) {
    add_to_line(m, ways.edge[way]);
  } else if (m.stage == MarkStage::kForward) {
    m.stage = MarkStage::kBackward;
    m.last = m.mesh->twin[m.first];
  } else {
    m.stage = MarkStage::kBetween;
  }
  return true;
}

}  // namespace microtin

#endif
