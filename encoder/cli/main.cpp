// SPDX-License-Identifier: MIT
// The program: it reads its command line, runs the command, and reports failures.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/cli/pages.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/process.hpp"

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace microtin::cli {
namespace {

// Large blocks of memory go back to the system when they are freed. By itself glibc keeps ever
// larger ones, and the pieces between them take 3 bytes for each post of a large raster.
void give_memory_back() {
#ifdef __GLIBC__
  constexpr int kLarge = 1 << 20;
  mallopt(M_MMAP_THRESHOLD, kLarge);
#endif
}

constexpr int kFailed = 1, kUsage = 2, kInternal = 3, kReportLost = 4;

constexpr const char* kExitCodes =
    "Exit codes: 0 done; 1 failed, no output file; 2 wrong usage; 3 internal fault of microtin, no "
    "output file; 4 output complete, but the report could not be printed.";

// Prints one line, whatever the text, without asking for memory: there may be none.
int fail(const char* text, int code) {
  std::fputs(code == kInternal ? "microtin: internal fault, please report it: " : "microtin: ",
             stderr);
  for (std::string_view rest = text; !rest.empty();) {
    const size_t size = character_bytes(rest);
    const std::string_view character = rest.substr(0, std::max<size_t>(size, 1));
    const bool shown = size != 0 && !is_control(character);
    for (const char byte : character) {
      std::fprintf(stderr, shown ? "%c" : "\\x%02x", static_cast<unsigned char>(byte));
    }
    rest.remove_prefix(character.size());
  }
  std::fputc('\n', stderr);
  return code;
}

int run(const std::vector<std::string>& arguments) {
  CLI::App app("Terrain TINs for microcontrollers");
  app.formatter_fn([](const CLI::App* shown, const std::string&, CLI::AppFormatMode) {
    return help_page(*shown);
  });
  app.allow_windows_style_options(false);  // a slash begins a name
  app.set_help_flag("-h,--help", "Print this page");
  Action action;
  int code = 0;
  app.set_version_flag("--version", versions(), "Print the versions of library and formats");
  app.require_subcommand(1);
  app.footer(kExitCodes);
  add_encode(app, action);
  add_update(app, action);
  add_plan(app, action);
  add_merge(app, action);
  add_cut(app, action);
  add_decode(app, action);
  add_embed(app, action);
  add_info(app, action);
  add_height_command(app, action, code);
  add_profile(app, action, code);
  add_check(app, action);
  add_diff(app, action);
  add_verify(app, action);
  add_render(app, action);
  add_fractal(app, action);
  add_help(app, action);
  add_documents(app, action);
  try {
    std::vector<const char*> texts;
    texts.reserve(arguments.size());
    for (const std::string& argument : arguments) texts.push_back(argument.c_str());
    app.parse(static_cast<int>(texts.size()), texts.data());
  } catch (const CLI::ParseError& error) {
    if (arguments.size() <= 1) {
      std::fputs(app.help().c_str(), stderr);
      return kUsage;
    }
    if (error.get_exit_code() != 0) return fail(usage_fault(app, error).c_str(), kUsage);
    std::ostringstream requested;  // a help page, or versions
    app.exit(error, requested);
    print(requested.str());
    return 0;
  }
  try {
    action();
  } catch (const Error& error) {
    return fail(spelled(error.text(), option_name).c_str(), kFailed);
  }
  return code;
}

}  // namespace
}  // namespace microtin::cli

int main(int argc, char** argv) {
  namespace cli = microtin::cli;
  if (!cli::hold_closed_standard_files()) return cli::kFailed;
  cli::make_signals_errors();
  cli::remove_leftovers_on_signals();
  cli::allow_many_open_files();
  cli::give_memory_back();
  try {
    return cli::run(cli::program_arguments(argc, argv));
  } catch (const std::bad_alloc&) {
    return cli::fail("not enough memory", cli::kFailed);
  } catch (const cli::ReportLost& lost) {
    return cli::fail(lost.what(), cli::kReportLost);
  } catch (const std::logic_error& fault) {  // our own, and those that the library finds
    return cli::fail(fault.what(), cli::kInternal);
  } catch (const std::exception& error) {
    return cli::fail(error.what(), cli::kFailed);
  }
}
