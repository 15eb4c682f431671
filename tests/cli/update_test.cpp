// SPDX-License-Identifier: MIT
// The command update.
#include <doctest/doctest.h>

#include <string>

#include "shared/pack_format.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/session.hpp"

namespace microtin::tests {
namespace {

// A terrain, its pack, and the terrain with some changed heights.
struct Changed : Session {
  Changed() {
    REQUIRE(run("fractal --size 65 --seed 3 -o old.asc").code == 0);
    std::string text = read("old.asc");
    REQUIRE(contains(text, " 608 "));
    text.replace(text.rfind(" 608 "), 5, " 908 ");
    write("new.asc", text);
    REQUIRE(run("encode old.asc --max-error 20 --tile-size 16 --units metre --date 2024 --lineage "
                "filled "
                "--water-level 600 -o old.mtp")
                .code == 0);
  }
};

}  // namespace

TEST_CASE("update: few tiles are new, notes stay, and the new terrain is kept") {
  const Changed session;
  const Session::Result updated = session.run(
      "update old.mtp new.asc --water-level 600 --date 2026 --tile-vertices 500 -o new.mtp");
  CHECK(updated.code == 0);
  CHECK(contains(updated.err + updated.out, "kept: 15 of 16 tiles"));
  CHECK(session.run("verify new.mtp new.asc --water-level 600").code == 0);
  CHECK(session.run("verify old.mtp new.asc --water-level 600").code == 1);
  const std::string info = session.run("info new.mtp").out;
  CHECK(contains(info, "date: \"2026\""));
  CHECK(contains(info, "lineage: \"filled\""));
  CHECK(contains(session.run("diff old.mtp new.mtp").err, "1 of 16 tiles differ"));
}

TEST_CASE("update: a tile whose stream or entry is damaged is new, whichever it is") {
  const Changed session;
  const std::string pack = session.read("old.mtp");
  PackHeader header{};
  REQUIRE(read_pack_header(reinterpret_cast<const uint8_t*>(pack.data()), &header) ==
          MICROTIN_STATUS_OK);
  const size_t index = pack_index_start(header), streams = index + 16 * kPackEntryBytes;
  for (const size_t at : {index + 2, streams + 20, pack.size() - 9}) {
    CAPTURE(at);
    std::string damaged = pack;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    session.write("bad.mtp", damaged);
    const Session::Result mended = session.run("update bad.mtp old.asc --water-level 600 -o o.mtp");
    CHECK(contains(mended.err + mended.out, "kept: 15 of 16 tiles"));
    CHECK(session.run("check o.mtp").code == 0);
  }
}

TEST_CASE("verify: a terrain in other units or of another system than the file is refused") {
  const Session session;
  session.write("t.asc",
                "ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4 5 6 7 8 9\n");
  for (const char* file : {"o.mtin", "o.mtp"}) {
    const std::string made = std::string(" -o ") + file, of_file = std::string("verify ") + file;
    REQUIRE(session.run("encode t.asc --epsg 25832 --units :metre --max-error 1" + made).code == 0);
    CHECK(session.run(of_file + " t.asc").code == 0);
    CHECK(contains(session.failure(of_file + " t.asc --units :foot"),
                   "t.asc: the terrain has other units than the encoded file, foot and metre"));
    CHECK(contains(
        session.failure(of_file + " t.asc --epsg 25833"),
        "t.asc: the terrain has another coordinate system than the encoded file, EPSG 25833"));
    CHECK(contains(
        session.failure("render " + std::string(file) + " -o r.png --source t.asc --units :foot"),
        "has other units than the encoded file"));
  }
}

TEST_CASE("update: what cannot be one pack is refused, and nothing is written") {
  const Changed session;
  const auto refusal = [&](const std::string& arguments) {
    return session.failure("update " + arguments + " -o n.mtp");
  };
  CHECK(contains(refusal("old.mtp new.asc --water-level 5"),
                 "old.mtp: its water level is 600, not 5"));
  CHECK(contains(refusal("old.mtp new.asc --units foot"), "has other units than the encoded file"));
  CHECK(contains(refusal("old.asc new.asc"), "old.asc: is not a pack"));
  for (const std::string option : {"--digest", "--phases"}) {
    CHECK(contains(refusal("old.mtp new.asc " + option), option + " is an option of streams"));
  }
  session.write("p.xyz", "0 0 0\n9 0 3\n0 9 7\n5 5 5\n");
  CHECK(contains(refusal("old.mtp p.xyz"), "p.xyz: only packs of rasters are updated"));
  REQUIRE(session.run("encode p.xyz -o p.mtp").code == 0);
  CHECK(contains(refusal("p.mtp new.asc"), "p.mtp: is not a pack that microtin made of a raster"));
  CHECK(
      contains(session.failure("update old.mtp new.asc -o old.mtp"), "old.mtp: is also an input"));
}

}  // namespace microtin::tests
