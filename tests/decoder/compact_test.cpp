// SPDX-License-Identifier: MIT
// Compact terrains: the same answers as the mesh, in the bytes that were computed before.
#include "microtin/compact.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>

#include "microtin/microtin.hpp"
#include "tests/support/compact_pair.hpp"
#include "tests/support/device.hpp"
#include "tests/support/files.hpp"
#include "tests/support/forged_stream.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/slow.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

std::unique_ptr<Device> decoded(const Bytes& stream) {
  microtin_stream_info info;
  REQUIRE(microtin_read_stream_info(stream.data(), stream.size(), &info) == MICROTIN_STATUS_OK);
  auto device = std::make_unique<Device>(info.vertices);
  REQUIRE(device->decode(stream) == MICROTIN_STATUS_OK);
  return device;
}

struct Needs {
  size_t bytes = 0, scratch = 0;
};

// Makes a compact terrain of a mesh, in calls of `piece` steps.
microtin_status make(void* target, size_t size, microtin_mesh* mesh, void* scratch,
                     size_t scratch_size, uint32_t piece, microtin_compact** compact,
                     Needs* needs) {
  microtin_compactor* compactor = nullptr;
  microtin_status status =
      microtin_compactor_init(target, size, mesh, scratch, scratch_size, &compactor);
  if (status != MICROTIN_STATUS_OK) return status;
  const uint32_t most = 44 * microtin_mesh_vertex_count(mesh) + 44;
  uint32_t steps = 0;
  do {
    status = microtin_compactor_run(compactor, compact, piece);
    REQUIRE((steps += piece) <= most + piece);
  } while (status == MICROTIN_STATUS_STEP_LIMIT);
  microtin_compactor_required_bytes(compactor, &needs->bytes, &needs->scratch);
  return status;
}

