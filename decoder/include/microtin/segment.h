// SPDX-License-Identifier: MIT
/* microtin: queries about slopes, and about many positions of a mesh, on a segment or in a grid.
 * C99 and C++.
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
  uint32_t result;   /* each microtin_query_result so far, as bits */
  uint32_t is_low;   /* the last crossing has less than the needed clearance */
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

/* The place of a segment's end. */
#define MICROTIN_ALONG_END 0x40000000l

/* A place of a profile: the begin of the segment, its end, a vertex on it, or where it crosses an
 * edge. Between two places with terrain the height is linear. */
typedef struct microtin_crossing {
  int32_t along;   /* the place, see microtin_segment_extremes */
  int32_t height;  /* z steps, 16 fractional bits, rounded once; INT32_MIN: none */
  uint32_t result; /* a microtin_query_result: OK, or why there is no height */
  uint32_t before; /* a microtin_query_result: OK: there is terrain from the place before up to this
                      one; or VOID, OUTSIDE, and on packs NOT_LOADED, BAD_TILE */
} microtin_crossing;

/* Returns the places of the profile along a segment one after another, each once, from the begin to
 * the end, whose `along` is MICROTIN_ALONG_END. Crossings of edges that have no height are left
 * out; vertices on the segment, the begin and the end never are.
 *
 * Begin with a state of zeros. Parameters and cost are those of microtin_mesh_segment_extremes, but
 * the state must not be null.
 *
 * - OK: *crossing is the next place; after the end it is the end again
 * - STEP_LIMIT: call again
 * - OUTSIDE: an end lies outside 0 .. 65535 * 256
 * - NOT_LOADED, UNVERIFIED */
microtin_query_result microtin_mesh_profile_next(const microtin_mesh* mesh,
                                                 const microtin_segment* segment,
                                                 microtin_segment_state* state,
                                                 microtin_crossing* crossing, uint32_t step_limit);

/* A straight path above a segment, such as a climb or a line of sight. A segment that is a single
 * position may have two heights. */
typedef struct microtin_path {
  microtin_segment segment;
  int32_t z,
      z_end; /* heights where it begins and ends: z steps, 8 fractional bits, within +-2^25 */
  int32_t clearance; /* what is needed above the terrain: 8 fractional bits, within +-2^25 */
} microtin_path;

/* How far a path is above the terrain; negative below. Places are those of
 * microtin_segment_extremes. */
typedef struct microtin_path_clearance {
  int32_t least;       /* z steps, 8 fractional bits, rounded down */
  int32_t least_along; /* its place, the first of several with the same rounded clearance */
  int32_t first_along; /* the first place with less than the needed clearance; -1: there is none */
} microtin_path_clearance;

/* A flag of microtin_*_path_clearance: against the highest that the source can be, which is the
 * surface and the margin `below`; see microtin_mesh_margins. */
#define MICROTIN_FLAG_SAFE 2u

/* Finds the least clearance of a path, and the first place where the terrain comes too near.
 * `first_along` is rounded down: the clearance suffices everywhere before it.
 *
 * `flags` is 0 or a sum of MICROTIN_FLAG_SAFE and MICROTIN_FLAG_ALLOW_UNVERIFIED. State, step limit
 * and cost are those of microtin_mesh_segment_extremes; a state serves one kind of query.
 *
 * - OK: every position of the segment has a height
 * - OUTSIDE, VOID: a part of the segment has none; the clearance is that of the rest. Also OUTSIDE,
 *   and nothing is found: an end lies outside 0 .. 65535 * 256, or a number of the path outside its
 *   range
 * - NO_MARGIN: with MICROTIN_FLAG_SAFE, the mesh does not state the margin `below`
 * - NOT_LOADED, UNVERIFIED, STEP_LIMIT
 *
 * `least` is INT32_MAX and `first_along` -1 if nothing is found. */
microtin_query_result microtin_mesh_path_clearance(const microtin_mesh* mesh,
                                                   const microtin_path* path,
                                                   microtin_segment_state* state,
                                                   microtin_path_clearance* clearance,
                                                   uint32_t flags, uint32_t step_limit);

/* The slope of a triangle: the height rises by dx / whole z steps for each lattice step east, and
 * by dy / whole for each lattice step north. Exact; |dx|, |dy| < 2^33, 0 < whole < 2^32.
 *
 * In real units, with the axes of the terrain:
 *
 *   east  = dx / whole * (z.numerator / z.denominator) / (x.numerator / x.denominator)
 *   north = dy / whole * (z.numerator / z.denominator) / (y.numerator / y.denominator)
 *   slope = sqrt(east^2 + north^2), the tangent of the slope's angle if all axes have one unit
 *   aspect = atan2(-east, -north), the direction of steepest descent, clockwise from north */
typedef struct microtin_gradient {
  int64_t dx, dy, whole;
} microtin_gradient;

/* Finds the gradient at a position, with parameters and results of microtin_mesh_height_at. On an
 * edge or a vertex it is that of one triangle with terrain, the same on every form: the one whose
 * centre lies farthest east, and of those with the same x farthest north. *hint becomes the number
 * of that triangle; see microtin_mesh_triangle. VOID also if all triangles around a vertex are
 * void. Costs a height, and a look at each triangle around a vertex. */
microtin_query_result microtin_mesh_gradient_at(const microtin_mesh* mesh, int32_t x, int32_t y,
                                                uint32_t* hint, microtin_gradient* gradient,
                                                uint32_t flags, uint32_t step_limit);

/* A position, 8 fractional bits. */
typedef struct microtin_position {
  int64_t x, y;
} microtin_position;

/* Stores the heights at `count` positions, INT32_MIN where there is none. Each query starts where
 * the one before ended: sort the positions, or not. *hint as in microtin_mesh_height_at.
 *
 * - OK: all positions have heights
 * - any other: the result of the last position without a height */
microtin_query_result microtin_mesh_heights_at(const microtin_mesh* mesh,
                                               const microtin_position* positions, uint32_t count,
                                               uint32_t* hint, int32_t* heights);

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

/* The greatest and the least height at the positions of a grid: z steps, 16 fractional bits. */
typedef struct microtin_grid_extremes {
  int32_t highest, lowest; /* INT32_MIN and INT32_MAX: no position has a height */
} microtin_grid_extremes;

/* Finds the greatest and the least height at the positions of a grid. `missing` is not used.
 * Results and cost are those of microtin_mesh_sample_grid; OUTSIDE does not depend on the z axis.
 */
microtin_query_result microtin_mesh_grid_extremes(const microtin_mesh* mesh,
                                                  const microtin_grid_spec* grid,
                                                  microtin_grid_extremes* extremes);

#ifdef __cplusplus
}
#endif

#endif
