// SPDX-License-Identifier: MIT
// Reading: whole files, pieces of files that need not fit into memory, and numbers out of them.
#include "encoder/files/input.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
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

[[noreturn]] void fail(const std::string& path) {
  throw Error(path + ": cannot be read: " + std::generic_category().message(errno));
}

// A file that is open for reading.
class OpenFile {
 public:
  explicit OpenFile(const std::string& path) : file_(open_to_read(path)) {
    if (file_ < 0) fail(path);
    if (examine(file_, state_)) return;
    const int reason = errno;
    close_file(file_);
    errno = reason;
    fail(path);
  }
  ~OpenFile() { close_file(file_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  int descriptor() const { return file_; }
  const FileState& state() const { return state_; }

 private:
  int file_;
  FileState state_;
};

using SharedFile = std::shared_ptr<const OpenFile>;

// Files that are read in pieces. A terrain of many cells may consist of more files than a process
// may have open, so at most kMostOpen are: the one that was not read for longest is closed, and
// opened again when it is read.
class FilePool {
 public:
  // A file of the pool. Its members change under the pool's lock alone.
  struct Member {
    SharedFile file;  // null: closed
    std::list<Member*>::iterator place;
  };

  static FilePool& instance() {
    static FilePool& pool = *new FilePool;  // outlives every file
    return pool;
  }

  // Returns the open file of a member, which `open` opens if it is closed.
  template <class Open>
  SharedFile take(Member& member, const Open& open) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (member.file) {
      open_.splice(open_.begin(), open_, member.place);
      return member.file;
    }
    if (open_.size() == kMostOpen) {
      open_.back()->file.reset();  // who reads it now keeps it open
      open_.pop_back();
    }
    SharedFile file = open();
    open_.push_front(&member);
    member.place = open_.begin();
    member.file = file;
    return file;
  }

  void remove(Member& member) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (member.file) open_.erase(member.place);
  }

 private:
  static constexpr size_t kMostOpen = 128;  // systems allow a process 256 or more

  std::mutex mutex_;
  std::list<Member*> open_;  // the one that was read last comes first
};

class FileBytes : public ByteSource {
 public:
  explicit FileBytes(const std::string& path) : path_(path) {
    const SharedFile file =
        FilePool::instance().take(member_, [&] { return std::make_shared<const OpenFile>(path); });
    state_ = file->state();
    if (state_.is_regular) return;
    FilePool::instance().remove(member_);
    throw Error(path + ": cannot be read in pieces; copy it into a regular file");
  }
  ~FileBytes() override { FilePool::instance().remove(member_); }
  FileBytes(const FileBytes&) = delete;
  FileBytes& operator=(const FileBytes&) = delete;

  uint64_t size() const override { return state_.size; }

  std::size_t read(uint64_t offset, void* to, std::size_t size) const override {
    const SharedFile file = FilePool::instance().take(member_, [this] { return open_again(); });
    std::size_t done = 0;
    while (done < size) {
      const int64_t taken =
          read_at(file->descriptor(), offset + done, static_cast<char*>(to) + done, size - done);
      if (taken < 0) fail(path_);
      if (taken == 0) break;
      done += static_cast<std::size_t>(taken);
    }
    return done;
  }

 private:
  SharedFile open_again() const {
    auto file = std::make_shared<const OpenFile>(path_);
    const FileState& now = file->state();
    if (now.size != state_.size || now.volume != state_.volume || now.number != state_.number) {
      throw Error(path_ +
                  ": became another file while it was read; start again when it is complete");
    }
    return file;
  }

  std::string path_;
  FileState state_;
  mutable FilePool::Member member_;
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
