// SPDX-License-Identifier: MIT
// The paper's claims that its tables do not show.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/product/phases.hpp"
#include "encoder/stream/encode.hpp"
#include "tests/bench/grids/grid.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/measure.hpp"
#include "tests/bench/paper/inputs.hpp"
#include "tests/bench/paper/jump_and_walk.hpp"
#include "tests/bench/paper/systems.hpp"
#include "tests/bench/paper/tables.hpp"
#include "tests/bench/statistics.hpp"

namespace microtin::bench {
namespace {

constexpr uint64_t kSeeds = 5;

// Section 6: Algorithm 1 removes a tenth of the vertices of degree 6 and less in every phase.
void print_least_batches() {
  constexpr double kProved = 0.1;
  print_head(
      "Section 6: the least part of the removable vertices that a phase of Algorithm 1 removes",
      {"input", "vertices", "proved (quoted)", "degree 6", "degree 9"});
  for (const Family& family : families()) {
    const std::vector<Point> points = family.points(20000);
    Row row{family.name, number(points.size()), "10 %"};
    for (const uint32_t degree : {6u, 9u}) {
      const double least = check(points, {"", Walk::kTriangles, degree}).least_fraction;
      if (least < kProved) throw Error("Algorithm 1 removes less than is proved");
      row.push_back(number(100 * least, 1) + " %");
    }
    print_row(row);
  }
}

// Section 5.2: the lower the degree, the faster are both.
void print_times_by_degree() {
  constexpr uint32_t kVertices = 40000;
  print_head("Section 5.2: medians in milliseconds by degree, n = 40,000",
             {"degree", "Alg. 1 CO", "Alg. 2 CO", "Alg. 1 Rec", "Alg. 2 Rec"});
  for (const uint32_t degree : {6u, 7u, 8u, 9u, 12u}) {
    Sample times[4];
    for (uint64_t seed = 0; seed < kSeeds; ++seed) {
      const std::vector<Point> points = uniform_places(kVertices, seed);
      size_t column = 0;
      for (const std::optional<Walk> walk :
           {std::optional(Walk::kTriangles), std::optional<Walk>()}) {
        const System system = {"", walk, degree};
        std::vector<Index> numbers;
        Triangulation triangulation(points, numbers);
        Order order;
        times[column].add(seconds_of([&] { order = order_of(triangulation, system); }));
        const Sequence sequence = sequence_of(order, triangulation.mesh());
        times[column + 2].add(seconds_of([&] {
          rebuild(sequence, {system.independent_sets, Traversal::kAllNeighbours});
        }));
        ++column;
      }
    }
    Row row{number(size_t{degree})};
    for (const Sample& time : times) row.push_back(number(1e3 * time.median(), 1));
    print_row(row);
  }
}

// Section 5.2: MSZ takes n^(4/3). The exponent is the slope of the regression line through the
// logarithms.
void print_exponents() {
  print_head("Section 5.2: how time grows with n, from 5,000 to 80,000 uniform points",
             {"system", "exponent, paper (quoted)", "exponent of the medians"});
  std::vector<double> sizes, walks, rebuilds;
  for (const uint32_t vertices : {5000u, 10000u, 20000u, 40000u, 80000u}) {
    Sample walk, rebuilding;
    for (uint64_t seed = 0; seed < kSeeds; ++seed) {
      const std::vector<Point> points = uniform_places(vertices, seed);
      walk.add(seconds_of([&] { jump_and_walk(points, seed); }));
      const Sequence sequence = sequence_of(points, {"", std::nullopt, 6});
      rebuilding.add(seconds_of([&] {
        rebuild(sequence, {std::nullopt, Traversal::kAllNeighbours});
      }));
    }
    sizes.push_back(std::log(vertices));
    walks.push_back(std::log(walk.median()));
    rebuilds.push_back(std::log(rebuilding.median()));
  }
  const auto slope = [&](const std::vector<double>& times) {
    double mean_x = 0, mean_y = 0, both = 0, square = 0;
    const auto n = static_cast<double>(sizes.size());
    for (size_t i = 0; i < sizes.size(); ++i) {
      mean_x += sizes[i] / n;
      mean_y += times[i] / n;
    }
    for (size_t i = 0; i < sizes.size(); ++i) {
      both += (sizes[i] - mean_x) * (times[i] - mean_y);
      square += (sizes[i] - mean_x) * (sizes[i] - mean_x);
    }
    return both / square;
  };
  print_row({"MSZ", "1.33", number(slope(walks), 2)});
  print_row({"Algorithm 2, reconstruction", "1", number(slope(rebuilds), 2)});
}

// Section 6: good for progressive transmission. With the product's degree of 10 most of these
// terrains have a single phase of 256 vertices or more.
void print_progress() {
  print_head("Section 6: a terrain arrives phase by phase, microtin with the paper's degree, 6",
             {"terrain", "vertices", "part of the bytes", "largest error, in bounds",
              "whole file, against the usual degree"});
  Effort paper;
  paper.degree = 6;
  for (const Terrain& terrain : terrains()) {
    const Model model = simplified(terrain.raster, terrain.options);
    const std::vector<uint8_t> stream = encode(model.tin, model.metadata, paper);
    const auto bytes = static_cast<double>(stream.size()),
               usual = static_cast<double>(encode(model.tin, model.metadata).size());
    const double bound = real(*terrain.options.max_error);
    for (const auto& phase : measure_phases(stream, terrain.raster)) {
      print_row({terrain.name, number(size_t{phase.vertices}),
                 number(100 * static_cast<double>(phase.bytes) / bytes, 1) + " %",
                 phase.max_error ? number(real(*phase.max_error) / bound, 1) : "-",
                 number(bytes / usual, 4)});
    }
  }
}

}  // namespace

void print_other_claims() {
  print_least_batches();
  print_times_by_degree();
  print_exponents();
  print_progress();
}

}  // namespace microtin::bench
