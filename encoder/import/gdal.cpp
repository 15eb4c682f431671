// SPDX-License-Identifier: MIT
// Whatever GDAL opens; part of builds with MICROTIN_WITH_GDAL only.
#include <cpl_error.h>
#include <cpl_vsi.h>
#include <gdal.h>
#include <ogr_srs_api.h>

#include <algorithm>
#include <array>

#include "encoder/base/error.hpp"
#include "encoder/exact/decimal.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/import/crs.hpp"
#include "encoder/import/gdal_dataset.hpp"
#include "encoder/import/import.hpp"
#include "encoder/import/raster.hpp"
#include "encoder/import/reference.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {
namespace {

GdalDataset open(const std::string& path, Indirect indirect) {
  GdalDataset dataset = open_gdal_dataset(path, indirect, GdalKind::kRaster);
  if (GDALGetRasterCount(dataset.get()) == 0)
    throw Error("has no raster band; name a file of heights");
  return dataset;
}

// What the file states about itself.
SourceNotes notes_of(GDALDatasetH dataset, std::vector<std::string>& warnings) {
  const auto item = [dataset](const char* name) {
    const char* const value = GDALGetMetadataItem(dataset, name, nullptr);
    return std::string(value != nullptr ? value : "");
  };
  SourceNotes notes = notes_of_items(item, warnings);
  const OGRSpatialReferenceH system = GDALGetSpatialRef(dataset);
  const double epoch = system != nullptr ? OSRGetCoordinateEpoch(system) : 0;
  if (epoch > 0) notes.epoch = shortest_decimal(epoch);
  return notes;
}

// Whether the first row is the northernmost.
enum class FirstRow { kNorth, kSouth };

FirstRow place(GDALDatasetH dataset, Raster& raster) {
  std::array<double, 6> t{};  // x0, dx by column, dx by row, y0, dy by column, dy by row
  if (GDALGetGeoTransform(dataset, t.data()) != CE_None) {
    throw Error("has no position: add it with \"gdal_translate -a_ullr WEST NORTH EAST SOUTH\"");
  }
  if (!runs_east(t)) {
    throw Error("its rows do not run from west to east: bring them there with gdalwarp");
  }
  raster.x = axis_of_cells_from(t[0], t[1], raster.width);
  raster.y = axis_of_cells_from(t[3], t[5], raster.height);
  return t[5] < 0 ? FirstRow::kNorth : FirstRow::kSouth;
}

// Bands of heights: not those that say how opaque others are.
GDALRasterBandH band_of(GDALDatasetH dataset, uint32_t number) {
  const int count = GDALGetRasterCount(dataset);
  if (number > static_cast<uint32_t>(count)) {
    throw Error("has no band " + std::to_string(number) + "; its last is " + std::to_string(count));
  }
  if (number != 0) return GDALGetRasterBand(dataset, static_cast<int>(number));
  std::vector<int> bands;
  for (int i = 1; i <= count; ++i) {
    const GDALRasterBandH band = GDALGetRasterBand(dataset, i);
    if (GDALGetRasterColorInterpretation(band) != GCI_AlphaBand) bands.push_back(i);
  }
  if (bands.size() > 1) {
    throw Error("has " + std::to_string(bands.size()) + " bands: choose the band of heights by " +
                parameter("band"));
  }
  return GDALGetRasterBand(dataset, bands.empty() ? 1 : bands[0]);
}

// GDAL's own view of voids: a mask of the file, or one made of the no-data value. Null: none.
GDALRasterBandH mask_of(GDALRasterBandH band) {
  return (GDALGetMaskFlags(band) & GMF_ALL_VALID) == 0 ? GDALGetMaskBand(band) : nullptr;
}

// Up to GDAL 3.6 such bytes have a mark instead of a type.
bool is_signed_byte(GDALRasterBandH band) {
  const char* const type = GDALGetMetadataItem(band, "PIXELTYPE", "IMAGE_STRUCTURE");
  return type != nullptr && EQUAL(type, "SIGNEDBYTE");
}

// Reads a band's heights one row after the other.
class BandReader {
 public:
  explicit BandReader(GDALRasterBandH band)
      : band_(band),
        mask_band_(mask_of(band)),
        type_(GDALGetRasterDataType(band)),
        row_(width()),
        mask_(width(), 255) {
    int given = 0;
    const double no_data = GDALGetRasterNoDataValue(band, &given);
    if (given != 0) no_data_ = NoData(no_data);  // if the file has a mask, GDAL passes it over
    const double scale = GDALGetRasterScale(band, &given);
    const double factor = given != 0 ? scale : 1;
    const double offset = GDALGetRasterOffset(band, &given);
    const double shift = given != 0 ? offset : 0;
    scaled_ = ScaledIntegers::from(factor, shift);
    const bool is_whole = type_ == GDT_Byte || type_ == GDT_Int16 || type_ == GDT_UInt16 ||
                          type_ == GDT_Int32 || type_ == GDT_UInt32;
    const bool is_binary = type_ == GDT_Float32 || type_ == GDT_Float64;
    if (!is_whole && !is_binary) {
      throw Error(std::string("its heights are of type ") + GDALGetDataTypeName(type_) +
                  ": translate them with \"gdal_translate -ot Float64\"");
    }
    if (is_signed_byte(band)) {
      throw Error(
          "its heights are signed bytes, which GDAL reads as unsigned: convert them to Int16 with "
          "gdal_calc.py, by numpy.int16(numpy.int8(A))");
    }
    if (!scaled_ || (is_binary && (factor != 1 || shift != 0))) {
      throw Error(
          "its heights have a scale or an offset: apply them with \"gdal_translate -unscale\"");
    }
    if (is_binary) scaled_.reset();
  }

