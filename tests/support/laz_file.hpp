// SPDX-License-Identifier: MIT
// Files of LAS and LAZ with made-up points.
#ifndef MICROTIN_TESTS_SUPPORT_LAZ_FILE_HPP
#define MICROTIN_TESTS_SUPPORT_LAZ_FILE_HPP

#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "tests/support/binary_file.hpp"
#include "tests/support/laz_points.hpp"

namespace microtin::tests {

// How a file is compressed.
struct LazOptions {
  uint32_t chunk_points = 50000;
  std::vector<uint32_t> chunks = {};  // points of each; empty: chunk_points in each but the last
  bool has_place_at_end = false;      // of the table of chunks, as writers to pipes have it
  uint32_t filling = 0;               // bytes of each layer that microtin does not read
  uint16_t layered_version = 3;
};

struct LazItems {
  std::vector<std::array<uint16_t, 3>> list;  // types, bytes, versions
  uint32_t other_layers = 0;
};

inline LazItems laz_items(uint8_t point_format, uint16_t point_bytes, uint16_t layered_version) {
  LazItems items;
  uint32_t left = point_bytes;
  const auto add = [&](uint32_t type, uint32_t bytes, uint32_t layers) {
    const auto version = static_cast<uint16_t>(point_format >= 6 ? layered_version : 2);
    items.list.push_back({static_cast<uint16_t>(type), static_cast<uint16_t>(bytes), version});
    items.other_layers += layers;
    left -= bytes;
  };
  if (point_format < 6) {
    add(6, 20, 0);
    if (point_format % 2 == 1) add(7, 8, 0);
    if (point_format >= 2) add(8, 6, 0);
    if (left != 0) add(0, left, 0);
    return items;
  }
  add(10, 30, 0);
  if (point_format == 7) add(11, 6, 1);
  if (point_format == 8 || point_format == 10) add(12, 8, 2);
  if (point_format >= 9) add(13, 29, 1);
  if (left != 0) add(14, left, left);
  return items;
}

inline std::string laz_record(uint8_t point_format, uint16_t point_bytes,
                              const LazOptions& options) {
  const LazItems items = laz_items(point_format, point_bytes, options.layered_version);
  BinaryFile record;
  record.put(2, std::string("laszip encoded")).put(18, uint16_t{22204});
  record.put(20, static_cast<uint16_t>(34 + 6 * items.list.size()));
  record.put(54, static_cast<uint16_t>(point_format < 6 ? 2 : 3)).put(58, uint8_t{3});
  record.put(54 + 12, options.chunks.empty() ? options.chunk_points : UINT32_MAX);
  record.put(54 + 16, int64_t{-1}).put(54 + 24, int64_t{-1});
  record.put(54 + 32, static_cast<uint16_t>(items.list.size()));
  for (const auto& item : items.list) {
    for (const uint16_t number : item) record.add(number);
  }
  return record.bytes();
}

inline std::string laz_chunk(const std::vector<std::string>& records, uint8_t point_format,
                             const LazOptions& options) {
  const std::string& first = records.front();
  if (point_format < 6) {
    InterleavedEncoder encoder(first, point_format);
    for (size_t i = 1; i < records.size(); ++i) encoder.add(records[i]);
    return first + encoder.finished();
  }
  LayeredEncoder encoder(first);
  for (size_t i = 1; i < records.size(); ++i) encoder.add(records[i]);
  const auto point_bytes = static_cast<uint16_t>(first.size());
  const LazItems items = laz_items(point_format, point_bytes, options.layered_version);
  return first + BinaryFile().add(static_cast<uint32_t>(records.size())).bytes() +
         encoder.finished(items.other_layers, options.filling);
}

// Compresses the points of a file that has no extended records.
inline std::string compressed(const std::string& las, const LazOptions& options = {}) {
  const auto format = static_cast<uint8_t>(las[104]);
  const auto point_bytes = number_at<uint16_t>(las, 105);
  const auto first = number_at<uint32_t>(las, 96);
  const std::string record = laz_record(format, point_bytes, options);
  BinaryFile file;
  file.add(las.substr(0, first) + record);
  const auto points_at = static_cast<uint32_t>(file.bytes().size());
  file.put(104, static_cast<uint8_t>(format | 128)).put(96, points_at);
  file.put(100, number_at<uint32_t>(las, 100) + 1).put(points_at, int64_t{-1});
  LazEncoder table;
  IntegerEncoder integers(32, 2);
  uint32_t chunks = 0, last_points = 0, last_bytes = 0;
  for (size_t at = first; at + point_bytes <= las.size(); ++chunks) {
    const uint32_t wanted = options.chunks.empty() ? options.chunk_points : options.chunks[chunks];
    std::vector<std::string> records;
    for (; records.size() < wanted && at + point_bytes <= las.size(); at += point_bytes) {
      records.push_back(las.substr(at, point_bytes));
    }
    const std::string chunk = laz_chunk(records, format, options);
    const auto points = static_cast<uint32_t>(records.size()),
               bytes = static_cast<uint32_t>(chunk.size());
    if (!options.chunks.empty()) {
      integers.encode(table, static_cast<int32_t>(last_points), static_cast<int32_t>(points), 0);
    }
    integers.encode(table, static_cast<int32_t>(last_bytes), static_cast<int32_t>(bytes), 1);
    last_points = points;
    last_bytes = bytes;
    file.add(chunk);
  }
  const auto place = static_cast<int64_t>(file.bytes().size());
  file.add(uint32_t{0}).add(chunks).add(table.finished());
  return options.has_place_at_end ? file.add(place).bytes() : file.put(points_at, place).bytes();
}

inline constexpr uint16_t kRecordBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};

