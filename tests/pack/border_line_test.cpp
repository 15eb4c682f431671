// SPDX-License-Identifier: MIT
// Chains of vertices along borders of tiles.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>

#include "encoder/pack/borders.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {
namespace {

constexpr int32_t kOne = 65536;

LinePost post_at(uint16_t place, int32_t height, int32_t bound, int32_t aim) {
  return {Sample{{place, 0}, height * kOne, (height - bound) * kOne, (height + bound) * kOne},
          false, aim * kOne};
}

// In steps, at each post.
std::vector<double> heights_of(const std::vector<ChainVertex>& chain) {
  std::vector<double> heights;
  for (std::size_t v = 0; v + 1 < chain.size(); ++v) {
    const ChainVertex &a = chain[v], &b = chain[v + 1];
    for (uint32_t post = a.post; post < b.post; ++post) {
      heights.push_back(a.height + static_cast<double>(b.height - a.height) * (post - a.post) /
                                       (b.post - a.post));
    }
  }
  heights.push_back(chain.back().height);
  return heights;
}

}  // namespace

TEST_CASE("border lines: few vertices, every post within its bounds") {
  Random random(5);
  for (const int bound : {1, 3, 12}) {
    std::vector<LinePost> posts;
    for (uint16_t i = 0; i < 400; ++i) {
      const auto height = static_cast<int32_t>(std::lround(40 * std::sin(i * 0.05))) +
                          static_cast<int32_t>(random.below(3)) - 1;
      posts.push_back(post_at(i, height, bound, height));
    }
    const std::vector<ChainVertex> chain = simplify_line(posts, ErrorModel{true}, 4);
    const std::vector<double> heights = heights_of(chain);
    REQUIRE(heights.size() == posts.size());
    for (std::size_t i = 0; i < posts.size(); ++i) {
      CHECK(std::abs(heights[i] - posts[i].sample->height / 65536.0) <= bound + 1e-9);
    }
    CHECK(chain.size() < (bound == 1 ? 300 : bound == 3 ? 60 : 30));
  }
}

// A chain that is free within its bounds stands out of the ground around it.
TEST_CASE("border lines: where posts leave room, they come near to the aims") {
  Random random(6);
  std::vector<LinePost> posts;
  for (uint16_t i = 0; i < 500; ++i) {
    posts.push_back(post_at(i, static_cast<int32_t>(random.below(17)) - 8, 20, 5));
  }
  const std::vector<ChainVertex> chain = simplify_line(posts, ErrorModel{true}, 4);
  CHECK(chain.size() < 10);
  double above = 0;
  for (const double height : heights_of(chain)) above += height - 5;
  CHECK(std::abs(above / 500) < 2);  // 5 if it came near to the posts
}

TEST_CASE("border lines: without bounds all posts are vertices, and voids part chains") {
  std::vector<LinePost> posts;
  for (uint16_t i = 0; i < 9; ++i) posts.push_back(post_at(i, 7 * i, 0, 0));
  CHECK(simplify_line(posts, ErrorModel{false}, 4).size() == 9);
  CHECK(simplify_line(posts, ErrorModel{true}, 4).size() == 2);
  posts[4].sample.reset();
  const std::vector<ChainVertex> chain = simplify_line(posts, ErrorModel{true}, 4);
  REQUIRE(chain.size() == 4);
  CHECK(chain[1].post == 3);
  CHECK(chain[2].post == 5);
}

}  // namespace microtin::tests
