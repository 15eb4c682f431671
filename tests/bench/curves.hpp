// SPDX-License-Identifier: MIT
// Charts with logarithmic axes.
#ifndef MICROTIN_TESTS_BENCH_CURVES_HPP
#define MICROTIN_TESTS_BENCH_CURVES_HPP

#include <string>
#include <utility>
#include <vector>

namespace microtin::bench {

struct Place {
  double x, y;
};

struct Mark {
  double x, y;
  std::string text;
};

struct Series {
  std::string name;
  std::vector<Place> line;
  std::vector<Mark> marks;
};

class Chart {
 public:
  explicit Chart(std::string x_title) : x_title_(std::move(x_title)) {}

  void add(Series series) { series_.push_back(std::move(series)); }

  // The chart's SVG elements, its left upper corner at (left, 0). y is in bytes.
  std::string svg(double left) const;

  static constexpr double kWidth = 460, kHeight = 420;

 private:
  std::string x_title_;
  std::vector<Series> series_;
};

// Side by side. Throws Error if the file cannot be written.
void write_charts(const std::string& path, const std::vector<Chart>& charts);

}  // namespace microtin::bench

#endif