// A record of a walk through all values that a format has: what is rare changes rarely. `pace` is
// the usual step of times.
inline void step_record(std::string& record, uint8_t point_format, int64_t pace,
                        std::mt19937& random) {
  const bool is_recent = point_format >= 6;
  const auto once_in = [&](uint32_t times) { return random() % times == 0; };
  const auto put = [&](size_t at, auto value) { std::memcpy(&record[at], &value, sizeof value); };
  for (const size_t at : {0u, 4u, 8u}) {
    const int32_t reach = once_in(400) ? 1 << 28 : once_in(20) ? 5000 : 60;
    const auto offset = static_cast<int32_t>(random() % (2 * static_cast<uint32_t>(reach))) - reach;
    put(at, static_cast<int32_t>(number_at<uint32_t>(record, at) / 2) / 2 + offset);
  }
  const auto change = [&](size_t from, size_t to, uint32_t times) {
    for (size_t at = from; at < to; ++at) {
      if (once_in(times)) record[at] = static_cast<char>(random());
    }
  };
  change(12, 14, 3);
  change(14, 15, 4);
  if (once_in(8)) put(15, static_cast<uint8_t>(is_recent ? random() : random() & 0xE7));
  if (is_recent && once_in(5)) put(16, static_cast<uint8_t>(random() % 40));
  change(is_recent ? 17 : 16, is_recent ? 20 : 18, 9);
  change(is_recent ? 20 : 18, is_recent ? 22 : 20, 40);
  const size_t time = is_recent ? 22 : point_format % 2 == 1 ? 20 : 0;
  if (time != 0 && !once_in(3)) {
    const int64_t steps = once_in(60)   ? static_cast<int64_t>(random()) << 20
                          : once_in(10) ? static_cast<int64_t>(random() % 1200) - 600
                                        : 1;
    const uint64_t rest = once_in(2) ? 3 : 0;  // times wrap around
    put(time, number_at<uint64_t>(record, time) +
                  static_cast<uint64_t>(steps) * static_cast<uint64_t>(pace) + rest);
  }
  change(is_recent ? 30 : time != 0 ? 28 : 20, record.size(), 6);
}

// A file of LAS 1.4 or, for formats below 6, 1.2, in hundredths, with these records of one size.
inline std::string scan_of(uint8_t point_format, uint16_t point_bytes, const std::string& records) {
  const bool is_recent = point_format >= 6;
  const uint16_t head = is_recent ? 375 : 227;
  const size_t points = records.size() / point_bytes;
  BinaryFile file;
  file.put(0, std::string("LASF")).put(24, uint8_t{1});
  file.put(25, static_cast<uint8_t>(is_recent ? 4 : 2)).put(94, head).put(96, uint32_t{head});
  file.put(104, point_format).put(105, point_bytes);
  file.put(107, is_recent ? 0u : static_cast<uint32_t>(points));
  for (size_t axis = 0; axis < 3; ++axis) file.put(131 + 8 * axis, 0.01).put(155 + 8 * axis, 0.0);
  file.put(head - 1u, '\0');
  if (is_recent) file.put(247, uint64_t{points});
  return file.add(records.substr(0, points * point_bytes)).bytes();
}

// Some points, with bytes of the writer's own.
inline std::string made_scan(uint8_t point_format, uint32_t points, uint32_t extra_bytes = 0,
                             uint32_t seed = 1) {
  const auto point_bytes = static_cast<uint16_t>(kRecordBytes[point_format] + extra_bytes);
  std::mt19937 random(seed);
  std::string record(point_bytes, '\0'), records;
  constexpr int64_t kPaces[] = {1000, 700000, -15000, 20};
  for (uint32_t i = 0; i < points; ++i) {
    step_record(record, point_format, kPaces[i / 100 % 4], random);
    records += record;
  }
  return scan_of(point_format, point_bytes, records);
}

}  // namespace microtin::tests

#endif
