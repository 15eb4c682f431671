// SPDX-License-Identifier: MIT
// What the command line makes of any stream: everything its header says, the same after it was
// written anew, and its terrain; or an error. A device finds in it what lies within.
#include <algorithm>
#include <cstring>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/stream/decoded_terrain.hpp"
#include "encoder/stream/header.hpp"
#include "fuzz/support/expect.hpp"
#include "fuzz/support/stream_mutator.hpp"

using namespace microtin::tests;

namespace {

// Notes are found in packs, too.
microtin_status fed_byte_by_byte(const uint8_t* data, size_t size, uint8_t type) {
  uint8_t buffer[3];
  microtin_note_finder finder;
  microtin_note_finder_init(&finder, type, buffer, sizeof buffer);
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  for (size_t i = 0; i < size; ++i) status = microtin_note_finder_feed(&finder, data + i, 1);
  return status;
}

// True if all notes of the header are sound.
bool find_notes(const uint8_t* data, size_t size, const microtin_stream_info* info) {
  bool sound = info != nullptr;
  for (int type = 0; type < 256; ++type) {
    const uint8_t* note = nullptr;
    uint32_t note_size = 0;
    const microtin_status status =
        microtin_find_note(data, size, static_cast<uint8_t>(type), &note, &note_size);
    EXPECT(status == fed_byte_by_byte(data, size, static_cast<uint8_t>(type)));
    sound = sound && (status == MICROTIN_STATUS_OK || status == MICROTIN_STATUS_NOT_FOUND);
    EXPECT((note != nullptr) == (status == MICROTIN_STATUS_OK));
    if (note == nullptr) continue;
    EXPECT(note > data);
    const size_t end = (info != nullptr ? info->header_bytes : size) - microtin::kCheckBytes;
    EXPECT(static_cast<size_t>(note - data) <= end);
    EXPECT(note_size <= end - static_cast<size_t>(note - data));
  }
  return sound;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::vector<uint8_t> stream(data, data + size);
  microtin_stream_info info;
  const bool legal = microtin_read_stream_info(data, size, &info) == MICROTIN_STATUS_OK;
  const bool sound = find_notes(data, size, legal ? &info : nullptr);
  try {
    const Header header = read_header(stream);
    EXPECT(legal && sound);
    const std::vector<uint8_t> once = write_header(header.contract, header.metadata);
    const Header again = read_header(once);
    const std::vector<uint8_t> twice = write_header(again.contract, again.metadata);
    EXPECT(once == twice);
    if (info.vertices > 2000) return 0;
    const DecodedTerrain decoded(stream);
    EXPECT(microtin_mesh_vertex_count(decoded.mesh()) == info.vertices);
  } catch (const Error& error) {
    EXPECT(error.what()[0] != '\0');
  }
  return 0;
}
