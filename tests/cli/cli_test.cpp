// SPDX-License-Identifier: MIT
// The program as its users meet it: exit codes, messages, files left behind.
#include <doctest/doctest.h>

#include <algorithm>
#include <string>

#include "microtin/compact_pack.h"
#include "microtin/microtin.h"
#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;
namespace fs = std::filesystem;

namespace {

const char* const kGrid =
    "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 2\nnodata_value -1\n"
    "1 2 3 4\n5 9 7 8\n-1 -1 3 9\n";

}  // namespace

TEST_CASE("cli: encode, info, verify and decode agree") {
  const Session session;
  session.write("t.asc", kGrid);
  const Session::Result encoded = session.run("encode t.asc -o t.mtin --epsg 25832:5783");
  CHECK(encoded.code == 0);
  CHECK(encoded.err.empty());
  CHECK(contains(encoded.out, "10 posts, 2 void posts"));
  CHECK(contains(encoded.out, "10 vertices"));

  const Session::Result info = session.run("info t.mtin --json");
  CHECK(info.code == 0);
  for (const char* key : {"\"stream_version\": 6",
                          "\"vertices\": 10",
                          "\"triangles\"",
                          "\"bytes\"",
                          "\"bits_per_vertex\"",
                          "\"phases\"",
                          "\"max_degree\": 10",
                          "\"coding\": \"balanced\"",
                          "\"workspace_bytes_16\"",
                          "\"workspace_bytes_32\"",
                          "\"steps\"",
                          "\"offsets\"",
                          "\"bound\": null",
                          "\"max_error\": 0.0",
                          "\"rms_error\": 0.0",
                          "\"mean_error\": 0.0",
                          "\"axes\"",
                          "\"grid\": {\"columns\": 4, \"rows\": 3",
                          "\"horizontal_epsg\": 25832",
                          "\"vertical_epsg\": 5783"}) {
    CHECK_MESSAGE(contains(info.out, key), key);
  }

  const Session::Result verified = session.run("verify t.mtin t.asc --json");
  CHECK(verified.code == 0);
  CHECK(contains(verified.out, "\"posts\": 10"));
  CHECK(contains(verified.out, "\"uncovered\": 0"));
  CHECK(contains(verified.out, "\"voids_answered\": 0"));

  CHECK(session.run("decode t.mtin -o t.xyz").code == 0);
  const std::string points = session.read("t.xyz");
  CHECK(std::count(points.begin(), points.end(), '\n') == 10);
  CHECK(contains(points, "1 5 1\n"));  // the north-west post
  CHECK(session.run("decode t.mtin --lattice -o -").out.find("0 2 1\n") != std::string::npos);
}

TEST_CASE("cli: a coarser lattice notes the source's grid, and the rule for posts that meet") {
  const Session session;
  session.write("t.asc",
                "ncols 5\nnrows 5\nxllcenter 100\nyllcenter 7\ncellsize 2\n"
                "1 1 1 1 1\n1 2 2 2 1\n1 2 3 2 1\n1 2 2 2 1\n1 1 1 1 1\n");
  REQUIRE(session.run("encode t.asc -o t.mtin --max-error 5 --xy-step 2").code == 0);
  const std::string info = session.run("info t.mtin").out;
  CHECK(contains(
      info,
      "grid: {\"columns\": 5, \"rows\": 5, \"x\": {\"offset\": 100, \"numerator\": 2, "
      "\"denominator\": 1}, \"y\": {\"offset\": 7, \"numerator\": 2, \"denominator\": 1}}"));
  CHECK(contains(info, "duplicates: \"middle of lowest and highest\"\n"));
  CHECK(contains(session.run("verify t.mtin t.asc").out, "mean_error: "));
}

TEST_CASE("cli: points come from a pipe, streams go to one") {
  const Session session;
  session.write("p.xyz", "0 0 1\n10.5 0 2\n0 10 3\n4 4 9\n");
  REQUIRE(session.run("encode - -o - < p.xyz > piped.mtin").code == 0);
  const Session::Result encoded = session.run("encode p.xyz -o filed.mtin");
  CHECK(session.read("piped.mtin") == session.read("filed.mtin"));
  CHECK(session.run("info - < piped.mtin").code == 0);
}

TEST_CASE("cli: bounds are kept, merged points counted" * kSlow) {
  const Session session;
  REQUIRE(session.run("fractal --size 65 --seed 3 -o f.asc").code == 0);
  REQUIRE(session.run("encode f.asc --max-error 10 --z-step 8 -o f.mtin").code == 0);
  const Session::Result verified = session.run("verify f.mtin f.asc --json");
  CHECK(verified.code == 0);
  CHECK(contains(verified.out, "\"covered\": 4225"));
  CHECK(contains(session.run("info f.mtin --json").out, "\"bound\": 10.0"));
  CHECK(contains(session.run("encode f.asc --xy-step 2 -o g.mtin").out, "merged: "));
  CHECK(session.run("encode f.asc --max-vertices 100 -o h.mtin").code == 0);
  const std::string few = session.run("info h.mtin").out, key = "vertices: ";
  CHECK(std::stoul(few.substr(few.find(key) + key.size())) <= 100);
  CHECK(contains(session.failure("encode f.asc --max-vertices 3 -o i.mtin"), "alone need 4"));
}

