// SPDX-License-Identifier: MIT
// Checks the paper's systems against the figures recorded in a file, or records them.
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "tests/bench/layers.hpp"
#include "tests/bench/paper/figures.hpp"

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    if (arguments.size() == 1) {
      microtin::bench::check_figures(arguments[0]);
    } else if (arguments.size() == 2 && arguments[0] == "--record") {
      microtin::bench::record_figures(arguments[1]);
    } else {
      throw microtin::base::Error("usage: microtin_paper_check [--record] FIGURES");
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "microtin_paper_check: %s\n", error.what());
    return 1;
  }
}
