// SPDX-License-Identifier: MIT
// Workspaces: how many vertices they hold, and where in them what lies.
#include "decoder/state.hpp"

namespace microtin {
namespace {

constexpr uint32_t kMeshFixed = MICROTIN_MESH_BYTES(0);
constexpr uint32_t kMeshPerFour = MICROTIN_MESH_BYTES(4) - kMeshFixed;
constexpr uint32_t kDecoderFixed = MICROTIN_DECODER_BYTES(0);
constexpr uint32_t kDecoderPerFour = MICROTIN_DECODER_BYTES(4) - kDecoderFixed;

static_assert(uint64_t{kMeshPerFour} * (MICROTIN_MAX_VERTICES + 3) <= UINT32_MAX &&
                  kDecoderPerFour <= kMeshPerFour,
              "products of capacity_of fit");

// How many vertices a workspace holds, of which `fixed` bytes and `per_four` bytes for four,
// rounded up, are needed.
MICROTIN_ONE_COPY microtin_status capacity_of(const void* workspace, size_t size, uint32_t fixed,
                                              uint32_t per_four, uint32_t* capacity) {
  if (reinterpret_cast<uintptr_t>(workspace) % MICROTIN_ALIGNMENT != 0)
    return MICROTIN_STATUS_MISALIGNED;
  const uint32_t most = MICROTIN_MAX_VERTICES, enough = fixed + per_four * ((most + 3) / 4);
  const uint32_t bytes = size < enough ? static_cast<uint32_t>(size) : enough;
  *capacity = bytes < fixed ? 0 : smaller((bytes - fixed) * 4 / per_four, most);
  return *capacity < 3 ? MICROTIN_STATUS_WORKSPACE_TOO_SMALL : MICROTIN_STATUS_OK;
}

}  // namespace
}  // namespace microtin

using namespace microtin;

microtin_status microtin_mesh_init(void* workspace, size_t size, microtin_mesh** mesh) {
  if (workspace == nullptr || mesh == nullptr) return MICROTIN_STATUS_ARGUMENT;
  *mesh = nullptr;
  uint32_t capacity = 0;
  const microtin_status status = capacity_of(workspace, size, kMeshFixed, kMeshPerFour, &capacity);
  if (status != MICROTIN_STATUS_OK) return status;
  microtin_mesh& m = *static_cast<microtin_mesh*>(workspace);
  // Widest numbers first, so that everything is aligned.
  const size_t half_edges = 6 * static_cast<size_t>(capacity);
  m.mesh.origin = reinterpret_cast<Index*>(&m + 1);
  m.mesh.twin = m.mesh.origin + half_edges;
  void* const behind = m.mesh.twin + half_edges;  // a multiple of four bytes from the begin
  m.mesh.place = static_cast<Point*>(behind);
  m.mesh.z = reinterpret_cast<int16_t*>(m.mesh.place + capacity);
  m.voids = reinterpret_cast<uint8_t*>(m.mesh.z + capacity);
  m.capacity = capacity;
  empty_mesh(m);
  *mesh = &m;
  return MICROTIN_STATUS_OK;
}

microtin_status microtin_decoder_init(void* workspace, size_t size, microtin_mesh* mesh,
                                      microtin_decoder** decoder) {
  if (workspace == nullptr || mesh == nullptr || decoder == nullptr)
    return MICROTIN_STATUS_ARGUMENT;
  *decoder = nullptr;
  uint32_t capacity = 0;
  const microtin_status status =
      capacity_of(workspace, size, kDecoderFixed, kDecoderPerFour, &capacity);
  if (status != MICROTIN_STATUS_OK) return status;
  microtin_decoder& d = *static_cast<microtin_decoder*>(workspace);
  d.mesh = mesh;
  d.capacity = capacity;
  d.status = MICROTIN_STATUS_NEED_INPUT;
  d.stop_phase = 0;
  d.verdict = MICROTIN_STATUS_OK;
  d.item = Item::kIdentity;
  d.in_header = true;
  d.coder.window.next = d.coder.window.bytes;
  d.coder.window.left = 0;
  d.coder.window.crc = 0;
  d.coder.window.used = 0;
  Reconstruction& r = d.reconstruction;
  r.mesh = &mesh->mesh;
  r.voids = mesh->voids;
  r.queue = reinterpret_cast<Index*>(&d + 1);
  r.marks = reinterpret_cast<uint8_t*>(r.queue + capacity);
  r.residual = reinterpret_cast<Residual*>(r.marks + mark_bytes(capacity));
  r.phase = 0;
  empty_mesh(*mesh);
  *decoder = &d;
  return MICROTIN_STATUS_OK;
}
