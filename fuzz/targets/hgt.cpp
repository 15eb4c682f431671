// SPDX-License-Identifier: MIT
// SRTM tiles. A first byte of 1 makes a whole tile by repeating the rest; else the bytes are taken
// as they are. They begin with the file's name.
#include "fuzz/support/import_target.hpp"

using namespace microtin::tests;

namespace {

constexpr size_t kTileBytes = 2 * 1201 * 1201;

std::string repeated(const std::string& bytes, size_t size) {
  std::string all;
  all.reserve(size + bytes.size());
  while (all.size() < size) all += bytes;
  all.resize(size);
  return all;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size < 2) return 0;
  const bool whole = data[0] == 1;
  const std::string rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string bytes = whole ? repeated(rest, kTileBytes) : rest;
  const auto name_end =
      std::find_if(rest.begin(), rest.end(), [](char c) { return c <= ' ' || c > '~'; });
  const std::string name(rest.begin(), name_end);
  return import_and_encode([&] { return import_hgt(name, bytes); }, Options(data, size));
}
