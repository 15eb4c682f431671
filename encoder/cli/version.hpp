// SPDX-License-Identifier: MIT
// What `microtin --version` prints.
#ifndef MICROTIN_ENCODER_CLI_VERSION_HPP
#define MICROTIN_ENCODER_CLI_VERSION_HPP

#include <string>

namespace microtin::cli {

// The library's version, as 1.0.0.
std::string library_version();

// The versions of the library and of the two formats that it reads and writes, a line each.
std::string versions();

}  // namespace microtin::cli

#endif
