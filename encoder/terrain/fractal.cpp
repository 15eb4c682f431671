// SPDX-License-Identifier: MIT
// Sums octaves of value noise and lets rivers cut into them.
#include "encoder/terrain/fractal.hpp"

#include <algorithm>
#include <functional>
#include <queue>
#include <utility>

#include "encoder/base/error.hpp"

namespace microtin::terrain {
namespace {

// Numbers are fixed point with 16 fractional bits, heights too.
constexpr int64_t kUnit = 65536;

int64_t times(int64_t a, int64_t b) {
  return (a * b) >> 16;
}

// A value in 0 .. 1 for each corner of an octave's grid (the mixer of SplitMix64).
int64_t corner_value(int64_t x, int64_t y, uint64_t seed) {
  uint64_t h = seed * 0xD6E8FEB86659FD93u + static_cast<uint64_t>(x) * 0x9E3779B97F4A7C15u +
               static_cast<uint64_t>(y) * 0xC2B2AE3D27D4EB4Fu;
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9u;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EBu;
  return static_cast<int64_t>((h ^ (h >> 31)) >> 48);
}

// 3t^2 - 2t^3.
int64_t fade(int64_t t) {
  return times(times(t, t), 3 * kUnit - 2 * t);
}

// Smooth random values in 0 .. 1, one for each unit cell's corner and blended between them.
int64_t noise(int64_t x, int64_t y, uint64_t seed) {
  const int64_t column = x >> 16, row = y >> 16;
  const int64_t u = fade(x & (kUnit - 1)), v = fade(y & (kUnit - 1));
  const auto blend = [u, seed, column](int64_t r) {
    const int64_t west = corner_value(column, r, seed);
    return west + times(u, corner_value(column + 1, r, seed) - west);
  };
  const int64_t south = blend(row);
  return south + times(v, blend(row + 1) - south);
}

// Noise of halving waves and heights, 0 .. 1.
int64_t fractal_noise(int64_t x, int64_t y, uint64_t seed) {
  constexpr int kOctaves = 6;
  int64_t sum = 0;
  for (int octave = 1; octave <= kOctaves; ++octave) {
    sum += noise(x, y, seed + static_cast<uint64_t>(octave)) >> octave;
    x *= 2;
    y *= 2;
  }
  return sum;
}

uint64_t square_root(uint64_t n) {
  uint64_t root = 0;
  for (uint64_t bit = uint64_t{1} << 31; bit != 0; bit >>= 1) {
    if ((root + bit) * (root + bit) <= n) root += bit;
  }
  return root;
}

// A landscape that rises slowly while its rivers cut into it, at a rate that grows with their slope
// and with the square root of the area they drain (the stream power law). Its opposite borders
// touch; sea lies along them and wherever the land does not rise.
class Landscape {
 public:
  Landscape(uint32_t side, uint64_t seed)
      : side_(side), posts_(side * side), height_(posts_), rise_(posts_), outlet_(posts_) {
    for (uint32_t post = 0; post < posts_; ++post) {
      const uint32_t x = post % side, y = post / side;
      const int64_t n = fractal_noise(x * kUnit / kLongestWave, y * kUnit / kLongestWave, seed);
      if (x != 0 && y != 0) rise_[post] = std::max<int64_t>(0, kRise * (n - kSeaShare));
      if (rise_[post] != 0) height_[post] = 2 * rise_[post] + 8 * corner_value(x, y, seed);
    }
  }

  // One step of the ages.
  void evolve() {
    find_rivers();
    erode();
    for (int i = 0; i < 4; ++i) creep();
  }

  int64_t height(uint32_t x, uint32_t y) const { return height_[size_t{y} * side_ + x]; }

 private:
  // The eight posts around one, anticlockwise from the east; odd directions are diagonal.
  uint32_t neighbour(uint32_t post, int direction) const {
    const uint32_t s = side_, n = posts_;
    const uint32_t step[8] = {1, s + 1, s, s - 1, n - 1, n - s - 1, n - s, n - s + 1};
    return (post + step[direction]) % n;
  }

