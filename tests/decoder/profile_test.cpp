// SPDX-License-Identifier: MIT
// Profiles along segments of meshes and compact terrains: against exact fractions.
#include <doctest/doctest.h>

#include <vector>

#include "tests/support/limited_segment.hpp"
#include "tests/support/reference_profile.hpp"
#include "tests/support/segment_terrains.hpp"

namespace microtin::tests {
namespace {

using namespace reference;

template <class Form>
std::vector<microtin_crossing> profile_of(const Form* form, const microtin_segment& c,
                                          uint32_t step_limit) {
  std::vector<microtin_crossing> profile;
  microtin_segment_state state = {};
  microtin_crossing crossing = {0, 0, 0, 0};
  for (uint32_t i = 0; i < 5 * triangles_of(form); ++i) {
    const microtin_query_result answer = next_crossing(form, c, &state, &crossing, step_limit);
    if (answer == MICROTIN_QUERY_STEP_LIMIT) continue;
    REQUIRE(answer == MICROTIN_QUERY_OK);
    profile.push_back(crossing);
    if (crossing.along == MICROTIN_ALONG_END) break;
  }
  microtin_crossing again = {0, 0, 0, 0};
  REQUIRE(next_crossing(form, c, &state, &again, step_limit) == MICROTIN_QUERY_OK);
  REQUIRE(same_crossing(again, crossing));
  return profile;
}

void check_profile(const Both& terrain, const Surface& surface, const microtin_segment& c) {
  CAPTURE(c.x);
  CAPTURE(c.y);
  CAPTURE(c.x_end);
  CAPTURE(c.y_end);
  const std::vector<microtin_crossing> profile = profile_of(terrain.mesh.mesh(), c, 0);
  REQUIRE(profile_fault(surface, c, profile) == "");
  REQUIRE(same_profile(profile_of(terrain.mesh.mesh(), c, 1), profile));
  REQUIRE(same_profile(profile_of(terrain.compact.compact(), c, 0), profile));
  REQUIRE(same_profile(profile_of(terrain.compact.compact(), c, 2), profile));
}

// Whether a profile that begins with this state reaches its end.
template <class Form>
bool has_end(const Form* form, const microtin_segment& c, microtin_segment_state state) {
  microtin_crossing crossing = {0, 0, 0, 0};
  for (uint32_t i = 0; i < 5 * triangles_of(form); ++i) {
    const microtin_query_result answer = next_crossing(form, c, &state, &crossing, i % 4);
    if (answer == MICROTIN_QUERY_OK && crossing.along == MICROTIN_ALONG_END) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("a profile has each place where a segment meets an edge or a vertex once, in order") {
  for_each_segment(
      [](const Both& terrain, const Surface& surface, const microtin_segment& c, bool, Random&) {
        if (c.x != c.x_end || c.y != c.y_end) check_profile(terrain, surface, c);
      });
}

TEST_CASE("profiles of places, of segments off the lattice, and of meshes that are not there") {
  const Both terrain(terrain_stream(300, 4));
  uint16_t x = 0, y = 0;
  int16_t z = 0;
  microtin_mesh_vertex(terrain.mesh.mesh(), 7, &x, &y, &z);
  const microtin_segment c = {x * 256, y * 256, x * 256, y * 256}, off = {-1, 0, 0, 0};
  const std::vector<microtin_crossing> profile = profile_of(terrain.mesh.mesh(), c, 0);
  REQUIRE(profile.size() == 2);
  for (const microtin_crossing& crossing : profile) CHECK(crossing.height == z * 65536);
  CHECK(same_profile(profile_of(terrain.compact.compact(), c, 1), profile));
  microtin_segment_state state = {};
  microtin_crossing crossing = {0, 0, 0, 0};
  CHECK(terrain.mesh.profile_next(off, &state, &crossing) == MICROTIN_QUERY_OUTSIDE);
  CHECK(terrain.compact.profile_next(off, &state, &crossing) == MICROTIN_QUERY_OUTSIDE);
  CHECK(terrain.made.profile_next(c, &state, &crossing) == MICROTIN_QUERY_NOT_LOADED);
}

TEST_CASE("a profile has an end, also if it begins with the state of another query") {
  const Both terrain(terrain_stream(100, 4));
  const microtin_segment c = {300, 200, 65535 * 256, 65000 * 256};
  for (uint32_t stage = 0; stage < 12; ++stage) {
    for (uint32_t triangle = 0; triangle < triangles_of(terrain.mesh.mesh()); ++triangle) {
      const microtin_segment_state state = {stage, triangle, 2, 1, {7, 6}, {5, 4}, {9, 8}};
      REQUIRE(has_end(terrain.mesh.mesh(), c, state));
      REQUIRE(has_end(terrain.compact.compact(), c, state));
    }
  }
}

}  // namespace microtin::tests
