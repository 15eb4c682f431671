// SPDX-License-Identifier: MIT
// Profiles of streams and packs: the heights, parts and vertices of the surface itself.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "microtin/encoder.hpp"
#include "microtin/surface.hpp"
#include "tests/support/files.hpp"
#include "tests/support/layers.hpp"
#include "tests/support/slow.hpp"
#include "tests/support/temporary_folder.hpp"

using namespace microtin::encoder;
using microtin::tests::TemporaryFolder;
using microtin::tests::write_file;

namespace {

constexpr uint32_t kSide = 64;
constexpr double kCell = 10, kLast = (kSide - 1) * kCell;
constexpr double kBend =
    1.01 * kCell / 256;  // how far a profile's line may be off the straight one
const double kNan = std::nan("");

// Hills with a hole in the middle and one at a corner; row 0 is the northernmost.
SourceTerrain hills() {
  std::vector<double> heights;
  for (uint32_t row = 0; row < kSide; ++row) {
    for (uint32_t column = 0; column < kSide; ++column) {
      const double z = 40 * std::sin(column * 0.3) * std::cos(row * 0.23) + (7 * column + row) % 5;
      const bool is_void =
          (column > 28 && column < 35 && row > 20 && row < 30) || (column > 57 && row > 58);
      heights.push_back(is_void ? kNan : std::round(z * 10) / 10);
    }
  }
  return SourceTerrain(raster_from_cells(kSide, kSide, heights.data(),
                                         {-kCell / 2, kCell, 0, kLast + kCell / 2, 0, -kCell}));
}

Surface stream_of(const SourceTerrain& terrain, const TemporaryFolder& folder) {
  Options options;
  options.max_error = "2";
  write_file(folder / "t.mtin", encode_stream(terrain, options).bytes);
  return Surface::from_file(folder / "t.mtin");
}

Surface pack_of(const SourceTerrain& terrain, const TemporaryFolder& folder) {
  Options options;
  options.max_error = "2";
  options.tile_size = 16;
  options.tile_vertices = 400;
  encode_pack(terrain, options, folder / "t.mtp");
  return Surface::from_file(folder / "t.mtp");
}

double height_of(const Surface& surface, double x, double y) {
  double height = 0;
  surface.heights(1, &x, &y, &height);
  return height;
}

bool is_edge_near(const Surface& surface, double x, double y) {
  for (const double dx : {-kBend, kBend}) {
    for (const double dy : {-kBend, kBend}) {
      if (std::isnan(height_of(surface, x + dx, y + dy)) != std::isnan(height_of(surface, x, y))) {
        return true;
      }
    }
  }
  return false;
}

// The profile is the surface's at any of its places, and between them.
void check_profile(const Surface& surface, const Profile& profile, double tolerance) {
  for (size_t i = 0; i < profile.places.size(); ++i) {
    const ProfilePlace& place = profile.places[i];
    if (i != 0) REQUIRE(place.along >= profile.places[i - 1].along);
    const bool is_known = place.is_known_before ||
                          (i + 1 < profile.places.size() && profile.places[i + 1].is_known_before);
    if (is_known && !is_edge_near(surface, place.x, place.y)) {
      CAPTURE(place.x);
      CAPTURE(place.y);
      CAPTURE(place.along);
      REQUIRE(std::abs(place.height - height_of(surface, place.x, place.y)) <= tolerance);
    }
  }
  for (const ProfilePlace& place : equal_places(profile, 300)) {
    const double height = height_of(surface, place.x, place.y);
    if (is_edge_near(surface, place.x, place.y)) continue;
    REQUIRE(std::isnan(height) == std::isnan(place.height));
    if (!std::isnan(height)) REQUIRE(std::abs(place.height - height) <= tolerance);
  }
}

bool is_whole(const Profile& profile) {
  return std::all_of(profile.places.begin(), profile.places.end(),
                     [](const ProfilePlace& place) { return !std::isnan(place.height); }) &&
         std::all_of(profile.places.begin() + 1, profile.places.end(),
                     [](const ProfilePlace& place) { return place.is_known_before; });
}

}  // namespace

TEST_CASE("profile: a stream's and a pack's are the heights of their surfaces" *
          microtin::tests::kSlow) {
  const TemporaryFolder folder;
  const SourceTerrain terrain = hills();
  std::mt19937 dice(3);
  std::uniform_real_distribution<double> place(-60, kLast + 60);
  for (const bool is_pack : {false, true}) {
    const Surface surface = is_pack ? pack_of(terrain, folder) : stream_of(terrain, folder);
    size_t whole = 0, partial = 0;
    for (int round = 0; round < 60; ++round) {
      const Surface::Position from = {place(dice), place(dice)}, to = {place(dice), place(dice)};
      const Profile profile = surface.profile(from, to);
      CAPTURE(round);
      const auto is_inside = [](const Surface::Position& p) {
        return std::min(p.x, p.y) >= 0 && std::max(p.x, p.y) <= kLast;
      };
      // Slopes are below 20, and a line bends by 1/512 of a cell at most.
      const bool bends = is_pack || !is_inside(from) || !is_inside(to);
      check_profile(surface, profile, bends ? 20 * kCell / 512 : 1e-3);
      CHECK((profile.result == MICROTIN_QUERY_OK) == is_whole(profile));
      CHECK(profile.length ==
            doctest::Approx(std::hypot(to.x - from.x, to.y - from.y)).epsilon(1e-3));
      (is_whole(profile) ? whole : partial) += 1;
    }
    CHECK(whole > 3);
    CHECK(partial > 3);
  }
}

