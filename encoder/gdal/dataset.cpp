// SPDX-License-Identifier: MIT
// Opens streams and packs, and answers for their raster block by block.
#include "encoder/gdal/dataset.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace microtin::gdal {
namespace {

using encoder::Grid;
using encoder::Surface;
using encoder::SurfaceInfo;
using encoder::Unit;

// A file of any of GDAL's file systems.
class VsiBytes : public encoder::ByteSource {
 public:
  explicit VsiBytes(const char* path) : file_(VSIFOpenL(path, "rb")) {
    if (file_ == nullptr) throw std::runtime_error(std::string(path) + ": cannot be opened");
    if (VSIFSeekL(file_, 0, SEEK_END) == 0) size_ = VSIFTellL(file_);
  }
  ~VsiBytes() override { VSIFCloseL(file_); }
  VsiBytes(const VsiBytes&) = delete;
  VsiBytes& operator=(const VsiBytes&) = delete;

  uint64_t size() const override { return size_; }
  size_t read(uint64_t offset, void* to, size_t size) const override {
    if (VSIFSeekL(file_, offset, SEEK_SET) != 0) throw std::runtime_error("cannot be read");
    return VSIFReadL(to, 1, size, file_);
  }

 private:
  VSILFILE* file_;
  uint64_t size_ = 0;
};

const char* symbol_of(Unit unit) {
  constexpr const char* kSymbols[] = {"", "m", "", "ft", "us-ft"};
  return kSymbols[static_cast<size_t>(unit)];
}

// One, two or five times a power of ten: at most half of what lies between vertices.
std::string cell_of(const SurfaceInfo& info) {
  const double area = (info.box.east - info.box.west) * (info.box.north - info.box.south);
  const double wanted = std::sqrt(area / static_cast<double>(info.vertices)) / 2;
  if (!(wanted > 1e-9 && wanted < 1e9)) throw std::runtime_error("CELL_SIZE must be given");
  const double power = std::pow(10, std::floor(std::log10(wanted)));
  const double digit = wanted / power >= 5 ? 5 : wanted / power >= 2 ? 2 : 1;
  return CPLSPrintf("%.9f", digit * power);
}

// Every 2^level-th of what the grid has, at the middle of the cells that it stands for.
Grid coarser(const Grid& grid, int level) {
  const uint64_t factor = uint64_t{1} << level;
  const auto axis = [&](const microtin_axis& fine) {
    // offset + numerator * (factor * k + (factor - 1) / 2), all times two
    microtin_axis coarse = fine;
    coarse.offset = 2 * fine.offset + static_cast<int64_t>(fine.numerator * (factor - 1));
    coarse.numerator = 2 * fine.numerator * factor;
    coarse.denominator = 2 * fine.denominator;
    return coarse;
  };
  const auto count = [&](uint32_t fine) {
    return static_cast<uint32_t>((fine + factor - 1) / factor);
  };
  return {count(grid.columns), count(grid.rows), axis(grid.x), axis(grid.y)};
}

class Band : public GDALPamRasterBand {
 public:
  Band(Dataset* dataset, int number, int level)
      : dataset_(dataset), level_(level), grid_(coarser(dataset->grid(), level)) {
    constexpr uint32_t kBlock = 256;
    poDS = dataset;
    nBand = number;
    nRasterXSize = static_cast<int>(grid_.columns);
    nRasterYSize = static_cast<int>(grid_.rows);
    eDataType = GDT_Float64;
    nBlockXSize = static_cast<int>(std::min(kBlock, grid_.columns));
    nBlockYSize = static_cast<int>(std::min(kBlock, grid_.rows));
  }

  // Coarser rasters, down to one block.
  void add_overviews() {
    constexpr int kMost = 16;
    Grid coarse = grid_;
    for (int level = 1; level <= kMost && std::max(coarse.columns, coarse.rows) > 256; ++level) {
      coarse = coarser(grid_, level);
      overviews_.push_back(std::make_unique<Band>(dataset_, 0, level));
    }
  }

