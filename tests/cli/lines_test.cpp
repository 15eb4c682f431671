// SPDX-License-Identifier: MIT
// Marks of lines on the command line: encode writes them, info counts them, decode and render show
// them.
#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "microtin/encoder.h"
#include "microtin/surface.hpp"
#include "tests/support/session.hpp"

using namespace microtin::tests;

// A namespace of its own: sources of a folder may be compiled as one.
namespace microtin::lines_test {
namespace {

constexpr const char* kLines = R"({"type": "FeatureCollection", "features": [
{"type": "Feature", "properties": {"class": "ridge"}, "geometry":
  {"type": "LineString", "coordinates": [[2, 3], [30, 30]]}},
{"type": "Feature", "properties": {"class": "Water"}, "geometry":
  {"type": "LineString", "coordinates": [[3, 30], [20, 12], [29, 4]]}},
{"type": "Feature", "properties": {}, "geometry":
  {"type": "LineString", "coordinates": [[5, 5], [5, 25]]}}]})";

void expect_run(const Session& session, const std::string& command) {
  const auto ran = session.run(command);
  CHECK_MESSAGE(ran.code == 0, command << ": " << ran.err);
}

// Writes a terrain, t.asc, and a stream of it with these lines, t.mtin.
void make_files(const Session& session) {
  expect_run(session, "fractal --size 33 --seed 4 -o t.asc");
  // Posts one unit apart, from 0 on.
  std::string terrain = session.read("t.asc");
  const size_t cell = terrain.find("cellsize");
  terrain.replace(cell, terrain.find('\n', cell) - cell, "cellsize 1");
  session.write("t.asc", terrain);
  session.write("l.geojson", kLines);
  expect_run(session, "encode t.asc --units metre --max-error 20 --breaklines l.geojson -o t.mtin");
}

nlohmann::json json_of(const Session& session, const std::string& command) {
  return nlohmann::json::parse(session.run(command).out);
}

}  // namespace

TEST_CASE("lines: info counts them and their classes") {
  const Session session;
  make_files(session);
  const nlohmann::json lines = json_of(session, "info --json t.mtin")["lines"];
  // Where a line is crossed, it goes on.
  CHECK(lines["lines"] == 3);
  CHECK(lines["edges"].get<int>() >= 4);
  CHECK(lines["bytes"].get<int>() > 8);
  CHECK(lines["classes"] == nlohmann::json{{"other", 1}, {"ridge", 1}, {"water", 1}});
  expect_run(session, "encode t.asc --units metre --max-error 20 -o plain.mtin");
  CHECK(json_of(session, "info --json plain.mtin").count("lines") == 0);
}

TEST_CASE("lines: decode writes them with their classes and heights, and encode reads them again") {
  const Session session;
  make_files(session);
  expect_run(session, "decode t.mtin -o out.geojson");
  const nlohmann::json out = nlohmann::json::parse(session.read("out.geojson"));
  std::vector<std::string> classes;
  for (const nlohmann::json& feature : out["features"]) {
    classes.push_back(feature["properties"]["class"]);
    const nlohmann::json& places = feature["geometry"]["coordinates"];
    CHECK(feature["geometry"]["type"] == "LineString");
    REQUIRE(places.size() >= 2);
    for (const nlohmann::json& place : places) REQUIRE(place.size() == 3);
    // Heights are those of the surface.
    const std::string x = places[0][0].dump(), y = places[0][1].dump();
    std::string command = "height t.mtin ";
    command.append(x).append(" ").append(y);
    const std::string height = session.run(command).out;
    CHECK(std::stod(height) == doctest::Approx(places[0][2].get<double>()));
  }
  CHECK(classes.size() == 3);
  expect_run(session, "verify t.mtin t.asc --units metre --breaklines out.geojson");
  expect_run(session,
             "encode t.asc --units metre --max-error 20 --breaklines out.geojson -o again.mtin");
  const auto counts = [&](const std::string& file) {
    return json_of(session, "info --json " + file)["lines"]["classes"];
  };
  CHECK(counts("again.mtin") == counts("t.mtin"));
  expect_run(session, "decode t.mtin --lattice -o lattice.geojson");
  CHECK(nlohmann::json::parse(session.read("lattice.geojson"))["features"].size() == 3);
}

