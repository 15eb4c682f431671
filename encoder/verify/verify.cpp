// SPDX-License-Identifier: MIT
// Comparing a decoded terrain with its source: by height queries at places of the lattice, and by
// the exact plane where points truly lie.
#include "encoder/verify/verify.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "shared/lattice.hpp"

namespace microtin::verifying {
namespace {

// Queries the heights of a terrain at numbers of a source.
class Asker {
 public:
  Asker(const microtin_mesh* mesh, const Placement& source, const Placement& lattice)
      : mesh_(mesh), x_(map_between(source.x, lattice.x)), y_(map_between(source.y, lattice.y)) {
    const uint32_t triangles = microtin_mesh_triangle_count(mesh);
    for (uint32_t t = 0; t < triangles; ++t) {
      uint32_t v[3];
      if (microtin_mesh_triangle(mesh, t, v) == MICROTIN_TRIANGLE_GHOST) continue;
      const Vertex first = vertex_of(mesh, v[0]);
      hint_for({first.x, first.y}) = t;
    }
  }

  // The place of (x, y) on the lattice, if it has one.
  std::optional<Point> place_of(int64_t x, int64_t y) const {
    const Wide kx = x_.nearest(x), ky = y_.nearest(y);
    if (kx < 0 || kx > kLatticeMax || ky < 0 || ky > kLatticeMax) return std::nullopt;
    return Point{static_cast<uint16_t>(kx), static_cast<uint16_t>(ky)};
  }

  // The terrain's height there, with 16 fractional bits, if it has one.
  std::optional<int32_t> height_at(Point place) {
    int32_t height = 0;
    uint32_t& hint = hint_for(place);
    if (hint == kNowhere) hint = last_;
    const microtin_query_result answer =
        microtin_mesh_height_at(mesh_, place.x * 256, place.y * 256, &hint, &height, 0, 0);
    last_ = hint;
    if (answer != MICROTIN_QUERY_OK) return std::nullopt;
    return height;
  }

 private:
  static constexpr uint32_t kNowhere = 0xFFFFFFFFu;

  uint32_t& hint_for(Point place) { return hints_[(place.x >> 8) * size_t{256} + (place.y >> 8)]; }

  const microtin_mesh* mesh_;
  LatticeMap x_, y_;
  // Points come in any order: a triangle of each 256 x 256 part of the lattice, if there is one,
  // and then the one where the last search there ended.
  std::vector<uint32_t> hints_ = std::vector<uint32_t>(size_t{256} * 256, kNowhere);
  uint32_t last_ = 0;  // where the last search of all ended
};

// Judges errors by posts' own bounds, if they have any and there is a bound.
class KeptBounds {
 public:
  KeptBounds(const OwnBounds& own, const std::optional<Decimal>& max_error)
      : bound_of_(own, max_error, kMaxDecimals), is_used_(!own.empty() && max_error) {}

  Wide bound_of(size_t post) const { return bound_of_(post); }

  void add(Wide error, size_t post) {
    if (is_used_) meter_.add(error, bound_of_(post));
  }

  void store_in(Verification& found) const {
    if (!is_used_) return;
    found.bounds = meter_.span();
    found.within_bound = meter_.keeps_all();
  }

