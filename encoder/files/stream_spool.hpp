// SPDX-License-Identifier: MIT
// Streams that wait in a file until it is known what comes before them.
#ifndef MICROTIN_ENCODER_FILES_STREAM_SPOOL_HPP
#define MICROTIN_ENCODER_FILES_STREAM_SPOOL_HPP

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "encoder/files/output_file.hpp"
#include "encoder/layers.hpp"

namespace microtin::files {

// The file has no name, so that nothing is left of it, however the program ends.
class StreamSpool {
 public:
  // In the folder of the output; where that is no file, in that of temporary files. Throws Error
  // naming the output.
  explicit StreamSpool(const std::string& output);

  void add(const std::vector<uint8_t>& stream);
  void clear();

  // Copies all streams in the order in which they came.
  void copy_to(OutputFile& out);

 private:
  void rewind();
  [[noreturn]] void fail() const;

  std::string output_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
  uint64_t bytes_ = 0;
};

}  // namespace microtin::files

#endif
