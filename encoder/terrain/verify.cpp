// SPDX-License-Identifier: MIT
// Asks the mesh at each post, and sums errors up exactly.
#include "encoder/terrain/verify.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/exact/mesh_vertex.hpp"
#include "shared/lattice.hpp"

namespace microtin::terrain {
namespace {

constexpr int64_t kBillion = 1000000000;

// Larger errors (a million units, in billionths) count as this in the mean, so that 2^26 squares
// fit.
constexpr Wide kLargestSquared = Wide{1} << 50;

// Differences between heights of the source and answers of the terrain, in billionths of a unit.
class ErrorMeter {
 public:
  ErrorMeter(const Axis& source, const Axis& lattice)
      : to_common_(static_cast<Wide>(lattice.denominator) * 65536),
        offset_(Wide{lattice.offset} * 65536),
        step_(static_cast<Wide>(lattice.numerator)),
        from_common_(static_cast<Wide>(source.denominator)),
        common_(to_common_ * from_common_) {}

  // `number` is the source's; `answer` is a lattice height with 16 fractional bits. With 60 and 31
  // bits in these, 40 in the axes and 30 in the source's denominator, sums stay below 2^117.
  // Returns how far the answer is above, in units.
  double add(int64_t number, int32_t answer) {
    const Wide below = number * to_common_ - from_common_ * (offset_ + step_ * answer);
    const Wide error = magnitude(below);
    const Wide billionths =
        error / common_ * kBillion + ceil_divide(error % common_ * kBillion, common_);
    largest_ = std::max(largest_, billionths);
    if (below > 0) deepest_ = std::max(deepest_, billionths);
    const Wide limited = std::min(billionths, kLargestSquared);
    squares_ += limited * limited;
    sum_ += below > 0 ? -limited : limited;
    ++count_;
    return -static_cast<double>(below) / static_cast<double>(common_);
  }

  Decimal largest() const { return make_decimal(largest_, kMaxDecimals); }
  Decimal deepest() const { return make_decimal(deepest_, kMaxDecimals); }

  Decimal mean() const {
    return count_ == 0 ? Decimal{} : make_decimal(round_divide(sum_, count_), kMaxDecimals);
  }

  // Rounded up.
  Decimal root_mean_square() const {
    if (count_ == 0) return {};
    const Wide mean = ceil_divide(squares_, count_);
    Wide low = -1, high = kLargestSquared;  // low^2 < mean <= high^2
    while (high - low > 1) {
      const Wide middle = (low + high) / 2;
      (middle * middle < mean ? low : high) = middle;
    }
    return make_decimal(high, kMaxDecimals);
  }

 private:
  Wide to_common_, offset_, step_, from_common_, common_;
  Wide largest_ = 0, deepest_ = 0;
  Wide squares_ = 0, sum_ = 0;
  int64_t count_ = 0;
};

// Asks a terrain for heights at numbers of a source.
class Asker {
 public:
  Asker(const microtin_mesh* mesh, const Placement& source, const Placement& lattice)
      : mesh_(mesh), x_(map_between(source.x, lattice.x)), y_(map_between(source.y, lattice.y)) {
    const uint32_t triangles = microtin_triangle_count(mesh);
    for (uint32_t t = 0; t < triangles; ++t) {
      uint32_t v[3];
      if (microtin_triangle(mesh, t, v) == MICROTIN_GHOST) continue;
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
    const microtin_answer answer =
        microtin_height_at(mesh_, place.x * 256, place.y * 256, 0, &hint, &height);
    last_ = hint;
    if (answer != MICROTIN_HEIGHT) return std::nullopt;
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

}  // namespace

Verification verify(const microtin_mesh* mesh, const Source& source,
                    const std::optional<Decimal>& bound, const PostVisitor& visit) {
  Placement lattice;
  microtin_placement(mesh, &lattice.x, &lattice.y, &lattice.z);
  return verify(mesh, lattice, source, bound, visit);
}

Verification verify(const microtin_mesh* mesh, const Placement& lattice, const Source& source,
                    const std::optional<Decimal>& bound, const PostVisitor& visit) {
  const Placement numbers = placement_of(source);
  Asker asker(mesh, numbers, lattice);
  ErrorMeter meter(numbers.z, lattice.z);
  Verification result;
  for_each_post(source, [&](int64_t x, int64_t y, int64_t z) {
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
    if (visit) visit(place->x, place->y, z, above);
  });
  result.uncovered = result.posts - result.covered;
  result.max_error = meter.largest();
  result.max_below = meter.deepest();
  result.rms_error = meter.root_mean_square();
  result.mean_error = meter.mean();
  result.within_bound = !bound || result.max_error <= *bound;
  return result;
}

Verification combine(const std::vector<Verification>& parts) {
  Verification all;
  double squares = 0;
  Wide sum = 0;  // of billionths: below 2^63 for each of at most 2^62 samples
  for (const Verification& part : parts) {
    all.posts += part.posts;
    all.covered += part.covered;
    all.uncovered += part.uncovered;
    all.voids += part.voids;
    all.voids_answered += part.voids_answered;
    if (all.max_error <= part.max_error) all.max_error = part.max_error;
    if (all.max_below <= part.max_below) all.max_below = part.max_below;
    const double rms = std::stod(to_string(part.rms_error));
    squares += rms * rms * static_cast<double>(part.covered);
    sum += mantissa_at(part.mean_error, kMaxDecimals) * static_cast<Wide>(part.covered);
    all.within_bound = all.within_bound && part.within_bound;
  }
  const double rms = all.covered == 0 ? 0 : std::sqrt(squares / static_cast<double>(all.covered));
  all.rms_error = make_decimal(static_cast<Wide>(std::ceil(rms * kBillion)), kMaxDecimals);
  if (all.covered != 0) {
    all.mean_error = make_decimal(round_divide(sum, static_cast<Wide>(all.covered)), kMaxDecimals);
  }
  return all;
}

}  // namespace microtin::terrain
