// SPDX-License-Identifier: MIT
// Puts posts or points on the lattice, and bounds their heights there.
#include "encoder/terrain/lay_out.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/terrain/clouds.hpp"

namespace microtin::terrain {
namespace {

constexpr Wide kOne = 65536;  // heights of samples have 16 fractional bits

struct LaidPost {
  Point place;
  uint32_t number;  // among the source's heights
};

// The source's numbers of heights.
class HeightsOf {
 public:
  explicit HeightsOf(const Source& source)
      : raster_(std::get_if<Raster>(&source)), cloud_(std::get_if<PointCloud>(&source)) {}

  int64_t operator()(const LaidPost& post) const {
    return raster_ != nullptr ? raster_->heights[post.number] : cloud_->points[post.number].z;
  }

 private:
  const Raster* raster_;
  const PointCloud* cloud_;
};

// Calls visit(x, y, z, number) as for_each_numbered_post does, but for each column of a raster in
// turn: on its lattice posts come in lexicographic order then.
template <class Visit>
void for_each_post_by_column(const Source& source, const Visit& visit) {
  const auto* const raster = std::get_if<Raster>(&source);
  if (raster == nullptr) {
    for_each_numbered_post(source, visit);
    return;
  }
  for (uint32_t column = 0; column < raster->width; ++column) {
    for (uint32_t row = 0; row < raster->height; ++row) {
      const std::size_t number = std::size_t{row} * raster->width + column;
      const int64_t z = raster->heights[number];
      if (z != kNoPost) visit(int64_t{column}, int64_t{row}, z, number);
    }
  }
}

// The heights at a place, and the limits that their bounds leave: numerators of the lattice's map.
struct Heights {
  int64_t low = std::numeric_limits<int64_t>::max();
  int64_t high = std::numeric_limits<int64_t>::min();
  Wide lowest = kBelowAll, highest = kAboveAll;

  bool is_bounded() const { return lowest != kBelowAll; }

  static constexpr Wide kAboveAll = Wide{1} << 120, kBelowAll = -kAboveAll;
};

// The posts with heights, by place; the places of the others; how far all move.
class Placing {
 public:
  Placing(const Lattice& lattice, const Source& source) : lattice_(lattice) {
    const auto* const raster = std::get_if<Raster>(&source);
    posts_.reserve(raster != nullptr ? posts_with_height(*raster)
                                     : std::get<PointCloud>(source).points.size());
    for_each_post_by_column(source, [this](int64_t x, int64_t y, int64_t z, std::size_t number) {
      add(x, y, z, number);
    });
    sort();
  }

  const std::vector<LaidPost>& posts() const { return posts_; }
  const std::vector<Point>& voids() const { return voids_; }
  Decimal xy_displacement() const { return make_decimal(xy_displacement_, lattice_.xy_decimals); }
  Decimal z_displacement() const { return make_decimal(z_displacement_, lattice_.z_decimals); }

 private:
  void add(int64_t x, int64_t y, int64_t z, std::size_t number) {
    const Point place{static_cast<uint16_t>(snap(lattice_.x, x, xy_displacement_)),
                      static_cast<uint16_t>(snap(lattice_.y, y, xy_displacement_))};
    if (z == kVoidHeight) {
      voids_.push_back(place);
    } else {
      snap(lattice_.z, z, z_displacement_);
      posts_.push_back({place, static_cast<uint32_t>(number)});
    }
  }

  void sort() {
    const auto before = [](const LaidPost& a, const LaidPost& b) { return a.place < b.place; };
    if (!std::is_sorted(posts_.begin(), posts_.end(), before))
      std::sort(posts_.begin(), posts_.end(), before);
    std::sort(voids_.begin(), voids_.end());
    voids_.erase(std::unique(voids_.begin(), voids_.end()), voids_.end());
  }

  static Wide snap(const LatticeMap& map, int64_t number, Wide& largest) {
    const Wide k = map.nearest(number);
    largest = std::max(largest, magnitude(map.numerator(number) - k * map.step));
    return k;
  }

