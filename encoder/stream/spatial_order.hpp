// The order in which points are inserted so that a triangulation of them is quick to build.
#ifndef MICROTIN_ENCODER_STREAM_SPATIAL_ORDER_HPP
#define MICROTIN_ENCODER_STREAM_SPATIAL_ORDER_HPP

#include <vector>

#include "encoder/layers.hpp"
#include "shared/mesh.hpp"

namespace microtin::stream {

// Numbers of the points, each once, in rounds of growing size (a biased randomized insertion order:
// Amenta, Choi and Rote, "Incremental constructions con BRIO") and along a Hilbert curve within
// each. The places alone decide, so the order of the input does not matter. Throws Error if two
// points share a place.
std::vector<Index> insertion_order(const std::vector<Point>& points);

}  // namespace microtin::stream

#endif
