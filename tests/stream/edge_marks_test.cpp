// SPDX-License-Identifier: MIT
// Marks of edges: what is written is read again, in any pieces; what is damaged or breaks a rule
// gets a status. The second decoder, in Python, reads the golden file.
#include "encoder/stream/edge_marks.hpp"

#include <doctest/doctest.h>

#include <array>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

#include "shared/crc32.hpp"
#include "tests/support/device.hpp"
#include "tests/support/files.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

using Edge = std::array<uint32_t, 2>;      // vertices, the smaller one first
using Classes = std::map<Edge, uint32_t>;  // of marked edges

Edge edge_of(uint32_t a, uint32_t b) {
  return a < b ? Edge{a, b} : Edge{b, a};
}

// A stream, and what a device has after its last section.
struct Decoded {
  explicit Decoded(const Bytes& with_chunks)
      : stream(with_chunks), device(info_of(with_chunks).vertices) {
    size_t used = 0;
    REQUIRE(device.feed(stream.data(), stream.size(), &used) == MICROTIN_STATUS_OK);
    behind.assign(stream.begin() + static_cast<std::ptrdiff_t>(used), stream.end());
  }

  static microtin_stream_info info_of(const Bytes& stream) {
    microtin_stream_info info;
    REQUIRE(microtin_read_stream_info(stream.data(), stream.size(), &info) == MICROTIN_STATUS_OK);
    return info;
  }

  Bytes stream, behind;
  Device device;
};

// Marks in a workspace between guards.
struct Marks {
  explicit Marks(const microtin_mesh* mesh)
      : space(MICROTIN_EDGE_MARKS_BYTES(microtin_mesh_vertex_count(mesh))) {
    REQUIRE(microtin_edge_marks_init(space.begin(), space.size(), mesh, &marks) ==
            MICROTIN_STATUS_OK);
  }
  ~Marks() { CHECK(space.guards_are_whole()); }
  Marks(const Marks&) = delete;
  Marks& operator=(const Marks&) = delete;

  microtin_status read(const Bytes& bytes) const {
    size_t used = 0;
    microtin_edge_marks_feed(marks, bytes.data(), bytes.size(), &used, 0);
    return microtin_edge_marks_finish(marks);
  }

  // From both triangles at each edge.
  Classes classes(const microtin_mesh* mesh) const {
    Classes found;
    for (uint32_t t = 0; t < microtin_mesh_triangle_count(mesh); ++t) {
      uint32_t v[3];
      microtin_mesh_triangle(mesh, t, v);
      for (uint32_t i = 0; i < 3; ++i) {
        const uint32_t kind = microtin_edge_marks_class(marks, t, i);
        const Edge edge = edge_of(v[i], v[(i + 1) % 3]);
        if (found.count(edge) != 0) CHECK(found[edge] == kind);
        if (kind != 0) found[edge] = kind;
        if (kind != 0) CHECK(edge[1] != MICROTIN_VERTEX_AT_INFINITY);
      }
    }
    return found;
  }

  Workspace space;
  microtin_edge_marks* marks = nullptr;
};

// Lines of one edge each, by chance, with classes 1 .. 12.
std::vector<MarkedLine> random_edges(const microtin_mesh* mesh, uint32_t one_of, Random& random,
                                     Classes& expected) {
  std::vector<MarkedLine> lines;
  for (uint32_t t = 0; t < microtin_mesh_triangle_count(mesh); ++t) {
    uint32_t v[3];
    if (microtin_mesh_triangle(mesh, t, v) == MICROTIN_TRIANGLE_GHOST) continue;
    const uint32_t a = v[t % 3], b = v[(t + 1) % 3];
    if (random.below(one_of) != 0 || expected.count(edge_of(a, b)) != 0) continue;
    const uint32_t kind = 1 + random.below(12);
    expected[edge_of(a, b)] = kind;
    lines.push_back({static_cast<LineClass>(kind), {a, b}});
  }
  return lines;
}

