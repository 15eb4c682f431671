// SPDX-License-Identifier: MIT
// Reading: whole files, pieces of files that need not fit into memory, and numbers out of them.
#include "encoder/files/input.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/files/file_access.hpp"

namespace microtin::files {

std::string read_file(const std::string& path) {
  const auto fail = [&path] {
    throw Error(path + ": cannot be read: " + std::generic_category().message(errno));
  };
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(nullptr, &std::fclose);
  if (path != "-") {
    opened.reset(open_stream(path, "rb"));
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

namespace {

class FileBytes : public ByteSource {
 public:
  explicit FileBytes(const std::string& path) : path_(path), file_(open_to_read(path)) {
    if (file_ < 0) fail();
    FileState state;
    const bool is_known = examine(file_, state);
    size_ = state.size;
    if (is_known && state.is_regular) return;
    close_file(file_);
    if (!is_known) fail();
    throw Error(path + ": cannot be read in pieces; copy it into a regular file");
  }
  ~FileBytes() override { close_file(file_); }
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  uint64_t size() const override { return size_; }

  std::size_t read(uint64_t offset, void* to, std::size_t size) const override {
    std::size_t done = 0;
    while (done < size) {
      const int64_t taken =
          read_at(file_, offset + done, static_cast<char*>(to) + done, size - done);
      if (taken < 0) fail();
      if (taken == 0) break;
      done += static_cast<std::size_t>(taken);
    }
    return done;
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(path_ + ": cannot be read: " + std::generic_category().message(errno));
  }

  std::string path_;
  int file_;
  uint64_t size_ = 0;
};

class MemoryBytes : public ByteSource {
 public:
  explicit MemoryBytes(std::vector<uint8_t> bytes) : bytes_(std::move(bytes)) {}

  uint64_t size() const override { return bytes_.size(); }

  std::size_t read(uint64_t offset, void* to, std::size_t size) const override {
    if (offset >= bytes_.size()) return 0;
    const std::size_t taken = std::min<uint64_t>(size, bytes_.size() - offset);
    if (taken != 0) std::memcpy(to, bytes_.data() + offset, taken);
    return taken;
  }

 private:
  std::vector<uint8_t> bytes_;
};

}  // namespace

std::unique_ptr<ByteSource> open_file(const std::string& path) {
  return std::make_unique<FileBytes>(path);
}

bool is_regular_file(const std::string& path) {
  std::error_code ignored;  // what cannot be examined is no such file
  return std::filesystem::is_regular_file(std::filesystem::u8path(path), ignored);
}

std::unique_ptr<ByteSource> bytes_in_memory(std::vector<uint8_t> bytes) {
  return std::make_unique<MemoryBytes>(std::move(bytes));
}

std::vector<uint8_t> bytes_at(const ByteSource& source, uint64_t offset, uint64_t size) {
  const uint64_t all = source.size();
  if (offset > all || size > all - offset) throw Error(describe(MICROTIN_STATUS_TRUNCATED));
  std::vector<uint8_t> bytes(size);
  if (source.read(offset, bytes.data(), size) != size)
    throw Error(describe(MICROTIN_STATUS_TRUNCATED));
  return bytes;
}

}  // namespace microtin::files
