// SPDX-License-Identifier: MIT
/* microtin: reads streams and packs, in real units. C++17, hosted.
 *
 * Vertices, triangles and heights come from the shipped decoder. Functions throw
 * std::runtime_error, which names the file, if it cannot be read, is damaged or breaks a rule of
 * the format, and std::bad_alloc if memory runs out. Only one thread at a time may use a surface.
 * Different surfaces are independent.
 */
#ifndef MICROTIN_SURFACE_HPP
#define MICROTIN_SURFACE_HPP

#include <microtin/microtin.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <microtin/profile.hpp>
#include <string>
#include <vector>

namespace microtin::encoder {

/* Bytes at any offset, for instance a file of another file system. */
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  /* Returns the number of bytes. */
  virtual uint64_t size() const = 0;

  /* Reads up to `size` bytes from an offset on, and returns how many: fewer at the end only. May
   * throw std::runtime_error. */
  virtual size_t read(uint64_t offset, void* to, size_t size) const = 0;
};

/* The unit of coordinates or heights. */
enum class Unit : uint8_t { kUnknown = 0, kMetre = 1, kDegree = 2, kFoot = 3, kUsSurveyFoot = 4 };

/* What the heights are. */
enum class SurfaceKind : uint8_t {
  kUnknown = 0,
  kGround = 1,   /* bare ground */
  kTop = 2,      /* the top surface, with vegetation and buildings */
  kBed = 3,      /* the bed of a sea or of a lake */
  kGeoid = 4,    /* heights of a geoid above an ellipsoid */
  kObstacles = 5 /* an envelope of obstacles: no obstacle is above the surface */
};

/* Returns the option's value, "ground"; "unknown" for kUnknown. */
const char* name_of(SurfaceKind kind);

/* Which side of the source the surface may be on, as far as the bound. */
enum class BoundSide : uint8_t { kNotStated = 0, kBoth = 1, kNeverBelow = 2, kNeverAbove = 3 };

/* Returns "both", "never_below" or "never_above"; "" for kNotStated. */
const char* name_of(BoundSide side);

/* Posts in columns and rows; row 0 is the southernmost. */
struct Grid {
  uint32_t columns = 0, rows = 0;
  microtin_axis x{0, 1, 1}; /* from a column's number to the x of its posts, east */
  microtin_axis y{0, 1, 1}; /* from a row's number to the y of its posts, north */
};

/* Returns the real coordinate of lattice number `k` of an axis. */
inline double coordinate(const microtin_axis& axis, int64_t k) {
  return (static_cast<double>(axis.offset) +
          static_cast<double>(axis.numerator) * static_cast<double>(k)) /
         static_cast<double>(axis.denominator);
}

/* A rectangle in real coordinates. */
struct Box {
  double west = 0, south = 0, east = 0, north = 0;
};

/* A stream after one of its phases, or after the first few. */
struct Phase {
  uint64_t vertices = 0;
  uint64_t bytes = 0;    /* from the first byte of the file on */
  std::string max_error; /* at the heights that the surface covers then; "" if there are none */
};

/* What the header contains, and where the surface is. */
struct SurfaceInfo {
  uint64_t bytes = 0;
  uint64_t vertices = 0;                    /* pack: those on borders count in each tile */
  uint32_t tile_columns = 1, tile_rows = 1; /* stream: 1 */
  bool is_pack = false;
  Box box;                        /* around the vertices, or around a pack's tiles */
  double lowest = 0, highest = 0; /* heights of vertices */
  microtin_axis x, y, z;          /* from lattice numbers to real units */
  Grid source;                    /* the posts of the encoded raster; points: no columns */
  Unit horizontal_unit = Unit::kUnknown, vertical_unit = Unit::kUnknown;
  uint32_t horizontal_epsg = 0, vertical_epsg = 0; /* 0: the file does not contain it */
  std::string wkt;                                 /* horizontal system without a code */
  std::string source_name, date, lineage;          /* "": the file does not contain it, as below */
  std::string bound, max_error, rms_error, mean_error; /* of heights, as measured */
  std::string max_error_at_points; /* at the points' own positions, if the lattice moves points */
  SurfaceKind surface = SurfaceKind::kUnknown;
  BoundSide side = BoundSide::kNotStated;
  std::string max_below, max_above; /* largest distances of the surface below and above heights */
  /* Largest distances from the bilinear surface of a raster's posts, also between posts. */
  std::string max_below_everywhere, max_above_everywhere;
  /* The least and the largest bound of heights that have bounds of their own, and the largest ratio
   * of an error to its bound. "": one bound for all. */
  std::string least_bound, largest_bound, max_bound_ratio;
  std::string attribution;     /* to be shown to users */
  std::string license;         /* an SPDX expression or a URL */
  std::string valid;           /* 2024-01/2025-06, 2024-01/.. or ../2025 */
  std::string epoch;           /* of the coordinates, a year: 2020.5 */
  std::string source_accuracy; /* of the source itself: "LE90 4" */
  std::string digest;          /* of a stream's mesh, 16 hexadecimal digits */
  std::vector<Phase> phases;   /* of a stream */
};

/* The largest distances of a tile below and above the bilinear surface of a raster's posts, also
 * between posts. "": the tile does not state them, or has no terrain. */
struct TileMargins {
  std::string max_below_everywhere, max_above_everywhere;
};

/* Between which heights an area lies, by those of the tiles that it touches; see
 * Surface::bounds_in_box. */