TEST_CASE("cli: searches, and surfaces that are never below" * kSlow) {
  const Session session;
  REQUIRE(session.run("fractal --size 65 --seed 3 -o f.asc").code == 0);
  for (const char* option : {"", "--fast", "--best", "--never-below", "--never-below --z-step 2"}) {
    REQUIRE(session.run("encode f.asc --max-error 10 -o f.mtin " + std::string(option)).code == 0);
    const Session::Result verified = session.run("verify f.mtin f.asc --json");
    CHECK(verified.code == 0);
    const bool above = std::string(option).find("--never") == 0;
    CHECK(contains(verified.out, "\"max_below\": 0.0,") == above);
    CHECK(session.run("verify f.mtin f.asc --never-below").code == (above ? 0 : 1));
  }
}

TEST_CASE("cli: the bound that a number of bytes allows" * kSlow) {
  const Session session;
  REQUIRE(session.run("fractal --size 33 --seed 3 -o f.asc").code == 0);
  for (const char* option : {"--fast", "--fast --never-below"}) {
    REQUIRE(session.run("encode f.asc --max-bytes 400 -o f.mtin " + std::string(option)).code == 0);
    CHECK(session.read("f.mtin").size() <= 400);
    // A bound a tenth smaller does not fit.
    const std::string info = session.run("info f.mtin").out;
    const double bound = std::stod(info.substr(info.find("\nbound: ") + 8));
    const std::string tighter = "encode f.asc -o g.mtin --max-error " + std::to_string(0.9 * bound);
    REQUIRE(session.run(tighter + " " + option).code == 0);
    CHECK(session.read("g.mtin").size() > 400);
    CHECK(session.run("verify f.mtin f.asc").code == 0);
  }
  CHECK(contains(session.failure("encode f.asc --max-bytes 30 --fast -o g.mtin"),
                 "--max-bytes 30 is too small: the smallest file found, at any error, has "));
}

TEST_CASE("cli: outlines of voids are simplified to use a limit") {
  const Session session;
  std::string grid =
      "ncols 30\nnrows 30\nxllcenter 0\nyllcenter 0\ncellsize 1\nNODATA_value -9999\n";
  for (int j = 0; j < 30; ++j) {
    for (int i = 0; i < 30; ++i) {
      const bool is_void = i < 3 || j > 26 || (10 < i && i < 14);
      grid += std::to_string(is_void ? -9999 : i * j % 23) + (i < 29 ? ' ' : '\n');
    }
  }
  session.write("v.asc", grid);
  for (const char* limit : {"--max-vertices 20", "--device-ram 3250", "--max-bytes 120"}) {
    REQUIRE(session.run(std::string("encode v.asc -o v.mtin ") + limit).code == 0);
    CHECK(session.run("verify v.mtin v.asc").code == 0);
  }
  CHECK(contains(session.failure("encode v.asc -o v.mtin --max-vertices 12"),
                 "--max-vertices 12 is too small: outline and voids alone need "));
  CHECK(contains(session.failure("encode v.asc -o v.mtin --device-ram 2800"),
                 "--device-ram 2800 holds at most "));
}

TEST_CASE("cli: a device's RAM decides how many vertices fit" * kSlow) {
  Session session;
  session.run("fractal --size 33 -o f.asc");
  const auto workspaces = [&](const std::string& stream) {
    const std::string info = session.run("info " + stream).out, key = "workspace_bytes_16: ";
    return std::stoul(info.substr(info.find(key) + key.size()));
  };
  CHECK(session.run("encode f.asc --device-ram 10000 -o ram.mtin").code == 0);
  const unsigned long used = workspaces("ram.mtin");
  CHECK(used <= 10000);
  CHECK(used > 8500);
  CHECK(session.run("encode f.asc --max-vertices 100 --device-ram 10000 -o few.mtin").code == 0);
  CHECK(workspaces("few.mtin") < used);
  CHECK(session.run("encode f.asc --max-vertices 900 --device-ram 10000 -o all.mtin").code == 0);
  CHECK(session.read("all.mtin") == session.read("ram.mtin"));
  CHECK(contains(session.failure("encode f.asc --max-error 0 --device-ram 10000 -o x"),
                 "the terrain does not fit: "));
  session.failure("encode f.asc --device-ram 1000 -o x", 2);
}

TEST_CASE("cli: streams become C headers") {
  Session session;
  session.write("square.xyz", "0 0 1\n2 0 2\n0 2 3\n2 2 4\n");
  CHECK(session.run("encode square.xyz -o s.mtin").code == 0);
  CHECK(session.run("embed s.mtin -o a-1.h").code == 0);
  const std::string header = session.read("a-1.h");
  CHECK(contains(header, "#define A_1_VERTICES 4\n"));
  const std::string stream = session.read("s.mtin");
  CHECK(contains(header, "static const uint8_t a_1_stream[" + std::to_string(stream.size()) +
                             "] = {\n    0x6d, 0x74, 0x69, 0x6e, "));
  CHECK(contains(session.run("embed s.mtin -o -").out, " terrain_stream["));
  CHECK(session.run("embed s.mtin -o 1.h").code == 0);
  CHECK(contains(session.read("1.h"), " t1_stream["));
  session.write("bad.mtin", stream.substr(1));
  CHECK(contains(session.failure("embed bad.mtin -o bad.h"), "bad.mtin"));
}

