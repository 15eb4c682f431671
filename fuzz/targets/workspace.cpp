// SPDX-License-Identifier: MIT
// Workspaces of any size and place: what does not fit or is not aligned is refused, what fits is
// filled without a byte beyond it. The fuzzer chooses them by the last bytes of its input.
#include <fuzzer/FuzzedDataProvider.h>

#include <vector>

#include "fuzz/support/expect.hpp"
#include "fuzz/support/stream_mutator.hpp"
#include "microtin/microtin.h"

namespace {

// On the heap, so that a step beyond either end is seen.
struct Workspace {
  explicit Workspace(FuzzedDataProvider& given)
      : vertices(given.ConsumeIntegralInRange<uint32_t>(0, 400)),
        offset(given.ConsumeIntegralInRange<size_t>(0, 9) % MICROTIN_ALIGNMENT) {
    if (given.ConsumeBool()) vertices = 1200;
  }

  void allocate(size_t bytes, size_t missing) {
    memory.resize(offset + bytes - missing);
    size = bytes - missing;
  }

  unsigned char* start() { return memory.data() + offset; }

  uint32_t vertices;
  size_t offset;
  size_t size = 0;
  std::vector<unsigned char> memory;
};

// The status of laying something out in a workspace that holds `vertices`, or one fewer.
microtin_status expected(const Workspace& w, size_t missing) {
  if (w.offset != 0) return MICROTIN_STATUS_MISALIGNED;
  return w.vertices < 3u + (missing != 0 ? 1u : 0u) ? MICROTIN_STATUS_WORKSPACE_TOO_SMALL
                                                    : MICROTIN_STATUS_OK;
}

void check_null_pointers(microtin_mesh* mesh, microtin_decoder* decoder, void* memory) {
  microtin_mesh* no_mesh = nullptr;
  microtin_decoder* no_decoder = nullptr;
  size_t used = 0;
  microtin_stream_info info;
  EXPECT(microtin_mesh_init(nullptr, 1000, &no_mesh) == MICROTIN_STATUS_ARGUMENT);
  EXPECT(microtin_mesh_init(memory, 1000, nullptr) == MICROTIN_STATUS_ARGUMENT);
  EXPECT(microtin_decoder_init(nullptr, 1000, mesh, &no_decoder) == MICROTIN_STATUS_ARGUMENT);
  EXPECT(microtin_decoder_init(memory, 1000, nullptr, &no_decoder) == MICROTIN_STATUS_ARGUMENT);
  EXPECT(microtin_decoder_init(memory, 1000, mesh, nullptr) == MICROTIN_STATUS_ARGUMENT);
  EXPECT(microtin_decoder_feed(nullptr, nullptr, 0, &used, 0) == MICROTIN_STATUS_ARGUMENT);
  EXPECT(microtin_decoder_feed(decoder, nullptr, 0, nullptr, 0) == MICROTIN_STATUS_ARGUMENT);
  EXPECT(microtin_decoder_feed(decoder, nullptr, 1, &used, 0) == MICROTIN_STATUS_ARGUMENT);
  EXPECT(microtin_decoder_finish(nullptr) == MICROTIN_STATUS_ARGUMENT);
  EXPECT(microtin_read_stream_info(nullptr, 1, &info) == MICROTIN_STATUS_ARGUMENT);
  EXPECT(microtin_read_stream_info(nullptr, 0, nullptr) == MICROTIN_STATUS_ARGUMENT);
  EXPECT(microtin_read_stream_info(nullptr, 0, &info) == MICROTIN_STATUS_NEED_INPUT);
  EXPECT(microtin_decoder_feed(decoder, nullptr, 0, &used, 0) == MICROTIN_STATUS_NEED_INPUT);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  FuzzedDataProvider given(data, size);
  Workspace for_mesh(given), for_decoder(given);
  const size_t missing = given.ConsumeBool() ? 1 : 0;
  for_mesh.allocate(MICROTIN_MESH_BYTES(for_mesh.vertices), missing);
  for_decoder.allocate(MICROTIN_DECODER_BYTES(for_decoder.vertices), missing);
  microtin_mesh* mesh = nullptr;
  microtin_decoder* decoder = nullptr;
  microtin_status status = microtin_mesh_init(for_mesh.start(), for_mesh.size, &mesh);
  EXPECT(status == expected(for_mesh, missing));
  if (status != MICROTIN_STATUS_OK) return 0;
  status = microtin_decoder_init(for_decoder.start(), for_decoder.size, mesh, &decoder);
  EXPECT(status == expected(for_decoder, missing));
  if (status != MICROTIN_STATUS_OK) return 0;
  check_null_pointers(mesh, decoder, for_mesh.start());
  size_t used = 0;
  microtin_decoder_feed(decoder, data, size, &used, 0);
  status = microtin_decoder_finish(decoder);
  microtin_stream_info info;
  if (microtin_read_stream_info(data, size, &info) != MICROTIN_STATUS_OK) return 0;
  const uint32_t lost = missing != 0 ? 1 : 0;
  const bool fits =
      info.vertices + lost <= for_mesh.vertices && info.vertices + lost <= for_decoder.vertices;
  EXPECT((status == MICROTIN_STATUS_TOO_BIG) == !fits);
  EXPECT(fits == (info.mesh_bytes <= for_mesh.size && info.decoder_bytes <= for_decoder.size));
  return 0;
}
