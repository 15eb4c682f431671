// SPDX-License-Identifier: MIT
// The commands encode, plan, update and merge: streams and packs from a terrain, and what to say of
// them.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <variant>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/progress.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/files/descriptors.hpp"
#include "encoder/files/output.hpp"
#include "encoder/import/breaklines.hpp"
#include "encoder/import/cloud.hpp"
#include "encoder/import/prepared_terrain.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/product/encode_pack.hpp"
#include "encoder/product/encode_stream.hpp"
#include "encoder/product/pack_parts.hpp"
#include "encoder/product/update_pack.hpp"
#include "encoder/terrain/clouds.hpp"
#include "encoder/terrain/raster_scan.hpp"
#include "encoder/terrain/voids.hpp"
#include "encoder/verify/everywhere_bound.hpp"

namespace microtin::cli {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> inputs_of(const EncodeRequest& request) {
  std::vector<std::string> files = files_of(request.input, request.preparation);
  if (!request.breaklines.empty()) files.push_back(request.breaklines);
  return files;
}

bool makes_pack(const EncodeRequest& request) {
  return request.tile_vertices != 0 || request.tiles || request.adapter != Adapter::kNone ||
         suffix_of(request.output) == ".mtp";
}

std::string moved(Decimal displacement) {
  if (displacement.mantissa == 0) return ", exact";
  return ", values move by up to " + to_string(displacement);
}

std::string warnings(const EncodeRequest& request, const Reference& reference) {
  std::string text;
  for (const std::string& one : reference.warnings) text += "warning: " + one + '\n';
  const bool is_grid = suffix_of(request.input) == ".asc";
  if (reference.horizontal_unit == Unit::kUnknown && is_grid) {
    text += "warning: a .prj next to " + request.input + " can state it\n";
  }
  return text;
}

// In which units the header says that the terrain is.
std::string units(const EncodeRequest& request, const Reference& source) {
  const Reference reference = completed(source);
  return "units: x and y " + std::string(name_of(reference.horizontal_unit)) + ", z " +
         std::string(name_of(reference.vertical_unit)) + '\n' + warnings(request, reference);
}

std::string merged(uint64_t points, DuplicateRule rule) {
  if (points == 0) return "";
  const std::string text = "merged: " + std::to_string(points) + " shared a place with another; ";
  if (rule == DuplicateRule::kMiddle) {
    return text + "the surface aims at the middle of the lowest and the highest there\n";
  }
  return text + "the " + std::string(text_of(rule)) + " stands for all there\n";
}

std::string at_true_places(const std::optional<Verification>& measured,
                           const std::optional<Decimal>& bound, const EncodeRequest& request) {
  if (!measured) return "";
  const bool is_bound = request.lattice.bound_at == BoundScope::kTruePlaces && bound;
  return "... where the points truly lie: at most " + to_string(measured->max_error) + ", rms " +
         to_string(measured->rms_error) + ", mean " + to_string(measured->mean_error) +
         (is_bound ? " (the bound holds there, too)" : "") + "; below the points: at most " +
         to_string(measured->max_below) + ", above: at most " + to_string(measured->max_above) +
         '\n';
}

std::string own_bounds(const std::optional<StatedBounds>& bounds) {
  return bounds ? text_of(*bounds) : "";
}

// How far the surface is on either side of the source.
std::string beyond(const Verification& measured, const std::optional<Distances>& everywhere,
                   bool is_bound) {
  std::string text = "below the source: at most " + to_string(measured.max_below) +
                     ", above: at most " + to_string(measured.max_above) + '\n';
  if (!everywhere) return text;
  return text + "everywhere, from the bilinear surface of the posts: at most " +
         to_string(everywhere->below) + " below, at most " + to_string(everywhere->above) +
         " above" + (is_bound ? " (the bound holds there, too)\n" : "\n");
}

std::string source_of_posts(uint64_t posts, uint64_t voids, const Mended& mended,
                            const std::string& selection) {
  std::string text = "source: " + std::to_string(posts) + " posts";
  if (voids != 0) text += ", " + std::to_string(voids) + " void posts";
  return text + describe_preparation(mended, selection) + '\n';
}

std::string source_of_points(uint64_t points, const std::string& selection) {
  return "source: " + std::to_string(points) + " points" + describe_preparation({}, selection) +
         '\n';
}

std::string source_of(const Source& source, const Verification& measured) {
  if (const auto* const cloud = std::get_if<PointCloud>(&source)) {
    return source_of_points(measured.posts, cloud->selection);
  }
  const auto& raster = std::get<Raster>(source);
  return source_of_posts(measured.posts, measured.voids, raster.mended, raster.selection);
}

// A decimal that is not exact, with few digits, rounded up.
std::string few_digits(double value) {
  constexpr double kParts = 1000;
  return to_string(make_decimal(static_cast<int64_t>(std::ceil(value * kParts - 1e-6)), 3));
}

std::string along_lines(const EncodedStream& encoded) {
  if (!encoded.breaklines) return "";
  const auto& [found, cost] = *encoded.breaklines;
  std::string text = "breaklines: " + std::to_string(found.lines.size()) + " lines are " +
                     std::to_string(found.pieces) + " edges between " +
                     std::to_string(cost.on_lines) + " vertices, of which " +
                     std::to_string(std::max<int64_t>(cost.added, 0)) +
                     " were added for edges that were missing; they lie within " +
                     few_digits(found.max_shift) + " steps of the lines";
  if (found.max_error > 0) {
    const double unit = step_of(encoded.laid.placement.z);
    text += ", heights within " + few_digits(found.max_error * unit);
  }
  text += '\n';
  if (cost.unit_pieces != 0) {
    text += "... " + std::to_string(cost.unit_pieces) +
            " edges have the length of a step: with --xy-step " +
            to_string(half(encoded.laid.xy_step)) + " lines need fewer vertices\n";
  }
  return text;
}

std::string stream_report(const Source& source, const EncodedStream& encoded,
                          const EncodeRequest& request) {
  const Laid& laid = encoded.laid;
  const bool posts = std::holds_alternative<Raster>(source);
  const Verification& measured = encoded.verification;
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // else a text for which memory is short ends early, unsaid
  text << source_of(source, measured) << "step of x and y: " << to_string(laid.xy_step)
       << (posts ? " (in posts)" : "") << moved(laid.xy_displacement)
       << "\nstep of z: " << to_string(laid.z_step) << moved(laid.z_displacement) << '\n'
       << merged(laid.merged, request.lattice.duplicates) << "stream: " << encoded.vertices
       << " vertices, " << encoded.stream.size() << " bytes, "
       << bits_per_vertex(encoded.stream.size(), encoded.vertices) << " bits/vertex\n"
       << "error: at most " << to_string(measured.max_error) << ", rms "
       << to_string(measured.rms_error) << ", mean " << to_string(measured.mean_error);
  if (encoded.bound && !encoded.bounds) {
    text << (request.lattice.max_error ? " (asked for: at most " : " (found: at most ")
         << to_string(*encoded.bound) << ")";
  }
  text << '\n'
       << own_bounds(encoded.bounds) << at_true_places(encoded.true_places, encoded.bound, request)
       << beyond(measured, encoded.everywhere,
                 request.lattice.bound_at == BoundScope::kEverywhere && encoded.bound)
       << along_lines(encoded);
  return text.str();
}

// `is_bound`: the bound was to hold between posts, too.
std::string pack_report(const PackReport& pack, bool is_bound = false) {
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // else a text for which memory is short ends early, unsaid
  text << "step of z: " << to_string(pack.z_step) << "\npack: " << tile_columns(pack.grid) << " x "
       << tile_rows(pack.grid) << " tiles of " << pack.grid.width << " x " << pack.grid.height
       << " steps";
  if (pack.empty_tiles != 0) text << ", " << pack.empty_tiles << " without terrain";
  text << ", " << pack.vertices << " vertices, at most " << pack.most_vertices << " in a tile, "
       << pack.bytes << " bytes\nerror: at most " << to_string(pack.measured.max_error) << ", rms "
       << to_string(pack.measured.rms_error) << ", mean " << to_string(pack.measured.mean_error);
  if (pack.bound && !pack.bounds) text << " (asked for: at most " << to_string(*pack.bound) << ")";
  text << '\n' << own_bounds(pack.bounds) << beyond(pack.measured, pack.everywhere, is_bound);
  return text.str();
}

// What firmware sets for an adapter of decoder/adapters.
std::string settings(const PackReport& pack, Adapter adapter) {
  if (adapter == Adapter::kNone || pack.compact_bytes == 0) return "";
  const std::string name = adapter == Adapter::kInav ? "inav" : "ardupilot";
  return "for " + name + ": define MICROTIN_ADAPTERS_COMPACT; MICROTIN_COMPACT_PACK_BYTES(" +
         std::to_string(kAdapterTiles) + ", " + std::to_string(slot_capacity(pack)) + ", " +
         std::to_string(pack.compact_bytes) + ") and microtin_" + name + " take " +
         std::to_string(adapter_ram(pack)) + " bytes\n";
}

// Warns of values that may not be heights, before the work begins.
void announce(const EncodeRequest& request, const std::string& text) {
  if (!text.empty()) std::fputs(warning(request.input + ": " + text).c_str(), stderr);
}

void announce_grid(const EncodeRequest& request, const PointCloud& cloud) {
  const std::string text = warning_on_grid(cloud);
  announce(request, text.empty() ? text : text + ": use --gridded");
}

RasterScan scan_for_fill(const EncodeRequest& request, const RasterReader& raster) {
  RasterScan scanned = scan(raster, {}, false, {});
  announce(request, warning_on_fill(scanned.extremes, raster.frame().decimals));
  return scanned;
}

std::unique_ptr<RasterReader> open_raster(const EncodeRequest& request) {
  OpenSource source = prepared_source(request.input, request.preparation);
  auto* const raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
  if (raster == nullptr) {
    throw Error(request.input + ": only packs of rasters have shards, and these are points");
  }
  scan_for_fill(request, **raster);
  return std::move(*raster);
}

// Each of these writes what is asked for and returns what to say of it.
std::string encode_raster(const RasterReader& raster, const EncodeRequest& request,
                          OutputFile& out) {
  const RasterScan scanned = scan_for_fill(request, raster);
  StreamSpool streams(request.output);
  const PackContent pack = with_file_context(request.input, [&] {
    ProgressBar bar;
    return encode_pack(raster, request, streams, bar.progress());
  });
  write_pack(pack, streams, out);
  const Raster& frame = raster.frame();
  return source_of_posts(scanned.posts, scanned.voids, scanned.mended, frame.selection) +
         pack_report(report_of(pack), is_bound_everywhere(request.lattice)) +
         settings(report_of(pack), request.adapter) + units(request, frame.reference);
}

std::string encode_points(const PointCloud& cloud, const EncodeRequest& request, OutputFile& out) {
  announce(request, warning_on_fill(cloud));
  announce_grid(request, cloud);
  const EncodedPoints made =
      with_file_context(request.input, [&] { return encode_pack(cloud, request); });
  out.write(made.bytes);
  std::string text = source_of_points(made.points, cloud.selection);
  text += "step of x and y: " + to_string(made.xy_step) + moved(made.xy_displacement) + "\n";
  return text + merged(made.merged, request.lattice.duplicates) + pack_report(made.report) +
         settings(made.report, request.adapter) +
         at_true_places(made.true_places, made.report.bound, request) +
         units(request, cloud.reference);
}

std::string encode_tiles(const EncodeRequest& request, OutputFile& out) {
  const std::unique_ptr<RasterReader> raster = open_raster(request);
  const ShardReport shard = with_file_context(request.input, [&] {
    ProgressBar bar;
    return encode_shard(*raster, request, *request.tiles, out, bar.progress());
  });
  return "tiles: " + range_text(shard.tiles) + " of " + range_text(shard.all) + ", " +
         std::to_string(shard.vertices) + " vertices\n" +
         warnings(request, completed(raster->frame().reference));
}

std::string encode_tiled(const EncodeRequest& request, OutputFile& out) {
  if (request.tiles) return encode_tiles(request, out);
  const OpenSource source = prepared_source(request.input, request.preparation);
  if (const auto* cloud = std::get_if<PointCloud>(&source)) {
    return encode_points(*cloud, request, out);
  }
  return encode_raster(*std::get<std::unique_ptr<RasterReader>>(source), request, out);
}

std::string encode_whole(const EncodeRequest& request, OutputFile& out) {
  const Source source = prepared_terrain(request.input, request.preparation);
  announce(request, std::visit([](const auto& one) { return warning_on_fill(one); }, source));
  if (const auto* const cloud = std::get_if<PointCloud>(&source)) {
    announce_grid(request, *cloud);
  }
  const EncodedStream encoded = with_file_context(request.input, [&] {
    ProgressBar bar;
    return encode_stream(source, request, bar.progress());
  });
  out.write(encoded.stream);
  return stream_report(source, encoded, request) + units(request, reference_of(source));
}

void announce_left_out(const EncodeRequest& request) {
  std::vector<std::string> names = request.preparation.more_files;
  names.insert(names.begin(), request.input);
  for (const std::string& name : names) {
    const std::string text = left_out_of(name);
    if (!text.empty()) std::fputs(warning(text).c_str(), stderr);
  }
}

// What the points of all files take, which are read into memory, if that is much.
void announce_memory(const EncodeRequest& request) {
  constexpr double kGigabyte = 1e9, kOfStream = 100, kOfPack = 180;  // bytes for a point
  uint64_t points = 0;
  for (const std::string& file : inputs_of(request)) points += points_expected(file);
  const double bytes = static_cast<double>(points) * (makes_pack(request) ? kOfPack : kOfStream);
  if (bytes < kGigabyte) return;
  const auto machine = static_cast<double>(machine_memory());
  char text[160];
  std::snprintf(text, sizeof text,
                "about %.0f points take about %.2g GB of memory; this machine has %.2g GB",
                static_cast<double>(points), bytes / kGigabyte, machine / kGigabyte);
  std::fputs(warning(request.input + ": " + text).c_str(), stderr);
}

// A name that says something else would have other programs read what is none of theirs. Shards are
// named at will.
void expect_own_suffix(const std::string& output, bool is_pack) {
  const std::string suffix = suffix_of(output);
  if (suffix.empty() || suffix == ".mtp" || (suffix == ".mtin" && !is_pack)) return;
  throw Error(output + (is_pack ? ": name a pack .mtp"
                                : ": name a stream .mtin and a pack .mtp; \"microtin decode\" and "
                                  "\"microtin render\" make other files from them"));
}

// The file of finished tiles is removed at the end, so it is no other file of the command.
void expect_own_resume_file(const EncodeRequest& request) {
  if (request.resume.empty()) return;
  refuse_overwriting(inputs_of(request), request.resume);
  const auto full = [](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(fs::u8path(path)));
  };
  if (full(request.resume) != full(request.output)) return;
  throw Error(request.resume + ": is also the output; name another file for --resume");
}

