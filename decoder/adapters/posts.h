// SPDX-License-Identifier: MIT
/* Where ArduPilot's terrain files have their posts, so that a block has the heights of the file
 * that `microtin decode -o N43E007.DAT` writes. ArduPilot computes in single precision; these
 * functions find the same numbers with integers.
 *
 * A file has one degree by one degree. Its rows of posts are `spacing` metres apart, and so are the
 * posts of a row. Blocks begin every 24 rows and 28 columns. */
#ifndef MICROTIN_ADAPTERS_POSTS_H
#define MICROTIN_ADAPTERS_POSTS_H

#include "spots.h"

#define MICROTIN_POSTS_DEGREE 10000000 /* places are in 1e-7 degrees */
#define MICROTIN_POSTS_OWN_ROWS 24     /* of a block: the others repeat its neighbours' */
#define MICROTIN_POSTS_OWN_COLUMNS 28
#define MICROTIN_POSTS_FARTHEST \
  1000 /* metres between posts: near a pole longitudes stay in range */

/* 1e-7 degrees of latitude for a metre, 89.83204953368922 in single precision, times 2^17. */
#define MICROTIN_POSTS_PER_METRE 11774466

/* How far a corner may be from where it is computed, in 1e-7 degrees: ArduPilot allows as much. */
#define MICROTIN_POSTS_TOLERANCE 5

/* The grid of a file. */
typedef struct microtin_posts {
  microtin_spot origin; /* the south-west corner, whole degrees */
  uint16_t spacing;     /* metres, 1 .. 1000 */
} microtin_posts;

/* The upper half of a product. */
static inline uint64_t microtin_posts_product(uint64_t a, uint64_t b) {
  const uint64_t a_low = (uint32_t)a, a_high = a >> 32, b_low = (uint32_t)b, b_high = b >> 32;
  const uint64_t middle = a_high * b_low + (a_low * b_low >> 32);
  const uint64_t other = a_low * b_high + (uint32_t)middle;
  return a_high * b_high + (middle >> 32) + (other >> 32);
}

/* A number rounded to 24 significant bits, as single precision has. */
static inline uint64_t microtin_posts_single(uint64_t number) {
  uint32_t bits = 0;
  while (number >> bits >> 24 != 0) ++bits;
  return (number + ((uint64_t)1 << bits >> 1)) >> bits << bits;
}

/* The cosine of a latitude, which shortens a degree of longitude, times 2^30 in single precision.
 * It is at least 0.01. The latitude is in 5e-8 degrees. */
static inline uint32_t microtin_posts_scale(int64_t latitude) {
  const uint64_t one = (uint64_t)1 << 61, least = 10737418;
  const uint64_t farthest = 1790000000; /* beyond 89.43 degrees the cosine is below 0.01 */
  uint64_t angle = (uint64_t)(latitude < 0 ? -latitude : latitude), square, cosine = one;
  uint32_t k;
  if (angle > farthest) angle = farthest;
  /* In radians times 2^61: 5e-8 degrees times 2^93 are 8642451851119134758. */
  angle = microtin_posts_single(microtin_posts_product(angle << 32, 8642451851119134758u));
  square = microtin_posts_product(angle << 2, angle << 1);
  /* The terms of the series up to x^24, from the last one: what is left out is below 2^-60. */
  for (k = 12; k != 0; --k) {
    cosine = one - microtin_posts_product(square << 1, cosine << 2) / ((2 * k - 1) * 2 * k);
  }
  cosine = microtin_posts_single(cosine) >> 31;
  return (uint32_t)(cosine < least ? least : cosine);
}

/* 1e-7 degrees of latitude that some rows are from the south, rounded down. */
static inline int32_t microtin_posts_north(const microtin_posts* posts, uint32_t rows) {
  return (int32_t)((uint64_t)rows * posts->spacing * MICROTIN_POSTS_PER_METRE >> 17);
}

/* The scale of longitudes halfway to a place that many 1e-7 degrees from the south. */
static inline uint32_t microtin_posts_halfway(const microtin_posts* posts, int32_t north) {
  return microtin_posts_scale(2 * (int64_t)posts->origin.latitude + north);
}

/* A post's place. The scale is that of the row, so that posts of a row share it. Longitudes may be
 * above 180 degrees. Rows and columns are below 2^16. */
static inline microtin_spot microtin_posts_place(const microtin_posts* posts, uint32_t row,
                                                 uint32_t column, uint32_t scale) {
  const uint64_t east = (uint64_t)column * posts->spacing * MICROTIN_POSTS_PER_METRE;
  microtin_spot place;
  place.latitude = posts->origin.latitude + microtin_posts_north(posts, row);
  place.longitude = posts->origin.longitude + (int32_t)((east << 13) / scale);
  return place;
}

/* The whole degrees at or below a coordinate, in 1e-7 degrees. */
static inline int32_t microtin_posts_floor(int32_t coordinate) {
  const int32_t rest = coordinate % MICROTIN_POSTS_DEGREE;
  return coordinate - (rest < 0 ? rest + MICROTIN_POSTS_DEGREE : rest);
}

/* The block of the grid in which a place lies that is not south or west of the origin. Returns its
 * corner; *row and *column count blocks. */