TEST_CASE("cli: terrain files of autopilots" * kSlow) {
  const Session session;
  std::string posts;
  for (int i = 0; i < 61 * 61; ++i) posts += {'\x01', static_cast<char>(i % 61)};
  session.write("N43E007.hgt", posts);
  CHECK(session.run("encode N43E007.hgt --max-error 2 -o s.mtin").code == 0);
  const Session::Result inav = session.run("decode s.mtin -o N43E007.TER");
  CHECK(inav.code == 0);
  CHECK(contains(inav.out, " blocks of 28 x 32 posts, 30 m apart; "));
  CHECK(contains(inav.out, "the grid adds: at most "));
  CHECK(contains(inav.out, "covered in part: "));
  CHECK(contains(session.run("decode s.mtin --cell 200 -o N43E007.DAT").out, ", 200 m apart; "));
  CHECK(session.read("N43E007.DAT").size() % 2048 == 0);
  CHECK(contains(session.failure("decode s.mtin --cell 31 -o N43E007.TER"), "--cell must be 30"));
  CHECK(contains(session.failure("decode s.mtin --cell 2.5 -o N43E008.DAT"),
                 "--cell must be a whole"));
  CHECK(
      contains(session.failure("decode s.mtin -o area.DAT"), "area.DAT: the name must be that of"));
  CHECK(contains(session.failure("decode s.mtin -o N10E010.DAT"), "no height in the cell"));
  CHECK(contains(session.failure("decode s.mtin --lattice -o N43E007.DAT"), "leave out --lattice"));
  session.write("square.xyz", "0 0 1\n2 0 2\n0 2 3\n2 2 4\n");
  CHECK(session.run("encode square.xyz -o m.mtin").code == 0);
  CHECK(contains(session.failure("decode m.mtin -o N00E000.DAT"), "need positions in degrees"));
}

TEST_CASE("cli: packs become C headers") {
  const Session session;
  CHECK(session.run("fractal --size 33 --seed 1 -o t.asc").code == 0);
  CHECK(session.run("encode t.asc --max-error 9 --tile-vertices 40 -o t.mtp").code == 0);
  CHECK(session.run("embed t.mtp -o t.h").code == 0);
  const std::string header = session.read("t.h"), bytes = session.read("t.mtp");
  const std::string info = session.run("info t.mtp").out, key = "max_tile_vertices: ";
  const std::string most = info.substr(info.find(key) + key.size());
  CHECK(contains(header, "#define T_MOST_VERTICES " + most.substr(0, most.find('\n') + 1)));
  CHECK(contains(header, "static const uint8_t t_pack[" + std::to_string(bytes.size()) +
                             "] = {\n    0x6d, 0x74, 0x70, 0x6b, "));
  const size_t last = static_cast<unsigned char>(bytes.back());
  char text[16];
  std::snprintf(text, sizeof text, "0x%02zx,\n}", last);
  CHECK(contains(header, text));
}

TEST_CASE("cli: verify fails on another terrain") {
  const Session session;
  session.write("a.xyz", "0 0 0\n9 0 0\n0 9 0\n");
  session.write("b.xyz", "0 0 5\n9 0 0\n0 9 0\n");
  session.write("c.xyz", "0 0 0\n90 0 0\n");
  REQUIRE(session.run("encode a.xyz --max-error 4 -o a.mtin").code == 0);
  CHECK(session.run("verify a.mtin a.xyz").code == 0);
  CHECK(session.failure("verify a.mtin b.xyz") == "a.mtin: the largest error is above the bound\n");
  CHECK(contains(session.failure("verify a.mtin c.xyz"), "not covered"));
}

TEST_CASE("cli: voids are filled on request") {
  const Session session;
  session.write("t.asc", kGrid);
  CHECK(contains(session.run("encode t.asc --fill-voids 2 -o t.mtin").out,
                 "12 posts, 2 of the posts were void and are filled"));
  CHECK(contains(session.failure("verify t.mtin t.asc"), "voids"));
  CHECK(session.run("verify t.mtin t.asc --fill-voids 2").code == 0);
  CHECK(contains(session.run("encode t.asc --fill-voids 2 --tile-vertices 60 -o t.mtp").out,
                 "source: 12 posts, 2 of the posts were void and are filled"));
}

