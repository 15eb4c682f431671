// SPDX-License-Identifier: MIT
// Golden streams that must be refused, one for each rule that a stream can break. The name of each
// begins with the status. MICROTIN_WRITE_GOLDEN=1 writes them anew.
#include <doctest/doctest.h>

#include <cstdlib>
#include <map>
#include <string>

#include "tests/support/files.hpp"
#include "tests/support/forged_stream.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

constexpr uint32_t kRefusedCapacity = 10000;

// --- Contracts and plans -------------------------------------------------------------------------

Contract flat_contract(uint32_t vertices) {
  return Contract{vertices, 99, 99, kMinDegree, Coding::kBalanced, false, false};
}

const std::vector<Vertex> kSeed = {{5, 5, 0}, {90, 10, 0}, {10, 90, 0}};

// The seed and one vertex.
Plan plan_with(const Vertex& vertex) {
  Plan plan{kSeed, {1}};
  plan.vertices.push_back(vertex);
  return plan;
}

const Plan kInside = plan_with({40, 40, 0});

// --- Coders that break a rule --------------------------------------------------------------------

struct NoHits : PlanCoder {
  using PlanCoder::PlanCoder;
  static bool conflicts(const Mesh&, Index) { return false; }
};

// In the last phase passes the first triangle that conflicts.
struct LateHit : PlanCoder {
  using PlanCoder::PlanCoder;
  bool conflicts(const Mesh& mesh, Index h) {
    const bool hit = PlanCoder::conflicts(mesh, h);
    if (!hit || !last_phase()) return hit;
    return met_++ != 0;
  }
  int met_ = 0;
};

// Puts a vertex on a corner of the first real triangle.
struct TakenPlace : PlanCoder {
  using PlanCoder::PlanCoder;
  Vertex next() {
    const Vertex planned = PlanCoder::next();
    return at().stage == Stage::kWalk ? kSeed[0] : planned;
  }
  bool conflicts(const Mesh&, Index) const { return at().vertex != kInfinity; }
};

struct EmptyBatch : PlanCoder {
  using PlanCoder::PlanCoder;
  static bool last_phase() { return false; }
  static uint32_t batch() { return 0; }
};

// Writes the opposite of the bit with that number.
struct OppositeBit : PlanCoder {
  OppositeBit(Plan plan, uint32_t number) : PlanCoder(std::move(plan)), opposite(number) {}
  bool bit(uint32_t probability, bool value) {
    PlanCoder::bit(probability, value != (bits++ == opposite));
    return value;
  }
  uint32_t opposite, bits = 0;
};

// Knows no bound on the work of all phases.
struct Tireless : PlanCoder {
  using PlanCoder::PlanCoder;
  void at(Reconstruction& r) {
    r.work = 0;
    PlanCoder::at(r);
  }
  using PlanCoder::at;
};

// Ends in ones, which leave the payload's last bytes 0.
struct AllVoid : BorderCoder {
  using BorderCoder::BorderCoder;
  static bool is_void(const Mesh&, Index) { return true; }
};

// Ends in a number so high that no encoder writes it: in what is left when the range is divided.
struct RoundedNumber : PlanCoder {
  using PlanCoder::PlanCoder;
  uint32_t uniform(uint32_t count, uint32_t value) {
    for (int i = 0; i < 3; ++i) bit(kProbabilityOne - kProbabilityMargin, false);
    return PlanCoder::uniform(1, count - value);
  }
};

// --- Streams -------------------------------------------------------------------------------------

// A valid stream with one byte of its header changed and the check made right again.
Bytes with_header_byte(size_t at, uint8_t value) {
  Bytes stream = header_of(flat_contract(4));
  stream[at] = value;
  stream.resize(stream.size() - kCheckBytes);
  append_check(stream, 0);
  return stream;
}

// A header of which all behind the identity is given, but for a right check.
Bytes identified(const Bytes& bytes) {
  Bytes stream(kMagic, kMagic + sizeof kMagic);
  stream.push_back(kVersion);
  stream.insert(stream.end(), bytes.begin(), bytes.end());
  append_check(stream, 0);
  return stream;
}

