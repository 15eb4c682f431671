// SPDX-License-Identifier: MIT
// Reading compressed laser scans. The scans are compressed here, by an encoder of the tests' own.
#include "encoder/import/laz.hpp"

#include <doctest/doctest.h>

#include "encoder/import/import.hpp"
#include "tests/support/imports.hpp"
#include "tests/support/laz_file.hpp"

using namespace microtin::tests;

namespace {

PointCloud all_points(const std::string& bytes) {
  return import_las("scan", bytes, ClassSet().set());
}

std::string laz_error(const std::string& bytes) {
  return import_error([&] { all_points(bytes); });
}

void check_equal(const std::string& las, const LazOptions& options) {
  const PointCloud expected = all_points(las), read = all_points(compressed(las, options));
  CHECK(text_of(read) == text_of(expected));
  CHECK(read.selection == expected.selection);
}

const std::vector<uint8_t> kFormats = {0, 1, 2, 3, 6, 7, 8, 9, 10};

std::string with_byte(std::string bytes, size_t at, int value) {
  bytes[at] = static_cast<char>(value);
  return bytes;
}

// Bytes of the record of LASzip begin there.
size_t settings_of(const std::string& laz) {
  return laz.find("laszip encoded") + 52;
}

}  // namespace

TEST_CASE("laz: the points of every format are those of the LAS file") {
  for (const uint8_t format : kFormats) {
    for (const uint32_t extra : {0u, 3u}) {
      CAPTURE(format);
      const std::string las = made_scan(format, 3000, extra, format + 7u);
      check_equal(las, {});
      check_equal(las, {700, {}, true, 50, 4});
      check_equal(las, {0, {1, 1000, 2, 1997}, false, 0, 3});
    }
  }
}

TEST_CASE("laz: one point, and files of chunks that are full") {
  for (const uint8_t format : kFormats) {
    CAPTURE(format);
    for (const uint32_t points : {1u, 2u, 10u, 20u}) {
      check_equal(made_scan(format, points), {10});
      check_equal(made_scan(format, points), {1});
    }
    CHECK(laz_error(compressed(made_scan(format, 0))) == "scan: holds no point");
  }
}

TEST_CASE("laz: points that are all alike take a fraction of a bit") {
  std::string las = made_scan(6, 1);
  const std::string point = las.substr(375);
  for (int i = 1; i < 20000; ++i) las += point;
  BinaryFile file;
  file.add(las).put(247, uint64_t{20000});
  CHECK(compressed(file.bytes()).size() < 1500);
  check_equal(file.bytes(), {});
}

TEST_CASE("laz: the ground is taken, and a scan without the mark of compression is read") {
  std::string las = made_scan(1, 400);
  const std::string laz = compressed(las);
  CHECK(import_las("scan", laz, {}).selection == import_las("scan", las, {}).selection);
  CHECK(import_las("scan", laz, {}).classes == ClassSet().set(2));
  CHECK(text_of(all_points(with_byte(laz, 104, 1))) == text_of(all_points(las)));
}

TEST_CASE("laz: files that are cut off") {
  for (const uint8_t format : {uint8_t{3}, uint8_t{7}}) {
    const std::string whole = compressed(made_scan(format, 200, 2), {50, {}, false, 9});
    for (size_t size = 0; size + 4 < whole.size(); ++size) {
      CHECK(laz_error(whole.substr(0, size)) != "none");
    }
  }
  const std::string whole = compressed(made_scan(3, 200));
  CHECK(laz_error(whole.substr(0, 2000))
            .find("scan: cut off: has 2000 bytes, and the table of "
                  "chunks begins at byte ") == 0);
}

TEST_CASE("laz: damage never does more than to end with an error, or to move points") {
  std::mt19937 random(3);
  for (const uint8_t format : kFormats) {
    const std::string whole = compressed(made_scan(format, 300, 1), {0, {100, 150, 50}, false, 5});
    size_t refused = 0;
    for (int i = 0; i < 400; ++i) {
      std::string damaged = whole;
      const size_t from = format < 6 ? 227 : 375;
      char& byte = damaged[from + random() % (whole.size() - from)];
      byte = static_cast<char>(byte ^ 1 << random() % 8);
      refused += laz_error(damaged) != "none" ? 1u : 0u;
    }
    CHECK(refused > 20);
  }
}

TEST_CASE("laz: what compressed a file is checked, with a remedy") {
  const std::string remedy =
      ": decompress it first, with laszip, las2las or \"pdal translate IN.laz OUT.las\"";
  const std::string laz = compressed(made_scan(1, 9, 2));
  const size_t settings = settings_of(laz);
  const auto refused = [&](const std::string& what) {
    return "scan: is compressed (LAZ) in a way that is not read, " + what +
           ", with points of format 1" + remedy;
  };
  CHECK(laz_error(with_byte(laz, settings, 1)) == refused("compressor 1 with coder 0"));
  CHECK(laz_error(with_byte(laz, settings + 2, 1)) == refused("compressor 2 with coder 1"));
  CHECK(laz_error(with_byte(laz, settings + 32, 2)) == refused("2 items"));
  CHECK(laz_error(with_byte(laz, settings + 34, 9)) == refused("item 9 of version 2"));
  CHECK(laz_error(with_byte(laz, settings + 36, 21)) == refused("item 6 of version 2"));
  CHECK(laz_error(with_byte(laz, settings + 44, 1)) == refused("item 7 of version 1"));
  CHECK(laz_error(with_byte(laz, settings - 52, 'L')) ==
        "scan: is compressed (LAZ) without a record of LASzip" + remedy);
  const std::string waves = compressed(with_byte(made_scan(1, 9, 30), 104, 4));
  CHECK(laz_error(waves) ==
        "scan: is compressed (LAZ) in a way that is not read, waveforms, with points of format 4" +
            remedy);
}

