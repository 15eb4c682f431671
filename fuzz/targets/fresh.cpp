// SPDX-License-Identifier: MIT
// Decodes in memory fresh from the heap, for MemorySanitizer (fuzz/strict): no result depends on
// what was never written.
#include <memory>
#include <vector>

#include "fuzz/support/device.hpp"
#include "fuzz/support/repair.hpp"

using namespace microtin::tests;

namespace {

constexpr uint32_t kCapacity = 300;

struct Memory {
  explicit Memory(size_t size) : bytes(std::malloc(size), &std::free) {}
  std::unique_ptr<void, void (*)(void*)> bytes;
};

// The sanitizer reports a branch on what was never written.
void look_at(const microtin_mesh* mesh) {
  EXPECT(microtin_mesh_digest(mesh) != 1);
  const uint32_t vertices = microtin_mesh_vertex_count(mesh);
  for (uint32_t v = 0; v < vertices; ++v) {
    uint16_t x = 0, y = 0;
    int16_t z = 0;
    microtin_mesh_vertex(mesh, v, &x, &y, &z);
    uint32_t hint = 0;
    int32_t height = 0;
    const microtin_query_result answer = microtin_mesh_height_at(
        mesh, x * 256, y * 256, &hint, &height, MICROTIN_FLAG_ALLOW_UNVERIFIED, 0);
    EXPECT(answer == MICROTIN_QUERY_NOT_LOADED ||
           (answer == MICROTIN_QUERY_OK && height == z * 65536));
  }
  microtin_axis axis[3];
  microtin_mesh_axes(mesh, axis, axis + 1, axis + 2);
  for (const microtin_axis& a : axis) EXPECT(a.numerator != 0 && a.denominator != 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  // Not by a mutator, whose bytes the sanitizer does not know to be written.
  std::vector<uint8_t> stream(data, data + size);
  repair(stream.data(), size);
  const size_t mesh_bytes = MICROTIN_MESH_BYTES(kCapacity);
  const size_t decoder_bytes = MICROTIN_DECODER_BYTES(kCapacity);
  const Memory mesh(mesh_bytes), decoder(decoder_bytes);
  Device device(mesh.bytes.get(), mesh_bytes, decoder.bytes.get(), decoder_bytes);
  const microtin_status status = device.decode(stream.data(), size);
  EXPECT(microtin_decoder_finish(device.decoder) == status);
  EXPECT(microtin_decoder_phase(device.decoder) <= kCapacity);
  look_at(device.mesh);
  return 0;
}
