// SPDX-License-Identifier: MIT
// The command height: the heights at places that are named, one on the command line or many on
// standard input.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include "encoder/cli/commands.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/cli/pages.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/files/input.hpp"
#include "encoder/files/output.hpp"
#include "encoder/import/text.hpp"
#include "encoder/product/place_query.hpp"

namespace microtin::cli {
namespace {

struct HeightRequest {
  std::string input;
  std::optional<Place> place;  // else those on standard input, one a line
  bool lattice = false;
  bool device = false;  // answers as a device does
};

constexpr int kDecimals = 3;  // of a height: millimetres, where the unit is the metre

struct Answer {
  microtin_query_result kind;
  std::string text;  // a number or a word
};

Answer result_at(PlaceQuery& query, const Place& place, const HeightRequest& request) {
  const bool on_lattice = request.lattice;
  const auto [kind, height] = request.device ? query.device_height_at(place.x, place.y, on_lattice)
                                             : query.height_at(place.x, place.y, on_lattice);
  if (kind != MICROTIN_QUERY_OK) return {kind, word_for(kind)};
  const Axis z = on_lattice ? Axis{0, 1, 1} : query.placement().z;
  return {kind, to_string(rounded_height(z, height, kDecimals))};
}

// Results behind the lines of places.
std::string answered(PlaceQuery& query, std::string_view lines, const HeightRequest& request) {
  std::string text;
  for (uint64_t number = 1; !lines.empty(); ++number) {
    const std::string_view line = take_line(lines);
    if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
    const std::optional<Place> place = parse_place(line, request.device);
    if (!place) {
      throw Error("standard input, line " + std::to_string(number) + ": is not a position, X Y" +
                  remedy_for_commas(line));
    }
    text += std::string(line) + ' ' + result_at(query, *place, request).text + '\n';
  }
  return text;
}

}  // namespace

const char* word_for(microtin_query_result answer) {
  switch (answer) {
    case MICROTIN_QUERY_VOID:
      return "void";
    case MICROTIN_QUERY_BAD_TILE:
      return "damaged";
    default:
      return "outside";
  }
}

int code_for(microtin_query_result answer) {
  switch (answer) {
    case MICROTIN_QUERY_OK:
      return 0;
    case MICROTIN_QUERY_VOID:
      return kInVoid;
    case MICROTIN_QUERY_BAD_TILE:
      return kDamaged;
    default:
      return kOutside;
  }
}

int code_unless_damaged(const std::function<int()>& work) {
  try {
    return work();
  } catch (const Damaged& damaged) {
    std::fputs(("microtin: " + std::string(damaged.what()) + '\n').c_str(), stderr);
    return kDamaged;
  }
}

std::optional<Place> parse_place(std::string_view text, bool for_device) {
  const int decimals = for_device ? PlaceQuery::kDeviceDecimals : kPlaceDecimals;
  constexpr const char* kBetween = " \t,;";
  std::vector<Decimal> numbers;
  while (true) {
    const size_t begin = text.find_first_not_of(kBetween);
    if (begin == std::string_view::npos) break;
    const size_t end = std::min(text.find_first_of(kBetween, begin), text.size());
    const auto number = parse_decimal(text.substr(begin, end - begin), decimals);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    text.remove_prefix(end);
  }
  if (numbers.size() != 2) return std::nullopt;
  return Place{numbers[0], numbers[1]};
}

namespace {

// Prints heights, or words where there are none. Returns the exit code.
int run_height(const HeightRequest& request) {
  refuse_overwriting({request.input}, "-");
  if (!request.place && request.input == "-") {
    throw Error(
        "standard input cannot have both the stream and the positions; name a file for the stream");
  }
  return code_unless_damaged([&] {
    PlaceQuery query(request.input);
    if (!request.place) {
      print(answered(query, without_mark(read_file("-")), request));
      return 0;
    }
    const Answer answer = result_at(query, *request.place, request);
    print(answer.text + '\n');
    return code_for(answer.kind);
  });
}

}  // namespace

void add_height_command(CLI::App& app, Action& action, int& code) {
  struct Request : HeightRequest {
    std::string x, y;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command = *app.add_subcommand("height", "Print the height at one or many positions");
  command.group(kLookAt);
  add_stream(command, request->input);
  CLI::Option* const x = command.add_option(
      "X", request->x,
      "Position to the east, in the terrain's unit. Without a position the command reads lines "
      "\"X Y\" from standard input");
  CLI::Option* const y =
      command.add_option("Y", request->y, "Position to the north, in the terrain's unit");
  x->needs(y);
  command.add_flag("--lattice", request->lattice,
                   "Read positions and print heights in lattice steps");
  command.add_flag("--device", request->device,
                   "Compute as a device does, at the nearest 1/256 of a lattice step");
  command.footer(
      "Where there is no height, the command prints a word: outside, void or damaged. For a "
      "position on the command line the exit codes are then 5, 6 and 7; 7 also if the file is "
      "damaged.");
  command.callback([request, x, &action, &code] {
    if (x->count() != 0) {
      request->place = parse_place(request->x + ' ' + request->y, request->device);
      if (!request->place) {
        throw CLI::ValidationError("X Y", '\'' + request->x + ' ' + request->y +
                                              "' is not allowed; use two decimal numbers");
      }
    }
    action = [request, &code] { code = run_height(*request); };
  });
}

}  // namespace microtin::cli
