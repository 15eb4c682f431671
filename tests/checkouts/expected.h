// SPDX-License-Identifier: MIT
/* The pack of a test, and heights that are right: from a pack that is loaded whole, from memory. */
#ifndef MICROTIN_TESTS_CHECKOUTS_EXPECTED_H
#define MICROTIN_TESTS_CHECKOUTS_EXPECTED_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "microtin/requests.h"

#define PLACES 1000
#define CAPACITY 300 /* more vertices than a tile has */

typedef struct place {
  int64_t x, y;
  int32_t height;
} place;

static uint8_t* pack_bytes;
static size_t pack_size;
static place places[PLACES];

static void require(int is_right, const char* what) {
  if (is_right) return;
  printf("wrong: %s\n", what);
  exit(1);
}

static uint8_t* read_whole_file(const char* path, size_t* size) {
  FILE* const file = fopen(path, "rb");
  uint8_t* bytes;
  require(file != NULL, path);
  fseek(file, 0, SEEK_END);
  *size = (size_t)ftell(file);
  rewind(file);
  bytes = (uint8_t*)malloc(*size);
  require(bytes != NULL && fread(bytes, 1, *size, file) == *size, path);
  fclose(file);
  return bytes;
}

static void read_pack_file(const char* path) {
  pack_bytes = read_whole_file(path, &pack_size);
}

static int32_t read_memory(void* context, uint64_t offset, uint8_t* buffer, size_t size) {
  const size_t left = offset < pack_size ? pack_size - (size_t)offset : 0;
  const size_t taken = size < left ? size : left;
  (void)context;
  memcpy(buffer, pack_bytes + offset, taken);
  return (int32_t)taken;
}

static microtin_pack* new_pack(uint32_t slots) {
  const size_t size = MICROTIN_PACK_BYTES(slots, CAPACITY);
  microtin_pack* pack;
  void* const space = malloc(size);
  require(space != NULL &&
              microtin_pack_init(space, size, slots, CAPACITY, &pack) == MICROTIN_STATUS_OK,
          "a pack");
  return pack;
}

static int64_t random_below(int64_t most) {
  static uint32_t state = 7;
  state = state * 1664525u + 1013904223u;
  return (int64_t)(state >> 4) * most >> 28;
}

/* Places anywhere in the pack, in no order. */
static void find_places(const char* path) {
  microtin_pack_info info;
  microtin_pack* whole;
  uint32_t hint = 0;
  int i;
  read_pack_file(path);
  whole = new_pack(64);
  for (i = 0; i < PLACES; ++i) {
    place* const p = places + i;
    microtin_segment here = {0, 0, 0, 0};
    if (i == 0) microtin_pack_load_with(whole, &here, read_memory, NULL, 0);
    require(microtin_pack_get_info(whole, &info) == MICROTIN_STATUS_OK, "the header");
    p->x = random_below((int64_t)info.x_max * 256);
    p->y = random_below((int64_t)info.y_max * 256);
    here.x = here.x_end = p->x;
    here.y = here.y_end = p->y;
    require(microtin_pack_load_with(whole, &here, read_memory, NULL, 0) == MICROTIN_STATUS_OK &&
                microtin_pack_height_at(whole, p->x, p->y, &hint, &p->height) == MICROTIN_QUERY_OK,
            "a place");
  }
}

#endif
