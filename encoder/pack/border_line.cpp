// SPDX-License-Identifier: MIT
// Finds the cheapest vertices along a line of posts by dynamic programming.
#include "encoder/pack/border_line.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "encoder/exact/wide.hpp"

namespace microtin::pack {
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
      if (is_void(post)) continue;
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
    const int64_t reach = is_corner || !model_.bounded ? 0 : kReach;
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

}  // namespace microtin::pack
