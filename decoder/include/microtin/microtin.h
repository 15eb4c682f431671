// SPDX-License-Identifier: MIT
/* microtin: decodes terrain TINs exactly, in fixed memory. C99 and C++.
 *
 * Nothing here allocates, recurses, uses floating point or keeps global state. All memory comes
 * from the caller in two parts:
 *
 *   mesh     what queries need; one for each terrain that is kept
 *   decoder  needed only while decoding; one terrain after another may use the same
 *
 * x, y and z are lattice integers: 0 .. 65535 for x and y, int16_t for z. x grows east, y grows
 * north, z grows upwards. The axes of a stream convert them to real units.
 *
 * Pointers must not be null; functions that return MICROTIN_STATUS_ARGUMENT check theirs. A call
 * that changes an object must not run while another call uses the same object, for example in an
 * interrupt. Costs are in walk steps, work units, or n, the number of vertices;
 * shared/docs/sizes.md has instructions for several processors.
 */
#ifndef MICROTIN_MICROTIN_H
#define MICROTIN_MICROTIN_H

#include <stddef.h>
#include <stdint.h>

#include "microtin/config.h"

/* The version of this library. Build files and other languages take it from here. */
#define MICROTIN_VERSION_MAJOR 1
/* The minor version of this library. */
#define MICROTIN_VERSION_MINOR 0
/* The patch version of this library. */
#define MICROTIN_VERSION_PATCH 0

/* Most vertices of a terrain with MICROTIN_INDEX_BITS, which config.h chooses. */
#define MICROTIN_MAX_VERTICES MICROTIN_MAX_VERTICES_FOR(MICROTIN_INDEX_BITS)
/* Most vertices of a terrain in a build with `index_bits` bits of index width. */
#define MICROTIN_MAX_VERTICES_FOR(index_bits) ((index_bits) == 16 ? 10923ul : 16777216ul)

/* Bytes of the workspaces for up to `capacity` vertices: constant expressions, also usable in #if.
 * Align both workspaces to MICROTIN_ALIGNMENT. */
#define MICROTIN_ALIGNMENT 8
/* Bytes of a mesh for up to `capacity` vertices. */
#define MICROTIN_MESH_BYTES(capacity) MICROTIN_MESH_BYTES_FOR(capacity, MICROTIN_INDEX_BITS)
/* Bytes of a decoder for up to `capacity` vertices. */
#define MICROTIN_DECODER_BYTES(capacity) MICROTIN_DECODER_BYTES_FOR(capacity, MICROTIN_INDEX_BITS)

/* Bytes of the workspaces in a build with `bits` bits of index width. A vertex takes six half-edges
 * (origin and twin each), x, y, z, and a void bit for each of two triangles. While decoding it also
 * takes a queue entry, two marks (a byte with 32-bit indices) and a byte of height context. */
#define MICROTIN_MESH_BYTES_FOR(capacity, bits) \
  (167ul + (6ul + (bits) / 8 * 12ul) * (capacity) + ((capacity) + 3ul) / 4)
/* Bytes of a decoder in a build with `bits` bits of index width. */
#define MICROTIN_DECODER_BYTES_FOR(capacity, bits) \
  ((bits) == 16 ? 2471ul + 3ul * (capacity) + ((capacity) + 3ul) / 4 : 2679ul + 6ul * (capacity))

/* Bytes of the buckets of microtin_buckets_init: a constant expression, side * side numbers. */
#define MICROTIN_BUCKETS_BYTES(side) (20ul + MICROTIN_INDEX_BITS / 8 * 1ul * (side) * (side))

/* Names that the linker sees: those of functions that depend on the index width contain it. */
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

/* Returns the version of the library that is linked, as 65536 * major + 256 * minor + patch. */
uint32_t microtin_version_number(void);

/* Returns the version of the format of streams that the library reads. For other versions functions
 * return MICROTIN_STATUS_UNSUPPORTED_VERSION. */
uint8_t microtin_stream_format_version(void);
/* Returns the version of the format of packs that the library reads. */
uint8_t microtin_pack_format_version(void);

/* The result of every function that can fail. 1 to 3 mean that there is more to do, 16 and above
 * are errors. A decoder that has returned an error other than ARGUMENT returns it again from every
 * further call. A pack continues after errors; see microtin_pack_load. */
