// SPDX-License-Identifier: MIT
// A decoder in workspaces of its own.
#ifndef MICROTIN_FUZZ_SUPPORT_DEVICE_HPP
#define MICROTIN_FUZZ_SUPPORT_DEVICE_HPP

#include <cstddef>
#include <cstdint>

#include "decoder/state.hpp"
#include "fuzz/support/expect.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {

// Steps that suffice for any stream of n vertices. A step inserts a vertex, starts a phase, codes a
// void flag, or passes one of the six half-edges per vertex that a phase walks over; all phases
// together walk around no more vertices than the budget allows.
constexpr uint32_t most_steps(uint32_t n) {
  return 7 * work_budget(n) + 3 * n;
}

class Device {
 public:
  Device(void* mesh_workspace, size_t mesh_bytes, void* decoder_workspace, size_t decoder_bytes) {
    EXPECT(microtin_mesh_init(mesh_workspace, mesh_bytes, &mesh) == MICROTIN_STATUS_OK);
    EXPECT(microtin_decoder_init(decoder_workspace, decoder_bytes, mesh, &decoder) ==
           MICROTIN_STATUS_OK);
  }

  // Feeds a whole stream in one call, which must end in its last status.
  microtin_status decode(const uint8_t* bytes, size_t size) {
    size_t used = 0;
    const microtin_status status =
        microtin_decoder_feed(decoder, bytes, size, &used, most_steps(decoder->capacity));
    EXPECT(status != MICROTIN_STATUS_STEP_LIMIT);
    EXPECT(used <= size && microtin_decoder_bytes_used(decoder) <= used);
    if (status == MICROTIN_STATUS_OK) EXPECT(microtin_decoder_bytes_used(decoder) == used);
    if (status == MICROTIN_STATUS_NEED_INPUT) EXPECT(used == size);
    return microtin_decoder_finish(decoder);
  }

  microtin_mesh* mesh = nullptr;
  microtin_decoder* decoder = nullptr;
};

template <uint32_t kCapacity>
struct Workspaces {
  alignas(MICROTIN_ALIGNMENT) unsigned char mesh[MICROTIN_MESH_BYTES(kCapacity)];
  alignas(MICROTIN_ALIGNMENT) unsigned char decoder[MICROTIN_DECODER_BYTES(kCapacity)];

  Device device() { return Device(mesh, sizeof mesh, decoder, sizeof decoder); }
};

}  // namespace microtin::tests

#endif
