// SPDX-License-Identifier: MIT
/* ArduPilot's terrain functions, served by a pack. Written from the declarations of
 * libraries/AP_Terrain/AP_Terrain.h. No function waits; microtin_ardupilot_load and
 * microtin_ardupilot_check read, in the IO thread.
 *
 * Places are in 1e-7 degrees. Not part of the library; float at the signatures only. */
#ifndef MICROTIN_ADAPTERS_ARDUPILOT_H
#define MICROTIN_ADAPTERS_ARDUPILOT_H

#include <stdbool.h>

#include "posts.h"

#define MICROTIN_ARDUPILOT_ROWS 28 /* to the north */
#define MICROTIN_ARDUPILOT_COLUMNS 32
#define MICROTIN_ARDUPILOT_GROUPS 56    /* of 4 x 4 posts, one bit each */
#define MICROTIN_ARDUPILOT_SAMPLES 1000 /* of a look ahead, at most */

#ifdef __cplusplus
extern "C" {
#endif

/* A block: heights in metres, 0 where the bit of a group is not set. */
typedef struct microtin_ardupilot_block {
  microtin_spot corner;           /* the south-west one: lat and lon of grid_block */
  microtin_posts posts;           /* the grid of its file: lat_degrees, lon_degrees and spacing */
  uint16_t grid_row, grid_column; /* grid_idx_x and grid_idx_y */
  uint64_t bitmap;                /* groups that are there; the lowest bits to the east first */
  uint8_t next;                   /* group to try */
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

/* Begins without tiles; `spacing` is TERRAIN_SPACING in metres, 0 stands for 100. The pack is
 * loaded by microtin_ardupilot_load alone. After another card was inserted, call
 * microtin_pack_reset and this function again while no thread queries. */
void microtin_ardupilot_init(microtin_ardupilot* terrain, microtin_pack* pack, uint16_t spacing);

/* AP_Terrain::io_timer, for the IO thread: loads a piece of what is requested, with the statuses of
 * microtin_requests_load. Difference: a call does a bounded piece of work, so call it several times
 * for each tick of the timer. */
microtin_status microtin_ardupilot_load(microtin_ardupilot* terrain, uint32_t step_limit,
                                        microtin_read read, void* context);

/* The part of AP_Terrain::update that has the position of AHRS: its place comes first, the way
 * ahead next, all other places in turn. Also computes the reference offset once the terrain at the
 * reference is known, as update_reference_offset does. Call it in each update. */
void microtin_ardupilot_set_position(microtin_ardupilot* terrain, int32_t lat, int32_t lng);

/* The home of AHRS. AP_Terrain::height_amsl caches its height, and so does this adapter: the height
 * at exactly this place stays known from its first result on. Difference: none. */
void microtin_ardupilot_set_home(microtin_ardupilot* terrain, int32_t lat, int32_t lng);

/* AP_Terrain::set_reference_location: the vehicle stands on the ground here, `altitude_cm` above
 * mean sea level. From when the terrain at this place is known, corrected heights have the offset
 * between the two, which is cached. `most` is TERRAIN_OFS_MAX in metres; 0: no correction.
 * Difference: the firmware checks that position and velocity are good before it calls this. */
void microtin_ardupilot_set_reference(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                      int32_t altitude_cm, float most);

/* TERRAIN_OFS_MAX changed, in metres. A cached offset is limited to it; 0 removes the offset, and a
 * later value above 0 computes it again, as update_reference_offset does. Difference: none. */
void microtin_ardupilot_set_offset_max(microtin_ardupilot* terrain, float most);

/* The reference_offset of log_terrain_data, in metres. False: there is none, and heights are not
 * corrected. Difference: none. */
bool microtin_ardupilot_reference_offset(microtin_ardupilot* terrain, float* offset);

/* AP_Terrain::height_amsl: the terrain in metres above mean sea level. False: not known, and
 * requested if it can be. Difference: the height is that of the surface, and not interpolated
 * between posts of TERRAIN_SPACING. */
bool microtin_ardupilot_height_amsl(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                    float* height, bool corrected);

/* AP_Terrain::lookahead: by how many metres the terrain ahead rises above a climb of climb_ratio
 * from the terrain below; 0 if that is not known. The bearing is in degrees, any number of turns;
 * the distance is in metres. Samples that are missing are skipped, and `missed` counts them.
 * Differences: the position is a parameter; a bearing that is not a number returns 0; there are at
 * most MICROTIN_ARDUPILOT_SAMPLES samples. */
float microtin_ardupilot_lookahead(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                   float bearing, float distance, float climb_ratio);

/* A part of AP_Terrain::update_mission_data and update_rally_data: requests the terrain between two
 * waypoints, or at a rally point, which is both. False: not noted, because six other requests wait
 * or the header is not loaded; request it again. Difference: the tiles of the whole leg are
 * requested, and not five places around each waypoint. */
bool microtin_ardupilot_request(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                int32_t lat_end, int32_t lng_end);

/* For AP_Terrain::pre_arm_checks: whether the pack has the terrain of a leg of the mission, and
 * whether its bytes are whole. Results as those of microtin_spots_check. Difference: it reads the
 * card, so call it in the IO thread, and not while microtin_ardupilot_load runs. */
microtin_status microtin_ardupilot_check(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                         int32_t lat_end, int32_t lng_end,
                                         microtin_pack_check* check, microtin_read read,
                                         void* context);

/* The block in which a place lies, as AP_Terrain::calculate_grid_info and find_grid_cache find it:
 * begins it without heights. `spacing` is in metres; 0 stands for that of microtin_ardupilot_init,
 * and more than 1000 for 1000. A block's corner finds that block, also if it was computed in single
 * precision. Difference: there is one block at a time. */
void microtin_ardupilot_begin_block(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                    uint16_t spacing);

/* AP_Terrain::schedule_disk_io and handle_terrain_data, which fill blocks: tries `groups` groups of
 * 4 x 4 posts. True if all 56 are there. Posts have the heights of the file that `microtin decode
 * -o N43E007.DAT` writes of the pack. Difference: none. */
bool microtin_ardupilot_fill_block(microtin_ardupilot* terrain, uint32_t groups);

/* AP_Terrain::get_statistics: groups of the block that are missing, and that are there. 0 and 0
 * before a block is begun. Difference: of the one block, and not of twelve. */
void microtin_ardupilot_statistics(const microtin_ardupilot* terrain, uint16_t* pending,
                                   uint16_t* loaded);

#ifdef __cplusplus
}
#endif

#endif
