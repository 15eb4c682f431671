// SPDX-License-Identifier: MIT
// The command height: numbers, words, exit codes; of streams and of packs.
#include <doctest/doctest.h>

#include <sstream>
#include <string>

#include "microtin/pack.h"
#include "tests/support/forged_pack.hpp"
#include "tests/support/session.hpp"

using namespace microtin::tests;

namespace {

// Corners at 0 and 9 with heights 0, 9 and 18; z = x + 2 y.
constexpr const char* kPlane = "0 0 0\n9 0 9\n0 9 18\n";

// A pack of nine tiles on 64 x 64 steps.
void make_pack(const Session& session) {
  REQUIRE(session.run("fractal --size 65 -o t.asc").code == 0);
  REQUIRE(session.run("encode t.asc --max-error 10 --tile-vertices 60 -o t.mtp").code == 0);
  REQUIRE(session.run("encode t.asc --max-error 10 -o t.mtin").code == 0);
}

void damage(const Session& session, const std::string& from, const std::string& to, size_t at) {
  std::string bytes = session.read(from);
  REQUIRE(at < bytes.size());
  bytes[at] = static_cast<char>(~bytes[at]);
  session.write(to, bytes);
}

}  // namespace

TEST_CASE("height: places in real units and on the lattice, one or many") {
  const Session session;
  session.write("plane.xyz", kPlane);
  REQUIRE(session.run("encode plane.xyz --z-step 1 --xy-step 1 -o plane.mtin").code == 0);
  CHECK(session.run("height plane.mtin 1 2").out == "5\n");
  CHECK(session.run("height plane.mtin 0.5 2.25").out == "5\n");
  CHECK(session.run("height plane.mtin 1.125 2").out == "5.125\n");
  CHECK(session.run("height plane.mtin --lattice 1 2").out == "5\n");
  const Session::Result many =
      session.shell("printf '1 2\\n\\n9;0\\n 8, 8\\n-1 3\\n' | microtin height plane.mtin");
  CHECK(many.code == 0);
  CHECK(many.out == "1 2 5\n9;0 9\n 8, 8 outside\n-1 3 outside\n");
}

TEST_CASE("height: outside, void and damaged have words, and exit codes of their own") {
  const Session session;
  session.write("plane.xyz", kPlane);
  REQUIRE(session.run("encode plane.xyz -o plane.mtin").code == 0);
  const Session::Result outside = session.run("height plane.mtin -1 2");
  CHECK(outside.code == 5);
  CHECK(outside.out == "outside\n");
  session.write("hole.asc",
                "ncols 5\nnrows 5\nxllcorner 0\nyllcorner 0\ncellsize 1\nnodata_value -1\n"
                "1 2 3 4 5\n5 -1 -1 -1 5\n5 -1 -1 -1 5\n5 -1 -1 -1 5\n1 2 3 4 5\n");
  REQUIRE(session.run("encode hole.asc -o hole.mtin").code == 0);
  const Session::Result hole = session.run("height hole.mtin --lattice 2 2");
  CHECK(hole.code == 6);
  CHECK(hole.out == "void\n");
  const std::string hole_bytes = session.read("hole.mtin");
  session.write("cut.mtin", hole_bytes.substr(0, hole_bytes.size() - 3));
  const Session::Result cut = session.run("height cut.mtin 1 2");
  CHECK(cut.code == 7);
  CHECK(cut.out.empty());
  CHECK(contains(cut.err, "cut.mtin: "));
  CHECK(contains(session.failure("height plane.xyz 1 2"), "not a microtin stream"));
}

TEST_CASE("height: a pack has the heights of its stream, except in a damaged tile") {
  const Session session;
  make_pack(session);
  damage(session, "t.mtp", "bad.mtp", session.read("t.mtp").size() - 20);
  const std::string ask = "printf '1 1\\n30 30\\n60 60\\n65 1\\n' | microtin height --lattice ";
  std::istringstream whole(session.shell(ask + "t.mtp").out);
  std::istringstream bad(session.shell(ask + "bad.mtp").out);
  std::string line, other;
  for (const char* place : {"1 1 ", "30 30 "}) {
    REQUIRE(std::getline(whole, line));
    REQUIRE(std::getline(bad, other));
    CHECK(line == other);
    CHECK(line.rfind(place, 0) == 0);
    CHECK(line.find_first_of("0123456789", std::string(place).size()) != std::string::npos);
  }
  REQUIRE(std::getline(whole, line));
  CHECK(!contains(line, "damaged"));
  REQUIRE(std::getline(bad, other));
  CHECK(other == "60 60 damaged");
  REQUIRE(std::getline(whole, line));
  CHECK(line == "65 1 outside");
  CHECK(session.run("height bad.mtp --lattice 60 60").code == 7);
  damage(session, "t.mtp", "bad.mtp", 12);
  CHECK(session.run("height bad.mtp --lattice 1 1").code == 7);
}