 private:
  BoundOf bound_of_;
  BoundMeter meter_;
  bool is_used_;
};

}  // namespace

Verification verify(const microtin_mesh* mesh, const Source& source,
                    const std::optional<Decimal>& bound, const PostVisitor& visit) {
  Placement lattice;
  microtin_mesh_axes(mesh, &lattice.x, &lattice.y, &lattice.z);
  return verify(mesh, lattice, source, bound, visit);
}

Verification verify(const microtin_mesh* mesh, const Placement& lattice, const Source& source,
                    const std::optional<Decimal>& bound, const PostVisitor& visit) {
  const Placement numbers = placement_of(source);
  Asker asker(mesh, numbers, lattice);
  ErrorMeter meter(numbers.z, lattice.z);
  KeptBounds kept(bounds_of(source), bound);
  Verification result;
  for_each_numbered_post(source, [&](int64_t x, int64_t y, int64_t z, size_t number) {
    const std::optional<Point> place = asker.place_of(x, y);
    const std::optional<int32_t> height = place ? asker.height_at(*place) : std::nullopt;
    if (z == kVoidHeight) {
      ++result.voids;
      if (height) ++result.voids_answered;
      return;
    }
    ++result.posts;
    if (!height) return;
    ++result.covered;
    const double above = meter.add(z, *height);
    kept.add(meter.last(), number);
    if (visit) visit(place->x, place->y, z, above);
  });
  result.uncovered = result.posts - result.covered;
  meter.report(bound, result);
  kept.store_in(result);
  return result;
}

namespace {

// The mean of means in billionths, each of as many samples as it covers. Where 127 bits do not hold
// twice the sum, the means' last bits do not count.
Wide mean_of(const std::vector<Verification>& parts, uint64_t samples) {
  constexpr Wide kLimit = Wide{1} << 125;
  Wide largest = 0, sum = 0;
  for (const Verification& part : parts) {
    largest = std::max(largest, magnitude(mantissa_at(part.mean_error, kMaxDecimals)));
  }
  Wide unit = 1;
  while (largest / unit >= kLimit / static_cast<Wide>(samples)) unit *= 2;
  for (const Verification& part : parts) {
    const Wide mean = mantissa_at(part.mean_error, kMaxDecimals);
    sum += mean / unit * static_cast<Wide>(part.covered);
  }
  return round_divide(sum, static_cast<Wide>(samples)) * unit;
}

// The root of the mean of squared roots in billionths, each of as many samples as it covers,
// rounded up: in a coarser unit where a sum of squares does not hold them otherwise.
Wide root_mean_square_of(const std::vector<Verification>& parts, uint64_t samples) {
  const Wide most = Wide{1} << (samples <= uint64_t{1} << 33 ? 92 : 36);
  const auto billionths = [](const Verification& part) {
    return mantissa_at(part.rms_error, kMaxDecimals);
  };
  Wide largest = 0, unit = 1;
  for (const Verification& part : parts) largest = std::max(largest, billionths(part));
  while (ceil_divide(largest, unit) > most) unit *= 2;
  SquareSum squares;
  for (const Verification& part : parts) {
    squares.add(ceil_divide(billionths(part), unit), static_cast<Wide>(part.covered));
  }
  return squares.root_of_mean(static_cast<Wide>(samples), ceil_divide(largest, unit)) * unit;
}

// Known if it is of every part that covers posts.
std::optional<Distances> combined_everywhere(const std::vector<Verification>& parts) {
  Distances all;
  bool is_known = false;
  for (const Verification& part : parts) {
    if (part.covered == 0) continue;
    if (!part.everywhere) return std::nullopt;
    is_known = true;
    if (all.below <= part.everywhere->below) all.below = part.everywhere->below;
    if (all.above <= part.everywhere->above) all.above = part.everywhere->above;
  }
  return is_known ? std::optional(all) : std::nullopt;
}

}  // namespace

Verification combine(const std::vector<Verification>& parts) {
  Verification all;
  for (const Verification& part : parts) {
    all.posts += part.posts;
    all.covered += part.covered;
    all.uncovered += part.uncovered;
    all.voids += part.voids;
    all.voids_answered += part.voids_answered;
    if (all.max_error <= part.max_error) all.max_error = part.max_error;
    if (all.max_below <= part.max_below) all.max_below = part.max_below;
    if (all.max_above <= part.max_above) all.max_above = part.max_above;
    all.within_bound = all.within_bound && part.within_bound;
    if (part.bounds) (all.bounds ? *all.bounds : all.bounds.emplace()).add(*part.bounds);
  }
  all.everywhere = combined_everywhere(parts);
  if (all.covered == 0) return all;
  all.rms_error = make_decimal_up(root_mean_square_of(parts, all.covered), kMaxDecimals);
  all.mean_error = make_decimal_nearest(mean_of(parts, all.covered), kMaxDecimals);
  return all;
}

std::string broken_promise(const std::optional<Distances>& stated, const Distances& found,
                           const std::string& where) {
  if (!stated) return {};
  const bool is_below = !(found.below <= stated->below);
  if (!is_below && found.above <= stated->above) return {};
  return where + ", the surface is " + (is_below ? "below" : "above") + " the source by up to " +
         to_string(is_below ? found.below : found.above) + "; the header states at most " +
         to_string(is_below ? stated->below : stated->above);
}

namespace {

constexpr int64_t kBillion = 1000000000;
constexpr int kHalf = 46;  // bits
constexpr Wide kHalfMask = (Wide{1} << kHalf) - 1;

// Rounds down.
Wide shifted(Wide number) {
  return (number - (number & kHalfMask)) / (Wide{1} << kHalf);
}

}  // namespace

void SquareSum::add(Wide number, Wide times) {
  const Wide high = shifted(number), low = number & kHalfMask;
  high_ += high * high * times;
  middle_ += high * low * times;
  low_ += low * low * times;
}

bool SquareSum::operator<=(const SquareSum& other) const {
  // other - this, carried from part to part; what the parts keep is not negative.
  const Wide low = other.low_ - low_;
  const Wide middle = 2 * (other.middle_ - middle_) + shifted(low);
  return other.high_ - high_ + shifted(middle) >= 0;
}

Wide SquareSum::root_of_mean(Wide count, Wide largest) const {
  Wide low = -1, high = largest;  // low^2 * count < sum <= high^2 * count
  while (high - low > 1) {
    const Wide middle = low + (high - low) / 2;
    SquareSum all;
    all.add(middle, count);
    (*this <= all ? high : low) = middle;
  }
  return high;
}

ErrorMeter::ErrorMeter(const Axis& source, const Axis& lattice)
    : to_common_(static_cast<Wide>(lattice.denominator) * 65536),
      offset_(Wide{lattice.offset} * 65536),
      step_(static_cast<Wide>(lattice.numerator)),
      from_common_(static_cast<Wide>(source.denominator)),
      common_(to_common_ * from_common_) {}

double ErrorMeter::add(int64_t number, int32_t answer) {
  const Wide below = number * to_common_ - from_common_ * (offset_ + step_ * answer);
  const Wide error = magnitude(below);
  const Wide billionths =
      error / common_ * kBillion + ceil_divide(error % common_ * kBillion, common_);
  count(billionths, below > 0);
  return -static_cast<double>(below) / static_cast<double>(common_);
}

// In parts of a unit that source and lattice have in common, the surface is below by whole + rest /
// under. Both go into the billionths, which are rounded up once.
double ErrorMeter::add(int64_t number, const ExactHeight& height) {
  const Wide common = from_common_ * (to_common_ / 65536), base = offset_ / 65536;
  const auto [over, over_rest] = multiply_divide(from_common_ * step_, height.above, height.under);
  Wide whole = number * (to_common_ / 65536) - from_common_ * (base + step_ * height.base) - over;
  Wide rest = height.under - over_rest;
  whole += rest == height.under ? 0 : -1;
  rest = rest == height.under ? 0 : rest;
  const bool is_below = whole > 0 || (whole == 0 && rest != 0);
  if (whole < 0) {
    whole = rest == 0 ? -whole : -whole - 1;
    rest = rest == 0 ? 0 : height.under - rest;
  }
  const auto [fine, fine_rest] = multiply_divide(kBillion, rest, height.under);
  const Wide in_part = whole % common * kBillion + fine + (fine_rest != 0 ? 1 : 0);
  count(whole / common * kBillion + ceil_divide(in_part, common), is_below);
  const double away =
      (static_cast<double>(whole) + static_cast<double>(rest) / static_cast<double>(height.under)) /
      static_cast<double>(common);
  return is_below ? -away : away;
}

void ErrorMeter::count(Wide billionths, bool is_below) {
  last_ = billionths;
  Wide& largest = is_below ? below_ : above_;
  largest = std::max(largest, billionths);
  squares_.add(billionths, 1);
  sum_ += is_below ? -billionths : billionths;
  ++count_;
}

void ErrorMeter::report(const std::optional<Decimal>& bound, Verification& found) const {
  found.max_below = make_decimal_up(below_, kMaxDecimals);
  found.max_above = make_decimal_up(above_, kMaxDecimals);
  found.max_error = make_decimal_up(std::max(below_, above_), kMaxDecimals);
  found.rms_error = root_mean_square();
  found.mean_error = mean();
  found.within_bound = !bound || found.max_error <= *bound;
}

Decimal ErrorMeter::mean() const {
  return count_ == 0 ? Decimal{} : make_decimal_nearest(round_divide(sum_, count_), kMaxDecimals);
}

Decimal ErrorMeter::root_mean_square() const {
  if (count_ == 0) return {};
  return make_decimal_up(squares_.root_of_mean(count_, std::max(below_, above_)), kMaxDecimals);
}

namespace {

constexpr int64_t kBand = 256;  // rows that are queried from west to east together

class TruePlaces {
 public:
  TruePlaces(const Placement& lattice, const PointCloud& cloud) {
    const Axis numbers = decimal_axis(cloud.xy_decimals);
    x_ = map_between(numbers, lattice.x);
    y_ = map_between(numbers, lattice.y);
  }

