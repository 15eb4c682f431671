// SPDX-License-Identifier: MIT
// The commands, each with what it accepts. Parsing sets `action` to the one that is asked for.
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
void add_plan(CLI::App& app, Action& action);
void add_merge(CLI::App& app, Action& action);
void add_decode(CLI::App& app, Action& action);
void add_embed(CLI::App& app, Action& action);
void add_height_command(CLI::App& app, Action& action, int& code);  // its exit code
void add_info(CLI::App& app, Action& action);
void add_verify(CLI::App& app, Action& action);
void add_fractal(CLI::App& app, Action& action);
void add_render(CLI::App& app, Action& action);

// For those who package the program; they tell what is defined by the time they run.
void add_documents(CLI::App& app, Action& action);

}  // namespace microtin::cli

#endif
