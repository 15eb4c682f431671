// SPDX-License-Identifier: MIT
/* microtin: turns terrains into streams and packs that microtin.h and pack.h decode. C++17, hosted.
 *
 * What is returned or written has been decoded by the shipped decoder and compared with every post
 * or point of the terrain: it keeps the bound, answers a height wherever the terrain has one and
 * none where it has not. The same terrain and options give the same bytes on every machine.
 *
 * Numbers that must stay exact are decimals as text, "0.25"; an empty text is none. What cannot be
 * done is thrown as std::runtime_error with a sentence that says why, out of memory as
 * std::bad_alloc, a fault of the encoder's own as std::logic_error. Functions use all processors
 * and may run at the same time for different terrains, or for one.
 */
#ifndef MICROTIN_ENCODER_HPP
#define MICROTIN_ENCODER_HPP

#include <microtin/microtin.h>

#include <array>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace microtin::encoder {

/* --- Terrains --- */

/* A height of RasterData where there is none. */
constexpr int64_t kNoData = std::numeric_limits<int64_t>::min();

/* A raster. Its numbers have magnitudes up to 10^18. */
struct RasterData {
  uint32_t columns = 0, rows = 0; /* 2 .. 65536 each for a stream */
  std::vector<int64_t> heights;   /* times 10^-decimals; row by row, row 0 southernmost */
  int decimals = 0;               /* 0 .. 18 */
  microtin_axis x{0, 1, 1};       /* from a column to where its posts lie, east */
  microtin_axis y{0, 1, 1};       /* from a row to where its posts lie, north */
  std::string wkt;                /* well-known text of the systems of places and heights, or "" */
  std::string z_unit = {};        /* as GDAL's bands name it, "cm"; "": as wkt says */
};

/* Points in any order, none of which needs to be unlike all others. */
struct PointCloudData {
  std::vector<std::array<int64_t, 3>> points; /* x, y times 10^-xy_decimals, z 10^-z_decimals */
  int xy_decimals = 0, z_decimals = 0;        /* 0 .. 18 */
  std::string wkt, z_unit = {};               /* as of RasterData */
};

/* Binary numbers, each of which stands for the shortest decimal that becomes it, of heights with at
 * most 9 decimals. Throws, naming row and column or the point, if one is out of range.
 *
 * A raster as GDAL and numpy hold it: heights row by row at the centres of cells, NaN where there
 * is none, or that value for it, compared in the heights' own type; the transform is GDAL's, from
 * the outer corner of the first cell: x, width of a cell, 0, y, 0, its height, below 0 if row 0 is
 * the northernmost. Cells are not rotated. */
using Transform = std::array<double, 6>;

/* Whether columns run east and rows north or south; skews of up to 10^-9 of a cell are what
 * rounding leaves, and count as none. raster_from_cells throws for all others. */
bool runs_east(const Transform& transform);

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();
/* Makes a raster from the heights of cells. Throws std::runtime_error if cells are rotated. */
RasterData raster_from_cells(uint32_t columns, uint32_t rows, const float* heights,
                             const Transform& transform, double no_data = kNoValue);
/* Makes a raster from the heights of cells. Throws std::runtime_error if cells are rotated. */
RasterData raster_from_cells(uint32_t columns, uint32_t rows, const double* heights,
                             const Transform& transform, double no_data = kNoValue);

/* Returns whether files with `bytes` bytes can hold a raster of `columns` x `rows`: up to 2^24
 * posts, or 1024 for each byte. A raster that claims more has a forged header, or is nearly all
 * void. O(1). */
bool can_hold(uint64_t bytes, uint32_t columns, uint32_t rows);

/* x, y, z of each point in turn. */
PointCloudData point_cloud_from_xyz(uint64_t count, const double* coordinates);

/* A terrain to be encoded. Copies share what they hold. */
class SourceTerrain {
 public:
  /* Takes 8 bytes a post or 24 a point. Throws if numbers of posts or decimals are out of range. */
  explicit SourceTerrain(RasterData posts);
  /* Takes 24 bytes a point. */
  explicit SourceTerrain(const PointCloudData& points);

  /* Reads a file by its suffix: .hgt, .zip (one .hgt), .asc, .xyz, .csv, .txt, .las, .ply, .obj.
   * Errors name the file and, for text, the line. */
  static SourceTerrain from_file(const std::string& path);

  struct Content;
  /* For the library alone. */
  const Content& content() const { return *content_; }

 private:
  explicit SourceTerrain(std::shared_ptr<const Content> content);
  std::shared_ptr<const Content> content_;
};

/* --- What is wanted --- */

/* How long the encoder searches for smaller files. */
enum class SearchEffort { kFast, kNormal, kBest }; /* some 5 % more bytes; the default; slow */

