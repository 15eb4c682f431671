// SPDX-License-Identifier: MIT
// Writes the manual page and the page of the documents that lists every command with its arguments
// and options, from the texts of --help.
#include "encoder/cli/pages.hpp"

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

// Without --help and the program's footer, which the page has once.
std::string chapter(const CommandText& command, const CommandText& program) {
  const std::vector<OptionText> options(command.options.begin() + 1, command.options.end());
  std::string text = ".SS " + line(command.name) + line(command.description);
  if (command.footer != program.footer) text += ".PP\n" + line(command.footer);
  return text + entries(command.arguments) + entries(options);
}

// A cell of a Markdown table.
std::string cell(const std::string& text) {
  return replaced(replaced(text, '|', "\\|"), '\n', " ");
}

std::string rows(const std::vector<OptionText>& options) {
  std::string text;
  for (const OptionText& option : options) {
    text += "| `" + cell(option.title) + "` | " + cell(option.description) + " |\n";
  }
  return text;
}

// Without --help and the program's footer, which the page has once.
std::string table(const CommandText& command, const CommandText& program) {
  const std::vector<OptionText> options(command.options.begin() + 1, command.options.end());
  std::string text = "\n## " + command.name + "\n\n    " + synopsis(command);
  text += "\n\n| argument or option | meaning |\n|---|---|\n| the command | ";
  text += cell(command.description) + " |\n" + rows(command.arguments) + rows(options);
  return command.footer == program.footer ? text
                                          : text + "| note | " + cell(command.footer) + " |\n";
}

}  // namespace

std::string manual(const CommandText& program) {
  std::string text =
      ".TH MICROTIN 1 \"\" \"microtin " + library_version() + "\" \"User Commands\"\n";
  text += section("NAME") + "microtin \\- " + line(program.description) + section("SYNOPSIS");
  const char* separator = "";
  for (const CommandText& command : program.commands) {
    text += separator + bold(synopsis(command));
    separator = ".br\n";
  }
  text += section("OPTIONS") + entries(program.options) + section("COMMANDS");
  for (const CommandText& command : program.commands) text += chapter(command, program);
  return text + section("EXIT STATUS") + line(program.footer);
}

std::string reference(const CommandText& program) {
  std::string text =
      "# Command-line reference\n\n"
      "This page lists every command and option of `microtin`, for people who write scripts. "
      "The program\nwrites it: `microtin reference`. `microtin COMMAND --help` prints the same "
      "texts.\n";
  for (const CommandText& command : program.commands) text += table(command, program);
  return text + "\n## All commands\n\n| option | meaning |\n|---|---|\n" + rows(program.options) +
         "| exit codes | " + cell(program.footer) + " |\n";
}

}  // namespace microtin::cli
