// SPDX-License-Identifier: MIT
// The reconstruction when every decision is the fuzzer's: improbable ones, which few streams hold,
// come as easily as others. What every single step promises is checked after it.
#include <cmath>

#include "fuzz/support/device.hpp"
#include "fuzz/support/local_delaunay.hpp"

namespace {

using namespace microtin;
using namespace microtin::tests;

constexpr uint32_t kCapacity = 66;

// A coder that reads no stream: each decision takes a byte, which most often goes with the odds.
class Choices {
 public:
  Choices(const uint8_t* data, size_t size) : next_(data), end_(data + size) {}

  bool ended() const { return next_ == end_; }

  uint32_t byte() { return ended() ? 0 : *next_++; }

  bool bit(uint32_t probability, bool) {
    EXPECT(probability >= static_cast<uint32_t>(kProbabilityMargin) &&
           probability <= kProbabilityOne - static_cast<uint32_t>(kProbabilityMargin));
    cost_ += 9.01;
    const uint32_t choice = byte();
    if (choice >= 254) return choice == 255;
    return choice * 129 < probability;
  }

  uint32_t uniform(uint32_t count, uint32_t) {
    EXPECT(count >= 1 && count <= 65536);
    cost_ += std::log2(count) + 0.01;
    uint32_t choice = byte();
    if (count > 256) choice |= byte() << 8;
    return choice % count;
  }

  uint32_t uniform_or_escape(uint32_t count, uint32_t) {
    EXPECT(count <= 16384);
    const uint32_t choice = uniform(count + 1, 0);
    cost_ += choice == count ? 10.01 : 0.01;
    return choice;
  }

  Vertex next() const { return Vertex{0, 0, 0}; }
  bool last_phase() const { return false; }
  uint32_t batch() const { return 0; }
  bool conflicts(const Mesh&, Index) const { return false; }
  bool is_void(const Mesh&, Index) const { return false; }

  double take_cost() {
    const double cost = cost_;
    cost_ = 0;
    return cost;
  }

 private:
  const uint8_t* next_;
  const uint8_t* end_;
  double cost_ = 0;  // most bits that a range coder takes for the decisions
};

// Each array on its own, so that a step out of one is seen.
Point place[kCapacity];
int16_t z[kCapacity];
Index origin[6 * kCapacity], twin[6 * kCapacity], queue[kCapacity];
uint8_t marks[mark_bytes(kCapacity)], voids[(kCapacity + 3) / 4];
Residual residual[kCapacity];
Mesh mesh;
Reconstruction state;

Contract contract_from(Choices& choices) {
  constexpr uint16_t kSides[] = {0, 1, 2, 5, 20, 255, 1000, 65535};
  Contract contract{};
  contract.vertices = 3 + choices.byte() % (kCapacity - 2);
  contract.x_max = kSides[choices.byte() % 8];
  contract.y_max = kSides[choices.byte() % 8];
  contract.degree = kMinDegree + choices.byte() % (kMaxDegree - kMinDegree + 1);
  contract.decoding = static_cast<Decoding>(1 + choices.byte() % 3);
  const uint32_t flags = choices.byte();
  contract.has_heights = (flags & 1) != 0;
  contract.has_voids = (flags & 2) != 0;
  return contract;
}

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
  state.contract = contract_from(choices);
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
