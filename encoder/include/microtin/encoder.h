// SPDX-License-Identifier: MIT
/* microtin: encodes terrain, and reads streams and packs, for languages that call C. C99 and C++.
 *
 * The shared library libmicrotin contains these functions and all of microtin.h, segment.h,
 * compact.h, pack.h and compact_pack.h. encoder.hpp and surface.hpp describe options and results in
 * detail. Numbers are in real units. Rows of rasters begin in the north. Texts are UTF-8 and end in
 * 0; a null pointer is an empty text.
 *
 * Every struct begins with `size`, which the caller sets to the sizeof of the struct. Later
 * versions add members at the end: the library reads and writes the first `size` bytes only, and a
 * member beyond them has its default. Zero in a member selects the default.
 *
 * A function that can fail returns microtin_status. Unless the status is OK, it has made nothing
 * and written no file, and microtin_last_error returns the reason:
 *
 * - MICROTIN_STATUS_REJECTED: the input or an option is refused
 * - MICROTIN_STATUS_NO_MEMORY: memory ran out
 * - MICROTIN_STATUS_CANCELLED: `progress` returned 1
 * - MICROTIN_STATUS_INTERNAL: a fault of the library itself
 *
 * Several threads may call these functions at once, but only one at a time for the same surface.
 * Free memory with the function that is named for it.
 */
#ifndef MICROTIN_ENCODER_H
#define MICROTIN_ENCODER_H

#include <microtin/microtin.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Returns the reason of the last failure in this thread. Valid until the thread's next call; never
 * null. */
const char* microtin_last_error(void);

/* Returns the warnings about the terrain that this thread encoded last, each on a line: units and
 * systems that were guessed, doubtful heights. "" if there are none. Valid until the thread's next
 * call; never null. */
const char* microtin_last_warnings(void);

/* Returns the version, "1.0.0". */
const char* microtin_version_string(void);

/* --- Encoding --- */

/* A raster: heights at the centres of cells, row by row. NaN is a cell without a height. Each
 * number stands for the shortest decimal that rounds to it. 2 .. 65536 columns and rows for a
 * stream. */
typedef struct microtin_raster_data {
  size_t size;
  uint32_t columns, rows;
  const double* heights;      /* or null, and then: */
  const float* float_heights; /* heights with 32 bits */
  double transform[6];        /* GDAL's geotransform; see encoder.hpp */
  const char* wkt;            /* well-known text of the horizontal and vertical systems */
  const double* no_data;      /* cells with this value, compared in the heights' type, have none */
} microtin_raster_data;

/* Points in any order. */
typedef struct microtin_point_data {
  size_t size;
  uint64_t count;
  const double* coordinates; /* x, y, z of each point in turn */
  const char* wkt;           /* well-known text of the horizontal and vertical systems */
} microtin_point_data;

/* Values of microtin_options.effort. */
enum { MICROTIN_EFFORT_FAST = 1, MICROTIN_EFFORT_NORMAL = 2, MICROTIN_EFFORT_BEST = 3 };

/* Values of microtin_options.coding. */
enum { MICROTIN_CODING_QUICK = 1, MICROTIN_CODING_BALANCED = 2, MICROTIN_CODING_DENSE = 3 };

/* Values of microtin_options.bound_at. */
enum {
  MICROTIN_BOUND_AT_POINTS = 1,
  MICROTIN_BOUND_AT_LATTICE = 2,
  MICROTIN_BOUND_AT_EVERYWHERE = 3
};

/* Values of microtin_options.duplicates. */
enum {
  MICROTIN_DUPLICATES_MIDDLE = 1,
  MICROTIN_DUPLICATES_LOWEST = 2,
  MICROTIN_DUPLICATES_HIGHEST = 3,
  MICROTIN_DUPLICATES_MEAN = 4
};

