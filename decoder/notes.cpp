// SPDX-License-Identifier: MIT
// Finding a note in a header, byte by byte.
#include "microtin/microtin.h"
#include "shared/pack_format.hpp"

namespace microtin {
namespace {

typedef microtin_note_finder Finder;

// What the next byte belongs to.
enum Part : uint8_t {
  kIdentityPart,
  kLengthPart,     // of a stream's header
  kNumbersPart,    // properties if `left` is 0, else `left` numbers, the placement's among them
  kFixedPart,      // of a pack's header
  kPlacementPart,  // of a pack: `left` bytes
  kHeadPart,       // of a note: `left` bytes
  kContentPart,    // of a note: `left` bytes
  kRestPart,       // up to the check: not read
  kCheckPart
};

// What is wrong is reported when the check has passed: before that, it is damage.
void fail(Finder& f, microtin_status verdict) {
  f.verdict = static_cast<uint8_t>(verdict);
  f.part = kRestPart;
}

void expect_note(Finder& f) {
  f.left = kNoteHeadBytes;
  f.part = kHeadPart;
}

// Streams have the shorter identity.
microtin_status take_identity(Finder& f, uint8_t byte) {
  f.identity[f.position - 1] = byte;
  microtin_status known = MICROTIN_STATUS_NEED_INPUT;
  if (f.position == kIdentityBytes) {
    known = check_identity(f.identity);
    f.part = kLengthPart;
  }
  if (known == MICROTIN_STATUS_BAD_MAGIC) {
    known = MICROTIN_STATUS_NEED_INPUT;
    f.part = kIdentityPart;
  }
  if (f.position == kPackIdentityBytes) {
    known = check_pack_identity(f.identity);
    f.part = kFixedPart;
  }
  return known == MICROTIN_STATUS_OK ? MICROTIN_STATUS_NEED_INPUT : known;
}

// `end` is below 2^31 + 10.
void take_length_of_header(Finder& f, uint8_t byte) {
  bool legal = true;
  if (take_length(&f.number, byte, &legal)) return;
  f.end = f.position + f.number;
  f.number = f.left = 0;
  f.part = kNumbersPart;
  if (!legal) fail(f, MICROTIN_STATUS_MALFORMED);
}

// Three numbers follow the properties, and those that these announce.
void take_number(Finder& f, uint8_t byte) {
  if (f.number >> kPropertyBits == 0) f.number = f.number << 7 | (byte & 127u);
  if (byte >= 128) return;
  if (f.left == 0) {
    f.left = 3u + ((f.number & kHasMargins) != 0 ? 2u : 0u) +
             ((f.number & kHasPlacement) != 0 ? 9u : 0u);
    if (f.number >> kPropertyBits != 0) fail(f, MICROTIN_STATUS_UNSUPPORTED_VERSION);
  } else if (--f.left == 0) {
    expect_note(f);
  }
  f.number = 0;
}

// `left` becomes the size of the placement, `number` that of the notes.
void take_fixed(Finder& f, uint8_t byte) {
  const uint32_t at = f.position - 1;
  if (at == 6) f.left = byte;
  if (at == 8) f.number = byte;
  if (at == 9) f.number |= static_cast<uint32_t>(byte) << 8;
  if (f.position != kPackFixedBytes) return;
  f.end = f.position + f.left + f.number;
  f.part = kPlacementPart;
  if (f.left == 0) expect_note(f);
}

void end_content(Finder& f) {
  expect_note(f);
  if (f.note != f.type) return;
  f.verdict = MICROTIN_STATUS_OK;
  f.part = kRestPart;  // the first of a type counts
}

void take_head(Finder& f, uint8_t byte) {
  if (f.left == kNoteHeadBytes) f.note = byte;
  if (f.left == 2) f.number = byte;
  if (--f.left != 0) return;
  f.left = f.number | static_cast<uint32_t>(byte) << 8;
  if (f.left > f.end - f.position) return fail(f, MICROTIN_STATUS_MALFORMED);
  if (f.note == f.type) {
    f.content_at = f.position;
    f.content_size = f.left;
  }
  f.part = kContentPart;
  if (f.left == 0) end_content(f);
}

void take_content(Finder& f, uint8_t byte) {
  const uint32_t i = f.content_size - f.left;
  if (f.note == f.type && i < f.capacity) f.buffer[i] = byte;
  if (--f.left == 0) end_content(f);
}

// NEED_INPUT: go on.
microtin_status take(Finder& f, uint8_t byte) {
  switch (f.part) {
    case kIdentityPart:
      return take_identity(f, byte);
    case kLengthPart:
      take_length_of_header(f, byte);
      break;
    case kNumbersPart:
      take_number(f, byte);
      break;
    case kFixedPart:
      take_fixed(f, byte);
      break;
    case kPlacementPart:
      if (--f.left == 0) expect_note(f);
      break;
    case kHeadPart:
      take_head(f, byte);
      break;
    case kContentPart:
      take_content(f, byte);
      break;
    default:
      break;
  }
  if (f.position == f.end) {
    if (f.part != kRestPart && !(f.part == kHeadPart && f.left == kNoteHeadBytes)) {
      fail(f, MICROTIN_STATUS_MALFORMED);
    }
    f.part = kCheckPart;
  }
  if (f.part != kCheckPart || f.position != f.end + kCheckBytes) return MICROTIN_STATUS_NEED_INPUT;
  return f.crc == kCheckedCrc ? static_cast<microtin_status>(f.verdict) : MICROTIN_STATUS_CHECKSUM;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

void microtin_note_finder_init(microtin_note_finder* finder, uint8_t type, uint8_t* buffer,
                               uint32_t capacity) {
  Finder& f = *finder;
  f.buffer = buffer;
  f.capacity = capacity;
  f.content_at = f.content_size = 0;
  f.crc = f.position = f.end = f.number = f.left = 0;
  f.type = type;
  f.part = kIdentityPart;
  f.status = MICROTIN_STATUS_NEED_INPUT;
  f.verdict = MICROTIN_STATUS_NOT_FOUND;
}

microtin_status microtin_note_finder_feed(microtin_note_finder* finder, const uint8_t* bytes,
                                          size_t size) {
  Finder& f = *finder;
  for (size_t i = 0; i < size && f.status == MICROTIN_STATUS_NEED_INPUT; ++i) {
    f.crc = crc32(f.crc, bytes + i, 1);
    ++f.position;
    f.status = static_cast<uint8_t>(take(f, bytes[i]));
  }
  return static_cast<microtin_status>(f.status);
}

microtin_status microtin_find_note(const uint8_t* bytes, size_t size, uint8_t type,
                                   const uint8_t** content, uint32_t* content_size) {
  if (content == nullptr || content_size == nullptr) return MICROTIN_STATUS_ARGUMENT;
  *content = nullptr;
  *content_size = 0;
  if (bytes == nullptr) return size == 0 ? MICROTIN_STATUS_NEED_INPUT : MICROTIN_STATUS_ARGUMENT;
  Finder f;
  microtin_note_finder_init(&f, type, nullptr, 0);
  const microtin_status status = microtin_note_finder_feed(&f, bytes, size);
  if (status == MICROTIN_STATUS_OK) {
    *content = bytes + f.content_at;
    *content_size = f.content_size;
  }
  if (status == MICROTIN_STATUS_NEED_INPUT && f.end != 0) *content_size = f.end + kCheckBytes;
  return status;
}