  RealPlace exact(const SourcePoint& p) const {
    return place_of(coordinate(x_, p.x), coordinate(y_, p.y));
  }
  RealPlace nearest(const SourcePoint& p) const {
    return place_on_lattice(limited(x_.nearest(p.x)), limited(y_.nearest(p.y)));
  }
  bool moves(const SourcePoint& p) const {
    return x_.numerator(p.x) % x_.step != 0 || y_.numerator(p.y) % y_.step != 0;
  }

 private:
  static RealCoordinate coordinate(const LatticeMap& map, int64_t number) {
    const Wide numerator = map.numerator(number), whole = floor_divide(numerator, map.step);
    return {limited(whole), numerator - whole * map.step, map.step};
  }
  // Points of a source that is not the lattice's own may lie anywhere; no terrain goes so far.
  static int64_t limited(Wide place) {
    constexpr Wide kFar = Wide{1} << 62;
    return static_cast<int64_t>(std::clamp(place, -kFar, kFar));
  }

  LatticeMap x_{}, y_{};
};

// The order in which points are queried, so that neighbours follow each other.
std::vector<uint32_t> order_of(const PointCloud& cloud, const TruePlaces& places) {
  std::vector<uint32_t> order(cloud.points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<std::tuple<int64_t, int64_t>> keys;
  keys.reserve(order.size());
  for (const SourcePoint& p : cloud.points) {
    const RealPlace place = places.nearest(p);
    keys.emplace_back(-(place.y / kBand), place.x);
  }
  std::sort(order.begin(), order.end(),
            [&](uint32_t a, uint32_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
  return order;
}

}  // namespace

bool moves_points(const Placement& lattice, const PointCloud& cloud) {
  const TruePlaces places(lattice, cloud);
  return std::any_of(cloud.points.begin(), cloud.points.end(),
                     [&](const SourcePoint& p) { return places.moves(p); });
}

Verification verify_at_true_places(const HeightQuery& height_at, const Placement& lattice,
                                   const PointCloud& cloud, const std::optional<Decimal>& bound,
                                   const TruePlaceVisitor& visit) {
  const TruePlaces places(lattice, cloud);
  ErrorMeter meter(decimal_axis(cloud.z_decimals), lattice.z);
  KeptBounds kept(cloud.bounds, bound);
  Verification result;
  for (const uint32_t i : order_of(cloud, places)) {
    const SourcePoint& p = cloud.points[i];
    const RealPlace there = places.exact(p), nearest = places.nearest(p);
    ExactAnswer answer = height_at(there);
    if (answer.kind != MICROTIN_QUERY_OK) answer = height_at(nearest);
    ++result.posts;
    if (answer.kind != MICROTIN_QUERY_OK) continue;
    ++result.covered;
    const double above = meter.add(p.z, answer.height);
    kept.add(meter.last(), i);
    const Wide own = kept.bound_of(i);
    if (visit) {
      visit(nearest, there, own == BoundOf::kNone ? HUGE_VAL : static_cast<double>(own) / kBillion,
            above);
    }
  }
  result.uncovered = result.posts - result.covered;
  meter.report(bound, result);
  kept.store_in(result);
  return result;
}

WaterGauge::WaterGauge(int decimals, const std::optional<Decimal>& level)
    : number_(number_of(level, decimals)) {}

PostVisitor WaterGauge::visitor() {
  return [this](int64_t, int64_t, int64_t z, double above) {
    if (z == number_ && above != 0) ++moved_;
  };
}

}  // namespace microtin::verifying
