// SPDX-License-Identifier: MIT
// Bytes that are read anywhere, piece by piece: a file that need not fit into memory.
#ifndef MICROTIN_ENCODER_FILES_BYTE_SOURCE_HPP
#define MICROTIN_ENCODER_FILES_BYTE_SOURCE_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "encoder/layers.hpp"

namespace microtin::files {

// Reading from several threads at once is allowed.
class ByteSource {
 public:
  ByteSource() = default;
  ByteSource(const ByteSource&) = delete;
  ByteSource& operator=(const ByteSource&) = delete;
  virtual ~ByteSource() = default;

  virtual uint64_t size() const = 0;

  // Up to `size` bytes from an offset on: fewer only at the end. Throws Error.
  virtual std::size_t read(uint64_t offset, void* to, std::size_t size) const = 0;
};

// A regular file. Throws Error naming it if it cannot be read, or is a pipe or device.
std::unique_ptr<ByteSource> open_file(const std::string& path);

// Whether open_file can open what is there.
bool is_regular_file(const std::string& path);

std::unique_ptr<ByteSource> bytes_in_memory(std::vector<uint8_t> bytes);

// `size` bytes from an offset on. Throws Error if they end before.
std::vector<uint8_t> bytes_at(const ByteSource& source, uint64_t offset, uint64_t size);

}  // namespace microtin::files

#endif
