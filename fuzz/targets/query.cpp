// SPDX-License-Identifier: MIT
// Queries on whatever was decoded, also after an early stop: heights are those of exact arithmetic,
// from any start of the search. What queries along segments return is what exact arithmetic says,
// in calls of any length, and also from the compact form. The fuzzer asks by the last bytes of its
// input.
#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <cstring>
#include <vector>

#include "fuzz/support/device.hpp"
#include "fuzz/support/segment_checks.hpp"
#include "fuzz/support/stream_mutator.hpp"
#include "shared/digest.hpp"
#include "tests/support/mesh_copy.hpp"
#include "tests/support/reference_heights.hpp"

namespace {

using namespace microtin;
using namespace microtin::tests;

constexpr uint32_t kCapacity = 1200;
constexpr int32_t kFineMost = 65535 * 256;
constexpr size_t kMostFacets = 300;  // that are looked at one by one

struct Place {
  int32_t x, y;
};

struct Answer {
  microtin_query_result kind;
  int32_t height;
};

// By definition, looking at every triangle.
Answer expected_at(const std::vector<reference::Corners>& triangles, Place p) {
  Answer answer = {MICROTIN_QUERY_OUTSIDE, 0};
  if (p.x < 0 || p.x > kFineMost || p.y < 0 || p.y > kFineMost) return answer;
  for (const reference::Corners& t : triangles) {
    if (!reference::holds(t, p.x, p.y)) continue;
    const bool at_vertex = std::any_of(
        t.v, t.v + 3, [p](const Vertex& v) { return v.x * 256 == p.x && v.y * 256 == p.y; });
    if (!t.is_void || at_vertex) return {MICROTIN_QUERY_OK, reference::height_in(t, p.x, p.y)};
    answer.kind = MICROTIN_QUERY_VOID;
  }
  return answer;
}

// Anywhere, at a vertex, or between two vertices.
Place place_from(FuzzedDataProvider& asked, const MeshCopy& copy) {
  const auto vertex = [&] {
    const size_t v = asked.ConsumeIntegralInRange<size_t>(0, copy.place.size() - 1);
    return Place{copy.place[v].x * 256, copy.place[v].y * 256};
  };
  const uint8_t kind = asked.ConsumeIntegral<uint8_t>();
  if (kind % 4 == 0)
    return Place{asked.ConsumeIntegral<int32_t>(), asked.ConsumeIntegral<int32_t>()};
  const Place p = vertex(), q = vertex();
  if (kind % 4 == 1) return p;
  const int32_t part = kind % 4 == 2 ? 128 : kind;
  return Place{p.x + (q.x - p.x) / 256 * part, p.y + (q.y - p.y) / 256 * part};
}

void check_heights(const microtin_mesh* mesh, const MeshCopy& copy, FuzzedDataProvider& asked) {
  const std::vector<reference::Corners> triangles = reference::real_triangles(mesh);
  for (int i = 0; i < 12; ++i) {
    const Place p = place_from(asked, copy);
    const Answer expected = expected_at(triangles, p);
    uint32_t hint = asked.ConsumeIntegral<uint32_t>();
    if (hint % 4 != 0) hint %= microtin_mesh_triangle_count(mesh);
    int32_t height = 0;
    EXPECT(microtin_mesh_height_at(mesh, p.x, p.y, &hint, &height, MICROTIN_FLAG_ALLOW_UNVERIFIED,
                                   0) == expected.kind);
    EXPECT(height == expected.height);
  }
}

// Heights near those of the terrain, or anywhere.
int32_t height_from(FuzzedDataProvider& asked, const MeshCopy& copy) {
  if (asked.ConsumeIntegral<uint8_t>() % 8 == 0)
    return asked.ConsumeIntegralInRange<int32_t>(-(1 << 25), 1 << 25);
  const size_t v = asked.ConsumeIntegralInRange<size_t>(0, copy.z.size() - 1);
  return copy.z[v] * 256 + asked.ConsumeIntegralInRange<int32_t>(-300, 300);
}

bool is_on_lattice(const microtin_segment& c) {
  return std::min({c.x, c.y, c.x_end, c.y_end}) >= 0 &&
         std::max({c.x, c.y, c.x_end, c.y_end}) <= kFineMost;
}

// The compact form of a mesh, in memory of its own; the mesh stays as it is. Empty if there is
// none: the mesh is not whole.
std::vector<uint64_t> compact_form(Workspaces<kCapacity>& workspaces, microtin_mesh* mesh) {
  std::vector<uint64_t> space(MICROTIN_COMPACT_BYTES(kCapacity) / 8 + 1),
      scratch(MICROTIN_DECODER_BYTES(2 * kCapacity) / 8 + 1);
  const std::vector<unsigned char> saved(workspaces.mesh, workspaces.mesh + sizeof workspaces.mesh);
  microtin_compactor* compactor = nullptr;
  if (microtin_compactor_init(space.data(), 8 * space.size(), mesh, scratch.data(),
                              8 * scratch.size(), &compactor) != MICROTIN_STATUS_OK)
    return {};
  microtin_compact* compact = nullptr;
  const microtin_status status = microtin_compactor_run(compactor, &compact, 0);
  std::memcpy(workspaces.mesh, saved.data(), saved.size());
  if (status != MICROTIN_STATUS_OK) return {};
  EXPECT(static_cast<void*>(compact) == space.data());
  return space;
}

// In calls of any length as in one, as the compact form has it, and as all triangles have it.
void check_segments(const microtin_mesh* mesh, const microtin_compact* compact,
                    const MeshCopy& copy, FuzzedDataProvider& asked) {
  reference::Surface surface;
  surface.add(mesh, 0, 0);
  for (int i = 0; i < 3; ++i) {
    const Place a = place_from(asked, copy), b = place_from(asked, copy);
    microtin_path path = {{a.x, a.y, b.x, b.y}, height_from(asked, copy), 0, 0};
    path.z_end = asked.ConsumeBool() ? path.z : height_from(asked, copy);
    path.clearance = asked.ConsumeBool() ? 0 : asked.ConsumeIntegralInRange<int32_t>(-999, 9999);
    const Walked walked = walk(mesh, path, 0);
    const uint32_t limit = 1 + asked.ConsumeIntegral<uint8_t>();
    EXPECT(walk(mesh, path, limit) == walked);
    if (compact != nullptr) EXPECT(walk(compact, path, limit) == walked);
    if (walked.result == MICROTIN_QUERY_UNVERIFIED || surface.facets.size() > kMostFacets) continue;
    if (is_on_lattice(path.segment)) {
      check_walk(surface, path, walked);
    } else {
      EXPECT(walked.result == MICROTIN_QUERY_OUTSIDE && walked.clearance.least == INT32_MAX);
    }
  }
}

bool same(const microtin_axis& a, const microtin_axis& b) {
  return a.offset == b.offset && a.numerator == b.numerator && a.denominator == b.denominator;
}

// A stream that was begun lies where its header says.
void check_placement(const microtin_mesh* mesh, const uint8_t* data, size_t size) {
  microtin_axis x, y, z;
  microtin_stream_info info;
  microtin_mesh_axes(mesh, &x, &y, &z);
  EXPECT(microtin_read_stream_info(data, size, &info) == MICROTIN_STATUS_OK);
  EXPECT(same(x, info.x) && same(y, info.y) && same(z, info.z));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  static Workspaces<kCapacity> workspaces;
  FuzzedDataProvider asked(data, size);
  Device device = workspaces.device();
  const uint32_t phases = asked.ConsumeIntegralInRange<uint32_t>(0, 12);
  microtin_decoder_stop_after_phase(device.decoder, phases);
  const microtin_status status = device.decode(data, size);
  if (status == MICROTIN_STATUS_STOPPED) EXPECT(microtin_decoder_phase(device.decoder) == phases);
  const microtin_mesh* const mesh = device.mesh;
  uint32_t hint = asked.ConsumeIntegral<uint32_t>();
  int32_t height = 0;
  const microtin_query_result answer = microtin_mesh_height_at(mesh, 0, 0, &hint, &height, 0, 0);
  if (microtin_mesh_triangle_count(mesh) == 0) {
    EXPECT(answer == MICROTIN_QUERY_NOT_LOADED);
    return 0;
  }
  EXPECT(status != MICROTIN_STATUS_OK || answer != MICROTIN_QUERY_UNVERIFIED);
  EXPECT(answer == MICROTIN_QUERY_UNVERIFIED ||
         mesh->verified_vertices == microtin_mesh_vertex_count(mesh));
  check_placement(mesh, data, size);
  uint64_t digest = 0;
  for (const reference::Corners& t : reference::real_triangles(mesh)) {
    digest += triangle_digest(t.v, t.is_void);
  }
  EXPECT(microtin_mesh_digest(mesh) == digest);
  const MeshCopy copy(mesh);
  EXPECT(pairing_fault(copy.mesh).empty());
  check_heights(mesh, copy, asked);
  const std::vector<uint64_t> compact = compact_form(workspaces, device.mesh);
  check_segments(
      mesh, compact.empty() ? nullptr : reinterpret_cast<const microtin_compact*>(compact.data()),
      copy, asked);
  return 0;
}