/* Values of surface: what the heights are; see encoder::SurfaceKind. */
enum {
  MICROTIN_SURFACE_UNKNOWN = 0,
  MICROTIN_SURFACE_GROUND = 1,
  MICROTIN_SURFACE_TOP = 2,
  MICROTIN_SURFACE_BED = 3,
  MICROTIN_SURFACE_GEOID = 4,
  MICROTIN_SURFACE_OBSTACLES = 5
};

/* The options of encoder::Options, with the same names and meanings. Zero in a member selects its
 * default; see encoder.hpp. */
typedef struct microtin_options {
  size_t size;
  const char* max_error; /* decimals, "0.25" */
  const char *z_step, *xy_step;
  uint32_t never_below; /* 1: no post or point is above the surface */
  uint32_t effort;      /* MICROTIN_EFFORT_* */
  uint32_t max_degree;  /* 6 .. 32 */
  uint32_t coding;      /* MICROTIN_CODING_* */
  uint32_t bound_at;    /* MICROTIN_BOUND_AT_* */
  uint32_t duplicates;  /* MICROTIN_DUPLICATES_* */
  const char* units;    /* "degree:metre", ":foot" */
  uint32_t horizontal_epsg, vertical_epsg;
  const char *source_name, *date, *lineage;
  uint32_t max_vertices, max_bytes;            /* of streams */
  uint32_t tile_vertices, tile_size;           /* of packs */
  int (*progress)(void* context, double done); /* 0 .. 1; returns 1 to cancel. May be null */
  void* context;
  uint32_t depths;  /* 1: heights grow downwards, and are negated */
  uint32_t surface; /* MICROTIN_SURFACE_* */
  const char *attribution, *license, *valid;
  const char *epoch, *source_accuracy;    /* "2020.5"; "LE90 4" */
  uint32_t digest, phases;                /* 1: note them, in a stream */
  const char* error_map;                  /* a file with a bound for each post or point */
  const char *area, *route, *route_width; /* files; the width in metres */
  const char *breaklines, *obstacles;     /* files */
  const char* route_edge_error;           /* the bound at the edges of route_width */
} microtin_options;

/* What the encoder measured; see encoder::Report. Errors are decimals as text, "" if there is
 * none. */
typedef struct microtin_report {
  size_t size;
  uint64_t samples, vertices, bytes;
  uint32_t tiles;
  char bound[24], max_error[24], rms_error[24], mean_error[24], max_below[24];
  char max_error_at_points[24], max_below_at_points[24];
  char max_above[24], max_below_everywhere[24], max_above_everywhere[24];
  char least_bound[24], largest_bound[24], max_bound_ratio[24];
} microtin_report;

/* A terrain to encode. */
typedef struct microtin_source microtin_source;

/* Makes a source from a raster, which is copied: 8 bytes a post. */
microtin_status microtin_source_from_raster(const microtin_raster_data* raster,
                                            microtin_source** source);
/* Makes a source from points, which are copied: 24 bytes each. */
microtin_status microtin_source_from_points(const microtin_point_data* points,
                                            microtin_source** source);
/* Reads a file. Its suffix selects the reader; see encoder.hpp. */
microtin_status microtin_source_from_file(const char* path, microtin_source** source);
/* Makes one terrain of `count` files and folders, which are read while the terrain is encoded: see
 * SourceTerrain::from_files. The names are copied. */
microtin_status microtin_source_from_files(const char* const* paths, uint64_t count,
                                           microtin_source** source);
/* Gives each post or point of a source a bound of its own: see SourceTerrain::set_error_map. The
 * raster of bounds is copied. Only one thread at a time may use the source meanwhile. */
microtin_status microtin_source_set_error_map(microtin_source* source,
                                              const microtin_raster_data* bounds);
/* Frees a source. Null is allowed. */
void microtin_source_free(microtin_source* source);

