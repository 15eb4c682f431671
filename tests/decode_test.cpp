// The decoder's contract: chunks, limits, stopping, statuses.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <random>

#include "encoder/encode.hpp"
#include "encoder/error.hpp"
#include "fuzz/repair.hpp"
#include "tests/mesh_copy.hpp"
#include "tests/streams.hpp"

using namespace microtin;
using Bytes = std::vector<uint8_t>;

namespace {

// A mesh and a decoder for a given capacity, in workspaces full of garbage with guards behind them.
struct Device {
  explicit Device(uint32_t capacity)
      : mesh_size(MICROTIN_MESH_BYTES(capacity)),
        decoder_size(MICROTIN_DECODER_BYTES(capacity)),
        mesh_storage(mesh_size / 8 + 2, kGarbage),
        decoder_storage(decoder_size / 8 + 2, kGarbage) {
    REQUIRE(microtin_mesh_init(mesh_storage.data(), mesh_size, &mesh) == MICROTIN_DONE);
    REQUIRE(microtin_decoder_init(decoder_storage.data(), decoder_size, mesh, &decoder) ==
            MICROTIN_DONE);
  }

  bool guards_are_whole() const {
    return mesh_storage.back() == kGarbage && decoder_storage.back() == kGarbage;
  }

  microtin_status feed(const uint8_t* bytes, size_t size, size_t* used, uint32_t steps = 0) const {
    return microtin_feed(decoder, bytes, size, steps, used);
  }
  microtin_status feed_all(const Bytes& bytes) const {
    size_t used = 0;
    return feed(bytes.data(), bytes.size(), &used);
  }

  static constexpr uint64_t kGarbage = 0xA5A5A5A5A5A5A5A5u;
  size_t mesh_size, decoder_size;
  std::vector<uint64_t> mesh_storage, decoder_storage;
  microtin_mesh* mesh = nullptr;
  microtin_decoder* decoder = nullptr;
};

// The vertices in the mesh after each byte, fed one at a time.
std::vector<uint32_t> vertices_by_byte(const Bytes& stream) {
  Device device(2000);
  std::vector<uint32_t> counts;
  for (const uint8_t& byte : stream) {
    size_t used = 0;
    device.feed(&byte, 1, &used);
    counts.push_back(microtin_vertex_count(device.mesh));
  }
  return counts;
}

}  // namespace

TEST_CASE("chunks of any size give the same terrain at the same byte positions") {
  const Bytes stream = terrain_stream(700, 5);
  const std::vector<uint32_t> expected = vertices_by_byte(stream);
  Device whole(700);
  REQUIRE(whole.feed_all(stream) == MICROTIN_DONE);
  std::mt19937 random(7);
  for (int round = 0; round < 20; ++round) {
    Device device(700);
    size_t at = 0;
    microtin_status status = MICROTIN_NEED_INPUT;
    while (at < stream.size()) {
      const size_t chunk = std::min<size_t>(random() % 300, stream.size() - at);
      size_t used = 0;
      status = device.feed(stream.data() + at, chunk, &used);
      REQUIRE(used == chunk);
      at += used;
      if (at != 0) CHECK(microtin_vertex_count(device.mesh) == expected[at - 1]);
    }
    CHECK(status == MICROTIN_DONE);
    CHECK(microtin_digest(device.mesh) == microtin_digest(whole.mesh));
    CHECK(microtin_bytes_used(device.decoder) == stream.size());
  }
}

TEST_CASE("a step limit of any size gives the same terrain") {
  const Bytes stream = terrain_stream(500, 6);
  Device whole(500);
  REQUIRE(whole.feed_all(stream) == MICROTIN_DONE);
  for (const uint32_t limit : {1u, 2u, 17u, 1000u}) {
    for (const size_t chunk : {size_t{1}, size_t{7}, size_t{100}, stream.size()}) {
      Device device(500);
      size_t at = 0;
      microtin_status status = MICROTIN_STEP_LIMIT;
      uint32_t before = 0;
      while (status == MICROTIN_STEP_LIMIT || status == MICROTIN_NEED_INPUT) {
        size_t used = 0;
        status = device.feed(stream.data() + at, std::min(chunk, stream.size() - at), &used, limit);
        at += used;
        const uint32_t now = microtin_vertex_count(device.mesh);
        REQUIRE(now <= before + std::max(limit, 3u));
        before = now;
      }
      CHECK(status == MICROTIN_DONE);
      CHECK(at == stream.size());
      CHECK(microtin_digest(device.mesh) == microtin_digest(whole.mesh));
    }
  }
}

