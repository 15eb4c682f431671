// SPDX-License-Identifier: MIT
// Grids that decode writes: which posts they have, and when they are refused.
#include <doctest/doctest.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "microtin/surface.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/join.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;

namespace {

std::string head(const std::string& columns, const std::string& rows, const std::string& x,
                 const std::string& y, const std::string& cell) {
  return "ncols " + columns + "\nnrows " + rows + "\nxllcenter " + x + "\nyllcenter " + y +
         "\ncellsize " + cell + "\nNODATA_value -9999\n";
}

const std::string kHeights =
    "-9999 -9999 -9999 -9999 -9999\n-9999 -9999 1 2 -9999\n-9999 2 3 4 -9999\n-9999 5 6 7 -9999\n";
const std::string kSource = head("5", "4", "500000.5", "-3", "2") + kHeights;

}  // namespace

TEST_CASE("cli: decode writes the source's posts, voids at the margins included") {
  const Session session;
  session.write("t.asc", kSource);
  for (const std::string output : {"t.mtin", "t.mtp --tile-vertices 60"}) {
    const std::string file = output.substr(0, output.find(' '));
    REQUIRE(session.run("encode t.asc -o " + output).code == 0);
    REQUIRE(session.run("decode " + file + " -o all.asc").code == 0);
    CHECK(session.read("all.asc") == kSource);
    REQUIRE(session.run("decode " + file + " --lattice -o lattice.asc").code == 0);
    CHECK(contains(session.read("lattice.asc"), "cellsize 1\n"));
    REQUIRE(session.run("decode " + file + " --extent 500001,-1,500005,100 -o some.asc").code == 0);
    CHECK(
        contains(session.read("some.asc"), "ncols 2\nnrows 51\nxllcenter 500002.5\nyllcenter -1"));
    CHECK(contains(session.read("some.asc"), "\n-9999 1\n2 3\n"));
    REQUIRE(session.run("decode " + file + " --extent 500002.5,-3,500006,0 --cell 1 -o fine.asc")
                .code == 0);
    CHECK(contains(session.read("fine.asc"),
                   "ncols 4\nnrows 4\nxllcenter 500002.5\nyllcenter -3\n"
                   "cellsize 1\nNODATA_value -9999\n"));
    CHECK(contains(session.read("fine.asc"), "\n3.5 4 4.5 5\n5 5.5 6 6.5\n"));
  }
}

TEST_CASE("cli: a lattice coarser than the source's posts still fills these") {
  const Session session;
  session.write("t.asc", head("5", "3", "0", "0", "1") + "1 1 1 1 1\n1 2 3 2 1\n1 1 1 1 1\n");
  REQUIRE(session.run("encode t.asc --xy-step 2 --max-error 3 -o t.mtin").code == 0);
  REQUIRE(session.run("decode t.mtin -o back.asc").code == 0);
  CHECK(
      contains(session.read("back.asc"), "ncols 5\nnrows 3\nxllcenter 0\nyllcenter 0\ncellsize 1"));
}

TEST_CASE("cli: decode --like writes another raster's posts") {
  const Session session;
  session.write("p.xyz", "0 0 0\n10 0 10\n0 10 0\n10 10 10\n");
  session.write("like.asc", head("3", "2", "-2.5", "1", "5") + "9 9 9\n9 9 9\n");
  REQUIRE(session.run("encode p.xyz --units metre -o p.mtin").code == 0);
  REQUIRE(session.run("decode p.mtin --like like.asc -o back.asc").code == 0);
  CHECK(session.read("back.asc") ==
        head("3", "2", "-2.5", "1", "5") + "-9999 2.5 7.5\n-9999 2.5 7.5\n");
  REQUIRE(session.run("decode p.mtin --like like.asc --extent 0,0,9,5 -o part.asc").code == 0);
  CHECK(session.read("part.asc") == head("2", "1", "2.5", "1", "5") + "2.5 7.5\n");
  CHECK(contains(session.failure("decode p.mtin --like p.xyz -o x.asc"),
                 "p.xyz: has points, and no posts; set their distance by --cell"));
  CHECK(contains(session.failure("decode p.mtin --like none.asc -o x.asc"),
                 "none.asc: cannot be read: No such file"));
  CHECK(contains(session.failure("decode p.mtin --like like.asc -o like.asc"), "like.asc"));
  CHECK(contains(session.read("like.asc"), "9 9 9"));
  session.write("like.prj", "GEOGCS[\"WGS 84\",UNIT[\"degree\",0.0174532925199433]]");
  CHECK(
      contains(session.failure("decode p.mtin --like like.asc -o x.asc"),
               "like.asc: its x and y are in the unit degree, and those of the terrain in metre"));
  session.write("far.asc", head("2", "2", "10.1", "0", "1") + "1 1\n1 1\n");
  CHECK(
      contains(session.failure("decode p.mtin --like far.asc -o x.asc"),
               "p.mtin: no post of the grid lies on the terrain, which has x 0 to 10, y 0 to 10"));
}