/* Encodes a stream. `report` may be null. Free the bytes with microtin_bytes_free. */
microtin_status microtin_encode_stream(const microtin_source* source,
                                       const microtin_options* options, uint8_t** bytes,
                                       uint64_t* byte_count, microtin_report* report);
/* Frees the bytes of a stream. Null is allowed. */
void microtin_bytes_free(uint8_t* bytes);

/* Encodes a pack and writes it to a file, which appears complete or not at all. `report` may be
 * null. */
microtin_status microtin_encode_pack(const microtin_source* source, const microtin_options* options,
                                     const char* path, microtin_report* report);

/* A part of the tiles of a pack; see encoder::Shard. */
typedef struct microtin_shard {
  size_t size;
  uint32_t tile_size; /* of the pack, in lattice steps between posts */
  uint32_t first_tile, last_tile;
  char z_step[24]; /* of the pack, a decimal as text */
} microtin_shard;

/* Divides the pack of a raster into at most `count` shards of equal work, and writes them to the
 * first of `count` structs, of which the first has its size. Writes their number to `planned`. */
microtin_status microtin_plan_shards(const microtin_source* source, const microtin_options* options,
                                     uint32_t count, microtin_shard* shards, uint32_t* planned);

/* Encodes the tiles of a shard, with the source and the options of microtin_plan_shards, and writes
 * them to a file, which appears complete or not at all. `report` may be null; it has vertices and
 * tiles alone. */
microtin_status microtin_encode_shard(const microtin_source* source,
                                      const microtin_options* options, const microtin_shard* shard,
                                      const char* path, microtin_report* report);

/* Joins `count` files of shards to the pack that microtin_encode_pack writes, or packs of one plan.
 * The file appears complete or not at all. `report` may be null. */
microtin_status microtin_merge_packs(const char* const* parts, uint64_t count, const char* path,
                                     microtin_report* report);

/* --- Reading --- */

/* A stream or a pack. */
typedef struct microtin_surface microtin_surface;

/* Opens a file. Decodes and checks a stream at once. Of a pack reads header and index, and decodes
 * tiles as needed. */
microtin_status microtin_surface_from_file(const char* path, microtin_surface** surface);
/* Opens a stream or a pack from bytes, which are copied. Errors contain `name`. */
microtin_status microtin_surface_from_bytes(const uint8_t* bytes, uint64_t byte_count,
                                            const char* name, microtin_surface** surface);
/* Frees a surface. Null is allowed. */
void microtin_surface_free(microtin_surface* surface);

/* Posts in columns and rows; row 0 is the southernmost. The x of a column is
 * (x.offset + x.numerator * column) / x.denominator. */
typedef struct microtin_grid {
  size_t size;
  uint32_t columns, rows;
  microtin_axis x, y;
} microtin_grid;

/* Values of horizontal_unit and vertical_unit. */
enum {
  MICROTIN_UNIT_UNKNOWN = 0,
  MICROTIN_UNIT_METRE = 1,
  MICROTIN_UNIT_DEGREE = 2,
  MICROTIN_UNIT_FOOT = 3,
  MICROTIN_UNIT_US_FOOT = 4
};

/* Values of side: which side of the source the surface may be on, as far as the bound. */
enum {
  MICROTIN_SIDE_NOT_STATED = 0,
  MICROTIN_SIDE_BOTH = 1,
  MICROTIN_SIDE_NEVER_BELOW = 2,
  MICROTIN_SIDE_NEVER_ABOVE = 3
};

/* A stream after one of its phases, or after the first few. */
typedef struct microtin_phase {
  uint64_t vertices;
  uint64_t bytes;        /* from the first byte of the file on */
  const char* max_error; /* at the heights that the surface covers then; "" if there are none */
} microtin_phase;

/* What the header contains, and where the surface is; see encoder::SurfaceInfo. Texts are valid as
 * long as the surface. */
