// SPDX-License-Identifier: MIT
/* microtin: encoder and reader for languages that call C. The shared library libmicrotin contains
 * these functions and all of microtin.h, segment.h, compact.h and pack.h. C99 and C++.
 *
 * encoder.hpp and surface.hpp describe options and results in detail. Numbers here are real units.
 * Rows of rasters begin in the north. Texts are UTF-8 and end in 0; null is an empty text. Set the
 * `size` of a struct; zeros elsewhere select the defaults. Later versions add members at the end.
 *
 * A function that can fail returns microtin_status. Unless the status is OK it has made nothing and
 * has written no file, and microtin_last_error returns the reason. Several threads may call these
 * functions at once, but only one at a time for the same surface. Free memory by the function that
 * is named for it.
 */
#ifndef MICROTIN_ENCODER_H
#define MICROTIN_ENCODER_H

#include <microtin/microtin.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A sentence on the last failure in this thread; valid until its next call. Never null. */
const char* microtin_last_error(void);

/* What the last terrain that this thread encoded leaves to a guess, or unknown, of units and
 * systems, and doubtful heights: sentences, each on a line; "" if nothing. Valid until its next
 * call. Never null. */
const char* microtin_last_warnings(void);

/* "0.1.0" */
const char* microtin_version_string(void);

/* --- Encoding --- */

/* Heights at the centres of a raster's cells, not a number where there is none; each number stands
 * for the shortest decimal that becomes it. 2 .. 65536 columns and rows for a stream. */
typedef struct microtin_raster_data {
  size_t size; /* sizeof(microtin_raster_data), as in all structs below */
  uint32_t columns, rows;
  const double* heights;      /* row by row; null: */
  const float* float_heights; /* ... these */
  double transform[6];        /* as GDAL's: see encoder.hpp */
  const char* wkt;            /* systems of places and heights */
  const double* no_data; /* of void cells, compared in the heights' own type; null: NaN alone */
} microtin_raster_data;

/* Points in any order. */
typedef struct microtin_point_data {
  size_t size;
  uint64_t count;
  const double* coordinates; /* x, y, z of each in turn */
  const char* wkt;
} microtin_point_data;

/* As encoder::Options, StreamOptions and PackOptions; 0 everywhere is what is usual. */
typedef struct microtin_options {
  size_t size;
  const char* max_error; /* decimals, "0.25" */
  const char *z_step, *xy_step;
  uint32_t never_below; /* 1: no height is below the terrain */
  uint32_t effort;      /* 1 fast, 2 normal, 3 best */
  uint32_t max_degree;  /* 6 .. 32 */
  uint32_t coding;      /* 1 quick, 2 balanced, 3 dense */
  uint32_t bound_at;    /* 1 points, 2 lattice */
  uint32_t duplicates;  /* 1 middle, 2 lowest, 3 highest, 4 mean */
  const char* units;    /* "degree:metre", ":foot"; null: as code or well-known text say */
  uint32_t horizontal_epsg, vertical_epsg;
  const char *source_name, *date, *lineage;
  uint32_t max_vertices, max_bytes;            /* of streams alone */
  uint32_t tile_vertices, tile_size;           /* of packs alone */
  int (*progress)(void* context, double done); /* 0 .. 1; returns 1 to cancel. May be null */
  void* context;
  uint32_t depths; /* 1: heights grow downwards, and are negated */
} microtin_options;

/* As encoder::Report; numbers are decimals as text, "" if there is none. */
typedef struct microtin_report {
  uint64_t samples, vertices, bytes;
  uint32_t tiles;
  char bound[24], max_error[24], rms_error[24], mean_error[24], max_below[24];
  char max_error_at_points[24], max_below_at_points[24];
} microtin_report;

/* A terrain to be encoded. */
typedef struct microtin_source microtin_source;

/* Copies what it is given: 8 bytes a post, 24 a point. */
microtin_status microtin_source_from_raster(const microtin_raster_data* raster,
                                            microtin_source** source);
/* Makes a source from points, which are copied: 24 bytes each. */
microtin_status microtin_source_from_points(const microtin_point_data* points,
                                            microtin_source** source);
