// SPDX-License-Identifier: MIT
// Workspaces used again, and calls with next to nothing: no state stays that should not.
#include <doctest/doctest.h>

#include <algorithm>

#include "tests/support/device.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

void begin_again(Device& device) {
  REQUIRE(microtin_decoder_init(device.decoder_space.begin(), device.decoder_space.size(),
                                device.mesh, &device.decoder) == MICROTIN_STATUS_OK);
}

microtin_query_result answer_at(const Device& device, uint32_t flags) {
  uint32_t hint = 0;
  int32_t height = 0;
  return microtin_mesh_height_at(device.mesh, 500 * 256, 500 * 256, &hint, &height, flags, 0);
}

bool has_void(const Device& device) {
  for (uint32_t t = 0; t < microtin_mesh_triangle_count(device.mesh); ++t) {
    uint32_t v[3];
    if (microtin_mesh_triangle(device.mesh, t, v) == MICROTIN_TRIANGLE_VOID) return true;
  }
  return false;
}

bool is_placed(const Device& device) {
  microtin_axis axis[3];
  microtin_mesh_axes(device.mesh, axis, axis + 1, axis + 2);
  return std::any_of(axis, axis + 3, [](const microtin_axis& a) {
    return a.offset != 0 || a.numerator != 1 || a.denominator != 1;
  });
}

}  // namespace

TEST_CASE("a mesh used again knows no voids of the terrain before") {
  Device device(700);
  REQUIRE(device.decode(encode(with_voids(rolling_tin(600, 5)), Metadata())) == MICROTIN_STATUS_OK);
  REQUIRE(has_void(device));
  const Bytes plain = terrain_stream(700, 6);
  begin_again(device);
  CHECK(!has_void(device));
  for (const uint8_t byte : plain) {
    size_t used = 0;
    device.feed(&byte, 1, &used);
    REQUIRE(!has_void(device));
  }
  CHECK(device.vertices() > 600);
}

TEST_CASE("a mesh used again is verified by checks of its own terrain alone") {
  Device device(250);
  for (const uint32_t before : {100u, 200u}) {
    begin_again(device);
    REQUIRE(device.decode(terrain_stream(before, 7)) == MICROTIN_STATUS_OK);
    begin_again(device);
    CHECK(answer_at(device, 0) == MICROTIN_QUERY_NOT_LOADED);
    const Bytes next = terrain_stream(250, 8);
    size_t at = 0;
    microtin_status status = MICROTIN_STATUS_STEP_LIMIT;
    while (status != MICROTIN_STATUS_OK) {
      REQUIRE((status == MICROTIN_STATUS_STEP_LIMIT || status == MICROTIN_STATUS_NEED_INPUT));
      const microtin_query_result answer = answer_at(device, 0);
      REQUIRE((answer == MICROTIN_QUERY_NOT_LOADED || answer == MICROTIN_QUERY_UNVERIFIED));
      size_t used = 0;
      status = device.feed(next.data() + at, next.size() - at, &used, 1);
      at += used;
    }
    CHECK(answer_at(device, 0) == MICROTIN_QUERY_OK);
  }
}

TEST_CASE("a placement is that of a header whose check has passed, or none") {
  const Bytes stream = encode(rolling_tin(30, 9), full_metadata());
  microtin_stream_info info;
  REQUIRE(microtin_read_stream_info(stream.data(), stream.size(), &info) == MICROTIN_STATUS_OK);
  Device device(30);
  for (size_t at = 0; at < info.header_bytes; ++at) {
    CHECK(!is_placed(device));
    size_t used = 0;
    REQUIRE(device.feed(stream.data() + at, 1, &used) == MICROTIN_STATUS_NEED_INPUT);
  }
  CHECK(is_placed(device));
  begin_again(device);
  CHECK(!is_placed(device));
  for (size_t at = 5; at < info.header_bytes; ++at) {
    Bytes damaged = stream;
    damaged[at] ^= 1;
    begin_again(device);
    CHECK(device.decode(damaged) != MICROTIN_STATUS_OK);
    CHECK(!is_placed(device));
  }
}

TEST_CASE("no call takes more than it is given, whatever an earlier one left") {
  const Bytes stream = terrain_stream(400, 10);
  for (const size_t chunk : {size_t{1}, size_t{2}, size_t{7}, size_t{30}}) {
    Device device(400);
    size_t at = 0;
    microtin_status status = MICROTIN_STATUS_STEP_LIMIT;
    for (uint32_t call = 0; status != MICROTIN_STATUS_OK; ++call) {
      REQUIRE((status == MICROTIN_STATUS_STEP_LIMIT || status == MICROTIN_STATUS_NEED_INPUT));
      const size_t given = call % 3 == 0 ? 0 : std::min(chunk, stream.size() - at);
      size_t used = 0;
      status = device.feed(stream.data() + at, given, &used, 1);
      REQUIRE(used <= given);
      at += used;
    }
    CHECK(at == stream.size());
  }
}

TEST_CASE("vertices as crowded as they get decode") {
  Random random(11);
  for (const uint32_t spread : {1u, 2u, 5u}) {
    Tin tin;
    for (const Point p : clustered_points(900, random, 60, 6 * spread)) {
      tin.vertices.push_back({p.x, p.y, static_cast<int16_t>(random.below(40))});
    }
    const Device device(static_cast<uint32_t>(tin.vertices.size()));
    CHECK(device.decode(encode(tin, Metadata())) == MICROTIN_STATUS_OK);
    CHECK(device.vertices() == tin.vertices.size());
  }
}

}  // namespace microtin::tests
