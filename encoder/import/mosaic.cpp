// SPDX-License-Identifier: MIT
// Lays rasters beside each other, and joins clouds.
#include "encoder/import/mosaic.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "encoder/base/error.hpp"
#include "encoder/exact/coordinates.hpp"
#include "encoder/exact/fraction.hpp"
#include "encoder/exact/lattice_map.hpp"
#include "encoder/exact/units.hpp"
#include "encoder/import/text.hpp"

namespace microtin::importing {
namespace {

namespace fs = std::filesystem;

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
    if (lower_case(fs::path(file.path).extension().string()) == ".asc") {
      return "put the .prj that is missing beside " + file.path;
    }
  }
  return std::holds_alternative<PointCloud>(part.source) ? "bring all points into one system first"
                                                         : "bring it there with gdalwarp";
}

void expect_alike(const NamedSource& first, const NamedSource& part, const Reference& a,
                  const Reference& b) {
  if (is_alike(a, b)) return;
  throw Error(part.path + ": its units or its coordinate system (" + text_of(b) +
              ") are not those of " + first.path + " (" + text_of(a) +
              "): " + remedy(first, part, a, b));
}

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

// Where a raster's first post is among those of another.
int64_t place_on(const Axis& axis, const Axis& grid, const std::string& path,
                 const std::string& first) {
  const LatticeMap map = map_between(axis, grid);
  if (map.shift % map.step != 0) {
    throw Error(path + ": its posts lie between those of " + first +
                ": bring all onto one grid with gdalwarp -tr -tap");
  }
  return static_cast<int64_t>(map.shift / map.step);
}

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

  // Heights of a rectangle within, with so many decimals.
  std::vector<int64_t> read(const Box& wanted, int decimals) const {
    Raster piece = raster->read(
        {static_cast<uint32_t>(wanted.x - box.x), static_cast<uint32_t>(wanted.y - box.y),
         static_cast<uint32_t>(wanted.width), static_cast<uint32_t>(wanted.height)});
    const int64_t factor = power_of_ten(decimals - piece.decimals);
    for (int64_t& z : piece.heights) {
      if (z != kVoidHeight) z *= factor;
    }
    return std::move(piece.heights);
  }
};

