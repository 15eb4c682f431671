// Writes the manual page: every command with its arguments and options, each told as --help tells
// it.
#include "encoder/cli/manual.hpp"

#include "encoder/cli/definitions.hpp"
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

std::string entry(const CLI::Option& option, bool is_argument) {
  const CLI::Formatter format;
  return ".TP\n" +
         bold(format.make_option_name(&option, is_argument) + format.make_option_opts(&option)) +
         line(format.make_option_desc(&option));
}

std::string entries(const CLI::App& command) {
  std::string text;
  for (const CLI::Option* const argument : arguments_of(command)) text += entry(*argument, true);
  for (const CLI::Option* const option : options_of(command)) text += entry(*option, false);
  return text;
}

std::string synopsis(const CLI::App& command) {
  std::string text = bold("microtin " + command.get_name());
  for (const CLI::Option* const argument : arguments_of(command)) {
    text += line(CLI::Formatter().make_option_usage(argument));
  }
  return text + line("[OPTIONS]");
}

std::string chapter(const CLI::App& command) {
  std::string text = ".SS " + line(command.get_name()) + line(command.get_description());
  if (!command.get_footer().empty()) text += ".PP\n" + line(command.get_footer());
  return text + entries(command);
}

}  // namespace

std::string manual(const CLI::App& app) {
  std::string text = ".TH MICROTIN 1 \"\" \"microtin " + library_version() +
                     "\" \"User Commands\"\n" + section("NAME") + "microtin \\- " +
                     line(app.get_description()) + section("SYNOPSIS");
  const char* separator = "";
  for (const CLI::App* const command : commands_of(app)) {
    text += separator + synopsis(*command);
    separator = ".br\n";
  }
  text +=
      section("OPTIONS") + entry(*app.get_help_ptr(), false) + entries(app) + section("COMMANDS");
  for (const CLI::App* const command : commands_of(app)) text += chapter(*command);
  return text + section("EXIT STATUS") + line(app.get_footer());
}

}  // namespace microtin::cli
