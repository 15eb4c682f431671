// SPDX-License-Identifier: MIT
/* microtin questions about many places of a terrain: the greatest height on a course, and blocks of
 * heights. C99 and C++.
 *
 * Coordinates have 8 fractional bits. Nothing here allocates, recurses, uses floating point or
 * keeps global state.
 */
#ifndef MICROTIN_SEGMENT_H
#define MICROTIN_SEGMENT_H

#include "microtin/microtin.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A straight way, or a place if both ends are the same. Each end within +-2^40, and less than 65536
 * steps (2^24 here) from the other along x and y. */
typedef struct microtin_segment {
  int64_t x, y, x_end, y_end;
} microtin_segment;

/* The greatest height on the course: exact, rounded once, found where it crosses edges. OK:
 * every place of it, those between lattice places too, has a height by microtin_mesh_height_at.
 * OUTSIDE, VOID: a part of it, be it a point, is outside the hull, or else void; *height is that of
 * the rest, INT32_MIN if there is none, or if an end is outside 0 .. 65535 * 256. Also NOT_LOADED,
 * UNVERIFIED. Looks at every triangle: about two for each vertex. */
microtin_query_result microtin_mesh_segment_max(const microtin_mesh* mesh,
                                                const microtin_segment* course, int32_t* height);

/* How far microtin_mesh_segment_max_limited has come. All zero to begin. */
typedef struct microtin_segment_state {
  uint32_t next; /* 0, 1: an end of the course, then triangles from number 0 on */
  uint32_t hint;
  int32_t highest; /* so far */
  uint32_t worst;  /* a microtin_query_result, so far */
} microtin_segment_state;

/* The same, with the same answers whatever the limits, in at most `step_limit` steps (0: no limit)
 * a call. STEP_LIMIT: call again with the same course and *progress; *height is INT32_MIN. A step
 * is one of a walk to an end of the course, as microtin_mesh_height_at_limited takes them, or looks
 * at one triangle, in O(1): in all one for each triangle and about sqrt(n) for the ends, whatever
 * the stream at most three times microtin_mesh_triangle_count. Any other answer is the last; asked
 * again, it is given again.
 *
 * Whoever replaces the terrain, lets its decoder go on, or wants another course begins anew with
 * zeros. Nothing tells an older progress apart: with it the answer holds for neither, but no number
 * in it leads out of the terrain. */
microtin_query_result microtin_mesh_segment_max_limited(const microtin_mesh* mesh,
                                                        const microtin_segment* course,
                                                        uint32_t step_limit,
                                                        microtin_segment_state* progress,
                                                        int32_t* height);

/* A block of places in rows: columns from (x, y) on by dx, rows by dy. */
typedef struct microtin_grid_spec {
  int64_t x, y;
  int32_t dx, dy; /* 8 fractional bits, too */
  uint16_t columns, rows;
  int16_t missing; /* what to write where there is no height */
} microtin_grid_spec;

/* Writes columns * rows heights in whole units of the z axis (such as metres), rounded to nearest,
 * halves up, kept within int16_t; `heights` is row by row. Returns OK if all are heights, else
 * the reason of the last that is not. OUTSIDE, and nothing is written, if the z axis has a
 * numerator of 2^31 or more or an offset beyond +-2^45, or x or y is beyond +-2^40. A query for
 * each place, from where the one before ended. Parts of a block have the same heights: who may not
 * stay long asks for a row or less at a time. */
microtin_query_result microtin_mesh_sample_grid(const microtin_mesh* mesh,
                                                const microtin_grid_spec* block, int16_t* heights);

#ifdef __cplusplus
}
#endif

#endif
