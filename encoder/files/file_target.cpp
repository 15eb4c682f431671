// SPDX-License-Identifier: MIT
// Follows links, and looks at what is where an output is to be.
#include "encoder/files/file_target.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <charconv>
#include <filesystem>
#include <system_error>

#include "encoder/base/error.hpp"

namespace microtin::files {
namespace fs = std::filesystem;
namespace {

constexpr int kMostLinks = 40;  // as the system's own

// Whether the names in a folder are numbers of this process's descriptors.
bool lists_descriptors(const fs::path& folder) {
  std::error_code ignored;  // what is not there is not the same
  const fs::path real = fs::canonical(folder, ignored);
  if (real.empty()) return false;
  for (const char* const known : {"/proc/self/fd", "/proc/thread-self/fd", "/dev/fd"}) {
    if (fs::canonical(known, ignored) == real) return true;
  }
  return false;
}

std::optional<int> number_of_descriptor(const fs::path& path) {
  const std::string name = path.filename().string();
  const char* const end = name.data() + name.size();
  int number = -1;
  const auto [next, error] = std::from_chars(name.data(), end, number);
  if (error != std::errc() || next != end || number < 0) return std::nullopt;
  if (!lists_descriptors(path.parent_path())) return std::nullopt;
  return number;
}

// The name behind links, as far as a descriptor: where that leads is not for us to open.
fs::path behind_links(const std::string& path) {
  fs::path target = path;
  std::error_code ignored;  // what cannot be examined is no link, and cannot be opened
  for (int links = 0; fs::is_symlink(fs::symlink_status(target, ignored)); ++links) {
    if (number_of_descriptor(target)) break;
    if (links == kMostLinks) {
      throw Error(path + ": " + std::generic_category().message(ELOOP));
    }
    const fs::path next = fs::read_symlink(target, ignored);
    target = target.parent_path() / next;  // `next` alone if that is absolute
  }
  return target;
}

// What a name stands for if that is a regular file.
std::optional<struct stat> regular_file(const std::string& path, int standard) {
  struct stat status {};
  const int result = path == "-" ? fstat(standard, &status) : stat(path.c_str(), &status);
  if (result != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  return status;
}

}  // namespace

std::optional<int> descriptor_named(const std::string& path) {
  if (path == "-") return STDOUT_FILENO;
  return number_of_descriptor(behind_links(path));
}

std::optional<std::string> replaced_by(const std::string& path) {
  if (descriptor_named(path)) return std::nullopt;
  const std::string target = behind_links(path).string();
  std::error_code ignored;  // a target that cannot be examined is one that cannot be opened
  const fs::file_status status = fs::status(target, ignored);
  if (fs::is_directory(status)) throw Error(path + ": is a directory");
  if (fs::exists(status) && !fs::is_regular_file(status)) return std::nullopt;
  return target;
}

void refuse_overwriting(const std::vector<std::string>& inputs, const std::string& output) {
  for (const std::string& written : {output, std::string("-")}) {
    const std::optional<struct stat> target = regular_file(written, STDOUT_FILENO);
    for (const std::string& input : inputs) {
      const std::optional<struct stat> source = regular_file(input, STDIN_FILENO);
      if (!target || !source) continue;
      if (source->st_dev != target->st_dev || source->st_ino != target->st_ino) continue;
      throw Error((written == "-" ? "standard output" : written) + ": is the input");
    }
  }
}

}  // namespace microtin::files
