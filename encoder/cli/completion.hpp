// Shell completion: scripts that know every command and option.
#ifndef MICROTIN_ENCODER_CLI_COMPLETION_HPP
#define MICROTIN_ENCODER_CLI_COMPLETION_HPP

#include <CLI/CLI.hpp>
#include <string>

namespace microtin::cli {

std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);

}  // namespace microtin::cli

#endif
