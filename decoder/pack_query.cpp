// SPDX-License-Identifier: MIT
// Queries on the tiles of a pack that are there. They only read, so they may interrupt anything.
#include "decoder/axis.hpp"
#include "decoder/pack_state.hpp"

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

// How bad an answer is. No switch: compilers make tables of those, which AVR would keep in RAM.
int rank(microtin_answer answer) {
  if (answer == MICROTIN_NOT_DECODED) return 4;
  if (answer == MICROTIN_IN_BAD_TILE) return 3;
  if (answer == MICROTIN_OUTSIDE) return 2;
  return answer == MICROTIN_IN_VOID ? 1 : 0;
}

microtin_answer worse(microtin_answer a, microtin_answer b) {
  return rank(a) > rank(b) ? a : b;
}

// Of a tile that is not there.
microtin_answer answer_without(const microtin_pack& p, uint32_t tile) {
  return bad_tile(p, tile) == MICROTIN_PACK_BAD_TILES ? MICROTIN_NOT_DECODED : MICROTIN_IN_BAD_TILE;
}

int32_t smaller(int32_t a, int32_t b) {
  return a < b ? a : b;
}

int32_t larger(int32_t a, int32_t b) {
  return a < b ? b : a;
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

LocalPoint point_at(const Mesh& mesh, Index v) {
  const Point p = point_of(mesh, v);
  return LocalPoint{p.x * static_cast<int32_t>(256), p.y * static_cast<int32_t>(256)};
}

// The half-edge of a ghost between finite vertices, given its first.
Index hull_edge_of(const Mesh& mesh, Index first) {
  const Index* const v = mesh.origin + first;
  return static_cast<Index>(first + (v[0] == kInfinity ? 1u : v[1] == kInfinity ? 2u : 0u));
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
int64_t share(int32_t rise, int64_t part, int64_t whole) {
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

bool is_less(Fraction a, Fraction b) {
  return static_cast<int64_t>(a.part) * b.whole < static_cast<int64_t>(b.part) * a.whole;
}

// Whether what is `from` where the course begins and `to` where it ends, each within +-2^51, and
// linear between, is above 0 at a fraction of it. In two parts, of which the low one is positive:
// below 2^50 and 2^51.
bool is_positive_at(Fraction f, int64_t from, int64_t to) {
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
        x_(reach(begin_.x, end_.x)),
        y_(reach(begin_.y, end_.y)),
        enters_{0, 1},
        leaves_{begin_.x != end_.x || begin_.y != end_.y, 1} {
    clip(begin_.x, end_.x, static_cast<int32_t>(box.x_end - box.x) * 256);
    clip(begin_.y, end_.y, static_cast<int32_t>(box.y_end - box.y) * 256);
  }

  // Whether the tile holds more of the course than a point.
  bool has_length() const { return is_less(enters_, leaves_); }

  // Looks at all triangles; at most microtin_triangle_count of them. False if a part of the course
  // in the tile is not known.
  bool look(const microtin_mesh& m, int32_t* highest) const {
    bool is_known = m.mesh.triangles != 0;
    for (Index t = 0; t < m.mesh.triangles; ++t) {
      const Index f = first_edge(t);
      const Index* const v = m.mesh.origin + f;
      if (is_ghost(v[0], v[1], v[2])) {
        is_known = is_known && !leaves_at(m.mesh, f);
      } else if (!is_aside(m.mesh, v)) {
        const Corner corner[3] = {corner_at(m.mesh, v[0]), corner_at(m.mesh, v[1]),
                                  corner_at(m.mesh, v[2])};
        if (has_terrain(m, t)) {
          for (int i = 0; i < 3; ++i) look_at_edge(corner[i], corner[i == 2 ? 0 : i + 1], highest);
        } else {
          is_known = !loses_in(m, f, corner) && is_known;
          for (int i = 0; i < 3; ++i) look_at_corner(corner[i], highest);
        }
      }
    }
    return is_known;
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
  bool is_aside(const Mesh& mesh, const Index* v) const {
    const Point a = point_of(mesh, v[0]), b = point_of(mesh, v[1]), c = point_of(mesh, v[2]);
    return are_aside(a.x, b.x, c.x, x_) || are_aside(a.y, b.y, c.y, y_);
  }
  static bool are_aside(int32_t a, int32_t b, int32_t c, const Reach& reach) {
    return (a < reach.low && b < reach.low && c < reach.low) ||
           (a > reach.high && b > reach.high && c > reach.high);
  }

  Corner corner_at(const Mesh& mesh, Index v) const {
    const LocalPoint at = point_at(mesh, v);
    return Corner{at, mesh.z[v], orient(begin_, end_, at)};
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
  bool loses_in(const microtin_mesh& m, Index first, const Corner* corner) const {
    if (passes_inside(corner)) return true;
    for (uint32_t i = 0; i < 3; ++i) {
      const Corner &a = corner[i], &b = corner[i == 2 ? 0 : i + 1];
      if (a.side == 0 && b.side == 0 && runs_along(a.at, b.at) &&
          !has_terrain(m, triangle_of(m.mesh.twin[first + i]))) {
        return true;
      }
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

  // Whether, in the tile, a part of the course lies beyond a ghost's hull edge, which runs with the
  // outside to its left.
  bool leaves_at(const Mesh& mesh, Index first) const {
    const Index h = hull_edge_of(mesh, first);
    const LocalPoint a = point_at(mesh, mesh.origin[h]),
                     b = point_at(mesh, mesh.origin[next_in_triangle(h)]);
    const int64_t from = orient(a, b, begin_), to = orient(a, b, end_);
    if (from <= 0 && to <= 0) return false;
    return is_positive_at(enters_, from, to) || is_positive_at(leaves_, from, to);
  }

  LocalPoint begin_, end_;
  Reach x_, y_;
  Fraction enters_, leaves_;  // what of the course lies in the tile
};

// The known edges of a tile's hull along a border line, in the order of their places.
class BorderEdges {
 public:
  // The line x (if vertical) or y = `line`, a side of the tile. At most two rounds of the hull.
  BorderEdges(const microtin_mesh* mesh, bool vertical, int32_t line)
      : mesh_(mesh), vertical_(vertical), line_(line), rises_(vertical == (line == 0)), h_(0) {
    const uint32_t triangles = mesh == nullptr ? 0 : mesh->mesh.triangles;
    Index ghost = 0;
    while (ghost < triangles && !is_ghost(mesh->mesh, ghost)) ++ghost;
    if (ghost >= triangles) {
      mesh_ = nullptr;
      return;
    }
    h_ = hull_edge_of(mesh->mesh, first_edge(ghost));
    bool was_on_line = true;
    for (uint32_t i = 0; i < 2 * triangles; ++i, was_on_line = is_on_line(), advance()) {
      if (!was_on_line && is_on_line()) return;
    }
    mesh_ = nullptr;
  }

  // How far the known edges that hold a place reach; that place if none does. Places do not fall
  // from call to call.
  int32_t reach(int32_t from) {
    while (mesh_ != nullptr && larger(along(0), along(1)) <= from) {
      advance();
      if (!is_on_line()) mesh_ = nullptr;
    }
    if (mesh_ == nullptr || smaller(along(0), along(1)) > from) return from;
    const bool is_known = has_terrain(*mesh_, triangle_of(mesh_->mesh.twin[h_]));
    return is_known ? larger(along(0), along(1)) : from;
  }

 private:
  // The end of the hull edge, 0 or 1.
  Index end(int i) const { return mesh_->mesh.origin[i == 0 ? h_ : next_in_triangle(h_)]; }
  int32_t along(int i) const {
    const LocalPoint p = point_at(mesh_->mesh, end(i));
    return vertical_ ? p.y : p.x;
  }
  bool is_on_line() const {
    const LocalPoint a = point_at(mesh_->mesh, end(0)), b = point_at(mesh_->mesh, end(1));
    return vertical_ ? a.x == line_ && b.x == line_ : a.y == line_ && b.y == line_;
  }

  // To the hull edge that follows as places rise. The outside lies to the left of hull edges: along
  // the first vertical side they run up, and so around the tile.
  void advance() {
    const Mesh& mesh = mesh_->mesh;
    h_ = rises_ ? next_in_triangle(mesh.twin[next_in_triangle(h_)])
                : previous_in_triangle(mesh.twin[previous_in_triangle(h_)]);
  }

  const microtin_mesh* mesh_;  // null: no more edges
  bool vertical_;
  int32_t line_;
  bool rises_;  // edges run as places rise
  Index h_;
};

// The mesh of a tile that is there; null if it is not, and then *absent becomes worse.
const microtin_mesh* mesh_of(const microtin_pack& p, uint32_t tile, microtin_answer* absent) {
  const uint32_t slot = slot_of(p, tile);
  if (slot != p.slot_count) return p.slots[slot].mesh;
  *absent = worse(*absent, answer_without(p, tile));
  return nullptr;
}

// Whether a course lies on a side of the box, more than a point of which it touches.
bool runs_along_side(const TileBox& box, const microtin_course& c) {
  const auto is = [](int64_t place, uint32_t step) {
    return place == static_cast<int64_t>(step) * 256;
  };
  return (c.x == c.x_end && (is(c.x, box.x) || is(c.x, box.x_end))) ||
         (c.y == c.y_end && (is(c.y, box.y) || is(c.y, box.y_end)));
}

// HEIGHT if every place of a course along a side of a tile is known to it or to the tile beyond, or
// if the side is another tile's business: the first one's of two at a border.
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
  const int32_t line = is_last ? static_cast<int32_t>(last - first) * 256 : 0;
  BorderEdges mine(mesh_of(p, tile, &worst), vertical, line);
  const bool has_beyond = is_last && last != most;
  const uint32_t beyond = tile + (vertical ? 1u : tile_columns(grid));
  BorderEdges theirs(has_beyond ? mesh_of(p, beyond, &worst) : nullptr, vertical, 0);
  const LocalPoint a = local(box, course.x, course.y), b = local(box, course.x_end, course.y_end);
  const int32_t length =
      static_cast<int32_t>(vertical ? box.y_end - box.y : box.x_end - box.x) * 256;
  const int32_t end = smaller(larger(vertical ? a.y : a.x, vertical ? b.y : b.x), length);
  int32_t known = larger(smaller(vertical ? a.y : a.x, vertical ? b.y : b.x), 0);
  while (known < end) {  // once for each edge at most
    const int32_t reached = larger(mine.reach(known), theirs.reach(known));
    if (reached == known) return worst;
    known = reached;
  }
  return MICROTIN_HEIGHT;
}

// What a tile says of a course that touches it.
microtin_answer answer_of_tile(const microtin_pack& p, const TouchedTiles& tiles,
                               const microtin_course& course, int32_t* highest) {
  microtin_answer absent = MICROTIN_HEIGHT;
  const microtin_mesh* const mesh = mesh_of(p, tiles.number(), &absent);
  if (absent == MICROTIN_NOT_DECODED) return absent;
  const TileBox box = tiles.box();
  const TileCourse part(box, course);
  const bool is_known = mesh != nullptr && part.look(*mesh, highest);
  if (!part.has_length() || is_known) return MICROTIN_HEIGHT;
  if (runs_along_side(box, course)) return answer_along_side(p, tiles.number(), course);
  return worse(absent, MICROTIN_IN_VOID);
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
  if (axis->numerator >> 30 != 0 || most > kPackExtentMost) return 0;  // their product: < 2^61
  const int64_t found = half_steps(*axis, most, value, per_unit);
  if (found < 0) return 0;
  *lattice = rounded_steps(found);
  return 1;
}

microtin_answer microtin_pack_height_at(const microtin_pack* pack, int64_t x, int64_t y,
                                        uint32_t* hint, int32_t* height) {
  if (!pack->has_header) return MICROTIN_NOT_DECODED;
  if (!is_inside(*pack, x, y)) return MICROTIN_OUTSIDE;
  microtin_answer answer = MICROTIN_IN_VOID;
  const microtin_course here = place(x, y);
  for (TouchedTiles tiles(pack->header.grid, here); !tiles.at_end(); tiles.next()) {
    const microtin_mesh* const mesh = mesh_of(*pack, tiles.number(), &answer);
    if (mesh == nullptr) continue;
    const LocalPoint p = local(tiles.box(), x, y);
    if (microtin_height_at(mesh, p.x, p.y, 0, hint, height) == MICROTIN_HEIGHT) {
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
  microtin_answer answer =
      worse(microtin_pack_height_at(pack, course->x, course->y, &hint, &begin),
            microtin_pack_height_at(pack, course->x_end, course->y_end, &hint, &end));
  if (answer == MICROTIN_NOT_DECODED) return answer;
  int32_t highest = larger(begin, end);
  for (TouchedTiles tiles(pack->header.grid, *course); !tiles.at_end(); tiles.next()) {
    answer = worse(answer, answer_of_tile(*pack, tiles, *course, &highest));
    if (answer == MICROTIN_NOT_DECODED) return answer;
  }
  *height = highest;
  return answer;
}

microtin_answer microtin_pack_fill(const microtin_pack* pack, const microtin_block* block,
                                   int16_t* heights) {
  const microtin_axis& axis = pack->axis[2];
  const int64_t furthest = static_cast<int64_t>(1) << 45;
  const microtin_course corner = place(block->x, block->y);
  const bool is_usable =
      axis.numerator >> 31 == 0 && axis.offset <= furthest && axis.offset >= -furthest;
  if (!is_legal(corner) || (pack->has_header && !is_usable)) return MICROTIN_OUTSIDE;
  microtin_answer answer = MICROTIN_HEIGHT;
  uint32_t hint = 0;
  for (uint32_t row = 0; row < block->rows; ++row) {
    const int64_t y = block->y + static_cast<int64_t>(block->dy) * row;
    for (uint32_t column = 0; column < block->columns; ++column) {
      const int64_t x = block->x + static_cast<int64_t>(block->dx) * column;
      int32_t z = 0;
      const microtin_answer here = microtin_pack_height_at(pack, x, y, &hint, &z);
      *heights++ = here == MICROTIN_HEIGHT ? in_units(z, axis) : block->missing;
      if (here != MICROTIN_HEIGHT && answer != MICROTIN_NOT_DECODED) answer = here;
    }
  }
  return answer;
}
