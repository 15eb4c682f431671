// SPDX-License-Identifier: MIT
// Lines of sight above profiles: against circles, dense sampling and numbers of textbooks.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include "microtin/profile.hpp"

using namespace microtin::encoder;

namespace {

constexpr double kRadius = 6371008.8;
const double kNone = std::nan("");

ProfilePlace place_at(double distance, double height, bool is_known) {
  ProfilePlace place;
  place.distance = distance;
  place.height = height;
  place.is_known_before = is_known;
  return place;
}

// Flat ground between pairs of a distance and a height.
Profile profile_of(const std::vector<std::pair<double, double>>& pairs) {
  Profile profile;
  for (const auto& [distance, height] : pairs) {
    profile.places.push_back(place_at(distance, height, !profile.places.empty()));
  }
  profile.length = pairs.back().first;
  profile.earth_radius = kRadius;
  for (ProfilePlace& place : profile.places) place.along = place.distance / profile.length;
  return profile;
}

SightEnd at_altitude(double height) {
  return {height, true};
}

// What is free at a distance, by the formulas of textbooks.
double free_at(const Profile& profile, const LineOfSight& sight, const SightOptions& options,
               double distance, double share) {
  const double d1 = distance, d2 = profile.length - distance;
  const double ray = (sight.from * d2 + sight.to * d1) / profile.length;
  const double bulge = d1 * d2 / (2 * options.earth_factor * kRadius);
  const double radius = options.frequency > 0
                            ? std::sqrt(299.792458 / options.frequency * d1 * d2 / profile.length)
                            : 0;
  double terrain = -1e30;
  for (size_t i = 1; i < profile.places.size(); ++i) {
    const ProfilePlace &a = profile.places[i - 1], &b = profile.places[i];
    if (!b.is_known_before || distance < a.distance || distance > b.distance) continue;
    const double part = (distance - a.distance) / (b.distance - a.distance);
    terrain = std::max(terrain, a.height + (b.height - a.height) * part);
  }
  return ray - terrain - bulge - share * radius;
}

Profile random_profile(std::mt19937& dice) {
  std::uniform_real_distribution<double> part(0, 1);
  std::vector<std::pair<double, double>> pairs = {{0, 100 * part(dice)}};
  while (pairs.size() < 12) {
    pairs.emplace_back(pairs.back().first + 20 + 4000 * part(dice), 100 * part(dice));
  }
  Profile profile = profile_of(pairs);
  if (part(dice) < 0.3) {
    profile.places[5].is_known_before = false;
    profile.result = MICROTIN_QUERY_VOID;
  }
  return profile;
}

}  // namespace

TEST_CASE("line of sight: a dense search finds nothing narrower, and no obstruction before") {
  std::mt19937 dice(7);
  std::uniform_real_distribution<double> part(0, 1);
  size_t blocked = 0, clear = 0, unknown = 0;
  for (int round = 0; round < 200; ++round) {
    const Profile profile = random_profile(dice);
    SightOptions options;
    options.earth_factor = round % 3 == 0 ? 1 : 4.0 / 3;
    options.frequency = round % 2 == 0 ? 868 : 0;
    const LineOfSight sight =
        line_of_sight(profile, {120 * part(dice)}, {120 * part(dice)}, options);
    double least = 1e30, first = kNone, share = 99;
    constexpr int kSteps = 20000;
    for (int i = 0; i <= kSteps; ++i) {
      const double at = profile.length * i / kSteps;
      const double free = free_at(profile, sight, options, at, 0);
      least = std::min(least, free);
      if (std::isnan(first) && free < 0) first = at;
      const double radius = free - free_at(profile, sight, options, at, 1);
      if (radius > 0) share = std::min(share, std::max(0.0, free / radius));
    }
    CHECK(sight.least_clearance <= least + 1e-6);
    CHECK(sight.least_clearance >= least - 1);  // the search has steps of some metres
    CHECK(free_at(profile, sight, options, sight.least_clearance_at, 0) ==
          doctest::Approx(sight.least_clearance).epsilon(1e-9));
    if (std::isnan(sight.first_obstruction)) {
      CHECK(least > -0.01);
    } else {
      CHECK((std::isnan(first) || sight.first_obstruction <= first + 1e-3));
      const double free = free_at(profile, sight, options, sight.first_obstruction, 0);
      const bool begins_there = sight.first_obstruction == profile.places[5].distance;
      CHECK(free < 0.02);
      CHECK((free > -0.02 || begins_there));
    }
    if (options.frequency > 0) CHECK(std::abs(sight.free_share - share) < 0.05 + 0.05 * share);
    blocked += sight.line == Sight::kBlocked;
    clear += sight.line == Sight::kClear;
    unknown += sight.line == Sight::kUnknown;
  }
  CHECK(blocked > 20);
  CHECK(clear > 20);
  CHECK(unknown > 5);
}

