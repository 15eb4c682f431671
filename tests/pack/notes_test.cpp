// SPDX-License-Identifier: MIT
// Notes as a device finds them, in headers sound and hostile.
#include <doctest/doctest.h>

#include <algorithm>
#include <optional>

#include "encoder/pack/file.hpp"
#include "encoder/stream/header.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

using Bytes = std::vector<uint8_t>;

struct Found {
  microtin_status status;
  const uint8_t* content;
  uint32_t size;
};

Found find_note(const uint8_t* bytes, size_t size, uint8_t type) {
  Found found{MICROTIN_STATUS_OK, bytes, 12345};
  found.status = microtin_find_note(bytes, size, type, &found.content, &found.size);
  return found;
}

// Nothing if there is no such note.
std::optional<Bytes> content_of(const Bytes& header, uint8_t type) {
  const Found found = find_note(header.data(), header.size(), type);
  if (found.status == MICROTIN_STATUS_NOT_FOUND) {
    CHECK(found.content == nullptr);
    CHECK(found.size == 0);
    return std::nullopt;
  }
  CHECK(found.status == MICROTIN_STATUS_OK);
  return Bytes(found.content, found.content + found.size);
}

// A stream's header with any bytes as notes.
Bytes stream_header(const Bytes& notes, const Placement& placement = {}) {
  Metadata metadata;
  metadata.placement = placement;
  Contract contract{4, 99, 99, kMinDegree, Coding::kBalanced, false, false, true, false};
  contract.above = static_cast<uint32_t>(notes.size());
  const Bytes bare = write_header(contract, metadata);
  const size_t start = kIdentityBytes + 1;  // its length takes one byte
  Bytes payload(bare.begin() + start, bare.end() - kCheckBytes);
  payload.insert(payload.end(), notes.begin(), notes.end());
  Bytes header(bare.begin(), bare.begin() + kIdentityBytes);
  append_varint(header, payload.size());
  header.insert(header.end(), payload.begin(), payload.end());
  append_check(header, 0);
  return header;
}

// The header of a pack with these notes.
Bytes pack_header(const Bytes& notes, const Placement& placement = {}) {
  PackContent pack{{100, 100, 50, 50}, {}, {}};
  pack.metadata.placement = placement;
  Bytes header = write_pack_header(pack);
  header.resize(kPackFixedBytes + size_t{header[6]});  // without the padding
  header[8] = static_cast<uint8_t>(notes.size());
  header[9] = static_cast<uint8_t>(notes.size() >> 8);
  header.insert(header.end(), notes.begin(), notes.end());
  append_check(header, 0);
  return header;
}