  const Lattice& lattice_;
  std::vector<LaidPost> posts_;
  std::vector<Point> voids_;
  Wide xy_displacement_ = 0, z_displacement_ = 0;
};

int32_t saturated(Wide height) {
  return static_cast<int32_t>(std::clamp<Wide>(height, INT32_MIN, INT32_MAX));
}

// Makes samples and counts the places where the bound cannot be kept.
class Sampler {
 public:
  // Water, whose heights are kept exactly, is at the options' level.
  Sampler(const Lattice& lattice, const LatticeOptions& options, const Source& source)
      : height_of_(source),
        map_(lattice.z),
        decimals_(lattice.z_decimals),
        bounded_(options.max_error.has_value()),
        is_step_asked_(options.z_step.has_value()),
        never_below_(options.never_below),
        has_own_bounds_(!bounds_of(source).empty()),
        max_error_(bounded_ ? mantissa_at(*options.max_error, decimals_) : Wide{0}),
        bound_of_(bounds_of(source), options.max_error, decimals_),
        water_(number_of(options.water_level, height_decimals(source))) {}

  void add(const LaidPost& post, Heights& heights) const {
    const int64_t z = height_of_(post);
    heights.low = std::min(heights.low, z);
    heights.high = std::max(heights.high, z);
    const Wide above = bound_of_(post.number), height = map_.numerator(z);
    if (above == BoundOf::kNone) return;
    heights.lowest = std::max(heights.lowest, height - (never_below_ ? 0 : above));
    heights.highest = std::min(heights.highest, height + above);
  }

  Sample sample(Point place, Heights heights) {
    const Wide low = map_.numerator(heights.low), high = map_.numerator(heights.high);
    Sample sample{place, saturated(round_divide((low + high) * kOne, 2 * map_.step)), INT32_MIN,
                  INT32_MAX};
    if (!bounded_) return sample;
    if (heights.low == heights.high && heights.low == water_) {
      sample.lowest = sample.highest = sample.height;
      return sample;
    }
    const Wide lowest = heights.lowest, highest = heights.highest;
    if (!heights.is_bounded()) {
      if (water_) keep_dry(heights, lowest, highest, sample);
      return sample;
    }
    narrowest_ = std::min(narrowest_, highest - lowest);
    sample.lowest = saturated(ceil_divide(lowest * kOne, map_.step));
    sample.highest = saturated(floor_divide(highest * kOne, map_.step));
    if (water_) keep_dry(heights, lowest, highest, sample);
    if (lowest > highest) {
      if (walls_++ == 0) first_wall_ = {place, heights};
    } else if (ceil_divide(sample.lowest, kOne) > floor_divide(sample.highest, kOne)) {
      ++without_step_;
    }
    return sample;
  }

  // Throws Error if there are such places.
  void check(const Placement& placement, const Source& source) const {
    const std::string refusal = parameter("max_error") + " cannot be kept at ";
    if (walls_ != 0) {
      const CoordinateText height(placement_of(source).z);
      const bool posts = std::holds_alternative<Raster>(source);
      throw Error(refusal + std::to_string(walls_) +
                  " positions where points of different heights meet, the first at x " +
                  CoordinateText(placement.x)(first_wall_.place.x) + ", y " +
                  CoordinateText(placement.y)(first_wall_.place.y) + " with heights from " +
                  height(first_wall_.heights.low) + " to " + height(first_wall_.heights.high) +
                  (posts ? "; use a smaller " + parameter("xy_step") + ", or none"
                         : "; use " + parameter("duplicates") + " lowest, highest or mean"));
    }
    if (without_step_ != 0) {
      throw Error(refusal + std::to_string(without_step_) +
                  " positions, where no whole z step is near enough; " + remedy());
    }
  }

 private:
  // Land is not at the water level, else it would pass for water.
  void keep_dry(Heights heights, Wide lowest, Wide highest, Sample& sample) {
    const Wide level = map_.numerator(*water_);
    const int32_t answer = saturated(level / map_.step * kOne);
    if (heights.low > *water_ && lowest <= level) {
      sample.lowest = answer + 1;
      narrowest_ = std::min(narrowest_, highest - level);
    } else if (heights.high < *water_ && highest >= level) {
      sample.highest = answer - 1;
      narrowest_ = std::min(narrowest_, level - lowest);
    }
  }

