// SPDX-License-Identifier: MIT
// Triangulates the strip along a border and compares it with the bilinear surface of the posts.
#include "encoder/pack/border_strip.hpp"

#include <algorithm>
#include <cstddef>

#include "encoder/fit/simplify.hpp"
#include "encoder/pack/tile.hpp"
#include "encoder/stream/encode.hpp"

namespace microtin::pack {
namespace {

constexpr uint32_t kBeside = 2;  // posts on each side: the strip's, and those its limits depend on

// The survey of posts that all have the limits of vertices.
Survey survey_of_vertices(const TiledRaster& tiled, const EverywhereBound& bound,
                          const Raster& raster) {
  LatticeOptions options = tiled.options;
  for (uint32_t x = 0; x < raster.width; ++x) {
    for (uint32_t y = 0; y < raster.height; ++y) {
      const std::size_t post = std::size_t{y} * raster.width + x;
      if (is_height(raster.heights[post])) {
        options.tightenings.push_back(bound.vertex_limits(post));
      }
    }
  }
  return survey_of(tiled, raster, options);
}

}  // namespace

void pin_height(Sample& sample) {
  sample = fixed_sample(sample.place, ErrorModel{true}.vertex_height(sample));
}

BorderStrip::BorderStrip(const TiledRaster& tiled, const TilePosts& posts, const TileBox& line)
    : box_(around(tiled.grid, line, kBeside, kBeside)),
      line_(line),
      is_row_(line.y == line.y_end),
      raster_(posts.crop_of(box_)),
      lattice_{raster_.x, raster_.y, tiled.lattice.placement.z},
      bound_(raster_, tiled.options, lattice_),
      survey_(survey_of_vertices(tiled, bound_, raster_)),
      pinned_(places_of(line)) {}

std::size_t BorderStrip::post_at(uint32_t along) const {
  const uint32_t x = line_.x - box_.x + (is_row_ ? along : 0),
                 y = line_.y - box_.y + (is_row_ ? 0 : along);
  return std::size_t{y} * raster_.width + x;
}

void BorderStrip::limit(uint32_t along, LinePost& post) const {
  if (!post.sample) return;
  const std::size_t at = post_at(along);
  const Point place{static_cast<uint16_t>(at % raster_.width),
                    static_cast<uint16_t>(at / raster_.width)};
  const auto sample = std::lower_bound(survey_.samples.begin(), survey_.samples.end(), place,
                                       [](const Sample& s, Point p) { return s.place < p; });
  post.sample = Sample{post.sample->place, sample->height, sample->lowest, sample->highest};
  post.aim = middle_of(*sample);
}

void BorderStrip::pin(uint32_t along, std::vector<LinePost>& on_line) {
  pinned_[along] = true;
  on_line[along].kept = true;
  limit(along, on_line[along]);
}

void BorderStrip::pin_ends(std::vector<LinePost>& on_line) {
  const auto last = static_cast<uint32_t>(on_line.size() - 1);
  pin(0, on_line);
  pin(last, on_line);
  limit(1, on_line[1]);
  limit(last - 1, on_line[last - 1]);
}

// The vertices of the chain, and the nearest posts on one side of the line. The posts next to the
// line's ends are left out: they may lie on other borders.
Survey BorderStrip::strip_survey(const std::vector<ChainVertex>& chain, int side) const {
  const auto across = [&](Point p) {
    return is_row_ ? int64_t{p.y} - (int64_t{line_.y} - box_.y)
                   : int64_t{p.x} - (int64_t{line_.x} - box_.x);
  };
  const auto along = [&](Point p) {
    return is_row_ ? int64_t{p.x} - (int64_t{line_.x} - box_.x)
                   : int64_t{p.y} - (int64_t{line_.y} - box_.y);
  };
  const auto last = static_cast<int64_t>(pinned_.size()) - 1;
  const auto is_beside = [&](Point p) {
    const int64_t at = along(p);
    return across(p) == side && at > 0 && at < last;
  };
  Survey survey;
  for (const Sample& sample : survey_.samples) {
    if (!is_beside(sample.place)) continue;
    survey.samples.push_back(sample);
    pin_height(survey.samples.back());
  }
  for (const ChainVertex& vertex : chain) {
    const std::size_t at = post_at(vertex.post);
    survey.samples.push_back(fixed_sample(
        {static_cast<uint16_t>(at % raster_.width), static_cast<uint16_t>(at / raster_.width)},
        vertex.height));
  }
  for (const Point place : survey_.voids) {
    const bool is_on_line = across(place) == 0 && along(place) >= 0 && along(place) <= last;
    if (is_on_line || is_beside(place)) survey.voids.push_back(place);
  }
  std::sort(survey.samples.begin(), survey.samples.end(),
            [](const Sample& a, const Sample& b) { return a.place < b.place; });
  survey.fixed = places_of(survey.samples);
  return survey;
}

bool BorderStrip::pin_missed(const std::vector<ChainVertex>& chain,
                             std::vector<LinePost>& on_line) {
  for (const int side : {-1, 1}) {
    const Survey survey = strip_survey(chain, side);
    if (!form_triangle(survey.samples)) continue;
    bound_.see(encode_and_decode(simplify(survey, {}), {}, {}).decoded.mesh());
  }
  bool has_more = false;
  for (const Tightening& missed : bound_.tightenings()) {
    const GlobalPost post{box_.x + missed.place.x, box_.y + missed.place.y};
    if (is_row_ ? post.y != line_.y : post.x != line_.x) continue;
    const uint32_t along = is_row_ ? post.x - line_.x : post.y - line_.y;
    if (along >= pinned_.size() || pinned_[along]) continue;
    pin(along, on_line);
    has_more = true;
  }
  return has_more;
}

}  // namespace microtin::pack
