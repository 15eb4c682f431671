// SPDX-License-Identifier: MIT
// Reading: whole files, pieces of files that need not fit into memory, and numbers out of them.
#ifndef MICROTIN_ENCODER_FILES_INPUT_HPP
#define MICROTIN_ENCODER_FILES_INPUT_HPP

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/layers.hpp"

namespace microtin::files {

// The bytes of a file, or of standard input for "-". Throws Error naming the file.
std::string read_file(const std::string& path);

// Bytes that are read anywhere, piece by piece: a file that need not fit into memory.

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

// Numbers out of files that may be cut off.

enum class ByteOrder { kLittleEndian, kBigEndian };

class ByteReader {
 public:
  // `name` goes into messages; both must outlive this.
  ByteReader(const std::string& name, std::string_view bytes,
             ByteOrder order = ByteOrder::kLittleEndian)
      : name_(name), bytes_(bytes), order_(order) {}

  uint64_t size() const { return bytes_.size(); }
  [[noreturn]] void fail(const std::string& what) const { throw Error(name_ + ": " + what); }

  // Throws Error if they are not all there.
  std::string_view bytes(uint64_t at, uint64_t count) const {
    if (at > size() || count > size() - at) {
      fail("cut off: has " + std::to_string(size()) + " bytes, but names more");
    }
    return bytes_.substr(static_cast<size_t>(at), static_cast<size_t>(count));
  }

  // An integer or an IEEE number, as many bytes as it has.
  template <class Number>
  Number number(uint64_t at) const {
    const std::string_view piece = bytes(at, sizeof(Number));
    uint64_t bits = 0;
    for (size_t i = 0; i < sizeof(Number); ++i) {
      const size_t place = order_ == ByteOrder::kBigEndian ? i : sizeof(Number) - 1 - i;
      bits = bits << 8 | static_cast<uint8_t>(piece[place]);
    }
    if constexpr (std::is_integral_v<Number>) {
      return static_cast<Number>(bits);
    } else {
      const auto narrow =
          static_cast<std::conditional_t<sizeof(Number) == 4, uint32_t, uint64_t>>(bits);
      Number value;
      static_assert(sizeof narrow == sizeof value);
      std::memcpy(&value, &narrow, sizeof value);
      return value;
    }
  }

 private:
  const std::string& name_;
  std::string_view bytes_;
  ByteOrder order_;
};

}  // namespace microtin::files

#endif