TEST_CASE("the decoder stops at the end and leaves what follows alone") {
  Bytes stream = terrain_stream(300, 1);
  const size_t end = stream.size();
  stream.insert(stream.end(), 500, 0xFF);  // erased flash
  for (const size_t chunk : {size_t{1}, size_t{64}, stream.size()}) {
    Device device(300);
    size_t at = 0;
    microtin_status status = MICROTIN_NEED_INPUT;
    while (status == MICROTIN_NEED_INPUT) {
      size_t used = 0;
      status = device.feed(stream.data() + at, std::min(chunk, stream.size() - at), &used);
      at += used;
    }
    CHECK(status == MICROTIN_DONE);
    CHECK(at == end);
    CHECK(microtin_bytes_used(device.decoder) == end);
    size_t used = 9;
    CHECK(device.feed(stream.data() + at, 10, &used) == MICROTIN_DONE);
    CHECK(used == 0);
  }
}

TEST_CASE("every prefix needs input and, if finished there, is truncated") {
  const Bytes stream = terrain_stream(60, 2);
  for (size_t size = 0; size < stream.size(); ++size) {
    const Bytes prefix(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size));
    Device device(60);
    CHECK(device.feed_all(prefix) == MICROTIN_NEED_INPUT);
    CHECK(microtin_finish(device.decoder) == MICROTIN_TRUNCATED);
    CHECK(device.feed_all(stream) == MICROTIN_TRUNCATED);
  }
}

TEST_CASE("every single flipped bit is noticed, and never before it is reached") {
  const Bytes stream = terrain_stream(40, 3);
  for (size_t bit = 0; bit < 8 * stream.size(); ++bit) {
    Bytes damaged = stream;
    damaged[bit / 8] = static_cast<uint8_t>(damaged[bit / 8] ^ (1 << bit % 8));
    Device device(40);
    device.feed_all(damaged);
    const microtin_status status = microtin_finish(device.decoder);
    CHECK(status >= MICROTIN_BAD_MAGIC);
    CHECK(status <= MICROTIN_TRUNCATED);
    CHECK(microtin_bytes_used(device.decoder) >= std::min<size_t>(bit / 8, 18));
  }
}

TEST_CASE("damage behind right checks ends in a status, and the mesh stays sound") {
  const Bytes stream = terrain_stream(40, 11);
  int rejected = 0;
  for (size_t at = 5; at < stream.size(); ++at) {
    const uint8_t byte = stream[at];
    for (const int other : {0, 255, byte + 1, byte - 1}) {
      Bytes damaged = stream;
      damaged[at] = static_cast<uint8_t>(other);
      repair(damaged.data(), damaged.size());
      Device device(60);
      device.feed_all(damaged);
      const microtin_status status = microtin_finish(device.decoder);
      CHECK((status == MICROTIN_DONE || status >= MICROTIN_BAD_MAGIC));
      rejected += status != MICROTIN_DONE;
      if (microtin_vertex_count(device.mesh) < 3) continue;
      CHECK(is_sound(MeshCopy(device.mesh)));
      CHECK(device.guards_are_whole());
    }
  }
  CHECK(rejected > 100);
}

TEST_CASE("a mesh of exactly n vertices is enough, n - 1 is too small and says so early") {
  const Bytes stream = terrain_stream(101, 4);
  Device exact(101);
  CHECK(exact.feed_all(stream) == MICROTIN_DONE);
  Device small(100);
  CHECK(small.feed_all(stream) == MICROTIN_TOO_BIG);
  CHECK(microtin_vertex_count(small.mesh) == 0);
  microtin_info info;
  REQUIRE(microtin_peek(stream.data(), stream.size(), &info) == MICROTIN_DONE);
  CHECK(info.vertices == 101);
  CHECK(info.mesh_bytes == MICROTIN_MESH_BYTES(101));
  CHECK(microtin_bytes_used(small.decoder) == info.header_bytes);
}

TEST_CASE("every phase can be the last, and is a coarser terrain") {
  const Bytes stream = terrain_stream(1500, 8, {6});
  const uint32_t phases = DecodedTerrain(stream).phases();
  REQUIRE(phases >= 3);
  uint32_t before = 3;
  for (uint32_t phase = 1; phase <= phases; ++phase) {
    Device device(1500);
    microtin_stop_after_phase(device.decoder, phase);
    const microtin_status status = device.feed_all(stream);
    CHECK(status == (phase == phases ? MICROTIN_DONE : MICROTIN_STOPPED));
    CHECK(microtin_phase(device.decoder) == phase);
    const uint32_t vertices = microtin_vertex_count(device.mesh);
    CHECK(vertices > before);
    CHECK(microtin_triangle_count(device.mesh) == 2 * vertices - 2);
    before = vertices;
  }
}

TEST_CASE("statuses name what is wrong") {
  const Bytes stream = terrain_stream(20, 9);
  const auto status_of = [](const Bytes& bytes) {
    Device device(20);
    device.feed_all(bytes);
    return microtin_finish(device.decoder);
  };
  Bytes other = stream;
  other[0] = 'M';
  CHECK(status_of(other) == MICROTIN_BAD_MAGIC);
  other = stream;
  other[4] = 99;
  CHECK(status_of(other) == MICROTIN_UNSUPPORTED_VERSION);
  other = stream;
  other[8] ^= 1;
  CHECK(status_of(other) == MICROTIN_CHECKSUM);
  other.back() ^= 1;
  other[8] ^= 1;
  CHECK(status_of(other) == MICROTIN_CHECKSUM);
}