TEST_CASE("cli: bad input gives one line with file and line, and no output") {
  const Session session;
  const std::string header = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  session.write("short.asc", header + "1 2 3\n");
  session.write("letters.asc", header + "1 2\n3 four\n");
  session.write("nan.xyz", "0 0 0\n1 0 nan\n0 1 0\n");
  session.write("range.xyz", "0 0 0\n1e40 0 0\n0 1 0\n");
  session.write("N43E007.hgt", std::string(1000, '\0'));
  session.write("line.xyz", "0 0 0\n1 1 0\n2 2 0\n");
  session.write("empty.xyz", "");
  session.write("wall.xyz", "0 0 0\n9 0 0\n0 9 0\n0 9 8\n");
  session.write("ok.xyz", "0 0 0\n9 0 3\n0 9 70000\n");
  session.write("image.tif", "II");
  const auto failure = [&](const std::string& arguments) {
    return session.failure("encode " + arguments + " -o out.mtin");
  };
  CHECK(contains(failure("missing.tif"), "No such file or directory"));
  CHECK(failure("missing.asc") == "missing.asc: cannot be read: No such file or directory\n");
  CHECK(failure("image.tif").find("image.tif: ") == 0);
  CHECK(failure("short.asc").find("short.asc:7: ") == 0);
  CHECK(failure("letters.asc").find("letters.asc:7: ") == 0);
  CHECK(failure("nan.xyz").find("nan.xyz:2: ") == 0);
  CHECK(failure("range.xyz").find("range.xyz:2: ") == 0);
  CHECK(failure("N43E007.hgt").find("N43E007.hgt: has 1000 bytes") == 0);
  CHECK(contains(failure("line.xyz"), "line.xyz: "));
  CHECK(contains(failure("line.xyz"), "triangle"));
  CHECK(failure("empty.xyz") == "empty.xyz: holds no point\n");
  CHECK(failure("wall.xyz --max-error 1").find("wall.xyz: --max-error cannot be kept at 1 ") == 0);
  CHECK(failure("ok.xyz --z-step 1").find("ok.xyz: --z-step 1 is too fine") == 0);
  CHECK(failure("ok.xyz --z-step 5 --max-error 1").find("ok.xyz: --max-error cannot be kept") == 0);
}

TEST_CASE("cli: directories and unwritable places") {
  const Session session;
  session.write("ok.xyz", "0 0 0\n9 0 3\n0 9 7\n");
  session.run("fractal --size 3 -o sub.asc");
  fs::create_directory(session.folder() + "/none");
  CHECK(session.failure("encode none -o out.mtin").find("none: holds no terrain file: .hgt, ") ==
        0);
  CHECK(session.failure("encode ok.xyz -o ok.tif").find("ok.tif: name a stream .mtin") == 0);
  CHECK(session.failure("encode sub.asc --tile-vertices 16 -o sub.mtin") ==
        "sub.mtin: name a pack .mtp\n");
  CHECK(session.failure("encode ok.xyz -o .") == ".: is a directory\n");
  CHECK(contains(session.failure("encode ok.xyz -o no/such/out.mtin"), "no/such/out.mtin: "));
  CHECK(contains(session.failure("decode . -o out.xyz"), ".: "));
  if (!fs::exists("/dev/full")) return;
  CHECK(session.failure("encode ok.xyz -o /dev/full") ==
        "/dev/full: cannot be written: No space left on device\n");
  CHECK(contains(session.failure("encode ok.xyz -o - > /dev/full"), "No space left"));
  CHECK(fs::exists("/dev/full"));
}

TEST_CASE("cli: the output is not the input") {
  const Session session;
  session.write("t.xyz", "0 0 1\n9 0 2\n0 9 3\n");
  CHECK(session.failure("encode t.xyz -o t.xyz") ==
        "t.xyz: is also an input; choose another output\n");
  REQUIRE(session.run("encode t.xyz -o t.mtin").code == 0);
  CHECK(session.failure("decode t.mtin -o ./t.mtin") ==
        "./t.mtin: is also an input; choose another output\n");
  CHECK(session.read("t.xyz") == "0 0 1\n9 0 2\n0 9 3\n");
}

TEST_CASE("cli: damaged streams") {
  const Session session;
  session.write("ok.xyz", "0 0 0\n9 0 3\n0 9 7\n5 5 5\n");
  REQUIRE(session.run("encode ok.xyz -o ok.mtin").code == 0);
  const std::string stream = session.read("ok.mtin");
  session.write("long.mtin", stream + "x");
  session.write("cut.mtin", stream.substr(0, stream.size() - 1));
  session.write("empty.mtin", "");
  std::string damaged = stream;
  damaged[stream.size() / 2] = static_cast<char>(damaged[stream.size() / 2] ^ 4);
  session.write("damaged.mtin", damaged);
  for (const std::string name : {"long.mtin", "cut.mtin", "empty.mtin", "damaged.mtin", "ok.xyz"}) {
    CHECK(session.failure("decode " + name + " -o out.xyz").find(name + ": ") == 0);
    CHECK(session.failure("info " + name).find(name + ": ") == 0);
    CHECK(session.failure("verify " + name + " ok.xyz").find(name + ": ") == 0);
  }
  CHECK(contains(session.failure("decode long.mtin -o out.xyz"),
                 "the bytes behind the end of the stream are damaged: they are no chunks"));
  CHECK(contains(session.failure("decode ok.mtin -o out.stl"), "out.stl: "));
}

