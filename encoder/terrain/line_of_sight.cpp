// SPDX-License-Identifier: MIT
// Lines of sight above a profile: a straight ray, the bulge of the Earth, and the Fresnel zone.
//
// Between two places the terrain is linear, the bulge and the radius of the zone are concave. So
// what is free below the ray is convex, and its minimum is found by halving intervals.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "encoder/base/error.hpp"
#include "microtin/profile.hpp"

namespace microtin::encoder {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kTouch = 1e-4;               // what is nearer touches, and does not block
constexpr double kMostShare = 99;             // of a zone that is looked for
constexpr double kSpeedOfLight = 299.792458;  // metres times MHz

// A part of the line with terrain, or a single place.
struct Span {
  double begin, end;  // distances
  double low, high;   // heights of the terrain at the begin and at the end
};

std::vector<Span> spans_of(const Profile& profile, bool is_safe) {
  std::vector<Span> spans;
  for (size_t i = 0; i < profile.places.size(); ++i) {
    const ProfilePlace& place = profile.places[i];
    if (std::isnan(place.height)) continue;
    const double margin = is_safe ? place.below : 0;
    const ProfilePlace& before = profile.places[i != 0 && place.is_known_before ? i - 1 : i];
    spans.push_back(
        {before.distance, place.distance, before.height + margin, place.height + margin});
  }
  return spans;
}

// A place of the ray, and what is free there.
struct Narrowest {
  double distance, free;
};

class Ray {
 public:
  Ray(const Profile& profile, const SightOptions& options, double from, double to)
      : profile_(profile), options_(options), from_(from), to_(to) {}

  // Between the terrain with its bulge and the ray, less a share of the zone.
  double free_at(const Span& span, double distance, double share) const {
    const double zone = share > 0 ? share * fresnel_radius(profile_, options_, distance) : 0;
    return height_at(distance) - terrain_at(span, distance) -
           earth_bulge(profile_, options_, distance) - zone;
  }

  // The least of a span.
  Narrowest narrowest(const Span& span, double share) const {
    constexpr int kHalvings = 60;
    double low = span.begin, high = span.end;
    for (int i = 0; i < kHalvings && low < high; ++i) {
      const double left = low + (high - low) * 0.49, right = low + (high - low) * 0.51;
      if (free_at(span, left, share) <= free_at(span, right, share)) {
        high = right;
      } else {
        low = left;
      }
    }
    Narrowest least{span.begin, free_at(span, span.begin, share)};
    for (const double distance : {(low + high) / 2, span.end}) {
      const double free = free_at(span, distance, share);
      if (free < least.free) least = {distance, free};
    }
    return least;
  }

  // Whether something of a span may be less than this: a quick look.
  bool may_be_below(const Span& span, double share, double bound) const {
    const double middle = std::clamp(profile_.length / 2, span.begin, span.end);
    const double most = earth_bulge(profile_, options_, middle) +
                        share * fresnel_radius(profile_, options_, middle);
    return std::min(height_at(span.begin) - span.low, height_at(span.end) - span.high) - most <
           bound;
  }

 private:
  // Exact at both ends.
  double height_at(double distance) const {
    if (profile_.length <= 0) return std::min(from_, to_);
    const double along = distance / profile_.length;
    return from_ * (1 - along) + to_ * along;
  }

  static double terrain_at(const Span& span, double distance) {
    if (distance <= span.begin) return span.low;
    if (distance >= span.end) return span.high;
    const double along = (distance - span.begin) / (span.end - span.begin);
    return span.low * (1 - along) + span.high * along;
  }

  const Profile& profile_;
  const SightOptions& options_;
  double from_, to_;
};

std::optional<Narrowest> narrowest_of(const Ray& ray, const std::vector<Span>& spans,
                                      double share) {
  std::optional<Narrowest> least;
  for (const Span& span : spans) {
    if (least && !ray.may_be_below(span, share, least->free)) continue;
    const Narrowest here = ray.narrowest(span, share);
    if (!least || here.free < least->free) least = here;
  }
  return least;
}

// The first distance where less is free than a share of the zone.
double first_blocked(const Ray& ray, const std::vector<Span>& spans, double share) {
  constexpr int kHalvings = 60;
  for (const Span& span : spans) {
    if (!ray.may_be_below(span, share, -kTouch)) continue;
    if (ray.free_at(span, span.begin, share) < -kTouch) return span.begin;
    const Narrowest least = ray.narrowest(span, share);
    if (least.free >= -kTouch) continue;
    double low = span.begin, high = least.distance;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = (low + high) / 2;
      (ray.free_at(span, middle, share) < -kTouch ? high : low) = middle;
    }
    return high;
  }
  return kNone;
}

