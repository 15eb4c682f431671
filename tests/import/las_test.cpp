// SPDX-License-Identifier: MIT
// Reading laser scans.
#include <doctest/doctest.h>

#include <array>

#include "encoder/import/import.hpp"
#include "encoder/import/mosaic.hpp"
#include "tests/support/binary_file.hpp"
#include "tests/support/imports.hpp"

using namespace microtin::tests;

namespace {

struct Return {
  std::array<int32_t, 3> place;
  int class_code;
  bool withheld = false;
};

constexpr std::array<uint16_t, 11> kPointBytes = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr std::array<uint16_t, 5> kHeadBytes = {227, 227, 227, 235, 375};

// A record of `user` and number, with its content.
std::string record(const std::string& user, uint16_t number, const std::string& content,
                   bool extended = false) {
  BinaryFile file;
  file.put(2, user).put(18, number);
  if (extended) {
    file.put(20, uint64_t{content.size()}).put(59, '\0');
  } else {
    file.put(20, static_cast<uint16_t>(content.size())).put(53, '\0');
  }
  return file.add(content).bytes();
}

// Scales are 0.01, 0.01 and 0.001, offsets 1000, 0 and -0.5.
BinaryFile las(uint8_t minor, uint8_t format, const std::vector<Return>& returns,
               const std::string& records = "", uint32_t record_count = 0) {
  const size_t bytes = kPointBytes[format] + 3u;  // with something of the writer's own
  BinaryFile file;
  file.put(0, std::string("LASF")).put(24, uint8_t{1}).put(25, minor);
  const uint16_t head = kHeadBytes[minor];
  const auto first = static_cast<uint32_t>(head + records.size());
  file.put(94, head).put(96, first).put(100, record_count);
  file.put(104, format).put(105, static_cast<uint16_t>(bytes));
  const bool wide = minor == 4;
  file.put(107, wide ? 0u : static_cast<uint32_t>(returns.size()));
  const double numbers[] = {0.01, 0.01, 0.001, 1000, 0, -0.5};
  for (size_t i = 0; i < 6; ++i) file.put(131 + 8 * i, numbers[i]);
  file.put(head - 1u, '\0');
  if (wide) file.put(247, uint64_t{returns.size()});
  file.put(head, records);
  for (size_t i = 0; i < returns.size(); ++i) {
    const size_t at = first + i * bytes;
    for (size_t k = 0; k < 3; ++k) file.put(at + 4 * k, returns[i].place[k]);
    const int withheld = returns[i].withheld ? 1 : 0;
    if (format < 6) {
      file.put(at + 15, static_cast<uint8_t>(returns[i].class_code | withheld << 7));
    } else {
      file.put(at + 15, static_cast<uint8_t>(withheld << 2));
      file.put(at + 16, static_cast<uint8_t>(returns[i].class_code));
    }
    file.put(at + bytes - 1, '\0');
  }
  return file;
}

const std::vector<Return> kScan = {{{100, 250, 1500}, 2},
                                   {{200, 250, 9000}, 5},
                                   {{-300, 125, -1}, 2},
                                   {{1, 2, 3}, 2, true},
                                   {{4, 5, 6}, 7}};

PointCloud cloud(const std::string& bytes, const std::optional<ClassSet>& classes = {}) {
  return import_las("scan", bytes, classes);
}

std::string las_error(const std::string& bytes, const std::optional<ClassSet>& classes = {}) {
  return import_error([&] { cloud(bytes, classes); });
}

std::string geo_keys(const std::vector<uint16_t>& keys) {
  BinaryFile file;
  file.add(uint16_t{1})
      .add(uint16_t{1})
      .add(uint16_t{0})
      .add(static_cast<uint16_t>(keys.size() / 2));
  for (size_t i = 0; i < keys.size(); i += 2) {
    file.add(keys[i]).add(uint16_t{0}).add(uint16_t{1}).add(keys[i + 1]);
  }
  return file.bytes();
}

}  // namespace

TEST_CASE("las: the ground, in exact decimals, of every version and format") {
  for (const uint8_t minor : {uint8_t{0}, uint8_t{1}, uint8_t{2}, uint8_t{3}, uint8_t{4}}) {
    for (int format = 0; format < (minor == 4 ? 11 : 6); ++format) {
      const PointCloud ground = cloud(las(minor, static_cast<uint8_t>(format), kScan).bytes());
      CHECK(text_of(ground) == "100100,250,1000 99700,125,-501");
      CHECK(ground.xy_decimals == 2);
      CHECK(ground.z_decimals == 3);
      CHECK(ground.selection == "taken: class 2 (2); left out: class 5 (1), 7 (1), withheld (1)");
    }
  }
}

