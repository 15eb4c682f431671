// SPDX-License-Identifier: MIT
// Walks along a line, tile by tile, and measures the way.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "encoder/base/error.hpp"
#include "encoder/export/queries.hpp"
#include "encoder/export/scene.hpp"
#include "encoder/verify/everywhere.hpp"
#include "microtin/segment.h"

namespace microtin::exporting {
namespace {

using encoder::Profile;
using encoder::ProfilePlace;

constexpr int64_t kStep = 256;  // positions have 8 fractional bits
constexpr double kMeanRadius = 6371008.8;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Fine {
  int64_t x, y;
};

// A place where the line crosses a border of tiles, or an end of the line.
struct Cut {
  Wide part, whole;  // of the line
  Fine at;

  double along() const { return static_cast<double>(part) / static_cast<double>(whole); }
};

bool is_before(const Cut& a, const Cut& b) {
  return a.part * b.whole < b.part * a.whole;
}

// A crossing of the line, before it has coordinates.
struct Found {
  double along;
  int32_t height;
  microtin_query_result result;
  microtin_query_result before;  // OK: there is terrain from the place before up to this one
  double below, above;           // the margins; NaN if they are not stated
};

using FoundPlaces = std::vector<Found>;

microtin_query_result worse(microtin_query_result a, microtin_query_result b) {
  constexpr microtin_query_result kOrder[] = {MICROTIN_QUERY_BAD_TILE, MICROTIN_QUERY_OUTSIDE,
                                              MICROTIN_QUERY_VOID};
  for (const microtin_query_result reason : kOrder) {
    if (a == reason || b == reason) return reason;
  }
  return MICROTIN_QUERY_OK;
}

// What two profiles of one place say. A height that either has counts.
void join(const Found& other, Found& found) {
  if (found.result == MICROTIN_QUERY_OK) return;
  if (other.result != MICROTIN_QUERY_OK) {
    found.result = worse(found.result, other.result);
    return;
  }
  found.result = MICROTIN_QUERY_OK;
  found.height = other.height;
  found.below = other.below;
  found.above = other.above;
}

class LineWalk {
 public:
  LineWalk(const SampledSurface& surface, Fine from, Fine to)
      : surface_(surface), grid_(surface.tiles), from_(from), to_(to) {}

  FoundPlaces places() const {
    const std::vector<Cut> cuts = this->cuts();
    FoundPlaces places;
    for (size_t i = 0; i + 1 < cuts.size(); ++i) append(piece(cuts[i], cuts[i + 1]), places);
    if (places.empty()) throw InternalFault("a line has no places");
    // On a border of tiles an end may have its height from a tile with nothing else of the line.
    join(piece(cuts.front(), cuts.front()).front(), places.front());
    join(piece(cuts.back(), cuts.back()).front(), places.back());
    return places;
  }

 private:
  // Both ends, and where the line crosses borders of tiles, in their order.
  std::vector<Cut> cuts() const {
    std::vector<Cut> cuts = {{0, 1, from_}, {1, 1, to_}};
    const Wide dx = to_.x - from_.x, dy = to_.y - from_.y;
    const auto add = [&](int64_t border, bool is_x) {
      const Wide whole = is_x ? dx : dy, part = border - (is_x ? from_.x : from_.y);
      const bool is_inside = whole > 0 ? part > 0 && part < whole : part < 0 && part > whole;
      if (!is_inside) return;
      const Wide size = magnitude(whole), other = magnitude(part);
      const int64_t at = is_x ? from_.y + static_cast<int64_t>(round_divide(dy * other, size))
                              : from_.x + static_cast<int64_t>(round_divide(dx * other, size));
      cuts.push_back({other, size, is_x ? Fine{border, at} : Fine{at, border}});
    };
    for_borders(from_.x, to_.x, grid_.width, grid_.x_max,
                [&](int64_t border) { add(border, true); });
    for_borders(from_.y, to_.y, grid_.height, grid_.y_max,
                [&](int64_t border) { add(border, false); });
    std::sort(cuts.begin(), cuts.end(), is_before);
    const auto is_same = [](const Cut& a, const Cut& b) { return !is_before(a, b); };
    cuts.erase(std::unique(cuts.begin(), cuts.end(), is_same), cuts.end());
    return cuts;
  }

