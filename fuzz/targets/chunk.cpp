// SPDX-License-Identifier: MIT
// However a stream is cut into pieces and steps are rationed, it ends in the same place, and every
// state on the way is a terrain. The fuzzer cuts by the last bytes of its input.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <vector>

#include "fuzz/support/device.hpp"
#include "fuzz/support/stream_mutator.hpp"
#include "tests/support/mesh_copy.hpp"

namespace {

using namespace microtin;
using namespace microtin::tests;

constexpr uint32_t kCapacity = 1200;

// Workspaces on the heap of no byte more than the stream's header asks for, if it is readable; what
// they hold at first must not matter.
struct ExactWorkspaces {
  ExactWorkspaces(const uint8_t* data, size_t size, unsigned char garbage) {
    microtin_stream_info info;
    uint32_t vertices = 3;
    if (microtin_read_stream_info(data, size, &info) == MICROTIN_STATUS_OK) {
      vertices = std::min(info.vertices, kCapacity);
    }
    mesh.assign(MICROTIN_MESH_BYTES(vertices), garbage);
    decoder.assign(MICROTIN_DECODER_BYTES(vertices), garbage);
  }

  Device device() { return Device(mesh.data(), mesh.size(), decoder.data(), decoder.size()); }

  std::vector<unsigned char> mesh, decoder;
};

// Between steps: what is there is a canonical triangulation, and the last insertion kept to the
// degree that the header promises.
void check_state(const Device& device) {
  const Mesh& mesh = device.mesh->mesh;
  if (mesh.triangles == 0) return;
  EXPECT(is_sound(MeshCopy(device.mesh)));
}

void check_last_vertex(const Device& device) {
  const Mesh& mesh = device.mesh->mesh;
  if (mesh.vertices <= 3) return;
  Index h = 0;
  while (mesh.origin[h] + 1u != mesh.vertices) ++h;
  EXPECT(degree_up_to(mesh, h, kMaxDegree + 1) <= device.decoder->reconstruction.contract.degree);
}

class Cutter {
 public:
  Cutter(const uint8_t* data, size_t size) : cuts_(data, size) {
    largest_ = cuts_.ConsumeIntegralInRange<size_t>(1, 200);
    most_steps_ = cuts_.ConsumeIntegralInRange<uint32_t>(0, 40);
    checked_vertices_ = cuts_.ConsumeIntegralInRange<uint32_t>(0, 60);
  }

  microtin_status decode(Device& device, const uint8_t* data, size_t size) {
    uint32_t steps = 0;
    microtin_status status = MICROTIN_STATUS_NEED_INPUT;
    for (size_t at = 0; at != size || status == MICROTIN_STATUS_STEP_LIMIT;) {
      const size_t wanted = cuts_.ConsumeIntegralInRange<size_t>(0, largest_);
      const size_t piece = std::min(cuts_.remaining_bytes() == 0 ? largest_ : wanted, size - at);
      size_t used = 0;
      status = feed(device, data + at, piece, &used, &steps);
      EXPECT(steps <= 2 * most_steps(kCapacity));
      if (status != MICROTIN_STATUS_NEED_INPUT && status != MICROTIN_STATUS_STEP_LIMIT)
        return status;
      at += used;
    }
    return microtin_decoder_finish(device.decoder);
  }

 private:
  microtin_status feed(Device& device, const uint8_t* data, size_t size, size_t* used,
                       uint32_t* steps) {
    // The piece has exactly that size, on the heap, so that reading past the end is seen.
    const std::vector<uint8_t> piece(data, data + size);
    const uint32_t limit = cuts_.ConsumeIntegralInRange<uint32_t>(0, most_steps_);
    const uint32_t before = microtin_mesh_vertex_count(device.mesh);
    const microtin_status status =
        microtin_decoder_feed(device.decoder, piece.data(), size, used, limit);
    EXPECT(*used <= size);
    EXPECT(status != MICROTIN_STATUS_NEED_INPUT || *used == size);
    if (status == MICROTIN_STATUS_STEP_LIMIT) *steps += limit;
    const uint32_t now = microtin_mesh_vertex_count(device.mesh);
    if (limit != 0) EXPECT(now <= before + limit);
    if (now != before) check_last_vertex(device);
    if (now == checked_vertices_ && now != before) check_state(device);
    return status;
  }

  FuzzedDataProvider cuts_;
  size_t largest_;
  uint32_t most_steps_;
  uint32_t checked_vertices_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  ExactWorkspaces one(data, size, 0), other(data, size, 0xA5);
  Device whole = one.device(), pieces = other.device();
  const microtin_status status = whole.decode(data, size);
  EXPECT(Cutter(data, size).decode(pieces, data, size) == status);
  EXPECT(microtin_decoder_bytes_used(pieces.decoder) == microtin_decoder_bytes_used(whole.decoder));
  EXPECT(microtin_decoder_phase(pieces.decoder) == microtin_decoder_phase(whole.decoder));
  EXPECT(microtin_mesh_vertex_count(pieces.mesh) == microtin_mesh_vertex_count(whole.mesh));
  EXPECT(microtin_mesh_digest(pieces.mesh) == microtin_mesh_digest(whole.mesh));
  // Done and errors stay.
  size_t used = 0;
  EXPECT(microtin_decoder_feed(pieces.decoder, data, size, &used, 0) == status && used == 0);
  EXPECT(microtin_decoder_finish(pieces.decoder) == status);
  return 0;
}
