// Keeps streams in a temporary file, in order.
#include "encoder/files/stream_spool.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "encoder/base/error.hpp"
#include "encoder/files/byte_source.hpp"
#include "encoder/files/leftovers.hpp"

namespace microtin::files {
namespace {

std::FILE* open_nameless(const std::string& output) {
  std::error_code ignored;
  if (output == "-" || (std::filesystem::exists(output, ignored) && !is_regular_file(output))) {
    return std::tmpfile();
  }
  const std::string name = output + ".streams-" + std::to_string(getpid());
  const SignalsHeld held;
  std::FILE* const file = std::fopen(name.c_str(), "w+bx");
  if (file != nullptr) std::remove(name.c_str());
  return file;
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