  // Borders of tiles between two coordinates.
  template <class Visit>
  static void for_borders(int64_t a, int64_t b, int64_t side, int64_t most, const Visit& visit) {
    const int64_t low = std::max<int64_t>(std::min(a, b), 0);
    const int64_t high = std::min(std::max(a, b), most * kStep);
    for (int64_t border = low / (side * kStep) * side; border * kStep <= high; border += side) {
      visit(border * kStep);
    }
    visit(most * kStep);
  }

  // Between two cuts: in a tile or, along a border, in two; or outside.
  FoundPlaces piece(const Cut& begin, const Cut& end) const {
    const double middle = (begin.along() + end.along()) / 2;
    const auto at = [middle](int64_t a, int64_t b) {
      return static_cast<double>(a) + static_cast<double>(b - a) * middle;
    };
    FoundPlaces best;
    for (const uint32_t row : tiles_at(at(from_.y, to_.y), grid_.height, grid_.y_max)) {
      for (const uint32_t column : tiles_at(at(from_.x, to_.x), grid_.width, grid_.x_max)) {
        merge(in_tile(row * tile_columns(grid_) + column, begin, end), best);
      }
    }
    if (best.empty()) return absent(begin, end, MICROTIN_QUERY_OUTSIDE);
    return best;
  }

  // The rows or columns of tiles that have a coordinate: one or, on a border, two.
  static std::vector<uint32_t> tiles_at(double coordinate, uint32_t side, uint32_t most) {
    const double place = coordinate / static_cast<double>(kStep);
    if (place < 0 || place > most) return {};
    const uint32_t last = (most - 1) / side;
    const uint32_t tile = std::min(static_cast<uint32_t>(place / side), last);
    if (tile != 0 && place == static_cast<double>(tile) * side) return {tile, tile - 1};
    return {tile};
  }

  // Along a border both tiles have the border's vertices, if they have terrain.
  static void merge(const FoundPlaces& other, FoundPlaces& best) {
    if (other.size() > best.size()) {
      FoundPlaces less = std::exchange(best, other);
      if (less.empty()) return;
      join(less.front(), best.front());
      join(less.back(), best.back());
      return;
    }
    for (size_t i = 0; i < best.size() && other.size() == best.size(); ++i) {
      join(other[i], best[i]);
      if (best[i].before == MICROTIN_QUERY_OK) continue;
      if (other[i].before != MICROTIN_QUERY_OK) {
        best[i].before = worse(best[i].before, other[i].before);
        continue;
      }
      best[i].before = MICROTIN_QUERY_OK;
      best[i].below = other[i].below;
      best[i].above = other[i].above;
    }
  }

  FoundPlaces in_tile(uint32_t tile, const Cut& begin, const Cut& end) const {
    const TileMesh found = surface_.mesh_of(tile);
    if (found.mesh == nullptr) return absent(begin, end, found.absent);
    const auto [below, above] = margins_of(found.mesh);
    const TileBox box = tile_box(grid_, tile);
    const Fine a = local(box, begin.at), b = local(box, end.at);
    const microtin_segment segment = {a.x, a.y, b.x, b.y};
    microtin_segment_state state = {};
    microtin_crossing crossing = {0, 0, 0, 0};
    const double from = begin.along(), length = end.along() - from;
    FoundPlaces places;
    do {
      const microtin_query_result result =
          microtin_mesh_profile_next(found.mesh, &segment, &state, &crossing, 0);
      if (result != MICROTIN_QUERY_OK) throw InternalFault("a profile has no next place");
      const auto reason = [&found](uint32_t answer) {
        const auto own = static_cast<microtin_query_result>(answer);
        return own == MICROTIN_QUERY_OUTSIDE ? found.absent : own;
      };
      const double along = from + length * (crossing.along / double{MICROTIN_ALONG_END});
      places.push_back({crossing.along == MICROTIN_ALONG_END ? end.along() : along, crossing.height,
                        reason(crossing.result), reason(crossing.before), below, above});
    } while (crossing.along != MICROTIN_ALONG_END);
    return places;
  }

