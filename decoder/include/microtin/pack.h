// SPDX-License-Identifier: MIT
/* microtin packs: a terrain in tiles, of which a device keeps a few. C99 and C++.
 *
 * Queries never read storage: they answer from the tiles that are there. microtin_pack_load_with,
 * called from where waiting is allowed, reads and decodes the tiles of a course, in pieces as small
 * as wanted, in the place of those least recently wanted.
 *
 * Who may interrupt whom: a query may run in an interrupt, or in a task of higher priority on the
 * same core, at any moment of microtin_pack_load_with, of the functions it calls, and of other
 * queries. It must be over before they go on. Otherwise (several cores, queries of lower priority)
 * the caller locks the pack.
 *
 * Places are global lattice coordinates with 8 fractional bits: 0 .. 256 * largest x. Nothing here
 * allocates, recurses, uses floating point or keeps global state.
 */
#ifndef MICROTIN_PACK_H
#define MICROTIN_PACK_H

#include "microtin/segment.h"

/* Bytes of the workspace of a pack that keeps `slots` tiles of up to `capacity` vertices: a
 * constant expression, also usable in #if. It must be aligned to MICROTIN_ALIGNMENT. A place can
 * lie in four tiles at once, so four slots or more are advised. */
#define MICROTIN_PACK_BYTES(slots, capacity) \
  MICROTIN_PACK_BYTES_FOR(slots, capacity, MICROTIN_INDEX_BITS)
#define MICROTIN_PACK_BYTES_FOR(slots, capacity, bits)                       \
  (472ul + MICROTIN_PACK_ROUND(MICROTIN_DECODER_BYTES_FOR(capacity, bits)) + \
   (slots) * (24ul + MICROTIN_PACK_ROUND(MICROTIN_MESH_BYTES_FOR(capacity, bits))))
#define MICROTIN_PACK_ROUND(bytes) (((bytes) + 7ul) / 8 * 8)

