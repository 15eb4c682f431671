// SPDX-License-Identifier: MIT
// SRTM tiles as they are handed out: one .hgt in a zip archive.
#include <zlib.h>

#include <new>

#include "encoder/base/text.hpp"
#include "encoder/files/input.hpp"
#include "encoder/import/import.hpp"

namespace microtin::importing {
namespace {

constexpr uint64_t kMostBytes = uint64_t{2} * 10801 * 10801;  // of an .hgt: a third of a second

constexpr uint64_t kMostFromByte = 1032;  // that deflating packs into one: more is forged

struct Entry {
  std::string_view name;
  uint16_t flags, method;
  uint32_t check;
  uint64_t packed, size;
  uint64_t local_header;
};

// The archive's last record, before a comment of up to 65535 bytes.
uint64_t find_end_record(const ByteReader& file) {
  constexpr uint64_t kBytes = 22, kLongestComment = 65535;
  for (uint64_t behind = kBytes; behind <= kBytes + kLongestComment; ++behind) {
    if (behind > file.size()) break;
    const uint64_t at = file.size() - behind;
    if (file.bytes(at, 4) == std::string_view("PK\5\6")) return at;
  }
  file.fail("is not a zip archive, or cut off; copy the file again");
}

bool is_hgt(std::string_view name) {
  constexpr std::string_view kSuffix = ".hgt";
  return name.size() >= kSuffix.size() &&
         lower_case(std::string(name.substr(name.size() - kSuffix.size()))) == kSuffix;
}

Entry find_hgt(const ByteReader& file) {
  const uint64_t end = find_end_record(file);
  const uint16_t entries = file.number<uint16_t>(end + 10);
  uint64_t at = file.number<uint32_t>(end + 16);
  std::optional<Entry> found;
  for (uint16_t i = 0; i < entries; ++i) {
    if (file.bytes(at, 4) != std::string_view("PK\1\2"))
      file.fail("the archive's list is damaged; copy the file again");
    const uint16_t name_size = file.number<uint16_t>(at + 28);
    const std::string_view name = file.bytes(at + 46, name_size);
    if (is_hgt(name)) {
      if (found) file.fail("holds more than one .hgt file: unpack the one that is meant");
      found = Entry{name,
                    file.number<uint16_t>(at + 8),
                    file.number<uint16_t>(at + 10),
                    file.number<uint32_t>(at + 16),
                    file.number<uint32_t>(at + 20),
                    file.number<uint32_t>(at + 24),
                    file.number<uint32_t>(at + 42)};
    }
    at +=
        46 + uint64_t{name_size} + file.number<uint16_t>(at + 30) + file.number<uint16_t>(at + 32);
  }
  if (!found) file.fail("holds no .hgt file; other formats are read unpacked");
  return *found;
}

// Fills `size` bytes; fewer, more or damaged ones give nothing.
std::optional<std::string> inflated(std::string_view packed, uint64_t size) {
  std::string bytes(static_cast<size_t>(size), '\0');
  z_stream stream{};
  constexpr int kNoHeader = -15;
  if (inflateInit2(&stream, kNoHeader) != Z_OK) throw std::bad_alloc();
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_out = static_cast<uInt>(size);
  const int result = inflate(&stream, Z_FINISH);
  const bool whole = result == Z_STREAM_END && stream.avail_out == 0;
  inflateEnd(&stream);
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  if (!whole) return std::nullopt;
  return bytes;
}

std::string unpacked(const ByteReader& file, const Entry& entry) {
  constexpr uint16_t kStored = 0, kDeflated = 8, kEncrypted = 1;
  if ((entry.flags & kEncrypted) != 0) file.fail("the .hgt file is encrypted: unpack it first");
  if (entry.method != kStored && entry.method != kDeflated) {
    file.fail("the .hgt file is packed by method " + std::to_string(entry.method) +
              "; stored and deflated ones are read: unpack it first");
  }
  if (entry.size > kMostBytes) {
    file.fail("the .hgt file would have " + std::to_string(entry.size) +
              " bytes, more than 10801 x 10801 posts: unpack it first");
  }
  const uint64_t local = entry.local_header;
  if (file.bytes(local, 4) != std::string_view("PK\3\4"))
    file.fail("the archive is damaged; copy the file again");
  const uint64_t at =
      local + 30 + file.number<uint16_t>(local + 26) + file.number<uint16_t>(local + 28);
  const std::string_view packed = file.bytes(at, entry.packed);
  std::optional<std::string> bytes;
  if (entry.method == kDeflated && entry.size <= kMostFromByte * entry.packed) {
    bytes = inflated(packed, entry.size);
  }
  if (entry.method == kStored && packed.size() == entry.size) bytes = packed;
  const auto check_of = [](const std::string& all) {
    return crc32(0, reinterpret_cast<const Bytef*>(all.data()), static_cast<uInt>(all.size()));
  };
  if (!bytes || check_of(*bytes) != entry.check)
    file.fail("the .hgt file in it is damaged; copy the file again");
  return *bytes;
}

}  // namespace

Raster import_zip(const std::string& name, const std::string& bytes) {
  const ByteReader file(name, bytes);
  const Entry entry = find_hgt(file);
  std::string inner(entry.name);
  for (char& c : inner) {
    if (c < ' ' || c > '~') c = '?';
  }
  return import_hgt(name + "/" + inner, unpacked(file, entry));
}

}  // namespace microtin::importing
