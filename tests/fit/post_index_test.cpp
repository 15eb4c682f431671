// SPDX-License-Identifier: MIT
// Which posts lie under a triangle, compared with a look at every one.
#include "encoder/fit/post_index.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "tests/support/point_sets.hpp"

namespace microtin::tests {
namespace {

// Numbers of posts, or more than there are of those whose place is another one.
std::vector<uint32_t> found(const PostIndex& index, const Points& posts, Point a, Point b,
                            Point c) {
  std::vector<uint32_t> numbers;
  index.visit_under(a, b, c, [&](uint32_t i, Point place) {
    numbers.push_back(place == posts[i] ? i : UINT32_MAX);
  });
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::vector<uint32_t> expected(const Points& posts, Point a, Point b, Point c) {
  std::vector<uint32_t> numbers;
  for (uint32_t i = 0; i < posts.size(); ++i) {
    const Point p = posts[i];
    if (orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0) {
      numbers.push_back(i);
    }
  }
  return numbers;
}

void check(const Points& posts, uint32_t side, Random& random) {
  const PostIndex index(posts);
  std::size_t wrong = 0, hits = 0;
  for (int round = 0; round < 300; ++round) {
    Point corner[3];
    for (Point& p : corner) {  // a post, or any place: beyond the posts, too
      const bool post = random.below(2) == 0;
      p = post ? posts[random.below(static_cast<uint32_t>(posts.size()))] : point_in(random, side);
    }
    const int64_t turn = orient2d(corner[0], corner[1], corner[2]);
    if (turn == 0) continue;
    if (turn < 0) std::swap(corner[0], corner[1]);
    const std::vector<uint32_t> all = expected(posts, corner[0], corner[1], corner[2]);
    hits += all.size();
    if (found(index, posts, corner[0], corner[1], corner[2]) != all) ++wrong;
  }
  for (uint32_t i = 0; i < posts.size(); ++i) {
    const auto at = index.find(posts[i]);
    if (!at || index.number(*at) != i || index.place(*at) != posts[i]) ++wrong;
    const Point elsewhere = point_in(random, side);
    const bool is_post = std::find(posts.begin(), posts.end(), elsewhere) != posts.end();
    if (index.find(elsewhere).has_value() != is_post) ++wrong;
  }
  CHECK(wrong == 0);
  CHECK(hits > 300);
}

}  // namespace

TEST_CASE("post index: rasters, whole and with gaps") {
  Random random(21);
  for (const uint32_t keep : {100u, 90u, 40u, 5u}) {
    CAPTURE(keep);
    check(lattice_points(31, 24, random, keep), 40, random);
  }
}

TEST_CASE("post index: scattered points of every kind") {
  Random random(22);
  for (const PointSet& set : point_sets(200, 5)) {
    CAPTURE(set.name);
    check(set.points, 65536, random);
  }
}

TEST_CASE("post index: crowds far apart, far from the origin") {
  Random random(23);
  Points crowds = lattice_points(80, 60, random, 80);
  for (Point& p : crowds) p = {static_cast<uint16_t>(p.x + 60000), static_cast<uint16_t>(p.y + 9)};
  check(crowds, 65536, random);
  crowds.push_back({3, 65000});
  std::reverse(crowds.begin(), crowds.end());  // their order does not matter
  check(crowds, 65536, random);
}

TEST_CASE("post index: none") {
  CHECK(found(PostIndex({}), {}, {0, 0}, {9, 0}, {0, 9}).empty());
}

}  // namespace microtin::tests
