// SPDX-License-Identifier: MIT
// The command profile: reports, tables, pictures, exit codes; of streams and of packs.
#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/support/session.hpp"

using namespace microtin::tests;

namespace {

// A ridge of 50 m across a plain of 100 m by 1000 m.
void make_ridge(const Session& session) {
  session.write("ridge.xyz",
                "0 0 0\n0 100 0\n490 0 0\n490 100 0\n500 0 50\n500 100 50\n510 0 0\n510 100 0\n"
                "1000 0 0\n1000 100 0\n");
  REQUIRE(session.run("encode ridge.xyz --units metre --z-step 1 --xy-step 1 -o ridge.mtin").code ==
          0);
}

nlohmann::json report(const Session& session, const std::string& words) {
  const Session::Result result = session.run("profile " + words + " --json");
  CHECK_MESSAGE(result.err.empty(), result.err);
  return nlohmann::json::parse(result.out);
}

}  // namespace

TEST_CASE("profile: the places of a ridge, as text and as JSON") {
  const Session session;
  make_ridge(session);
  const nlohmann::json found = report(session, "ridge.mtin 0 0 1000 0");
  CHECK(found["length"] == 1000);
  CHECK(found["without_heights"] == "none");
  CHECK(found["height_unit"] == "metre");
  CHECK(found["highest"] == 50);
  CHECK(found["highest_at"] == 500);
  CHECK(found["lowest"] == 0);
  CHECK(found.count("line_of_sight") == 0);
  REQUIRE(found["places"].size() == 5);
  CHECK(found["places"][2] ==
        nlohmann::json(
            {{"distance", 500}, {"x", 500}, {"y", 0}, {"height", 50}, {"known_before", true}}));
  const std::string text = session.run("profile ridge.mtin 0 0 1000 0 --samples 3").out;
  CHECK(contains(text, "length: 1000\n"));
  CHECK(contains(text, "places: 3\n"));
}

TEST_CASE("profile: two masts see each other over the ridge, or do not") {
  const Session session;
  make_ridge(session);
  const std::string line = "ridge.mtin 0 0 1000 0 --earth-factor flat ";
  nlohmann::json found = report(session, line + "--from-height 49 --to-height 49");
  CHECK(found["line_of_sight"] == "blocked");
  CHECK(found["least_clearance"] == -1);
  CHECK(found["least_clearance_at"] == 500);
  CHECK(found["first_obstruction_at"].get<double>() == doctest::Approx(499.8).epsilon(1e-4));
  CHECK(session.run("profile " + line + "--from-height 49").code == 0);
  found = report(session, line + "--from-altitude 55 --to-altitude 57 --frequency 868");
  CHECK(found["line_of_sight"] == "clear");
  CHECK(found["least_clearance"] == 6);
  // The first zone has a radius of 9.29 m in the middle.
  CHECK(found["fresnel_zone"] == "clear");
  CHECK(found["free_percent"].get<double>() == doctest::Approx(64.6).epsilon(0.002));
  found = report(session, line +
                              "--from-altitude 55 --to-altitude 57 --frequency 868 "
                              "--zone-share 70");
  CHECK(found["line_of_sight"] == "clear");
  CHECK(found["fresnel_zone"] == "blocked");
  CHECK(
      report(session, "ridge.mtin 0 0 1000 0 --from-height 60 --earth-factor 1")["earth_radius"] ==
      6371009);
  CHECK(contains(session.failure("profile " + line + "--from-height 60 --safe"),
                 "ridge.mtin: the surface does not state"));
}

TEST_CASE("profile: a part without heights is never clear, and has an exit code") {
  const Session session;
  make_ridge(session);
  const std::string words = "profile ridge.mtin 0 50 1200 50 --from-height 99 --to-altitude 99";
  const Session::Result outside = session.run(words);
  CHECK(outside.code == 5);
  CHECK(contains(outside.out, "line_of_sight: unknown\n"));
  CHECK(contains(outside.out, "without_heights: outside\n"));
  CHECK(contains(session.run("profile ridge.mtin 0 50 1200 50 --from-height 1 --to-altitude 9").out,
                 "line_of_sight: blocked\n"));
  REQUIRE(session.run("fractal --size 65 -o t.asc").code == 0);
  REQUIRE(session.run("encode t.asc --max-error 10 --tile-vertices 60 -o t.mtp").code == 0);
  std::string bytes = session.read("t.mtp");
  CHECK(session.run("profile t.mtp 0 1900 1900 1900").code == 0);
  bytes[bytes.size() - 20] = static_cast<char>(~bytes[bytes.size() - 20]);
  session.write("bad.mtp", bytes);
  const Session::Result bad = session.run(
      "profile bad.mtp 0 1900 1900 1900 --from-altitude 9999 "
      "--to-altitude 9999");
  CHECK(bad.code == 7);
  CHECK(contains(bad.out, "without_heights: damaged\n"));
  CHECK(contains(bad.out, "line_of_sight: unknown\n"));
  session.write("cut.mtin", session.read("ridge.mtin").substr(0, 60));
  CHECK(session.run("profile cut.mtin 0 0 1 1").code == 7);
}

TEST_CASE("profile: a table and pictures are files, and the report is printed") {
  const Session session;
  make_ridge(session);
  const std::string words =
      "profile ridge.mtin 0 50 1200 50 --from-height 60 --to-altitude 60 "
      "--frequency 868 ";
  const Session::Result table = session.run(words + "--samples 5 -o o.csv");
  CHECK(contains(table.out, "places: 5\n"));
  std::istringstream lines(session.read("o.csv"));
  std::string line;
  REQUIRE(std::getline(lines, line));
  CHECK(line == "distance,x,y,height,known_before,ray,bulge,fresnel_radius");
  REQUIRE(std::getline(lines, line));
  CHECK(line == "0,0,50,0,0,60,0,0");
  for (int i = 0; i < 4; ++i) REQUIRE(std::getline(lines, line));
  CHECK(line == "1200,1200,50,,0,60,0,0");
  CHECK(session.run(words + "-o -").out.rfind("distance,", 0) == 0);
  CHECK(session.run(words + "-o o.svg").code == 5);
  CHECK(contains(session.read("o.svg"), "<svg "));
  CHECK(session.run(words + "-o o.png").code == 5);
  CHECK(session.read("o.png").substr(1, 3) == "PNG");
  CHECK(contains(session.failure(words + "-o o.txt"), "name it .csv, .png or .svg"));
  CHECK(contains(session.failure("profile ridge.mtin 0 0 a 0", 2), "'a 0' is not allowed"));
  CHECK(contains(session.failure("profile ridge.mtin 0 0 9 0 --earth-factor 0", 2), "4/3"));
  CHECK(contains(session.failure("profile ridge.mtin 0 0 9 1e13"), "not a number near"));
}
