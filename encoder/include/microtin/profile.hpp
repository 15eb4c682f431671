// SPDX-License-Identifier: MIT
/* microtin: profiles of a surface, and lines of sight above them. C++17, hosted.
 *
 * Distances are metres on the ground. Heights, clearances and radii are in the surface's unit of
 * heights. Where a unit is not known, it counts as the metre.
 */
#ifndef MICROTIN_PROFILE_HPP
#define MICROTIN_PROFILE_HPP

#include <microtin/microtin.h>

#include <cstddef>
#include <limits>
#include <vector>

namespace microtin::encoder {

/* A place of a profile: an end of the line, a vertex of the surface on the line, or where the line
 * crosses an edge. */
struct ProfilePlace {
  double along = 0;    /* the part of the line before the place, 0 .. 1 */
  double distance = 0; /* from the begin of the line, in metres */
  double x = 0, y = 0; /* in the surface's coordinates */
  double height = std::numeric_limits<double>::quiet_NaN(); /* NaN: there is none */
  bool is_known_before = false; /* the surface has heights from the place before up to this one */
  /* How far the source lies at most above and below the surface there; NaN: not stated. */
  double below = std::numeric_limits<double>::quiet_NaN();
  double above = std::numeric_limits<double>::quiet_NaN();
};

/* The heights along the straight line between two positions of the lattice, each of them rounded
 * to 1/256 of a lattice step. Between two places with a surface the height is linear. */
struct Profile {
  std::vector<ProfilePlace> places; /* from the begin of the line to its end: at least two */
  double length = 0;                /* in metres */
  double earth_radius = 0;          /* metres: of the sphere that fits best at the line's middle */
  /* How far the line is from the shortest line on the Earth, in metres; NaN unless x and y are in
   * degrees. */
  double geodesic_deviation = std::numeric_limits<double>::quiet_NaN();
  double metres_per_height = 1;
  /* OK: the whole line has heights. OUTSIDE, VOID or BAD_TILE: the worst reason why a part, perhaps
   * a point, has none. */
  microtin_query_result result = MICROTIN_QUERY_OK;
};

/* Returns the place of the least height; null if no place has a height. */
const ProfilePlace* lowest_of(const Profile& profile);

/* Returns the place of the greatest height; null if no place has a height. */
const ProfilePlace* highest_of(const Profile& profile);

/* Returns `count` places in equal parts of the line, both ends included. A count of 1 is the
 * begin. */
std::vector<ProfilePlace> equal_places(const Profile& profile, size_t count);

/* An end of a line of sight. */
struct SightEnd {
  double height = 0;
  bool is_above_datum = false; /* false: the height is above the ground, which is the surface */
};

/* How a line of sight is judged. */
struct SightOptions {
  /* Refraction bends rays down. A ray is straight above a sphere of this many radii of the Earth.
   * 4/3 is usual for radio, 1 for geometry without refraction; infinity is a flat Earth. */
  double earth_factor = 4.0 / 3;
  double frequency = 0;    /* in MHz, 0: without a Fresnel zone */
  double zone_share = 0.6; /* of the radius of the first Fresnel zone that has to be free */
  /* Measure from the highest that the source can be. An end above the ground then stands on the
   * lowest that the source can be. */
  bool is_safe = false;
};

/* Whether something is free of terrain. */
enum class Sight : uint8_t {
  kClear = 0,   /* the whole line has heights, and none is in the way */
  kBlocked = 1, /* a known height is in the way */
  kUnknown = 2  /* no known height is in the way, but a part of the line has none */
};

/* Returns "clear", "blocked" or "unknown". */
const char* name_of(Sight sight);

/* A line of sight above a profile. Numbers are NaN where nothing is known, or nothing is blocked.
 * Clearances are those of the parts that are known. */
struct LineOfSight {
  Sight line = Sight::kUnknown; /* of the ray itself */
  Sight zone =
      Sight::kUnknown;        /* of the share of the Fresnel zone; without a frequency as `line` */
  double from = 0, to = 0;    /* heights of the ends above the datum */
  double least_clearance = 0; /* of the ray above the terrain and the curved Earth */
  double least_clearance_at = 0; /* its distance from the begin, in metres */
  double first_obstruction = 0;  /* distance of the first place where the terrain blocks the ray */
  double first_zone_obstruction = 0; /* of the first place where it blocks the share of the zone */
  /* The largest share of the first Fresnel zone that is free along the whole line, at most 99; 0 if
   * the ray is blocked. NaN without a frequency. */
  double free_share = 0;
  double free_share_at = 0; /* the distance where the zone is narrowest */
};

/* Returns whether two ends of a profile see each other. Throws std::runtime_error if a number is
 * out of range, or if the margins are missing that a safe answer needs. O(places).
 *
 *   const Profile profile = Surface::from_file("area.mtin").profile({7.5, 43.9}, {7.8, 44.0});
 *   SightOptions options;
 *   options.frequency = 868;
 *   if (line_of_sight(profile, {10}, {2}, options).zone == Sight::kClear) ...
 */
LineOfSight line_of_sight(const Profile& profile, const SightEnd& from, const SightEnd& to,
                          const SightOptions& options);

/* Returns how far the Earth rises above the straight line between the ends, at a distance from the
 * begin. */
double earth_bulge(const Profile& profile, const SightOptions& options, double distance);

/* Returns the radius of the first Fresnel zone, at a distance from the begin. */
double fresnel_radius(const Profile& profile, const SightOptions& options, double distance);

}  // namespace microtin::encoder

#endif