Part part_of(const NamedSource& first, NamedSource& named) {
  auto& raster = std::get<std::unique_ptr<RasterReader>>(named.source);
  const Raster& grid = std::get<std::unique_ptr<RasterReader>>(first.source)->frame();
  const Raster& frame = raster->frame();
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
    for (NamedSource& source : sources) parts_.push_back(part_of(sources[0], source));
    frame_ = std::get<std::unique_ptr<RasterReader>>(sources[0].source)->frame();
    for (size_t i = 0; i < parts_.size(); ++i) {
      parts_[i].raster = std::move(std::get<std::unique_ptr<RasterReader>>(sources[i].source));
      frame_.decimals = std::max(frame_.decimals, parts_[i].raster->frame().decimals);
    }
    find_frame();
    compare_parts();
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
    x_ = all.x;
    y_ = all.y;
    frame_.width = static_cast<uint32_t>(all.width);
    frame_.height = static_cast<uint32_t>(all.height);
    frame_.x = moved_axis(frame_.x, x_);
    frame_.y = moved_axis(frame_.y, y_);
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

// Brings numbers to more decimals; false if they do not fit.
bool refine(std::array<int64_t*, 2> numbers, int64_t factor) {
  for (int64_t* const number : numbers) {
    if (number == nullptr) continue;
    const Wide exact = Wide{*number} * factor;
    if (magnitude(exact) > power_of_ten(18)) return false;
    *number = static_cast<int64_t>(exact);
  }
  return true;
}

void refine(PointCloud& cloud, int xy_decimals, int z_decimals, const std::string& path) {
  const int64_t xy = power_of_ten(xy_decimals - cloud.xy_decimals);
  const int64_t z = power_of_ten(z_decimals - cloud.z_decimals);
  for (SourcePoint& p : cloud.points) {
    if (!refine({&p.x, &p.y}, xy) || !refine({&p.z, nullptr}, z)) {
      throw Error(path + ": its numbers do not go with the decimals of the other files");
    }
  }
  cloud.xy_decimals = xy_decimals;
  cloud.z_decimals = z_decimals;
}

// Where points of several files share a place: how far they differ there.
class SharedPlaces {
 public:
  // Files' points follow each other; `ends` says where each one's do.
  SharedPlaces(const PointCloud& cloud, const std::vector<size_t>& ends)
      : cloud_(cloud), ends_(ends), order_(cloud.points.size()) {
    std::iota(order_.begin(), order_.end(), size_t{0});
    std::sort(order_.begin(), order_.end(), [this](size_t a, size_t b) {
      const SourcePoint &p = cloud_.points[a], &q = cloud_.points[b];
      return std::tie(p.x, p.y, a) < std::tie(q.x, q.y, b);
    });
    for (size_t begin = 0; begin < order_.size();) begin = compare_from(begin);
  }

  std::string text(const std::vector<NamedSource>& parts) const {
    if (places_ == 0) return ", which share no place";
    const std::string at = std::to_string(places_) + " places that they share";
    if (difference_ == 0) return ", which agree at " + at;
    const CoordinateText place({0, 1, static_cast<uint64_t>(power_of_ten(cloud_.xy_decimals))});
    const SourcePoint& p = cloud_.points[first_];
    return "; at " + at + " they differ by up to " +
           to_string(make_decimal(difference_, cloud_.z_decimals)) + ", most at x " + place(p.x) +
           ", y " + place(p.y) + " in " + parts[file_of(first_)].path + " and " +
           parts[file_of(second_)].path + "; all count";
  }

 private:
  size_t file_of(size_t point) const {
    return static_cast<size_t>(std::upper_bound(ends_.begin(), ends_.end(), point) - ends_.begin());
  }

  // The points of one place, in the order of their files; those of earlier files are compared by
  // their lowest and highest. Returns where the next place begins.
  size_t compare_from(size_t begin) {
    const SourcePoint& place = cloud_.points[order_[begin]];
    const size_t first_file = file_of(order_[begin]);
    size_t low = order_[begin], high = low, own_low = low, own_high = low, file = first_file;
    bool is_shared = false;
    size_t end = begin;
    for (; end < order_.size(); ++end) {
      const size_t point = order_[end];
      const SourcePoint& p = cloud_.points[point];
      if (p.x != place.x || p.y != place.y) break;
      if (const size_t own = file_of(point); own != file) {
        file = own;
        low = lower(low, own_low);
        high = higher(high, own_high);
        own_low = own_high = point;
      }
      own_low = lower(own_low, point);
      own_high = higher(own_high, point);
      if (file == first_file) continue;
      is_shared = true;
      note(low, point);
      note(high, point);
    }
    if (is_shared) ++places_;
    return end;
  }

  size_t lower(size_t a, size_t b) const { return cloud_.points[b].z < cloud_.points[a].z ? b : a; }
  size_t higher(size_t a, size_t b) const {
    return cloud_.points[b].z > cloud_.points[a].z ? b : a;
  }

  void note(size_t a, size_t b) {
    const Wide difference = magnitude(Wide{cloud_.points[a].z} - cloud_.points[b].z);
    if (difference <= difference_) return;
    difference_ = difference;
    first_ = a;
    second_ = b;
  }

  const PointCloud& cloud_;
  const std::vector<size_t>& ends_;
  std::vector<size_t> order_;
  uint64_t places_ = 0;
  Wide difference_ = 0;
  size_t first_ = 0, second_ = 0;
};

PointCloud join_clouds(std::vector<NamedSource> parts) {
  PointCloud whole = std::move(std::get<PointCloud>(parts[0].source));
  std::vector<size_t> ends = {whole.points.size()};
  for (size_t i = 1; i < parts.size(); ++i) {
    PointCloud& part = std::get<PointCloud>(parts[i].source);
    expect_alike(parts[0], parts[i], whole.reference, part.reference);
    const int xy = std::max(whole.xy_decimals, part.xy_decimals);
    const int z = std::max(whole.z_decimals, part.z_decimals);
    refine(whole, xy, z, parts[i].path);
    refine(part, xy, z, parts[i].path);
    whole.points.insert(whole.points.end(), part.points.begin(), part.points.end());
    if (whole.classes && part.classes) *whole.classes |= *part.classes;
    ends.push_back(whole.points.size());
    part = PointCloud();
  }
  whole.selection = std::to_string(parts.size()) + " files" + SharedPlaces(whole, ends).text(parts);
  return whole;
}

bool is_cloud(const NamedSource& named) {
  return std::holds_alternative<PointCloud>(named.source);
}

}  // namespace

namespace {

using FilesBySuffix = std::map<std::string, std::vector<std::string>>;

FilesBySuffix terrain_files_in(const std::string& folder) {
  FilesBySuffix by_suffix;
  std::error_code error;
  const fs::directory_iterator entries(folder, error);
  if (error) throw Error(folder + ": cannot be read: " + error.message());
  for (const auto& entry : entries) {
    const std::string suffix = lower_case(entry.path().extension().string());
    if (entry.is_regular_file() && is_terrain_suffix(suffix)) {
      by_suffix[suffix].push_back(entry.path().string());
    }
  }
  return by_suffix;
}

FilesBySuffix::const_iterator most_of(const FilesBySuffix& files) {
  return std::max_element(files.begin(), files.end(), [](const auto& a, const auto& b) {
    return a.second.size() < b.second.size();
  });
}

}  // namespace

std::vector<std::string> files_in(const std::string& path) {
  std::error_code none;
  if (!fs::is_directory(path, none)) return {path};
  const FilesBySuffix by_suffix = terrain_files_in(path);
  if (by_suffix.empty()) throw Error(path + ": holds no terrain file: " + terrain_kinds());
  std::vector<std::string> files = most_of(by_suffix)->second;
  std::sort(files.begin(), files.end());
  return files;
}

std::string left_out_of(const std::string& path) {
  std::error_code none;
  if (!fs::is_directory(path, none)) return "";
  const FilesBySuffix by_suffix = terrain_files_in(path);
  if (by_suffix.size() < 2) return "";
  const auto most = most_of(by_suffix);
  std::string text = path + ": its " + most->first + " files are taken; left out are";
  for (auto other = by_suffix.begin(); other != by_suffix.end(); ++other) {
    if (other == most) continue;
    text += ' ' + std::to_string(other->second.size()) + " of " + other->first;
  }
  return text;
}

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
