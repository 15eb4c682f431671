// Any bytes end in a status. Whatever was decoded by then is a sound mesh, queries on it end, and
// small chunks end in the same place.
#include <algorithm>
#include <cstdlib>

#include "fuzz/repair.hpp"
#include "tests/mesh_copy.hpp"

namespace {

using namespace microtin;

constexpr uint32_t kCapacity = 300;

struct Device {
  Device() {
    microtin_mesh_init(mesh_bytes, sizeof mesh_bytes, &mesh);
    microtin_decoder_init(decoder_bytes, sizeof decoder_bytes, mesh, &decoder);
  }

  microtin_status decode(const std::vector<uint8_t>& bytes, size_t chunk) {
    for (size_t at = 0; at < bytes.size();) {
      size_t used = 0;
      // An exact-size copy on the heap, so that reading past the chunk is seen.
      const std::vector<uint8_t> piece(
          bytes.begin() + static_cast<std::ptrdiff_t>(at),
          bytes.begin() + static_cast<std::ptrdiff_t>(std::min(bytes.size(), at + chunk)));
      const microtin_status status = microtin_feed(decoder, piece.data(), piece.size(), 0, &used);
      if (status != MICROTIN_NEED_INPUT) return status;
      at += used;
    }
    return microtin_finish(decoder);
  }

  alignas(8) unsigned char mesh_bytes[MICROTIN_MESH_BYTES(kCapacity)];
  alignas(8) unsigned char decoder_bytes[MICROTIN_DECODER_BYTES(kCapacity)];
  microtin_mesh* mesh = nullptr;
  microtin_decoder* decoder = nullptr;
};

void expect(bool truth) {
  if (!truth) std::abort();
}

void query(const microtin_mesh* mesh, const std::vector<uint8_t>& bytes) {
  uint32_t hint = 0;
  for (size_t i = 0; i + 8 <= bytes.size() && i < 80; i += 8) {
    const int32_t x = static_cast<int32_t>(read_u32(&bytes[i]) % (65536u * 256u));
    const int32_t y = static_cast<int32_t>(read_u32(&bytes[i + 4]) % (65536u * 256u));
    int32_t height = 0;
    microtin_height_at(mesh, x, y, MICROTIN_ANSWER_UNVERIFIED, &hint, &height);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::vector<uint8_t> bytes(data, data + size);
  Device whole;
  const microtin_status status = whole.decode(bytes, bytes.size());
  expect(status == MICROTIN_DONE || status >= MICROTIN_BAD_MAGIC);
  if (microtin_vertex_count(whole.mesh) >= 3) {
    const MeshCopy copy(whole.mesh);
    expect(is_sound(copy));
    query(whole.mesh, bytes);
  }
  Device pieces;
  expect(pieces.decode(bytes, 1 + (size != 0 ? data[0] % 97u : 0u)) == status);
  expect(microtin_bytes_used(pieces.decoder) == microtin_bytes_used(whole.decoder));
  expect(microtin_digest(pieces.mesh) == microtin_digest(whole.mesh));
  return 0;
}

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t most);

// Most mutants get right checks; some stay as they are.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t most, unsigned seed) {
  size = LLVMFuzzerMutate(data, size, most);
  if (seed % 8 != 0) {
    std::vector<uint8_t> bytes(data, data + size);
    repair(bytes);
    std::copy(bytes.begin(), bytes.end(), data);
  }
  return size;
}
