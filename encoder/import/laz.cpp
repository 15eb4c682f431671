// SPDX-License-Identifier: MIT
// LAZ: the points of a LAS file, compressed in chunks. Ours: what compresses them is read of their
// record, then the table of chunks, then each chunk for itself.
#include "encoder/import/laz.hpp"

#include <algorithm>
#include <string>

#include "encoder/base/work.hpp"

namespace microtin::importing {
namespace {

constexpr const char* kUnpack =
    "decompress it first, with laszip, las2las or \"pdal translate IN.laz OUT.las\"";

enum LazItem : uint16_t {
  kBytes = 0,
  kPoint = 6,
  kTime = 7,
  kColour = 8,
  kRecentPoint = 10,
  kRecentColour = 11,
  kRecentNearInfrared = 12,
  kRecentWave = 13,
  kRecentBytes = 14
};

// A part of a record of LAS, compressed for itself.
struct LazPart {
  uint16_t item;
  uint32_t bytes;
};

// The parts of a format. Bytes that the writer added follow them.
std::vector<LazPart> parts_of(uint8_t point_format) {
  switch (point_format) {
    case 0:
      return {{kPoint, 20}};
    case 1:
      return {{kPoint, 20}, {kTime, 8}};
    case 2:
      return {{kPoint, 20}, {kColour, 6}};
    case 3:
      return {{kPoint, 20}, {kTime, 8}, {kColour, 6}};
    case 6:
      return {{kRecentPoint, 30}};
    case 7:
      return {{kRecentPoint, 30}, {kRecentColour, 6}};
    case 8:
      return {{kRecentPoint, 30}, {kRecentNearInfrared, 8}};
    case 9:
      return {{kRecentPoint, 30}, {kRecentWave, 29}};
    case 10:
      return {{kRecentPoint, 30}, {kRecentNearInfrared, 8}, {kRecentWave, 29}};
    default:
      return {};
  }
}

uint32_t layers_of(const LazPart& part) {
  switch (part.item) {
    case kRecentPoint:
      return 9;
    case kRecentNearInfrared:
      return 2;
    case kRecentBytes:
      return part.bytes;
    default:
      return 1;
  }
}

// The record of LASzip: how points are compressed, and into which parts.
class LazSettings {
 public:
  LazSettings(const std::string& name, const ByteReader& file, const LazHeader& header)
      : file_(file), header_(header), record_(name, header.record) {
    if (header.record.empty()) {
      file.fail(std::string("is compressed (LAZ) without a record of LASzip: ") + kUnpack);
    }
    const bool is_layered = header.point_format >= 6;
    const uint16_t compressor = is_layered ? 3 : 2;
    if (number(0) != compressor || number(2) != 0) {
      refuse("compressor " + std::to_string(number(0)) + " with coder " +
             std::to_string(number(2)));
    }
    check_parts();
  }

  uint32_t chunk_points() const { return record_.number<uint32_t>(12); }

  LazRecord layout() const {
    LazRecord layout;
    layout.point_format = header_.point_format;
    for (const LazPart& part : parts_) {
      layout.bytes += part.bytes;
      layout.has_time = layout.has_time || part.item == kTime;
      layout.has_colour = layout.has_colour || part.item == kColour;
      if (part.item == kBytes) layout.extra_bytes = part.bytes;
      if (header_.point_format >= 6) layout.layers += layers_of(part);
    }
    return layout;
  }

 private:
  uint16_t number(uint64_t at) const { return record_.number<uint16_t>(at); }

  [[noreturn]] void refuse(const std::string& what) const {
    file_.fail("is compressed (LAZ) in a way that is not read, " + what +
               ", with points of format " + std::to_string(header_.point_format) + ": " + kUnpack);
  }

  void check_parts() {
    parts_ = parts_of(header_.point_format);
    if (parts_.empty()) refuse("waveforms");
    uint32_t bytes = 0;
    for (const LazPart& part : parts_) bytes += part.bytes;
    const bool is_layered = header_.point_format >= 6;
    if (header_.point_bytes > bytes) {
      parts_.push_back({is_layered ? kRecentBytes : kBytes, header_.point_bytes - bytes});
    }
    if (number(32) != parts_.size()) refuse(std::to_string(number(32)) + " items");
    for (size_t i = 0; i < parts_.size(); ++i) {
      const uint64_t at = 34 + 6 * i;
      const uint16_t version = number(at + 4);
      if (number(at) != parts_[i].item || number(at + 2) != parts_[i].bytes ||
          !(is_layered ? version == 3 || version == 4 : version == 2)) {
        refuse("item " + std::to_string(number(at)) + " of version " + std::to_string(version));
      }
    }
  }

