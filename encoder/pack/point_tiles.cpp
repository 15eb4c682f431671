// SPDX-License-Identifier: MIT
// The points of a cloud on the lattice of its pack, and each tile: what lies in it, its survey and
// its stream.
#include "encoder/pack/point_tiles.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/stream/encode.hpp"

namespace microtin::pack {
namespace {

constexpr uint32_t kPartBits = 16;

// The points of each square of 2^16 x 2^16 places, by its first place.
std::map<GlobalPost, std::vector<uint32_t>> squares(const std::vector<GlobalPost>& places) {
  std::map<GlobalPost, std::vector<uint32_t>> parts;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const GlobalPost first{places[i].x >> kPartBits << kPartBits,
                           places[i].y >> kPartBits << kPartBits};
    parts[first].push_back(static_cast<uint32_t>(i));
  }
  return parts;
}

Lattice lattice_from(Lattice whole, GlobalPost first) {
  whole.x.shift -= whole.x.step * first.x;
  whole.y.shift -= whole.y.step * first.y;
  whole.placement = placement_from(whole.placement, first);
  return whole;
}

Decimal larger(Decimal a, Decimal b) {
  return a <= b ? b : a;
}

// Calls visit(tile) for each tile that holds a place; for none if the place is kNowhere.
template <class Visit>
void visit_tiles(const TileGrid& grid, GlobalPost place, const Visit& visit) {
  if (place.x > grid.x_max || place.y > grid.y_max) return;
  for (const uint32_t tile : tiles_at(grid, place)) visit(tile);
}

}  // namespace

PointSurvey survey_points(const PointCloud& cloud, const LatticeOptions& options) {
  PointSurvey survey;
  survey.lattice = choose_pack_lattice(cloud, options);
  const auto places = places_on(cloud, survey.lattice.placement, INT32_MAX, INT32_MAX);
  for (const auto& [first, points] : squares(places)) {
    const Laid laid = lay_out(part_of(cloud, points), lattice_from(survey.lattice, first), options);
    for (const Sample& s : laid.survey.samples) {
      survey.samples.push_back(
          {{first.x + s.place.x, first.y + s.place.y}, s.height, s.lowest, s.highest});
    }
    survey.xy_step = laid.xy_step;
    survey.z_step = laid.z_step;
    survey.xy_displacement = larger(survey.xy_displacement, laid.xy_displacement);
    survey.merged += laid.merged;
  }
  std::sort(survey.samples.begin(), survey.samples.end(),
            [](const GlobalSample& a, const GlobalSample& b) { return a.place < b.place; });
  survey.x_max = survey.y_max = 0;
  for (const GlobalSample& s : survey.samples) {
    survey.x_max = std::max(survey.x_max, s.place.x);
    survey.y_max = std::max(survey.y_max, s.place.y);
  }
  return survey;
}

std::vector<GlobalPost> places_of(const std::vector<GlobalSample>& samples) {
  std::vector<GlobalPost> places;
  places.reserve(samples.size());
  for (const GlobalSample& sample : samples) places.push_back(sample.place);
  return places;
}

std::vector<GlobalPost> places_on(const PointCloud& cloud, const Placement& lattice, uint32_t x_max,
                                  uint32_t y_max) {
  const Placement numbers = placement_of(part_of(cloud, {}));
  const LatticeMap x_map = map_between(numbers.x, lattice.x);
  const LatticeMap y_map = map_between(numbers.y, lattice.y);
  std::vector<GlobalPost> places;
  places.reserve(cloud.points.size());
  for (const SourcePoint& p : cloud.points) {
    const Wide x = x_map.nearest(p.x), y = y_map.nearest(p.y);
    const bool inside = x >= 0 && x <= x_max && y >= 0 && y <= y_max;
    places.push_back(inside ? GlobalPost{static_cast<uint32_t>(x), static_cast<uint32_t>(y)}
                            : kNowhere);
  }
  return places;
}

Placement placement_from(const Placement& whole, GlobalPost first) {
  return {moved_axis(whole.x, first.x), moved_axis(whole.y, first.y), whole.z};
}

