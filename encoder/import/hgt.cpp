// SPDX-License-Identifier: MIT
// SRTM tiles, read whole or in rectangles.
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/import/import.hpp"
#include "encoder/terrain/degrees.hpp"

namespace microtin::importing {
namespace {

constexpr uint32_t kWgs84 = 4326;
constexpr uint32_t kEgm96Height = 5773;

int64_t height_of(const uint8_t* bytes) {
  const int value = bytes[0] * 256 + bytes[1];
  const int height = value < 32768 ? value : value - 65536;
  return height == -32768 ? kVoidHeight : height;
}

struct Size {
  uint32_t columns = 0, rows = 0;
};

// Posts in a row of a square that takes this many bytes; 0 if there is none.
uint32_t side_of(uint64_t bytes) {
  constexpr uint64_t kMost = uint64_t{1} << 30;  // far beyond any disk, and a square fits 64 bits
  uint64_t low = 0, high = kMost;                // 2 * low^2 <= bytes < 2 * high^2
  while (high - low > 1) {
    const uint64_t middle = (low + high) / 2;
    (2 * middle * middle <= bytes ? low : high) = middle;
  }
  return low >= 2 && 2 * low * low == bytes ? static_cast<uint32_t>(low) : 0;
}

// Towards the poles columns are 2, 3, 4 or 6 times as far apart as rows, as in DTED. No square of
// posts takes as many bytes.
Size size_of(uint64_t bytes) {
  for (const uint32_t rows : {1201U, 3601U}) {
    for (const uint32_t times : {2U, 3U, 4U, 6U}) {
      const uint32_t columns = (rows - 1) / times + 1;
      if (uint64_t{2} * columns * rows == bytes) return {columns, rows};
    }
  }
  const uint32_t side = side_of(bytes);
  return {side, side};
}

class HgtReader : public RasterReader {
 public:
  HgtReader(const std::string& name, std::unique_ptr<ByteSource> bytes)
      : name_(name), bytes_(std::move(bytes)) {
    const auto [columns, rows] = size_of(bytes_->size());
    if (rows == 0) {
      throw Error(name + ": has " + std::to_string(bytes_->size()) +
                  " bytes; an .hgt file has two for each post of a square, as 25934402 for 3601 x "
                  "3601, or of 1801 x 3601, for example, towards the poles");
    }
    const auto cell = cell_of(name);
    if (!cell) {
      throw Error(name + ": the file's name has no position; name it as N43E007.hgt");
    }
    frame_.width = columns;
    frame_.height = rows;
    frame_.x = degree_from(cell->longitude, columns);
    frame_.y = degree_from(cell->latitude, rows);
    frame_.reference = {Unit::kDegree, Unit::kMetre, kWgs84, kEgm96Height, {}};
  }

  Raster read(const PostRectangle& r) const override {
    Raster part = crop_frame(frame_, r);
    part.heights.reserve(size_t{r.width} * r.height);
    std::vector<uint8_t> row(size_t{2} * r.width);
    for (uint32_t y = r.y; y < r.y + r.height; ++y) {
      const uint64_t post = uint64_t{frame_.height - 1 - y} * frame_.width + r.x;
      if (bytes_->read(2 * post, row.data(), row.size()) != row.size()) {
        throw Error(name_ + ": became shorter while it was read; start again when it is complete");
      }
      for (size_t i = 0; i < row.size(); i += 2) part.heights.push_back(height_of(&row[i]));
    }
    return part;
  }

 private:
  static Axis degree_from(int first, uint32_t posts) {
    return {int64_t{first} * (posts - 1), 1, posts - 1};
  }

  std::string name_;
  std::unique_ptr<ByteSource> bytes_;
};

}  // namespace

std::unique_ptr<RasterReader> open_hgt(const std::string& name, std::unique_ptr<ByteSource> bytes) {
  return std::make_unique<HgtReader>(name, std::move(bytes));
}

Raster import_hgt(const std::string& name, const std::string& bytes) {
  const HgtReader reader(name, bytes_in_memory({bytes.begin(), bytes.end()}));
  return reader.read({0, 0, reader.frame().width, reader.frame().height});
}

}  // namespace microtin::importing
