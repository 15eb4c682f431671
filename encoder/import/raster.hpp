// SPDX-License-Identifier: MIT
// What the readers of rasters share: marks of voids, places of cells, counts of posts.
#ifndef MICROTIN_ENCODER_IMPORT_RASTER_HPP
#define MICROTIN_ENCODER_IMPORT_RASTER_HPP

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "encoder/layers.hpp"
#include "encoder/terrain/source.hpp"

namespace microtin::importing {

// A number in a text, of any size: infinite if it is beyond 64-bit floating point.
std::optional<double> number_of_any_size(std::string_view word);

// Cells that are not a number are void, and those that have the no-data value in the cells' own
// type: -9999.99 is -9999.990234375 as a float. Values that no height can have have many spellings,
// -3.4e38 and -3.40282e+38; they need to agree to a thousandth.
class NoData {
 public:
  NoData() = default;  // there is no such value, as for NaN
  explicit NoData(double value) : value_(value) {}
  explicit NoData(std::string_view word);  // a number of any size, or NaN

  bool marks(float cell) const;
  bool marks(double cell) const;

  // A text does not tell its type: cells may have been floats, each written to the digits at hand.
  bool marks(std::string_view word) const;

 private:
  double value_ = std::numeric_limits<double>::quiet_NaN();
  std::string text_;  // empty: the value was none
};

// Where the cells of a raster lie that GDAL's six numbers place.

// Whether columns run east and rows south or north. The numbers are the outer corner's x, a cell's
// width, its skew by row, the corner's y, the skew by column, a cell's height. Skews of up to 10^-9
// of a cell are what rounding leaves: they move the last of 65,536 rows by 1/15,000 of a cell.
bool runs_east(const std::array<double, 6>& transform);

// Where the centres of cells lie, of which the first begins or, if their size is below 0, the last
// ends at the corner; in the order in which coordinates grow. Numbers stand for the shortest
// decimals that become them. Throws Error.
Axis axis_of_cells_from(double corner, double size, uint32_t cells);

// Rasters that claim more posts than their files can hold.

// Whether files with `held` bytes, or `held` posts, can hold a raster of `columns` x `rows`, below
// 2^32 each. A header's count alone takes no memory: the function accepts up to 2^24 posts, and
// 1024 for each byte, which is what deflate reaches.
inline bool can_hold(uint64_t held, uint64_t columns, uint64_t rows) {
  constexpr uint64_t kBelieved = uint64_t{1} << 24, kPostsPerByte = 1024;
  return columns * rows <= std::max(kBelieved, held * kPostsPerByte);
}

}  // namespace microtin::importing

#endif
