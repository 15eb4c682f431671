// SPDX-License-Identifier: MIT
// A mesh, as any stream may make it, and its compact form side by side: made in calls of any
// length, in memory of its own or in place, it answers the same, from any hint. Every decision of
// decoding is the fuzzer's, so that nearly all inputs lead to a mesh; it asks by their last bytes.
#include <fuzzer/FuzzedDataProvider.h>

#include <cstring>
#include <iterator>
#include <vector>

#include "fuzz/support/choices.hpp"
#include "fuzz/support/device.hpp"
#include "shared/header.hpp"
#include "tests/support/compact_pair.hpp"

namespace {

using namespace microtin;
using namespace microtin::tests;

constexpr uint32_t kCapacity = 200;

Workspaces<kCapacity> workspaces;

struct Made {
  microtin_status status;
  microtin_compact* compact;
  size_t bytes, scratch_bytes;
};

Made make(void* target, size_t size, microtin_mesh* mesh, void* scratch, size_t scratch_size,
          uint32_t piece) {
  Made made = {MICROTIN_STATUS_STEP_LIMIT, nullptr, 0, 0};
  const uint32_t calls = (44 * microtin_mesh_vertex_count(mesh) + 44) / piece + 2;
  microtin_compactor* compactor = nullptr;
  EXPECT(microtin_compactor_init(target, size, mesh, scratch, scratch_size, &compactor) ==
         MICROTIN_STATUS_OK);
  for (uint32_t i = 0; i < calls && made.status == MICROTIN_STATUS_STEP_LIMIT; ++i) {
    made.status = microtin_compactor_run(compactor, &made.compact, piece);
  }
  EXPECT(made.status != MICROTIN_STATUS_STEP_LIMIT);
  microtin_compactor_required_bytes(compactor, &made.bytes, &made.scratch_bytes);
  return made;
}

// From the heap, so that sanitizers see accesses next to it.
typedef std::vector<uint64_t> Memory;

Memory memory_of(size_t bytes) {
  return Memory((bytes + 7) / 8);
}

Memory copy_of(const void* from, size_t bytes) {
  Memory copy = memory_of(bytes);
  std::memcpy(copy.data(), from, bytes);
  return copy;
}

// In exactly the memory that it asks for.
Memory made_apart(microtin_mesh* mesh, uint32_t piece) {
  const uint64_t digest = microtin_mesh_digest(mesh);
  Memory none(1), all = memory_of(MICROTIN_DECODER_BYTES(2 * kCapacity));
  const Made told = make(none.data(), 8, mesh, all.data(), 8 * all.size(), 999);
  EXPECT(told.status == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  EXPECT(microtin_mesh_digest(mesh) == digest);
  Memory space = memory_of(told.bytes), scratch = memory_of(told.scratch_bytes);
  const Made made = make(space.data(), told.bytes, mesh, scratch.data(), told.scratch_bytes, piece);
  EXPECT(made.status == MICROTIN_STATUS_OK && made.bytes == told.bytes);
  EXPECT(microtin_compact_size(made.compact) == told.bytes);
  return space;
}

// Nothing, if there is no room.
Memory made_in_place(microtin_mesh* mesh, uint32_t piece) {
  const uint64_t digest = microtin_mesh_digest(mesh);
  const Made made = make(workspaces.mesh, sizeof workspaces.mesh, mesh, workspaces.decoder,
                         sizeof workspaces.decoder, piece);
  if (made.status == MICROTIN_STATUS_OK) return copy_of(made.compact, made.bytes);
  EXPECT(made.status == MICROTIN_STATUS_WORKSPACE_TOO_SMALL &&
         microtin_mesh_digest(mesh) == digest);
  return Memory();
}

// One input of eight goes on at random: most are short, so their meshes are small.
std::vector<uint8_t> decisions(const uint8_t* data, size_t size, FuzzedDataProvider& asked) {
  std::vector<uint8_t> bytes(data, data + size);
  if (asked.ConsumeIntegralInRange(0, 7) == 7) {
    Random random(asked.ConsumeIntegral<uint64_t>());
    std::generate_n(std::back_inserter(bytes), 3000,
                    [&random] { return static_cast<uint8_t>(random.next()); });
  }
  return bytes;
}

void decide(Reconstruction& state, Choices choices) {
  state.contract = contract_from(choices, kCapacity);
  start(state);
  while (state.stage != Stage::kComplete && !choices.ended()) {
    if (step(state, choices) == StepOutcome::kMalformed) break;
  }
}

// As if a section ended here; what bytes would be wasted on is at random.
void finish(microtin_mesh* mesh, Random random) {
  place_on_lattice(mesh->axis);
  mesh->is_placed = true;
  mesh->verified_vertices = mesh->mesh.vertices;
  mesh->has_voids = random.below(2) == 0;
  for (Index v = 0; v < mesh->mesh.vertices; ++v) {
    mesh->mesh.z[v] = static_cast<int16_t>(random.next());
  }
  for (Index t = 0; t < mesh->mesh.triangles; t += 8) {
    mesh->voids[t / 8] = static_cast<uint8_t>(random.next() & random.next());
  }
}

void check_refused(microtin_mesh* mesh) {
  microtin_compactor* compactor = nullptr;
  Memory space(40), scratch(40);
  EXPECT(microtin_compactor_init(space.data(), 320, mesh, scratch.data(), 320, &compactor) ==
         MICROTIN_STATUS_ARGUMENT);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  FuzzedDataProvider asked(data, size);
  Device device = workspaces.device();
  const std::vector<uint8_t> bytes = decisions(data, size, asked);
  decide(device.decoder->reconstruction, Choices(bytes.data(), bytes.size()));
  check_refused(device.mesh);
  if (device.mesh->mesh.triangles == 0) return 0;
  finish(device.mesh, Random(asked.ConsumeIntegral<uint64_t>()));
  const Memory mesh = copy_of(workspaces.mesh, sizeof workspaces.mesh);
  const uint32_t piece = asked.ConsumeIntegralInRange<uint32_t>(1, 2000);
  const bool apart = asked.ConsumeBool();
  const Memory made = apart ? made_apart(device.mesh, piece) : made_in_place(device.mesh, piece);
  if (made.empty()) return 0;
  std::memcpy(workspaces.mesh, mesh.data(), sizeof workspaces.mesh);
  Random random(asked.ConsumeIntegral<uint64_t>());
  EXPECT(difference(device.mesh, reinterpret_cast<const microtin_compact*>(made.data()), 60, random)
             .empty());
  return 0;
}
