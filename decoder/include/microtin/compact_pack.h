// SPDX-License-Identifier: MIT
/* microtin packs with compact slots: three times as many tiles in the same memory. C99 and C++.
 *
 * Such a pack decodes one tile at a time in a mesh of its own, and then makes it compact in its
 * slot. The tile that the slot held before stays until then. Interrupts, segments, reading and bad
 * tiles are as in pack.h. These functions of pack.h serve for both kinds of packs:
 * microtin_pack_reset, _align_reads, _next_read, _complete_read, _read_once, _bad_tile,
 * _clear_bad_tiles, _get_info, _axis_to_lattice. The others return WRONG_PACK_KIND for a pack with
 * compact slots, as those below do for a pack of pack.h.
 */
#ifndef MICROTIN_COMPACT_PACK_H
#define MICROTIN_COMPACT_PACK_H

#include "microtin/compact.h"
#include "microtin/pack.h"

/* Bytes of the workspace of a pack that decodes tiles of up to `capacity` vertices, and has `slots`
 * slots of `tile_bytes` each: a constant expression, also usable in #if. `microtin info` prints the
 * tile_bytes that a pack needs (microtin_pack_info::max_compact_bytes).
 * MICROTIN_COMPACT_BYTES(capacity) suffices for every pack that the encoder writes, and
 * MICROTIN_COMPACT_NARROW_BYTES(capacity) if tiles are less than 256 lattice steps wide and high.
 */
#define MICROTIN_COMPACT_PACK_BYTES(slots, capacity, tile_bytes) \
  MICROTIN_COMPACT_PACK_BYTES_FOR(slots, capacity, tile_bytes, MICROTIN_INDEX_BITS)
/* Bytes of the workspace in a build with `bits` bits of index width. */
#define MICROTIN_COMPACT_PACK_BYTES_FOR(slots, capacity, tile_bytes, bits)                     \
  (MICROTIN_PACK_OWN_BYTES + MICROTIN_PACK_ROUND(MICROTIN_DECODER_BYTES_FOR(capacity, bits)) + \
   MICROTIN_PACK_ROUND(MICROTIN_MESH_BYTES_FOR(capacity, bits)) +                              \
   (slots) * (24ul + MICROTIN_PACK_ROUND(tile_bytes)))

#ifdef __cplusplus
extern "C" {
#endif

#if MICROTIN_INDEX_BITS == 16 /* the name that the linker sees has the width: microtin.h */
#define microtin_compact_pack_init microtin_compact_pack_init_16
#else
#define microtin_compact_pack_init microtin_compact_pack_init_32
#endif

/* Makes a pack without tiles; parameters and results as those of microtin_pack_init. */
microtin_status microtin_compact_pack_init(void* workspace, size_t size, uint32_t slots,
                                           uint32_t capacity, uint32_t tile_bytes,
                                           microtin_pack** pack);

/* Loads the tiles that a segment touches, as microtin_pack_load does. `step_limit` also limits the
 * steps that make a tile compact: 16 steps of microtin_compactor_run count as one work unit. A tile
 * is bad if it takes more than tile_bytes (TOO_BIG), or more than the header states (MALFORMED). */
microtin_status microtin_compact_pack_load(microtin_pack* pack, const microtin_segment* segment,
                                           uint32_t step_limit);

/* Loads the tiles that a segment touches and reads what it needs by `read`, as
 * microtin_pack_load_with does. */
static inline microtin_status microtin_compact_pack_load_with(microtin_pack* pack,
                                                              const microtin_segment* segment,
                                                              microtin_read read, void* context,
                                                              uint32_t step_limit) {
  for (;;) {
    microtin_status status;
    int is_ready;
    if (!pack || !read) return MICROTIN_STATUS_ARGUMENT;
    is_ready = microtin_pack_read_once(pack, read, context);
    status = microtin_compact_pack_load(pack, segment, step_limit);
    if (status != MICROTIN_STATUS_NEED_INPUT || step_limit != 0 || !is_ready) return status;
  }
}

/* Finds the clearance of a path, and loads no tile that the index rules out, as
 * microtin_pack_search_path does. */
microtin_status microtin_compact_pack_search_path(microtin_pack* pack, const microtin_path* path,
                                                  uint32_t flags, microtin_path_search* search,
                                                  uint32_t step_limit);

/* Searches all at once, as microtin_pack_search_path_with does. */
static inline microtin_status microtin_compact_pack_search_path_with(
    microtin_pack* pack, const microtin_path* path, uint32_t flags, microtin_path_search* search,
    microtin_read read, void* context) {
  for (;;) {
    microtin_status status;
    int is_ready;
    if (!pack || !read) return MICROTIN_STATUS_ARGUMENT;
    is_ready = microtin_pack_read_once(pack, read, context);
    status = microtin_compact_pack_search_path(pack, path, flags, search, 0);
    if (status != MICROTIN_STATUS_NEED_INPUT || !is_ready) return status;
  }
}

/* Returns between which heights the source lies, as microtin_pack_safe_heights_at does. */
microtin_query_result microtin_compact_pack_safe_heights_at(const microtin_pack* pack, int64_t x,
                                                            int64_t y, uint32_t* hint,
                                                            microtin_safe_heights* heights);

/* Returns the height at a position, as microtin_pack_height_at does. */
microtin_query_result microtin_compact_pack_height_at(const microtin_pack* pack, int64_t x,
                                                      int64_t y, uint32_t* hint, int32_t* height);

/* Finds the greatest and the least height on a segment, as microtin_pack_segment_extremes does. */
microtin_query_result microtin_compact_pack_segment_extremes(const microtin_pack* pack,
                                                             const microtin_segment* segment,
                                                             microtin_segment_extremes* extremes);

/* Finds the clearance of a path, as microtin_pack_path_clearance does. */
microtin_query_result microtin_compact_pack_path_clearance(const microtin_pack* pack,
                                                           const microtin_path* path,
                                                           microtin_path_clearance* clearance,
                                                           uint32_t flags);

/* Returns the places of a profile one after another, as microtin_pack_profile_next does. */
microtin_query_result microtin_compact_pack_profile_next(const microtin_pack* pack,
                                                         const microtin_segment* segment,
                                                         microtin_segment_state* state,
                                                         microtin_crossing* crossing);

/* Finds the gradient at a position, as microtin_pack_gradient_at does. */
microtin_query_result microtin_compact_pack_gradient_at(const microtin_pack* pack, int64_t x,
                                                        int64_t y, uint32_t* hint,
                                                        microtin_gradient* gradient);

/* Stores the heights at some positions, as microtin_pack_heights_at does. NOT_LOADED takes
 * precedence over all other results. */
microtin_query_result microtin_compact_pack_heights_at(const microtin_pack* pack,
                                                       const microtin_position* positions,
                                                       uint32_t count, uint32_t* hint,
                                                       int32_t* heights);

/* Finds the greatest and the least height of a grid, as microtin_pack_grid_extremes does.
 * NOT_LOADED takes precedence over all other results. */
microtin_query_result microtin_compact_pack_grid_extremes(const microtin_pack* pack,
                                                          const microtin_grid_spec* grid,
                                                          microtin_grid_extremes* extremes);

/* Stores the heights of a grid, as microtin_pack_sample_grid does. */
microtin_query_result microtin_compact_pack_sample_grid(const microtin_pack* pack,
                                                        const microtin_grid_spec* grid,
                                                        int16_t* heights);

#ifdef __cplusplus
}
#endif

#endif
