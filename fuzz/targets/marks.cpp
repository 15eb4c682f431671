// SPDX-License-Identifier: MIT
// Any bytes behind a stream, as marks of the edges of one of four terrains. However they are cut
// and steps are rationed, they get one status within the bound of work, and mark edges or nothing.
// The first bytes of an input choose the terrain and the cuts.
#include <algorithm>
#include <cstring>
#include <deque>
#include <vector>

#include "fuzz/support/device.hpp"
#include "fuzz/support/repair.hpp"
#include "microtin/edge_marks.h"
#include "shared/edge_marks.hpp"
#include "tests/support/streams.hpp"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t most);

namespace {

using namespace microtin;
using namespace microtin::tests;

constexpr uint32_t kCapacity = 400;
constexpr size_t kChoiceBytes = 5;  // the terrain, and a seed of the cuts

// A terrain that has been decoded.
struct Terrain {
  explicit Terrain(const Tin& tin) {
    const std::vector<uint8_t> stream = encode(tin, Metadata(), {32, Coding::kBalanced});
    Device device = spaces.device();
    EXPECT(device.decode(stream.data(), stream.size()) == MICROTIN_STATUS_OK);
    mesh = device.mesh;
    digest = microtin_mesh_digest(mesh);
  }

  Workspaces<kCapacity> spaces;
  const microtin_mesh* mesh = nullptr;
  uint64_t digest = 0;
};

// The centre of the third one has more edges than a decoder looks at.
const Terrain& terrain_of(uint8_t choice) {
  static std::deque<Terrain> terrains;
  if (terrains.empty()) {
    Random random(9);
    Tin wheel;
    for (const Point p : circle_points(1105 * 1105, random))
      wheel.vertices.push_back({p.x, p.y, 0});
    wheel.vertices.push_back({32768, 32768, 9});
    terrains.emplace_back(rolling_tin(3, 1));
    terrains.emplace_back(with_voids(rolling_tin(40, 6)));
    terrains.emplace_back(wheel);
    terrains.emplace_back(rolling_tin(250, 42));
  }
  return terrains[choice % 4];
}

// Marks in a workspace on the heap of no byte more than they need. What it holds must not matter.
struct Marks {
  Marks(const Terrain& terrain, unsigned char garbage)
      : space(MICROTIN_EDGE_MARKS_BYTES(microtin_mesh_vertex_count(terrain.mesh)), garbage) {
    EXPECT(microtin_edge_marks_init(space.data(), space.size(), terrain.mesh, &marks) ==
           MICROTIN_STATUS_OK);
  }

