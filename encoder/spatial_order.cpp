#include "encoder/spatial_order.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace microtin {
namespace {

constexpr uint64_t kRounds = 10;  // 8^10 > 2^24 points

// The place's position on the Hilbert curve through the whole lattice.
uint32_t hilbert_position(Point p) {
  uint32_t x = p.x, y = p.y, position = 0;
  for (uint32_t side = 1u << 15; side != 0; side >>= 1) {
    const uint32_t right = (x & side) != 0, upper = (y & side) != 0;
    position = position << 2 | ((3u * right) ^ upper);
    if (upper == 0) {
      if (right != 0) {
        x = ~x;
        y = ~y;
      }
      std::swap(x, y);
    }
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

}  // namespace

std::vector<Index> insertion_order(const std::vector<Point>& points) {
  std::vector<std::pair<uint64_t, Index>> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const uint64_t round = kRounds - 1 - rounds_from_last(points[i]);
    keys[i] = {round << 32 | hilbert_position(points[i]), static_cast<Index>(i)};
  }
  std::sort(keys.begin(), keys.end());
  std::vector<Index> order(points.size());
  for (std::size_t i = 0; i < keys.size(); ++i) order[i] = keys[i].second;
  return order;
}

}  // namespace microtin
