// SPDX-License-Identifier: MIT
// Encodes, and trusts nothing that it has not measured on what the decoder makes of it.
#include "encoder/product/encode_stream.hpp"

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/export/queries.hpp"
#include "encoder/fit/breaklines.hpp"
#include "encoder/pack/point_pack.hpp"
#include "encoder/product/phases.hpp"
#include "encoder/product/true_bound.hpp"
#include "encoder/stream/device_memory.hpp"
#include "encoder/stream/edge_marks.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/breaklines.hpp"
#include "encoder/terrain/clouds.hpp"
#include "encoder/verify/breaklines.hpp"
#include "encoder/verify/everywhere.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::product {
namespace {

void check_vertices(const Tin& tin, const EncodeOptions& options) {
  const uint32_t limit = vertex_limit(options);
  const uint64_t vertices = tin.vertices.size();
  if (options.device_ram != 0 && vertices > most_vertices(options.device_ram)) {
    throw Error("the terrain does not fit: " + std::to_string(vertices) + " vertices take " +
                std::to_string(device_ram(static_cast<uint32_t>(vertices))) + " bytes, and " +
                parameter("device_ram") + ' ' + std::to_string(options.device_ram) +
                " holds at most " + std::to_string(most_vertices(options.device_ram)) +
                " vertices; increase the error or make a pack (.mtp)");
  }
  if (limit != 0 && vertices > limit) {
    throw Error(parameter("max_vertices") + ' ' + std::to_string(limit) + " is too small: outline" +
                (options.lattice.breaklines.empty() ? " and voids" : ", voids and breaklines") +
                " alone need " + std::to_string(vertices));
  }
}

// An attempt: encoded, and measured by what a decoder makes of it.
struct Attempt {
  EncodedStream encoded;
  uint64_t missed = 0;  // points, or posts around places, that do not keep the bound
};

void expect_promises(const Verification& measured, const WaterGauge& gauge,
                     const LatticeOptions& lattice) {
  const bool too_low = lattice.never_below && measured.max_below.mantissa != 0;
  if (!measured.within_bound || too_low || measured.uncovered != 0 ||
      measured.voids_answered != 0 || gauge.moved() != 0) {
    throw InternalFault("the decoded terrain does not meet the options");
  }
}

// Throws Error if a line is no chain of edges of the decoded terrain.
FoundBreaklines expect_breaklines(const microtin_mesh* mesh, const Source& source,
                                  const LatticeOptions& lattice, const Placement& placement) {
  const std::vector<LatticeLine> lines =
      lines_over(terrain::line_ground_of(source, placement), lattice.breaklines, placement);
  std::optional<LineRoom> room;
  if (lattice.max_error) {
    room = terrain::room_of(*lattice.max_error, lattice.never_below, exact::step_of(placement.z));
  }
  FoundBreaklines found = verifying::find_breaklines(mesh, lines, room, placement);
  if (found.missing) {
    throw Error(parameter("breaklines") + ": " + *found.missing + "; use a smaller " +
                parameter("xy_step") + ", or a larger " + parameter("max_error"));
  }
  return found;
}

// The edges along lines as lines of the mesh.
std::vector<MarkedLine> marked_lines(const FoundBreaklines& found,
                                     const std::vector<LineClass>& classes) {
  std::vector<MarkedLine> lines;
  lines.reserve(found.chains.size());
  for (const FoundChain& chain : found.chains) {
    const bool is_known = chain.line < classes.size();
    lines.push_back({is_known ? classes[chain.line] : LineClass::kOther, chain.vertices});
  }
  return lines;
}

Metadata metadata_for(const Source& source, const EncodeOptions& options, const Laid& laid) {
  Metadata metadata =
      std::visit([&](const auto& one) { return metadata_of(options, one); }, source);
  metadata.placement = laid.placement;
  if (const auto* raster = std::get_if<Raster>(&source)) metadata.grid = posts_of(*raster);
  if (const auto* cloud = std::get_if<PointCloud>(&source)) metadata.classes = cloud->classes;
  if (laid.merged != 0) metadata.duplicates = options.lattice.duplicates;
  return metadata;
}

Accuracy accuracy_of(const Verification& measured, const std::optional<Decimal>& bound) {
  return {bound, measured.max_error, measured.rms_error, measured.mean_error};
}

// What becomes of a bound that is missed where points truly lie, or between posts: the limits of
// the next attempt become narrower, or the bound wider.
enum class Miss { kNarrows, kWidens };

// What attempts learn from those before.
struct Lessons {
  LatticeOptions lattice;
  std::optional<EverywhereBound> everywhere;
};

// Measures a raster between its posts, and narrows limits if the bound is to be kept there.
void measure_between_posts(const Raster& raster, const microtin_mesh* mesh, bool is_kept,
                           Metadata& metadata, Lessons& lessons, Attempt& attempt) {
  const Placement& placement = metadata.placement;
  metadata.everywhere = margins_of(measure_gap(mesh, placement, raster));
  attempt.encoded.everywhere = stated_everywhere(metadata.everywhere, placement.z);
  if (!is_kept) return;
  if (!lessons.everywhere) lessons.everywhere.emplace(raster, lessons.lattice, placement);
  attempt.missed = lessons.everywhere->see(mesh);
  lessons.lattice.tightenings = lessons.everywhere->tightenings();
}

// Measures points where they truly lie; adds narrower limits to the lattice's options if they are
// to be kept there.
void measure_true_places(const PointCloud& cloud, const microtin_mesh* mesh, bool is_kept,
                         LatticeOptions& lattice, Attempt& attempt) {
  const SampledSurface surface = sampled(mesh);
  if (!moves_points(surface.placement, cloud)) return;
  Verification& found = attempt.encoded.true_places.emplace();
  if (!is_kept || !lattice.max_error) {
    found = verify_at_true_places(surface.height_at, surface.placement, cloud, std::nullopt);
    return;
  }
  TrueBound bound(lattice, surface);
  found = verify_at_true_places(surface.height_at, surface.placement, cloud, lattice.max_error,
                                [&](const RealPlace& nearest, const RealPlace& exact, double own,
                                    double above) { bound.see(nearest, exact, own, above); });
  attempt.missed = bound.missed();
  if (attempt.missed == 0 && !found.within_bound)
    attempt.missed = 1;  // by less than a double tells
  bound.add_to(lattice.tightenings);
}

// The errors that a header notes. A bound that holds where points truly lie holds at both.
void note_accuracy(EncodedStream& encoded, const EncodeOptions& options, Miss miss,
                   Metadata& metadata) {
  const bool is_bound = options.lattice.bound_at == BoundScope::kTruePlaces;
  const std::optional<Verification>& there = encoded.true_places;
  if (miss == Miss::kWidens && encoded.bound) {
    const Decimal error = error_where_bound(encoded, options.lattice.bound_at);
    if (*encoded.bound <= error) encoded.bound = error;
  }
  const std::optional<Decimal> all = bound_of_all(encoded.bound, encoded.verification.bounds);
  metadata.accuracy = accuracy_of(encoded.verification, all);
  metadata.side = side_of(encoded.bound, options.lattice.never_below);
  metadata.at_samples = Distances{encoded.verification.max_below, encoded.verification.max_above};
  if (there) metadata.true_places = accuracy_of(*there, is_bound ? all : std::nullopt);
  metadata.bounds = encoded.bounds;
}

// The lattice's options become those of the next attempt.
Attempt assess(const Source& source, const EncodeOptions& options, Lessons& lessons,
               Approximation&& found, Miss miss) {
  const BreaklineCost cost = keep_breaklines(found.laid, found.tin);
  check_vertices(found.tin, options);
  LatticeOptions& lattice = lessons.lattice;
  const std::optional<Decimal>& bound = lattice.max_error;
  Metadata metadata = metadata_for(source, options, found.laid);
  auto [stream, decoded] = encode_and_decode(found.tin, metadata, options.effort);
  expect_promised(measured_form(decoded.mesh()));
  const auto* cloud = std::get_if<PointCloud>(&source);
  std::optional<Source> thin;
  if (cloud != nullptr) {
    if (auto some = thinned(*cloud, found.laid.placement, lattice.duplicates))
      thin = std::move(*some);
  }
  const Source& kept = thin ? *thin : source;
  WaterGauge gauge(height_decimals(source), bound ? lattice.water_level : std::nullopt);
  const Verification measured = verify(decoded.mesh(), kept, bound, gauge.visitor());
  expect_promises(measured, gauge, lattice);
  lattice.z_step = found.laid.z_step;
  std::optional<StatedBounds> own = stated_bounds(bounds_of(source), bound);
  if (own) own->span = measured.bounds.value_or(BoundSpan{});
  Attempt result{{std::move(found.laid),
                  bound,
                  own,
                  {},
                  microtin_mesh_vertex_count(decoded.mesh()),
                  measured,
                  std::nullopt,
                  std::nullopt,
                  std::nullopt},
                 0};
  EncodedStream& encoded = result.encoded;
  if (!lattice.breaklines.empty()) {
    encoded.breaklines =
        Breaklines{expect_breaklines(decoded.mesh(), kept, lattice, metadata.placement), cost};
  }
  if (cloud != nullptr) {
    const bool is_kept =
        options.lattice.bound_at == BoundScope::kTruePlaces && miss == Miss::kNarrows;
    measure_true_places(std::get<PointCloud>(kept), decoded.mesh(), is_kept, lattice, result);
  }
  if (const auto* const raster = std::get_if<Raster>(&source)) {
    const bool is_kept = is_bound_everywhere(options.lattice) && miss == Miss::kNarrows;
    measure_between_posts(*raster, decoded.mesh(), is_kept, metadata, lessons, result);
  }
  note_accuracy(encoded, options, miss, metadata);
  if (options.digest) metadata.digest = microtin_mesh_digest(decoded.mesh());
  if (options.phases) metadata.phases = measure_phases(stream, kept);
  encoded.stream = with_metadata(stream, metadata);
  if (encoded.breaklines) {
    append_edge_marks(decoded.mesh(), marked_lines(encoded.breaklines->found, lattice.line_classes),
                      encoded.stream);
  }
  return result;
}

// The surface is fitted within `room`, the bound or less.
Attempt attempt(const Source& source, const EncodeOptions& options, Lessons& lessons,
                const std::optional<Decimal>& room, const Progress& progress) {
  LatticeOptions fitted = lessons.lattice;
  fitted.max_error = room;
  return assess(source, options, lessons,
                approximate(source, fitted, simplify_options(options, processors(), progress)),
                Miss::kNarrows);
}

// A pack keeps the points' decimals, unless they reach too far for its tiles.
std::string pack_that_is_finer(const PointCloud& cloud) {
  const Decimal own = make_decimal(1, cloud.xy_decimals);
  if (pack::finest_step(cloud, pack::kMostTiles) <= own) return "make a pack (.mtp)";
  const uint64_t tiles = std::min<uint64_t>(cloud.points.size(), pack::kMostTiles);
  return "make a pack (.mtp) with " + parameter("xy_step") + ' ' +
         to_string(pack::finest_step(cloud, tiles)) + " or finer";
}

// True if a step that is left out is as coarse.
bool is_finest(Decimal xy_step, const Source& source, LatticeOptions lattice) {
  lattice.xy_step.reset();
  const Lattice finest = choose_lattice(source, lattice);
  return xy_step <= make_decimal(finest.x.step, finest.xy_decimals);
}

[[noreturn]] void refuse_lattice(const Source& source, const Attempt& last,
                                 const EncodeOptions& options) {
  const Decimal step = last.encoded.laid.xy_step;
  throw Error("the error at " + std::to_string(last.missed) + " points is up to " +
              to_string(last.encoded.true_places->max_error) + ", above " + parameter("max_error") +
              ' ' + to_string(*options.lattice.max_error) + ": " + parameter("xy_step") + ' ' +
              to_string(step) + " is too coarse" +
              (is_finest(step, source, options.lattice)
                   ? ", and 16 bits hold no finer one; " +
                         pack_that_is_finer(std::get<PointCloud>(source)) + ", "
                   : std::string("; leave it out, ")) +
              "or use " + parameter("bound_at") + " lattice");
}

// Limits scale posts' own bounds.
void refuse_scaling(const Source& source, const EncodeOptions& options) {
  const std::string limit = parameter(options.max_bytes != 0 ? "max_bytes" : "max_vertices");
  if (options.lattice.max_error->mantissa == 0) {
    throw Error(parameter("max_error") + " 0 cannot be scaled for " + limit + "; use a larger one");
  }
  const bool is_cloud = std::holds_alternative<PointCloud>(source);
  const BoundScope where = options.lattice.bound_at;
  if (is_cloud ? where != BoundScope::kLattice : where == BoundScope::kEverywhere) {
    throw Error(parameter("error_map") + " and " + limit + " go together only with " +
                parameter("bound_at") + (is_cloud ? " lattice" : " points") + "; use that, or " +
                parameter("max_error"));
  }
}

// Fits a raster, and adds vertices wherever the bound is missed between its posts, until none are
// missing or the cells bend too much. A search among the narrower limits would undo that.
EncodedStream encode_everywhere(const Source& source, const EncodeOptions& options,
                                const Progress& progress) {
  constexpr int kMostAttempts = 12;
  Lessons lessons{options.lattice, std::nullopt};
  Approximation found = approximate(source, first_fit(options.lattice),
                                    simplify_options(options, processors(), progress));
  for (int attempts = 1;; ++attempts) {
    const Tin tin = found.tin;
    Attempt made = assess(source, options, lessons, std::move(found), Miss::kNarrows);
    if (made.missed == 0) return std::move(made.encoded);
    if (attempts == kMostAttempts) {
      refuse_everywhere(std::get<Raster>(source), options.lattice, made.missed);
    }
    Laid laid = lay_out(source, lessons.lattice);
    Tin more = mended(laid.survey, tin);
    found = {std::move(laid), std::move(more)};
  }
}

// Attempts until points keep the bound where they truly lie, as many as are allowed.
Attempt attempt_some(const Source& source, const EncodeOptions& options,
                     const std::optional<Decimal>& room, const Progress& progress) {
  constexpr int kMostAttempts = 6;
  Lessons lessons{options.lattice, std::nullopt};
  for (int tries = 1;; ++tries) {
    Attempt made = attempt(source, options, lessons, room, progress);
    if (made.missed == 0 || tries == kMostAttempts) return made;
  }
}

// An attempt everywhere within less than the bound. Nothing if the terrain does not go within that.
std::optional<Attempt> attempt_narrowly(const Source& source, const EncodeOptions& options,
                                        const Attempt& last, const Progress& progress) {
  const Decimal error = error_where_bound(last.encoded, options.lattice.bound_at);
  const Decimal room = narrower(*options.lattice.max_error, error);
  try {
    return attempt_some(source, options, room, progress);
  } catch (const Error&) {
    return std::nullopt;
  }
}

}  // namespace

