// SPDX-License-Identifier: MIT
// The commands decode and embed: streams and packs as files of other programs.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/options.hpp"
#include "encoder/cli/pages.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/export/autopilot.hpp"
#include "encoder/export/grid.hpp"
#include "encoder/export/mesh.hpp"
#include "encoder/export/system.hpp"
#include "encoder/files/input.hpp"
#include "encoder/files/output.hpp"
#include "encoder/import/features.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/product/document.hpp"
#include "encoder/stream/embed.hpp"

namespace microtin::cli {
namespace {

namespace fs = std::filesystem;

struct DecodeRequest {
  std::string input;
  std::string output;
  bool lattice = false;          // integers instead of real coordinates
  bool force = false;            // write more than 1 GB, read more than a stream's vertices
  std::optional<Decimal> cell;   // of a grid
  std::optional<Extent> extent;  // where the grid's posts lie
  std::string like;              // the raster whose posts the grid has; empty: none
  Preparation like_preparation;  // how that is read
};

// --- Grids ---

// A grid's coordinate system, in a file next to it.
class SystemFile {
 public:
  SystemFile(const std::string& grid, const Metadata& metadata)
      : path_(fs::u8path(grid).replace_extension(".prj").string()),
        code_(metadata.horizontal_epsg) {
    const std::string text = system_text(metadata);
    if (!text.empty()) {
      out_.emplace(path_).write(text);
    } else if (std::error_code none; fs::exists(fs::u8path(path_), none)) {
      warning_ = warning(path_ + " lies next to the grid, but is not its coordinate system");
    } else if (code_ != 0) {
      const std::string code = "EPSG:" + std::to_string(code_);
      warning_ = warning("no " + path_ + " is written: the text of " + code +
                         " is not known here; \"gdalsrsinfo -o wkt_esri " + code + "\" prints it");
    }
  }

  void commit() {
    if (out_) out_->commit();
    std::fputs(warning_.c_str(), stderr);
  }

