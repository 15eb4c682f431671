// SPDX-License-Identifier: MIT
// LAS, the American Society for Photogrammetry and Remote Sensing's format for laser scans.
// Ours: of its many fields five are read, as the integers that they are.
#include <algorithm>
#include <array>

#include "encoder/base/text.hpp"
#include "encoder/exact/decimal.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/cloud.hpp"
#include "encoder/import/crs.hpp"
#include "encoder/import/import.hpp"
#include "encoder/import/laz.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {
namespace {

constexpr uint8_t kGround = 2, kLowNoise = 7, kHighNoise = 18;

// Bytes of the header, without what a writer adds, of versions 1.0 to 1.4.
constexpr std::array<uint16_t, 5> kHeaderBytes = {227, 227, 227, 235, 375};

// Bytes of a point of each format, without what a writer adds.
constexpr std::array<uint16_t, 11> kPointBytes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

struct LasHeader {
  uint8_t minor_version;
  uint16_t bytes;
  uint8_t point_format;
  bool is_compressed;
  uint16_t point_bytes;
  uint64_t first_point;
  uint64_t points;
};

void expect_points_behind(const ByteReader& file, uint64_t first_point, uint64_t end) {
  if (first_point >= end) return;
  file.fail("malformed: its points begin at byte " + std::to_string(first_point) +
            ", before the header and its records end, at " + std::to_string(end));
}

LasHeader read_header(const ByteReader& file) {
  if (file.size() < 4 || file.bytes(0, 4) != "LASF") file.fail("is not a LAS file");
  LasHeader header{};
  const uint8_t major = file.number<uint8_t>(24);
  header.minor_version = file.number<uint8_t>(25);
  if (major != 1 || header.minor_version > 4) {
    file.fail("is of LAS version " + std::to_string(major) + '.' +
              std::to_string(header.minor_version) + "; 1.0 to 1.4 are read");
  }
  header.bytes = file.number<uint16_t>(94);
  if (header.bytes < kHeaderBytes[header.minor_version]) {
    file.fail("has a header of " + std::to_string(header.bytes) + " bytes; version 1." +
              std::to_string(header.minor_version) + " takes " +
              std::to_string(kHeaderBytes[header.minor_version]));
  }
  header.first_point = file.number<uint32_t>(96);
  expect_points_behind(file, header.first_point, header.bytes);
  const auto format = file.number<uint8_t>(104);
  header.point_format = format & 0x3F;
  header.is_compressed = format != header.point_format;
  header.point_bytes = file.number<uint16_t>(105);
  header.points = points_of_las(file);
  if (header.point_format >= kPointBytes.size()) {
    file.fail("has points of format " + std::to_string(header.point_format) + "; 0 to 10 are read");
  }
  if (header.point_bytes < kPointBytes[header.point_format]) {
    file.fail("has points of " + std::to_string(header.point_bytes) + " bytes; format " +
              std::to_string(header.point_format) + " takes " +
              std::to_string(kPointBytes[header.point_format]));
  }
  return header;
}

void expect_all_points(const ByteReader& file, const LasHeader& header) {
  const uint64_t room = file.size() - std::min(header.first_point, file.size());
  if (header.points <= room / header.point_bytes) return;
  file.fail("cut off: has " + std::to_string(room / header.point_bytes) + " of " +
            std::to_string(header.points) + " points");
}

// The day on which the file was made, in version 1.0 that of the flight; the year alone if the day
// is not stated. Empty: there is none.
std::string date_of(const ByteReader& file) {
  const auto day = file.number<uint16_t>(90), year = file.number<uint16_t>(92);
  return year == 0 ? std::string() : iso_date(year, day);
}

// Collects what the variable length records say of the coordinates and of compression.
class References {
 public:
  explicit References(const ByteReader& file, const LasHeader& header) : file_(file) {
    const uint64_t end = read_records(header.bytes, file.number<uint32_t>(100), false);
    expect_points_behind(file, header.first_point, end);
    if (header.minor_version == 4) {
      read_records(file.number<uint64_t>(235), file.number<uint32_t>(243), true);
    }
  }

  // Empty: the points are not compressed.
  std::string_view laszip() const { return laszip_; }

  // Some writers leave a text empty next to keys.
  Reference take() const {
    return is_wkt(wkt_) ? reference_of_wkt(wkt_) : reference_of_geo_keys(keys_, doubles_);
  }

 private:
  // Returns where they end.
  uint64_t read_records(uint64_t at, uint32_t count, bool extended) {
    const uint64_t head = extended ? 60 : 54;
    for (uint32_t i = 0; i < count; ++i) {
      file_.bytes(at, head);
      const std::string_view user = file_.bytes(at + 2, 16);
      const uint64_t size =
          extended ? file_.number<uint64_t>(at + 20) : file_.number<uint16_t>(at + 20);
      add(user.substr(0, user.find('\0')), file_.number<uint16_t>(at + 18), at + head, size);
      at += head + size;
    }
    return at;
  }

