// SPDX-License-Identifier: MIT
// Samples that breaklines need, with the heights that terrain and line allow there.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

#include "encoder/base/error.hpp"
#include "encoder/exact/wide.hpp"
#include "encoder/terrain/breaklines.hpp"
#include "shared/lattice.hpp"

namespace microtin::terrain {
namespace {

constexpr double kPartsOfStep = 65536;  // of the heights of samples, in a z step

// Heights from lowest to highest, in 2^-16 z steps.
struct Limits {
  int64_t lowest, highest;

  bool has_step() const {
    return exact::ceil_divide(lowest, 65536) <= exact::floor_divide(highest, 65536);
  }
};

constexpr Limits kAnyHeight{INT32_MIN, INT32_MAX};

Limits both_of(Limits a, Limits b) {
  return {std::max(a.lowest, b.lowest), std::min(a.highest, b.highest)};
}

Limits around_height(double height, double radius) {
  const auto within = [](double number) {
    return static_cast<int64_t>(std::clamp(number, -2147483648.0, 2147483647.0));
  };
  return {within(std::ceil((height - radius) * kPartsOfStep)),
          within(std::floor((height + radius) * kPartsOfStep))};
}

int32_t height_number(double height) {
  return static_cast<int32_t>(around_height(height, 0).highest);
}

// The step within some limits that is nearest to the middle of others.
Limits one_step(Limits within, Limits near) {
  const int64_t middle = (near.lowest + near.highest) / 2;
  const int64_t step = static_cast<int64_t>(std::clamp(exact::round_divide(middle, 65536),
                                                       exact::ceil_divide(within.lowest, 65536),
                                                       exact::floor_divide(within.highest, 65536)));
  return {step * 65536, step * 65536};
}

bool is_sample_before(const Sample& sample, Point p) {
  return sample.place < p;
}

// The mean height of the samples around a place, those nearby most: by the inverse square of their
// distance.
double height_nearby(const std::vector<Sample>& samples, Point p) {
  constexpr std::size_t kEnough = 4;
  double weights = 0, heights = 0;
  std::size_t count = 0;
  for (int reach = 1; count < kEnough && reach <= kLatticeMax; reach *= 2) {
    weights = heights = 0;
    count = 0;
    for (int x = std::max(p.x - reach, 0); x <= std::min(p.x + reach, kLatticeMax + 0); ++x) {
      const Point from{static_cast<uint16_t>(x), static_cast<uint16_t>(std::max(p.y - reach, 0))};
      auto at = std::lower_bound(samples.begin(), samples.end(), from, is_sample_before);
      for (; at != samples.end() && at->place.x == x && at->place.y <= p.y + reach; ++at) {
        const double dx = double{0} + x - p.x, dy = double{0} + at->place.y - p.y;
        const double weight = 1 / std::max(dx * dx + dy * dy, 1.0);
        weights += weight;
        heights += weight * at->height / kPartsOfStep;
        ++count;
      }
    }
  }
  return weights != 0 ? heights / weights : 0;
}

class Pinning {
 public:
  Pinning(Survey& survey, LineRoom room, const Placement& lattice)
      : survey_(survey), room_(room), lattice_(lattice), own_(survey.samples.size()) {}

  // Pins at one place.
  void add(const Pin* first, const Pin* last) {
    Limits narrow = kAnyHeight, wide = kAnyHeight;
    std::optional<double> height;
    for (const Pin* one = first; one != last; ++one) {
      if (!one->height) continue;
      if (!height) height = one->height;
      narrow = both_of(narrow, around_height(*one->height + room_.middle, room_.radius / 2));
      wide = both_of(wide, around_height(*one->height + room_.middle, room_.radius));
    }
    const auto end = survey_.samples.begin() + static_cast<std::ptrdiff_t>(own_);
    const auto at = std::lower_bound(survey_.samples.begin(), end, first->place, is_sample_before);
    const bool is_own = at != end && at->place == first->place;
    if (is_own && !height) return;
    if (!height) {
      height = height_nearby(survey_.samples, first->place);
      narrow = wide = around_height(*height, room_.radius);
      if (!wide.has_step()) narrow = wide = kAnyHeight;
    }
    const Limits before = is_own ? Limits{at->lowest, at->highest} : kAnyHeight;
    const Limits limits = choose(before, narrow, wide, first, last, is_own ? &*at : nullptr);
    const auto lowest = static_cast<int32_t>(limits.lowest),
               highest = static_cast<int32_t>(limits.highest);
    if (is_own) {
      at->lowest = lowest;
      at->highest = highest;
    } else {
      made_.push_back({first->place, height_number(*height), lowest, highest});
    }
  }

