// SPDX-License-Identifier: MIT
/* What the adapters share: places on the globe, a pack that is asked there, and the requests that
 * questions leave for the task that reads the card. Integers only.
 *
 * Questions may interrupt the service, not each other. Define MICROTIN_ADAPTERS_COMPACT for packs
 * of compact_pack.h, everywhere or nowhere. */
#ifndef MICROTIN_ADAPTERS_SPOTS_H
#define MICROTIN_ADAPTERS_SPOTS_H

#include "microtin/requests.h"

#ifdef MICROTIN_ADAPTERS_COMPACT
#define MICROTIN_SPOTS_LOAD microtin_requests_load_compact
#define MICROTIN_SPOTS_PACK_LOAD microtin_compact_pack_load
#define MICROTIN_SPOTS_HEIGHT_AT microtin_compact_pack_height_at
#else
#define MICROTIN_SPOTS_LOAD microtin_requests_load
#define MICROTIN_SPOTS_PACK_LOAD microtin_pack_load
#define MICROTIN_SPOTS_HEIGHT_AT microtin_pack_height_at
#endif

/* Millimetres of the way ahead that are requested, at most. */
#define MICROTIN_SPOTS_AHEAD 10000000

/* Terrain that will be queried is loaded before: so far ahead of each place, in 1e-7 degrees of
 * latitude or longitude, whichever changes more. 500 m to the north. */
#define MICROTIN_SPOTS_LEAD 45000

/* The vehicle's course is taken over a tenth of that. */
#define MICROTIN_SPOTS_COURSE 4500

/* A place, in 1e-7 degrees. */
typedef struct microtin_spot {
  int32_t latitude, longitude;
} microtin_spot;

/* A place with a height that stays known, whatever tiles are loaded. */
typedef struct microtin_latch {
  microtin_spot at;
  int32_t millimetres;
  uint8_t has_place, has_height;
} microtin_latch;

typedef struct microtin_spots {
  microtin_pack* pack; /* places in degrees, heights in metres */
  microtin_pack_info info;
  volatile uint8_t has_info;
  uint32_t hint;
  microtin_requests requests;
  microtin_latch home;
  microtin_spot course_from; /* where the course was taken last, also on the lattice */
  int64_t course_x, course_y;
  int64_t lead_x, lead_y; /* MICROTIN_SPOTS_LEAD along the course, on the lattice */
  uint8_t has_course;     /* course_from is known */
} microtin_spots;

static inline void microtin_latch_set(microtin_latch* latch, microtin_spot at) {
  latch->at = at;
  latch->has_place = 1;
  latch->has_height = 0;
}

static inline void microtin_spots_init(microtin_spots* s, microtin_pack* pack) {
  s->pack = pack;
  s->has_info = 0;
  s->hint = 0;
  s->home.has_place = 0;
  s->home.has_height = 0;
  s->has_course = 0;
  s->course_from.latitude = 0;
  s->course_from.longitude = 0;
  s->course_x = 0;
  s->course_y = 0;
  s->lead_x = 0;
  s->lead_y = 0;
  microtin_requests_init(&s->requests, pack);
}

/* Whether the service has something to load. */
static inline int microtin_spots_is_pending(const microtin_spots* s) {
  return !s->has_info || microtin_requests_pending(&s->requests) != 0;
}

/* After a service: places are known once the header is loaded. */
static inline void microtin_spots_note_header(microtin_spots* s) {
  if (!s->has_info && microtin_pack_get_info(s->pack, &s->info) == MICROTIN_STATUS_OK) {
    __atomic_signal_fence(__ATOMIC_SEQ_CST); /* no question sees half of it */
    s->has_info = 1;
  }
}

/* A piece of what is requested, with the statuses of microtin_requests_load. */
static inline microtin_status microtin_spots_load(microtin_spots* s, uint32_t step_limit,
                                                  microtin_read read, void* context) {
  const microtin_status status = MICROTIN_SPOTS_LOAD(&s->requests, read, context, step_limit);
  microtin_spots_note_header(s);
  return status;
}

