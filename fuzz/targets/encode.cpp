// SPDX-License-Identifier: MIT
// Any set of vertices that spans a triangle becomes a stream that decodes to the canonical
// triangulation of these vertices, whatever their order; any other set is refused.
#include "encoder/stream/encode.hpp"

#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <set>
#include <vector>

#include "encoder/base/error.hpp"
#include "fuzz/support/expect.hpp"
#include "tests/support/mesh_copy.hpp"

namespace {

using namespace microtin;
using namespace microtin::tests;

bool smaller(const Vertex& a, const Vertex& b) {
  return Point{a.x, a.y} < Point{b.x, b.y};
}

bool same_place(const Vertex& a, const Vertex& b) {
  return a.x == b.x && a.y == b.y;
}

bool equal(const Vertex& a, const Vertex& b) {
  return same_place(a, b) && a.z == b.z;
}

// Vertices in a box, so that small boxes make many lines and circles.
Tin tin_from(FuzzedDataProvider& given) {
  const uint16_t width = static_cast<uint16_t>(65535u >> given.ConsumeIntegralInRange(0, 15));
  const uint16_t height = static_cast<uint16_t>(65535u >> given.ConsumeIntegralInRange(0, 15));
  const uint16_t left = given.ConsumeIntegralInRange<uint16_t>(0, 65535u - width);
  const uint16_t low = given.ConsumeIntegralInRange<uint16_t>(0, 65535u - height);
  const uint32_t heights = given.ConsumeIntegralInRange<uint32_t>(0, 2);
  Tin tin;
  while (given.remaining_bytes() > 0 && tin.vertices.size() < 150) {
    Vertex v = {0, 0, 0};
    v.x = given.ConsumeIntegralInRange<uint16_t>(left, left + width);
    v.y = given.ConsumeIntegralInRange<uint16_t>(low, low + height);
    if (heights == 1) v.z = given.ConsumeIntegral<int8_t>();
    if (heights == 2) v.z = given.ConsumeIntegral<int16_t>();
    tin.vertices.push_back(v);
  }
  return tin;
}

// Whether they can be a terrain: no two at a place, not all on a line.
bool is_terrain(std::vector<Vertex> vertices) {
  std::sort(vertices.begin(), vertices.end(), smaller);
  if (std::adjacent_find(vertices.begin(), vertices.end(), same_place) != vertices.end()) {
    return false;
  }
  return std::any_of(vertices.begin(), vertices.end(), [&vertices](const Vertex& v) {
    const Vertex &a = vertices.front(), &b = vertices.back();
    return reference::area({a.x, a.y}, {b.x, b.y}, {v.x, v.y}) != 0;
  });
}

void check_decoded(const microtin_mesh* mesh, std::vector<Vertex> vertices) {
  const MeshCopy copy(mesh);
  std::vector<Vertex> found;
  for (size_t v = 0; v < copy.place.size(); ++v) {
    found.push_back({copy.place[v].x, copy.place[v].y, copy.z[v]});
  }
  std::sort(found.begin(), found.end(), smaller);
  std::sort(vertices.begin(), vertices.end(), smaller);
  EXPECT(std::equal(found.begin(), found.end(), vertices.begin(), vertices.end(), equal));
  EXPECT(is_sound(copy));
  if (vertices.size() < 12) EXPECT(reference_delaunay(copy.place) == triangles_of(copy.mesh));
}

Tin::Triangle corners_of(const microtin_mesh* mesh, const uint32_t* v) {
  Point p[3];
  int16_t z = 0;
  for (int i = 0; i < 3; ++i) microtin_mesh_vertex(mesh, v[i], &p[i].x, &p[i].y, &z);
  std::rotate(p, std::min_element(p, p + 3), p + 3);
  return {p[0], p[1], p[2]};
}

std::vector<Tin::Triangle> triangles_of_kind(const microtin_mesh* mesh,
                                             microtin_triangle_kind kind) {
  std::vector<Tin::Triangle> found;
  for (uint32_t t = 0; t < microtin_mesh_triangle_count(mesh); ++t) {
    uint32_t v[3];
    if (microtin_mesh_triangle(mesh, t, v) == kind) found.push_back(corners_of(mesh, v));
  }
  return found;
}

std::set<std::array<Point, 3>> set_of(const std::vector<Tin::Triangle>& triangles) {
  std::set<std::array<Point, 3>> set;
  for (const Tin::Triangle& t : triangles) set.insert({t.a, t.b, t.c});
  return set;
}

// Some triangles become void, and the vertices come in another order.
void check_voids(Tin tin, const Effort& effort, const microtin_mesh* mesh, uint64_t chosen) {
  const std::vector<Tin::Triangle> all = triangles_of_kind(mesh, MICROTIN_TRIANGLE_REAL);
  for (size_t i = 0; i < all.size(); ++i) {
    if ((chosen >> i % 64 & 1) != 0) tin.voids.push_back(all[i]);
  }
  const Encoding first = encode_and_decode(tin, Metadata(), effort);
  std::reverse(tin.vertices.begin(), tin.vertices.end());
  std::rotate(tin.vertices.begin(), tin.vertices.begin() + 1, tin.vertices.end());
  std::reverse(tin.voids.begin(), tin.voids.end());
  EXPECT(encode(tin, Metadata(), effort) == first.stream);
  EXPECT(set_of(triangles_of_kind(first.decoded.mesh(), MICROTIN_TRIANGLE_VOID)) ==
         set_of(tin.voids));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  FuzzedDataProvider given(data, size);
  Effort effort;
  effort.degree = given.ConsumeIntegralInRange<uint32_t>(kMinDegree, kMaxDegree);
  effort.coding = static_cast<Coding>(given.ConsumeIntegralInRange(1, 3));
  const uint64_t voids = given.ConsumeBool() ? given.ConsumeIntegral<uint64_t>() : 0;
  const Tin tin = tin_from(given);
  if (!is_terrain(tin.vertices)) {
    bool refused = false;
    try {
      encode(tin, Metadata(), effort);
    } catch (const Error&) {
      refused = true;
    }
    EXPECT(refused);
    return 0;
  }
  const Encoding encoding = encode_and_decode(tin, Metadata(), effort);
  check_decoded(encoding.decoded.mesh(), tin.vertices);
  check_voids(tin, effort, encoding.decoded.mesh(), voids);
  return 0;
}
