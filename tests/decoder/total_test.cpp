// SPDX-License-Identifier: MIT
// What a decoder does with valid streams does not depend on how they come: chunks, step limits,
// capacity, what lies behind; and the mesh answers at any time.
#include <doctest/doctest.h>

#include "shared/format.hpp"
#include "tests/support/device.hpp"
#include "tests/support/forged_stream.hpp"
#include "tests/support/mesh_copy.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

// Feeds the chunk from an exact-size copy on the heap, so that AddressSanitizer sees reads beyond.
microtin_status feed_copy(const Device& device, const Bytes& stream, size_t at, size_t chunk,
                          size_t* used, uint32_t steps = 0) {
  const auto begin = stream.begin() + static_cast<std::ptrdiff_t>(at);
  const size_t size = std::min(chunk, stream.size() - at);
  const Bytes copy(begin, begin + static_cast<std::ptrdiff_t>(size));
  return device.feed(copy.data(), size, used, steps);
}

// The vertices in the mesh after each byte, fed one at a time.
std::vector<uint32_t> vertices_by_byte(const Bytes& stream, uint32_t capacity) {
  const Device device(capacity);
  std::vector<uint32_t> counts;
  for (const uint8_t& byte : stream) {
    size_t used = 0;
    device.feed(&byte, 1, &used);
    counts.push_back(device.vertices());
  }
  return counts;
}

microtin_query_result answer_at(const Device& device, uint32_t x, uint32_t y, uint32_t flags) {
  uint32_t hint = 0;
  int32_t height = 0;
  return microtin_mesh_height_at(device.mesh, static_cast<int32_t>(x * 256),
                                 static_cast<int32_t>(y * 256), &hint, &height, flags, 0);
}

// Queries at the vertices and elsewhere, with what they must say of a mesh so far.
void check_queries(const Device& device, bool verified, Random& random) {
  if (microtin_mesh_triangle_count(device.mesh) == 0) {
    CHECK(answer_at(device, 1, 1, 0) == MICROTIN_QUERY_NOT_LOADED);
    CHECK(answer_at(device, 1, 1, MICROTIN_FLAG_ALLOW_UNVERIFIED) == MICROTIN_QUERY_NOT_LOADED);
    return;
  }
  for (uint32_t v = 0; v < device.vertices(); ++v) {
    uint16_t x = 0, y = 0;
    int16_t z = 0;
    microtin_mesh_vertex(device.mesh, v, &x, &y, &z);
    CHECK(answer_at(device, x, y, MICROTIN_FLAG_ALLOW_UNVERIFIED) == MICROTIN_QUERY_OK);
    CHECK(answer_at(device, x, y, 0) == (verified ? MICROTIN_QUERY_OK : MICROTIN_QUERY_UNVERIFIED));
  }
  const Point p = point_in(random, 1000);
  CHECK(answer_at(device, p.x, p.y, MICROTIN_FLAG_ALLOW_UNVERIFIED) <= MICROTIN_QUERY_VOID);
}

}  // namespace

TEST_CASE("chunks of any size, also of 0 bytes, give the same terrain at the same positions") {
  const Bytes stream = terrain_stream(700, 5);
  const std::vector<uint32_t> expected = vertices_by_byte(stream, 700);
  const Device whole(700);
  REQUIRE(whole.feed_all(stream) == MICROTIN_STATUS_OK);
  Random random(7);
  for (int round = 0; round < 20; ++round) {
    const Device device(700);
    microtin_status status = MICROTIN_STATUS_NEED_INPUT;
    for (size_t at = 0, used = 0; at < stream.size(); at += used) {
      CHECK(device.feed(nullptr, 0, &used) == MICROTIN_STATUS_NEED_INPUT);
      CHECK(used == 0);
      const size_t chunk = std::min<size_t>(random.below(300), stream.size() - at);
      status = feed_copy(device, stream, at, chunk, &used);
      REQUIRE(used == chunk);
      if (at + used != 0) CHECK(device.vertices() == expected[at + used - 1]);
    }
    CHECK(status == MICROTIN_STATUS_OK);
    CHECK(microtin_mesh_digest(device.mesh) == microtin_mesh_digest(whole.mesh));
    CHECK(microtin_decoder_bytes_used(device.decoder) == stream.size());
    CHECK(device.guards_are_whole());
  }
}

