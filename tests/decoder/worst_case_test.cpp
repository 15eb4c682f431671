// SPDX-License-Identifier: MIT
// The bound on steps (shared/docs/guarantees.md), and streams made to come near it.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "fuzz/support/repair.hpp"
#include "tests/support/files.hpp"
#include "tests/support/forged_stream.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/streams.hpp"

namespace microtin::tests {
namespace {

// Most steps for each byte behind the header, and in addition to these (shared/docs/guarantees.md).
constexpr uint64_t kStepsPerByte = 9947, kStepsBeside = 791;

struct Count {
  microtin_status status;
  uint64_t steps;
  uint64_t bytes;  // taken behind the header
};

// Decodes with a step a call, in workspaces for exactly as many vertices as the header says.
Count count_steps(const Bytes& stream) {
  microtin_stream_info info;
  if (microtin_read_stream_info(stream.data(), stream.size(), &info) != MICROTIN_STATUS_OK)
    return {};
  const Device device(info.vertices);
  Count count = {MICROTIN_STATUS_STEP_LIMIT, 0, 0};
  for (size_t at = 0, used = 0; count.status == MICROTIN_STATUS_STEP_LIMIT; at += used) {
    count.status = device.feed(stream.data() + at, stream.size() - at, &used, 1);
    ++count.steps;
  }
  CHECK(device.guards_are_whole());
  count.bytes = microtin_decoder_bytes_used(device.decoder) - info.header_bytes;
  return count;
}

double part_of_bound(const Count& count) {
  return static_cast<double>(count.steps) /
         static_cast<double>(kStepsPerByte * count.bytes + kStepsBeside);
}

// Prints how near a stream comes to the bound.
void check_bound(const std::string& name, const Bytes& stream) {
  const Count count = count_steps(stream);
  CHECK(count.status == MICROTIN_STATUS_OK);
  CHECK(part_of_bound(count) <= 1);
  MESSAGE(name << ": " << count.steps << " steps for " << count.bytes << " bytes, "
               << 100 * part_of_bound(count) << " % of the bound");
}

// The most phases for up to `most` vertices: every batch is as small as the work of all allows.
Plan small_batches(uint32_t most) {
  Random random(3);
  Plan plan{{{0, 0, 0}, {999, 0, 0}, {0, 999, 0}}, {}};
  uint32_t work = 0, placed = 3;
  for (;;) {
    uint32_t batch = 1;
    while (work + placed + batch > work_budget(placed + batch)) ++batch;
    if (placed + batch > most) break;
    placed += batch;
    work += placed;
    plan.batches.push_back(batch);
  }
  for (const Point p : lattice_points(44, 44, random, 100, 22)) {
    if (plan.vertices.size() == placed) break;
    plan.vertices.push_back({point(p.x + 1, 0).x, point(p.y + 1, 0).x, 0});
  }
  return plan;
}

Contract contract_of(const Plan& plan) {
  const uint32_t n = static_cast<uint32_t>(plan.vertices.size());
  return Contract{n, 999, 999, kMaxDegree, Coding::kQuick, false, false};
}

// With as many phases of one vertex as the work of all allows.
Plan border_plan(uint16_t largest_x) {
  return Plan{border_seed(largest_x), {largest_x - 3u, 1, 1}};
}

Bytes border_stream(uint16_t largest_x) {
  return forge(border_contract(largest_x), BorderCoder(border_plan(largest_x)));
}

// Counts the steps of walks that code nothing, but for the last step of all.
template <class Coder>
struct WatchedCoder : Coder {
  using Coder::at;
  using Coder::Coder;
  void at(const Reconstruction& r) {
    free_steps += was_walking && symbols == 0;
    work = r.work;
    was_walking = r.stage == Stage::kWalk;
    symbols = 0;
    Coder::at(r);
  }
  bool bit(uint32_t probability, bool value) {
    ++symbols;
    return Coder::bit(probability, value);
  }
  uint32_t uniform(uint32_t count, uint32_t value) {
    symbols += count > 1;
    return Coder::uniform(count, value);
  }
  uint32_t uniform_or_escape(uint32_t count, uint32_t value) {
    ++symbols;
    return Coder::uniform_or_escape(count, value);
  }

