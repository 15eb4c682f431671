// SPDX-License-Identifier: MIT
// Sorts by round and place on the Hilbert curve: radix sort.
#include "encoder/stream/spatial_order.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#include "encoder/base/error.hpp"

namespace microtin::stream {
namespace {

constexpr uint64_t kRounds = 10;  // 8^10 > 2^24 points

// 0 for the last round, which takes 7 points of 8; then 1 for 7 of 8 of the rest, and so on.
uint64_t rounds_from_last(Point p) {
  uint64_t hash = scramble(static_cast<uint64_t>(p.x) << 16 | p.y);
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
    keys[i] = (round << kPositionBits | hilbert_position<16>(points[i].x, points[i].y))
                  << kNumberBits |
              i;
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
