// SPDX-License-Identifier: MIT
/* microtin: streams and packs read back, in real units. C++17, hosted.
 *
 * Vertices, triangles and heights come from the shipped decoder. What cannot be read, is damaged or
 * breaks a rule of the format is thrown as std::runtime_error with a sentence that names the file,
 * out of memory as std::bad_alloc. One thread at a time may use a surface; different surfaces do
 * not know of each other.
 */
#ifndef MICROTIN_SURFACE_HPP
#define MICROTIN_SURFACE_HPP

#include <microtin/microtin.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace microtin::encoder {

/* Bytes that are read anywhere: a file of whatever file system. */
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  /* The number of bytes. */
  virtual uint64_t size() const = 0;

  /* Up to `size` bytes from an offset on: fewer only at the end. May throw std::runtime_error. */
  virtual size_t read(uint64_t offset, void* to, size_t size) const = 0;
};

/* The unit of coordinates or heights. */
enum class Unit : uint8_t { kUnknown = 0, kMetre = 1, kDegree = 2, kFoot = 3, kUsSurveyFoot = 4 };

/* Posts in columns and rows; row 0 is the southernmost. */
struct Grid {
  uint32_t columns = 0, rows = 0;
  microtin_axis x{0, 1, 1}; /* from a column to where its posts lie, east */
  microtin_axis y{0, 1, 1}; /* ... and from a row, north */
};

/* The real coordinate of number `k` of an axis. */
inline double coordinate(const microtin_axis& axis, int64_t k) {
  return (static_cast<double>(axis.offset) +
          static_cast<double>(axis.numerator) * static_cast<double>(k)) /
         static_cast<double>(axis.denominator);
}

/* A rectangle in real coordinates. */
struct Box {
  double west = 0, south = 0, east = 0, north = 0;
};

/* What a header says, and where the surface is. */
struct SurfaceInfo {
  uint64_t bytes = 0;
  uint64_t vertices = 0;                    /* of a pack: those on borders once for each tile */
  uint32_t tile_columns = 1, tile_rows = 1; /* 1 of a stream */
  bool is_pack = false;
  Box box;                        /* around the vertices, or around a pack's tiles */
  double lowest = 0, highest = 0; /* vertex */
  microtin_axis x, y, z;          /* the lattice */
  Grid source;                    /* posts of the raster it was made of; else no columns */
  Unit horizontal_unit = Unit::kUnknown, vertical_unit = Unit::kUnknown;
  uint32_t horizontal_epsg = 0, vertical_epsg = 0;     /* 0: not stated */
  std::string wkt;                                     /* horizontal system without a code */
  std::string origin, date, lineage;                   /* "": not stated, as all below */
  std::string bound, max_error, rms_error, mean_error; /* of heights, as measured */
  std::string max_error_at_points; /* where points truly lie, if the lattice moves them */
};

/* Triangles are counter-clockwise from above; void ones are left out. */
struct Mesh {
  std::vector<std::array<double, 3>> vertices; /* x, y, height */
  std::vector<std::array<uint32_t, 3>> triangles;
};

/* A stream or a pack that is read. One thread at a time may use a surface. */
class Surface {
 public:
  /* A stream is decoded at once, of a pack header and index are read. `name` is for messages. */
  static Surface from_file(const std::string& path);
  /* Reads a stream or a pack from bytes. `name` is for messages. */
  static Surface from_bytes(std::unique_ptr<const ByteSource> bytes, const std::string& name);
  /* Takes over another surface. */
  Surface(Surface&& other) noexcept;
  /* Takes over another surface. */
  Surface& operator=(Surface&& other) noexcept;
  ~Surface();

  /* Returns what the header contains, and where the surface is. */
  const SurfaceInfo& info() const;

  /* All of it; vertices on borders of tiles once. O(n). */
  Mesh mesh() const;

  /* A tile of a pack, from the south-west corner on row by row; a stream is one tile. Nothing in
   * the mesh if it has no terrain. Throws std::out_of_range. */
  Mesh tile(uint32_t column, uint32_t row) const;
  /* The rectangle of a tile. Throws std::out_of_range. */
  Box tile_box(uint32_t column, uint32_t row) const;

  /* Posts `cell` units apart, from the south-west corner of the box on; "0.25" is exact. */
  Grid grid(const std::string& cell) const;

  /* Heights at places, in any order; NaN where there is none. A height is that of the exact plane
   * at the place, off by at most three units in the last place of it or, if that is larger, of the
   * difference in height across its triangle. A place within 2^-50 of its value of a coordinate of
   * the lattice is taken there. Tiles are decoded when they are needed, and two rows of them are
   * kept. About 0.3 us a height, and the decoding. */
  void heights(size_t count, const double* x, const double* y, double* heights) const;

  /* Heights at the posts of a rectangle of the grid, within it or not; the first row written is the
   * northernmost. A post's place is an exact fraction. */
  struct Rectangle {
    int64_t column = 0, row = 0; /* the south-west post */
    uint32_t columns = 0, rows = 0;
  };
  /* Writes the heights at the posts of the rectangle, NaN where there is none. */
  void heights(const Grid& grid, const Rectangle& rectangle, double* heights) const;

 private:
  struct Content;
  explicit Surface(std::unique_ptr<Content> content);
  std::unique_ptr<Content> content_;
};

}  // namespace microtin::encoder

#endif
