// SPDX-License-Identifier: MIT
// The command profile: the heights along a line as a report, a table or a picture.
#include "microtin/profile.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "encoder/base/text.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/cli/pages.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/output.hpp"
#include "encoder/picture/render.hpp"
#include "encoder/product/place_query.hpp"

namespace microtin::cli {
namespace {

using encoder::LineOfSight;
using encoder::Profile;
using encoder::ProfilePlace;
using encoder::SightEnd;
using encoder::SightOptions;

struct ProfileRequest {
  std::string input;
  std::string output;  // empty: none
  Place from, to;
  std::optional<Decimal> from_height, to_height;      // above the ground
  std::optional<Decimal> from_altitude, to_altitude;  // above the datum
  std::optional<Decimal> frequency;                   // in MHz
  uint32_t zone_share = 60;                           // percent
  double earth_factor = 4.0 / 3;
  uint32_t samples = 0;  // 0: all places of the profile
  uint32_t width = 1024;
  bool safe = false;
  bool json = false;
};

// With three decimals at most, or as the position needs; null, or nothing, if it is not a number.
std::string shown(double value, const char* absent = "null", int decimals = 3) {
  const auto decimal = shortest_decimal(value, decimals);
  return decimal ? to_string(*decimal) : absent;
}

constexpr int kPositionDecimals = 9;

struct Judged {
  Profile profile;
  SightOptions options;
  std::optional<LineOfSight> sight;
};

SightEnd end_of(const std::optional<Decimal>& height, const std::optional<Decimal>& altitude) {
  if (altitude) return {real(*altitude), true};
  return {height ? real(*height) : 0, false};
}

Judged judge(PlaceQuery& query, const ProfileRequest& request) {
  const auto position = [](const Place& place) { return Position{real(place.x), real(place.y)}; };
  Judged judged;
  judged.profile = query.profile(position(request.from), position(request.to));
  judged.options.earth_factor = request.earth_factor;
  judged.options.frequency = request.frequency ? real(*request.frequency) : 0;
  judged.options.zone_share = request.zone_share / 100.0;
  judged.options.is_safe = request.safe;
  const bool is_wanted =
      request.from_height || request.to_height || request.from_altitude || request.to_altitude;
  if (!is_wanted) return judged;
  judged.sight = line_of_sight(judged.profile, end_of(request.from_height, request.from_altitude),
                               end_of(request.to_height, request.to_altitude), judged.options);
  return judged;
}

std::vector<ProfilePlace> places_of(const Profile& profile, uint32_t samples) {
  return samples == 0 ? profile.places : equal_places(profile, samples);
}

// --- The report ---

std::string quoted(const std::string& text, bool as_json) {
  return as_json ? json(text) : text;
}

void add_extreme(const char* name, const ProfilePlace* place, JsonObject& report) {
  report.emplace_back(name, place == nullptr ? "null" : shown(place->height));
  report.emplace_back(std::string(name) + "_at",
                      place == nullptr ? "null" : shown(place->distance));
}

void add_sight(const Judged& judged, bool as_json, JsonObject& report) {
  const LineOfSight& sight = *judged.sight;
  report.emplace_back("line_of_sight", quoted(name_of(sight.line), as_json));
  report.emplace_back("from_altitude", shown(sight.from));
  report.emplace_back("to_altitude", shown(sight.to));
  report.emplace_back("least_clearance", shown(sight.least_clearance));
  report.emplace_back("least_clearance_at", shown(sight.least_clearance_at));
  report.emplace_back("first_obstruction_at", shown(sight.first_obstruction));
  report.emplace_back("earth_radius",
                      shown(judged.profile.earth_radius * judged.options.earth_factor, "null", 0));
  if (judged.options.frequency <= 0) return;
  report.emplace_back("fresnel_zone", quoted(name_of(sight.zone), as_json));
  report.emplace_back("free_percent", shown(100 * sight.free_share, "null", 1));
  report.emplace_back("free_percent_at", shown(sight.free_share_at));
  report.emplace_back("first_zone_obstruction_at", shown(sight.first_zone_obstruction));
}

std::string place_json(const ProfilePlace& place) {
  return json(JsonObject{{"distance", shown(place.distance)},
                         {"x", shown(place.x, "null", kPositionDecimals)},
                         {"y", shown(place.y, "null", kPositionDecimals)},
                         {"height", shown(place.height)},
                         {"known_before", place.is_known_before ? "true" : "false"}});
}

std::string place_list(const std::vector<ProfilePlace>& places) {
  std::string list = "[";
  for (const ProfilePlace& place : places) {
    list += (list.size() == 1 ? "\n    " : ",\n    ") + place_json(place);
  }
  return list + "\n  ]";
}

std::string report_of(const Judged& judged, const ProfileRequest& request, Unit vertical) {
  const Profile& profile = judged.profile;
  const bool as_json = request.json;
  const char* const missing =
      profile.result == MICROTIN_QUERY_OK ? "none" : word_for(profile.result);
  JsonObject report = {{"length", shown(profile.length)},
                       {"without_heights", quoted(missing, as_json)},
                       {"height_unit", quoted(std::string(name_of(vertical)), as_json)}};
  report.emplace_back("first_height", shown(profile.places.front().height));
  report.emplace_back("last_height", shown(profile.places.back().height));
  add_extreme("lowest", lowest_of(profile), report);
  add_extreme("highest", highest_of(profile), report);
  if (!std::isnan(profile.geodesic_deviation)) {
    report.emplace_back("geodesic_deviation", shown(profile.geodesic_deviation));
  }
  if (judged.sight) add_sight(judged, as_json, report);
  const std::vector<ProfilePlace> places = places_of(profile, request.samples);
  report.emplace_back("places", as_json ? place_list(places) : std::to_string(places.size()));
  return text_of(report, as_json);
}

// --- Files ---

// What is not there is an empty field.
std::string csv_of(const Judged& judged, uint32_t samples) {
  std::string text = "distance,x,y,height,known_before";
  if (judged.sight) text += ",ray,bulge";
  if (judged.sight && judged.options.frequency > 0) text += ",fresnel_radius";
  text += '\n';
  const Profile& profile = judged.profile;
  for (const ProfilePlace& place : places_of(profile, samples)) {
    text += shown(place.distance) + ',' + shown(place.x, "", kPositionDecimals) + ',' +
            shown(place.y, "", kPositionDecimals) + ',' + shown(place.height, "") + ',' +
            (place.is_known_before ? '1' : '0');
    if (judged.sight) {
      const double part = profile.length > 0 ? place.distance / profile.length : 0;
      const double ray = judged.sight->from * (1 - part) + judged.sight->to * part;
      text += ',' + shown(ray, "") + ',' +
              shown(earth_bulge(profile, judged.options, place.distance), "");
      if (judged.options.frequency > 0) {
        text += ',' + shown(fresnel_radius(profile, judged.options, place.distance), "");
      }
    }
    text += '\n';
  }
  return text;
}

std::string content_of(const Judged& judged, const ProfileRequest& request, Unit vertical) {
  const std::string suffix = suffix_of(request.output);
  const ProfilePicture picture{judged.profile, judged.options, judged.sight, vertical};
  if (suffix == ".svg") return profile_svg(picture, request.width);
  if (suffix != ".png") return csv_of(judged, request.samples);
  const std::vector<uint8_t> png = profile_png(picture, request.width);
  return {png.begin(), png.end()};
}

void expect_output(const std::string& path) {
  const std::string suffix = suffix_of(path);
  if (path.empty() || path == "-" || suffix == ".csv" || suffix == ".png" || suffix == ".svg") {
    return;
  }
  throw Error(path + ": is not a kind of file that profile writes; name it .csv, .png or .svg");
}

// --- Options ---

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

// Prints what a line crosses, and whether its ends see each other. Returns the exit code.
int run_profile(const ProfileRequest& request) {
  expect_output(request.output);
  refuse_overwriting({request.input}, request.output.empty() ? "-" : request.output);
  return code_unless_damaged([&] {
    PlaceQuery query(request.input);
    const Judged judged = with_file_context(request.input, [&] { return judge(query, request); });
    const std::string report = report_of(judged, request, query.vertical_unit());
    const int code = code_for(judged.profile.result);
    if (request.output.empty()) {
      print(report);
      return code;
    }
    const std::string content = content_of(judged, request, query.vertical_unit());
    OutputFile out(request.output);
    out.write(content);
    deliver(out, request.output, report);
    return code;
  });
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
