// SPDX-License-Identifier: MIT
#include "tests/support/paths.hpp"

namespace microtin::tests {

std::filesystem::path golden_folder() {
  return MICROTIN_GOLDEN_DIR;
}

std::string golden(const std::string& name) {
  return (golden_folder() / name).string();
}

std::filesystem::path data_folder() {
  return MICROTIN_DATA_DIR;
}

std::string built_program() {
  return MICROTIN_CLI;
}

}  // namespace microtin::tests
