// SPDX-License-Identifier: MIT
// Surveys a tile with the vertices its borders share, encodes it, and checks both.
#include "encoder/pack/tile.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <set>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/pack/kept_tiles.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "encoder/verify/everywhere.hpp"
#include "encoder/verify/water_gauge.hpp"
#include "shared/pack_format.hpp"
#include "shared/predicates.hpp"

namespace microtin::pack {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw InternalFault("a decoded tile " + what);
}

// The posts of a tile. On borders with other tiles the shared vertices stand for all posts with
// heights, also where no post is: they are fixed.
Survey survey_of_tile(const TiledRaster& tiled, const TilePosts& posts,
                      const SharedVertices& shared) {
  const TileSides sides(tiled.grid, posts.box());
  const Survey all = survey_of(tiled, posts.tile());
  Survey survey;
  survey.voids = all.voids;
  survey.samples.reserve(all.samples.size());
  const auto is_before = [](const Sample& a, const Sample& b) { return a.place < b.place; };
  for (const Sample& sample : all.samples) {
    if (!sides.shares(sample.place)) survey.samples.push_back(sample);
  }
  const auto own = static_cast<std::ptrdiff_t>(survey.samples.size());
  for (const auto& [place, step] : shared) {
    const int32_t height = step * 65536;
    survey.samples.push_back({place, height, height, height});
    survey.fixed.push_back(place);
  }
  std::inplace_merge(survey.samples.begin(), survey.samples.begin() + own, survey.samples.end(),
                     is_before);
  return survey;
}

// Whether a stream can hold it: its samples form a triangle. Throws Error if not and posts of it
// lie on no border, so that no other tile holds them.
bool has_terrain(const TileBox& box, const Survey& survey) {
  if (form_triangle(survey.samples)) return true;
  if (survey.samples.size() == survey.fixed.size()) return false;
  throw Error("the tile from column " + std::to_string(box.x) + ", row " + std::to_string(box.y) +
              " has only " + std::to_string(survey.samples.size()) +
              " heights, which do not form a triangle; change " + parameter("tile_vertices"));
}

bool has_terrain(const TiledRaster& tiled, uint32_t tile) {
  if (tiled.kept != nullptr && tiled.kept->keeps(tile)) return tiled.kept->has_terrain(tile);
  const TilePosts posts(tiled, tile);
  return form_triangle(survey_of_tile(tiled, posts, shared_vertices(tiled, posts)).samples);
}

// Every post of a tile without terrain must be one of a tile that has it.
void check_covered_by_others(const TiledRaster& tiled, const TilePosts& posts) {
  for (const GlobalPost post : uncovered_posts(nullptr, posts.tile(), posts.box())) {
    const std::vector<uint32_t> holders = tiles_at(tiled.grid, post);
    if (std::any_of(holders.begin(), holders.end(),
                    [&](uint32_t tile) { return has_terrain(tiled, tile); })) {
      continue;
    }
    throw Error("the height at column " + std::to_string(post.x) + ", row " +
                std::to_string(post.y) + " has too few others around it for a triangle; change " +
                parameter("tile_vertices"));
  }
}

// Makes the posts next to those of borders that are not covered vertices: nothing that a void
// reaches comes between then. These posts have heights, as voids are next to vertices of borders
// alone.
void fix_beside(const std::vector<GlobalPost>& uncovered, const Raster& part, const TileBox& box,
                const TileSides& sides, Survey& survey) {
  std::set<Point> fixed(survey.fixed.begin(), survey.fixed.end());
  for (const GlobalPost post : uncovered) {
    if (!sides.shares(
            {static_cast<uint16_t>(post.x - box.x), static_cast<uint16_t>(post.y - box.y)}))
      fail("leaves a post out");
    const int64_t x = int64_t{post.x} - box.x, y = int64_t{post.y} - box.y;
    const Point first{static_cast<uint16_t>(std::max<int64_t>(x - part.x_spacing, 0)), 0};
    auto sample = std::lower_bound(survey.samples.begin(), survey.samples.end(), first,
                                   [](const Sample& s, Point p) { return s.place < p; });
    for (; sample != survey.samples.end() && sample->place.x <= x + part.x_spacing; ++sample) {
      const int64_t away = sample->place.y - y;
      if (std::abs(away) > part.y_spacing || sides.shares(sample->place)) continue;
      fixed.insert(sample->place);
    }
  }
  if (fixed.size() == survey.fixed.size()) fail("has a border that nothing covers");
  survey.fixed.assign(fixed.begin(), fixed.end());
}

}  // namespace

bool form_triangle(const std::vector<Sample>& samples) {
  return !samples.empty() && std::any_of(samples.begin(), samples.end(), [&](const Sample& s) {
    return orient2d(samples.front().place, samples.back().place, s.place) != 0;
  });
}