TEST_CASE("cli: an extent takes either name of a longitude, with the source's own posts") {
  const Session session;
  session.write("t.asc", head("5", "3", "179.5", "-3", "0.35") +  // to 180.9
                             "1 2 3 4 5\n2 3 4 5 6\n3 4 5 6 7\n");
  for (const std::string file : {"t.mtin", "t.mtp"}) {
    REQUIRE(session.run("encode t.asc --units degree:metre -o " + file).code == 0);
    for (const std::string grid : {"", " --like t.asc"}) {
      const auto rows = [&](const std::string& extent, const std::string& west) {
        REQUIRE(session.run(join({"decode ", file, grid, " -o x.asc --extent=", extent})).code ==
                0);
        CHECK(contains(session.read("x.asc"), head("3", "2", west, "-3", "0.35")));
        CHECK(contains(session.read("x.asc"), "\n4 5 6\n5 6 7\n"));
      };
      rows("180.1,-3,181,-2.5", "180.2");
      rows("-179.9,-3,-179,-2.5", "-179.8");
    }
  }
}

TEST_CASE("cli: decode refuses what does not go together") {
  const Session session;
  session.write("t.asc", kSource);
  REQUIRE(session.run("encode t.asc -o t.mtin").code == 0);
  CHECK(
      contains(session.failure("decode t.mtin --extent 1,2,3,4 -o t.ply"), "are for grids (.asc)"));
  CHECK(contains(session.failure("decode t.mtin --like t.asc -o t.glb"), "are for grids (.asc)"));
  CHECK(contains(session.failure("decode t.mtin --extent 3,2,1,4 -o x.asc", 2),
                 "--extent: '3,2,1,4' is not allowed; use WEST,SOUTH,EAST,NORTH"));
  CHECK(contains(session.failure("decode t.mtin --like t.asc --cell 2 -o x.asc", 2), "--cell"));
  CHECK(contains(session.failure("decode t.mtin --like t.asc --lattice -o x.asc", 2), "--lattice"));
  CHECK(contains(session.failure("decode t.mtin --extent 500001,-9,500002,9 -o x.asc"),
                 "no post of the grid lies in the extent; choose a larger one"));
}

TEST_CASE("cli: an output that can take more than 1 GB is announced, and forced") {
  const Session session;
  session.write("t.asc", kSource);
  REQUIRE(session.run("encode t.asc -o t.mtin").code == 0);
  CHECK(
      session.failure("decode t.mtin --cell 0.0002 -o x.asc") ==
      "x.asc: would take up to 2.8 GB; use --force to write it; use --cell or --extent for less\n");
  // To where nobody writes much: the announcement comes before.
  CHECK(contains(session.run("decode t.mtin --cell 0.0002 --force -o missing/x.asc").err,
                 "warning: missing/x.asc takes up to 2.8 GB"));
}

namespace {

// A pack of 1,025 tiles, each of a flat stream of 16,384 vertices, whose header says that they have
// 2,097,152.
Bytes understated_pack() {
  Tin tin;
  for (uint32_t place = 0; place < 16384; ++place) {
    tin.vertices.push_back(
        {static_cast<uint16_t>(place % 128), static_cast<uint16_t>(place / 128), 0});
  }
  constexpr uint32_t kTiles = 1025;
  const ForgedTile tile = forged_tile(tin);
  Bytes pack = forged_pack({127 * kTiles, 127, 127, 127}, std::vector<ForgedTile>(kTiles, tile));
  put_number(pack, note_in(pack, MICROTIN_NOTE_SUMS).first, 0x00808081, 4);
  repair_checks(pack);
  return pack;
}

}  // namespace

// Sanitizers take minutes to make this pack, and less of the program runs than in other cases.
TEST_CASE("cli: the vertices of a pack are counted, not taken from its header" * kSlow *
          doctest::skip(kIsSanitized)) {
  const Session session;
  const Bytes pack = understated_pack();
  session.write("t.mtp", {pack.begin(), pack.end()});
  REQUIRE(contains(session.run("info t.mtp").out, "\nvertices: 2097152\n"));
  CHECK(contains(session.failure("decode t.mtp -o t.ply"), "t.ply: would take up to "));
  const std::string many = "t.mtp: its tiles have 16793600 vertices, which take about ";
  CHECK(contains(session.failure("decode t.mtp --lattice -o t.xyz"), many));
  CHECK(contains(session.failure("render t.mtp -o t.png"), many));
  CHECK(contains(session.failure("render t.mtp -o t.svg"), "use --force to read them"));
  const microtin::encoder::Surface surface =
      microtin::encoder::Surface::from_file(session.folder() + "/t.mtp");
  CHECK_THROWS_WITH_AS(surface.mesh(), doctest::Contains("16793600 vertices; more than 16777216"),
                       std::runtime_error);
}
