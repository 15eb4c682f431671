// SPDX-License-Identifier: MIT
// Surveys a tile with the vertices its borders share, encodes it, and checks both.
#include "encoder/pack/tile.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/pack/border_strip.hpp"
#include "encoder/pack/kept_tiles.hpp"
#include "encoder/stream/encode.hpp"
#include "encoder/terrain/exact_query.hpp"
#include "encoder/verify/everywhere.hpp"
#include "encoder/verify/everywhere_bound.hpp"
#include "encoder/verify/water_gauge.hpp"
#include "shared/pack_format.hpp"
#include "shared/predicates.hpp"

namespace microtin::pack {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw InternalFault("a decoded tile " + what);
}

// The posts of a tile, with the limits of the options. On borders with other tiles the shared
// vertices stand for all posts with heights, also where no post is: they are fixed.
Survey survey_of_tile(const TiledRaster& tiled, const TilePosts& posts,
                      const SharedVertices& shared, const LatticeOptions& options) {
  const TileSides sides(tiled.grid, posts.box());
  const Survey all = survey_of(tiled, posts.tile(), options);
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

Survey first_survey(const TiledRaster& tiled, const TilePosts& posts,
                    const SharedVertices& shared) {
  return survey_of_tile(tiled, posts, shared, first_fit(tiled.options));
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
  return form_triangle(first_survey(tiled, posts, shared_vertices(tiled, posts)).samples);
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

namespace {

// A surface for a tile, and how far it is from the tile's posts.
struct FittedTile {
  Tin tin;
  Encoding encoded;
  Verification measured;
};

// Finds the surface of a tile, from attempt to attempt.
class TileFit {
 public:
  TileFit(const TiledRaster& tiled, const TilePosts& posts)
      : tiled_(tiled),
        posts_(posts),
        sides_(tiled.grid, posts.box()),
        part_(posts.tile()),
        shared_(shared_vertices(tiled, posts)),
        survey_(first_survey(tiled, posts, shared_)) {
    if (is_bound_everywhere(tiled.options)) everywhere_.emplace(part_, tiled.options, lattice());
  }
  TileFit(const TileFit&) = delete;
  TileFit& operator=(const TileFit&) = delete;

  const Raster& part() const { return part_; }
  Placement lattice() const { return {part_.x, part_.y, tiled_.lattice.placement.z}; }
  bool has_terrain() const { return pack::has_terrain(posts_.box(), survey_); }

  // One that keeps the options at posts, and maybe not between them.
  Tin first(const SimplifyOptions& options) const { return simplify(survey_, options); }

  FittedTile fit(const SimplifyOptions& options) {
    Tin tin = first(options);
    for (;;) {  // ends: there are always more fixed posts, or narrower limits a few times
      Encoding encoded =
          encode_and_decode(tin, Metadata(), options.effort, origin_of(posts_.box()));
      const microtin_mesh* const mesh = encoded.decoded.mesh();
      const std::optional<Decimal>& bound = tiled_.options.max_error;
      WaterGauge gauge(part_.decimals, bound ? tiled_.options.water_level : std::nullopt);
      const Verification measured =
          verifying::verify(mesh, lattice(), part_, bound, gauge.visitor());
      if (measured.uncovered != 0) {
        fix_beside(uncovered_posts(mesh, part_, posts_.box()), part_, posts_.box(), sides_,
                   survey_);
        tin = everywhere_ ? mended(survey_, tin) : first(options);
        continue;
      }
      check_shared(mesh, sides_, shared_);
      if (!keeps_options(tiled_.options, measured, gauge.moved()))
        fail("does not meet the options");
      if (!everywhere_ || !narrow(mesh)) return {std::move(tin), std::move(encoded), measured};
      tin = mended(survey_, tin);
    }
  }

 private:
  // Narrows the limits where a surface misses the bound between posts. False: it misses nothing.
  bool narrow(const microtin_mesh* mesh) {
    constexpr int kMostAttempts = 12;
    const uint64_t missed = everywhere_->see(mesh);
    if (missed == 0) return false;
    if (++attempts_ == kMostAttempts) refuse_everywhere(part_, tiled_.options, missed);
    LatticeOptions options = tiled_.options;
    for (const auto& [place, limits] : limits_inside()) options.tightenings.push_back(limits);
    Survey narrower = survey_of_tile(tiled_, posts_, shared_, options);
    std::vector<Point> fixed;
    for (const Tightening& one : options.tightenings) {
      if (one.is_vertex) fixed.push_back(one.place);
    }
    pin_beside_borders(fixed, narrower);
    std::set_union(survey_.fixed.begin(), survey_.fixed.end(), fixed.begin(), fixed.end(),
                   std::inserter(narrower.fixed, narrower.fixed.end()));
    survey_ = std::move(narrower);
    return true;
  }

  // The limits of posts that are no other tile's. Where a border was missed in vain, all posts next
  // to the edge there become vertices, as in the strip.
  std::map<Point, Tightening> limits_inside() const {
    std::map<Point, Tightening> limits;
    for (const Tightening& one : everywhere_->tightenings()) {
      if (!sides_.shares(one.place)) {
        limits.emplace(one.place, one);
      } else if (one.is_vertex) {
        for (const Point place : beside_edges(one.place)) {
          const std::size_t post = std::size_t{place.y} * part_.width + place.x;
          if (is_height(part_.heights[post])) limits[place] = everywhere_->vertex_limits(post);
        }
      }
    }
    return limits;
  }

  // The places next to the edges of borders that a post lies on, but for other tiles' places.
  std::vector<Point> beside_edges(Point post) const {
    std::vector<Point> places;
    for (const Inwards in : sides_.inwards(post)) {
      for (const int direction : {-1, 1}) {
        const int along_x = direction * in.y, along_y = direction * in.x;
        for (int64_t x = post.x, y = post.y; is_inside(x, y); x += along_x, y += along_y) {
          const Point beside = place_at(x + in.x, y + in.y), on_side = place_at(x, y);
          if (is_inside(x + in.x, y + in.y) && !sides_.shares(beside)) places.push_back(beside);
          if (on_side != post && shared_.count(on_side) != 0) break;
        }
      }
    }
    return places;
  }

  static Point place_at(int64_t x, int64_t y) {
    return {static_cast<uint16_t>(x), static_cast<uint16_t>(y)};
  }

  bool is_inside(int64_t x, int64_t y) const {
    return x >= 0 && y >= 0 && x < part_.width && y < part_.height;
  }

  // Vertices next to a border have the heights with which its strip keeps the bound.
  void pin_beside_borders(const std::vector<Point>& vertices, Survey& survey) const {
    auto vertex = vertices.begin();
    for (Sample& sample : survey.samples) {
      while (vertex != vertices.end() && *vertex < sample.place) ++vertex;
      if (vertex == vertices.end() || *vertex != sample.place) continue;
      if (sides_.is_beside(sample.place)) pin_height(sample);
    }
  }

  const TiledRaster& tiled_;
  const TilePosts& posts_;
  TileSides sides_;
  Raster part_;
  SharedVertices shared_;
  Survey survey_;
  std::optional<EverywhereBound> everywhere_;
  int attempts_ = 0;
};

}  // namespace

uint32_t count_vertices(const TiledRaster& tiled, uint32_t tile, const SimplifyOptions& options) {
  const TilePosts posts(tiled, tile);
  TileFit fit(tiled, posts);
  if (!fit.has_terrain()) return 0;
  const bool is_final = !is_bound_everywhere(tiled.options);
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
