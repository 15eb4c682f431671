// SPDX-License-Identifier: MIT
// The reconstruction when every decision is the fuzzer's. What every single step promises is
// checked after it.
#include "fuzz/support/choices.hpp"

#include "fuzz/support/device.hpp"
#include "fuzz/support/local_delaunay.hpp"

namespace {

using namespace microtin;
using namespace microtin::tests;

constexpr uint32_t kCapacity = 66;

// Each array on its own, so that a step out of one is seen.
Point place[kCapacity];
int16_t z[kCapacity];
Index origin[6 * kCapacity], twin[6 * kCapacity], queue[kCapacity];
uint8_t marks[mark_bytes(kCapacity)], voids[(kCapacity + 3) / 4];
Residual residual[kCapacity];
Mesh mesh;
Reconstruction state;

// What holds between steps of a walk.
void check_walk(Index placed_before) {
  EXPECT(mesh.origin[next_in_triangle(state.chord)] == state.vertex);
  EXPECT(state.queue_head <= state.queue_tail && state.queue_tail <= mesh.vertices);
  if (mesh.vertices == placed_before) return;
  EXPECT(mesh.vertices == placed_before + 1);
  const Index v = mesh.vertices - 1;
  Index h = 0;
  while (mesh.origin[h] != v) ++h;
  EXPECT(degree_up_to(mesh, h, kMaxDegree + 1) <= state.contract.degree);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  Choices choices(data, size);
  mesh = Mesh{place, z, origin, twin, 0, 0};
  state.mesh = &mesh;
  state.queue = queue;
  state.marks = marks;
  state.voids = voids;
  state.residual = residual;
  state.contract = contract_from(choices, kCapacity);
  start(state);
  uint32_t steps = 0;
  while (state.stage != Stage::kComplete && !choices.ended()) {
    const Index placed = mesh.vertices;
    const StepOutcome outcome = step(state, choices);
    EXPECT(choices.take_cost() <= 8.0 * kStepBytes);
    EXPECT(++steps <= most_steps(state.contract.vertices));
    if (outcome == StepOutcome::kMalformed) break;
    if (state.stage == Stage::kWalk) check_walk(placed);
  }
  if (state.stage == Stage::kComplete) EXPECT(step(state, choices) == StepOutcome::kMalformed);
  EXPECT(mesh.triangles == 0 || is_locally_delaunay(mesh));
  return 0;
}