TEST_CASE("height: the exact plane at the real position, with --device the device's height") {
  const Session session;
  session.write("slope.asc",
                "ncols 2\nnrows 2\nxllcenter 0\nyllcenter 0\ncellsize 1000\n0 1000\n0 1000\n");
  for (const char* const name : {"slope.mtin", "slope.mtp"}) {
    const std::string file = name;
    REQUIRE(session.run("encode slope.asc --max-error 0 -o " + file).code == 0);
    CHECK(session.run("height " + file + " 1.9 500").out == "1.9\n");
    CHECK(session.run("height " + file + " 2 500").out == "2\n");
    CHECK(session.run("height " + file + " 0.1235 0.0000001").out == "0.124\n");  // halves up
    CHECK(session.run("height " + file + " 999.999 1000").out == "999.999\n");
    CHECK(session.run("height " + file + " 1000.000001 0").out == "outside\n");
    CHECK(session.run("height " + file + " -- -0.000001 0").out == "outside\n");
    CHECK(session.run("height " + file + " --device 1.9 500").out == "0\n");
    CHECK(session.run("height " + file + " --device 2 500").out == "3.906\n");
    CHECK(session.run("height " + file + " --device 1000.000001 0").out == "1000\n");
  }
  REQUIRE(session.run("decode slope.mtin --cell 0.5 --extent 0,0,4,0.5 -o fine.asc").code == 0);
  CHECK(contains(session.read("fine.asc"), "\n0 0.5 1 1.5 2 2.5 3 3.5 4\n"));
}

TEST_CASE("height: a tile with more vertices than usual gets the room that its stream needs") {
  const Session session;
  Tin small, large;
  for (uint32_t place = 0; place < 65536; ++place) {
    const auto x = static_cast<uint16_t>(place % 256), y = static_cast<uint16_t>(place / 256);
    large.vertices.push_back({x, y, 7});
    if (x % 255 == 0 && y % 255 == 0) small.vertices.push_back({x, y, 7});
  }
  const Bytes pack = forged_pack({765, 255, 255, 255},
                                 {forged_tile(small), forged_tile(large), forged_tile(small)});
  session.write("t.mtp", {pack.begin(), pack.end()});
  for (const std::string device : {"", " --device"}) {
    CHECK(session
              .shell("printf '9 9\\n255 9\\n300 9\\n510 255\\n700 0\\n9 9\\n' | " +
                     ("microtin height t.mtp --lattice" + device))
              .out == "9 9 7\n255 9 7\n300 9 7\n510 255 7\n700 0 7\n9 9 7\n");
  }
}

TEST_CASE("height: a place with twelve decimals of a border lies on it") {
  const Session session;
  session.write("third.asc",
                "ncols 2\nnrows 2\nxllcenter 0.333333333333\nyllcenter 0\n"
                "cellsize 0.333333333333\n0 3\n0 3\n");
  REQUIRE(session.run("encode third.asc -o third.mtin").code == 0);
  CHECK(session.run("height third.mtin 0.333333333333 0").out == "0\n");
  CHECK(session.run("height third.mtin 0.666666666667 0").out == "3\n");
  CHECK(session.run("height third.mtin 0.66666666667 0").out == "outside\n");
  CHECK(session.run("height third.mtin 0.5 0").out == "1.5\n");
}

TEST_CASE("height: what is no place is refused, with its line") {
  const Session session;
  session.write("plane.xyz", kPlane);
  REQUIRE(session.run("encode plane.xyz -o plane.mtin").code == 0);
  session.failure("height plane.mtin 1", 2);
  session.failure("height plane.mtin 1 north", 2);
  const Session::Result three =
      session.shell("printf '1 2\\n1 2 3\\n' | microtin height plane.mtin");
  CHECK(three.code == 1);
  CHECK(three.out.empty());
  CHECK(contains(three.err, "standard input, line 2"));
  CHECK(session.shell("microtin height - <plane.mtin").code == 1);
  CHECK(session.shell("printf '\\357\\273\\2771 2\\n' | microtin height plane.mtin").out ==
        "1 2 5\n");
  CHECK(session.shell("microtin height - 1 2 <plane.mtin").out == "5\n");
}

TEST_CASE("info: the memory that a device needs for a pack, and the macro for it") {
  const Session session;
  make_pack(session);
  const std::string info = session.run("info t.mtp --json").out;
  const std::string key = "\"max_tile_vertices\": ";
  const size_t at = info.find(key);
  REQUIRE(at != std::string::npos);
  const auto most = static_cast<uint32_t>(std::stoul(info.substr(at + key.size())));
  CHECK(contains(info,
                 "\"device_memory\": \"MICROTIN_PACK_BYTES(4, " + std::to_string(most) + ")\""));
  CHECK(contains(info, "\"workspace_bytes_16\": " +
                           std::to_string(MICROTIN_PACK_BYTES_FOR(4, uint64_t{most}, 16))));
  CHECK(contains(info, "\"workspace_bytes_32\": " +
                           std::to_string(MICROTIN_PACK_BYTES_FOR(4, uint64_t{most}, 32))));
}

TEST_CASE("info: a stream and a pack of one such tile have the same compact bytes") {
  const Session session;
  REQUIRE(session.run("fractal --size 33 --seed 5 -o t.asc").code == 0);
  REQUIRE(session.run("encode t.asc -o t.mtin").code == 0);
  REQUIRE(session.run("encode t.asc -o t.mtp").code == 0);
  const auto compact_bytes = [&](const std::string& file, const std::string& name) {
    const std::string info = session.run("info " + file).out, key = "\n" + name + ": ";
    const size_t at = info.find(key);
    REQUIRE(at != std::string::npos);
    return std::stoul(info.substr(at + key.size()));
  };
  const uint64_t of_stream = compact_bytes("t.mtin", "compact_bytes");
  CHECK(of_stream == compact_bytes("t.mtp", "max_compact_bytes"));
  CHECK(of_stream > 8 * 33 * 33);
}
