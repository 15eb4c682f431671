// SPDX-License-Identifier: MIT
// The programs that ours is compared with. Each is there only if its package was when this was
// built.
#ifndef MICROTIN_TESTS_BENCH_PEERS_PEERS_HPP
#define MICROTIN_TESTS_BENCH_PEERS_PEERS_HPP

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "tests/bench/surface.hpp"

namespace microtin::bench {

struct Codec {
  std::string name;
  bool sends_triangles;
  std::function<Bytes(const Surface&)> encode;
  std::function<Surface(const Bytes&)> decode;
  std::function<void(const Bytes&)> decode_and_drop;  // without the copy into a Surface; for timing
};

struct Triangulator {
  std::string name;
  std::function<size_t(const std::vector<Vertex>&)> count_triangles;
};

// Those that are there, at the level with the smallest files.
std::vector<Codec> dense_codecs();

// Those worth timing: points at the level with the smallest files, meshes at the default level.
std::vector<Codec> fast_codecs();

// Those that send triangles and are no Draco, each at its best.
std::vector<Codec> mesh_codecs();

std::optional<Triangulator> triangulator();

// Names the missing packages.
void print_missing_peers();

// Encodes, and throws Error unless that decodes to the surface.
Bytes checked_encode(const Codec& codec, const Surface& surface);

// The peers themselves. Draco's compression level is 10 for the smallest files and 5 by default.
Codec draco_points(int level);
Codec draco_mesh(int level);
Codec xz_points();
Codec meshoptimizer();
Codec quantized_mesh();
Triangulator cgal();

}  // namespace microtin::bench

#endif
