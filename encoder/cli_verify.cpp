#include "encoder/cli_commands.hpp"
#include "encoder/cli_pack.hpp"
#include "encoder/cli_report.hpp"
#include "encoder/error_context.hpp"
#include "encoder/import.hpp"
#include "encoder/pack_file.hpp"
#include "encoder/verify.hpp"
#include "encoder/voids.hpp"

namespace microtin {

void run_verify(const VerifyRequest& request) {
  const std::string& input = request.input;
  const std::optional<PackFile> pack = open_pack(input);
  if (pack) {
    run_verify_pack(request, *pack);
    return;
  }
  const std::vector<uint8_t> stream = read_stream(input);
  Source source = import_terrain(request.source, request.classes);
  fill_voids(source, request.fill_voids);
  const DecodedTerrain terrain = about(input, [&] { return DecodedTerrain(stream); });
  const std::optional<Accuracy> accuracy = read_header(stream).metadata.accuracy;
  const std::optional<Decimal> bound = accuracy ? accuracy->bound : std::nullopt;
  const Verification found = verify(terrain.mesh(), source, bound);
  report_and_judge(request, bound, found);
}

void report_and_judge(const VerifyRequest& request, const std::optional<Decimal>& bound,
                      const Verification& found) {
  const std::string& input = request.input;
  const JsonObject report = {{"posts", json(found.posts)},
                             {"covered", json(found.covered)},
                             {"uncovered", json(found.uncovered)},
                             {"voids", json(found.voids)},
                             {"voids_answered", json(found.voids_answered)},
                             {"bound", bound ? number(*bound) : "null"},
                             {"max_error", number(found.max_error)},
                             {"max_below", number(found.max_below)},
                             {"rms_error", number(found.rms_error)}};
  print(report, request.json);
  if (!found.within_bound) throw Error(input + ": the largest error is above the bound");
  if (found.uncovered != 0) throw Error(input + ": heights of the source are not covered");
  if (found.voids_answered != 0) throw Error(input + ": voids of the source answer heights");
}

}  // namespace microtin