typedef enum microtin_status {
  MICROTIN_STATUS_OK = 0,         /* done; for a stream: decoded and verified to its end */
  MICROTIN_STATUS_NEED_INPUT = 1, /* all bytes were taken; more are needed */
  MICROTIN_STATUS_STEP_LIMIT = 2, /* the step limit of this call was reached; call again */
  MICROTIN_STATUS_STOPPED = 3,    /* the requested phase is complete; decoding is over */
  MICROTIN_STATUS_BAD_MAGIC = 16, /* the bytes are not a microtin stream or pack */
  MICROTIN_STATUS_UNSUPPORTED_VERSION = 17, /* a format version, or a feature, unknown here */
  MICROTIN_STATUS_TOO_BIG = 18,             /* more vertices than the workspaces hold */
  MICROTIN_STATUS_CHECKSUM = 19,            /* the bytes are damaged */
  MICROTIN_STATUS_MALFORMED = 20,           /* undamaged bytes break a rule of the format */
  MICROTIN_STATUS_TRUNCATED = 21,           /* the stream or pack ends too early */
  MICROTIN_STATUS_MISALIGNED = 22,          /* a workspace is not aligned to MICROTIN_ALIGNMENT */
  MICROTIN_STATUS_WORKSPACE_TOO_SMALL = 23, /* a workspace or a pack is too small */
  MICROTIN_STATUS_ARGUMENT = 24,            /* a null pointer, or a number that is not allowed */
  MICROTIN_STATUS_IO = 25,                  /* reading storage failed; the next call tries again */
  MICROTIN_STATUS_BAD_TILES = 26,           /* a pack: all tiles but bad ones are loaded */
  MICROTIN_STATUS_OUT_OF_RANGE = 27,        /* a number or its conversion exceeds its range */
  MICROTIN_STATUS_NOT_FOUND = 28,       /* there is no such note, or no bad tile in this place */
  MICROTIN_STATUS_WRONG_PACK_KIND = 29, /* the pack has slots of the other kind */
  MICROTIN_STATUS_REJECTED = 64,  /* hosts: an impossible request, or a file that cannot be read */
  MICROTIN_STATUS_NO_MEMORY = 65, /* hosts: memory ran out */
  MICROTIN_STATUS_CANCELLED = 66, /* hosts: the caller's progress function cancelled the work */
  MICROTIN_STATUS_INTERNAL = 67   /* hosts: an internal fault of the library */
} microtin_status;

/* Returns the name of a status without MICROTIN_STATUS_; "?" for other numbers and for
 * statuses of hosts, and "" if MICROTIN_NO_NAMES is defined. On AVR the string lies in flash, as
 * those of PSTR do. */
const char* microtin_status_name(microtin_status status);

/* Converts lattice coordinates to real ones: coordinate k is (offset + numerator * k) / denominator
 * units. */
typedef struct microtin_axis {
  int64_t offset;
  uint64_t numerator;   /* 1 .. 2^40 - 1 */
  uint64_t denominator; /* 1 .. 2^40 - 1 */
} microtin_axis;

/* A margin that a stream does not state. */
#define MICROTIN_MARGIN_NOT_STATED 0xFFFFFFFFul

/* What a stream's header contains. */
typedef struct microtin_stream_info {
  uint32_t vertices;
  uint32_t header_bytes; /* of fixed part, placement, notes and check together */
  uint8_t version;       /* of the format */
  uint8_t max_degree;    /* most triangles around a vertex when it is inserted */
  uint8_t coding;        /* 1 quick, 2 balanced, 3 dense */
  uint8_t has_heights;   /* 0: every z is 0 */
  uint8_t has_voids;     /* 1: some triangles may be void */
  uint32_t below, above; /* the margins, as microtin_mesh_margins returns them */
  microtin_axis x, y, z; /* offset 0 and step 1 if the stream does not contain them */
  size_t mesh_bytes;     /* the mesh's workspace; beyond MICROTIN_MAX_VERTICES none suffices */
  size_t decoder_bytes;  /* the decoder's workspace; beyond MICROTIN_MAX_VERTICES none suffices */
} microtin_stream_info;

/* A mesh, which is a decoded terrain. Meshes, decoders and buckets lie in the caller's workspaces.
 */
