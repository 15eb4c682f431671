// SPDX-License-Identifier: MIT
// Points off the lattice, points that meet, and how both are told.
#include <doctest/doctest.h>

#include <cstdint>
#include <cstdlib>
#include <string>

#include "tests/support/session.hpp"
#include "tests/support/slow.hpp"

using namespace microtin::tests;

namespace {

// "1.205" for 1205.
std::string in_thousands(int64_t number) {
  return std::to_string(number / 1000) + "." + std::to_string(1000 + number % 1000).substr(1);
}

// A slope of points with more decimals than 16 bits hold, in a straight frame.
std::string slope() {
  std::string text;
  for (int64_t i = 0; i < 400; ++i) {
    const int64_t column = i % 20, row = i / 20;
    const bool is_rim = column == 0 || column == 19 || row == 0 || row == 19;
    const int64_t x = column * 5000003 + (is_rim ? 0 : i * i * 7919 % 900001);
    const int64_t y = row * 4900007 + (is_rim ? 0 : i * 7907 % 800011);
    text += in_thousands(x) + " " + in_thousands(y) + " " + std::to_string(x / 20000) + "." +
            std::to_string(i * i % 10) + "\n";
  }
  return text;
}

// A ridge between 0 and 1000 in x and y, with points a centimetre within the cut in the south.
std::string cut_ridge() {
  const auto height = [](int64_t x) { return in_thousands(200000 - 400 * std::abs(x - 500)); };
  std::string text = "0 0 0\n1000 0 0\n0 1000 0\n1000 1000 0\n";
  for (int64_t i = 1; i < 400; ++i) {
    const int64_t x = i * 7919 % 997 + 1, y = i * 104729 % 991 + 1;
    text += std::to_string(x) + " " + std::to_string(y) + " " + height(x) + "\n";
  }
  for (int64_t x = 25; x < 1000; x += 25)
    text += std::to_string(x) + ".01 0.01 " + height(x) + "\n";
  return text;
}

double number_behind(const std::string& text, const std::string& name) {
  const size_t at = text.find(name);
  return at == std::string::npos ? -1 : std::stod(text.substr(at + name.size()));
}

}  // namespace

TEST_CASE("points: the bound holds where they truly lie, or on the lattice alone") {
  const Session session;
  session.write("p.xyz", slope());
  const std::string truly = "... where the points truly lie: at most ";
  const std::string lattice =
      session.run("encode p.xyz --max-error 0.5 --bound-at lattice -o lattice.mtin").out;
  CHECK(number_behind(lattice, truly) > 0.5);
  const std::string points = session.run("encode p.xyz --max-error 0.5 -o points.mtin").out;
  CHECK(number_behind(points, truly) > 0);
  CHECK(number_behind(points, truly) <= 0.5);
  CHECK(contains(points, "(the bound holds there, too); below the points: at most "));
  CHECK(contains(session.run("info points.mtin").out, "true_places: {\"bound\": 0.5, "));
  CHECK(contains(session.run("info lattice.mtin").out, "true_places: {\"bound\": null, "));
  const Session::Result verified = session.run("verify points.mtin p.xyz");
  CHECK(verified.code == 0);
  CHECK(contains(verified.out, "points: 400\n"));
  CHECK(!contains(verified.out, "voids"));
  CHECK(contains(verified.out, "true_places: {\"bound\": 0.5, "));
  CHECK(session.run("verify lattice.mtin p.xyz").code == 0);
}

TEST_CASE("points: verify judges whether the surface is below them, where they truly lie, too") {
  const Session session;
  session.write("p.xyz", slope());
  const std::string command = "encode p.xyz --max-error 2 --never-below ";
  REQUIRE(session.run(command + "-o points.mtin").code == 0);
  CHECK(session.run("verify points.mtin p.xyz --never-below").code == 0);
  CHECK(session.run("verify points.mtin p.xyz --never-below --json")
            .out.find("\"max_below\": 0.0,") != std::string::npos);
  REQUIRE(
      session.run("encode p.xyz --max-error 0.5 --never-below --bound-at lattice -o lattice.mtin")
          .code == 0);
  CHECK(session.run("verify lattice.mtin p.xyz --never-below").code == 0);
  REQUIRE(session.run("encode p.xyz --max-error 2 -o both.mtin").code == 0);
  CHECK(session.run("verify both.mtin p.xyz").code == 0);
  CHECK(contains(session.failure("verify both.mtin p.xyz --never-below"),
                 "both.mtin: the surface is below the source, by 1."));

  session.write("q.xyz", "0 0 0\n100 0 100\n0 100 0\n100 100 100\n49.9 50 50\n");
  REQUIRE(session.run("encode q.xyz --max-error 1 --never-below --xy-step 1 -o q.mtin").code == 0);
  session.write("moved.xyz", "0 0 0\n100 0 100\n0 100 0\n100 100 100\n50.4 50 50\n50.6 50 51.4\n");
  for (const char* const words : {"", " --never-below"}) {  // the header states it
    CHECK(contains(session.failure(std::string("verify q.mtin moved.xyz") + words),
                   "the surface is below the source, by "));
  }
}

