// SPDX-License-Identifier: MIT
// Joins rasters, which are read in pieces.
#include "encoder/import/mosaic.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/base/text.hpp"
#include "encoder/exact/decimal.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/import/raster.hpp"
#include "encoder/import/reference.hpp"

namespace microtin::importing {
namespace {

bool is_alike(const Reference& a, const Reference& b) {
  return a.horizontal_unit == b.horizontal_unit && a.vertical_unit == b.vertical_unit &&
         a.horizontal_epsg == b.horizontal_epsg && a.vertical_epsg == b.vertical_epsg &&
         a.wkt == b.wkt;
}

std::string text_of(const Reference& reference) {
  std::string text = "x and y " + std::string(name_of(reference.horizontal_unit)) + ", heights " +
                     std::string(name_of(reference.vertical_unit));
  if (reference.horizontal_epsg != 0) text += ", EPSG:" + std::to_string(reference.horizontal_epsg);
  if (reference.vertical_epsg != 0) text += ":" + std::to_string(reference.vertical_epsg);
  return text;
}

// What to do about two files that are not alike.
std::string remedy(const NamedSource& first, const NamedSource& part, const Reference& a,
                   const Reference& b) {
  for (const auto& [file, reference] : {std::tie(first, a), std::tie(part, b)}) {
    if (reference.horizontal_unit != Unit::kUnknown || !reference.wkt.empty()) continue;
    if (suffix_of(file.path) == ".asc") {
      return "add the missing .prj next to " + file.path + ", or set an EPSG code for all";
    }
  }
  const bool is_unknown = a.vertical_unit == Unit::kUnknown || b.vertical_unit == Unit::kUnknown;
  const std::string others = is_unknown ? ", or set units for all" : "";
  return (std::holds_alternative<PointCloud>(part.source) ? "bring all points into one system first"
                                                          : "bring it there with gdalwarp") +
         others;
}

}  // namespace

void expect_alike(const NamedSource& first, const NamedSource& part, const Reference& a,
                  const Reference& b) {
  if (is_alike(a, b)) return;
  throw Error(part.path + ": its units or its coordinate system (" + text_of(b) +
              ") are not those of " + first.path + " (" + text_of(a) +
              "): " + remedy(first, part, a, b));
}

std::vector<bool> turned_east(const std::vector<LongitudeSpan>& spans) {
  constexpr double kHalfTurn = 180;
  std::vector<LongitudeSpan> sorted = spans;
  std::sort(sorted.begin(), sorted.end(),
            [](const LongitudeSpan& a, const LongitudeSpan& b) { return a.west < b.west; });
  double east = sorted[0].east, last_west = -std::numeric_limits<double>::infinity();
  for (const LongitudeSpan& span : sorted) {
    if (span.west - east > kHalfTurn) last_west = east;
    east = std::max(east, span.east);
  }
  std::vector<bool> turned;
  turned.reserve(spans.size());
  for (const LongitudeSpan& span : spans) turned.push_back(span.east <= last_west);
  return turned;
}

std::string turned_text(const std::vector<bool>& turned, double east) {
  const auto count = std::count(turned.begin(), turned.end(), true);
  if (count == 0) return "";
  return "; " + std::to_string(count) +
         (count == 1
              ? " lies beyond 180 degrees east and continues its neighbours' longitudes, to "
              : " lie beyond 180 degrees east and continue their neighbours' longitudes, to ") +
         to_string(*shortest_decimal(east));
}

namespace {

// A rectangle on the grid of the first raster's posts.
struct Box {
  int64_t x, y, width, height;

  int64_t right() const { return x + width; }
  int64_t top() const { return y + height; }

  Box shared_with(const Box& other) const {
    const int64_t left = std::max(x, other.x), bottom = std::max(y, other.y);
    return {left, bottom, std::max<int64_t>(0, std::min(right(), other.right()) - left),
            std::max<int64_t>(0, std::min(top(), other.top()) - bottom)};
  }