void take_breaklines(EncodeRequest& request) {
  if (request.breaklines.empty()) return;
  BreaklineFile read = read_breaklines(request.breaklines);
  request.lattice.breaklines = std::move(read.lines);
  request.lattice.line_classes = std::move(read.classes);
}

}  // namespace

void run_encode(EncodeRequest request) {
  refuse_overwriting(inputs_of(request), request.output);
  expect_own_resume_file(request);
  if (!request.tiles) expect_own_suffix(request.output, makes_pack(request));
  OutputFile out(request.output);  // fails early if it cannot be written
  announce_left_out(request);
  announce_memory(request);
  take_breaklines(request);
  deliver(out, request.output,
          makes_pack(request) ? encode_tiled(request, out) : encode_whole(request, out));
  std::error_code none;
  if (!request.resume.empty()) fs::remove(fs::u8path(request.resume), none);
}

void run_plan(EncodeRequest request, uint32_t shards) {
  refuse_overwriting(inputs_of(request), "-");
  take_breaklines(request);
  const std::unique_ptr<RasterReader> raster = open_raster(request);
  const std::vector<ShardPlan> plans = with_file_context(request.input, [&] {
    ProgressBar bar;
    return plan_shards(*raster, request, shards, bar.progress());
  });
  std::string text;
  for (const ShardPlan& plan : plans) {
    text += "--tile-size " + std::to_string(plan.tile_size) + " --z-step " +
            to_string(plan.z_step) + " --shard " + range_text(plan.tiles) + '\n';
  }
  print(text);
}

