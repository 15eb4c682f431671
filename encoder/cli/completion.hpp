// SPDX-License-Identifier: MIT
// Shell completion: scripts that know every command and option.
#ifndef MICROTIN_ENCODER_CLI_COMPLETION_HPP
#define MICROTIN_ENCODER_CLI_COMPLETION_HPP

#include <string>

#include "encoder/cli/definitions.hpp"

namespace microtin::cli {

std::string bash_completion(const CommandText& program);
std::string zsh_completion(const CommandText& program);

}  // namespace microtin::cli

#endif
