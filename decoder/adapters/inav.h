// SPDX-License-Identifier: MIT
/* INAV's terrain functions, served by a pack. Written from the contract of
 * src/main/terrain/terrain_nav.h (INAV 10): a result is a plain yes or no, values are written on
 * yes alone, nothing waits, and what is missing is scheduled for loading.
 *
 * Places are in 1e-7 degrees. Not part of the library; float at the signatures only. */
#ifndef MICROTIN_ADAPTERS_INAV_H
#define MICROTIN_ADAPTERS_INAV_H

#include <stdbool.h>

#include "card.h"

#define MICROTIN_INAV_STEP 30000 /* millimetres between samples of a look ahead */
#define MICROTIN_INAV_SAMPLES 64

/* Milliseconds for which the last known height below the vehicle is fresh. */
#ifndef MICROTIN_INAV_FRESH_MS
#define MICROTIN_INAV_FRESH_MS 500
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef struct microtin_inav {
  microtin_spots spots;
  microtin_spot here;
  uint32_t known_at; /* milliseconds: when the height below the vehicle was known */
  uint8_t has_here, was_known;
  volatile uint8_t status; /* of the last service */
} microtin_inav;

/* terrainInit: begins without tiles. The pack is loaded by microtin_inav_load alone. After another
 * card was inserted, call microtin_pack_reset and this function again while no task queries. */
void microtin_inav_init(microtin_inav* inav, microtin_pack* pack);

/* loadGridToCacheTask, for the task that may read the card: loads a piece of what is requested,
 * with the statuses of microtin_requests_load. Difference: failures of the card do not end terrain
 * for good; the next call tries again. */
microtin_status microtin_inav_load(microtin_inav* inav, uint32_t step_limit, microtin_read read,
                                   void* context);

/* loadGridToCacheTask for a card that never waits (card.h), as AsyncFatFs is: loads a piece of what
 * is requested, with the statuses of microtin_requests_load. */
microtin_status microtin_inav_load_card(microtin_inav* inav, microtin_card* card,
                                        uint32_t step_limit);

/* The part of terrainUpdateTask that has gpsSol.llh: this place comes first, the way ahead next,
 * all other places in turn. Call it in each update. */
void microtin_inav_set_position(microtin_inav* inav, int32_t lat, int32_t lon);

/* posControl.gpsOrigin. terrainUpdateTask keeps its height, and so does this adapter: the height at
 * exactly this place stays known from its first result on. */
void microtin_inav_set_home(microtin_inav* inav, int32_t lat, int32_t lon);

/* terrainNavIsHealthy: the last service found the card, home's height is known, and the height
 * below the vehicle was known at most MICROTIN_INAV_FRESH_MS ago. `now_ms` is millis(). Call it in
 * each update: it queries both heights. Differences: it recovers when the card is back; whether
 * terrain is enabled is the firmware's matter. */
bool microtin_inav_is_healthy(microtin_inav* inav, uint32_t now_ms);

/* terrainNavGetHeightAtLocation, and terrainNavGetHomeTerrainHeight at home: the terrain in metres.
 * Difference: the height is that of the surface, and not interpolated between posts 30 m apart. */
bool microtin_inav_height(microtin_inav* inav, int32_t lat, int32_t lon, float* height_m);

typedef struct microtin_inav_look {
  float climb_needed_m;   /* beyond what climb_ratio gives, 0 or more */
  float escape_deficit_m; /* the same beyond escape_ratio */
  uint8_t samples_total, samples_missed;
} microtin_inav_look;

/* terrainNavLookahead: every 30 m of a way, 64 times at most. Ratios are metres of climb for each
 * metre of way; the bearing is in degrees, any number of turns; the distance is in metres. No: the
 * terrain below is not known, or the bearing is not a number. Differences: the position is a
 * parameter, and the firmware calls microtin_inav_is_healthy first. */
bool microtin_inav_lookahead(microtin_inav* inav, int32_t lat, int32_t lon, float bearing_deg,
                             float distance_m, float climb_ratio, float escape_ratio,
                             microtin_inav_look* look);

/* Requests the terrain between two waypoints, or at a safe home, which is both. No: not noted,
 * because six other requests wait or the header is not loaded; request it again. INAV has no such
 * function. */
bool microtin_inav_request(microtin_inav* inav, int32_t lat, int32_t lon, int32_t lat_end,
                           int32_t lon_end);

/* For isNavigationBlocked and the arming flags: whether the pack has the terrain of a leg of the
 * mission, and whether its bytes are whole. Results as those of microtin_spots_check. Call it in
 * the task that calls microtin_inav_load. INAV has no such function. */
microtin_status microtin_inav_check(microtin_inav* inav, int32_t lat, int32_t lon, int32_t lat_end,
                                    int32_t lon_end, microtin_pack_check* check, microtin_read read,
                                    void* context);

#ifdef __cplusplus
}
#endif

#endif
