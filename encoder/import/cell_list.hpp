// SPDX-License-Identifier: MIT
// Lists of files that make up a terrain, and of cells that are sea.
#ifndef MICROTIN_ENCODER_IMPORT_CELL_LIST_HPP
#define MICROTIN_ENCODER_IMPORT_CELL_LIST_HPP

#include <string>
#include <vector>

#include "encoder/layers.hpp"
#include "encoder/terrain/degrees.hpp"

namespace microtin::importing {

struct CellList {
  std::vector<std::string> files;  // or folders
  std::vector<DegreeCell> sea;
};

// Reads a list of a name a line; names are relative to the list's folder. "sea N50W010" says that a
// cell without a file is sea. Blank lines and those that begin with # are skipped. Throws Error
// naming the list and the line.
CellList read_cell_list(const std::string& path);

}  // namespace microtin::importing

#endif
