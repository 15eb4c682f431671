// SPDX-License-Identifier: MIT
// What the command line accepts, for all that tells people of it beside --help.
#ifndef MICROTIN_ENCODER_CLI_DEFINITIONS_HPP
#define MICROTIN_ENCODER_CLI_DEFINITIONS_HPP

#include <string>
#include <string_view>
#include <vector>

// CLI11 takes its time to compile: only those that define options include it.
namespace CLI {
class App;
}

namespace microtin::cli {

// The type of an argument that is the path of a file, as --help shows it.
inline constexpr const char* kFile = "FILE";

// An option, or an argument, which is told apart by its place alone.
struct OptionText {
  std::vector<std::string> names;  // -o and --output; none for an argument
  std::string usage;               // an argument's name, in brackets if it may be left out
  std::string title;               // as in --help: names, type, default, what it excludes
  std::string description;
  bool takes_value;
  bool takes_file;
  bool repeats;
};

struct CommandText {
  std::string name;
  std::string description;
  std::string footer;
  std::vector<OptionText> arguments;
  std::vector<OptionText> options;  // --help is the first
  std::vector<CommandText> commands;
};

// In the order of the definitions, without those that --help does not show.
CommandText describe(const CLI::App& app);

// The text with `replacement` for every `character`.
std::string replaced(std::string_view text, char character, std::string_view replacement);

}  // namespace microtin::cli

#endif