// The largest share of the zone that is free everywhere: a larger one is made smaller until it is.
Narrowest free_share_of(const Ray& ray, const std::vector<Span>& spans, const Profile& profile,
                        const SightOptions& options) {
  constexpr int kSteps = 100;
  Narrowest share{kNone, kMostShare};
  for (int i = 0; i < kSteps; ++i) {
    const auto least = narrowest_of(ray, spans, share.free);
    if (!least || least->free >= -kTouch) break;
    const double radius = fresnel_radius(profile, options, least->distance);
    const double free = least->free + share.free * radius;
    if (radius <= 0 || free <= 0) return {least->distance, 0};
    const double smaller = free / radius;
    if (smaller >= share.free) break;
    share = {least->distance, smaller};
  }
  return share;
}

void expect(bool holds, const char* name, const std::string& wanted) {
  if (!holds) throw base::Error(base::parameter(name) + ": is not " + wanted);
}

void expect_options(const SightEnd& from, const SightEnd& to, const SightOptions& options) {
  constexpr double kHighest = 1e9, kFastest = 1e9;
  const auto is_height = [](double height) { return std::abs(height) <= kHighest; };
  expect(is_height(from.height), "from_height", "a number from -10^9 to 10^9");
  expect(is_height(to.height), "to_height", "a number from -10^9 to 10^9");
  expect(options.earth_factor > 0, "earth_factor", "a number above 0, or infinity");
  expect(options.frequency >= 0 && options.frequency <= kFastest, "frequency",
         "a number of megahertz from 0 to 10^9");
  expect(options.zone_share >= 0 && options.zone_share <= kMostShare, "zone_share",
         "a number from 0 to 99");
}

void expect_margins(const Profile& profile) {
  for (const ProfilePlace& place : profile.places) {
    if (std::isnan(place.height) || (place.below >= 0 && place.above >= 0)) continue;
    throw base::Error(
        "the surface does not state how far it is from its source between posts, which a safe "
        "line of sight needs; encode a raster again");
  }
}

// Above the datum.
double height_of(const SightEnd& end, const ProfilePlace& ground, bool is_safe) {
  if (end.is_above_datum) return end.height;
  return ground.height - (is_safe ? ground.above : 0) + end.height;
}

Sight sight_of(double first_blocked, microtin_query_result known) {
  if (!std::isnan(first_blocked)) return Sight::kBlocked;
  return known == MICROTIN_QUERY_OK ? Sight::kClear : Sight::kUnknown;
}

}  // namespace

const char* name_of(Sight sight) {
  return sight == Sight::kClear ? "clear" : sight == Sight::kBlocked ? "blocked" : "unknown";
}

double earth_bulge(const Profile& profile, const SightOptions& options, double distance) {
  const double rise =
      distance * (profile.length - distance) / (2 * options.earth_factor * profile.earth_radius);
  return rise / profile.metres_per_height;
}

double fresnel_radius(const Profile& profile, const SightOptions& options, double distance) {
  if (options.frequency <= 0 || profile.length <= 0) return 0;
  const double wave = kSpeedOfLight / options.frequency;
  const double square = wave * distance * (profile.length - distance) / profile.length;
  return std::sqrt(std::max(0.0, square)) / profile.metres_per_height;
}

LineOfSight line_of_sight(const Profile& profile, const SightEnd& from, const SightEnd& to,
                          const SightOptions& options) {
  expect_options(from, to, options);
  if (options.is_safe) expect_margins(profile);
  LineOfSight found;
  found.from = height_of(from, profile.places.front(), options.is_safe);
  found.to = height_of(to, profile.places.back(), options.is_safe);
  found.least_clearance = found.least_clearance_at = found.first_obstruction =
      found.first_zone_obstruction = found.free_share = found.free_share_at = kNone;
  if (std::isnan(found.from) || std::isnan(found.to)) return found;
  const Ray ray(profile, options, found.from, found.to);
  const std::vector<Span> spans = spans_of(profile, options.is_safe);
  const auto least = narrowest_of(ray, spans, 0);
  if (least) {
    found.least_clearance = least->free;
    found.least_clearance_at = least->distance;
  }
  found.first_obstruction = first_blocked(ray, spans, 0);
  found.line = found.zone = sight_of(found.first_obstruction, profile.result);
  if (options.frequency <= 0) return found;
  found.first_zone_obstruction = first_blocked(ray, spans, options.zone_share);
  found.zone = sight_of(found.first_zone_obstruction, profile.result);
  if (!std::isnan(found.first_obstruction)) {
    found.free_share = 0;
    found.free_share_at = found.least_clearance_at;
    return found;
  }
  if (spans.empty()) return found;
  const Narrowest share = free_share_of(ray, spans, profile, options);
  found.free_share = share.free;
  found.free_share_at = share.distance;
  return found;
}

}  // namespace microtin::encoder