void run_update(UpdateRequest request) {
  std::vector<std::string> inputs = inputs_of(request);
  inputs.push_back(request.old);
  refuse_overwriting(inputs, request.output);
  expect_own_suffix(request.output, true);
  OutputFile out(request.output);
  announce_left_out(request);
  take_breaklines(request);
  Preparation preparation = request.preparation;
  preparation.max_error = max_error_of_map(request.old);
  const OpenSource source = prepared_source(request.input, preparation);
  const auto* const raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
  if (raster == nullptr) {
    throw Error(request.input +
                ": only packs of rasters are updated, and these are points; encode them again");
  }
  StreamSpool streams(request.output);
  const UpdatedPack updated = with_file_context(request.input, [&] {
    ProgressBar bar;
    return update_pack(request.old, **raster, request, request.bound_at, streams, bar.progress());
  });
  write_pack(updated.content, streams, out);
  deliver(out, request.output,
          "kept: " + std::to_string(updated.kept) + " of " +
              std::to_string(updated.content.tiles.size()) + " tiles\n" +
              pack_report(report_of(updated.content)));
}

void run_merge(const std::vector<std::string>& shards, const std::string& output) {
  refuse_overwriting(shards, output);
  expect_own_suffix(output, true);
  OutputFile out(output);
  StreamSpool streams(output);
  deliver(out, output, pack_report(merge_parts(shards, streams, out)));
}

}  // namespace microtin::cli
