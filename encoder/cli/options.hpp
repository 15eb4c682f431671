// SPDX-License-Identifier: MIT
// Options that several commands take.
#ifndef MICROTIN_ENCODER_CLI_OPTIONS_HPP
#define MICROTIN_ENCODER_CLI_OPTIONS_HPP

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "encoder/cli/commands.hpp"
#include "encoder/export/grid.hpp"
#include "encoder/import/prepared_terrain.hpp"
#include "encoder/layers.hpp"
#include "encoder/product/public_options.hpp"

namespace microtin::cli {

// Options are defined as help pages show them, "--max-error METRES". Those that take a value and
// are not required get their default_str.

// "--max-error", of the parameter max_error: how the command line spells errors of the library.
std::string option_name(const std::string& parameter);

// The options defined from here on are in this group of the help page.
void begin_group(CLI::App& command, const std::string& group);

CLI::Option* add_output(CLI::App& command, std::string& path,
                        const std::string& description = "Write this file; - is standard output");

CLI::Option* add_stream(CLI::App& command, std::string& path);

// One or several files, or folders of them, that make up one terrain.
void add_terrain(CLI::App& command, std::string& path, Preparation& preparation);

// Files of a terrain that a list names. The list is read when the command line is; then, if a
// terrain is required, there must be one.
void add_cells(CLI::App& command, std::string& path, Preparation& preparation, bool is_required);

// The files of a terrain, given by an option instead of as arguments.
CLI::Option* add_terrain(CLI::App& command, std::string& path, Preparation& preparation,
                         const std::string& name, const std::string& description);

void add_json(CLI::App& command, bool& json);

// An option whose text is read by `read`, which returns whether it is `wanted`. Numbers and lists
// are not left to CLI11: it takes 010 for 8 and the next argument for an item, and its messages do
// not name what is allowed.
CLI::Option* add_read(CLI::App& command, const std::string& definition,
                      std::function<bool(const std::string&)> read, const std::string& wanted,
                      const std::string& description);

CLI::Option* add_text(CLI::App& command, const std::string& definition, std::string& text,
                      const std::string& description);

// A number of decimal digits, all of the text.
bool read_number(std::string_view text, uint32_t& number);
bool read_number(std::string_view text, uint64_t& number);

// A whole number from `least` to `most`, of which the help page prints the limits.
template <class Number>
CLI::Option* add_number(CLI::App& command, const std::string& definition, Number& number,
                        Number least, const std::string& description,
                        Number most = std::numeric_limits<Number>::max()) {
  const auto read = [&number, least, most](const std::string& text) {
    return read_number(text, number) && number >= least && number <= most;
  };
  const std::string range = std::to_string(least) + " to " + std::to_string(most);
  CLI::Option* const option =
      add_read(command, definition, read, "a whole number, " + range, description);
  return option->option_text(range);
}

// A height, of either sign.
CLI::Option* add_height(CLI::App& command, const std::string& definition,
                        std::optional<Decimal>& value, const std::string& description);

// A decimal number from 0 up.
CLI::Option* add_decimal(CLI::App& command, const std::string& definition,
                         std::optional<Decimal>& value, const std::string& description);

// A rectangle, --extent WEST,SOUTH,EAST,NORTH.
CLI::Option* add_rectangle(CLI::App& command, std::optional<Extent>& extent,
                           const std::string& description);

// One of some names for values, of which the help page prints all and the default.
template <class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Value& value,
                        const std::vector<std::pair<std::string, Value>>& choices,
                        const std::string& description) {
  std::vector<std::string> names;
  std::string definition = name, usual;
  for (const auto& [word, meaning] : choices) {
    definition += (names.empty() ? ' ' : '|') + word;
    if (meaning == value) usual = word;
    names.push_back(word);
  }
  const auto read = [&value, choices](const std::string& text) {
    for (const auto& [word, meaning] : choices) {
      if (word != text) continue;
      value = meaning;
      return true;
    }
    return false;
  };
  return add_read(command, definition, read, alternatives(names), description)->default_str(usual);
}

// An option of the library's table, "--max-error METRES", which has its values, its limits and its
// default. The definition of a flag, and of a choice, has no name of a value.
CLI::Option* add_named(CLI::App& command, const std::string& definition, encoder::Options& options,
                       const std::string& description);

void add_indirect(CLI::App& command, Preparation& preparation);

// The option --error-map; `elsewhere` ends the description.
void add_error_map(CLI::App& command, encoder::Options& options, const std::string& elsewhere);

// The option --breaklines.
void add_breaklines(CLI::App& command, encoder::Options& options, const std::string& description);

// The option --obstacles.
void add_obstacles(CLI::App& command, encoder::Options& options);

// For encoding, and alike for every comparison with the source.
void add_preparation(CLI::App& command, Preparation& preparation, encoder::Options& options);

// Defines a command that prints what a stream or a pack is like, and returns it.
CLI::App& add_look(CLI::App& app, Action& action, const std::string& name,
                   const std::string& description, void (*run)(const std::string&, bool));

}  // namespace microtin::cli

#endif
