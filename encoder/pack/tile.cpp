// SPDX-License-Identifier: MIT
// Encodes a tile, and checks what a decoder makes of it.
#include "encoder/pack/tile.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/pack/kept_tiles.hpp"
#include "encoder/pack/tile_fit.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "encoder/verify/everywhere.hpp"
#include "shared/pack_format.hpp"
#include "shared/predicates.hpp"

namespace microtin::pack {
namespace {

bool has_terrain(const TiledRaster& tiled, uint32_t tile) {
  if (tiled.kept != nullptr && tiled.kept->keeps(tile)) return tiled.kept->has_terrain(tile);
  const TilePosts posts(tiled, tile);
  return TileFit(tiled, posts).forms_triangle();
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

}  // namespace

void fail_tile(const std::string& what) {
  throw InternalFault("a decoded tile " + what);
}

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
      fail_tile("has another border than its neighbour");
    ++found;
  }
  if (found != shared.size()) fail_tile("lacks a vertex of its border");
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
  TileFit fit(tiled, posts);
  if (!fit.has_terrain()) return 0;
  const bool is_final = !is_bound_everywhere(tiled.options) && tiled.lines == nullptr;
  const Tin tin = is_final ? fit.first(options) : fit.fit(options).tin;
  return static_cast<uint32_t>(tin.vertices.size());
}

EncodedTile encode_tile(const TiledRaster& tiled, uint32_t tile, const SimplifyOptions& options) {
  if (tiled.kept != nullptr && tiled.kept->keeps(tile)) return tiled.kept->tile(tile);
  const TilePosts posts(tiled, tile);
  TileFit fit(tiled, posts);
  if (!fit.has_terrain()) {
    check_covered_by_others(tiled, posts);
    return {};
  }
  FittedTile fitted = fit.fit(options);
  DecodedTerrain& decoded = fitted.encoded.decoded;
  Metadata metadata;
  metadata.everywhere = margins_of(measure_gap(decoded.mesh(), fit.lattice(), fit.part()));
  std::vector<uint8_t> all = with_metadata(fitted.encoded.stream, metadata);
  if (fitted.measured.bounds) append_chunk(*fitted.measured.bounds, all);
  TileSummary summary = summary_of(all, std::move(decoded), fitted.measured);
  summary.below = metadata.everywhere.below;
  summary.above = metadata.everywhere.above;
  return {std::move(summary), std::move(all)};
}

}  // namespace microtin::pack
