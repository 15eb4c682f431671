// SPDX-License-Identifier: MIT
// How far queries walk: the bound, walks in pieces, and starts from buckets.
#include <doctest/doctest.h>

#include <algorithm>

#include "microtin/microtin.hpp"
#include "tests/support/point_sets.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

DecodedTerrain flat_terrain(const Points& points) {
  Tin tin;
  for (const Point p : points) tin.vertices.push_back(Vertex{p.x, p.y, 0});
  return DecodedTerrain(encode(tin, Metadata()));
}

struct Place {
  int32_t x, y;
};

// Anywhere on the lattice, or at a vertex.
Place random_place(const Points& points, Random& random) {
  if (random.below(2) == 0) {
    const Point p = points[random.below(static_cast<uint32_t>(points.size()))];
    return {p.x * 256, p.y * 256};
  }
  return {static_cast<int32_t>(random.below(65535 * 256 + 1)),
          static_cast<int32_t>(random.below(65535 * 256 + 1))};
}

struct Walked {
  microtin_query_result answer;
  uint32_t steps;
};

// The walk in pieces of one step.
Walked walk(const microtin_mesh* mesh, Place p, uint32_t* hint) {
  int32_t height = 0;
  Walked walked = {MICROTIN_QUERY_STEP_LIMIT, 0};
  while (walked.answer == MICROTIN_QUERY_STEP_LIMIT &&
         walked.steps <= microtin_mesh_triangle_count(mesh)) {
    walked.answer = microtin_mesh_height_at(mesh, p.x, p.y, hint, &height, 0, 1);
    ++walked.steps;
  }
  return walked;
}

}  // namespace

TEST_CASE("a walk in pieces finds what one without a limit does, within the bound") {
  Random random(31);
  uint32_t most = 0;
  for (const PointSet& set : point_sets(300, 31)) {
    CAPTURE(set.name);
    const DecodedTerrain terrain = flat_terrain(set.points);
    for (int probe = 0; probe < 300; ++probe) {
      const Place p = random_place(set.points, random);
      uint32_t hint = random.below(microtin_mesh_triangle_count(terrain.mesh()));
      uint32_t whole_hint = hint;
      const Walked walked = walk(terrain.mesh(), p, &hint);
      CHECK(walked.steps <= microtin_mesh_triangle_count(terrain.mesh()));
      int32_t height = 0;
      CHECK(walked.answer ==
            microtin_mesh_height_at(terrain.mesh(), p.x, p.y, &whole_hint, &height, 0, 0));
      most = std::max(most, walked.steps);
    }
  }
  CHECK(most > 30);
}

TEST_CASE("from buckets the walk is short, and its end the same") {
  Random random(33);
  const Points points = uniform_points(2000, random);
  const DecodedTerrain terrain = flat_terrain(points);
  Buckets<45> buckets;
  CHECK(buckets.hint(0, 0) == 0);
  CHECK(buckets.build(terrain.mesh()) == MICROTIN_STATUS_OK);
  uint32_t total = 0;
  constexpr int kProbes = 2000;
  for (int probe = 0; probe < kProbes; ++probe) {
    const Place p = random_place(points, random);
    uint32_t cold = 0, hint = buckets.hint(p.x, p.y);
    int32_t cold_height = 0, height = 0;
    const microtin_query_result expected =
        microtin_mesh_height_at(terrain.mesh(), p.x, p.y, &cold, &cold_height, 0, 0);
    total += walk(terrain.mesh(), p, &hint).steps;
    CHECK(microtin_mesh_height_at(terrain.mesh(), p.x, p.y, &hint, &height, 0, 0) == expected);
    CHECK(height == cold_height);
  }
  CHECK(total < 4 * kProbes);
  CHECK(buckets.build(nullptr) == MICROTIN_STATUS_ARGUMENT);
}

TEST_CASE("buckets of any terrain, for places anywhere") {
  Random random(34);
  for (const PointSet& set : point_sets(40, 34)) {
    CAPTURE(set.name);
    const DecodedTerrain terrain = flat_terrain(set.points);
    std::vector<uint64_t> storage(MICROTIN_BUCKETS_BYTES(9) / 8 + 1);
    microtin_buckets* buckets = nullptr;
    REQUIRE(microtin_buckets_init(storage.data(), MICROTIN_BUCKETS_BYTES(9), terrain.mesh(),
                                  &buckets) == MICROTIN_STATUS_OK);
    for (const int32_t x : {INT32_MIN, -1, 0, 255, 256, 32768 * 256, 65535 * 256, INT32_MAX}) {
      for (const int32_t y : {INT32_MIN, 0, 65535 * 256, INT32_MAX}) {
        CHECK(microtin_buckets_hint(buckets, x, y) < microtin_mesh_triangle_count(terrain.mesh()));
      }
    }
  }
}

TEST_CASE("buckets refuse what they cannot use") {
  Random random(35);
  const DecodedTerrain terrain = flat_terrain(uniform_points(20, random));
  alignas(8) uint8_t storage[64];
  microtin_buckets* buckets = nullptr;
  const auto init = [&](void* workspace, size_t size) {
    return microtin_buckets_init(workspace, size, terrain.mesh(), &buckets);
  };
  CHECK(init(storage, MICROTIN_BUCKETS_BYTES(1)) == MICROTIN_STATUS_OK);
  CHECK(init(storage, MICROTIN_BUCKETS_BYTES(1) - 1) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  CHECK(buckets == nullptr);
  CHECK(init(storage + 4, 60) == MICROTIN_STATUS_MISALIGNED);
  CHECK(init(nullptr, 64) == MICROTIN_STATUS_ARGUMENT);
}

}  // namespace microtin::tests
