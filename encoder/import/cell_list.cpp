// SPDX-License-Identifier: MIT
// Lists of files that make up a terrain, and of cells that are sea.
#include <filesystem>
#include <string_view>

#include "encoder/base/error.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/import.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {
namespace {

constexpr std::string_view kBlanks = " \t\r", kSea = "sea";

std::string_view trimmed(std::string_view line) {
  const size_t first = line.find_first_not_of(kBlanks);
  if (first == line.npos) return {};
  return line.substr(first, line.find_last_not_of(kBlanks) - first + 1);
}

void add_line(std::string_view line, const std::filesystem::path& folder, CellList& list) {
  if (line.empty() || line[0] == '#') return;
  const bool is_sea = line.substr(0, kSea.size()) == kSea && line.size() > kSea.size() &&
                      is_blank(line[kSea.size()]);
  if (!is_sea) {
    list.files.push_back((folder / std::filesystem::u8path(line)).string());
    return;
  }
  const std::string name(trimmed(line.substr(kSea.size())));
  const std::optional<DegreeCell> cell = cell_of(name);
  if (!cell) throw Error('\'' + name + "' is not a cell of one degree; write it as N50W010");
  list.sea.push_back(*cell);
}

}  // namespace

CellList read_cell_list(const std::string& path) {
  const std::string content = read_file(path);
  const std::filesystem::path folder = std::filesystem::u8path(path).parent_path();
  CellList list;
  size_t number = 0;
  for (std::string_view rest = without_mark(content); !rest.empty();) {
    ++number;
    with_file_context(path + ", line " + std::to_string(number),
                      [&] { add_line(trimmed(take_line(rest)), folder, list); });
  }
  if (list.files.empty()) throw Error(path + ": names no file; write one on each line");
  return list;
}

}  // namespace microtin::importing
