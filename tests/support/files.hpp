// SPDX-License-Identifier: MIT
// Whole files.
#ifndef MICROTIN_TESTS_SUPPORT_FILES_HPP
#define MICROTIN_TESTS_SUPPORT_FILES_HPP

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/layers.hpp"

namespace microtin::tests {

// The bytes; none of a file that is not there.
inline std::vector<uint8_t> bytes_of_file(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_file(const std::string& path, const std::vector<uint8_t>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

}  // namespace microtin::tests

#endif
