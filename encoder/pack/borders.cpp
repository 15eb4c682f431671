// SPDX-License-Identifier: MIT
// The borders between the tiles of a grid: which vertices neighbours share.
#include "encoder/pack/borders.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "encoder/exact/wide.hpp"
#include "encoder/pack/border_strip.hpp"
#include "encoder/pack/kept_tiles.hpp"
#include "encoder/pack/sparse_line.hpp"

namespace microtin::pack {

// Means of squares by sums over rectangles from a corner; of noise as many posts as possible, of
// hills as few.

Ground::Ground(const std::vector<Sample>& samples, uint32_t width, uint32_t height)
    : width_(width), height_(height), sums_(std::size_t{width + 1} * (height + 1)) {
  const std::size_t row = std::size_t{width} + 1;
  for (const Sample& sample : samples) {
    sums_[(sample.place.y + std::size_t{1}) * row + sample.place.x + 1] = {middle_of(sample), 1};
  }
  for (std::size_t i = row; i < sums_.size(); ++i) {
    const bool begins = i % row == 0;
    const Sum west = begins ? Sum{} : sums_[i - 1], south = sums_[i - row];
    const Sum both = begins ? Sum{} : sums_[i - row - 1];
    sums_[i].heights += west.heights + south.heights - both.heights;
    sums_[i].posts += west.posts + south.posts - both.posts;
  }
}

Ground::Sum Ground::sum(uint32_t x, uint32_t y, uint32_t reach_x, uint32_t reach_y) const {
  const Sum &a = corner(x - reach_x, y - reach_y), &b = corner(x + reach_x + 1, y - reach_y),
            &c = corner(x - reach_x, y + reach_y + 1),
            &d = corner(x + reach_x + 1, y + reach_y + 1);
  return {d.heights - c.heights - b.heights + a.heights, d.posts - c.posts - b.posts + a.posts};
}

int32_t Ground::at(uint32_t x, uint32_t y, int64_t tolerance) const {
  const uint32_t most_x = std::min(x, width_ - 1 - x), most_y = std::min(y, height_ - 1 - y);
  int64_t mean = 0, lowest = std::numeric_limits<int32_t>::min(),
          highest = std::numeric_limits<int32_t>::max();
  for (uint32_t reach = 0; reach <= kGroundReach; ++reach) {
    const uint32_t reach_x = std::min(reach, most_x), reach_y = std::min(reach, most_y);
    const Sum all = sum(x, y, reach_x, reach_y);
    const int64_t posts = int64_t{2 * reach_x + 1} * (2 * reach_y + 1);
    if (all.posts != posts) break;
    const int64_t wider = all.heights / posts;
    if (wider < lowest || wider > highest) break;
    mean = wider;
    if (reach == 0) continue;
    lowest = std::max(lowest, mean - tolerance);
    highest = std::min(highest, mean + tolerance);
  }
  return static_cast<int32_t>(mean);
}

// Finds the cheapest vertices along a line of posts by dynamic programming.

namespace {

constexpr int64_t kStep = 65536;  // heights of samples have 16 fractional bits
constexpr int kReach = 4;         // heights that are tried above and below the aim

// A slope in 1/65536 steps a post; |rise| < 2^33, run in 1..65535.
struct Slope {
  int64_t rise;
  int64_t run;

  bool operator<(const Slope& other) const { return rise * other.run < other.rise * run; }
};

// Directions that keep a straight piece within the bounds of all posts passed so far.
class Cone {
 public:
  void narrow(const Sample& sample, int64_t from_height, int64_t run) {
    low_ = std::max(low_, Slope{sample.lowest - from_height, run});
    high_ = std::min(high_, Slope{sample.highest - from_height, run});
  }
  bool is_empty() const { return high_ < low_; }
  bool holds(Slope slope) const { return !(slope < low_) && !(high_ < slope); }

 private:
  Slope low_{-(int64_t{1} << 33), 1}, high_{int64_t{1} << 33, 1};
};

// Sums about a straight piece from behind its first vertex on. Heights here have four fractional
// bits and differ by less than 2^20, so that sums for 65535 posts are below 2^57, products below
// 2^110.
class Piece {
 public:
  void add(int64_t aim_above_first, int64_t run) {
    const int64_t aim = aim_above_first / kUnit;
    squares_ += aim * aim;
    moments_ += aim * run;
    squared_runs_ += run * run;
    linear_ = Wide{moments_} * 2 * kFine / run;
    quadratic_ = Wide{squared_runs_} * kFine / (run * run);
  }

