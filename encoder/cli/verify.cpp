// SPDX-License-Identifier: MIT
// The commands verify, check and diff: whether files are what they should be.
#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/cli/pages.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/output.hpp"
#include "encoder/import/breaklines.hpp"
#include "encoder/product/document.hpp"
#include "encoder/product/public_options.hpp"
#include "encoder/verify/everywhere.hpp"

namespace microtin::cli {

// The command verify: compares a stream or a pack with its terrain and judges.

namespace {

// The terrain is read as the stream was encoded; breaklines must be edges.
struct VerifyRequest : TerrainRequest {
  std::string input;
  bool never_below = false;
  bool json = false;
};

void add_true_places(JsonObject& report, const Original::Judgement& judgement) {
  if (!judgement.true_places) return;
  const Verification& found = *judgement.true_places;
  const std::optional<Decimal>& bound = judgement.true_bound;
  report.emplace_back("true_places", json(JsonObject{{"bound", bound ? number(*bound) : "null"},
                                                     {"max_error", number(found.max_error)},
                                                     {"max_below", number(found.max_below)},
                                                     {"max_above", number(found.max_above)},
                                                     {"rms_error", number(found.rms_error)},
                                                     {"mean_error", number(found.mean_error)}}));
}

JsonObject report_of(const Original::Judgement& judgement, const Metadata& notes, bool is_cloud) {
  const Verification& found = judgement.found;
  const std::optional<Decimal> bound = bound_of_all(judgement.promise.bound, found.bounds);
  JsonObject report = {{is_cloud ? "points" : "posts", json(found.posts)},
                       {"covered", json(found.covered)},
                       {"uncovered", json(found.uncovered)}};
  if (!is_cloud) {
    report.emplace_back("voids", json(found.voids));
    report.emplace_back("voids_answered", json(found.voids_answered));
  }
  const JsonObject errors = {
      {"bound", bound ? number(*bound) : "null"}, {"max_error", number(found.max_error)},
      {"max_below", number(found.max_below)},     {"max_above", number(found.max_above)},
      {"rms_error", number(found.rms_error)},     {"mean_error", number(found.mean_error)}};
  report.insert(report.end(), errors.begin(), errors.end());
  if (judgement.promise.bounds && found.bounds) {
    StatedBounds measured = *judgement.promise.bounds;
    measured.span = *found.bounds;
    report.emplace_back("bounds", json_of(measured));
  }
  if (found.everywhere) report.emplace_back("everywhere", json_of(*found.everywhere));
  add_true_places(report, judgement);
  if (is_cloud && notes.classes) report.emplace_back("classes", json(list_of(*notes.classes)));
  if (judgement.promise.water_level) {
    report.emplace_back("water_moved", json(judgement.water_moved));
  }
  return report;
}

std::string text_of_lines(const FoundBreaklines& found, const Placement& placement) {
  return json(JsonObject{{"lines", json(uint64_t{found.lines.size()})},
                         {"edges", json(found.pieces)},
                         {"max_shift", json(found.max_shift)},
                         {"max_error", json(found.max_error * step_of(placement.z))}});
}

// What was overridden or converted of the source's units and systems.
void add_warnings(JsonObject& report, const Original& original) {
  const Reference& reference =
      original.raster() != nullptr ? original.raster()->reference : original.cloud()->reference;
  std::string list;
  for (const std::string& warning : reference.warnings) {
    list += (list.empty() ? "" : ", ") + json(warning);
  }
  if (!list.empty()) report.emplace_back("warnings", '[' + list + ']');
}

// Where points truly lie, too, if the bound is to hold there.
void expect_side(BoundSide side, const Original::Judgement& judgement, const std::string& input) {
  const auto expect = [&](const Verification& found, const std::string& where) {
    const bool is_below = side == BoundSide::kNeverBelow && found.max_below.mantissa != 0,
               is_above = side == BoundSide::kNeverAbove && found.max_above.mantissa != 0;
    if (!is_below && !is_above) return;
    throw Error(input + ": " + where + "the surface is " +
                (is_below ? "below the source, by " : "above the source, by ") +
                to_string(is_below ? found.max_below : found.max_above) + " at most");
  };
  expect(judgement.found, "");
  if (judgement.true_places && judgement.true_bound) {
    expect(*judgement.true_places, "where the points truly lie, ");
  }
}

// The bounds are those of the map, and no error is a larger part of its bound.
std::string broken_bounds(const BoundSpan& stated, const BoundSpan& found) {
  if (!(found.least == stated.least) || !(found.largest == stated.largest)) {
    return "the bounds of the error map go from " + to_string(found.least) + " to " +
           to_string(found.largest) + ", and the header states " + to_string(stated.least) +
           " to " + to_string(stated.largest);
  }
  if (found.ratio <= stated.ratio) return {};
  return "an error is " + to_string(found.ratio) + " of its bound; the header states at most " +
         to_string(stated.ratio);
}

// What the header states of heights.
void expect_stated(const Original::Judgement& judgement, const Metadata& notes,
                   const std::string& input) {
  const Verification& found = judgement.found;
  expect_side(notes.side, judgement, input);
  const Distances at_samples = {found.max_below, found.max_above};
  std::string broken = broken_promise(notes.at_samples, at_samples, "at its samples");
  if (broken.empty() && found.everywhere) {
    const auto stated = stated_everywhere(notes.everywhere, notes.placement.z);
    broken = broken_promise(stated, *found.everywhere, "everywhere");
  }
  if (broken.empty() && notes.bounds && found.bounds) {
    broken = broken_bounds(notes.bounds->span, *found.bounds);
  }
  if (broken.empty()) broken = found.broken;
  if (!broken.empty()) throw Error(input + ": " + broken);
}

void expect_kept(const Original::Judgement& judgement, const std::string& input) {
  const Verification& found = judgement.found;
  if (!found.within_bound) {
    throw Error(input + (found.bounds ? ": an error is above its bound of the error map"
                                      : ": the largest error is above the bound"));
  }
  if (judgement.true_places && !judgement.true_places->within_bound) {
    throw Error(input + ": where the points truly lie, the largest error is above the bound");
  }
  if (found.uncovered != 0) {
    throw Error(input + ": " + std::to_string(found.uncovered) + " of " +
                std::to_string(found.posts) + " heights of the source are not covered" +
                (found.covered == 0 ? "; the source lies elsewhere" : ""));
  }
  if (found.voids_answered != 0) throw Error(input + ": voids of the source have heights");
  if (judgement.water_moved != 0) throw Error(input + ": water of the source is not at its level");
}

void expect_lines(const FoundBreaklines& lines, const VerifyRequest& request) {
  const std::string& file = request.options.breaklines;
  if (lines.missing) throw Error(request.input + ": breaklines: " + *lines.missing);
  if (!lines.wrong_marks) return;
  throw Error(request.input + ": breaklines: " + *lines.wrong_marks + "; encode it again with " +
              parameter("breaklines") + ' ' + file + ", or name the file of lines that it has");
}

// Throws Error, after the report, if the stream fails its promises.
void run_verify(const VerifyRequest& request) {
  const std::string& input = request.input;
  const Preparation preparation = preparation_of(request.options, request.preparation);
  std::vector<std::string> inputs = files_of(request.source, preparation);
  inputs.push_back(input);
  refuse_overwriting(inputs, "-");
  const Document document(input);
  const Original original(document, request.source, preparation);
  ProgressBar bar;
  const Original::Judgement judgement = original.judge(bar.progress());
  JsonObject report = report_of(judgement, document.metadata(), original.cloud() != nullptr);
  if (original.raster() != nullptr && !original.raster()->selection.empty()) {
    report.emplace_back("source", json(original.raster()->selection));
  }
  std::optional<FoundBreaklines> lines;
  if (!request.options.breaklines.empty()) {
    const FeatureFiles files = feature_files_of(preparation);
    lines = original.breaklines(read_breaklines(request.options.breaklines, files));
    report.emplace_back("breaklines", text_of_lines(*lines, document.metadata().placement));
  }
  add_warnings(report, original);
  const bool is_printed = try_print(text_of(report, request.json));
  expect_kept(judgement, input);
  if (request.never_below) expect_side(BoundSide::kNeverBelow, judgement, input);
  expect_stated(judgement, document.metadata(), input);
  if (lines) expect_lines(*lines, request);
  if (!is_printed) throw ReportLost(input + ": keeps its promises, but nobody reads the report");
}

// The commands check and diff: what is damaged in a file, and how two packs differ.

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

// Throws Error, after the report, if a tile cannot be used.
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
  const bool is_printed = try_print(text_of(report, as_json));
  if (!found.faults.empty()) {
    throw Error(input + ": " + of_tiles(found.faults.size(), found.tiles) +
                " cannot be used, or are not as the file states");
  }
  if (!is_printed) throw ReportLost(input + ": is intact, but nobody reads the report");
}

// Throws Error, after the report, if a tile differs.
void run_diff(const std::string& first, const std::string& second, bool as_json) {
  const Difference found = compare_packs(first, second);
  const bool is_printed = try_print(
      text_of({{"tiles", json(found.tiles)},
               {"header", json(found.is_header_same ? "same" : "different")},
               {"different", json_list(found.differ, [](uint32_t tile) { return json(tile); })}},
              as_json));
  if (!found.differ.empty()) {
    throw Error(second + ": " + of_tiles(found.differ.size(), found.tiles) +
                " differ from those of " + first);
  }
  if (!is_printed) throw ReportLost(second + ": has the same tiles, but nobody reads the report");
}

}  // namespace

