// SPDX-License-Identifier: MIT
// Workspaces of the sizes of microtin.h hold that many vertices, and one byte less holds one
// fewer: never more than fit.
#include <cstdio>

#include "decoder/state.hpp"

namespace {

microtin_mesh mesh_header;
microtin_decoder decoder_header;

// What a workspace of that size would hold; nothing behind its first bytes is touched.
uint32_t mesh_capacity(unsigned long size) {
  microtin_mesh* mesh = nullptr;
  return microtin_mesh_init(&mesh_header, size, &mesh) == MICROTIN_STATUS_OK ? mesh->capacity : 0;
}

uint32_t decoder_capacity(unsigned long size) {
  microtin_decoder* decoder = nullptr;
  return microtin_decoder_init(&decoder_header, size, &mesh_header, &decoder) == MICROTIN_STATUS_OK
             ? decoder->capacity
             : 0;
}

}  // namespace

int main() {
  unsigned long wrong = 0;
  const auto check = [&wrong](uint32_t capacity, unsigned long expected) {
    if (capacity == expected) return;
    std::printf("%lu vertices fit, not %lu\n", expected, static_cast<unsigned long>(capacity));
    ++wrong;
  };
  const unsigned long most = MICROTIN_MAX_VERTICES;
  for (unsigned long n = 4; n <= most; n += n < most - 1000 ? 7 : 1) {
    check(mesh_capacity(MICROTIN_MESH_BYTES(n)), n);
    check(mesh_capacity(MICROTIN_MESH_BYTES(n) - 1), n - 1);
    check(decoder_capacity(MICROTIN_DECODER_BYTES(n)), n);
    check(decoder_capacity(MICROTIN_DECODER_BYTES(n) - 1), n - 1);
  }
  check(mesh_capacity(MICROTIN_MESH_BYTES(most + 5)), most);
  check(mesh_capacity(~0ul), most);
  return wrong == 0 ? 0 : 1;
}
