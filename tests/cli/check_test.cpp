// SPDX-License-Identifier: MIT
// The commands check and diff.
#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "encoder/files/input.hpp"
#include "encoder/pack/file.hpp"
#include "shared/pack_format.hpp"
#include "tests/support/forged_pack.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

namespace microtin::tests {
namespace {

// A byte of the stream of a tile, or of its entry, is changed.
std::string with_change(std::string pack, size_t at) {
  pack[at] = static_cast<char>(pack[at] ^ 4);
  return pack;
}

size_t entry_of(const std::string& pack, uint32_t tile) {
  PackHeader header{};
  REQUIRE(read_pack_header(reinterpret_cast<const uint8_t*>(pack.data()), &header) ==
          MICROTIN_STATUS_OK);
  return static_cast<size_t>(pack_entry_start(header, tile));
}

}  // namespace

TEST_CASE("check: intact files pass, and bad tiles are all listed") {
  const Session session;
  session.write("t.xyz", "0 0 0\n9 0 3\n0 9 7\n5 5 5\n");
  REQUIRE(session.run("encode t.xyz -o t.mtin").code == 0);
  CHECK(session.run("check t.mtin").out == "kind: \"stream\"\n");
  session.write("d.mtin", with_change(session.read("t.mtin"), 20));
  CHECK(session.failure("check d.mtin").find("d.mtin: damaged") == 0);

  REQUIRE(session.run("fractal --size 65 --seed 3 -o t.asc").code == 0);
  REQUIRE(session.run("encode t.asc --max-error 20 --tile-size 16 -o t.mtp").code == 0);
  CHECK(session.run("check t.mtp").out ==
        "kind: \"pack\"\ntiles: 16\nunsupported: []\nbad: []\nfaults: []\n");
  std::string pack = session.read("t.mtp");
  pack = with_change(pack, pack.size() - 9);        // the last stream
  pack = with_change(pack, entry_of(pack, 3) + 2);  // an entry
  session.write("d.mtp", pack);
  const Session::Result damaged = session.run("check d.mtp --json");
  CHECK(damaged.code == 1);
  CHECK(contains(damaged.out, "\"bad\": [3, 15]"));
  CHECK(contains(damaged.out, "\"unsupported\": []"));
  CHECK(contains(damaged.out, "\"tile 3: damaged"));
  CHECK(contains(damaged.err, "d.mtp: 2 of 16 tiles cannot be used"));
  CHECK(contains(session.failure("embed d.mtp -o d.h"), "d.mtp: tile 3: damaged"));
  CHECK(!std::filesystem::exists(session.folder() + "/d.h"));
  const std::string intact = session.read("t.mtp");
  Bytes sums(intact.begin(), intact.end());
  sums[note_in(sums, MICROTIN_NOTE_SUMS).first] ^= 1;
  repair_checks(sums);
  session.write("s.mtp", std::string(sums.begin(), sums.end()));
  CHECK(contains(session.failure("check s.mtp"), "vertices in all tiles; there are"));
  session.write("h.mtp", with_change(session.read("t.mtp"), 21));
  CHECK(session.failure("check h.mtp").find("h.mtp: ") == 0);
}

TEST_CASE("check: a header that states more tiles than its file holds costs no time") {
  const Session session;
  const PackContent countless{{0x7FFFFFFF, 1, 1, 1}, {}, {}};
  const std::vector<uint8_t> header = write_pack_header(countless);
  session.write("big.mtp", std::string(header.begin(), header.end()));
  CHECK(session.failure("check big.mtp").find("big.mtp: ") == 0);
  CHECK(session.failure("diff big.mtp big.mtp").find("big.mtp: ") == 0);
}

TEST_CASE("check: tiles of a later version are listed apart") {
  const Session session;
  session.write("u.mtp", microtin::files::read_file(golden("unknown.mtp")));
  const Session::Result found = session.run("check u.mtp");
  CHECK(found.code == 1);
  CHECK(contains(found.out, "\nunsupported: [1, 2]\nbad: [7]\n"));
}

TEST_CASE("diff: tiles that differ are listed" * kSlow) {
  const Session session;
  REQUIRE(session.run("fractal --size 65 --seed 3 -o t.asc").code == 0);
  const std::string encode = "encode t.asc --max-error 20 --z-step 8 --tile-size 16 -o ";
  REQUIRE(session.run(encode + "a.mtp").code == 0);
  REQUIRE(session.run(encode + "b.mtp --date 2026").code == 0);
  CHECK(session.run("diff a.mtp a.mtp").out == "tiles: 16\nheader: \"same\"\ndifferent: []\n");
  CHECK(session.run("diff a.mtp b.mtp").out == "tiles: 16\nheader: \"different\"\ndifferent: []\n");
  std::string text = session.read("t.asc");
  REQUIRE(contains(text, " 608 "));
  text.replace(text.rfind(" 608 "), 5, " 908 ");
  session.write("t.asc", text);
  REQUIRE(session.run(encode + "c.mtp").code == 0);
  const Session::Result changed = session.run("diff a.mtp c.mtp");
  CHECK(changed.code == 1);
  CHECK(contains(changed.out, "different: ["));
  CHECK(contains(changed.err, "of 16 tiles differ from those of a.mtp"));
  REQUIRE(session.run("encode t.asc --max-error 20 --tile-size 32 -o d.mtp").code == 0);
  CHECK(session.failure("diff a.mtp d.mtp") ==
        "a.mtp, d.mtp: have other tiles or another lattice; compare packs of one plan\n");
  session.write("no.mtp", "no pack");
  CHECK(session.failure("diff a.mtp no.mtp").find("no.mtp: ") == 0);
}

}  // namespace microtin::tests