TEST_CASE("las: the classes that an option selects, without ground all except noise") {
  const std::string bytes = las(2, 1, kScan).bytes();
  CHECK(text_of(cloud(bytes, ClassSet().set(5).set(7))) == "100200,250,8500 100004,5,-494");
  CHECK(cloud(bytes, ClassSet().set(5).set(7)).classes == ClassSet().set(5).set(7));
  CHECK(cloud(bytes, ClassSet().set()).points.size() == 4);
  CHECK(las_error(bytes, ClassSet().set(9)) ==
        "scan: no point is taken; left out: class 2 (2), 5 (1), 7 (1), withheld (1); choose other "
        "classes by classes");
  const PointCloud rest =
      cloud(las(4, 6, {{{0, 0, 0}, 1}, {{1, 0, 0}, 7}, {{2, 0, 0}, 18}, {{3, 0, 0}, 200}}).bytes());
  CHECK(text_of(rest) == "100000,0,-5 100003,0,-5");
  CHECK(rest.selection == "taken: class 1 (1), 200 (1); left out: class 7 (1), 18 (1)");
}

TEST_CASE("las: scales of many decimals are rounded at the end") {
  BinaryFile file = las(2, 0, {{{2000000000, 3, 1}, 2}, {{-3, 0, 0}, 2}});
  file.put(131, 0x1p-13).put(155, 0.0).put(147, 1e-7);
  const PointCloud points = cloud(file.bytes());
  CHECK(points.xy_decimals == 9);
  CHECK(points.points[0].x == 244140625000000);
  CHECK(points.points[1].x == -366211);  // 0.0003662109375
  CHECK(points.z_decimals == 7);
  CHECK(points.points[0].z == -4999999);
}

TEST_CASE("las: files of one terrain give the same classes, and what is left out is summed up") {
  const std::string scan = las(2, 1, kScan).bytes(),
                    bare = las(2, 1, {{{0, 0, 7}, 0}, {{9, 0, 7}, 5}}).bytes();
  const auto joined = [&](const std::string& other, const std::optional<ClassSet>& classes = {}) {
    std::vector<NamedSource> parts;
    parts.push_back({"a.las", cloud(scan, classes)});
    parts.push_back({"b.las", cloud(other, classes)});
    return join_clouds(std::move(parts));
  };
  CHECK(joined(scan).classes == ClassSet().set(2));
  CHECK(joined(scan).selection ==
        "2 files, which agree at 2 places that they share; taken: class 2 (4); left out: class 5 "
        "(2), 7 (2), withheld (2)");
  CHECK(import_error([&] { joined(bare); }) ==
        "b.las: taken: class 0 (1), 5 (1), but a.las: taken: class 2 (2); left out: class 5 (1), "
        "7 (1), withheld (1); choose the classes of all files by classes");
  CHECK(joined(bare, ClassSet().set(5)).points.size() == 2);
}

TEST_CASE("las: codes and units from GeoTIFF keys and from well-known text") {
  const std::string utm =
      geo_keys({1024, 1, 2048, 4326, 3072, 25832, 3076, 9001, 4096, 5783, 4099, 9001});
  const auto reference = [](const std::string& bytes) { return cloud(bytes).reference; };
  const Reference metres =
      reference(las(2, 0, kScan, record("LASF_Projection", 34735, utm), 1).bytes());
  CHECK(metres.horizontal_epsg == 25832);
  CHECK(metres.vertical_epsg == 5783);
  CHECK(metres.horizontal_unit == Unit::kMetre);
  CHECK(metres.vertical_unit == Unit::kMetre);
  const std::string degrees =
      record("other", 1, "x") + record("LASF_Projection", 34735, geo_keys({1024, 2, 2048, 4269}));
  CHECK(reference(las(3, 0, kScan, degrees, 2).bytes()).horizontal_unit == Unit::kDegree);
  CHECK(reference(las(3, 0, kScan, degrees, 2).bytes()).horizontal_epsg == 4269);
  const std::string nothing = degrees + record("LASF_Projection", 2112, std::string(1, '\0'));
  CHECK(reference(las(4, 6, kScan, nothing, 3).bytes()).horizontal_epsg == 4269);
  const std::string wkt =
      "PROJCS[\"x\",GEOGCS[\"y\",AUTHORITY[\"EPSG\",\"4269\"]],UNIT[\"US survey foot\","
      "0.3048006096012192],AUTHORITY[\"EPSG\",\"2992\"]]";
  BinaryFile file = las(4, 6, kScan);
  file.put(235, uint64_t{file.bytes().size()}).put(243, uint32_t{1});
  file.add(record("LASF_Projection", 2112, wkt, true));
  CHECK(reference(file.bytes()).horizontal_epsg == 2992);
  CHECK(reference(file.bytes()).horizontal_unit == Unit::kUsSurveyFoot);
}