  int GetOverviewCount() override { return static_cast<int>(overviews_.size()); }
  GDALRasterBand* GetOverview(int i) override {
    return i >= 0 && i < GetOverviewCount() ? overviews_[static_cast<size_t>(i)].get() : nullptr;
  }

  double GetNoDataValue(int* given) override {
    if (given != nullptr) *given = TRUE;
    return dataset_->no_data();
  }
  const char* GetUnitType() override { return symbol_of(dataset_->surface().info().vertical_unit); }

  CPLErr IReadBlock(int block_x, int block_y, void* to) override {
    return guarded([&] { return read_block(block_x, block_y, static_cast<double*>(to)); },
                   CE_Failure);
  }

 private:
  CPLErr read_block(int block_x, int block_y, double* to) {
    // Rows of the block from the north; those of the grid count from the south.
    const int64_t north = int64_t{grid_.rows} - 1 - int64_t{block_y} * nBlockYSize;
    // The northernmost posts of coarser rasters keep their place: rows count from the north.
    const Surface::Rectangle rectangle{int64_t{block_x} * nBlockXSize, north - nBlockYSize + 1,
                                       static_cast<uint32_t>(nBlockXSize),
                                       static_cast<uint32_t>(nBlockYSize)};
    dataset_->surface().heights(from_north(), rectangle, to);
    const size_t count = size_t{rectangle.columns} * rectangle.rows;
    std::replace_if(
        to, to + count, [](double height) { return std::isnan(height); }, dataset_->no_data());
    return CE_None;
  }

  // The grid moved so that its northern edge is that of the finest.
  Grid from_north() const {
    Grid moved = grid_;
    const int64_t factor = int64_t{1} << level_;
    const int64_t beyond = int64_t{grid_.rows} * factor - dataset_->grid().rows;
    moved.y.offset -= beyond * 2 * static_cast<int64_t>(dataset_->grid().y.numerator);
    return moved;
  }

  Dataset* dataset_;
  int level_;
  Grid grid_;
  std::vector<std::unique_ptr<Band>> overviews_;
};

// GDAL's texts are UTF-8.
std::string valid_text(const std::string& text) {
  if (CPLIsUTF8(text.c_str(), -1) != 0) return text;
  const std::unique_ptr<char, decltype(&CPLFree)> ascii(CPLForceToASCII(text.c_str(), -1, '?'),
                                                        CPLFree);
  return ascii.get();
}

std::string name_of_system(const SurfaceInfo& info) {
  if (info.horizontal_epsg == 0) return "a text";
  const std::string name = "EPSG " + std::to_string(info.horizontal_epsg);
  return info.vertical_epsg != 0 ? name + ':' + std::to_string(info.vertical_epsg) : name;
}

}  // namespace

int identify(GDALOpenInfo* info) {
  if (info->nHeaderBytes < 8) return FALSE;
  const uint8_t* const bytes = info->pabyHeader;
  if (std::memcmp(bytes, "mtsh", 4) == 0) return TRUE;  // a shard, which opening names as such
  const uint8_t* note = nullptr;
  uint32_t size = 0;
  return microtin_find_note(bytes, static_cast<size_t>(info->nHeaderBytes), 0, &note, &size) !=
         MICROTIN_STATUS_BAD_MAGIC;
}