// A header of properties, vertices, x_max, y_max, as far as they are given, and what follows.
Bytes header_with(const std::vector<uint64_t>& numbers, const Bytes& rest = {}) {
  Bytes payload;
  for (const uint64_t number : numbers) append_varint(payload, number);
  payload.insert(payload.end(), rest.begin(), rest.end());
  Bytes framed;
  append_varint(framed, payload.size());
  framed.insert(framed.end(), payload.begin(), payload.end());
  return identified(framed);
}

constexpr uint64_t properties(uint32_t degree, uint32_t coding) {
  return uint64_t{degree} << 5 | coding << 3;
}

constexpr uint64_t kLegal = properties(kMinDegree, 2);

Bytes with_placement(const Bytes& placement) {
  return header_with({kLegal + kHasPlacement, 4, 99, 99}, placement);
}

Bytes with_section(const Bytes& head_and_payload) {
  Bytes stream = header_of(flat_contract(4));
  const size_t from = stream.size();
  stream.insert(stream.end(), head_and_payload.begin(), head_and_payload.end());
  append_check(stream, from);
  return stream;
}

// A valid stream, of one section with less than 128 bytes, with `added` bytes more, or fewer.
Bytes resized_payload(const Contract& contract, const Bytes& valid, int added) {
  Bytes stream = header_of(contract);
  Bytes payload(valid.begin() + static_cast<std::ptrdiff_t>(stream.size()) + 1,
                valid.end() - static_cast<std::ptrdiff_t>(kCheckBytes));
  payload.resize(payload.size() + static_cast<size_t>(added));
  append_section(stream, payload);
  return stream;
}

Bytes valid_stream() {
  return forge(flat_contract(4), PlanCoder(kInside));
}

// A stream whose payload lacks no byte, since four zeros are taken as read.
Bytes valid_stream_that_ends_in_zeros() {
  constexpr uint16_t kLargest = kRefusedCapacity - 2;
  return forge(border_contract(kLargest), AllVoid(Plan{border_seed(kLargest), {kLargest - 1u}}));
}

// One step of height too much, behind a vertex of height z, the highest or lowest: the last bit is
// its sign.
Bytes with_vertex_beyond(int16_t z) {
  Contract contract = flat_contract(3);
  contract.has_heights = true;
  const int16_t within = static_cast<int16_t>(z < 0 ? z + 1 : z - 1);
  const Plan plan{{kSeed[0], {90, 10, z}, {10, 90, within}}, {}};
  OppositeBit valid(plan, UINT32_MAX);
  forge(contract, valid);
  return forge(contract, OppositeBit(plan, valid.bits - 1));
}

// A valid stream with bytes ahead of its only section's length, which takes one byte.
Bytes with_longer_length(const Bytes& ahead) {
  const Bytes valid = valid_stream();
  Bytes stream = header_of(flat_contract(4));
  const auto head = valid.begin() + static_cast<std::ptrdiff_t>(stream.size());
  Bytes section = ahead;
  section.insert(section.end(), head, valid.end() - kCheckBytes);
  stream.insert(stream.end(), section.begin(), section.end());
  append_check(stream, stream.size() - section.size());
  return stream;
}

Bytes with_rounded_number() {
  Contract contract = flat_contract(3);
  contract.x_max = contract.y_max = 65534;
  return forge(contract, RoundedNumber(Plan{{{0, 0, 0}, {65534, 65534, 0}, {1, 65534, 0}}, {}}));
}

Bytes cut_off(size_t size) {
  Bytes stream = valid_stream();
  stream.resize(size < stream.size() ? size : stream.size() - 1);
  return stream;
}

Bytes flipped(size_t at) {
  Bytes stream = valid_stream();
  uint8_t& byte = stream[at < stream.size() ? at : stream.size() - 1];
  byte = static_cast<uint8_t>(byte ^ 1);
  return stream;
}

