// SPDX-License-Identifier: MIT
// Plots as SVG.
#ifndef MICROTIN_TESTS_BENCH_SVG_HPP
#define MICROTIN_TESTS_BENCH_SVG_HPP

#include <string>
#include <utility>
#include <vector>

namespace microtin::bench {

struct Curve {
  std::string name;
  std::vector<std::pair<double, double>> points;
};

// Curves over a logarithmic x axis; y from 0.
struct Panel {
  std::string title, x_label, y_label;
  std::vector<Curve> curves;
};

// Draws the panels two in a row, with one legend, since all have the same curves.
void write_plot(const std::string& path, const std::vector<Panel>& panels);

}  // namespace microtin::bench

#endif
