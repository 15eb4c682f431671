// SPDX-License-Identifier: MIT
// The benchmark's program; `run` calls it.
#include <cstdio>
#include <exception>

#include "encoder/base/error.hpp"
#include "tests/bench/bounds.hpp"
#include "tests/bench/budgets.hpp"
#include "tests/bench/grids/autopilots.hpp"
#include "tests/bench/grids/firmware_grids.hpp"
#include "tests/bench/grids/flight.hpp"
#include "tests/bench/grids/raster_rate.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/paper/linearity.hpp"
#include "tests/bench/paper/tables.hpp"
#include "tests/bench/peers/peer_costs.hpp"
#include "tests/bench/peers/peers.hpp"
#include "tests/bench/rate.hpp"
#include "tests/bench/speed.hpp"
#include "tests/bench/training/pack_starts.hpp"
#include "tests/bench/training/train.hpp"

namespace microtin::bench {
namespace {

using Arguments = std::vector<std::string>;

void print_paper() {
  print_compression();
  print_running_time();
  print_tests();
  print_fractions();
  print_claims();
  print_other_claims();
}

// Whether it is a command that takes no arguments.
bool run_alone(const std::string& command) {
  if (command == "rate") {
    print_missing_peers();
    print_uniform_rate();
    print_terrain_rate();
    print_tile_rate();
  } else if (command == "bounds") {
    print_bounds();
  } else if (command == "paper") {
    print_paper();
  } else if (command == "peers") {
    print_missing_peers();
    print_peer_costs();
    print_raster_rate();
    print_firmware_grids();
  } else if (command == "starts") {
    print_pack_starts();
  } else if (command == "train") {
    print_start_probabilities();
  } else {
    return false;
  }
  return true;
}

void run(const std::string& command, const Arguments& arguments) {
  if (run_alone(command)) return;
  if (command == "budgets" && arguments.size() <= 1) {
    print_budgets(arguments.empty() ? "" : arguments[0]);
  } else if (command == "curves" && arguments.size() == 1) {
    draw_curves(arguments[0]);
  } else if (command == "peer-instructions" && arguments.size() == 1) {
    print_peer_instructions(arguments[0]);
  } else if (command == "grid" && arguments.size() == 2) {
    write_grid(arguments[0], arguments[1]);
  } else if (command == "flight" && arguments.size() == 6) {
    print_flight(
        {arguments[0], arguments[1], arguments[2], arguments[3], arguments[4], arguments[5]});
  } else if (command == "cell" && arguments.size() == 1) {
    write_cell(arguments[0]);
  } else if (command == "autopilots" && arguments.size() == 7) {
    print_autopilots({arguments[0], arguments[1], arguments[2], arguments[3], arguments[4],
                      arguments[5], arguments[6]});
  } else if (command == "linearity" && arguments.size() == 1) {
    print_linearity(
        {"nanoseconds", [](const Work& work) { return 1e9 * seconds_of(work); }, 4096000},
        arguments[0]);
  } else if (command == "growth" && arguments.size() == 2) {
    const auto count = [&](const Work& work) { return instructions({work}, arguments[0])[0]; };
    print_linearity({"instructions", count, 64000}, arguments[1]);
  } else if (command == "scans") {
    print_scan_speed(arguments);
  } else if (command == "streams" && arguments.size() == 1) {
    write_streams(arguments[0]);
  } else if (command == "curve-streams" && arguments.size() == 1) {
    write_curve_streams(arguments[0]);
  } else if (command == "times") {
    print_missing_peers();
    print_decode_speed(arguments, nanoseconds, "nanoseconds");
    print_encode_speed();
  } else if (command == "instructions" && !arguments.empty()) {
    const auto measure = [&](const std::vector<Work>& works) {
      return instructions(works, arguments[0]);
    };
    print_decode_speed(Arguments(arguments.begin() + 1, arguments.end()), measure, "instructions");
  } else {
    throw Error(
        "usage: microtin_bench rate | bounds | budgets [TERRAIN] | curves FILE | paper | peers | "
        "peer-instructions FILE | cell FILE | autopilots CALLGRIND TERRAIN PACK PACK TER DAT DAT | "
        "grid TERRAIN GRID | flight TERRAIN PACK GRID LOG LOG LOG | linearity PLOT | growth FILE "
        "PLOT "
        "| scans [FILE...] | starts | train | streams FOLDER | curve-streams FOLDER | times "
        "STREAM... | "
        "instructions FILE STREAM...");
  }
}

}  // namespace
}  // namespace microtin::bench

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const std::string command = arguments.empty() ? "" : arguments[0];
  try {
    microtin::bench::run(command,
                         {arguments.begin() + (arguments.empty() ? 0 : 1), arguments.end()});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "microtin_bench: %s\n", error.what());
    return 1;
  }
}
