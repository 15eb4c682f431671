// SPDX-License-Identifier: MIT
/* INAV's questions about terrain, answered by a pack. Written from the contract of
 * src/main/terrain/terrain_nav.h (INAV 10): an answer is a plain yes or no, values are written on
 * yes alone, nothing waits, and what is missing is scheduled for loading. A firmware's
 * terrainNavGetHeightAtLocation and terrainNavLookahead call these with what they are given.
 *
 * Not part of the library; float at the signatures only. */
#ifndef MICROTIN_ADAPTERS_INAV_H
#define MICROTIN_ADAPTERS_INAV_H

#include <stdbool.h>

#include "spots.h"

#define MICROTIN_INAV_STEP 30000 /* millimetres between samples of a look ahead */
#define MICROTIN_INAV_SAMPLES 64

#ifdef __cplusplus
extern "C" {
#endif

typedef struct microtin_inav {
  microtin_spots spots;
} microtin_inav;

/* The pack is serviced by microtin_inav_load alone. Another card: microtin_pack_reset and this
 * once more, while nobody asks; else places are taken for those of the pack before. */
void microtin_inav_init(microtin_inav* inav, microtin_pack* pack);

/* To be called by the task that may read the card: see microtin_pack_load_with. */
microtin_status microtin_inav_load(microtin_inav* inav, uint32_t step_limit, microtin_read read,
                                   void* context);

/* The vehicle is here: this place comes first, the way ahead next, all other places in turn. The
 * terrain task calls it in each update. */
void microtin_inav_set_position(microtin_inav* inav, int32_t lat, int32_t lon);

/* Home is here: its height stays known from the first answer for exactly this place on. */
void microtin_inav_set_home(microtin_inav* inav, int32_t lat, int32_t lon);

/* Terrain in metres at a place in 1e-7 degrees. */
bool microtin_inav_height(microtin_inav* inav, int32_t lat, int32_t lon, float* height_m);

typedef struct microtin_inav_look {
  float climb_needed_m;   /* beyond what climb_ratio gives, 0 or more */
  float escape_deficit_m; /* the same beyond escape_ratio */
  uint8_t samples_total, samples_missed;
} microtin_inav_look;

/* Every 30 m of a way, 64 times at most. Ratios are metres of climb for each metre of way; bearings
 * may be any number of turns. No: the terrain below is not known, or the bearing is not a number.
 */
bool microtin_inav_lookahead(microtin_inav* inav, int32_t lat, int32_t lon, float bearing_deg,
                             float distance_m, float climb_ratio, float escape_ratio,
                             microtin_inav_look* look);

#ifdef __cplusplus
}
#endif

#endif
