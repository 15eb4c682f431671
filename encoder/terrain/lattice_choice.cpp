// SPDX-License-Identifier: MIT
// Finds the finest step and the offset with which all numbers fit the lattice.
#include "encoder/terrain/lattice_choice.hpp"

#include <algorithm>
#include <numeric>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"
#include "shared/lattice.hpp"

namespace microtin::terrain {
namespace {

// Axes that share their step.
struct AxisGroup {
  std::vector<NumberRange> ranges;
  int decimals;         // of the numbers
  int needed_decimals;  // of the refined numbers, at least
  int lattice_low, lattice_high;
  const char* parameter;               // that sets the step
  std::optional<int64_t> anchor = {};  // a number that must be on the lattice
  int bits = 16;                       // of the lattice
  bool from_low = false;               // the lowest number goes to the lattice's first
};

struct GroupFit {
  std::vector<LatticeMap> maps;  // one for each range; none if one does not fit
  int decimals = 0;
};

// The map of one axis, if the range is not too wide.
std::optional<LatticeMap> fit(const NumberRange& range, Wide scale, Wide step,
                              const AxisGroup& group) {
  const auto rest_of = [step](Wide number) { return number - floor_divide(number, step) * step; };
  const Wide low = scale * range.low;
  const bool same_rest = scale * range.spacing % step == 0;
  const Wide rest = group.anchor ? rest_of(scale * *group.anchor) : same_rest ? rest_of(low) : 0;
  const Wide first = floor_divide(low - rest, step) * step + rest;
  const Wide from_low = group.lattice_low * step - first;
  for (const Wide shift : {group.from_low ? from_low : -rest, -first, from_low}) {
    const LatticeMap map{scale, shift, step};
    if (map.numerator(range.low) >= group.lattice_low * step &&
        map.nearest(range.high) <= group.lattice_high) {
      return map;
    }
  }
  return std::nullopt;
}

GroupFit fit_all(const AxisGroup& group, Decimal step) {
  GroupFit fits;
  fits.decimals = std::max({group.decimals, group.needed_decimals, step.decimals});
  const Wide scale = power_of_ten(fits.decimals - group.decimals);
  for (const NumberRange& range : group.ranges) {
    const auto map = fit(range, scale, mantissa_at(step, fits.decimals), group);
    if (!map) return {};
    fits.maps.push_back(*map);
  }
  return fits;
}

struct FinestFit {
  GroupFit fits;
  Decimal step;
};

FinestFit fit_finest(const AxisGroup& group) {
  for (int64_t power = 1;; power *= 10) {
    for (const int64_t digit : {1, 2, 5}) {
      const Decimal step = make_decimal(digit * power, group.decimals);
      GroupFit fits = fit_all(group, step);
      if (!fits.maps.empty()) return {std::move(fits), step};
    }
  }
}

GroupFit fit_explicit(const AxisGroup& group, Decimal step) {
  constexpr int64_t kLargest = 1000000000;  // keeps products with an axis in 128 bits
  const std::string name = parameter(group.parameter) + ' ' + to_string(step);
  if (step.mantissa <= 0 || !(step <= Decimal{kLargest, 0})) {
    throw Error(name + " is out of range; use a number above 0, up to " + std::to_string(kLargest));
  }
  GroupFit fits = fit_all(group, step);
  if (fits.maps.empty()) {
    throw Error(name + " is too fine: " + std::to_string(group.bits) +
                " bits do not hold the source's range in such steps; use " +
                to_string(fit_finest(group).step) + " or more");
  }
  return fits;
}

GroupFit choose(const AxisGroup& group, const std::optional<Decimal>& step) {
  return step ? fit_explicit(group, *step) : fit_finest(group).fits;
}

// The real coordinates of a map's lattice, given those of the source's numbers, which are
// (step * k - shift) / scale.
Axis lattice_axis(const Axis& source, const LatticeMap& map) {
  const Wide numerator = static_cast<Wide>(source.numerator);
  return reduced_axis(source.offset * map.scale - numerator * map.shift, numerator * map.step,
                      static_cast<Wide>(source.denominator) * map.scale);
}

AxisGroup height_group(const NumberRange& z, int decimals, const OwnBounds& bounds,
                       const LatticeOptions& options) {
  if (z.empty()) throw Error("there is no height");
  return {{z},
          decimals,
          options.max_error ? std::max(options.max_error->decimals, bounds.decimals) : 0,
          INT16_MIN,
          INT16_MAX,
          "z_step",
          number_of(options.water_level, decimals)};
}

}  // namespace

void NumberRange::add(int64_t number) {
  if (empty()) {
    low = high = number;
    return;
  }
  // What a spacing of 1 divides need not be divided.
  if (spacing != 1) spacing = std::gcd(spacing, number - low);
  low = std::min(low, number);
  high = std::max(high, number);
}

void NumberRange::add(const NumberRange& others) {
  if (others.empty()) return;
  add(others.low);
  add(others.high);
  spacing = std::gcd(spacing, others.spacing);
}

Lattice choose_post_lattice(const Raster& frame, const NumberRange& heights,
                            const LatticeOptions& options) {
  const GroupFit up =
      choose(height_group(heights, frame.decimals, frame.bounds, options), options.z_step);
  const LatticeMap itself{1, 0, 1};
  const Axis up_axis = decimal_axis(frame.decimals);
  return {itself, itself,      up.maps[0],
          0,      up.decimals, {frame.x, frame.y, lattice_axis(up_axis, up.maps[0])}};
}

Lattice post_lattice_at(const Raster& frame, const NumberRange& heights, const Axis& z,
                        const LatticeOptions& options) {
  const AxisGroup group = height_group(heights, frame.decimals, frame.bounds, options);
  const Axis step = {0, z.numerator, z.denominator};
  const int decimals =
      std::max({group.decimals, group.needed_decimals, decimals_of(z), decimals_of(step)});
  if (decimals > kMaxDecimals) throw Error("the heights have too many decimals; round them");
  const Wide unit = power_of_ten(decimals), parts = static_cast<Wide>(z.denominator);
  const LatticeMap map{power_of_ten(decimals - group.decimals), -z.offset * unit / parts,
                       static_cast<Wide>(z.numerator) * unit / parts};
  const Axis up = decimal_axis(frame.decimals);
  const LatticeMap itself{1, 0, 1};
  Lattice lattice{itself, itself, map, 0, decimals, {frame.x, frame.y, z}};
  if (map.step <= 0 || !is_same(lattice_axis(up, map), z)) {
    throw Error("the heights are on no decimal lattice");
  }
  if (map.nearest(heights.low) < INT16_MIN || map.nearest(heights.high) > INT16_MAX) {
    throw Error("heights are beyond the lattice's range");
  }
  return lattice;
}

namespace {

Lattice choose(const Source& source, AxisGroup places, const LatticeOptions& options) {
  NumberRange x, y, z;
  for_each_post(source, [&](int64_t px, int64_t py, int64_t pz) {
    x.add(px);
    y.add(py);
    if (pz != kVoidHeight) z.add(pz);
  });
  const auto* raster = std::get_if<Raster>(&source);
  if (raster != nullptr && !options.xy_step && std::max(x.high, y.high) > kLatticeMax) {
    throw Error("a raster of more than 65536 posts in a row needs " + parameter("xy_step") +
                " above 1, or a pack (.mtp)");
  }
  const auto* cloud = std::get_if<PointCloud>(&source);
  places.ranges = {x, y};
  places.decimals = cloud != nullptr ? cloud->xy_decimals : 0;
  const AxisGroup heights = height_group(z, height_decimals(source), bounds_of(source), options);
  const GroupFit xy = choose(places, options.xy_step);
  const GroupFit up = choose(heights, options.z_step);
  const Placement numbers = placement_of(source);
  const Placement placement{lattice_axis(numbers.x, xy.maps[0]),
                            lattice_axis(numbers.y, xy.maps[1]),
                            lattice_axis(numbers.z, up.maps[0])};
  return {xy.maps[0], xy.maps[1], up.maps[0], xy.decimals, up.decimals, placement};
}

}  // namespace

Lattice choose_lattice(const Source& source, const LatticeOptions& options) {
  return choose(source, {{}, 0, 0, 0, kLatticeMax, "xy_step"}, options);
}

Lattice choose_pack_lattice(const PointCloud& cloud, const LatticeOptions& options) {
  return choose(cloud, {{}, 0, 0, 0, INT32_MAX, "xy_step", {}, 31, true}, options);
}

}  // namespace microtin::terrain
