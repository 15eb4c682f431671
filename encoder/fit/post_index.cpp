// SPDX-License-Identifier: MIT
// Sorts posts into square cells of about one post each: counting sort.
#include "encoder/fit/post_index.hpp"

#include <algorithm>

namespace microtin::fit {

PostIndex::PostIndex(const std::vector<Point>& places) {
  uint32_t width = 1, height = 1;
  for (const Point p : places) {
    width = std::max(width, p.x + 1u);
    height = std::max(height, p.y + 1u);
  }
  const auto cells = [&] {
    return std::size_t{(width + cell_ - 1) / cell_} * ((height + cell_ - 1) / cell_);
  };
  while (cells() > 2 * places.size() + 64) ++cell_;
  columns_ = (width + cell_ - 1) / cell_;
  rows_ = (height + cell_ - 1) / cell_;
  first_.resize(cells() + 1);
  const auto cell_of = [&](Point p) { return std::size_t{p.x / cell_} * rows_ + p.y / cell_; };
  for (const Point p : places) ++first_[cell_of(p) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  std::vector<uint32_t> next(first_);
  places_.resize(places.size());
  rows_of_places_.resize(places.size() + kReadAhead);
  numbers_.resize(places.size());
  for (uint32_t i = 0; i < places.size(); ++i) {
    const uint32_t position = next[cell_of(places[i])]++;
    places_[position] = places[i];
    rows_of_places_[position] = places[i].y;
    numbers_[position] = i;
  }
}

std::optional<std::size_t> PostIndex::find(Point p) const {
  if (p.x / cell_ >= columns_ || p.y / cell_ >= rows_) return std::nullopt;
  const std::size_t cell = std::size_t{p.x / cell_} * rows_ + p.y / cell_;
  const auto begin = places_.begin() + first_[cell], end = places_.begin() + first_[cell + 1];
  const auto at = std::find(begin, end, p);
  if (at == end) return std::nullopt;
  return static_cast<std::size_t>(at - places_.begin());
}

}  // namespace microtin::fit