TEST_CASE("cli: a pack for an autopilot fits its RAM in nine compact slots") {
  const Session session;
  REQUIRE(session.run("fractal --size 129 --seed 3 -o t.asc").code == 0);
  const auto number_after = [](const std::string& text, const std::string& words) {
    const size_t at = text.find(words);
    REQUIRE(at != std::string::npos);
    return std::stoul(text.substr(at + words.size()));
  };
  for (const std::string name : {"inav", "ardupilot"}) {
    const Session::Result made =
        session.run("encode t.asc --max-error 9 --for " + name + " --device-ram 30000 -o t.mtp");
    REQUIRE(made.code == 0);
    CHECK(contains(made.out, "for " + name + ": define MICROTIN_ADAPTERS_COMPACT; "));
    const unsigned long capacity = number_after(made.out, "MICROTIN_COMPACT_PACK_BYTES(9, "),
                        taken = number_after(made.out, " and microtin_" + name + " take ");
    const std::string info = session.run("info t.mtp").out;
    CHECK(number_after(info, "max_tile_vertices: ") == capacity);
    const unsigned long tile = number_after(info, "max_compact_bytes: ");
    CHECK(taken == MICROTIN_COMPACT_PACK_BYTES_FOR(9, capacity, tile, 16) + 3072);
    CHECK(taken <= 30000);
    CHECK(taken > 15000);
  }
  // Smaller tiles than for a device that keeps four.
  REQUIRE(session.run("encode t.asc --max-error 9 --device-ram 30000 -o four.mtp").code == 0);
  CHECK(number_after(session.run("info four.mtp").out, "max_tile_vertices: ") >
        number_after(session.run("info t.mtp").out, "max_tile_vertices: "));
  CHECK(contains(session.failure("encode t.asc --for inav --device-ram 8000 -o no.mtp"),
                 "--device-ram 8000 is too small for a pack"));
  session.failure("encode t.asc --for px4 -o no.mtp", 2);
}

TEST_CASE("cli: packs" * kSlow) {
  const Session session;
  REQUIRE(session.run("fractal --size 65 --seed 3 -o t.asc").code == 0);
  const Session::Result encoded =
      session.run("encode t.asc --max-error 20 --tile-vertices 60 -o t.mtp");
  REQUIRE(encoded.code == 0);
  CHECK(contains(encoded.out, "pack: "));
  CHECK(contains(encoded.out, "requested: at most 20"));
  CHECK(session.run("verify t.mtp t.asc").code == 0);
  const Session::Result info = session.run("info t.mtp");
  CHECK(contains(info.out, "pack_version: 5"));
  CHECK(contains(info.out, "\ntile   x   y  bytes  vertices  max_below_everywhere  max_above_"));
  CHECK(contains(info.out, "\n   0   0   0  "));
  CHECK(contains(session.run("info t.mtp --json").out, "\"tiles\": ["));
  CHECK(session.run("decode t.mtp -o t.ply").code == 0);
  CHECK(contains(session.read("t.ply"), "element face "));
  CHECK(session.run("encode t.asc --max-error 20 --device-ram 32768 -o ram.mtp").code == 0);
  REQUIRE(session.run("fractal --size 65 --seed 4 -o other.asc").code == 0);
  CHECK(contains(session.failure("verify t.mtp other.asc"), "above the bound"));
  session.write("points.xyz", "0 0 0\n9 0 3\n0 9 7\n");
  CHECK(contains(session.failure("encode t.asc --tile-vertices 60 --xy-step 2 -o p.mtp"),
                 "--xy-step"));
  session.write("beside.xyz", "-1 0 0\n9 0 3\n0 9 7\n");
  CHECK(contains(session.failure("verify t.mtp beside.xyz"), "above the bound"));
  std::string damaged = session.read("t.mtp");
  damaged[damaged.size() - 9] ^= 4;
  session.write("damaged.mtp", damaged);
  CHECK(contains(session.failure("decode damaged.mtp -o out.ply"), "damaged.mtp: tile "));
  const std::size_t first = damaged.find("mtin");
  damaged[first + 7] ^= 4;  // in its header
  session.write("damaged.mtp", damaged);
  CHECK(contains(session.failure("info damaged.mtp"), "damaged.mtp: tile 0: "));
}

