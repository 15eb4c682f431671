// ESRI ASCII grids.
#include "fuzz/import_fuzz.hpp"

using namespace microtin;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  LatticeOptions options;
  options.max_error = Decimal{static_cast<int64_t>(size % 64), 1};
  return import_and_encode([&] { return import_asc("grid.asc", text); }, options);
}