// Along a way through the mesh that turns as it likes.
std::vector<uint32_t> random_path(const microtin_mesh* mesh, uint32_t edges, Random& random) {
  uint32_t t = random.below(microtin_mesh_triangle_count(mesh)), v[3];
  while (microtin_mesh_triangle(mesh, t, v) == MICROTIN_TRIANGLE_GHOST) ++t;
  std::vector<uint32_t> path{v[0], v[1]};
  while (path.size() <= edges) {
    const uint32_t corner = random.below(3);
    const uint32_t next = microtin_mesh_neighbour(mesh, t, corner);
    if (microtin_mesh_triangle(mesh, next, v) == MICROTIN_TRIANGLE_GHOST) continue;
    t = next;
    for (uint32_t i = 0; i < 3; ++i) {
      if (v[i] == path.back() && random.below(2) == 0) path.push_back(v[(i + 1) % 3]);
    }
  }
  return path;
}

// Vertices on a circle around one.
Tin wheel() {
  Random random(9);
  Tin tin;
  for (const Point p : circle_points(1105 * 1105, random)) tin.vertices.push_back({p.x, p.y, 0});
  tin.vertices.push_back({32768, 32768, 9});
  return tin;
}

Bytes with_lines(const Bytes& stream, const std::vector<MarkedLine>& lines) {
  Bytes all = stream;
  append_edge_marks(DecodedTerrain(stream).mesh(), lines, all);
  return all;
}

Bytes chunk_of(uint32_t type, const Bytes& content) {
  Bytes all;
  append_varint(all, type);
  append_varint(all, content.size());
  all.insert(all.end(), content.begin(), content.end());
  append_check(all, 0);
  return all;
}

Bytes joined(Bytes a, const Bytes& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

// The chunk with marks that a test changes, of 40 vertices.
Decoded small_terrain(Classes& expected) {
  const Bytes stream = terrain_stream(40, 3);
  const DecodedTerrain terrain(stream);
  Random random(5);
  return Decoded(with_lines(stream, random_edges(terrain.mesh(), 4, random, expected)));
}

Bytes content_of(const Bytes& chunk) {
  REQUIRE(chunk.size() > 6);
  REQUIRE(chunk[1] < 128);
  return {chunk.begin() + 2, chunk.end() - 4};
}

// What tests/firmware/lines.cpp prints.
std::string marked_triangles(const Bytes& stream) {
  const Decoded decoded(stream);
  const Marks marks(decoded.device.mesh);
  const microtin_status status = marks.read(decoded.behind);
  const uint32_t edges = microtin_edge_marks_count(marks.marks);
  std::string text = "status " + std::to_string(status) + "\nedges " + std::to_string(edges) + '\n';
  for (uint32_t t = 0; t < microtin_mesh_triangle_count(decoded.device.mesh); ++t) {
    std::string line = std::to_string(t);
    uint32_t all = 0;
    for (uint32_t i = 0; i < 3; ++i) {
      const uint32_t kind = microtin_edge_marks_class(marks.marks, t, i);
      line += ' ' + std::to_string(kind);
      all |= kind;
    }
    if (all != 0) text += line + '\n';
  }
  return text;
}

}  // namespace

TEST_CASE("edge marks: any edges are read again, with their classes") {
  for (const uint32_t n : {3u, 4u, 12u, 300u, 2000u}) {
    for (const uint32_t one_of : {1u, 3u, 50u}) {
      CAPTURE(n);
      CAPTURE(one_of);
      const Bytes stream = terrain_stream(n, n + one_of);
      Random random(n + one_of);
      Classes expected;
      const DecodedTerrain terrain(stream);
      const auto lines = random_edges(terrain.mesh(), one_of, random, expected);
      const Decoded decoded(with_lines(stream, lines));
      CHECK(decoded.behind.empty() == expected.empty());
      const Marks marks(decoded.device.mesh);
      const bool none = expected.empty();
      CHECK(marks.read(decoded.behind) == (none ? MICROTIN_STATUS_NOT_FOUND : MICROTIN_STATUS_OK));
      CHECK(marks.classes(decoded.device.mesh) == expected);
      CHECK(microtin_edge_marks_count(marks.marks) == expected.size());
    }
  }
}

TEST_CASE("edge marks: vertices of many edges, voids and hull edges") {
  Random random(9);
  for (const Tin& tin : {with_voids(rolling_tin(200, 6)), wheel()}) {
    const Bytes stream = encode(tin, Metadata(), {32, Coding::kBalanced});
    for (const uint32_t one_of : {1u, 2u, 9u}) {
      Classes expected;
      const DecodedTerrain terrain(stream);
      const auto lines = random_edges(terrain.mesh(), one_of, random, expected);
      const Decoded decoded(with_lines(stream, lines));
      const Marks marks(decoded.device.mesh);
      CHECK(marks.read(decoded.behind) == MICROTIN_STATUS_OK);
      CHECK(marks.classes(decoded.device.mesh) == expected);
    }
  }
}