// A compact terrain in exactly the bytes that it needs, which are computed before the mesh is
// touched.
class Compact {
 public:
  explicit Compact(const Bytes& stream, uint32_t piece = 1u << 20) : device_(decoded(stream)) {
    microtin_mesh* const mesh = device_->mesh;
    const Told before = told_by(mesh);
    Workspace little(64), first_scratch(MICROTIN_DECODER_BYTES(device_->vertices()));
    REQUIRE(make(little.begin(), little.size(), mesh, first_scratch.begin(), first_scratch.size(),
                 piece, &compact_, &needs_) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
    CHECK(compact_ == nullptr);
    CHECK(told_by(mesh) == before);
    space_ = std::make_unique<Workspace>(needs_.bytes);
    scratch_ = std::make_unique<Workspace>(needs_.scratch);
    const Needs told = needs_;
    REQUIRE(make(space_->begin(), told.bytes, mesh, scratch_->begin(), told.scratch - 1, piece,
                 &compact_, &needs_) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
    REQUIRE(make(space_->begin(), told.bytes - 1, mesh, scratch_->begin(), told.scratch, piece,
                 &compact_, &needs_) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
    CHECK(told_by(mesh) == before);
    REQUIRE(make(space_->begin(), told.bytes, mesh, scratch_->begin(), told.scratch, piece,
                 &compact_, &needs_) == MICROTIN_STATUS_OK);
    CHECK(needs_.bytes == told.bytes);
    CHECK(needs_.scratch == told.scratch);
    CHECK(microtin_compact_size(compact_) == told.bytes);
    CHECK(microtin_mesh_triangle_count(mesh) == 0);
    CHECK(space_->guards_are_whole());
    CHECK(scratch_->guards_are_whole());
    CHECK(device_->guards_are_whole());
  }

  const microtin_compact* get() const { return compact_; }
  const Needs& needs() const { return needs_; }
  uint32_t repeats() const {
    return microtin_compact_triangle_count(compact_) / 2 + 1 -
           microtin_compact_vertex_count(compact_);
  }
  Bytes bytes() const {
    const uint8_t* const begin = reinterpret_cast<const uint8_t*>(compact_);
    return Bytes(begin, begin + needs_.bytes);
  }

 private:
  std::unique_ptr<Device> device_;
  std::unique_ptr<Workspace> space_, scratch_;
  microtin_compact* compact_ = nullptr;
  Needs needs_;
};

Tin wild_tin(const Points& points) {
  Tin tin;
  Random random(7);
  for (const Point p : points) {
    tin.vertices.push_back(Vertex{p.x, p.y, static_cast<int16_t>(random.below(65536) - 32768)});
  }
  return tin;
}

// Made in calls of any length, in place too, it is the same and answers as the mesh does.
uint32_t check(const Bytes& stream, uint32_t seed, int places = 300) {
  Random random(seed);
  const std::unique_ptr<Device> mesh = decoded(stream);
  const Compact compact(stream);
  CHECK(difference(mesh->mesh, compact.get(), places, random) == "");
  const Compact pieces(stream, 1 + seed % 7);
  CHECK(pieces.bytes() == compact.bytes());
  const std::unique_ptr<Device> own = decoded(stream);
  Needs needs;
  microtin_compact* in_place = nullptr;
  const microtin_status status =
      make(own->mesh, own->mesh_space.size(), own->mesh, own->decoder_space.begin(),
           own->decoder_space.size(), 1 + seed % 5, &in_place, &needs);
  CHECK(own->guards_are_whole());
  const uint32_t n = own->vertices();
  CHECK(
      (status == MICROTIN_STATUS_OK || n < 64 || compact.repeats() > MICROTIN_COMPACT_REPEATS(n)));
  if (status == MICROTIN_STATUS_OK) {
    const uint8_t* const begin = reinterpret_cast<const uint8_t*>(in_place);
    CHECK(Bytes(begin, begin + needs.bytes) == compact.bytes());
  } else {
    CHECK(status == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
    CHECK(microtin_mesh_digest(own->mesh) == microtin_mesh_digest(mesh->mesh));
  }
  return compact.repeats();
}

void check_tin(const Tin& tin, uint32_t seed, bool voids = true) {
  check(encode(tin, Metadata(), Effort{32, Coding::kQuick}), seed);
  if (voids && tin.vertices.size() > 3) {
    check(encode(with_voids(tin), Metadata(), Effort{32, Coding::kQuick}), seed + 1);
  }
}

}  // namespace

TEST_CASE("in place there is room for what the macros allow for, from 64 vertices on") {
  for (const unsigned long bits : {16ul, 32ul}) {
    for (unsigned long n = 3; n < 20000; ++n) {
      const unsigned long twins = bits / 8 * 6 * std::max(n, 64ul);
      const unsigned long most = MICROTIN_COMPACT_HEADER_BYTES + twins;
      REQUIRE(MICROTIN_COMPACT_BYTES_FOR(n, 2ul, bits) <= most);
    }
  }
}

TEST_CASE("compact terrains have the mesh's results: golden streams") {
  uint32_t streams = 0;
  for (const auto& entry : std::filesystem::directory_iterator(golden_folder())) {
    if (entry.path().extension() != ".mtin") continue;
    CAPTURE(entry.path().string());
    check(bytes_of_file(entry.path().string()), ++streams);
  }
  CHECK(streams > 5);
}

TEST_CASE("compact terrains have the mesh's results: point sets, with voids too" * kSlow) {
  for (const PointSet& set : tiny_point_sets()) {
    CAPTURE(set.name);
    check_tin(wild_tin(set.points), 3);
  }
  for (const uint32_t n : {12u, 30u, 100u, 300u, 1500u}) {
    for (const PointSet& set : point_sets(n, n)) {
      CAPTURE(set.name);
      CAPTURE(n);
      check_tin(wild_tin(set.points), n);
    }
  }
}

TEST_CASE("compact terrains have the mesh's results: many small ones") {
  for (uint32_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const uint32_t n = 4 + random.below(40), side = 4 + random.below(20);
    Points points = uniform_points(n, random, side);
    points.push_back(point(side, side + 1));  // not all on a line, whatever the others are
    points.push_back(point(side + 1, side));
    check_tin(wild_tin(points), seed, seed % 3 == 0);
  }
}

namespace {

uint32_t repeats_of(const Points& points) {
  const Bytes stream = encode(wild_tin(points), Metadata(), Effort{32, Coding::kQuick});
  const std::unique_ptr<Device> device = decoded(stream);
  const uint32_t n = device->vertices();
  Workspace space(40 * n + 200), scratch(MICROTIN_DECODER_BYTES(2 * n));
  microtin_compact* compact = nullptr;
  Needs needs;
  REQUIRE(make(space.begin(), space.size(), device->mesh, scratch.begin(), scratch.size(), 1000,
               &compact, &needs) == MICROTIN_STATUS_OK);
  return microtin_compact_triangle_count(compact) / 2 + 1 - n;
}

// Points that the path misses many of, found by moving one after another.
Points missed_points(uint32_t n, uint32_t tries, Random& random) {
  Points best = uniform_points(n, random, 200);
  uint32_t most = repeats_of(best);
  for (uint32_t i = 0; i < tries; ++i) {
    Points points = best;
    points[random.below(static_cast<uint32_t>(points.size()))] = point_in(random, 200);
    points = distinct(points, random);
    const uint32_t repeats = repeats_of(points);
    if (repeats < most || points.size() < best.size()) continue;
    best = points;
    most = repeats;
  }
  return best;
}

}  // namespace

TEST_CASE("compact terrains have the mesh's results: many vertices missed by the path") {
  uint32_t most = 0;
  for (uint32_t seed = 0; seed < 6; ++seed) {
    Random random(seed);
    const Points points = missed_points(16 + 2 * seed, 250, random);
    const Tin tin = wild_tin(points);
    most = std::max(most, check(encode(tin, Metadata(), Effort{32, Coding::kQuick}), seed, 3000));
    check(encode(with_voids(tin), Metadata(), Effort{32, Coding::kQuick}), seed, 3000);
  }
  CHECK(most >= 6);
}

TEST_CASE("compact terrains have the mesh's results: hubs with long fans, and forged streams") {
  Points hub = {point(30000, 30000)};
  for (int i = 0; i < 800; ++i) {
    const double angle = i * 2 * 3.14159265358979 / 800;
    for (const double radius : {20000.0, 25000.0 + i % 7}) {
      hub.push_back(point(30000 + std::lround(radius * std::cos(angle)),
                          30000 + std::lround(radius * std::sin(angle))));
    }
  }
  Random random(5);
  check_tin(wild_tin(distinct(hub, random)), 5);
  for (const uint32_t spokes : {8u, 24u, 32u}) {
    check(forge(Contract{spokes + 1, kWheelSide, kWheelSide, kMaxDegree, Coding::kQuick, false,
                         false},
                PlanCoder(wheel(spokes))),
          spokes);
  }
  check(sectioned_stream(3), 9);
}

TEST_CASE("compact terrains of the encoder fit the macros, 8.5 or 10.5 bytes a vertex") {
  const auto check_size = [](const Tin& tin, bool is_narrow) {
    const Compact compact(encode(tin, Metadata(), Effort{10, Coding::kBalanced}), 0x7FFFFFFF);
    const uint32_t n = microtin_compact_vertex_count(compact.get()), repeats = compact.repeats();
    CHECK(compact.needs().bytes <=
          (is_narrow ? MICROTIN_COMPACT_NARROW_BYTES(n) : MICROTIN_COMPACT_BYTES(n)));
    CHECK(compact.needs().scratch <= MICROTIN_COMPACTOR_BYTES(n));
    CHECK(MICROTIN_COMPACTOR_BYTES(n) <= MICROTIN_DECODER_BYTES(n));
    // With numbers of 16 bits.
    const double bytes = MICROTIN_COMPACT_HEADER_BYTES +
                         (is_narrow ? 8.0 : 10.0) * (n + 1 + repeats) + 2.0 * repeats;
    CHECK(bytes <= (is_narrow ? 8.5 : 10.5) * n + 300);
    CHECK(repeats <= 4 + n / 300);
  };
  for (const uint32_t n : {250u, 1000u, 10000u}) {
    const Tin tin = rolling_tin(n, n);
    check_size(tin, false);
    check_size(with_voids(tin), false);
    Tin narrow = tin;
    Random random(n);
    narrow.vertices.clear();
    for (const Point p : uniform_points(n, random, 256)) narrow.vertices.push_back({p.x, p.y, 5});
    check_size(narrow, true);
  }
  for (const PointSet& set : point_sets(1000, 8)) {
    CAPTURE(set.name);
    const Compact compact(encode(wild_tin(set.points), Metadata(), Effort{10, Coding::kBalanced}),
                          0x7FFFFFFF);
    const uint32_t n = microtin_compact_vertex_count(compact.get());
    CHECK(compact.needs().bytes <= MICROTIN_COMPACT_BYTES(n));
    CHECK(compact.needs().scratch <= MICROTIN_COMPACTOR_BYTES(n));
  }
}

TEST_CASE("compact terrains: making takes 15 to 18.5 steps a vertex of a terrain") {
  for (const uint32_t n : {1000u, 10000u}) {
    const Bytes stream = encode(rolling_tin(n, n), Metadata());
    for (const bool in_place : {false, true}) {
      const std::unique_ptr<Device> device = decoded(stream);
      Workspace elsewhere(MICROTIN_COMPACT_BYTES(n));
      void* const target = in_place ? device->mesh : elsewhere.begin();
      const size_t size = in_place ? device->mesh_space.size() : elsewhere.size();
      microtin_compactor* compactor = nullptr;
      REQUIRE(microtin_compactor_init(target, size, device->mesh, device->decoder_space.begin(),
                                      device->decoder_space.size(),
                                      &compactor) == MICROTIN_STATUS_OK);
      microtin_compact* compact = nullptr;
      uint32_t steps = 1;
      while (microtin_compactor_run(compactor, &compact, 1) == MICROTIN_STATUS_STEP_LIMIT) ++steps;
      REQUIRE(compact != nullptr);
      const double each = steps / static_cast<double>(microtin_compact_vertex_count(compact));
      MESSAGE(std::string(in_place ? "in place: " : "elsewhere: ") << each << " steps");
      CHECK(each > 15);
      CHECK(each < 18.5);
    }
  }
}

TEST_CASE("compact terrains: boxes of 255 steps are narrow, of 256 wide") {
  for (const int32_t width : {255, 256}) {
    for (const int32_t height : {255, 256}) {
      const Tin tin = wild_tin({point(700, 900), point(700 + width, 900), point(700, 900 + height),
                                point(700 + width, 900 + height), point(800, 1000)});
      const Bytes stream = encode(tin, Metadata());
      check(stream, 1);
      const bool is_narrow = width == 255 && height == 255;
      const size_t y_bytes = is_narrow ? 0 : 2 * 6;
      CHECK(Compact(stream).needs().bytes ==
            MICROTIN_COMPACT_HEADER_BYTES + 6 * (2 * sizeof(Index) + 4) + y_bytes);
    }
  }
}

TEST_CASE("a compact terrain may be copied to another place") {
  const Bytes stream = terrain_stream(300, 4);
  Bytes copy;
  {
    const Compact compact(stream);
    copy = compact.bytes();
  }
  Workspace elsewhere(copy.size());
  std::memcpy(elsewhere.begin(), copy.data(), copy.size());
  Random random(4);
  CHECK(difference(decoded(stream)->mesh, static_cast<microtin_compact*>(elsewhere.begin()), 500,
                   random) == "");
}

TEST_CASE("compact terrains: a hint for a position outside is that of the nearest on the lattice") {
  const Compact compact(terrain_stream(900, 6));
  const microtin_compact* const c = compact.get();
  const int32_t most = 65535 * 256, far[] = {INT32_MIN, -most, -1, most + 1, INT32_MAX};
  for (const int32_t x : far) {
    const int32_t near = x < 0 ? 0 : most;
    for (const int32_t other : {0, 70000, most}) {
      CHECK(microtin_compact_hint(c, x, other) == microtin_compact_hint(c, near, other));
      CHECK(microtin_compact_hint(c, other, x) == microtin_compact_hint(c, other, near));
    }
  }
}

TEST_CASE("compact terrains: arguments, and meshes that are not verified") {
  const Bytes stream = terrain_stream(900, 6);
  const Device device(900);
  Workspace space(40000), scratch(40000);
  uint8_t* const begin = static_cast<uint8_t*>(space.begin());
  microtin_compactor* compactor = nullptr;
  const auto begins = [&](void* target, microtin_mesh* mesh, void* with, size_t size) {
    return microtin_compactor_init(target, space.size(), mesh, with, size, &compactor);
  };
  CHECK(begins(begin, device.mesh, scratch.begin(), scratch.size()) ==
        MICROTIN_STATUS_ARGUMENT);  // empty
  size_t used = 0;
  microtin_decoder_stop_after_phase(device.decoder, 100);
  REQUIRE(device.feed(stream.data(), stream.size(), &used, 300) == MICROTIN_STATUS_STEP_LIMIT);
  CHECK(begins(begin, device.mesh, scratch.begin(), scratch.size()) == MICROTIN_STATUS_ARGUMENT);
  device.feed(stream.data() + used, stream.size() - used, &used);
  REQUIRE(device.vertices() > 800);
  CHECK(begins(nullptr, device.mesh, scratch.begin(), scratch.size()) == MICROTIN_STATUS_ARGUMENT);
  CHECK(begins(begin, nullptr, scratch.begin(), scratch.size()) == MICROTIN_STATUS_ARGUMENT);
  CHECK(begins(begin, device.mesh, nullptr, scratch.size()) == MICROTIN_STATUS_ARGUMENT);
  CHECK(begins(begin + 4, device.mesh, scratch.begin(), scratch.size()) ==
        MICROTIN_STATUS_MISALIGNED);
  CHECK(begins(begin, device.mesh, scratch.begin(), 300) == MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  CHECK(compactor == nullptr);
  REQUIRE(begins(begin, device.mesh, scratch.begin(), scratch.size()) == MICROTIN_STATUS_OK);
  microtin_compact* compact = nullptr;
  CHECK(microtin_compactor_run(compactor, nullptr, 1) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_compactor_run(nullptr, &compact, 1) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_compactor_run(compactor, &compact, 0) == MICROTIN_STATUS_OK);
  CHECK(microtin_compactor_run(compactor, &compact, 1) == MICROTIN_STATUS_OK);  // said again
  CHECK(compact == space.begin());
}

TEST_CASE("the C++ face of compact terrains") {
  const Bytes stream = terrain_stream(500, 9);
  static Terrain<500> terrain;
  static Decoder<500> decoder(terrain);
  static CompactTerrain<500> compact;
  CHECK(compact.compact() == nullptr);
  size_t used = 0;
  REQUIRE(decoder.feed(stream.data(), stream.size(), &used) == MICROTIN_STATUS_OK);
  const uint64_t digest = terrain.digest();
  const uint32_t vertices = terrain.vertices();
  REQUIRE(compact.make(terrain, decoder) == MICROTIN_STATUS_OK);
  CHECK(compact.vertices() == vertices);
  CHECK(compact.digest() == digest);
  uint32_t hint = compact.hint(500 * 256, 500 * 256);
  int32_t height = 0;
  CHECK(compact.height_at(500 * 256, 500 * 256, &hint, &height) == MICROTIN_QUERY_OK);

  decoder.begin(terrain);
  REQUIRE(decoder.feed(stream.data(), stream.size(), &used) == MICROTIN_STATUS_OK);
  CHECK(compact.make(terrain, decoder) == MICROTIN_STATUS_ARGUMENT);  // it holds a terrain
  CHECK(compact.digest() == digest);
  CHECK(terrain.digest() == digest);
  compact.clear();
  CHECK(compact.make(terrain, decoder) == MICROTIN_STATUS_OK);
  CHECK(compact.digest() == digest);
}

}  // namespace microtin::tests