TEST_CASE("line of sight: the bulge is that of a circle, and the zone that of ITU-R P.526") {
  // Two masts on a ball without terrain between: the chord's distance below the surface.
  for (const double length : {10000.0, 30000.0, 100000.0}) {
    const Profile sea = profile_of({{0, 0}, {length, 0}});
    SightOptions options;
    options.earth_factor = 1;
    const double angle = length / kRadius / 2;
    const double sagitta = kRadius * (1 - std::cos(angle));
    CHECK(earth_bulge(sea, options, length / 2) == doctest::Approx(sagitta).epsilon(1e-4));
    // Masts that just see each other: h = R (1 / cos - 1).
    const double mast = kRadius * (1 / std::cos(angle) - 1);
    CHECK(line_of_sight(sea, {mast * 1.001}, {mast * 1.001}, options).line == Sight::kClear);
    CHECK(line_of_sight(sea, {mast * 0.999}, {mast * 0.999}, options).line == Sight::kBlocked);
    options.earth_factor = 4.0 / 3;
    CHECK(line_of_sight(sea, {mast * 0.76}, {mast * 0.76}, options).line == Sight::kClear);
    CHECK(line_of_sight(sea, {mast * 0.74}, {mast * 0.74}, options).line == Sight::kBlocked);
  }
  const Profile path = profile_of({{0, 0}, {10000, 0}});
  SightOptions radio;
  radio.frequency = 2400;
  CHECK(fresnel_radius(path, radio, 5000) == doctest::Approx(17.67).epsilon(1e-3));
  CHECK(fresnel_radius(path, radio, 0) == 0);
}

TEST_CASE("line of sight: the flat Earth, a knife edge, and shares of its zone") {
  const Profile edge = profile_of({{0, 0}, {4999, 0}, {5000, 40}, {5001, 0}, {10000, 0}});
  SightOptions options;
  options.earth_factor = std::numeric_limits<double>::infinity();
  options.frequency = 868;
  const double radius = fresnel_radius(edge, options, 5000);
  LineOfSight sight = line_of_sight(edge, at_altitude(40 + 0.61 * radius),
                                    at_altitude(40 + 0.61 * radius), options);
  CHECK(sight.line == Sight::kClear);
  CHECK(sight.zone == Sight::kClear);
  CHECK(sight.free_share == doctest::Approx(0.61).epsilon(1e-4));
  CHECK(sight.free_share_at == doctest::Approx(5000).epsilon(1e-6));
  CHECK(sight.least_clearance == doctest::Approx(0.61 * radius));
  sight = line_of_sight(edge, at_altitude(40 + 0.59 * radius), at_altitude(40 + 0.59 * radius),
                        options);
  CHECK(sight.line == Sight::kClear);
  CHECK(sight.zone == Sight::kBlocked);
  CHECK(sight.first_zone_obstruction == doctest::Approx(5000).epsilon(1e-4));
  sight = line_of_sight(edge, at_altitude(39), at_altitude(39), options);
  CHECK(sight.line == Sight::kBlocked);
  CHECK(sight.free_share == 0);
  CHECK(sight.first_obstruction == doctest::Approx(4999 + 39.0 / 40).epsilon(1e-6));
}

TEST_CASE("line of sight: a ray that touches is clear, and what is not known is never clear") {
  Profile slope = profile_of({{0, 0}, {50, 5}, {100, 10}});
  SightOptions options;
  options.earth_factor = std::numeric_limits<double>::infinity();
  CHECK(line_of_sight(slope, {0}, {0}, options).line == Sight::kClear);
  CHECK(line_of_sight(slope, {0}, at_altitude(9.9), options).line == Sight::kBlocked);
  slope.places[1].is_known_before = false;
  slope.result = MICROTIN_QUERY_VOID;
  CHECK(line_of_sight(slope, {1}, {1}, options).line == Sight::kUnknown);
  CHECK(line_of_sight(slope, {1}, at_altitude(0), options).line == Sight::kBlocked);
  slope.places[0].height = kNone;
  const LineOfSight nothing = line_of_sight(slope, {1}, {1}, options);
  CHECK(nothing.line == Sight::kUnknown);
  CHECK(std::isnan(nothing.least_clearance));
}

TEST_CASE("line of sight: a safe one takes margins from both the ground and its ends") {
  Profile flat = profile_of({{0, 0}, {500, 0}, {1000, 0}});
  SightOptions options;
  options.is_safe = true;
  CHECK_THROWS_AS(line_of_sight(flat, {9}, {9}, options), std::runtime_error);
  for (ProfilePlace& place : flat.places) place.below = place.above = 4;
  flat.places[2].below = 6;
  CHECK(line_of_sight(flat, {9.9}, {10.1}, options).line == Sight::kBlocked);
  const LineOfSight sight = line_of_sight(flat, {10.1}, {10.1}, options);
  CHECK(sight.line == Sight::kClear);
  CHECK(sight.from == doctest::Approx(6.1));
}

TEST_CASE("line of sight: feet, a single place, and numbers that are none") {
  Profile feet = profile_of({{0, 0}, {20000, 0}});
  SightOptions options;
  const double metres = earth_bulge(feet, options, 10000);
  feet.metres_per_height = 0.3048;
  CHECK(earth_bulge(feet, options, 10000) == doctest::Approx(metres / 0.3048));
  Profile here = profile_of({{0, 5}, {0, 5}});
  here.length = 0;
  CHECK(line_of_sight(here, {1}, {2}, options).least_clearance == 1);
  options.earth_factor = 0;
  CHECK_THROWS_AS(line_of_sight(feet, {1}, {2}, options), std::runtime_error);
  options = {};
  options.frequency = kNone;
  CHECK_THROWS_AS(line_of_sight(feet, {1}, {2}, options), std::runtime_error);
  CHECK_THROWS_AS(line_of_sight(feet, {kNone}, {2}, {}), std::runtime_error);
}