  std::vector<unsigned char> space;
  microtin_edge_marks* marks = nullptr;
};

struct Outcome {
  microtin_status status;
  size_t used;
};

// In one call, with as many work units as are promised to suffice.
Outcome feed_whole(const Marks& marks, const std::vector<uint8_t>& bytes, uint32_t most) {
  size_t used = 0;
  const microtin_status status =
      microtin_edge_marks_feed(marks.marks, bytes.data(), bytes.size(), &used, most);
  EXPECT(status != MICROTIN_STATUS_STEP_LIMIT && used <= bytes.size());
  EXPECT(status != MICROTIN_STATUS_NEED_INPUT || used == bytes.size());
  return {status, used};
}

Outcome feed_pieces(const Marks& marks, const std::vector<uint8_t>& bytes, uint32_t most,
                    Random& cuts) {
  const uint32_t largest = 1 + cuts.below(40), most_steps = cuts.below(20);
  uint32_t steps = 0;
  size_t at = 0;
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  while (at != bytes.size() || status == MICROTIN_STATUS_STEP_LIMIT) {
    const uint8_t* const next = bytes.data() + at;
    const size_t size = std::min<size_t>(cuts.below(largest + 1), bytes.size() - at);
    const std::vector<uint8_t> piece(next, next + size);  // reading past its end is seen
    const uint32_t limit = cuts.below(most_steps + 1);
    size_t used = 0;
    status = microtin_edge_marks_feed(marks.marks, piece.data(), size, &used, limit);
    EXPECT(used <= size && (status != MICROTIN_STATUS_NEED_INPUT || used == size));
    at += used;
    if (status == MICROTIN_STATUS_STEP_LIMIT) {
      steps += limit;
      EXPECT(limit != 0 && steps < most);
    } else if (status != MICROTIN_STATUS_NEED_INPUT) {
      break;
    }
  }
  return {status, at};
}

// Both triangles at an edge state the same class, and as many edges have one as are counted.
void check_classes(const Marks& marks, const microtin_mesh* mesh, bool may_have_marks) {
  const uint32_t half_edges = 3 * microtin_mesh_triangle_count(mesh);
  uint32_t marked = 0;
  for (Index h = 0; h < half_edges; ++h) {
    const Index twin = mesh->mesh.twin[h];
    const uint32_t kind = microtin_edge_marks_class(marks.marks, h / 3, h % 3);
    EXPECT(kind == microtin_edge_marks_class(marks.marks, twin / 3, twin % 3));
    EXPECT(kind <= kLineClasses);
    if (kind == 0) continue;
    EXPECT(mesh->mesh.origin[h] != kInfinity && mesh->mesh.origin[twin] != kInfinity);
    ++marked;
  }
  EXPECT(marked == 2 * microtin_edge_marks_count(marks.marks));
  EXPECT((marked != 0) == may_have_marks);
}

// Makes a number equal to another one, or as large as its bytes allow. False if they are too many.
bool set_varint(uint8_t* begin, const uint8_t* end, size_t wanted) {
  const auto bytes = static_cast<uint32_t>(end - begin);
  if (bytes > 2 || (bytes == 2 && wanted < 128)) return false;
  const size_t value = std::min<size_t>(wanted, bytes == 2 ? 16383 : 127);
  if (bytes == 2) begin[0] = static_cast<uint8_t>(128 | value >> 7);
  begin[bytes - 1] = static_cast<uint8_t>(value & 127);
  return true;
}

// Where bytes of marks begin, the payload ends where the content ends.
void repair_payload(uint8_t* content, const uint8_t* end) {
  const uint8_t* next = content;
  uint64_t number = 0;
  if (!read_varint(&next, end, &number)) return;
  uint8_t* const size = content + (next - content);
  if (read_varint(&next, end, &number)) set_varint(size, next, static_cast<size_t>(end - next));
}

// Sets the checks of chunks. Marks reach up to the end, as does a chunk that is too long.
void repair_chunks(uint8_t* bytes, size_t size) {
  for (size_t at = 0; at < size;) {
    const uint8_t *next = bytes + at, *const end = bytes + size;
    uint64_t type = 0, length = 0;
    if (!read_varint(&next, end, &type)) return;
    uint8_t* const stated = bytes + (next - bytes);
    if (!read_varint(&next, end, &length)) return;
    uint8_t* const content = bytes + (next - bytes);
    const auto left = static_cast<size_t>(end - content);
    if (left < kCheckBytes) return;
    if (type == kMarkChunk || length > left - kCheckBytes) {
      if (!set_varint(stated, content, left - kCheckBytes)) return;
      next = stated;
      read_varint(&next, end, &length);
    }
    if (type == kMarkChunk) repair_payload(content, content + length);
    const size_t check = static_cast<size_t>(content - bytes) + static_cast<size_t>(length);
    write_check(bytes, at, check);
    at = check + kCheckBytes;
  }
}

}  // namespace

// Most mutants get right lengths and checks; some stay as they are.
extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t most, unsigned seed) {
  size = LLVMFuzzerMutate(data, size, most);
  if (seed % 16 != 0 && size > kChoiceBytes) {
    repair_chunks(data + kChoiceBytes, size - kChoiceBytes);
  }
  return size;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size < kChoiceBytes) return 0;
  const Terrain& terrain = terrain_of(data[0]);
  uint32_t seed = 0;
  std::memcpy(&seed, data + 1, sizeof seed);
  Random cuts(seed);
  const std::vector<uint8_t> bytes(data + kChoiceBytes, data + size);
  const uint32_t most = 10 * microtin_mesh_vertex_count(terrain.mesh);
  const Marks whole(terrain, 0), pieces(terrain, 0xA5);
  const Outcome one = feed_whole(whole, bytes, most);
  const Outcome other = feed_pieces(pieces, bytes, most, cuts);
  EXPECT(one.status == other.status);
  EXPECT(one.used == other.used);
  const microtin_status status = microtin_edge_marks_finish(whole.marks);
  EXPECT(status == microtin_edge_marks_finish(pieces.marks));
  EXPECT(status == one.status || one.status == MICROTIN_STATUS_NEED_INPUT);
  EXPECT(status != MICROTIN_STATUS_NEED_INPUT);
  check_classes(whole, terrain.mesh, status == MICROTIN_STATUS_OK);
  check_classes(pieces, terrain.mesh, status == MICROTIN_STATUS_OK);
  // What was said stays.
  size_t used = 0;
  EXPECT(microtin_edge_marks_feed(pieces.marks, bytes.data(), bytes.size(), &used, 0) == status);
  EXPECT(used == 0);
  EXPECT(microtin_mesh_digest(terrain.mesh) == terrain.digest);
  return 0;
}