// Inside the seed or beyond its long side; no two share a place.
Plan scattered(uint32_t n) {
  Random random(41);
  std::vector<Vertex> vertices = kSeed;
  while (vertices.size() < n) {
    const Point p = point_in(random, 80, 10, 10);
    vertices.push_back(Vertex{p.x, p.y, 0});
  }
  return single_steps(vertices);
}

// The last vertex sees two edges of the hull, and comes at the second.
Bytes late_at_hull() {
  std::vector<Vertex> vertices = kSeed;
  vertices.push_back({60, 60, 0});
  vertices.push_back({95, 95, 0});
  return forge(flat_contract(5), LateHit(single_steps(vertices)));
}

using Refused = std::map<std::string, Bytes>;

void add_headers(Refused& all) {
  all["bad_magic"] = with_header_byte(0, 'M');
  all["unsupported_version"] = with_header_byte(4, kVersion + 1);
  all["malformed_header_length"] = identified({0x80});
  all["malformed_header_length_above_31_bits"] = identified({0x88, 0x80, 0x80, 0x80, 0x80});
  all["malformed_header_short"] = header_with({kLegal, 4, 99});
  all["malformed_number_not_shortest"] = header_with({kLegal, 4, 99}, {0x80, 99});
  all["unsupported_property"] = header_with({kLegal + (1 << kPropertyBits), 4, 99, 99});
  all["unsupported_property_high"] = header_with({kLegal + (uint64_t{1} << 63), 4, 99, 99});
  all["unsupported_property_and_more"] = header_with({kLegal + (1 << kPropertyBits), 1, 65536});
  all["malformed_properties_above_64_bits"] =
      header_with({}, {0x82, 0x80, 0x80, 0x80, 0x80, 0x80, 0x80, 0x82, 0x83, 0x28, 4, 99, 99});
  all["malformed_degree_low"] = header_with({properties(kMinDegree - 1, 2), 4, 99, 99});
  all["malformed_degree_high"] = header_with({properties(kMaxDegree + 1, 2), 4, 99, 99});
  all["unsupported_coding"] = header_with({properties(kMinDegree, 0), 4, 99, 99});
  all["malformed_count_low"] = header_of(flat_contract(2));
  all["malformed_count_high"] = header_of(flat_contract(kMaxVertices + 1));
  all["malformed_side_x"] = header_with({kLegal, 4, 65536, 99});
  all["malformed_side_y"] = header_with({kLegal, 4, 99, 65536});
  all["malformed_margin_missing"] = header_with({kLegal + kHasMargins, 4, 99, 99, 1});
  all["malformed_margin_high"] = header_with({kLegal + kHasMargins, 4, 99, 99, 1, kMarginMost + 2});
  all["malformed_placement_short"] = with_placement({1, 2, 3, 1, 2, 3, 1, 2});
  all["malformed_placement_zero"] = with_placement({1, 2, 0, 1, 2, 3, 1, 2, 3});
  all["malformed_placement_above_40_bits"] =
      with_placement({1, 2, 3, 1, 2, 3, 1, 0xA0, 0x80, 0x80, 0x80, 0x80, 0, 3});
  all["malformed_placement_long"] =
      with_placement({0x82, 255, 255, 255, 255, 255, 255, 255, 255, 127, 2, 3});
  all["too_big"] = header_of(flat_contract(kRefusedCapacity + 1));
  all["too_big_for_all"] = header_of(flat_contract(kMaxVertices));
}

void add_damage(Refused& all) {
  const size_t header = header_of(flat_contract(4)).size();
  all["checksum_header"] = flipped(8);
  all["checksum_header_check"] = flipped(header - 1);
  all["checksum_payload"] = flipped(header + 2);
  all["checksum_section_check"] = flipped(SIZE_MAX);
  all["truncated_header"] = cut_off(header - 1);
  all["truncated_payload"] = cut_off(header + 2);
  all["truncated_check"] = cut_off(SIZE_MAX);
}

