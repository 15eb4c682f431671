// SPDX-License-Identifier: MIT
// Golden streams: what this version of the format looks like, byte for byte. Files of a released
// version never change (tests/golden/frozen.py). MICROTIN_WRITE_GOLDEN=1 writes them, and
// `host_report X.mtin > X.report` the report of each.
#include <doctest/doctest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <utility>

#include "shared/pack_format.hpp"
#include "shared/start_probabilities.hpp"
#include "tests/support/device.hpp"
#include "tests/support/files.hpp"
#include "tests/support/mesh_copy.hpp"
#include "tests/support/noted_metadata.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

struct Golden {
  std::string name;
  std::vector<uint8_t> stream;
};

Tin flat(const Points& points) {
  Tin tin;
  for (const Point p : points) tin.vertices.push_back(Vertex{p.x, p.y, 0});
  return tin;
}

// Heights that differ by as much as they can, and slivers along the hull.
Tin cliffs(Random& random) {
  Tin tin = flat(uniform_points(60, random));
  tin.vertices.push_back(Vertex{0, 0, 0});
  tin.vertices.push_back(Vertex{65535, 1, 0});
  tin.vertices.push_back(Vertex{32768, 1, 0});
  tin.vertices.push_back(Vertex{30000, 2, 0});
  for (Vertex& v : tin.vertices) v.z = random.below(2) == 0 ? INT16_MIN : INT16_MAX;
  return tin;
}

// Odd x, and seven of eight y even, but for some vertices on the border; with corners.
Tin on_every_other_line(const Tin& tin) {
  std::map<std::pair<uint16_t, uint16_t>, int16_t> heights;
  uint32_t i = 0;
  for (const Vertex& v : tin.vertices) {
    const bool west = i % 16 == 0, north = i % 16 == 8;
    const uint32_t y = i % 8 == 4 ? v.y : v.y & ~1u;
    heights[{static_cast<uint16_t>(west ? 0 : v.x | 1u), static_cast<uint16_t>(north ? 1000 : y)}] =
        v.z;
    ++i;
  }
  const uint16_t ends[] = {0, 1000};
  for (const uint16_t x : ends) heights[{x, ends[0]}] = heights[{x, ends[1]}] = 7;
  Tin on_lines;
  for (const auto& [place, z] : heights) {
    on_lines.vertices.push_back(Vertex{place.first, place.second, z});
  }
  return on_lines;
}

void append(Bytes& bytes, const Bytes& more) {
  bytes.insert(bytes.end(), more.begin(), more.end());
}

Bytes note(uint8_t type, const Bytes& content) {
  Bytes note{type, static_cast<uint8_t>(content.size()), 0};
  append(note, content);
  return note;
}

Bytes chunk(uint32_t type, const Bytes& content) {
  Bytes chunk;
  append_varint(chunk, type);
  append_varint(chunk, content.size());
  append(chunk, content);
  append_check(chunk, 0);
  return chunk;
}

// A stream with all that a reader of this version skips.
Bytes with_what_is_later(const Bytes& stream) {
  Header header = read_header(stream);
  header.contract.below = 0;
  header.contract.above = kMarginMost;
  header.metadata.date = "2026";
  Bytes plain = write_header(header.contract, header.metadata);
  const Bytes known = write_notes(header.metadata);
  Bytes payload(plain.begin() + kIdentityBytes + 1, plain.end() - kCheckBytes);
  payload.resize(payload.size() - known.size());
  append(payload, note(200, {1, 2, 3}));
  append(payload, known);
  append(payload, note(0, {0, 0}));
  append(payload, note(100, {}));
  Bytes later(plain.begin(), plain.begin() + kIdentityBytes);
  append_varint(later, payload.size());
  append(later, payload);
  append_check(later, 0);
  later.insert(later.end(), stream.begin() + header.info.header_bytes, stream.end());
  append(later, chunk(0, {}));
  append(later, chunk(kChunkNumberEnd - 1, Bytes(200, 9)));
  return later;
}

// Given, so that the files stay as they are whatever suits an encoder.
constexpr Effort kUsual = {10, Coding::kBalanced};

Metadata of_kind(SurfaceKind kind, BoundSide side, const Margins& everywhere = {}) {
  Metadata metadata;
  metadata.surface = kind;
  metadata.side = side;
  metadata.everywhere = everywhere;
  return metadata;
}

// Each kind of surface and each side, with codings, degrees, voids and margins in other pairs than
// in the streams without notes.
std::vector<Golden> noted_streams() {
  Random random(38);
  Tin level = flat(uniform_points(30, random));
  for (Vertex& v : level.vertices) v.z = -4000;
  Metadata own = of_kind(SurfaceKind::kObstacles, BoundSide::kNeverBelow, {0, 1600});
  own.bounds = StatedBounds{{50, 7, {5, 1}, {30, 0}, {98, 2}}, {30, 0}, {20, 0}};
  return {{"ground", encode(with_voids(rolling_tin(40, 38)),
                            of_kind(SurfaceKind::kGround, BoundSide::kBoth), {9, Coding::kQuick})},
          {"bed", encode(level, of_kind(SurfaceKind::kBed, BoundSide::kNeverAbove, {17, 0}),
                         {32, Coding::kDense})},
          {"geoid", encode(with_voids(rolling_tin(24, 39)),
                           of_kind(SurfaceKind::kGeoid, BoundSide::kNotStated, {1, 33}),
                           {6, Coding::kBalanced})},
          {"obstacles", encode(rolling_tin(50, 40), own, {7, Coding::kDense})}};
}

