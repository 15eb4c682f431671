// SPDX-License-Identifier: MIT
// Writes beside the target and takes its place at the end.
#include "encoder/files/output_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "encoder/files/file_target.hpp"
#include "encoder/files/standard_files.hpp"

namespace microtin::files {
namespace {

constexpr mode_t kPrivate = 0600, kUsual = 0666, kAllBits = 07777;

// Owner, if we may and a container knows it, and mode. What is private was so from the first byte
// on.
bool take_after(int file, const struct stat& old) {
  const bool has_owner = fchown(file, old.st_uid, old.st_gid) == 0;
  if (!has_owner && errno != EPERM && errno != EINVAL) return false;
  return fchmod(file, old.st_mode & kAllBits) == 0;
}

}  // namespace

std::FILE* stream_of(int file, const char* mode) {
  std::FILE* const stream = file < 0 ? nullptr : fdopen(file, mode);
  if (stream == nullptr && file >= 0) {
    const int error = errno;
    close(file);
    errno = error;
  }
  return stream;
}

int open_new(std::string& name, int access, mode_t mode) {
  constexpr int kMostLeftovers = 1000;
  const std::string stem = name + std::to_string(getpid());
  name = stem;
  for (int i = 0;; ++i) {
    const int file = open(name.c_str(), access | O_CREAT | O_EXCL | O_CLOEXEC, mode);
    if (file >= 0 || errno != EEXIST || i == kMostLeftovers) return file;
    name = stem + '-' + std::to_string(i);
  }
}

OutputFile::OutputFile(const std::string& path) : path_(path) {
  if (const std::optional<std::string> target = replaced_by(path)) {
    target_ = *target;
    open_temporary();
    return;
  }
  const std::optional<int> descriptor = descriptor_named(path);
  if (descriptor == STDOUT_FILENO) {
    file_ = stdout;
  } else if (descriptor) {
    file_ = stream_of(fcntl(*descriptor, F_DUPFD_CLOEXEC, 0), "wb");
  } else {
    file_ = stream_of(open(path.c_str(), O_WRONLY | O_CLOEXEC), "wb");
  }
  if (file_ == nullptr) fail();
}

void OutputFile::open_temporary() {
  std::string name = target_ + ".part-";
  struct stat old {};
  const bool replaces = stat(target_.c_str(), &old) == 0;
  const SignalsHeld held;
  const int file = open_new(name, O_WRONLY, replaces ? kPrivate : kUsual);
  if (file < 0) fail();
  file_ = stream_of(file, "wb");
  if (file_ == nullptr || (replaces && !take_after(file, old))) {
    const int error = errno;
    if (file_ != nullptr) std::fclose(file_);
    std::remove(name.c_str());
    errno = error;
    fail();
  }
  temporary_ = std::move(name);  // nothing may throw from here on: the file would stay
  leftover_.emplace(temporary_);
}

OutputFile::~OutputFile() {
  if (file_ != nullptr && file_ != stdout) std::fclose(file_);
  if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void OutputFile::write(std::string_view bytes) {
  if (bytes.empty()) return;  // there may be no data to point at
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail();
}

void OutputFile::commit() {
  if (std::fflush(file_) != 0) fail();
  if (file_ == stdout) return;
  std::FILE* file = file_;
  file_ = nullptr;
  if (std::fclose(file) != 0) fail();
  if (temporary_.empty()) return;
  if (std::rename(temporary_.c_str(), target_.c_str()) != 0) fail();
  leftover_.reset();
  temporary_.clear();
}

void OutputFile::fail() const {
  const int error = errno;
  const std::string text = path_ + ": cannot be written: " + std::generic_category().message(error);
  if (file_ == stdout && nobody_reads(error)) throw NobodyReads(text);
  throw Error(text);
}

}  // namespace microtin::files