TEST_CASE("a step limit of any size gives the same terrain") {
  const Bytes stream = terrain_stream(500, 6);
  const Device whole(500);
  REQUIRE(whole.feed_all(stream) == MICROTIN_STATUS_OK);
  for (const uint32_t limit : {1u, 2u, 17u, 1000u}) {
    for (const size_t chunk : {size_t{1}, size_t{7}, size_t{100}, stream.size()}) {
      const Device device(500);
      size_t at = 0;
      microtin_status status = MICROTIN_STATUS_STEP_LIMIT;
      while (status == MICROTIN_STATUS_STEP_LIMIT || status == MICROTIN_STATUS_NEED_INPUT) {
        const uint32_t before = device.vertices();
        size_t used = 0;
        status = feed_copy(device, stream, at, chunk, &used, limit);
        at += used;
        REQUIRE(device.vertices() <= before + 1 + limit * 2 / 5);
      }
      CHECK(status == MICROTIN_STATUS_OK);
      CHECK(at == stream.size());
      CHECK(microtin_mesh_digest(device.mesh) == microtin_mesh_digest(whole.mesh));
    }
  }
}

TEST_CASE("the decoder stops at the end and leaves what follows alone") {
  Bytes stream = terrain_stream(300, 1);
  const size_t end = stream.size();
  stream.insert(stream.end(), 500, 0xFF);  // erased flash
  for (const size_t chunk : {size_t{1}, size_t{64}, stream.size()}) {
    const Device device(300);
    size_t at = 0, used = 0;
    microtin_status status = MICROTIN_STATUS_NEED_INPUT;
    for (; status == MICROTIN_STATUS_NEED_INPUT; at += used) {
      status = feed_copy(device, stream, at, chunk, &used);
    }
    CHECK(status == MICROTIN_STATUS_OK);
    CHECK(at == end);
    CHECK(microtin_decoder_bytes_used(device.decoder) == end);
    CHECK(feed_copy(device, stream, at, 10, &used) == MICROTIN_STATUS_OK);
    CHECK(used == 0);
  }
}

TEST_CASE("workspaces for exactly n vertices are enough, for n - 1 the header is refused") {
  const Bytes stream = terrain_stream(101, 4);
  const uint32_t n = 101;
  const Device exact(n);
  CHECK(exact.feed_all(stream) == MICROTIN_STATUS_OK);
  CHECK(exact.guards_are_whole());
  microtin_stream_info info;
  REQUIRE(microtin_read_stream_info(stream.data(), stream.size(), &info) == MICROTIN_STATUS_OK);
  CHECK(info.vertices == n);
  CHECK(info.mesh_bytes == MICROTIN_MESH_BYTES(n));
  CHECK(info.decoder_bytes == MICROTIN_DECODER_BYTES(n));
  for (const uint32_t less : {0u, 1u}) {
    const Device small(n - less, n - 1 + less);
    CHECK(small.feed_all(stream) == MICROTIN_STATUS_TOO_BIG);
    CHECK(small.vertices() == 0);
    CHECK(microtin_decoder_bytes_used(small.decoder) == info.header_bytes);
    CHECK(small.guards_are_whole());
  }
}

TEST_CASE("after every step the mesh is the canonical triangulation, and queries know its state") {
  Random random(9);
  for (const Bytes& stream :
       {terrain_stream(50, 7), encode(with_voids(rolling_tin(40, 8)), Metadata())}) {
    const Device device(50);
    size_t at = 0, steps = 0;
    microtin_status status = MICROTIN_STATUS_STEP_LIMIT;
    while (status == MICROTIN_STATUS_STEP_LIMIT) {
      const uint32_t before = device.vertices();
      size_t used = 0;
      status = feed_copy(device, stream, at, stream.size(), &used, 1);
      at += used;
      ++steps;
      REQUIRE(device.vertices() <= before + 1);
      check_queries(device, status == MICROTIN_STATUS_OK, random);
      if (device.vertices() >= 3 && device.vertices() != before) {
        CHECK(is_sound(MeshCopy(device.mesh)));
      }
    }
    CHECK(status == MICROTIN_STATUS_OK);
    CHECK(steps > device.vertices());
    CHECK(device.guards_are_whole());
  }
}

TEST_CASE("a coarser terrain is verified between sections, and not within them") {
  const uint32_t sections = 4;
  const Bytes stream = sectioned_stream(sections);
  const Device device(300);
  uint32_t verified_times = 0;
  bool verified = false;
  for (const uint8_t& byte : stream) {
    size_t used = 0;
    device.feed(&byte, 1, &used);
    const microtin_query_result answer = answer_at(device, 1, 1, 0);
    if (device.vertices() < kSectionVertices) CHECK(answer >= MICROTIN_QUERY_NOT_LOADED);
    verified_times += answer == MICROTIN_QUERY_OK && !verified;
    verified = answer == MICROTIN_QUERY_OK;
  }
  CHECK(verified_times == sections);
}

}  // namespace microtin::tests
