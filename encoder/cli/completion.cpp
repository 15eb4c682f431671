// SPDX-License-Identifier: MIT
// Writes the scripts of shell completion from the definitions of commands and options.
#include "encoder/cli/pages.hpp"

namespace microtin::cli {
namespace {

std::string joined(const std::vector<std::string>& parts, const char* separator) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : separator) + part;
  return text;
}

// --- bash ---

// The names of options whose value is not a file, behind which nothing can be proposed.
std::vector<std::string> names_of_values(const CommandText& command) {
  std::vector<std::string> names;
  for (const OptionText& option : command.options) {
    if (!option.takes_value || option.takes_file) continue;
    names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

std::string bash_case(const CommandText& command) {
  std::string text = "    " + command.name + ")\n";
  text += "      options='" + joined(names_of_options(command), " ") + "'\n";
  text += "      values='" + joined(names_of_values(command), " ") + "'\n";
  if (!command.commands.empty()) {
    text += "      commands='" + joined(names_of_commands(command), " ") + "'\n";
  }
  return text + "      ;;\n";
}

// Where nothing is proposed, readline proposes files, as `complete` below says.
constexpr const char* kBashBegin =
    R"(# bash completion of microtin, written by `microtin completion bash`
_microtin() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}
  local options='' values='' commands=''
  COMPREPLY=()
  if [ "$COMP_CWORD" -eq 1 ]; then
    compopt +o default 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -W ')";

constexpr const char* kBashCases = R"(' -- "$current")
    return
  fi
  case ${COMP_WORDS[1]} in
)";

constexpr const char* kBashEnd = R"(  esac
  if [[ " $values " == *" $previous "* ]]; then
    compopt +o default 2>/dev/null
  elif [[ $current == -* ]]; then
    mapfile -t COMPREPLY < <(compgen -W "$options" -- "$current")
  elif [[ -n $commands ]]; then
    compopt +o default 2>/dev/null
    mapfile -t COMPREPLY < <(compgen -W "$commands" -- "$current")
  fi
}
complete -o default -F _microtin microtin
)";

// --- zsh ---

std::string quoted(const std::string& text) {
  return "'" + replaced(text, '\'', "'\\''") + "'";
}

// A description between brackets.
std::string explanation(const OptionText& option) {
  const std::string text = replaced(option.description, '\\', "\\\\");
  return "[" + replaced(replaced(text, '[', "\\["), ']', "\\]") + "]";
}

// What follows an option or stands alone: a message, and how to complete it.
std::string zsh_value(const OptionText& option) {
  if (!option.takes_value) return "";
  return option.takes_file ? ":file:_files" : ":value: ";
}

std::string zsh_option(const OptionText& option) {
  const std::string excluded = "(" + joined(option.names, " ") + ")";
  std::string text;
  for (const std::string& name : option.names) {
    text += " \\\n        " + quoted(excluded + name + explanation(option) + zsh_value(option));
  }
  return text;
}

std::string zsh_options(const CommandText& command) {
  std::string text;
  for (const OptionText& option : command.options) text += zsh_option(option);
  return text;
}

std::string zsh_case(const CommandText& command) {
  std::string text = "    " + command.name + ")\n      _arguments" + zsh_options(command);
  for (const OptionText& argument : command.arguments) {
    text += " \\\n        " + quoted((argument.repeats ? "*" : "") + zsh_value(argument));
  }
  if (!command.commands.empty()) {
    text += " \\\n        " + quoted(":command:(" + joined(names_of_commands(command), " ") + ")");
  }
  return text + "\n      ;;\n";
}

std::string zsh_commands(const CommandText& program) {
  std::string text;
  for (const CommandText& command : program.commands) {
    text += "        " + quoted(command.name + ":" + command.description) + "\n";
  }
  return text;
}

constexpr const char* kZshBegin = R"(#compdef microtin
# zsh completion of microtin, written by `microtin completion zsh`
_microtin() {
  local context state state_descr line
  typeset -A opt_args
  _arguments -C)";

constexpr const char* kZshCommands = R"( \
        ':command:->command' '*::argument:->argument'
  case $state in
    command)
      local -a commands=(
)";

constexpr const char* kZshCases = R"(      )
      _describe command commands
      return
      ;;
    argument) ;;
    *) return ;;
  esac
  case $line[1] in
)";

constexpr const char* kZshEnd = R"(  esac
}
_microtin "$@"
)";

}  // namespace

std::string bash_completion(const CommandText& program) {
  std::string text = kBashBegin + joined(names_of_commands(program), " ") + ' ';
  text += joined(names_of_options(program), " ") + kBashCases;
  for (const CommandText& command : program.commands) text += bash_case(command);
  return text + kBashEnd;
}

std::string zsh_completion(const CommandText& program) {
  std::string text =
      kZshBegin + zsh_options(program) + kZshCommands + zsh_commands(program) + kZshCases;
  for (const CommandText& command : program.commands) text += zsh_case(command);
  return text + kZshEnd;
}

}  // namespace microtin::cli