  size_t width() const { return static_cast<size_t>(GDALGetRasterBandXSize(band_)); }
  size_t height() const { return static_cast<size_t>(GDALGetRasterBandYSize(band_)); }

  // Appends a row, row 0 the file's first.
  void read(size_t row, DecimalColumn& heights) {
    read_row(band_, row, row_.data(), GDT_Float64);
    if (mask_band_ != nullptr) read_row(mask_band_, row, mask_.data(), GDT_Byte);
    for (size_t column = 0; column < row_.size(); ++column) {
      const double value = row_[column];
      const bool is_void = mask_[column] == 0 || is_no_data(value);
      const std::optional<Decimal> height = is_void ? std::nullopt : decimal(value);
      if (is_void) {
        heights.add_void();
      } else if (!height || !heights.add(*height)) {
        throw Error("row " + std::to_string(row) + ", column " + std::to_string(column) + ": " +
                    not_a_height(value));
      }
    }
  }

 private:
  void read_row(GDALRasterBandH band, size_t row, void* values, GDALDataType type) const {
    const int columns = static_cast<int>(width());
    if (GDALRasterIO(band, GF_Read, 0, static_cast<int>(row), columns, 1, values, columns, 1, type,
                     0, 0) != CE_None) {
      throw Error(std::string("cannot be read: ") + CPLGetLastErrorMsg());
    }
  }

  bool is_no_data(double value) const {
    return type_ == GDT_Float32 ? no_data_.marks(static_cast<float>(value)) : no_data_.marks(value);
  }

  std::optional<Decimal> decimal(double value) const {
    if (scaled_) return (*scaled_)(static_cast<int64_t>(value));
    return type_ == GDT_Float32 ? shortest_decimal(static_cast<float>(value))
                                : shortest_decimal(value);
  }

  GDALRasterBandH band_, mask_band_;  // null: there is no mask
  GDALDataType type_;
  std::vector<double> row_;
  std::vector<uint8_t> mask_;             // of the row; 0: void
  std::optional<ScaledIntegers> scaled_;  // for integers
  NoData no_data_;
};

uint64_t bytes_of(const GdalDataset& dataset) {
  uint64_t bytes = 0;
  for (const std::string& file : files_of_dataset(dataset)) {
    VSIStatBufL status;
    if (VSIStatL(file.c_str(), &status) == 0) bytes += static_cast<uint64_t>(status.st_size);
  }
  return bytes;
}

// GDAL reads a block at a time, which a header may claim to be larger than the raster.
void expect_held(const GdalDataset& dataset, GDALRasterBandH band) {
  const auto columns = static_cast<uint64_t>(GDALGetRasterBandXSize(band));
  const auto rows = static_cast<uint64_t>(GDALGetRasterBandYSize(band));
  const uint64_t bytes = bytes_of(dataset);
  int width = 0, height = 0;
  GDALGetBlockSize(band, &width, &height);
  if (can_hold(bytes, std::max<uint64_t>(columns, static_cast<uint64_t>(width)),
               std::max<uint64_t>(rows, static_cast<uint64_t>(height)))) {
    return;
  }
  throw Error(
      "its " + std::to_string(bytes) + " bytes cannot hold " + std::to_string(columns) + " x " +
      std::to_string(rows) +
      " posts: cut out those that it has with \"gdal_translate -projwin WEST NORTH EAST SOUTH\"");
}

Raster read(const std::string& path, Indirect indirect, uint32_t number) {
  const GdalDataset dataset = open(path, indirect);
  const GDALRasterBandH band = band_of(dataset.get(), number);
  expect_held(dataset, band);
  BandReader reader(band);
  Raster raster;
  raster.width = static_cast<uint32_t>(reader.width());
  raster.height = static_cast<uint32_t>(reader.height());
  const FirstRow first = place(dataset.get(), raster);
  if (const char* wkt = GDALGetProjectionRef(dataset.get()))
    raster.reference = reference_of_wkt(wkt);
  state_vertical_unit(unit_named(GDALGetRasterUnitType(band)), raster.reference);
  raster.reference.notes = notes_of(dataset.get(), raster.reference.warnings);
  DecimalColumn heights;
  heights.reserve(reader.width() * reader.height());
  for (size_t row = 0; row < reader.height(); ++row) {
    reader.read(first == FirstRow::kSouth ? row : reader.height() - 1 - row, heights);
  }
  raster.decimals = heights.decimals();
  raster.heights = std::move(heights.mantissas());
  return raster;
}

}  // namespace

Raster import_gdal(const std::string& path, Indirect indirect, uint32_t band) {
  return with_file_context(path, [&] { return read(path, indirect, band); });
}

std::vector<std::string> gdal_files(const std::string& path, Indirect indirect) {
  return files_by_gdal(path, [&] { return open(path, indirect); });
}

}  // namespace microtin::importing
