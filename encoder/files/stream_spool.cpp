// SPDX-License-Identifier: MIT
// Keeps streams in a temporary file, in order.
#include "encoder/files/stream_spool.hpp"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "encoder/base/error.hpp"
#include "encoder/files/file_target.hpp"
#include "encoder/files/leftovers.hpp"

namespace microtin::files {
namespace {

std::FILE* open_nameless(const std::string& output) {
  const std::optional<std::string> target = replaced_by(output);
  if (!target) return std::tmpfile();
  std::string name = *target + ".streams-";
  const SignalsHeld held;
  const int number = open_new(name, O_RDWR, 0600);
  if (number >= 0) std::remove(name.c_str());
  return stream_of(number, "w+b");
}

}  // namespace

StreamSpool::StreamSpool(const std::string& output)
    : output_(output), file_(open_nameless(output), &std::fclose) {
  if (!file_) fail();
}

void StreamSpool::add(const std::vector<uint8_t>& stream) {
  if (stream.empty()) return;
  if (std::fwrite(stream.data(), 1, stream.size(), file_.get()) != stream.size()) fail();
  bytes_ += stream.size();
}

void StreamSpool::clear() {
  rewind();
  bytes_ = 0;
}

void StreamSpool::copy_to(OutputFile& out) {
  if (std::fflush(file_.get()) != 0) fail();
  rewind();
  std::vector<char> piece(65536);
  for (uint64_t left = bytes_; left != 0;) {
    const std::size_t size = std::min<uint64_t>(left, piece.size());
    if (std::fread(piece.data(), 1, size, file_.get()) != size) fail();
    out.write({piece.data(), size});
    left -= size;
  }
}

void StreamSpool::rewind() {
  if (std::fseek(file_.get(), 0, SEEK_SET) != 0) fail();
}

void StreamSpool::fail() const {
  throw Error(output_ + ": cannot be written: " + std::generic_category().message(errno));
}

}  // namespace microtin::files
