// SPDX-License-Identifier: MIT
/* microtin: decodes terrain TINs exactly, in fixed memory. C99 and C++.
 *
 * Nothing here allocates, recurses, uses floating point or keeps global state. All memory comes
 * from the caller in two parts:
 *
 *   mesh     what queries need; one per terrain that is kept
 *   decoder  needed only while decoding; may be reused for one terrain after another
 *
 * Numbers called x, y and z are lattice integers: 0..65535 for x and y, int16_t for z. x grows
 * east, y grows north, z up. A stream's placement says what they mean in real units.
 *
 * Pointers must not be null; calls that can say MICROTIN_STATUS_ARGUMENT check theirs. A call that
 * changes an object must not run, say in an interrupt, while another uses the same. Costs are in
 * steps or in n, the vertices; shared/docs/sizes.md has instructions for several processors.
 */
#ifndef MICROTIN_MICROTIN_H
#define MICROTIN_MICROTIN_H

#include <stddef.h>
#include <stdint.h>

#include "microtin/config.h"

/* The version of this library; all else that tells it takes it from here. */
#define MICROTIN_VERSION_MAJOR 0
#define MICROTIN_VERSION_MINOR 1
#define MICROTIN_VERSION_PATCH 0

/* What holds for MICROTIN_INDEX_BITS, which config.h chooses. */
#define MICROTIN_MAX_VERTICES MICROTIN_MAX_VERTICES_FOR(MICROTIN_INDEX_BITS)
#define MICROTIN_MAX_VERTICES_FOR(index_bits) ((index_bits) == 16 ? 10923ul : 16777216ul)

/* Bytes of each workspace for up to `capacity` vertices: constant expressions, also usable in #if.
 * Both workspaces must be aligned to MICROTIN_ALIGNMENT. */
#define MICROTIN_ALIGNMENT 8
#define MICROTIN_MESH_BYTES(capacity) MICROTIN_MESH_BYTES_FOR(capacity, MICROTIN_INDEX_BITS)
#define MICROTIN_DECODER_BYTES(capacity) MICROTIN_DECODER_BYTES_FOR(capacity, MICROTIN_INDEX_BITS)

/* The same for a build with the given index width. Per vertex: six half-edges (origin and twin
 * each), x, y, z, and a void bit for each of two triangles; while decoding a queue entry, two marks
 * (a byte if numbers are wide) and a byte of height context. */
#define MICROTIN_MESH_BYTES_FOR(capacity, bits) \
  (159ul + (6ul + (bits) / 8 * 12ul) * (capacity) + ((capacity) + 3ul) / 4)
#define MICROTIN_DECODER_BYTES_FOR(capacity, bits) \
  ((bits) == 16 ? 2463ul + 3ul * (capacity) + ((capacity) + 3ul) / 4 : 2671ul + 6ul * (capacity))

/* Bytes of the buckets of microtin_buckets_init: a constant expression, side * side numbers. */
#define MICROTIN_BUCKETS_BYTES(side) (20ul + MICROTIN_INDEX_BITS / 8 * 1ul * (side) * (side))

/* Functions to which the width matters have it in the names that the linker sees. */
#if MICROTIN_INDEX_BITS == 16
#define microtin_read_stream_info microtin_read_stream_info_16
#define microtin_mesh_init microtin_mesh_init_16
#define microtin_decoder_init microtin_decoder_init_16
#define microtin_buckets_init microtin_buckets_init_16
#else
#define microtin_read_stream_info microtin_read_stream_info_32
#define microtin_mesh_init microtin_mesh_init_32
#define microtin_decoder_init microtin_decoder_init_32
#define microtin_buckets_init microtin_buckets_init_32
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The version of the library that is linked, as 65536 * major + 256 * minor + patch, and those of
 * the formats of streams and of packs that it reads: others are
 * MICROTIN_STATUS_UNSUPPORTED_VERSION. */
uint32_t microtin_version_number(void);
uint8_t microtin_stream_format_version(void);
uint8_t microtin_pack_format_version(void);

