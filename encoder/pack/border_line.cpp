// SPDX-License-Identifier: MIT
// Finds the fewest vertices along a line of posts by dynamic programming.
#include "encoder/pack/border_line.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <utility>

namespace microtin::pack {
namespace {

constexpr int64_t kStep = 65536;  // heights of samples have 16 fractional bits
constexpr int kReach = 4;         // heights that are tried above and below that of the source

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

// What a chain costs up to a vertex: vertices, then distances from the source.
using Cost = std::pair<uint32_t, uint64_t>;
constexpr Cost kUnreached{std::numeric_limits<uint32_t>::max(), 0};

// A post that may become a vertex at this height.
struct State {
  uint32_t post;
  int16_t height;
  Cost cost;
  std::size_t before;  // state of the vertex before
};

class Chain {
 public:
  Chain(const std::vector<LinePost>& posts, ErrorModel model) : posts_(posts), model_(model) {
    for (uint32_t post = 0; post < posts.size(); ++post) add_states(post);
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
    const int64_t nearest = model_.vertex_height(sample);
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
      states_.push_back({post, static_cast<int16_t>(height), kUnreached, 0});
    }
  }

  uint64_t deviation(const State& state) const {
    return static_cast<uint64_t>(
        std::abs(state.height * kStep - int64_t{posts_[state.post].sample->height}));
  }

  void start(uint32_t post) {
    for (std::size_t s = first_[post]; s < first_[post + 1]; ++s) {
      states_[s].cost = {1, deviation(states_[s])};
    }
  }

  // Tries every straight piece that begins there.
  void extend(std::size_t from) {
    const State start = states_[from];
    if (start.cost == kUnreached) return;
    const int64_t height = start.height * kStep;
    Cone cone;
    for (uint32_t post = start.post + 1; post < posts_.size() && !is_void(post); ++post) {
      const int64_t run = position(post) - position(start.post);
      for (std::size_t s = first_[post]; s < first_[post + 1]; ++s) {
        State& state = states_[s];
        if (!cone.holds({state.height * kStep - height, run})) continue;
        const Cost cost{start.cost.first + 1, start.cost.second + deviation(state)};
        if (!(cost < state.cost)) continue;
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
    for (uint32_t left = best->cost.first; left > 0; --left, s = states_[s].before) {
      vertices.push_back({states_[s].post, states_[s].height});
    }
    std::reverse(vertices.begin() + static_cast<std::ptrdiff_t>(size), vertices.end());
  }

  const std::vector<LinePost>& posts_;
  ErrorModel model_;
  std::vector<State> states_;
  std::vector<std::size_t> first_;  // of each post, and one more
};

}  // namespace

std::vector<ChainVertex> simplify_line(const std::vector<LinePost>& posts, ErrorModel model) {
  return Chain(posts, model).vertices();
}

}  // namespace microtin::pack
