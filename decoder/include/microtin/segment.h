// SPDX-License-Identifier: MIT
/* microtin: queries about many positions of a mesh, on a segment or in a grid. C99 and C++.
 *
 * Coordinates are lattice coordinates with 8 fractional bits: 256 is one lattice step. Nothing here
 * allocates, recurses, uses floating point or keeps global state. A query reads its terrain only,
 * so that it may interrupt other queries; it must not run while the terrain changes.
 *
 *   microtin_segment ahead = {x, y, x_ahead, y_ahead};
 *   int32_t height;
 *   if (microtin_mesh_segment_max(mesh, &ahead, NULL, &height, 0) == MICROTIN_QUERY_OK) ...
 */
#ifndef MICROTIN_SEGMENT_H
#define MICROTIN_SEGMENT_H

#include "microtin/microtin.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A straight line between two positions; a single position if both ends are equal. Each coordinate
 * lies within +-2^40. The ends are less than 65,536 lattice steps (2^24 here) apart along x and
 * along y. */
typedef struct microtin_segment {
  int64_t x, y;         /* where it begins, 8 fractional bits */
  int64_t x_end, y_end; /* where it ends, 8 fractional bits */
} microtin_segment;

/* Where a query along a segment stands between two calls. All zero to begin. */
typedef struct microtin_segment_state {
  uint32_t next;   /* 0, 1: an end of the segment; then 2 more than the next triangle's number */
  uint32_t hint;   /* the triangle where the walk to an end stands */
  int32_t highest; /* the greatest height so far */
  uint32_t worst;  /* the worst microtin_query_result so far */
} microtin_segment_state;

/* Finds the greatest height on a segment: exact, rounded once to 16 fractional bits of a z step.
 *
 * A call takes at most `step_limit` walk steps (0: no limit). After STEP_LIMIT call again with the
 * same segment and state. `state` may be null without a limit. A walk step looks at one triangle.
 * The query looks at every triangle, about two for each vertex, and at most at three times
 * microtin_mesh_triangle_count in all calls together.
 *
 * - OK: *height is the greatest height, and every position of the segment has a height
 * - OUTSIDE: a part of the segment, perhaps a point, is outside the hull; *height is the greatest
 *   height of the rest
 * - VOID: a part of the segment is void, and none is outside; *height as with OUTSIDE
 * - NOT_LOADED, UNVERIFIED: the mesh has no verified terrain
 * - STEP_LIMIT: call again; *height is INT32_MIN
 *
 * *height is INT32_MIN if no position of the segment has a height, and if an end lies outside
 * 0 .. 65535 * 256. After any result but STEP_LIMIT another call repeats it. Begin with a state of
 * zeros when the terrain or the segment changes: a state of another segment gives a wrong result,
 * but cannot lead out of the terrain. */
microtin_query_result microtin_mesh_segment_max(const microtin_mesh* mesh,
                                                const microtin_segment* segment,
                                                microtin_segment_state* state, int32_t* height,
                                                uint32_t step_limit);

/* Positions in rows and columns, and what to store where there is no height. */
typedef struct microtin_grid_spec {
  int64_t x, y;           /* the first position, 8 fractional bits */
  int32_t dx, dy;         /* from a column, and from a row, to the next, 8 fractional bits */
  uint16_t columns, rows; /* how many of each */
  int16_t missing;        /* stored where there is no height */
} microtin_grid_spec;

/* Stores columns * rows heights, row by row, in whole units of the z axis (such as metres). They
 * are rounded to nearest, halves up, and limited to the range of int16_t. A part of a grid has the
 * same heights as the whole grid: split it where a call must be short. The cost is one query for
 * each position, which starts where the one before ended.
 *
 * - OK: all positions have heights
 * - OUTSIDE, and nothing is stored: the numerator of the z axis is 2^31 or more, its offset is
 *   beyond +-2^45, or x or y is beyond +-2^40
 * - any other: the result of the last position without a height; see microtin_mesh_height_at */
microtin_query_result microtin_mesh_sample_grid(const microtin_mesh* mesh,
                                                const microtin_grid_spec* grid, int16_t* heights);

#ifdef __cplusplus
}
#endif

#endif
