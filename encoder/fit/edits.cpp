// SPDX-License-Identifier: MIT
// Remembers what changed, last first, to take it back.
#include "encoder/fit/edits.hpp"

#include <limits>

namespace microtin::fit {

bool Edits::remove(Index v) {
  const Edit edit{Edit::kRemoval, v, surface_.vertex(v), surface_.finite_neighbour(v)};
  if (!surface_.remove(v)) return false;
  edits_.push_back(edit);
  return true;
}

Index Edits::insert(Vertex vertex, Index hint) {
  const Index v = surface_.insert(vertex, hint);
  edits_.push_back({Edit::kInsertion, v, vertex, 0});
  return v;
}

bool Edits::set_height(Index v, int32_t height) {
  using Range = std::numeric_limits<int16_t>;
  if (height < Range::min() || height > Range::max()) return false;
  edits_.push_back({Edit::kHeight, v, surface_.vertex(v), 0});
  surface_.set_height(v, static_cast<int16_t>(height));
  return true;
}

void Edits::roll_back(std::size_t size) {
  for (; edits_.size() > size; edits_.pop_back()) {
    const Edit& edit = edits_.back();
    switch (edit.kind) {
      case Edit::kRemoval:  // the last free number, so it gets its own again
        surface_.insert(edit.before, surface_.edge_of(edit.neighbour));
        break;
      case Edit::kInsertion:
        surface_.remove(edit.vertex);
        break;
      case Edit::kHeight:
        surface_.set_height(edit.vertex, edit.before.z);
        break;
    }
  }
}

}  // namespace microtin::fit
