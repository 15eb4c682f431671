// SPDX-License-Identifier: MIT
// Output that appears complete or not at all, what its name leads to, and streams that wait for it.
#ifndef MICROTIN_ENCODER_FILES_OUTPUT_HPP
#define MICROTIN_ENCODER_FILES_OUTPUT_HPP

#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/files/file_access.hpp"
#include "encoder/files/process.hpp"
#include "encoder/layers.hpp"

namespace microtin::files {

// The descriptor of this process that is meant by a name such as /dev/stdout, /dev/fd/3 or
// /proc/self/fd/1, or by a link to one; 1 for "-". Nothing for other names. Throws Error if links
// lead round in a circle.
std::optional<int> descriptor_named(const std::string& path);

// The file whose place an output of this name takes: the name behind all links, also where there
// is no file yet. Nothing if it is a descriptor, a device or a pipe, which are written directly.
// Throws Error for folders, too.
std::optional<std::string> replaced_by(const std::string& path);

// Throws Error if the output, or standard output, which takes reports, is the file of one of the
// inputs by whatever name. "-" is standard input or output.
void refuse_overwriting(const std::vector<std::string>& inputs, const std::string& output);

// Output that appears complete or not at all.

// Standard output is closed, or the pipe that it was has no other end.
struct NobodyReads : Error {
  using Error::Error;
};

// Writes to a temporary next to the target, which takes the target's place on commit() and
// disappears without it, also when a signal ends the program. The target is what a link leads to,
// also if there is nothing yet; a file that was there hands on its mode. (On Windows the target is
// the link, and the folder decides who may read.) "-" is standard output,
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

// Opens a new file, named `name` and the process; another number follows where a file has that
// name, left by a process that was killed. `name` becomes what it is called; -1 with errno if there
// is none.
int open_new(std::string& name, NewFile kind);

// A stream on a descriptor, which it then owns; null with errno if it cannot be, or there is none.
std::FILE* stream_of(int file, const char* mode);

// Where streams lie that are written one after the other, equal ones once.
class StreamPlaces {
 public:
  // Whether the bytes at an offset are those of the stream.
  using IsAt = std::function<bool(uint64_t offset)>;

  // The offset of an equal stream, or bytes(): then the stream is new, and is to be written there.
  uint64_t place(const std::vector<uint8_t>& stream, const IsAt& is_at);

  // All streams that are to be written take as many bytes.
  uint64_t bytes() const { return bytes_; }

 private:
  struct Place {
    uint64_t offset, size;
  };
  std::unordered_multimap<size_t, Place> places_;  // by a hash
  uint64_t bytes_ = 0;
};

// Streams that wait in a file until it is known what comes before them.

// The file has no name, so that nothing is left of it, however the program ends.
class StreamSpool {
 public:
  // In the folder of the output; where that is no file, in that of temporary files. Throws Error
  // naming the output.
  explicit StreamSpool(const std::string& output);

  // Returns where the stream is among those that copy_to copies, equal ones once. An empty stream
  // is nowhere: 0.
  uint64_t add(const std::vector<uint8_t>& stream);
  void clear();

  // Copies the streams in the order in which they came.
  void copy_to(OutputFile& out);

 private:
  bool holds(const std::vector<uint8_t>& stream, uint64_t offset);
  void go_to(uint64_t offset);
  [[noreturn]] void fail() const;

  std::string output_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  StreamPlaces places_;
};

// Streams in memory.
class JoinedStreams {
 public:
  // Returns where the stream is. An empty one is nowhere: 0.
  uint64_t add(const std::vector<uint8_t>& stream);

  const std::vector<uint8_t>& bytes() const { return bytes_; }

 private:
  StreamPlaces places_;
  std::vector<uint8_t> bytes_;
};

}  // namespace microtin::files

#endif
