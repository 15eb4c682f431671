// SPDX-License-Identifier: MIT
// Cuts edges of the global triangulation where tiles meet, at shared vertices.
#include <algorithm>
#include <cstdlib>
#include <limits>
#include <map>

#include "encoder/base/work.hpp"
#include "encoder/pack/point_tiles.hpp"

namespace microtin::pack {
namespace {

constexpr int64_t kOne = 65536;
constexpr uint32_t kPointVertexPrice = 4;  // borders lie on a surface that is simple already

// start + (end - start) * part / whole, to the nearest.
int32_t between(int32_t start, int32_t end, Wide part, Wide whole) {
  return static_cast<int32_t>(start + round_divide((Wide{end} - start) * part, whole));
}

int32_t saturated(int64_t height) {
  return static_cast<int32_t>(std::clamp<int64_t>(height, std::numeric_limits<int32_t>::min(),
                                                  std::numeric_limits<int32_t>::max()));
}

uint32_t nearest_place(const Crossing& crossing) {
  return static_cast<uint32_t>((crossing.at + kOne / 2) / kOne);
}

int64_t median_difference(const PointSurvey& survey, const GlobalTriangulation& triangulation) {
  std::vector<int64_t> differences;
  triangulation.visit_edges([&](uint32_t a, uint32_t b) {
    differences.push_back(std::abs(int64_t{survey.samples[a].height} - survey.samples[b].height));
  });
  const auto middle = differences.begin() + static_cast<std::ptrdiff_t>(differences.size() / 2);
  std::nth_element(differences.begin(), middle, differences.end());
  return *middle;
}

}  // namespace

BorderTolerance choose_tolerance(const PointSurvey& survey,
                                 const GlobalTriangulation& triangulation,
                                 const LatticeOptions& options) {
  if (!options.max_error) {
    const int64_t room = std::max(median_difference(survey, triangulation), kOne / 2);
    return {room, room, true};
  }
  const Lattice& lattice = survey.lattice;
  const Wide bound = mantissa_at(*options.max_error, lattice.z_decimals) * kOne / lattice.z.step;
  const auto room = static_cast<int64_t>(std::min<Wide>(bound, INT32_MAX));
  if (options.never_below) return {0, std::max(room, kOne), false};
  return {std::max(room, kOne / 2), std::max(room, kOne / 2), false};
}

void Profile::add_sample(uint32_t at, const GlobalSample& sample) {
  add_crossing(at, 1, sample.height);
  crossings_.back().sample = &sample;
}

void Profile::add_crossing(Wide numerator, Wide denominator, int32_t height) {
  first_ = std::min(first_, static_cast<uint32_t>(floor_divide(numerator, denominator)));
  last_ = std::max(last_, static_cast<uint32_t>(ceil_divide(numerator, denominator)));
  crossings_.push_back(
      {static_cast<int64_t>(floor_divide(numerator * kOne, denominator)), height, nullptr});
}

void Profile::sort() {
  std::sort(crossings_.begin(), crossings_.end(), [](const Crossing& a, const Crossing& b) {
    if (a.at != b.at) return a.at < b.at;
    const bool first = a.sample != nullptr, second = b.sample != nullptr;
    return first != second ? first : a.height < b.height;
  });
}

Crossing Profile::at(uint32_t place) const {
  const int64_t at = place * kOne;
  const auto next = std::lower_bound(crossings_.begin(), crossings_.end(), at,
                                     [](const Crossing& c, int64_t to) { return c.at < to; });
  if (next == crossings_.end()) return {at, crossings_.back().height, nullptr};
  if (next->at == at) return *next;
  if (next == crossings_.begin()) return {at, next->height, nullptr};
  const Crossing& before = *(next - 1);
  return {at, between(before.height, next->height, at - before.at, next->at - before.at), nullptr};
}

GlobalPost PointBorders::Lines::post(std::size_t line, uint32_t at) const {
  const uint32_t across = static_cast<uint32_t>(line + 1) * spacing;
  return go_north ? GlobalPost{across, at} : GlobalPost{at, across};
}

PointBorders::PointBorders(const PointSurvey& survey, const GlobalTriangulation& triangulation,
                           const TileGrid& grid, const BorderTolerance& tolerance)
    : survey_(survey),
      grid_(grid),
      tolerance_(tolerance),
      north_{true, grid.width, grid.y_max, grid.height, {}, {}},
      east_{false, grid.height, grid.x_max, grid.width, {}, {}} {
  north_.profiles.resize(tile_columns(grid) - 1);
  east_.profiles.resize(tile_rows(grid) - 1);
  for (Lines* const lines : {&north_, &east_}) {
    add_samples(*lines);
    triangulation.visit_edges([&](uint32_t a, uint32_t b) {
      cross_edge(*lines, survey_.samples[a], survey_.samples[b]);
    });
    for_each_parallel(lines->profiles.size(), [&](std::size_t i) { lines->profiles[i].sort(); });
  }
  simplify(north_);
  simplify(east_);
  for (Lines* const lines : {&north_, &east_}) lines->profiles = {};  // they are large
}

void PointBorders::add_samples(Lines& lines) const {
  for (const GlobalSample& sample : survey_.samples) {
    const uint32_t across = lines.across(sample.place), line = across / lines.spacing;
    if (across % lines.spacing != 0 || line == 0 || line > lines.profiles.size()) continue;
    lines.profiles[line - 1].add_sample(lines.along(sample.place), sample);
  }
}

// Adds the edge to all lines strictly between its ends.
void PointBorders::cross_edge(Lines& lines, const GlobalSample& from,
                              const GlobalSample& to) const {
  if (lines.across(from.place) > lines.across(to.place)) {
    cross_edge(lines, to, from);
    return;
  }
  const uint32_t begin = lines.across(from.place), end = lines.across(to.place);
  const Wide start = lines.along(from.place), rise = lines.along(to.place) - start;
  for (uint32_t line = begin / lines.spacing + 1; line <= lines.profiles.size(); ++line) {
    const uint32_t across = line * lines.spacing;
    if (across >= end) return;
    const Wide part = across - begin, whole = end - begin;
    lines.profiles[line - 1].add_crossing(start * whole + rise * part, whole,
                                          between(from.height, to.height, part, whole));
  }
}

void PointBorders::simplify(Lines& lines) const {
  lines.pieces.resize(lines.profiles.size());
  const uint32_t count = (lines.length - 1) / lines.piece_length + 1;
  for (auto& pieces : lines.pieces) pieces.resize(count);
  for_each_parallel(lines.pieces.size() * count, [&](std::size_t i) {
    const std::size_t line = i / count, piece = i % count;
    lines.pieces[line][piece] =
        simplify_piece(lines, line, static_cast<uint32_t>(piece) * lines.piece_length);
  });
}

PointBorders::Piece PointBorders::simplify_piece(const Lines& lines, std::size_t line,
                                                 uint32_t begin) const {
  const Profile& profile = lines.profiles[line];
  const uint32_t end = begin + std::min(lines.piece_length, lines.length - begin);
  std::map<uint32_t, Crossing> by_place;
  const auto add = [&](uint32_t place) {
    if (begin <= place && place <= end) by_place[place] = profile.at(place);
  };
  const auto& crossings = profile.crossings();
  auto crossing =
      std::lower_bound(crossings.begin(), crossings.end(), begin,
                       [](const Crossing& c, uint32_t p) { return nearest_place(c) < p; });
  for (; crossing != crossings.end() && nearest_place(*crossing) <= end; ++crossing) {
    add(nearest_place(*crossing));
  }
  if (!profile.is_empty()) {
    add(profile.first());
    add(profile.last());
  }
  for (const uint32_t place : {begin, end}) {
    if (const auto shared = corner(lines.post(line, place))) by_place[place] = *shared;
  }
  std::vector<LinePost> posts;
  posts.reserve(by_place.size());
  for (const auto& [place, found] : by_place) posts.push_back(line_post(found, place - begin));
  Piece piece;
  if (posts.empty()) return piece;
  for (const ChainVertex& vertex : simplify_line(posts, ErrorModel{true}, kPointVertexPrice)) {
    piece.push_back({posts[vertex.post].sample->place.x, vertex.height});
  }
  return piece;
}

// What all borders that meet at a corner have there.
std::optional<Crossing> PointBorders::corner(GlobalPost post) const {
  const std::size_t column = post.x / grid_.width, row = post.y / grid_.height;
  const bool on_north = post.x % grid_.width == 0 && column > 0 && column <= north_.profiles.size();
  const bool on_east = post.y % grid_.height == 0 && row > 0 && row <= east_.profiles.size();
  if (on_north && north_.profiles[column - 1].holds(post.y)) {
    return north_.profiles[column - 1].at(post.y);
  }
  if (on_east && east_.profiles[row - 1].holds(post.x)) return east_.profiles[row - 1].at(post.x);
  return std::nullopt;
}

LinePost PointBorders::line_post(const Crossing& crossing, uint32_t at) const {
  Sample sample{{static_cast<uint16_t>(at), 0},
                crossing.height,
                saturated(crossing.height - tolerance_.below),
                saturated(crossing.height + tolerance_.above)};
  if (crossing.sample == nullptr) return {sample, false, middle_of(sample)};
  sample.lowest = crossing.sample->lowest;
  sample.highest = crossing.sample->highest;
  if (tolerance_.keep_samples) {
    sample.height = ErrorModel{false}.vertex_height(sample) * 65536;
    sample.lowest = sample.highest = sample.height;
  }
  return {sample, tolerance_.keep_samples, middle_of(sample)};
}

SharedVertices PointBorders::of_tile(uint32_t tile) const {
  const TileBox box = tile_box(grid_, tile);
  const uint32_t column = tile % tile_columns(grid_), row = tile / tile_columns(grid_);
  SharedVertices shared;
  const auto add = [&](const Lines& lines, std::size_t line, uint32_t piece, uint32_t across) {
    if (line == 0 || line > lines.pieces.size()) return;
    for (const BorderVertex& vertex : lines.pieces[line - 1][piece]) {
      const auto offset = static_cast<uint16_t>(across);
      const Point place = lines.go_north ? Point{offset, vertex.at} : Point{vertex.at, offset};
      shared[place] = vertex.height;
    }
  };
  add(north_, column, row, 0);
  add(north_, column + 1, row, box.x_end - box.x);
  add(east_, row, column, 0);
  add(east_, row + 1, column, box.y_end - box.y);
  return shared;
}

}  // namespace microtin::pack
