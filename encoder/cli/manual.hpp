// SPDX-License-Identifier: MIT
// The manual page, from the texts of --help.
#ifndef MICROTIN_ENCODER_CLI_MANUAL_HPP
#define MICROTIN_ENCODER_CLI_MANUAL_HPP

#include <string>

#include "encoder/cli/definitions.hpp"

namespace microtin::cli {

// microtin(1) in roff with the macros of man(7).
std::string manual(const CommandText& program);

}  // namespace microtin::cli

#endif