TEST_CASE("lines: C++ and C return those that decode writes") {
  const Session session;
  make_files(session);
  expect_run(session, "decode t.mtin -o out.geojson");
  const nlohmann::json out = nlohmann::json::parse(session.read("out.geojson"));
  const std::string path = session.folder() + "/t.mtin";
  const std::vector<encoder::Line> lines = encoder::Surface::from_file(path).lines();
  microtin_surface* surface = nullptr;
  REQUIRE(microtin_surface_from_file(path.c_str(), &surface) == MICROTIN_STATUS_OK);
  microtin_lines in_c{};
  in_c.size = sizeof in_c;
  for (int twice = 0; twice < 2; ++twice) {
    REQUIRE(microtin_surface_lines(surface, &in_c) == MICROTIN_STATUS_OK);
  }
  REQUIRE(lines.size() == out["features"].size());
  REQUIRE(in_c.count == lines.size());
  const double* at = in_c.coordinates;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const nlohmann::json& feature = out["features"][i];
    CHECK(lines[i].line_class == feature["properties"]["class"].get<std::string>());
    CHECK(lines[i].line_class == in_c.classes[i]);
    CHECK(lines[i].vertices ==
          feature["geometry"]["coordinates"].get<std::vector<std::array<double, 3>>>());
    REQUIRE(in_c.vertices[i] == lines[i].vertices.size());
    for (const std::array<double, 3>& vertex : lines[i].vertices) {
      CHECK(std::equal(vertex.begin(), vertex.end(), at));
      at += 3;
    }
  }
  microtin_surface_free(surface);
  CHECK(microtin_surface_lines(nullptr, &in_c) == MICROTIN_STATUS_REJECTED);
}

TEST_CASE("lines: decode refuses a file without lines, and a pack") {
  const Session session;
  make_files(session);
  expect_run(session, "encode t.asc --units metre --max-error 20 -o plain.mtin");
  expect_run(session, "encode t.asc --units metre --max-error 20 -o t.mtp");
  CHECK(contains(session.failure("decode plain.mtin -o o.geojson"), "has no lines"));
  CHECK(contains(session.failure("decode t.mtp -o o.geojson"), "is a pack"));
  CHECK(contains(session.failure("decode t.mtin --cell 2 -o o.geojson"), "have cells"));
}

TEST_CASE("lines: render draws them in the colours of their classes") {
  const Session session;
  make_files(session);
  expect_run(session, "render t.mtin -o lines.svg");
  const std::string svg = session.read("lines.svg");
  CHECK(contains(svg, "stroke=\"#1254b8\""));  // water
  CHECK(contains(svg, "stroke=\"#6e3d1a\""));  // a ridge
  CHECK(contains(svg, "stroke=\"#c71414\""));  // another line
  expect_run(session, "render t.mtin -o lines.png");
  expect_run(session, "encode t.asc --units metre --max-error 20 -o plain.mtin");
  expect_run(session, "render plain.mtin -o plain.svg");
  CHECK(!contains(session.read("plain.svg"), "#1254b8"));
}

TEST_CASE("lines: a text has a column of classes, and other words are refused") {
  const Session session;
  make_files(session);
  session.write("l.csv",
                "x,y,class\n2,3,ridge\n30,30,ridge\n3,30,water\n20,12,WATER\n29,4,water\n"
                "5,5,\n5,25,\n");
  expect_run(session, "encode t.asc --units metre --max-error 20 --breaklines l.csv -o c.mtin");
  CHECK(session.read("c.mtin") == session.read("t.mtin"));
  const auto refusal = [&](const std::string& name, const std::string& text) {
    session.write(name, text);
    return session.failure("encode t.asc --units metre --max-error 20 -o o.mtin --breaklines " +
                           name);
  };
  CHECK(contains(refusal("w.csv", "x,y,class\n2,3,ridges\n9,9,ridges\n"),
                 "w.csv:2: 'ridges' is not a class of lines; use one of other, ridge, valley"));
  std::string wrong = kLines;
  wrong.replace(wrong.find("Water"), 5, "lake");
  CHECK(contains(refusal("w.geojson", wrong), "w.geojson:4: 'lake' is not a class of lines"));
}

}  // namespace microtin::lines_test
