// SPDX-License-Identifier: MIT
// Making compact terrains: a path through the vertices of a mesh, then its laced ring.
#include "decoder/ring.hpp"

namespace microtin {
namespace {

// What is done, item by item, in turn. Up to kExpand the mesh is only looked at.
enum class Work : uint8_t {
  kClear,      // bytes of bits
  kBox,        // vertices
  kInfinity,   // half-edges, up to one that starts at infinity
  kExpand,     // triangles, as the path is found
  kNumber,     // corners, along the path
  kVertices,   // positions
  kTriangles,  // triangles of the mesh
  kSlits,      // positions
  kLeft,       // positions: leaves to the left of the path
  kRight,      // positions: leaves to the right of the path
  kMove,       // eight bytes, where the mesh was
  kComplete
};

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
  microtin::RingShape header;
  uint32_t ringed;         // vertices that the expansion reached, infinity included
  uint8_t* triangles;      // a bit each: to the left of the path
  uint8_t* vertices;       // a bit each: on the path
  microtin::Index* order;  // by position: a vertex or, with kRingFlag, the position it repeats
  // The body, where it is written: in the target or, if that is the mesh, over its twins.
  microtin::Index* looks;
  microtin::RingVertex* vertex;
  microtin::Index* repeat;  // the next to be listed
  uint16_t* y;
  microtin::Mesh mesh;  // the source's
  microtin_mesh* source;
  microtin_compact* target;
  size_t body_bytes;
  size_t body_most, order_most;  // bytes, positions for which there is room
  uint32_t below, above;         // margins
  microtin_axis axis[3];
};

static_assert(sizeof(microtin_compactor) % sizeof(microtin::Index) == 0, "numbers follow it");
static_assert(sizeof(microtin_compactor) + 8 <= MICROTIN_COMPACTOR_HEADER_BYTES, "see compact.h");

namespace microtin {
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

bool put_vertex(Compactor& c) {
  const uint32_t i = c.cursor++;
  const Mesh& mesh = c.mesh;
  Index v = c.order[i];
  if ((v & kRingFlag) != 0) v = c.order[v & kRingNumber];
  if (i == 0) v = 0;  // of infinity, any
  const Point at = point_of(mesh, v);
  c.looks[2 * i] = c.looks[2 * i + 1] = 0;
  RingVertex& vertex = c.vertex[i];
  vertex.z = mesh.z[v];
  if (c.header.is_narrow != 0) {
    vertex.place = static_cast<uint16_t>((at.x - c.least.x) | (at.y - c.least.y) << 8);
  } else {
    vertex.place = at.x;
    c.y[i] = at.y;
  }
  return c.cursor == c.header.positions;
}

// The triangle of the positions low < middle < high. What a full one lacks, its leaf gets later.
void put(Compactor& c, uint32_t side, uint32_t low, uint32_t middle, uint32_t high, uint32_t flag) {
  const bool has_left = low + 1 != middle, has_right = middle + 1 != high;
  uint32_t value = has_right ? high : has_left ? low : 0;
  if (has_left == has_right) value |= kRingPair;
  c.looks[2 * middle + side] = static_cast<Index>(value | flag);
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
  const bool flagged = low != 0 && has_voids(*c.source) && is_void(c.source->voids, t);
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
    put(c, 0, last, i - 1, i, kRingFlag);
    put(c, 0, first - 1, last, i, kRingFlag);
    c.order[first] = static_cast<Index>(i);
    *c.repeat++ = static_cast<Index>(i);
  }
  return c.cursor == c.header.positions;
}

// Along a side: `order` of each middle becomes its a, and each leaf gets that of the full triangle
// before. A full one's left child is what the triangle before has grown to, going up as long as
// that is a right child: one further up is an item, too, so that there are at most two for each.
bool put_leaf(Compactor& c) {
  const uint32_t side = c.work == Work::kLeft ? 0 : 1, middle = c.cursor;
  Index* const looks = c.looks + side;
  Index& slot = looks[2 * middle];
  const uint32_t number = slot & kRingNumber;
  const bool is_pair = (slot & kRingPair) != 0;
  if (is_pair && number > middle) {
    if (told(looks, c.low) == middle) {
      c.low = c.order[c.low];
      return false;
    }
    c.full_low = c.low;
  } else {
    if (is_pair) slot = static_cast<Index>(slot + c.full_low);
    c.low = !is_pair && number < middle ? number : middle - 1;
  }
  c.order[middle] = static_cast<Index>(c.low);
  return ++c.cursor == c.header.positions - 1;
}

// Eight bytes. The body ends where it begins, or further ahead.
bool move(Compactor& c) {
  uint8_t* const to = reinterpret_cast<uint8_t*>(c.target + 1);
  const uint8_t* const from = reinterpret_cast<const uint8_t*>(c.looks);
  for (uint32_t i = 0; i < 8 && c.cursor != c.body_bytes; ++i, ++c.cursor) {
    to[c.cursor] = from[c.cursor];
  }
  return c.cursor == c.body_bytes;
}

// Handles an item.
bool handle(Compactor& c) {
  switch (c.work) {
    case Work::kClear:
      return clear(c);
    case Work::kBox:
      return extend_box(c);
    case Work::kInfinity:
      return find_infinity(c);
    case Work::kExpand:
      return expand(c);
    case Work::kNumber:
      return number(c);
    case Work::kVertices:
      return put_vertex(c);
    case Work::kTriangles:
      return put_triangle(c);
    case Work::kSlits:
      return put_slit(c);
    case Work::kLeft:
    case Work::kRight:
      return put_leaf(c);
    default:
      break;
  }
  return move(c);
}

// What is needed, and whether it is there.
microtin_status measure(Compactor& c) {
  RingShape& header = c.header;
  header.positions = 2 * (header.vertices + 1) - c.ringed;
  header.is_narrow = c.most.x - c.least.x < 256 && c.most.y - c.least.y < 256;
  if (header.is_narrow != 0) {
    header.west = c.least.x;
    header.south = c.least.y;
  }
  c.body_bytes = body_bytes(header);
  c.repeat = c.looks + 2 * header.positions;
  c.vertex = reinterpret_cast<RingVertex*>(c.repeat + repeats_of(header));
  c.y = reinterpret_cast<uint16_t*>(c.vertex + header.positions);
  if (!has_room_for(header.positions)) return MICROTIN_STATUS_TOO_BIG;
  const bool fits = c.body_bytes <= c.body_most && header.positions <= c.order_most;
  return fits ? MICROTIN_STATUS_STEP_LIMIT : MICROTIN_STATUS_WORKSPACE_TOO_SMALL;
}

// The work after that in hand, but for what is not wanted.
Work work_after(const Compactor& c) {
  Work next = static_cast<Work>(static_cast<uint8_t>(c.work) + 1);
  if (next == Work::kSlits && c.header.positions == c.header.vertices + 1) next = Work::kLeft;
  if (next == Work::kMove && c.looks == reinterpret_cast<Index*>(c.target + 1)) {
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
void put_header(const Compactor& c) {
  static_cast<RingShape&>(*c.target) = c.header;
  c.target->below = c.below;
  c.target->above = c.above;
  for (int i = 0; i < 3; ++i) c.target->axis[i] = c.axis[i];
}

// Makes ready for the next work. False if there is none, or no room.
bool begin_next(Compactor& c) {
  if (c.work == Work::kExpand) {
    c.status = static_cast<uint8_t>(measure(c));
    if (c.status != MICROTIN_STATUS_STEP_LIMIT) return false;
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
  if (c.work != Work::kComplete) return true;
  put_header(c);
  c.status = MICROTIN_STATUS_OK;
  return false;
}

// Where the body is written, and how much room is there: over the twins if the target is the mesh,
// since nothing needs these once corners have numbers.
void find_room(Compactor& c, size_t size) {
  c.looks = reinterpret_cast<Index*>(c.target + 1);
  c.body_most = size < sizeof(microtin_compact) ? 0 : size - sizeof(microtin_compact);
  if (static_cast<void*>(c.target) != c.source) return;
  c.looks = c.mesh.twin;
  const size_t twins = 6 * static_cast<size_t>(c.source->capacity) * sizeof(Index);
  if (twins < c.body_most) c.body_most = twins;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_compactor_init(void* workspace, size_t size, microtin_mesh* mesh,
                                        void* scratch, size_t scratch_size,
                                        microtin_compactor** compactor) {
  if (workspace == nullptr || mesh == nullptr || scratch == nullptr || compactor == nullptr) {
    return MICROTIN_STATUS_ARGUMENT;
  }
  *compactor = nullptr;
  if ((reinterpret_cast<uintptr_t>(workspace) | reinterpret_cast<uintptr_t>(scratch)) %
          MICROTIN_ALIGNMENT !=
      0) {
    return MICROTIN_STATUS_MISALIGNED;
  }
  const uint32_t n = mesh->mesh.vertices;
  if (n == 0 || mesh->verified_vertices != n) return MICROTIN_STATUS_ARGUMENT;
  const size_t order_at = sizeof(Compactor) + bit_bytes(n);
  if (scratch_size < order_at) return MICROTIN_STATUS_WORKSPACE_TOO_SMALL;
  Compactor& c = *static_cast<Compactor*>(scratch);
  c = Compactor();
  c.below = mesh->below;
  c.above = mesh->above;
  __builtin_memcpy(c.axis, mesh->axis, sizeof c.axis);
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
  c.status = MICROTIN_STATUS_STEP_LIMIT;
  find_room(c, size);
  *compactor = &c;
  return MICROTIN_STATUS_OK;
}

microtin_status microtin_compactor_run(microtin_compactor* compactor, microtin_compact** compact,
                                       uint32_t step_limit) {
  if (compactor == nullptr || compact == nullptr) return MICROTIN_STATUS_ARGUMENT;
  Compactor& c = *compactor;
  *compact = nullptr;
  uint32_t left = step_limit == 0 ? 0xFFFFFFFFu : step_limit;
  bool goes_on = c.status == MICROTIN_STATUS_STEP_LIMIT;
  for (; goes_on && left != 0; --left) goes_on = !handle(c) || begin_next(c);
  if (c.status == MICROTIN_STATUS_OK) *compact = c.target;
  return static_cast<microtin_status>(c.status);
}

void microtin_compactor_required_bytes(const microtin_compactor* compactor, size_t* bytes,
                                       size_t* scratch_bytes) {
  const Compactor& c = *compactor;
  const uint32_t n = c.header.vertices;
  *bytes = sizeof(microtin_compact) + c.body_bytes;
  *scratch_bytes =
      sizeof(Compactor) + bit_bytes(n) + static_cast<size_t>(c.header.positions) * sizeof(Index);
}
