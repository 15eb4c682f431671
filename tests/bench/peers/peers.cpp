// SPDX-License-Identifier: MIT
#include "tests/bench/peers/peers.hpp"

#include <cstdio>

#include "encoder/base/error.hpp"
#include "tests/bench/layers.hpp"

namespace microtin::bench {

std::vector<Codec> dense_codecs() {
  std::vector<Codec> codecs;
#ifdef MICROTIN_BENCH_DRACO
  codecs.push_back(draco_points(10));
  codecs.push_back(draco_mesh(10));
#endif
#ifdef MICROTIN_BENCH_LIBLZMA
  codecs.push_back(xz_points());
#endif
  return codecs;
}

std::vector<Codec> fast_codecs() {
  std::vector<Codec> codecs;
#ifdef MICROTIN_BENCH_DRACO
  codecs.push_back(draco_points(10));
  codecs.push_back(draco_mesh(5));
#endif
  return codecs;
}

std::vector<Codec> mesh_codecs() {
  std::vector<Codec> codecs;
#ifdef MICROTIN_BENCH_MESHOPTIMIZER
  codecs.push_back(meshoptimizer());
#endif
#ifdef MICROTIN_BENCH_ZLIB
  codecs.push_back(quantized_mesh());
#endif
  return codecs;
}

std::optional<Triangulator> triangulator() {
#ifdef MICROTIN_BENCH_CGAL
  return cgal();
#else
  return std::nullopt;
#endif
}

void print_missing_peers() {
#ifndef MICROTIN_BENCH_DRACO
  std::puts("skipped: Draco (libdraco-dev is not installed)");
#endif
#ifndef MICROTIN_BENCH_LIBLZMA
  std::puts("skipped: xz (liblzma-dev is not installed)");
#endif
#ifndef MICROTIN_BENCH_MESHOPTIMIZER
  std::puts("skipped: meshoptimizer (libmeshoptimizer-dev or libzstd-dev is not installed)");
#endif
#ifndef MICROTIN_BENCH_ZLIB
  std::puts("skipped: quantized-mesh (zlib1g-dev is not installed)");
#endif
#ifndef MICROTIN_BENCH_LERC
  std::puts("skipped: LERC (liblerc-dev is not installed)");
#endif
#ifndef MICROTIN_BENCH_CGAL
  std::puts("skipped: CGAL (libcgal-dev is not installed)");
#endif
}

Bytes checked_encode(const Codec& codec, const Surface& surface) {
  Bytes bytes = codec.encode(surface);
  const Surface decoded = codec.decode(bytes);
  const bool same =
      codec.sends_triangles ? same_triangles(surface, decoded) : same_vertices(surface, decoded);
  if (!same) throw Error(codec.name + " does not decode to what it was given");
  return bytes;
}

}  // namespace microtin::bench
