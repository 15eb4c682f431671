// SPDX-License-Identifier: MIT
// Reading zipped SRTM tiles.
#include <doctest/doctest.h>
#include <zlib.h>

#include "encoder/import/import.hpp"
#include "tests/support/binary_file.hpp"
#include "tests/support/imports.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;

namespace {

constexpr uint16_t kStored = 0, kDeflated = 8;

std::string tile() {
  std::string bytes(size_t{2} * 1201 * 1201, '\0');
  for (size_t i = 0; i < bytes.size(); i += 7) bytes[i] = static_cast<char>(i % 3);
  return bytes;
}

std::string deflated(const std::string& bytes) {
  z_stream stream{};
  REQUIRE(deflateInit2(&stream, 6, Z_DEFLATED, -15, 8, Z_DEFAULT_STRATEGY) == Z_OK);
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  std::string input = bytes;
  stream.next_in = reinterpret_cast<Bytef*>(input.data());
  stream.avail_in = static_cast<uInt>(input.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  REQUIRE(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

struct Member {
  std::string name;
  uint16_t method = kStored;
  std::string packed;
  uint32_t size = 0;
  uint32_t check = 0;
  uint16_t flags = 0;
};

Member member(const std::string& name, const std::string& bytes, uint16_t method = kStored) {
  const auto* data = reinterpret_cast<const Bytef*>(bytes.data());
  const auto size = static_cast<uInt>(bytes.size());
  return {name, method, method == kDeflated ? deflated(bytes) : bytes, size,
          static_cast<uint32_t>(crc32(0, data, size))};
}

std::string zip(const std::vector<Member>& members, const std::string& comment = "") {
  BinaryFile file;
  BinaryFile list;
  for (const Member& m : members) {
    const auto at = static_cast<uint32_t>(file.bytes().size());
    const auto packed = static_cast<uint32_t>(m.packed.size());
    const auto name = static_cast<uint16_t>(m.name.size());
    file.add(std::string("PK\3\4")).add(uint16_t{20}).add(m.flags).add(m.method).add(0u);
    file.add(m.check).add(packed).add(m.size).add(name).add(uint16_t{2}).add(m.name + "ex");
    file.add(m.packed);
    list.add(std::string("PK\1\2")).add(0x00140014u).add(m.flags).add(m.method).add(0u);
    list.add(m.check).add(packed).add(m.size).add(name).add(uint16_t{0}).add(uint16_t{3});
    list.add(uint16_t{0}).add(uint16_t{0}).add(0u).add(at).add(m.name + "com");
  }
  const auto start = static_cast<uint32_t>(file.bytes().size());
  const auto count = static_cast<uint16_t>(members.size());
  file.add(list.bytes()).add(std::string("PK\5\6")).add(0u).add(count).add(count);
  file.add(static_cast<uint32_t>(list.bytes().size())).add(start);
  return file.add(static_cast<uint16_t>(comment.size())).add(comment).bytes();
}

std::string error(const std::string& bytes) {
  return import_error([&] { import_zip("a.zip", bytes); });
}

std::string error(const Member& one) {
  return error(zip({one}));
}

}  // namespace

TEST_CASE("zip: the tile in it, stored or deflated, among other files") {
  const std::string bytes = tile();
  const Raster raster = import_hgt("N43E007.hgt", bytes);
  for (const uint16_t method : {kStored, kDeflated}) {
    const Raster found = import_zip(
        "some.zip", zip({member("readme.txt", "text"), member("folder/N43E007.HGT", bytes, method)},
                        "a comment"));
    CHECK(found.heights == raster.heights);
    CHECK(found.x.offset == 7 * 1200);
    CHECK(found.reference.horizontal_epsg == 4326);
  }
}

TEST_CASE("zip: tiles of half an arc second, and none that so few bytes cannot hold" * kSlow) {
  const Member fine = member("N43E007.hgt", std::string(size_t{2} * 7201 * 7201, '\1'), kDeflated);
  CHECK(import_zip("a.zip", zip({fine})).width == 7201);
  Member forged = fine;
  forged.packed.resize(1000);
  CHECK(error(forged) == "a.zip: the .hgt file in it is damaged; copy the file again");
}

TEST_CASE("zip: every error is reported") {
  const Member good = member("N43E007.hgt", tile(), kDeflated);
  const auto with = [&](const auto& change) {
    Member one = good;
    change(one);
    return error(one);
  };
  CHECK(error("") == "a.zip: is not a zip archive, or cut off; copy the file again");
  CHECK(error(std::string(70000, 'x')) ==
        "a.zip: is not a zip archive, or cut off; copy the file again");
  CHECK(error(member("a.asc", "x")) ==
        "a.zip: holds no .hgt file; other formats are read unpacked");
  CHECK(error(zip({good, good})) ==
        "a.zip: holds more than one .hgt file: unpack the one that is meant");
  CHECK(error(member("N43E007.hgt", "abc")).find("a.zip/N43E007.hgt: has 3 bytes") == 0);
  CHECK(error(member("\x01.hgt", tile())).find("a.zip/?.hgt: the file's name has no position") ==
        0);
  CHECK(with([](Member& m) { m.flags = 1; }) ==
        "a.zip: the .hgt file is encrypted: unpack it first");
  CHECK(with([](Member& m) { m.method = 12; }) ==
        "a.zip: the .hgt file is packed by method 12; stored and deflated ones are read: unpack it "
        "first");
  CHECK(with([](Member& m) { m.size = 233323203; }) ==
        "a.zip: the .hgt file would have 233323203 bytes, more than 10801 x 10801 posts: unpack it "
        "first");
  const std::string damaged = "a.zip: the .hgt file in it is damaged; copy the file again";
  CHECK(with([](Member& m) { m.size -= 1; }) == damaged);
  CHECK(with([](Member& m) { m.size += 1; }) == damaged);
  CHECK(with([](Member& m) { m.check ^= 1; }) == damaged);
  CHECK(with([](Member& m) { m.packed[50] ^= 1; }) == damaged);
  CHECK(with([](Member& m) { m.packed.pop_back(); }) == damaged);
  CHECK(with([](Member& m) { m.method = kStored; }) == damaged);
  std::string whole = zip({good});
  CHECK(error(whole.replace(0, 2, "xx")) == "a.zip: the archive is damaged; copy the file again");
  whole = zip({good});
  CHECK(error(whole.replace(whole.find("PK\1\2"), 2, "xx")) ==
        "a.zip: the archive's list is damaged; copy the file again");
  CHECK(error(whole.substr(whole.find("PK\5\6"))).find("a.zip: cut off: has 22 bytes") == 0);
}

TEST_CASE("zip: a real tile") {
  const std::string path = data_file("N43E007.hgt.zip");
  if (path.empty()) return;
  const Raster raster = std::get<Raster>(import_terrain(path));
  CHECK(raster.width == 1201);
  CHECK(raster.y.offset == 43 * 1200);
}
