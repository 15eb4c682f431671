// SPDX-License-Identifier: MIT
// Sorts posts into square cells of about one post each: counting sort.
#include "encoder/fit/post_index.hpp"

#include <algorithm>

namespace microtin::fit {

PostIndex::PostIndex(const std::vector<Point>& places) : size_(places.size()) {
  if (places.empty()) return;
  find_box(places);
  const auto columns = [&] { return std::size_t{(east_ - west_) / cell_ + 1}; };
  const auto rows = [&] { return std::size_t{(north_ - south_) / cell_ + 1}; };
  while (columns() * rows() > 2 * places.size() + 64) ++cell_;
  rows_ = rows();
  const bool is_sorted = cell_ == 1 && std::is_sorted(places.begin(), places.end());
  is_full_ = is_sorted && columns() * rows_ == places.size();
  if (is_full_) {
    fill_column();
    return;
  }
  first_.resize(columns() * rows_ + 1);
  for (const Point p : places) ++first_[cell_of(p) + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  if (!is_sorted) sort(places);
  places_.reserve(places.size());
  rows_of_places_.resize(places.size() + kReadAhead);
  for (std::size_t i = 0; i < places.size(); ++i) {
    places_.push_back(places[number(i)]);
    rows_of_places_[i] = places_[i].y;
  }
}

void PostIndex::find_box(const std::vector<Point>& places) {
  west_ = south_ = kLatticeMax;
  for (const Point p : places) {
    west_ = std::min<uint32_t>(west_, p.x);
    south_ = std::min<uint32_t>(south_, p.y);
    east_ = std::max<uint32_t>(east_, p.x);
    north_ = std::max<uint32_t>(north_, p.y);
  }
}

void PostIndex::fill_column() {
  reciprocal_ = (int64_t{1} << kReciprocalBits) / static_cast<int64_t>(rows_) + 1;
  rows_of_places_.resize(rows_ + kReadAhead);
  for (std::size_t row = 0; row < rows_; ++row) {
    rows_of_places_[row] = static_cast<float>(south_ + row);
  }
}

void PostIndex::sort(const std::vector<Point>& places) {
  std::vector<uint32_t> next(first_);
  numbers_.resize(places.size());
  for (uint32_t i = 0; i < places.size(); ++i) numbers_[next[cell_of(places[i])]++] = i;
  sort_cells(places);
}

void PostIndex::sort_cells(const std::vector<Point>& places) {
  for (std::size_t cell = 0; cell + 1 < first_.size(); ++cell) {
    if (first_[cell + 1] - first_[cell] < 2) continue;
    std::sort(numbers_.begin() + first_[cell], numbers_.begin() + first_[cell + 1],
              [&](uint32_t a, uint32_t b) { return places[a] < places[b]; });
    has_crowds_ = has_crowds_ || is_crowded(cell);
  }
}

std::optional<std::size_t> PostIndex::find(Point p) const {
  if (size_ == 0 || p.x < west_ || p.x > east_ || p.y < south_ || p.y > north_) {
    return std::nullopt;
  }
  const std::size_t cell = cell_of(p);
  if (is_full_) return cell;
  const auto end = places_.begin() + first_[cell + 1];
  const auto at = std::lower_bound(places_.begin() + first_[cell], end, p);
  if (at == end || *at != p) return std::nullopt;
  return static_cast<std::size_t>(at - places_.begin());
}

}  // namespace microtin::fit