std::vector<Golden> golden_streams() {
  const Tin example{
      {{0, 0, 10}, {40, 0, 12}, {40, 30, 20}, {0, 30, 11}, {16, 12, 25}, {30, 20, 18}}, {}};
  Random random(31);
  std::vector<Golden> all;
  all.push_back({"example", encode(example, Metadata(), kUsual)});
  all.push_back({"hills", encode(rolling_tin(1000, 32), full_metadata(), kUsual)});
  all.push_back({"phases", encode(rolling_tin(700, 33), Metadata(), {6, Coding::kQuick})});
  all.push_back(
      {"voids", encode(with_voids(rolling_tin(300, 34)), Metadata(), {8, Coding::kDense})});
  // Chords whose cotangents are the largest 32-bit numbers and beyond.
  all.push_back({"needles", encode(flat({{16948, 26227},
                                         {21539, 23131},
                                         {22795, 22284},
                                         {24051, 21437},
                                         {25307, 20590},
                                         {48695, 4818},
                                         {54109, 1167}}),
                                   Metadata(), kUsual)});
  all.push_back({"triangle", encode(Tin{{{3, 4, -32768}, {60003, 4, 32767}, {3, 65535, 0}}, {}},
                                    Metadata(), kUsual)});
  all.push_back({"cliffs", encode(cliffs(random), Metadata(), {10, Coding::kDense})});
  all.push_back({"lattice", encode(flat(lattice_points(20, 15, random)), Metadata(), kUsual)});
  all.push_back({"circle", encode(flat(circle_points(1105 * 1105, random)), Metadata(),
                                  {32, Coding::kBalanced})});
  // Phases after the first section.
  all.push_back(
      {"sections", encode(flat(lattice_points(40, 30, random)), Metadata(), {6, Coding::kQuick})});
  all.push_back(
      {"corners", encode(flat(extreme_corners(random)), Metadata(), {12, Coding::kDense})});
  // A tile of a pack, on every other line but for some places, up to its border.
  // Margins, a note of a later version in each position, and chunks behind the end.
  all.push_back({"later", with_what_is_later(encode(rolling_tin(300, 36), Metadata(), kUsual))});
  all.push_back({"parities", encode_and_decode(on_every_other_line(rolling_tin(1500, 35)),
                                               Metadata(), kUsual, Origin{true, false})
                                 .stream});
  all.push_back({"notes", encode(rolling_tin(60, 37), noted_metadata(), kUsual)});
  for (Golden& golden : noted_streams()) all.push_back(std::move(golden));
  return all;
}

// The indented lines of format-stream.md up to section 14, and an empty one for each heading.
std::vector<std::string> indented_lines_of_the_format() {
  std::ifstream text(golden("../../../shared/docs/format-stream.md"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) {
    if (line.rfind("## 15.", 0) == 0) break;
    if (line.rfind("    ", 0) == 0) lines.push_back(line);
    if (line.rfind('#', 0) == 0) lines.emplace_back();
  }
  return lines;
}

}  // namespace

TEST_CASE("golden streams are what the encoder writes and the decoder reads") {
  for (const Golden& golden : golden_streams()) {
    const std::string path = tests::golden(golden.name + ".mtin");
    if (std::getenv("MICROTIN_WRITE_GOLDEN") != nullptr) write_file(path, golden.stream);
    CAPTURE(golden.name);
    CHECK(bytes_of_file(path) == golden.stream);
    CHECK_NOTHROW(DecodedTerrain{golden.stream});
  }
}

// Too large to be kept as a file; recorded by the hash of its bytes. The last batch has 69,449.
TEST_CASE("a golden stream has a batch above 65,535 vertices") {
  constexpr uint32_t kVertices = 70000;
  Random random(41);
  const Points points = uniform_points(kVertices, random);
  const Bytes stream = encode(flat(points), Metadata(), kUsual);
  CHECK(stream.size() == 158062);
  CHECK(stream_hash(kStreamHash, stream.data(), stream.size()) == 0x1BA121D3);
  const Device device(kVertices);
  REQUIRE(device.decode(stream) == MICROTIN_STATUS_OK);
  CHECK(microtin_mesh_digest(device.mesh) == 0xC00E6F9B15BD70D9);
}

TEST_CASE("the hexdump in format-stream.md is the example stream") {
  std::vector<uint8_t> dump;
  for (const std::string& line : indented_lines_of_the_format()) {
    std::istringstream row(line);
    std::string offset, digits;
    row >> offset;
    if (offset.size() != 8 || offset.rfind("000000", 0) != 0) continue;
    while (row >> digits) dump.push_back(static_cast<uint8_t>(std::stoul(digits, nullptr, 16)));
  }
  CHECK(dump == golden_streams()[0].stream);
}

TEST_CASE("the table of starts in format-stream.md is the decoder's") {
  std::vector<uint32_t> listed, expected;
  for (const std::string& line : indented_lines_of_the_format()) {
    if (line.empty()) listed.clear();  // it stands under the last heading
    std::istringstream row(line);
    for (uint32_t start; row >> start;) listed.push_back(start);
  }
  for (const uint8_t start : kStartTable) expected.push_back(start);
  CHECK(listed == expected);
}

}  // namespace microtin::tests
