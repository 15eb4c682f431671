// SPDX-License-Identifier: MIT
#include "tests/bench/surface.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "encoder/stream/decoded_terrain.hpp"
#include "tests/bench/layers.hpp"

namespace microtin::bench {
namespace {

using Place = std::tuple<uint16_t, uint16_t, int16_t>;

Place place_of(const Vertex& v) {
  return {v.x, v.y, v.z};
}

std::set<Place> places(const Surface& surface) {
  std::set<Place> places;
  for (const Vertex& v : surface.vertices) places.insert(place_of(v));
  return places;
}

std::set<std::array<Place, 3>> corners(const Surface& surface) {
  std::set<std::array<Place, 3>> triangles;
  for (const auto& t : surface.triangles) {
    std::array<Place, 3> corner;
    for (size_t i = 0; i < 3; ++i) corner[i] = place_of(surface.vertices[t[i]]);
    std::rotate(corner.begin(), std::min_element(corner.begin(), corner.end()), corner.end());
    triangles.insert(corner);
  }
  return triangles;
}

}  // namespace

Surface surface_of(const Bytes& stream) {
  const DecodedTerrain terrain(stream);
  Surface surface;
  surface.vertices.resize(microtin_mesh_vertex_count(terrain.mesh()));
  for (uint32_t i = 0; i < surface.vertices.size(); ++i) {
    Vertex& v = surface.vertices[i];
    microtin_mesh_vertex(terrain.mesh(), i, &v.x, &v.y, &v.z);
    surface.has_heights = surface.has_heights || v.z != 0;
  }
  for (uint32_t i = 0; i < microtin_mesh_triangle_count(terrain.mesh()); ++i) {
    std::array<uint32_t, 3> t;
    if (microtin_mesh_triangle(terrain.mesh(), i, t.data()) == MICROTIN_TRIANGLE_REAL) {
      surface.triangles.push_back(t);
    }
  }
  return surface;
}

bool same_vertices(const Surface& a, const Surface& b) {
  return a.vertices.size() == b.vertices.size() && places(a) == places(b);
}

bool same_triangles(const Surface& a, const Surface& b) {
  return corners(a) == corners(b);
}

double floor_bits(double places, double vertices) {
  const auto log_factorial = [](long double n) { return std::lgamma(n + 1); };
  const long double log_sets =
      log_factorial(places) - log_factorial(vertices) - log_factorial(places - vertices);
  return static_cast<double>(log_sets / std::log(2.0L)) / vertices;
}

double floor_bits(const Surface& surface) {
  const auto by_x = [](const Vertex& a, const Vertex& b) { return a.x < b.x; };
  const auto by_y = [](const Vertex& a, const Vertex& b) { return a.y < b.y; };
  const auto& v = surface.vertices;
  const auto [west, east] = std::minmax_element(v.begin(), v.end(), by_x);
  const auto [south, north] = std::minmax_element(v.begin(), v.end(), by_y);
  return floor_bits((east->x - west->x + 1.0) * (north->y - south->y + 1.0),
                    static_cast<double>(v.size()));
}

}  // namespace microtin::bench
