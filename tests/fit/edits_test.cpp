// SPDX-License-Identifier: MIT
// Taking back what was done to a surface.
#include <doctest/doctest.h>

#include <algorithm>
#include <tuple>

#include "encoder/fit/simplify.hpp"
#include "encoder/fit/surface.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {
namespace {

using Place = std::tuple<uint16_t, uint16_t, int16_t>;

std::vector<Place> vertices_of(const Surface& surface) {
  std::vector<Place> vertices;
  for (const Vertex v : surface.tin().vertices) vertices.emplace_back(v.x, v.y, v.z);
  std::sort(vertices.begin(), vertices.end());
  return vertices;
}

Survey bumps() {
  Survey survey;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) {
      const int32_t height = (x * y % 7 + x / 3) * 65536;
      survey.samples.push_back({point(x, y), height, height - 65536, height + 65536});
    }
  }
  return survey;
}

Points places_of(const Survey& survey) {
  Points places;
  for (const Sample& s : survey.samples) places.push_back(s.place);
  return places;
}

}  // namespace

TEST_CASE("edits: rolled back, everything is as it was") {
  const Survey survey = bumps();
  const PostIndex posts(places_of(survey));
  const PostLimits limits(survey, ErrorModel{true}, posts);
  Surface surface(survey, ErrorModel{true}, posts, limits,
                  simplify(survey, {true, 0, Search::kGreedy, false, true, 1, {}, {}}));
  Edits edits(surface);
  const std::vector<Place> before = vertices_of(surface);
  Random random(31);
  std::size_t removed = 0, inserted = 0, marked = 0;
  std::vector<Place> at_mark;
  for (int i = 0; i < 200; ++i) {
    if (i == 100) {
      marked = edits.size();
      at_mark = vertices_of(surface);
    }
    const Index v = random.below(surface.vertex_limit());
    if (!surface.has_vertex(v)) continue;
    if (random.below(3) == 0) {
      CHECK(edits.set_height(v, static_cast<int32_t>(random.below(50))));
    } else if (!surface.is_fixed(v) && edits.remove(v)) {
      ++removed;
      const Point p = survey.samples[random.below(400)].place;
      const auto is_there = [&](const Place& place) {
        return std::get<0>(place) == p.x && std::get<1>(place) == p.y;
      };
      const std::vector<Place> now = vertices_of(surface);
      const Index hint = surface.edge_of(kInfinity);
      const bool taken = std::any_of(now.begin(), now.end(), is_there);
      CHECK(surface.can_insert(p, hint) != taken);
      if (taken) continue;
      edits.insert({p.x, p.y, 5}, kInfinity);
      ++inserted;
    }
  }
  CHECK(removed > 20);
  CHECK(inserted > 5);
  CHECK(surface.vertices() == vertices_of(surface).size());
  edits.roll_back(marked);
  CHECK(vertices_of(surface) == at_mark);
  edits.roll_back(0);
  CHECK(vertices_of(surface) == before);
  CHECK(surface.vertices() == before.size());
}

TEST_CASE("edits: heights beyond 16 bits are refused") {
  const Survey survey = bumps();
  const PostIndex posts(places_of(survey));
  const PostLimits limits(survey, ErrorModel{true}, posts);
  Surface surface(survey, ErrorModel{true}, posts, limits,
                  simplify(survey, {true, 0, Search::kGreedy, false, true, 1, {}, {}}));
  Edits edits(surface);
  CHECK_FALSE(edits.set_height(0, 32768));
  CHECK_FALSE(edits.set_height(0, -32769));
  CHECK(edits.size() == 0);
  CHECK(edits.set_height(0, -32768));
}

}  // namespace microtin::tests
