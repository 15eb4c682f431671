// What the command line accepts, read from its definitions by all that tells people of it.
#ifndef MICROTIN_ENCODER_CLI_DEFINITIONS_HPP
#define MICROTIN_ENCODER_CLI_DEFINITIONS_HPP

#include <CLI/CLI.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace microtin::cli {

// The type of an argument that is the path of a file, as --help shows it.
inline constexpr const char* kFile = "FILE";

// In the order of their definition, without those that --help does not show.
std::vector<const CLI::App*> commands_of(const CLI::App& app);

// What begins with a dash; all but --help, which every command has.
std::vector<const CLI::Option*> options_of(const CLI::App& app);

// What is told apart by its place alone.
std::vector<const CLI::Option*> arguments_of(const CLI::App& command);

// -o and --output, for example.
std::vector<std::string> names_of(const CLI::Option& option);

bool takes_value(const CLI::Option& option);
bool takes_file(const CLI::Option& option);

// The text with `replacement` for every `character`.
std::string replaced(std::string_view text, char character, std::string_view replacement);

}  // namespace microtin::cli

#endif
