// The manual page, from the texts of --help.
#ifndef MICROTIN_ENCODER_CLI_MANUAL_HPP
#define MICROTIN_ENCODER_CLI_MANUAL_HPP

#include <CLI/CLI.hpp>
#include <string>

namespace microtin::cli {

// microtin(1) in roff with the macros of man(7).
std::string manual(const CLI::App& app);

}  // namespace microtin::cli

#endif