/* Reads a file by its suffix. */
microtin_status microtin_source_from_file(const char* path, microtin_source** source);
/* Frees a source. Null is allowed. */
void microtin_source_free(microtin_source* source);

/* The stream's bytes are freed by microtin_bytes_free. */
microtin_status microtin_encode_stream(const microtin_source* source,
                                       const microtin_options* options, uint8_t** bytes,
                                       uint64_t* size, microtin_report* report);
/* Frees the bytes of a stream. Null is allowed. */
void microtin_bytes_free(uint8_t* bytes);

/* Writes a file that appears complete or not at all. */
microtin_status microtin_encode_pack(const microtin_source* source, const microtin_options* options,
                                     const char* path, microtin_report* report);

/* --- Reading --- */

/* A stream or a pack that is read. */
typedef struct microtin_surface microtin_surface;

/* A stream or a pack, from a file, or from bytes that are copied. A stream is decoded and checked
 * at once, of a pack header and index; its tiles when they are asked for. `name` is for messages.
 */
microtin_status microtin_surface_from_file(const char* path, microtin_surface** surface);
/* Reads a stream or a pack from bytes, which are copied. `name` is for messages. */
microtin_status microtin_surface_from_bytes(const uint8_t* bytes, uint64_t size, const char* name,
                                            microtin_surface** surface);
/* Frees a surface. Null is allowed. */
void microtin_surface_free(microtin_surface* surface);

/* Posts: the place of (column, row) is (x, y) of coordinates `x.offset + x.numerator * column`
 * parts of `x.denominator`; row 0 is the southernmost. */
typedef struct microtin_grid {
  uint32_t columns, rows;
  microtin_axis x, y;
} microtin_grid;

/* As encoder::SurfaceInfo. Texts are valid as long as the surface. */
typedef struct microtin_surface_info {
  uint64_t bytes, vertices;
  uint32_t is_pack, tile_columns, tile_rows; /* 1 x 1 of a stream */
  double west, south, east, north, lowest, highest;
  microtin_axis x, y, z;
  microtin_grid source;                    /* no columns: it was no raster */
  uint32_t horizontal_unit, vertical_unit; /* 1 metre, 2 degree, 3 foot, 4 US survey foot, or 0 */
  uint32_t horizontal_epsg, vertical_epsg;
  const char *wkt, *origin, *date, *lineage;
  const char *bound, *max_error, *rms_error, *mean_error;
  const char* max_error_at_points; /* where points truly lie, if the lattice moves them */
} microtin_surface_info;

/* Writes what the header contains, and where the surface is. */
void microtin_surface_get_info(const microtin_surface* surface, microtin_surface_info* info);

/* Vertices and triangles. They belong to the surface, until the next of these calls for it. */
typedef struct microtin_triangles {
  uint64_t vertices, triangles;
  const double* coordinates; /* x, y, height of each vertex */
  const uint32_t* corners;   /* three of each triangle, counter-clockwise; void ones are left out */
} microtin_triangles;

/* All of it; vertices on borders of tiles once. O(n). */
microtin_status microtin_surface_mesh(microtin_surface* surface, microtin_triangles* triangles);

/* A tile, columns from the west, rows from the south; a stream is tile 0, 0. Nothing in it if the
 * tile has no terrain. */
microtin_status microtin_surface_tile(microtin_surface* surface, uint32_t column, uint32_t row,
                                      microtin_triangles* triangles);

/* Heights of the exact plane at `count` places, not a number where there is none. About 0.3 us
 * each, and the decoding of the tiles that are needed. */
microtin_status microtin_surface_heights(microtin_surface* surface, uint64_t count, const double* x,
                                         const double* y, double* heights);

/* Posts `cell` units apart ("0.25"), from the south-west corner on. */
microtin_status microtin_surface_grid(const microtin_surface* surface, const char* cell,
                                      microtin_grid* grid);

/* Heights at all posts of a grid, columns * rows of them, the northernmost row first. */
microtin_status microtin_surface_sample_grid(microtin_surface* surface, const microtin_grid* grid,
                                             double* heights);

#ifdef __cplusplus
}
#endif

#endif
