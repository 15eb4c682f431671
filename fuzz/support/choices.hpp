// SPDX-License-Identifier: MIT
// A coder for the reconstruction that reads no stream: every decision is the fuzzer's, so that
// improbable ones, which few streams hold, come as easily as others.
#ifndef MICROTIN_FUZZ_SUPPORT_CHOICES_HPP
#define MICROTIN_FUZZ_SUPPORT_CHOICES_HPP

#include <cmath>

#include "fuzz/support/expect.hpp"
#include "shared/reconstruction.hpp"
#include "tests/support/layers.hpp"

namespace microtin::tests {

// Each decision takes a byte, which most often goes with the odds.
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

  // Most bits that a range coder takes for the decisions since the last time.
  double take_cost() {
    const double cost = cost_;
    cost_ = 0;
    return cost;
  }

 private:
  const uint8_t* next_;
  const uint8_t* end_;
  double cost_ = 0;
};

// A contract of at most `capacity` vertices, 258 at most.
inline Contract contract_from(Choices& choices, uint32_t capacity) {
  constexpr uint16_t kSides[] = {0, 1, 2, 5, 20, 255, 1000, 65535};
  Contract contract{};
  contract.vertices = 3 + choices.byte() % (capacity - 2);
  contract.x_max = kSides[choices.byte() % 8];
  contract.y_max = kSides[choices.byte() % 8];
  contract.degree = kMinDegree + choices.byte() % (kMaxDegree - kMinDegree + 1);
  contract.coding = static_cast<Coding>(1 + choices.byte() % 3);
  const uint32_t flags = choices.byte();
  contract.has_heights = (flags & 1) != 0;
  contract.has_voids = (flags & 2) != 0;
  return contract;
}

}  // namespace microtin::tests

#endif