  // The sum of the squared distances of the posts' aims if it ends at the last of them, `rise`
  // above the first vertex.
  uint64_t squares(int64_t rise) const {
    const int64_t up = rise / kUnit;
    const Wide sum = squares_ + up * (up * quadratic_ - linear_) / kFine;
    return static_cast<uint64_t>(std::max<Wide>(0, sum));
  }

  static uint64_t square(int64_t height) {
    return static_cast<uint64_t>((height / kUnit) * (height / kUnit));
  }

 private:
  static constexpr int64_t kUnit = kStep / 16, kFine = int64_t{1} << 32;
  int64_t squares_ = 0, moments_ = 0, squared_runs_ = 0;
  Wide linear_ = 0, quadratic_ = 0;  // in parts of kFine
};

// What a chain costs up to a vertex: squared distances from the aims, and a price for each vertex.
using Cost = uint64_t;
constexpr Cost kUnreached = std::numeric_limits<Cost>::max();
constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

// A post that may become a vertex at this height.
struct State {
  uint32_t post;
  int16_t height;
  Cost cost;
  std::size_t before;  // state of the vertex before, if there is one
};

class Chain {
 public:
  Chain(const std::vector<LinePost>& posts, ErrorModel model, uint32_t price)
      : posts_(posts), model_(model), price_(price * Piece::square(kStep)) {
    for (uint32_t post = 0; post < posts.size(); ++post) {
      add_states(post);
      if (is_void(post) || posts[post].sample->is_unbounded()) continue;
      const Sample& sample = *posts[post].sample;
      price_ =
          std::max(price_, price * Piece::square((int64_t{sample.highest} - sample.lowest) / 2));
    }
    first_.push_back(states_.size());
  }

  std::vector<ChainVertex> vertices() {
    std::vector<ChainVertex> vertices;
    for (uint32_t post = 0; post < posts_.size(); ++post) {
      if (starts_run(post)) start(post);
      for (std::size_t s = first_[post]; s < first_[post + 1]; ++s) extend(s);
      if (ends_run(post)) append(post, vertices);
    }
    return vertices;
  }

 private:
  bool is_void(std::size_t post) const { return !posts_[post].sample; }
  int64_t position(uint32_t post) const {
    const Point place = posts_[post].sample->place;
    return int64_t{place.x} + place.y;
  }
  bool starts_run(std::size_t post) const {
    return !is_void(post) && (post == 0 || is_void(post - 1));
  }
  bool ends_run(std::size_t post) const {
    return !is_void(post) && (post + 1 == posts_.size() || is_void(post + 1));
  }

  void add_states(uint32_t post) {
    first_.push_back(states_.size());
    if (is_void(post)) return;
    const Sample& sample = *posts_[post].sample;
    const int64_t nearest = height_near_aim(posts_[post]);
    const bool is_corner = post == 0 || post + 1 == posts_.size();
    const int64_t reach = is_corner || !model_.bounded || sample.is_unbounded() ? 0 : kReach;
    const int64_t room =
        std::max(sample.highest - nearest * kStep, nearest * kStep - sample.lowest) / kStep;
    const int64_t stride = std::max<int64_t>(1, room / kReach);
    for (int64_t k = -reach; k <= reach; ++k) {
      const int64_t height = nearest + k * stride;
      const bool fits = height >= std::numeric_limits<int16_t>::min() &&
                        height <= std::numeric_limits<int16_t>::max();
      if (!fits || (k != 0 && model_.violation(sample, static_cast<int32_t>(height * kStep)) != 0))
        continue;
      states_.push_back({post, static_cast<int16_t>(height), kUnreached, kNone});
    }
  }

  // The allowed height that is nearest to the aim.
  int64_t height_near_aim(const LinePost& post) const {
    const int64_t nearest = model_.vertex_height(*post.sample);
    if (!model_.bounded) return nearest;
    const Wide aim = round_divide(Wide{post.aim}, kStep);
    const Wide lowest = ceil_divide(post.sample->lowest, kStep),
               highest = floor_divide(post.sample->highest, kStep);
    return lowest > highest ? nearest : static_cast<int64_t>(std::clamp(aim, lowest, highest));
  }

  void start(uint32_t post) {
    for (std::size_t s = first_[post]; s < first_[post + 1]; ++s) {
      states_[s].cost = price_ + Piece::square(posts_[post].aim - states_[s].height * kStep);
    }
  }

