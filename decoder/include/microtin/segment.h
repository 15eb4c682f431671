// SPDX-License-Identifier: MIT
/* microtin: queries about many positions of a mesh, on a segment or in a grid. C99 and C++.
 *
 * Coordinates are lattice coordinates with 8 fractional bits: 256 is one lattice step. Nothing here
 * allocates, recurses, uses floating point or keeps global state. A query reads its terrain only,
 * so that it may interrupt other queries; it must not run while the terrain changes.
 *
 *   microtin_segment ahead = {x, y, x_ahead, y_ahead};
 *   microtin_segment_extremes found;
 *   if (microtin_mesh_segment_extremes(mesh, &ahead, NULL, &found, 0) == MICROTIN_QUERY_OK) ...
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

/* Where a query along a segment stands between two calls. All zero to begin; the contents are the
 * library's. */
typedef struct microtin_segment_state {
  uint32_t stage;    /* 0: before the first walk step */
  uint32_t triangle; /* the number of the triangle where the walk stands */
  uint32_t result;   /* the worst microtin_query_result so far */
  int32_t value[2];
  int64_t part[2], whole[2];
} microtin_segment_state;

/* The greatest and the least height on a segment: exact, rounded once to 16 fractional bits of a z
 * step. A place is the part of the segment's length, with 30 fractional bits and rounded down: 0 at
 * the begin, 2^30 at the end. Of several places with the same rounded height it is the first. */
typedef struct microtin_segment_extremes {
  int32_t highest, lowest;             /* z steps, 16 fractional bits */
  int32_t highest_along, lowest_along; /* the places */
} microtin_segment_extremes;

/* Finds the greatest and the least height on a segment.
 *
 * A call takes at most `step_limit` walk steps (0: no limit). After STEP_LIMIT call again with the
 * same segment and state. `state` may be null without a limit. A walk step looks at one triangle.
 * The query walks to the begin, as microtin_mesh_height_at does, and from there to the end, through
 * the triangles that the segment meets. If the begin is outside, it goes along the hull to where
 * the segment enters.
 *
 * - OK: every position of the segment has a height
 * - OUTSIDE: a part of the segment, perhaps a point, is outside the hull; the heights are those of
 *   the rest
 * - VOID: a part of the segment is void, and none is outside; the heights are those of the rest
 * - NOT_LOADED, UNVERIFIED: the mesh has no verified terrain
 * - STEP_LIMIT: call again
 *
 * `highest` is INT32_MIN and `lowest` INT32_MAX if no position of the segment has a height, if an
 * end lies outside 0 .. 65535 * 256, and after STEP_LIMIT. After any result but STEP_LIMIT another
 * call repeats it. Begin with a state of zeros when the terrain or the segment changes: a state of
 * another segment gives a wrong result, but cannot lead out of the terrain. */
microtin_query_result microtin_mesh_segment_extremes(const microtin_mesh* mesh,
                                                     const microtin_segment* segment,
                                                     microtin_segment_state* state,
                                                     microtin_segment_extremes* extremes,
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