  std::pair<double, double> margins_of(const microtin_mesh* mesh) const {
    Margins margins;
    microtin_mesh_margins(mesh, &margins.below, &margins.above);
    const auto stated = stated_everywhere(margins, surface_.placement.z);
    return stated ? std::pair(real(stated->below), real(stated->above)) : std::pair(kNone, kNone);
  }

  static FoundPlaces absent(const Cut& begin, const Cut& end, microtin_query_result why) {
    return {{begin.along(), 0, why, why, kNone, kNone}, {end.along(), 0, why, why, kNone, kNone}};
  }

  // Rounding does not lead out of a tile; the line's middle may, by a rounding of its own.
  static Fine local(const TileBox& box, Fine at) {
    return {std::clamp<int64_t>(at.x - box.x * kStep, 0, (box.x_end - box.x) * kStep),
            std::clamp<int64_t>(at.y - box.y * kStep, 0, (box.y_end - box.y) * kStep)};
  }

  static void append(const FoundPlaces& piece, FoundPlaces& places) {
    auto next = piece.begin();
    if (!places.empty()) join(*next++, places.back());
    places.insert(places.end(), next, piece.end());
  }

  const SampledSurface& surface_;
  TileGrid grid_;
  Fine from_, to_;
};

// --- From the lattice to real numbers ---

double real_at(const Axis& axis, double lattice) {
  return offset_of(axis) + step_of(axis) * lattice;
}

int64_t fine_coordinate(const char* name, const Axis& axis, double value) {
  constexpr double kFarthest = 0x1p32;
  const double lattice = (value - offset_of(axis)) / step_of(axis);
  if (!(std::abs(lattice) < kFarthest)) {
    throw Error(std::string(name) + " of an end of the profile is not a number near the terrain");
  }
  return std::llround(lattice * static_cast<double>(kStep));
}

// The name of `x`, by turns of a circle, that is nearest to the middle between two numbers.
double named_near(double x, double low, double high) {
  const double middle = (low + high) / 2;
  return x - 360 * std::round((x - middle) / 360);
}

class Way {
 public:
  Way(const Placement& placement, Unit horizontal, Fine from, Fine to)
      : placement_(placement), unit_(horizontal), from_(from), to_(to) {}

  Position at(double along) const {
    const auto between = [along](int64_t a, int64_t b) {
      return (static_cast<double>(a) + static_cast<double>(b - a) * along) /
             static_cast<double>(kStep);
    };
    return {real_at(placement_.x, between(from_.x, to_.x)),
            real_at(placement_.y, between(from_.y, to_.y))};
  }

  // In metres, between two places.
  double distance(const Position& a, const Position& b) const {
    if (unit_ != Unit::kDegree) {
      return metres_per(unit_).value_or(1) * std::hypot(b.x - a.x, b.y - a.y);
    }
    constexpr double kPart = 0.05;  // degrees in which the length of a degree hardly changes
    const int parts = 1 + static_cast<int>(std::abs(b.y - a.y) / kPart);
    double sum = 0;
    for (int i = 0; i < parts; ++i) {
      const Degree degree = degree_at(a.y + (b.y - a.y) * (i + 0.5) / parts);
      sum += std::hypot((b.x - a.x) * degree.x, (b.y - a.y) * degree.y) / parts;
    }
    return sum;
  }

  double earth_radius() const {
    if (unit_ != Unit::kDegree) return kMeanRadius;
    constexpr double kEquator = 6378137, kSquare = 0.0066943799901413;  // of the eccentricity
    const double sine = std::sin(at(0.5).y * kRadian);
    return kEquator * std::sqrt(1 - kSquare) / (1 - kSquare * sine * sine);
  }

  // The largest distance of the line from the great circle through its ends.
  double geodesic_deviation() const {
    if (unit_ != Unit::kDegree) return kNone;
    const Vector normal = cross_product(direction(at(0)), direction(at(1)));
    const double size = std::sqrt(dot(normal, normal));
    if (size < 1e-12) return 0;
    constexpr double kParts = 32;
    double most = 0;
    for (int i = 1; i < kParts; ++i) {
      const double beside = dot(normal, direction(at(i / kParts))) / size;
      most = std::max(most, std::abs(std::asin(std::clamp(beside, -1.0, 1.0))));
    }
    return most * kMeanRadius;
  }