  // Tries every straight piece that begins there.
  void extend(std::size_t from) {
    const State start = states_[from];
    if (start.cost == kUnreached) return;
    const int64_t height = start.height * kStep;
    Cone cone;
    Piece piece;
    for (uint32_t post = start.post + 1; post < posts_.size() && !is_void(post); ++post) {
      const int64_t run = position(post) - position(start.post);
      piece.add(posts_[post].aim - height, run);
      for (std::size_t s = first_[post]; s < first_[post + 1]; ++s) {
        State& state = states_[s];
        const int64_t rise = state.height * kStep - height;
        if (!cone.holds({rise, run})) continue;
        const Cost cost = start.cost + price_ + piece.squares(rise);
        if (cost >= state.cost) continue;
        state.cost = cost;
        state.before = from;
      }
      if (posts_[post].kept || !model_.bounded) return;
      cone.narrow(*posts_[post].sample, height, run);
      if (cone.is_empty()) return;
    }
  }

  // The best chain of the run that ends there.
  void append(uint32_t post, std::vector<ChainVertex>& vertices) const {
    const auto cheaper = [](const State& a, const State& b) { return a.cost < b.cost; };
    const auto begin = states_.begin();
    const auto best =
        std::min_element(begin + static_cast<std::ptrdiff_t>(first_[post]),
                         begin + static_cast<std::ptrdiff_t>(first_[post + 1]), cheaper);
    const std::size_t size = vertices.size();
    std::size_t s = static_cast<std::size_t>(best - begin);
    for (; s != kNone; s = states_[s].before) {
      vertices.push_back({states_[s].post, states_[s].height});
    }
    std::reverse(vertices.begin() + static_cast<std::ptrdiff_t>(size), vertices.end());
  }