Decimal error_where_bound(const EncodedStream& encoded, BoundScope bound_at) {
  Decimal error = encoded.verification.max_error;
  const auto add = [&](Decimal other) {
    if (error <= other) error = other;
  };
  if (encoded.true_places && bound_at == BoundScope::kTruePlaces)
    add(encoded.true_places->max_error);
  if (encoded.everywhere && bound_at == BoundScope::kEverywhere) {
    add(encoded.everywhere->below);
    add(encoded.everywhere->above);
  }
  return error;
}

EncodedStream encode_measured(const Source& source, const EncodeOptions& options,
                              const Progress& progress) {
  if (is_bound_everywhere(options.lattice)) return encode_everywhere(source, options, progress);
  Attempt made = attempt_some(source, options, options.lattice.max_error, progress);
  if (made.missed == 0) return std::move(made.encoded);
  std::optional<Attempt> narrow = attempt_narrowly(source, options, made, progress);
  if (!narrow || narrow->missed != 0) refuse_lattice(source, made, options);
  return std::move(narrow->encoded);
}

EncodedStream measured(const Source& source, const EncodeOptions& options, Approximation&& found) {
  Lessons lessons{options.lattice, std::nullopt};
  return assess(source, options, lessons, std::move(found), Miss::kWidens).encoded;
}

