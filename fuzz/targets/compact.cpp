// SPDX-License-Identifier: MIT
// The mesh and its compact form side by side, of whatever was decoded, also after an early stop:
// made in calls of any length, in memory of its own or in place, it answers the same, from any
// hint. The fuzzer asks by the last bytes of its input.
#include <fuzzer/FuzzedDataProvider.h>

#include <vector>

#include "fuzz/support/device.hpp"
#include "fuzz/support/stream_mutator.hpp"
#include "tests/support/compact_pair.hpp"

namespace {

using namespace microtin;
using namespace microtin::tests;

constexpr uint32_t kCapacity = 1200;

struct Made {
  microtin_status status;
  microtin_compact* compact;
  size_t bytes, scratch_bytes;
};

Made make(void* target, size_t size, microtin_mesh* mesh, void* scratch, size_t scratch_size,
          uint32_t piece) {
  Made made = {MICROTIN_STEP_LIMIT, nullptr, 0, 0};
  const uint32_t calls = (44 * microtin_vertex_count(mesh) + 44) / piece + 2;
  microtin_compactor* compactor = nullptr;
  EXPECT(microtin_compact_begin(target, size, mesh, scratch, scratch_size, &compactor) ==
         MICROTIN_DONE);
  for (uint32_t i = 0; i < calls && made.status == MICROTIN_STEP_LIMIT; ++i) {
    made.status = microtin_compact_proceed(compactor, piece, &made.compact);
  }
  EXPECT(made.status != MICROTIN_STEP_LIMIT);
  microtin_compact_needs(compactor, &made.bytes, &made.scratch_bytes);
  return made;
}

// In exactly the memory that it asks for; from the heap, so that nothing beside is touched unseen.
void check_exact(const microtin_mesh* mesh, Device& victim, FuzzedDataProvider& asked) {
  const uint64_t digest = microtin_digest(mesh);
  std::vector<uint64_t> scratch(MICROTIN_DECODER_BYTES(2 * kCapacity) / 8);
  uint64_t none = 0;
  const Made told = make(&none, sizeof none, victim.mesh, scratch.data(), 8 * scratch.size(), 999);
  EXPECT(told.status == MICROTIN_WORKSPACE_TOO_SMALL);
  EXPECT(microtin_digest(victim.mesh) == digest);
  std::vector<uint64_t> exact((told.bytes + 7) / 8), exact_scratch((told.scratch_bytes + 7) / 8);
  const uint32_t piece = asked.ConsumeIntegralInRange<uint32_t>(1, 2000);
  const Made made =
      make(exact.data(), told.bytes, victim.mesh, exact_scratch.data(), told.scratch_bytes, piece);
  EXPECT(made.status == MICROTIN_DONE && made.bytes == told.bytes);
  EXPECT(microtin_compact_size(made.compact) == told.bytes);
  Random random(asked.ConsumeIntegral<uint64_t>());
  EXPECT(difference(mesh, made.compact, 60, random).empty());
}

void check_in_place(const microtin_mesh* mesh, Workspaces<kCapacity>& own, Device& victim,
                    FuzzedDataProvider& asked) {
  const uint32_t piece = asked.ConsumeIntegralInRange<uint32_t>(1, 2000);
  const Made made =
      make(own.mesh, sizeof own.mesh, victim.mesh, own.decoder, sizeof own.decoder, piece);
  if (made.status != MICROTIN_DONE) {
    EXPECT(made.status == MICROTIN_WORKSPACE_TOO_SMALL);
    EXPECT(microtin_digest(victim.mesh) == microtin_digest(mesh));
    return;
  }
  Random random(asked.ConsumeIntegral<uint64_t>());
  EXPECT(difference(mesh, made.compact, 60, random).empty());
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static Workspaces<kCapacity> workspaces, victims;
  FuzzedDataProvider asked(data, size);
  Device device = workspaces.device();
  const uint32_t phases = asked.ConsumeIntegralInRange<uint32_t>(0, 12);
  microtin_stop_after_phase(device.decoder, phases);
  device.decode(data, size);
  Device victim = victims.device();
  microtin_stop_after_phase(victim.decoder, phases);
  victim.decode(data, size);
  const uint32_t vertices = microtin_vertex_count(device.mesh);
  if (vertices == 0 || device.mesh->verified_vertices != vertices) {
    microtin_compactor* compactor = nullptr;
    uint64_t scratch[40];
    EXPECT(microtin_compact_begin(victims.decoder, sizeof victims.decoder, victim.mesh, scratch,
                                  sizeof scratch, &compactor) == MICROTIN_ARGUMENT);
    return 0;
  }
  if (asked.ConsumeBool()) {
    check_exact(device.mesh, victim, asked);
  } else {
    check_in_place(device.mesh, victims, victim, asked);
  }
  return 0;
}
