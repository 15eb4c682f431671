// SPDX-License-Identifier: MIT
// The commands check and diff: what is damaged in a file, and how two packs differ.
#include "encoder/base/error.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/output.hpp"
#include "encoder/product/document.hpp"

namespace microtin::cli {
namespace {

// "[1, 2]"
template <class Items, class Text>
std::string json_list(const Items& items, const Text& text) {
  std::string list;
  for (const auto& item : items) {
    list += list.empty() ? "" : ", ";
    list += text(item);
  }
  return '[' + list + ']';
}

std::string of_tiles(size_t some, uint32_t all) {
  return std::to_string(some) + " of " + std::to_string(all) + " tiles";
}

// The numbers of tiles that are of a later version, or bad for another reason.
std::string tiles_of(const std::vector<TileFault>& faults, bool unsupported) {
  std::vector<uint32_t> tiles;
  for (const TileFault& fault : faults) {
    if (fault.is_unsupported == unsupported) tiles.push_back(fault.tile);
  }
  return json_list(tiles, [](uint32_t tile) { return json(tile); });
}

}  // namespace

void run_check(const std::string& input, bool as_json) {
  const Checked found = check_file(input);
  JsonObject report = {{"kind", json(found.tiles == 0 ? "stream" : "pack")}};
  if (found.tiles != 0) {
    report.emplace_back("tiles", json(found.tiles));
    report.emplace_back("unsupported", tiles_of(found.faults, true));
    report.emplace_back("bad", tiles_of(found.faults, false));
    const auto text = [](const TileFault& fault) { return json(fault.text); };
    report.emplace_back("faults", json_list(found.faults, text));
  }
  const bool told = tell(text_of(report, as_json));
  if (!found.faults.empty()) {
    throw Error(input + ": " + of_tiles(found.faults.size(), found.tiles) +
                " cannot be used, or are not as the file states");
  }
  if (!told) throw ReportLost(input + ": is intact, but nobody reads the report");
}

void run_diff(const std::string& first, const std::string& second, bool as_json) {
  const Difference found = compare_packs(first, second);
  const bool told = tell(
      text_of({{"tiles", json(found.tiles)},
               {"header", json(found.is_header_same ? "same" : "different")},
               {"different", json_list(found.differ, [](uint32_t tile) { return json(tile); })}},
              as_json));
  if (!found.differ.empty()) {
    throw Error(second + ": " + of_tiles(found.differ.size(), found.tiles) +
                " differ from those of " + first);
  }
  if (!told) throw ReportLost(second + ": has the same tiles, but nobody reads the report");
}

}  // namespace microtin::cli
