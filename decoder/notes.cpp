// SPDX-License-Identifier: MIT
// Finding a note in a header.
#include "microtin/microtin.h"
#include "shared/pack_format.hpp"

namespace microtin {
namespace {

// The notes of a header or, while bytes of it are missing, no `first` and the bytes it takes, 0 if
// unknown.
struct Notes {
  const uint8_t* first;
  uint32_t size;
};

// Skips a number that is known to be legal. Returns its last byte.
uint8_t skip_varint(const uint8_t** bytes) {
  while (**bytes >= 128) ++*bytes;
  return *(*bytes)++;
}

microtin_status notes_of_stream(const uint8_t* bytes, size_t size, Notes* notes) {
  microtin_stream_info info;
  const microtin_status status = microtin_read_stream_info(bytes, size, &info);
  notes->size = info.header_bytes;
  if (status != MICROTIN_STATUS_OK) return status;
  const uint8_t* next = bytes + kIdentityBytes;
  skip_varint(&next);                             // the length
  const uint8_t properties = skip_varint(&next);  // the low ones
  int numbers = (properties & kHasPlacement) != 0 ? 12 : 3;
  for (; numbers != 0; --numbers) skip_varint(&next);
  notes->first = next;
  notes->size = info.header_bytes - kCheckBytes - static_cast<uint32_t>(next - bytes);
  return MICROTIN_STATUS_OK;
}

microtin_status notes_of_pack(const uint8_t* bytes, size_t size, Notes* notes) {
  notes->size = 0;
  if (size < kPackIdentityBytes) return MICROTIN_STATUS_NEED_INPUT;
  const microtin_status known = check_pack_identity(bytes);
  if (known != MICROTIN_STATUS_OK) return known;
  notes->size = kPackFixedBytes;
  if (size < kPackFixedBytes) return MICROTIN_STATUS_NEED_INPUT;
  PackHeader header;
  const bool legal = read_pack_header(bytes, &header);
  notes->size = pack_index_start(header);  // at most 40 + 255 + 65535 + 4
  if (size < notes->size) return MICROTIN_STATUS_NEED_INPUT;
  if (crc32(0, bytes, static_cast<size_t>(notes->size)) != kCheckedCrc)
    return MICROTIN_STATUS_CHECKSUM;
  if (!legal) return MICROTIN_STATUS_MALFORMED;
  notes->first = bytes + kPackFixedBytes + header.placement_bytes;
  notes->size = header.note_bytes;
  return MICROTIN_STATUS_OK;
}

// Makes `notes` the content of the first note of a type, if there is one. Each turn takes three
// bytes at least.
microtin_status find(uint8_t type, Notes* notes) {
  while (notes->size != 0) {
    if (notes->size < kNoteHeadBytes) return MICROTIN_STATUS_MALFORMED;
    const uint8_t* const head = notes->first;
    const uint32_t size = read_u16(head + 1);
    notes->first += kNoteHeadBytes;
    notes->size -= kNoteHeadBytes;
    if (size > notes->size) return MICROTIN_STATUS_MALFORMED;
    if (*head == type) {
      notes->size = size;
      return MICROTIN_STATUS_OK;
    }
    notes->first += size;
    notes->size -= size;
  }
  return MICROTIN_STATUS_NOT_FOUND;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_find_note(const uint8_t* bytes, size_t size, uint8_t type,
                                   const uint8_t** content, uint32_t* content_size) {
  if (content == nullptr || content_size == nullptr) return MICROTIN_STATUS_ARGUMENT;
  *content = nullptr;
  *content_size = 0;
  if (bytes == nullptr) return size == 0 ? MICROTIN_STATUS_NEED_INPUT : MICROTIN_STATUS_ARGUMENT;
  Notes notes = {nullptr, 0};
  microtin_status status = notes_of_stream(bytes, size, &notes);
  if (status == MICROTIN_STATUS_BAD_MAGIC) status = notes_of_pack(bytes, size, &notes);
  if (status == MICROTIN_STATUS_OK) status = find(type, &notes);
  if (status == MICROTIN_STATUS_OK) *content = notes.first;
  if (status == MICROTIN_STATUS_OK || status == MICROTIN_STATUS_NEED_INPUT)
    *content_size = notes.size;
  return status;
}
