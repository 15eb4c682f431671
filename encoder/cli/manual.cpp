// SPDX-License-Identifier: MIT
// Writes the manual page: every command with its arguments and options, each told as --help tells
// it.
#include "encoder/cli/manual.hpp"

#include "encoder/cli/version.hpp"

namespace microtin::cli {
namespace {

// The text on a line of its own: nothing in it is a request or an escape.
std::string line(const std::string& text) {
  std::string escaped = replaced(text, '\\', "\\e");
  escaped = replaced(escaped, '-', "\\-");
  escaped = replaced(escaped, '\'', "\\(aq");
  const bool request = !escaped.empty() && escaped.front() == '.';
  return (request ? "\\&" : "") + escaped + "\n";
}

std::string bold(const std::string& text) {
  return ".B " + line(text);
}

std::string section(const std::string& name) {
  return ".SH " + name + "\n";
}

std::string entries(const std::vector<OptionText>& options) {
  std::string text;
  for (const OptionText& option : options) {
    text += ".TP\n" + bold(option.title) + line(option.description);
  }
  return text;
}

std::string synopsis(const CommandText& command) {
  std::string text = bold("microtin " + command.name);
  for (const OptionText& argument : command.arguments) text += line(argument.usage);
  return text + line("[OPTIONS]");
}

// Without --help and the program's footer, which the page tells once.
std::string chapter(const CommandText& command, const CommandText& program) {
  const std::vector<OptionText> options(command.options.begin() + 1, command.options.end());
  std::string text = ".SS " + line(command.name) + line(command.description);
  if (command.footer != program.footer) text += ".PP\n" + line(command.footer);
  return text + entries(command.arguments) + entries(options);
}

}  // namespace

std::string manual(const CommandText& program) {
  std::string text =
      ".TH MICROTIN 1 \"\" \"microtin " + library_version() + "\" \"User Commands\"\n";
  text += section("NAME") + "microtin \\- " + line(program.description) + section("SYNOPSIS");
  const char* separator = "";
  for (const CommandText& command : program.commands) {
    text += separator + synopsis(command);
    separator = ".br\n";
  }
  text += section("OPTIONS") + entries(program.options) + section("COMMANDS");
  for (const CommandText& command : program.commands) text += chapter(command, program);
  return text + section("EXIT STATUS") + line(program.footer);
}

}  // namespace microtin::cli
