// SPDX-License-Identifier: MIT
// Cuts clouds into packs, and compares packs with clouds.
#include "encoder/pack/point_pack.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/work.hpp"
#include "encoder/files/output.hpp"
#include "encoder/fit/simplify.hpp"
#include "encoder/pack/encode.hpp"
#include "encoder/pack/point_tiles.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::pack {

// Lays points out, cuts them into tiles and encodes each.

namespace {

constexpr std::size_t kPilot = 20000;    // points
constexpr double kPointsPerVertex = 16;  // of simplified terrain, to begin with

// More tiles than that are nearly all empty.
constexpr uint64_t kTilesOfFew = 30000, kTilesPerPoint = 16;

// Keeps the points in the middle, in ascending order of a coordinate, as many as wanted.
template <class Before>
void keep_middle(std::vector<uint32_t>& points, std::size_t wanted, const Before& before) {
  if (points.size() <= wanted) return;
  const auto skipped = static_cast<std::ptrdiff_t>((points.size() - wanted) / 2);
  const auto end = skipped + static_cast<std::ptrdiff_t>(wanted);
  std::nth_element(points.begin(), points.begin() + skipped, points.end(), before);
  std::nth_element(points.begin() + skipped, points.begin() + end, points.end(), before);
  points.erase(points.begin() + end, points.end());
  points.erase(points.begin(), points.begin() + skipped);
}

// Points around the middle.
PointCloud pilot_of(const PointCloud& cloud) {
  std::vector<uint32_t> points(cloud.points.size());
  std::iota(points.begin(), points.end(), 0u);
  const auto strip = static_cast<std::size_t>(
      std::sqrt(static_cast<double>(points.size()) * static_cast<double>(kPilot)));
  const auto at = [&cloud](uint32_t i) -> const SourcePoint& { return cloud.points[i]; };
  keep_middle(points, strip, [&](uint32_t a, uint32_t b) {
    return std::tie(at(a).x, at(a).y, at(a).z) < std::tie(at(b).x, at(b).y, at(b).z);
  });
  keep_middle(points, kPilot, [&](uint32_t a, uint32_t b) {
    return std::tie(at(a).y, at(a).x, at(a).z) < std::tie(at(b).y, at(b).x, at(b).z);
  });
  std::sort(points.begin(), points.end());
  return part_of(cloud, points);
}

// The cloud on a lattice with the z step that suits its middle best, unless one was requested.
PointSurvey survey_of(const PointCloud& cloud, LatticeOptions& lattice, SimplifyOptions simplify) {
  if (simplify.bounded && !lattice.z_step) {
    try {
      if (simplify.search == Search::kNormal) simplify.search = Search::kFast;
      LatticeOptions pilot = lattice;
      pilot.xy_step.reset();
      lattice.z_step = approximate(pilot_of(cloud), pilot, simplify).laid.z_step;
      return survey_points(cloud, lattice);
    } catch (const Error&) {  // no triangle in the middle, or too fine for the whole
      lattice.z_step.reset();
    }
  }
  return survey_points(cloud, lattice);
}

// About `pieces` tiles along the longer side.
TileGrid grid_in_pieces(const PointSurvey& survey, uint32_t pieces) {
  const uint32_t longer = std::max(survey.x_max, survey.y_max);
  return grid_of(survey.x_max, survey.y_max, (longer - 1) / pieces + 1);
}

// The vertices of the tile that has most.
uint32_t most_vertices(const TiledCloud& tiled) {
  SimplifyOptions options = tiled.simplify;
  options.search = Search::kFast;
  const PointBorders borders(tiled.survey, tiled.triangulation, tiled.grid, tiled.tolerance);
  const PointTiles tiles(tiled, borders);
  std::vector<uint32_t> vertices(tile_count(tiled.grid));
  for_each_parallel(vertices.size(), [&](std::size_t i) {
    vertices[i] = tiles.vertices_of(static_cast<uint32_t>(i), options);
  });
  return *std::max_element(vertices.begin(), vertices.end());
}

[[noreturn]] void refuse_extent(const TiledCloud& tiled) {
  const uint64_t points = tiled.cloud.points.size();
  throw Error(parameter("xy_step") + ' ' + to_string(tiled.survey.xy_step) +
              " is too fine: the pack needs more than " + std::to_string(kMostTiles) +
              " tiles of at most " + std::to_string(kLatticeMax) + " steps; use " +
              to_string(finest_step(tiled.cloud, std::min<uint64_t>(points, kMostTiles))) +
              " or more");
}

[[noreturn]] void refuse_tiles(uint32_t most_vertices) {
  throw Error("the pack needs more than " + std::to_string(kMostTiles) +
              " tiles, or tiles of one " + "step" +
              (most_vertices == 0
                   ? std::string()
                   : ", and a tile still has " + std::to_string(most_vertices) + " vertices") +
              "; increase " + parameter("tile_vertices"));
}

[[noreturn]] void refuse_crowds(uint64_t tiles, uint32_t most_vertices) {
  throw Error(
      "the points lie in clusters so far apart that they need more than " + std::to_string(tiles) +
      " tiles, and a tile still has " + std::to_string(most_vertices) +
      " vertices; encode each cluster as its own pack, or increase " + parameter("tile_vertices"));
}

// The fewest pieces along the longer side, at least `fewest`, found to keep tiles within the number
// of vertices.
uint32_t choose_pieces(TiledCloud tiled, const PackOptions& options, uint32_t fewest) {
  const double x_max = tiled.survey.x_max, y_max = tiled.survey.y_max;
  const double points = options.max_vertices * (tiled.simplify.bounded ? kPointsPerVertex : 1);
  const double tiles = static_cast<double>(tiled.survey.samples.size()) / points;
  const double guess = std::sqrt(tiles * std::max(x_max, y_max) / std::min(x_max, y_max));
  const auto longer = static_cast<uint32_t>(std::max(x_max, y_max));
  fewest = std::max(fewest, (longer - 1) / kLatticeMax + 1);
  if (has_too_many_tiles(grid_in_pieces(tiled.survey, fewest))) refuse_extent(tiled);
  uint32_t fitting = 0, most = 0;
  uint32_t pieces = std::max(fewest, static_cast<uint32_t>(std::min<double>(guess, longer)));
  const uint64_t plenty =
      std::max<uint64_t>(kTilesOfFew + kTilesPerPoint * tiled.survey.samples.size(),
                         tile_count(grid_in_pieces(tiled.survey, pieces)));
  for (;;) {
    tiled.grid = grid_in_pieces(tiled.survey, pieces);
    if (pieces > longer || has_too_many_tiles(tiled.grid)) refuse_tiles(most);
    if (tile_count(tiled.grid) > plenty) refuse_crowds(plenty, most);
    most = most_vertices(tiled);
    const uint32_t allowed = most_vertices(options, tiled.grid);
    if (most <= allowed) fitting = pieces;
    if (most > allowed) fewest = pieces + 1;
    const double ratio = std::min(2.0, std::sqrt(static_cast<double>(most) / allowed));
    const uint32_t next = std::max(fewest, static_cast<uint32_t>(std::ceil(pieces * ratio)));
    if (fitting != 0 && next >= fitting) return fitting;
    pieces = next;
  }
}

std::vector<EncodedTile> encode_tiles(const TiledCloud& tiled,
                                      const std::vector<GlobalPost>& places) {
  const PointBorders borders(tiled.survey, tiled.triangulation, tiled.grid, tiled.tolerance);
  const PointTiles tiles(tiled, borders);
  const TileContents points(tiled.grid, places);
  std::vector<EncodedTile> encoded(tile_count(tiled.grid));
  for_each_parallel(encoded.size(), [&](std::size_t i) {
    const auto tile = static_cast<uint32_t>(i);
    encoded[i] = tiles.encode(tile, points.of_tile(tile));
  });
  return encoded;
}

bool all_fit(const std::vector<EncodedTile>& tiles, uint32_t most) {
  return std::all_of(tiles.begin(), tiles.end(), [most](const EncodedTile& tile) {
    return tile.summary.vertices <= most && fits(tile.summary, most);
  });
}

}  // namespace