#ifdef __cplusplus
extern "C" {
#endif

#if MICROTIN_INDEX_BITS == 16 /* see microtin.h */
#define microtin_pack_init microtin_pack_init_16
#else
#define microtin_pack_init microtin_pack_init_32
#endif

typedef struct microtin_pack microtin_pack;

/* Lays out a pack without tiles in `workspace`, with `slots` (1 .. 255) slots for tiles of up to
 * `capacity` (3 .. MICROTIN_MAX_VERTICES) vertices, and sets *pack, to null if the status is not
 * OK: WORKSPACE_TOO_SMALL, see MICROTIN_PACK_BYTES; MISALIGNED; ARGUMENT. */
microtin_status microtin_pack_init(void* workspace, size_t size, uint32_t slots, uint32_t capacity,
                                   microtin_pack** pack);

/* Forgets all tiles, bad ones too, and the header, as after microtin_pack_init: another card. */
void microtin_pack_reset(microtin_pack* pack);

/* --- Reading and decoding. --- */

/* Reads up to `size` bytes (1 .. 128) of the pack at `offset` into `buffer`. Returns how many, at
 * least one; 0 if the pack ends there; a negative number if reading failed. */
typedef int32_t (*microtin_read)(void* context, uint64_t offset, uint8_t* buffer, size_t size);

/* From now on no read crosses a multiple of `sector`, a power of two up to 32768, so that each asks
 * for one sector of a card, and one that is kept is read from once; and the index is read for four
 * tiles of a row at a time, since going back to it costs a sector. 0, as at first: neither.
 * ARGUMENT: another number. */
microtin_status microtin_pack_align_reads(microtin_pack* pack, uint32_t sector);

/* Works towards having every tile that touches the course, first those where it begins, at most
 * `step_limit` decoding steps (as of microtin_decoder_feed) and one wish for input. The same
 * course, or another, may be asked for next.
 * - OK: they are there; queries on the course have answers
 * - NEED_INPUT: bytes are wanted: see microtin_pack_next_read
 * - STEP_LIMIT: call again
 * - BAD_TILES: they are there but for bad ones: see microtin_pack_bad_tile
 * - IO: reading failed; the same bytes stay wanted. Not of a tile that the course does not touch
 * - WORKSPACE_TOO_SMALL: the course touches more good tiles than there are slots; so many are there
 * - ARGUMENT: a null pointer, or too long a course
 * - STOPPED: a pack of compact_pack.h: a tile is decoded, and what makes it compact is there.
 *   Nothing is lost
 * - BAD_MAGIC, UNSUPPORTED_VERSION, MALFORMED: the header is not that of a pack, or damaged
 * - CHECKSUM: the header is damaged
 * - TRUNCATED: the pack ends within its header
 *
 * After these the next call begins anew. Tiles that are there stay until their slots are needed.
 * Besides the steps, O(columns + rows of tiles in the course's bounding box + slots^2); with more
 * bad tiles than are remembered, O((columns + rows) * slots).
 */
microtin_status microtin_pack_load(microtin_pack* pack, const microtin_segment* course,
                                   uint32_t step_limit);

/* Where the wanted bytes are, and where to put them; *size is 0 if none are wanted. */
void microtin_pack_next_read(microtin_pack* pack, uint64_t* offset, uint8_t** buffer, size_t* size);

/* What became of them, as microtin_read returns it: so many, the first ones, have been put there,
 * and the rest stays wanted; 0: the pack ends there; negative, or more than were wanted: reading
 * failed. The next microtin_pack_load tells. Nothing has to be said while one waits for bytes.
 */
void microtin_pack_complete_read(microtin_pack* pack, int32_t taken);

/* Reads what is wanted, if anything is, and tells. */
static inline void microtin_pack_fetch(microtin_pack* pack, microtin_read read, void* context) {
  uint64_t offset;
  uint8_t* buffer;
  size_t size;
  microtin_pack_next_read(pack, &offset, &buffer, &size);
  if (size != 0) microtin_pack_complete_read(pack, read(context, offset, buffer, size));
}

/* All together, with a function that reads. With a step limit at most one read (of 128 bytes at
 * most) and so many steps, and on NEED_INPUT call again; without (0) all that is needed. */
static inline microtin_status microtin_pack_load_with(microtin_pack* pack,
                                                      const microtin_segment* course,
                                                      uint32_t step_limit, microtin_read read,
                                                      void* context) {
  for (;;) {
    microtin_status status;
    if (!pack || !read) return MICROTIN_STATUS_ARGUMENT;
    microtin_pack_fetch(pack, read, context);
    status = microtin_pack_load(pack, course, step_limit);
    if (status != MICROTIN_STATUS_NEED_INPUT || step_limit != 0) return status;
  }
}

/* --- Bad tiles: damaged, breaking a rule, another pack's, beyond the end, or too big for a slot.
 * They are passed over and not tried again while they are remembered. --- */

/* So many are remembered: of more, those that were wanted last. If one course touches more, the
 * others cost an attempt each time it is served to its end; they keep no good tile from coming. */
#define MICROTIN_PACK_MAX_BAD_TILES 8

/* Place `i` < MICROTIN_PACK_MAX_BAD_TILES, in no order: returns 1 if a bad tile is remembered
 * there, with its number and a microtin_status:
 * - CHECKSUM: what was read is damaged, is another tile's or another pack's, or no stream that can
 *   be decoded: only a whole one tells whether it is the right one
 * - MALFORMED: it is undamaged and breaks a rule of packs
 * - TOO_BIG: what lies in its place has more vertices than a slot holds
 * - TRUNCATED: the pack ends before it does
 *
 * Else returns 0. */
int microtin_pack_bad_tile(const microtin_pack* pack, uint32_t i, uint32_t* tile, uint32_t* why);

/* Forgets the bad tiles, so that they are tried again. */
void microtin_pack_clear_bad_tiles(microtin_pack* pack);

/* --- What the header says; valid once microtin_pack_load got past it. --- */

typedef struct microtin_pack_info {
  uint32_t x_max, y_max;            /* steps */
  uint16_t tile_width, tile_height; /* steps */
  uint32_t most_vertices;           /* of a tile: the capacity needed */
  uint32_t compact_bytes;           /* of a tile, see compact_pack.h: with 16-bit numbers if these
                                       reach for most_vertices; 0: not stated */
  int16_t lowest, highest;          /* vertex */
  microtin_axis x, y, z;            /* of global lattice numbers */
} microtin_pack_info;

/* Returns 1, or 0 if the header is not known yet. */
int microtin_pack_get_info(const microtin_pack* pack, microtin_pack_info* info);

/* As microtin_axis_to_lattice, for places of a pack, 0 .. `most` steps: `value` / `per_unit` units
 * on an axis. Returns 1, or 0 when the place lies outside (below 0 also if it would be rounded to
 * 0), per_unit outside 1 .. 2^24, the axis' numerator is 2^30 or more or its offset outside +-2^61.
 * Exact: integers only. */
int microtin_pack_axis_to_lattice(const microtin_axis* axis, uint32_t most, int64_t value,
                                  uint32_t per_unit, int64_t* lattice);

/* --- Queries. NOT_LOADED: a tile that is needed is not there; ask microtin_pack_load for it.
 * BAD_TILE: none is missing but bad ones. OUTSIDE: (partly) outside 0 .. 256 * largest x or y.
 * VOID: the terrain is not known there. --- */

/* As microtin_mesh_height_at: z steps with 16 fractional bits. A place on a border has the height
 * that any of its tiles knows. At most four times the steps of microtin_mesh_height_at. */
microtin_query_result microtin_pack_height_at(const microtin_pack* pack, int64_t x, int64_t y,
                                              uint32_t* hint, int32_t* height);

/* The greatest height on the course: exact, rounded once, found where it crosses edges. OK:
 * every place of it, its ends and those between lattice places too, has a height by
 * microtin_pack_height_at. VOID, BAD_TILE: a part of it, be it a point, has none; *height is
 * that of the rest, INT32_MIN if there is none. Looks at every triangle of the tiles that the
 * course touches. OUTSIDE: also of a course that is too long. */
microtin_query_result microtin_pack_segment_max(const microtin_pack* pack,
                                                const microtin_segment* course, int32_t* height);

/* As microtin_mesh_sample_grid. NOT_LOADED is told before all other answers. */
microtin_query_result microtin_pack_sample_grid(const microtin_pack* pack,
                                                const microtin_grid_spec* block, int16_t* heights);

#ifdef __cplusplus
}
#endif

#endif
