// SPDX-License-Identifier: MIT
// Golden packs with what a later version may add: they are read, or refused with one status, on the
// host and on every device.
#include <doctest/doctest.h>

#include <string>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/stream/header.hpp"
#include "tests/support/files.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/noted_metadata.hpp"
#include "tests/support/pack_device.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/report_of_tiles.hpp"

namespace microtin::tests {
namespace {

void append(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

Bytes stream_of(int16_t z) {
  return encode(Tin{{{0, 0, z}, {4, 0, z}, {0, 4, z}, {4, 4, static_cast<int16_t>(z + 1)}}, {}},
                Metadata(), {10, Coding::kBalanced});
}

// A property that this version does not have, and a header that it does not expect.
Bytes with_property(const Bytes& stream) {
  Bytes payload;
  append_varint(payload, uint64_t{1} << 30 | 10u << 5 | 2u << 3);
  payload.resize(90, 3);
  Bytes later(stream.begin(), stream.begin() + kIdentityBytes);
  append_varint(later, payload.size());
  append(later, payload);
  append_check(later, 0);
  return later;
}

Bytes of_later_version(Bytes stream) {
  stream[4] = 255;
  stream.resize(300, 7);
  return stream;
}

Bytes with_chunks(Bytes stream) {
  for (const size_t size : {size_t{0}, size_t{200}}) {
    Bytes chunk;
    append_varint(chunk, 90);
    append_varint(chunk, size);
    chunk.resize(chunk.size() + size, 5);
    append_check(chunk, 0);
    append(stream, chunk);
  }
  return stream;
}

// Puts unknown notes in front of those of a pack, and behind them.
Bytes with_notes(const Bytes& pack) {
  PackHeader header{};
  REQUIRE(read_pack_header(pack.data(), &header) == MICROTIN_STATUS_OK);
  const Bytes first = {200, 5, 0, 'a', '.', 'b', 0, 1}, last = {130, 0, 0};
  const auto from = pack.begin() + kPackFixedBytes + header.placement_bytes;
  const auto end = from + header.note_bytes;
  Bytes changed(pack.begin(), from);
  append(changed, first);
  changed.insert(changed.end(), from, end);
  append(changed, last);
  changed[8] = static_cast<uint8_t>(changed[8] + first.size() + last.size());
  append_check(changed, 0);
  changed.insert(changed.end(), end + kCheckBytes, pack.end());
  return changed;
}

// A tile of four vertices, or of none.
TileSummary tile_of(const Bytes& stream, uint64_t offset) {
  TileSummary tile;
  tile.bytes = static_cast<uint32_t>(stream.size());
  tile.offset = stream.empty() ? 0 : offset;
  tile.stream_hash = stream_hash(kStreamHash, stream.data(), stream.size());
  tile.vertices = stream.empty() ? 0 : 4;
  if (!stream.empty()) add_heights(stream, tile);
  return tile;
}

// One tile, and each note of this version that a pack may have.
Bytes with_each_note() {
  const Bytes stream = stream_of(5);
  PackContent content{{4, 4, 4, 4}, noted_metadata(), {tile_of(stream, 0)}};
  content.metadata.digest.reset();
  content.metadata.phases.clear();
  return pack::write_pack(content, stream);
}

// Eight tiles: good, with an unknown property, of a later version, with chunks; one that shares the
// stream of the first, one without terrain, one behind a gap, a damaged one.
Bytes all_kinds() {
  const Bytes good = stream_of(5), gap(50, 9);
  const std::vector<Bytes> streams = {good,
                                      with_property(good),
                                      of_later_version(good),
                                      with_chunks(stream_of(6)),
                                      good,
                                      {},
                                      stream_of(7),
                                      stream_of(8)};
  PackContent content{{16, 8, 4, 4}, {}, {}};
  content.metadata.source = "x";
  Bytes joined;
  for (size_t i = 0; i < streams.size(); ++i) {
    if (i == 6) append(joined, gap);
    const bool is_shared = i == 4;
    content.tiles.push_back(tile_of(streams[i], is_shared ? 0 : joined.size()));
    if (!is_shared) append(joined, streams[i]);
  }
  Bytes pack = with_notes(pack::write_pack(content, joined));
  pack.back() ^= 1;
  return pack;
}

Bytes with_flag(uint8_t flag, bool is_damaged) {
  Bytes pack = all_kinds();
  PackHeader header{};
  read_pack_header(pack.data(), &header);
  pack[5] = flag;
  pack[7] = 3;  // reserved in this version
  const size_t check = pack_index_start(header) - kCheckBytes;
  put_number(pack, check, crc32(0, pack.data(), check) ^ (is_damaged ? 1 : 0), kCheckBytes);
  return pack;
}

std::vector<std::pair<std::string, Bytes>> golden_packs() {
  return {{"noted", with_each_note()},
          {"unknown", all_kinds()},
          {"flag_low", with_flag(8, false)},
          {"flag_low_damaged", with_flag(8, true)},
          {"flag_high", with_flag(16, true)}};
}

std::string refusal(const Bytes& bytes, uint32_t tile) {
  try {
    PackFile(bytes).tile(tile);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("golden packs: what a later version may add is read, or refused with one status") {
  for (const auto& [name, bytes] : golden_packs()) check_golden_pack(name, bytes);
}

TEST_CASE("golden packs: a device finds each note") {
  const Bytes pack = bytes_of_file(golden("noted.mtp"));
  const auto text = [&](uint8_t type) {
    const uint8_t* content = nullptr;
    uint32_t size = 0;
    CHECK(microtin_find_note(pack.data(), pack.size(), type, &content, &size) ==
          MICROTIN_STATUS_OK);
    return std::string(content, content + size);
  };
  CHECK(text(MICROTIN_NOTE_ATTRIBUTION) == "\xC2\xA9 the <survey>\x1B");
  CHECK(text(MICROTIN_NOTE_LICENSE) == "CC-BY-4.0");
  CHECK(text(MICROTIN_NOTE_VALIDITY) == "2024-01/..");
  CHECK(text(MICROTIN_NOTE_SOURCE_ACCURACY) == std::string("\1\10\0", 3));
  CHECK(text(MICROTIN_NOTE_EPOCH).size() == 4);
  CHECK(text(MICROTIN_NOTE_PLACES)[0] == 2);
  const Metadata metadata = PackFile(pack).metadata();
  CHECK(to_string(*metadata.epoch) == "2020.5");
  CHECK(metadata.places.size() == 2);
}

TEST_CASE("golden packs: the host refuses what a device refuses, for the same reason") {
  const auto of = [](const char* tile, microtin_status status) {
    return std::string(tile) + describe(status);
  };
  const Bytes pack = bytes_of_file(golden("unknown.mtp"));
  CHECK(PackFile(pack).metadata().source == "x");
  CHECK(refusal(pack, 1) == of("tile 1: ", MICROTIN_STATUS_UNSUPPORTED_VERSION));
  CHECK(refusal(pack, 2) == of("tile 2: ", MICROTIN_STATUS_UNSUPPORTED_VERSION));
  CHECK(refusal(pack, 7) == of("tile 7: ", MICROTIN_STATUS_CHECKSUM));
  for (const uint32_t tile : {0u, 3u, 4u, 5u, 6u}) CHECK(refusal(pack, tile).empty());
  const std::string bad =
      "unsupported: 2 tiles (1, 2): " + of("", MICROTIN_STATUS_UNSUPPORTED_VERSION) +
      "; bad: tile 7: " + of("tile 7: ", MICROTIN_STATUS_CHECKSUM);
  CHECK_THROWS_WITH_AS(PackFile(pack).expect_as_stated(), bad.c_str(), Error);
  const std::pair<const char*, microtin_status> flags[] = {
      {"flag_low", MICROTIN_STATUS_UNSUPPORTED_VERSION},
      {"flag_low_damaged", MICROTIN_STATUS_CHECKSUM},
      {"flag_high", MICROTIN_STATUS_UNSUPPORTED_VERSION}};
  for (const auto& [name, status] : flags) {
    CHECK(refusal(bytes_of_file(golden(std::string(name) + ".mtp")), 0) == describe(status));
    CHECK(read_file(golden(std::string(name) + ".report")) ==
          "header " + std::to_string(static_cast<int>(status)) + "\n");
  }
}

}  // namespace microtin::tests