EncodedStream encode_stream(const Source& source, const EncodeOptions& requested,
                            const Progress& progress) {
  const EncodeOptions options = mapped(requested, bounds_of(source));
  if (options.tile_size != 0) {
    throw Error(parameter("tile_size") + " is for packs, and this is a stream; leave it out");
  }
  if (!options.resume.empty()) {
    throw Error(parameter("resume") + " is for packs, and this is a stream; leave it out");
  }
  if (std::holds_alternative<PointCloud>(source)) refuse_everywhere_of_points(options);
  if (options.lattice.bound_at == BoundScope::kEverywhere && !options.lattice.breaklines.empty()) {
    throw Error(parameter("breaklines") + " and " + parameter("bound_at") +
                " everywhere do not go together; leave one of them out");
  }
  // Fails before the work, if it does.
  std::visit([&](const auto& one) { metadata_of(options, one); }, source);
  const bool limited = options.max_bytes != 0 || vertex_limit(options) != 0;
  const bool scales = bounds_of(source).unscaled && (options.max_bytes | options.max_vertices) != 0;
  if (scales) refuse_scaling(source, options);
  const bool is_bounded = options.lattice.max_error && !scales;
  if (!options.lattice.breaklines.empty() && !limited && !is_bounded) {
    throw Error(parameter("breaklines") + " needs a bound; use " + parameter("max_error") + ", " +
                parameter("max_bytes") + " or " + parameter("max_vertices"));
  }
  if (!limited || is_bounded) return encode_measured(source, options, progress);
  return encode_within_budget(source, options, progress);
}

}  // namespace microtin::product
