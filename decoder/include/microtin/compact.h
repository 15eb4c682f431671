// SPDX-License-Identifier: MIT
/* microtin compact terrains: a decoded terrain in a third of the mesh's memory. C99 and C++.
 *
 * A compact terrain is made from a mesh, which is lost by that, and answers the same queries with
 * the same answers; shared/docs/sizes.md compares what they cost. Its vertices and triangles have
 * other numbers than the mesh's, since they are counted along a path through all of them. It holds
 * no pointers: it may be copied and moved as a whole, to any place aligned to MICROTIN_ALIGNMENT.
 *
 * Nothing here allocates, recurses, uses floating point or keeps global state.
 */
#ifndef MICROTIN_COMPACT_H
#define MICROTIN_COMPACT_H

#include "microtin/segment.h"

/* Bytes of a compact terrain of so many vertices; NARROW if its places lie in a box less than 256
 * steps wide and high. Constant expressions, also usable in #if. The path passes vertices that it
 * cannot reach by taking a neighbour twice, which costs as much as two vertices: these macros allow
 * for as many as the encoder lets pass. A mesh that needs more is told by its status,
 * MICROTIN_STATUS_WORKSPACE_TOO_SMALL, before anything is changed. */
#define MICROTIN_COMPACT_BYTES(vertices) \
  MICROTIN_COMPACT_BYTES_FOR(vertices, 2ul, MICROTIN_INDEX_BITS)
#define MICROTIN_COMPACT_NARROW_BYTES(vertices) \
  MICROTIN_COMPACT_BYTES_FOR(vertices, 0ul, MICROTIN_INDEX_BITS)

/* The same for a build with the given index width: `wide` is 0 if narrow, else 2. And exactly, of a
 * terrain of which so many vertices are taken twice. */
#define MICROTIN_COMPACT_BYTES_FOR(vertices, wide, bits) \
  MICROTIN_COMPACT_BYTES_WITH(vertices, MICROTIN_COMPACT_REPEATS(vertices), wide, bits)
#define MICROTIN_COMPACT_BYTES_WITH(vertices, repeats, wide, bits) \
  (MICROTIN_COMPACT_HEADER_BYTES +                                 \
   ((vertices) + 1ul + (repeats)) * (4ul + (bits) / 8 * 2ul + (wide)) + (repeats) * ((bits) / 8))
#define MICROTIN_COMPACT_HEADER_BYTES 88ul
#define MICROTIN_COMPACT_REPEATS(vertices) (8ul + (vertices) / 64)

/* Scratch for making one, free again afterwards: less than the decoder's workspace of the same
 * capacity, which may be given when decoding is over. */
#define MICROTIN_COMPACTOR_BYTES(vertices)                      \
  (MICROTIN_COMPACTOR_HEADER_BYTES + ((vertices)*3ul + 7) / 8 + \
   MICROTIN_INDEX_BITS / 8 * ((vertices) + 2ul + MICROTIN_COMPACT_REPEATS(vertices)))
#define MICROTIN_COMPACTOR_HEADER_BYTES 280ul

/* As in microtin.h: the width is in the name that the linker sees. */
#if MICROTIN_INDEX_BITS == 16
#define microtin_compactor_init microtin_compactor_init_16
#else
#define microtin_compactor_init microtin_compactor_init_32
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct microtin_compact microtin_compact;
typedef struct microtin_compactor microtin_compactor;

/* --- Making --- */

/* Begins to make a compact terrain of a mesh that is complete and verified: after
 * MICROTIN_STATUS_OK, or MICROTIN_STATUS_STOPPED with 256 vertices or more. It will lie at the
 * start of `workspace`. That may be the mesh's own: give the mesh and its size. (There is room for
 * what the macros allow for, then, if the mesh's capacity is 64 or more; with less even what
 * microtin_compactor_required_bytes tells may not do.) `scratch` holds what is needed meanwhile.
 * Both must be aligned to MICROTIN_ALIGNMENT. Changes nothing but the scratch. OK, or MISALIGNED,
 * ARGUMENT, WORKSPACE_TOO_SMALL: the scratch cannot hold even what is needed to measure. O(1). */
microtin_status microtin_compactor_init(void* workspace, size_t size, microtin_mesh* mesh,
                                        void* scratch, size_t scratch_size,
                                        microtin_compactor** compactor);

