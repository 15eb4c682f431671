// SPDX-License-Identifier: MIT
// What the command line accepts, and the pages out of that: help, the manual page, the page of the
// documents, shell completion, and versions. The definitions and completion have sources of their
// own.
#ifndef MICROTIN_ENCODER_CLI_PAGES_HPP
#define MICROTIN_ENCODER_CLI_PAGES_HPP

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace microtin::cli {

// The type of an argument that is the path of a file, as --help shows it.
inline constexpr const char* kFile = "FILE";

// An option, or an argument, which has a position and no name that is written.
struct OptionText {
  std::vector<std::string> names;  // -o and --output; none for an argument
  std::string usage;               // "TERRAIN...", "-o FILE"; in brackets if it may be left out
  std::string title;               // as help pages show it: "-o, --output FILE"
  std::string description;         // ends with its range, what it excludes, and its default
  std::string group;
  bool required;
  bool takes_value;
  bool takes_file;
  bool repeats;
};

struct CommandText {
  std::string name;
  std::string description;
  std::string group;
  std::string footer;
  std::vector<OptionText> arguments;
  std::vector<OptionText> options;  // --help is the first
  std::vector<CommandText> commands;
};

// In the order of the definitions, without hidden commands.
CommandText describe(const CLI::App& app);

std::vector<std::string> names_of_options(const CommandText& command);
std::vector<std::string> names_of_commands(const CommandText& program);

// "microtin encode TERRAIN... -o FILE [OPTIONS]", for a command.
std::string synopsis(const CommandText& command);

// The text with `replacement` for every `character`.
std::string replaced(std::string_view text, char character, std::string_view replacement);

// The groups of commands on the help page of the program, and the usual group of options.
inline constexpr const char* kEncode = "Encode a terrain";
inline constexpr const char* kLookAt = "Look at a stream or a pack";
inline constexpr const char* kConvert = "Convert a stream or a pack";
inline constexpr const char* kShards = "Encode a pack on many machines";
inline constexpr const char* kOthers = "Others";

inline constexpr const char* kOptions = "Options";

// The page of the program, or of a command: at most 80 columns wide, options in their groups.
std::string help_page(const CLI::App& app);

// One line that names the fault and a remedy: the option or command that was probably meant, or
// where the help is.
std::string usage_fault(const CLI::App& program, const CLI::ParseError& error);

// The library's version, as 1.0.0.
std::string library_version();

// The versions of the library and of the two formats that it reads and writes, a line each.
std::string versions();

// microtin(1) in roff with the macros of man(7).
std::string manual(const CommandText& program);

// encoder/docs/command-line.md, in Markdown.
std::string reference(const CommandText& program);

// Scripts for shells, which know every command and option.
std::string bash_completion(const CommandText& program);
std::string zsh_completion(const CommandText& program);

}  // namespace microtin::cli

#endif
