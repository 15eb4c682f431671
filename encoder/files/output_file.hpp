// SPDX-License-Identifier: MIT
// Output that appears complete or not at all.
#ifndef MICROTIN_ENCODER_FILES_OUTPUT_FILE_HPP
#define MICROTIN_ENCODER_FILES_OUTPUT_FILE_HPP

#include <sys/types.h>

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/files/leftovers.hpp"
#include "encoder/layers.hpp"

namespace microtin::files {

// Standard output is closed, or the pipe that it was has no other end.
struct NobodyReads : Error {
  using Error::Error;
};

// Writes to a temporary beside the target, which takes the target's place on commit() and
// disappears without it, also when a signal ends the program. The target is what a link leads to,
// also if there is nothing yet; a file that was there hands on its mode. "-" is standard output,
// as is /dev/stdout; descriptors, devices and pipes are written directly and keep what they hold.
// All throw Error naming the output.
class OutputFile {
 public:
  explicit OutputFile(const std::string& path);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void write(std::string_view bytes);
  void write(const std::vector<uint8_t>& bytes) {
    write({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  void commit();
  bool is_standard_output() const { return file_ == stdout; }

 private:
  void open_temporary();
  [[noreturn]] void fail() const;

  std::string path_;       // as the user calls it
  std::string target_;     // behind links
  std::string temporary_;  // empty: written directly
  std::optional<Leftover> leftover_;
  std::FILE* file_ = nullptr;
};

// Opens a new file, for reading too if `access` says so, named `name` and the process; another
// number follows where a file has that name, left by a process that was killed. `name` becomes what
// it is called; -1 with errno if there is none.
int open_new(std::string& name, int access, mode_t mode);

// A stream on a descriptor, which it then owns; null with errno if it cannot be, or there is none.
std::FILE* stream_of(int file, const char* mode);

}  // namespace microtin::files

#endif
