// SPDX-License-Identifier: MIT
// Options that several commands take.
#ifndef MICROTIN_ENCODER_CLI_OPTIONS_HPP
#define MICROTIN_ENCODER_CLI_OPTIONS_HPP

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "encoder/import/prepared_terrain.hpp"
#include "encoder/layers.hpp"

namespace microtin::cli {

void add_output(CLI::App& command, std::string& path,
                const std::string& description = "File to write; - is standard output");

CLI::Option* add_stream(CLI::App& command, std::string& path,
                        const std::string& description = "A stream (.mtin) or a pack (.mtp)");

// One or several files, or folders of them, that make up one terrain.
void add_terrain(CLI::App& command, std::string& path, Preparation& preparation);

// The files of a terrain, given by an option instead of as arguments.
CLI::Option* add_terrain(CLI::App& command, std::string& path, Preparation& preparation,
                         const std::string& name, const std::string& description);

void add_json(CLI::App& command, bool& json);

// An option whose text is read by `read`, which says whether it is what is `wanted`. Numbers and
// lists are not left to CLI11: it takes 010 for 8 and the next argument for an item, and does not
// say what it wanted.
CLI::Option* add_read(CLI::App& command, const std::string& name,
                      std::function<bool(const std::string&)> read, const std::string& wanted,
                      const std::string& description);

// A number of decimal digits, all of the text.
bool read_number(std::string_view text, uint32_t& number);
bool read_number(std::string_view text, uint64_t& number);

// A height, of either sign.
CLI::Option* add_height(CLI::App& command, const std::string& name, std::optional<Decimal>& value,
                        const std::string& description);

// A decimal number from 0 on.
CLI::Option* add_decimal(CLI::App& command, const std::string& name, std::optional<Decimal>& value,
                         const std::string& description);

// One of some names for values.
template <class Value>
CLI::Option* add_choice(CLI::App& command, const std::string& name, Value& value,
                        std::map<std::string, Value> choices, const std::string& wanted,
                        const std::string& description) {
  const auto read = [&value, choices = std::move(choices)](const std::string& text) {
    const auto found = choices.find(text);
    if (found != choices.end()) value = found->second;
    return found != choices.end();
  };
  return add_read(command, name, read, wanted, description);
}

void add_indirect(CLI::App& command, Preparation& preparation);

// For encoding, and alike for every comparison with the source.
void add_preparation(CLI::App& command, Preparation& preparation);

}  // namespace microtin::cli

#endif
