// SPDX-License-Identifier: MIT
// Lists of points.
#include "fuzz/support/import_target.hpp"

using namespace microtin::tests;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  return import_and_encode([&] { return import_points("points.csv", text); }, Options(data, size));
}