Decimal finest_step(const PointCloud& cloud, uint64_t tiles) {
  NumberRange x, y;
  for (const SourcePoint& p : cloud.points) {
    x.add(p.x);
    y.add(p.y);
  }
  for (Wide power = 1;; power *= 10) {
    for (const int digit : {1, 2, 5}) {
      const auto across = [step = power * digit](const NumberRange& range) {
        return ceil_divide(Wide{range.high} - range.low + step, step * kLatticeMax);
      };
      if (across(x) * across(y) <= tiles) return make_decimal(power * digit, cloud.xy_decimals);
    }
  }
}

PointPack encode_point_pack(const PointCloud& cloud, const PackOptions& options,
                            Metadata metadata) {
  LatticeOptions lattice = options.lattice;
  const PointSurvey survey = survey_of(cloud, lattice, options.simplify);
  const GlobalTriangulation triangulation(places_of(survey.samples));
  TiledCloud tiled{cloud,   survey,           triangulation,
                   lattice, options.simplify, choose_tolerance(survey, triangulation, lattice),
                   {}};
  const Placement& placement = survey.lattice.placement;
  const auto places = places_on(cloud, placement, survey.x_max, survey.y_max);
  std::vector<EncodedTile> tiles;
  uint32_t pieces = 0;
  do {  // a longer search seldom finds more vertices than the one for the plan
    pieces = choose_pieces(tiled, options, pieces + 1);
    tiled.grid = grid_in_pieces(survey, pieces);
    tiles = encode_tiles(tiled, places);
  } while (!all_fit(tiles, most_vertices(options, tiled.grid)));
  metadata.placement = placement;
  metadata.accuracy = Accuracy{lattice.max_error, {}, {}, {}};
  metadata.side = side_of(lattice.max_error, lattice.never_below);
  metadata.classes = cloud.classes;
  metadata.bounds = stated_bounds(cloud.bounds, lattice.max_error);
  if (survey.merged != 0) metadata.duplicates = DuplicateRule::kMiddle;
  PointPack pack{{tiled.grid, std::move(metadata), {}},
                 {},
                 survey.xy_step,
                 survey.xy_displacement,
                 survey.merged};
  JoinedStreams streams;
  for (EncodedTile& tile : tiles) {
    tile.summary.offset = streams.add(tile.stream);
    tile.stream = {};
    pack.content.tiles.push_back(tile.summary);
  }
  pack.streams = streams.bytes();
  return pack;
}