 private:
  static constexpr double kRadian = 0.017453292519943295;

  static Vector direction(const Position& p) {
    const double cosine = std::cos(p.y * kRadian);
    return {cosine * std::cos(p.x * kRadian), cosine * std::sin(p.x * kRadian),
            std::sin(p.y * kRadian)};
  }

  Placement placement_;
  Unit unit_;
  Fine from_, to_;
};

ProfilePlace place_of(const Found& found, const Axis& z) {
  ProfilePlace place;
  place.along = found.along;
  if (found.result == MICROTIN_QUERY_OK) place.height = real_at(z, found.height / 65536.0);
  place.below = found.below;
  place.above = found.above;
  return place;
}

std::pair<Fine, Fine> ends_on_lattice(const SampledSurface& surface, Position from, Position to) {
  const Placement& at = surface.placement;
  if (surface.is_degrees) {
    from.x = named_near(from.x, real_at(at.x, static_cast<double>(surface.x_min)),
                        real_at(at.x, static_cast<double>(surface.x_max)));
    to.x = named_near(to.x, from.x, from.x);
  }
  return {{fine_coordinate("x", at.x, from.x), fine_coordinate("y", at.y, from.y)},
          {fine_coordinate("x", at.x, to.x), fine_coordinate("y", at.y, to.y)}};
}

}  // namespace

Profile profile_of(const SampledSurface& surface, Unit horizontal, Unit vertical, Position from,
                   Position to) {
  const auto [begin, end] = ends_on_lattice(surface, from, to);
  const FoundPlaces found = LineWalk(surface, begin, end).places();
  const Way way(surface.placement, horizontal, begin, end);
  Profile profile;
  profile.metres_per_height = metres_per(vertical).value_or(1);
  profile.earth_radius = way.earth_radius();
  profile.geodesic_deviation = way.geodesic_deviation();
  for (const Found& one : found) {
    ProfilePlace place = place_of(one, surface.placement.z);
    const Position at = way.at(place.along);
    if (!profile.places.empty()) {
      const ProfilePlace& before = profile.places.back();
      profile.length += way.distance({before.x, before.y}, at);
      place.is_known_before = one.before == MICROTIN_QUERY_OK;
      profile.result = worse(profile.result, one.before);
    }
    place.distance = profile.length;
    place.x = at.x;
    place.y = at.y;
    profile.result = worse(profile.result, one.result);
    profile.places.push_back(place);
  }
  return profile;
}

}  // namespace microtin::exporting

namespace microtin::encoder {
namespace {

template <class Before>
const ProfilePlace* first_of(const Profile& profile, const Before& before) {
  const ProfilePlace* first = nullptr;
  for (const ProfilePlace& place : profile.places) {
    if (!std::isnan(place.height) && (first == nullptr || before(place.height, first->height))) {
      first = &place;
    }
  }
  return first;
}

double between(double a, double b, double part) {
  return a * (1 - part) + b * part;
}

}  // namespace

const ProfilePlace* lowest_of(const Profile& profile) {
  return first_of(profile, std::less<double>());
}

const ProfilePlace* highest_of(const Profile& profile) {
  return first_of(profile, std::greater<double>());
}

std::vector<ProfilePlace> equal_places(const Profile& profile, size_t count) {
  std::vector<ProfilePlace> places;
  auto next = profile.places.begin();
  for (size_t i = 0; i < count; ++i) {
    const double along = count == 1 ? 0 : static_cast<double>(i) / static_cast<double>(count - 1);
    while (next->along < along) ++next;
    ProfilePlace place = *next;
    if (along < next->along) {
      const ProfilePlace& before = *(next - 1);
      const double part = (along - before.along) / (next->along - before.along);
      place.along = along;
      place.distance = between(before.distance, next->distance, part);
      place.x = between(before.x, next->x, part);
      place.y = between(before.y, next->y, part);
      place.height = next->is_known_before ? between(before.height, next->height, part)
                                           : std::numeric_limits<double>::quiet_NaN();
    }
    places.push_back(place);
  }
  return places;
}

}  // namespace microtin::encoder
