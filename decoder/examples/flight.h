// SPDX-License-Identifier: MIT
/* The flight of card.c: 1,000 places over a pack in ten straight legs, for the code that flies it
 * and for the code that checks the heights. */
#ifndef MICROTIN_EXAMPLES_FLIGHT_H
#define MICROTIN_EXAMPLES_FLIGHT_H

#include "microtin/pack.h"
#include "print.h"

#define FLIGHT_PLACES 1000
#define FLIGHT_LEG 100 /* places from corner to corner */
#define FLIGHT_AHEAD 8 /* places that are to be known before the vehicle goes on */

/* Where place `i` lies on an axis: lattice, 8 fractional bits. Corners are in 1/64 of the way to
 * the largest x or y. */
static inline int64_t flight_axis(const uint8_t* corners, int32_t i, uint32_t most) {
  const int32_t leg = i / FLIGHT_LEG, part = i % FLIGHT_LEG;
  const int32_t sum = corners[leg] * (FLIGHT_LEG - part) + corners[leg + 1] * part;
  return (int64_t)most * 256 * sum / (64 * FLIGHT_LEG);
}

/* What the vehicle wants to know when it is at place `i`: that, and the way ahead to the end of its
 * leg at most. */
static inline microtin_segment flight_segment(int32_t i, const microtin_pack_info* pack) {
  static const uint8_t x[11] = {3, 60, 45, 9, 22, 50, 63, 31, 5, 30, 62};
  static const uint8_t y[11] = {5, 11, 52, 60, 7, 3, 58, 63, 33, 20, 40};
  const int32_t left = FLIGHT_LEG - 1 - i % FLIGHT_LEG;
  const int32_t end = i + (left < FLIGHT_AHEAD ? left : FLIGHT_AHEAD);
  microtin_segment segment;
  segment.x = flight_axis(x, i, pack->x_max);
  segment.y = flight_axis(y, i, pack->y_max);
  segment.x_end = flight_axis(x, end, pack->x_max);
  segment.y_end = flight_axis(y, end, pack->y_max);
  return segment;
}

/* What is known of place `i`, ten places on a line. Heights have 16 fractional bits. */
static inline void print_place(int32_t i, microtin_query_result result, int32_t height) {
  switch (result) {
    case MICROTIN_QUERY_OK:
      print_number(height);
      break;
    case MICROTIN_QUERY_BAD_TILE:
      print("bad");
      break;
    case MICROTIN_QUERY_VOID:
      print("void");
      break;
    default:
      print("nothing");
      break;
  }
  print(i % 10 == 9 ? "\n" : " ");
}

#endif
