// SPDX-License-Identifier: MIT
// Versions of the library and of the formats, as their headers define them.
#include "encoder/cli/version.hpp"

#include "microtin/encoder.h"
#include "shared/format.hpp"
#include "shared/pack_format.hpp"

namespace microtin::cli {

std::string library_version() {
  return microtin_version_string();
}

std::string versions() {
  return "microtin " + library_version() + "\nstream format " + std::to_string(kVersion) +
         "\npack format " + std::to_string(kPackVersion);
}

}  // namespace microtin::cli