typedef enum microtin_status {
  MICROTIN_STATUS_OK = 0,         /* the whole stream is decoded and verified */
  MICROTIN_STATUS_NEED_INPUT = 1, /* every byte given was taken; more are needed */
  MICROTIN_STATUS_STEP_LIMIT = 2, /* the steps allowed for this call are used up; call again */
  MICROTIN_STATUS_STOPPED = 3, /* the phase asked for is complete; nothing more will be decoded */
  /* Errors. Once a decoder returns one but ARGUMENT, every further call returns it again; a pack
   * goes on, see microtin_pack_load. */
  MICROTIN_STATUS_BAD_MAGIC = 16, /* not a microtin stream */
  MICROTIN_STATUS_UNSUPPORTED_VERSION =
      17, /* a version of the format, or a part of it, unknown here */
  MICROTIN_STATUS_TOO_BIG =
      18, /* more vertices than the workspaces hold: see microtin_stream_info */
  MICROTIN_STATUS_CHECKSUM = 19,            /* the bytes were damaged */
  MICROTIN_STATUS_MALFORMED = 20,           /* undamaged bytes that break a rule of the format */
  MICROTIN_STATUS_TRUNCATED = 21,           /* microtin_decoder_finish: the stream ends too early */
  MICROTIN_STATUS_MISALIGNED = 22,          /* a workspace is not aligned to MICROTIN_ALIGNMENT */
  MICROTIN_STATUS_WORKSPACE_TOO_SMALL = 23, /* a workspace cannot hold even three vertices */
  MICROTIN_STATUS_ARGUMENT = 24,            /* a null pointer or a number out of range */
  /* Of packs alone. */
  MICROTIN_STATUS_IO = 25, /* reading failed; nothing is lost, and the next call tries again */
  MICROTIN_STATUS_BAD_TILES = 26, /* all tiles are there but bad ones: see microtin_pack_bad_tile */
  /* The host library only, see encoder.h. */
  MICROTIN_STATUS_REJECTED = 64,  /* a request that cannot be met, or a file that cannot be read */
  MICROTIN_STATUS_NO_MEMORY = 65, /* memory ran out */
  MICROTIN_STATUS_CANCELLED = 66, /* the caller's progress function cancelled the work */
  MICROTIN_STATUS_INTERNAL = 67   /* an internal fault of the library */
} microtin_status;

/* Its name, without MICROTIN_; "" where MICROTIN_NO_NAMES leaves names out, "?" if it is none. On
 * AVR the string lies in flash, as PSTR's do. */
const char* microtin_status_name(microtin_status status);

/* One axis: the real coordinate of lattice value k, in units, is (offset + numerator * k) /
 * denominator. */
typedef struct microtin_axis {
  int64_t offset;
  uint64_t numerator;   /* 1 .. 2^40 - 1 */
  uint64_t denominator; /* 1 .. 2^40 - 1 */
} microtin_axis;

/* What a stream's header says. */
typedef struct microtin_stream_info {
  uint32_t vertices;
  uint32_t header_bytes; /* fixed part, placement, notes and check together */
  uint8_t version;
  uint8_t degree;      /* most triangles around a vertex when it is inserted */
  uint8_t decoding;    /* how much it weighs places: 1 quick, 2 balanced, 3 dense */
  uint8_t has_heights; /* 0: every z is 0 */
  uint8_t has_voids;
  microtin_axis x, y, z; /* offset 0 and step 1 where the stream does not say */
  size_t mesh_bytes;     /* workspaces that this build needs for the stream; none will do for */
  size_t decoder_bytes;  /* more than MICROTIN_MAX_VERTICES */
} microtin_stream_info;

typedef struct microtin_mesh microtin_mesh;
typedef struct microtin_decoder microtin_decoder;
typedef struct microtin_buckets microtin_buckets;

