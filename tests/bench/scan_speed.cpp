// SPDX-License-Identifier: MIT
// How many points of laser scans are read in a second.
#include <chrono>
#include <cmath>

#include "encoder/files/input.hpp"
#include "encoder/import/cloud.hpp"
#include "encoder/import/import.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/speed.hpp"
#include "tests/bench/table.hpp"
#include "tests/support/laz_file.hpp"

namespace microtin::bench {
namespace {

struct Times {
  double wall = 0, processors = 0;  // seconds
};

// The best of five. By the clock on the wall, all processors share the work.
Times best_times(const Work& work) {
  Times best;
  for (int round = 0; round < 5; ++round) {
    const auto begin = std::chrono::steady_clock::now();
    const double processors = seconds_of(work);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    if (round == 0 || wall.count() < best.wall) best.wall = wall.count();
    if (round == 0 || processors < best.processors) best.processors = processors;
  }
  return best;
}

void print_speed(const std::string& name, const std::string& bytes) {
  const Times times = best_times([&] { import_las(name, bytes, ClassSet().set()); });
  const uint64_t points = points_of_las(ByteReader(name, bytes));
  const auto count = static_cast<double>(points);
  print_row({name, std::to_string(points), number(static_cast<double>(bytes.size()) / count, 1),
             number(count / times.wall / 1e6, 2), number(1e9 * times.processors / count, 0)});
}

// A scan as aircraft make them: lines of 500 pulses, 10 microseconds apart, of which some have two
// returns; ground, and what stands on it, in centimetres.
std::string airborne_scan(uint8_t format, uint32_t points) {
  const bool is_recent = format >= 6;
  std::mt19937 random(1);
  std::string record(tests::kRecordBytes[format], '\0'), records;
  const auto put = [&](size_t at, auto value) { std::memcpy(&record[at], &value, sizeof value); };
  double time = 4e8;
  for (uint32_t i = 0, pulse = 0; i < points; ++pulse) {
    time += 1e-5;
    const uint32_t returns = random() % 5 == 0 ? 2 : 1, line = pulse / 500, column = pulse % 500;
    for (uint32_t k = 1; k <= returns && i < points; ++k, ++i) {
      const bool is_ground = k == returns && random() % 40 != 0;
      const auto noise = [&](uint32_t most) { return static_cast<double>(random() % most); };
      put(0, static_cast<int32_t>(50 * column + noise(9)));
      put(4, static_cast<int32_t>(60 * line + noise(9)));
      put(8, static_cast<int32_t>(2000 * std::sin(line / 90.0) + 3 * column + noise(6) +
                                  (is_ground ? 0 : noise(1500))));
      put(12, static_cast<uint16_t>(40 + random() % 60));
      record[14] = static_cast<char>(k | returns << (is_recent ? 4 : 3));
      record[is_recent ? 16 : 15] = is_ground ? 2 : 5;
      if (is_recent || format % 2 == 1) put(is_recent ? 22 : 20, time);
      const size_t colour = is_recent ? 30 : format % 2 == 1 ? 28 : 20;
      for (size_t at = colour; at < record.size(); at += 2) {
        put(at, static_cast<uint16_t>(256 * (100 + line / 20 % 50 + random() % 4)));
      }
      records += record;
    }
  }
  return tests::scan_of(format, tests::kRecordBytes[format], records);
}

}  // namespace

void print_scan_speed(const std::vector<std::string>& paths) {
  constexpr uint32_t kPoints = 1000000;
  print_head("Reading laser scans", {"scan", "points", "bytes a point", "million points a second",
                                     "nanoseconds of processor time a point"});
  for (const int format : {1, 3, 6, 7}) {
    const std::string las = airborne_scan(static_cast<uint8_t>(format), kPoints);
    const std::string name = "made, format " + std::to_string(format);
    print_speed(name + ", LAS", las);
    print_speed(name + ", LAZ", tests::compressed(las));
  }
  for (const std::string& path : paths) print_speed(path, read_file(path));
}

}  // namespace microtin::bench
