// Reads the definitions of commands and options.
#include "encoder/cli/definitions.hpp"

namespace microtin::cli {

std::vector<const CLI::App*> commands_of(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::vector<const CLI::Option*> options_of(const CLI::App& app) {
  const CLI::Option* const help = app.get_help_ptr();
  return app.get_options(
      [help](const CLI::Option* option) { return option->nonpositional() && option != help; });
}

std::vector<const CLI::Option*> arguments_of(const CLI::App& command) {
  return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

bool takes_value(const CLI::Option& option) {
  return option.get_items_expected_max() != 0;
}

bool takes_file(const CLI::Option& option) {
  return takes_value(option) && option.get_type_name() == kFile;
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
