// SPDX-License-Identifier: MIT
// Surfaces over obstacles: nowhere below the terrain or an obstacle, looked at in dense samples.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "microtin/surface.hpp"
#include "tests/support/files.hpp"
#include "tests/support/join.hpp"
#include "tests/support/session.hpp"

using namespace microtin::tests;
namespace library = microtin::encoder;

// A namespace of its own: sources of a folder may be compiled as one.
namespace microtin::obstacles_test {
namespace {

constexpr double kNoTop = std::numeric_limits<double>::quiet_NaN();
constexpr int kSide = 51;  // posts, 10 apart, from 0 on

int ground(int column, int row) {
  return static_cast<int>(std::lround(150 + 40 * std::sin(column * 0.17) * std::cos(row * 0.13)));
}

bool has_no_ground(int column, int row) {
  return column >= 40 && column <= 43 && row >= 40 && row <= 43;
}

void write_ground(const Session& session) {
  std::string text = join({"ncols ", std::to_string(kSide), "\nnrows ", std::to_string(kSide),
                           "\nxllcenter 0\nyllcenter 0\ncellsize 10\nnodata_value -9\n"});
  for (int row = kSide - 1; row >= 0; --row) {
    for (int column = 0; column < kSide; ++column) {
      text += std::to_string(has_no_ground(column, row) ? -9 : ground(column, row));
      text += column + 1 < kSide ? ' ' : '\n';
    }
  }
  session.write("t.asc", text);
}

double ground_at(double x, double y) {
  const int column = std::min(static_cast<int>(x / 10), kSide - 2),
            row = std::min(static_cast<int>(y / 10), kSide - 2);
  const double u = x / 10 - column, v = y / 10 - row;
  return (ground(column, row) * (1 - u) + ground(column + 1, row) * u) * (1 - v) +
         (ground(column, row + 1) * (1 - u) + ground(column + 1, row + 1) * u) * v;
}

std::string feature(const std::string& properties, const std::string& geometry) {
  return join(
      {R"({"type": "Feature", "properties": {)", properties, R"(}, "geometry": )", geometry, "}"});
}

std::string collection(std::initializer_list<std::string> features) {
  std::string all;
  for (const std::string& one : features) all += (all.empty() ? "" : ",") + one;
  return R"({"type": "FeatureCollection", "features": [)" + all + "]}";
}

constexpr const char* kTower = R"({"type": "Point", "coordinates": [123.4, 231.7]})";
constexpr const char* kOnPost = R"({"type": "Point", "coordinates": [300, 100]})";
constexpr const char* kOnSlope = R"({"type": "Point", "coordinates": [150, 80]})";
constexpr const char* kAtRim = R"({"type": "Point", "coordinates": [0, 498]})";
constexpr const char* kInVoid = R"({"type": "Point", "coordinates": [415, 415]})";
constexpr const char* kFarAway = R"({"type": "Point", "coordinates": [9000, 415]})";
constexpr const char* kLine =
    R"({"type": "LineString", "coordinates": [[20, 20], [260, 61], [470, 330]]})";
constexpr const char* kBuilding =
    R"({"type": "Polygon", "coordinates": [[[331, 432], [352, 432], [352, 446], [331, 432]]]})";

using Footprint = std::function<bool(double x, double y)>;
using Top = std::function<double(double x, double y)>;  // not a number: no obstacle is there

struct Found {
  double lowest_over = 1e9;       // above the top
  double lowest_elsewhere = 1e9;  // above the ground
  double highest_far = -1e9;      // above the ground, 50 and more from it along an axis
};

Found look(const std::string& file, const Top& top, const Footprint& is_near) {
  const library::Surface surface = library::Surface::from_file(file);
  Found found;
  std::vector<double> ys;
  for (double y = 0; y <= 10 * (kSide - 1); y += 1.25) ys.push_back(y);
  std::vector<double> heights(ys.size());
  for (double x = 0; x <= 10 * (kSide - 1); x += 1.25) {
    const std::vector<double> xs(ys.size(), x);
    surface.heights(ys.size(), xs.data(), ys.data(), heights.data());
    for (std::size_t i = 0; i < ys.size(); ++i) {
      const double y = ys[i], z = heights[i];
      if (x >= 390 && x <= 440 && y >= 390 && y <= 440) continue;  // next to the void
      REQUIRE_FALSE(std::isnan(z));
      const double over = z - top(x, y);
      if (!std::isnan(over)) found.lowest_over = std::min(found.lowest_over, over);
      found.lowest_elsewhere = std::min(found.lowest_elsewhere, z - ground_at(x, y));
      if (!is_near(x, y)) found.highest_far = std::max(found.highest_far, z - ground_at(x, y));
    }
  }
  return found;
}

Footprint within(double x, double y, double radius) {
  return [=](double u, double v) { return std::hypot(u - x, v - y) <= radius; };
}

double distance_to(double x, double y, double from_x, double from_y, double to_x, double to_y) {
  const double along_x = to_x - from_x, along_y = to_y - from_y;
  const double part = std::clamp(
      ((x - from_x) * along_x + (y - from_y) * along_y) / (along_x * along_x + along_y * along_y),
      0.0, 1.0);
  return std::hypot(x - from_x - part * along_x, y - from_y - part * along_y);
}

std::string encode(const Session& session, const std::string& obstacles,
                   const std::string& options = "", const std::string& output = "o.mtin") {
  session.write("o.geojson", obstacles);
  const Session::Result made = session.run(join(
      {"encode t.asc --units metre --max-error 4 --obstacles o.geojson -o ", output, options}));
  REQUIRE_MESSAGE(made.code == 0, made.err);
  const Session::Result verified = session.run(
      join({"verify ", output, " t.asc --units metre --obstacles o.geojson --never-below"}));
  CHECK_MESSAGE(verified.code == 0, verified.err);
  return made.out;
}

constexpr double kRounding = 1e-6;

}  // namespace

TEST_CASE(
    "obstacles: a tower is there in all of its radius, and the ground is as before away from it") {
  const Session session;
  write_ground(session);
  struct Tower {
    const char* geometry;
    double x, y, radius;
  };
  struct Way {
    const char *output, *options;
  };
  for (const Tower& tower : {Tower{kTower, 123.4, 231.7, 0}, Tower{kTower, 123.4, 231.7, 17},
                             Tower{kOnPost, 300, 100, 0}, Tower{kAtRim, 0, 498, 3}}) {
    for (const Way& way :
         {Way{"o.mtin", ""}, Way{"o.mtin", " --fast"}, Way{"o.mtin", " --z-step 0.5"},
          Way{"o.mtp", " --tile-size 10"}, Way{"o.mtp", " --tile-size 23 --fast"}}) {
      const std::string file = session.folder() + "/" + way.output;
      encode(
          session,
          collection({feature(join({R"("top": 301.5, "radius": )", std::to_string(tower.radius)}),
                              tower.geometry)}),
          way.options, way.output);
      const Footprint covers = within(tower.x, tower.y, tower.radius + 1.3);
      const Top top = [&](double x, double y) { return covers(x, y) ? 301.5 : kNoTop; };
      const Found found = look(file, top, within(tower.x, tower.y, tower.radius + 64));
      CHECK(found.lowest_over >= -kRounding);
      CHECK(found.lowest_over < 7.5);  // not higher than the bound and a little
      CHECK(found.lowest_elsewhere >= -kRounding);
      CHECK(found.highest_far <= 4 + kRounding);
    }
  }
}

TEST_CASE("obstacles: a tower on a slope stands on the highest ground that it touches") {
  const Session session;
  write_ground(session);
  const Footprint covers = within(150, 80, 30);
  double highest = 0;
  for (double x = 120; x <= 180; ++x) {
    for (double y = 50; y <= 110; ++y) {
      if (covers(x, y)) highest = std::max(highest, ground_at(x, y));
    }
  }
  const Top top = [&](double x, double y) { return covers(x, y) ? highest + 100 : kNoTop; };
  for (const char* output : {"o.mtin", "o.mtp"}) {
    encode(session, collection({feature(R"("height": 100, "radius": 30)", kOnSlope)}), "", output);
    const Found found =
        look(session.folder() + "/" + output, top, [](double, double) { return true; });
    CHECK(found.lowest_over >= -kRounding);
    CHECK(found.lowest_over < 12);  // cells that it touches reach higher
  }
}

TEST_CASE("obstacles: lines have a width, polygons an area, and both follow the ground") {
  const Session session;
  write_ground(session);
  const std::string obstacles = collection(
      {feature(R"("height": 50, "radius": 4)", kLine), feature(R"("height": 30)", kBuilding)});
  const Top top = [](double x, double y) -> double {
    const double away =
        std::min(distance_to(x, y, 20, 20, 260, 61), distance_to(x, y, 260, 61, 470, 330));
    if (away <= 4) return ground_at(x, y) + 50;
    const bool in_building =
        x <= 352 && y >= 432 && (x - 331) * (446 - 432) >= (y - 432) * (352 - 331);
    return in_building ? ground_at(x, y) + 30 : kNoTop;
  };
  const Footprint anywhere = [](double, double) { return true; };
  for (const char* output : {"o.mtin", "o.mtp"}) {
    encode(session, obstacles, contains(output, ".mtp") ? " --tile-size 10" : "", output);
    const Found found = look(session.folder() + "/" + output, top, anywhere);
    CHECK(found.lowest_over >= -kRounding);
    CHECK(found.lowest_over <= 12);  // the posts of a cell are at the height of its highest
    CHECK(found.lowest_elsewhere >= -kRounding);
  }
}

TEST_CASE("obstacles: a pack is updated where one was built, and keeps all other tiles") {
  const Session session;
  write_ground(session);
  const std::string before = collection({feature(R"("top": 290)", kOnPost)}),
                    after = collection({feature(R"("top": 290)", kOnPost),
                                        feature(R"("top": 301.5, "radius": 17)", kTower)});
  encode(session, before, " --tile-size 10 --z-step 0.5", "o.mtp");
  const std::string update =
      "update o.mtp t.asc --units metre --obstacles o.geojson --tile-vertices 500 -o ";
  REQUIRE(session.run(update + "same.mtp").code == 0);
  CHECK(session.read("same.mtp") == session.read("o.mtp"));
  session.write("o.geojson", after);
  const Session::Result updated = session.run(update + "new.mtp");
  REQUIRE_MESSAGE(updated.code == 0, updated.err);
  CHECK(contains(updated.out, "kept: 2"));
  const Footprint covers = within(123.4, 231.7, 17);
  const Top top = [&](double x, double y) { return covers(x, y) ? 301.5 : kNoTop; };
  const Found found = look(session.folder() + "/new.mtp", top, [](double, double) { return true; });
  CHECK(found.lowest_over >= -kRounding);
  CHECK(found.lowest_elsewhere >= -kRounding);
}

TEST_CASE("obstacles: those in voids and beyond the terrain are counted, and the kind is stated") {
  const Session session;
  write_ground(session);
  const std::string obstacles =
      collection({feature(R"("top": 400)", kInVoid), feature(R"("top": 400)", kFarAway),
                  feature(R"("top": 300)", kTower)});
  for (const char* output : {"o.mtin", "o.mtp"}) {
    const std::string report = encode(session, obstacles, "", output);
    CHECK(contains(report, "raised to 1 obstacle"));
    CHECK(contains(report, "2 obstacles lie elsewhere"));
    CHECK(library::Surface::from_file(session.folder() + "/" + output).info().surface ==
          library::SurfaceKind::kObstacles);
  }
}

TEST_CASE("obstacles: properties in capitals are those in small letters") {
  const Session session;
  write_ground(session);
  encode(session, collection({feature(R"("top": 300, "radius": 20)", kTower)}), "", "small.mtin");
  encode(session, collection({feature(R"("TOP": 300, "Radius": 20)", kTower)}), "", "large.mtin");
  CHECK(session.read("small.mtin") == session.read("large.mtin"));
}

TEST_CASE("obstacles: what cannot be understood is refused, with the file's name") {
  const Session session;
  write_ground(session);
  const auto refused = [&](const std::string& obstacles, const std::string& options) {
    session.write("o.geojson", obstacles);
    return session.failure(
        join({"encode t.asc --units metre --obstacles o.geojson -o o.mtin", options}));
  };
  const std::string both = collection({feature(R"("top": 3, "height": 5)", kTower)}),
                    none = collection({feature(R"("radius": 3)", kTower)}),
                    negative = collection({feature(R"("top": 3, "radius": -1)", kTower)}),
                    good = collection({feature(R"("top": 300)", kTower)});
  CHECK(contains(refused(both, " --max-error 4"), "o.geojson: an obstacle needs either"));
  CHECK(contains(refused(none, " --max-error 4"), "o.geojson: an obstacle needs either"));
  CHECK(contains(refused(negative, " --max-error 4"), "radius"));
  session.write("o.geojson", good);
  CHECK(session.run("encode t.asc --units metre --obstacles o.geojson -o o.mtin").code == 2);
  session.write("p.xyz", "0 0 1\n9 0 2\n0 9 3\n9 9 7\n");
  for (const char* output : {"o.mtin", "o.mtp"}) {
    CHECK(contains(session.failure(join({"encode p.xyz --units metre --max-error 4 --obstacles "
                                         "o.geojson -o ",
                                         output})),
                   "is for rasters"));
  }
}

}  // namespace microtin::obstacles_test
