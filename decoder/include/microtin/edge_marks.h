// SPDX-License-Identifier: MIT
/* microtin: the marks of a terrain's edges. C99 and C++.
 *
 * A stream may state behind its end which edges of the mesh are lines, such as ridges, rivers or
 * runways, and a class for each line. Heights need no marks. A program that needs them passes the
 * bytes behind the stream on:
 *
 *   microtin_edge_marks* marks;
 *   microtin_edge_marks_init(memory, sizeof memory, mesh, &marks);   (once the mesh is complete)
 *   microtin_edge_marks_feed(marks, bytes, size, &used, 0);          (until it returns OK)
 *   if (microtin_edge_marks_class(marks, t, corner) == MICROTIN_LINE_WATER) ...
 *
 * Nothing here allocates, recurses, uses floating point or keeps global state. Compact terrains and
 * packs have no marks: their edges have other numbers, or none.
 */
#ifndef MICROTIN_EDGE_MARKS_H
#define MICROTIN_EDGE_MARKS_H

#include "microtin/microtin.h"

/* Bytes of the marks of a mesh with up to `capacity` vertices: a constant expression, also usable
 * in #if. An edge takes four bits. Align the workspace to MICROTIN_ALIGNMENT. */
#define MICROTIN_EDGE_MARKS_BYTES(capacity) (360ul + (capacity) + ((capacity) + 1ul) / 2)

/* Names that the linker sees: those of functions that depend on the index width contain it. */
#if MICROTIN_INDEX_BITS == 16
#define microtin_edge_marks_init microtin_edge_marks_init_16
#else
#define microtin_edge_marks_init microtin_edge_marks_init_32
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* What a line is. Values up to 15 that are not listed are for later versions: take them as OTHER.
 */
typedef enum microtin_line_class {
  MICROTIN_LINE_NONE = 0,  /* the edge has no mark */
  MICROTIN_LINE_OTHER = 1, /* a line of no other class, or of an unknown one */
  MICROTIN_LINE_RIDGE = 2,
  MICROTIN_LINE_VALLEY = 3, /* the bottom of a valley, with or without water */
  MICROTIN_LINE_WATER = 4,  /* a river, or a shore */
  MICROTIN_LINE_CLIFF = 5,
  MICROTIN_LINE_DAM = 6, /* or a dike */
  MICROTIN_LINE_WALL = 7,
  MICROTIN_LINE_BUILDING = 8,
  MICROTIN_LINE_ROAD = 9,
  MICROTIN_LINE_RAILWAY = 10,
  MICROTIN_LINE_RUNWAY = 11,
  MICROTIN_LINE_BORDER = 12 /* of an area, such as a field or a forest */
} microtin_line_class;

/* The marks of a mesh's edges, in the caller's workspace. */
typedef struct microtin_edge_marks microtin_edge_marks;

/* Makes an object without marks for `mesh` in `workspace`, and sets *marks, which points into it.
 * The mesh must be decoded to its end. After the mesh has changed, call this function again.
 * O(n).
 *
 * - OK
 * - ARGUMENT: a null pointer, or a mesh that is empty or not verified
 * - MISALIGNED, WORKSPACE_TOO_SMALL */
microtin_status microtin_edge_marks_init(void* workspace, size_t size, const microtin_mesh* mesh,
                                         microtin_edge_marks** marks);

/* Takes the next `size` bytes behind the stream's end: the first are those that
 * microtin_decoder_feed did not take. At most `step_limit` work units (0: no limit); a work unit
 * looks at no more than 31 triangles and marks at most one edge. *used is how many bytes were
 * taken.
 *
 * - NEED_INPUT: pass the following bytes
 * - STEP_LIMIT: call again with the bytes that were not taken
 * - OK: the marks are complete and verified; following bytes were not taken
 * - CHECKSUM: the bytes are damaged, or nothing that may follow a stream
 * - MALFORMED, ARGUMENT
 *
 * All calls together take fewer than 10 n work units for n vertices. After an error no edge has a
 * mark, and the mesh is as before. How the bytes are cut into calls changes no result. */
microtin_status microtin_edge_marks_feed(microtin_edge_marks* marks, const uint8_t* bytes,
                                         size_t size, size_t* used, uint32_t step_limit);

/* Ends the bytes: none follow. Returns NOT_FOUND instead of NEED_INPUT if the file has no marks,
 * TRUNCATED if it ends too early, and any other status again. After STEP_LIMIT feed the rest first.
 * O(1). */
microtin_status microtin_edge_marks_finish(microtin_edge_marks* marks);

/* Returns how many edges have marks; 0 until the marks are verified. O(1). */
uint32_t microtin_edge_marks_count(const microtin_edge_marks* marks);

/* Returns the class of the edge from vertex `corner` (0 .. 2) of triangle `t` to the next, a
 * microtin_line_class: MICROTIN_LINE_NONE if it has no mark, and until the marks are verified. Both
 * triangles at an edge return the same. O(1). */
uint32_t microtin_edge_marks_class(const microtin_edge_marks* marks, uint32_t t, uint32_t corner);

#ifdef __cplusplus
}
#endif

#endif
