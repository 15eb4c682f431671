// SPDX-License-Identifier: MIT
// The test vectors of format-stream.md, which the second decoder computes
// (tests/golden/vectors.py): the library computes the same.
#include <doctest/doctest.h>

#include <algorithm>
#include <deque>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "decoder/range_decoder.hpp"
#include "encoder/stream/header.hpp"
#include "shared/digest.hpp"
#include "shared/edge_marks.hpp"
#include "shared/header.hpp"
#include "shared/pack_format.hpp"
#include "shared/reconstruction.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/point_sets.hpp"

namespace microtin::tests {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<uint8_t>;

Bytes bytes_of(const std::string& hex) {
  Bytes bytes;
  for (size_t i = 0; i < hex.size(); i += 2) {
    bytes.push_back(static_cast<uint8_t>(std::stoul(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

Point point_in(const Json& pair) {
  return point(pair[0].get<uint32_t>(), pair[1].get<uint32_t>());
}

// --- Functions of numbers. Each takes a vector without its last entry, the result. ---------------

template <class Number>
Number entry(const Json& vector, size_t i) {
  return vector[i].get<Number>();
}

bool read_number(const Bytes& bytes, uint64_t* value) {
  const uint8_t* next = bytes.data();
  const uint8_t* const end = next + bytes.size();
  return read_varint(&next, end, value) && next == end;
}

Json varint_in(const Json& v) {
  const Bytes bytes = bytes_of(v[0]);
  uint64_t value = 0;
  Bytes written;
  REQUIRE(read_number(bytes, &value));
  append_varint(written, value);
  CHECK(written == bytes);
  return value;
}

Json is_refused(const Json& v) {
  uint64_t value = 0;
  return read_number(bytes_of(v[0]), &value) ? 0 : 1;
}

// An axis begins with an offset, which has a sign.
Json zigzag_in(const Json& v) {
  Bytes bytes;
  append_varint(bytes, entry<uint64_t>(v, 0));
  bytes.insert(bytes.end(), {1, 1});
  const uint8_t* next = bytes.data();
  microtin_axis axis{};
  REQUIRE(read_axis(&next, next + bytes.size(), &axis));
  return axis.offset;
}

Json crc_of(const Json& v) {
  const Bytes bytes = bytes_of(v[0]);
  return crc32(0, bytes.data(), bytes.size());
}

Json hash_of(const Json& v) {
  const Bytes bytes = bytes_of(v[0]);
  return stream_hash(kStreamHash, bytes.data(), bytes.size());
}

Json cotangent_of(const Json& v) {
  return cotangent(entry<int32_t>(v, 0), divisor_of(entry<int32_t>(v, 1)), entry<int32_t>(v, 2));
}

Json incircle_of(const Json& v) {
  return incircle(point_in(v[0]), point_in(v[1]), point_in(v[2]), point_in(v[3]));
}

Json triangle_conflict(const Json& v) {
  const Point p = point_in(v[3]);
  return conflicts_with_triangle(point_in(v[0]), point_in(v[1]), point_in(v[2]), p) ? 1 : 0;
}

Json ghost_conflict(const Json& v) {
  return conflicts_with_ghost(point_in(v[0]), point_in(v[1]), point_in(v[2])) ? 1 : 0;
}

// A half-edge of one triangle leads from u to v, and its next one to w.
Json bend_at(const Json& v) {
  Point place[3] = {point_in(v[0]), point_in(v[1]), point_in(v[2])};
  Index origin[3] = {0, 1, 2};
  return bend_of({place, nullptr, origin, nullptr, 3, 1}, 0, 1);
}

using Function = Json (*)(const Json&);

const std::map<std::string, Function>& functions() {
  static const std::map<std::string, Function> all = {
      {"crc32", crc_of},
      {"fnv32", hash_of},
      {"varint", varint_in},
      {"varint refused", is_refused},
      {"zigzag", zigzag_in},
      {"log2", [](const Json& v) -> Json { return log2_of(entry<uint32_t>(v, 0)); }},
      {"rlog", [](const Json& v) -> Json { return rough_log2(entry<uint32_t>(v, 0)); }},
      {"rexp", [](const Json& v) -> Json { return rough_exp2(entry<int32_t>(v, 0)); }},
      {"rroot", [](const Json& v) -> Json { return rough_root(entry<uint32_t>(v, 0)); }},
      {"cot", cotangent_of},
      {"segment",
       [](const Json& v) -> Json { return cap(entry<uint32_t>(v, 0), entry<int32_t>(v, 1)); }},
      {"incircle", incircle_of},
      {"bend", bend_at},
      {"conflict with a triangle", triangle_conflict},
      {"conflict with a ghost", ghost_conflict}};
  return all;
}

// --- Symbols -------------------------------------------------------------------------------------

// Returns the symbols of a vector, and compares what the library codes them with.
struct Script {
  const Json& symbols;
  size_t at = 0;

  static Vertex next() { return Vertex{0, 0, 0}; }
  uint32_t take(uint32_t of) {
    REQUIRE(at < symbols.size());
    CHECK(symbols[at][0].get<uint32_t>() == of);
    return symbols[at++][1].get<uint32_t>();
  }
  bool bit(uint32_t probability, bool) { return take(probability) != 0; }
  uint32_t uniform(uint32_t count, uint32_t) { return count == 1 ? 0 : take(count); }
  uint32_t uniform_or_escape(uint32_t count, uint32_t) { return take(count); }
  bool is_at_end() const { return at == symbols.size(); }
};

Models fresh_models() {
  Models models;
  reset(models);
  return models;
}

void check_adaptive_bit(const Json& v) {
  AdaptiveBit bit = adaptive_bit(v["start"].get<uint32_t>());
  for (size_t i = 0; i < v["bits"].size(); ++i) {
    CHECK(v["probabilities"][i] == probability_of(bit) >> 1);
    learn(bit, v["bits"][i] == 1);
  }
  CHECK(v["fast"] == bit.fast);
  CHECK(v["slow"] == bit.slow);
}

uint32_t decode_symbol(RangeDecoder& coder, const std::string& kind, uint32_t of) {
  if (kind == "bit") return coder.bit(of, false) ? 1 : 0;
  return kind == "number" ? coder.uniform(of, 0) : coder.uniform_or_escape(of, 0);
}

void check_range_coder(const Json& v) {
  const Bytes payload = bytes_of(v["payload"]);
  RangeDecoder coder{};
  REQUIRE(payload.size() <= sizeof coder.window.bytes);
  std::copy(payload.begin(), payload.end(), coder.window.bytes);
  coder.window.next = coder.window.bytes;
  coder.window.left = payload.size();
  coder.payload_left = static_cast<uint32_t>(payload.size());
  coder.begin();
  for (const Json& symbol : v["symbols"]) {
    const uint32_t of = symbol[1].get<uint32_t>();
    const uint32_t value = symbol[2].is_null() ? of : symbol[2].get<uint32_t>();
    CHECK(decode_symbol(coder, symbol[0], of) == value);
  }
  CHECK_FALSE(coder.overrun);
}

Tally tally_of(const Json& counts) {
  return Tally{{counts[0].get<uint16_t>(), counts[1].get<uint16_t>()}};
}

void check_tally(const Json& v) {
  Tally tally = tally_of({v["even"], v["odd"]});
  const FastInt first = v["first"], count = v["lines"];
  const bool odd_origin = v["odd origin"] == 1;
  const Json& symbols = v["symbols"];
  Script script{symbols};
  const Ruling left = rule(script, tally, Lines{first, first + count - 1}, odd_origin, first);
  CHECK(script.is_at_end());
  CHECK(v["left"] == Json({line_at(left, left.numbers.first), left.numbers.count, left.step}));
  learn(tally, true);
  CHECK(v["learnt"] == Json({tally.met[0], tally.met[1]}));
}

void check_magnitude(const Json& v) {
  Models models = fresh_models();
  Script script{v["symbols"]};
  const uint32_t typical = v["typical"];
  CHECK(v["magnitude"] == code_magnitude(script, models.gap, models.height.mantissa, typical, 0));
  CHECK(script.is_at_end());
}

// --- The mesh ------------------------------------------------------------------------------------

struct SmallMesh {
  Point place[16];
  int16_t z[16];
  Index origin[96], twin[96];
  Index triangles[kMaxDegree], edge_origin[kMaxDegree], edge_twin[kMaxDegree];
  Mesh mesh = {place, z, origin, twin, 0, 0};
  Cavity cavity = {triangles, edge_origin, edge_twin, 14, 0};
};

Index vertex_number(const Json& number) {
  return number == -1 ? kInfinity : number.get<Index>();
}

Json number_of_vertex(Index v) {
  return v == kInfinity ? Json(-1) : Json(v);
}

Index half_edge(const Mesh& mesh, Index from, Index to) {
  Index h = 0;
  while (mesh.origin[h] != from || mesh.origin[next_in_triangle(h)] != to) ++h;
  return h;
}

Json ring_of(const Cavity& cavity) {
  Json ring = Json::array();
  for (Index i = 0; i < cavity.size + 2; ++i) {
    ring.push_back(number_of_vertex(cavity.edge_origin[i]));
  }
  return ring;
}

Json triangles_of(const Mesh& mesh) {
  Json triangles = Json::array();
  for (Index t = 0; t < mesh.triangles; ++t) {
    const Index* const corner = mesh.origin + first_edge(t);
    triangles.push_back(
        {number_of_vertex(corner[0]), number_of_vertex(corner[1]), number_of_vertex(corner[2])});
  }
  return triangles;
}

void check_one_insertion(SmallMesh& small, const Json& step) {
  Mesh& mesh = small.mesh;
  const Index chord =
      half_edge(mesh, vertex_number(step["chord"][0]), vertex_number(step["chord"][1]));
  const Point b = point_in(step["vertex"]);
  REQUIRE(grow_cavity(mesh, chord, b, small.cavity, [](Index) { return false; }));
  Json cavity = Json::array();
  for (Index i = 0; i < small.cavity.size; ++i) cavity.push_back(small.cavity.triangles[i]);
  CHECK(step["cavity"] == cavity);
  CHECK(step["ring"] == ring_of(small.cavity));
  mesh.place[mesh.vertices] = b;
  fan_cavity(mesh, small.cavity, mesh.vertices);
  ++mesh.vertices;
  CHECK(step["triangles"] == triangles_of(mesh));
}

uint64_t digest_of(const Mesh& mesh, Index void_triangle) {
  uint64_t digest = 0;
  for (Index t = 0; t < mesh.triangles; ++t) {
    if (is_ghost(mesh, t)) continue;
    Vertex corner[3];
    for (Index i = 0; i < 3; ++i) {
      const Index v = mesh.origin[first_edge(t) + i];
      corner[i] = Vertex{mesh.place[v].x, mesh.place[v].y, mesh.z[v]};
    }
    digest += triangle_digest(corner, t == void_triangle);
  }
  return digest;
}

void check_insertion(const Json& v) {
  SmallMesh small;
  for (size_t i = 0; i < 3; ++i) small.place[i] = point_in(v["seed"][i]);
  start_mesh(small.mesh);
  for (const Json& step : v["insertions"]) check_one_insertion(small, step);
  for (size_t i = 0; i < v["heights"].size(); ++i) small.z[i] = v["heights"][i];
  const std::string digest = v["digest"];
  CHECK(digest_of(small.mesh, v["void"]) == std::stoull(digest, nullptr, 16));
}

void check_height(const Json& v) {
  Point place[kMaxDegree];
  int16_t z[kMaxDegree];
  Residual residual[kMaxDegree];
  Index ring[kMaxDegree];
  const uint32_t size = static_cast<uint32_t>(v["ring"].size());
  for (Index i = 0; i < size; ++i) {
    const Json& vertex = v["ring"][i];
    place[i] = point_in(vertex);
    z[i] = vertex[2].get<int16_t>();
    residual[i] = vertex[3].get<Residual>();
    ring[i] = i;
  }
  const Mesh mesh = {place, z, nullptr, nullptr, static_cast<Index>(size), 0};
  const HeightPrediction prediction = predict_height(mesh, residual, ring, size, Point{500, 500});
  CHECK(v["prediction"] == prediction.height);
  Models models = fresh_models();
  Script script{v["symbols"]};
  int16_t height = 0;
  REQUIRE(code_height(script, models.height, prediction, &height));
  CHECK(v["height"] == height);
  CHECK(script.is_at_end());
}

// --- Positions -----------------------------------------------------------------------------------

Side side_of(const Json& apex) {
  Side side{};
  side.certified = !apex.is_null();
  side.ghost = apex == "infinity";
  if (apex.is_array()) side.apex = point_in(apex);
  return side;
}

FreeRegion region_of(const Json& v) {
  FreeRegion region{};
  const Json& corners = v["corners"];
  see_corners(region, point_in(corners[0]), point_in(corners[1]), point_in(corners[2]));
  region.next = side_of(v["apexes"][0]);
  region.opposite_certified = side_of(v["apexes"][1]).certified;
  region.chord = side_of(v["apexes"][2]);
  region.expected = free_area(region) + v["density"].get<Log2>();
  return region;
}

Contract contract_of(const Json& v) {
  Contract contract{};
  contract.x_max = v["largest"][0];
  contract.y_max = v["largest"][1];
  contract.has_heights = v.value("heights", 1) == 1;
  contract.coding = static_cast<Coding>(v.value("coding", 2));
  contract.odd_origin_x = v["odd"][0] == 1;
  contract.odd_origin_y = v["odd"][1] == 1;
  return contract;
}

// A vector lists the tallies of x, then those of y. The library lists those of a second line by the
// axis of the first one.
PlaceHabits habits_of(const Json& v) {
  PlaceHabits habits;
  reset(habits);
  habits.crowding = v.value("crowding", kCrowdingStart);
  for (size_t axis = 0; axis < 2; ++axis) {
    habits.parities.first[axis] = tally_of(v["tallies"][3 * axis]);
    for (size_t i = 0; i < 2; ++i) {
      habits.parities.second[1 - axis][i] = tally_of(v["tallies"][3 * axis + 1 + i]);
    }
  }
  return habits;
}

Json behind(const Side& side) {
  return side.certified && !side.ghost ? Json(side.behind) : Json();
}

void check_position(const Json& v) {
  const FreeRegion region = region_of(v);
  CHECK(v["expected"] == region.expected);
  CHECK(v["behind"] == Json({behind(region.next), behind(region.chord)}));
  Models models = fresh_models();
  PlaceHabits habits = habits_of(v);
  Place place{};
  Script script{v["symbols"]};
  const Offset found = code_place(script, models.place, region, contract_of(v),
                                  v["density"].get<Log2>(), place, habits);
  CHECK(script.is_at_end());
  CHECK(v["position"] == Json({region.origin.x + found.x, region.origin.y + found.y}));
  CHECK(v["crowding afterwards"] == habits.crowding);
}

Json tallies_of(const PlaceHabits& habits) {
  Json tallies = Json::array();
  for (size_t axis = 0; axis < 2; ++axis) {
    const Tally* const second = habits.parities.second[1 - axis];
    for (const Tally& tally : {habits.parities.first[axis], second[0], second[1]}) {
      tallies.push_back({tally.met[0], tally.met[1]});
    }
  }
  return tallies;
}

void check_hull_position(const Json& v) {
  const Contract contract = contract_of(v);
  const HullEdge edge = hull_edge(contract, point_in(v["corners"][0]), point_in(v["corners"][1]));
  const Log2 density = v["density"];
  Models models = fresh_models();
  PlaceHabits habits = habits_of(v);
  Script script{v["symbols"]};
  Json position;
  if (edge.length != 1 && code_hit(script, models.hit, estimate_hull_hit(edge, density), false)) {
    const Point b = code_hull_place(script, models.gap, models.height.mantissa, habits.parities,
                                    contract, edge, density);
    position = Json({b.x, b.y});
  }
  CHECK(script.is_at_end());
  CHECK(v["position"] == position);
  CHECK(v["tallies afterwards"] == tallies_of(habits));
}

// --- Lines ---------------------------------------------------------------------------------------

// A script of a reader.
struct MarkScript : Script {
  static bool begins(Index) { return false; }
  static uint32_t line_class(Index) { return 0; }
  static uint32_t way(Index, const Ways&) { return 0; }
};

void set_mesh(const Json& v, SmallMesh& small) {
  Mesh& mesh = small.mesh;
  for (const Json& vertex : v["vertices"]) mesh.place[mesh.vertices++] = point_in(vertex);
  for (const Json& triangle : v["triangles"]) {
    for (Index i = 0; i < 3; ++i) {
      mesh.origin[first_edge(mesh.triangles) + i] = vertex_number(triangle[i]);
    }
    ++mesh.triangles;
  }
  for (Index h = 0; h < first_edge(mesh.triangles); ++h) {
    mesh.twin[h] = half_edge(mesh, mesh.origin[next_in_triangle(h)], mesh.origin[h]);
  }
}

void check_marks(const Json& v) {
  SmallMesh small;
  set_mesh(v, small);
  uint8_t marks[edge_mark_bytes(16)] = {};
  EdgeMarking marking{};
  begin_marking(marking, small.mesh, marks, v["edges"].get<uint32_t>());
  MarkScript script{{v["symbols"]}};
  std::vector<std::pair<uint32_t, std::deque<Index>>> lines;
  while (marking.left != 0) {
    const uint32_t before = marking.left;
    REQUIRE(code_marks(marking, script));
    if (marking.left == before) continue;
    const Index end = end_of(small.mesh, marking.last);
    if (marking.stage == MarkStage::kBackward) {
      lines.back().second.push_front(end);
      continue;
    }
    if (marking.last == marking.first) {
      lines.push_back({marking.kind, {small.mesh.origin[marking.first]}});
    }
    lines.back().second.push_back(end);
  }
  CHECK(script.is_at_end());
  CHECK(v["lines"] == Json(lines));
}

using Check = void (*)(const Json&);

const std::map<std::string, Check>& checks() {
  static const std::map<std::string, Check> all = {
      {"adaptive bit", check_adaptive_bit},
      {"range coder", check_range_coder},
      {"tally", check_tally},
      {"magnitude", check_magnitude},
      {"insertion", check_insertion},
      {"height", check_height},
      {"position", check_position},
      {"position around infinity", check_hull_position},
      {"marks", check_marks}};
  return all;
}

}  // namespace

TEST_CASE("the library computes each test vector of the second decoder") {
  std::ifstream file(golden("../vectors.json"));
  const Json vectors = Json::parse(file);
  std::set<std::string> met;
  for (const auto& kind : vectors.items()) {
    const std::string& name = kind.key();
    met.insert(name);
    for (const Json& v : kind.value()) {
      CAPTURE(name);
      CAPTURE(v.dump());
      if (functions().count(name) != 0) {
        CHECK(functions().at(name)(v) == v.back());
      } else {
        REQUIRE(checks().count(name) == 1);
        checks().at(name)(v);
      }
    }
  }
  CHECK(met.size() == functions().size() + checks().size());
}

}  // namespace microtin::tests
