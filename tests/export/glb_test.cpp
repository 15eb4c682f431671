// SPDX-License-Identifier: MIT
// glTF binaries, read by a parser of their own.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "encoder/export/mesh.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace microtin::tests;

namespace {

template <class Number>
Number number(const std::string& bytes, size_t at) {
  REQUIRE(at + sizeof(Number) <= bytes.size());
  Number value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

// A file taken apart, with all that the specification demands of it checked on the way.
struct Glb {
  explicit Glb(const std::string& bytes) {
    REQUIRE(bytes.substr(0, 4) == "glTF");
    REQUIRE(number<uint32_t>(bytes, 4) == 2);
    REQUIRE(number<uint32_t>(bytes, 8) == bytes.size());
    const uint32_t head = number<uint32_t>(bytes, 12);
    REQUIRE(head % 4 == 0);
    REQUIRE(bytes.substr(16, 4) == "JSON");
    json = nlohmann::json::parse(bytes.substr(20, head));
    const uint32_t body = number<uint32_t>(bytes, 20 + head);
    REQUIRE(body % 4 == 0);
    REQUIRE(bytes.substr(24 + head, 4) == std::string("BIN\0", 4));
    binary = bytes.substr(28 + head);
    REQUIRE(binary.size() == body);
    REQUIRE(json["buffers"][0]["byteLength"] == body);
    REQUIRE(json["asset"]["version"] == "2.0");
    const auto& primitive = json["meshes"][0]["primitives"][0];
    REQUIRE(json["nodes"][json["scenes"][json["scene"].get<size_t>()]["nodes"][0].get<size_t>()]
                ["mesh"] == 0);
    REQUIRE(json["materials"].size() == primitive["material"].get<size_t>() + 1);
    positions = values<float>(primitive["attributes"]["POSITION"], 5126, "VEC3", 3);
    normals = values<float>(primitive["attributes"]["NORMAL"], 5126, "VEC3", 3);
    colours = values<uint8_t>(primitive["attributes"]["COLOR_0"], 5121, "VEC4", 4);
    indices = values<uint32_t>(primitive["indices"], 5125, "SCALAR", 1);
    REQUIRE(positions.size() == normals.size());
    REQUIRE(positions.size() / 3 == colours.size() / 4);
    for (const uint32_t index : indices) REQUIRE(index < positions.size() / 3);
    check_bounds(json["accessors"][primitive["attributes"]["POSITION"].get<size_t>()]);
  }

  template <class Number>
  std::vector<Number> values(const nlohmann::json& accessor_number, int type,
                             const std::string& shape, size_t width) const {
    const auto& accessor = json["accessors"][accessor_number.get<size_t>()];
    REQUIRE(accessor["componentType"] == type);
    REQUIRE(accessor["type"] == shape);
    const auto& view = json["bufferViews"][accessor["bufferView"].get<size_t>()];
    const size_t at = view["byteOffset"], size = view["byteLength"], count = accessor["count"];
    REQUIRE(at % 4 == 0);
    REQUIRE(at + size <= binary.size());
    REQUIRE(size == count * width * sizeof(Number));
    std::vector<Number> all;
    for (size_t i = 0; i < count * width; ++i) {
      all.push_back(number<Number>(binary, at + i * sizeof(Number)));
    }
    return all;
  }

  void check_bounds(const nlohmann::json& accessor) const {
    for (size_t axis = 0; axis < 3; ++axis) {
      float low = positions[axis], high = low;
      for (size_t i = axis; i < positions.size(); i += 3) {
        low = std::min(low, positions[i]);
        high = std::max(high, positions[i]);
      }
      CHECK(accessor["min"][axis].get<float>() == low);
      CHECK(accessor["max"][axis].get<float>() == high);
    }
  }

  nlohmann::json json;
  std::string binary;
  std::vector<float> positions, normals;
  std::vector<uint8_t> colours;
  std::vector<uint32_t> indices;
};

Glb exported(const SurfaceModel& model, Coordinates coordinates = Coordinates::kReal) {
  const TemporaryFolder folder;
  OutputFile out(folder / "mesh.glb");
  export_model(model, MeshFormat::kGlb, coordinates, out);
  out.commit();
  std::ifstream file(folder / "mesh.glb", std::ios::binary);
  return Glb({std::istreambuf_iterator<char>(file), {}});
}

// A square of 4 x 4 steps that rises by 2 to the east; the last vertex lies higher.
SurfaceModel square() {
  SurfaceModel model;
  model.placement = {{5274357000, 500, 1000}, {1000000, 1, 2}, {100, 10, 1}};
  model.vertices = {{0, 0, 0}, {4, 0, 2}, {0, 4, 0}, {4, 4, 2}, {8, 4, 8}};
  model.triangles = {{0, 1, 2}, {1, 3, 2}, {1, 4, 3}};
  return model;
}

}  // namespace

TEST_CASE("glb: metres from the middle, y up, the north at negative z") {
  const Glb glb = exported(square());
  CHECK(glb.json["asset"]["extras"]["origin"] == nlohmann::json({5274359.0, 500001.0, 140.0}));
  CHECK(glb.positions ==
        std::vector<float>{-2, -40, 1, 0, -20, 1, -2, -40, -1, 0, -20, -1, 2, 40, -1});
  CHECK(glb.indices == std::vector<uint32_t>{0, 1, 2, 1, 3, 2, 1, 4, 3});
  CHECK(std::equal(glb.colours.begin(), glb.colours.begin() + 4, glb.colours.begin() + 8));
  CHECK(glb.colours[0] != glb.colours[16]);
  CHECK(glb.colours[3] == 255);
}

TEST_CASE("glb: triangles turn counter-clockwise, normals are of length 1 and on that side") {
  const Glb glb = exported(square());
  const auto at = [](const std::vector<float>& v, size_t i) {
    return std::array<double, 3>{v[3 * i], v[3 * i + 1], v[3 * i + 2]};
  };
  for (size_t v = 0; v < glb.normals.size() / 3; ++v) {
    const auto [x, y, z] = at(glb.normals, v);
    CHECK(std::abs(x * x + y * y + z * z - 1) < 1e-6);
    CHECK(y > 0);
  }
  for (size_t t = 0; t < glb.indices.size(); t += 3) {
    const auto a = at(glb.positions, glb.indices[t]), b = at(glb.positions, glb.indices[t + 1]),
               c = at(glb.positions, glb.indices[t + 2]);
    const double up = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]);
    CHECK(up > 0);
  }
  // The south-west vertex has one triangle: 20 up for 2 to the east.
  CHECK(glb.normals[0] / glb.normals[1] == doctest::Approx(-10));
  CHECK(glb.normals[2] == doctest::Approx(0));
}