/* Reads a stream's header from its first `size` bytes without decoding anything. NEED_INPUT: give
 * more; `info->header_bytes`, if not 0, says how many. OK: `info` is filled in and its check
 * passed. Errors: BAD_MAGIC, UNSUPPORTED_VERSION, CHECKSUM, MALFORMED, ARGUMENT. O(header bytes),
 * usually below 100. */
microtin_status microtin_read_stream_info(const uint8_t* bytes, size_t size,
                                          microtin_stream_info* info);

/* Types of notes: what a header says beside the terrain. format-stream.md, section 4, has the
 * content of each. */
typedef enum microtin_note_type {
  MICROTIN_NOTE_UNITS = 1,
  MICROTIN_NOTE_SYSTEMS = 2, /* EPSG codes */
  MICROTIN_NOTE_ORIGIN = 3,
  MICROTIN_NOTE_ACCURACY = 4,
  MICROTIN_NOTE_DATE = 5,
  MICROTIN_NOTE_LINEAGE = 6,
  MICROTIN_NOTE_WATER = 7,
  MICROTIN_NOTE_GRID = 8,
  MICROTIN_NOTE_WKT = 9,
  MICROTIN_NOTE_CLASSES = 10,
  MICROTIN_NOTE_DUPLICATES = 11,
  MICROTIN_NOTE_TRUE_PLACES = 12 /* accuracy there */
} microtin_note_type;

/* Finds a note in the header of a stream or of a pack, with which the `size` bytes begin. OK: the
 * header's check passed, and *content points to the note's *content_size bytes; it is null if there
 * is no such note. NEED_INPUT: give more; *content_size, if not 0, says how many bytes. Any other
 * status leaves null and 0: BAD_MAGIC, UNSUPPORTED_VERSION, CHECKSUM, ARGUMENT, or MALFORMED, also
 * if a note before reaches beyond the notes. A content may be longer than is known here: a later
 * version's. O(header bytes). */
microtin_status microtin_find_note(const uint8_t* bytes, size_t size, uint8_t type,
                                   const uint8_t** content, uint32_t* content_size);

/* Lays out an empty mesh in `workspace`, with the capacity that `size` bytes allow, and sets *mesh,
 * which points into it. OK, or WORKSPACE_TOO_SMALL, MISALIGNED, ARGUMENT. O(1). */
microtin_status microtin_mesh_init(void* workspace, size_t size, microtin_mesh** mesh);

/* Lays out a decoder that will fill `mesh` with the stream fed to it. The mesh is emptied; what
 * holds of its capacity and of the decoder's is the smaller. When decoding is over, the workspace
 * is free for other uses. OK, or WORKSPACE_TOO_SMALL, MISALIGNED, ARGUMENT. O(1). */
microtin_status microtin_decoder_init(void* workspace, size_t size, microtin_mesh* mesh,
                                      microtin_decoder** decoder);

/* Stop, with MICROTIN_STATUS_STOPPED, when `phase` phases (1, 2, ...) are complete: a coarse,
 * well-spread terrain. 0, the default, decodes everything. Phases that leave fewer than 256
 * vertices are verified together with the first that reaches them; stopped before, queries answer
 * with MICROTIN_FLAG_ALLOW_UNVERIFIED only. */
void microtin_decoder_stop_after_phase(microtin_decoder* decoder, uint32_t phase);

/* Decodes from the next `size` bytes of the stream, at most `step_limit` steps (0: no limit); a
 * step is at most nine triangles visited, with at most one insertion. (The step that starts a phase
 * also clears two bits per vertex; bytes of the header, and behind an error, are no steps.) *used
 * tells how many bytes were taken: all of them on NEED_INPUT; on STEP_LIMIT pass the rest again. On
 * OK the stream's last byte is the last one taken and anything behind it is left alone. Chunking
 * changes no result.
 *
 * Bytes are read where they are, once: a stream in memory-mapped flash can be passed whole, one in
 * a ring buffer from its oldest byte to where it wraps. Only a step's worth is kept between calls.
 * Errors: all but MISALIGNED and WORKSPACE_TOO_SMALL. */
