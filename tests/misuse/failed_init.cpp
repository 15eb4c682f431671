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
  *mesh = mesh_status == MICROTIN_DONE ? kSomeMesh : nullptr;
  return mesh_status;
}

microtin_status microtin_decoder_init(void*, size_t, microtin_mesh* mesh,
                                      microtin_decoder** decoder) {
  *decoder = nullptr;
  if (mesh == nullptr) return MICROTIN_ARGUMENT;
  if (decoder_status == MICROTIN_DONE) *decoder = kSomeDecoder;
  return decoder_status;
}

microtin_status microtin_pack_init(void*, size_t, uint32_t, uint32_t, microtin_pack** pack) {
  *pack = nullptr;
  return pack_status;
}

microtin_status microtin_feed(microtin_decoder* decoder, const uint8_t*, size_t size, uint32_t,
                              size_t* used) {
  *used = size;
  return decoder == nullptr ? MICROTIN_ARGUMENT : MICROTIN_NEED_INPUT;
}

microtin_status microtin_finish(microtin_decoder* decoder) {
  return decoder == nullptr ? MICROTIN_ARGUMENT : MICROTIN_TRUNCATED;
}

void microtin_pack_wanted(microtin_pack*, uint64_t*, uint8_t**, size_t* size) {
  *size = 0;
}

void microtin_pack_given(microtin_pack*, int32_t) {}

microtin_status microtin_pack_prepare(microtin_pack*, const microtin_course*, uint32_t) {
  return MICROTIN_DONE;
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
  return right && used == (fed == MICROTIN_NEED_INPUT ? 1u : 0u);
}

}  // namespace

int main() {
  bool right = says(MICROTIN_NEED_INPUT, MICROTIN_TRUNCATED);
  mesh_status = MICROTIN_MISALIGNED;
  right = right && says(MICROTIN_MISALIGNED, MICROTIN_MISALIGNED);
  mesh_status = MICROTIN_DONE;
  decoder_status = MICROTIN_WORKSPACE_TOO_SMALL;
  right = right && says(MICROTIN_WORKSPACE_TOO_SMALL, MICROTIN_WORKSPACE_TOO_SMALL);
  pack_status = MICROTIN_MISALIGNED;
  microtin::Pack<1, 5> pack;
  right = right && pack.status() == MICROTIN_MISALIGNED &&
          pack.service({0, 0, 0, 0}, 1, nothing, nullptr) == MICROTIN_MISALIGNED;
  return right ? 0 : 1;
}
