// SPDX-License-Identifier: MIT
// The command decode: a mesh or a grid from a stream or a pack.
#include <cstdio>
#include <filesystem>
#include <optional>

#include "encoder/base/error_context.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/export/autopilot.hpp"
#include "encoder/export/export.hpp"
#include "encoder/export/grid.hpp"
#include "encoder/export/system.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/files/output_file.hpp"
#include "encoder/product/document.hpp"

namespace microtin::cli {

namespace {

namespace fs = std::filesystem;

bool is_grid(const std::string& path) {
  return std::filesystem::path(path).extension() == ".asc";
}

// A grid's coordinate system, in a file beside it.
class SystemFile {
 public:
  SystemFile(const std::string& grid, const Metadata& metadata)
      : path_(fs::path(grid).replace_extension(".prj").string()), code_(metadata.horizontal_epsg) {
    const std::string text = system_text(metadata);
    if (!text.empty()) {
      out_.emplace(path_).write(text);
    } else if (std::error_code none; fs::exists(path_, none)) {
      warning_ = warning(path_ + " lies beside the grid, but is not its coordinate system");
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

void decode_to_grid(const DecodeRequest& request) {
  constexpr uint64_t kMostPosts = uint64_t{1} << 26;  // of a stream, without a word on cells
  const Document document(request.input);
  SampledSurface surface = document.sampled();
  if (document.stream() != nullptr && !request.cell && lattice_posts(surface) > kMostPosts) {
    throw Error(request.input + ": has " + std::to_string(lattice_posts(surface)) +
                " places on its lattice: give the size of the grid's cells, --cell");
  }
  if (request.lattice) surface.placement = Placement();
  OutputFile out(request.output);
  export_grid(surface, request.cell, out);
  std::optional<SystemFile> system;
  if (!request.lattice) system.emplace(request.output, document.metadata());
  out.commit();
  if (system) system->commit();
}

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

std::string text_of(const AutopilotFile& file, uint32_t spacing) {
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
  const DegreeCell cell = cell_of(request.output);
  const uint32_t spacing = spacing_of(request, autopilot);
  if (request.lattice) throw Error(request.output + ": has real coordinates, not --lattice");
  const Document document(request.input);
  const Metadata metadata = document.metadata();
  if (metadata.horizontal_unit != Unit::kDegree || metadata.vertical_unit != Unit::kMetre) {
    throw Error(request.input + ": autopilots want places in degrees and heights in metres");
  }
  const AutopilotFile file = with_file_context(
      request.output, [&] { return autopilot_file(document.sampled(), autopilot, cell, spacing); });
  OutputFile out(request.output);
  out.write(file.bytes);
  deliver(out, request.output, text_of(file, spacing));
}

}  // namespace

void run_decode(const DecodeRequest& request) {
  refuse_overwriting({request.input}, request.output);
  if (const auto autopilot = autopilot_of(request.output)) {
    decode_for_autopilot(request, *autopilot);
    return;
  }
  if (is_grid(request.output)) {
    decode_to_grid(request);
    return;
  }
  if (request.cell) throw Error(request.output + ": only grids (.asc, .DAT, .TER) have cells");
  const MeshFormat format = mesh_format_of(request.output);
  const SurfaceModel model = Document(request.input).model();
  if (format == MeshFormat::kGlb && model.triangles.empty()) {
    throw Error(request.input + ": holds no triangle");
  }
  const bool is_real = !request.lattice;
  OutputFile out(request.output);
  export_model(model, format, is_real ? Coordinates::kReal : Coordinates::kLattice, out);
  const bool has_units = format == MeshFormat::kGlb && is_real;
  const std::string of_units = has_units ? warning_of_units(request.output, model) : "";
  out.commit();
  std::fputs(of_units.c_str(), stderr);
}

}  // namespace microtin::cli
