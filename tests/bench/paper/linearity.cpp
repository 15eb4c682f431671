// SPDX-License-Identifier: MIT
#include "tests/bench/paper/linearity.hpp"

#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/stream/encode.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/paper/inputs.hpp"
#include "tests/bench/paper/systems.hpp"
#include "tests/bench/statistics.hpp"
#include "tests/bench/svg.hpp"

namespace microtin::bench {
namespace {

constexpr System kSystem = {"Algorithm 2", std::nullopt, 6};
constexpr uint32_t kLeast = 1000;

enum Quantity { kOrdering, kRebuilding, kDecoding, kTests, kQuantities };
const char* const kNames[] = {"CO", "Rec", "microtin decoding", "in-circle tests of Rec"};

// The sum over a family's sizes, for a straight line through logarithms.
class Fit {
 public:
  void add(double x, double y) {
    x = std::log(x);
    y = std::log(y);
    n_ += 1;
    x_ += x;
    y_ += y;
    xx_ += x * x;
    xy_ += x * y;
  }

  double slope() const { return (n_ * xy_ - x_ * y_) / (n_ * xx_ - x_ * x_); }

 private:
  double n_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
};

// Small inputs are measured several times.
uint32_t rounds(size_t vertices) {
  return vertices < 50000 ? 5 : vertices < 500000 ? 3 : 1;
}

struct Costs {
  double total[kQuantities];
};

Costs measure(const std::vector<Point>& points, const CostUnit& unit) {
  Sample samples[kQuantities];
  Tin tin;
  for (const Point p : points) tin.vertices.push_back({p.x, p.y, 0});
  const auto stream = encode(tin, {});
  for (uint32_t round = 0; round < rounds(points.size()); ++round) {
    std::vector<Index> numbers;
    Triangulation triangulation(points, numbers);
    Order order;
    Tests tests;
    samples[kOrdering].add(unit.cost([&] { order = order_of(triangulation, kSystem); }));
    const Sequence sequence = sequence_of(order, triangulation.mesh());
    const Method method = {std::nullopt, Traversal::kAllNeighbours};
    samples[kRebuilding].add(unit.cost([&] { tests = rebuild(sequence, method); }));
    samples[kTests].add(static_cast<double>(tests.in_circle));
    samples[kDecoding].add(unit.cost([&] { DecodedTerrain{stream}; }));
  }
  Costs costs{};
  for (int q = 0; q < kQuantities; ++q) costs.total[q] = samples[q].median();
  return costs;
}

std::vector<Panel> empty_panels(const CostUnit& unit) {
  std::vector<Panel> panels;
  for (int q = 0; q < kQuantities; ++q) {
    const std::string y_label = (q == kTests ? "tests" : unit.name) + " per vertex";
    panels.push_back({kNames[q], "vertices", y_label, {}});
  }
  return panels;
}

void print_size(const Family& family, size_t vertices, const Costs& costs) {
  Row row{family.name, number(vertices)};
  for (int q = 0; q < kQuantities; ++q) {
    const double per_vertex = costs.total[q] / static_cast<double>(vertices);
    row.push_back(number(per_vertex, q == kTests ? 2 : 0));
  }
  print_row(row);
}

// Prints and collects one family. Returns the exponents.
Row measure_family(const Family& family, const CostUnit& unit, std::vector<Panel>& panels) {
  Fit fits[kQuantities];
  for (Panel& panel : panels) panel.curves.push_back({family.name, {}});
  for (uint32_t wanted = kLeast; wanted <= unit.most_vertices; wanted *= 4) {
    const std::vector<Point> points = family.points(wanted);
    const Costs costs = measure(points, unit);
    const auto vertices = static_cast<double>(points.size());
    for (size_t q = 0; q < kQuantities; ++q) {
      fits[q].add(vertices, costs.total[q]);
      panels[q].curves.back().points.emplace_back(vertices, costs.total[q] / vertices);
    }
    print_size(family, points.size(), costs);
  }
  Row exponents{family.name, "exponent"};
  for (const Fit& fit : fits) exponents.push_back(number(fit.slope(), 3));
  return exponents;
}

// The family that costs most per vertex at its largest size.
Row costliest(const std::vector<Panel>& panels) {
  Row row{"costliest at the end", ""};
  for (const Panel& panel : panels) {
    const auto last = [](const Curve& curve) { return curve.points.back().second; };
    row.push_back(
        std::max_element(panel.curves.begin(), panel.curves.end(),
                         [&](const Curve& a, const Curve& b) { return last(a) < last(b); })
            ->name);
  }
  return row;
}

}  // namespace

void print_linearity(const CostUnit& unit, const std::string& plot) {
  Row head{"points", "vertices"};
  for (const char* name : kNames) head.emplace_back(name);
  print_head("Linearity: " + unit.name + " (or tests) per vertex, degree 6; the product as it is",
             head);
  std::vector<Panel> panels = empty_panels(unit);
  std::vector<Row> exponents;
  for (const Family& family : families()) {
    exponents.push_back(measure_family(family, unit, panels));
  }
  print_head("Linearity: exponents fitted to totals in " + unit.name, head);
  for (const Row& row : exponents) print_row(row);
  print_row(costliest(panels));
  write_plot(plot, panels);
}

}  // namespace microtin::bench