microtin_status microtin_decoder_feed(microtin_decoder* decoder, const uint8_t* bytes, size_t size,
                                      uint32_t step_limit, size_t* used);

/* Tells the decoder that no byte will follow: NEED_INPUT becomes the error
 * MICROTIN_STATUS_TRUNCATED, any other status is told again. Not to be called after STEP_LIMIT:
 * feed the rest first. O(1). */
microtin_status microtin_decoder_finish(microtin_decoder* decoder);

/* Phases complete so far, and how many bytes of the stream were decoded: all that were taken but a
 * few that wait for more. O(1). */
uint32_t microtin_decoder_phase(const microtin_decoder* decoder);
uint64_t microtin_decoder_bytes_used(const microtin_decoder* decoder);

/* --- The mesh. Valid at any time; it holds the exact Delaunay triangulation of its vertices. Each
 * call is O(1) if not said otherwise; numbers out of range are not checked. --- */

#define MICROTIN_VERTEX_AT_INFINITY 0xFFFFFFFFul

/* Vertices decoded so far. */
uint32_t microtin_mesh_vertex_count(const microtin_mesh* mesh);

/* Place and height of vertex `v` < microtin_mesh_vertex_count. */
void microtin_mesh_vertex(const microtin_mesh* mesh, uint32_t v, uint16_t* x, uint16_t* y,
                          int16_t* z);

/* Triangles, ghosts included: 2n - 2, or 0 while the mesh is empty. */
uint32_t microtin_mesh_triangle_count(const microtin_mesh* mesh);

typedef enum microtin_triangle_kind {
  MICROTIN_TRIANGLE_REAL = 0,
  MICROTIN_TRIANGLE_VOID = 1, /* real, but without terrain; known once the stream is OK */
  MICROTIN_TRIANGLE_GHOST =
      2, /* outside: one vertex is MICROTIN_VERTEX_AT_INFINITY, the other two a hull edge */
  MICROTIN_TRIANGLE_NO_AREA = 3 /* of compact terrains only: to be passed over */
} microtin_triangle_kind;

/* The vertices of triangle `t` < microtin_mesh_triangle_count, counter-clockwise from above. */
microtin_triangle_kind microtin_mesh_triangle(const microtin_mesh* mesh, uint32_t t, uint32_t v[3]);

/* The triangle across the edge from vertex `corner` (0..2) of triangle `t` to the next. */
uint32_t microtin_mesh_neighbour(const microtin_mesh* mesh, uint32_t t, uint32_t corner);

/* A number that depends on the set of triangles alone, not on their order (format-stream.md,
 * "Digest"). Equal on every target. O(n). */
uint64_t microtin_mesh_digest(const microtin_mesh* mesh);

/* --- Heights --- */

typedef enum microtin_query_result {
  MICROTIN_QUERY_OK = 0,         /* a height was written */
  MICROTIN_QUERY_OUTSIDE = 1,    /* outside the hull */
  MICROTIN_QUERY_VOID = 2,       /* inside, but the terrain is not known there */
  MICROTIN_QUERY_NOT_LOADED = 3, /* the mesh is empty */
  MICROTIN_QUERY_UNVERIFIED = 4, /* the mesh holds vertices whose check has not passed yet */
  MICROTIN_QUERY_STEP_LIMIT = 5, /* the steps allowed for this call are used up; call again */
  MICROTIN_QUERY_BAD_TILE =
      6 /* of packs alone: a tile that is needed is damaged or breaks a rule */
} microtin_query_result;

/* As microtin_status_name. */
const char* microtin_query_result_name(microtin_query_result answer);

#define MICROTIN_FLAG_ALLOW_UNVERIFIED 1u /* flag: answer from vertices not yet verified too */