TEST_CASE("glb: places and heights have units of their own, each of its length in metres") {
  constexpr double kRounding = 2e-7;  // of floats; the two feet differ by ten times as much
  struct Length {
    Unit unit;
    double metres;
  };
  for (const Length& flat : {Length{Unit::kMetre, 1}, Length{Unit::kFoot, 0.3048},
                             Length{Unit::kUsSurveyFoot, 0.304800609601219},
                             Length{Unit::kUnknown, 1}, Length{Unit::kDegree, 0}}) {
    for (const Length& up :
         {Length{Unit::kMetre, 1}, Length{Unit::kFoot, 0.3048},
          Length{Unit::kUsSurveyFoot, 0.304800609601219}, Length{Unit::kUnknown, 1}}) {
      SurfaceModel model = square();
      if (flat.unit == Unit::kDegree) model.placement.y = {4498, 1, 100};
      model.horizontal_unit = flat.unit;
      model.vertical_unit = up.unit;
      const Glb glb = exported(model);
      CHECK(std::abs(glb.positions[1] / (-40 * up.metres) - 1) < kRounding);
      if (flat.unit == Unit::kDegree) continue;
      CHECK(std::abs(glb.positions[0] / (-2 * flat.metres) - 1) < kRounding);
      CHECK(std::abs(glb.positions[2] / (1 * flat.metres) - 1) < kRounding);
    }
  }
}

TEST_CASE("glb: units become metres, degrees by the latitude") {
  SurfaceModel model = square();
  model.horizontal_unit = Unit::kFoot;
  model.vertical_unit = Unit::kUsSurveyFoot;
  const Glb feet = exported(model);
  CHECK(feet.positions[0] == doctest::Approx(-0.6096));
  CHECK(feet.positions[1] == doctest::Approx(-40 * 1200.0 / 3937));
  model = square();
  model.horizontal_unit = Unit::kDegree;
  model.placement.x = {0, 1, 100};
  model.placement.y = {4498, 1, 100};  // 45 degrees in the middle, of WGS 84
  const Glb degrees = exported(model);
  CHECK(degrees.positions[0] == doctest::Approx(-0.04 * 78846.8));
  CHECK(degrees.positions[2] == doctest::Approx(0.02 * 111131.8));
  CHECK(degrees.positions[1] == -40);
  const Glb lattice = exported(model, Coordinates::kLattice);
  CHECK(lattice.positions[0] == -4);
  CHECK(lattice.positions[1] == -4);
}
