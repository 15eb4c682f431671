// The command verify: compares a stream or a pack with its terrain and judges.
#include "encoder/terrain/verify.hpp"

#include "encoder/base/error_context.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/pack.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/terrain/water.hpp"

namespace microtin::cli {

void run_verify(const VerifyRequest& request) {
  const std::string& input = request.input;
  std::vector<std::string> inputs = files_of(request.source, request.preparation);
  inputs.push_back(input);
  refuse_overwriting(inputs, "-");
  const std::optional<PackFile> pack = open_pack(input);
  if (pack) {
    run_verify_pack(request, *pack);
    return;
  }
  const std::vector<uint8_t> stream = read_stream(input);
  const Source source = prepared_terrain(request.source, request.preparation).source;
  const DecodedTerrain terrain = with_file_context(input, [&] { return DecodedTerrain(stream); });
  const Promise promise = with_file_context(
      input, [&] { return promise_of(read_header(stream).metadata, request.preparation); });
  WaterGauge gauge(height_decimals(source), promise.water_level);
  const Verification found = verify(terrain.mesh(), source, promise.bound, gauge.visitor());
  report_and_judge(request, promise, found, gauge.moved());
}

Promise promise_of(const Metadata& metadata, const Preparation& preparation) {
  const std::optional<Decimal>&noted = metadata.water_level, &given = preparation.water_level;
  if (given && !(noted && *noted == *given)) {
    throw Error("its water level is " + (noted ? to_string(*noted) : "not noted") + ", not " +
                to_string(*given));
  }
  if (!metadata.accuracy || !metadata.accuracy->bound) return {};
  return {metadata.accuracy->bound, metadata.water_level};
}

void report_and_judge(const VerifyRequest& request, const Promise& promise,
                      const Verification& found, uint64_t water_moved) {
  const std::string& input = request.input;
  const std::optional<Decimal>& bound = promise.bound;
  JsonObject report = {{"posts", json(found.posts)},
                       {"covered", json(found.covered)},
                       {"uncovered", json(found.uncovered)},
                       {"voids", json(found.voids)},
                       {"voids_answered", json(found.voids_answered)},
                       {"bound", bound ? number(*bound) : "null"},
                       {"max_error", number(found.max_error)},
                       {"max_below", number(found.max_below)},
                       {"rms_error", number(found.rms_error)}};
  if (promise.water_level) report.emplace_back("water_moved", json(water_moved));
  const bool told = tell(text_of(report, request.json));
  if (!found.within_bound) throw Error(input + ": the largest error is above the bound");
  if (found.uncovered != 0) throw Error(input + ": heights of the source are not covered");
  if (found.voids_answered != 0) throw Error(input + ": voids of the source answer heights");
  if (water_moved != 0) throw Error(input + ": water of the source is not at its level");
  if (!told) throw ReportLost(input + ": keeps its promises, but nobody reads the report");
}

}  // namespace microtin::cli
