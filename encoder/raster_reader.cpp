#include "encoder/raster_reader.hpp"

#include <filesystem>
#include <utility>
#include <variant>

#include "encoder/error.hpp"
#include "encoder/import.hpp"
#include "encoder/import_text.hpp"

namespace microtin {
namespace {

Raster frame_of(const Raster& raster) {
  Raster frame;
  frame.width = raster.width;
  frame.height = raster.height;
  frame.decimals = raster.decimals;
  frame.x = raster.x;
  frame.y = raster.y;
  frame.reference = raster.reference;
  return frame;
}

}  // namespace

RasterInMemory::RasterInMemory(Raster raster) : raster_(std::move(raster)) {
  frame_ = frame_of(raster_);
}

std::unique_ptr<RasterReader> open_raster(const std::string& path) {
  const std::string suffix = lower_case(std::filesystem::path(path).extension().string());
  if (suffix == ".hgt") return open_hgt(path, open_file(path));
  if (suffix == ".asc") return open_asc(path, open_file(path));
  Source source = import_terrain(path);
  auto* const raster = std::get_if<Raster>(&source);
  if (raster == nullptr) throw Error(path + ": packs are made of rasters; these are points");
  return std::make_unique<RasterInMemory>(std::move(*raster));
}

}  // namespace microtin
