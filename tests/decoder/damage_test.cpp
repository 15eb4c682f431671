// SPDX-License-Identifier: MIT
// Streams that were cut off or damaged: what the decoder says, and that it never says done.
#include <doctest/doctest.h>

#include "decoder/state.hpp"
#include "fuzz/support/repair.hpp"
#include "tests/support/device.hpp"
#include "tests/support/forged_stream.hpp"
#include "tests/support/mesh_copy.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

constexpr uint32_t kDamagedCapacity = 320;

// With heights; with void flags; with a placement and all notes; with several sections.
std::vector<Bytes> small_streams() {
  return {terrain_stream(40, 3), encode(with_voids(rolling_tin(30, 4)), Metadata()),
          encode(rolling_tin(10, 5), full_metadata()), sectioned_stream(3)};
}

// Feeds an exact-size copy on the heap, so that AddressSanitizer sees reads beyond the end.
microtin_status feed_copy(const Device& device, const uint8_t* begin, size_t size) {
  const Bytes copy(begin, begin + size);
  return device.feed_all(copy);
}

// Every change of one bit, and of one byte to 0, 255, one more and one less.
template <class Visit>
void for_each_damage(const Bytes& stream, const Visit& visit) {
  Bytes damaged = stream;
  for (size_t at = 0; at < stream.size(); ++at) {
    const int byte = stream[at];
    std::vector<int> others = {0, 255, byte + 1, byte - 1};
    for (int bit = 0; bit < 8; ++bit) others.push_back(byte ^ 1 << bit);
    for (const int other : others) {
      damaged[at] = static_cast<uint8_t>(other);
      if (damaged[at] != byte) visit(damaged, at);
    }
    damaged[at] = stream[at];
  }
}

// Whether the decoder keeps saying so, takes nothing more and changes nothing.
bool is_final(const Device& device, microtin_status status, const Bytes& bytes) {
  const uint64_t digest = microtin_mesh_digest(device.mesh),
                 taken = microtin_decoder_bytes_used(device.decoder);
  size_t used = 1;
  return device.feed(bytes.data(), bytes.size(), &used) == status && used == 0 &&
         device.feed(nullptr, 0, &used, 1) == status &&
         microtin_decoder_finish(device.decoder) == status &&
         microtin_decoder_bytes_used(device.decoder) == taken &&
         microtin_mesh_digest(device.mesh) == digest;
}

}  // namespace

TEST_CASE("every prefix needs input and, if finished there, stays truncated") {
  for (const Bytes& stream : small_streams()) {
    for (size_t size = 0; size < stream.size(); ++size) {
      const Device device(kDamagedCapacity);
      CHECK(feed_copy(device, stream.data(), size) == MICROTIN_STATUS_NEED_INPUT);
      CHECK(microtin_decoder_finish(device.decoder) == MICROTIN_STATUS_TRUNCATED);
      CHECK(is_final(device, MICROTIN_STATUS_TRUNCATED, stream));
    }
    CHECK(feed_copy(Device(kDamagedCapacity), stream.data(), stream.size()) == MICROTIN_STATUS_OK);
  }
}

TEST_CASE("peek returns for every prefix the bytes that the header needs, or the header") {
  for (const Bytes& stream : small_streams()) {
    microtin_stream_info whole, info;
    REQUIRE(microtin_read_stream_info(stream.data(), stream.size(), &whole) == MICROTIN_STATUS_OK);
    for (size_t size = 0; size < stream.size(); ++size) {
      const Bytes prefix(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size));
      const microtin_status status = microtin_read_stream_info(prefix.data(), size, &info);
      CHECK(status ==
            (size < whole.header_bytes ? MICROTIN_STATUS_NEED_INPUT : MICROTIN_STATUS_OK));
      CHECK((info.header_bytes == whole.header_bytes || info.header_bytes == 0));
    }
  }
}