typedef struct microtin_mesh microtin_mesh;
/* A decoder, which turns a stream into a mesh. */
typedef struct microtin_decoder microtin_decoder;
/* Hints for height queries at any position. */
typedef struct microtin_buckets microtin_buckets;

/* Reads a stream's header from its first `size` bytes. Decodes nothing. O(header bytes), usually
 * below 100.
 *
 * - OK: `info` is filled in, and the header's check has passed
 * - NEED_INPUT: pass more bytes; info->header_bytes is how many, if it is not 0
 * - BAD_MAGIC, UNSUPPORTED_VERSION, CHECKSUM, MALFORMED, ARGUMENT */
microtin_status microtin_read_stream_info(const uint8_t* bytes, size_t size,
                                          microtin_stream_info* info);

/* Types of notes: what a header contains besides the terrain. format-stream.md, section 4, defines
 * the content of each. */
typedef enum microtin_note_type {
  MICROTIN_NOTE_PADDING = 0, /* fills up; says nothing */
  MICROTIN_NOTE_UNITS = 1,
  MICROTIN_NOTE_SYSTEMS = 2, /* coordinate reference systems, as EPSG codes */
  MICROTIN_NOTE_ORIGIN = 3,
  MICROTIN_NOTE_ACCURACY = 4,
  MICROTIN_NOTE_DATE = 5,
  MICROTIN_NOTE_LINEAGE = 6,
  MICROTIN_NOTE_WATER = 7,
  MICROTIN_NOTE_GRID = 8,
  MICROTIN_NOTE_WKT = 9,
  MICROTIN_NOTE_CLASSES = 10,
  MICROTIN_NOTE_DUPLICATES = 11,
  MICROTIN_NOTE_TRUE_PLACES = 12, /* accuracy at the points' own positions */
  MICROTIN_NOTE_SURFACE = 13,     /* what kind of surface, and on which side of it the bound is */
  MICROTIN_NOTE_PHASES = 14,      /* of a stream: vertices, bytes, and largest error after each */
  MICROTIN_NOTE_DIGEST = 15,      /* of a stream's mesh, as microtin_mesh_digest returns it */
  MICROTIN_NOTE_SUMS = 16,        /* of a pack's tiles: their vertices, and how many have terrain */
  MICROTIN_NOTE_PLACES = 17,      /* of other streams and packs in the same file */
  MICROTIN_NOTE_BOUNDS = 18,      /* that samples have of their own */
  /* 64 to 127: about the source. */
  MICROTIN_NOTE_ATTRIBUTION = 64, /* a text to be shown to users */
  MICROTIN_NOTE_LICENSE = 65,
  MICROTIN_NOTE_EPOCH = 66,    /* of the coordinates */
  MICROTIN_NOTE_VALIDITY = 67, /* from when to when the terrain is valid */
  MICROTIN_NOTE_SOURCE_ACCURACY = 68
} microtin_note_type;

/* Finds a note in the header of a stream or of a pack; the `size` bytes begin with the header.
 * O(header bytes). The content may be longer than this version knows, in a later version's file.
 * The header's numbers are not compared with their ranges.
 *
 * - OK: *content points to the note's *content_size bytes; the header's check has passed
 * - NOT_FOUND: the header has no such note
 * - NEED_INPUT: pass more bytes; *content_size is how many, if it is not 0
 * - BAD_MAGIC, UNSUPPORTED_VERSION, CHECKSUM, ARGUMENT
 * - MALFORMED: the parts of the header, or the notes up to this one, do not fit their lengths
 *
 * *content is null unless the status is OK. */
microtin_status microtin_find_note(const uint8_t* bytes, size_t size, uint8_t type,
                                   const uint8_t** content, uint32_t* content_size);

/* Finds a note in a header that passes piece by piece. At most 64 bytes, so that a small device
 * need not hold the header, which may have 65 KB. */
typedef struct microtin_note_finder {
  uint8_t* buffer; /* the caller's */
  uint32_t capacity;
  uint32_t content_at;   /* where the content begins, from the start of the header */
  uint32_t content_size; /* bytes of the content: if more than the capacity, the rest is left out */
  /* What follows is the finder's own. */
  uint32_t crc, position, end, number, left;
  uint8_t identity[6];
  uint8_t type, note, part, status, verdict;
} microtin_note_finder;