void check_shared(const microtin_mesh* mesh, const TileSides& sides, const SharedVertices& shared) {
  std::size_t found = 0;
  for (uint32_t v = 0; v < microtin_mesh_vertex_count(mesh); ++v) {
    const auto [x, y, z] = vertex_of(mesh, v);
    const Point p = {x, y};
    if (!sides.shares(p)) continue;
    const auto vertex = shared.find(p);
    if (vertex == shared.end() || vertex->second != z)
      fail("has another border than its neighbour");
    ++found;
  }
  if (found != shared.size()) fail("lacks a vertex of its border");
}

TileSummary summary_of(const std::vector<uint8_t>& stream, DecodedTerrain&& decoded,
                       const Verification& measured) {
  TileSummary summary;
  summary.bytes = static_cast<uint32_t>(stream.size());
  summary.stream_hash = stream_hash(kStreamHash, stream.data(), stream.size());
  summary.vertices = microtin_mesh_vertex_count(decoded.mesh());
  summary.lowest = INT16_MAX;
  summary.highest = INT16_MIN;
  for (uint32_t v = 0; v < summary.vertices; ++v) {
    const int16_t z = vertex_of(decoded.mesh(), v).z;
    summary.lowest = std::min(summary.lowest, z);
    summary.highest = std::max(summary.highest, z);
  }
  summary.measured = measured;
  summary.compact = compact_form(std::move(decoded));
  return summary;
}

bool keeps_options(const LatticeOptions& options, const Verification& measured,
                   uint64_t water_moved) {
  const bool too_low = options.never_below && measured.max_below.mantissa != 0;
  return measured.within_bound && !too_low && measured.voids_answered == 0 &&
         measured.uncovered == 0 && water_moved == 0;
}

std::vector<GlobalPost> uncovered_posts(const microtin_mesh* mesh, const Raster& part,
                                        const TileBox& box) {
  std::vector<GlobalPost> posts;
  uint32_t hint = 0;
  for_each_post(part, [&](int64_t x, int64_t y, int64_t z) {
    int32_t height = 0;
    const bool covered =
        mesh != nullptr && z != kVoidHeight &&
        microtin_mesh_height_at(mesh, static_cast<int32_t>(x * 256), static_cast<int32_t>(y * 256),
                                &hint, &height, 0, 0) == MICROTIN_QUERY_OK;
    if (z == kVoidHeight || covered) return;
    posts.push_back({box.x + static_cast<uint32_t>(x), box.y + static_cast<uint32_t>(y)});
  });
  return posts;
}

uint32_t count_vertices(const TiledRaster& tiled, uint32_t tile, const SimplifyOptions& options) {
  const TilePosts posts(tiled, tile);
  const Survey survey = survey_of_tile(tiled, posts, shared_vertices(tiled, posts));
  if (!has_terrain(posts.box(), survey)) return 0;
  return static_cast<uint32_t>(simplify(survey, options).vertices.size());
}

EncodedTile encode_tile(const TiledRaster& tiled, uint32_t tile, const SimplifyOptions& options) {
  if (tiled.kept != nullptr && tiled.kept->keeps(tile)) return tiled.kept->tile(tile);
  const TilePosts posts(tiled, tile);
  const TileBox& box = posts.box();
  const TileSides sides(tiled.grid, box);
  const Raster part = posts.tile();
  const SharedVertices shared = shared_vertices(tiled, posts);
  Survey survey = survey_of_tile(tiled, posts, shared);
  if (!has_terrain(box, survey)) {
    check_covered_by_others(tiled, posts);
    return {};
  }
  for (;;) {  // ends: there are always more fixed posts
    const Tin tin = simplify(survey, options);
    auto [stream, decoded] = encode_and_decode(tin, Metadata(), options.effort, origin_of(box));
    const std::optional<Decimal>& bound = tiled.options.max_error;
    WaterGauge gauge(part.decimals, bound ? tiled.options.water_level : std::nullopt);
    const Placement lattice = {part.x, part.y, tiled.lattice.placement.z};
    const Verification measured =
        verifying::verify(decoded.mesh(), lattice, part, bound, gauge.visitor());
    if (measured.uncovered != 0) {
      fix_beside(uncovered_posts(decoded.mesh(), part, box), part, box, sides, survey);
      continue;
    }
    check_shared(decoded.mesh(), sides, shared);
    if (!keeps_options(tiled.options, measured, gauge.moved())) fail("does not meet the options");
    Metadata metadata;
    metadata.everywhere = margins_of(measure_gap(decoded.mesh(), lattice, part));
    std::vector<uint8_t> all = with_metadata(stream, metadata);
    if (measured.bounds) append_chunk(*measured.bounds, all);
    TileSummary summary = summary_of(all, std::move(decoded), measured);
    summary.below = metadata.everywhere.below;
    summary.above = metadata.everywhere.above;
    return {std::move(summary), std::move(all)};
  }
}

}  // namespace microtin::pack