TEST_CASE("a flipped bit or a changed byte is damage, and never taken for anything else") {
  for (const Bytes& stream : small_streams()) {
    for_each_damage(stream, [&](const Bytes& damaged, size_t at) {
      const Device device(kDamagedCapacity);
      const microtin_status status = device.decode(damaged);
      const bool longer = status == MICROTIN_STATUS_TRUNCATED;  // as a damaged length makes it
      if (at < sizeof kMagic) {
        CHECK(status == MICROTIN_STATUS_BAD_MAGIC);
      } else if (at == sizeof kMagic) {
        CHECK(status == MICROTIN_STATUS_UNSUPPORTED_VERSION);
      } else {
        CHECK((status == MICROTIN_STATUS_CHECKSUM || longer));
        CHECK(microtin_decoder_bytes_used(device.decoder) > at);
      }
      if (at >= stream.size() - kCheckBytes) {
        uint32_t hint = 0;
        int32_t height = 0;
        CHECK(microtin_mesh_height_at(device.mesh, 0, 0, &hint, &height, 0, 0) ==
              MICROTIN_QUERY_UNVERIFIED);
      }
      CHECK(is_final(device, status, stream));
    });
  }
}

TEST_CASE("damage behind right checks ends in a status, and the mesh stays sound") {
  size_t done = 0, malformed = 0;
  for (const Bytes& stream : small_streams()) {
    for_each_damage(stream, [&](Bytes damaged, size_t) {
      const bool repaired = repair(damaged.data(), damaged.size());
      const Device device(kDamagedCapacity);
      const microtin_status status = device.decode(damaged);
      done += status == MICROTIN_STATUS_OK;
      malformed += status == MICROTIN_STATUS_MALFORMED;
      CHECK((status == MICROTIN_STATUS_OK || status >= MICROTIN_STATUS_BAD_MAGIC));
      CHECK((status != MICROTIN_STATUS_CHECKSUM || !repaired));
      CHECK(is_final(device, status, stream));
      CHECK(device.guards_are_whole());
      if (device.vertices() >= 3 && device.vertices() <= 60) CHECK(is_sound(MeshCopy(device.mesh)));
    });
  }
  CHECK(done > 100);
  CHECK(malformed > 100);
}

TEST_CASE("no payload places a vertex outside the lattice") {
  Random random(9);
  size_t vertices = 0;
  for (const Coding coding : {Coding::kQuick, Coding::kBalanced}) {
    Tin tin;
    for (const Point p : uniform_points(60, random, 40))
      tin.vertices.push_back(Vertex{p.x, p.y, 0});
    const Bytes stream = encode(tin, Metadata(), {10, coding});
    for (int round = 0; round < 20000; ++round) {
      Bytes random_payload = stream;
      for (size_t at = stream.size() / 2 - random.below(20); at < stream.size(); ++at) {
        random_payload[at] = static_cast<uint8_t>(random.below(256));
      }
      repair(random_payload.data(), random_payload.size());
      const Device device(kDamagedCapacity);
      device.decode(random_payload);
      const Mesh& mesh = device.mesh->mesh;
      const Contract& contract = device.decoder->reconstruction.contract;
      for (Index v = 0; v < mesh.vertices; ++v) {
        CHECK(mesh.place[v].x <= contract.x_max);
        CHECK(mesh.place[v].y <= contract.y_max);
      }
      vertices += mesh.vertices;
    }
  }
  CHECK(vertices > 200000);
}

TEST_CASE("chunks of any size give the same status for damaged streams") {
  Random random(8);
  for (const Bytes& stream : small_streams()) {
    for (int round = 0; round < 200; ++round) {
      Bytes damaged = stream;
      uint8_t& byte = damaged[random.below(static_cast<uint32_t>(stream.size()))];
      byte = static_cast<uint8_t>(byte ^ 1u << random.below(8));
      if (round % 2 != 0) repair(damaged.data(), damaged.size());
      const Device whole(kDamagedCapacity), pieces(kDamagedCapacity);
      const microtin_status expected = whole.decode(damaged);
      microtin_status status = MICROTIN_STATUS_NEED_INPUT;
      for (size_t at = 0; at < damaged.size() && status == MICROTIN_STATUS_NEED_INPUT;) {
        const size_t chunk = std::min<size_t>(random.below(90), damaged.size() - at);
        status = feed_copy(pieces, damaged.data() + at, chunk);
        at += chunk;
      }
      CHECK(microtin_decoder_finish(pieces.decoder) == expected);
      CHECK(microtin_decoder_bytes_used(pieces.decoder) ==
            microtin_decoder_bytes_used(whole.decoder));
      CHECK(microtin_mesh_digest(pieces.mesh) == microtin_mesh_digest(whole.mesh));
    }
  }
}

}  // namespace microtin::tests
