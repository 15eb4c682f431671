// SPDX-License-Identifier: MIT
/* microtin: encodes terrain as streams and packs, which microtin.h and pack.h decode. C++17,
 * hosted.
 *
 * Before a function returns a stream or writes a pack, the shipped decoder decodes it, and every
 * post or point of the terrain is compared with it: the surface keeps the bound, covers all heights
 * and leaves all voids open. The same terrain and options give the same bytes on every machine.
 *
 * Numbers that must stay exact are decimals as text, "0.25". An empty text means "not given".
 *
 * Functions throw std::runtime_error if the input or an option is refused; its text names the cause
 * and a remedy. They throw std::bad_alloc if memory runs out, and std::logic_error for a fault of
 * the encoder itself. Functions use all processors. They may run at the same time for different
 * terrains or for the same one.
 */
#ifndef MICROTIN_ENCODER_HPP
#define MICROTIN_ENCODER_HPP

#include <microtin/microtin.h>

#include <array>
#include <cstdint>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <microtin/surface.hpp>
#include <string>
#include <vector>

namespace microtin::encoder {

/* Returns the message of an exception that this library threw, with the names of options as `spell`
 * returns them: for programs that call max_error MAX_ERROR, say. what() has the names of Options.
 */
std::string message_of(const std::exception& error,
                       const std::function<std::string(const std::string& option)>& spell);

/* --- Terrain --- */

/* Marks a post without a height in RasterData::heights. */
constexpr int64_t kNoData = std::numeric_limits<int64_t>::min();

/* A raster of heights. Numbers have magnitudes up to 10^18. */
struct RasterData {
  uint32_t columns = 0, rows = 0; /* 2 .. 65536 each for a stream */
  std::vector<int64_t> heights;   /* times 10^-decimals; row by row, row 0 southernmost */
  int decimals = 0;               /* 0 .. 18 */
  microtin_axis x{0, 1, 1};       /* from a column's number to the x of its posts, east */
  microtin_axis y{0, 1, 1};       /* from a row's number to the y of its posts, north */
  std::string wkt;         /* well-known text of the horizontal and vertical systems, or "" */
  std::string z_unit = {}; /* unit of heights in GDAL's spelling, "cm"; "": the unit in wkt */
  /* Metadata of the raster's file, by GDAL's names. The encoder takes its notes from them unless
   * options state others: TIFFTAG_COPYRIGHT, TIFFTAG_IMAGEDESCRIPTION, TIFFTAG_DATETIME, the items
   * of GDAL's driver for microtin, and COORDINATE_EPOCH. */
  std::map<std::string, std::string> items = {};
};

/* Points in any order. Points may coincide. */
struct PointCloudData {
  std::vector<std::array<int64_t, 3>> points; /* x, y times 10^-xy_decimals, z 10^-z_decimals */
  int xy_decimals = 0, z_decimals = 0;        /* 0 .. 18 */
  std::string wkt, z_unit = {};               /* as in RasterData */
};

/* GDAL's geotransform: x of the outer corner of the first cell, width of a cell, 0, y of that
 * corner, 0, height of a cell, which is below 0 if row 0 is the northernmost. */
using Transform = std::array<double, 6>;

/* Returns whether the columns of a raster run east and its rows north or south. Skews up to 10^-9
 * of a cell are rounding, and count as none. */
bool runs_east(const Transform& transform);

/* No value marks cells without a height; NaN always does. */
constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

/* Makes a raster from the heights of cells, in the layout of GDAL and numpy: row by row, each
 * height at the centre of its cell. Cells with NaN or `no_data`, compared in the type of the
 * heights, have no height. Each binary number stands for the shortest decimal that rounds to it, of
 * at most 9 decimals. Throws std::runtime_error, which names row and column, if a height is out of
 * range, or if the cells are rotated. */
RasterData raster_from_cells(uint32_t columns, uint32_t rows, const float* heights,
                             const Transform& transform, double no_data = kNoValue);
/* Makes a raster from heights with 64 bits, as above. */
RasterData raster_from_cells(uint32_t columns, uint32_t rows, const double* heights,
                             const Transform& transform, double no_data = kNoValue);

/* Returns whether a file of `bytes` bytes can hold a raster of `columns` x `rows`: at most 2^24
 * posts, or 1024 posts for each byte. A raster that claims more has a forged header, or is nearly
 * all void. O(1). */
bool can_hold(uint64_t bytes, uint32_t columns, uint32_t rows);

/* Makes a point cloud from x, y, z of each point in turn. Each binary number stands for the
 * shortest decimal that rounds to it, of at most 9 decimals. Throws std::runtime_error, which names
 * the point, if a number is out of range. */
PointCloudData point_cloud_from_xyz(uint64_t count, const double* coordinates);

/* A terrain to encode. Copies share the content. */
class SourceTerrain {
 public:
  /* Takes over a raster: 8 bytes a post. Throws std::runtime_error if a number is out of range. */
  explicit SourceTerrain(RasterData raster);
  /* Copies points: 24 bytes a point. Throws std::runtime_error if a number is out of range. */
  explicit SourceTerrain(const PointCloudData& points);

