// Compact terrains: the same answers as the mesh, in the bytes that were told.
#include "microtin/compact.h"

#include <doctest/doctest.h>

#include <cstring>
#include <filesystem>
#include <memory>

#include "tests/compact_pair.hpp"
#include "tests/device.hpp"
#include "tests/files.hpp"
#include "tests/forged_stream.hpp"
#include "tests/streams.hpp"

namespace microtin {
namespace {

std::unique_ptr<Device> decoded(const Bytes& stream) {
  microtin_info info;
  REQUIRE(microtin_peek(stream.data(), stream.size(), &info) == MICROTIN_DONE);
  auto device = std::make_unique<Device>(info.vertices);
  REQUIRE(device->decode(stream) == MICROTIN_DONE);
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
      microtin_compact_begin(target, size, mesh, scratch, scratch_size, &compactor);
  if (status != MICROTIN_DONE) return status;
  const uint32_t most = 44 * microtin_vertex_count(mesh) + 44;
  uint32_t steps = 0;
  do {
    status = microtin_compact_proceed(compactor, piece, compact);
    REQUIRE((steps += piece) <= most + piece);
  } while (status == MICROTIN_STEP_LIMIT);
  microtin_compact_needs(compactor, &needs->bytes, &needs->scratch);
  return status;
}

// A compact terrain in exactly the bytes that it needs, which are told before the mesh is touched.
class Compact {
 public:
  explicit Compact(const Bytes& stream, uint32_t piece = 1u << 20) : device_(decoded(stream)) {
    microtin_mesh* const mesh = device_->mesh;
    const Told before = told_by(mesh);
    Workspace little(64), first_scratch(MICROTIN_DECODER_BYTES(device_->vertices()));
    REQUIRE(make(little.begin(), little.size(), mesh, first_scratch.begin(), first_scratch.size(),
                 piece, &compact_, &needs_) == MICROTIN_WORKSPACE_TOO_SMALL);
    CHECK(compact_ == nullptr);
    CHECK(told_by(mesh) == before);
    space_ = std::make_unique<Workspace>(needs_.bytes);
    scratch_ = std::make_unique<Workspace>(needs_.scratch);
    const Needs told = needs_;
    REQUIRE(make(space_->begin(), told.bytes, mesh, scratch_->begin(), told.scratch - 1, piece,
                 &compact_, &needs_) == MICROTIN_WORKSPACE_TOO_SMALL);
    REQUIRE(make(space_->begin(), told.bytes - 1, mesh, scratch_->begin(), told.scratch, piece,
                 &compact_, &needs_) == MICROTIN_WORKSPACE_TOO_SMALL);
    CHECK(told_by(mesh) == before);
    REQUIRE(make(space_->begin(), told.bytes, mesh, scratch_->begin(), told.scratch, piece,
                 &compact_, &needs_) == MICROTIN_DONE);
    CHECK(needs_.bytes == told.bytes);
    CHECK(needs_.scratch == told.scratch);
    CHECK(microtin_compact_size(compact_) == told.bytes);
    CHECK(microtin_triangle_count(mesh) == 0);
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
  CHECK((status == MICROTIN_DONE || own->vertices() < 100 || compact.repeats() > 10));
  if (status == MICROTIN_DONE) {
    const uint8_t* const begin = reinterpret_cast<const uint8_t*>(in_place);
    CHECK(Bytes(begin, begin + needs.bytes) == compact.bytes());
  } else {
    CHECK(status == MICROTIN_WORKSPACE_TOO_SMALL);
    CHECK(microtin_digest(own->mesh) == microtin_digest(mesh->mesh));
  }
  return compact.repeats();
}

void check_tin(const Tin& tin, uint32_t seed, bool voids = true) {
  check(encode(tin, Metadata(), Effort{32, 1}), seed);
  if (voids && tin.vertices.size() > 3) {
    check(encode(with_voids(tin), Metadata(), Effort{32, 1}), seed + 1);
  }
}

}  // namespace

TEST_CASE("compact terrains answer as the mesh does: golden streams") {
  uint32_t streams = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MICROTIN_GOLDEN_DIR)) {
    if (entry.path().extension() != ".mtin") continue;
    CAPTURE(entry.path().string());
    check(read_file(entry.path().string()), ++streams);
  }
  CHECK(streams > 5);
}

TEST_CASE("compact terrains answer as the mesh does: point sets, with voids too") {
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

TEST_CASE("compact terrains answer as the mesh does: many small ones") {
  for (uint32_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const uint32_t n = 4 + random.below(40), side = 4 + random.below(20);
    check_tin(wild_tin(uniform_points(n, random, side)), seed, seed % 3 == 0);
  }
}
}  // namespace microtin
