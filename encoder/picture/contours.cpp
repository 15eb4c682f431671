// SPDX-License-Identifier: MIT
// Cuts each triangle at the levels between its vertices, and joins the pieces at the edges.
#include "encoder/picture/contours.hpp"

#include <optional>
#include <unordered_map>

#include "encoder/base/error.hpp"
#include "encoder/picture/legend.hpp"

namespace microtin::picture {
namespace {

constexpr size_t kMostPieces = 5'000'000;
constexpr uint32_t kNone = UINT32_MAX;

// An edge at a level: lower vertex number first.
struct Crossing {
  int64_t level;
  uint32_t a, b;

  bool operator==(const Crossing& other) const {
    return level == other.level && a == other.a && b == other.b;
  }
};

struct CrossingHash {
  size_t operator()(const Crossing& c) const {
    const uint64_t edge = uint64_t{c.a} << 32 | c.b;
    return static_cast<size_t>(
        (edge ^ static_cast<uint64_t>(c.level) << 20) * 0x9E3779B97F4A7C15U >> 16);
  }
};

// A crossing, and the crossings that pieces of its line lead to: one at a border, else two.
struct Joint {
  Crossing at;
  std::array<uint32_t, 2> next;
};

class Cutter {
 public:
  Cutter(const SurfaceModel& model, Decimal interval) : model_(model) {
    const Axis& z = model.placement.z;
    step_ = Wide{z.numerator} * power_of_ten(interval.decimals);
    offset_ = Wide{z.offset} * power_of_ten(interval.decimals);
    interval_ = Wide{interval.mantissa} * static_cast<Wide>(z.denominator);
    for (const auto& triangle : model.triangles) cut(triangle);
  }

  std::vector<Contour> lines() {
    std::vector<Contour> all;
    for (const bool closed : {false, true}) {  // those with ends first: from their ends
      for (uint32_t joint = 0; joint < joints_.size(); ++joint) {
        const bool is_end = joints_[joint].next[1] == kNone;
        if (!followed_[joint] && is_end != closed) all.push_back(follow(joint, closed));
      }
    }
    return all;
  }

 private:
  // The highest level below a height: |offset + z * step| < 2^63 * 10^18 is a Wide.
  int64_t level_below(int64_t z) const {
    const Wide level = ceil_divide(offset_ + z * step_, interval_) - 1;
    if (magnitude(level) > INT32_MAX) throw Error("the interval of contours is too small");
    return static_cast<int64_t>(level);
  }

  void cut(const std::array<uint32_t, 3>& triangle) {
    std::array<int64_t, 3> below{};
    for (size_t i = 0; i < 3; ++i) below[i] = level_below(model_.vertices[triangle[i]][2]);
    const auto [low, high] = std::minmax_element(below.begin(), below.end());
    for (int64_t level = *low + 1; level <= *high; ++level) {
      std::array<uint32_t, 2> ends{};
      size_t count = 0;
      for (size_t i = 0; i < 3; ++i) {  // two of the three edges are crossed
        const size_t j = (i + 1) % 3;
        if ((below[i] < level) == (below[j] < level)) continue;
        ends[count++] = joint_at(
            {level, std::min(triangle[i], triangle[j]), std::max(triangle[i], triangle[j])});
      }
      connect(ends[0], ends[1]);
      connect(ends[1], ends[0]);
    }
  }

  uint32_t joint_at(const Crossing& at) {
    const auto [found, is_new] = numbers_.emplace(at, static_cast<uint32_t>(joints_.size()));
    if (is_new) {
      if (joints_.size() == kMostPieces) throw Error("the interval of contours is too small");
      joints_.push_back({at, {kNone, kNone}});
      followed_.push_back(false);
    }
    return found->second;
  }

  void connect(uint32_t from, uint32_t to) {
    std::array<uint32_t, 2>& next = joints_[from].next;
    next[next[0] == kNone ? 0 : 1] = to;
  }

  // Both triangles at an edge find the same place.
  Spot place(const Crossing& at) const {
    const auto &a = model_.vertices[at.a], &b = model_.vertices[at.b];
    const Wide above = at.level * interval_ - offset_ - a[2] * step_;
    const double t = static_cast<double>(above) /
                     (static_cast<double>(b[2] - a[2]) * static_cast<double>(step_));
    const auto along = [&](size_t axis) {
      return static_cast<double>(a[axis]) + t * static_cast<double>(b[axis] - a[axis]);
    };
    return {along(0), along(1)};
  }

  Contour follow(uint32_t start, bool closed) {
    Contour line{joints_[start].at.level, {}};
    for (uint32_t at = start; at != kNone && !followed_[at];) {
      followed_[at] = true;
      line.places.push_back(place(joints_[at].at));
      const std::array<uint32_t, 2>& next = joints_[at].next;
      const bool first_is_done = next[0] == kNone || followed_[next[0]];
      at = first_is_done ? next[1] : next[0];
    }
    if (closed) line.places.push_back(line.places.front());
    return line;
  }

  const SurfaceModel& model_;
  Wide step_, offset_, interval_;  // of heights, all over one denominator
  std::vector<Joint> joints_;
  std::vector<bool> followed_;
  std::unordered_map<Crossing, uint32_t, CrossingHash> numbers_;
};

}  // namespace

std::optional<Decimal> round_interval(double low, double high) {
  constexpr int kLines = 10, kDecimals = kMaxDecimals;
  if (!(high > low)) return std::nullopt;
  const double interval = round_length((high - low) / kLines);
  const double mantissa = std::round(interval * static_cast<double>(power_of_ten(kDecimals)));
  return make_decimal(static_cast<int64_t>(std::clamp(mantissa, 1.0, 9e17)), kDecimals);
}

std::vector<Contour> contours_of(const SurfaceModel& model, Decimal interval) {
  return Cutter(model, interval).lines();
}

}  // namespace microtin::picture
