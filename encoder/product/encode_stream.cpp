// SPDX-License-Identifier: MIT
// Encodes, and trusts nothing that it has not measured on what the decoder makes of it.
#include "encoder/product/encode_stream.hpp"

#include <string>
#include <utility>
#include <variant>

#include "encoder/base/error.hpp"
#include "encoder/product/budget.hpp"
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

}  // namespace

EncodedStream encode_measured(const Source& source, const EncodeOptions& options,
                              const Progress& progress) {
  return measured(source, options,
                  approximate(source, options.lattice, simplify_options(options, progress)));
}

EncodedStream measured(const Source& source, const EncodeOptions& options, Approximation&& found) {
  check_vertices(found.tin, options);
  const std::optional<Decimal>& bound = options.lattice.max_error;
  Metadata metadata = metadata_of(options, reference_of(source));
  metadata.placement = found.laid.placement;
  if (const auto* raster = std::get_if<Raster>(&source)) metadata.grid = posts_of(*raster);
  if (const auto* cloud = std::get_if<PointCloud>(&source)) metadata.classes = cloud->classes;
  if (found.laid.merged != 0) metadata.duplicates = DuplicateRule::kMiddle;
  const auto [stream, decoded] = encode_and_decode(found.tin, metadata, options.effort);
  WaterGauge gauge(height_decimals(source), bound ? options.lattice.water_level : std::nullopt);
  const Verification checked = verify(decoded.mesh(), source, bound, gauge.visitor());
  const bool too_low = options.lattice.never_below && checked.max_below.mantissa != 0;
  if (!checked.within_bound || too_low || checked.uncovered != 0 || checked.voids_answered != 0 ||
      gauge.moved() != 0) {
    throw InternalFault("the decoded terrain does not keep what was asked for");
  }
  metadata.accuracy = Accuracy{bound, checked.max_error, checked.rms_error, checked.mean_error};
  return {std::move(found.laid), bound, with_metadata(stream, metadata),
          microtin_vertex_count(decoded.mesh()), checked};
}

EncodedStream encode_stream(const Source& source, const EncodeOptions& options,
                            const Progress& progress) {
  metadata_of(options, reference_of(source));  // fails before the work, if it does
  const bool limited = options.max_bytes != 0 || vertex_limit(options) != 0;
  if (!limited || options.lattice.max_error) return encode_measured(source, options, progress);
  return encode_within_budget(source, options, progress);
}

}  // namespace microtin::product
