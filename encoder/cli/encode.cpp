// The command encode: a stream from a terrain, and what to say of it.
#include <algorithm>
#include <limits>
#include <sstream>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/error_context.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/pack.hpp"
#include "encoder/cli/progress.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/files/output_file.hpp"
#include "encoder/fit/approximation.hpp"
#include "encoder/fit/byte_budget.hpp"
#include "encoder/stream/device_ram.hpp"
#include "encoder/terrain/verify.hpp"
#include "encoder/terrain/water.hpp"

namespace microtin::cli {

std::vector<std::string> inputs_of(const EncodeRequest& request) {
  return files_of(request.input, request.preparation);
}

Metadata metadata_of(const EncodeRequest& request, const Reference& reference,
                     const Placement& placement) {
  Metadata metadata;
  metadata.placement = placement;
  metadata.horizontal_unit = reference.horizontal_unit;
  metadata.vertical_unit = reference.vertical_unit;
  metadata.horizontal_epsg = reference.horizontal_epsg;
  metadata.vertical_epsg = reference.vertical_epsg;
  if (request.horizontal_epsg != 0) metadata.horizontal_epsg = request.horizontal_epsg;
  if (request.vertical_epsg != 0) metadata.vertical_epsg = request.vertical_epsg;
  metadata.source = request.source_text;
  metadata.date = request.date;
  metadata.lineage = request.lineage;
  metadata.water_level = request.preparation.water_level;
  return metadata;
}

namespace {

bool makes_pack(const EncodeRequest& request) {
  const std::string& name = request.output;
  return request.tile_vertices != 0 || request.tiles ||
         (name.size() > 4 && name.substr(name.size() - 4) == ".mtp");
}

// The vertices that may be used, 0 for as many as it takes. A device's RAM is a limit only if
// nothing else asks for vertices.
uint32_t vertex_limit(const EncodeRequest& request) {
  if (request.device_ram == 0 || request.max_vertices != 0 || request.lattice.max_error) {
    return request.max_vertices;
  }
  return most_vertices(request.device_ram);
}

void check_vertices(const Tin& tin, const EncodeRequest& request) {
  const uint32_t limit = vertex_limit(request);
  const uint64_t vertices = tin.vertices.size();
  if (request.device_ram != 0 && vertices > most_vertices(request.device_ram)) {
    throw Error("the terrain does not fit: " + std::to_string(vertices) + " vertices take " +
                std::to_string(device_ram(static_cast<uint32_t>(vertices))) +
                " bytes; --device-ram " + std::to_string(request.device_ram) + " holds at most " +
                std::to_string(most_vertices(request.device_ram)) + " vertices");
  }
  if (limit != 0 && vertices > limit) {
    throw Error("--max-vertices " + std::to_string(limit) +
                " is not enough: outline and voids alone need " + std::to_string(vertices));
  }
}

}  // namespace

SimplifyOptions simplify_options(const EncodeRequest& request, const Progress& progress) {
  SimplifyOptions options;
  options.bounded = request.lattice.max_error.has_value();
  options.max_vertices = vertex_limit(request);
  options.search = request.search;
  options.effort = request.effort;
  options.progress = progress;
  return options;
}

namespace {

// A stream that was decoded and measured.
struct Encoded {
  Laid laid;
  std::optional<Decimal> bound;  // asked for
  std::vector<uint8_t> stream;
  uint32_t vertices;
  Verification verification;
};

// Encodes, measures what a decoder makes of it, and states the errors in the header.
Encoded encode_measured(const Source& source, const EncodeRequest& request,
                        const Progress& progress) {
  Approximation found = approximate(source, request.lattice, simplify_options(request, progress));
  check_vertices(found.tin, request);
  const std::optional<Decimal>& bound = request.lattice.max_error;
  const Reference reference = std::visit([](const auto& s) { return s.reference; }, source);
  Metadata metadata = metadata_of(request, reference, found.laid.placement);
  const auto [stream, decoded] = encode_and_decode(found.tin, metadata, request.effort);
  WaterGauge gauge(height_decimals(source), bound ? request.lattice.water_level : std::nullopt);
  const Verification measured = verify(decoded.mesh(), source, bound, gauge.visitor());
  const bool too_low = request.lattice.never_below && measured.max_below.mantissa != 0;
  if (!measured.within_bound || too_low || measured.uncovered != 0 ||
      measured.voids_answered != 0 || gauge.moved() != 0) {
    throw InternalFault("the decoded terrain does not keep what was asked for");
  }
  metadata.accuracy = Accuracy{bound, measured.max_error, measured.rms_error};
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
std::optional<Encoded> encode_if_possible(const Source& source, const EncodeRequest& request) {
  try {
    return encode_measured(source, request, {});
  } catch (const Error&) {
    return std::nullopt;
  }
}

// The smallest bound, and its stream, that max_bytes allow.
Encoded encode_within_bytes(const Source& source, EncodeRequest request) {
  const Decimal largest = height_range(source);
  const Search search = request.search;
  std::optional<Encoded> last;  // that fits
  std::size_t smallest = std::numeric_limits<std::size_t>::max();
  const auto fits = [&](uint32_t rung, Search with) {
    request.search = with;
    request.lattice.max_error = bound_at(largest, rung);
    std::optional<Encoded> encoded = encode_if_possible(source, request);
    if (!encoded) return false;
    smallest = std::min(smallest, encoded->stream.size());
    if (encoded->stream.size() > request.max_bytes) return false;
    if (with == search) last = std::move(encoded);
    return true;
  };
  const auto rung = last_rung([&](uint32_t r) { return fits(r, Search::kFast); },
                              [&](uint32_t r) { return fits(r, search); });
  if (!rung) {
    request.lattice.max_error = largest;
    encode_measured(source, request, {});  // throws if that was the reason
    throw Error("--max-bytes " + std::to_string(request.max_bytes) +
                " is not enough: at any error, at least " + std::to_string(smallest));
  }
  return std::move(*last);
}

}  // namespace

std::string moved(Decimal displacement) {
  if (displacement.mantissa == 0) return ", exact";
  return ", values move by up to " + to_string(displacement);
}

std::string merged(uint64_t points) {
  if (points == 0) return "";
  return "merged: " + std::to_string(points) +
         " shared a place with another; the surface aims at the middle of the lowest and the " +
         "highest there\n";
}

namespace {

std::string report(const PreparedTerrain& terrain, const Encoded& encoded) {
  const Laid& laid = encoded.laid;
  const bool posts = std::holds_alternative<Raster>(terrain.source);
  const Verification& measured = encoded.verification;
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // else a text for which memory is short ends early, unsaid
  text << "source: " << measured.posts << (posts ? " posts" : " points");
  if (measured.voids != 0) text << ", " << measured.voids << " void posts";
  text << describe_preparation(terrain);
  text << "\nstep of x and y: " << to_string(laid.xy_step) << (posts ? " (in posts)" : "")
       << moved(laid.xy_displacement) << "\nstep of z: " << to_string(laid.z_step)
       << moved(laid.z_displacement) << '\n'
       << merged(laid.merged) << "stream: " << encoded.vertices << " vertices, "
       << encoded.stream.size() << " bytes, "
       << bits_per_vertex(encoded.stream.size(), encoded.vertices) << " bits/vertex\n"
       << "error: at most " << to_string(measured.max_error) << ", rms "
       << to_string(measured.rms_error);
  if (encoded.bound) text << " (asked for: at most " << to_string(*encoded.bound) << ")";
  text << "\nbelow the source: at most " << to_string(measured.max_below);
  text << '\n';
  return text.str();
}

}  // namespace

void run_encode(const EncodeRequest& request) {
  refuse_overwriting(inputs_of(request), request.output);
  if (makes_pack(request)) {
    run_encode_pack(request);
    return;
  }
  OutputFile out(request.output);  // fails early if it cannot be written
  const PreparedTerrain terrain = prepared_terrain(request.input, request.preparation);
  const Source& source = terrain.source;
  const Encoded encoded = with_file_context(request.input, [&] {
    ProgressBar bar;
    return request.max_bytes != 0 ? encode_within_bytes(source, request)
                                  : encode_measured(source, request, bar.progress());
  });
  out.write(encoded.stream);
  deliver(out, request.output, report(terrain, encoded));
}

}  // namespace microtin::cli
