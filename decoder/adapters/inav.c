// SPDX-License-Identifier: MIT
/* Answers the terrain questions of INAV from a pack. */
#include "inav.h"

void microtin_inav_init(microtin_inav* inav, microtin_pack* pack) {
  microtin_spots_init(&inav->spots, pack);
  inav->has_here = 0;
  inav->was_known = 0;
  inav->status = MICROTIN_STATUS_OK;
}

void microtin_inav_set_position(microtin_inav* inav, int32_t lat, int32_t lon) {
  const microtin_spot here = {lat, lon};
  inav->here = here;
  inav->has_here = 1;
  microtin_spots_set_position(&inav->spots, here);
}

void microtin_inav_set_home(microtin_inav* inav, int32_t lat, int32_t lon) {
  const microtin_spot home = {lat, lon};
  microtin_latch_set(&inav->spots.home, home);
}

microtin_status microtin_inav_load(microtin_inav* inav, uint32_t step_limit, microtin_read read,
                                   void* context) {
  const microtin_status status = microtin_spots_load(&inav->spots, step_limit, read, context);
  inav->status = (uint8_t)status;
  return status;
}

microtin_status microtin_inav_load_card(microtin_inav* inav, microtin_card* card,
                                        uint32_t step_limit) {
  const microtin_status status = microtin_spots_load_card(&inav->spots, card, step_limit);
  inav->status = (uint8_t)status;
  return status;
}

/* Whether the last service found the card, and a pack on it. */
static bool is_card_good(const microtin_inav* inav) {
  return inav->status == MICROTIN_STATUS_OK || inav->status == MICROTIN_STATUS_NEED_INPUT ||
         inav->status == MICROTIN_STATUS_STEP_LIMIT ||
         inav->status == MICROTIN_STATUS_WORKSPACE_TOO_SMALL;
}

bool microtin_inav_is_healthy(microtin_inav* inav, uint32_t now_ms) {
  int32_t height;
  if (inav->has_here && microtin_spots_ask_place(&inav->spots, inav->here, &height)) {
    inav->known_at = now_ms;
    inav->was_known = 1;
  }
  if (inav->was_known && now_ms - inav->known_at > MICROTIN_INAV_FRESH_MS) inav->was_known = 0;
  return microtin_spots_ask_latch(&inav->spots, &inav->spots.home, &height) && inav->was_known &&
         is_card_good(inav);
}

bool microtin_inav_height(microtin_inav* inav, int32_t lat, int32_t lon, float* height_m) {
  const microtin_spot at = {lat, lon};
  int32_t height;
  if (!microtin_spots_ask_place(&inav->spots, at, &height)) return false;
  *height_m = (float)height / 1000.0f;
  return true;
}

bool microtin_inav_lookahead(microtin_inav* inav, int32_t lat, int32_t lon, float bearing_deg,
                             float distance_m, float climb_ratio, float escape_ratio,
                             microtin_inav_look* look) {
  microtin_stride stride;
  const int32_t samples = microtin_whole(distance_m / 30.0f, MICROTIN_INAV_SAMPLES);
  const int32_t climb = microtin_whole(climb_ratio * MICROTIN_INAV_STEP, 1e6f),
                escape = microtin_whole(escape_ratio * MICROTIN_INAV_STEP, 1e6f);
  const microtin_spot from = {lat, lon};
  microtin_spot at = from;
  int64_t needed = 0, deficit = 0;
  int32_t bearing, base, height, missed = 0, i;
  if (!microtin_spots_bearing(bearing_deg, &bearing)) return false;
  stride = microtin_stride_along(bearing, MICROTIN_INAV_STEP);
  microtin_spots_look(&inav->spots, from, stride, MICROTIN_INAV_STEP, samples);
  if (!microtin_spots_ask(&inav->spots, from, &base)) return false;
  for (i = 1; i <= samples; ++i) {
    at = microtin_spot_beside(at, stride.north, stride.east);
    if (!microtin_spots_ask(&inav->spots, at, &height)) {
      ++missed;
      continue;
    }
    const int64_t rise = (int64_t)height - base;
    if (rise - climb * i > needed) needed = rise - climb * i;
    if (rise - escape * i > deficit) deficit = rise - escape * i;
  }
  look->climb_needed_m = (float)needed / 1000.0f;
  look->escape_deficit_m = (float)deficit / 1000.0f;
  look->samples_total = (uint8_t)(samples > 0 ? samples : 0);
  look->samples_missed = (uint8_t)missed;
  return true;
}

bool microtin_inav_request(microtin_inav* inav, int32_t lat, int32_t lon, int32_t lat_end,
                           int32_t lon_end) {
  const microtin_spot from = {lat, lon}, to = {lat_end, lon_end};
  return microtin_spots_request(&inav->spots, from, to, MICROTIN_PRIORITY_OTHER) != 0;
}

microtin_status microtin_inav_check(microtin_inav* inav, int32_t lat, int32_t lon, int32_t lat_end,
                                    int32_t lon_end, microtin_pack_check* check, microtin_read read,
                                    void* context) {
  const microtin_spot from = {lat, lon}, to = {lat_end, lon_end};
  return microtin_spots_check(&inav->spots, from, to, check, read, context);
}
