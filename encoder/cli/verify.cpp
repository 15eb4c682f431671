// SPDX-License-Identifier: MIT
// The command verify: compares a stream or a pack with its terrain and judges.
#include "encoder/base/error.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/progress.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/product/document.hpp"

namespace microtin::cli {
namespace {

Original::Judgement judge(const VerifyRequest& request) {
  const Document document(request.input);
  const Original original(document, request.source, request.preparation);
  ProgressBar bar;
  return original.judge(bar.progress());
}

}  // namespace

void run_verify(const VerifyRequest& request) {
  const std::string& input = request.input;
  std::vector<std::string> inputs = files_of(request.source, request.preparation);
  inputs.push_back(input);
  refuse_overwriting(inputs, "-");
  const auto [promise, found, water_moved] = judge(request);
  const std::optional<Decimal>& bound = promise.bound;
  JsonObject report = {{"posts", json(found.posts)},
                       {"covered", json(found.covered)},
                       {"uncovered", json(found.uncovered)},
                       {"voids", json(found.voids)},
                       {"voids_answered", json(found.voids_answered)},
                       {"bound", bound ? number(*bound) : "null"},
                       {"max_error", number(found.max_error)},
                       {"max_below", number(found.max_below)},
                       {"rms_error", number(found.rms_error)},
                       {"mean_error", number(found.mean_error)}};
  if (promise.water_level) report.emplace_back("water_moved", json(water_moved));
  const bool told = tell(text_of(report, request.json));
  if (!found.within_bound) throw Error(input + ": the largest error is above the bound");
  if (found.uncovered != 0) throw Error(input + ": heights of the source are not covered");
  if (found.voids_answered != 0) throw Error(input + ": voids of the source answer heights");
  if (water_moved != 0) throw Error(input + ": water of the source is not at its level");
  if (!told) throw ReportLost(input + ": keeps its promises, but nobody reads the report");
}

}  // namespace microtin::cli