  // A step that was not requested is the finest that fits: then the bound must be wider.
  std::string remedy() const {
    const Wide narrowest = std::max<Wide>(narrowest_, 1);
    if (is_step_asked_) {
      return "use " + parameter("z_step") + ' ' + to_string(make_decimal(narrowest, decimals_)) +
             " or less";
    }
    if (has_own_bounds_) {
      return "16 bits hold these heights in steps of " +
             to_string(make_decimal(map_.step, decimals_)) + ": use larger bounds in the " +
             parameter("error_map") + ", or make tiles of less height";
    }
    const Wide missing = map_.step - narrowest;
    const bool grows_twice = !never_below_ && max_error_ != 0 && !water_;
    const Wide more = grows_twice ? ceil_divide(missing, 2) : missing;
    return "16 bits hold these heights in steps of " +
           to_string(make_decimal(map_.step, decimals_)) + ": use " + parameter("max_error") + ' ' +
           to_string(make_decimal(max_error_ + more, decimals_)) + " or more";
  }

  struct Wall {
    Point place;
    Heights heights;
  };

  HeightsOf height_of_;
  const LatticeMap& map_;
  int decimals_;
  bool bounded_, is_step_asked_, never_below_, has_own_bounds_;
  Wide max_error_;
  BoundOf bound_of_;  // how far the surface may be from a height
  std::optional<int64_t> water_;
  Wide narrowest_ = std::numeric_limits<int64_t>::max();
  uint64_t walls_ = 0, without_step_ = 0;
  Wall first_wall_{};
};

std::vector<Sample> make_samples(const std::vector<LaidPost>& posts, Sampler& sampler) {
  std::size_t places = 0;
  for (size_t i = 0; i < posts.size(); ++i) {
    if (i == 0 || posts[i].place != posts[i - 1].place) ++places;
  }
  std::vector<Sample> samples;
  samples.reserve(places);
  for (size_t i = 0; i < posts.size();) {
    const Point place = posts[i].place;
    Heights heights;
    for (; i < posts.size() && posts[i].place == place; ++i) sampler.add(posts[i], heights);
    samples.push_back(sampler.sample(place, heights));
  }
  return samples;
}

// Throws Error if a void post shares its place with a height: it would answer that.
void check_voids(const std::vector<Point>& voids, const std::vector<Sample>& samples,
                 const Placement& placement) {
  uint64_t shared = 0;
  Point first{};
  auto sample = samples.begin();
  for (const Point place : voids) {
    while (sample != samples.end() && sample->place < place) ++sample;
    if (sample == samples.end() || sample->place != place) continue;
    if (shared++ == 0) first = place;
  }
  if (shared == 0) return;
  throw Error(parameter("xy_step") + " is too coarse: " + std::to_string(shared) +
              " void posts share a position with a height, the first at x " +
              CoordinateText(placement.x)(first.x) + ", y " + CoordinateText(placement.y)(first.y) +
              "; use a smaller one, or none");
}

// A whole step within [lowest, highest] that a vertex can have is kept: the next one to the new
// limits, if these hold none.
void keep_a_step(const Sample& before, Sample& after) {
  const Wide up = ceil_divide(Wide{after.lowest}, kOne) * kOne;
  if (up <= after.highest) return;
  if (up <= before.highest) {
    after.highest = static_cast<int32_t>(up);
  } else {
    after.lowest = static_cast<int32_t>(floor_divide(Wide{after.highest}, kOne) * kOne);
  }
}

// A place that the surface must pass though no point is there: within the limits, or as near their
// middle as a vertex can be.
Sample sample_within(const Tightening& limits) {
  const int32_t middle = saturated((Wide{limits.lowest} + limits.highest) / 2);
  if (ceil_divide(Wide{limits.lowest}, kOne) <= floor_divide(Wide{limits.highest}, kOne)) {
    return {limits.place, middle, limits.lowest, limits.highest};
  }
  const int32_t step = saturated(round_divide(Wide{middle}, kOne) * kOne);
  return {limits.place, step, step, step};
}

void fix_vertices(const std::vector<Tightening>& tightenings, std::vector<Point>& fixed) {
  for (const Tightening& tight : tightenings) {
    if (tight.is_vertex) fixed.push_back(tight.place);
  }
  std::sort(fixed.begin(), fixed.end());
  fixed.erase(std::unique(fixed.begin(), fixed.end()), fixed.end());
}

// Both are in the order of places.
void tighten(std::vector<Sample>& samples, const std::vector<Tightening>& tightenings) {
  const size_t own = samples.size();
  size_t at = 0;
  for (const Tightening& tight : tightenings) {
    while (at != own && samples[at].place < tight.place) ++at;
    if (at == own || samples[at].place != tight.place) {
      samples.push_back(sample_within(tight));
      continue;
    }
    Sample* const sample = &samples[at];
    Sample narrow = *sample;
    narrow.lowest = std::clamp(tight.lowest, sample->lowest, sample->highest);
    narrow.highest = std::clamp(tight.highest, narrow.lowest, sample->highest);
    keep_a_step(*sample, narrow);
    *sample = narrow;
  }
  std::inplace_merge(samples.begin(), samples.begin() + static_cast<ptrdiff_t>(own), samples.end(),
                     [](const Sample& a, const Sample& b) { return a.place < b.place; });
}

// Chains for the breaklines, and their samples.
void add_breaklines(const LatticeOptions& options, const Lattice& lattice, Laid& laid) {
  if (options.breaklines.empty() || !options.max_error) return;
  const auto spacing = [](const LatticeMap& map) {
    return static_cast<double>(map.scale) / static_cast<double>(map.step);
  };
  const LineGround ground = line_ground_of(laid.survey, spacing(lattice.x), spacing(lattice.y));
  laid.line_room =
      room_of(*options.max_error, options.never_below, exact::step_of(laid.placement.z));
  laid.breaklines =
      chains_of(lines_over(ground, options.breaklines, laid.placement), laid.line_room, {}, {});
  pin_chains(laid);
}

void refuse_unbounded(const OwnBounds& own) {
  if (std::find(own.numbers.begin(), own.numbers.end(), kUnbounded) == own.numbers.end()) return;
  throw Error(parameter("never_below") + ": the " + parameter("error_map") +
              " leaves posts without a bound; give them one");
}

}  // namespace

bool may_stand(const Laid& laid, Point place) {
  if (!laid.is_shared || !laid.is_shared(place)) return true;
  return std::binary_search(laid.survey.fixed.begin(), laid.survey.fixed.end(), place);
}

void add_pins(const Laid& laid, const LatticeLine& line, const LineVertex& vertex,
              std::vector<Pin>& pins) {
  if (laid.is_shared && laid.is_shared(vertex.place)) return;
  add_pins(line, vertex, pins);
}

void pin_chains(Laid& laid) {
  std::vector<Pin> pins;
  for (const Chain& chain : laid.breaklines) {
    for (const LineVertex& vertex : chain.vertices) add_pins(laid, chain.line, vertex, pins);
  }
  pin(laid.survey, std::move(pins), laid.line_room, laid.placement);
}

Laid lay_out(const Source& source, const LatticeOptions& options) {
  return lay_out(source, choose_lattice(source, options), options);
}

Laid lay_out(const Source& source, const Lattice& lattice, const LatticeOptions& options) {
  const auto* cloud = std::get_if<PointCloud>(&source);
  if (cloud != nullptr && options.duplicates != DuplicateRule::kMiddle) {
    if (auto thin = thinned(*cloud, lattice.placement, options.duplicates)) {
      LatticeOptions rest = options;
      rest.duplicates = DuplicateRule::kMiddle;
      Laid laid = lay_out(*thin, lattice, rest);
      laid.merged += cloud->points.size() - thin->points.size();
      return laid;
    }
  }
  if (options.never_below) refuse_unbounded(bounds_of(source));
  const Placing placing(lattice, source);
  Sampler sampler(lattice, options, source);
  Laid laid;
  laid.survey.samples = make_samples(placing.posts(), sampler);
  sampler.check(lattice.placement, source);
  laid.merged = placing.posts().size() - laid.survey.samples.size();
  check_voids(placing.voids(), laid.survey.samples, lattice.placement);
  laid.survey.voids = placing.voids();
  laid.placement = lattice.placement;
  laid.z_step = make_decimal(lattice.z.step, lattice.z_decimals);
  add_breaklines(options, lattice, laid);
  tighten(laid.survey.samples, options.tightenings);
  fix_vertices(options.tightenings, laid.survey.fixed);
  laid.xy_step = make_decimal(lattice.x.step, lattice.xy_decimals);
  laid.xy_displacement = placing.xy_displacement();
  laid.z_displacement = placing.z_displacement();
  return laid;
}

}  // namespace microtin::terrain
