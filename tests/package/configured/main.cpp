// SPDX-License-Identifier: MIT
// A project with a configuration of its own: 16-bit numbers, a hook for asserts, no names.
#include "microtin/microtin.hpp"

namespace {

int broken = 0;

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
                 microtin_query_result_name(MICROTIN_QUERY_OK)[0] == '\0'
             ? 0
             : 1;
}