  // Floods the land from the sea, always over the lowest post reached; water leaves each post by
  // the steepest way to one flooded before.
  void find_rivers() {
    using Wet = std::pair<int64_t, uint32_t>;
    std::priority_queue<Wet, std::vector<Wet>, std::greater<Wet>> shore;
    std::vector<int64_t> level(posts_, -1);  // of the flood, once it was reached
    std::vector<bool> flooded(posts_);
    order_.clear();
    for (uint32_t post = 0; post < posts_; ++post) {
      if (rise_[post] != 0) continue;
      level[post] = 0;
      shore.push({0, post});
    }
    while (!shore.empty()) {
      const uint32_t post = shore.top().second;
      shore.pop();
      flooded[post] = true;
      order_.push_back(post);
      int64_t steepest = -1;
      for (int direction = 0; direction < 8; ++direction) {
        const uint32_t other = neighbour(post, direction);
        if (flooded[other]) {
          const int64_t fall = level[post] - level[other];
          const int64_t slope = direction % 2 == 0 ? fall : fall * 5 / 7;
          if (slope <= steepest) continue;
          steepest = slope;
          outlet_[post] = other;
        } else if (level[other] < 0) {
          level[other] = std::max(level[post], height_[other]);
          shore.push({level[other], other});
        }
      }
    }
  }

  void erode() {
    std::vector<uint32_t> drained(posts_, 1);
    for (size_t k = posts_; k-- > 0;) {
      const uint32_t post = order_[k];
      if (rise_[post] != 0) drained[outlet_[post]] += drained[post];
    }
    // Downstream first: the implicit step, which no river makes unstable, needs the new height
    // there.
    for (const uint32_t post : order_) {
      if (rise_[post] == 0) continue;
      const auto power = static_cast<int64_t>(square_root(uint64_t{drained[post]} << 28));
      const int64_t below = height_[outlet_[post]];
      height_[post] = below + (height_[post] + rise_[post] - below) * kUnit / (kUnit + power);
    }
  }

  // Soil creeps down every slope and rounds it.
  void creep() {
    const std::vector<int64_t> before = height_;
    for (uint32_t post = 0; post < posts_; ++post) {
      if (rise_[post] == 0) continue;
      int64_t bend = -4 * before[post];
      for (int side = 0; side < 8; side += 2) bend += before[neighbour(post, side)];
      height_[post] += bend / 5;
    }
  }

  static constexpr int64_t kLongestWave = 200;            // of the pattern of rise, in posts
  static constexpr int64_t kSeaShare = kUnit * 32 / 100;  // noise below does not rise
  static constexpr int64_t kRise = 120;                   // metres in a step where the noise is 1

  uint32_t side_, posts_;
  std::vector<int64_t> height_, rise_;
  std::vector<uint32_t> outlet_;  // where a land post's water flows
  std::vector<uint32_t> order_;   // every post after its outlet
};

}  // namespace

std::vector<int16_t> fractal_heights(uint32_t size, uint64_t seed) {
  constexpr uint32_t kMargin = 32;  // cut off, and with it the sea along the borders
  constexpr int kSteps = 30;
  if (size < kSmallestFractal || size > kLargestFractal) {
    throw Error("a fractal has 2 to 8193 posts a side");
  }
  Landscape landscape(size + 2 * kMargin, seed);
  for (int i = 0; i < kSteps; ++i) landscape.evolve();
  std::vector<int16_t> heights;
  heights.reserve(size_t{size} * size);
  for (uint32_t y = 0; y < size; ++y) {
    for (uint32_t x = 0; x < size; ++x) {
      heights.push_back(static_cast<int16_t>(landscape.height(x + kMargin, y + kMargin) / kUnit));
    }
  }
  return heights;
}

void write_fractal_asc(std::ostream& out, uint32_t size, uint64_t seed) {
  const std::vector<int16_t> heights = fractal_heights(size, seed);
  out << "ncols " << size << "\nnrows " << size << "\nxllcenter 0\nyllcenter 0\ncellsize 30\n";
  for (uint32_t y = size; y-- > 0;) {
    for (uint32_t x = 0; x < size; ++x) {
      out << (x == 0 ? "" : " ") << heights[size_t{y} * size + x];
    }
    out << '\n';
  }
}

}  // namespace microtin::terrain
