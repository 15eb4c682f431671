// SPDX-License-Identifier: MIT
// Any bytes end in a status, after a bounded number of steps; whatever was decoded by then is the
// canonical triangulation, and looking at the header alone says the same of it.
#include "fuzz/support/device.hpp"
#include "fuzz/support/local_delaunay.hpp"
#include "fuzz/support/stream_mutator.hpp"

namespace {

using namespace microtin;
using namespace microtin::tests;

constexpr uint32_t kCapacity = 300;  // few, to be quick; more than the first section holds

// A header that peek refuses is refused for the same reason; otherwise something else is wrong.
void check_peek(const uint8_t* data, size_t size, microtin_status status) {
  microtin_stream_info info;
  const microtin_status peeked = microtin_read_stream_info(data, size, &info);
  if (peeked >= MICROTIN_STATUS_BAD_MAGIC) {
    EXPECT(status == peeked);
  } else if (peeked == MICROTIN_STATUS_NEED_INPUT) {
    EXPECT(status == MICROTIN_STATUS_TRUNCATED &&
           (info.header_bytes == 0 || info.header_bytes > size));
  } else {
    EXPECT((status == MICROTIN_STATUS_TOO_BIG) == (info.vertices > kCapacity));
    EXPECT(status != MICROTIN_STATUS_BAD_MAGIC && status != MICROTIN_STATUS_UNSUPPORTED_VERSION);
  }
}

bool is_on_lattice(const Mesh& mesh, const Contract& contract) {
  for (Index v = 0; v < mesh.vertices; ++v) {
    if (mesh.place[v].x > contract.x_max || mesh.place[v].y > contract.y_max) return false;
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static Workspaces<kCapacity> workspaces;
  Device device = workspaces.device();
  const microtin_status status = device.decode(data, size);
  EXPECT(status == MICROTIN_STATUS_OK || status >= MICROTIN_STATUS_BAD_MAGIC);
  check_peek(data, size, status);
  const Mesh& mesh = device.mesh->mesh;
  EXPECT(mesh.triangles == 0 || is_locally_delaunay(mesh));
  EXPECT(is_on_lattice(mesh, device.decoder->reconstruction.contract));
  if (status == MICROTIN_STATUS_OK) {
    EXPECT(mesh.vertices == device.decoder->reconstruction.contract.vertices);
    EXPECT(mesh.vertices == device.mesh->verified_vertices);
  }
  return 0;
}
