// SPDX-License-Identifier: MIT
// Opening files by GDAL; part of builds with MICROTIN_WITH_GDAL only.
#ifndef MICROTIN_ENCODER_IMPORT_GDAL_DATASET_HPP
#define MICROTIN_ENCODER_IMPORT_GDAL_DATASET_HPP

#include <gdal.h>

#include <memory>
#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/import/import.hpp"
#include "encoder/layers.hpp"

namespace microtin::importing {

struct CloseGdalDataset {
  void operator()(void* dataset) const { GDALClose(dataset); }
};

using GdalDataset = std::unique_ptr<void, CloseGdalDataset>;

enum class GdalKind { kRaster, kVector };

// Opens a file with the drivers of that kind whose files hold their content themselves, and of VRT
// if that is allowed. GDAL's messages are kept from the terminal. Throws Error that does not name
// the file.
GdalDataset open_gdal_dataset(const std::string& path, Indirect indirect, GdalKind kind);

// All files that the dataset is read from.
std::vector<std::string> files_of_dataset(const GdalDataset& dataset);

// All files that the dataset of a file is read from. open() returns it; if that throws Error, these
// are the file alone, and the fault is reported when the file is read.
template <class Open>
std::vector<std::string> files_by_gdal(const std::string& path, const Open& open) {
  try {
    return files_of_dataset(open());
  } catch (const Error&) {
    return {path};
  }
}

}  // namespace microtin::importing

#endif
