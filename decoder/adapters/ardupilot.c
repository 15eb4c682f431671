// SPDX-License-Identifier: MIT
/* Answers the terrain questions of ArduPilot from a pack. */
#include "ardupilot.h"

void microtin_ardupilot_init(microtin_ardupilot* terrain, microtin_pack* pack, uint16_t spacing) {
  microtin_spots_init(&terrain->spots, pack);
  terrain->spacing = spacing != 0 ? spacing : 100;
  terrain->has_reference = 0;
  terrain->has_correction = 0;
  terrain->most_correction = 0;
  terrain->missed = 0;
  microtin_ardupilot_begin_block(terrain, 0, 0, terrain->spacing);
  terrain->has_block = 0;
}

microtin_status microtin_ardupilot_load(microtin_ardupilot* terrain, uint32_t step_limit,
                                        microtin_read read, void* context) {
  return microtin_spots_load(&terrain->spots, step_limit, read, context);
}

void microtin_ardupilot_set_home(microtin_ardupilot* terrain, int32_t lat, int32_t lng) {
  const microtin_spot home = {lat, lng};
  microtin_latch_set(&terrain->spots.home, home);
}

/* Keeps the correction within its bound, or computes it once the terrain at the reference is there.
 * Differences stay below 2^30 + 2^31 mm. False: there is none. */
static bool find_correction(microtin_ardupilot* terrain) {
  const int64_t most = terrain->most_correction;
  int64_t above = terrain->correction;
  int32_t ground;
  if (most <= 0) terrain->has_correction = 0;
  if (most <= 0 || !terrain->has_reference) return false;
  if (!terrain->has_correction) {
    if (!microtin_spots_ask(&terrain->spots, terrain->reference, &ground)) return false;
    above = (int64_t)terrain->reference_altitude - ground;
  }
  terrain->correction = (int32_t)(above > most ? most : above < -most ? -most : above);
  terrain->has_correction = 1;
  return true;
}

void microtin_ardupilot_set_position(microtin_ardupilot* terrain, int32_t lat, int32_t lng) {
  const microtin_spot here = {lat, lng};
  microtin_spots_set_position(&terrain->spots, here);
  find_correction(terrain);
}

void microtin_ardupilot_set_offset_max(microtin_ardupilot* terrain, float most) {
  terrain->most_correction = microtin_whole(most * 1000.0f, 1e6f);
  find_correction(terrain);
}

void microtin_ardupilot_set_reference(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                      int32_t altitude_cm, float most) {
  terrain->reference.latitude = lat;
  terrain->reference.longitude = lng;
  terrain->reference_altitude = microtin_whole((float)altitude_cm, 1e8f) * 10;
  terrain->has_reference = 1;
  terrain->has_correction = 0;
  microtin_ardupilot_set_offset_max(terrain, most);
}

bool microtin_ardupilot_reference_offset(microtin_ardupilot* terrain, float* offset) {
  if (!find_correction(terrain)) return false;
  *offset = (float)terrain->correction / 1000.0f;
  return true;
}

bool microtin_ardupilot_height_amsl(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                    float* height, bool corrected) {
  const microtin_spot at = {lat, lng};
  int32_t millimetres;
  if (!microtin_spots_ask_place(&terrain->spots, at, &millimetres)) return false;
  *height = (float)millimetres / 1000.0f;
  if (corrected && find_correction(terrain)) *height += (float)terrain->correction / 1000.0f;
  return true;
}

float microtin_ardupilot_lookahead(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                   float bearing, float distance, float climb_ratio) {
  const int32_t step = terrain->spacing * (int32_t)1000;
  microtin_stride stride;
  /* Samples until the distance is used up: the last may lie beyond it. */
  const float exact = distance / (float)terrain->spacing;
  const int32_t whole = microtin_whole(exact, MICROTIN_ARDUPILOT_SAMPLES);
  const int32_t samples =
      (float)whole < exact && whole < MICROTIN_ARDUPILOT_SAMPLES ? whole + 1 : whole;
  const int64_t climb = microtin_whole(climb_ratio * (float)step, 1e9f);
  const microtin_spot from = {lat, lng};
  microtin_spot at = from;
  int64_t most = 0;
  int32_t course, base, height, i;
  terrain->missed = 0;
  if (!microtin_spots_bearing(bearing, &course)) return 0.0f;
  stride = microtin_stride_along(course, step);
  microtin_spots_look(&terrain->spots, from, stride, step, samples);
  if (!microtin_spots_ask(&terrain->spots, from, &base)) return 0.0f;
  for (i = 1; i <= samples; ++i) {
    at = microtin_spot_beside(at, stride.north, stride.east);
    if (!microtin_spots_ask(&terrain->spots, at, &height)) {
      ++terrain->missed;
    } else if (height - (int64_t)base - climb * i > most) {
      most = height - (int64_t)base - climb * i;
    }
  }
  return (float)most / 1000.0f;
}

bool microtin_ardupilot_request(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                int32_t lat_end, int32_t lng_end) {
  const microtin_spot from = {lat, lng}, to = {lat_end, lng_end};
  return microtin_spots_request(&terrain->spots, from, to, MICROTIN_PRIORITY_OTHER) != 0;
}

