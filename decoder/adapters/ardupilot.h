// SPDX-License-Identifier: MIT
/* ArduPilot's questions about terrain, answered by a pack. Written from the declarations of
 * libraries/AP_Terrain/AP_Terrain.h: height_amsl, lookahead, set_reference_location,
 * get_statistics, and blocks of 28 x 32 heights for what wants grids. Nothing waits; only
 * microtin_ardupilot_load reads, from the IO thread.
 *
 * Not part of the library; float at the signatures only. */
#ifndef MICROTIN_ADAPTERS_ARDUPILOT_H
#define MICROTIN_ADAPTERS_ARDUPILOT_H

#include <stdbool.h>

#include "spots.h"

#define MICROTIN_ARDUPILOT_ROWS 28 /* to the north */
#define MICROTIN_ARDUPILOT_COLUMNS 32
#define MICROTIN_ARDUPILOT_GROUPS 56    /* of 4 x 4 posts, one bit each */
#define MICROTIN_ARDUPILOT_SAMPLES 1000 /* of a look ahead, at most */

#ifdef __cplusplus
extern "C" {
#endif

/* A block: heights in metres, 0 where the bit of a group is not set. */
typedef struct microtin_ardupilot_block {
  microtin_spot corner; /* the south-west one */
  uint16_t spacing;     /* metres, 1 .. 1000 */
  uint64_t bitmap;      /* groups that are there; the lowest bits to the east first */
  uint8_t next;         /* group to try */
  int16_t height[MICROTIN_ARDUPILOT_ROWS][MICROTIN_ARDUPILOT_COLUMNS];
} microtin_ardupilot_block;

typedef struct microtin_ardupilot {
  microtin_spots spots;
  uint16_t spacing; /* metres between samples of a look ahead: TERRAIN_SPACING */
  microtin_spot reference;
  int32_t reference_altitude, most_correction; /* millimetres */
  int32_t correction;
  uint8_t has_reference, has_correction;
  uint8_t has_block; /* one was begun */
  uint16_t missed;   /* samples of the last look ahead that were not there */
  microtin_ardupilot_block block;
} microtin_ardupilot;

/* The pack is serviced by microtin_ardupilot_load alone. Another card: microtin_pack_reset and
 * this once more, while nobody asks; else places are taken for those of the pack before. */
void microtin_ardupilot_init(microtin_ardupilot* terrain, microtin_pack* pack, uint16_t spacing);

/* For the thread that may read the card: see microtin_pack_load_with. */
microtin_status microtin_ardupilot_load(microtin_ardupilot* terrain, uint32_t step_limit,
                                        microtin_read read, void* context);

/* The vehicle is here: this place comes first, the way ahead next, all other places in turn. Call
 * it in each update, as AP_Terrain::update does with the position of AHRS. */
void microtin_ardupilot_set_position(microtin_ardupilot* terrain, int32_t lat, int32_t lng);

/* Home is here: its height stays known from the first answer for exactly this place on. */
void microtin_ardupilot_set_home(microtin_ardupilot* terrain, int32_t lat, int32_t lng);

/* The vehicle stands on the ground here, at this altitude above mean sea level: corrected heights
 * agree with that, by `most` metres at most; 0: no correction. */
void microtin_ardupilot_set_reference(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                      int32_t altitude_cm, float most);

/* Terrain in metres above mean sea level, places in 1e-7 degrees. False: not known, and requested
 * if it can be. */
bool microtin_ardupilot_height_amsl(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                    float* height, bool corrected);

/* By how many metres the terrain ahead rises above a climb of climb_ratio from the terrain below; 0
 * if that is not known, or the bearing is not a number. Bearings may be any number of turns. Skips
 * what is missing: `missed` counts it. */
float microtin_ardupilot_lookahead(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                   float bearing, float distance, float climb_ratio);

/* Begins the block of a corner, which the firmware's own arithmetic finds. */
void microtin_ardupilot_begin_block(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                    uint16_t spacing);

/* Tries this many groups of 4 x 4 posts, each sixteen heights: true if all 56 are there. */
bool microtin_ardupilot_fill_block(microtin_ardupilot* terrain, uint32_t groups);

/* Groups of the block that are not there, and that are: AP_Terrain::get_statistics. 0 and 0 before
 * a block is begun. */
void microtin_ardupilot_statistics(const microtin_ardupilot* terrain, uint16_t* pending,
                                   uint16_t* loaded);

#ifdef __cplusplus
}
#endif

#endif