void add_sections(Refused& all) {
  all["checksum_length_not_shortest"] = with_longer_length({0x80});
  all["malformed_length_not_shortest"] = with_section({0x80});
  all["checksum_length_above_31_bits"] = with_longer_length({0x88, 0x80, 0x80, 0x80});
  all["malformed_length_above_31_bits"] = with_section({0x88, 0x80, 0x80, 0x80, 0x80});
  all["malformed_code_is_range"] = with_section({4, 0xFF, 0xFF, 0xFF, 0xFF});
  all["malformed_number_in_rounding"] = with_rounded_number();
  const Bytes border = valid_stream_that_ends_in_zeros();
  all["malformed_payload_short"] =
      resized_payload(border_contract(kRefusedCapacity - 2), border, -1);
  all["malformed_payload_rest"] = resized_payload(flat_contract(4), valid_stream(), 5);
}

void add_symbols(Refused& all) {
  const Contract three = flat_contract(3), four = flat_contract(4), five = flat_contract(5);
  Contract eight = flat_contract(8), twelve = flat_contract(12), sixty = flat_contract(60);
  twelve.degree = sixty.degree = kMaxDegree;
  eight.x_max = eight.y_max = kWheelSide;
  all["malformed_seed_clockwise"] =
      forge(three, PlanCoder(Plan{{kSeed[0], kSeed[2], kSeed[1]}, {}}));
  all["malformed_seed_on_a_line"] =
      forge(three, PlanCoder(Plan{{{1, 1, 0}, {2, 2, 0}, {4, 4, 0}}, {}}));
  all["malformed_seed_order"] = forge(three, PlanCoder(Plan{{kSeed[1], kSeed[2], kSeed[0]}, {}}));
  all["malformed_height"] = with_vertex_beyond(32767);
  all["malformed_height_low"] = with_vertex_beyond(-32768);
  all["malformed_batch_empty"] = forge(five, EmptyBatch(kInside));
  all["malformed_walk_ends"] = forge(four, NoHits(kInside));
  all["malformed_work"] = forge(sixty, Tireless(scattered(60)));
  all["malformed_place_before_first"] = forge(four, PlanCoder(plan_with({2, 50, 0})));
  all["malformed_place_taken"] = forge(four, TakenPlace(kInside));
  all["malformed_cavity_final"] = forge(twelve, LateHit(scattered(12)));
  all["malformed_cavity_size"] = forge(eight, PlanCoder(wheel(7)));
}

Refused refused_streams() {
  Refused all;
  add_headers(all);
  add_damage(all);
  add_sections(all);
  add_symbols(all);
  return all;
}

microtin_status status_named(const std::string& name) {
  const std::map<std::string, microtin_status> statuses = {
      {"bad", MICROTIN_STATUS_BAD_MAGIC},
      {"unsupported", MICROTIN_STATUS_UNSUPPORTED_VERSION},
      {"too", MICROTIN_STATUS_TOO_BIG},
      {"checksum", MICROTIN_STATUS_CHECKSUM},
      {"malformed", MICROTIN_STATUS_MALFORMED},
      {"truncated", MICROTIN_STATUS_TRUNCATED}};
  return statuses.at(name.substr(0, name.find('_')));
}

}  // namespace

TEST_CASE("each golden stream that must be refused is refused with its status") {
  for (const auto& refused : refused_streams()) {
    const std::string& name = refused.first;
    const Bytes& stream = refused.second;
    const std::string path = golden("refused/" + name + ".mtin");
    if (std::getenv("MICROTIN_WRITE_GOLDEN") != nullptr) write_file(path, stream);
    CAPTURE(name);
    CHECK(bytes_of_file(path) == stream);
    const Device device(kRefusedCapacity);
    CHECK(device.decode(stream) == status_named(name));
    CHECK(device.guards_are_whole());
    CHECK(device.decode(stream) == status_named(name));
  }
}

