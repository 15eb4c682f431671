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
#include "encoder/cli/report.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/files/output.hpp"
#include "encoder/files/process.hpp"
#include "encoder/import/cloud.hpp"
#include "encoder/import/prepared_terrain.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/product/encode_pack.hpp"
#include "encoder/product/encode_stream.hpp"
#include "encoder/product/made_pack.hpp"
#include "encoder/product/public_options.hpp"
#include "encoder/terrain/clouds.hpp"
#include "encoder/terrain/voids.hpp"
#include "encoder/verify/everywhere.hpp"

namespace microtin::cli {
namespace {

namespace fs = std::filesystem;

// A command, in the terms of the library's parts.
struct Job : EncodeOptions {
  std::string input, output;
  std::optional<TileRange> tiles;
  Preparation preparation;
};

Job job_of(const EncodeRequest& request) {
  Job job{options_of(request.options), request.source, request.output, request.tiles,
          preparation_of(request.options, request.preparation)};
  job.lattice.water_level = job.preparation.water_level;
  job.device_ram = request.device_ram;
  job.adapter = request.adapter;
  job.resume = request.resume;
  return job;
}

// The pack of an update states itself what obstacles imply.
Job encoding_of(const EncodeRequest& request) {
  Job job = job_of(request);
  if (!request.options.obstacles.empty()) imply_obstacles(job);
  return job;
}

std::vector<std::string> inputs_of(const EncodeRequest& request) {
  return files_of(request.source, preparation_of(request.options, request.preparation));
}

bool makes_pack(const Job& job) {
  return job.tile_vertices != 0 || job.tiles || job.adapter != Adapter::kNone ||
         suffix_of(job.output) == ".mtp";
}

std::string moved(Decimal displacement) {
  if (displacement.mantissa == 0) return ", exact";
  return ", values move by up to " + to_string(displacement);
}

std::string warnings(const Job& job, const Reference& reference) {
  std::string text;
  for (const std::string& one : reference.warnings) text += "warning: " + one + '\n';
  const bool is_grid = suffix_of(job.input) == ".asc";
  if (reference.horizontal_unit == Unit::kUnknown && is_grid) {
    text += "warning: a .prj next to " + job.input + " can state it\n";
  }
  return text;
}

// In which units the header says that the terrain is.
std::string units(const Job& job, const Reference& source) {
  const Reference reference = completed(source);
  return "units: x and y " + std::string(name_of(reference.horizontal_unit)) + ", z " +
         std::string(name_of(reference.vertical_unit)) + '\n' + warnings(job, reference);
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
                           const std::optional<Decimal>& bound, const Job& job) {
  if (!measured) return "";
  const bool is_bound = job.lattice.bound_at == BoundScope::kTruePlaces && bound;
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

std::string text_of_source(const Source& source, const Verification& measured) {
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

std::string stream_report(const Source& source, const EncodedStream& encoded, const Job& job) {
  const Laid& laid = encoded.laid;
  const bool posts = std::holds_alternative<Raster>(source);
  const Verification& measured = encoded.verification;
  std::ostringstream text;
  text.exceptions(std::ios::badbit);  // else a text for which memory is short ends early, unsaid
  text << text_of_source(source, measured) << "step of x and y: " << to_string(laid.xy_step)
       << (posts ? " (in posts)" : "") << moved(laid.xy_displacement)
       << "\nstep of z: " << to_string(laid.z_step) << moved(laid.z_displacement) << '\n'
       << merged(laid.merged, job.lattice.duplicates) << "stream: " << encoded.vertices
       << " vertices, " << encoded.stream.size() << " bytes, "
       << bits_per_vertex(encoded.stream.size(), encoded.vertices) << " bits/vertex\n"
       << "error: at most " << to_string(measured.max_error) << ", rms "
       << to_string(measured.rms_error) << ", mean " << to_string(measured.mean_error);
  if (encoded.bound && !encoded.bounds) {
    text << (job.lattice.max_error ? " (requested: at most " : " (found: at most ")
         << to_string(*encoded.bound) << ")";
  }
  text << '\n'
       << own_bounds(encoded.bounds) << at_true_places(encoded.true_places, encoded.bound, job)
       << beyond(measured, encoded.everywhere,
                 job.lattice.bound_at == BoundScope::kEverywhere && encoded.bound)
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
  if (pack.bound && !pack.bounds) text << " (requested: at most " << to_string(*pack.bound) << ")";
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
void announce(const Job& job, const std::string& text) {
  if (!text.empty()) std::fputs(warning(job.input + ": " + text).c_str(), stderr);
}

void announce_grid(const Job& job, const std::string& text) {
  announce(job, text.empty() ? text : text + ": use --gridded");
}

OpenSource open_source(const Job& job) {
  return prepared_source(job.input, job.preparation);
}

// What the source holds, after warnings about it.
SourceFacts announced(const Job& job, const PackSource& source) {
  SourceFacts facts = facts_of(source);
  announce(job, facts.fill);
  announce_grid(job, facts.grid);
  return facts;
}

const RasterReader& raster_of(const Job& job, const PackSource& source) {
  const RasterReader* const raster =
      with_file_context(job.input, [&] { return &raster_with_shards(source); });
  announced(job, source);
  return *raster;
}

// Each of these writes what is requested and returns what to say of it.
std::string encode_tiles(const Job& job, OutputFile& out) {
  const OpenSource opened = open_source(job);
  const PackSource source = pack_source_of(opened);
  const RasterReader& raster = raster_of(job, source);
  const ShardReport shard = with_file_context(job.input, [&] {
    ProgressBar bar;
    return encode_shard(raster, job, *job.tiles, out, bar.progress());
  });
  return "tiles: " + range_text(shard.tiles) + " of " + range_text(shard.all) + ", " +
         std::to_string(shard.vertices) + " vertices\n" +
         warnings(job, completed(raster.frame().reference));
}

std::string text_before(const EncodedPoints& made, const Job& job, const std::string& selection) {
  return source_of_points(made.points, selection) + "step of x and y: " + to_string(made.xy_step) +
         moved(made.xy_displacement) + "\n" + merged(made.merged, job.lattice.duplicates);
}

std::string encode_tiled(const Job& job, OutputFile& out) {
  if (job.tiles) return encode_tiles(job, out);
  const OpenSource opened = open_source(job);
  const PackSource source = pack_source_of(opened);
  const SourceFacts facts = announced(job, source);
  MadePack pack = with_file_context(job.input, [&] {
    ProgressBar bar;
    return made_pack(source, job, job.output, bar.progress());
  });
  pack.write(out);
  const std::string text = pack_report(pack.report(), is_bound_everywhere(job.lattice)) +
                           settings(pack.report(), job.adapter);
  if (const auto* const cloud = std::get_if<PointCloud>(&opened)) {
    return text_before(*pack.points(), job, cloud->selection) + text +
           at_true_places(pack.points()->true_places, pack.report().bound, job) +
           units(job, cloud->reference);
  }
  const Raster& frame = std::get<const RasterReader*>(source)->frame();
  return source_of_posts(facts.scanned->posts, facts.scanned->voids, facts.scanned->mended,
                         frame.selection) +
         text + units(job, frame.reference);
}

std::string encode_whole(const Job& job, OutputFile& out) {
  const Source source = prepared_terrain(job.input, job.preparation);
  announce(job, std::visit([](const auto& one) { return warning_on_fill(one); }, source));
  if (const auto* const cloud = std::get_if<PointCloud>(&source)) {
    announce_grid(job, warning_on_grid(*cloud));
  }
  const EncodedStream encoded = with_file_context(job.input, [&] {
    ProgressBar bar;
    return encode_stream(source, job, bar.progress());
  });
  out.write(encoded.stream);
  return stream_report(source, encoded, job) + units(job, reference_of(source));
}

void announce_left_out(const Job& job) {
  std::vector<std::string> names = job.preparation.more_files;
  names.insert(names.begin(), job.input);
  for (const std::string& name : names) {
    const std::string text = left_out_of(name);
    if (!text.empty()) std::fputs(warning(text).c_str(), stderr);
  }
}

// What the points of all files take, which are read into memory, if that is much.
void announce_memory(const Job& job, const std::vector<std::string>& inputs) {
  constexpr double kGigabyte = 1e9, kOfStream = 100, kOfPack = 180;  // bytes for a point
  uint64_t points = 0;
  for (const std::string& file : inputs) points += points_expected(file);
  const double bytes = static_cast<double>(points) * (makes_pack(job) ? kOfPack : kOfStream);
  if (bytes < kGigabyte) return;
  const auto machine = static_cast<double>(machine_memory());
  char text[160];
  std::snprintf(text, sizeof text,
                "about %.0f points take about %.2g GB of memory; this machine has %.2g GB",
                static_cast<double>(points), bytes / kGigabyte, machine / kGigabyte);
  std::fputs(warning(job.input + ": " + text).c_str(), stderr);
}

// Other programs choose how to read a file by its suffix, so another suffix is refused. No other
// program reads shards: they may have any name.
void expect_own_suffix(const std::string& output, bool is_pack) {
  const std::string suffix = suffix_of(output);
  if (suffix.empty() || suffix == ".mtp" || (suffix == ".mtin" && !is_pack)) return;
  throw Error(output + (is_pack ? ": name a pack .mtp"
                                : ": name a stream .mtin and a pack .mtp; \"microtin decode\" and "
                                  "\"microtin render\" make other files from them"));
}

// The file of finished tiles is removed at the end, so it is no other file of the command.
void expect_own_resume_file(const Job& job, const std::vector<std::string>& inputs) {
  if (job.resume.empty()) return;
  refuse_overwriting(inputs, job.resume);
  const auto full = [](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(fs::u8path(path)));
  };
  if (full(job.resume) != full(job.output)) return;
  throw Error(job.resume + ": is also the output; name another file for --resume");
}

}  // namespace

void run_encode(const EncodeRequest& request) {
  Job job = encoding_of(request);
  const std::vector<std::string> inputs = inputs_of(request);
  refuse_overwriting(inputs, job.output);
  expect_own_resume_file(job, inputs);
  if (!job.tiles) expect_own_suffix(job.output, makes_pack(job));
  OutputFile out(job.output);  // fails early if it cannot be written
  announce_left_out(job);
  announce_memory(job, inputs);
  take_breaklines(request.options, feature_files_of(job.preparation), job);
  deliver(out, job.output, makes_pack(job) ? encode_tiled(job, out) : encode_whole(job, out));
  std::error_code none;
  if (!job.resume.empty()) fs::remove(fs::u8path(job.resume), none);
}

void run_plan(const EncodeRequest& request, uint32_t shards) {
  Job job = encoding_of(request);
  refuse_overwriting(inputs_of(request), "-");
  take_breaklines(request.options, feature_files_of(job.preparation), job);
  const OpenSource opened = open_source(job);
  const PackSource source = pack_source_of(opened);
  const RasterReader& raster = raster_of(job, source);
  const std::vector<ShardPlan> plans = with_file_context(job.input, [&] {
    ProgressBar bar;
    return plan_shards(raster, job, shards, bar.progress());
  });
  std::string text;
  for (const ShardPlan& plan : plans) {
    text += "--tile-size " + std::to_string(plan.tile_size) + " --z-step " +
            to_string(plan.z_step) + " --shard " + range_text(plan.tiles) + '\n';
  }
  print(text);
}

void run_update(const UpdateRequest& request) {
  Job job = job_of(request);
  std::vector<std::string> inputs = inputs_of(request);
  inputs.push_back(request.old);
  refuse_overwriting(inputs, job.output);
  expect_own_suffix(job.output, true);
  OutputFile out(job.output);
  announce_left_out(job);
  take_breaklines(request.options, feature_files_of(job.preparation), job);
  job.preparation.max_error = max_error_of_map(request.old);
  const OpenSource source = open_source(job);
  const auto* const raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
  if (raster == nullptr) {
    throw Error(job.input +
                ": only packs of rasters are updated, and these are points; encode them again");
  }
  UpdatedTiles updated = with_file_context(job.input, [&] {
    ProgressBar bar;
    return updated_pack(request.old, **raster, job, request.bound_at, job.output, bar.progress());
  });
  updated.pack.write(out);
  deliver(out, job.output,
          "kept: " + std::to_string(updated.kept) + " of " + std::to_string(updated.tiles) +
              " tiles\n" + pack_report(updated.pack.report()));
}

void run_merge(const std::vector<std::string>& shards, const std::string& output) {
  refuse_overwriting(shards, output);
  expect_own_suffix(output, true);
  OutputFile out(output);
  MadePack pack = merged_pack(shards, output);
  pack.write(out);
  deliver(out, output, pack_report(pack.report()));
}

}  // namespace microtin::cli