/* Height of the terrain at (x, y), given with 8 fractional bits (0 .. 65535 * 256): z with 16
 * fractional bits, the exact height of the plane rounded to nearest (halves up), the same from
 * either side of an edge. *height is written with MICROTIN_QUERY_OK only. Valid terrain wins over
 * void on a shared edge, and a vertex has its own height even among voids.
 *
 * *hint is the triangle where the walk starts and, afterwards, where it ended; start with 0, or
 * with what microtin_buckets_hint says, and keep it between calls. Any number will do. A step looks
 * at one triangle: at most microtin_mesh_triangle_count steps, whatever the stream; about sqrt(n)
 * from an arbitrary hint, one or two from a place nearby. Never MICROTIN_QUERY_STEP_LIMIT. */
microtin_query_result microtin_mesh_height_at(const microtin_mesh* mesh, int32_t x, int32_t y,
                                              uint32_t flags, uint32_t* hint, int32_t* height);

/* The same with at most `step_limit` steps (0: no limit). On MICROTIN_QUERY_STEP_LIMIT *hint is
 * where the walk stands: call again with the same place and hint. The bound on the steps holds for
 * all such calls together. */
microtin_query_result microtin_mesh_height_at_limited(const microtin_mesh* mesh, int32_t x,
                                                      int32_t y, uint32_t flags,
                                                      uint32_t step_limit, uint32_t* hint,
                                                      int32_t* height);

/* --- Buckets: where to start when no hint from nearby is at hand. Optional. --- */

/* Divides the box around the vertices into side x side equal buckets and keeps for each the number
 * of a triangle near its middle. `size` bytes of `workspace`, aligned to MICROTIN_ALIGNMENT, give
 * the largest side up to 1,024 with MICROTIN_BUCKETS_BYTES(side) <= size. About sqrt(n) buckets a
 * side leave few steps to walk. Costs O(n + side * side) steps on terrain, one walk per bucket in
 * the worst case. MICROTIN_STATUS_OK, or MICROTIN_STATUS_ARGUMENT, _MISALIGNED,
 * _WORKSPACE_TOO_SMALL.
 *
 * The buckets know the mesh as it was; when it has changed, their hints are still allowed, but far
 * away. */
microtin_status microtin_buckets_init(void* workspace, size_t size, const microtin_mesh* mesh,
                                      microtin_buckets** buckets);

/* A hint for (x, y), given with 8 fractional bits; places outside take the nearest bucket. O(1). */
uint32_t microtin_buckets_hint(const microtin_buckets* buckets, int32_t x, int32_t y);

/* --- Real units --- */

/* The placement of the decoded stream's axes; offset 0 and step 1 before its header's check has
 * passed. O(1). */
void microtin_mesh_axes(const microtin_mesh* mesh, microtin_axis* x, microtin_axis* y,
                        microtin_axis* z);

/* Converts a real coordinate, `value` / `per_unit` units (degrees as 1e-7 integers: per_unit =
 * 10000000), to the lattice with 8 fractional bits, rounded to nearest, for
 * microtin_mesh_height_at. Returns 1, or 0 when the place lies outside 0..65535, per_unit outside 1
 * .. 2^24, or the axis' offset outside +-2^61; *lattice is then left alone. Exact. A few 64-bit
 * divisions. */
int microtin_axis_to_lattice(const microtin_axis* axis, int64_t value, uint32_t per_unit,
                             int32_t* lattice);

/* The other way, for streams and packs: the real coordinate of a place with 8 fractional bits, in
 * units / `per_unit`, rounded to nearest, halves up. Returns 1, or 0 when per_unit lies outside
 * 1 .. 2^24, the axis' offset outside +-2^61, the place (in steps) times the axis' numerator
 * outside +-2^62, or the coordinate outside +-2^38 units; *value is then left alone. Exact. A few
 * 64-bit divisions. */
int microtin_axis_from_lattice(const microtin_axis* axis, int64_t lattice, uint32_t per_unit,
                               int64_t* value);

/* The same for a height with 16 fractional bits, on the z axis: with a per_unit of 1000, where the
 * unit is the metre, in millimetres. Returns 0 also if an int32_t does not hold it. */
int microtin_axis_height(const microtin_axis* z, int32_t height, uint32_t per_unit, int32_t* value);

#ifdef __cplusplus
}
#endif

#endif
