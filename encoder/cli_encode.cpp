#include <sstream>

#include "encoder/cli_commands.hpp"
#include "encoder/cli_report.hpp"
#include "encoder/device_ram.hpp"
#include "encoder/error.hpp"
#include "encoder/error_context.hpp"
#include "encoder/import.hpp"
#include "encoder/lay_out.hpp"
#include "encoder/output_file.hpp"
#include "encoder/simplify.hpp"
#include "encoder/verify.hpp"
#include "encoder/voids.hpp"

namespace microtin {
namespace {

Metadata metadata_of(const EncodeRequest& request, const Source& source,
                     const Placement& placement) {
  const Reference reference = std::visit([](const auto& s) { return s.reference; }, source);
  Metadata metadata;
  metadata.placement = placement;
  metadata.horizontal_unit = reference.horizontal_unit;
  metadata.vertical_unit = reference.vertical_unit;
  metadata.horizontal_epsg = reference.horizontal_epsg;
  metadata.vertical_epsg = reference.vertical_epsg;
  if (request.horizontal_epsg != 0) metadata.horizontal_epsg = request.horizontal_epsg;
  if (request.vertical_epsg != 0) metadata.vertical_epsg = request.vertical_epsg;
  metadata.source = request.source_text;
  return metadata;
}

// A stream that was decoded and measured.
struct Encoded {
  std::vector<uint8_t> stream;
  uint32_t vertices;
  Verification verification;
};

// Encodes, measures what a decoder makes of it, and states the errors in the header.
Encoded encode_measured(const Tin& tin, Metadata metadata, const Source& source,
                        const EncodeRequest& request) {
  const std::optional<Decimal>& bound = request.lattice.max_error;
  const auto [stream, decoded] = encode_and_decode(tin, metadata, request.effort);
  const Verification measured = verify(decoded.mesh(), source, bound);
  if (!measured.within_bound || measured.uncovered != 0 || measured.voids_answered != 0) {
    throw Error("internal error: the decoded terrain does not keep what was asked for");
  }
  metadata.accuracy = Accuracy{bound, measured.max_error, measured.rms_error};
  return {with_metadata(stream, metadata), microtin_vertex_count(decoded.mesh()), measured};
}

std::string moved(Decimal displacement) {
  if (displacement.mantissa == 0) return ", exact";
  return ", values move by up to " + to_string(displacement);
}

std::string report(const Source& source, uint32_t filled, const Laid& laid, const Encoded& encoded,
                   const std::optional<Decimal>& bound) {
  const bool posts = std::holds_alternative<Raster>(source);
  const Verification& measured = encoded.verification;
  std::ostringstream text;
  text << "source: " << measured.posts << (posts ? " posts" : " points");
  if (measured.voids != 0) text << ", " << measured.voids << " void posts";
  if (filled != 0) text << ", " << filled << " of the posts were void and are filled";
  text << "\nstep of x and y: " << to_string(laid.xy_step) << (posts ? " (in posts)" : "")
       << moved(laid.xy_displacement) << "\nstep of z: " << to_string(laid.z_step)
       << moved(laid.z_displacement) << '\n';
  if (laid.merged != 0) {
    text << "merged: " << laid.merged << " shared a place with another; the surface aims at the "
         << "middle of the lowest and the highest there\n";
  }
  text << "stream: " << encoded.vertices << " vertices, " << encoded.stream.size() << " bytes, "
       << bits_per_vertex(encoded.stream.size(), encoded.vertices) << " bits/vertex\n"
       << "error: at most " << to_string(measured.max_error) << ", rms "
       << to_string(measured.rms_error);
  if (bound) text << " (asked for: at most " << to_string(*bound) << ")";
  text << '\n';
  return text.str();
}

// The vertices that may be used, 0 for as many as it takes. A device's RAM is a limit only if
// nothing else asks for vertices.
uint32_t vertex_limit(const EncodeRequest& request) {
  if (request.device_ram == 0 || request.max_vertices != 0 || request.lattice.max_error) {
    return request.max_vertices;
  }
  return most_vertices(request.device_ram);
}

void check_vertices(const Tin& tin, uint32_t limit, const EncodeRequest& request) {
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

void run_encode(const EncodeRequest& request) {
  refuse_overwriting(request.input, request.output);
  OutputFile out(request.output);  // fails early if it cannot be written
  Source source = import_terrain(request.input);
  const uint32_t filled = fill_voids(source, request.fill_voids);
  const Laid laid = about(request.input, [&] { return lay_out(source, request.lattice); });
  const Encoded encoded = about(request.input, [&] {
    const uint32_t limit = vertex_limit(request);
    const Tin tin = simplify(laid.survey, {request.lattice.max_error.has_value(), limit});
    check_vertices(tin, limit, request);
    return encode_measured(tin, metadata_of(request, source, laid.placement), source, request);
  });
  out.write({reinterpret_cast<const char*>(encoded.stream.data()), encoded.stream.size()});
  out.commit();
  std::FILE* const terminal = request.output == "-" ? stderr : stdout;
  std::fputs(report(source, filled, laid, encoded, request.lattice.max_error).c_str(), terminal);
}

}  // namespace microtin