  uint64_t free_steps = 0;
  uint32_t work = 0;  // vertices at the ends of all phases
  uint32_t symbols = 0;
  bool was_walking = false;
};

template <class Coder>
void check_free_steps(const Contract& contract, const Plan& plan) {
  WatchedCoder<Coder> coder(plan);
  forge(contract, coder);
  CHECK(coder.work > 100);
  CHECK(coder.free_steps > 0);
  CHECK(2 * coder.free_steps <= 3 * uint64_t{coder.work});
}

// What decisions cost.
struct Cost {
  double bits = 0;

  bool bit(uint32_t probability, bool value) {
    const uint32_t part = value ? probability : kProbabilityOne - probability;
    bits -= std::log2(static_cast<double>(part) / kProbabilityOne);
    return value;
  }
};

// The most bits of a length, whatever its adaptive bits have learned before.
double dearest_length() {
  double dearest = 0;
  for (uint32_t learned = 0; learned < 1u << kExponents; ++learned) {
    for (uint32_t typical = 0; typical < kMagnitudeBits; ++typical) {
      for (uint32_t length = 0; length <= kMagnitudeBits; ++length) {
        ExponentModel model;
        for (uint32_t i = 0; i < kExponents; ++i) {
          model.longer[i] = adaptive_bit((learned >> i & 1u) != 0 ? 255 : 0);
        }
        Cost cost;
        REQUIRE(code_exponent(cost, model, typical, length) == length);
        dearest = std::max(dearest, cost.bits);
      }
    }
  }
  return dearest;
}

uint32_t triangles_at(const MeshCopy& copy, uint32_t vertex) {
  return static_cast<uint32_t>(std::count(copy.origin.begin(), copy.origin.end(), vertex));
}

}  // namespace

TEST_CASE("a decision narrows the range by 513/512 at least, a number by 2") {
  RangeDecoder coder{};  // with a window of zeros
  // What is left of the range, times 2^8 for each byte read.
  const auto narrowed = [&](uint32_t range, uint32_t code, const auto& take) {
    coder.window.next = coder.window.bytes;
    coder.window.left = coder.payload_left = 8;
    coder.range = range;
    coder.code = code;
    take();
    return static_cast<double>(coder.range) / (1u << 8 * (8 - coder.payload_left)) / range;
  };
  for (uint32_t high = kRangeLeast >> 15; high <= 0xFFFFFFFFu >> 15; ++high) {
    for (const uint32_t range : {high << 15, high << 15 | 0x7FFFu}) {
      for (const uint32_t p : {64u, 32704u}) {
        const auto bit = [&] { coder.bit(p, false); };
        REQUIRE(narrowed(range, 0, bit) <= 512.0 / 513);
        REQUIRE(narrowed(range, range - 1, bit) <= 512.0 / 513);
      }
      REQUIRE(narrowed(range, 0, [&] { coder.uniform(2, 0); }) <= 0.5);
      const auto number = [&] { coder.uniform_or_escape(1, 0); };
      REQUIRE(std::pow(narrowed(range, 0, number), 2) <= 512.0 / 513);
      REQUIRE(narrowed(range, range - 1, number) <= 1.0 / 1000);
    }
  }
}

TEST_CASE("an adaptive bit never leaves its margins") {
  const uint16_t low = kProbabilityMargin, high = kProbabilityOne - kProbabilityMargin;
  for (uint16_t p = low; p <= high; ++p) {
    for (const bool one : {false, true}) {
      AdaptiveBit bit{p, p};
      learn(bit, one);
      REQUIRE((bit.fast >= low && bit.fast <= high && bit.slow >= low && bit.slow <= high));
    }
  }
  for (uint32_t i = 0; i < kStarts; ++i) {
    const uint16_t start = adaptive_bit(table_start(i)).fast;
    CHECK((start >= low && start <= high));
  }
}

// format-stream.md counts numbers as they are legal. One that is none may leave 1 of 2^32, but
// lengths learn on the way. The parts of a step are those that format-stream.md lists.
TEST_CASE("the bytes of a step are enough, also where its numbers are none") {
  const double decision = 9.003, none = 32;
  const double magnitude = dearest_length() + decision + none;
  const double at_border = 3 * decision + 2 * magnitude;  // hit, parity, sign; gap and height
  const double elsewhere = 12 * decision + 14 + 10 + 2 * none + magnitude;
  MESSAGE("bits of a step: " << at_border << " at the border, " << elsewhere << " elsewhere");
  CHECK(at_border + 8 < 8 * kStepBytes);
  CHECK(elsewhere + 8 < 8 * kStepBytes);
}

TEST_CASE("steps of a walk without a symbol are at most 3/2 of the vertices it ends with") {
  const Plan small = small_batches(1500);
  check_free_steps<PlanCoder>(contract_of(small), small);
  check_free_steps<BorderCoder>(border_contract(999), border_plan(999));
}

TEST_CASE("no golden stream takes more steps than its bytes allow") {
  size_t done = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(golden_folder())) {
    if (entry.path().extension() != ".mtin") continue;
    const Bytes stream = bytes_of_file(entry.path().string());
    microtin_stream_info info;
    const bool is_large =
        microtin_read_stream_info(stream.data(), stream.size(), &info) == MICROTIN_STATUS_OK &&
        info.vertices > 100000;
    if (is_large) continue;
    const Count count = count_steps(stream);
    CAPTURE(entry.path().string());
    CHECK(part_of_bound(count) <= 1);
    done += count.status == MICROTIN_STATUS_OK && count.steps != 0;
  }
  CHECK(done >= 10);
}

