// SPDX-License-Identifier: MIT
// A terrain in flash, decoded piece by piece, and the height at a place. Needs 4 KB of RAM: a Mega, not an Uno.
#include <microtin.h>

#include "terrain.h"

static microtin::Terrain<TERRAIN_VERTICES> terrain(microtin::defer_init);
static microtin::Decoder<TERRAIN_VERTICES> decoder(microtin::defer_init);

// Flash is not read by pointers on AVR: a few bytes at a time are brought to RAM.
static microtin_status decode() {
  uint8_t piece[16];
  size_t at = 0;
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  while (status == MICROTIN_STATUS_NEED_INPUT && at < sizeof terrain_stream) {
    size_t size = 0, used = 0;
    while (size < sizeof piece && at + size < sizeof terrain_stream) {
      piece[size] = pgm_read_byte(terrain_stream + at + size);
      ++size;
    }
    status = decoder.feed(piece, size, &used);
    at += used;
  }
  return status == MICROTIN_STATUS_NEED_INPUT ? decoder.finish() : status;
}

void setup() {
  Serial.begin(115200);
  terrain.begin();
  decoder.begin(terrain);
  if (decode() != MICROTIN_STATUS_OK) {
    Serial.println("no terrain");
    return;
  }
  uint32_t hint = 0;
  int32_t height = 0;
  // 16 and 12 steps of the lattice to the east and to the north.
  if (terrain.height_at(16 * 256L, 12 * 256L, &hint, &height) == MICROTIN_QUERY_OK) {
    Serial.print(terrain.vertices());
    Serial.print(" vertices, height ");
    Serial.println(height / 65536);
  }
}

void loop() {}
