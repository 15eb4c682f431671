// SPDX-License-Identifier: MIT
#include "encoder/import/class_counts.hpp"

namespace microtin::importing {
namespace {

void append(std::string& list, const std::string& item) {
  list += (list.empty() ? "" : ", ") + item;
}

}  // namespace

void add(ClassCounts& sum, const ClassCounts& more) {
  for (size_t c = 0; c < sum.points.size(); ++c) sum.points[c] += more.points[c];
  sum.withheld += more.withheld;
}

std::string taken_text(const ClassCounts& counts, const ClassSet& taken) {
  std::string in, out;
  for (size_t c = 0; c < counts.points.size(); ++c) {
    if (counts.points[c] == 0) continue;
    std::string& list = taken[c] ? in : out;
    append(list, (list.empty() ? "class " : "") + std::to_string(c) + " (" +
                     std::to_string(counts.points[c]) + ")");
  }
  if (counts.withheld != 0) append(out, "withheld (" + std::to_string(counts.withheld) + ")");
  return "taken" + (in.empty() ? in : ": " + in) + (out.empty() ? out : "; left out: " + out);
}

}  // namespace microtin::importing