struct HeightBounds {
  /* Heights of vertices; NaN: no tile of the area has terrain. */
  double lowest = std::numeric_limits<double>::quiet_NaN();
  double highest = std::numeric_limits<double>::quiet_NaN();
  /* How high and low the source is at most, if it is a raster; NaN: the header states no margins.
   */
  double source_lowest = std::numeric_limits<double>::quiet_NaN();
  double source_highest = std::numeric_limits<double>::quiet_NaN();
  /* The area lies inside, and each of its tiles has terrain. Only then nothing in the area is
   * outside the bounds. Voids within tiles have no height and do not count. */
  bool is_complete = false;
};

/* Vertices and triangles. Triangles are counter-clockwise from above; void ones are left out. */
struct Mesh {
  std::vector<std::array<double, 3>> vertices; /* x, y, height */
  std::vector<std::array<uint32_t, 3>> triangles;
};

/* A line among the edges of a stream, such as a ridge or a river. */
struct Line {
  std::string line_class; /* a name: "ridge", "water", ... of encoder/docs/accuracy.md */
  std::vector<std::array<double, 3>> vertices; /* x, y, height; a closed line repeats the first */
};

/* A stream or a pack. Only one thread at a time may use a surface. */
class Surface {
 public:
  /* Opens a file. Decodes a stream at once; of a pack reads header and index. */
  static Surface from_file(const std::string& path);
  /* Opens a stream or a pack from bytes. Errors contain `name`. */
  static Surface from_bytes(std::unique_ptr<const ByteSource> bytes, const std::string& name);
  /* Takes over another surface. */
  Surface(Surface&& other) noexcept;
  /* Takes over another surface. */
  Surface& operator=(Surface&& other) noexcept;
  ~Surface();

  /* Returns what the header contains, and where the surface is. */
  const SurfaceInfo& info() const;

  /* Returns the whole surface. Vertices on borders of tiles appear once. O(n). */
  Mesh mesh() const;

  /* Returns the lines that the marks of a stream's edges make, as `microtin decode -o
   * lines.geojson` writes them. A pack has none. O(n). */
  std::vector<Line> lines() const;

  /* Returns a tile of a pack, counted from the south-west corner; a stream is one tile. A tile
   * without terrain has no vertices. Throws std::out_of_range. */
  Mesh tile(uint32_t column, uint32_t row) const;
  /* Returns the rectangle of a tile. Throws std::out_of_range. */
  Box tile_box(uint32_t column, uint32_t row) const;
  /* Returns how far a tile is from the bilinear surface of a raster's posts. Throws
   * std::out_of_range. */
  TileMargins tile_margins(uint32_t column, uint32_t row) const;

  /* Returns a grid of posts `cell` units apart, from the south-west corner of the box on. `cell` is
   * a decimal, "0.25"; "" selects the posts of the encoded raster. */
  Grid grid(const std::string& cell) const;

  /* Writes the heights at `count` positions, in any order; NaN where there is none. A height is
   * that of the exact plane at the position. Its error is at most three units in the last place of
   * the height or, if that is larger, of the difference in height across the triangle. A coordinate
   * within a factor of 1 +- 2^-50 of a lattice coordinate counts as that coordinate. Tiles are
   * decoded as needed; the surface keeps two rows of them. About 0.3 us a height, and the decoding.
   *
   *   double x = 381000, y = 5623000, height;
   *   Surface::from_file("area.mtp").heights(1, &x, &y, &height);
   */
  void heights(size_t count, const double* x, const double* y, double* heights) const;

  /* Writes the gradients at `count` positions: how many metres the surface rises for each metre
   * east, and for each metre north; NaN where there is none. The slope is the arctangent of
   * hypot(east, north). The aspect, in which direction the surface falls, is atan2(-east, -north),
   * clockwise from north. A gradient is that of the exact triangle at the position. On an edge or a
   * vertex it is that of the triangle whose centre lies farthest east, and of those with the same x
   * farthest north, as on devices. A degree has its length at the position; a unit that is not
   * known counts as the metre. A vertex among voids has a height, but no gradient. Costs some two
   * heights. */
  void gradients(size_t count, const double* x, const double* y, double* east, double* north) const;

  /* A position in the surface's coordinates. */
  struct Position {
    double x = 0, y = 0;
  };

  /* Returns between which heights a box lies. A pack's index has the lowest and the highest height
   * of each tile, so no tile is decoded; a stream is one tile. What is above `highest` of complete
   * bounds is surely above the surface there, and what is above `source_highest` above the source.
   * Throws if a coordinate is not a number. O(tiles that the box touches). */
  HeightBounds bounds_in_box(const Box& box) const;
  /* Returns between which heights the straight line between two positions lies, as bounds_in_box
   * does. In degrees the line is that of the given numbers. */
  HeightBounds bounds_on_line(const Position& from, const Position& to) const;

  /* Returns the heights along the straight line between two positions, which may lie outside. In
   * degrees the line takes the shorter way around the Earth, and is straight in degrees. It bends
   * at borders of tiles and of the lattice, by at most 1/512 of a lattice step. Tiles that cannot
   * be read are parts of the line without heights. Throws if a position is not a number, or 2^32
   * lattice steps away. Takes O(triangles on the line + sqrt(triangles)), and the decoding. */
  Profile profile(const Position& from, const Position& to) const;

  /* A rectangle of posts of a grid, inside or outside it. */
  struct Rectangle {
    int64_t column = 0, row = 0; /* the south-west post */
    uint32_t columns = 0, rows = 0;
  };
  /* Writes the heights at the posts of the rectangle, the northernmost row first; NaN where there
   * is none. The position of a post is an exact fraction. */
  void heights(const Grid& grid, const Rectangle& rectangle, double* heights) const;

 private:
  struct Content;
  explicit Surface(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}  // namespace microtin::encoder

#endif
