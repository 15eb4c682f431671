// SPDX-License-Identifier: MIT
// Files of numbers, made byte by byte.
#ifndef MICROTIN_TESTS_SUPPORT_BINARY_FILE_HPP
#define MICROTIN_TESTS_SUPPORT_BINARY_FILE_HPP

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>

#include "tests/support/layers.hpp"

namespace microtin::tests {

class BinaryFile {
 public:
  explicit BinaryFile(bool big_endian = false) : big_endian_(big_endian) {}

  // An integer or an IEEE number, as many bytes as it has.
  template <class Number>
  BinaryFile& add(Number value) {
    put(bytes_.size(), value);
    return *this;
  }
  BinaryFile& add(const std::string& text) {
    bytes_ += text;
    return *this;
  }

  // At a place; the file grows by zeros if need be. Tests run on little-endian hosts.
  template <class Number>
  BinaryFile& put(size_t at, Number value) {
    std::string piece(sizeof value, '\0');
    std::memcpy(piece.data(), &value, sizeof value);
    if (big_endian_) std::reverse(piece.begin(), piece.end());
    return put(at, piece);
  }
  BinaryFile& put(size_t at, const std::string& piece) {
    if (bytes_.size() < at + piece.size()) bytes_.resize(at + piece.size());
    bytes_.replace(at, piece.size(), piece);
    return *this;
  }

  const std::string& bytes() const { return bytes_; }

 private:
  bool big_endian_;
  std::string bytes_;
};

}  // namespace microtin::tests

#endif