TEST_CASE("points: those of a raster are recognised, and taken as it on request" * kSlow) {
  const Session session;
  REQUIRE(session.run("fractal --size 65 --seed 3 -o f.asc").code == 0);
  REQUIRE(session.run("encode f.asc -o all.mtin && microtin decode all.mtin -o f.xyz").code == 0);
  const Session::Result points = session.run("encode f.xyz --max-error 5 --fast -o points.mtin");
  CHECK(contains(points.err, "warning: f.xyz: the points are the posts of a raster, 65 x 65;"));
  const Session::Result raster =
      session.run("encode f.xyz --gridded --max-error 5 --fast -o raster.mtin");
  CHECK(raster.code == 0);
  CHECK(raster.err.empty());
  CHECK(contains(raster.out, "source: 4225 posts"));
  CHECK(10 * session.read("raster.mtin").size() < 9 * session.read("points.mtin").size());
  CHECK(session.run("verify raster.mtin f.xyz --gridded").code == 0);
  CHECK(session.run("render raster.mtin --source f.xyz --gridded -o f.png").code == 0);
  REQUIRE(session.run("encode f.xyz --gridded --max-error 5 --fast -o raster.mtp").code == 0);
  CHECK(session.run("verify raster.mtp f.xyz --gridded").code == 0);
  session.write("p.xyz", slope());
  CHECK(contains(session.failure("encode p.xyz --gridded -o p.mtin"), "leave out --gridded"));
}

TEST_CASE("points: the bound holds in slivers along the hull, too") {
  const Session session;
  session.write("p.xyz", cut_ridge());
  const std::string report = session.run("encode p.xyz --max-error 1 -o p.mtin").out;
  CHECK(contains(report, "step of x and y: 0.02,"));
  CHECK(!contains(report, "merged"));  // what is added beside the points does not count
  const Session::Result verified = session.run("verify p.mtin p.xyz");
  CHECK(verified.code == 0);
  CHECK(contains(verified.out, "points: 442\n"));
  CHECK(contains(verified.out, "true_places: {\"bound\": 1.0, "));
}

TEST_CASE("points: one that is right on the lattice alone fails where it truly lies") {
  const Session session;
  session.write("p.xyz", "0 0 0\n100 0 100\n0 100 0\n100 100 100\n49.9 50 50\n");
  REQUIRE(session.run("encode p.xyz --max-error 1 --xy-step 1 -o p.mtin").code == 0);
  session.write("moved.xyz", "0 0 0\n100 0 100\n0 100 0\n100 100 100\n50.4 50 49.1\n");
  CHECK(contains(session.failure("verify p.mtin moved.xyz"), "where the points truly lie"));
}

TEST_CASE("points: a lattice that is too coarse is named, with what is fine enough" * kSlow) {
  const Session session;
  session.write("p.xyz", slope());
  CHECK(contains(session.failure("encode p.xyz --max-error 0.5 --xy-step 500 -o p.mtin"),
                 ": --xy-step 500 is too coarse; leave it out, or use --bound-at lattice"));
  // Left out, it would be as coarse.
  session.write("wide.xyz",
                "0 0 0\n1000 0 0\n0 1000 0\n1000 1000 0\n500.01 400.01 9\n500.03 400.01 0\n");
  CHECK(contains(
      session.failure("encode wide.xyz --max-error 0.1 --xy-step 0.02 -o p.mtin"),
      ": --xy-step 0.02 is too coarse, and 16 bits hold no finer one; make a pack (.mtp)"));
  // Left out, more tiles are needed than there can be: a step is named that does.
  const std::string pack = "encode p.xyz --max-error 0.5 --tile-vertices 500 -o p.mtp --xy-step ";
  CHECK(contains(session.failure(pack + "500"),
                 ": --xy-step 500 is too coarse; use 5, or use --bound-at lattice"));
  CHECK(session.run(pack + "5").code == 0);
  REQUIRE(session
              .run("encode p.xyz --max-error 0.5 --xy-step 500 --bound-at lattice --tile-vertices "
                   "500 -o coarse.mtp")
              .code == 0);
  CHECK(contains(session.run("info coarse.mtp").out, "true_places: {\"bound\": null"));
}

