// SPDX-License-Identifier: MIT
// Pages about the command line, out of its definitions: help, the manual page, the page of the
// documents, shell completion, and versions. Completion has a source of its own.
#ifndef MICROTIN_ENCODER_CLI_PAGES_HPP
#define MICROTIN_ENCODER_CLI_PAGES_HPP

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
