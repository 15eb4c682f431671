// SPDX-License-Identifier: MIT
// The paper's Table 3, timed here.
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/stream/encode.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/measure.hpp"
#include "tests/bench/paper/inputs.hpp"
#include "tests/bench/paper/jump_and_walk.hpp"
#include "tests/bench/paper/systems.hpp"
#include "tests/bench/paper/tables.hpp"
#include "tests/bench/statistics.hpp"

namespace microtin::bench {
namespace {

constexpr size_t kColumns = 5;  // MSZ, orders of Algorithm 1 and 2, reconstructions of both

struct Printed {
  uint32_t vertices;
  double seconds[kColumns];
};
constexpr Printed kPrinted[] = {{5000, {4, 2, 2, 2, 1}},
                                {10000, {9, 5, 4, 2, 2}},
                                {20000, {22, 9, 7, 5, 5}},
                                {40000, {52, 18, 14, 11, 10}},
                                {80000, {124, 36, 30, 23, 19}}};

struct Times {
  Sample paper[kColumns];
  Sample by_sides, decoding;
};

void add_system(const std::vector<Point>& points, const System& system, int number, Times& times) {
  std::vector<Index> numbers;
  Triangulation triangulation(points, numbers);
  Order order;
  times.paper[number].add(seconds_of([&] { order = order_of(triangulation, system); }));
  const Sequence sequence = sequence_of(order, triangulation.mesh());
  const auto time = [&](Traversal traversal) {
    return seconds_of([&] { rebuild(sequence, {system.independent_sets, traversal}); });
  };
  times.paper[number + 2].add(time(Traversal::kAllNeighbours));
  if (!system.independent_sets) times.by_sides.add(time(Traversal::kSidedness));
}

Times measure(uint32_t vertices) {
  constexpr uint64_t kSeeds = 5;
  Times times;
  for (uint64_t seed = 0; seed < kSeeds; ++seed) {
    const std::vector<Point> points = uniform_places(vertices, seed);
    times.paper[0].add(seconds_of([&] { jump_and_walk(points, seed); }));
    add_system(points, {"", Walk::kTriangles, 6}, 1, times);
    add_system(points, {"", std::nullopt, 6}, 2, times);
    const auto stream = encode(uniform_tin(vertices, seed), {});
    times.decoding.add(seconds_of([&] { DecodedTerrain{stream}; }));
  }
  return times;
}

}  // namespace

void print_running_time() {
  print_head("Table 3: medians in milliseconds, and in units of Algorithm 2's reconstruction",
             {"n", "", "MSZ", "Alg. 1 CO", "Alg. 2 CO", "Alg. 1 Rec", "Alg. 2 Rec",
              "Alg. 2 Rec, sidedness first", "microtin, decoding"});
  for (const Printed& printed : kPrinted) {
    const Times times = measure(printed.vertices);
    const double unit = times.paper[kColumns - 1].median();
    Row milliseconds{number(size_t{printed.vertices}), "ms"}, ours{"", "ours"},
        paper{"", "paper (quoted)"};
    for (size_t i = 0; i < kColumns; ++i) {
      milliseconds.push_back(number(1e3 * times.paper[i].median(), 1));
      ours.push_back(number(times.paper[i].median() / unit, 2));
      paper.push_back(number(printed.seconds[i] / printed.seconds[kColumns - 1], 2));
    }
    for (const Sample* sample : {&times.by_sides, &times.decoding}) {
      milliseconds.push_back(number(1e3 * sample->median(), 1));
      ours.push_back(number(sample->median() / unit, 2));
      paper.push_back("-");
    }
    for (const Row& row : {milliseconds, ours, paper}) print_row(row);
  }
}

}  // namespace microtin::bench