GDALDataset* Dataset::open(GDALOpenInfo* info) {
  if (identify(info) == FALSE || info->fpL == nullptr) return nullptr;
  if (info->eAccess == GA_Update) {
    // Programs that try this first, as ogrinfo and QGIS do, go on to read and want no error.
    if ((info->nOpenFlags & GDAL_OF_VERBOSE_ERROR) != 0) {
      CPLError(CE_Failure, CPLE_NotSupported, "MTIN: files are not updated; translate them");
    }
    return nullptr;
  }
  return guarded(
      [&]() -> GDALDataset* {
        std::unique_ptr<Dataset> dataset(new Dataset(
            Surface::from_bytes(std::make_unique<VsiBytes>(info->pszFilename), info->pszFilename)));
        dataset->describe();
        dataset->read_system();
        const char* const cell = CSLFetchNameValue(info->papszOpenOptions, "CELL_SIZE");
        if ((info->nOpenFlags & GDAL_OF_RASTER) != 0) dataset->add_raster(cell);
        if ((info->nOpenFlags & GDAL_OF_VECTOR) != 0) dataset->add_layers();
        dataset->SetDescription(info->pszFilename);
        dataset->TryLoadXML();
        return dataset.release();
      },
      static_cast<GDALDataset*>(nullptr));
}

Dataset::Dataset(Surface surface) : surface_(std::move(surface)) {
  nRasterXSize = nRasterYSize = 0;
  system_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
}

// Vertices, bytes and largest error after each, in that order.
std::string text_of(const std::vector<encoder::Phase>& phases) {
  std::string text;
  for (const encoder::Phase& phase : phases) {
    const std::string separator = text.empty() ? "" : "; ";
    text += separator + std::to_string(phase.vertices) + ' ' + std::to_string(phase.bytes);
    if (!phase.max_error.empty()) text += ' ' + phase.max_error;
  }
  return text;
}

// Texts of the header as metadata.
void Dataset::describe() {
  const SurfaceInfo& info = surface_.info();
  const bool is_known = info.surface != encoder::SurfaceKind::kUnknown;
  const std::pair<const char*, std::string> items[] = {
      {GDALMD_AREA_OR_POINT, GDALMD_AOP_POINT},
      {"VERTICES", std::to_string(info.vertices)},
      {"TILES", info.is_pack ? CPLSPrintf("%u x %u", info.tile_columns, info.tile_rows) : ""},
      {"MAX_ERROR_ASKED", info.bound},
      {"MAX_ERROR", info.max_error},
      {"MAX_ERROR_AT_POINTS", info.max_error_at_points},
      {"RMS_ERROR", info.rms_error},
      {"SURFACE", is_known ? encoder::name_of(info.surface) : ""},
      {"SIDE", encoder::name_of(info.side)},
      {"MAX_BELOW", info.max_below},
      {"MAX_ABOVE", info.max_above},
      {"MAX_BELOW_EVERYWHERE", info.max_below_everywhere},
      {"MAX_ABOVE_EVERYWHERE", info.max_above_everywhere},
      {"LEAST_BOUND", info.least_bound},
      {"LARGEST_BOUND", info.largest_bound},
      {"MAX_BOUND_RATIO", info.max_bound_ratio},
      {"SOURCE", valid_text(info.source_name)},
      {"DATE", valid_text(info.date)},
      {"LINEAGE", valid_text(info.lineage)},
      {"ATTRIBUTION", valid_text(info.attribution)},
      {"TIFFTAG_COPYRIGHT", valid_text(info.attribution)},  // which GeoTIFF files keep
      {"LICENSE", valid_text(info.license)},
      {"VALID", valid_text(info.valid)},
      {"COORDINATE_EPOCH", info.epoch},
      {"SOURCE_ACCURACY", info.source_accuracy},
      {"DIGEST", info.digest},
      {"PHASES", text_of(info.phases)},
  };
  for (const auto& [name, value] : items) {
    if (!value.empty()) GDALPamDataset::SetMetadataItem(name, value.c_str());
  }
}