TEST_CASE("edge marks: lines come back as paths that cover each edge once") {
  const Bytes stream = terrain_stream(700, 8);
  const DecodedTerrain terrain(stream);
  Random random(8);
  std::vector<MarkedLine> lines;
  Classes expected;
  for (uint32_t i = 0; i < 30; ++i) {
    const auto kind = static_cast<LineClass>(1 + random.below(12));
    lines.push_back({kind, random_path(terrain.mesh(), 1 + random.below(40), random)});
    const std::vector<uint32_t>& path = lines.back().vertices;
    for (size_t at = 1; at < path.size(); ++at) {
      expected.emplace(edge_of(path[at - 1], path[at]), static_cast<uint32_t>(kind));
    }
  }
  const Bytes all = with_lines(stream, lines);
  const DecodedTerrain marked(all);
  CHECK(marked.marked_edges() == expected.size());
  CHECK(marked.mark_bytes() == all.size() - stream.size());
  Classes found;
  for (const MarkedLine& line : marked.lines()) {
    REQUIRE(line.vertices.size() >= 2);
    for (size_t at = 1; at < line.vertices.size(); ++at) {
      const Edge edge = edge_of(line.vertices[at - 1], line.vertices[at]);
      CHECK(found.emplace(edge, static_cast<uint32_t>(line.kind)).second);
    }
  }
  CHECK(found == expected);
}

namespace {

// Feeds the bytes in pieces, with a limit of steps for each call.
void check_pieces(const Decoded& decoded, const Classes& expected, size_t piece, uint32_t steps) {
  const microtin_mesh* const mesh = decoded.device.mesh;
  const Bytes bytes = joined(decoded.behind, {1, 2, 3});
  const Marks marks(mesh);
  size_t at = 0;
  uint64_t calls = 0;
  microtin_status status = MICROTIN_STATUS_NEED_INPUT;
  while (status == MICROTIN_STATUS_NEED_INPUT || status == MICROTIN_STATUS_STEP_LIMIT) {
    const Bytes copy(
        bytes.begin() + static_cast<std::ptrdiff_t>(at),
        bytes.begin() + static_cast<std::ptrdiff_t>(std::min(at + piece, bytes.size())));
    size_t used = 0;
    status = microtin_edge_marks_feed(marks.marks, copy.data(), copy.size(), &used, steps);
    at += used;
    ++calls;
    REQUIRE(calls <= 10 * microtin_mesh_vertex_count(mesh) + bytes.size());
  }
  CHECK(status == MICROTIN_STATUS_OK);
  CHECK(at == decoded.behind.size());
  CHECK(marks.classes(mesh) == expected);
}

}  // namespace

TEST_CASE("edge marks: pieces and step limits change no result, and work is bounded") {
  Random random(12);
  // A step around the wheel's centre takes many bytes.
  const Bytes streams[] = {terrain_stream(500, 12),
                           encode(wheel(), Metadata(), {32, Coding::kBalanced})};
  for (const Bytes& stream : streams) {
    const DecodedTerrain terrain(stream);
    for (const uint32_t one_of : {1u, 4u, 40u}) {
      Classes expected;
      const Decoded decoded(
          with_lines(stream, random_edges(terrain.mesh(), one_of, random, expected)));
      for (const size_t piece : {size_t{1}, size_t{7}, size_t{100}, decoded.behind.size() + 3}) {
        for (const uint32_t steps : {1u, 5u, 0u}) check_pieces(decoded, expected, piece, steps);
      }
    }
  }
}

