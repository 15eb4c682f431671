// Queries on the tiles of a pack that are there. They only read, so they may interrupt anything.
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
