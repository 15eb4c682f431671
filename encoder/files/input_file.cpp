// SPDX-License-Identifier: MIT
// Reads a file or standard input to its end.
#include "encoder/files/input_file.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <system_error>

#include "encoder/base/error.hpp"

namespace microtin::files {

std::string read_file(const std::string& path) {
  const auto fail = [&path] {
    throw Error(path + ": cannot be read: " + std::generic_category().message(errno));
  };
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(nullptr, &std::fclose);
  if (path != "-") {
    opened.reset(std::fopen(path.c_str(), "rb"));
    if (!opened) fail();
  }
  std::FILE* file = opened ? opened.get() : stdin;
  std::string bytes;
  size_t size = 0, taken = 1;
  while (taken != 0) {
    bytes.resize(size + (size_t{1} << 16) + size / 2);
    taken = std::fread(&bytes[size], 1, bytes.size() - size, file);
    size += taken;
  }
  if (std::ferror(file) != 0) fail();
  bytes.resize(size);
  return bytes;
}

}  // namespace microtin::files