TEST_CASE("edge marks: each damaged byte is found, and each prefix is too short") {
  Classes expected;
  const Decoded decoded = small_terrain(expected);
  Bytes damaged = decoded.behind;
  for (size_t at = 0; at < damaged.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      damaged[at] = static_cast<uint8_t>(decoded.behind[at] ^ 1 << bit);
      const Marks marks(decoded.device.mesh);
      const microtin_status status = marks.read(damaged);
      CAPTURE(at);
      CHECK((status == MICROTIN_STATUS_CHECKSUM || status == MICROTIN_STATUS_TRUNCATED));
      CHECK(marks.classes(decoded.device.mesh).empty());
      CHECK(microtin_edge_marks_count(marks.marks) == 0);
      CHECK(marks.read(decoded.behind) == status);  // it stays so
      CHECK_THROWS_WITH(
          EdgeMarks(decoded.device.mesh, damaged.data(), damaged.data() + damaged.size()),
          "the marks of edges behind the stream are damaged");
    }
    damaged[at] = decoded.behind[at];
  }
  for (size_t size = 0; size < damaged.size(); ++size) {
    const Marks marks(decoded.device.mesh);
    const Bytes prefix(damaged.begin(), damaged.begin() + static_cast<std::ptrdiff_t>(size));
    const microtin_status expected_status =
        size == 0 ? MICROTIN_STATUS_NOT_FOUND : MICROTIN_STATUS_TRUNCATED;
    CHECK(marks.read(prefix) == expected_status);
    CHECK(marks.classes(decoded.device.mesh).empty());
  }
}

TEST_CASE("edge marks: changed payloads with right checks end, and mark edges or nothing") {
  Classes expected;
  const Decoded decoded = small_terrain(expected);
  const Bytes content = content_of(decoded.behind);
  Random random(77);
  size_t malformed = 0, read = 0;
  for (int i = 0; i < 4000; ++i) {
    Bytes other = content;
    for (uint32_t changes = 1 + random.below(4); changes != 0; --changes) {
      other[random.below(static_cast<uint32_t>(other.size()))] =
          static_cast<uint8_t>(random.below(256));
    }
    if (random.below(4) == 0) other.resize(random.below(static_cast<uint32_t>(other.size())));
    const Marks marks(decoded.device.mesh);
    const microtin_status status = marks.read(chunk_of(19, other));
    CHECK((status == MICROTIN_STATUS_OK || status == MICROTIN_STATUS_MALFORMED));
    const Classes found = marks.classes(decoded.device.mesh);
    CHECK(found.size() == microtin_edge_marks_count(marks.marks));
    if (status == MICROTIN_STATUS_OK) {
      ++read;
      CHECK(!found.empty());
    } else {
      ++malformed;
      CHECK(found.empty());
    }
  }
  CHECK(malformed > 1000);
  CHECK(read > 0);
}

TEST_CASE("edge marks: each broken rule is malformed, and chunks of other types are skipped") {
  Classes expected;
  const Decoded decoded = small_terrain(expected);
  const Bytes content = content_of(decoded.behind);
  REQUIRE(content[0] == expected.size());
  REQUIRE(content[1] == content.size() - 2);
  const auto status_of = [&](const Bytes& bytes) {
    const Marks marks(decoded.device.mesh);
    return marks.read(bytes);
  };
  const auto changed = [&](size_t at, uint8_t byte) {
    Bytes other = content;
    other[at] = byte;
    return chunk_of(19, other);
  };
  CHECK(status_of(chunk_of(19, content)) == MICROTIN_STATUS_OK);
  CHECK(status_of(chunk_of(19, {})) == MICROTIN_STATUS_MALFORMED);
  CHECK(status_of(chunk_of(19, {5})) == MICROTIN_STATUS_MALFORMED);
  CHECK(status_of(changed(0, 0)) == MICROTIN_STATUS_MALFORMED);    // no edge
  CHECK(status_of(changed(0, 128)) == MICROTIN_STATUS_MALFORMED);  // not the shortest form
  CHECK(status_of(changed(0, 127)) == MICROTIN_STATUS_MALFORMED);  // more edges than there are
  CHECK(status_of(changed(0, content[0] - 9)) == MICROTIN_STATUS_MALFORMED);  // payload is left
  CHECK(status_of(changed(1, content[1] + 1)) == MICROTIN_STATUS_MALFORMED);  // beyond the content
  CHECK(status_of(changed(1, content[1] - 9)) == MICROTIN_STATUS_MALFORMED);  // too short
  CHECK(status_of(chunk_of(19, joined(content, {1, 2, 3}))) == MICROTIN_STATUS_OK);
  const Bytes other = joined(chunk_of(0, {}), chunk_of(200, Bytes(300, 7)));
  CHECK(status_of(joined(other, chunk_of(19, content))) == MICROTIN_STATUS_OK);
  CHECK(status_of(other) == MICROTIN_STATUS_NOT_FOUND);
  CHECK(status_of(joined(chunk_of(19, {5}), decoded.behind)) == MICROTIN_STATUS_MALFORMED);
  CHECK(status_of({128, 19}) == MICROTIN_STATUS_CHECKSUM);  // not a chunk
  const Bytes large = {0xFF, 0xFF, 0xFF, 0xFF, 0x7F};       // 2^31 or more
  CHECK(status_of(large) == MICROTIN_STATUS_CHECKSUM);
  CHECK(status_of(joined({19}, large)) == MICROTIN_STATUS_CHECKSUM);
  CHECK_THROWS_WITH(DecodedTerrain(joined(terrain_stream(40, 3), chunk_of(19, {5}))),
                    "the marks of edges behind the stream are malformed");
}

