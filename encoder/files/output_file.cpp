// Writes beside the target and takes its place at the end.
#include "encoder/files/output_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "encoder/base/error.hpp"

namespace microtin::files {
namespace fs = std::filesystem;

OutputFile::OutputFile(const std::string& path) : path_(path), target_(path) {
  if (path == "-") {
    file_ = stdout;
    return;
  }
  std::error_code ignored;  // a target that cannot be examined is one that cannot be opened
  const fs::file_status status = fs::status(path, ignored);
  if (fs::is_directory(status)) throw Error(path + ": is a directory");
  const bool special = fs::exists(status) && !fs::is_regular_file(status);
  if (fs::is_regular_file(status)) target_ = fs::canonical(path, ignored).string();
  if (!special) temporary_ = target_ + ".part-" + std::to_string(getpid());
  const SignalsHeld held;
  file_ = std::fopen(special ? path.c_str() : temporary_.c_str(), special ? "wb" : "wbx");
  if (file_ == nullptr) {
    temporary_.clear();
    fail();
  }
  if (!special) leftover_.emplace(temporary_);
}

OutputFile::~OutputFile() {
  if (file_ != nullptr && file_ != stdout) std::fclose(file_);
  if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void refuse_overwriting(const std::string& input, const std::string& output) {
  std::error_code ignored;  // files that are not there are not the same
  if (fs::is_regular_file(input, ignored) && fs::equivalent(input, output, ignored)) {
    throw Error(output + ": is the input");
  }
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
  throw Error(path_ + ": cannot be written: " + std::generic_category().message(errno));
}

}  // namespace microtin::files
