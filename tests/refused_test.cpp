// Golden streams that must be refused, one for each rule that a stream can break. The name of each
// begins with the status. MICROTIN_WRITE_GOLDEN=1 writes them anew.
#include <doctest/doctest.h>

#include <cstdlib>
#include <map>
#include <string>

#include "tests/files.hpp"
#include "tests/forged_stream.hpp"
#include "tests/streams.hpp"

namespace microtin {
namespace {

constexpr uint32_t kCapacity = 100;

// --- Contracts and plans -------------------------------------------------------------------------

Contract flat_contract(uint32_t vertices) {
  return Contract{vertices, 99, 99, kMinDegree, 2, false, false};
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

struct LargestNumbers : PlanCoder {
  using PlanCoder::PlanCoder;
  bool bit(uint32_t probability, bool) { return PlanCoder::bit(probability, true); }
  uint32_t uniform(uint32_t count, uint32_t) { return PlanCoder::uniform(count, count - 1); }
};

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

template <uint32_t kSize>
struct BatchOf : PlanCoder {
  using PlanCoder::PlanCoder;
  static bool last_phase() { return false; }
  static uint32_t batch() { return kSize; }
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

Bytes with_blocks(const Bytes& blocks) {
  Bytes stream = with_header_byte(5, kHasBlocks);
  stream.resize(stream.size() - kCheckBytes);
  stream.push_back(static_cast<uint8_t>(blocks.size()));
  stream.push_back(0);
  stream.insert(stream.end(), blocks.begin(), blocks.end());
  append_check(stream, 0);
  return stream;
}

Bytes with_section(const Bytes& head_and_payload) {
  Bytes stream = header_of(flat_contract(4));
  const size_t from = stream.size();
  stream.insert(stream.end(), head_and_payload.begin(), head_and_payload.end());
  append_check(stream, from);
  return stream;
}

// The only section of a valid stream with `added` bytes more, or fewer.
Bytes resized_payload(int added) {
  const Contract contract = flat_contract(4);
  const Bytes valid = forge(contract, PlanCoder(kInside));
  Bytes stream = header_of(contract);
  Bytes payload(valid.begin() + static_cast<std::ptrdiff_t>(stream.size()) + 1,
                valid.end() - static_cast<std::ptrdiff_t>(kCheckBytes));
  payload.resize(payload.size() + static_cast<size_t>(added));
  append_section(stream, payload);
  return stream;
}

Bytes cut_off(size_t size) {
  Bytes stream = forge(flat_contract(4), PlanCoder(kInside));
  stream.resize(size < stream.size() ? size : stream.size() - 1);
  return stream;
}

Bytes flipped(size_t at) {
  Bytes stream = forge(flat_contract(4), PlanCoder(kInside));
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

using Refused = std::map<std::string, Bytes>;

void add_headers(Refused& all) {
  const uint8_t placement = kBlockPlacement;
  all["bad_magic"] = with_header_byte(0, 'M');
  all["unsupported_version"] = with_header_byte(4, kVersion + 1);
  all["unsupported_block"] = with_blocks({0xFF, 0, 0, 0x7F});
  all["malformed_flags"] = with_header_byte(5, 32);
  all["malformed_degree_low"] = with_header_byte(6, 128 + kMinDegree - 1);
  all["malformed_degree_high"] = with_header_byte(6, 128 + kMaxDegree + 1);
  all["malformed_levels"] = with_header_byte(6, kMinDegree);
  all["malformed_count_low"] = header_of(flat_contract(2));
  all["malformed_count_high"] = header_of(flat_contract(kMaxVertices + 1));
  all["malformed_block_head"] = with_blocks({0x7F, 0});
  all["malformed_block_length"] = with_blocks({0x7F, 2, 0, 9});
  all["malformed_placement_short"] = with_blocks({placement, 8, 0, 1, 2, 3, 1, 2, 3, 1, 2});
  all["malformed_placement_rest"] = with_blocks({placement, 10, 0, 1, 2, 3, 1, 2, 3, 1, 2, 3, 9});
  all["malformed_placement_zero"] = with_blocks({placement, 9, 0, 1, 2, 0, 1, 2, 3, 1, 2, 3});
  Bytes too_long(3 + kPlacementMostBytes + 1, 0);
  too_long[0] = placement;
  too_long[1] = kPlacementMostBytes + 1;
  all["malformed_placement_long"] = with_blocks(too_long);
  all["too_big"] = header_of(flat_contract(kCapacity + 1));
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
  all["malformed_length_not_shortest"] = with_section({0x81, 0x00, 0x00});
  all["malformed_length_above_32_bits"] = with_section({0x80, 0x80, 0x80, 0x80, 0x10});
  all["malformed_code_is_range"] = with_section({4, 0xFF, 0xFF, 0xFF, 0xFF});
  all["malformed_code_in_rounding"] = with_section({4, 0xFF, 0xFF, 0xFF, 0xFE});
  all["malformed_payload_short"] = resized_payload(-6);
  all["malformed_payload_rest"] = resized_payload(5);
}

void add_symbols(Refused& all) {
  const Contract four = flat_contract(4), five = flat_contract(5);
  Contract high = four, eight = flat_contract(8), twelve = flat_contract(12),
           sixty = flat_contract(60);
  high.has_heights = true;
  twelve.degree = sixty.degree = kMaxDegree;
  eight.x_max = eight.y_max = kWheelSide;
  all["malformed_seed_clockwise"] =
      forge(four, PlanCoder(Plan{{kSeed[0], kSeed[2], kSeed[1]}, {}}));
  all["malformed_seed_on_a_line"] =
      forge(four, PlanCoder(Plan{{{1, 1, 0}, {2, 2, 0}, {4, 4, 0}}, {}}));
  all["malformed_seed_order"] = forge(four, PlanCoder(Plan{{kSeed[1], kSeed[2], kSeed[0]}, {}}));
  all["malformed_height"] = forge(high, LargestNumbers(kInside));
  all["malformed_batch_empty"] = forge(five, BatchOf<0>(kInside));
  all["malformed_batch_of_all"] = forge(five, BatchOf<2>(kInside));
  all["malformed_walk_ends"] = forge(four, NoHits(kInside));
  all["malformed_work"] = forge(sixty, PlanCoder(scattered(60)));
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
      {"bad", MICROTIN_BAD_MAGIC},       {"unsupported", MICROTIN_UNSUPPORTED_VERSION},
      {"too", MICROTIN_TOO_BIG},         {"checksum", MICROTIN_CHECKSUM},
      {"malformed", MICROTIN_MALFORMED}, {"truncated", MICROTIN_TRUNCATED}};
  return statuses.at(name.substr(0, name.find('_')));
}

}  // namespace

TEST_CASE("golden streams that must be refused are, each with its status") {
  for (const auto& [name, stream] : refused_streams()) {
    const std::string path = MICROTIN_GOLDEN_DIR "/refused/" + name + ".mtin";
    if (std::getenv("MICROTIN_WRITE_GOLDEN") != nullptr) write_file(path, stream);
    CAPTURE(name);
    CHECK(read_file(path) == stream);
    const Device device(kCapacity);
    CHECK(device.decode(stream) == status_named(name));
    CHECK(device.guards_are_whole());
    CHECK(device.decode(stream) == status_named(name));
  }
}

TEST_CASE("what is refused is one rule away from what is not") {
  CHECK(Device(kCapacity).decode(forge(flat_contract(4), PlanCoder(kInside))) == MICROTIN_DONE);
  CHECK(Device(kCapacity).decode(resized_payload(0)) == MICROTIN_DONE);
  Contract seven = flat_contract(7);
  seven.x_max = seven.y_max = kWheelSide;
  CHECK(Device(kCapacity).decode(forge(seven, PlanCoder(wheel(6)))) == MICROTIN_DONE);
}

TEST_CASE("peek tells of a header what decoding it tells") {
  for (const auto& [name, stream] : refused_streams()) {
    microtin_info info;
    const microtin_status peeked = microtin_peek(stream.data(), stream.size(), &info);
    const Device device(kCapacity);
    const microtin_status status = device.feed_all(stream);
    CAPTURE(name);
    if (status == MICROTIN_TOO_BIG) {
      CHECK(peeked == MICROTIN_DONE);
      CHECK(info.vertices > kCapacity);
      CHECK(info.mesh_bytes == MICROTIN_MESH_BYTES(info.vertices));
      CHECK(info.decoder_bytes == MICROTIN_DECODER_BYTES(info.vertices));
    } else {
      CHECK((peeked == status || (peeked == MICROTIN_DONE && stream.size() > info.header_bytes)));
    }
  }
}

}  // namespace microtin
