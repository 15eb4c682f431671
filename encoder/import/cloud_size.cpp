// SPDX-License-Identifier: MIT
// Looks at the first bytes of a cloud's file.
#include "encoder/import/cloud_size.hpp"

#include <algorithm>

#include "encoder/base/error.hpp"
#include "encoder/base/suffix.hpp"
#include "encoder/files/byte_source.hpp"
#include "encoder/files/input_file.hpp"

namespace microtin::importing {
namespace {

constexpr uint64_t kLookedAt = 65536;

uint64_t points_of_ply(const std::string& head) {
  const std::string element = "element vertex ";
  const size_t at = head.find(element);
  if (at == std::string::npos) return 0;
  uint64_t points = 0;
  for (size_t i = at + element.size(); i < head.size() && head[i] >= '0' && head[i] <= '9'; ++i) {
    if (points < UINT32_MAX) points = 10 * points + static_cast<uint64_t>(head[i] - '0');
  }
  return points;
}

uint64_t lines_of(const std::string& head, uint64_t bytes) {
  const auto lines = static_cast<uint64_t>(std::count(head.begin(), head.end(), '\n'));
  return head.empty()
             ? 0
             : static_cast<uint64_t>(static_cast<double>(bytes) * static_cast<double>(lines) /
                                     static_cast<double>(head.size()));
}

uint64_t points_in(const std::string& path, const std::string& suffix) {
  const std::unique_ptr<ByteSource> file = open_file(path);
  const std::vector<uint8_t> head = bytes_at(*file, 0, std::min(kLookedAt, file->size()));
  const std::string text(head.begin(), head.end());
  if (suffix == ".las") return points_of_las(ByteReader(path, text));
  return suffix == ".ply" ? points_of_ply(text) : lines_of(text, file->size());
}

}  // namespace

uint64_t points_expected(const std::string& path) {
  const std::string suffix = suffix_of(path);
  constexpr const char* kClouds[] = {".las", ".ply", ".xyz", ".csv", ".txt", ".obj"};
  const bool is_cloud =
      std::find(std::begin(kClouds), std::end(kClouds), suffix) != std::end(kClouds);
  try {
    return is_cloud && is_regular_file(path) ? points_in(path, suffix) : 0;
  } catch (const Error&) {
    return 0;
  }
}

}  // namespace microtin::importing
