// SPDX-License-Identifier: MIT
// What a terrain must represent, on the lattice: samples with the heights that are allowed there.
#ifndef MICROTIN_ENCODER_TERRAIN_SURVEY_HPP
#define MICROTIN_ENCODER_TERRAIN_SURVEY_HPP

#include <cstdint>
#include <vector>

#include "encoder/layers.hpp"
#include "shared/lattice.hpp"

namespace microtin::terrain {

// Heights in this file are lattice steps with 16 fractional bits, as height queries answer them.

// One place that the surface must pass: a source post, or all source points that share a place.
struct Sample {
  Point place;
  int32_t height;   // of the source; the middle of lowest and highest if several share the place
  int32_t lowest;   // the surface here lies in lowest .. highest: the error bound, rounded inwards
  int32_t highest;  // (the full int32_t range if there is no bound)

  bool is_unbounded() const { return lowest == INT32_MIN && highest == INT32_MAX; }
};

// Where the surface has as much room above as below.
inline int32_t middle_of(const Sample& sample) {
  if (sample.is_unbounded()) return sample.height;
  return static_cast<int32_t>((int64_t{sample.lowest} + sample.highest) / 2);
}

// A sample that has a vertex's height, in z steps, and no other.
inline Sample fixed_sample(Point place, int16_t z) {
  const int32_t height = z * 65536;
  return {place, height, height, height};
}

struct Survey {
  std::vector<Sample> samples;  // distinct places, in lexicographic order (x, then y)
  std::vector<Point> voids;     // raster posts without a height, in lexicographic order
  std::vector<Point> fixed;     // samples that must become vertices, in lexicographic order
};

// The vertices chosen to represent a survey.
struct Tin {
  struct Triangle {
    Point a, b, c;  // counter-clockwise, the lexicographically smallest first
  };
  std::vector<Vertex> vertices;  // distinct places, any order
  std::vector<Triangle> voids;   // those triangles of their Delaunay triangulation that are void
};

inline std::vector<Point> places_of(const Tin& tin) {
  std::vector<Point> places;
  places.reserve(tin.vertices.size());
  for (const Vertex& v : tin.vertices) places.push_back({v.x, v.y});
  return places;
}

inline std::vector<Point> places_of(const std::vector<Sample>& samples) {
  std::vector<Point> places;
  places.reserve(samples.size());
  for (const Sample& sample : samples) places.push_back(sample.place);
  return places;
}

}  // namespace microtin::terrain

#endif
