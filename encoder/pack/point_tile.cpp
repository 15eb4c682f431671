// SPDX-License-Identifier: MIT
// One tile of a cloud of points: what lies in it, its survey and its stream.
#include <algorithm>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/pack/point_tiles.hpp"
#include "encoder/stream/encode.hpp"

namespace microtin::pack {

// Sorts things by the tiles that hold them: counting sort.

namespace {

template <class Visit>
void visit_tiles(const TileGrid& grid, GlobalPost place, const Visit& visit) {
  if (place.x > grid.x_max || place.y > grid.y_max) return;
  for (const uint32_t tile : tiles_at(grid, place)) visit(tile);
}

}  // namespace

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

// Surveys the points of a tile with its borders, and encodes it.

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
