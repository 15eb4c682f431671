// SPDX-License-Identifier: MIT
// Objects whose initialisation fails tell why, themselves and whenever they are fed. The functions
// that fail stand in for the library.
#include "microtin/microtin.hpp"
#include "microtin/pack.hpp"

namespace {

microtin_status mesh_status, decoder_status, pack_status;
microtin_mesh* const kSomeMesh = reinterpret_cast<microtin_mesh*>(&mesh_status);
microtin_decoder* const kSomeDecoder = reinterpret_cast<microtin_decoder*>(&decoder_status);

}  // namespace

extern "C" {

microtin_status microtin_mesh_init(void*, size_t, microtin_mesh** mesh) {
  *mesh = mesh_status == MICROTIN_STATUS_OK ? kSomeMesh : nullptr;
  return mesh_status;
}

microtin_status microtin_decoder_init(void*, size_t, microtin_mesh* mesh,
                                      microtin_decoder** decoder) {
  *decoder = nullptr;
  if (mesh == nullptr) return MICROTIN_STATUS_ARGUMENT;
  if (decoder_status == MICROTIN_STATUS_OK) *decoder = kSomeDecoder;
  return decoder_status;
}

microtin_status microtin_pack_init(void*, size_t, uint32_t, uint32_t, microtin_pack** pack) {
  *pack = nullptr;
  return pack_status;
}

microtin_status microtin_decoder_feed(microtin_decoder* decoder, const uint8_t*, size_t size,
                                      size_t* used, uint32_t) {
  *used = size;
  return decoder == nullptr ? MICROTIN_STATUS_ARGUMENT : MICROTIN_STATUS_NEED_INPUT;
}

microtin_status microtin_decoder_finish(microtin_decoder* decoder) {
  return decoder == nullptr ? MICROTIN_STATUS_ARGUMENT : MICROTIN_STATUS_TRUNCATED;
}

void microtin_pack_next_read(microtin_pack*, uint64_t*, uint8_t**, size_t* size) {
  *size = 0;
}

void microtin_pack_complete_read(microtin_pack*, int32_t) {}

microtin_status microtin_pack_load(microtin_pack*, const microtin_segment*, uint32_t) {
  return MICROTIN_STATUS_OK;
}
}

namespace {

int32_t nothing(void*, uint64_t, uint8_t*, size_t) {
  return 0;
}

// What a decoder says of a byte, and of its being the last.
bool says(microtin_status fed, microtin_status finished) {
  microtin::Terrain<5> terrain;
  microtin::Decoder<5> decoder(terrain);
  const uint8_t byte = 0;
  size_t used = 7;
  const bool right = decoder.feed(&byte, 1, &used) == fed && decoder.finish() == finished &&
                     terrain.status() == mesh_status;
  return right && used == (fed == MICROTIN_STATUS_NEED_INPUT ? 1u : 0u);
}

}  // namespace

int main() {
  bool right = says(MICROTIN_STATUS_NEED_INPUT, MICROTIN_STATUS_TRUNCATED);
  mesh_status = MICROTIN_STATUS_MISALIGNED;
  right = right && says(MICROTIN_STATUS_MISALIGNED, MICROTIN_STATUS_MISALIGNED);
  mesh_status = MICROTIN_STATUS_OK;
  decoder_status = MICROTIN_STATUS_WORKSPACE_TOO_SMALL;
  right = right && says(MICROTIN_STATUS_WORKSPACE_TOO_SMALL, MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  pack_status = MICROTIN_STATUS_MISALIGNED;
  microtin::Pack<1, 5> pack;
  right = right && pack.status() == MICROTIN_STATUS_MISALIGNED &&
          pack.load_with({0, 0, 0, 0}, nothing, nullptr, 1) == MICROTIN_STATUS_MISALIGNED;
  return right ? 0 : 1;
}