  /* Reads a file. Its suffix selects the reader: .hgt, .zip (one .hgt), .asc, .xyz, .csv, .txt,
   * .las, .laz, .ply, .obj. Errors name the file and, for text, the line. */
  static SourceTerrain from_file(const std::string& path);

  /* Makes one terrain of several files, and of folders: for a folder the files in it, by name, of
   * the suffix that most of its terrain files have. If rasters overlap, the file named first counts
   * at each position; points of all files count. The posts of all rasters lie on a common lattice.
   * The files are read while the terrain is encoded, and again each time: for packs, .hgt and .asc
   * tile by tile. So errors of their content come from that call. Throws std::runtime_error if
   * there is no path, or if a folder holds no terrain file. */
  static SourceTerrain from_files(const std::vector<std::string>& paths);

  /* Gives each post or point a bound of its own, from a raster of bounds in the unit of heights: of
   * the terrain's grid, or of a coarser one in the same system. A post takes the least bound of the
   * cells that it touches. 0 is exact. A void cell leaves posts without a bound. Posts that touch
   * no cell take max_error. Copies of this terrain made before keep theirs. Throws
   * std::runtime_error if a number is out of range. */
  void set_error_map(RasterData bounds);

  /* Takes this GeoJSON text in place of the file `path`, if an option names that: error_map, area,
   * route, breaklines or obstacles. The file is not read. Errors name it, with the line of the
   * text. Copies of this terrain made before read the file. */
  void set_features(const std::string& path, std::string geojson);

  struct Content;
  /* For the library itself. */
  const Content& content() const { return *content_; }

