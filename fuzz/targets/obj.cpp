// SPDX-License-Identifier: MIT
// OBJ files.
#include "fuzz/support/import_target.hpp"

using namespace microtin::tests;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  return import_and_encode([&] { return import_obj("mesh.obj", bytes); }, Options(data, size));
}