TEST_CASE("cli: packs of points" * kSlow) {
  const Session session;
  std::string points;
  for (int i = 0; i < 900; ++i) {
    points += std::to_string(i % 30 * 5000) + ".25 " + std::to_string(i / 30 * 3000) + " " +
              std::to_string(i * i % 97) + "\n";
  }
  session.write("p.xyz", points + "0.26 0 1\n");
  const Session::Result encoded =
      session.run("encode p.xyz --max-error 9 --xy-step 0.1 --tile-vertices 90 -o p.mtp");
  REQUIRE(encoded.code == 0);
  CHECK(contains(encoded.out, "source: 901 points"));
  CHECK(contains(encoded.out, "step of x and y: 0.1, values move by up to 0.05"));
  CHECK(contains(encoded.out, "merged: 1 shared"));
  CHECK(contains(encoded.out, "pack: "));
  CHECK(session.run("verify p.mtp p.xyz").code == 0);
  CHECK(contains(session.run("info p.mtp").out, "x_max: 145000"));
  CHECK(session.run("decode p.mtp -o p.ply").code == 0);
  CHECK(contains(session.read("p.ply"), "element face "));
  CHECK(session.run("encode p.xyz --device-ram 32768 -o ram.mtp").code == 0);
  CHECK(session.run("verify ram.mtp p.xyz").code == 0);
  session.write("other.xyz", points + "70000 45000 500\n");
  CHECK(contains(session.failure("verify p.mtp other.xyz"), "above the bound"));
  session.write("beside.xyz", points + "200000 0 5\n");
  CHECK(contains(session.failure("verify p.mtp beside.xyz"), "not covered"));
  REQUIRE(session.run("fractal --size 5 -o t.asc").code == 0);
  CHECK(contains(session.failure("verify p.mtp t.asc"), "posts of the pack"));
  const std::string in_shards = "p.xyz: only packs of rasters have shards, and these are points";
  CHECK(contains(session.failure("plan p.xyz --tile-vertices 90"), in_shards));
  CHECK(contains(session.failure("encode p.xyz --tile-vertices 90 --shard 0:1 -o p.shard"),
                 in_shards));
  CHECK(contains(session.failure("encode p.xyz --tile-vertices 90 --tile-size 9 -o s.mtp"),
                 "p.xyz: --tile-size is for rasters, and these are points; leave it out"));
  CHECK(contains(session.failure("merge p.xyz -o m.mtp"), "p.xyz: "));
  session.write("line.xyz", "0 0 0\n1 1 3\n2 2 7\n");
  CHECK(contains(session.failure("encode line.xyz --tile-vertices 60 -o line.mtp"), "one line"));
}

TEST_CASE("cli: a grid that is written is a terrain again" * kSlow) {
  const Session session;
  REQUIRE(session.run("fractal --size 65 --seed 3 -o f.asc").code == 0);
  REQUIRE(session.run("encode f.asc --max-error 10 --z-step 4 -o f.mtin").code == 0);
  REQUIRE(session.run("decode f.mtin -o surface.asc").code == 0);
  // The grid has the exact planes' heights, rounded at the third decimal. verify compares them with
  // the device's answers, which are rounded to 1/65536 of a z step.
  const std::string verified = session.run("verify f.mtin surface.asc").out, key = "max_error: ";
  CHECK(std::stod(verified.substr(verified.find(key) + key.size())) <= 0.0005 + 4.0 / 131072);
  REQUIRE(session.run("encode f.asc -o exact.mtin").code == 0);
  REQUIRE(session.run("decode exact.mtin -o exact.asc").code == 0);
  CHECK(contains(session.run("verify exact.mtin exact.asc").out, "max_error: 0.0\n"));
  REQUIRE(session.run("encode exact.asc -o again.mtin").code == 0);
  CHECK(session.read("again.mtin") == session.read("exact.mtin"));
  REQUIRE(session.run("encode f.asc --max-error 10 --z-step 4 --tile-vertices 60 -o f.mtp").code ==
          0);
  REQUIRE(session.run("decode f.mtp -o pack.asc").code == 0);
  // Between these posts the surface may be farther from theirs than from that of its own source.
  const std::string of_pack = session.run("verify f.mtp pack.asc").out;
  CHECK(std::stod(of_pack.substr(of_pack.find(key) + key.size())) <= 0.0005 + 4.0 / 131072);
  REQUIRE(session.run("decode f.mtp --lattice --cell 16 -o coarse.asc").code == 0);
  CHECK(contains(session.read("coarse.asc"), "ncols 5\nnrows 5\nxllcenter 0\nyllcenter 0\n"));
  session.write("far.xyz", "0 0 1\n655.35 0 2\n0 655.35 3\n");
  REQUIRE(session.run("encode far.xyz -o far.mtin").code == 0);
  CHECK(session.failure("decode far.mtin -o far.asc") ==
        "far.asc: would take up to 30.1 GB; use --force to write it; use --cell or --extent for "
        "less\n");
  CHECK(session.run("decode far.mtin --cell 100 -o far.asc").code == 0);
  CHECK(contains(session.failure("decode far.mtin --cell 100 -o far.ply"), "only grids (.asc"));
}

TEST_CASE("cli: meshes for viewers") {
  const Session session;
  REQUIRE(session.run("fractal --size 65 --seed 3 -o f.asc").code == 0);
  for (const std::string options : {"-o f.mtin", "--tile-vertices 60 -o f.mtp"}) {
    REQUIRE(session.run("encode f.asc --max-error 10 " + options).code == 0);
    REQUIRE(session.run("decode " + options.substr(options.find("f.m")) + " -o f.glb").code == 0);
    CHECK(session.read("f.glb").substr(0, 4) == "glTF");
  }
}

