// SPDX-License-Identifier: MIT
/* microtin packs: a terrain in tiles, a few of which a device holds in slots. C99 and C++.
 *
 * Queries never read storage: they answer from the tiles that are loaded. microtin_pack_load_with
 * loads the tiles that a segment touches. Call it where waiting is allowed. It reads and decodes in
 * pieces as small as you choose, and replaces the tiles that neither a query nor a call has used
 * for longest. If several places compete for the slots, use requests.h.
 *
 * Interrupts: a query may interrupt microtin_pack_load_with, the functions that it calls, and other
 * queries at any moment, from an interrupt or from a task of higher priority on the same core. The
 * query must end before the interrupted function continues. In all other cases (several cores,
 * queries of lower priority) the caller locks the pack, or the library does:
 *
 * Threads: if MICROTIN_PACK_ENTER and MICROTIN_PACK_LEAVE are defined (config.h), queries may run
 * at any time, on any core, while one loading call runs. A query takes the lock to pin the tile
 * that it uses, reads the tile without the lock, and takes the lock to unpin it. A loading call
 * never writes to a pinned slot: if there is no other, it returns STEP_LIMIT, and
 * microtin_pack_is_waiting returns 1. The lock is held while slots are compared, never while
 * reading or decoding. Functions other than queries and the loading call (init, reset, bad tiles,
 * checks, bounds) need a lock of your own.
 *
 * Positions are global lattice coordinates with 8 fractional bits: 0 .. 256 * x_max. Nothing here
 * allocates, recurses, uses floating point or keeps global state.
 */
#ifndef MICROTIN_PACK_H
#define MICROTIN_PACK_H

#include "microtin/segment.h"

/* Bytes of the workspace of a pack with `slots` slots for tiles of up to `capacity` vertices: a
 * constant expression, also usable in #if. Align the workspace to MICROTIN_ALIGNMENT. A position
 * can touch four tiles, so use four slots or more. */
#define MICROTIN_PACK_BYTES(slots, capacity) \
  MICROTIN_PACK_BYTES_FOR(slots, capacity, MICROTIN_INDEX_BITS)
/* Bytes of the workspace in a build with `bits` bits of index width. */
#define MICROTIN_PACK_BYTES_FOR(slots, capacity, bits)                                         \
  (MICROTIN_PACK_OWN_BYTES + MICROTIN_PACK_ROUND(MICROTIN_DECODER_BYTES_FOR(capacity, bits)) + \
   (slots) * (24ul + MICROTIN_PACK_ROUND(MICROTIN_MESH_BYTES_FOR(capacity, bits))))
/* Bytes of a pack itself, with its buffer for reads. */
#if MICROTIN_READ_ALIGNMENT > 1
#define MICROTIN_PACK_OWN_BYTES (640ul + MICROTIN_PACK_ROUND(MICROTIN_READ_ALIGNMENT))
#else
#define MICROTIN_PACK_OWN_BYTES 512ul
#endif
/* `bytes`, rounded up to a multiple of 8. */
#define MICROTIN_PACK_ROUND(bytes) (((bytes) + 7ul) / 8 * 8)

