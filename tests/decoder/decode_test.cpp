// SPDX-License-Identifier: MIT
// The decoder's contract: chunks, limits, stopping, statuses.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "fuzz/support/repair.hpp"
#include "tests/support/device.hpp"
#include "tests/support/forged_stream.hpp"
#include "tests/support/streams.hpp"

using namespace microtin;
using namespace microtin::tests;

TEST_CASE("every phase can be the last, and is a coarser terrain") {
  const Bytes stream = terrain_stream(1500, 8, {6});
  const uint32_t phases = DecodedTerrain(stream).phases();
  REQUIRE(phases >= 3);
  uint32_t before = 3;
  for (uint32_t phase = 1; phase <= phases; ++phase) {
    Device device(1500);
    microtin_decoder_stop_after_phase(device.decoder, phase);
    const microtin_status status = device.feed_all(stream);
    CHECK(status == (phase == phases ? MICROTIN_STATUS_OK : MICROTIN_STATUS_STOPPED));
    CHECK(microtin_decoder_phase(device.decoder) == phase);
    const uint32_t vertices = microtin_mesh_vertex_count(device.mesh);
    CHECK(vertices > before);
    CHECK(microtin_mesh_triangle_count(device.mesh) == 2 * vertices - 2);
    before = vertices;
  }
}

TEST_CASE("notes in the header are skipped, a broken placement is malformed") {
  const Bytes stream = terrain_stream(20, 9);
  const uint32_t end = read_header(stream).info.header_bytes - kCheckBytes;
  const auto status_with = [&](bool is_placed, const Bytes& added, bool damaged) {
    Bytes other = stream;
    other.insert(other.begin() + end, added.begin(), added.end());
    other[5] = static_cast<uint8_t>(other[5] + added.size());        // the length
    if (is_placed) other[7] |= static_cast<uint8_t>(kHasPlacement);  // properties
    repair(other.data(), other.size());
    if (damaged) other[end] ^= 1;
    microtin_stream_info info;
    const microtin_status peeked = microtin_read_stream_info(other.data(), other.size(), &info);
    Device device(20);
    const microtin_status status = device.feed_all(other);
    CHECK(status == peeked);
    microtin_axis x, y, z;
    microtin_mesh_axes(device.mesh, &x, &y, &z);
    for (const microtin_axis& axis : {x, y, z}) {
      CHECK(axis.numerator != 0);
      CHECK(axis.denominator != 0);
    }
    return status;
  };
  CHECK(status_with(false, {0x7F, 2, 0, 9, 9}, false) == MICROTIN_STATUS_OK);
  CHECK(status_with(false, {0xFF}, false) == MICROTIN_STATUS_OK);
  CHECK(status_with(true, {1, 2, 3, 1, 2, 3, 1, 2, 3}, false) == MICROTIN_STATUS_OK);
  for (const Bytes& broken :
       {Bytes{1}, Bytes{1, 2, 3, 1, 2, 3, 1, 2}, Bytes{1, 0, 3, 1, 2, 3, 1, 2, 3}}) {
    CHECK(status_with(true, broken, false) == MICROTIN_STATUS_MALFORMED);
    CHECK(status_with(true, broken, true) == MICROTIN_STATUS_CHECKSUM);
  }
}

TEST_CASE("stopping after the last phase of a terrain with voids decodes it whole") {
  Tin tin = rolling_tin(900, 12);
  const DecodedTerrain without(encode(tin, Metadata()));
  const MeshCopy copy(without.mesh());
  const std::array<Point, 3> t = triangles_of(copy.mesh).triangles[7];
  tin.voids.push_back(Tin::Triangle{t[0], t[1], t[2]});
  const Bytes stream = encode(tin, Metadata());
  Device device(900);
  microtin_decoder_stop_after_phase(device.decoder, DecodedTerrain(stream).phases());
  CHECK(device.feed_all(stream) == MICROTIN_STATUS_OK);
}

TEST_CASE("workspaces are checked") {
  std::vector<uint64_t> bytes(1000);
  microtin_mesh* mesh = nullptr;
  CHECK(microtin_mesh_init(nullptr, 8000, &mesh) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_mesh_init(reinterpret_cast<uint8_t*>(bytes.data()) + 4, 7000, &mesh) ==
        MICROTIN_STATUS_MISALIGNED);
  CHECK(microtin_mesh_init(bytes.data(), MICROTIN_MESH_BYTES(3) - 1, &mesh) ==
        MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  CHECK(mesh == nullptr);
  CHECK(microtin_mesh_init(bytes.data(), MICROTIN_MESH_BYTES(3), &mesh) == MICROTIN_STATUS_OK);
  CHECK(mesh != nullptr);
}

TEST_CASE("a device needs at most 34 bytes a vertex and 3 KB, and keeps 31") {
  for (const unsigned long n : {3ul, 250ul, 1000ul, MICROTIN_MAX_VERTICES_FOR(16)}) {
    CHECK(MICROTIN_MESH_BYTES_FOR(n, 16) + MICROTIN_DECODER_BYTES_FOR(n, 16) <= 3072 + 34 * n);
    CHECK(MICROTIN_MESH_BYTES_FOR(n, 16) <= 3072 + 31 * n);
  }
}

TEST_CASE("queries on a mesh that is not decoded or not verified report that") {
  const Bytes stream = terrain_stream(400, 10);
  Device device(400);
  uint32_t hint = 0;
  int32_t height = 0;
  CHECK(microtin_mesh_height_at(device.mesh, 0, 0, &hint, &height, 0, 0) ==
        MICROTIN_QUERY_NOT_LOADED);
  size_t used = 0;
  REQUIRE(device.feed(stream.data(), stream.size() - 2, &used) == MICROTIN_STATUS_NEED_INPUT);
  uint16_t x = 0, y = 0;
  int16_t z = 0;
  microtin_mesh_vertex(device.mesh, 0, &x, &y, &z);
  CHECK(microtin_mesh_height_at(device.mesh, x * 256, y * 256, &hint, &height, 0, 0) ==
        MICROTIN_QUERY_UNVERIFIED);
  CHECK(microtin_mesh_height_at(device.mesh, x * 256, y * 256, &hint, &height,
                                MICROTIN_FLAG_ALLOW_UNVERIFIED, 0) == MICROTIN_QUERY_OK);
  CHECK(height == z * 65536);
}

TEST_CASE("a header cannot claim more memory than its bytes could fill") {
  const auto error_of = [](uint32_t vertices, size_t bytes) -> std::string {
    Bytes stream =
        header_of(Contract{vertices, 99, 99, kMinDegree, Coding::kBalanced, false, false});
    stream.resize(stream.size() + bytes);
    try {
      const DecodedTerrain decoded(stream);
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  const std::string refused =
      "cut off or malformed: its header has more vertices than its bytes can hold";
  CHECK(error_of(kMaxVertices, 30) == refused);
  CHECK(error_of(3 + 1421 * 30 + 1, 30) == refused);
  CHECK(error_of(3 + 1421 * 30, 30) != refused);
  CHECK(DecodedTerrain(terrain_stream(3, 1)).phases() == 0);
}
