// SPDX-License-Identifier: MIT
// The command cut: whole tiles of a pack as a pack of their own.
#include <CLI/CLI.hpp>
#include <memory>
#include <optional>
#include <string>

#include "encoder/cli/commands.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/cli/pages.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/output.hpp"
#include "encoder/product/made_pack.hpp"

namespace microtin::cli {
namespace {

void run_cut(const std::string& input, const Extent& extent, const std::string& output) {
  refuse_overwriting({input}, output);
  OutputFile out(output);
  MadePack part = part_of_pack(input, extent, output);
  part.write(out);
  const PackReport& report = part.report();
  deliver(out, output,
          "tiles: " + std::to_string(tile_columns(report.grid)) + " x " +
              std::to_string(tile_rows(report.grid)) + ", " + std::to_string(report.vertices) +
              " vertices, " + std::to_string(report.bytes) + " bytes\n");
}

}  // namespace

void add_cut(CLI::App& app, Action& action) {
  struct Request {
    std::string input, output;
    std::optional<Extent> extent;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command =
      *app.add_subcommand("cut", "Take whole tiles out of a pack, without encoding them again");
  command.group(kShards);
  command.add_option("PACK", request->input, "A pack (.mtp)")->required()->type_name(kFile);
  begin_group(command, kOptions);
  add_output(command, request->output, "Write this pack (.mtp); - is standard output");
  add_rectangle(command, request->extent,
                "Take the tiles that have a part of this rectangle of the pack's coordinates")
      ->required();
  command.callback([request, &action] {
    action = [request] { run_cut(request->input, *request->extent, request->output); };
  });
}

}  // namespace microtin::cli
