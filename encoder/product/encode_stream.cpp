// SPDX-License-Identifier: MIT
// Encodes, and trusts nothing that it has not measured on what the decoder makes of it.
#include "encoder/product/encode_stream.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "encoder/base/error.hpp"
#include "encoder/fit/approximation.hpp"
#include "encoder/fit/byte_budget.hpp"
#include "encoder/stream/device_ram.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/water.hpp"

namespace microtin::product {
namespace {

void check_vertices(const Tin& tin, const EncodeOptions& options) {
  const uint32_t limit = vertex_limit(options);
  const uint64_t vertices = tin.vertices.size();
  if (options.device_ram != 0 && vertices > most_vertices(options.device_ram)) {
    throw Error("the terrain does not fit: " + std::to_string(vertices) + " vertices take " +
                std::to_string(device_ram(static_cast<uint32_t>(vertices))) +
                " bytes; --device-ram " + std::to_string(options.device_ram) + " holds at most " +
                std::to_string(most_vertices(options.device_ram)) + " vertices");
  }
  if (limit != 0 && vertices > limit) {
    throw Error("--max-vertices " + std::to_string(limit) +
                " is not enough: outline and voids alone need " + std::to_string(vertices));
  }
}

// Encodes, measures what a decoder makes of it, and states the errors in the header.
EncodedStream encode_measured(const Source& source, const EncodeOptions& options,
                              const Progress& progress) {
  Metadata metadata = metadata_of(options, reference_of(source));
  Approximation found = approximate(source, options.lattice, simplify_options(options, progress));
  check_vertices(found.tin, options);
  const std::optional<Decimal>& bound = options.lattice.max_error;
  metadata.placement = found.laid.placement;
  if (const auto* raster = std::get_if<Raster>(&source)) metadata.grid = posts_of(*raster);
  if (const auto* cloud = std::get_if<PointCloud>(&source)) metadata.classes = cloud->classes;
  if (found.laid.merged != 0) metadata.duplicates = DuplicateRule::kMiddle;
  const auto [stream, decoded] = encode_and_decode(found.tin, metadata, options.effort);
  WaterGauge gauge(height_decimals(source), bound ? options.lattice.water_level : std::nullopt);
  const Verification measured = verify(decoded.mesh(), source, bound, gauge.visitor());
  const bool too_low = options.lattice.never_below && measured.max_below.mantissa != 0;
  if (!measured.within_bound || too_low || measured.uncovered != 0 ||
      measured.voids_answered != 0 || gauge.moved() != 0) {
    throw InternalFault("the decoded terrain does not keep what was asked for");
  }
  metadata.accuracy = Accuracy{bound, measured.max_error, measured.rms_error, measured.mean_error};
  return {std::move(found.laid), bound, with_metadata(stream, metadata),
          microtin_vertex_count(decoded.mesh()), measured};
}

// The distance of the lowest and the highest height; 1 if there is none.
Decimal height_range(const Source& source) {
  int64_t low = std::numeric_limits<int64_t>::max(), high = std::numeric_limits<int64_t>::min();
  for_each_post(source, [&](int64_t, int64_t, int64_t z) {
    if (z == kVoidHeight) return;
    low = std::min(low, z);
    high = std::max(high, z);
  });
  if (low >= high) return {1, 0};
  return make_decimal(Wide{high} - low, height_decimals(source));
}

// Nothing if points that share a place rule the bound out.
std::optional<EncodedStream> encode_if_possible(const Source& source, const EncodeOptions& options,
                                                const Progress& progress) {
  try {
    return encode_measured(source, options, progress);
  } catch (const Error&) {
    return std::nullopt;
  }
}

// The smallest bound, and its stream, that max_bytes allow.
EncodedStream encode_within_bytes(const Source& source, EncodeOptions options,
                                  const Progress& progress) {
  const Decimal largest = height_range(source);
  const Search search = options.search;
  std::optional<EncodedStream> last;  // that fits
  std::size_t smallest = std::numeric_limits<std::size_t>::max();
  const auto fits = [&](uint32_t rung, Search with) {
    options.search = with;
    options.lattice.max_error = bound_at(largest, rung);
    std::optional<EncodedStream> encoded = encode_if_possible(source, options, progress);
    if (!encoded) return false;
    smallest = std::min(smallest, encoded->stream.size());
    if (encoded->stream.size() > options.max_bytes) return false;
    if (with == search) last = std::move(encoded);
    return true;
  };
  const auto rung = last_rung([&](uint32_t r) { return fits(r, Search::kFast); },
                              [&](uint32_t r) { return fits(r, search); });
  if (!rung) {
    options.lattice.max_error = largest;
    encode_measured(source, options, progress);  // throws if that was the reason
    throw Error("--max-bytes " + std::to_string(options.max_bytes) +
                " is not enough: at any error, at least " + std::to_string(smallest));
  }
  return std::move(*last);
}

}  // namespace

EncodedStream encode_stream(const Source& source, const EncodeOptions& options,
                            const Progress& progress) {
  if (options.max_bytes == 0) return encode_measured(source, options, progress);
  return encode_within_bytes(source, options, progress.part(0, 0));  // how far is not known
}

}  // namespace microtin::product
