// SPDX-License-Identifier: MIT
// The calls on files, by the names that POSIX gives them.
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "encoder/files/file_access.hpp"

namespace microtin::files {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kPrivate = 0600, kUsual = 0666, kAllBits = 07777;

bool take_state(int result, const struct stat& status, FileState& state) {
  if (result != 0) return false;
  state.is_regular = S_ISREG(status.st_mode);
  state.size = static_cast<uint64_t>(status.st_size);
  state.volume = static_cast<uint64_t>(status.st_dev);
  state.number = static_cast<uint64_t>(status.st_ino);
  state.owner = status.st_uid;
  state.group = status.st_gid;
  state.mode = status.st_mode & kAllBits;
  return true;
}

}  // namespace

std::FILE* open_stream(const std::string& path, const char* mode) {
  return std::fopen(path.c_str(), mode);
}

int open_to_read(const std::string& path) {
  return open(path.c_str(), O_RDONLY | O_CLOEXEC);
}

int open_to_write(const std::string& path) {
  return open(path.c_str(), O_WRONLY | O_CLOEXEC);
}

int create_file(const std::string& path, NewFile kind) {
  const int access = kind == NewFile::kNameless ? O_RDWR : O_WRONLY;
  const int file = open(path.c_str(), access | O_CREAT | O_EXCL | O_CLOEXEC,
                        kind == NewFile::kUsual ? kUsual : kPrivate);
  if (file >= 0 && kind == NewFile::kNameless) remove_file(path);
  return file;
}

bool examine(int file, FileState& state) {
  struct stat status {};
  return take_state(fstat(file, &status), status, state);
}

bool examine(const std::string& path, FileState& state) {
  struct stat status {};
  return take_state(stat(path.c_str(), &status), status, state);
}

bool lists_descriptors(const fs::path& folder) {
  std::error_code ignored;  // what is not there is not the same
  const fs::path real = fs::canonical(folder, ignored);
  if (real.empty()) return false;
  for (const char* const known : {"/proc/self/fd", "/proc/thread-self/fd", "/dev/fd"}) {
    if (fs::canonical(known, ignored) == real) return true;
  }
  return false;
}

int duplicate(int file) {
  return fcntl(file, F_DUPFD_CLOEXEC, 0);
}

void close_file(int file) {
  close(file);
}

// The owner is taken if the process may give the file away and a container knows the owner. What is
// private was so from the first byte on.
bool take_after(int file, const FileState& old) {
  const bool has_owner = fchown(file, old.owner, old.group) == 0;
  if (!has_owner && errno != EPERM && errno != EINVAL) return false;
  return fchmod(file, static_cast<mode_t>(old.mode)) == 0;
}

int64_t read_at(int file, uint64_t offset, void* to, std::size_t size) {
  for (;;) {
    const ssize_t taken = pread(file, to, size, static_cast<off_t>(offset));
    if (taken >= 0 || errno != EINTR) return taken;
  }
}

bool seek_to(std::FILE* stream, uint64_t offset) {
  return fseeko(stream, static_cast<off_t>(offset), SEEK_SET) == 0;
}

bool replace_file(const std::string& from, const std::string& to) {
  return std::rename(from.c_str(), to.c_str()) == 0;
}

void remove_file(const std::string& path) {
  std::remove(path.c_str());
}

std::FILE* open_temporary_stream() {
  return std::tmpfile();
}

uint64_t process_number() {
  return static_cast<uint64_t>(getpid());
}

}  // namespace microtin::files
