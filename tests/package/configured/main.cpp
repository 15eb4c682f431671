// SPDX-License-Identifier: MIT
// A project with a configuration of its own: 16-bit numbers, a hook for asserts, no names and no
// sectors.
#include "microtin/microtin.hpp"
#include "microtin/pack.h"

namespace {

int broken = 0;

bool aligns(uint32_t sector) {
  alignas(MICROTIN_ALIGNMENT) static uint8_t space[MICROTIN_PACK_BYTES(1, 10)];
  microtin_pack* pack = nullptr;
  microtin_pack_init(space, sizeof space, 1, 10, &pack);
  return microtin_pack_align_reads(pack, sector) == MICROTIN_STATUS_OK;
}

}  // namespace

void broken_promise() {
  ++broken;
}

static_assert(MICROTIN_MAX_VERTICES == 10923, "the width that was chosen");

int main() {
  static microtin::Terrain<10> terrain;
  uint16_t x = 0, y = 0;
  int16_t z = 0;
  microtin_mesh_vertex(terrain.mesh(), 0, &x, &y, &z);  // it has none
  return broken == 1 && microtin_status_name(MICROTIN_STATUS_OK)[0] == '\0' &&
                 microtin_query_result_name(MICROTIN_QUERY_OK)[0] == '\0' && aligns(0) &&
                 !aligns(512)
             ? 0
             : 1;
}