static inline int microtin_spots_column(const microtin_spots* s, int64_t longitude, int64_t* x) {
  return microtin_pack_axis_to_lattice(&s->info.x, s->info.x_max, longitude, 10000000, x) ==
         MICROTIN_STATUS_OK;
}

/* Lattice coordinates with 8 fractional bits, also in a pack that names longitudes a turn farther
 * west or east. 0: outside, or the header is not known. */
static inline int microtin_spots_place(const microtin_spots* s, microtin_spot at, int64_t* x,
                                       int64_t* y) {
  const int64_t turn = 3600000000;
  return s->has_info &&
         (microtin_spots_column(s, at.longitude, x) ||
          microtin_spots_column(s, at.longitude + turn, x) ||
          microtin_spots_column(s, at.longitude - turn, x)) &&
         microtin_pack_axis_to_lattice(&s->info.y, s->info.y_max, at.latitude, 10000000, y) ==
             MICROTIN_STATUS_OK;
}

/* Requests what lies between two places, or the first place alone if the second one is not in the
 * pack or is far away. 0: not noted. */
static inline int microtin_spots_request(microtin_spots* s, microtin_spot from, microtin_spot to,
                                         uint32_t priority) {
  const int64_t farthest = (int64_t)1 << 24;
  microtin_segment c;
  if (!microtin_spots_place(s, from, &c.x, &c.y)) return 0;
  if (!microtin_spots_place(s, to, &c.x_end, &c.y_end) || c.x_end - c.x >= farthest ||
      c.x - c.x_end >= farthest || c.y_end - c.y >= farthest || c.y - c.y_end >= farthest) {
    c.x_end = c.x;
    c.y_end = c.y;
  }
  return microtin_requests_add(&s->requests, &c, priority) == MICROTIN_STATUS_OK;
}

/* Checks that the pack has the terrain between two places, and that its bytes are whole, as
 * microtin_pack_check_segment does. Call it where microtin_spots_load is called. A call makes one
 * read; `check` is all zero to begin.
 *
 * - OK: all tiles have terrain and are whole
 * - NEED_INPUT: call again
 * - IO: reading failed; call again
 * - OUT_OF_RANGE: a place lies outside the pack
 * - NOT_FOUND: the others are whole, and check->without_terrain tiles have no terrain
 * - BAD_TILES, and the statuses of a bad header: as microtin_pack_check_segment */
static inline microtin_status microtin_spots_check(microtin_spots* s, microtin_spot from,
                                                   microtin_spot to, microtin_pack_check* check,
                                                   microtin_read read, void* context) {
  microtin_segment leg;
  microtin_status status;
  if (!s->has_info) {
    status = microtin_spots_load(s, 1, read, context);
    return status == MICROTIN_STATUS_OK || status == MICROTIN_STATUS_STEP_LIMIT
               ? MICROTIN_STATUS_NEED_INPUT
               : status;
  }
  if (!microtin_spots_place(s, from, &leg.x, &leg.y) ||
      !microtin_spots_place(s, to, &leg.x_end, &leg.y_end)) {
    return MICROTIN_STATUS_OUT_OF_RANGE;
  }
  microtin_pack_read_once(s->pack, read, context);
  status = microtin_pack_check_segment(s->pack, &leg, check);
  return status == MICROTIN_STATUS_OK && check->without_terrain != 0 ? MICROTIN_STATUS_NOT_FOUND
                                                                     : status;
}