/* Begins to find the first note of a type. Its content goes to `buffer`, as far as `capacity` bytes
 * hold it; a buffer of no bytes may be null. O(1). */
void microtin_note_finder_init(microtin_note_finder* finder, uint8_t type, uint8_t* buffer,
                               uint32_t capacity);

/* Takes the next `size` bytes of a stream or pack, from its first on. O(size).
 *
 * - NEED_INPUT: pass the following bytes
 * - OK: the note is found, and the header's check has passed. Only then do the buffer and the
 *   content's position and size have a meaning
 * - any other result of microtin_find_note */
microtin_status microtin_note_finder_feed(microtin_note_finder* finder, const uint8_t* bytes,
                                          size_t size);

/* Makes an empty mesh in `workspace`, with the capacity that `size` bytes allow, and sets *mesh,
 * which points into it. OK, or WORKSPACE_TOO_SMALL, MISALIGNED, ARGUMENT. O(1). */
microtin_status microtin_mesh_init(void* workspace, size_t size, microtin_mesh** mesh);

/* Makes a decoder that fills `mesh` with the stream that it is fed. The mesh becomes empty. The
 * smaller of the capacities of mesh and decoder limits the terrain. The workspace is free when
 * decoding has ended. OK, or WORKSPACE_TOO_SMALL, MISALIGNED, ARGUMENT. O(1). */
microtin_status microtin_decoder_init(void* workspace, size_t size, microtin_mesh* mesh,
                                      microtin_decoder** decoder);

/* Stops decoding with MICROTIN_STATUS_STOPPED when `phase` phases (1, 2, ...) are complete: the
 * terrain is then coarse and evenly spread. 0, the default, decodes everything. Phases with fewer
 * than 256 vertices are verified together with the first phase that reaches 256. Before that,
 * queries need MICROTIN_FLAG_ALLOW_UNVERIFIED. */
void microtin_decoder_stop_after_phase(microtin_decoder* decoder, uint32_t phase);

/* Decodes from the next `size` bytes of the stream, at most `step_limit` work units (0: no limit).
 * A work unit visits at most nine triangles and inserts at most one vertex. One that inserts a
 * vertex counts as two or three in turn, because it takes about as many times the instructions; a
 * call does at least one. (The work unit that begins a phase also clears two bits a vertex. Bytes
 * of the header, and bytes after an error, cost no work units.) *used is how many bytes were taken.
 *
 * - NEED_INPUT: all bytes were taken; pass the following ones
 * - STEP_LIMIT: call again with the bytes that were not taken
 * - OK: the terrain is complete and verified; bytes behind the stream's end were not taken
 * - STOPPED: see microtin_decoder_stop_after_phase
 * - any error but MISALIGNED and WORKSPACE_TOO_SMALL
 *
 * The decoder reads each byte once, where it lies: pass a stream in memory-mapped flash as a whole,
 * or a ring buffer from its oldest byte to where it wraps. How a stream is cut into calls changes
 * no result. */
microtin_status microtin_decoder_feed(microtin_decoder* decoder, const uint8_t* bytes, size_t size,
                                      size_t* used, uint32_t step_limit);

/* Ends the stream: no byte follows. Returns TRUNCATED instead of NEED_INPUT, and any other status
 * again. After STEP_LIMIT feed the rest first. O(1). */
microtin_status microtin_decoder_finish(microtin_decoder* decoder);

/* Returns how many phases are complete. O(1). */
uint32_t microtin_decoder_phase(const microtin_decoder* decoder);

/* Returns how many bytes of the stream are decoded: all that were taken but the last few. O(1). */
uint64_t microtin_decoder_bytes_used(const microtin_decoder* decoder);

/* --- The mesh. It is valid at any time, and holds the exact Delaunay triangulation of its
 * vertices. Each call is O(1) unless its comment states another cost. Indices are not checked. ---
 */

/* The third vertex of a ghost triangle. */
#define MICROTIN_VERTEX_AT_INFINITY 0xFFFFFFFFul

/* Returns how many vertices are decoded. */
uint32_t microtin_mesh_vertex_count(const microtin_mesh* mesh);

/* Returns position and height of vertex `v` < microtin_mesh_vertex_count. */
void microtin_mesh_vertex(const microtin_mesh* mesh, uint32_t v, uint16_t* x, uint16_t* y,
                          int16_t* z);

