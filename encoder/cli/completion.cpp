// Writes the scripts of shell completion from the definitions of commands and options.
#include "encoder/cli/completion.hpp"

#include "encoder/cli/definitions.hpp"

namespace microtin::cli {
namespace {

std::string joined(const std::vector<std::string>& parts, const char* separator) {
  std::string text;
  for (const std::string& part : parts) text += (text.empty() ? "" : separator) + part;
  return text;
}

std::vector<std::string> names_of_commands(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* const command : commands_of(app)) names.push_back(command->get_name());
  return names;
}

void append(std::vector<std::string>& names, const std::vector<std::string>& more) {
  names.insert(names.end(), more.begin(), more.end());
}

std::vector<std::string> names_of_options(const CLI::App& app) {
  std::vector<std::string> names = names_of(*app.get_help_ptr());
  for (const CLI::Option* const option : options_of(app)) append(names, names_of(*option));
  return names;
}

// --- bash ---

// The names of options whose value is no file, behind which nothing can be proposed.
std::vector<std::string> names_of_values(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* const option : options_of(app)) {
    if (takes_value(*option) && !takes_file(*option)) append(names, names_of(*option));
  }
  return names;
}

std::string bash_case(const CLI::App& command) {
  std::string text = "    " + command.get_name() + ")\n";
  text += "      options='" + joined(names_of_options(command), " ") + "'\n";
  text += "      values='" + joined(names_of_values(command), " ") + "'\n";
  return text + "      ;;\n";
}

// Where nothing is proposed, readline proposes files, as `complete` below says.
constexpr const char* kBashBegin =
    R"(# bash completion of microtin, written by `microtin completion bash`
_microtin() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} options='' values=''
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
  fi
}
complete -o default -F _microtin microtin
)";

// --- zsh ---

std::string quoted(const std::string& text) {
  return "'" + replaced(text, '\'', "'\\''") + "'";
}

// A description between brackets.
std::string explanation(const CLI::Option& option) {
  const std::string text = replaced(option.get_description(), '\\', "\\\\");
  return "[" + replaced(replaced(text, '[', "\\["), ']', "\\]") + "]";
}

// What follows an option or stands alone: a message, and how to complete it.
std::string zsh_value(const CLI::Option& option) {
  if (!takes_value(option)) return "";
  return takes_file(option) ? ":file:_files" : ":value: ";
}

std::string zsh_option(const CLI::Option& option) {
  std::string text;
  for (const std::string& name : names_of(option)) {
    text += " \\\n        " + quoted("(" + joined(names_of(option), " ") + ")" + name +
                                     explanation(option) + zsh_value(option));
  }
  return text;
}

std::string zsh_options(const CLI::App& app) {
  std::string text = zsh_option(*app.get_help_ptr());
  for (const CLI::Option* const option : options_of(app)) text += zsh_option(*option);
  return text;
}

std::string zsh_argument(const CLI::Option& argument) {
  const bool many = argument.get_items_expected_max() > 1;
  return " \\\n        " + quoted((many ? "*" : "") + zsh_value(argument));
}

std::string zsh_case(const CLI::App& command) {
  std::string text = "    " + command.get_name() + ")\n      _arguments" + zsh_options(command);
  for (const CLI::Option* const argument : arguments_of(command)) text += zsh_argument(*argument);
  return text + "\n      ;;\n";
}

std::string zsh_commands(const CLI::App& app) {
  std::string text;
  for (const CLI::App* const command : commands_of(app)) {
    text += "        " + quoted(command->get_name() + ":" + command->get_description()) + "\n";
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

std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> first = names_of_commands(app);
  append(first, names_of_options(app));
  std::string text = kBashBegin + joined(first, " ") + kBashCases;
  for (const CLI::App* const command : commands_of(app)) text += bash_case(*command);
  return text + kBashEnd;
}

std::string zsh_completion(const CLI::App& app) {
  std::string text = kZshBegin + zsh_options(app) + kZshCommands + zsh_commands(app) + kZshCases;
  for (const CLI::App* const command : commands_of(app)) text += zsh_case(*command);
  return text + kZshEnd;
}

}  // namespace microtin::cli
