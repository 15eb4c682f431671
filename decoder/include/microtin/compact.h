// SPDX-License-Identifier: MIT
/* microtin compact terrains: a decoded terrain in a third of the mesh's memory. C99 and C++.
 *
 * A compact terrain is made from a mesh, which is consumed, and answers the same queries with the
 * same results. Its vertices and triangles have other numbers than the mesh's, because they are
 * counted along a path through all of them. A compact terrain holds no pointers: a program may copy
 * or move it as a whole to any address aligned to MICROTIN_ALIGNMENT.
 *
 * Nothing here allocates, recurses, uses floating point or keeps global state.
 */
#ifndef MICROTIN_COMPACT_H
#define MICROTIN_COMPACT_H

#include "microtin/segment.h"

/* Bytes of a compact terrain of `vertices` vertices: constant expressions, also usable in #if.
 * NARROW is for positions in a box less than 256 lattice steps wide and high. A vertex that the
 * path passes twice costs as much as two. These macros allow for as many as the encoder allows. For
 * a mesh with more, microtin_compactor_run returns WORKSPACE_TOO_SMALL before it changes anything.
 */
#define MICROTIN_COMPACT_BYTES(vertices) \
  MICROTIN_COMPACT_BYTES_FOR(vertices, 2ul, MICROTIN_INDEX_BITS)
/* Bytes of a compact terrain in a box less than 256 lattice steps wide and high. */
#define MICROTIN_COMPACT_NARROW_BYTES(vertices) \
  MICROTIN_COMPACT_BYTES_FOR(vertices, 0ul, MICROTIN_INDEX_BITS)

/* Bytes of a compact terrain in a build with `bits` bits of index width; `wide` is 0 for a narrow
 * terrain, else 2. */
#define MICROTIN_COMPACT_BYTES_FOR(vertices, wide, bits) \
  MICROTIN_COMPACT_BYTES_WITH(vertices, MICROTIN_COMPACT_REPEATS(vertices), wide, bits)
/* Exact bytes of a compact terrain with `repeats` vertices that the path passes twice. */
#define MICROTIN_COMPACT_BYTES_WITH(vertices, repeats, wide, bits) \
  (MICROTIN_COMPACT_HEADER_BYTES +                                 \
   ((vertices) + 1ul + (repeats)) * (4ul + (bits) / 8 * 2ul + (wide)) + (repeats) * ((bits) / 8))
/* Bytes of the header of a compact terrain. */
#define MICROTIN_COMPACT_HEADER_BYTES 96ul
/* Vertices that the path may pass twice in terrains of the encoder. */
#define MICROTIN_COMPACT_REPEATS(vertices) (8ul + (vertices) / 64)

/* Bytes of scratch memory for making a compact terrain. The scratch is free afterwards. The
 * decoder's workspace for the same capacity is large enough, and free when decoding has ended. */
#define MICROTIN_COMPACTOR_BYTES(vertices)                      \
  (MICROTIN_COMPACTOR_HEADER_BYTES + ((vertices)*3ul + 7) / 8 + \
   MICROTIN_INDEX_BITS / 8 * ((vertices) + 2ul + MICROTIN_COMPACT_REPEATS(vertices)))
/* Bytes of the header of the scratch memory. */
#define MICROTIN_COMPACTOR_HEADER_BYTES 288ul

/* The index width is part of the name that the linker sees; see microtin.h. */
#if MICROTIN_INDEX_BITS == 16
#define microtin_compactor_init microtin_compactor_init_16
#else
#define microtin_compactor_init microtin_compactor_init_32
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* A compact terrain. */
typedef struct microtin_compact microtin_compact;
/* A compactor, which makes a compact terrain from a mesh. */
typedef struct microtin_compactor microtin_compactor;

/* --- Making a compact terrain --- */

/* Begins to make a compact terrain of a mesh that is complete and verified: decoding ended with
 * MICROTIN_STATUS_OK, or with MICROTIN_STATUS_STOPPED and 256 vertices or more.
 *
 * The compact terrain will lie at the start of `workspace`, `size` bytes. That may be the mesh's
 * own memory: pass the mesh and its size. (A mesh with a capacity of 64 or more has room for every
 * terrain that the macros above allow.) `scratch` holds what is needed until the terrain is made.
 * Both must be aligned to MICROTIN_ALIGNMENT. The call changes the scratch only. O(1).
 *
 * - OK: *compactor points into the scratch
 * - WORKSPACE_TOO_SMALL: the scratch cannot hold what measuring needs
 * - MISALIGNED, ARGUMENT */
microtin_status microtin_compactor_init(void* workspace, size_t size, microtin_mesh* mesh,
                                        void* scratch, size_t scratch_size,
                                        microtin_compactor** compactor);

/* Works for at most `step_limit` steps (0: no limit), each of O(1). A terrain takes about 17 steps
 * a vertex, and no more than 44. The first third of the steps only reads the mesh.
 *
 * - OK: *compact is the terrain; the mesh is empty or overwritten, and the scratch is free
 * - STEP_LIMIT: call again
 * - WORKSPACE_TOO_SMALL: the mesh is unchanged; microtin_compactor_required_bytes returns the sizes
 *   that suffice
 * - TOO_BIG: the mesh is unchanged; 16-bit indices do not suffice for more than 16,383 vertices and
 *   repeats */
microtin_status microtin_compactor_run(microtin_compactor* compactor, microtin_compact** compact,
                                       uint32_t step_limit);