  const ByteReader& file_;
  const LazHeader& header_;
  ByteReader record_;
  std::vector<LazPart> parts_;
};

struct LazChunk {
  uint64_t at;
  uint64_t bytes;
  uint32_t points;
};

// The table of chunks. Every chunk has a record and lies in the file, so that there are not more
// chunks than the file has bytes.
class LazTable {
 public:
  LazTable(const ByteReader& file, const LazHeader& header, const LazSettings& settings)
      : file_(file), header_(header), settings_(settings) {}

  std::vector<LazChunk> read() const {
    const uint64_t table = place();
    if (file_.number<uint32_t>(table) != 0) fail("is of an unknown version");
    const auto count = file_.number<uint32_t>(table + 4);
    const std::string_view bytes = file_.bytes(table + 8, file_.size() - table - 8);
    std::vector<LazChunk> chunks;
    try {
      read_chunks(table, count, bytes, chunks);
    } catch (const Error& error) {
      fail(error.text());
    }
    return chunks;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    file_.fail("damaged: the table of chunks " + what + "; copy the file again");
  }

  // A writer that could not go back has stated the place at the end of the file.
  uint64_t place() const {
    const uint64_t begin = header_.first_point + 8;
    auto place = file_.number<uint64_t>(header_.first_point);
    if (place == UINT64_MAX) place = file_.number<uint64_t>(file_.size() - 8);
    if (place < begin || place > file_.size() || file_.size() - place < 8) {
      file_.fail("cut off: has " + std::to_string(file_.size()) +
                 " bytes, and the table of chunks begins at byte " + std::to_string(place));
    }
    return place;
  }

  void read_chunks(uint64_t end, uint32_t count, std::string_view bytes,
                   std::vector<LazChunk>& chunks) const {
    const uint32_t size = settings_.chunk_points();
    const bool is_variable = size == UINT32_MAX;
    uint64_t left = header_.points;
    LazChunk chunk = {header_.first_point + 8, 0, 0};
    if (size == 0) throw Error("belongs to chunks of no points");
    if (count == 0) throw Error("is empty");
    LazDecoder decoder(bytes);
    LazIntegers integers(32, 2);
    const auto next = [&](uint64_t last, uint32_t context) {
      return static_cast<uint32_t>(last) + integers.difference(decoder, context);
    };
    for (uint32_t i = 0; i < count; ++i) {
      chunk.points = is_variable ? next(chunk.points, 0)
                                 : static_cast<uint32_t>(std::min<uint64_t>(size, left));
      chunk.bytes = next(chunk.bytes, 1);
      if (chunk.bytes == 0) throw Error("names a chunk of no bytes");
      if (chunk.bytes > end - chunk.at) throw Error("names bytes behind its own begin");
      if (chunk.points > left) throw Error("names more points than the header");
      if (chunk.bytes < header_.point_bytes && chunk.points != 0) {
        throw Error("has a chunk that is too small for a point");
      }
      if (chunk.points != 0) chunks.push_back(chunk);
      chunk.at += chunk.bytes;
      left -= chunk.points;
    }
    if (left != 0) throw Error("lacks " + std::to_string(left) + " of the header's points");
  }

  const ByteReader& file_;
  const LazHeader& header_;
  const LazSettings& settings_;
};

}  // namespace

std::vector<std::vector<ScanPoint>> unpack_laz(const std::string& name, const ByteReader& file,
                                               const LazHeader& header) {
  const LazSettings settings(name, file, header);
  const LazRecord layout = settings.layout();
  const std::vector<LazChunk> chunks = LazTable(file, header, settings).read();
  std::vector<std::vector<ScanPoint>> points(chunks.size());
  for_each_parallel(chunks.size(), [&](size_t i) {
    const LazChunk& chunk = chunks[i];
    try {
      points[i] = unpack_chunk(file.bytes(chunk.at, chunk.bytes), chunk.points, layout);
    } catch (const Error& error) {
      file.fail("damaged: chunk " + std::to_string(i + 1) + " of " + std::to_string(chunks.size()) +
                ", from byte " + std::to_string(chunk.at) + " on, " + error.text() +
                "; copy the file again");
    }
  });
  return points;
}

}  // namespace microtin::importing
