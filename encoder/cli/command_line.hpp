// SPDX-License-Identifier: MIT
// The commands, each with what it accepts. Parsing sets `action` to the command that is named.
#ifndef MICROTIN_ENCODER_CLI_COMMAND_LINE_HPP
#define MICROTIN_ENCODER_CLI_COMMAND_LINE_HPP

#include <functional>

#include "encoder/layers.hpp"

namespace CLI {
class App;
}

namespace microtin::cli {

using Action = std::function<void()>;

void add_encode(CLI::App& app, Action& action);
void add_update(CLI::App& app, Action& action);
void add_plan(CLI::App& app, Action& action);
void add_merge(CLI::App& app, Action& action);
void add_cut(CLI::App& app, Action& action);
void add_decode(CLI::App& app, Action& action);
void add_embed(CLI::App& app, Action& action);
void add_height_command(CLI::App& app, Action& action, int& code);  // its exit code
void add_profile(CLI::App& app, Action& action, int& code);         // its exit code
void add_info(CLI::App& app, Action& action);
void add_check(CLI::App& app, Action& action);
void add_diff(CLI::App& app, Action& action);
void add_verify(CLI::App& app, Action& action);
void add_fractal(CLI::App& app, Action& action);
void add_render(CLI::App& app, Action& action);

// The command help, with the pages of the commands that are defined before it.
void add_help(CLI::App& app, Action& action);

// Documents for packages of the program, about the commands that are defined when they are printed.
void add_documents(CLI::App& app, Action& action);

}  // namespace microtin::cli

#endif
