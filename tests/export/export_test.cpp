// SPDX-License-Identifier: MIT
// Meshes in other programs' formats.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "encoder/base/error.hpp"
#include "encoder/export/mesh.hpp"
#include "encoder/stream/encode.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace microtin::tests;

namespace {

// Two triangles over a square: (0, 0), (4, 0), (0, 4) and (4, 4); the upper right one may be void.
DecodedTerrain square(bool with_void) {
  Tin tin;
  tin.vertices = {{0, 0, -3}, {4, 0, 0}, {0, 4, 1}, {5, 5, 7}};
  if (with_void) tin.voids = {{{0, 4}, {4, 0}, {5, 5}}};
  Metadata metadata;
  metadata.placement = {{5274357669, 5, 1000}, {-1, 2, 4}, {0, 1, 3}};
  return DecodedTerrain(encode(tin, metadata));
}

std::vector<std::string> exported(const SurfaceModel& model, MeshFormat format,
                                  Coordinates coordinates) {
  const TemporaryFolder folder;
  OutputFile out(folder / "mesh");
  export_model(model, format, coordinates, out);
  out.commit();
  std::ifstream file(folder / "mesh");
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

std::vector<std::string> exported(const DecodedTerrain& terrain, MeshFormat format,
                                  Coordinates coordinates) {
  return exported(model_of(terrain.mesh()), format, coordinates);
}

}  // namespace

TEST_CASE("xyz: a line for each vertex, in exact decimals") {
  std::vector<std::string> lines = exported(square(false), MeshFormat::kXyz, Coordinates::kReal);
  std::sort(lines.begin(), lines.end());
  CHECK(lines == std::vector<std::string>{"5274357.669 -0.25 -1", "5274357.669 1.75 0.333333333333",
                                          "5274357.689 -0.25 0",
                                          "5274357.694 2.25 2.333333333333"});
}

TEST_CASE("meshes in text keep the numbers of the terrain, whatever its units are") {
  for (const MeshFormat format : {MeshFormat::kXyz, MeshFormat::kObj, MeshFormat::kPly}) {
    SurfaceModel model = model_of(square(false).mesh());
    const std::vector<std::string> plain = exported(model, format, Coordinates::kReal);
    for (const Unit flat : {Unit::kMetre, Unit::kDegree, Unit::kFoot, Unit::kUsSurveyFoot}) {
      for (const Unit up : {Unit::kMetre, Unit::kFoot, Unit::kUsSurveyFoot}) {
        model.horizontal_unit = flat;
        model.vertical_unit = up;
        CHECK(exported(model, format, Coordinates::kReal) == plain);
      }
    }
  }
}

TEST_CASE("xyz: lattice integers") {
  std::vector<std::string> lines = exported(square(true), MeshFormat::kXyz, Coordinates::kLattice);
  std::sort(lines.begin(), lines.end());
  CHECK(lines == std::vector<std::string>{"0 0 -3", "0 4 1", "4 0 0", "5 5 7"});
}

TEST_CASE("obj: triangles are counter-clockwise, void ones left out") {
  for (const bool with_void : {false, true}) {
    const std::vector<std::string> lines =
        exported(square(with_void), MeshFormat::kObj, Coordinates::kLattice);
    REQUIRE(lines.size() == (with_void ? 5 : 6));
    std::vector<std::array<int, 2>> places;
    for (size_t i = 0; i < 4; ++i) {
      std::istringstream line(lines[i]);
      std::string v;
      std::array<int, 2> place{};
      line >> v >> place[0] >> place[1];
      CHECK(v == "v");
      places.push_back(place);
    }
    int area = 0;
    for (size_t i = 4; i < lines.size(); ++i) {
      std::istringstream line(lines[i]);
      std::string f;
      size_t a = 0, b = 0, c = 0;
      line >> f >> a >> b >> c;
      REQUIRE((a >= 1 && a <= 4 && b >= 1 && b <= 4 && c >= 1 && c <= 4));
      const auto &p = places[a - 1], &q = places[b - 1], &r = places[c - 1];
      const int twice = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
      CHECK(twice > 0);
      area += twice;
    }
    CHECK(area == (with_void ? 16 : 40));
  }
}

TEST_CASE("ply: counts and lines agree") {
  const std::vector<std::string> lines =
      exported(square(true), MeshFormat::kPly, Coordinates::kReal);
  REQUIRE(lines.size() == 9 + 4 + 1);
  CHECK(lines[0] == "ply");
  CHECK(lines[2] == "element vertex 4");
  CHECK(lines[6] == "element face 1");
  CHECK(lines[8] == "end_header");
  CHECK(lines[13].substr(0, 2) == "3 ");
}

TEST_CASE("most_mesh_bytes is never too low, and as sharp as lines allow") {
  const DecodedTerrain terrain = square(false);
  constexpr uint64_t kHead = 65536 + 4096;  // which is for texts that these have not
  for (const auto format :
       {MeshFormat::kXyz, MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kGlb}) {
    for (const auto coordinates : {Coordinates::kReal, Coordinates::kLattice}) {
      const TemporaryFolder folder;
      OutputFile out(folder / "mesh");
      export_model(model_of(terrain.mesh()), format, coordinates, out);
      out.commit();
      const uint64_t most = most_mesh_bytes(sampled(terrain.mesh()), 4, format, coordinates);
      CHECK(std::filesystem::file_size(folder / "mesh") <= most);
      CHECK(most - kHead <= 3 * std::filesystem::file_size(folder / "mesh"));
    }
  }
  constexpr uint64_t kMany = 1000000000;
  CHECK(most_mesh_bytes(sampled(terrain.mesh()), kMany, MeshFormat::kGlb, Coordinates::kReal) ==
        kHead + kMany * (28 + 2 * 12));
}

TEST_CASE("the suffix selects the format") {
  CHECK(mesh_format_of("a/b.obj") == MeshFormat::kObj);
  CHECK(mesh_format_of("-") == MeshFormat::kXyz);
  CHECK_THROWS_AS(mesh_format_of("mesh.stl"), Error);
}

TEST_CASE("output appears on commit only, and never in part") {
  const TemporaryFolder folder;
  const auto files = [&] {
    return std::distance(std::filesystem::directory_iterator(folder.path()),
                         std::filesystem::directory_iterator());
  };
  { OutputFile(folder / "gone").write("half"); }
  CHECK(files() == 0);
  OutputFile out(folder / "kept");
  out.write("whole");
  CHECK_FALSE(std::filesystem::exists(folder / "kept"));
  out.commit();
  CHECK(files() == 1);
  CHECK(std::filesystem::file_size(folder / "kept") == 5);
}

TEST_CASE("what was there before stays until commit, links lead to their file") {
  const TemporaryFolder folder;
  std::ofstream(folder / "target") << "old";
  std::filesystem::create_symlink("target", folder / "link");
  { OutputFile(folder / "link").write("n"); }
  CHECK(std::filesystem::file_size(folder / "target") == 3);
  OutputFile out(folder / "link");
  out.write("newer");
  out.commit();
  CHECK(std::filesystem::is_symlink(folder / "link"));
  CHECK(std::filesystem::file_size(folder / "target") == 5);
}

TEST_CASE("places that cannot be written are refused by name") {
  const TemporaryFolder folder;
  CHECK_THROWS_WITH_AS(OutputFile(folder.path()), (folder.path() + ": is a directory").c_str(),
                       Error);
  CHECK_THROWS_AS(OutputFile(folder / "no/such/folder"), Error);
  if (!std::filesystem::exists("/dev/full")) return;
  OutputFile full("/dev/full");
  full.write("a few bytes stay in the buffer");
  CHECK_THROWS_WITH_AS(full.commit(), "/dev/full: cannot be written: No space left on device",
                       Error);
  CHECK(std::filesystem::exists("/dev/full"));
}