/* Returns the exact sizes of the terrain and of the scratch. They are 0 before
 * microtin_compactor_run has returned OK, WORKSPACE_TOO_SMALL or TOO_BIG. O(1). */
void microtin_compactor_required_bytes(const microtin_compactor* compactor, size_t* bytes,
                                       size_t* scratch_bytes);

/* Returns the bytes that a compact terrain takes: copy as many to move it. O(1). */
size_t microtin_compact_size(const microtin_compact* compact);

/* --- The terrain. Each call is O(1) unless its comment states another cost. Indices are not
 * checked. A *repeat* is a vertex that the path passes twice; terrains have few. --- */

/* Returns the number of vertices. */
uint32_t microtin_compact_vertex_count(const microtin_compact* compact);

/* Returns position and height of vertex `v` < microtin_compact_vertex_count. O(repeats). */
void microtin_compact_vertex(const microtin_compact* compact, uint32_t v, uint16_t* x, uint16_t* y,
                             int16_t* z);

/* Returns the number of triangles, with ghosts and with two without area for each repeat. */
uint32_t microtin_compact_triangle_count(const microtin_compact* compact);

/* Returns kind and corners of triangle `t` < microtin_compact_triangle_count, counter-clockwise.
 * Two corners of a triangle of the kind MICROTIN_TRIANGLE_NO_AREA are the same vertex: skip it.
 * Cost: O(repeats) and the triangles up to the next one with two neighbours on the path, usually
 * few. */
microtin_triangle_kind microtin_compact_triangle(const microtin_compact* compact, uint32_t t,
                                                 uint32_t v[3]);

/* Returns the digest, which equals microtin_mesh_digest of the mesh. O(n). */
uint64_t microtin_compact_digest(const microtin_compact* compact);

/* Returns the axes of the terrain, as microtin_mesh_axes does for a mesh. */
void microtin_compact_axes(const microtin_compact* compact, microtin_axis* x, microtin_axis* y,
                           microtin_axis* z);

/* Returns the height at a position, with parameters and results of microtin_mesh_height_at. *hint
 * is a triangle's number; any number is allowed. A walk step is O(1) on terrain. On a mesh made to
 * be slow a walk step is O(n), but all steps of a walk together are O(n log n). Without a limit, a
 * walk that has not arrived after 24 steps continues from microtin_compact_hint if that is nearer.
 */
microtin_query_result microtin_compact_height_at(const microtin_compact* compact, int32_t x,
                                                 int32_t y, uint32_t* hint, int32_t* height,
                                                 uint32_t step_limit);

/* Returns the margins, as microtin_mesh_margins does for the mesh. */
void microtin_compact_margins(const microtin_compact* compact, uint32_t* below, uint32_t* above);

/* Returns between which heights the source lies, with parameters and results of
 * microtin_mesh_safe_heights_at. */
microtin_query_result microtin_compact_safe_heights_at(const microtin_compact* compact, int32_t x,
                                                       int32_t y, uint32_t* hint,
                                                       microtin_safe_heights* heights,
                                                       uint32_t step_limit);

/* Finds the greatest and the least height on a segment, with parameters and results of
 * microtin_mesh_segment_extremes. */
microtin_query_result microtin_compact_segment_extremes(const microtin_compact* compact,
                                                        const microtin_segment* segment,
                                                        microtin_segment_state* state,
                                                        microtin_segment_extremes* extremes,
                                                        uint32_t step_limit);

/* Returns the places of a profile one after another, with parameters and results of
 * microtin_mesh_profile_next. */
microtin_query_result microtin_compact_profile_next(const microtin_compact* compact,
                                                    const microtin_segment* segment,
                                                    microtin_segment_state* state,
                                                    microtin_crossing* crossing,
                                                    uint32_t step_limit);

/* Finds the clearance of a path, with parameters and results of microtin_mesh_path_clearance. */
microtin_query_result microtin_compact_path_clearance(const microtin_compact* compact,
                                                      const microtin_path* path,
                                                      microtin_segment_state* state,
                                                      microtin_path_clearance* clearance,
                                                      uint32_t flags, uint32_t step_limit);

/* Finds the gradient at a position, with parameters and results of microtin_mesh_gradient_at. */
microtin_query_result microtin_compact_gradient_at(const microtin_compact* compact, int32_t x,
                                                   int32_t y, uint32_t* hint,
                                                   microtin_gradient* gradient,
                                                   uint32_t step_limit);

/* Stores the heights at some positions, with parameters and results of microtin_mesh_heights_at. */
microtin_query_result microtin_compact_heights_at(const microtin_compact* compact,
                                                  const microtin_position* positions,
                                                  uint32_t count, uint32_t* hint, int32_t* heights);

/* Finds the greatest and the least height of a grid, as microtin_mesh_grid_extremes does. */
microtin_query_result microtin_compact_grid_extremes(const microtin_compact* compact,
                                                     const microtin_grid_spec* grid,
                                                     microtin_grid_extremes* extremes);

/* Stores the heights of a grid, with parameters and results of microtin_mesh_sample_grid. */
microtin_query_result microtin_compact_sample_grid(const microtin_compact* compact,
                                                   const microtin_grid_spec* grid,
                                                   int16_t* heights);

/* Returns a hint for (x, y), 8 fractional bits, for the first query in a region. Positions outside
 * the lattice take its nearest one. The function looks at about 22 vertices, and at two for each
 * halving of the path between them. */
uint32_t microtin_compact_hint(const microtin_compact* compact, int32_t x, int32_t y);

#ifdef __cplusplus
}
#endif

#endif