 private:
  explicit SourceTerrain(std::shared_ptr<const Content> content);
  std::shared_ptr<const Content> content_;
};

/* --- Options --- */

/* How long the encoder searches for a smaller file. */
enum class SearchEffort {
  kFast,   /* about 18 % more bytes */
  kNormal, /* the default */
  kBest    /* slow */
};

/* Trades time of decoding for bytes. */
enum class Coding { kQuick, kBalanced, kDense };

/* Where a bound holds. */
enum class BoundAt {
  kPoints,    /* at the posts, or at the points' own positions and on the lattice */
  kLattice,   /* of points: at the positions on the lattice only */
  kEverywhere /* of a raster: between posts, too, compared with their bilinear surface */
};

/* Which height counts where several points share a position of the lattice. */
enum class Duplicates {
  kMiddle, /* all count: the surface aims at the middle of the lowest and the highest */
  kLowest,
  kHighest,
  kMean
};

/* The most vertices of a tile if neither an option nor a device's memory limits them. */
constexpr uint32_t kUsualTileVertices = 2000;

/* Options of streams and packs. An option that the file does not take must keep its default. Texts
 * are UTF-8. Without a bound and without a limit every post or point becomes a vertex. */
struct Options {
  std::string max_error; /* the bound: largest distance of the surface from any height */
  /* A file with a bound for each post or point: a raster of bounds, as for set_error_map, which it
   * replaces, or polygons with a property max_error: GeoJSON (.geojson, .json), and in builds with
   * GDAL .gpkg, .shp, .fgb, .kml, .gpx, .dxf, .dgn and .gdb. Elsewhere max_error holds. With
   * max_vertices or max_bytes all bounds are scaled alike, as much as it takes. */
  std::string error_map;
  /* Files in GeoJSON, or what GDAL reads in builds with it, in the system of the terrain. A file
   * that states another one is refused; GeoJSON states none. `area`: polygons; `route`: lines, with
   * route_width metres, half on each side. What lies outside of both has no heights. With
   * route_edge_error the bound grows from max_error at a route to that at the edges. */
  std::string area, route, route_width, route_edge_error;
  /* A file of lines along which the surface has edges: such a file, or text. Needs a bound; not for
   * packs of points. */
  std::string breaklines;
  /* Raster: such a file of what stands on the terrain: points, lines and polygons with `top`, or
   * `height` above the ground, and `radius`. The surface is below none of it, and nowhere below the
   * terrain. Needs max_error; never_below and bound_at need not be set. */
  std::string obstacles;
  uint32_t max_vertices = 0; /* stream: the smallest bound with 3 .. 2^24 vertices at most */
  uint32_t max_bytes = 0;    /* stream: the smallest bound whose file has at most this size */
  bool never_below = false;  /* with a bound: no post or point is above the surface */
  std::string z_step;        /* z step; "": the best one for the bound, or the terrain's own */
  std::string xy_step;       /* lattice step; "": the terrain's own. Stream of a raster: in posts */
  BoundAt bound_at = BoundAt::kPoints;
  Duplicates duplicates = Duplicates::kMiddle;
  SearchEffort effort = SearchEffort::kNormal;
  Coding coding = Coding::kBalanced;
  /* The most triangles around a vertex when it is added: 6 .. 32. 0 selects 10, for kQuick 9, and
   * for terrain of fewer than 2,000 vertices 16 if that saves at least 0.4 % of the bytes. */
  uint32_t max_degree = 0;
  uint32_t tile_vertices = 0; /* pack: the most of a tile, 16 .. 2^24; 0: kUsualTileVertices */
  uint32_t tile_size = 0;     /* pack of a raster: extent of a tile in posts; 0: chosen */
  /* Units of x, y and of heights: "metre", "degree:metre", ":foot"; "": from the codes or from the
   * terrain. Other units of length, such as "cm" or "fathom", are converted to metres exactly.
   * Heights of unknown unit get the unit of x and y, but are refused if that is the degree. */
  std::string units;
  /* Heights grow downwards, and are negated. Without this, systems of depths are refused. */
  bool depths = false;
  SurfaceKind surface = SurfaceKind::kUnknown; /* a note of the header */
  /* Notes of the header; 0 or "": none. Known codes set the units. All texts together have at most
   * 65,535 bytes. */
  uint32_t horizontal_epsg = 0, vertical_epsg = 0;
  std::string source_name, date,
      lineage;             /* date: 2026, 2026-11, 2026-11-21, or two: 2019-05/2021 */
  std::string attribution; /* a text to be shown to users */
  std::string license;     /* an SPDX expression or a URL */
  std::string valid;       /* two dates: 2024-01/2025-06; open on one side: 2024-01/.., ../2025 */
  std::string epoch;       /* of the coordinates, a year: 2020.5 */
  std::string source_accuracy; /* of the source itself: "LE90 4", "LE95 5" or "RMSE 2.5" */
  /* Stream: note a digest of the mesh, by which a device checks its memory: 11 bytes. */
  bool digest = false;
  /* Stream: note the vertices, bytes and largest error after each phase. */
  bool phases = false;
};

/* Sets an option by the name of its member, for callers whose options are texts: "max_error" to
 * "2.5", "never_below" to "true" or "false", "effort" to "fast". Throws std::runtime_error if there
 * is no such option, or if the text is none of its values. An empty text means "not given",
 * and is refused for the name of a file. */
void set_option(Options& options, const std::string& name, const std::string& value);

/* --- Results --- */

/* What the encoder measured. Errors are in units of height. */
struct Report {
  uint64_t samples = 0; /* posts or points with a height; all were compared */
  uint64_t vertices = 0;
  uint64_t bytes = 0;
  uint32_t tiles = 0;    /* 0: a stream */
  std::string bound;     /* the bound that all keep, given or found for a limit; "": none */
  std::string max_error; /* the largest error, rounded up to 9 decimals */
  std::string rms_error;
  std::string mean_error; /* above 0: the surface is too high in the mean */
  std::string max_below;  /* the largest distance of the surface below a height */
  std::string max_above;  /* the largest distance of the surface above a height */
  /* The largest distances of the surface below and above the bilinear surface of a raster's posts,
   * at posts and between them, as the header states them. "" for points. */
  std::string max_below_everywhere, max_above_everywhere;
  /* As max_error and max_below, at the points' own positions. "" if the lattice moves none. */
  std::string max_error_at_points, max_below_at_points;
  /* If posts or points have bounds of their own: the least and the largest, and the largest part
   * of its bound that an error is. "": one bound for all. */
  std::string least_bound, largest_bound, max_bound_ratio;
  std::vector<std::string> warnings; /* units and systems that were guessed; doubtful heights */
};

/* A stream and what the encoder measured. */
struct Stream {
  std::vector<uint8_t> bytes;
  Report report;
};

/* --- Encoding --- */

/* Thrown if Callbacks::cancelled returns true. No file is left behind. */
struct Cancelled : std::exception {
  /* Returns "cancelled". */
  const char* what() const noexcept override { return "cancelled"; }
};

/* Functions that the encoder calls from several threads, one call at a time. Both may be empty, and
 * may throw. */
struct Callbacks {
  std::function<void(double done)> progress; /* the estimated part of the time, 0 .. 1 */
  std::function<bool()> cancelled; /* called with each progress; packs of points never call it */
};

/* Encodes a terrain as a stream. O(n log n) for n samples, about 20 us a post; `effort` changes the
 * factor.
 *
 *   RasterData raster = raster_from_cells(columns, rows, heights, transform);
 *   Options options;
 *   options.max_error = "2.5";
 *   Stream stream = encode_stream(SourceTerrain(std::move(raster)), options);
 */
Stream encode_stream(const SourceTerrain& terrain, const Options& options,
                     const Callbacks& callbacks = {});

/* Encodes a terrain as a pack of tiles, and writes it to a file, which appears complete or not at
 * all. Besides the terrain, a raster needs the memory of a few tiles, and points need a few hundred
 * bytes each. */
Report encode_pack(const SourceTerrain& terrain, const Options& options, const std::string& path,
                   const Callbacks& callbacks = {});

/* --- Shards: the tiles of one pack from several processes or machines --- */

/* A part of the tiles of a pack. */
struct Shard {
  uint32_t tile_size = 0; /* of the pack, in lattice steps between posts */
  std::string z_step;     /* of the pack */
  uint32_t first_tile = 0, last_tile = 0;
};

/* Divides the pack of a raster into at most `count` shards of equal work. All of them have the
 * tile size and the step of heights that encode_pack chooses. Takes the time of encoding a few
 * tiles, or none with both in `options`. Throws std::runtime_error if the terrain is points. */
std::vector<Shard> plan_shards(const SourceTerrain& terrain, const Options& options, uint32_t count,
                               const Callbacks& callbacks = {});

/* Encodes the tiles of a shard, and writes them to a file, which appears complete or not at all.
 * The terrain and the options are those of plan_shards; the shard replaces tile_size and z_step.
 * Needs the memory of a few tiles, for any number of tiles, besides what the terrain keeps. The
 * report has `vertices`, `tiles` and `warnings` alone. Throws std::runtime_error if a tile has too
 * many vertices; the message has the tile size for all shards. */
Report encode_shard(const SourceTerrain& terrain, const Options& options, const Shard& shard,
                    const std::string& path, const Callbacks& callbacks = {});

/* Joins the files of all shards, in any order, to the bytes that encode_pack writes; or joins packs
 * of one plan. The file appears complete or not at all. The report has no samples. Throws
 * std::runtime_error that names the file which does not fit, and if tiles are missing. */
Report merge_packs(const std::vector<std::string>& parts, const std::string& path);

}  // namespace microtin::encoder

#endif