TEST_CASE("points: those outside the terrain are not covered, at any distance") {
  const Session session;
  session.write("p.xyz", slope());
  REQUIRE(session.run("encode p.xyz --max-error 0.5 --xy-step 5 -o p.mtin").code == 0);
  REQUIRE(
      session.run("encode p.xyz --max-error 0.5 --xy-step 5 --tile-vertices 99 -o p.mtp").code ==
      0);
  for (const char* place : {"-9000 50000", "50000 -90", "99000000 50000", "50000 123456789012",
                            "83886080 50000"}) {  // 2^24 steps
    session.write("more.xyz", slope() + place + " 3\n");
    for (const char* file : {"p.mtin", "p.mtp"}) {
      CHECK_MESSAGE(contains(session.failure(std::string("verify ") + file + " more.xyz"),
                             "1 of 401 heights of the source are not covered"),
                    place);
    }
  }
}

TEST_CASE("points: fine decimals over a large area are told a step that works, at each turn" *
          kSlow) {
  const Session session;
  std::string rough = "50000.9 50000 0\n50001.1 50000 3\n";  // steeper than a coarse lattice holds
  for (uint32_t i = 1; i <= 300; ++i) {  // millimetres over 100 km, up to 1500 m high
    const uint32_t x = i * 2654435761u, y = x * 1597334677u, z = y * 3812015801u;
    rough += std::to_string(x % 100000000 / 1000.0) + ' ' + std::to_string(y % 100000000 / 1000.0) +
             ' ' + std::to_string(z % 1500) + '\n';
  }
  session.write("p.xyz", rough);
  const auto step_behind = [](const std::string& text, const std::string& words) {
    REQUIRE(contains(text, words));
    const std::string rest = text.substr(text.find(words) + words.size());
    return rest.substr(0, rest.find_first_not_of(".0123456789"));
  };
  const std::string encode = "encode p.xyz --max-error 0.1 -o ";
  const std::string stream = session.failure(encode + "p.mtin");
  const std::string coarse = step_behind(stream, "make a pack (.mtp) with --xy-step ");
  CHECK(contains(session.failure(encode + "p.mtp --tile-vertices 300"),
                 "; use " + coarse + " or more"));
  std::string pack = encode + "p.mtp --tile-vertices 300 --xy-step ";
  const std::string finer = step_behind(session.failure(pack + coarse), "too coarse; use ");
  CHECK(session.run(pack + finer).code == 0);
  CHECK(session.run("verify p.mtp p.xyz").code == 0);
  CHECK(contains(session.failure("encode p.xyz --xy-step 0.5 -o p.mtin"),
                 "--xy-step 0.5 is too fine: 16 bits do not hold the source's range in such steps; "
                 "use 2 or more"));
}

TEST_CASE("points: one of those that meet stands for all, and verify knows which") {
  const Session session;
  session.write("p.xyz", "0 0 0\n9 0 0\n0 9 0\n9 9 0\n5 5 1\n5 5 4\n5 5 7\n");
  CHECK(contains(session.failure("encode p.xyz --max-error 1 -o p.mtin"), "--duplicates"));
  for (const auto& [rule, height] :
       {std::pair<std::string, std::string>{"lowest", "1"}, {"highest", "7"}, {"mean", "4"}}) {
    for (const std::string name : {"p.mtin", "p.mtp --tile-vertices 90"}) {
      std::string words = "encode p.xyz --duplicates ";
      words.append(rule).append(" -o ").append(name);
      const std::string out = session.run(words).out;
      CHECK(
          contains(out, "merged: 2 shared a place with another; the " + rule + " stands for all"));
      const std::string file = name.substr(0, name.find(' '));
      CHECK(session.run("verify " + file + " p.xyz").code == 0);
      CHECK(contains(session.run("info " + file).out, "duplicates: \"" + rule + "\""));
      REQUIRE(session.run("decode " + file + " -o p.xyz.out.xyz").code == 0);
      CHECK(contains(session.read("p.xyz.out.xyz"), "5 5 " + height + "\n"));
    }
  }
  CHECK(contains(session.failure("encode p.xyz --duplicates any -o p.mtin", 2),
                 "'any' is not allowed; use middle, lowest, highest or mean"));
}

TEST_CASE("points: latitude before longitude is refused if the system is in degrees") {
  const Session session;
  session.write("swap.xyz", "47.1 158.2 3\n47.2 158.2 4\n47.1 158.3 6\n");
  for (const std::string name : {"p.mtin", "p.mtp"}) {
    CHECK(session.failure("encode swap.xyz --epsg 4326:5773 -o " + name) ==
          "swap.xyz: point 1, at x 47.1, y 158.2: latitude 158.2 is beyond 90 degrees: x is the "
          "longitude and y the latitude; exchange them, or give the coordinate system that they "
          "are in\n");
  }
  session.write("swap.asc",
                "ncols 2\nnrows 2\nxllcenter 47\nyllcenter 158\ncellsize 0.5\n1 2\n3 4\n");
  for (const std::string name : {"p.mtin", "p.mtp", "p.shard --shard 0:0 --tile-vertices 90"}) {
    CHECK(contains(session.failure("encode swap.asc --units degree:metre -o " + name),
                   "swap.asc: row 1 from the south: latitude 158 is beyond 90 degrees"));
  }
}
