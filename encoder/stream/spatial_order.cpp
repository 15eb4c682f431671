#include "encoder/stream/spatial_order.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "encoder/base/error.hpp"

namespace microtin::stream {
namespace {

constexpr uint64_t kRounds = 10;  // 8^10 > 2^24 points

// The Hilbert curve through the whole lattice, four bits of x and y at a time. Each square of the
// curve is the first one, its axes swapped (bit 0 of the orientation), reversed (bit 1), or both.
struct HilbertStep {
  uint8_t position;     // among the 16 x 16 squares
  uint8_t orientation;  // of what lies in the square
};
using HilbertSteps = std::array<HilbertStep, 4 * 256>;  // by orientation, x, y

constexpr HilbertStep hilbert_step(uint32_t orientation, uint32_t x, uint32_t y) {
  uint32_t position = 0;
  for (uint32_t side = 8; side != 0; side >>= 1) {
    const bool swapped = (orientation & 1) != 0, reversed = (orientation & 2) != 0;
    const bool right = (((swapped ? y : x) & side) != 0) != reversed;
    const bool upper = (((swapped ? x : y) & side) != 0) != reversed;
    position = position << 2 | ((right ? 3u : 0u) ^ (upper ? 1u : 0u));
    if (!upper) orientation ^= right ? 3u : 1u;
  }
  return {static_cast<uint8_t>(position), static_cast<uint8_t>(orientation)};
}

constexpr HilbertSteps hilbert_steps() {
  HilbertSteps steps{};
  for (uint32_t i = 0; i < steps.size(); ++i) {
    steps[i] = hilbert_step(i >> 8, i >> 4 & 15u, i & 15u);
  }
  return steps;
}

constexpr HilbertSteps kHilbertSteps = hilbert_steps();

uint64_t hilbert_position(Point p) {
  uint64_t position = 0;
  uint32_t orientation = 0;
  for (int shift = 12; shift >= 0; shift -= 4) {
    const uint32_t x = p.x >> shift & 15, y = p.y >> shift & 15;
    const HilbertStep step = kHilbertSteps[orientation << 8 | x << 4 | y];
    position = position << 8 | step.position;
    orientation = step.orientation;
  }
  return position;
}

// 0 for the last round, which takes 7 points of 8; then 1 for 7 of 8 of the rest, and so on.
uint64_t rounds_from_last(Point p) {
  uint64_t hash = (static_cast<uint64_t>(p.x) << 16 | p.y) + 0x9e3779b97f4a7c15u;
  hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9u;  // SplitMix64
  hash = (hash ^ hash >> 27) * 0x94d049bb133111ebu;
  uint64_t rounds = 0;
  for (; rounds < kRounds - 1 && (hash >> 61) == 0; hash <<= 3) ++rounds;
  return rounds;
}

// A round, a position on the curve, and the number of the point there.
constexpr int kNumberBits = 28, kPositionBits = 32, kRoundBits = 4;

// Sorts by round and position: radix sort, one digit at a time, the lowest first.
void sort_keys(std::vector<uint64_t>& keys) {
  constexpr int kDigitBits = 9;
  static_assert((kPositionBits + kRoundBits) % kDigitBits == 0, "whole digits");
  std::vector<uint64_t> sorted(keys.size());
  for (int shift = kNumberBits; shift < 64; shift += kDigitBits) {
    std::array<std::size_t, (1u << kDigitBits) + 1> starts{};
    const auto digit = [&](uint64_t key) { return key >> shift & ((1u << kDigitBits) - 1u); };
    for (const uint64_t key : keys) ++starts[digit(key) + 1];
    for (std::size_t i = 1; i < starts.size(); ++i) starts[i] += starts[i - 1];
    for (const uint64_t key : keys) sorted[starts[digit(key)]++] = key;
    keys.swap(sorted);
  }
}

}  // namespace

std::vector<Index> insertion_order(const std::vector<Point>& points) {
  if (points.size() >> kNumberBits != 0) throw Error("too many points to triangulate");
  std::vector<uint64_t> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const uint64_t round = kRounds - 1 - rounds_from_last(points[i]);
    keys[i] = (round << kPositionBits | hilbert_position(points[i])) << kNumberBits | i;
  }
  sort_keys(keys);
  std::vector<Index> order(points.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    // A place has only one round and position.
    if (i != 0 && keys[i] >> kNumberBits == keys[i - 1] >> kNumberBits) {
      throw Error("two vertices share a place");
    }
    order[i] = static_cast<Index>(keys[i] & ((uint64_t{1} << kNumberBits) - 1));
  }
  return order;
}

}  // namespace microtin::stream