const Placement kPlaced = {{-9'000'000'000, 1, 3}, {1, 2, 1}, {0, 1, 10}};

// What an independent reader finds: the end of the notes is -1, a note beyond it -2.
int position_of(const Bytes& notes, uint8_t type) {
  int at = 0;
  const int end = static_cast<int>(notes.size());
  while (at != end) {
    if (at + 3 > end) return -2;
    const int size = notes[static_cast<size_t>(at) + 1] + 256 * notes[static_cast<size_t>(at) + 2];
    if (at + 3 + size > end) return -2;
    if (notes[static_cast<size_t>(at)] == type) return at;
    at += 3 + size;
  }
  return -1;
}

}  // namespace

TEST_CASE("notes: a device finds in streams and packs what was written") {
  Metadata metadata = full_metadata();
  metadata.date = "2026-11";
  metadata.wkt = "LOCAL_CS[\"site\"]";
  metadata.classes = ClassSet().set(2).set(9);
  const Bytes notes = write_notes(metadata);
  PackContent pack{{100, 100, 50, 50}, metadata, {}};
  for (const Bytes& header : {encode(rolling_tin(10, 5), metadata), write_pack_header(pack)}) {
    CHECK(content_of(header, MICROTIN_NOTE_UNITS) == Bytes{2, 1});
    CHECK(content_of(header, MICROTIN_NOTE_DATE) == Bytes{'2', '0', '2', '6', '-', '1', '1'});
    CHECK(content_of(header, MICROTIN_NOTE_CLASSES) == Bytes{2, 2, 9, 9});
    CHECK(content_of(header, MICROTIN_NOTE_GRID) == Bytes{0x89, 0x31, 0x89, 0x31});
    const std::optional<Bytes> wkt = content_of(header, MICROTIN_NOTE_WKT);
    CHECK(wkt == Bytes(metadata.wkt.begin(), metadata.wkt.end()));
    CHECK(content_of(header, MICROTIN_NOTE_LINEAGE) == std::nullopt);
    CHECK(content_of(header, 200) == std::nullopt);
    CHECK(content_of(header, 255) == std::nullopt);
  }
}

TEST_CASE("notes: an incomplete header returns how many bytes it needs") {
  const Bytes notes = {3, 1, 0, 'a', 7, 2, 0, 4, 1};
  for (const Bytes& header : {stream_header(notes, kPlaced), pack_header(notes, kPlaced)}) {
    for (size_t size = 0; size < header.size(); ++size) {
      const Bytes prefix(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(size));
      const Found found = find_note(prefix.data(), size, 7);
      CHECK(found.status == MICROTIN_STATUS_NEED_INPUT);
      CHECK(found.content == nullptr);
      CHECK((found.size == 0 || (found.size > size && found.size <= header.size())));
      if (size >= kPackFixedBytes) CHECK(found.size == header.size());
    }
    CHECK(content_of(header, 7) == Bytes{4, 1});
  }
}

TEST_CASE("notes: wrong arguments, and what is neither stream nor pack") {
  const Bytes header = stream_header({});
  const uint8_t* content = nullptr;
  uint32_t size = 0;
  CHECK(microtin_find_note(nullptr, 9, 3, &content, &size) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_find_note(header.data(), 9, 3, nullptr, &size) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_find_note(header.data(), 9, 3, &content, nullptr) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_find_note(nullptr, 0, 3, &content, &size) == MICROTIN_STATUS_NEED_INPUT);
  const Bytes other(40, 'm');
  CHECK(find_note(other.data(), other.size(), 3).status == MICROTIN_STATUS_BAD_MAGIC);
  for (Bytes later : {stream_header({}), pack_header({})}) {
    ++later[4];
    CHECK(find_note(later.data(), later.size(), 3).status == MICROTIN_STATUS_UNSUPPORTED_VERSION);
  }
}

TEST_CASE("notes: unknown flags of a pack leave the notes in place, or make all unknown") {
  const Bytes notes = {200, 1, 0, 'x', 3, 1, 0, 'a'};
  const Bytes plain = pack_header(notes, kPlaced);
  for (uint32_t flags = 1; flags < 256; ++flags) {
    Bytes flagged = plain;
    flagged[5] = static_cast<uint8_t>(flags);
    const auto status = [&] { return find_note(flagged.data(), flagged.size(), 3).status; };
    const bool is_known = flags < 16;
    CAPTURE(flags);
    CHECK(status() == (is_known ? MICROTIN_STATUS_CHECKSUM : MICROTIN_STATUS_UNSUPPORTED_VERSION));
    flagged[7] = 1;  // reserved here
    flagged.resize(flagged.size() - kCheckBytes);
    append_check(flagged, 0);
    CHECK(status() == (is_known ? MICROTIN_STATUS_OK : MICROTIN_STATUS_UNSUPPORTED_VERSION));
    if (is_known) CHECK(content_of(flagged, 3) == Bytes{'a'});
  }
}

TEST_CASE("notes: any bytes in their place are searched within bounds") {
  Random random(17);
  for (int round = 0; round < 3000; ++round) {
    Bytes notes(random.below(40));
    for (uint8_t& byte : notes)
      byte = static_cast<uint8_t>(random.below(random.below(2) ? 4 : 256));
    const Placement placement = random.below(2) != 0 ? kPlaced : Placement();
    const uint8_t type = static_cast<uint8_t>(random.below(5));
    const int expected = position_of(notes, type);
    for (const Bytes& header : {stream_header(notes, placement), pack_header(notes, placement)}) {
      const Found found = find_note(header.data(), header.size(), type);
      CHECK(found.status == (expected == -2   ? MICROTIN_STATUS_MALFORMED
                             : expected == -1 ? MICROTIN_STATUS_NOT_FOUND
                                              : MICROTIN_STATUS_OK));
      const size_t start = header.size() - kCheckBytes - notes.size();
      if (expected < 0) {
        CHECK(found.content == nullptr);
        CHECK(found.size == 0);
      } else {
        CHECK(found.content == header.data() + start + expected + 3);
        CHECK(found.size == read_u16(found.content - 2));
      }
    }
  }
}

// What a finder says of a header that comes in pieces, and what it copies.
struct Streamed {
  microtin_status status;
  Bytes content;
  uint32_t size;
};

Streamed find_in_pieces(const Bytes& header, uint8_t type, uint32_t capacity, Random& random) {
  Bytes buffer(capacity + 1, 0xEE);
  microtin_note_finder finder;
  microtin_note_finder_init(&finder, type, buffer.data(), capacity);
  microtin_status status = microtin_note_finder_feed(&finder, nullptr, 0);
  for (size_t at = 0; at < header.size() && status == MICROTIN_STATUS_NEED_INPUT;) {
    const size_t size = std::min<size_t>(1 + random.below(9), header.size() - at);
    status = microtin_note_finder_feed(&finder, header.data() + at, size);
    at += size;
  }
  CHECK(microtin_note_finder_feed(&finder, header.data(), 0) == status);
  CHECK(buffer.back() == 0xEE);
  buffer.resize(std::min(capacity, finder.content_size));
  return {status, buffer, finder.content_size};
}

TEST_CASE("notes: a finder that is fed finds what is found at once, in 64 bytes") {
  static_assert(sizeof(microtin_note_finder) <= 64, "it is promised");
  Random random(18);
  int found_notes = 0;
  for (int round = 0; round < 2000; ++round) {
    Bytes notes;
    for (uint32_t left = random.below(5); left != 0; --left) {
      const Bytes content(random.below(9), static_cast<uint8_t>(left));
      notes.push_back(static_cast<uint8_t>(random.below(5)));
      append_number(notes, content.size(), 2);
      notes.insert(notes.end(), content.begin(), content.end());
    }
    if (random.below(4) == 0) notes.push_back(7);  // begins a note that does not end
    const Placement placement = random.below(2) != 0 ? kPlaced : Placement();
    const uint8_t type = static_cast<uint8_t>(random.below(5));
    const uint32_t capacity = random.below(6);
    for (Bytes header : {stream_header(notes, placement), pack_header(notes, placement)}) {
      if (random.below(3) == 0) header[random.below(static_cast<uint32_t>(header.size()))] ^= 1;
      header.push_back(9);  // what follows is not looked at
      const Found at_once = find_note(header.data(), header.size(), type);
      const Streamed fed = find_in_pieces(header, type, capacity, random);
      CHECK(fed.status == at_once.status);
      if (at_once.status != MICROTIN_STATUS_OK) continue;
      ++found_notes;
      CHECK(fed.size == at_once.size);
      const uint32_t copied = std::min(capacity, at_once.size);
      CHECK(fed.content == Bytes(at_once.content, at_once.content + copied));
    }
  }
  CHECK(found_notes > 500);
}

TEST_CASE("notes: a changed byte is reported, and forged headers keep the search within bounds") {
  const Bytes notes = {3, 1, 0, 'a', 7, 2, 0, 4, 1};
  for (const Bytes& header : {stream_header(notes, kPlaced), pack_header(notes, kPlaced)}) {
    for (size_t at = 0; at < header.size(); ++at) {
      for (int bit = 0; bit < 8; ++bit) {
        Bytes changed = header;
        changed[at] = static_cast<uint8_t>(changed[at] ^ 1 << bit);
        const Found damaged = find_note(changed.data(), changed.size(), 7);
        CHECK(damaged.status != MICROTIN_STATUS_OK);
        CHECK(damaged.status != MICROTIN_STATUS_NOT_FOUND);
        CHECK(damaged.content == nullptr);
        changed.resize(changed.size() - kCheckBytes);
        append_check(changed, 0);
        const Found forged = find_note(changed.data(), changed.size(), 7);
        if (forged.content == nullptr) continue;
        CHECK(forged.status == MICROTIN_STATUS_OK);
        CHECK(forged.content >= changed.data());
        CHECK(forged.content + forged.size <= changed.data() + changed.size() - kCheckBytes);
      }
    }
  }
}

TEST_CASE("notes: the parity of a tile's origin reaches the header, and nothing else changes") {
  const Tin tin = rolling_tin(40, 6);
  for (const Origin origin : {Origin{false, false}, Origin{true, false}, Origin{false, true}}) {
    const Encoding encoding = encode_and_decode(tin, Metadata(), {}, origin);
    const Contract contract = read_header(encoding.stream).contract;
    CHECK(contract.odd_origin_x == origin.odd_x);
    CHECK(contract.odd_origin_y == origin.odd_y);
    CHECK(contract.degree == usual_degree(Effort()));
    const Contract kept = read_header(with_metadata(encoding.stream, full_metadata())).contract;
    CHECK(kept.odd_origin_x == origin.odd_x);
    CHECK(kept.odd_origin_y == origin.odd_y);
  }
}

}  // namespace microtin::tests
