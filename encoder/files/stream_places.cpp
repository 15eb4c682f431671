// SPDX-License-Identifier: MIT
// Finds equal streams by a hash, and by their bytes.
#include "encoder/files/stream_places.hpp"

#include <algorithm>
#include <cstddef>
#include <string_view>

namespace microtin::files {

uint64_t StreamPlaces::place(const std::vector<uint8_t>& stream, const IsAt& is_at) {
  const std::string_view text(reinterpret_cast<const char*>(stream.data()), stream.size());
  const size_t hash = std::hash<std::string_view>()(text);
  const auto [first, last] = places_.equal_range(hash);
  for (auto at = first; at != last; ++at) {
    const Place& place = at->second;
    if (place.size == stream.size() && is_at(place.offset)) return place.offset;
  }
  const uint64_t end = bytes_;
  places_.emplace(hash, Place{end, stream.size()});
  bytes_ += stream.size();
  return end;
}

uint64_t JoinedStreams::add(const std::vector<uint8_t>& stream) {
  if (stream.empty()) return 0;
  const uint64_t end = bytes_.size();
  const uint64_t place = places_.place(stream, [&](uint64_t offset) {
    return std::equal(stream.begin(), stream.end(),
                      bytes_.begin() + static_cast<std::ptrdiff_t>(offset));
  });
  if (place == end) bytes_.insert(bytes_.end(), stream.begin(), stream.end());
  return place;
}

}  // namespace microtin::files