TEST_CASE("a vertex that must be refused is not inserted first") {
  Refused all = refused_streams();
  all["malformed_cavity_passed"] = late_at_hull();
  for (const auto& refused : all) {
    const std::string& name = refused.first;
    if (name.find("place_") == name.npos && name.find("cavity_") == name.npos) continue;
    microtin_stream_info info;
    REQUIRE(microtin_read_stream_info(refused.second.data(), refused.second.size(), &info) ==
            MICROTIN_STATUS_OK);
    const Device device(info.vertices);
    CAPTURE(name);
    CHECK(device.decode(refused.second) == MICROTIN_STATUS_MALFORMED);
    CHECK(device.vertices() == info.vertices - 1);
  }
}

TEST_CASE("the work of all phases is bounded to the vertex") {
  // One phase up to `first` vertices and then one vertex a phase: how far `last` is over the bound.
  const auto excess = [](uint32_t first, uint32_t last) {
    uint32_t work = first;
    for (uint32_t n = first + 1; n <= last; ++n) work += n;
    return static_cast<int64_t>(work) - work_budget(last);
  };
  const auto stream = [](uint32_t first, uint32_t last) {
    Plan plan = scattered(last);
    plan.batches.assign(last - first, 1);
    plan.batches.insert(plan.batches.begin(), first - 3);
    Contract contract = flat_contract(last);
    contract.degree = kMaxDegree;
    return forge(contract, Tireless(std::move(plan)));
  };
  bool met = false, exceeded = false;
  for (uint32_t first = 4; first < 200 && !(met && exceeded); ++first) {
    uint32_t last = first + 1;
    while (excess(first, last + 1) <= 0) ++last;
    if (!met && excess(first, last) == 0) {
      met = true;
      CHECK(Device(kRefusedCapacity).decode(stream(first, last)) == MICROTIN_STATUS_OK);
    }
    if (!exceeded && excess(first, last + 1) == 1) {
      exceeded = true;
      const Device device(kRefusedCapacity);
      CHECK(device.decode(stream(first, last + 1)) == MICROTIN_STATUS_MALFORMED);
      CHECK(device.vertices() == last);
    }
  }
  CHECK(met);
  CHECK(exceeded);
}

TEST_CASE("what is refused is one rule away from what is not") {
  CHECK(Device(kRefusedCapacity).decode(valid_stream()) == MICROTIN_STATUS_OK);
  CHECK(Device(kRefusedCapacity).decode(valid_stream_that_ends_in_zeros()) == MICROTIN_STATUS_OK);
  Contract twelve = flat_contract(12);
  twelve.degree = kMaxDegree;
  CHECK(Device(kRefusedCapacity).decode(forge(twelve, PlanCoder(scattered(12)))) ==
        MICROTIN_STATUS_OK);
  Contract seven = flat_contract(7);
  seven.x_max = seven.y_max = kWheelSide;
  CHECK(Device(kRefusedCapacity).decode(forge(seven, PlanCoder(wheel(6)))) == MICROTIN_STATUS_OK);
}

TEST_CASE("peek and decoding return the same header") {
  for (const auto& refused : refused_streams()) {
    const std::string& name = refused.first;
    const Bytes& stream = refused.second;
    microtin_stream_info info;
    const microtin_status peeked = microtin_read_stream_info(stream.data(), stream.size(), &info);
    const Device device(kRefusedCapacity);
    const microtin_status status = device.feed_all(stream);
    CAPTURE(name);
    if (status == MICROTIN_STATUS_TOO_BIG) {
      CHECK(peeked == MICROTIN_STATUS_OK);
      CHECK(info.vertices > kRefusedCapacity);
      CHECK(info.mesh_bytes == MICROTIN_MESH_BYTES(info.vertices));
      CHECK(info.decoder_bytes == MICROTIN_DECODER_BYTES(info.vertices));
    } else {
      CHECK((peeked == status ||
             (peeked == MICROTIN_STATUS_OK && stream.size() > info.header_bytes)));
    }
  }
}

}  // namespace microtin::tests
