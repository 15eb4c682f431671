// SPDX-License-Identifier: MIT
// A stream or a pack as GDAL sees it: a raster of heights, and layers of vertices and triangles.
#ifndef MICROTIN_ENCODER_GDAL_DATASET_HPP
#define MICROTIN_ENCODER_GDAL_DATASET_HPP

#include <gdal_pam.h>
#include <ogrsf_frmts.h>

#include <memory>
#include <microtin/encoder.hpp>
#include <microtin/surface.hpp>
#include <string>
#include <vector>

namespace microtin::gdal {

// Whether the file begins as a stream or a pack does.
int identify(GDALOpenInfo* info);

class Dataset : public GDALPamDataset {
 public:
  // Null, with an error that GDAL knows, if it cannot be read.
  static GDALDataset* open(GDALOpenInfo* info);

  CPLErr GetGeoTransform(double* transform) override;
  const OGRSpatialReference* GetSpatialRef() const override;
  int GetLayerCount() override { return static_cast<int>(layers_.size()); }
  OGRLayer* GetLayer(int i) override;
  int TestCapability(const char* /*capability*/) override { return FALSE; }

  const encoder::Surface& surface() const { return surface_; }
  const encoder::Grid& grid() const { return grid_; }
  double no_data() const { return no_data_; }

 private:
  explicit Dataset(encoder::Surface surface);
  void describe();
  void read_system();
  void add_raster(const char* cell);
  void add_layers();

  encoder::Surface surface_;
  encoder::Grid grid_;
  double no_data_ = -9999;
  OGRSpatialReference system_;
  std::vector<std::unique_ptr<OGRLayer>> layers_;
};

std::unique_ptr<OGRLayer> vertex_layer(const encoder::Surface& surface,
                                       const OGRSpatialReference& system);
std::unique_ptr<OGRLayer> triangle_layer(const encoder::Surface& surface,
                                         const OGRSpatialReference& system);
// Null: the file has no lines.
std::unique_ptr<OGRLayer> line_layer(const encoder::Surface& surface,
                                     const OGRSpatialReference& system);

// The polygons, lines and points of a dataset as GeoJSON, a feature on each line, numbers to all
// their digits. Curves become lines. `system` is that in which they must be; null: any. Throws
// std::runtime_error, which does not name the file.
std::string geojson_of(GDALDataset& features, const OGRSpatialReference* system);

// Encodes the first band: a pack if the name ends in .mtp, else a stream.
GDALDataset* create_copy(const char* path, GDALDataset* source, int strict, char** options,
                         GDALProgressFunc progress, void* context);

// MAX_ERROR, of the library's option max_error.
inline std::string option_name(const std::string& option) {
  return CPLString(option).toupper();
}

// Runs `work`; what it throws becomes an error of GDAL's, and the result `otherwise`.
template <class Work, class Result>
Result guarded(const Work& work, Result otherwise) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    CPLError(CE_Failure, CPLE_OutOfMemory, "MTIN: out of memory");
  } catch (const std::exception& error) {
    CPLError(CE_Failure, CPLE_AppDefined, "MTIN: %s",
             encoder::message_of(error, option_name).c_str());
  }
  return otherwise;
}

}  // namespace microtin::gdal

#endif
