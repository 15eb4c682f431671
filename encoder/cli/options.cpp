// SPDX-License-Identifier: MIT
// Defines options of the command line, and reads their values.
#include "encoder/cli/options.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <memory>
#include <vector>

#include "encoder/cli/pages.hpp"
#include "encoder/files/output.hpp"
#include "encoder/import/import.hpp"

namespace microtin::cli {
namespace {

constexpr const char* kTerrainFiles =
    "Files of one terrain, or folders of them. Rasters: .hgt, .zip with one .hgt, .asc. Points: "
    ".xyz, .csv, .txt, .las, .laz, .ply, .obj; - reads points from standard input"
#ifdef MICROTIN_WITH_GDAL
    ". GDAL reads other formats"
#endif
    ;

// Other names of standard output are "-" for all that follows, unless a suffix stands for a format.
std::string plain_output(const std::string& path) {
  if (path.empty()) {
    throw CLI::ValidationError("--output", "'' is not allowed; use the name of a file, or -");
  }
  const bool is_plain = std::filesystem::u8path(path).extension().empty();
  return is_plain && descriptor_named(path) == kStandardOutput ? "-" : path;
}

template <class Number>
bool read_all(std::string_view text, Number& number) {
  const char* const end = text.data() + text.size();
  const auto [next, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && next == end;
}

bool read_classes(std::string_view text, ClassSet& classes) {
  if (text == "all") {
    classes.set();
    return true;
  }
  uint32_t code = 0;
  for (size_t start = 0, end = 0; end != std::string_view::npos; start = end + 1) {
    end = text.find(',', start);
    if (!read_number(text.substr(start, end - start), code) || code >= classes.size()) return false;
    classes.set(code);
  }
  return true;
}

bool read_code(std::string_view text, uint32_t& code) {
  return read_number(text, code) && code != 0;
}

bool read_epsg(std::string_view text, uint32_t& horizontal, uint32_t& vertical) {
  const size_t colon = text.find(':');
  return read_code(text.substr(0, colon), horizontal) &&
         (colon == std::string_view::npos || read_code(text.substr(colon + 1), vertical));
}

// The name of an option, and that of its value.
std::pair<std::string, std::string> split(const std::string& definition) {
  const size_t space = definition.find(' ');
  return {definition.substr(0, space), definition.substr(space + 1)};
}

// "max_error" of "--max-error".
std::string parameter_name(const std::string& option) {
  std::string name = option.substr(2);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

// "quick|balanced|dense".
std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : "|") + word;
  return text;
}

}  // namespace

std::string option_name(const std::string& parameter) {
  std::string name = "--" + parameter;
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

void begin_group(CLI::App& command, const std::string& group) {
  command.option_defaults()->group(group);
}

CLI::Option* add_output(CLI::App& command, std::string& path, const std::string& description) {
  return command.add_option("-o,--output", path, description)
      ->required()
      ->type_name(kFile)
      ->transform(plain_output);
}

CLI::Option* add_stream(CLI::App& command, std::string& path) {
  return command.add_option("STREAM", path, "A stream (.mtin) or a pack (.mtp)")
      ->required()
      ->type_name(kFile);
}

CLI::Option* add_terrain(CLI::App& command, std::string& path, Preparation& preparation,
                         const std::string& name, const std::string& description) {
  return command
      .add_option_function<std::vector<std::string>>(
          name,
          [&path, &preparation](const std::vector<std::string>& files) {
            path = files[0];
            preparation.more_files.assign(files.begin() + 1, files.end());
          },
          description)
      ->type_name(kFile);
}

namespace {

void take_cells(std::string& path, Preparation& preparation) {
  CellList list = read_cell_list(preparation.cells);
  if (path.empty()) {
    path = list.files.front();
    list.files.erase(list.files.begin());
  }
  for (std::string& file : list.files) preparation.more_files.push_back(std::move(file));
  preparation.sea = std::move(list.sea);
}

}  // namespace

void add_cells(CLI::App& command, std::string& path, Preparation& preparation, bool is_required) {
  add_text(command, "--cells FILE", preparation.cells,
           "Read the files and folders too that this text names, one on a line, relative to its "
           "folder. A line \"sea N50W010\" makes sea of what is absent from that cell");
  command.parse_complete_callback([&path, &preparation, is_required] {
    if (!preparation.cells.empty()) take_cells(path, preparation);
    if (is_required && path.empty()) throw CLI::RequiredError("TERRAIN");
  });
}

void add_terrain(CLI::App& command, std::string& path, Preparation& preparation) {
  add_terrain(command, path, preparation, "TERRAIN", kTerrainFiles);
  add_cells(command, path, preparation, true);
}

void add_json(CLI::App& command, bool& json) {
  command.add_flag("--json", json, "Print JSON");
}

CLI::Option* add_read(CLI::App& command, const std::string& definition,
                      std::function<bool(const std::string&)> read, const std::string& wanted,
                      const std::string& description) {
  const auto [name, value] = split(definition);
  const auto take = [option = name, read = std::move(read), wanted](const std::string& text) {
    if (!read(text)) {
      throw CLI::ValidationError(option, '\'' + text + "' is not allowed; use " + wanted);
    }
  };
  return command.add_option_function<std::string>(name, take, description)->type_name(value);
}

CLI::Option* add_text(CLI::App& command, const std::string& definition, std::string& text,
                      const std::string& description) {
  const auto [name, value] = split(definition);
  if (value == kFile) {
    const auto read = [&text](const std::string& given) {
      text = given;
      return !given.empty();
    };
    return add_read(command, definition, read, "the name of a file", description)
        ->default_str("none");
  }
  return command.add_option(name, text, description)->type_name(value)->default_str("none");
}

bool read_number(std::string_view text, uint32_t& number) {
  return read_all(text, number);
}

bool read_number(std::string_view text, uint64_t& number) {
  return read_all(text, number);
}

CLI::Option* add_height(CLI::App& command, const std::string& definition,
                        std::optional<Decimal>& value, const std::string& description) {
  const auto read = [&value](const std::string& text) {
    value = parse_decimal(text);
    return value.has_value();
  };
  return add_read(command, definition, read, "a decimal number", description);
}

CLI::Option* add_decimal(CLI::App& command, const std::string& definition,
                         std::optional<Decimal>& value, const std::string& description) {
  const auto read = [&value](const std::string& text) {
    value = parse_decimal(text);
    return value && value->mantissa >= 0;
  };
  return add_read(command, definition, read, "a decimal number from 0 up", description);
}

CLI::Option* add_rectangle(CLI::App& command, std::optional<Extent>& extent,
                           const std::string& description) {
  const auto read = [&extent](const std::string& text) {
    extent = parse_extent(text);
    return extent.has_value();
  };
  return add_read(command, "--extent WEST,SOUTH,EAST,NORTH", read,
                  "WEST,SOUTH,EAST,NORTH, such as 7.5,43,8,43.5", description);
}

void add_indirect([[maybe_unused]] CLI::App& command, [[maybe_unused]] Preparation& preparation) {
#ifdef MICROTIN_WITH_GDAL
  command.add_flag_callback(
      "--allow-vrt", [&preparation] { preparation.indirect = Indirect::kAllowed; },
      "Read .vrt files, which name other files to read, and names that begin with /vsi");
#endif
}

CLI::Option* add_named(CLI::App& command, const std::string& definition, encoder::Options& options,
                       const std::string& description) {
  const auto [name, value] = split(definition);
  const NamedOption& option = named_option(parameter_name(name));
  if (option.flag != nullptr) return command.add_flag(name, options.*option.flag, description);
  if (option.number != nullptr) {
    return add_number(command, definition, options.*option.number, option.least, description,
                      option.most);
  }
  if (option.text != nullptr && option.is_allowed == nullptr) {
    return add_text(command, definition, options.*option.text, description);
  }
  const auto read = [&option, &options](const std::string& text) {
    return !text.empty() && set(option, options, text);
  };
  const auto& words = option.words;
  CLI::Option* const added =
      add_read(command, option.choice == nullptr ? definition : name + ' ' + joined(words), read,
               wanted_by(option), description);
  return option.choice == nullptr ? added : added->default_str(words[option.choice->get(options)]);
}

void add_error_map(CLI::App& command, encoder::Options& options, const std::string& elsewhere) {
  add_named(command, "--error-map FILE", options,
            "Take the bound of each post or point from a raster of bounds, of the terrain's grid "
            "or a coarser one, or from polygons with a property max_error (GeoJSON, or by GDAL); " +
                elsewhere);
  add_named(command, "--route-edge-error METRES", options,
            "Let the bound grow from that at --route to this at the edges of --route-width")
      ->default_str("the same bound");
}

void add_breaklines(CLI::App& command, encoder::Options& options, const std::string& description) {
  add_named(command, "--breaklines FILE", options,
            description +
                " the lines of this file: GeoJSON, what GDAL reads in builds with it, or text with "
                "x, y and maybe z on each line and an empty line between lines");
}

void add_obstacles(CLI::App& command, encoder::Options& options) {
  add_named(command, "--obstacles FILE", options,
            "Raise the terrain to the obstacles of this file (GeoJSON, or by GDAL): points, lines "
            "and polygons with a top or a height above the ground, and a radius in metres. The "
            "surface is "
            "nowhere below them or the terrain: --never-below and --bound-at everywhere hold");
}

namespace {

// In which units and systems the source's numbers are; they override what its files state.
void add_reference(CLI::App& command, encoder::Options& options) {
  add_read(
      command, "--epsg CODE",
      [&options](const std::string& text) {
        return read_epsg(text, options.horizontal_epsg, options.vertical_epsg);
      },
      "an EPSG code, or two with a colon, such as 25832 or 25832:7837",
      "Set the coordinate system: a horizontal EPSG code, or HORIZONTAL:VERTICAL; known codes set "
      "the units")
      ->default_str("as the file states");
  add_named(command, "--units UNIT", options,
            "Set the units: of x, y and heights (metre, foot, us-foot), of both (degree:metre), or "
            "of heights alone (:foot). Lengths in cm, km, yard, fathom and others are converted to "
            "metres")
      ->default_str("as the file or the codes state; heights as x and y");
  add_named(command, "--depths", options,
            "Negate the source's values: they are depths, which grow downwards");
}

// What lies outside of an area, and far from a route, is left out.
void add_extent(CLI::App& command, encoder::Options& options) {
  add_named(command, "--area FILE", options,
            "Keep only what lies in the polygons of this file (GeoJSON, or by GDAL), or on their "
            "borders; all posts outside are void");
  CLI::Option* const route =
      add_named(command, "--route FILE", options,
                "Keep only what lies near the lines of this file (GeoJSON, or by GDAL), and in the "
                "area of --area; all posts outside are void");
  CLI::Option* const width = add_named(command, "--route-width METRES", options,
                                       "Keep this width around a route, half on each side")
                                 ->default_str("none");
  route->needs(width);
  width->needs(route);
}

}  // namespace

void add_preparation(CLI::App& command, Preparation& preparation, encoder::Options& options) {
  begin_group(command, "How the terrain is read");
  const auto read = [&preparation](const std::string& text) {
    return read_classes(text, preparation.classes.emplace());
  };
  add_read(command, "--classes LIST", read, "a list such as 2,9, or all",
           "Read the points of these classes of .las and .laz files, such as 2,9, or all")
      ->default_str("ground, 2; without ground all but noise, 7 and 18");
  add_reference(command, options);
  command.add_flag("--gridded", preparation.gridded,
                   "Read points that are the posts of a raster as that raster");
  add_indirect(command, preparation);
  add_extent(command, options);
#ifdef MICROTIN_WITH_GDAL
  add_number(command, "--band N", preparation.band, 1u,
             "Read heights from this band of a file that GDAL reads")
      ->default_str("the only band");
#endif
  begin_group(command, "Voids and water of rasters");
  add_number(command, "--fill-voids N", preparation.fill_voids, 0u,
             "Interpolate the heights of voids of up to N posts")
      ->default_str("0");
  CLI::Option* const level =
      add_height(command, "--water-level METRES", preparation.water_level,
                 "Make water of the remaining voids, and of posts at this height, in the terrain's "
                 "unit")
          ->default_str("no water");
  add_text(command, "--water-mask FILE", preparation.water_mask,
           "Make water only of the voids where this .asc grid of the terrain's posts has 1, not 0")
      ->needs(level);
  add_choice<Absent>(command, "--absent", preparation.absent,
                     {{"void", Absent::kVoid}, {"sea", Absent::kSea}},
                     "Choose what positions in none of several files are: unknown, or sea at the "
                     "water level")
      ->needs(level);
}

CLI::App& add_look(CLI::App& app, Action& action, const std::string& name,
                   const std::string& description, void (*run)(const std::string&, bool)) {
  struct Request {
    std::string input;
    bool json = false;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command = *app.add_subcommand(name, description);
  command.group(kLookAt);
  add_stream(command, request->input);
  add_json(command, request->json);
  command.callback(
      [request, &action, run] { action = [request, run] { run(request->input, request->json); }; });
  return command;
}

}  // namespace microtin::cli