TEST_CASE("edge marks: arguments") {
  Classes expected;
  const Decoded decoded = small_terrain(expected);
  const microtin_mesh* const mesh = decoded.device.mesh;
  Workspace space(MICROTIN_EDGE_MARKS_BYTES(40) + 1);
  microtin_edge_marks* marks = nullptr;
  const size_t size = MICROTIN_EDGE_MARKS_BYTES(40);
  CHECK(microtin_edge_marks_init(space.begin(), size - 1, mesh, &marks) ==
        MICROTIN_STATUS_WORKSPACE_TOO_SMALL);
  CHECK(marks == nullptr);
  CHECK(microtin_edge_marks_init(static_cast<uint8_t*>(space.begin()) + 1, size, mesh, &marks) ==
        MICROTIN_STATUS_MISALIGNED);
  CHECK(microtin_edge_marks_init(nullptr, size, mesh, &marks) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_edge_marks_init(space.begin(), size, nullptr, &marks) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_edge_marks_init(space.begin(), size, mesh, nullptr) == MICROTIN_STATUS_ARGUMENT);
  const Device empty(40);
  CHECK(microtin_edge_marks_init(space.begin(), size, empty.mesh, &marks) ==
        MICROTIN_STATUS_ARGUMENT);
  REQUIRE(microtin_edge_marks_init(space.begin(), size, mesh, &marks) == MICROTIN_STATUS_OK);
  size_t used = 0;
  CHECK(microtin_edge_marks_feed(nullptr, nullptr, 0, &used, 0) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_edge_marks_feed(marks, nullptr, 1, &used, 0) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_edge_marks_feed(marks, nullptr, 0, nullptr, 0) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_edge_marks_feed(marks, nullptr, 0, &used, 0) == MICROTIN_STATUS_NEED_INPUT);
  CHECK(microtin_edge_marks_finish(nullptr) == MICROTIN_STATUS_ARGUMENT);
  CHECK(microtin_edge_marks_finish(marks) == MICROTIN_STATUS_NOT_FOUND);
  CHECK(microtin_edge_marks_class(marks, 0, 0) == MICROTIN_LINE_NONE);
}

TEST_CASE("edge marks: the golden file is what is written, and what is read") {
  const Bytes stream = encode(rolling_tin(250, 42), Metadata(), {10, Coding::kBalanced});
  const DecodedTerrain terrain(stream);
  Random random(42);
  std::vector<MarkedLine> lines;
  for (uint32_t i = 0; i < 9; ++i) {
    const auto kind = static_cast<LineClass>(1 + random.below(12));
    lines.push_back({kind, random_path(terrain.mesh(), 3 + random.below(20), random)});
  }
  const Bytes all = with_lines(stream, lines);
  const std::string path = golden("../next/lines.mtin"), report = golden("../next/lines.report");
  std::string text;
  for (const MarkedLine& line : DecodedTerrain(all).lines()) {
    text += "line " + std::to_string(static_cast<uint32_t>(line.kind));
    for (const uint32_t v : line.vertices) text += ' ' + std::to_string(v);
    text += '\n';
  }
  const std::string triangles = marked_triangles(all);
  const std::string triangles_path = golden("../next/lines.triangles");
  if (std::getenv("MICROTIN_WRITE_GOLDEN") != nullptr) {
    write_file(path, all);
    write_file(triangles_path, Bytes(triangles.begin(), triangles.end()));
    write_file(report, Bytes(text.begin(), text.end()));
  }
  CHECK(bytes_of_file(path) == all);
  CHECK(bytes_of_file(report) == Bytes(text.begin(), text.end()));
  CHECK(bytes_of_file(triangles_path) == Bytes(triangles.begin(), triangles.end()));
}

}  // namespace microtin::tests
