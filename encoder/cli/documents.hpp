// Commands for those who package the program: its manual page and its completions.
#ifndef MICROTIN_ENCODER_CLI_DOCUMENTS_HPP
#define MICROTIN_ENCODER_CLI_DOCUMENTS_HPP

#include <functional>

namespace CLI {
class App;
}

namespace microtin::cli {

// Adds `manual`, `completion bash` and `completion zsh`, which --help does not show. They tell what
// is defined by the time they run; `action` becomes what they do.
void add_documents(CLI::App& app, std::function<void()>& action);

}  // namespace microtin::cli

#endif