TEST_CASE("laz: the table of chunks is checked") {
  const std::string laz = compressed(made_scan(0, 100), {0, {40, 60}, false});
  const size_t points = number_at<uint32_t>(laz, 96);
  const auto table = static_cast<size_t>(number_at<int64_t>(laz, points));
  const auto damaged = [](const std::string& what) {
    return "scan: damaged: the table of chunks " + what + "; copy the file again";
  };
  CHECK(laz_error(laz) == "none");
  CHECK(laz_error(with_byte(laz, table, 1)) == damaged("is of an unknown version"));
  CHECK(laz_error(with_byte(laz, table + 4, 0)) == damaged("is empty"));
  CHECK(laz_error(with_byte(laz, table + 4, 1)) == damaged("lacks 60 of the header's points"));
  CHECK(laz_error(with_byte(laz, 107, 99)) == damaged("names more points than the header"));
  CHECK(laz_error(with_byte(laz, 107, 101)) == damaged("lacks 1 of the header's points"));
  BinaryFile file;
  file.add(laz).put(points, static_cast<int64_t>(table - 8));
  CHECK(laz_error(file.bytes()).find("scan: damaged: ") == 0);
  file.put(points, static_cast<int64_t>(points + 7));
  CHECK(laz_error(file.bytes()).find("scan: cut off: ") == 0);
  const std::string fixed = compressed(made_scan(0, 100), {50});
  file.put(0, fixed).put(settings_of(fixed) + 12, uint32_t{0});
  CHECK(laz_error(file.bytes()) == damaged("belongs to chunks of no points"));
}

TEST_CASE("laz: an error names the chunk") {
  const std::string las = made_scan(6, 100);
  const std::string laz = compressed(las, {50});
  const size_t points = number_at<uint32_t>(laz, 96);
  const std::string place =
      "scan: damaged: chunk 1 of 2, from byte " + std::to_string(points + 8) + " on, ";
  CHECK(laz_error(with_byte(laz, points + 8 + 30, 51)) ==
        place +
            "has another number of points than the table of chunks states; copy the file "
            "again");
  CHECK(laz_error(with_byte(laz, points + 8 + 34 + 3, 1)) ==
        place + "ends before its layers do; copy the file again");
  CHECK(laz_error(with_byte(laz, points + 8 + 34 + 4 * 8 + 3, 1)) ==
        place + "ends before its layers do; copy the file again");
  BinaryFile file;
  file.add(laz).put(points + 8 + 34, uint32_t{0});
  CHECK(laz_error(file.bytes()) == place + "has no layer of x and y; copy the file again");
  file.put(points + 8 + 34, uint32_t{12});
  CHECK(laz_error(file.bytes()) == place + "ends before its last point; copy the file again");
}

TEST_CASE("laz: symbols, bits and integers are what was encoded, also the extreme ones") {
  LazEncoder encoder;
  SymbolShares few(3), many(515);
  BitShares bits;
  IntegerEncoder integers(32, 2), shorts(16, 1);
  std::mt19937 random(5);
  std::vector<uint32_t> values;
  for (uint32_t i = 0; i < 60000; ++i) {
    values.push_back(i % 9 == 0 ? 0x80000000u : static_cast<uint32_t>(random() >> random() % 32));
    encoder.symbol(few, values.back() % 3 / 2);
    encoder.symbol(many, values.back() % 515);
    encoder.bit(bits, values.back() % 7 == 0);
    integers.encode(encoder, 0, static_cast<int32_t>(values.back()), i % 2);
    shorts.encode(encoder, 0, static_cast<int16_t>(values.back()), 0);
    encoder.raw(values.back() & 0x7FFFF, 19);
  }
  const std::string bytes = encoder.finished();
  LazDecoder decoder(bytes);
  LazModel few_model(3), many_model(515);
  LazBitModel bit_model;
  LazIntegers integer_models(32, 2), short_models(16, 1);
  size_t wrong = 0;
  for (uint32_t i = 0; i < values.size(); ++i) {
    wrong += decoder.symbol(few_model) != values[i] % 3 / 2 ? 1u : 0u;
    wrong += decoder.symbol(many_model) != values[i] % 515 ? 1u : 0u;
    wrong += (decoder.bit(bit_model) != 0) != (values[i] % 7 == 0) ? 1u : 0u;
    wrong += integer_models.difference(decoder, i % 2) != values[i] ? 1u : 0u;
    const auto expected = static_cast<uint32_t>(static_cast<int16_t>(values[i]));
    wrong += short_models.difference(decoder, 0) != expected ? 1u : 0u;
    wrong += decoder.raw(19) != (values[i] & 0x7FFFF) ? 1u : 0u;
  }
  CHECK(wrong == 0);
}

TEST_CASE("laz: values that no encoder writes are refused") {
  CHECK(import_error([] { LazDecoder("\xFF\xFF\xFF\xFF"); }) ==
        "contains what no compressor writes");
  CHECK(import_error([] { LazDecoder("abc"); }) == "ends before its last point");
  LazDecoder decoder("\xFF\xFF\xFF\xFE");
  CHECK(import_error([&] { decoder.raw(19); }) == "contains what no compressor writes");
}

TEST_CASE("laz: a real scan") {
  const std::string path = data_file("simple.laz"), las = data_file("simple.las");
  if (path.empty() || las.empty()) return;
  const PointCloud scan = std::get<PointCloud>(import_terrain(path)),
                   expected = std::get<PointCloud>(import_terrain(las));
  CHECK(text_of(scan) == text_of(expected));
  CHECK(scan.selection == expected.selection);
  CHECK(scan.reference.horizontal_epsg == expected.reference.horizontal_epsg);
}
