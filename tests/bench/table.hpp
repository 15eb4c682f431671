// SPDX-License-Identifier: MIT
// Markdown tables.
#ifndef MICROTIN_TESTS_BENCH_TABLE_HPP
#define MICROTIN_TESTS_BENCH_TABLE_HPP

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace microtin::bench {

using Row = std::vector<std::string>;

inline void print_row(const Row& row) {
  for (const std::string& cell : row) std::printf("| %s ", cell.c_str());
  std::puts("|");
  std::fflush(stdout);
}

inline void print_head(const std::string& title, const Row& head) {
  std::printf("\n### %s\n\n", title.c_str());
  print_row(head);
  print_row(Row(head.size(), "---"));
}

inline std::string number(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

inline std::string number(size_t value) {
  return std::to_string(value);
}

class GeometricMean {
 public:
  void add(double value) {
    log_sum_ += std::log(value);
    ++count_;
  }

  double value() const { return std::exp(log_sum_ / count_); }

 private:
  double log_sum_ = 0;
  int count_ = 0;
};

}  // namespace microtin::bench

#endif
