// SPDX-License-Identifier: MIT
// Surveys a tile, and narrows its limits until its surface keeps what was requested.
#include "encoder/pack/tile_fit.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <set>
#include <string>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/fit/breaklines.hpp"
#include "encoder/pack/border_strip.hpp"
#include "encoder/verify/breaklines.hpp"
#include "encoder/verify/verify.hpp"

namespace microtin::pack {
namespace {

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
  for (const auto& [place, z] : shared) {
    survey.samples.push_back(fixed_sample(place, z));
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

// Makes the posts next to those of borders that are not covered vertices: nothing that a void
// reaches comes between then. These posts have heights, as voids are next to vertices of borders
// alone.
void fix_beside(const std::vector<GlobalPost>& uncovered, const Raster& part, const TileBox& box,
                const TileSides& sides, Survey& survey) {
  std::set<Point> fixed(survey.fixed.begin(), survey.fixed.end());
  for (const GlobalPost post : uncovered) {
    if (!sides.shares(
            {static_cast<uint16_t>(post.x - box.x), static_cast<uint16_t>(post.y - box.y)}))
      fail_tile("leaves a post out");
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
  if (fixed.size() == survey.fixed.size()) fail_tile("has a border that nothing covers");
  survey.fixed.assign(fixed.begin(), fixed.end());
}

Point place_at(int64_t x, int64_t y) {
  return {static_cast<uint16_t>(x), static_cast<uint16_t>(y)};
}

}  // namespace

TileFit::TileFit(const TiledRaster& tiled, const TilePosts& posts)
    : tiled_(tiled),
      posts_(posts),
      sides_(tiled.grid, posts.box()),
      part_(posts.tile()),
      shared_(shared_vertices(tiled, posts)) {
  laid_.placement = lattice();
  laid_.survey = first_survey(tiled, posts, shared_);
  if (is_bound_everywhere(tiled.options)) everywhere_.emplace(part_, tiled.options, lattice());
  if (tiled.lines != nullptr) add_lines();
}

// Positions of borders are those of both tiles: chains take the vertices that are there.
void TileFit::add_lines() {
  const LinesInTile lines = tiled_.lines->in_tile(tiled_.grid, posts_.box());
  lines_ = parts_of(lines, part_);
  laid_.line_room = line_room(tiled_);
  laid_.is_shared = [this](Point place) { return sides_.shares(place); };
  laid_.breaklines = chains_of(lines_, laid_.line_room, lines.stops,
                               [this](Point place) { return may_stand(laid_, place); });
  pin_chains(laid_);
}

void TileFit::expect_edges(const microtin_mesh* mesh) const {
  const FoundBreaklines found =
      verifying::find_breaklines(mesh, lines_, laid_.line_room, laid_.placement);
  if (!found.missing) return;
  throw Error(parameter("breaklines") + ": " + *found.missing + "; use a larger " +
              parameter("max_error") + ", or make a stream (.mtin)");
}

bool TileFit::has_terrain() const {
  const TileBox& box = posts_.box();
  if (forms_triangle()) return true;
  if (laid_.survey.samples.size() == laid_.survey.fixed.size()) return false;
  throw Error("the tile from column " + std::to_string(box.x) + ", row " + std::to_string(box.y) +
              " has only " + std::to_string(laid_.survey.samples.size()) +
              " heights, which do not form a triangle; change " + parameter("tile_vertices"));
}

FittedTile TileFit::fit(const SimplifyOptions& options) {
  Tin tin = first(options);
  for (;;) {  // ends: there are always more fixed posts, or narrower limits a few times
    keep_breaklines(laid_, tin);
    Encoding encoded = encode_and_decode(tin, Metadata(), options.effort, origin_of(posts_.box()));
    const microtin_mesh* const mesh = encoded.decoded.mesh();
    const std::optional<Decimal>& bound = tiled_.options.max_error;
    WaterGauge gauge(part_.decimals, bound ? tiled_.options.water_level : std::nullopt);
    const Verification measured = verifying::verify(mesh, lattice(), part_, bound, gauge.visitor());
    if (measured.uncovered != 0) {
      fix_beside(uncovered_posts(mesh, part_, posts_.box()), part_, posts_.box(), sides_,
                 laid_.survey);
      tin = everywhere_ ? mended(laid_.survey, tin) : first(options);
      continue;
    }
    check_shared(mesh, sides_, shared_);
    if (!keeps_options(tiled_.options, measured, gauge.moved()))
      fail_tile("does not meet the options");
    expect_edges(mesh);
    if (!everywhere_ || !narrow(mesh)) return {std::move(tin), std::move(encoded), measured};
    tin = mended(laid_.survey, tin);
  }
}

// Narrows the limits where a surface misses the bound between posts. False: it misses nothing.
bool TileFit::narrow(const microtin_mesh* mesh) {
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
  std::set_union(laid_.survey.fixed.begin(), laid_.survey.fixed.end(), fixed.begin(), fixed.end(),
                 std::inserter(narrower.fixed, narrower.fixed.end()));
  laid_.survey = std::move(narrower);
  return true;
}

// The limits of posts that are no other tile's. Where a border was missed in vain, all posts next
// to the edge there become vertices, as in the strip.
std::map<Point, Tightening> TileFit::limits_inside() const {
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
std::vector<Point> TileFit::beside_edges(Point post) const {
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

// Vertices next to a border have the heights with which its strip keeps the bound.
void TileFit::pin_beside_borders(const std::vector<Point>& vertices, Survey& survey) const {
  auto vertex = vertices.begin();
  for (Sample& sample : survey.samples) {
    while (vertex != vertices.end() && *vertex < sample.place) ++vertex;
    if (vertex == vertices.end() || *vertex != sample.place) continue;
    if (sides_.is_beside(sample.place)) pin_height(sample);
  }
}

}  // namespace microtin::pack