/* Goes on for at most `step_limit` steps (0: no limit), each of O(1); STEP_LIMIT: call again. About
 * 17 steps a vertex, whatever the mesh at most 44. OK: *compact is the terrain, the mesh is empty
 * (or overwritten), and the scratch is free.
 *
 * The first third of the steps only looks at the mesh. If it ends with WORKSPACE_TOO_SMALL the mesh
 * is as it was, and microtin_compactor_required_bytes tells what would do. TOO_BIG, too: the mesh
 * is as it was, and the width of the numbers does not reach, if there are more than 16,383 vertices
 * and vertices taken twice. */
microtin_status microtin_compactor_run(microtin_compactor* compactor, uint32_t step_limit,
                                       microtin_compact** compact);

/* The bytes that the terrain takes, and those of the scratch, exactly; known from when
 * microtin_compactor_run said OK, WORKSPACE_TOO_SMALL or TOO_BIG, else 0. */
void microtin_compactor_required_bytes(const microtin_compactor* compactor, size_t* bytes,
                                       size_t* scratch_bytes);

/* The bytes that a compact terrain takes: what to copy. O(1). */
size_t microtin_compact_size(const microtin_compact* compact);

/* --- The terrain. Each call is O(1) if not said otherwise; numbers out of range are not checked.
 * A *repeat* is a vertex taken twice: terrains have few. --- */

uint32_t microtin_compact_vertex_count(const microtin_compact* compact);

/* Place and height of vertex `v` < microtin_compact_vertex_count. O(repeats). */
void microtin_compact_vertex(const microtin_compact* compact, uint32_t v, uint16_t* x, uint16_t* y,
                             int16_t* z);

/* Ghosts and, two for each repeat, triangles without area included. */
uint32_t microtin_compact_triangle_count(const microtin_compact* compact);

/* As microtin_mesh_triangle, of triangle `t` < microtin_compact_triangle_count;
 * MICROTIN_TRIANGLE_NO_AREA if it only fills the gap at a repeat: two of its corners are then the
 * same vertex. O(repeats) and the triangles up to the next that has two neighbours on the path,
 * usually few. */
microtin_triangle_kind microtin_compact_triangle(const microtin_compact* compact, uint32_t t,
                                                 uint32_t v[3]);

/* As microtin_mesh_digest: equal to that of the mesh. O(n). */
uint64_t microtin_compact_digest(const microtin_compact* compact);

/* As microtin_mesh_axes. */
void microtin_compact_axes(const microtin_compact* compact, microtin_axis* x, microtin_axis* y,
                           microtin_axis* z);

/* As microtin_mesh_height_at_limited, with the same answers. *hint is a number of a triangle; any
 * will do. A step is O(1) mostly; on meshes made for it O(n), but all steps of a walk are O(n log
 * n). Without a limit, a walk that has not arrived after 24 steps goes on from what
 * microtin_compact_hint would find, if that is nearer. */
microtin_query_result microtin_compact_height_at(const microtin_compact* compact, int32_t x,
                                                 int32_t y, uint32_t step_limit, uint32_t* hint,
                                                 int32_t* height);

/* As microtin_mesh_segment_max, microtin_mesh_segment_max_limited and microtin_mesh_sample_grid,
 * with the same answers. Steps are O(1) as those of microtin_compact_height_at are. */
microtin_query_result microtin_compact_segment_max(const microtin_compact* compact,
                                                   const microtin_segment* course, int32_t* height);
microtin_query_result microtin_compact_segment_max_limited(const microtin_compact* compact,
                                                           const microtin_segment* course,
                                                           uint32_t step_limit,
                                                           microtin_segment_state* progress,
                                                           int32_t* height);
microtin_query_result microtin_compact_sample_grid(const microtin_compact* compact,
                                                   const microtin_grid_spec* block,
                                                   int16_t* heights);

/* A hint for (x, y), given with 8 fractional bits, where none from nearby is at hand: by the
 * nearest of some vertices along the path, then of others beside that. Looks at about 22 vertices
 * and two for each halving of what lies between. */
uint32_t microtin_compact_hint(const microtin_compact* compact, int32_t x, int32_t y);

#ifdef __cplusplus
}
#endif

#endif