TEST_CASE("no damaged stream behind right checks takes more steps than its bytes allow") {
  const Bytes stream = sectioned_stream(3);
  Random random(6);
  double most = 0;
  for (int round = 0; round < 300; ++round) {
    Bytes damaged = stream;
    const uint32_t from = random.below(static_cast<uint32_t>(stream.size()));
    for (size_t i = 18 + from; i < stream.size(); ++i) damaged[i] = random.below(2) != 0 ? 255 : 0;
    repair(damaged.data(), damaged.size());
    most = std::max(most, part_of_bound(count_steps(damaged)));
  }
  CHECK(most > 0);
  CHECK(most <= 1);
}

TEST_CASE("vertices that cost next to nothing, and walks that cost nothing, stay in the bound") {
  check_bound("1,001 vertices on a border", border_stream(999));
  const Bytes stream = border_stream(65535);
  check_bound("65,537 vertices on a border", stream);
  CHECK(part_of_bound(count_steps(stream)) > 0.05);
}

TEST_CASE("the most phases stay in the bound") {
  const Plan plan = small_batches(1500);
  const Bytes stream = forge(contract_of(plan), PlanCoder(plan));
  check_bound("the smallest batches", stream);
  CHECK(DecodedTerrain(stream).phases() == plan.batches.size());
  CHECK(plan.batches.size() > 40);
}

TEST_CASE("phases that add too little are refused soon, however many vertices are announced") {
  Random random(4);
  std::vector<Vertex> vertices = {{0, 0, 0}, {999, 0, 0}, {0, 999, 0}};
  for (const Point p : lattice_points(10, 10, random, 50, 22)) {
    vertices.push_back({point(p.x + 1, 0).x, point(p.y + 1, 0).x, 0});
  }
  Plan plan = single_steps(vertices);
  for (const uint32_t announced : {103u, 60000u, 1000000u}) {
    const Bytes stream = forge(
        Contract{announced, 999, 999, kMaxDegree, Coding::kQuick, false, false}, PlanCoder(plan));
    const Count count = count_steps(stream);
    CHECK(count.status == MICROTIN_STATUS_MALFORMED);
    CHECK(count.steps < 3000);
    const Device device(announced);
    device.decode(stream);
    const uint32_t n = microtin_mesh_vertex_count(device.mesh);
    CHECK(n < 50);
    CHECK((n + 1) * (n + 2) / 2 - 6 >
          work_budget(n + 1));  // 4 + 5 + .. + (n + 1), the phase refused
  }
}

TEST_CASE("the largest cavity that fits is taken, one larger is refused") {
  for (const uint32_t degree : {kMaxDegree, kMaxDegree + 1}) {
    const Plan plan = wheel(degree);
    const Bytes stream = forge(contract_of(plan), PlanCoder(plan));
    const Device device(degree + 1);
    const bool fits = degree == kMaxDegree;
    CHECK(device.decode(stream) == (fits ? MICROTIN_STATUS_OK : MICROTIN_STATUS_MALFORMED));
    CHECK(device.guards_are_whole());
    const MeshCopy copy(device.mesh);
    CHECK(is_sound(copy));
    if (fits) {
      CHECK(triangles_at(copy, degree) == degree);
      check_bound("a wheel of 32 spokes", stream);
    }
  }
}

}  // namespace microtin::tests
