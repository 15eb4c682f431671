// Commands that print what the command line accepts, for man and for shells.
#include "encoder/cli/documents.hpp"

#include <CLI/CLI.hpp>

#include "encoder/cli/completion.hpp"
#include "encoder/cli/manual.hpp"
#include "encoder/files/output_file.hpp"

namespace microtin::cli {
namespace {

constexpr const char* kHidden = "";

using Writer = std::string (*)(const CommandText& program);

void add_document(CLI::App& parent, const char* name, Writer writer, const CLI::App& app,
                  std::function<void()>& action) {
  parent.add_subcommand(name)->group(kHidden)->callback([writer, &app, &action] {
    action = [writer, &app] {
      OutputFile out("-");
      out.write(writer(describe(app)));
      out.commit();
    };
  });
}

}  // namespace

void add_documents(CLI::App& app, std::function<void()>& action) {
  add_document(app, "manual", manual, app, action);
  CLI::App& completion = *app.add_subcommand("completion")->group(kHidden)->require_subcommand(1);
  add_document(completion, "bash", bash_completion, app, action);
  add_document(completion, "zsh", zsh_completion, app, action);
}

}  // namespace microtin::cli