/* Returns the number of triangles with ghosts: 2n - 2, or 0 if the mesh is empty. */
uint32_t microtin_mesh_triangle_count(const microtin_mesh* mesh);

/* What a triangle is. */
typedef enum microtin_triangle_kind {
  MICROTIN_TRIANGLE_REAL = 0,
  MICROTIN_TRIANGLE_VOID = 1,   /* has no terrain; known when the status of the stream is OK */
  MICROTIN_TRIANGLE_GHOST = 2,  /* outside: a hull edge and MICROTIN_VERTEX_AT_INFINITY */
  MICROTIN_TRIANGLE_NO_AREA = 3 /* in compact terrains only: skip it */
} microtin_triangle_kind;

/* Returns kind and vertices of triangle `t` < microtin_mesh_triangle_count, counter-clockwise from
 * above. */
microtin_triangle_kind microtin_mesh_triangle(const microtin_mesh* mesh, uint32_t t, uint32_t v[3]);

/* Returns the triangle across the edge from vertex `corner` (0 .. 2) of triangle `t` to the next.
 */
uint32_t microtin_mesh_neighbour(const microtin_mesh* mesh, uint32_t t, uint32_t corner);

/* Returns a number that depends on the set of triangles and not on their order, equal on every
 * target; format-stream.md defines it ("Digest"). O(n). */
uint64_t microtin_mesh_digest(const microtin_mesh* mesh);

/* Returns the margins of the decoded stream, in sixteenths of a z step: how far the surface lies at
 * most below and above the surface of its source, at any position. (The source is the raster that
 * was encoded, interpolated bilinearly between posts; its own errors are not included.)
 * MICROTIN_MARGIN_NOT_STATED if the stream does not state a margin, and until it is decoded and
 * verified to its end; other values are at most 2^20. O(1). */
void microtin_mesh_margins(const microtin_mesh* mesh, uint32_t* below, uint32_t* above);

/* --- Heights --- */

/* The result of queries. */
typedef enum microtin_query_result {
  MICROTIN_QUERY_OK = 0,              /* the height was stored */
  MICROTIN_QUERY_OUTSIDE = 1,         /* outside the hull, or the pack */
  MICROTIN_QUERY_VOID = 2,            /* inside, but the terrain has no height there */
  MICROTIN_QUERY_NOT_LOADED = 3,      /* the mesh is empty, or the tile is not loaded */
  MICROTIN_QUERY_UNVERIFIED = 4,      /* a checksum of the mesh has not passed yet */
  MICROTIN_QUERY_STEP_LIMIT = 5,      /* the step limit of this call was reached; call again */
  MICROTIN_QUERY_BAD_TILE = 6,        /* a pack: the tile is damaged or breaks a rule */
  MICROTIN_QUERY_WRONG_PACK_KIND = 7, /* the pack has slots of the other kind */
  MICROTIN_QUERY_NO_MARGIN = 8        /* the stream does not state its margins */
} microtin_query_result;

/* Returns the name of a query result without MICROTIN_QUERY_, as microtin_status_name does. */
const char* microtin_query_result_name(microtin_query_result result);

/* A flag of queries: also use vertices whose checksum has not passed yet. */
#define MICROTIN_FLAG_ALLOW_UNVERIFIED 1u

/* Returns the height of the terrain at (x, y), 8 fractional bits each (0 .. 65535 * 256): z with 16
 * fractional bits, the exact height of the plane rounded to nearest, halves up. It is the same from
 * either side of an edge. On an edge between terrain and void the terrain counts, and a vertex has
 * its own height even among voids.
 *
 * *hint is the triangle where the walk begins, and where it has ended. Begin with 0 or with
 * microtin_buckets_hint, and keep it between calls; any number is allowed. A walk step looks at one
 * triangle. A walk takes one or two walk steps from a position nearby, about sqrt(n) from an
 * arbitrary hint, and never more than microtin_mesh_triangle_count.
 *
 * A call takes at most `step_limit` walk steps (0: no limit). After STEP_LIMIT call again with the
 * same position and hint. `flags` is 0 or MICROTIN_FLAG_ALLOW_UNVERIFIED. *height is stored only
 * with OK; the other results are OUTSIDE, VOID, NOT_LOADED, UNVERIFIED, STEP_LIMIT. */
