// SPDX-License-Identifier: MIT
// What the command profile accepts.
#include <CLI/CLI.hpp>
#include <array>
#include <limits>
#include <memory>
#include <string>

#include "encoder/cli/command_line.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/definitions.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/picture/render.hpp"

namespace microtin::cli {
namespace {

constexpr uint32_t kMostSamples = 1000000;

struct Request : ProfileRequest {
  std::array<std::string, 4> numbers;  // of the positions
};

Place place_of(const std::string& x, const std::string& y) {
  const std::optional<Place> place = parse_place(x + ' ' + y, false);
  if (place) return *place;
  throw CLI::ValidationError("X Y",
                             '\'' + x + ' ' + y + "' is not allowed; use two decimal numbers");
}

// "4/3", "1.25" or "flat".
bool read_earth_factor(const std::string& text, double& factor) {
  if (text == "flat") {
    factor = std::numeric_limits<double>::infinity();
    return true;
  }
  const size_t slash = text.find('/');
  const auto above = parse_decimal(text.substr(0, slash));
  const auto below =
      slash == std::string::npos ? Decimal{1, 0} : parse_decimal(text.substr(slash + 1));
  if (!above || !below || above->mantissa <= 0 || below->mantissa <= 0) return false;
  factor = real(*above) / real(*below);
  return true;
}

void add_ends(CLI::App& command, Request& request) {
  begin_group(command, "Line of sight");
  CLI::Option* const from =
      add_height(command, "--from-height METRES", request.from_height,
                 "Set the height of the first end above the ground, in the terrain's unit")
          ->default_str("the ground if the other end has a height, else no line of sight");
  CLI::Option* const to =
      add_height(command, "--to-height METRES", request.to_height,
                 "Set the height of the second end above the ground, in the terrain's unit")
          ->default_str("the ground if the other end has a height, else no line of sight");
  add_height(command, "--from-altitude METRES", request.from_altitude,
             "Set the height of the first end above the datum of heights")
      ->excludes(from)
      ->default_str("a height above the ground");
  add_height(command, "--to-altitude METRES", request.to_altitude,
             "Set the height of the second end above the datum of heights")
      ->excludes(to)
      ->default_str("a height above the ground");
}

void add_model(CLI::App& command, Request& request) {
  add_read(
      command, "--earth-factor K",
      [&request](const std::string& text) { return read_earth_factor(text, request.earth_factor); },
      "a number above 0, such as 4/3, 1 or 1.25, or flat",
      "Multiply the radius of the Earth, for refraction. 4/3: radio. 1: no refraction. flat: the "
      "Earth is a plane")
      ->default_str("four thirds, 4/3");
  CLI::Option* const frequency =
      add_decimal(command, "--frequency MHZ", request.frequency,
                  "Judge also the first Fresnel zone of this frequency, in megahertz")
          ->default_str("no Fresnel zone");
  add_number(command, "--zone-share PERCENT", request.zone_share, 1u,
             "Set how much of the radius of the first Fresnel zone has to be free", 100u)
      ->default_str(std::to_string(request.zone_share))
      ->needs(frequency);
  command.add_flag("--safe", request.safe,
                   "Judge by the highest that the source can be between its posts, which encoding "
                   "a raster notes");
}

}  // namespace

void add_profile(CLI::App& app, Action& action, int& code) {
  auto request = std::make_shared<Request>();
  CLI::App& command = *app.add_subcommand(
      "profile", "Print the heights along a line, and whether its ends see each other");
  command.group(kLookAt);
  add_stream(command, request->input);
  const std::array<const char*, 4> names = {"X", "Y", "X_END", "Y_END"};
  const std::array<const char*, 4> meanings = {
      "Position of the first end to the east, in the terrain's unit",
      "Position of the first end to the north", "Position of the second end to the east",
      "Position of the second end to the north"};
  for (size_t i = 0; i < names.size(); ++i) {
    command.add_option(names[i], request->numbers[i], meanings[i])->required();
  }
  add_output(command, request->output,
             "Write this file: the places as .csv, or a picture, .png or .svg; - is .csv on "
             "standard output")
      ->required(false)
      ->default_str("no file");
  add_number(command, "--samples N", request->samples, 2u,
             "List N places in equal parts of the line", kMostSamples)
      ->default_str("every place where the line meets an edge");
  add_number(command, "--width N", request->width, kNarrowest, "Set the pixels in a row", kWidest)
      ->default_str(std::to_string(request->width));
  add_json(command, request->json);
  add_ends(command, *request);
  add_model(command, *request);
  command.footer(
      "The report has distances in metres, and heights in the terrain's unit. A blocked line is a "
      "result: the exit code is 0. It is 5, 6 or 7 if a part of the line is outside, void or "
      "damaged; 7 also if the file is damaged.");
  command.callback([request, &action, &code] {
    const auto& numbers = request->numbers;
    request->from = place_of(numbers[0], numbers[1]);
    request->to = place_of(numbers[2], numbers[3]);
    action = [request, &code] { code = run_profile(*request); };
  });
}

}  // namespace microtin::cli