/* What decoding may cost: less time for more bytes, or the other way round. */
enum class Coding { kQuick, kBalanced, kDense };

/* Where a bound holds for points that a stream's lattice moves: where they truly lie, too, or on
 * the lattice alone. */
enum class BoundAt { kPoints, kLattice };

/* Which of the points that meet at a place of the lattice stands for all. kMiddle: all count, and
 * the surface aims at the middle of the lowest and the highest. */
enum class Duplicates { kMiddle, kLowest, kHighest, kMean };

/* What the encoder may choose. Texts are UTF-8; an empty text is none. */
struct Options {
  std::string max_error;    /* the largest distance of the surface from any height; "": see below */
  bool never_below = false; /* with a bound: no height is below the terrain */
  std::string z_step;       /* of heights; "": the one that suits the bound, or the terrain's own */
  std::string xy_step; /* of places; "": the terrain's own. RasterData: in posts, not in packs */
  BoundAt bound_at = BoundAt::kPoints;
  Duplicates duplicates = Duplicates::kMiddle;
  SearchEffort effort = SearchEffort::kNormal;
  /* Most triangles around a vertex when it is added: 6 .. 32. 0: 10, quick 9, or, of terrains of
   * less than 2,000 vertices, 16 if that saves a 256th. */
  uint32_t max_degree = 0;
  Coding coding = Coding::kBalanced;
  /* Units of x and y and of heights: "metre", "degree:metre", ":foot"; "": as the codes or the
   * terrain's file say. Numbers in other units of length than metre, foot and us-foot, such as "cm"
   * or "fathom", are converted to metres, exactly, or refused. Heights of unknown unit have that of
   * x and y; beside degrees they are refused. */
  std::string units;
  /* Heights grow downwards: they are negated. Without, systems of depths are refused. */
  bool depths = false;
  /* Notes of the header; 0 or empty: not stated. Codes that are known set the units. All texts
   * together up to 65,535 bytes of UTF-8. */
  uint32_t horizontal_epsg = 0, vertical_epsg = 0;
  std::string source_name, date, lineage; /* date: 2026, 2026-11 or 2026-11-21 */
};

/* Without a bound and without a limit here every post or point is a vertex. */
struct StreamOptions : Options {
  uint32_t max_vertices = 0; /* 3 .. 2^24: the smallest bound for them; no max_error */
  uint32_t max_bytes =
      0; /* the smallest bound of a stream of this size; without max_error, max_vertices */
};

/* Vertices of a tile at most, if a pack's options set neither a number of vertices nor a device's
 * memory. */
constexpr uint32_t kUsualTileVertices = 2000;

/* Options of a pack. */
struct PackOptions : Options {
  uint32_t tile_vertices = 0; /* of a tile at most: 16 .. 2^24; 0: kUsualTileVertices */
  uint32_t tile_size = 0;     /* extent of a tile of posts; 0: to be chosen */
};

/* --- Results --- */

/* What the encoder measured. Errors are in units of height. */
struct Report {
  uint64_t samples = 0; /* posts or points with a height, all of them compared */
  uint64_t vertices = 0;
  uint64_t bytes = 0;
  uint32_t tiles = 0;    /* 0: a stream */
  std::string bound;     /* asked for, or found for a limit; "": none */
  std::string max_error; /* measured, in the terrain's unit, rounded up to 9 decimals */
  std::string rms_error;
  std::string mean_error; /* above 0: the surface is too high */
  std::string max_below;  /* how far the surface is below a height at most */
  /* Where points truly lie, if the lattice moves them; else "". */
  std::string max_error_at_points, max_below_at_points;
  std::vector<std::string> warnings; /* what is guessed of units and systems; doubtful heights */
};

/* A stream and what the encoder measured. */
struct Stream {
  std::vector<uint8_t> bytes;
  Report report;
};

/* --- Work --- */

/* Thrown when Callbacks::cancelled said so. Nothing is left behind. */
struct Cancelled : std::exception {
  /* Returns "cancelled". */
  const char* what() const noexcept override { return "cancelled"; }
};

/* Both may be empty. Called from several threads, one at a time; both may throw. */
struct Callbacks {
  std::function<void(double done)> progress; /* 0 .. 1 of the time, estimated */
  std::function<bool()> cancelled;           /* asked often, but for packs of points */
};

/* O(n log n) for n samples, with factors of a search that `effort` sets: some 20 us a post. */
Stream encode_stream(const SourceTerrain& terrain, const StreamOptions& options,
                     const Callbacks& callbacks = {});

/* Writes a file that appears complete or not at all. The memory that it needs beside the terrain is
 * that of a few tiles for posts, a few hundred bytes a point for points. */
Report encode_pack(const SourceTerrain& terrain, const PackOptions& options,
                   const std::string& path, const Callbacks& callbacks = {});

}  // namespace microtin::encoder

#endif