PointCloud part_of(const PointCloud& cloud, const std::vector<uint32_t>& points) {
  PointCloud part;
  part.xy_decimals = cloud.xy_decimals;
  part.z_decimals = cloud.z_decimals;
  part.points.reserve(points.size());
  for (const uint32_t i : points) part.points.push_back(cloud.points[i]);
  part.bounds = frame_of(cloud.bounds);
  if (!cloud.bounds.empty()) {
    for (const uint32_t i : points) part.bounds.numbers.push_back(cloud.bounds.numbers[i]);
  }
  return part;
}

// A counting sort: a tile's numbers follow those of the tile before it.
TileContents::TileContents(const TileGrid& grid, const std::vector<GlobalPost>& places)
    : start_(tile_count(grid) + 1) {
  for (const GlobalPost place : places) {
    visit_tiles(grid, place, [&](uint32_t tile) { ++start_[std::size_t{tile} + 1]; });
  }
  for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  numbers_.resize(static_cast<std::size_t>(start_.back()));
  std::vector<std::ptrdiff_t> next(start_);
  for (std::size_t i = 0; i < places.size(); ++i) {
    visit_tiles(grid, places[i], [&](uint32_t tile) {
      numbers_[static_cast<std::size_t>(next[tile]++)] = static_cast<uint32_t>(i);
    });
  }
}

PointTiles::PointTiles(const TiledCloud& tiled, const PointBorders& borders)
    : tiled_(tiled), borders_(borders), samples_(tiled.grid, places_of(tiled.survey.samples)) {}

Survey PointTiles::survey_of(uint32_t tile) const {
  const TileBox box = tile_box(tiled_.grid, tile);
  const TileSides sides(tiled_.grid, box);
  Survey survey;
  for (const uint32_t number : samples_.of_tile(tile)) {
    const GlobalSample& sample = tiled_.survey.samples[number];
    const Point place{static_cast<uint16_t>(sample.place.x - box.x),
                      static_cast<uint16_t>(sample.place.y - box.y)};
    if (sides.shares(place)) continue;
    survey.samples.push_back({place, sample.height, sample.lowest, sample.highest});
  }
  for (const auto& [place, z] : borders_.of_tile(tile)) {
    survey.samples.push_back(fixed_sample(place, z));
    survey.fixed.push_back(place);
  }
  std::sort(survey.samples.begin(), survey.samples.end(),
            [](const Sample& a, const Sample& b) { return a.place < b.place; });
  return survey;
}

uint32_t PointTiles::vertices_of(uint32_t tile, const SimplifyOptions& options) const {
  const Survey survey = survey_of(tile);
  if (!form_triangle(survey.samples)) return 0;
  if (!options.bounded) return static_cast<uint32_t>(survey.samples.size());
  return static_cast<uint32_t>(fit::simplify(survey, options).vertices.size());
}

EncodedTile PointTiles::encode(uint32_t tile, const std::vector<uint32_t>& points) const {
  const Survey survey = survey_of(tile);
  if (!form_triangle(survey.samples)) return {};
  const TileBox box = tile_box(tiled_.grid, tile);
  const Tin tin = simplify(survey, tiled_.simplify);
  auto [stream, decoded] =
      encode_and_decode(tin, Metadata(), tiled_.simplify.effort, origin_of(box));
  check_shared(decoded.mesh(), TileSides(tiled_.grid, box), borders_.of_tile(tile));
  const Verification measured = verifying::verify(
      decoded.mesh(), placement_from(tiled_.survey.lattice.placement, {box.x, box.y}),
      part_of(tiled_.cloud, points), tiled_.lattice.max_error);
  if (!keeps_options(tiled_.lattice, measured, 0)) {
    throw InternalFault("a decoded tile does not meet the options");
  }
  if (measured.bounds) append_chunk(*measured.bounds, stream);
  return {summary_of(stream, std::move(decoded), measured), std::move(stream)};
}

}  // namespace microtin::pack