 private:
  std::string path_, warning_;
  uint32_t code_;
  std::optional<OutputFile> out_;
};

PostGrid grid_of_file(const DecodeRequest& request, const Metadata& terrain) {
  const OpenSource source = prepared_source(request.like, request.like_preparation);
  const auto* raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
  if (raster == nullptr) {
    throw Error(request.like + ": has points, and no posts; set their distance by --cell");
  }
  Reference own;
  own.horizontal_unit = terrain.horizontal_unit;
  own.horizontal_epsg = terrain.horizontal_epsg;
  with_file_context(request.like,
                    [&] { expect_same_horizontal_system((*raster)->frame().reference, own); });
  return posts_of((*raster)->frame());
}

// The posts of a file that is named, or of the source, or the lattice's.
PostGrid posts_alike(const DecodeRequest& request, const SampledSurface& surface,
                     const Metadata& metadata) {
  if (!request.like.empty()) return grid_of_file(request, metadata);
  return metadata.grid && !request.lattice ? *metadata.grid : lattice_grid(surface);
}

PostGrid grid_of(const DecodeRequest& request, const SampledSurface& surface,
                 const Metadata& metadata) {
  const std::optional<Extent>& extent = request.extent;
  if (!request.cell) {
    const PostGrid grid = posts_alike(request, surface, metadata);
    return extent ? posts_within(grid, *extent, surface.is_degrees) : grid;
  }
  return extent ? grid_of_cells(*extent, *request.cell) : grid_of_cells(surface, *request.cell);
}

void decode_to_grid(const DecodeRequest& request) {
  const Document document(request.input);
  const Metadata metadata = document.metadata();
  SampledSurface surface = document.sampled();
  if (request.lattice) {
    surface.placement = Placement();
    surface.is_degrees = false;
  }
  const PostGrid grid = grid_of(request, surface, metadata);
  if (!meets(surface, grid)) {
    throw Error(request.input + ": no post of the grid lies on the terrain, which has " +
                extent_text(surface));
  }
  announce_size(request.output, most_grid_bytes(surface, grid), request.force,
                "; use --cell or --extent for less");
  OutputFile out(request.output);
  export_grid(surface, grid, out);
  std::optional<SystemFile> system;
  if (!request.lattice) system.emplace(request.output, metadata);
  out.commit();
  if (system) system->commit();
}

// --- Other formats ---

// Metres between an autopilot's posts.
uint32_t spacing_of(const DecodeRequest& request, Autopilot autopilot) {
  const bool is_inav = autopilot == Autopilot::kInav;
  if (!request.cell) return is_inav ? kInavSpacing : kArduPilotSpacing;
  const Decimal cell = *request.cell;
  const std::string text = to_string(cell);
  for (uint32_t metres = 10; metres <= 1000; ++metres) {
    if (text == std::to_string(metres) && (!is_inav || metres == kInavSpacing)) return metres;
  }
  throw Error(
      request.output + ": --cell must be " +
      (is_inav ? "30, the spacing of INAV's posts" : "a whole number of metres, 10 to 1000"));
}

std::string fixed(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", value);
  return text;
}

std::string autopilot_report(const AutopilotFile& file, uint32_t spacing) {
  std::string text = std::to_string(file.blocks) + " blocks of 28 x 32 posts, " +
                     std::to_string(spacing) + " m apart; " + std::to_string(file.empty) +
                     " without terrain are zeros\n";
  if (file.partial != 0) {
    text += "covered in part: " + std::to_string(file.partial) +
            " blocks, whose groups of 4 x 4 posts without all heights are marked missing\n";
  }
  if (file.beyond != 0) {
    text += "beyond the terrain's edge: " + std::to_string(file.beyond) +
            " posts, which have the height of the nearest place on it\n";
  }
  return text + "the grid adds: at most " + fixed(file.largest) + " m, rms " + fixed(file.rms) +
         " m, at " + std::to_string(file.places) + " places of the lattice\n";
}

void decode_for_autopilot(const DecodeRequest& request, Autopilot autopilot) {
  const auto cell = cell_of(request.output);
  if (!cell) {
    throw Error(request.output + ": the name must be that of a cell, such as N43E007");
  }
  const uint32_t spacing = spacing_of(request, autopilot);
  if (request.lattice)
    throw Error(request.output +
                ": a file for an autopilot has real coordinates; leave out --lattice");
  const Document document(request.input);
  const Metadata metadata = document.metadata();
  if (metadata.horizontal_unit != Unit::kDegree || metadata.vertical_unit != Unit::kMetre) {
    throw Error(request.input +
                ": autopilots need positions in degrees and heights in metres; encode the terrain "
                "in these units");
  }
  const AutopilotFile file = with_file_context(request.output, [&] {
    return autopilot_file(document.sampled(), autopilot, *cell, spacing);
  });
  OutputFile out(request.output);
  out.write(file.bytes);
  deliver(out, request.output, autopilot_report(file, spacing));
  if (file.missed != 0) {
    const double percent =
        100.0 * static_cast<double>(file.missed) / static_cast<double>(file.queried);
    std::fputs(warning("firmware that computes in single precision finds no height at " +
                       std::to_string(file.missed) + " of " + std::to_string(file.queried) +
                       " places with terrain (" + fixed(percent) +
                       " %): its distances are too coarse at this latitude")
                   .c_str(),
               stderr);
  }
}

void decode_to_mesh(const DecodeRequest& request) {
  const MeshFormat format = mesh_format_of(request.output);
  const bool is_real = !request.lattice;
  const Coordinates coordinates = is_real ? Coordinates::kReal : Coordinates::kLattice;
  const Document document(request.input);
  const uint64_t vertices = document.counted_vertices();
  announce_size(
      request.output,
      static_cast<double>(most_mesh_bytes(document.sampled(), vertices, format, coordinates)),
      request.force);
  const SurfaceModel model = document.model(most_vertices(request.input, vertices, request.force));
  if (format == MeshFormat::kGlb && model.triangles.empty()) {
    throw Error(request.input + ": has no triangle, which a .glb file needs; write an .xyz file");
  }
  OutputFile out(request.output);
  export_model(model, format, coordinates, out);
  const bool has_units = format == MeshFormat::kGlb && is_real;
  const std::string of_units = has_units ? warning_of_units(request.output, model) : "";
  out.commit();
  std::fputs(of_units.c_str(), stderr);
}

void decode_to_lines(const DecodeRequest& request) {
  const Document document(request.input);
  if (document.stream() == nullptr) {
    throw Error(request.input + ": is a pack, which has no lines; write a mesh or a grid");
  }
  const DecodedTerrain& terrain = document.stream()->terrain;
  const std::vector<MarkedLine> lines = terrain.lines();
  if (lines.empty()) {
    throw Error(request.input + ": has no lines; encode it with --breaklines, or write a mesh");
  }
  const Placement placement = request.lattice ? Placement() : document.metadata().placement;
  OutputFile out(request.output);
  export_lines(terrain.mesh(), lines, placement, out);
  out.commit();
}

void run_decode(const DecodeRequest& request) {
  std::vector<std::string> inputs = files_of(request.like, request.like_preparation);
  inputs.push_back(request.input);
  refuse_overwriting(inputs, request.output);
  const bool is_grid = suffix_of(request.output) == ".asc";
  if (!is_grid && (!request.like.empty() || request.extent)) {
    throw Error(request.output + ": --like and --extent are for grids (.asc)");
  }
  if (const auto autopilot = autopilot_of(request.output)) {
    decode_for_autopilot(request, *autopilot);
    return;
  }
  if (is_grid) {
    decode_to_grid(request);
    return;
  }
  if (request.cell) throw Error(request.output + ": only grids (.asc, .DAT, .TER) have cells");
  if (is_geojson(request.output)) {
    decode_to_lines(request);
    return;
  }
  decode_to_mesh(request);
}

std::string source_of(const Document& document, const std::string& name) {
  if (const DecodedStream* const stream = document.stream()) {
    return embed(stream->bytes, Embedded::kStream,
                 microtin_mesh_vertex_count(stream->terrain.mesh()), name);
  }
  const std::string bytes = read_file(document.path());
  return embed({bytes.begin(), bytes.end()}, Embedded::kPack,
               document.pack()->header().most_vertices, name);
}

// A stream was decoded to be opened; of a pack each tile is. Tiles of a later version are intact.
void expect_intact(const Document& document) {
  if (document.pack() == nullptr) return;
  for (const TileFault& fault : document.pack()->faults()) {
    if (!fault.is_unsupported) throw Error(document.path() + ": " + fault.text);
  }
}

void run_embed(const std::string& input, const std::string& output) {
  refuse_overwriting({input}, output);
  const Document document(input);
  expect_intact(document);
  const std::string name = output == "-" ? "terrain" : fs::u8path(output).stem().string();
  OutputFile out(output);
  out.write(source_of(document, name));
  out.commit();
}

}  // namespace

void add_decode(CLI::App& app, Action& action) {
  auto request = std::make_shared<DecodeRequest>();
  CLI::App& command =
      *app.add_subcommand("decode", "Turn a stream or a pack into a mesh, a grid or lines");
  command.group(kConvert);
  add_stream(command, request->input);
  add_output(
      command, request->output,
      "Write this file. Meshes: .xyz, .obj, .ply, .glb. A grid: .asc. Marked lines: .geojson. "
      "A cell for autopilots: N43E007.DAT, N43E007.TER. - is .xyz on standard output");
  begin_group(command, "Posts of a grid");
  CLI::Option* const cell =
      add_decimal(command, "--cell DISTANCE", request->cell,
                  "Set the distance of posts, in the terrain's unit; in metres for .DAT files")
          ->default_str("the source's posts; for points the lattice's positions");
  add_rectangle(
      command, request->extent,
      "Write the posts in this rectangle of the terrain's coordinates; with --cell they begin "
      "at its south-west corner")
      ->default_str("the whole terrain");
  CLI::Option* const like =
      add_text(command, "--like FILE", request->like, "Write the posts of this raster")
          ->excludes(cell);
  add_indirect(command, request->like_preparation);
  begin_group(command, kOptions);
  command
      .add_flag("--lattice", request->lattice, "Write lattice coordinates, which are whole numbers")
      ->excludes(like);
  command.add_flag(
      "--force", request->force,
      "Write a file that can have more than 1 GB, or a mesh of more than 2^24 vertices");
  command.callback([request, &action] {
    request->like_preparation.band = 1;  // all bands have the same posts
    request->like_preparation.requested.reset();
    if (request->cell && request->cell->mantissa == 0) {
      throw CLI::ValidationError("--cell", "must be above 0");
    }
    action = [request] { run_decode(*request); };
  });
}

void add_embed(CLI::App& app, Action& action) {
  struct Request {
    std::string input, output;
  };
  auto request = std::make_shared<Request>();
  CLI::App& command =
      *app.add_subcommand("embed", "Turn a stream or a pack into a C header for firmware");
  command.group(kConvert);
  add_stream(command, request->input);
  add_output(command, request->output);
  command.footer(
      "X.h defines the array X_stream and X_VERTICES, the capacity of a mesh for it. For a pack it "
      "defines X_pack and X_MOST_VERTICES, the capacity of a slot.");
  command.callback(
      [request, &action] { action = [request] { run_embed(request->input, request->output); }; });
}

}  // namespace microtin::cli