// Compares a pack with points: the tiles that hold a point are queried.

namespace {

bool answers(const microtin_mesh* mesh, const TileBox& box, GlobalPost place, uint32_t* hint) {
  int32_t height = 0;
  return microtin_mesh_height_at(mesh, static_cast<int32_t>(place.x - box.x) * 256,
                                 static_cast<int32_t>(place.y - box.y) * 256, hint, &height, 0,
                                 0) == MICROTIN_QUERY_OK;
}

}  // namespace

Verification verify(const PackFile& pack, const PointCloud& cloud,
                    const std::optional<Decimal>& bound, const PostVisitor& visit) {
  const TileGrid& grid = pack.grid();
  const Placement& placement = pack.metadata().placement;
  const std::vector<GlobalPost> places = places_on(cloud, placement, grid.x_max, grid.y_max);
  const TileContents points(grid, places);
  std::vector<Verification> parts(pack.entries().size());
  std::vector<VisitLog> visits(parts.size());
  std::vector<std::vector<uint32_t>> covered(parts.size());
  for_each_parallel(parts.size(), [&](std::size_t i) {
    const auto number = static_cast<uint32_t>(i);
    const std::vector<uint32_t> here = points.of_tile(number);
    if (here.empty()) return;
    const std::optional<DecodedTerrain> tile = pack.tile(number);
    if (!tile) return;
    const TileBox box = tile_box(grid, number);
    parts[i] = verifying::verify(tile->mesh(), placement_from(placement, {box.x, box.y}),
                                 part_of(cloud, here), bound,
                                 visit ? visits[i].recorder(box.x, box.y) : PostVisitor());
    uint32_t hint = 0;
    for (const uint32_t point : here) {
      if (answers(tile->mesh(), box, places[point], &hint)) covered[i].push_back(point);
    }
  });
  for (const VisitLog& log : visits) log.replay(visit);
  std::vector<bool> is_covered(places.size());
  for (const auto& numbers : covered) {
    for (const uint32_t point : numbers) is_covered[point] = true;
  }
  Verification all = combine(parts);
  all.posts = places.size();
  all.covered = static_cast<uint64_t>(std::count(is_covered.begin(), is_covered.end(), true));
  all.uncovered = all.posts - all.covered;
  return all;
}

}  // namespace microtin::pack