microtin_query_result microtin_mesh_height_at(const microtin_mesh* mesh, int32_t x, int32_t y,
                                              uint32_t* hint, int32_t* height, uint32_t flags,
                                              uint32_t step_limit);

/* Between which heights the source lies at a position, in z steps with 8 fractional bits, both
 * rounded outwards: microtin_axis_from_lattice converts them. */
typedef struct microtin_safe_heights {
  int32_t lowest;  /* the surface's height less the margin above */
  int32_t highest; /* the surface's height plus the margin below */
} microtin_safe_heights;

/* Returns between which heights the source lies at (x, y): never above *highest, so that a vehicle
 * above it is above the source; see microtin_mesh_margins for what that does not include.
 * Parameters and results are those of microtin_mesh_height_at. NO_MARGIN: the stream does not state
 * both margins, or is not decoded to its end. *heights is stored only with OK. */
microtin_query_result microtin_mesh_safe_heights_at(const microtin_mesh* mesh, int32_t x, int32_t y,
                                                    uint32_t* hint, microtin_safe_heights* heights,
                                                    uint32_t flags, uint32_t step_limit);

/* --- Buckets: where a walk begins when no hint from nearby is known. Optional. --- */

/* Divides the box around the vertices into side x side equal buckets, and stores for each the
 * number of a triangle near its middle. `size` bytes of `workspace`, aligned to MICROTIN_ALIGNMENT,
 * allow the largest side up to 1,024 with MICROTIN_BUCKETS_BYTES(side) <= size. About sqrt(n)
 * buckets a side make walks short. The buckets describe the mesh as it is now: if it changes, their
 * hints stay allowed and become distant. Cost: O(n + side * side) walk steps on terrain, one walk
 * for each bucket in the worst case. OK, or ARGUMENT, MISALIGNED, WORKSPACE_TOO_SMALL. */
microtin_status microtin_buckets_init(void* workspace, size_t size, const microtin_mesh* mesh,
                                      microtin_buckets** buckets);

/* Returns a hint for (x, y), 8 fractional bits. Positions outside take the nearest bucket. O(1). */
uint32_t microtin_buckets_hint(const microtin_buckets* buckets, int32_t x, int32_t y);

/* --- Real units --- */

/* Returns the axes of the decoded stream; offset 0 and step 1 until its header's check has passed.
 * O(1). */
void microtin_mesh_axes(const microtin_mesh* mesh, microtin_axis* x, microtin_axis* y,
                        microtin_axis* z);

/* Converts a real coordinate, `value` / `per_unit` units, to the lattice with 8 fractional bits,
 * rounded to nearest, for microtin_mesh_height_at. For degrees as integers of 1e-7 degrees,
 * per_unit is 10000000. Exact; costs a few 64-bit divisions.
 *
 * - OK
 * - OUT_OF_RANGE: the position lies outside 0 .. 65535, per_unit outside 1 .. 2^24, or the axis'
 *   offset outside +-2^61; *lattice is unchanged */
microtin_status microtin_axis_to_lattice(const microtin_axis* axis, int64_t value,
                                         uint32_t per_unit, int32_t* lattice);

/* Converts a position with 8 fractional bits, of a stream or a pack, to a real coordinate in units
 * / `per_unit`, rounded to nearest, halves up. Exact; costs a few 64-bit divisions.
 *
 * - OK
 * - OUT_OF_RANGE: per_unit lies outside 1 .. 2^24, the axis' offset outside +-2^61, the position in
 *   lattice steps times the axis' numerator outside +-2^62, or the coordinate outside +-2^38 units;
 *   *value is unchanged */
microtin_status microtin_axis_from_lattice(const microtin_axis* axis, int64_t lattice,
                                           uint32_t per_unit, int64_t* value);

/* Converts a height with 16 fractional bits to units / `per_unit`: to millimetres if the unit of
 * the z axis is the metre and per_unit is 1000. Results as those of microtin_axis_from_lattice;
 * OUT_OF_RANGE also if int32_t does not hold the value. */
microtin_status microtin_axis_height(const microtin_axis* z, int32_t height, uint32_t per_unit,
                                     int32_t* value);

#ifdef __cplusplus
}
#endif

#endif