  const std::vector<LinePost>& posts_;
  ErrorModel model_;
  Cost price_;  // of a vertex
  std::vector<State> states_;
  std::vector<std::size_t> first_;  // of each post, and one more
};

}  // namespace

std::vector<ChainVertex> simplify_line(const std::vector<LinePost>& posts, ErrorModel model,
                                       uint32_t price) {
  return Chain(posts, model, price).vertices();
}

// Reads a tile with the posts next to it, and finds the vertices of its four borders.

TileBox around(const TileGrid& grid, const TileBox& box, uint32_t reach_x, uint32_t reach_y) {
  return {box.x - std::min(box.x, reach_x), box.y - std::min(box.y, reach_y),
          std::min(box.x_end + reach_x, grid.x_max), std::min(box.y_end + reach_y, grid.y_max)};
}

namespace {

// The tiles in one direction that hold a coordinate.
std::vector<uint32_t> slices_at(uint32_t k, uint32_t size, uint32_t slices) {
  const uint32_t slice = k / size;
  std::vector<uint32_t> found;
  if (k % size == 0 && slice > 0) found.push_back(slice - 1);
  if (slice < slices) found.push_back(slice);
  return found;
}

GlobalPost post_of(const TileBox& line, uint32_t post) {
  return line.x == line.x_end ? GlobalPost{line.x, line.y + post}
                              : GlobalPost{line.x + post, line.y};
}

// A tile's side that is another tile's, too, from its first corner northwards or eastwards.
struct Border {
  TileBox line;
  uint32_t neighbour;
};

std::vector<Border> borders_of(const TileGrid& grid, uint32_t tile) {
  const TileBox box = tile_box(grid, tile);
  const uint32_t columns = tile_columns(grid);
  std::vector<Border> borders;
  if (box.x != 0) borders.push_back({{box.x, box.y, box.x, box.y_end}, tile - 1});
  if (box.x_end != grid.x_max) {
    borders.push_back({{box.x_end, box.y, box.x_end, box.y_end}, tile + 1});
  }
  if (box.y != 0) borders.push_back({{box.x, box.y, box.x_end, box.y}, tile - columns});
  if (box.y_end != grid.y_max) {
    borders.push_back({{box.x, box.y_end, box.x_end, box.y_end}, tile + columns});
  }
  return borders;
}

// A box and the posts around it on which aims depend.
TileBox with_ground(const TiledRaster& tiled, const TileBox& box) {
  const Raster& frame = tiled.raster.frame();
  return around(tiled.grid, box, kGroundReach + farthest_post(frame.x_spacing),
                kGroundReach + farthest_post(frame.y_spacing));
}

constexpr uint32_t kVertexPrice = 2;  // more expensive ones make ridges of noisy borders

uint32_t place_on_line(const Sample& sample) {
  return uint32_t{sample.place.x} + sample.place.y;
}

// A post of a line with the ground as its aim.
LinePost post_with_aim(const TilePosts& posts, const Ground& ground, const TileBox& strip,
                       const TileBox& line, const Sample& sample) {
  const GlobalPost place = post_of(line, place_on_line(sample));
  const int64_t bounds = int64_t{sample.highest} - sample.lowest;
  return {sample, posts.is_beside_void(place.x, place.y),
          ground.at(place.x - strip.x, place.y - strip.y, bounds / 8)};
}

// Where posts are not at every place.
std::vector<LinePost> posts_of_sparse_line(const TiledRaster& tiled, const TilePosts& posts,
                                           const TileBox& line) {
  const Raster& frame = tiled.raster.frame();
  const TileBox strip = with_ground(tiled, line);
  const Raster part = posts.crop_of(strip);
  const std::vector<Sample> samples = survey_of(tiled, part).samples;
  const PlaceSamples places(part, samples);
  const Ground ground(places.all(), part.width, part.height);
  const bool is_row = line.y == line.y_end;
  const SparseLine inner{line.x - strip.x, line.y - strip.y, places_of(line), is_row};
  std::vector<LinePost> on_line;
  for (const auto& sample :
       line_samples(places, inner, is_row ? frame.x_spacing : frame.y_spacing)) {
    on_line.push_back(sample ? post_with_aim(posts, ground, strip, line, *sample) : LinePost{});
  }
  return on_line;
}

// Leaves out pins at void posts.
std::vector<Pin> at_samples(std::vector<Pin> pins, const Survey& survey) {
  const std::vector<Point> places = places_of(survey.samples);
  pins.erase(std::remove_if(pins.begin(), pins.end(),
                            [&](const Pin& pin) {
                              return !std::binary_search(places.begin(), places.end(), pin.place);
                            }),
             pins.end());
  return pins;
}

// The posts of a border; those that breaklines need as vertices are fixed.
Survey survey_of_border(const TiledRaster& tiled, const TilePosts& posts, const TileBox& line) {
  const Raster part = posts.crop_of(line);
  Survey survey = survey_of(tiled, part);
  if (tiled.lines == nullptr) return survey;
  BorderPins pins = tiled.lines->pins_on(tiled.grid, line);
  const Placement lattice{part.x, part.y, tiled.lattice.placement.z};
  for (std::vector<Pin>* const some : {&pins.heights, &pins.vertices}) {
    survey.fixed.clear();
    terrain::pin(survey, at_samples(std::move(*some), survey), line_room(tiled), lattice);
  }
  return survey;
}

// Aims at the ground on both sides: a border that follows the noise of its own posts stands out.
std::vector<LinePost> posts_of_line(const TiledRaster& tiled, const TilePosts& posts,
                                    const TileBox& line) {
  if (is_sparse(tiled.raster.frame())) return posts_of_sparse_line(tiled, posts, line);
  std::vector<LinePost> on_line(places_of(line));
  const TileBox strip = with_ground(tiled, line);
  const Ground ground(survey_of(tiled, posts.crop_of(strip)).samples, strip.x_end - strip.x + 1,
                      strip.y_end - strip.y + 1);
  const Survey survey = survey_of_border(tiled, posts, line);
  for (const Sample& sample : survey.samples) {
    on_line[place_on_line(sample)] = post_with_aim(posts, ground, strip, line, sample);
  }
  for (const Point place : survey.fixed) on_line[std::size_t{place.x} + place.y].kept = true;
  return on_line;
}

}  // namespace

TilePosts::TilePosts(const TiledRaster& tiled, uint32_t tile)
    : number_(tile), box_(tile_box(tiled.grid, tile)) {
  const TileBox all = with_ground(tiled, box_);
  x_ = all.x;
  y_ = all.y;
  posts_ = tiled.raster.read({x_, y_, all.x_end - x_ + 1, all.y_end - y_ + 1});
}

Raster TilePosts::crop_of(const TileBox& box) const {
  return crop(posts_, {box.x - x_, box.y - y_, box.x_end - box.x + 1, box.y_end - box.y + 1});
}

bool TilePosts::is_beside_void(uint32_t x, uint32_t y) const {
  const uint32_t column = x - x_, row = y - y_, dx = posts_.x_spacing, dy = posts_.y_spacing;
  for (uint32_t r = row - std::min(row, dy); r <= std::min(row + dy, posts_.height - 1); ++r) {
    for (uint32_t c = column - std::min(column, dx); c <= std::min(column + dx, posts_.width - 1);
         ++c) {
      if (posts_.heights[std::size_t{r} * posts_.width + c] == kVoidHeight) return true;
    }
  }
  return false;
}

Survey survey_of(const TiledRaster& tiled, const Raster& part, const LatticeOptions& options) {
  Lattice lattice = tiled.lattice;
  lattice.placement.x = part.x;
  lattice.placement.y = part.y;
  return lay_out(part, lattice, options).survey;
}

Survey survey_of(const TiledRaster& tiled, const Raster& part) {
  return survey_of(tiled, part, first_fit(tiled.options));
}

std::vector<uint32_t> tiles_at(const TileGrid& grid, GlobalPost post) {
  const uint32_t columns = tile_columns(grid);
  std::vector<uint32_t> tiles;
  for (const uint32_t row : slices_at(post.y, grid.height, tile_rows(grid))) {
    for (const uint32_t column : slices_at(post.x, grid.width, columns)) {
      tiles.push_back(row * columns + column);
    }
  }
  return tiles;
}

namespace {

// The corners of tiles that are kept have the heights that they had.
void pin_corners(const KeptTiles& kept, const TileBox& line, std::vector<LinePost>& on_line) {
  for (const std::size_t post : {std::size_t{0}, on_line.size() - 1}) {
    if (!on_line[post].sample) continue;
    const auto height = kept.height_at(post_of(line, place_on_line(*on_line[post].sample)));
    if (!height) continue;
    const Sample pinned = fixed_sample(on_line[post].sample->place, *height);
    on_line[post] = {pinned, true, pinned.height};
  }
}

// A chain with which tiles can keep the bound of the options.
std::vector<ChainVertex> simplify_border(const TiledRaster& tiled, const TilePosts& posts,
                                         const TileBox& line, std::vector<LinePost>& on_line) {
  const ErrorModel model{tiled.options.max_error.has_value()};
  std::optional<BorderStrip> strip;
  if (is_bound_everywhere(tiled.options)) strip.emplace(tiled, posts, line).pin_ends(on_line);
  if (tiled.kept != nullptr) pin_corners(*tiled.kept, line, on_line);
  for (;;) {  // ends: each time more posts are vertices
    std::vector<ChainVertex> chain = simplify_line(on_line, model, kVertexPrice);
    if (!strip || !strip->pin_missed(chain, on_line)) return chain;
  }
}

// The vertices on a border of a tile, by place in the tile.
SharedVertices chain_of(const TiledRaster& tiled, const TilePosts& posts, const TileBox& line) {
  std::vector<LinePost> on_line = posts_of_line(tiled, posts, line);
  SharedVertices vertices;
  for (const ChainVertex& vertex : simplify_border(tiled, posts, line, on_line)) {
    const GlobalPost post = post_of(line, place_on_line(*on_line[vertex.post].sample));
    vertices[{static_cast<uint16_t>(post.x - posts.box().x),
              static_cast<uint16_t>(post.y - posts.box().y)}] = vertex.height;
  }
  return vertices;
}

// Those that a neighbour has there, by place in the tile.
SharedVertices kept_chain(const TiledRaster& tiled, const TileBox& box, const Border& border) {
  const TileBox other = tile_box(tiled.grid, border.neighbour);
  const TileBox& line = border.line;
  SharedVertices vertices;
  for (const auto& [place, height] : tiled.kept->border(border.neighbour)) {
    const GlobalPost post = {other.x + place.x, other.y + place.y};
    if (post.x < line.x || post.x > line.x_end || post.y < line.y || post.y > line.y_end) continue;
    vertices[{static_cast<uint16_t>(post.x - box.x), static_cast<uint16_t>(post.y - box.y)}] =
        height;
  }
  return vertices;
}

}  // namespace

SharedVertices shared_vertices(const TiledRaster& tiled, const TilePosts& posts) {
  SharedVertices shared;
  for (const Border& border : borders_of(tiled.grid, posts.number())) {
    const bool is_kept = tiled.kept != nullptr && tiled.kept->has_terrain(border.neighbour);
    shared.merge(is_kept ? kept_chain(tiled, posts.box(), border)
                         : chain_of(tiled, posts, border.line));
  }
  return shared;
}

}  // namespace microtin::pack