TEST_CASE("las: the day of the header is the date of the source, and files' dates are joined") {
  BinaryFile file = las(2, 1, kScan);
  CHECK(cloud(file.bytes()).reference.notes.date.empty());
  file.put(90, uint16_t{60}).put(92, uint16_t{2024});
  const PointCloud first = cloud(file.bytes());
  CHECK(first.reference.notes.date == "2024-02-29");
  file.put(90, uint16_t{0}).put(92, uint16_t{2026});
  const PointCloud second = cloud(file.bytes());
  CHECK(second.reference.notes.date == "2026");
  std::vector<NamedSource> parts;
  parts.push_back({"a.las", first});
  parts.push_back({"b.las", second});
  const OpenSource both = join(std::move(parts));
  CHECK(std::get<PointCloud>(both).reference.notes.date == "2024-02-29/2026");
}

TEST_CASE("las: every error is reported") {
  CHECK(las_error("") == "scan: is not a LAS file");
  CHECK(las_error("LASF") == "scan: cut off: has 4 bytes, but names more");
  const auto with = [](size_t at, auto value) {
    return las_error(las(2, 1, kScan).put(at, value).bytes());
  };
  CHECK(with(24, uint8_t{2}) == "scan: is of LAS version 2.2; 1.0 to 1.4 are read");
  CHECK(with(25, uint8_t{5}) == "scan: is of LAS version 1.5; 1.0 to 1.4 are read");
  CHECK(with(104, uint8_t{11}) == "scan: has points of format 11; 0 to 10 are read");
  CHECK(with(105, uint16_t{27}) == "scan: has points of 27 bytes; format 1 takes 28");
  CHECK(with(107, uint32_t{6}) == "scan: cut off: has 5 of 6 points");
  CHECK(with(96, uint32_t{0xFFFFFFFF}) == "scan: cut off: has 0 of 5 points");
  CHECK(with(107, uint32_t{0}) == "scan: holds no point");
  CHECK(with(100, uint32_t{1000}).find("scan: cut off") == 0);
  for (const double scale : {0.0, -0.01, 1e7, 1e-300, 0.0 / 0.0}) {
    CHECK(with(131, scale) == "scan: the header's scale or offset of an axis is out of range");
  }
  CHECK(with(155, 1e18) == "scan: the header's scale or offset of an axis is out of range");
  CHECK(with(147, 1e6) == "none");
  CHECK(with(163, 1e17).find("scan: point 1: ") == 0);
  const std::string whole = las(4, 7, kScan).bytes();
  for (size_t size = 0; size < whole.size(); ++size) {
    CHECK(las_error(whole.substr(0, size)) != "none");
  }
}

TEST_CASE("las: real scans") {
  if (const std::string path = data_file("simple.las"); !path.empty()) {
    const PointCloud scan = std::get<PointCloud>(import_terrain(path));
    CHECK(scan.selection == "taken: class 2 (276); left out: class 1 (789)");
    CHECK(scan.xy_decimals == 2);
    CHECK(std::get<PointCloud>(import_terrain(path, ClassSet().set())).points.size() == 1065);
  }
}

TEST_CASE("las: points whose offset lies within the header or its records are refused") {
  for (const uint8_t minor : {uint8_t{2}, uint8_t{3}, uint8_t{4}}) {
    const uint16_t head = kHeadBytes[minor];
    const BinaryFile sound = las(minor, 0, kScan, record("me", 1, "note"), 1);
    CHECK(cloud(sound.bytes()).points.size() == 2);
    for (const uint32_t first : {0u, 100u, head - 1u, head + 0u, head + 57u}) {
      BinaryFile file = sound;
      file.put(96, first);
      const uint32_t end = first < head ? head : head + 58u;
      CHECK(las_error(file.bytes()) ==
            "scan: malformed: its points begin at byte " + std::to_string(first) +
                ", before the header and its records end, at " + std::to_string(end));
    }
    BinaryFile small = sound;
    small.put(94, uint16_t{200});
    CHECK(las_error(small.bytes()) == "scan: has a header of 200 bytes; version 1." +
                                          std::to_string(minor) + " takes " + std::to_string(head));
  }
}
