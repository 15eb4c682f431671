// What the commands do with packs.
#ifndef MICROTIN_ENCODER_CLI_PACK_HPP
#define MICROTIN_ENCODER_CLI_PACK_HPP

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/cli/commands.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/layers.hpp"
#include "encoder/pack/file.hpp"
#include "encoder/terrain/source.hpp"
#include "encoder/terrain/verify.hpp"

namespace microtin::cli {

void run_encode_pack(const EncodeRequest& request);
void run_info_pack(const PackFile& pack, bool as_json);
void run_verify_pack(const VerifyRequest& request, const PackFile& pack);

// Common to packs and streams.
std::vector<std::string> inputs_of(const EncodeRequest& request);
Metadata metadata_of(const EncodeRequest& request, const Reference& reference,
                     const Placement& placement);
SimplifyOptions simplify_options(const EncodeRequest& request, const Progress& progress);
std::string moved(Decimal displacement);
std::string merged(uint64_t points);  // a line, if there are any
void add_placement(JsonObject& report, const Metadata& metadata);
void add_notes(JsonObject& report, const Metadata& metadata);
void add_accuracy(JsonObject& report, const std::optional<Accuracy>& accuracy);

// What a header promises of the heights.
struct Promise {
  std::optional<Decimal> bound;
  std::optional<Decimal> water_level;  // at which posts are exact
};

// Throws Error if the source was given another water level.
Promise promise_of(const Metadata& metadata, const Preparation& preparation);

// Throws Error, after the report, if there is something wrong.
void report_and_judge(const VerifyRequest& request, const Promise& promise,
                      const Verification& found, uint64_t water_moved);

}  // namespace microtin::cli

#endif
