// SPDX-License-Identifier: MIT
#include "tests/bench/bounds.hpp"

#include <algorithm>
#include <ctime>
#include <optional>
#include <vector>

#include "encoder/base/error.hpp"
#include "tests/bench/curves.hpp"
#include "tests/bench/flat_parts.hpp"
#include "tests/bench/inputs.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/table.hpp"
#include "tests/support/approximations.hpp"

namespace microtin::bench {
namespace {

struct Quoted {
  size_t lerc, sperr, sz3;  // bytes; 0: not known
};

struct Task {
  const char* terrain;
  const char* bound;  // metres
  Quoted quoted;
};

// Quoted: LERC with zstd, SPERR and SZ3 on the same posts and bounds, all of them without random
// access; measured once, elsewhere.
constexpr Task kTasks[] = {
    {"scottish_borders", "10", {74335, 16132, 15555}},
    {"scottish_borders", "30", {39930, 6197, 4694}},
    {"osnabrueck", "5", {42338, 12028, 10258}},
    {"bigtujunga", "20", {71417, 11171, 9906}},
    {"jacksboro", "10", {67097, 22537, 20866}},
    {"jacksboro", "3", {0, 0, 44952}},
    {"sthelens", "10", {}},
    {"riviera", "30", {}},
    {"andorra", "30", {}},
    {"jd211_multibeam", "0.1", {}},
    {"tidal_marsh", "0.2", {}},
    {"bijou_gully", "0.5", {}},
};

struct Result {
  size_t bytes, vertices;
  Decimal z_step;
  double rms, mean;
  std::optional<double> flat_mean;
  double seconds;  // of processor time
};

// Throws Error if the decoded terrain is not within the bound.
Result measure(const Raster& raster, const char* bound, Search search, bool never_below = false) {
  const Source source = raster;
  const std::clock_t start = std::clock();
  LatticeOptions lattice;
  lattice.max_error = parse_decimal(bound);
  lattice.never_below = never_below;
  const auto [found, encoding, verified] = approximated(source, lattice, search);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const bool below = never_below && verified.max_below.mantissa != 0;
  if (!verified.within_bound || verified.uncovered != 0 || below) throw Error("a bound is broken");
  std::vector<double> errors(raster.heights.size());
  verify(encoding.decoded.mesh(), source, {}, [&](int64_t x, int64_t y, int64_t, double above) {
    errors[static_cast<size_t>(y * raster.width + x)] = above;
  });
  return {encoding.stream.size(),
          found.tin.vertices.size(),
          found.laid.z_step,
          std::stod(to_string(verified.rms_error)),
          std::stod(to_string(verified.mean_error)),
          worst_flat_mean(raster, errors),
          seconds};
}

std::string known(size_t bytes) {
  return bytes != 0 ? number(bytes) : "";
}

std::string known(std::optional<double> value) {
  return value ? number(*value, 3) : "";
}

// What is printed of a search, and of its result.
void add_columns(Row& row, const std::string& search) {
  row.insert(row.end(), {search, "rms", "mean", "flat", "s"});
}

void add_cells(Row& row, const Result& result) {
  row.insert(row.end(), {number(result.bytes), number(result.rms, 3), number(result.mean, 3),
                         known(result.flat_mean), number(result.seconds, 1)});
}

Row columns() {
  Row row = {"terrain, bound in metres", "LERC (quoted)", "SPERR (quoted)", "SZ3 (quoted)",
             "greedy"};
  add_columns(row, "`--fast`");
  add_columns(row, "microtin");
  row.insert(row.end(), {"vertices", "z step"});
  add_columns(row, "`--best`");
  row.insert(row.end(), {"microtin / SZ3", "`--never-below`", "at half the bound"});
  return row;
}

// Prints the row of a task; adds to the mean of ratios where all are known.
void print_task(const Task& task, GeometricMean& mean) {
  const Raster raster = read_raster({task.terrain, {}});
  const auto measured = [&](Search search) { return measure(raster, task.bound, search); };
  const Result normal = measured(Search::kNormal);
  const Result above = measure(raster, task.bound, Search::kNormal, true);
  const std::string half_bound = number(std::stod(task.bound) / 2, 3);
  const Result half = measure(raster, half_bound.c_str(), Search::kNormal);
  const double ratio =
      static_cast<double>(normal.bytes) / static_cast<double>(std::max<size_t>(task.quoted.sz3, 1));
  if (task.quoted.lerc != 0) mean.add(ratio);
  Row row = {std::string(task.terrain) + " " + task.bound, known(task.quoted.lerc),
             known(task.quoted.sperr), known(task.quoted.sz3),
             number(measured(Search::kGreedy).bytes)};
  add_cells(row, measured(Search::kFast));
  add_cells(row, normal);
  row.insert(row.end(), {number(normal.vertices), to_string(normal.z_step)});
  add_cells(row, measured(Search::kBest));
  row.insert(row.end(), {task.quoted.sz3 != 0 ? number(ratio, 3) : "", number(above.bytes),
                         number(half.bytes)});
  print_row(row);
}

}  // namespace

void print_bounds() {
  if (rasters().empty()) return;
  print_head(
      "Bytes at a guaranteed error, mean error of all and of the worst flat part; quoted: LERC + "
      "zstd, SPERR, SZ3",
      columns());
  GeometricMean mean;
  for (const Task& task : kTasks) print_task(task, mean);
  std::printf("\nGeometric mean of microtin / SZ3 over the first five: %.3f\n", mean.value());
}

void draw_curves(const std::string& path) {
  Chart against_bound("largest error, m"), against_rms("rms error, m");
  for (const char* terrain : {"scottish_borders", "bigtujunga", "jacksboro"}) {
    Series bound_series{terrain, {}, {}}, rms_series{terrain, {}, {}};
    for (const char* bound : {"3", "5", "10", "20", "30", "60"}) {
      const Result result = measure(read_raster({terrain, {}}), bound, Search::kNormal);
      const auto bytes = static_cast<double>(result.bytes);
      bound_series.line.push_back({std::stod(bound), bytes});
      rms_series.line.push_back({result.rms, bytes});
      for (const Task& task : kTasks) {
        if (task.terrain != bound_series.name || std::string(task.bound) != bound) continue;
        const double at = std::stod(bound);
        bound_series.marks.push_back({at, static_cast<double>(task.quoted.sz3), "SZ3"});
        if (task.quoted.lerc == 0) continue;
        bound_series.marks.push_back({at, static_cast<double>(task.quoted.lerc), "LERC"});
      }
    }
    against_bound.add(bound_series);
    against_rms.add(rms_series);
  }
  write_charts(path, {against_bound, against_rms});
}

}  // namespace microtin::bench