  bool empty() const { return width == 0 || height == 0; }
};

// "10 x 10"
std::string cells_of(const Raster& frame) {
  const auto step = [](const Axis& axis) {
    return CoordinateText({0, axis.numerator, axis.denominator})(1);
  };
  return step(frame.x) + " x " + step(frame.y);
}

// Where a raster's first post is among those of another, but for what writers round corners by.
int64_t place_on(const Axis& axis, const Axis& grid, const std::string& path,
                 const std::string& first) {
  constexpr Wide kRounding = 1000000;  // parts of a cell
  const LatticeMap map = map_between(axis, grid);
  const Wide place = map.nearest(0);
  if (magnitude(map.shift - place * map.step) > map.step / kRounding) {
    throw Error(path + ": its posts lie between those of " + first +
                ": bring all onto one grid with gdalwarp -tr -tap");
  }
  return static_cast<int64_t>(place);
}

// Frames of rasters; in degrees those beyond 180 continue their neighbours' longitudes.
struct Frames {
  explicit Frames(const std::vector<NamedSource>& sources) {
    std::vector<LongitudeSpan> spans;
    bool is_degrees = true;
    for (const NamedSource& source : sources) {
      all.push_back(std::get<std::unique_ptr<RasterReader>>(source.source)->frame());
      const Raster& frame = all.back();
      is_degrees = is_degrees && frame.reference.horizontal_unit == Unit::kDegree;
      const double west = offset_of(frame.x);
      spans.push_back({west, west + step_of(frame.x) * (frame.width - 1)});
    }
    if (!is_degrees) return;
    const std::vector<bool> turned = turned_east(spans);
    double east = 0;
    for (size_t i = 0; i < all.size(); ++i) {
      if (!turned[i]) continue;
      all[i].x = names_of_x(all[i].x, true).back();
      east = std::max(east, spans[i].east + 360);
    }
    text = turned_text(turned, east);
  }

  std::vector<Raster> all;
  std::string text;  // for the user
};

void expect_same_cells(const Raster& frame, const Raster& grid, const std::string& path,
                       const std::string& first) {
  const LatticeMap x = map_between(frame.x, grid.x), y = map_between(frame.y, grid.y);
  if (x.scale == x.step && y.scale == y.step) return;
  throw Error(path + ": its cells are " + cells_of(frame) + ", those of " + first + " are " +
              cells_of(grid) + ": bring all onto one grid with gdalwarp -tr -tap");
}

struct Part {
  std::string path;
  std::unique_ptr<RasterReader> raster;
  Box box;

  // Heights of a rectangle within, with this many decimals.
  std::vector<int64_t> read(const Box& wanted, int decimals) const {
    Raster piece = raster->read(
        {static_cast<uint32_t>(wanted.x - box.x), static_cast<uint32_t>(wanted.y - box.y),
         static_cast<uint32_t>(wanted.width), static_cast<uint32_t>(wanted.height)});
    if (!refine(piece.heights, power_of_ten(decimals - piece.decimals))) {
      throw Error(path + ": its heights do not fit the decimals of the other files");
    }
    return std::move(piece.heights);
  }
};

Part part_of(const NamedSource& first, const Raster& grid, const NamedSource& named,
             const Raster& frame) {
  expect_alike(first, named, grid.reference, frame.reference);
  expect_same_cells(frame, grid, named.path, first.path);
  return {named.path,
          nullptr,
          {place_on(frame.x, grid.x, named.path, first.path),
           place_on(frame.y, grid.y, named.path, first.path), int64_t{frame.width},
           int64_t{frame.height}}};
}

// The largest difference of two heights at a post.
struct Difference {
  int64_t height = 0;  // with the whole's decimals
  int64_t x = 0, y = 0;
  std::string first, second;
};

class Mosaic : public RasterReader {
 public:
  explicit Mosaic(std::vector<NamedSource> sources) {
    const Frames frames(sources);
    frame_ = frames.all[0];
    for (size_t i = 0; i < sources.size(); ++i) {
      parts_.push_back(part_of(sources[0], frame_, sources[i], frames.all[i]));
    }
    for (size_t i = 0; i < parts_.size(); ++i) {
      add_statements(frames.all[i].reference, frame_.reference);
      parts_[i].raster = std::move(std::get<std::unique_ptr<RasterReader>>(sources[i].source));
      frame_.decimals = std::max(frame_.decimals, parts_[i].raster->frame().decimals);
    }
    find_frame();
    compare_parts();
    frame_.selection += frames.text;
  }

  Raster read(const PostRectangle& r) const override {
    Raster whole = crop_frame(frame_, r);
    whole.heights.assign(size_t{r.width} * r.height, kVoidHeight);
    const Box wanted{x_ + r.x, y_ + r.y, int64_t{r.width}, int64_t{r.height}};
    for (const Part& part : parts_) {
      const Box box = wanted.shared_with(part.box);
      if (box.empty()) continue;
      const std::vector<int64_t> heights = part.read(box, frame_.decimals);
      for (int64_t row = 0; row < box.height; ++row) {
        for (int64_t column = 0; column < box.width; ++column) {
          int64_t& z = whole.heights[static_cast<size_t>((box.y - wanted.y + row) * wanted.width +
                                                         box.x - wanted.x + column)];
          if (z == kVoidHeight) z = heights[static_cast<size_t>(row * box.width + column)];
        }
      }
    }
    return whole;
  }

