// SPDX-License-Identifier: MIT
// Packs cut into parts, and parts joined again.
#include <doctest/doctest.h>

#include <string>

#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

// A terrain of 257 x 257 posts, 30 apart, and its pack of 9 x 9 tiles of 29 steps.
struct Packed : Session {
  Packed() {
    REQUIRE(run("fractal --size 257 --seed 3 -o t.asc").code == 0);
    REQUIRE(run("encode t.asc " + options + "-o t.mtp").code == 0);
  }

  const std::string options = "--units metre --max-error 10 --z-step 6 --tile-size 31 --fast ";
};

}  // namespace

TEST_CASE("cut: whole tiles keep their heights, and parts join to what they were" * kSlow) {
  const Packed session;
  const Session::Result west = session.run("cut t.mtp --extent 0,0,3000,7680 -o west.mtp");
  CHECK(contains(west.out, "tiles: 4 x 9, "));
  // Tiles of an odd width: a column more, so that the first place is an even one.
  CHECK(contains(session.run("cut t.mtp --extent 3000,0,7680,7680 -o east.mtp").out,
                 "tiles: 7 x 9, "));
  CHECK(contains(session.run("cut t.mtp --extent 80.2,80.3,80.4,80.6 -o one.mtp").out,
                 "tiles: 1 x 1, "));
  for (const std::string part : {"west.mtp", "east.mtp", "one.mtp"}) {
    CHECK(session.run("check " + part).code == 0);
  }
  for (const std::string place : {"2000 5000", "100 40", "2990 7680"}) {
    CHECK(session.run("height west.mtp " + place).out == session.run("height t.mtp " + place).out);
  }
  CHECK(session.run("height east.mtp 4000 5000").out == session.run("height t.mtp 4000 5000").out);
  CHECK(session.run("height west.mtp 4000 5000").out == "outside\n");
  for (const std::string order : {"west.mtp east.mtp", "east.mtp west.mtp"}) {
    REQUIRE(session.run("merge " + order + " -o all.mtp").code == 0);
    CHECK(session.run("diff all.mtp t.mtp").code == 0);
    CHECK(session.run("verify all.mtp t.asc --units metre").code == 0);
    CHECK(session.read("all.mtp").size() == session.read("t.mtp").size());
  }
}

TEST_CASE("cut: what is not there, or does not go together, is refused" * kSlow) {
  const Packed session;
  CHECK(session.failure("cut t.mtp --extent 7900,0,9000,256 -o c.mtp") ==
        "t.mtp: has no tile in this extent; it goes from x 0, y 0 to x 7680, y 7680\n");
  CHECK(contains(session.failure("cut t.asc --extent 0,0,1,1 -o c.mtp"), "t.asc: is not a pack"));
  CHECK(session.run("cut t.mtp -o c.mtp").code == 2);
  REQUIRE(session.run("cut t.mtp --extent 0,0,3000,7680 -o west.mtp").code == 0);
  std::string text = session.read("t.asc");
  for (size_t at = 0; (at = text.find(" 60", at)) != text.npos; ++at) text[at + 1] = '7';
  session.write("other.asc", text);
  REQUIRE(session.run("encode other.asc " + session.options + "-o other.mtp").code == 0);
  REQUIRE(session.run("cut other.mtp --extent 3700,0,7680,7680 -o east.mtp").code == 0);
  CHECK(contains(session.failure("merge west.mtp east.mtp -o c.mtp"),
                 "east.mtp: its border is not that of west.mtp"));
  CHECK(contains(session.failure("merge t.mtp other.mtp -o c.mtp"), "other.mtp: its "));
  REQUIRE(session
              .run("encode t.asc --units metre --max-error 12 --z-step 6 --tile-size 31 --fast "
                   "-o wide.mtp")
              .code == 0);
  CHECK(contains(session.failure("merge west.mtp wide.mtp -o c.mtp"),
                 "wide.mtp: has other tiles, another lattice, bound or system than west.mtp"));
}

TEST_CASE("cut: both names of a longitude beyond 180 degrees") {
  const Session session;
  const std::string heights = "1 2 3\n4 5 6\n7 8 9\n";
  session.write("a.asc", "ncols 3\nnrows 3\nxllcenter 179\nyllcenter 0\ncellsize 0.5\n" + heights);
  session.write("b.asc", "ncols 3\nnrows 3\nxllcenter -180\nyllcenter 0\ncellsize 0.5\n" + heights);
  REQUIRE(session.run("encode a.asc b.asc --units degree:metre --tile-size 2 -o t.mtp").code == 0);
  for (const std::string extent : {"-179.9,0,-179.1,1", "180.1,0,180.9,1"}) {
    REQUIRE(session.run("cut t.mtp --extent " + extent + " -o c.mtp").code == 0);
    CHECK(session.run("height c.mtp -- -179.5 0.5").out == "5\n");
    CHECK(session.run("height c.mtp 179.5 0.5").out == "outside\n");
  }
}

}  // namespace microtin::tests
