// SPDX-License-Identifier: MIT
// Help pages, and what to say of a command line that cannot be understood.
#ifndef MICROTIN_ENCODER_CLI_HELP_HPP
#define MICROTIN_ENCODER_CLI_HELP_HPP

#include <string>

#include "encoder/cli/definitions.hpp"

namespace CLI {
class ParseError;
}

namespace microtin::cli {

// The page of the program, or of a command: at most 80 columns wide, options in their groups.
std::string help_page(const CLI::App& app);

// One line that names the fault and a remedy: the option or command that was probably meant, or
// where the help is.
std::string usage_fault(const CLI::App& program, const CLI::ParseError& error);

}  // namespace microtin::cli

#endif
