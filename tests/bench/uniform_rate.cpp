// SPDX-License-Identifier: MIT
// Bits per vertex of uniform points, compared with other programs and the paper.
#include "encoder/stream/encode.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/peers/peers.hpp"
#include "tests/bench/rate.hpp"
#include "tests/bench/table.hpp"

namespace microtin::bench {
namespace {

struct Size {
  uint32_t vertices;
  uint64_t samples;   // sets over which the rates are averaged
  const char* paper;  // bits per vertex, from Sohler's Table 2
};

constexpr Size kSizes[] = {{5000, 8, "27.49"},  {10000, 4, "26.50"}, {20000, 4, "25.45"},
                           {40000, 2, "24.39"}, {80000, 2, "23.42"}, {1000000, 1, "-"}};
constexpr Effort kEfforts[] = {{10, Coding::kBalanced}, {9, Coding::kQuick}, {10, Coding::kDense},
                               {8, Coding::kBalanced},  {8, Coding::kQuick}, {32, Coding::kDense}};

std::vector<Codec> point_codecs() {
  std::vector<Codec> codecs;
  for (Codec& codec : dense_codecs()) {
    if (!codec.sends_triangles) codecs.push_back(std::move(codec));
  }
  return codecs;
}

void print_size(const Size& size, const std::vector<Codec>& peers) {
  std::vector<double> bits(std::size(kEfforts) + peers.size());
  for (uint64_t seed = 0; seed < size.samples; ++seed) {
    const Tin tin = uniform_tin(size.vertices, seed);
    const Surface surface{false, tin.vertices, {}};
    const double scale = 8.0 / static_cast<double>(size.vertices * size.samples);
    auto sum = bits.begin();
    for (const Effort& effort : kEfforts) {
      *sum++ += scale * static_cast<double>(encode(tin, {}, effort).size());
    }
    for (const Codec& peer : peers) {
      *sum++ += scale * static_cast<double>(checked_encode(peer, surface).size());
    }
  }
  const double floor = floor_bits(65536.0 * 65536.0, size.vertices);
  Row row{number(size_t{size.vertices}), number(floor, 2)};
  for (size_t i = 0; i < bits.size(); ++i) {
    row.push_back(number(bits[i], 2));
    if (i == 0) row.push_back(number(bits[i] / floor, 3));
  }
  row.push_back(size.paper);
  print_row(row);
}

}  // namespace

void print_uniform_rate() {
  const std::vector<Codec> peers = point_codecs();
  Row head{"n", "floor"};
  for (const Effort& effort : kEfforts) {
    head.push_back("D " + std::to_string(effort.degree) + ", " + name_of(effort.coding));
    if (head.size() == 3) head.push_back("/ floor");
  }
  for (const Codec& peer : peers) head.push_back(peer.name);
  head.push_back("1999 paper (quoted)");
  print_head("Uniform 16-bit points, x and y only, whole file, bits/vertex", head);
  for (const Size& size : kSizes) print_size(size, peers);
}

}  // namespace microtin::bench