TEST_CASE("profile: along borders of tiles, through their corners, and at a single place") {
  const TemporaryFolder folder;
  const Surface pack = pack_of(hills(), folder);
  const double border = 16 * kCell;
  for (const Surface::Position to : {Surface::Position{border, kLast},
                                     {kLast, border},
                                     {4 * border, 4 * border},
                                     {2 * border, border},
                                     {0, 0},
                                     {border, border}}) {
    for (const Surface::Position from : {Surface::Position{border, 0}, {0, border}, {0, 0}}) {
      const Profile profile = pack.profile(from, to);
      check_profile(pack, profile, 20 * kCell / 512);
      const Profile back = pack.profile(to, from);
      REQUIRE(back.places.size() == profile.places.size());
      for (size_t i = 0; i < back.places.size(); ++i) {
        const ProfilePlace& other = profile.places[profile.places.size() - 1 - i];
        REQUIRE(std::isnan(back.places[i].height) == std::isnan(other.height));
        REQUIRE(std::abs(back.places[i].along - (1 - other.along)) < 1e-6);
      }
    }
  }
  const Profile here = pack.profile({77, 88}, {77, 88});
  CHECK(here.places.size() == 2);
  CHECK(here.length == 0);
  CHECK(here.places[0].height == doctest::Approx(height_of(pack, 77, 88)).epsilon(1e-2));
}

TEST_CASE("profile: a tile that cannot be read is a part without heights") {
  const TemporaryFolder folder;
  pack_of(hills(), folder);
  std::vector<uint8_t> bytes = microtin::tests::bytes_of_file(folder / "t.mtp");
  bytes[bytes.size() - 20] ^= 0xFF;
  write_file(folder / "bad.mtp", bytes);
  const Surface bad = Surface::from_file(folder / "bad.mtp");
  const Profile profile = bad.profile({0, kLast - 5}, {kLast, kLast - 5});
  CHECK(profile.result == MICROTIN_QUERY_BAD_TILE);
  CHECK(!std::isnan(profile.places.front().height));
  CHECK(line_of_sight(profile, {1000}, {1000, true}, {}).line == Sight::kUnknown);
}

TEST_CASE("profile: extremes, equal places and positions that are none") {
  const TemporaryFolder folder;
  const Surface surface = stream_of(hills(), folder);
  const Profile profile = surface.profile({0, 0}, {kLast, 100});
  for (const ProfilePlace& place : profile.places) {
    CHECK(place.height <= highest_of(profile)->height);
    CHECK(place.height >= lowest_of(profile)->height);
    CHECK(place.below > 0);
  }
  CHECK(equal_places(profile, 1).front().distance == 0);
  CHECK(equal_places(profile, 3)[1].distance == doctest::Approx(profile.length / 2));
  CHECK(lowest_of(surface.profile({-50, -50}, {-9, -9})) == nullptr);
  CHECK_THROWS_AS(surface.profile({kNan, 0}, {1, 1}), std::runtime_error);
  CHECK_THROWS_AS(surface.profile({0, 0}, {1, 1e12}), std::runtime_error);
}

TEST_CASE("profile: degrees are metres on the Earth, and the line takes the shorter way") {
  const TemporaryFolder folder;
  const std::vector<double> flat(25, 7);
  Transform cells{169, 4, 0, 62, 0, -4};
  RasterData raster = raster_from_cells(5, 5, flat.data(), cells);
  Options options;
  options.units = "degree:metre";
  write_file(folder / "d.mtin", encode_stream(SourceTerrain(raster), options).bytes);
  const Surface surface = Surface::from_file(folder / "d.mtin");
  // A degree of the meridian at 52 degrees, and of the parallel: Vincenty on WGS 84.
  CHECK(surface.profile({175, 51.5}, {175, 52.5}).length ==
        doctest::Approx(111267.5).epsilon(1e-4));
  CHECK(surface.profile({175, 52}, {176, 52}).length == doctest::Approx(68677.6).epsilon(1e-3));
  const Profile across = surface.profile({179, 52}, {-179, 52});
  CHECK(across.length == doctest::Approx(2 * 68677.6).epsilon(1e-3));
  CHECK(across.result == MICROTIN_QUERY_OK);
  // The parallel lies L^2 tan(latitude) / 8 R from the great circle.
  const double sagitta =
      across.length * across.length * std::tan(52 * 0.0174532925) / 8 / 6371008.8;
  CHECK(across.geodesic_deviation == doctest::Approx(sagitta).epsilon(0.01));
  CHECK(surface.profile({175, 50}, {175, 53}).geodesic_deviation < 1e-3);
  // The radius that fits at a latitude: 6372.8 km at 45 degrees is 6381 km at 52.
  CHECK(across.earth_radius == doctest::Approx(6383200).epsilon(1e-3));
}
