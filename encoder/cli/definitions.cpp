// SPDX-License-Identifier: MIT
// Reads the definitions of commands and options out of CLI11.
#include <CLI/CLI.hpp>
#include <set>

#include "encoder/cli/pages.hpp"

namespace microtin::cli {
namespace {

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

// "; not with --a, --b", for those of the command's options, in their order, that are `related`.
std::string related_names(const CLI::App& app, const char* relation,
                          const std::set<CLI::Option*>& related) {
  std::string text;
  for (const CLI::Option* const option : app.get_options()) {
    if (related.count(const_cast<CLI::Option*>(option)) == 0) continue;
    text += (text.empty() ? std::string("; ") + relation : ",") + ' ' + option->get_name();
  }
  return text;
}

// What CLI11 knows of an option, in parentheses: its range, its relations, its default.
std::string limits_of(const CLI::App& app, const CLI::Option& option) {
  std::string text;
  if (!option.get_option_text().empty()) text += "; " + option.get_option_text();
  text += related_names(app, "only with", option.get_needs());
  text += related_names(app, "not with", option.get_excludes());
  if (option.get_required()) text += "; required";
  if (!option.get_default_str().empty()) text += "; default: " + option.get_default_str();
  return text.empty() ? "" : " (" + text.substr(2) + ')';
}

OptionText describe_option(const CLI::App& app, const CLI::Option& option) {
  const bool takes_value = option.get_items_expected_max() != 0;
  const bool repeats = option.get_items_expected_max() > 1;
  const std::string dots = repeats ? "..." : "";
  const std::vector<std::string> names = names_of(option);
  std::string usage = option.get_name(true), title = usage + dots;
  if (!option.get_positional()) {
    const std::string value = takes_value ? ' ' + option.get_type_name() : "";
    usage = names.front() + value;
    title = (names.size() > 1 ? names[0] + ", " + names[1] : names[0]) + value + dots;
  }
  usage += dots;
  return {names,
          option.get_required() ? usage : '[' + usage + ']',
          title,
          option.get_description() + limits_of(app, option),
          option.get_group(),
          option.get_required(),
          takes_value,
          takes_value && option.get_type_name() == kFile,
          repeats};
}

}  // namespace

CommandText describe(const CLI::App& app) {
  CommandText text{
      app.get_name(), app.get_description(), app.get_group(), app.get_footer(), {}, {}, {}};
  for (const CLI::Option* const option : app.get_options()) {
    (option->get_positional() ? text.arguments : text.options)
        .push_back(describe_option(app, *option));
  }
  for (const CLI::App* const command : app.get_subcommands({})) {
    if (!command->get_group().empty()) text.commands.push_back(describe(*command));
  }
  return text;
}

std::vector<std::string> names_of_options(const CommandText& command) {
  std::vector<std::string> names;
  for (const OptionText& option : command.options) {
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

std::vector<std::string> names_of_commands(const CommandText& program) {
  std::vector<std::string> names;
  for (const CommandText& command : program.commands) names.push_back(command.name);
  return names;
}

std::string synopsis(const CommandText& command) {
  std::string text = "microtin " + command.name;
  for (const OptionText& argument : command.arguments) text += ' ' + argument.usage;
  for (const OptionText& option : command.options) {
    if (option.required) text += ' ' + option.usage;
  }
  return text + (command.commands.empty() ? " [OPTIONS]" : " [COMMAND]");
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
