// SPDX-License-Identifier: MIT
// Chooses the posts of a grid, and writes its coordinate system to a file next to it.
#include <cstdio>
#include <filesystem>
#include <optional>

#include "encoder/base/error.hpp"
#include "encoder/cli/commands.hpp"
#include "encoder/cli/report.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/export/grid.hpp"
#include "encoder/export/system.hpp"
#include "encoder/files/output.hpp"
#include "encoder/product/document.hpp"

namespace microtin::cli {
namespace {

namespace fs = std::filesystem;

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

// A grid in another system would have heights of other places.
void expect_same_system(const std::string& path, const Reference& grid, const Metadata& terrain) {
  const Unit there = grid.horizontal_unit, here = terrain.horizontal_unit;
  if (there != here && there != Unit::kUnknown && here != Unit::kUnknown) {
    throw Error(path + ": its x and y are in the unit " + std::string(name_of(there)) +
                ", and those of the terrain in " + std::string(name_of(here)));
  }
  const uint32_t code = grid.horizontal_epsg, own = terrain.horizontal_epsg;
  if (code != own && code != 0 && own != 0) {
    throw Error(path + ": is in EPSG:" + std::to_string(code) +
                ", the terrain in EPSG:" + std::to_string(own));
  }
}

PostGrid grid_of_file(const DecodeRequest& request, const Metadata& terrain) {
  const OpenSource source = prepared_source(request.like, request.like_preparation);
  const auto* raster = std::get_if<std::unique_ptr<RasterReader>>(&source);
  if (raster == nullptr) {
    throw Error(request.like + ": has points, and no posts; set their distance by --cell");
  }
  expect_same_system(request.like, (*raster)->frame().reference, terrain);
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

}  // namespace

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

}  // namespace microtin::cli