TEST_CASE("cli: meshes are terrains, too, classes are for laser scans") {
  const Session session;
  session.write("p.xyz", "0 0 0\n9 0 3.5\n0 9 7\n5 5 5\n");
  REQUIRE(session.run("encode p.xyz -o p.mtin").code == 0);
  for (const std::string mesh : {"p.ply", "p.obj"}) {
    REQUIRE(session.run("decode p.mtin -o " + mesh).code == 0);
    REQUIRE(session.run("encode " + mesh + " -o again.mtin").code == 0);
    CHECK(session.read("again.mtin") == session.read("p.mtin"));
    CHECK(session.failure("encode " + mesh + " --classes 2 -o x.mtin") ==
          mesh + ": only .las and .laz files have classes\n");
  }
  session.write("a.las", "LASF");
  session.write("a.zip", "PK");
  CHECK(session.failure("encode a.las --classes all -o x.mtin").find("a.las: cut off") == 0);
  CHECK(session.failure("encode a.zip -o x.mtin").find("a.zip: is not a zip archive") == 0);
}

TEST_CASE("cli: date, lineage and water are noted in streams and packs") {
  const Session session;
  session.write("t.asc", kGrid);
  session.write("mask.asc",
                "ncols 4\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 2\n"
                "0 0 0 0\n0 0 0 1\n1 0 0 0\n");
  const std::string notes =
      " --date 2026-11-21 --source-name survey --lineage 'noise removed' --water-level 3.5 ";
  for (const std::string name : {"t.mtin", "t.mtp --tile-vertices 60"}) {
    const Session::Result encoded =
        session.run(std::string("encode t.asc --max-error 1").append(notes).append("-o ") + name);
    CHECK(encoded.code == 0);
    const std::string file = name.substr(0, name.find(' '));
    const std::string info = session.run("info " + file).out;
    for (const char* line : {"\nsource_name: \"survey\"\n", "\ndate: \"2026-11-21\"\n",
                             "\nlineage: \"noise removed\"\n", "\nwater_level: 3.5\n"}) {
      CHECK_MESSAGE(contains(info, line), info);
    }
    const std::string water = "verify " + file + " t.asc --water-level 3.5";
    CHECK(contains(session.run(water).out, "water_moved: 0"));
    CHECK(
        contains(session.failure("verify " + file + " t.asc"), "voids of the source have heights"));
    CHECK(session.failure("verify " + file + " t.asc --water-level 3") ==
          file + ": its water level is 3.5, not 3\n");
    CHECK(session.run("render " + file + " -o t.png --width 300").code == 0);
    CHECK(session.run("render " + file + " -o t.png --source t.asc --water-level 3.5").code == 0);
    CHECK(session.read("t.png").substr(1, 3) == "PNG");
  }
  CHECK(contains(session.run("encode t.asc --water-level 3 -o w.mtin").out,
                 "12 posts, 2 of the posts were void and are water"));
  const std::string masked = "t.asc --water-level 3 --water-mask mask.asc";
  CHECK(contains(session.run("encode " + masked + " -o m.mtin").out,
                 "11 posts, 1 void posts, 1 of the posts were void and are water"));
  CHECK(session.run("verify m.mtin " + masked).code == 0);
  CHECK(contains(session.run("encode " + masked + " --tile-vertices 60 -o m.mtp").out,
                 "source: 11 posts, 1 void posts, 1 of the posts were void and are water"));
  session.write("p.xyz", "0 0 0\n9 0 3\n0 9 7\n");
  session.write("high.asc",
                "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\nnodata_value -9\n"
                "1 2 999999999999 -9\n");
  for (const char* const output : {"p.mtin", "p.mtp --tile-vertices 60"}) {
    CHECK(session.failure("encode high.asc --water-level 0.000000001 -o " + std::string(output)) ==
          "high.asc: the water level has too many decimals for these heights; round it\n");
  }
  CHECK(session.failure("encode p.xyz --water-level 3 -o p.mtin") ==
        "p.xyz: --water-level is for rasters, and these are points\n");
  CHECK(session.failure("encode t.asc --water-level 3 --water-mask t.asc -o p.mtin") ==
        "t.asc: a water mask contains only 0 and 1\n");
  CHECK(session.failure("render t.mtin -o no.png --source none.asc") ==
        "none.asc: cannot be read: No such file or directory\n");
  CHECK(session.run("render t.mtp -o t.png --source p.xyz").code == 0);
}