microtin_status microtin_ardupilot_check(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                         int32_t lat_end, int32_t lng_end,
                                         microtin_pack_check* check, microtin_read read,
                                         void* context) {
  const microtin_spot from = {lat, lng}, to = {lat_end, lng_end};
  return microtin_spots_check(&terrain->spots, from, to, check, read, context);
}

void microtin_ardupilot_begin_block(microtin_ardupilot* terrain, int32_t lat, int32_t lng,
                                    uint16_t spacing) {
  microtin_ardupilot_block* const block = &terrain->block;
  const microtin_spot at = {lat, lng};
  int row, column;
  terrain->has_block = 1;
  if (spacing == 0) spacing = terrain->spacing;
  block->posts.spacing = spacing < MICROTIN_POSTS_FARTHEST ? spacing : MICROTIN_POSTS_FARTHEST;
  block->corner = microtin_posts_find(&block->posts, at, &block->grid_row, &block->grid_column);
  block->bitmap = 0;
  block->next = 0;
  for (row = 0; row < MICROTIN_ARDUPILOT_ROWS; ++row) {
    for (column = 0; column < MICROTIN_ARDUPILOT_COLUMNS; ++column) block->height[row][column] = 0;
  }
}

/* The height of a post in whole metres, halves up, of millimetres, as the file has it. */
static microtin_query_result height_of_post(microtin_ardupilot* terrain, microtin_spot post,
                                            int16_t* metres) {
  microtin_spots* const spots = &terrain->spots;
  int64_t x, y, turn;
  int32_t height = 0;
  microtin_query_result result;
  if (!spots->has_info) return MICROTIN_QUERY_NOT_LOADED;
  turn = microtin_posts_turn(&terrain->block.posts, &spots->info);
  if (!microtin_posts_position(&terrain->block.posts, post, &spots->info, turn, &x, &y)) {
    return MICROTIN_QUERY_OUTSIDE;
  }
  result = microtin_spots_height_on(spots, x, y, &height);
  if (result == MICROTIN_QUERY_NOT_LOADED) {
    const microtin_segment place = {x, y, x, y};
    microtin_requests_add(&spots->requests, &place, MICROTIN_PRIORITY_OTHER);
  }
  if (height < -32768000 || height > 32767000) return MICROTIN_QUERY_OUTSIDE;
  *metres = (int16_t)((height + 32768500) / 1000 - 32768);
  return result;
}

/* A group that is not all there leaves zeros. */
static void try_group(microtin_ardupilot* terrain, int32_t group) {
  microtin_ardupilot_block* const block = &terrain->block;
  const int32_t row = group / 8 * 4, column = group % 8 * 4;
  const uint32_t south = block->grid_row * (uint32_t)MICROTIN_POSTS_OWN_ROWS + (uint32_t)row,
                 west =
                     block->grid_column * (uint32_t)MICROTIN_POSTS_OWN_COLUMNS + (uint32_t)column;
  int16_t heights[4][4];
  uint32_t i, j;
  for (i = 0; i < 4; ++i) {
    const uint32_t scale =
        microtin_posts_halfway(&block->posts, microtin_posts_north(&block->posts, south + i));
    for (j = 0; j < 4; ++j) {
      const microtin_spot post = microtin_posts_place(&block->posts, south + i, west + j, scale);
      if (height_of_post(terrain, post, &heights[i][j]) != MICROTIN_QUERY_OK) return;
    }
  }
  for (i = 0; i < 4; ++i) {
    for (j = 0; j < 4; ++j) block->height[row + (int)i][column + (int)j] = heights[i][j];
  }
  block->bitmap |= (uint64_t)1 << group;
}

bool microtin_ardupilot_fill_block(microtin_ardupilot* terrain, uint32_t groups) {
  const uint64_t all = ((uint64_t)1 << MICROTIN_ARDUPILOT_GROUPS) - 1;
  microtin_ardupilot_block* const block = &terrain->block;
  uint32_t left = groups < MICROTIN_ARDUPILOT_GROUPS ? groups : MICROTIN_ARDUPILOT_GROUPS;
  for (; left != 0 && block->bitmap != all; --left) {
    while ((block->bitmap >> block->next & 1) != 0) {
      block->next = (uint8_t)((block->next + 1) % MICROTIN_ARDUPILOT_GROUPS);
    }
    try_group(terrain, block->next);
    block->next = (uint8_t)((block->next + 1) % MICROTIN_ARDUPILOT_GROUPS);
  }
  return block->bitmap == all;
}

void microtin_ardupilot_statistics(const microtin_ardupilot* terrain, uint16_t* pending,
                                   uint16_t* loaded) {
  uint64_t bits = terrain->block.bitmap;
  uint16_t count = 0;
  for (; bits != 0; bits &= bits - 1) ++count;
  *loaded = count;
  *pending = (uint16_t)(MICROTIN_ARDUPILOT_GROUPS - count);
  if (!terrain->has_block) *pending = 0; /* checks before take-off wait for pending groups */
}