// Warns of a code or a text that PROJ does not know, and reads the data all the same.
void Dataset::read_system() {
  const SurfaceInfo& info = surface_.info();
  OGRErr error = OGRERR_NONE;
  if (info.horizontal_epsg != 0) {
    error = system_.importFromEPSG(static_cast<int>(info.horizontal_epsg));
  } else if (!info.wkt.empty()) {
    error = system_.importFromWkt(info.wkt.c_str());
  }
  OGRSpatialReference heights;
  if (error == OGRERR_NONE && info.vertical_epsg != 0 && !system_.IsEmpty()) {
    error = heights.importFromEPSG(static_cast<int>(info.vertical_epsg));
    const OGRSpatialReference places = system_;
    if (error == OGRERR_NONE) {
      const std::string name =
          std::string(places.GetName()) + " + " + std::string(heights.GetName());
      error = system_.SetCompoundCS(name.c_str(), &places, &heights);
    }
  }
  if (error != OGRERR_NONE) {
    CPLError(CE_Warning, CPLE_AppDefined,
             "MTIN: the coordinate system, %s, is not understood: assign one with -a_srs",
             name_of_system(info).c_str());
  }
  if (!info.epoch.empty()) system_.SetCoordinateEpoch(CPLAtof(info.epoch.c_str()));
  system_.SetAxisMappingStrategy(OAMS_TRADITIONAL_GIS_ORDER);
}

void Dataset::add_raster(const char* cell) {
  const SurfaceInfo& info = surface_.info();
  grid_ = info.source;
  if (cell != nullptr || grid_.columns == 0) {
    grid_ = surface_.grid(cell != nullptr ? std::string(cell) : cell_of(info));
  }
  constexpr uint32_t kMost = 0x7FFFFFFF;
  constexpr int64_t kFurthest = int64_t{1} << 60;  // so that doubling and adding stay in 64 bits
  const auto is_near = [](int64_t offset) { return offset > -kFurthest && offset < kFurthest; };
  if (grid_.columns > kMost || grid_.rows > kMost || !is_near(grid_.x.offset) ||
      !is_near(grid_.y.offset)) {
    throw std::runtime_error("the grid has more than 2^31 columns or rows, or lies too far away");
  }
  while (info.lowest <= no_data_) no_data_ = 10 * no_data_ - 9;
  nRasterXSize = static_cast<int>(grid_.columns);
  nRasterYSize = static_cast<int>(grid_.rows);
  auto band = std::make_unique<Band>(this, 1, 0);
  band->add_overviews();
  SetBand(1, band.release());
}

void Dataset::add_layers() {
  layers_.push_back(vertex_layer(surface_, system_));
  layers_.push_back(triangle_layer(surface_, system_));
  if (auto lines = line_layer(surface_, system_)) layers_.push_back(std::move(lines));
}

OGRLayer* Dataset::GetLayer(int i) {
  return i >= 0 && i < GetLayerCount() ? layers_[static_cast<size_t>(i)].get() : nullptr;
}

// Posts are the centres of cells.
CPLErr Dataset::GetGeoTransform(double* transform) {
  if (grid_.columns == 0) return CE_Failure;
  const Grid half = coarser(grid_, 0);  // twice the denominator
  const auto half_step = [](const microtin_axis& axis) {
    return static_cast<int64_t>(axis.numerator / 2);
  };
  const auto at = [&](const microtin_axis& axis, int64_t k, int64_t halves) {
    microtin_axis moved = axis;
    moved.offset += halves * half_step(axis);
    return encoder::coordinate(moved, k);
  };
  const auto step = [](const microtin_axis& axis) {
    return static_cast<double>(axis.numerator) / static_cast<double>(axis.denominator);
  };
  transform[0] = at(half.x, 0, -1);
  transform[1] = step(half.x);
  transform[2] = 0;
  transform[3] = at(half.y, int64_t{grid_.rows} - 1, 1);
  transform[4] = 0;
  transform[5] = -step(half.y);
  return CE_None;
}

const OGRSpatialReference* Dataset::GetSpatialRef() const {
  return system_.IsEmpty() ? nullptr : &system_;
}

}  // namespace microtin::gdal