typedef struct microtin_surface_info {
  size_t size;
  uint64_t bytes, vertices;
  uint32_t is_pack, tile_columns, tile_rows; /* stream: 0, 1, 1 */
  double west, south, east, north, lowest, highest;
  microtin_axis x, y, z;
  uint32_t horizontal_unit, vertical_unit; /* MICROTIN_UNIT_* */
  uint32_t horizontal_epsg, vertical_epsg;
  const char *wkt, *source_name, *date, *lineage;
  const char *bound, *max_error, *rms_error, *mean_error;
  const char* max_error_at_points;   /* at the points' own positions, if the lattice moves points */
  uint32_t surface, side;            /* MICROTIN_SURFACE_*, MICROTIN_SIDE_* */
  const char *max_below, *max_above; /* at posts or points */
  const char *max_below_everywhere,
      *max_above_everywhere; /* from the surface of a raster's posts */
  const char *attribution, *license, *valid, *epoch, *source_accuracy;
  const char* digest;           /* of a stream's mesh, 16 hexadecimal digits */
  const microtin_phase* phases; /* of a stream */
  uint64_t phase_count;
  const char *least_bound, *largest_bound, *max_bound_ratio; /* if heights have their own */
} microtin_surface_info;

/* Writes what the header contains, and where the surface is. Cannot fail for a surface and a struct
 * with its size. */
microtin_status microtin_surface_get_info(const microtin_surface* surface,
                                          microtin_surface_info* info);

/* Vertices and triangles. They belong to the surface, and are valid until the next call that writes
 * such a struct for it. */
typedef struct microtin_triangles {
  size_t size;
  uint64_t vertices, triangles;
  const double* coordinates; /* x, y, height of each vertex */
  const uint32_t* corners;   /* three of each triangle, counter-clockwise; void ones are left out */
} microtin_triangles;

/* Writes the whole surface. Vertices on borders of tiles appear once. O(n). */
microtin_status microtin_surface_mesh(microtin_surface* surface, microtin_triangles* triangles);

/* The lines that the marks of a stream's edges make, such as ridges and rivers. They belong to the
 * surface, and are valid until the next call that writes such a struct for it. */
typedef struct microtin_lines {
  size_t size;
  uint64_t count;             /* of lines; 0: there are none, as in a pack */
  const char* const* classes; /* the name of each line's class: "ridge", "water", ... */
  const uint64_t* vertices;   /* how many vertices each line has */
  const double* coordinates;  /* x, y, height of each vertex, line after line */
} microtin_lines;

/* Writes the lines, as `microtin decode -o lines.geojson` does. O(n). */
microtin_status microtin_surface_lines(microtin_surface* surface, microtin_lines* lines);

/* Writes a tile, columns counted from the west and rows from the south; a stream is tile 0, 0. A
 * tile without terrain has no vertices. */
microtin_status microtin_surface_tile(microtin_surface* surface, uint32_t column, uint32_t row,
                                      microtin_triangles* triangles);

/* The largest distances of a tile below and above the bilinear surface of a raster's posts, also
 * between posts: decimals as text, "" if the tile does not state them or has no terrain. */
typedef struct microtin_tile_margins {
  size_t size;
  char max_below_everywhere[24], max_above_everywhere[24];
} microtin_tile_margins;

/* Writes the margins of a tile, counted as for microtin_surface_tile. Reads the tile's header. */
microtin_status microtin_surface_tile_margins(const microtin_surface* surface, uint32_t column,
                                              uint32_t row, microtin_tile_margins* margins);

/* Writes the heights of the exact plane at `count` positions; NaN where there is none. About 0.3 us
 * each, and the decoding of the tiles that are needed. */
microtin_status microtin_surface_heights(microtin_surface* surface, uint64_t count, const double* x,
                                         const double* y, double* heights);

/* Writes the gradients at `count` positions, metres of rise for a metre east and for a metre north;
 * NaN where there is none. See Surface::gradients for the slope, the aspect and the rules. */
