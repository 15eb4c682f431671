// SPDX-License-Identifier: MIT
// Asks the mesh at each post.
#include "encoder/terrain/verify.hpp"

#include <algorithm>
#include <string>

#include "encoder/exact/lattice_map.hpp"
#include "encoder/exact/mesh_vertex.hpp"
#include "encoder/terrain/error_meter.hpp"
#include "shared/lattice.hpp"

namespace microtin::terrain {
namespace {

// Asks a terrain for heights at numbers of a source.
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
  meter.tell(bound, result);
  return result;
}

namespace {

// The mean of means in billionths, each of as many samples as it covers. Where 127 bits do not hold
// twice the sum, the means' last bits do not count.
Wide mean_of(const std::vector<Verification>& parts, uint64_t samples) {
  constexpr Wide kMost = Wide{1} << 125;
  Wide largest = 0, sum = 0;
  for (const Verification& part : parts) {
    largest = std::max(largest, magnitude(mantissa_at(part.mean_error, kMaxDecimals)));
  }
  Wide unit = 1;
  while (largest / unit >= kMost / static_cast<Wide>(samples)) unit *= 2;
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
    all.within_bound = all.within_bound && part.within_bound;
  }
  if (all.covered == 0) return all;
  all.rms_error = make_decimal_up(root_mean_square_of(parts, all.covered), kMaxDecimals);
  all.mean_error = make_decimal_nearest(mean_of(parts, all.covered), kMaxDecimals);
  return all;
}

}  // namespace microtin::terrain
