// SPDX-License-Identifier: MIT
// Interpolates samples, with their bounds, between the next posts on both sides.
#include "encoder/pack/sparse_line.hpp"

#include "encoder/exact/wide.hpp"

namespace microtin::pack {
namespace {

constexpr uint32_t kNoSample = 0xFFFFFFFF, kVoid = kNoSample - 1;  // instead of a sample's number

using Found = PlaceSamples::Found;

// Calls look(distance) up to a distance, until it finds something.
template <class Look>
Found next_known(uint32_t reach, uint32_t& distance, const Look& look) {
  for (distance = 1; distance <= reach; ++distance) {
    if (Found found = look(distance); found.is_known) return found;
  }
  return {};
}

// Between two posts, at distances from them. Bounds are rounded inwards, as those of samples.
Sample between(const Sample& first, uint32_t from_a, const Sample& second, uint32_t from_b,
               Point place) {
  // Between a post with a bound and one without, the bound that there is holds.
  const bool is_first_free = first.is_unbounded(), is_second_free = second.is_unbounded();
  const Sample& a = is_first_free && !is_second_free ? second : first;
  const Sample& b = is_second_free && !is_first_free ? first : second;
  const Wide all = from_a + from_b;
  const auto sum = [&](int32_t of_a, int32_t of_b) {
    return Wide{of_a} * from_b + Wide{of_b} * from_a;
  };
  Sample sample{place, static_cast<int32_t>(round_divide(sum(a.height, b.height), all)),
                static_cast<int32_t>(ceil_divide(sum(a.lowest, b.lowest), all)),
                static_cast<int32_t>(floor_divide(sum(a.highest, b.highest), all))};
  if (sample.lowest > sample.highest) sample.lowest = sample.highest = sample.height;
  return sample;
}

// Looks on both sides of a place, in a row or a column.
template <class Low, class High>
Found found_between(Point place, uint32_t reach_low, uint32_t reach_high, const Low& look_low,
                    const High& look_high) {
  uint32_t from_low = 0, from_high = 0;
  const Found low = next_known(reach_low, from_low, look_low);
  const Found high = next_known(reach_high, from_high, look_high);
  if (!low.is_known || !high.is_known) return {};
  if (!low.sample || !high.sample) return {true, std::nullopt};
  return {true, between(*low.sample, from_low, *high.sample, from_high, place)};
}

Point point(uint32_t x, uint32_t y) {
  return {static_cast<uint16_t>(x), static_cast<uint16_t>(y)};
}

}  // namespace

PlaceSamples::PlaceSamples(const Raster& part, const std::vector<Sample>& samples)
    : width_(part.width),
      height_(part.height),
      reach_x_(farthest_post(part.x_spacing)),
      reach_y_(farthest_post(part.y_spacing)),
      samples_(samples),
      numbers_(part.heights.size(), kNoSample) {
  for (std::size_t i = 0; i < part.heights.size(); ++i) {
    if (part.heights[i] == kVoidHeight) numbers_[i] = kVoid;
  }
  for (std::size_t i = 0; i < samples.size(); ++i) {
    numbers_[std::size_t{samples[i].place.y} * width_ + samples[i].place.x] =
        static_cast<uint32_t>(i);
  }
}

Found PlaceSamples::post(uint32_t x, uint32_t y) const {
  const uint32_t number = numbers_[std::size_t{y} * width_ + x];
  if (number == kNoSample) return {};
  if (number == kVoid) return {true, std::nullopt};
  return {true, samples_[number]};
}

Found PlaceSamples::in_row(uint32_t x, uint32_t y) const {
  if (Found here = post(x, y); here.is_known) return here;
  return found_between(
      point(x, y), std::min(reach_x_, x), std::min(reach_x_, width_ - 1 - x),
      [&](uint32_t away) { return post(x - away, y); },
      [&](uint32_t away) { return post(x + away, y); });
}

Found PlaceSamples::in_column(uint32_t x, uint32_t y) const {
  if (Found here = post(x, y); here.is_known) return here;
  return found_between(
      point(x, y), std::min(reach_y_, y), std::min(reach_y_, height_ - 1 - y),
      [&](uint32_t away) { return post(x, y - away); },
      [&](uint32_t away) { return post(x, y + away); });
}

std::optional<Sample> PlaceSamples::at(uint32_t x, uint32_t y) const {
  if (const Found here = in_row(x, y); here.is_known) return here.sample;
  const Found rows = found_between(
      point(x, y), std::min(reach_y_, y), std::min(reach_y_, height_ - 1 - y),
      [&](uint32_t away) { return in_row(x, y - away); },
      [&](uint32_t away) { return in_row(x, y + away); });
  if (rows.is_known) return rows.sample;
  return found_between(
             point(x, y), std::min(reach_x_, x), std::min(reach_x_, width_ - 1 - x),
             [&](uint32_t away) { return in_column(x - away, y); },
             [&](uint32_t away) { return in_column(x + away, y); })
      .sample;
}

std::vector<Sample> PlaceSamples::all() const {
  std::vector<Sample> samples;
  for (uint32_t x = 0; x < width_; ++x) {
    for (uint32_t y = 0; y < height_; ++y) {
      if (const std::optional<Sample> sample = at(x, y)) samples.push_back(*sample);
    }
  }
  return samples;
}

namespace {

// Whether the next of these that are known, on both sides, have samples.
bool is_enclosed(const std::vector<Found>& line, std::size_t place, uint32_t reach) {
  const auto has_sample = [&](std::size_t places, bool is_down) {
    for (std::size_t away = 1; away <= std::min<std::size_t>(places, reach); ++away) {
      const Found& found = line[is_down ? place - away : place + away];
      if (found.is_known) return found.sample.has_value();
    }
    return false;
  };
  return has_sample(place, true) && has_sample(line.size() - 1 - place, false);
}

}  // namespace

std::vector<std::optional<Sample>> line_samples(const PlaceSamples& part, const SparseLine& line,
                                                uint32_t spacing) {
  const uint32_t reach = farthest_post(spacing), end = line.places - 1;
  const auto x = [&](uint32_t i) { return line.is_row ? line.x + i : line.x; };
  const auto y = [&](uint32_t i) { return line.is_row ? line.y : line.y + i; };
  std::vector<Found> posts(line.places);
  for (uint32_t i = 0; i < line.places; ++i) posts[i] = part.post(x(i), y(i));
  std::vector<Found> found = posts;
  for (uint32_t i = 0; i < line.places; ++i) {
    if (i == 0 || i == end) {
      found[i] = {true, part.at(x(i), y(i))};
    } else if (!posts[i].is_known && !is_enclosed(posts, i, reach)) {
      found[i] = line.is_row ? part.in_column(x(i), y(i)) : part.in_row(x(i), y(i));
    }
  }
  std::vector<std::optional<Sample>> samples;
  for (uint32_t i = 0; i < line.places; ++i) {
    if (!found[i].is_known && is_enclosed(found, i, reach)) continue;
    std::optional<Sample> sample = found[i].is_known ? found[i].sample : part.at(x(i), y(i));
    if (sample) sample->place = line.is_row ? point(i, 0) : point(0, i);
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace microtin::pack