 private:
  void find_frame() {
    Box all = parts_[0].box;
    for (const Part& part : parts_) {
      const int64_t right = std::max(all.right(), part.box.right());
      const int64_t top = std::max(all.top(), part.box.top());
      all.x = std::min(all.x, part.box.x);
      all.y = std::min(all.y, part.box.y);
      all.width = right - all.x;
      all.height = top - all.y;
      if (all.width > INT32_MAX || all.height > INT32_MAX) {
        throw Error(part.path + ": lies more than 2^31 posts from " + parts_[0].path);
      }
    }
    expect_held(all);
    x_ = all.x;
    y_ = all.y;
    frame_.width = static_cast<uint32_t>(all.width);
    frame_.height = static_cast<uint32_t>(all.height);
    frame_.x = moved_axis(frame_.x, x_);
    frame_.y = moved_axis(frame_.y, y_);
  }

  void expect_held(const Box& all) const {
    uint64_t held = 0;
    for (const Part& part : parts_) held += static_cast<uint64_t>(part.box.width * part.box.height);
    if (can_hold(held, static_cast<uint64_t>(all.width), static_cast<uint64_t>(all.height))) return;
    throw Error(parts_[0].path + " and others: lie so far apart that they have " +
                std::to_string(held) + " of " + std::to_string(all.width) + " x " +
                std::to_string(all.height) + " posts: encode distant files by themselves");
  }

  void compare_parts() {
    uint64_t overlaps = 0;
    Difference largest;
    for (size_t i = 0; i < parts_.size(); ++i) {
      for (size_t j = i + 1; j < parts_.size(); ++j) {
        if (parts_[i].box.shared_with(parts_[j].box).empty()) continue;
        ++overlaps;
        compare(parts_[i], parts_[j], largest);
      }
    }
    frame_.selection = std::to_string(parts_.size()) + " files" + text_of(overlaps, largest);
  }

  // In strips, so that memory stays small.
  void compare(const Part& a, const Part& b, Difference& largest) const {
    constexpr int64_t kRows = 64;
    const Box all = a.box.shared_with(b.box);
    for (int64_t y = all.y; y < all.top(); y += kRows) {
      const Box strip{all.x, y, all.width, std::min(kRows, all.top() - y)};
      const std::vector<int64_t> mine = a.read(strip, frame_.decimals);
      const std::vector<int64_t> others = b.read(strip, frame_.decimals);
      for (size_t i = 0; i < mine.size(); ++i) {
        if (mine[i] == kVoidHeight || others[i] == kVoidHeight) continue;
        const auto difference = static_cast<int64_t>(magnitude(Wide{mine[i]} - others[i]));
        if (difference <= largest.height) continue;
        const auto column = static_cast<int64_t>(i) % strip.width;
        const auto row = static_cast<int64_t>(i) / strip.width;
        largest = {difference, strip.x + column - x_, strip.y + row - y_, a.path, b.path};
      }
    }
  }

  std::string text_of(uint64_t overlaps, const Difference& largest) const {
    if (overlaps == 0) return ", none of which overlap";
    if (largest.height == 0) return ", which agree where they overlap";
    return "; where they overlap they differ by up to " +
           to_string(make_decimal(largest.height, frame_.decimals)) + ", most at x " +
           CoordinateText(frame_.x)(largest.x) + ", y " + CoordinateText(frame_.y)(largest.y) +
           " in " + largest.first + " and " + largest.second + "; the first one counts";
  }

  std::vector<Part> parts_;
  int64_t x_ = 0, y_ = 0;  // of the whole's first post on the first raster's grid
};

bool is_cloud(const NamedSource& named) {
  return std::holds_alternative<PointCloud>(named.source);
}

}  // namespace

OpenSource join(std::vector<NamedSource> parts) {
  if (parts.size() == 1) return std::move(parts[0].source);
  for (const NamedSource& part : parts) {
    if (is_cloud(part) == is_cloud(parts[0])) continue;
    throw Error(part.path + (is_cloud(part) ? ": are points, but " : ": is a raster, but ") +
                parts[0].path + (is_cloud(part) ? " is a raster" : " are points"));
  }
  if (is_cloud(parts[0])) return join_clouds(std::move(parts));
  return std::make_unique<Mosaic>(std::move(parts));
}

}  // namespace microtin::importing