TEST_CASE("cli: wrong usage has an exit code of its own") {
  const Session session;
  session.write("ok.xyz", "0 0 0\n9 0 3\n0 9 7\n");
  for (const char* arguments : {"frobnicate",
                                "encode",
                                "encode ok.xyz",
                                "encode ok.xyz -o o --max-degree 5",
                                "encode ok.xyz -o o --max-degree 33",
                                "encode ok.xyz -o o --coding slow",
                                "encode ok.xyz -o o --max-error -1",
                                "encode ok.xyz -o o --max-error x",
                                "encode ok.xyz -o o --max-error nan",
                                "encode ok.xyz -o o --max-vertices 2",
                                "encode ok.xyz -o o --epsg 1:x",
                                "encode ok.xyz -o o --max-error 1 --max-vertices 9",
                                "encode ok.xyz -o o --nonsense",
                                "encode ok.xyz -o o --never-below",
                                "encode ok.xyz -o o --max-error 1 --fast --best",
                                "encode ok.xyz -o o --max-error 1 --max-bytes 9",
                                "encode ok.xyz -o o --max-vertices 9 --max-bytes 9",
                                "encode ok.xyz -o o --max-vertices 9 --tile-vertices 99",
                                "encode ok.xyz -o o --tile-vertices 3",
                                "encode ok.xyz -o o --device-ram 2000",
                                "encode ok.xyz -o o --device-ram 65536 --tile-vertices 99",
                                "encode ok.xyz -o o --classes 2,",
                                "encode ok.xyz -o o --classes 256",
                                "encode ok.xyz -o o --classes ground",
                                "encode ok.xyz -o o --date 2026-02-30",
                                "encode ok.xyz -o o --water-level high",
                                "encode ok.xyz -o o --water-mask m.asc",
                                "fractal --size 8194 -o o.asc",
                                "render ok.mtin -o o --width 199",
                                "info",
                                "decode ok.xyz",
                                "decode ok.xyz -o o.asc --cell 0"}) {
    session.failure(arguments, 2);
  }
  const Session::Result help = session.run("encode --help");
  CHECK(help.code == 0);
  CHECK(contains(help.out, "--max-error"));
  CHECK(contains(help.out, std::to_string(MICROTIN_MAX_VERTICES_FOR(16))));
}

TEST_CASE("cli: help prints the pages of the program and of every command") {
  const Session session;
  CHECK(session.run("help").out == session.run("--help").out);
  for (const char* name : {"encode", "plan", "merge", "decode", "embed", "height", "info", "check",
                           "diff", "update", "verify", "fractal", "render", "help"}) {
    const std::string page = session.run(std::string("help ") + name).out;
    CHECK(contains(page, std::string("Usage: microtin ") + name));
    CHECK(page == session.run(std::string(name) + " --help").out);
  }
}

TEST_CASE("cli: wrong names get the nearest ones") {
  const Session session;
  const std::vector<std::pair<std::string, std::string>> wrong = {
      {"encode t.asc --max-eror 10 -o t.mtin",
       "unknown option --max-eror; did you mean --max-error?"},
      {"encode t.asc --max-eror=10", "unknown option --max-eror; did you mean --max-error?"},
      {"encode --fats t.asc --max-error x", "unknown option --fats; did you mean --fast?"},
      {"encode t.asc --unlike -o t.mtin", "unknown option --unlike; see \"microtin help encode\""},
      {"info -q t.mtin", "unknown option -q; see \"microtin help info\""},
      {"info t.mtin u.mtin", "unexpected argument u.mtin; see \"microtin help info\""},
      {"encode t.asc --max-error 1 --max-error 2 --max-error 3 -o t.mtin",
       "--max-error is given 3 times; give it once"},
      {"encode t.asc -o t.mtin -o u.mtin", "--output is given 2 times; give it once"},
      {"--verison", "unknown option --verison; did you mean --version?"},
      {"encdoe t.asc -o t.mtin", "unknown command encdoe; did you mean encode?"},
      {"frobnicate", "unknown command frobnicate; see \"microtin help\""},
      {"help rendre", "unknown command rendre; did you mean render?"},
      {"manul", "unknown command manul; see \"microtin help\""}};  // that one is hidden
  for (const auto& [words, message] : wrong) CHECK(session.failure(words, 2) == message + "\n");
}

TEST_CASE("cli: options name what they take") {
  const Session session;
  const std::string number = "a decimal number from 0 up",
                    epsg = "an EPSG code, or two with a colon, such as 25832 or 25832:7837",
                    tiles = "FROM:TO, such as 0:99", classes = "a list such as 2,9, or all";
  const auto refuses = [&](const std::string& option, const std::string& text,
                           const std::string& wanted) {
    CHECK(session.failure("encode ok.xyz -o o " + option + " '" + text + "'", 2) ==
          option + ": '" + text + "' is not allowed; use " + wanted + "\n");
  };
  for (const char* text : {"x", "nan", "-1", "1e99", ""}) refuses("--max-error", text, number);
  refuses("--z-step", "1,5", number);
  refuses("--water-level", "high", "a decimal number");
  for (const char* text : {"0", "x", "1:", ":1", "1:0", "1:2:3", "-1", "0x10", "4294967296", ""}) {
    refuses("--epsg", text, epsg);
  }
  for (const char* text : {"9", "3:2", "0:", ":9", "0:1:2", "0:-1", ""}) {
    refuses("--shard", text, tiles);
  }
  for (const char* text : {"2,", ",2", "2,,9", "256", "ground", "2 9", "all,2", ""}) {
    refuses("--classes", text, classes);
  }
  for (const char* text : {"2026-02-30", "26-1-1", "yesterday"}) {
    refuses("--date", text, "a date such as 2026, 2026-11 or 2026-11-21");
  }
  for (const char* text : {"5", "33", "x", "7.0", "-7", " 7", ""}) {
    refuses("--max-degree", text, "a whole number, 6 to 32");
  }
  refuses("--coding", "slow", "quick, balanced or dense");
}