  void add(std::string_view user, uint16_t record, uint64_t at, uint64_t size) {
    constexpr uint16_t kGeoKeys = 34735, kGeoDoubles = 34736, kWkt = 2112, kLaszip = 22204;
    const std::string_view content = file_.bytes(at, size);
    if (user == "laszip encoded" && record == kLaszip) laszip_ = content;
    if (user != "LASF_Projection") return;
    if (record == kWkt) wkt_ = content;
    if (record == kGeoDoubles) {
      doubles_.clear();
      for (uint64_t i = 0; i + 8 <= size; i += 8) doubles_.push_back(file_.number<double>(at + i));
    }
    if (record != kGeoKeys) return;
    keys_.clear();
    for (uint64_t i = 0; i + 2 <= size; i += 2) keys_.push_back(file_.number<uint16_t>(at + i));
  }

  const ByteReader& file_;
  std::string_view wkt_, laszip_;
  std::vector<uint16_t> keys_;
  std::vector<double> doubles_;
};

// The points of a file in their order: where the file has them, or decompressed.
class ScanPoints {
 public:
  ScanPoints(const ByteReader& file, const LasHeader& header) : file_(file), header_(header) {
    expect_all_points(file, header);
  }
  ScanPoints(const ByteReader& file, const LasHeader& header,
             std::vector<std::vector<ScanPoint>> unpacked)
      : file_(file), header_(header), unpacked_(std::move(unpacked)) {}

  // Calls visit(point).
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const std::vector<ScanPoint>& chunk : unpacked_) {
      for (const ScanPoint& point : chunk) visit(point);
    }
    if (!unpacked_.empty()) return;
    for (uint64_t i = 0; i < header_.points; ++i) {
      const uint64_t at = header_.first_point + i * header_.point_bytes;
      visit(scan_point_at(file_, at, header_.point_format));
    }
  }

 private:
  const ByteReader& file_;
  const LasHeader& header_;
  std::vector<std::vector<ScanPoint>> unpacked_;
};

ScanPoints points_of(const std::string& name, const ByteReader& file, const LasHeader& header,
                     std::string_view laszip) {
  if (header.points == 0) file.fail("holds no point");
  if (!header.is_compressed && laszip.empty()) return {file, header};
  const LazHeader compressed = {header.point_format, header.point_bytes, header.first_point,
                                header.points, laszip};
  return {file, header, unpack_laz(name, file, compressed)};
}

class LasPointReader {
 public:
  LasPointReader(const ByteReader& file, const ScanPoints& points)
      : file_(file), points_(points), axes_{scaled(0), scaled(1), scaled(2)} {
    points.for_each([&](const ScanPoint& point) {
      ++(point.is_withheld ? counts_.withheld : counts_.points[point.class_code]);
    });
  }

  // The points of these classes that are not withheld.
  PointCloud read(const ClassSet& classes) const {
    PointColumns columns;
    uint64_t number = 0;
    points_.for_each([&](const ScanPoint& point) {
      ++number;
      if (point.is_withheld || !classes[point.class_code]) return;
      for (size_t axis = 0; axis < 3; ++axis) {
        const Decimal value = axes_[axis](point.place[axis]);
        if (!columns.add(axis, value)) fail_on(number, value);
      }
    });
    if (columns.empty())
      file_.fail("no point is " + taken_text(counts_, classes) +
                 (has_others() ? "; choose other classes by " + parameter("classes") : ""));
    PointCloud cloud = columns.take();
    cloud.selection = taken_text(counts_, classes);
    cloud.classes = classes;
    cloud.counts = counts_;
    return cloud;
  }

  // What a terrain model is made of: the ground or, if nobody looked for it, all but noise.
  ClassSet default_classes() const {
    ClassSet classes;
    if (counts_.points[kGround] != 0) return classes.set(kGround);
    return classes.set().reset(kLowNoise).reset(kHighNoise);
  }

 private:
  ScaledIntegers scaled(uint64_t axis) const {
    const auto numbers = ScaledIntegers::from(file_.number<double>(131 + 8 * axis),
                                              file_.number<double>(155 + 8 * axis));
    if (!numbers) file_.fail("the header's scale or offset of an axis is out of range");
    return *numbers;
  }

  bool has_others() const {
    return std::any_of(counts_.points.begin(), counts_.points.end(),
                       [](uint64_t count) { return count != 0; });
  }

  [[noreturn]] void fail_on(uint64_t number, Decimal value) const {
    file_.fail("point " + std::to_string(number) + ": " + to_string(value) +
               " is not a number in range");
  }

  const ByteReader& file_;
  const ScanPoints& points_;
  std::array<ScaledIntegers, 3> axes_;
  ClassCounts counts_;
};

}  // namespace

uint64_t points_of_las(const ByteReader& file) {
  const bool has_both = file.number<uint8_t>(25) == 4;  // the minor version
  const uint64_t points = has_both ? file.number<uint64_t>(247) : 0;
  return points != 0 ? points : file.number<uint32_t>(107);
}

PointCloud import_las(const std::string& name, const std::string& bytes,
                      const std::optional<ClassSet>& classes) {
  const ByteReader file(name, bytes);
  const LasHeader header = read_header(file);
  const References references(file, header);
  const ScanPoints points = points_of(name, file, header, references.laszip());
  const LasPointReader reader(file, points);
  PointCloud cloud = reader.read(classes ? *classes : reader.default_classes());
  cloud.reference = references.take();
  cloud.reference.notes.date = date_of(file);
  return cloud;
}

}  // namespace microtin::importing
