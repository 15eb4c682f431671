// SPDX-License-Identifier: MIT
#include "tests/bench/paper/tables.hpp"

#include "encoder/base/error.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/stream/triangulation.hpp"
#include "tests/bench/grids/grid.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/paper/inputs.hpp"
#include "tests/bench/paper/jump_and_walk.hpp"
#include "tests/bench/paper/length_code.hpp"
#include "tests/bench/paper/systems.hpp"
#include "tests/bench/statistics.hpp"

namespace microtin::bench {
namespace {

// A size of the paper's with the figures that it prints.
struct Printed {
  uint32_t vertices;
  uint32_t seeds;   // over which ours are averaged
  double bits[2];   // Table 2: per vertex, Algorithm 1 and 2
  double tests[2];  // Table 4: in all
};
constexpr Printed kPrinted[] = {{5000, 16, {31.85, 27.49}, {50e3, 48e3}},
                                {10000, 8, {30.74, 26.50}, {100e3, 96e3}},
                                {20000, 8, {29.62, 25.45}, {199e3, 192e3}},
                                {40000, 4, {28.47, 24.39}, {399e3, 383e3}},
                                {80000, 4, {27.34, 23.42}, {799e3, 768e3}}};

constexpr System kAlgorithm1 = {"Algorithm 1", Walk::kTriangles, 6};
constexpr System kAlgorithm1Degree9 = {"Algorithm 1", Walk::kTriangles, 9};
constexpr System kAlgorithm1Vertices = {"Algorithm 1, vertex walk", Walk::kVertices, 6};
constexpr System kAlgorithm2 = {"Algorithm 2", std::nullopt, 6};
const System kProduct = {"microtin", std::nullopt, usual_degree(Effort())};

double per_vertex(uint64_t count, const Sequence& sequence) {
  return static_cast<double>(count) / static_cast<double>(sequence.points.size());
}

Tests tests_of(const Sequence& sequence, const System& system, Traversal traversal) {
  return rebuild(sequence, {system.independent_sets, traversal});
}

// The paper's figure, ours and the ratio.
void add_comparison(Row& row, double paper, const Sample& ours) {
  row.push_back(number(paper, 2));
  row.push_back(with_spread(ours, 2));
  row.push_back(number(ours.mean() / paper, 3));
}

}  // namespace

// --- Table 2 -------------------------------------------------------------------------------------

void print_compression() {
  print_head(
      "Table 2: bits per vertex of uniform points, x and y, in the paper's length code",
      {"n", "seeds", "Algorithm 1, paper (quoted)", "ours", "ratio", "Algorithm 2, paper (quoted)",
       "ours", "ratio", "Algorithm 1, vertex walk", "microtin, whole file"});
  for (const Printed& printed : kPrinted) {
    Sample bits[3], product;
    for (uint64_t seed = 0; seed < printed.seeds; ++seed) {
      const Tin tin = uniform_tin(printed.vertices, seed);
      const std::vector<Point> points = uniform_places(printed.vertices, seed);
      Sample* sample = bits;
      for (const System& system : {kAlgorithm1, kAlgorithm2, kAlgorithm1Vertices}) {
        const Sequence sequence = sequence_of(points, system);
        (sample++)->add(per_vertex(length_code_bits(sequence), sequence));
      }
      product.add(8.0 * static_cast<double>(encode(tin, {}).size()) / printed.vertices);
    }
    Row row{number(size_t{printed.vertices}), number(size_t{printed.seeds})};
    add_comparison(row, printed.bits[0], bits[0]);
    add_comparison(row, printed.bits[1], bits[1]);
    row.push_back(with_spread(bits[2], 2));
    row.push_back(with_spread(product, 2));
    print_row(row);
  }
}

// --- Table 4 -------------------------------------------------------------------------------------

namespace {

struct Measured {
  Sample all[2], uncertified[2];  // Algorithm 1 and 2
  Sample by_sides, sidedness;     // Algorithm 2
  Sample product;
};

Measured measure_tests(const Printed& printed) {
  Measured measured;
  for (uint64_t seed = 0; seed < printed.seeds; ++seed) {
    const std::vector<Point> points = uniform_places(printed.vertices, seed);
    int i = 0;
    for (const System& system : {kAlgorithm1Degree9, kAlgorithm2}) {
      const Sequence sequence = sequence_of(points, system);
      const auto count = [&](Traversal traversal) {
        return per_vertex(tests_of(sequence, system, traversal).in_circle, sequence);
      };
      measured.all[i].add(count(Traversal::kAllNeighbours));
      measured.uncertified[i++].add(count(Traversal::kUncertified));
      if (system.independent_sets) continue;
      const Tests tests = tests_of(sequence, system, Traversal::kSidedness);
      measured.by_sides.add(per_vertex(tests.in_circle, sequence));
      measured.sidedness.add(per_vertex(tests.sidedness, sequence));
    }
    // Ours gets the triangles that are hit, and tests those that it destroys and their neighbours.
    const Sequence sequence = sequence_of(points, kProduct);
    const Tests tests = tests_of(sequence, kProduct, Traversal::kUncertified);
    measured.product.add(2 * per_vertex(tests.destroyed, sequence) + 2);
  }
  return measured;
}

}  // namespace

void print_tests() {
  print_head(
      "Table 4: in-circle tests per vertex of the reconstruction, uniform points",
      {"n", "seeds", "Algorithm 1 (degree 9), paper (quoted)", "ours", "ratio",
       "Algorithm 2 (degree 6), paper (quoted)", "ours", "ratio",
       "Algorithm 1, certified not tested", "Algorithm 2, certified not tested",
       "Algorithm 2, sidedness first: in-circle", "... and sidedness", "microtin (degree 10)"});
  for (const Printed& printed : kPrinted) {
    const Measured measured = measure_tests(printed);
    Row row{number(size_t{printed.vertices}), number(size_t{printed.seeds})};
    for (int i = 0; i < 2; ++i) {
      add_comparison(row, printed.tests[i] / printed.vertices, measured.all[i]);
    }
    for (const Sample* sample : {&measured.uncertified[0], &measured.uncertified[1],
                                 &measured.by_sides, &measured.sidedness, &measured.product}) {
      row.push_back(with_spread(*sample, 2));
    }
    print_row(row);
  }
}

// --- Section 4 -----------------------------------------------------------------------------------

void print_fractions() {
  constexpr uint32_t kVertices = 80000, kSeeds = 4;
  const char* const proved[] = {"1/3", "2/5", "1/2", "1/2"};
  print_head("Section 4: the part of the removable vertices that a phase removes, n = 80,000",
             {"degree", "proved (quoted)", "in practice (quoted)", "first phase",
              "least of all phases", "phases", "Algorithm 1: first phase", "least", "phases"});
  for (uint32_t degree = 6; degree <= 9; ++degree) {
    Row row{number(size_t{degree}), proved[degree - 6], degree == 6 ? "about 80 %" : "-"};
    for (const std::optional<Walk> walk :
         {std::optional<Walk>(), std::optional(Walk::kTriangles)}) {
      const System system = {"", walk, degree};
      Sample first, least, phases;
      for (uint64_t seed = 0; seed < kSeeds; ++seed) {
        const std::vector<Point> points = uniform_places(kVertices, seed);
        first.add(100.0 * sequence_of(points, system).batches.back() / kVertices);
        const Check found = check(points, system);
        if (found.violations + found.wrong_phases != 0) throw Error("a claim does not hold");
        least.add(100 * found.least_fraction);
        phases.add(found.phases);
      }
      row.push_back(with_spread(first, 1) + " %");
      row.push_back(number(least.least(), 1) + " %");
      row.push_back(with_spread(phases, 1));
    }
    print_row(row);
  }
}

// --- The claims ----------------------------------------------------------------------------------

namespace {

struct PointSet {
  std::string name;
  std::vector<Point> points;
};

// The vertices of terrains, and all families of points.
std::vector<PointSet> point_sets() {
  constexpr uint32_t kVertices = 50000;
  std::vector<PointSet> sets;
  for (const Family& family : families()) {
    sets.push_back({family.name, family.points(kVertices)});
  }
  for (const Terrain& terrain : terrains()) {
    PointSet set{terrain.name, {}};
    for (const Vertex& v : simplified(terrain.raster, terrain.options).tin.vertices) {
      set.points.push_back({v.x, v.y});
    }
    sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace

void print_claims() {
  const std::vector<PointSet> sets = point_sets();
  print_head("Lemma 1 and Theorem 1 at run time, after every phase",
             {"input", "vertices", "system", "degree", "phases", "certified triangles destroyed",
              "phases that differ", "least part removed"});
  for (const auto& [name, points] : sets) {
    for (const System& system : {kAlgorithm1, kAlgorithm2, kProduct}) {
      const Check found = check(points, system);
      print_row({name, number(points.size()), system.name, number(size_t{system.degree}),
                 number(size_t{found.phases}), number(size_t{found.violations}),
                 number(size_t{found.wrong_phases}), number(100 * found.least_fraction, 1) + " %"});
    }
  }
}

}  // namespace microtin::bench
