// SPDX-License-Identifier: MIT
// Help pages, the manual page and the page of the documents, out of the definitions.
#include "encoder/cli/pages.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <numeric>
#include <string_view>
#include <utility>
#include <vector>

#include "encoder/cli/commands.hpp"
#include "encoder/cli/report.hpp"
#include "microtin/encoder.h"
#include "shared/format.hpp"
#include "shared/pack_format.hpp"

namespace microtin::cli {

// Help pages, and remedies for slips.

namespace {

constexpr size_t kColumns = 80, kTextColumn = 26;

// Adds the words from column `indent` on, in lines of at most kColumns. `column` is where the last
// line of the page ends.
void add_wrapped(std::string& page, size_t column, size_t indent, std::string_view text) {
  while (!text.empty()) {
    const size_t end = std::min(text.find(' '), text.size());
    if (column > indent && column + 1 + end > kColumns) {
      page += '\n';
      column = 0;
    }
    const size_t space = column < indent ? indent - column : (column == 0 ? 0 : 1);
    page += std::string(space, ' ').append(text.substr(0, end));
    column += space + end;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  page += '\n';
}

// A line of a list: a title, and a text in the second column.
void add_entry(std::string& page, const std::string& title, const std::string& text) {
  page += "  " + title;
  size_t column = 2 + title.size();
  if (column + 2 > kTextColumn) {
    page += '\n';
    column = 0;
  }
  add_wrapped(page, column, kTextColumn, text);
}

const std::string& title_of(const OptionText& option) {
  return option.title;
}

const std::string& title_of(const CommandText& command) {
  return command.name;
}

// Each group in the order of its first entry, under a heading.
template <class Entry>
void add_groups(std::string& page, std::vector<Entry> entries) {
  while (!entries.empty()) {
    const std::string group = entries.front().group;
    const auto rest = std::stable_partition(
        entries.begin(), entries.end(), [&](const Entry& entry) { return entry.group == group; });
    page += '\n' + group + ":\n";
    for (auto entry = entries.begin(); entry != rest; ++entry) {
      add_entry(page, title_of(*entry), entry->description);
    }
    entries.erase(entries.begin(), rest);
  }
}

// The number of letters to insert, remove, replace or swap with the next one.
size_t edits(std::string_view from, std::string_view to) {
  std::vector<size_t> before, last, row(to.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 1; i <= from.size(); ++i) {
    before = std::exchange(last, row);
    row[0] = i;
    for (size_t j = 1; j <= to.size(); ++j) {
      const size_t replaced = last[j - 1] + (from[i - 1] != to[j - 1] ? 1 : 0);
      row[j] = std::min({replaced, last[j] + 1, row[j - 1] + 1});
      const bool swapped = i > 1 && j > 1 && from[i - 1] == to[j - 2] && from[i - 2] == to[j - 1];
      if (swapped) row[j] = std::min(row[j], before[j - 2] + 1);
    }
  }
  return row.back();
}

// The name that the word is a slip of: up to a third of its letters differ. Empty if there is none.
std::string nearest(std::string_view word, const std::vector<std::string>& names) {
  std::string found;
  size_t least = word.size() / 3 + 1;
  for (const std::string& name : names) {
    const size_t distance = edits(word, name);
    if (distance >= least) continue;
    least = distance;
    found = name;
  }
  return found;
}

std::string remedy(const std::string& meant, const std::string& page) {
  return meant.empty() ? "; see \"" + page + '"' : "; did you mean " + meant + '?';
}

}  // namespace

std::string help_page(const CLI::App& app) {
  CommandText text = describe(app);
  const bool is_program = app.get_parent() == nullptr;
  std::string page;
  add_wrapped(page, 0, 0, text.description);
  page += '\n';
  const std::string usage = is_program ? "microtin COMMAND [ARGUMENTS] [OPTIONS]" : synopsis(text);
  add_wrapped(page, 0, 0, "Usage: " + usage);
  if (!text.arguments.empty()) page += "\nArguments:\n";
  for (const OptionText& argument : text.arguments) {
    add_entry(page, argument.title, argument.description);
  }
  add_groups(page, text.commands);
  std::rotate(text.options.begin(), text.options.begin() + 1, text.options.end());  // --help
  add_groups(page, text.options);
  const std::string program_footer = is_program ? text.footer : app.get_parent()->get_footer();
  if (text.footer != program_footer) {
    page += '\n';
    add_wrapped(page, 0, 0, text.footer);
  }
  page += '\n';
  add_wrapped(page, 0, 0, program_footer);
  return page;
}

namespace {

// "--units: At Most 1 required but received 2", as CLI11 has it, in plain words; else empty.
std::string repeated_option(const std::string& fault) {
  const std::string words = ": At Most 1 required but received ";
  const std::size_t at = fault.find(words);
  if (at == fault.npos) return "";
  return fault.substr(0, at) + " is given " + fault.substr(at + words.size()) +
         " times; give it once";
}

}  // namespace

std::string usage_fault(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App* app = &program;
  std::string page = "microtin help";
  while (!app->get_subcommands().empty()) {
    app = app->get_subcommands().back();
    page += ' ' + app->get_name();
  }
  const CommandText text = describe(*app);
  const std::vector<std::string> unknown = app->remaining();
  const bool has_commands = !text.commands.empty();  // the first word is one, or an option
  const auto end = has_commands && !unknown.empty()
                       ? unknown.begin() + 1
                       : std::find(unknown.begin(), unknown.end(), "--");
  const auto option = std::find_if(unknown.begin(), end, [](const std::string& word) {
    return word.size() > 1 && word[0] == '-';
  });
  if (option != end) {
    const std::string name = option->substr(0, option->find('='));
    return "unknown option " + name + remedy(nearest(name, names_of_options(text)), page);
  }
  std::string repeated = repeated_option(error.what());
  if (unknown.empty() && !repeated.empty()) return repeated;
  const bool has_remedy = dynamic_cast<const CLI::ValidationError*>(&error) != nullptr;
  if (unknown.empty()) return error.what() + (has_remedy ? "" : remedy("", page));
  if (!has_commands) return "unexpected argument " + unknown[0] + remedy("", page);
  return "unknown command " + unknown[0] +
         remedy(nearest(unknown[0], names_of_commands(text)), page);
}

std::string library_version() {
  return microtin_version_string();
}

std::string versions() {
  return "microtin " + library_version() + "\nstream format " + std::to_string(kVersion) +
         "\npack format " + std::to_string(kPackVersion);
}

// Writes the manual page and the page of the documents that lists every command with its arguments
// and options, from the texts of --help.

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

namespace {

constexpr const char* kHidden = "";  // the group of commands that --help does not show

// Prints what the command line accepts, for man or a shell.
void add_document(CLI::App& parent, const std::string& name, const CLI::App& app, Action& action,
                  std::string (*writer)(const CommandText& program)) {
  parent.add_subcommand(name)->group(kHidden)->callback(
      [&app, &action, writer] { action = [&app, writer] { print(writer(describe(app))); }; });
}

}  // namespace

void add_help(CLI::App& app, Action& action) {
  CLI::App& help = *app.add_subcommand("help", "Print the page of a command");
  help.group(kOthers)->require_subcommand(0, 1);
  help.callback([&app, &help, &action] {
    if (help.get_subcommands().empty()) action = [&app] { print(help_page(app)); };
  });
  for (const CLI::App* const command : app.get_subcommands({})) {
    help.add_subcommand(command->get_name(), command->get_description())
        ->group(command->get_group())
        ->callback([command, &action] { action = [command] { print(help_page(*command)); }; });
  }
}

void add_documents(CLI::App& app, Action& action) {
  add_document(app, "manual", app, action, manual);
  add_document(app, "reference", app, action, reference);
  CLI::App& completion = *app.add_subcommand("completion")->group(kHidden)->require_subcommand(1);
  add_document(completion, "bash", app, action, bash_completion);
  add_document(completion, "zsh", app, action, zsh_completion);
}

}  // namespace microtin::cli