/* Takes the course again if the vehicle has moved by MICROTIN_SPOTS_COURSE. */
static inline void microtin_spots_take_course(microtin_spots* s, microtin_spot here) {
  int64_t x, y, north = (int64_t)here.latitude - s->course_from.latitude,
                east = (int64_t)here.longitude - s->course_from.longitude, most;
  if (north < 0) north = -north;
  if (east < 0) east = -east;
  most = north > east ? north : east;
  if ((s->has_course && most < MICROTIN_SPOTS_COURSE) || !microtin_spots_place(s, here, &x, &y)) {
    return;
  }
  if (s->has_course) { /* below 2^41 * 2^16 */
    s->lead_x = (x - s->course_x) * MICROTIN_SPOTS_LEAD / most;
    s->lead_y = (y - s->course_y) * MICROTIN_SPOTS_LEAD / most;
  }
  s->course_from = here;
  s->course_x = x;
  s->course_y = y;
  s->has_course = 1;
}

/* The vehicle is here: this tile comes first. */
static inline void microtin_spots_set_position(microtin_spots* s, microtin_spot here) {
  microtin_spots_request(s, here, here, MICROTIN_PRIORITY_HERE);
  microtin_spots_take_course(s, here);
}

/* A place was queried that moves with the vehicle: requests where it will be soon, if that is
 * another tile. */
static inline void microtin_spots_request_soon(microtin_spots* s, int64_t x, int64_t y) {
  const int64_t to_x = x + s->lead_x, to_y = y + s->lead_y;
  const microtin_segment place = {to_x, to_y, to_x, to_y};
  if ((uint32_t)(x >> 8) / s->info.tile_width == (uint32_t)(to_x >> 8) / s->info.tile_width &&
      (uint32_t)(y >> 8) / s->info.tile_height == (uint32_t)(to_y >> 8) / s->info.tile_height) {
    return;
  }
  microtin_requests_add(&s->requests, &place, MICROTIN_PRIORITY_SOON);
}

/* The terrain in millimetres at a lattice position with 8 fractional bits. OUTSIDE also for a
 * height that int32_t does not hold. */
static inline microtin_query_result microtin_spots_height_on(microtin_spots* s, int64_t x,
                                                             int64_t y, int32_t* millimetres) {
  int32_t height;
  const microtin_query_result result = MICROTIN_SPOTS_HEIGHT_AT(s->pack, x, y, &s->hint, &height);
  if (result != MICROTIN_QUERY_OK) return result;
  return microtin_axis_height(&s->info.z, height, 1000, millimetres) == MICROTIN_STATUS_OK
             ? MICROTIN_QUERY_OK
             : MICROTIN_QUERY_OUTSIDE;
}

/* The terrain in millimetres. NOT_LOADED: it may be there later, if it is requested. */
static inline microtin_query_result microtin_spots_height(microtin_spots* s, microtin_spot at,
                                                          int32_t* millimetres) {
  int64_t x, y;
  if (!s->has_info) return MICROTIN_QUERY_NOT_LOADED;
  if (!microtin_spots_place(s, at, &x, &y)) return MICROTIN_QUERY_OUTSIDE;
  return microtin_spots_height_on(s, x, y, millimetres);
}

/* The height; a missing tile is requested. 0: there is no height. */
static inline int microtin_spots_ask(microtin_spots* s, microtin_spot at, int32_t* millimetres) {
  const microtin_query_result result = microtin_spots_height(s, at, millimetres);
  if (result == MICROTIN_QUERY_NOT_LOADED) {
    microtin_spots_request(s, at, at, MICROTIN_PRIORITY_OTHER);
  }
  return result == MICROTIN_QUERY_OK;
}

/* The height at a latched place; it is kept from when it is known first. 0: not known yet. */
static inline int microtin_spots_ask_latch(microtin_spots* s, microtin_latch* latch,
                                           int32_t* millimetres) {
  if (!latch->has_place) return 0;
  if (!latch->has_height) {
    latch->has_height = (uint8_t)microtin_spots_ask(s, latch->at, &latch->millimetres);
  }
  *millimetres = latch->millimetres;
  return latch->has_height;
}