void add_verify(CLI::App& app, Action& action) {
  auto request = std::make_shared<VerifyRequest>();
  CLI::App& command =
      *app.add_subcommand("verify", "Compare a stream or a pack with its source terrain");
  command.group(kLookAt);
  add_stream(command, request->input);
  add_terrain(command, request->source, request->preparation);
  add_preparation(command, request->preparation, request->options);
  begin_group(command, kOptions);
  command.add_flag("--never-below", request->never_below,
                   "Fail also if the surface is below the source anywhere");
  add_error_map(command, request->options, "the file states the bound elsewhere");
  add_breaklines(command, request->options, "Fail also if edges do not follow");
  add_obstacles(command, request->options);
  add_json(command, request->json);
  command.footer(
      "The exit code is 1, after the report, if the file does not keep its bound, or what an "
      "option "
      "requires.");
  command.callback([request, &action] { action = [request] { run_verify(*request); }; });
}

void add_check(CLI::App& app, Action& action) {
  add_look(app, action, "check",
           "Decode all of a stream or a pack, and list the tiles that cannot be used", run_check)
      .footer(
          "The exit code is 1 if a stream, or a tile of a pack, cannot be used. The report lists "
          "such tiles.");
}

void add_diff(CLI::App& app, Action& action) {
  struct Request {
    std::string first, second;
    bool json = false;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command =
      *app.add_subcommand("diff", "List the tiles in which two packs of the same tiles differ");
  command.group(kLookAt);
  command.add_option("FIRST", request->first, "A pack (.mtp)")->required()->type_name(kFile);
  command.add_option("SECOND", request->second, "A pack of the same tiles")
      ->required()
      ->type_name(kFile);
  add_json(command, request->json);
  command.footer(
      "The exit code is 1, after the report, if a tile differs. A header that differs is reported, "
      "but is no failure.");
  command.callback([request, &action] {
    action = [request] { run_diff(request->first, request->second, request->json); };
  });
}

}  // namespace microtin::cli
