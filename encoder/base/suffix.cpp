// SPDX-License-Identifier: MIT
// Takes the suffix from a name.
#include "encoder/base/suffix.hpp"

#include <filesystem>

namespace microtin::base {

std::string lower_case(std::string text) {
  for (char& c : text) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return text;
}

std::string suffix_of(const std::string& path) {
  return lower_case(std::filesystem::path(path).extension().string());
}

}  // namespace microtin::base
