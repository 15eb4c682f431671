// SPDX-License-Identifier: MIT
/* microtin packs whose tiles are kept in compact form: three times as many in the same memory. C99
 * and C++.
 *
 * One tile at a time is decoded, in a mesh of the pack's own, and made compact into its slot. So a
 * tile that is to go stays until then. All else is as in pack.h: who may interrupt whom, courses,
 * reading, bad tiles. Of its functions those that are missing here serve for these packs, too:
 * microtin_pack_reset, _align_reads, _wanted, _given, _bad_tile, _retry, _header, _to_lattice.
 */
#ifndef MICROTIN_COMPACT_PACK_H
#define MICROTIN_COMPACT_PACK_H

#include "microtin/compact.h"
#include "microtin/pack.h"

/* Bytes of the workspace of a pack that decodes tiles of up to `capacity` vertices and keeps
 * `slots` of them in `tile_bytes` each: what microtin_pack_info says of the pack, as `microtin
 * info` does (of builds with the width of numbers that is told there), or for any of our encoder's
 * packs MICROTIN_COMPACT_BYTES(capacity), and _NARROW_BYTES where tiles are less than 256 steps
 * wide and high. A constant expression, also usable in #if. */
#define MICROTIN_COMPACT_PACK_BYTES(slots, capacity, tile_bytes) \
  MICROTIN_COMPACT_PACK_BYTES_FOR(slots, capacity, tile_bytes, MICROTIN_INDEX_BITS)
#define MICROTIN_COMPACT_PACK_BYTES_FOR(slots, capacity, tile_bytes, bits)   \
  (472ul + MICROTIN_PACK_ROUND(MICROTIN_DECODER_BYTES_FOR(capacity, bits)) + \
   MICROTIN_PACK_ROUND(MICROTIN_MESH_BYTES_FOR(capacity, bits)) +            \
   (slots) * (24ul + MICROTIN_PACK_ROUND(tile_bytes)))

#ifdef __cplusplus
extern "C" {
#endif

#if MICROTIN_INDEX_BITS == 16 /* see microtin.h */
#define microtin_compact_pack_init microtin_compact_pack_init_16
#else
#define microtin_compact_pack_init microtin_compact_pack_init_32
#endif

/* As microtin_pack_init. */
microtin_status microtin_compact_pack_init(void* workspace, size_t size, uint32_t slots,
                                           uint32_t capacity, uint32_t tile_bytes,
                                           microtin_pack** pack);

/* As microtin_pack_load; `step_limit` holds for decoding, and for making compact: 16 steps of
 * microtin_compactor_run count as one. A tile that takes more than tile_bytes is a bad one,
 * TOO_BIG; MALFORMED, if it takes more than the pack's header says. Also ARGUMENT: a pack of
 * pack.h. */
microtin_status microtin_compact_pack_load(microtin_pack* pack, const microtin_segment* course,
                                           uint32_t step_limit);

/* As microtin_pack_load_with. */
static inline microtin_status microtin_compact_pack_load_with(microtin_pack* pack,
                                                              const microtin_segment* course,
                                                              uint32_t step_limit,
                                                              microtin_read read, void* context) {
  for (;;) {
    microtin_status status;
    if (!pack || !read) return MICROTIN_STATUS_ARGUMENT;
    microtin_pack_fetch(pack, read, context);
    status = microtin_compact_pack_load(pack, course, step_limit);
    if (status != MICROTIN_STATUS_NEED_INPUT || step_limit != 0) return status;
  }
}

/* As those of pack.h, with the same answers. NOT_LOADED, too: a pack of pack.h. */
microtin_query_result microtin_compact_pack_height_at(const microtin_pack* pack, int64_t x,
                                                      int64_t y, uint32_t* hint, int32_t* height);
microtin_query_result microtin_compact_pack_segment_max(const microtin_pack* pack,
                                                        const microtin_segment* course,
                                                        int32_t* height);
microtin_query_result microtin_compact_pack_sample_grid(const microtin_pack* pack,
                                                        const microtin_grid_spec* block,
                                                        int16_t* heights);

#ifdef __cplusplus
}
#endif

#endif
