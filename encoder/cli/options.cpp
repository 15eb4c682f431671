// SPDX-License-Identifier: MIT
#include "encoder/cli/options.hpp"

#include <unistd.h>

#include <charconv>
#include <filesystem>
#include <vector>

#include "encoder/cli/definitions.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/import/reference.hpp"

namespace microtin::cli {
namespace {

constexpr const char* kTerrainFiles =
    "Rasters: .hgt, .zip with one .hgt, .asc. Points: .xyz, .csv, .txt, .las, .ply, .obj; - reads "
    "points. Several files, or a folder of them, are one terrain"
#ifdef MICROTIN_WITH_GDAL
    ". Others by GDAL"
#endif
    ;

// Other names of standard output are "-" for all that follows, unless a suffix asks for a format.
std::string plain_output(const std::string& path) {
  const bool is_plain = std::filesystem::path(path).extension().empty();
  return is_plain && descriptor_named(path) == STDOUT_FILENO ? "-" : path;
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

// In which units and systems the source's numbers are; they come before what its files say.
void add_reference(CLI::App& command, Preparation& preparation) {
  Reference& asked = preparation.asked.emplace();
  add_read(
      command, "--epsg",
      [&asked](const std::string& text) {
        return read_epsg(text, asked.horizontal_epsg, asked.vertical_epsg);
      },
      "a code, nor two with a colon between",
      "Codes of the coordinates: horizontal, or horizontal:vertical; known ones set the units");
  add_read(
      command, "--units", [&asked](const std::string& text) { return read_units(text, asked); },
      "a unit, nor two with a colon between",
      "Units of x and y and of heights: metre, foot or us-foot; degree:metre; or :foot for "
      "heights alone; cm, km, yard, fathom and others are converted to metres. If not given: as "
      "the "
      "file or its codes say; heights as x and y");
  command.add_flag("--depths", asked.depths,
                   "The source's heights grow downwards: turn them into heights, by their sign");
}

}  // namespace

void add_output(CLI::App& command, std::string& path, const std::string& description) {
  command.add_option("-o,--output", path, description)
      ->required()
      ->type_name(kFile)
      ->transform(plain_output);
}

CLI::Option* add_stream(CLI::App& command, std::string& path, const std::string& description) {
  return command.add_option("stream", path, description)->required()->type_name(kFile);
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

void add_terrain(CLI::App& command, std::string& path, Preparation& preparation) {
  add_terrain(command, path, preparation, "terrain", kTerrainFiles)->required();
}

void add_json(CLI::App& command, bool& json) {
  command.add_flag("--json", json, "Print JSON");
}

CLI::Option* add_read(CLI::App& command, const std::string& name,
                      std::function<bool(const std::string&)> read, const std::string& wanted,
                      const std::string& description) {
  return command.add_option_function<std::string>(
      name,
      [name, read = std::move(read), wanted](const std::string& text) {
        if (!read(text)) throw CLI::ValidationError(name, text + " is not " + wanted);
      },
      description);
}

bool read_number(std::string_view text, uint32_t& number) {
  return read_all(text, number);
}

bool read_number(std::string_view text, uint64_t& number) {
  return read_all(text, number);
}

CLI::Option* add_height(CLI::App& command, const std::string& name, std::optional<Decimal>& value,
                        const std::string& description) {
  const auto read = [&value](const std::string& text) {
    value = parse_decimal(text);
    return value.has_value();
  };
  return add_read(command, name, read, "a decimal number", description);
}

CLI::Option* add_decimal(CLI::App& command, const std::string& name, std::optional<Decimal>& value,
                         const std::string& description) {
  const auto read = [&value](const std::string& text) {
    value = parse_decimal(text);
    return value && value->mantissa >= 0;
  };
  return add_read(command, name, read, "a decimal number from 0 on", description);
}

void add_indirect([[maybe_unused]] CLI::App& command, [[maybe_unused]] Preparation& preparation) {
#ifdef MICROTIN_WITH_GDAL
  command.add_flag_callback(
      "--allow-vrt", [&preparation] { preparation.indirect = Indirect::kAllowed; },
      "Read .vrt files, which name other files to be read, and names that begin with /vsi");
#endif
}

void add_preparation(CLI::App& command, Preparation& preparation) {
  const auto read = [&preparation](const std::string& text) {
    return read_classes(text, preparation.classes.emplace());
  };
  add_read(
      command, "--classes", read, "a list such as 2,9, nor all",
      "Points to take from a .las file: their classes, 2,9 for instance, or all. If not given: "
      "the ground (2) or, if there is none, all but noise (7, 18)");
  add_reference(command, preparation);
  command.add_flag("--gridded", preparation.gridded,
                   "Take points that are the posts of a raster as that raster");
  add_indirect(command, preparation);
#ifdef MICROTIN_WITH_GDAL
  command
      .add_option("--band", preparation.band,
                  "Band of heights, from 1 on, in a file that has several (read by GDAL)")
      ->check(CLI::PositiveNumber);
#endif
  command.add_option("--fill-voids", preparation.fill_voids,
                     "Interpolate voids of up to this many posts");
  CLI::Option* const level = add_height(
      command, "--water-level", preparation.water_level,
      "Voids that are left are water at this height, as are posts at this height (rasters)");
  command
      .add_option("--water-mask", preparation.water_mask,
                  "An .asc grid of the terrain's posts: 1 where voids are water, else 0")
      ->type_name(kFile)
      ->needs(level);
}

}  // namespace microtin::cli