/* The height at a place that may be home. */
static inline int microtin_spots_ask_place(microtin_spots* s, microtin_spot at,
                                           int32_t* millimetres) {
  const microtin_latch* const home = &s->home;
  microtin_query_result result;
  microtin_segment place;
  if (home->has_place && home->at.latitude == at.latitude && home->at.longitude == at.longitude) {
    return microtin_spots_ask_latch(s, &s->home, millimetres);
  }
  if (!microtin_spots_place(s, at, &place.x, &place.y)) return 0;
  place.x_end = place.x;
  place.y_end = place.y;
  result = microtin_spots_height_on(s, place.x, place.y, millimetres);
  if (result == MICROTIN_QUERY_OK) {
    microtin_spots_request_soon(s, place.x, place.y);
  } else if (result == MICROTIN_QUERY_NOT_LOADED) {
    microtin_requests_add(&s->requests, &place, MICROTIN_PRIORITY_OTHER);
  }
  return result == MICROTIN_QUERY_OK;
}

/* The sine of an angle in 1/100 degree, times 65536; within 10 of it. A polynomial with x, x^3 and
 * x^5 over the quarter. */
static inline int32_t microtin_sine(int32_t angle) {
  int64_t x, square, value;
  int32_t part = angle % 36000;
  int is_negative;
  if (part < 0) part += 36000;
  is_negative = part >= 18000;
  part %= 18000;
  if (part > 9000) part = 18000 - part;
  x = (int64_t)part * 65536 / 9000;
  square = x * x / 65536;
  value = 42154 - square * 4765 / 65536;
  value = 102933 - square * value / 65536;
  value = x * value / 65536;
  return (int32_t)(is_negative ? -value : value);
}

/* The position that many millimetres north and east, |each| < 2^31, as the autopilots reckon: a
 * degree of latitude has the length of one at the equator. */
static inline microtin_spot microtin_spot_beside(microtin_spot from, int32_t north, int32_t east) {
  const int64_t up = (int64_t)north * 89832 / 1000000;
  const int64_t middle = (from.latitude + up / 2) / 100000;
  int64_t scale = microtin_sine((int32_t)(middle + 9000)), right;
  microtin_spot to;
  if (scale < 655) scale = 655; /* near the poles */
  right = from.longitude + (int64_t)east * 89832 / 1000000 * 65536 / scale;
  if (right > 1800000000) right -= 3600000000;
  if (right < -1800000000) right += 3600000000;
  to.latitude = (int32_t)(from.latitude + up);
  to.longitude = (int32_t)right;
  return to;
}

/* Steps of a way: millimetres north and east for each. */
typedef struct microtin_stride {
  int32_t north, east;
} microtin_stride;

static inline microtin_stride microtin_stride_along(int32_t bearing_centidegrees, int32_t step) {
  microtin_stride stride;
  stride.north = (int32_t)((int64_t)microtin_sine(bearing_centidegrees + 9000) * step / 65536);
  stride.east = (int32_t)((int64_t)microtin_sine(bearing_centidegrees) * step / 65536);
  return stride;
}

/* The vehicle is here, and looks ahead `count` strides: they come before other places. */
static inline void microtin_spots_look(microtin_spots* s, microtin_spot here,
                                       microtin_stride stride, int32_t step, int32_t count) {
  const int32_t most = MICROTIN_SPOTS_AHEAD / step + 1, strides = count < most ? count : most;
  microtin_spots_set_position(s, here);
  microtin_spots_request(s, here,
                         microtin_spot_beside(here, stride.north * strides, stride.east * strides),
                         MICROTIN_PRIORITY_AHEAD);
}

/* A bearing in degrees, any number of turns, in 1/100 degree. 0: not a number, or beyond 10 million
 * degrees. */
static inline int microtin_spots_bearing(float degrees, int32_t* bearing) {
  if (!(degrees > -1e7f && degrees < 1e7f)) return 0;
  *bearing = (int32_t)(degrees * 100.0f);
  return 1;
}

/* A float that is no number, or too large, becomes the nearest bound. */
static inline int32_t microtin_whole(float value, float most) {
  if (!(value > -most)) return (int32_t)-most;
  return (int32_t)(value < most ? value : most);
}

#endif