  void finish() {
    std::vector<Sample>& samples = survey_.samples;
    samples.insert(samples.end(), made_.begin(), made_.end());
    std::inplace_merge(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(own_),
                       samples.end(),
                       [](const Sample& a, const Sample& b) { return a.place < b.place; });
  }

 private:
  Limits choose(Limits before, Limits narrow, Limits wide, const Pin* first, const Pin* last,
                const Sample* sample) const {
    const Limits usual = both_of(before, narrow), most = both_of(before, wide);
    if (usual.has_step()) return usual;
    if (most.has_step()) return one_step(most, usual);
    refuse(first, last, sample);
  }

  std::string height_text(double z) const {
    const double height = exact::offset_of(lattice_.z) + exact::step_of(lattice_.z) * z;
    const auto decimal = exact::shortest_decimal(height, 3);
    return decimal ? to_string(*decimal) : "-";
  }

  [[noreturn]] void refuse(const Pin* first, const Pin* last, const Sample* sample) const {
    std::string heights;
    for (const Pin* one = first; one != last; ++one) {
      if (!one->height) continue;
      heights += (heights.empty() ? "line " : ", line ") + std::to_string(one->line + 1) + " at " +
                 height_text(*one->height);
    }
    if (sample != nullptr)
      heights += ", the terrain at " + height_text(sample->height / kPartsOfStep);
    throw Error(parameter("breaklines") + ": at " + place_text(place_of(first->place), lattice_) +
                " no z step is within the bound of all heights: " + heights + "; use a larger " +
                parameter("max_error") + ", a smaller " + parameter("xy_step") +
                ", or leave out the heights of the lines");
  }

  Survey& survey_;
  LineRoom room_;
  const Placement& lattice_;
  std::size_t own_;
  std::vector<Sample> made_;
};

}  // namespace

LineRoom room_of(Decimal max_error, bool never_below, double z_step) {
  const double bound = exact::real(max_error) / z_step;
  return never_below ? LineRoom{bound / 2, bound / 2} : LineRoom{0, bound};
}

std::vector<double> heights_at(const LatticeLine& line, LinePlace vertex, double along) {
  constexpr double kNear = 1.5;  // steps along the line: places that move there are nearer
  if (!line.has_heights()) return {};
  const double low = std::max(along - kNear, 0.0), high = std::min(along + kNear, line.length());
  std::vector<double> heights{line.at(along).z, line.at(line.foot(vertex, low, high)).z};
  const LatticeLine::Range near = line.between(along - kNear, along + kNear);
  for (std::size_t i = near.first; i < near.last; ++i) {
    const LinePlace place = line.places()[i];
    const bool moves_there = nearest_step(place.x) == vertex.x && nearest_step(place.y) == vertex.y;
    if (moves_there) heights.push_back(place.z);
  }
  return heights;
}

void add_pins(const LatticeLine& line, const LineVertex& vertex, std::vector<Pin>& pins) {
  if (!line.has_heights()) pins.push_back({vertex.place, std::nullopt, line.number()});
  for (const double height : heights_at(line, place_of(vertex.place), vertex.along)) {
    pins.push_back({vertex.place, height, line.number()});
  }
}

void pin(Survey& survey, std::vector<Pin> pins, LineRoom room, const Placement& lattice) {
  std::stable_sort(pins.begin(), pins.end(),
                   [](const Pin& a, const Pin& b) { return a.place < b.place; });
  Pinning pinning(survey, room, lattice);
  for (std::size_t i = 0; i < pins.size();) {
    std::size_t last = i;
    while (last < pins.size() && pins[last].place == pins[i].place) ++last;
    pinning.add(pins.data() + i, pins.data() + last);
    survey.fixed.push_back(pins[i].place);
    i = last;
  }
  pinning.finish();
  std::sort(survey.fixed.begin(), survey.fixed.end());
  survey.fixed.erase(std::unique(survey.fixed.begin(), survey.fixed.end()), survey.fixed.end());
}

void add_missing_samples(Survey& survey, const Tin& tin, LineRoom room) {
  std::vector<Sample> missing;
  for (const Vertex& v : tin.vertices) {
    const Point place{v.x, v.y};
    const auto at =
        std::lower_bound(survey.samples.begin(), survey.samples.end(), place, is_sample_before);
    if (at != survey.samples.end() && at->place == place) continue;
    const Limits limits = around_height(v.z, room.radius);
    missing.push_back({place, height_number(v.z), static_cast<int32_t>(limits.lowest),
                       static_cast<int32_t>(limits.highest)});
  }
  survey.samples.insert(survey.samples.end(), missing.begin(), missing.end());
  std::sort(survey.samples.begin(), survey.samples.end(),
            [](const Sample& a, const Sample& b) { return a.place < b.place; });
}

}  // namespace microtin::terrain
