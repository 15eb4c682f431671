// SPDX-License-Identifier: MIT
// The manual page and the page of the documents, from the texts of --help.
#ifndef MICROTIN_ENCODER_CLI_MANUAL_HPP
#define MICROTIN_ENCODER_CLI_MANUAL_HPP

#include <string>

#include "encoder/cli/definitions.hpp"

namespace microtin::cli {

// microtin(1) in roff with the macros of man(7).
std::string manual(const CommandText& program);

// encoder/docs/command-line.md, in Markdown.
std::string reference(const CommandText& program);

}  // namespace microtin::cli

#endif