TEST_CASE("header blocks: unknown ones are skipped, required ones refused, broken ones malformed") {
  const Bytes stream = terrain_stream(20, 9);
  const auto status_with = [&](const Bytes& blocks, bool damaged) {
    Bytes other = stream;
    Bytes added = {static_cast<uint8_t>(blocks.size()), 0};
    added.insert(added.end(), blocks.begin(), blocks.end());
    const uint32_t at = kIdentityBytes + dimensions_bytes(other[5]);
    other.insert(other.begin() + at, added.begin(), added.end());
    other[5] |= kHasBlocks;
    repair(other.data(), other.size());
    if (damaged) other[at + added.size()] ^= 1;
    microtin_info info;
    const microtin_status peeked = microtin_peek(other.data(), other.size(), &info);
    Device device(20);
    const microtin_status status = device.feed_all(other);
    CHECK(status == peeked);
    return status;
  };
  const uint8_t placement = kBlockPlacement;
  CHECK(status_with({0x7F, 2, 0, 9, 9}, false) == MICROTIN_DONE);
  CHECK(status_with({0x7F, 0, 0, 0x7E, 1, 0, 5}, false) == MICROTIN_DONE);
  CHECK(status_with({placement, 9, 0, 1, 2, 3, 1, 2, 3, 1, 2, 3}, false) == MICROTIN_DONE);
  CHECK(status_with({0xFF, 2, 0, 9, 9}, false) == MICROTIN_UNSUPPORTED_VERSION);
  // Of several faults the first is told.
  CHECK(status_with({placement, 0, 0, 0xFF, 0, 0}, false) == MICROTIN_MALFORMED);
  CHECK(status_with({0xFF, 0, 0, placement, 0, 0}, false) == MICROTIN_UNSUPPORTED_VERSION);
  for (const Bytes& broken : {Bytes{0x7F}, Bytes{0x7F, 3, 0, 9, 9}, Bytes{placement, 0, 0},
                              Bytes{placement, 9, 0, 1, 0, 3, 1, 2, 3, 1, 2, 3}}) {
    CHECK(status_with(broken, false) == MICROTIN_MALFORMED);
    CHECK(status_with(broken, true) == MICROTIN_CHECKSUM);
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
  microtin_stop_after_phase(device.decoder, DecodedTerrain(stream).phases());
  CHECK(device.feed_all(stream) == MICROTIN_DONE);
}

TEST_CASE("workspaces are checked") {
  std::vector<uint64_t> bytes(1000);
  microtin_mesh* mesh = nullptr;
  CHECK(microtin_mesh_init(nullptr, 8000, &mesh) == MICROTIN_ARGUMENT);
  CHECK(microtin_mesh_init(reinterpret_cast<uint8_t*>(bytes.data()) + 4, 7000, &mesh) ==
        MICROTIN_MISALIGNED);
  CHECK(microtin_mesh_init(bytes.data(), MICROTIN_MESH_BYTES(3) - 1, &mesh) ==
        MICROTIN_WORKSPACE_TOO_SMALL);
  CHECK(mesh == nullptr);
  CHECK(microtin_mesh_init(bytes.data(), MICROTIN_MESH_BYTES(3), &mesh) == MICROTIN_DONE);
  CHECK(mesh != nullptr);
}

TEST_CASE("a device needs at most 34 bytes a vertex and 3 KB, and keeps 31") {
  for (const unsigned long n : {3ul, 250ul, 1000ul, 10923ul}) {
    CHECK(MICROTIN_MESH_BYTES_FOR(n, 16) + MICROTIN_DECODER_BYTES_FOR(n, 16) <= 3072 + 34 * n);
    CHECK(MICROTIN_MESH_BYTES_FOR(n, 16) <= 3072 + 31 * n);
  }
}

TEST_CASE("queries on a mesh that is not decoded or not verified say so") {
  const Bytes stream = terrain_stream(400, 10);
  Device device(400);
  uint32_t hint = 0;
  int32_t height = 0;
  CHECK(microtin_height_at(device.mesh, 0, 0, 0, &hint, &height) == MICROTIN_NOT_DECODED);
  size_t used = 0;
  REQUIRE(device.feed(stream.data(), stream.size() - 2, &used) == MICROTIN_NEED_INPUT);
  uint16_t x = 0, y = 0;
  int16_t z = 0;
  microtin_vertex(device.mesh, 0, &x, &y, &z);
  CHECK(microtin_height_at(device.mesh, x * 256, y * 256, 0, &hint, &height) ==
        MICROTIN_NOT_VERIFIED);
  CHECK(microtin_height_at(device.mesh, x * 256, y * 256, MICROTIN_ANSWER_UNVERIFIED, &hint,
                           &height) == MICROTIN_HEIGHT);
  CHECK(height == z * 65536);
}