microtin_status microtin_surface_gradients(microtin_surface* surface, uint64_t count,
                                           const double* x, const double* y, double* east,
                                           double* north);

/* Between which heights an area lies, by those of the tiles that it touches; see
 * encoder::HeightBounds. */
typedef struct microtin_height_bounds {
  size_t size;
  double lowest, highest;               /* NaN: no tile of the area has terrain */
  double source_lowest, source_highest; /* NaN: the header states no margins */
  uint32_t is_complete; /* 1: nothing in the area is outside the bounds; voids do not count */
} microtin_height_bounds;

/* Writes between which heights a box lies, by a pack's index and without decoding. */
microtin_status microtin_surface_bounds_in_box(const microtin_surface* surface, double west,
                                               double south, double east, double north,
                                               microtin_height_bounds* bounds);

/* Writes between which heights the straight line between two positions lies, by a pack's index and
 * without decoding. */
microtin_status microtin_surface_bounds_on_line(const microtin_surface* surface, double x, double y,
                                                double x_end, double y_end,
                                                microtin_height_bounds* bounds);

/* --- Profiles and lines of sight ---
 *
 * profile.hpp defines the terms and units; encoder/docs/profiles.md has the model and its error. */

/* The places of a profile; see encoder::ProfilePlace. They belong to the surface, and are valid
 * until the next call that writes such a struct for it. */
typedef struct microtin_profile {
  size_t size;
  uint64_t count;                 /* of places: at least 2 */
  const double* places;           /* seven of each: along, distance, x, y, height, below, above */
  const uint8_t* is_known_before; /* one of each place */
  double length, earth_radius, geodesic_deviation;
  uint32_t result; /* a microtin_query_result */
} microtin_profile;

/* Writes the profile of the straight line between two positions. */
microtin_status microtin_surface_profile(microtin_surface* surface, double x, double y,
                                         double x_end, double y_end, microtin_profile* profile);

/* How lines of sight are judged; see encoder::SightOptions. */
typedef struct microtin_sight_options {
  size_t size;
  double earth_factor;           /* 0: 4/3 */
  double frequency;              /* MHz; 0: no Fresnel zone */
  double zone_share;             /* 0: 0.6 */
  uint32_t is_safe;              /* 1: by the highest that the source can be */
  uint32_t from_datum, to_datum; /* 1: heights of that end are above the datum, not the ground */
} microtin_sight_options;

/* Values of `line` and `zone`. */
enum { MICROTIN_SIGHT_CLEAR = 0, MICROTIN_SIGHT_BLOCKED = 1, MICROTIN_SIGHT_UNKNOWN = 2 };

/* Where results are written, one number of each line; see encoder::LineOfSight. A null pointer
 * leaves them out. */
typedef struct microtin_sights {
  size_t size;
  uint8_t *line, *zone; /* MICROTIN_SIGHT_* */
  double *least_clearance, *least_clearance_at, *first_obstruction, *first_zone_obstruction;
  double *free_share, *free_share_at;
} microtin_sights;

/* Judges `count` lines of sight. `ends` has six numbers of each line: x, y and height of its begin,
 * then those of its end. `options` may be null. */
microtin_status microtin_surface_lines_of_sight(microtin_surface* surface, uint64_t count,
                                                const double* ends,
                                                const microtin_sight_options* options,
                                                const microtin_sights* sights);

/* Writes a grid of posts `cell` units apart, from the south-west corner on. `cell` is a decimal,
 * "0.25"; null selects the posts of the encoded raster. */
microtin_status microtin_surface_grid(const microtin_surface* surface, const char* cell,
                                      microtin_grid* grid);

/* Writes the heights at all posts of a grid, columns * rows of them, the northernmost row first. */
microtin_status microtin_surface_sample_grid(microtin_surface* surface, const microtin_grid* grid,
                                             double* heights);

#ifdef __cplusplus
}
#endif

#endif
