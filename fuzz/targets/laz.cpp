// SPDX-License-Identifier: MIT
// Compressed laser scans. A file, which begins with 'L', is read. Other inputs are records of
// points: the tests' own encoder compresses them, and reading must return the same points.
#include "fuzz/support/import_target.hpp"
#include "tests/support/laz_file.hpp"

using namespace microtin::tests;

namespace {

// Enough for what a thousand bytes may hold; more would only take time.
constexpr uint64_t kMostPoints = 20000;

bool is_too_large(const std::string& bytes) {
  return bytes.size() > 255 && (number_at<uint32_t>(bytes, 107) > kMostPoints ||
                                (bytes[25] == 4 && number_at<uint64_t>(bytes, 247) > kMostPoints));
}

// The points, or what is wrong with the file.
std::string outcome(const std::string& bytes) {
  std::string text;
  try {
    const PointCloud cloud = import_las("scan", bytes, ClassSet().set());
    text = cloud.selection;
    for (const SourcePoint& p : cloud.points) {
      text += " " + std::to_string(p.x) + "," + std::to_string(p.y) + "," + std::to_string(p.z);
    }
  } catch (const Error& error) {
    check_message(error);
    text = error.what();
  }
  return text;
}

void compress_and_read(const uint8_t* data, size_t size) {
  constexpr uint8_t kFormats[] = {0, 1, 2, 3, 6, 7, 8, 9, 10};
  FuzzedDataProvider given(data, size);
  const uint8_t format = kFormats[given.ConsumeIntegralInRange<size_t>(0, 8)];
  const auto bytes =
      static_cast<uint16_t>(kRecordBytes[format] + given.ConsumeIntegralInRange<uint32_t>(0, 3));
  LazOptions options;
  options.chunk_points = given.ConsumeIntegralInRange<uint32_t>(1, 40);
  options.has_place_at_end = given.ConsumeBool();
  options.filling = given.ConsumeIntegralInRange<uint32_t>(0, 9);
  const std::string las = scan_of(format, bytes, given.ConsumeRemainingBytesAsString());
  EXPECT(outcome(compressed(las, options)) == outcome(las));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0 || data[0] != 'L') {
    compress_and_read(data, size);
    return 0;
  }
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  if (is_too_large(bytes)) return 0;
  return import_and_encode([&] { return import_las("scan.laz", bytes, ClassSet().set()); },
                           Options(data, size));
}
