// SPDX-License-Identifier: MIT
// The ground around posts: noise is averaged out, hills are not.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

#include "encoder/pack/borders.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {
namespace {

constexpr int32_t kUnit = 65536, kBound = 8 * kUnit;
constexpr uint32_t kWidth = 60, kHeight = 40;

std::vector<Sample> samples_of(const std::function<int32_t(uint16_t, uint16_t)>& height) {
  std::vector<Sample> samples;
  for (uint16_t x = 0; x < kWidth; ++x) {
    for (uint16_t y = 0; y < kHeight; ++y) {
      const int32_t z = height(x, y);
      samples.push_back({{x, y}, z, z - kBound, z + kBound});
    }
  }
  return samples;
}

}  // namespace

TEST_CASE("ground: of noise on a slope the slope is left") {
  Random random(11);
  const auto slope = [](uint32_t x, uint32_t y) {
    return 3 * static_cast<int32_t>(x) * kUnit - 2 * static_cast<int32_t>(y) * kUnit;
  };
  const Ground ground(samples_of([&](uint16_t x, uint16_t y) {
                        return slope(x, y) + (static_cast<int32_t>(random.below(9)) - 4) * kUnit;
                      }),
                      kWidth, kHeight);
  double squares = 0, posts = 0;
  for (uint32_t x = 8; x < kWidth - 8; ++x) {
    for (uint32_t y = 8; y < kHeight - 8; ++y, ++posts) {
      squares += std::pow((ground.at(x, y, kBound / 4) - slope(x, y)) / double{kUnit}, 2);
    }
  }
  CHECK(std::sqrt(squares / posts) < 0.65);                                  // of noise: 2.58
  CHECK(std::abs(ground.at(0, 20, kBound / 4) - slope(0, 20)) < 4 * kUnit);  // a line of posts
}

TEST_CASE("ground: a ridge keeps its height, within the tolerance") {
  const auto ridge = [](uint32_t x) {
    return (100 - 3 * std::abs(static_cast<int32_t>(x) - 30)) * kUnit;
  };
  const Ground ground(samples_of([&](uint16_t x, uint16_t) { return ridge(x); }), kWidth, kHeight);
  CHECK(ground.at(30, 20, 2 * kUnit) > ridge(30) - 5 * kUnit);
  CHECK(ground.at(30, 20, 100 * kUnit) < ridge(30) - 10 * kUnit);
}

TEST_CASE("ground: squares end before voids") {
  std::vector<Sample> samples =
      samples_of([](uint16_t x, uint16_t) { return x < 22 ? 0 : 6 * kUnit; });
  CHECK(Ground(samples, kWidth, kHeight).at(20, 20, kBound) > 0);
  samples.erase(samples.begin() + 22 * kHeight + 20);
  CHECK(Ground(samples, kWidth, kHeight).at(20, 20, kBound) == 0);
}

}  // namespace microtin::tests