static inline microtin_spot microtin_posts_block(const microtin_posts* posts, microtin_spot at,
                                                 uint16_t* row, uint16_t* column) {
  const uint64_t step = (uint64_t)posts->spacing * MICROTIN_POSTS_PER_METRE;
  const int32_t north = at.latitude - posts->origin.latitude;
  const uint64_t up = (uint64_t)((int64_t)north + MICROTIN_POSTS_TOLERANCE),
                 right = (uint64_t)((int64_t)at.longitude - posts->origin.longitude +
                                    MICROTIN_POSTS_TOLERANCE);
  uint32_t scale = microtin_posts_halfway(posts, north), first;
  *row = (uint16_t)((up << 17) / (step * MICROTIN_POSTS_OWN_ROWS));
  *column = (uint16_t)((right * scale >> 13) / (step * MICROTIN_POSTS_OWN_COLUMNS));
  first = *row * (uint32_t)MICROTIN_POSTS_OWN_ROWS;
  scale = microtin_posts_halfway(posts, microtin_posts_north(posts, first));
  return microtin_posts_place(posts, first, *column * (uint32_t)MICROTIN_POSTS_OWN_COLUMNS, scale);
}

static inline int32_t microtin_posts_within(int32_t coordinate, int32_t most) {
  if (coordinate > most) return most;
  return coordinate < -most ? -most : coordinate;
}

/* Whether two places differ by no more than the tolerance. */
static inline int microtin_posts_is_near(microtin_spot a, microtin_spot b) {
  const int64_t north = (int64_t)a.latitude - b.latitude, east = (int64_t)a.longitude - b.longitude;
  const int32_t most = MICROTIN_POSTS_TOLERANCE;
  return north >= -most && north <= most && east >= -most && east <= most;
}

/* Finds the file and the block of a place, as AP_Terrain::calculate_grid_info does; off the globe
 * those of the nearest place on it. The last columns of blocks of a file lie east of its degree:
 * corners up to one degree east are recognised. Returns the block's corner. */
static inline microtin_spot microtin_posts_find(microtin_posts* posts, microtin_spot at,
                                                uint16_t* row, uint16_t* column) {
  microtin_spot corner;
  at.latitude = microtin_posts_within(at.latitude, 900000000);
  at.longitude = microtin_posts_within(at.longitude, 1810000000);
  posts->origin.latitude = microtin_posts_floor(at.latitude);
  posts->origin.longitude = microtin_posts_floor(at.longitude);
  corner = microtin_posts_block(posts, at, row, column);
  if (microtin_posts_is_near(corner, at)) return corner;
  posts->origin.longitude -= MICROTIN_POSTS_DEGREE;
  corner = microtin_posts_block(posts, at, row, column);
  if (microtin_posts_is_near(corner, at)) return corner;
  posts->origin.longitude += MICROTIN_POSTS_DEGREE;
  return microtin_posts_block(posts, at, row, column);
}

/* Turns, in 1e-7 degrees, from the file's longitudes to those of the pack. */
static inline int64_t microtin_posts_turn(const microtin_posts* posts,
                                          const microtin_pack_info* info) {
  const int64_t turns[3] = {0, 3600000000, -3600000000};
  const int64_t west = posts->origin.longitude;
  int64_t first, last;
  int i;
  if (microtin_axis_from_lattice(&info->x, 0, 10000000, &first) != MICROTIN_STATUS_OK ||
      microtin_axis_from_lattice(&info->x, (int64_t)info->x_max * 256, 10000000, &last) !=
          MICROTIN_STATUS_OK) {
    return 0;
  }
  for (i = 0; i < 3; ++i) {
    if (first < west + MICROTIN_POSTS_DEGREE + turns[i] && last > west + turns[i]) return turns[i];
  }
  return 0;
}

/* The lattice coordinate of the terrain's edge, for a place at most `reach` beyond it. Both are in
 * 1e-7 degrees. 0: the place is farther away. */
static inline int microtin_posts_edge(const microtin_axis* axis, uint32_t most, int64_t value,
                                      int64_t reach, int64_t* lattice) {
  int64_t edge;
  *lattice = 0;
  if (microtin_axis_from_lattice(axis, 0, 10000000, &edge) != MICROTIN_STATUS_OK) return 0;
  if (value > edge) *lattice = (int64_t)most * 256;
  if (microtin_axis_from_lattice(axis, *lattice, 10000000, &edge) != MICROTIN_STATUS_OK) return 0;
  return value - edge <= reach && edge - value <= reach;
}

/* The lattice position of a post. A post beyond the terrain's edge has the position of the edge if
 * it is no farther away than four posts, as in the file. 0: it is farther away. */
static inline int microtin_posts_position(const microtin_posts* posts, microtin_spot post,
                                          const microtin_pack_info* info, int64_t turn, int64_t* x,
                                          int64_t* y) {
  const uint64_t reach = (uint64_t)posts->spacing * 4 * MICROTIN_POSTS_PER_METRE;
  const int64_t longitude = post.longitude + turn;
  if (microtin_pack_axis_to_lattice(&info->y, info->y_max, post.latitude, 10000000, y) !=
          MICROTIN_STATUS_OK &&
      !microtin_posts_edge(&info->y, info->y_max, post.latitude, (int64_t)(reach >> 17), y)) {
    return 0;
  }
  if (microtin_pack_axis_to_lattice(&info->x, info->x_max, longitude, 10000000, x) ==
      MICROTIN_STATUS_OK) {
    return 1;
  }
  return microtin_posts_edge(
      &info->x, info->x_max, longitude,
      (int64_t)((reach << 13) / microtin_posts_scale(2 * (int64_t)post.latitude)), x);
}

#endif
