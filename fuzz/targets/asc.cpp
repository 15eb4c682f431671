// SPDX-License-Identifier: MIT
// ESRI ASCII grids.
#include "fuzz/support/import_target.hpp"

using namespace microtin::tests;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  return import_and_encode([&] { return import_asc("grid.asc", text); }, Options(data, size));
}
