// SPDX-License-Identifier: MIT
// A folder for a test's files, removed with them.
#ifndef MICROTIN_TESTS_SUPPORT_TEMPORARY_FOLDER_HPP
#define MICROTIN_TESTS_SUPPORT_TEMPORARY_FOLDER_HPP

#include <unistd.h>

#include <filesystem>
#include <string>

#include "tests/support/layers.hpp"

namespace microtin::tests {

class TemporaryFolder {
 public:
  TemporaryFolder() {
    static int count = 0;
    const std::string name =
        "microtin-test-" + std::to_string(getpid()) + "-" + std::to_string(count++);
    path_ = (std::filesystem::temp_directory_path() / name).string();
    std::filesystem::create_directory(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline std::string operator/(const TemporaryFolder& folder, const std::string& name) {
  return folder.path() + "/" + name;
}

}  // namespace microtin::tests

#endif
