// SPDX-License-Identifier: MIT
// Reads the definitions of commands and options out of CLI11.
#include "encoder/cli/definitions.hpp"

#include <CLI/CLI.hpp>

namespace microtin::cli {
namespace {

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

OptionText describe(const CLI::Option& option) {
  const CLI::Formatter format;
  const bool takes_value = option.get_items_expected_max() != 0;
  return {
      names_of(option),
      option.get_positional() ? format.make_option_usage(&option) : "",
      format.make_option_name(&option, option.get_positional()) + format.make_option_opts(&option),
      format.make_option_desc(&option),
      takes_value,
      takes_value && option.get_type_name() == kFile,
      option.get_items_expected_max() > 1};
}

}  // namespace

CommandText describe(const CLI::App& app) {
  CommandText text{app.get_name(), app.get_description(), app.get_footer(), {}, {}, {}};
  for (const CLI::Option* const option : app.get_options()) {
    (option->get_positional() ? text.arguments : text.options).push_back(describe(*option));
  }
  for (const CLI::App* const command : app.get_subcommands({})) {
    if (!command->get_group().empty()) text.commands.push_back(describe(*command));
  }
  return text;
}

std::string replaced(std::string_view text, char character, std::string_view replacement) {
  std::string result;
  for (const char c : text) {
    if (c == character) {
      result += replacement;
    } else {
      result += c;
    }
  }
  return result;
}

}  // namespace microtin::cli
