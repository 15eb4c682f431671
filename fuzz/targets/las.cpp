// SPDX-License-Identifier: MIT
// Laser scans: their default classes or, if the file has an odd number of bytes, all.
#include "fuzz/support/import_target.hpp"

using namespace microtin::tests;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  return import_and_encode(
      [&] {
        return import_las("scan.las", bytes,
                          size % 2 == 1 ? std::optional(ClassSet().set()) : std::nullopt);
      },
      Options(data, size));
}
