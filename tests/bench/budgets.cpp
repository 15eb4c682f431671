// SPDX-License-Identifier: MIT
#include "tests/bench/budgets.hpp"

#include <algorithm>
#include <ctime>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/product/encode_stream.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/table.hpp"

namespace microtin::bench {
namespace {

struct Task {
  const char* terrain;
  const char* bound;  // metres; what it takes is the limit
};

constexpr Task kTasks[] = {
    {"scottish_borders", "20"}, {"scottish_borders", "80"}, {"andorra", "30"},
    {"andorra", "150"},         {"jd211_multibeam", "0.1"}, {"jd211_multibeam", "0.2"},
};

// Bounds a little below the error that was found, as parts of it.
constexpr double kBelow[] = {0.995, 0.98, 0.95};

struct Result {
  size_t vertices, bytes;
  double error, seconds;  // of processor time
};

Result measure(const Source& source, const EncodeOptions& options) {
  const std::clock_t start = std::clock();
  const EncodedStream encoded = encode_stream(source, options, {});
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return {encoded.vertices, encoded.stream.size(),
          std::stod(to_string(encoded.verification.max_error)), seconds};
}

Result measure_bound(const Source& source, Search search, const std::string& bound) {
  EncodeOptions options;
  options.search = search;
  options.lattice.max_error = parse_decimal(bound);
  return measure(source, options);
}

// The smallest of some bounds that takes no more vertices, as text.
std::string better_bound(const Source& source, Search search, const Result& limit, double error) {
  std::string found = "none";
  for (const double part : kBelow) {
    const std::string bound = number(error * part, 6);
    if (measure_bound(source, search, bound).vertices <= limit.vertices) found = bound;
  }
  return found;
}

void print_task(const Task& task, const std::pair<const char*, Search>& effort) {
  const Source source = read_raster({task.terrain, {}});
  const auto [name, search] = effort;
  const Result limit = measure_bound(source, search, task.bound);
  EncodeOptions options;
  options.search = search;
  options.max_vertices = static_cast<uint32_t>(limit.vertices);
  const Result vertices = measure(source, options);
  options.max_vertices = 0;
  options.max_bytes = static_cast<uint32_t>(limit.bytes);
  const Result bytes = measure(source, options);
  const double unused =
      100 - 100 * static_cast<double>(bytes.bytes) / static_cast<double>(limit.bytes);
  print_row({std::string(task.terrain) + " " + task.bound, name, number(limit.vertices),
             number(vertices.vertices), number(limit.error, 4), number(vertices.error, 4),
             better_bound(source, search, limit, vertices.error),
             number(vertices.seconds / limit.seconds, 1), number(limit.bytes), number(bytes.bytes),
             number(unused, 2), number(bytes.error, 4), number(bytes.seconds / limit.seconds, 1)});
}

}  // namespace

void print_budgets(const std::string& only) {
  if (rasters().empty()) return;
  print_head("Limits: what a bound takes, and what is found within as many vertices or bytes",
             {"terrain, bound in metres", "search", "vertices", "`--max-vertices`", "error",
              "... found", "a smaller bound that takes no more", "times one encoding", "bytes",
              "`--max-bytes`", "unused, %", "error", "times one encoding"});
  for (const Task& task : kTasks) {
    if (!only.empty() && only != task.terrain) continue;
    print_task(task, {"`--fast`", Search::kFast});
    print_task(task, {"", Search::kNormal});
  }
}

}  // namespace microtin::bench
