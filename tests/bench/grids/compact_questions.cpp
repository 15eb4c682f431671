// SPDX-License-Identifier: MIT
// compact_questions CALLGRIND LARGE SMALL CELL: rows for packs with compact slots in the table of
// the questions of an autopilot. CELL is a file named after the cell.
#include <cstdio>
#include <exception>

#include "encoder/terrain/degrees.hpp"
#include "tests/bench/grids/questions.hpp"

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  try {
    const auto cell = microtin::terrain::cell_of(argv[4]);
    if (!cell) return 2;
    microtin::bench::print_pack_questions(argv[2], argv[3], *cell, argv[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "compact_questions: %s\n", error.what());
    return 1;
  }
}