#ifdef __cplusplus
extern "C" {
#endif

#if MICROTIN_INDEX_BITS == 16 /* the name that the linker sees has the width: microtin.h */
#define microtin_pack_init microtin_pack_init_16
#else
#define microtin_pack_init microtin_pack_init_32
#endif

/* A pack: its header, and tiles in slots. */
typedef struct microtin_pack microtin_pack;

/* Makes a pack without tiles in `workspace`, `size` bytes, with `slots` (1 .. 255) slots for tiles
 * of up to `capacity` (3 .. MICROTIN_MAX_VERTICES) vertices. Sets *pack, to null unless the status
 * is OK. O(slots).
 *
 * - OK
 * - WORKSPACE_TOO_SMALL: see MICROTIN_PACK_BYTES
 * - MISALIGNED, ARGUMENT */
microtin_status microtin_pack_init(void* workspace, size_t size, uint32_t slots, uint32_t capacity,
                                   microtin_pack** pack);

/* Removes all tiles, the bad ones and the header from the pack: another card was inserted. */
void microtin_pack_reset(microtin_pack* pack);

/* --- Reading and decoding --- */

/* Your function that reads storage: up to `size` bytes (1 .. 128) of the pack at `offset` into
 * `buffer`. Returns one of
 *
 * - how many bytes it stored, at least one
 * - 0: the pack ends at `offset`
 * - MICROTIN_READ_NOT_READY: the bytes are not there yet; the pack requests them again
 * - another negative number: reading failed. If errors of the file system are sticky, as those of
 *   FatFs are, the next call must open the file again before it reads (decoder/examples/card.c)
 *
 * `buffer` is aligned to MICROTIN_READ_ALIGNMENT (config.h). */
typedef int32_t (*microtin_read)(void* context, uint64_t offset, uint8_t* buffer, size_t size);

/* What a microtin_read returns if the bytes are not there yet. */
#define MICROTIN_READ_NOT_READY (-2147483647 - 1)

/* Makes later reads suit a card with sectors of `sector` bytes, a power of two up to 32,768. No
 * read crosses a multiple of `sector`, and where tiles are loaded, one read brings the index of
 * four tiles of a row. 0, the default, does neither. OK, or ARGUMENT for another number; with
 * MICROTIN_NO_SECTORS (config.h) for all but 0. */
microtin_status microtin_pack_align_reads(microtin_pack* pack, uint32_t sector);

/* Loads the tiles that a segment touches, first those where it begins, without any reading of its
 * own: after NEED_INPUT pass what it needs by microtin_pack_next_read and
 * microtin_pack_complete_read. A call decodes at most `step_limit` work units (0: no limit; see
 * microtin_decoder_feed). The next call may pass the same segment or another: a tile that is begun
 * is finished first, so that segments may take turns. It is given up if it cannot be read, or if a
 * more important request needs another tile (requests.h).
 *
 * - OK: all tiles are loaded; queries on the segment have results
 * - NEED_INPUT: bytes are needed
 * - STEP_LIMIT: call again; see microtin_pack_is_waiting
 * - BAD_TILES: all tiles but bad ones are loaded; see microtin_pack_bad_tile
 * - IO: reading failed; the next call needs the same bytes. Not returned for bytes that the segment
 *   does not need
 * - WORKSPACE_TOO_SMALL: the segment touches more good tiles than there are slots; all slots are
 *   filled
 * - ARGUMENT: a null pointer, or a segment that is too long
 * - WRONG_PACK_KIND: a pack of compact_pack.h
 * - BAD_MAGIC: the bytes are not a pack
 * - UNSUPPORTED_VERSION: the pack is of another version of the format, or has an unknown flag
 * - MALFORMED, CHECKSUM, TRUNCATED: the header breaks a rule, is damaged, or ends too early
 *   (After these three and UNSUPPORTED_VERSION the next call reads the header again.)
 *
 * Loaded tiles stay until their slots are needed. Besides the work units, a call takes
 * O(columns + rows of tiles in the segment's bounding box + slots^2). */
microtin_status microtin_pack_load(microtin_pack* pack, const microtin_segment* segment,
                                   uint32_t step_limit);

/* Returns 1 if the last loading call found no slot because queries of other threads use them, else
 * 0. Always 0 without MICROTIN_PACK_ENTER (config.h). */
int microtin_pack_is_waiting(const microtin_pack* pack);

/* Returns which bytes the pack needs next, and where to store them; *size is 0 if it needs none.
 * *buffer is aligned to MICROTIN_READ_ALIGNMENT; with an alignment of 32 or more no variable shares
 * its cache lines of that size. */
void microtin_pack_next_read(microtin_pack* pack, uint64_t* offset, uint8_t** buffer, size_t* size);

/* Reports the result of a read, as microtin_read returns it: the number of bytes stored; 0 if the
 * pack ends there; MICROTIN_READ_NOT_READY, which changes nothing; another negative number, or more
 * than were needed, if reading failed. The next call that needs the bytes acts on it. While a read
 * is in progress, call no function that loads, checks, searches or finds bounds. */
void microtin_pack_complete_read(microtin_pack* pack, int32_t taken);

/* Reads what the pack needs next, if anything, by one call of `read`, and reports the result.
 * Returns 0 if the bytes are not ready, else 1. */
static inline int microtin_pack_read_once(microtin_pack* pack, microtin_read read, void* context) {
  int32_t taken = 0;
  uint64_t offset;
  uint8_t* buffer;
  size_t size;
  microtin_pack_next_read(pack, &offset, &buffer, &size);
  if (size != 0) {
    taken = read(context, offset, buffer, size);
    microtin_pack_complete_read(pack, taken);
  }
  return taken != MICROTIN_READ_NOT_READY;
}

/* Loads the tiles that a segment touches and reads what it needs by `read`. Returns a status of
 * microtin_pack_load. With a step limit a call makes at most one read: after NEED_INPUT or
 * STEP_LIMIT call again. Without a limit (0) one call does all, but for bytes that are not ready:
 * NEED_INPUT. */
static inline microtin_status microtin_pack_load_with(microtin_pack* pack,
                                                      const microtin_segment* segment,
                                                      microtin_read read, void* context,
                                                      uint32_t step_limit) {
  for (;;) {
    microtin_status status;
    int is_ready;
    if (!pack || !read) return MICROTIN_STATUS_ARGUMENT;
    is_ready = microtin_pack_read_once(pack, read, context);
    status = microtin_pack_load(pack, segment, step_limit);
    if (status != MICROTIN_STATUS_NEED_INPUT || step_limit != 0 || !is_ready) return status;
  }
}

/* --- Bad tiles: damaged, malformed, of another pack or another version of the format, truncated,
 * or too big for a slot. The pack skips them, and does not try them again while it remembers them.
 * --- */

/* How many bad tiles a pack remembers: those that a segment touched last. If a segment touches more
 * bad tiles, each of the others costs an attempt whenever the segment is loaded; good tiles are
 * loaded nevertheless. */
#define MICROTIN_PACK_MAX_BAD_TILES 8

/* Returns the bad tile in place `i` < MICROTIN_PACK_MAX_BAD_TILES, in no order: its number and, as
 * a microtin_status, the reason.
 *
 * - OK: *why is one of
 *   - CHECKSUM: what was read is damaged, is another tile's or another pack's, or is not a stream
 *   - UNSUPPORTED_VERSION: the tile is undamaged, and of a later version of the format, or has a
 *     property that this version does not have
 *   - MALFORMED: the tile is undamaged and breaks a rule of packs
 *   - TOO_BIG: the tile has more vertices, or takes more bytes, than a slot holds
 *   - TRUNCATED: the pack ends before the tile does
 * - NOT_FOUND: the place is empty */
microtin_status microtin_pack_bad_tile(const microtin_pack* pack, uint32_t i, uint32_t* tile,
                                       uint32_t* why);

/* Forgets the bad tiles, so that the pack tries them again. */
void microtin_pack_clear_bad_tiles(microtin_pack* pack);

/* --- Checks before the terrain is needed, for example before take-off --- */

/* What a check found so far. All zero to begin. */
typedef struct microtin_pack_check {
  uint32_t tiles;           /* checked */
  uint32_t without_terrain; /* of these: tiles that have no height anywhere */
  uint32_t bad;             /* of these: bad tiles; microtin_pack_bad_tile has the latest */
  uint32_t first_bad;       /* the number of the first bad tile, if there is one */
  uint32_t next;            /* the check's own */
  uint8_t is_inside;        /* 1: the whole segment or box lies in the pack */
} microtin_pack_check;

/* Checks that every tile that a segment touches is there and whole, for packs of both kinds: that
 * its entry and the start of its stream keep the rules, that its vertices fit a slot, and that its
 * bytes are those of which the pack states the hash. Decodes nothing, and changes no slot. It reads
 * by microtin_pack_next_read and microtin_pack_complete_read, as microtin_pack_load does; after
 * NEED_INPUT and IO call again with the same segment and check. A call handles at most one read,
 * and takes O(columns + rows of tiles in the segment's bounding box + slots^2). Any number of tiles
 * is allowed.
 *
 * - OK: done; no tile is bad
 * - BAD_TILES: done; check->bad tiles are bad
 * - NEED_INPUT, IO, ARGUMENT, and the statuses of a bad header: as microtin_pack_load
 *
 * A tile that is being loaded is loaded again from its beginning. A tile with terrain may be void
 * in parts: load it and query. */
microtin_status microtin_pack_check_segment(microtin_pack* pack, const microtin_segment* segment,
                                            microtin_pack_check* check);

/* Checks every tile of a box, of which `diagonal` joins two opposite corners; parameters, results
 * and cost are those of microtin_pack_check_segment. */
microtin_status microtin_pack_check_box(microtin_pack* pack, const microtin_segment* diagonal,
                                        microtin_pack_check* check);

/* Checks all at once: the tiles of a box if `is_box` is not 0, else those that a segment touches.
 * Reads by `read`. IO ends the check, as NEED_INPUT does if bytes are not ready; another call with
 * the same check continues it. */
static inline microtin_status microtin_pack_check_with(microtin_pack* pack,
                                                       const microtin_segment* area, int is_box,
                                                       microtin_pack_check* check,
                                                       microtin_read read, void* context) {
  for (;;) {
    microtin_status status;
    int is_ready;
    if (!pack || !read) return MICROTIN_STATUS_ARGUMENT;
    is_ready = microtin_pack_read_once(pack, read, context);
    status = is_box ? microtin_pack_check_box(pack, area, check)
                    : microtin_pack_check_segment(pack, area, check);
    if (status != MICROTIN_STATUS_NEED_INPUT || !is_ready) return status;
  }
}

/* --- Bounds of heights from the index, without decoding --- */

/* What the index states of an area so far. All zero to begin. */
typedef struct microtin_pack_bounds {
  microtin_pack_check check; /* counts of entries of the index; `bad` ones are damaged or absent */
  int16_t lowest, highest;   /* z steps: no vertex of the area's tiles is lower, none is higher.
                                They mean nothing if no tile has terrain */
} microtin_pack_bounds;

/* Finds between which heights the tiles lie that a segment touches, for packs of both kinds. Reads
 * 20 bytes of the index for each tile, and neither decodes nor changes a slot: much faster than
 * loading, if the answer suffices. Streams are not looked at; a tile with a damaged stream counts
 * like a whole one. How to call, cost and results are those of microtin_pack_check_segment, but
 * what is being loaded stays. */
microtin_status microtin_pack_bounds_on_segment(microtin_pack* pack,
                                                const microtin_segment* segment,
                                                microtin_pack_bounds* bounds);

/* Finds the same of the tiles of a box, as microtin_pack_check_box does. */
microtin_status microtin_pack_bounds_in_box(microtin_pack* pack, const microtin_segment* diagonal,
                                            microtin_pack_bounds* bounds);

/* Finds the bounds all at once, reading by `read`, as microtin_pack_check_with does. */
static inline microtin_status microtin_pack_bounds_with(microtin_pack* pack,
                                                        const microtin_segment* area, int is_box,
                                                        microtin_pack_bounds* bounds,
                                                        microtin_read read, void* context) {
  for (;;) {
    microtin_status status;
    int is_ready;
    if (!pack || !read) return MICROTIN_STATUS_ARGUMENT;
    is_ready = microtin_pack_read_once(pack, read, context);
    status = is_box ? microtin_pack_bounds_in_box(pack, area, bounds)
                    : microtin_pack_bounds_on_segment(pack, area, bounds);
    if (status != MICROTIN_STATUS_NEED_INPUT || !is_ready) return status;
  }
}

/* --- The clearance of a path, which loads no tile that the index rules out --- */

/* A flag of microtin_pack_search_path: only the first place where the terrain comes too near is
 * wanted. More tiles are ruled out. */
#define MICROTIN_FLAG_FIRST_ONLY 4u

/* What a search along a path found so far. All zero to begin. */
typedef struct microtin_path_search {
  microtin_path_clearance clearance; /* what is found, at the end of the search */
  uint32_t result;  /* a microtin_query_result at the end: OK; OUTSIDE: an end lies outside the
                       pack; BAD_TILE: a tile is bad; NO_MARGIN, and nothing is found */
  uint32_t tiles;   /* of the path, handled so far */
  uint32_t decoded; /* of these: tiles in which the path was compared with the terrain */
  uint32_t next;    /* the search's own, as all that follows */
  uint8_t needs_tile, has_bad;
  microtin_segment_state state;
} microtin_path_search;

/* Finds what microtin_pack_path_clearance finds if all tiles are loaded, exactly, but loads a tile
 * only if the index cannot rule it out. A tile is ruled out if the path is above its highest vertex
 * by the needed clearance and by the least clearance of the tiles before it. One slot suffices for
 * any number of tiles. Tiles in slots are not read again.
 *
 * `flags` is a sum of MICROTIN_FLAG_SAFE, with which the pack's margin rules out and each tile's
 * own counts, and MICROTIN_FLAG_FIRST_ONLY: then `least` stays INT32_MAX, and it does not count.
 * Voids have no height and do not count; a tile that is ruled out may have voids. The index is
 * trusted, as by microtin_pack_is_clear: if a tile is higher than it says, the tile may be missed.
 *
 * This is a loading call. Reads, step limit and statuses are those of microtin_pack_load. After
 * NEED_INPUT, STEP_LIMIT and IO call again with the same path, flags and search. With a step limit
 * a call walks through at most one tile.
 *
 * - OK: done; no entry of a tile is bad, and no stream that was needed
 * - BAD_TILES: done; search->clearance is that of the other tiles
 * - WORKSPACE_TOO_SMALL: requests of requests.h or queries of other threads use all slots
 * - ARGUMENT: also for numbers of the path outside their range */
microtin_status microtin_pack_search_path(microtin_pack* pack, const microtin_path* path,
                                          uint32_t flags, microtin_path_search* search,
                                          uint32_t step_limit);

/* Searches all at once, reading by `read`, as microtin_pack_load_with does without a limit. */
static inline microtin_status microtin_pack_search_path_with(microtin_pack* pack,
                                                             const microtin_path* path,
                                                             uint32_t flags,
                                                             microtin_path_search* search,
                                                             microtin_read read, void* context) {
  for (;;) {
    microtin_status status;
    int is_ready;
    if (!pack || !read) return MICROTIN_STATUS_ARGUMENT;
    is_ready = microtin_pack_read_once(pack, read, context);
    status = microtin_pack_search_path(pack, path, flags, search, 0);
    if (status != MICROTIN_STATUS_NEED_INPUT || !is_ready) return status;
  }
}

/* --- The header --- */

/* What a pack's header contains. Positions are global lattice coordinates. */
typedef struct microtin_pack_info {
  uint32_t x_max, y_max;            /* extent in lattice steps */
  uint16_t tile_width, tile_height; /* extent of a tile in lattice steps */
  uint32_t max_tile_vertices;       /* no tile has more vertices: the capacity that suffices */
  uint32_t max_compact_bytes;       /* most bytes of a compact tile, see compact_pack.h, with 16-bit
                                       indices if these suffice; 0: not stated */
  int16_t lowest, highest;          /* z steps: no vertex is lower, no vertex is higher */
  uint32_t below, above; /* the margins of all tiles, as microtin_mesh_margins has them */
  microtin_axis x, y, z; /* from lattice coordinates to real ones */
} microtin_pack_info;

/* Returns what the header contains. OK, or NEED_INPUT before microtin_pack_load has read it. */
microtin_status microtin_pack_get_info(const microtin_pack* pack, microtin_pack_info* info);

/* Whether an area's terrain is surely below `height`, in z steps with 16 fractional bits. `bounds`
 * are complete bounds of the area, `info` is the pack's. `flags` is 0, for the terrain in the pack,
 * or MICROTIN_FLAG_SAFE, for its source. Returns 1 if so. Returns 0 if it is not known: a tile
 * reaches that high, has no terrain or a bad entry; the area leaves the pack; or the pack states no
 * margin. Then load the tiles and use microtin_pack_path_clearance. Voids within tiles have no
 * height and do not count. */
static inline int microtin_pack_is_clear(const microtin_pack_bounds* bounds,
                                         const microtin_pack_info* info, int32_t height,
                                         uint32_t flags) {
  const microtin_pack_check* const check = &bounds->check;
  int64_t highest = bounds->highest, below = info->below;
  highest *= 65536;
  if ((flags & MICROTIN_FLAG_SAFE) != 0) {
    if (info->below == MICROTIN_MARGIN_NOT_STATED) return 0;
    highest += below * 4096;
  }
  return check->is_inside && check->tiles != 0 && check->without_terrain + check->bad == 0 &&
         highest < height;
}

/* Converts a real coordinate to the lattice of a pack, 0 .. `most` lattice steps with 8 fractional
 * bits. Parameters and rounding are those of microtin_axis_to_lattice. OK, or OUT_OF_RANGE: the
 * position lies outside, also if it would be rounded up to 0; or per_unit lies outside 1 .. 2^24,
 * the axis' numerator is 2^30 or more, or its offset is beyond +-2^61. *lattice is then unchanged.
 */
microtin_status microtin_pack_axis_to_lattice(const microtin_axis* axis, uint32_t most,
                                              int64_t value, uint32_t per_unit, int64_t* lattice);

/* --- Queries ---
 *
 * - OK: the height was stored
 * - NOT_LOADED: a tile that the query needs is not loaded; call microtin_pack_load
 * - BAD_TILE: a tile that the query needs is bad, and no other is missing
 * - OUTSIDE: a position lies outside 0 .. 256 * x_max or y_max
 * - VOID: the terrain has no height there
 * - WRONG_PACK_KIND: a pack of compact_pack.h */

/* Returns the height at a position, in z steps with 16 fractional bits; *hint as in
 * microtin_mesh_height_at. A position on a border of tiles has the height of any tile that has one.
 * At most four times the walk steps of microtin_mesh_height_at. */
microtin_query_result microtin_pack_height_at(const microtin_pack* pack, int64_t x, int64_t y,
                                              uint32_t* hint, int32_t* height);

/* Returns between which heights the source lies at a position, by the margins of its tile; see
 * microtin_mesh_safe_heights_at. Parameters and results are those of microtin_pack_height_at.
 * NO_MARGIN: the tile does not state both margins. */
microtin_query_result microtin_pack_safe_heights_at(const microtin_pack* pack, int64_t x, int64_t y,
                                                    uint32_t* hint, microtin_safe_heights* heights);

/* Finds the greatest and the least height on a segment, and where they are, as
 * microtin_mesh_segment_extremes does. On borders the heights of all tiles count. Of several places
 * with the same height on a border that the segment runs along it may return a later one.
 *
 * - OK: every position of the segment has a height by microtin_pack_height_at, also between lattice
 *   positions
 * - VOID, BAD_TILE, NOT_LOADED: a part of the segment, perhaps a point, has none; the heights are
 *   those of the rest
 * - OUTSIDE: an end lies outside the pack; the heights are those of the rest, or missing because
 *   the segment is too long
 * - WRONG_PACK_KIND: a pack of compact_pack.h
 *
 * `highest` is INT32_MIN and `lowest` INT32_MAX if no position has a height. The cost in each tile
 * that the segment touches is that of microtin_mesh_segment_extremes. */
microtin_query_result microtin_pack_segment_extremes(const microtin_pack* pack,
                                                     const microtin_segment* segment,
                                                     microtin_segment_extremes* extremes);

/* Finds the least clearance of a path, and the first place where the terrain comes too near, as
 * microtin_mesh_path_clearance does. `flags` is 0 or MICROTIN_FLAG_SAFE, with the margin of each
 * tile. Results are those of microtin_pack_segment_extremes, or NO_MARGIN, and nothing is found: a
 * tile on the segment does not state its margin. Only OK covers the whole path: with any other
 * result the clearance is that of the rest. Along a border of tiles `least_along` may be a later
 * one of several places with the least clearance; `first_along` is the first. */
microtin_query_result microtin_pack_path_clearance(const microtin_pack* pack,
                                                   const microtin_path* path,
                                                   microtin_path_clearance* clearance,
                                                   uint32_t flags);

/* Returns the places of the profile along a segment one after another, as
 * microtin_mesh_profile_next does, from the tiles that are loaded. A place on a border of tiles is
 * returned once, with the height of any tile that has one. The place where the segment leaves a
 * tile is left out if no tile has a height there.
 *
 * Begin with a state of zeros, and with another one when the segment changes. Tiles may be loaded
 * between two calls: places are returned from there on.
 *
 * - OK: *crossing is the next place; after the end it is the end again. Its `before` is the worst
 *   result of what lies between: NOT_LOADED, BAD_TILE, OUTSIDE (the pack) or VOID, in this order
 * - OUTSIDE: the segment is too long
 * - NOT_LOADED: the header is not loaded
 * - WRONG_PACK_KIND: a pack of compact_pack.h
 *
 * A call takes the walk steps to the next place, and O(columns + rows) of the tiles between. */
microtin_query_result microtin_pack_profile_next(const microtin_pack* pack,
                                                 const microtin_segment* segment,
                                                 microtin_segment_state* state,
                                                 microtin_crossing* crossing);

/* Finds the gradient at a position; see microtin_mesh_gradient_at. Of a position on a border of
 * tiles the triangles of all tiles count that are loaded. *hint becomes the triangle's number in
 * its tile. Results are those of microtin_pack_height_at. */
microtin_query_result microtin_pack_gradient_at(const microtin_pack* pack, int64_t x, int64_t y,
                                                uint32_t* hint, microtin_gradient* gradient);

/* Stores the heights at some positions, as microtin_mesh_heights_at does. NOT_LOADED takes
 * precedence over all other results. */
microtin_query_result microtin_pack_heights_at(const microtin_pack* pack,
                                               const microtin_position* positions, uint32_t count,
                                               uint32_t* hint, int32_t* heights);

/* Finds the greatest and the least height of a grid, as microtin_mesh_grid_extremes does.
 * NOT_LOADED takes precedence over all other results. */
microtin_query_result microtin_pack_grid_extremes(const microtin_pack* pack,
                                                  const microtin_grid_spec* grid,
                                                  microtin_grid_extremes* extremes);

/* Stores the heights of a grid, with parameters and results of microtin_mesh_sample_grid.
 * NOT_LOADED takes precedence over all other results. */
microtin_query_result microtin_pack_sample_grid(const microtin_pack* pack,
                                                const microtin_grid_spec* grid, int16_t* heights);

#ifdef __cplusplus
}
#endif

#endif
